"""Cells over the face of the gas Reynolds film: its parameter block, the film thickness at their nodes, and the balance
of every cell, what it stores is what flows in, with its derivatives and its steady solution.

    d(p h)/dt + wm d(p h)/dtheta = (1/r) d/dr (r h^3 p p_r/(12 mu)) + (1/r^2) d/dtheta (h^3 p p_theta/(12 mu))

**Source** Reynolds' equation of an isothermal ideal gas (Gross, Gas Film Lubrication (1962)), with first-order slip
(Burgdorfer (1959), J. Basic Eng. 81, 94): h^3 p becomes h^3 p (1 + 6 Kn), Kn = mu sqrt(pi R T/2)/(p h).

Every cell has a node, and both edges of the face are nodes too.  A cell reaches from halfway to the node before to
halfway to the next; the first and the last reach to the edge of the face, and what flows over that edge is what flows
at the half of the way, with the cell's own rate in between.  Towards the edges the cells get narrower: gas that is
squeezed fast escapes from a thin layer there, and one that expands falls in pressure most before its outlet.

The unknowns are the products x = p h of the cells (Pa m), those of one angle side by side: what a cell stores is linear
in them, the gap's rates do not occur, and a film that is shut in answers at once through p = x/h.  From a node to the
next over the radius p^2 is what a steady flow between faces of constant slope makes of it: there

    flow = 2 h_a^2 h_b^2/(h_a + h_b) (p_a^2 - p_b^2) / (24 mu ln(r_b/r_a))

is exact for parallel faces, and but for 1/r for cones.  Around the circle differences are central ones that are exact
for tilt, without upwinding: x is smooth there, for nothing holds its pressure at any angle, and what an upwind
difference damps would be taken for damping of the film.  Below zero, where a solver may try, p |p| stands for p^2, so
that pressure differences always even out.  Second order in the cells.

The steady pressures at a gap state are found by Newton's method.
"""

import math
from itertools import pairwise

import numpy as np

from ...faces.film_thickness import film_thickness, waves, waves_rate
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
    INNER_PRESSURE,
    MEAN_SPIN,
    OUTER_PRESSURE,
    TEMPERATURE,
    TILT_AT_MEAN,
    VISCOSITY,
    face_parameters,
    regularised_thickness,
)
from ...numerics.kernel import inner_kernel, outer_kernel, value_kernel
from ...numerics.piecewise_linear import points
from ...scene.film import depth_of
from ...scene.fluid import GasReynolds, gas_of
from .._cells_around import AFTER, BEFORE, INNER, OUTER, OWN, eliminate, neighbours, place, room

# Block after the faces: cells over the radius, angles, scale of an unknown (Pa m), what slip adds to the flow at a
# temperature of 1 K (m/s, 0 without), and the steps of differences around the circle: 2 sin(d_theta) of a slope,
# (2 sin(d_theta/2))^2 of a curvature, exact for tilt; whether there are pads.
CELLS, ANGLES, SCALE, SLIP, SLOPE_STEP, CURVATURE_STEP, PADDED, TABLES = range(FACE_SIZE, FACE_SIZE + 8)
# Tables, each with room for all nodes: radius (m), rise of the aligned film from the clearance (m), arm of the tilt (m)
# at each node; ln of the ratio of radii from a node to the next; of each cell int r dr (m^2), without what is between
# its node and the edge of the face, and with it; int dr/r over the latter (1/m^2), int r^3 dr (m^4); what force (m^2)
# and moment (m^3) have of the pressure of each node, per rad.  Then sines and cosines of the angles, and of pads their
# depth (m) at each node, angle by angle.
RADIUS, RISE, ARM, APART, CORE, AREA, AROUND, DRAG, PRESSED, TURNED, ROWS = range(11)
# How much narrower the cells at the edges are: 0 all alike, 1 as the cosines of equal angles.
GRADING = 0.8
# Exact for what `weights` integrates.
POINTS, WEIGHTS = np.polynomial.legendre.leggauss(4)


def radii(inner_radius: float, outer_radius: float, cells: int, grading: float) -> np.ndarray:
    """Radii (m) of the nodes, (cells + 2,)."""
    even = np.concatenate([[0.0], (np.arange(cells) + 0.5) / cells, [1.0]])
    share = (1.0 - grading) * even + grading * 0.5 * (1.0 - np.cos(np.pi * even))
    return inner_radius + (outer_radius - inner_radius) * share


