"""Radial film between faces of any profile: Reynolds' equation solved exactly over the radius at every angle.

**Source** the moment integrals of the radial film (films/radial/film.py),

    r h^3 p' = 12 mu (Phi + c),   Phi = integral of f r dr,   f = dh/dt + wm dh/dtheta

(planar: no r).  Phi does not ask for the shape of the faces; only 1/h^3 does, and its integrals are sums over the
pieces of the radius between which h is linear.
**Valid** narrow and moderately wide faces, incompressible, laminar; no pressure flow around the circle; faces whose
shape is the same all around; no cavitation.

The gap is linear in r between the radii of the profile, piece by piece.
Gauss points in r where a piece's film ratio is small, as it is for many pieces: all that depends on the radius alone is
then known before the circle is walked.  Where that would take too many, points in the rational stand-in for ln h of the
radial film (films/radial/film.py).  Each piece has the shortest rule that serves it at the thinnest and at the thickest
angle.
"""

import math
from functools import lru_cache, partial

import numpy as np

from ...faces.geometry import (
    CLEARANCE,
    CONING,
    CONING_CHANGE,
    CONING_RATE,
    DZ,
    DZ_RATE,
    FLOOR,
    INNER_PRESSURE,
    INNER_RADIUS,
    OUTER_PRESSURE,
    OUTER_RADIUS,
    PLANAR,
    PROFILE,
    PROFILE_DEPTHS,
    PROFILE_RADII,
    TILT_AT_MEAN,
    VISCOSITY,
    regularised_thickness,
    tilt_frame,
)
from ...numerics.kernel import inner_kernel, value_kernel
from .. import _radial_quadrature
from .._contract import PRESSURE, Film
from .._radial_quadrature import (
    COSINES,
    ERROR,
    MOST_ANGLES,
    RADIAL_POINTS,
    RULE_SIZE,
    RULES,
    SINES,
    angle_count,
    centrifugal,
    fields,
    gauss,
    grid,
    points_for,
    relative_clearance,
    rule_at,
    write_circle,
)
from . import OFFER

# Behind the radial film's block: the largest film ratios of a piece that the rules serve with points in r.
PLAIN = _radial_quadrature.BLOCK_SIZE
BLOCK_SIZE = PLAIN + len(RADIAL_POINTS)
# A point in r costs so much less than a rational one.
CHEAPER = 4
# ln of the film ratios at which points in r are tried.
TRIED = np.linspace(0.0, 3.5, 351)

# Rows of the nodes: distance from r_i, arm of the tilt, film of the aligned faces (m).
D, ARM, ALIGNED = range(3)
# Rows of the pieces (between a node and the next): index of the rule, whether its points are in r, its first point.
RULE, IN_R, FIRST = range(3)
# Rows of the points: radius, integrals of 1 and of the arm (r dr; planar: dr), arm and film of the aligned faces,
# weight (over r; planar: weight), weight over h^3, film at this angle.
R, PHI_0, PHI_1, POINT_ARM, POINT_ALIGNED, UNIT, A, H = range(8)
TABLE = 8


@lru_cache(maxsize=64)
def plain_ratios(radius_ratio: float, error: float) -> tuple[float, ...]:
    """Largest film ratio (or its inverse) that each rule (rules,) serves with points in r at this relative error, 0 if
    none; found by trying.  `radius_ratio` inner over outer radius of the widest piece."""
    q = np.exp(np.concatenate([TRIED, -TRIED]))[:, None]

    def moments(n):
        x, w = gauss(n)
        y = 0.5 * (1 + x)
        r, weight = radius_ratio + (1 - radius_ratio) * y, w / (1 + (q - 1) * y) ** 3
        return np.stack([np.sum(weight * r**k * y**j, axis=1) for k in (-1, 1, 2) for j in range(4)])

    exact, found = moments(96), []
    for n in RADIAL_POINTS:
        off = np.max(np.abs(moments(n) / exact - 1), axis=0).reshape(2, -1).max(axis=0)
        # As in the radial film's rules: force and moments are differences of these integrals.
        serves = int(np.searchsorted(np.maximum.accumulate(off), max(error / 200, 3e-15)))
        found.append(math.exp(TRIED[serves - 1]) if serves else 0.0)
    return tuple(found)


