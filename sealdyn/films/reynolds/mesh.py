"""Cells over radius and angle: the film's parameter block, and what the film thickness makes of the cells.

In ln r and theta Reynolds' equation has constant coefficients but for the film: the cells are all alike there, each
with its node in its middle.  Film values stand where they are needed: at the nodes (what a cell stores), halfway
between nodes and at the edges of the face (what flows).  One sector of a face that repeats itself may stand for all.

A rough film carries means over Christensen's heights at a mean film thickness.
**Source** Lebeck, Teale & Pierce, ONR ME-95(79)ONR-414-1 (1979), ch. 2: density 35/(32 c^7) (c^2 - d^2)^3 of the
heights |d| < c = 3 rms; the mean film E(H) carries the Couette flow and is what the film stores, the mean cube E(H^3)
the Poiseuille flow in both directions, the mean reciprocal E(1/H) the shear.  H = max(h + d, 0).  Over plateaus, which
leave a film b between them, the flow sees the smooth film b + E(max(h - b + d, 0)).
Patir & Cheng (1978), J. Lubr. Tech. 100, 12: in place of E(H^3) the factor 1 - 0.90 exp(-0.56 h/rms) times h^3, of
roughness that is alike in both directions, h above half an rms.
**Valid** heights far lower than they are long, the same in every direction.  faces/roughness.py has the same means for
arrays.
"""

import math

import numpy as np

from ...faces.film_thickness import film_thickness, waves, waves_rate, waves_turn
from ...faces.geometry import (
    CLEARANCE,
    CONING_CHANGE,
    CONING_RATE,
    DZ,
    DZ_RATE,
    FACE_SIZE,
    FLOOR,
    GAP_STATE_SIZE,
    GX,
    GX_RATE,
    GY,
    GY_RATE,
    HALF_HEIGHT,
    INNER_RADIUS,
    PLATEAU,
    TILT_AT_MEAN,
    VISCOSITY,
    WAVES,
    face_parameters,
    regularised_thickness,
)
from ...numerics.kernel import inner_kernel
from ...numerics.piecewise_linear import points
from ...scene.film import Reynolds, cells_of

# Block after the faces: cells over the radius, angles of a sector, sectors of the circle, steps in ln r and theta, the
# pressure (Pa) that counts as 1, whether the flow sees the asperities (FACTOR: by Patir and Cheng's), whether the film
# cavitates, the cavitation pressure (Pa; 0 without), and how much faster than the faces turn a full cell is brought
# back to its volume.
(CELLS, ANGLES, SECTORS, RADIAL_STEP, ANGLE_STEP, SCALE, ROUGH, CAVITATES, CAVITATION, PACE, TABLES) = range(
    FACE_SIZE, FACE_SIZE + 11
)
# That of a run, and where it must not show: in the modes.
FASTER, AT_ONCE = 30.0, 1e8
# Values of ROUGH.
FACTOR = 2.0
SEEN = {"none": 0.0, "christensen": 1.0, "patir-cheng": FACTOR}
# Tables, each with room for all edges: radius (m), rise of the aligned film (m) and arm of the tilt (m) at the nodes,
# then rise and arm at the edges; of each cell int r dr (m^2), int of the arm r dr (m^3), int r^3 dr (m^4).
RADIUS, RISE, ARM, EDGE_RISE, EDGE_ARM, AREA, TURNED, DRAG, ROWS = range(9)


def parameters(film, clearance: float, error: float = 1e-8, orders=()) -> np.ndarray:
    """The film's block of the parameter array: a `Film` table and the design clearance at the inner radius (m); `error`
    is not needed: the cells are as many as the scene says, or enough for waves of these `orders`."""
    options = film.reynolds or Reynolds()
    radial, angles, sectors = cells_of(film, orders)
    r_i, width = film.inner_radius, film.outer_radius - film.inner_radius
    # Narrow faces on a large radius keep their digits.
    step = math.log1p(width / r_i) / radial
    f = np.zeros(TABLES + ROWS * (radial + 1))
    f[:FACE_SIZE] = face_parameters(film, clearance)
    f[CELLS], f[ANGLES], f[SECTORS] = radial, angles, sectors
    f[RADIAL_STEP], f[ANGLE_STEP] = step, 2.0 * math.pi / (sectors * angles)
    base = film.cavitation_pressure if options.cavitation == "mass-conserving" else None
    f[CAVITATES], f[CAVITATION], f[PACE] = base is not None, base or 0.0, FASTER
    spread = [abs(p - f[CAVITATION]) for p in (*points(film.inner_pressure), *points(film.outer_pressure))]
    f[SCALE], f[ROUGH] = max(spread) or 1.0, SEEN[options.roughness]

    nodes = r_i + r_i * np.expm1(step * (np.arange(radial) + 0.5))
    edges = r_i + r_i * np.expm1(step * np.arange(radial + 1))
    edges[-1] = film.outer_radius
    low, high, still = edges[:-1], edges[1:], np.zeros(GAP_STATE_SIZE)
    mean = r_i + 0.5 * width
    tables = f[TABLES:].reshape(ROWS, radial + 1)
    tables[RADIUS, :radial], tables[ARM, :radial] = nodes, mean if f[TILT_AT_MEAN] else nodes
    tables[EDGE_ARM] = mean if f[TILT_AT_MEAN] else edges
    # Waves are laid later.
    tables[RISE, :radial] = [film_thickness(f, still, r, 0.0) - f[CLEARANCE] for r in nodes]
    tables[EDGE_RISE] = [film_thickness(f, still, r, 0.0) - f[CLEARANCE] for r in edges]
    area = 0.5 * (high - low) * (high + low)
    tables[AREA, :radial] = area
    third = (high - low) * (high * high + high * low + low * low) / 3.0
    tables[TURNED, :radial] = mean * area if f[TILT_AT_MEAN] else third
    tables[DRAG, :radial] = 0.5 * area * (high * high + low * low)
    return f