def weights(r: np.ndarray, between: np.ndarray, power: int) -> np.ndarray:
    """What the integral of p r^power dr over the face has of p at the nodes `r` (m), (nodes,): parabolas through three
    nodes each from one of the radii `between` (m), (nodes - 1,), to the next; those at the ends reach to the edges."""
    found, limits = np.zeros(len(r)), np.concatenate([r[:1], between[1:-1], r[-1:]])
    for n, (a, b) in enumerate(pairwise(limits)):
        # Counted from the middle node, in half widths.
        middle, half = r[n + 1], 0.5 * (r[n + 2] - r[n])
        x = (0.5 * (a + b) - middle + 0.5 * (b - a) * POINTS) / half
        moments = [0.5 * (b - a) * np.sum(WEIGHTS * x**k * (middle + half * x) ** power) for k in range(3)]
        at = (r[n : n + 3] - middle) / half
        found[n : n + 3] += np.linalg.solve(np.vander(at, increasing=True).T, moments)
    return found


def parameters(film, clearance: float, error: float = 1e-8, grading: float = GRADING) -> np.ndarray:
    """The film's block of the parameter array: a Film table and the design clearance at the inner radius (m).  `error`
    is not needed: the cells are as many as the scene says.  `grading` from 0, all alike, to 1."""
    options = film.gas_reynolds or GasReynolds()
    cells, angles = options.cells
    nodes = cells + 2
    f = np.zeros(TABLES + ROWS * nodes + 2 * angles + (angles * nodes if film.pads else 0))
    f[:FACE_SIZE] = face_parameters(film, clearance)
    f[CELLS], f[ANGLES] = cells, angles
    f[SCALE] = max(*points(film.inner_pressure), *points(film.outer_pressure)) * clearance
    # Mean free path viscosity/pressure sqrt(pi R T/2).
    f[SLIP] = 0.5 * math.sqrt(0.5 * math.pi * gas_of(film).gas_constant) if options.slip else 0.0
    step = 2.0 * math.pi / angles
    f[SLOPE_STEP], f[CURVATURE_STEP] = 2.0 * math.sin(step), 4.0 * math.sin(0.5 * step) ** 2

    r = radii(film.inner_radius, film.outer_radius, cells, grading)
    between = 0.5 * (r[:-1] + r[1:])
    edges = np.concatenate([r[:1], between[1:-1], r[-1:]])
    a, b = edges[:-1], edges[1:]
    mean, still = 0.5 * (film.inner_radius + film.outer_radius), np.zeros(GAP_STATE_SIZE)
    tables = f[TABLES : TABLES + ROWS * nodes].reshape(ROWS, nodes)
    tables[RADIUS], tables[ARM] = r, mean if f[TILT_AT_MEAN] else r
    # Waves are laid later.
    tables[RISE] = [film_thickness(f, still, radius, 0.0) - f[CLEARANCE] for radius in r]
    tables[APART, : cells + 1] = np.log(r[1:] / r[:-1])
    tables[CORE, :cells] = 0.5 * np.diff(between**2)
    tables[AREA, :cells], tables[AROUND, :cells] = 0.5 * (b * b - a * a), np.log(b / a)
    tables[AROUND, :cells] /= tables[AREA, :cells]
    tables[DRAG, :cells] = 0.25 * (b**4 - a**4)
    tables[PRESSED] = weights(r, between, 1)
    tables[TURNED] = mean * tables[PRESSED] if f[TILT_AT_MEAN] else weights(r, between, 2)
    theta = step * np.arange(angles)
    last = TABLES + ROWS * nodes + 2 * angles
    f[TABLES + ROWS * nodes : last] = np.concatenate([np.sin(theta), np.cos(theta)])
    if film.pads:
        f[PADDED], f[last:] = 1.0, depth_of(film, r, theta[:, None]).ravel()
    return f


@inner_kernel()
def table(f, which):
    """One of the tables of a block, (cells + 2,)."""
    nodes = int(f[CELLS]) + 2
    return f[TABLES + which * nodes : TABLES + (which + 1) * nodes]


@inner_kernel()
def sines(f):
    """Sines and cosines of the angles of a block, both (angles,)."""
    first, angles = TABLES + ROWS * (int(f[CELLS]) + 2), int(f[ANGLES])
    return f[first : first + angles], f[first + angles : first + 2 * angles]


@inner_kernel()
def pads(f):
    """Depth of the pads (angles, cells + 2) (m) of a block that has them."""
    angles, nodes = int(f[ANGLES]), int(f[CELLS]) + 2
    first = TABLES + ROWS * nodes + 2 * angles
    return f[first : first + angles * nodes].reshape(angles, nodes)