@inner_kernel()
def nodes_of(f, s):
    """The radii of the profile: rows named above (m), (3, radii), at a gap state."""
    r_i, count, mean = f[INNER_RADIUS], int(f[PROFILE]), f[TILT_AT_MEAN] != 0.0
    nodes, coning = np.empty((3, count)), f[CONING] + s[CONING_CHANGE]
    for n in range(count):
        r = f[PROFILE_RADII + n]
        nodes[D, n], nodes[ARM, n] = r - r_i, 0.5 * (r_i + f[OUTER_RADIUS]) if mean else r
        nodes[ALIGNED, n] = f[CLEARANCE] + s[DZ] + coning * (r - r_i) + f[PROFILE_DEPTHS + n]
    return nodes


@inner_kernel()
def pieces_of(f, nodes, tilt):
    """The pieces: rows named above, (3, pieces); the number of points and of angles, and whether any film is below the
    floor.  `nodes` (3, radii), `tilt` (rad)."""
    floor, room, low, bent, total = f[FLOOR], 1e9, False, False, 0
    pieces = np.zeros((3, nodes.shape[1] - 1), np.int64)
    last_thin = last_thick = 0.0
    for n in range(nodes.shape[1]):
        h, swing = nodes[ALIGNED, n], nodes[ARM, n] * tilt
        room = min(room, relative_clearance(h, swing))
        low, bent = low or h - swing < floor, bent or abs(h - floor) < swing
        thin, thick = regularised_thickness(h - swing, floor), regularised_thickness(h + swing, floor)
        if n > 0:
            ratio = max(thin / last_thin, last_thin / thin, thick / last_thick, last_thick / thick)
            rational, plain = points_for(f, 1.0, ratio), 0
            while plain < len(RADIAL_POINTS) and f[PLAIN + plain] < ratio:
                plain += 1
            points = int(f[RULES + RULE_SIZE * rational])
            in_r = plain < len(RADIAL_POINTS) and f[RULES + RULE_SIZE * plain] <= CHEAPER * points
            piece = pieces[:, n - 1]
            piece[RULE], piece[IN_R], piece[FIRST] = plain if in_r else rational, in_r, total
            total += int(f[RULES + RULE_SIZE * piece[RULE]])
        last_thin, last_thick = thin, thick
    return pieces, total, angle_count(f, room, bent), low


@inner_kernel()
def phi(d, r_i, r_m, mean, planar):
    """Integrals of 1 and of the tilt's arm from r_i to r_i + d (m), over r dr (m^2, m^3; planar: over dr, m, m^2);
    `mean`: the arm is r_m everywhere."""
    if planar:
        phi_0, phi_1 = d, d * (r_i + 0.5 * d)
    else:
        phi_0, phi_1 = d * (r_i + 0.5 * d), d * (r_i * r_i + d * (r_i + d * (1.0 / 3.0)))
    return phi_0, r_m * phi_0 if mean else phi_1


@inner_kernel()
def lay_in_r(f, nodes, pieces, table):
    """Fill the rows of `table` (TABLE, points) that do not depend on the angle, for the pieces with points in r; the
    others get a film of 1."""
    r_i, r_m, mean, planar = f[INNER_RADIUS], 0.5 * (f[INNER_RADIUS] + f[OUTER_RADIUS]), f[TILT_AT_MEAN], f[PLANAR]
    table[POINT_ALIGNED], table[POINT_ARM], table[UNIT] = 1.0, 0.0, 1.0
    for n in range(pieces.shape[1]):
        if not pieces[IN_R, n]:
            continue
        width, (x, w) = nodes[D, n + 1] - nodes[D, n], rule_at(f, pieces[RULE, n])
        for i in range(len(x)):
            k, y = pieces[FIRST, n] + i, 0.5 * (1.0 + x[i])
            d = nodes[D, n] + y * width
            table[R, k] = r_i + d
            table[PHI_0, k], table[PHI_1, k] = phi(d, r_i, r_m, mean != 0.0, planar != 0.0)
            table[POINT_ARM, k] = nodes[ARM, n] + y * (nodes[ARM, n + 1] - nodes[ARM, n])
            table[POINT_ALIGNED, k] = nodes[ALIGNED, n] + y * (nodes[ALIGNED, n + 1] - nodes[ALIGNED, n])
            table[UNIT, k] = 0.5 * w[i] * width / (1.0 if planar != 0.0 else r_i + d)