@inner_kernel()
def table(f, which):
    """One of the tables of a block, (cells + 1,)."""
    size = int(f[CELLS]) + 1
    return f[TABLES + which * size : TABLES + (which + 1) * size]


@inner_kernel()
def half_height(f):
    """Half the height of the asperities (m) that the flow sees, 0 between smooth faces."""
    return f[HALF_HEIGHT] if f[ROUGH] != 0.0 else 0.0


@inner_kernel()
def plateau(f):
    """Film (m) between the plateaus that the flow sees, 0 without."""
    return f[PLATEAU] if f[ROUGH] != 0.0 else 0.0


@inner_kernel()
def heights(f, s, nodes, between, edges):
    """Mean film thickness (m), as the flow sees it, at the `nodes` (angles, cells), halfway from each angle to the next
    at the nodes' radii, `between` (angles, cells), and at the `edges` (angles, cells + 1) of the cells' radii."""
    rise, arm, edge_rise, edge_arm = table(f, RISE), table(f, ARM), table(f, EDGE_RISE), table(f, EDGE_ARM)
    radius, c, b, floor, outwards = table(f, RADIUS), half_height(f), plateau(f), f[FLOOR], s[CONING_CHANGE]
    first, step = f[INNER_RADIUS], f[RADIAL_STEP]
    for k in range(nodes.shape[0]):
        for half in range(2):
            theta = f[ANGLE_STEP] * (k + 0.5 * half)
            aligned = f[CLEARANCE] + s[DZ] + waves(f, s, theta)
            tilt = s[GX] * math.sin(theta) - s[GY] * math.cos(theta)
            out = nodes if half == 0 else between
            for j in range(nodes.shape[1]):
                coned = rise[j] + outwards * (radius[j] - first)
                out[k, j] = open_height(aligned + coned + arm[j] * tilt, c, b, floor)
            if half == 0:
                for j in range(edges.shape[1]):
                    coned = edge_rise[j] + outwards * first * math.expm1(step * j)
                    edges[k, j] = open_height(aligned + coned + edge_arm[j] * tilt, c, b, floor)


@inner_kernel()
def films(f, s):
    """What the film thickness at a gap state makes of the cells: mean film (m) at the nodes `stored` and halfway to the
    next angle `carried`, (angles, cells) both, and the conductances (m^3/(Pa s)) between neighbours over the radius
    `ways` (angles, cells + 1), the first and the last to the edges of the face, and around `around` (angles, cells)."""
    angles, cells = int(f[ANGLES]), int(f[CELLS])
    stored, carried, around = np.empty((angles, cells)), np.empty((angles, cells)), np.empty((angles, cells))
    ways = np.empty((angles, cells + 1))
    heights(f, s, stored, carried, ways)
    c, b, factor, per = half_height(f), plateau(f), f[ROUGH] == FACTOR, 1.0 / (12.0 * s[VISCOSITY])
    over, along = per * f[ANGLE_STEP] / f[RADIAL_STEP], per * f[RADIAL_STEP] / f[ANGLE_STEP]
    for k in range(angles):
        for j in range(cells):
            around[k, j] = along * mean_cube(carried[k, j], c, b, factor)
            carried[k, j], stored[k, j] = mean_film(carried[k, j], c, b), mean_film(stored[k, j], c, b)
        for j in range(cells + 1):
            # Half a step from the edges of the face.
            near = 2.0 if j == 0 or j == cells else 1.0
            ways[k, j] = near * over * mean_cube(ways[k, j], c, b, factor)
    return stored, carried, ways, around