@inner_kernel()
def thicknesses(f, s, h, bumps):
    """Film thickness `h` (angles, cells + 2) at the nodes (m), as the film's flow sees it, and what the waves have of
    it, `bumps` (angles,) (m)."""
    rise, arm, radius = table(f, RISE), table(f, ARM), table(f, RADIUS)
    sin, cos = sines(f)
    deeper = TABLES + ROWS * h.shape[1] + 2 * h.shape[0]
    for k in range(h.shape[0]):
        bumps[k] = waves(f, s, 2.0 * math.pi * k / h.shape[0])
        aligned, tilt = f[CLEARANCE] + s[DZ] + bumps[k], s[GX] * sin[k] - s[GY] * cos[k]
        for n in range(h.shape[1]):
            coned = rise[n] + s[CONING_CHANGE] * (radius[n] - radius[0])
            if f[PADDED] != 0.0:
                coned += f[deeper + k * h.shape[1] + n]
            h[k, n] = regularised_thickness(aligned + coned + arm[n] * tilt, f[FLOOR])


@inner_kernel()
def thickness_rates(f, s, h, rates):
    """Rates `rates` (angles, cells) of the film thickness `h` of `thicknesses` in the cells (m/s), of the gap state's
    own rates."""
    arm, radius, floor = table(f, ARM), table(f, RADIUS), f[FLOOR]
    sin, cos = sines(f)
    for k in range(rates.shape[0]):
        aligned = s[DZ_RATE] + waves_rate(f, s, 2.0 * math.pi * k / rates.shape[0])
        tilting = s[GX_RATE] * sin[k] - s[GY_RATE] * cos[k]
        for j in range(rates.shape[1]):
            # Below the floor its continuation moves less.
            slope = 1.0 if h[k, j + 1] >= floor else (h[k, j + 1] / floor) ** 2
            coned = s[CONING_RATE] * (radius[j + 1] - radius[0])
            rates[k, j] = slope * (aligned + coned + arm[j + 1] * tilting)


@inner_kernel()
def _through(h_a, h_b):
    """h^3 (m^3) of a film that is linear between two thicknesses, as a flow through it sees it: 1 over the mean of
    1/h^3."""
    both = h_a * h_b
    return 2.0 * both * both / (h_a + h_b)


@inner_kernel()
def pressures(f, s, x, h, p):
    """Pressures `p` (angles, cells + 2) at the nodes (Pa)."""
    cells = h.shape[1] - 2
    for k in range(h.shape[0]):
        p[k, 0], p[k, cells + 1] = s[INNER_PRESSURE], s[OUTER_PRESSURE]
        for j in range(cells):
            p[k, j + 1] = x[k * cells + j] / h[k, j + 1]


@inner_kernel()
def radial_ways(f, s, h, ways, slips):
    """What the flow (Pa m^3/s per rad) between neighbouring nodes over the radius has of differences of p^2, `ways`,
    and with slip of p, `slips`, both (angles, cells + 1)."""
    apart, per, slip = table(f, APART), 1.0 / (24.0 * s[VISCOSITY]), _slip(f, s)
    for e in range(ways.shape[1]):
        way, slippery = per / apart[e], slip / apart[e]
        for k in range(ways.shape[0]):
            ways[k, e] = way * _through(h[k, e], h[k, e + 1])
            slips[k, e] = slippery * h[k, e] * h[k, e + 1]


@inner_kernel()
def _ways_around(f, s, h, ways, slips):
    """The same between each angle and the next, per area (Pa m/s), (angles, cells)."""
    around, per, slip = table(f, AROUND), 1.0 / (24.0 * s[VISCOSITY] * f[CURVATURE_STEP]), _slip(f, s)
    slip /= f[CURVATURE_STEP]
    angles, cells = ways.shape
    for k in range(angles):
        _, after = neighbours(k, angles)
        for j in range(cells):
            h_a, h_b = h[k, j + 1], h[after, j + 1]
            ways[k, j], slips[k, j] = per * around[j] * _through(h_a, h_b), slip * around[j] * h_a * h_b


@inner_kernel()
def _slip(f, s):
    """What slip adds to the flow, over h^2 and a difference of p (m/s); the viscosity drops out."""
    return f[SLIP] * s[TEMPERATURE] ** 0.5


@inner_kernel()
def between(p_a, p_b, way, slip):
    """Flow from a node to its neighbour."""
    return way * (p_a * abs(p_a) - p_b * abs(p_b)) + slip * (p_a - p_b)