@inner_kernel()
def _rational(table, first, d_a, width, h_a, h_b, r_i, r_m, mean, planar, x, w):
    """The points of one piece at one angle, in the radial film's rational rule."""
    h_g = math.sqrt(h_a * h_b)
    q = math.sqrt(h_g / h_a)
    t, u_a, u_s = (q - 1.0) / (q + 1.0), 1.0 / q, 1.0 / (q + 1.0 / q)
    per_h = 1.0 / h_g
    scale, reach = width * (1.0 - t * t) * u_s * per_h**3, 0.5 * (1.0 - t) * u_s * width
    for i in range(len(x)):
        k, tx = first + i, t * x[i]
        back, fore = 1.0 / (1.0 - tx), 1.0 / (1.0 + tx)
        u, v = (1.0 + tx) * back, (1.0 - tx) * fore
        d = d_a + reach * (1.0 + x[i]) * back * (u + u_a)
        weight = w[i] * scale * back * back * v**5
        table[R, k], table[H, k] = r_i + d, h_g * u * u
        table[A, k] = weight if planar else weight / (r_i + d)
        table[PHI_0, k], table[PHI_1, k] = phi(d, r_i, r_m, mean, planar)


@inner_kernel()
def _films(table, tilt_cos):
    for k in range(table.shape[1]):
        h = table[POINT_ALIGNED, k] - table[POINT_ARM, k] * tilt_cos
        per = 1.0 / h
        table[H, k], table[A, k] = h, table[UNIT, k] * (per * per * per)


@inner_kernel()
def at_angle(f, nodes, pieces, table, tilt_cos, low):
    """Film (m) and weight over its cube at every point of `table` (TABLE, points), at one angle: `tilt_cos` (rad) the
    tilt times cos(beta); `low`: some films are below the floor."""
    _films(table, tilt_cos)
    r_i, r_m, mean, planar = f[INNER_RADIUS], 0.5 * (f[INNER_RADIUS] + f[OUTER_RADIUS]), f[TILT_AT_MEAN], f[PLANAR]
    for n in range(pieces.shape[1]):
        if not low and pieces[IN_R, n]:
            continue
        h_a = regularised_thickness(nodes[ALIGNED, n] - nodes[ARM, n] * tilt_cos, f[FLOOR])
        h_b = regularised_thickness(nodes[ALIGNED, n + 1] - nodes[ARM, n + 1] * tilt_cos, f[FLOOR])
        first, (x, w) = pieces[FIRST, n], rule_at(f, pieces[RULE, n])
        if pieces[IN_R, n]:
            for i in range(len(x)):
                h = h_a + 0.5 * (1.0 + x[i]) * (h_b - h_a)
                table[H, first + i], table[A, first + i] = h, table[UNIT, first + i] / (h * h * h)
        else:
            width = nodes[D, n + 1] - nodes[D, n]
            _rational(table, first, nodes[D, n], width, h_a, h_b, r_i, r_m, mean != 0.0, planar != 0.0, x, w)


@inner_kernel()
def sums(table, z_rate, even):
    """Nine integrals over a radius, of weight over h^3: times 1, Phi's even and Phi's odd part; the three with r^2;
    with r^3.  `z_rate` (m/s) and `even` (rad/s) make Phi's even part."""
    a0 = ae = a1 = b0 = be = b1 = c0 = ce = c1 = 0.0
    for k in range(table.shape[1]):
        a, r, phi_1 = table[A, k], table[R, k], table[PHI_1, k]
        phi = z_rate * table[PHI_0, k] - even * phi_1
        b = a * r * r
        c = b * r
        a0 += a
        ae += a * phi
        a1 += a * phi_1
        b0 += b
        be += b * phi
        b1 += b * phi_1
        c0 += c
        ce += c * phi
        c1 += c * phi_1
    return a0, ae, a1, b0, be, b1, c0, ce, c1


@inner_kernel()
def drag(table, planar):
    """Integral of r^3 / h (m^3) over a radius."""
    total = 0.0
    for k in range(table.shape[1]):
        r, h = table[R, k], table[H, k]
        total += table[A, k] * h * h * r**3 * (1.0 if planar else r)
    return total


def accepts(film, waves=()) -> str:
    """What faces it takes, "" if it can take these."""
    return "faces that are the same all around" if waves else ""