@inner_kernel()
def stored_rates(f, s, rates):
    """Rates `rates` (angles, cells) of the mean film at the nodes (m/s), of the gap state's own rates and of waves that
    pass: dE(H)/dt = (1 - contact share) dh/dt."""
    rise, arm, radius = table(f, RISE), table(f, ARM), table(f, RADIUS)
    c, b, floor, outwards, first = half_height(f), plateau(f), f[FLOOR], s[CONING_CHANGE], f[INNER_RADIUS]
    for k in range(rates.shape[0]):
        theta = f[ANGLE_STEP] * k
        sin, cos = math.sin(theta), math.cos(theta)
        aligned, tilt = f[CLEARANCE] + s[DZ] + waves(f, s, theta), s[GX] * sin - s[GY] * cos
        moving, tilting = s[DZ_RATE] + waves_rate(f, s, theta), s[GX_RATE] * sin - s[GY_RATE] * cos
        for j in range(rates.shape[1]):
            h = aligned + rise[j] + outwards * (radius[j] - first) + arm[j] * tilt
            slope = open_slope(h, c, b, floor) * (1.0 - contact_share(open_height(h, c, b, floor) - b, c))
            rates[k, j] = slope * (moving + s[CONING_RATE] * (radius[j] - first) + arm[j] * tilting)


@inner_kernel()
def moves(f, s):
    """Whether the film thickness changes at a gap state."""
    rates = abs(s[DZ_RATE]) + abs(s[GX_RATE]) + abs(s[GY_RATE]) + abs(s[CONING_RATE])
    return rates > 0.0 or (f[WAVES] != 0.0 and waves_turn(f, s))


# --- means over rough heights ---------------------------------------------------------------------------

# Above the last asperity's foot, in c: nearer to it h is continued, so that no film closes altogether.
NEAREST = 0.05
# Films thinner than this share of c do not count in the shear: its mean would diverge.
CUTOFF = 0.1
# Patir and Cheng's two numbers of isotropic roughness, and the least film over the rms for which they stand.
PATIR, CHENG, STANDS = 0.90, 0.56, 0.5
POINTS, WEIGHTS = np.polynomial.legendre.leggauss(16)


@inner_kernel()
def open_height(h, c, b, floor):
    """Mean film (m) as the flow sees it: h itself, and its positive continuation below the `floor` (m) of smooth faces
    (c = 0), or near -c between rough ones; over plateaus, between which a film `b` (m) stays, h itself."""
    return h if b > 0.0 else regularised_thickness(h + c, lowest(c, floor)) - c


@inner_kernel()
def open_slope(h, c, b, floor):
    """How `open_height` moves with h."""
    low = lowest(c, floor)
    return 1.0 if b > 0.0 or h + c >= low else (low / (2.0 * low - h - c)) ** 2


@inner_kernel()
def lowest(c, floor):
    """Height (m) over the feet of the asperities from which on the film is continued."""
    return floor if c == 0.0 else NEAREST * c


@inner_kernel()
def contact_share(h, c):
    """Share of the area in contact, P(h/c); 0 between smooth faces (c = 0)."""
    if c == 0.0 or h >= c:
        return 0.0
    u = min(0.5 * (1.0 - h / c), 1.0)
    return u**4 * (35.0 - u * (84.0 - u * (70.0 - 20.0 * u)))


@inner_kernel()
def mean_film(h, c, b):
    """E(H) (m), H over the plateaus `b` (m)."""
    if c == 0.0 or h - b >= c:
        return h
    # Factored about h = b - c, where the film closes: nothing cancels.
    u = max(0.5 * (1.0 + (h - b) / c), 0.0)
    return b + c * u**5 * (14.0 - u * (28.0 - u * (20.0 - 5.0 * u)))


@inner_kernel()
def mean_cube(h, c, b, factor):
    """E(H^3) (m^3), or what stands for it: over plateaus the cube of the mean film, with `factor` Patir and Cheng's
    share of h^3, c three rms roughnesses."""
    if c == 0.0 or b > 0.0:
        return mean_film(h, c, b) ** 3
    if factor:
        x = 3.0 * regularised_thickness(h, STANDS * c / 3.0) / c
        return (1.0 - PATIR * math.exp(-CHENG * x)) * (x * c / 3.0) ** 3
    if h >= c:
        return h * (h * h + c * c / 3.0)
    u = max(0.5 * (1.0 + h / c), 0.0)
    return c**3 * u**7 * (8.0 - u * (12.0 - u * (20.0 / 3.0 - u * (4.0 / 3.0))))


@inner_kernel()
def mean_reciprocal(h, c, b):
    """E(1/H) (1/m) over films thicker than CUTOFF c: Gauss points in ln H, where the integrand is smooth; over plateaus
    of their mean film."""
    if c == 0.0 or b > 0.0:
        return 1.0 / mean_film(h, c, b)
    x = h / c
    top, low = x + 1.0, max(x - 1.0, CUTOFF)
    if top <= low:
        return 0.0
    middle, half, total = 0.5 * math.log(top * low), 0.5 * math.log(top / low), 0.0
    for k in range(len(POINTS)):
        d = math.exp(middle + half * POINTS[k]) - x
        total += WEIGHTS[k] * (1.0 - d * d) ** 3
    return 35.0 / 32.0 * half * total / c