@inner_kernel()
def state(f, s, x):
    """What the balances are made of: thicknesses (m) and pressures (Pa) at the nodes, ways and slips over the radius,
    ways and slips around the circle."""
    angles, cells = int(f[ANGLES]), int(f[CELLS])
    h, p = np.empty((angles, cells + 2)), np.empty((angles, cells + 2))
    thicknesses(f, s, h, np.empty(angles))
    pressures(f, s, x, h, p)
    ways, slips = np.empty((angles, cells + 1)), np.empty((angles, cells + 1))
    radial_ways(f, s, h, ways, slips)
    ways_around, slips_around = np.empty((angles, cells)), np.empty((angles, cells))
    _ways_around(f, s, h, ways_around, slips_around)
    return h, p, ways, slips, ways_around, slips_around


@inner_kernel()
def rates(f, s, x, h, p, ways, slips, ways_around, slips_around, out):
    """Rates `out` (n,) (Pa m/s) at which the flows across its edges fill every cell, of the `state` at `x`."""
    angles, cells = int(f[ANGLES]), int(f[CELLS])
    area, turning = table(f, CORE), s[MEAN_SPIN] / f[SLOPE_STEP]
    for k in range(angles):
        before, after = neighbours(k, angles)
        arriving = between(p[k, 0], p[k, 1], ways[k, 0], slips[k, 0])
        for j in range(cells):
            here = p[k, j + 1]
            leaving = between(here, p[k, j + 2], ways[k, j + 1], slips[k, j + 1])
            filled = (arriving - leaving) / area[j]
            filled += between(p[before, j + 1], here, ways_around[before, j], slips_around[before, j])
            filled -= between(here, p[after, j + 1], ways_around[k, j], slips_around[k, j])
            carried = turning * (x[before * cells + j] - x[after * cells + j])
            out[k * cells + j] = carried + filled
            arriving = leaving


@inner_kernel()
def slopes(f, s, h, p, ways, slips, ways_around, slips_around, out):
    """Derivatives `out` (n, 5) of `rates` by each cell's own unknown and its neighbours' (OWN, INNER, ...), 1/s; 0 for
    the edges of the face."""
    angles, cells = int(f[ANGLES]), int(f[CELLS])
    area, turning = table(f, CORE), s[MEAN_SPIN] / f[SLOPE_STEP]
    for k in range(angles):
        before, after = neighbours(k, angles)
        for j in range(cells):
            here, inside, outside = p[k, j + 1], p[k, j], p[k, j + 2]
            row, per = out[k * cells + j], 1.0 / area[j]
            way = per * (ways[k, j] + ways[k, j + 1]) + ways_around[before, j] + ways_around[k, j]
            slip = per * (slips[k, j] + slips[k, j + 1]) + slips_around[before, j] + slips_around[k, j]
            row[OWN] = -_slope(here, h[k, j + 1], way, slip)
            row[INNER] = per * _slope(inside, h[k, j], ways[k, j], slips[k, j]) if j > 0 else 0.0
            row[OUTER] = per * _slope(outside, h[k, j + 2], ways[k, j + 1], slips[k, j + 1]) if j < cells - 1 else 0.0
            way, slip = ways_around[before, j], slips_around[before, j]
            row[BEFORE] = _slope(p[before, j + 1], h[before, j + 1], way, slip) + turning
            way, slip = ways_around[k, j], slips_around[k, j]
            row[AFTER] = _slope(p[after, j + 1], h[after, j + 1], way, slip) - turning


@inner_kernel()
def _slope(p, h, way, slip):
    """What a flow from a node has of its unknown p h."""
    return (2.0 * way * abs(p) + slip) / h


@value_kernel()
def residual(f, s, x, x_rate, res):
    """What every cell stores less what flows into it, per area (Pa m/s)."""
    rates(f, s, x, *state(f, s, x), res)
    for i in range(len(res)):
        res[i] = x_rate[i] - res[i]
    return 0