def parameters(film, clearance: float, error: float = 1e-8) -> np.ndarray:
    """The film's block of the parameter array, shape (BLOCK_SIZE,).

    `film` a Film table, `clearance` design clearance at the inner radius where the profile is 0 (m), `error` relative
    error allowed to the quadrature of force and moments; points and angles follow it and the gap.
    """
    f = np.zeros(BLOCK_SIZE)
    f[:PLAIN] = _radial_quadrature.parameters(film, clearance, error)
    if f[PROFILE] == 0.0:
        f[PROFILE], f[PROFILE_RADII], f[PROFILE_RADII + 1] = 2, film.inner_radius, film.outer_radius
    r = f[PROFILE_RADII : PROFILE_RADII + int(f[PROFILE])]
    f[PLAIN:] = plain_ratios(float(np.min(r[:-1] / r[1:])), float(f[ERROR]))
    return f


@inner_kernel()
def _circle(f, s, complete):
    """Integrate over the face.  `complete` asks for leakage and friction torque too."""
    r_i, r_o, mean, planar = f[INNER_RADIUS], f[OUTER_RADIUS], f[TILT_AT_MEAN] != 0.0, f[PLANAR] != 0.0
    mu, p_i, p_o, r_m = s[VISCOSITY], s[INNER_PRESSURE], s[OUTER_PRESSURE], 0.5 * (r_i + r_o)
    # A cone that grows is a tilting of every radius alike.
    cone_rate = s[CONING_RATE]
    z_rate = s[DZ_RATE] - cone_rate * r_i
    # In p - g r^2/2 the film is one without inertia.
    g = centrifugal(f, s)
    p_i, p_o = p_i - 0.5 * g * r_i * r_i, p_o - 0.5 * g * r_o * r_o

    # In the frame of the tilt f is even part + odd part.
    frame = tilt_frame(s)
    tilt, along = frame[0], frame[3]

    nodes = nodes_of(f, s)
    pieces, points, angles, low = pieces_of(f, nodes, tilt)
    table = np.empty((TABLE, points))
    lay_in_r(f, nodes, pieces, table)
    whole_0, whole_1 = phi(r_o - r_i, r_i, r_m, mean, planar)
    stride, drive = MOST_ANGLES // angles, (p_o - p_i) / (12.0 * mu)

    force = moment_even = moment_odd = flow_i = flow_o = couette = twist = 0.0
    for j in range(angles // 2 + 1):
        cos_b, sin_b = f[COSINES + j * stride], f[SINES + j * stride]
        at_angle(f, nodes, pieces, table, tilt * cos_b, low)
        even = along * cos_b - cone_rate
        a0, ae, a1, b0, be, b1, c0, ce, c1 = sums(table, z_rate, even)
        edge, edge_odd = (drive - ae) / a0, -a1 / a0
        twice = 1.0 if j == 0 or 2 * j == angles else 2.0
        force += twice * (be + edge * b0)
        moment_even += twice * cos_b * (ce + edge * c0)
        moment_odd += twice * sin_b * sin_b * (c1 + edge_odd * c0)
        if complete:
            flow_i -= twice * edge
            flow_o -= twice * (edge + z_rate * whole_0 - even * whole_1)
            couette += twice * drag(table, planar)
            twist += twice * sin_b * sin_b * (b1 + edge_odd * b0)

    d_beta = 2.0 * math.pi / angles
    around = force, moment_even, moment_odd, flow_i, flow_o, couette, twist
    write_circle(f, s, frame, g, d_beta, around, complete)


@value_kernel()
def wrench(f, s):
    """Force (N) and moments (N m) of the film on the stator, from the gap state, into the gap state."""
    _circle(f, s, False)


@value_kernel()
def flow(f, s):
    """As `wrench`; also flow in +r (m^3/s) at both radii and the friction torque on the rotor (N m):
    `int [mu (W_r - W_s) r^3/h + (h/2) r dp/dtheta] dr dtheta`, what the shaft supplies."""
    _circle(f, s, True)


FILM = Film(
    **OFFER._asdict(),
    accepts=accepts,
    parameters=parameters,
    opening_law=partial(_radial_quadrature.opening_law, parameters, wrench),
    wrench=wrench,
    flow=flow,
    quantities=(PRESSURE,),
    grid=grid,
    fields=fields,
)