@value_kernel()
def jacobian(f, s, x, x_rate, alpha, data):
    """d residual / d x + alpha d residual / d x_rate, in the order of the pattern (columns, rows rising)."""
    angles, cells = int(f[ANGLES]), int(f[CELLS])
    rows, at = np.empty((angles * cells, 5)), 0
    slopes(f, s, *state(f, s, x), rows)
    for k in range(angles):
        before, after = neighbours(k, angles)
        for j in range(cells):
            i = k * cells + j
            # The angle next door may lie at the other end of the list.
            if k == angles - 1:
                data[at], at = -rows[after * cells + j, BEFORE], at + 1
            if k > 0:
                data[at], at = -rows[before * cells + j, AFTER], at + 1
            if j > 0:
                data[at], at = -rows[i - 1, OUTER], at + 1
            data[at], at = alpha - rows[i, OWN], at + 1
            if j < cells - 1:
                data[at], at = -rows[i + 1, INNER], at + 1
            if k < angles - 1:
                data[at], at = -rows[after * cells + j, BEFORE], at + 1
            if k == 0:
                data[at], at = -rows[before * cells + j, AFTER], at + 1


# Newton's steps, the change of a pressure after which only rounding is left, and how near to zero a step may take a
# pressure; the change from which on what closing adds counts fully.
MOST_STEPS, ARRIVED, NEAREST, NEAR = 200, 1e-9, 0.1, 0.01
# Least pressure, and least pressure of which flows have their slope, as shares of the lower one of the edges.
LEAST, SLOPED = 1e-6, 1e-3
UNSOLVED = 1


@inner_kernel()
def _first(f, s, x):
    """Pressures of a flow over the radius alone between still faces: p^2 falls with the way."""
    angles, cells = int(f[ANGLES]), int(f[CELLS])
    p_i, p_o = s[INNER_PRESSURE], s[OUTER_PRESSURE]
    h, _, ways, _, _, _ = state(f, s, x)
    for k in range(angles):
        total, reached = np.sum(1.0 / ways[k]), 0.0
        for j in range(cells):
            reached += 1.0 / (ways[k, j] * total)
            x[k * cells + j] = h[k, j + 1] * (p_i * p_i + reached * (p_o * p_o - p_i * p_i)) ** 0.5


@outer_kernel()
def start(f, s, x):
    """Unknowns `x` (n,) of the steady film at a gap state: p h_t + wm d(p h)/dtheta = what flows in.  A film that opens
    so fast that it would be drawn empty keeps the least pressure.  Returns 0, or a code where none is found."""
    angles, cells = int(f[ANGLES]), int(f[CELLS])
    x[:] = 0.0
    _first(f, s, x)
    h, h_rate = np.empty((angles, cells + 2)), np.empty((angles, cells))
    thicknesses(f, s, h, np.empty(angles))
    thickness_rates(f, s, h, h_rate)
    left, rows, (band, y) = np.empty(len(x)), np.empty((len(x), 5)), room(angles, cells)
    width = band.shape[1] // 2
    far, strayed, low = True, False, min(s[INNER_PRESSURE], s[OUTER_PRESSURE])
    for _ in range(MOST_STEPS):
        now = state(f, s, x)
        rates(f, s, x, *now, left)
        # Where no pressure is left, a flow does not know its slope.
        _, p, ways, slips, ways_around, slips_around = now
        slopes(f, s, h, np.maximum(p, SLOPED * low), ways, slips, ways_around, slips_around, rows)
        band[:] = 0.0
        for k in range(angles):
            before, after = neighbours(k, angles)
            here = place(k, angles) * cells
            to_before, to_after = place(before, angles) * cells - here, place(after, angles) * cells - here
            for j in range(cells):
                i, at = k * cells + j, here + j
                squeezed = h_rate[k, j] / h[k, j + 1]
                y[at] = left[i] - squeezed * x[i]
                # Far below its pressure a film that closes would be driven farther down by what closing has of it.
                band[at, width] = (max(squeezed, 0.0) if far else squeezed) - rows[i, OWN]
                if j > 0:
                    band[at, width - 1] -= rows[i, INNER]
                if j < cells - 1:
                    band[at, width + 1] -= rows[i, OUTER]
                band[at, width + to_after] -= rows[i, AFTER]
                band[at, width + to_before] -= rows[i, BEFORE]
        if not eliminate(band, y):
            return UNSOLVED
        change = highest = 0.0
        for k in range(angles):
            for j in range(cells):
                i, before = k * cells + j, x[k * cells + j]
                x[i] = max(before + y[place(k, angles) * cells + j], NEAREST * before, LEAST * low * h[k, j + 1])
                change = max(change, abs(x[i] - before) / h[k, j + 1])
                highest = max(highest, x[i] / h[k, j + 1])
        if not change < np.inf:
            return UNSOLVED
        if change < ARRIVED * highest:
            return 0
        # Once has shown whether it may count.
        strayed |= not far and change > NEAR * highest
        far = strayed or change > NEAR * highest
    return UNSOLVED
