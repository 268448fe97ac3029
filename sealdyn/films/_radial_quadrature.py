"""What the radial films share: their parameter block, their Gauss rules over the radius, a radial line of Reynolds'
equation, and the pressure over the face.

**Source** Reynolds' equation along a radius, as in radial/film.py:

    r h^3 p' = 12 mu (Phi + c),   Phi = integral of f r dr,   f = dh/dt + wm dh/dtheta

(planar: no r; inertia adds g r to p'), integrated from each radius of the grid to the next by the Gauss rule that
serves the film ratio between them: how fine the grid is does not matter to the pressures on it.
**Valid** where these films are; between faces without waves.
"""

import math
from functools import lru_cache

import numpy as np

from ..faces.film_thickness import film_thickness
from ..faces.geometry import (
    CAVITATED,
    CONING_RATE,
    DZ_RATE,
    FACE_SIZE,
    FLOOR,
    FLOW_INNER,
    FLOW_OUTER,
    FORCE,
    GAP_STATE_SIZE,
    GX,
    GX_RATE,
    GY,
    GY_RATE,
    INNER_PRESSURE,
    INNER_RADIUS,
    MEAN_SPIN,
    MOMENT_X,
    MOMENT_Y,
    OUTER_PRESSURE,
    OUTER_RADIUS,
    PLANAR,
    PROFILE,
    PROFILE_RADII,
    SPIN_DIFFERENCE,
    TILT_AT_MEAN,
    TORQUE,
    VISCOSITY,
    face_parameters,
    regularised_thickness,
)
from ..numerics.kernel import inner_kernel, outer_kernel
from ._contract import force_over_clearance

# Gauss rules offered.
RADIAL_POINTS = (4, 8, 12, 16, 24, 32)
# Angle counts offered are divisors of the longest table.
MOST_ANGLES = 3072
ANGLES = (8, 12, 16, 24, 32, 48, 64, 96, 128, 192, 256, 384, 512, 768, 1536, 3072)

# Cosines and sines of the half circle, and how often each of its angles is met on the whole one.
HALF_CIRCLE = tuple(
    function(2 * np.pi * np.arange(MOST_ANGLES // 2 + 1) / MOST_ANGLES) for function in (np.cos, np.sin)
)
TWICE = np.array([1.0, *(MOST_ANGLES // 2 - 1) * [2.0], 1.0])

# At the floor the film's law has a bend of second order, of which the trapezoid leaves LOW/N^3 of the load; and by how
# many powers of e each Gauss point of a panel between two bends gains (bent_angles in radial/film.py).
LOW, PANEL_GAIN = 10.0, 2.88

# Block layout after the faces; INERTIA is the density (kg/m^3) of a film with inertia, else 0.
CAVITATION, HAS_CAVITATION, INERTIA, LOG_ERROR, LOW_ANGLES, PANEL_RULE, ERROR, RULES = range(FACE_SIZE, FACE_SIZE + 8)
RULE_SIZE = 2 + 2 * RADIAL_POINTS[-1]
ANGLE_COUNTS = RULES + RULE_SIZE * len(RADIAL_POINTS)
COSINES = ANGLE_COUNTS + len(ANGLES)
SINES = COSINES + MOST_ANGLES // 2 + 1
WEIGHTS = SINES + MOST_ANGLES // 2 + 1
BLOCK_SIZE = WEIGHTS + MOST_ANGLES // 2 + 1


@lru_cache(maxsize=16)
def gauss(points: int) -> tuple[np.ndarray, np.ndarray]:
    """Gauss-Legendre points and weights, each (points,), on [-1, 1]."""
    return np.polynomial.legendre.leggauss(points)


# ln of the film ratios at which the rules are tried.
TRIED = np.linspace(0.0, 12.0, 241)


@lru_cache(maxsize=64)
def _rule_errors(radius_ratio: float) -> np.ndarray:
    """Worst relative error of the radial integrals, (rules, film ratios tried), of a film ratio or its inverse and of
    anything flatter."""
    q = np.exp(0.25 * np.concatenate([TRIED, -TRIED]))[:, None]
    t = (q - 1) / (q + 1)

    def moments(n):
        x, w = gauss(n)
        u = (1 + t * x) / (1 - t * x)
        y = 0.5 * (1 + x) * (1 - t) / (1 - t * x) * (u + 1 / q) / (q + 1 / q)
        dy = u * (1 - t * t) / (1 - t * x) ** 2 / (q + 1 / q)
        r = radius_ratio + (1 - radius_ratio) * y
        weight = w * dy / u**6
        powers = [r**k * y**j for k in (-1, 1, 2) for j in (0, 1, 2, 3)]
        return np.stack([np.sum(weight * power, axis=1) for power in powers])

    exact = moments(64)
    worst = [np.max(np.abs(moments(n) / exact - 1), axis=0).reshape(2, -1).max(axis=0) for n in RADIAL_POINTS]
    return np.maximum.accumulate(np.array(worst), axis=1)


@lru_cache(maxsize=64)
def _rules(radius_ratio: float, error: float) -> np.ndarray:
    """The block's Gauss rules: for each, its count, the largest film ratio (or its inverse) it may serve at
    this error, points and weights.  The limit is found by trying, so no error constant is guessed."""
    rows = []
    for points, errors in zip(RADIAL_POINTS, _rule_errors(radius_ratio), strict=True):
        # Force and moments are differences of these integrals: measured up to 100 times worse.
        serves = int(np.searchsorted(errors, max(error / 200, 3e-15)))
        x, w = gauss(points)
        row = np.zeros(RULE_SIZE)
        # A rule that cannot even serve flat faces gets a limit below one.
        row[:2] = points, math.exp(TRIED[serves - 1]) if serves else math.exp(-1.0)
        row[2 : 2 + points] = x
        row[2 + RADIAL_POINTS[-1] : 2 + RADIAL_POINTS[-1] + points] = w
        rows.append(row)
    return np.concatenate(rows)


def parameters(film, clearance: float, error: float = 1e-8) -> np.ndarray:
    """The film's block of the parameter array, shape (BLOCK_SIZE,).

    `film` a Film table, `clearance` design clearance at the inner radius (m), `error` relative error allowed to the
    quadrature of force and moments; points and angles follow it and the gap.
    """
    f = np.zeros(BLOCK_SIZE)
    f[:FACE_SIZE] = face_parameters(film, clearance)
    if film.cavitation_pressure is not None:
        f[CAVITATION], f[HAS_CAVITATION] = film.cavitation_pressure, 1.0
    f[INERTIA] = film.density if film.inertia else 0.0
    f[ERROR] = error = min(max(error, 1e-14), 1e-2)
    f[LOG_ERROR] = math.log(1e4 / error)
    f[LOW_ANGLES] = (LOW / (10.0 * error)) ** (1.0 / 3.0)
    wanted = int(np.searchsorted(RADIAL_POINTS, f[LOG_ERROR] / PANEL_GAIN))
    f[PANEL_RULE] = RULES + RULE_SIZE * min(wanted, len(RADIAL_POINTS) - 1)
    # Of a floored line a small part may be left: a tenth of the error is asked of its radial integrals.
    share = 0.1 if f[HAS_CAVITATION] else 1.0
    f[RULES:ANGLE_COUNTS] = _rules(film.inner_radius / film.outer_radius, share * error)
    f[ANGLE_COUNTS:COSINES] = ANGLES
    (f[COSINES:SINES], f[SINES:WEIGHTS]), f[WEIGHTS:BLOCK_SIZE] = HALF_CIRCLE, TWICE
    return f


def opening_law(parameters, wrench, film, mean_spin=0.0, spin_difference=0.0):
    """The function `opening_law` of a radial film's contract (N, m, Pa, rad/s), from the film's `parameters` and kernel
    `wrench`."""
    s = np.zeros(GAP_STATE_SIZE)
    s[VISCOSITY], s[MEAN_SPIN], s[SPIN_DIFFERENCE] = 1.0, mean_spin, spin_difference
    return force_over_clearance(film, parameters(film, 1.0, 1e-13), s, wrench)


@inner_kernel()
def centrifugal(f, s):
    """Slope over r^2/2 (Pa/m^2) of the pressure that turns the fluid: p' of a film without inertia gains g r.

    **Source** the radial momentum of Couette flow, u = r (W_s + (W_r - W_s) y) at y = z/h, pushes outwards as a flow of
    6 int y (1 - y) rho u^2/r dy = rho r (3 W_s^2 + 4 W_s W_r + 3 W_r^2)/10 = rho r (wm^2 + (W_r - W_s)^2/20) would.
    **Valid** laminar, small h^2 rho W / mu: squeeze and the flow's own radial momentum are left out.
    """
    if f[INERTIA] == 0.0:
        return 0.0
    return f[INERTIA] * (s[MEAN_SPIN] * s[MEAN_SPIN] + 0.05 * s[SPIN_DIFFERENCE] * s[SPIN_DIFFERENCE])


@inner_kernel()
def points_for(f, h_i, h_o):
    """Index of the Gauss rule that serves the film ratio between h_i and h_o (m, or any unit); `f` the film's block."""
    ratio = h_o / h_i if h_o > h_i else h_i / h_o
    for rule in range(len(RADIAL_POINTS) - 1):
        if ratio <= f[RULES + rule * RULE_SIZE + 1]:
            return rule
    return len(RADIAL_POINTS) - 1


@inner_kernel()
def rule_at(f, rule):
    """Points and weights, each (points,), on [-1, 1] of a Gauss rule (index); `f` the film's block."""
    slot = RULES + RULE_SIZE * rule
    points, weights = int(f[slot]), slot + 2 + RADIAL_POINTS[-1]
    return f[slot + 2 : slot + 2 + points], f[weights : weights + points]


@inner_kernel()
def write_circle(f, s, frame, g, d_beta, sums, complete):
    """Write the gap state's force and moments, with `complete` its flows and torque too: `sums` over half the circle
    in steps of `d_beta` (rad) of the force, the even and the odd moment, the flows at both edges, the shear and the
    pressure on the slope; `frame` of `tilt_frame`, `g` of `centrifugal`.  Returns the torque's part that the pressure
    has on the slope of the film."""
    tilt, c_a, s_a, _, across = frame
    force, moment_even, moment_odd, flow_i, flow_o, drag, twist = sums
    r_i, r_o, mu, r_m = f[INNER_RADIUS], f[OUTER_RADIUS], s[VISCOSITY], 0.5 * (f[INNER_RADIUS] + f[OUTER_RADIUS])
    p_i, p_o = s[INNER_PRESSURE] - 0.5 * g * r_i * r_i, s[OUTER_PRESSURE] - 0.5 * g * r_o * r_o
    m_along, m_across = 4.0 * mu * d_beta * moment_even, -4.0 * mu * across * d_beta * moment_odd
    s[FORCE] = math.pi * (p_o * r_o * r_o - p_i * r_i * r_i) - 6.0 * mu * d_beta * force
    s[FORCE] += 0.25 * math.pi * g * (r_o**4 - r_i**4)
    s[MOMENT_X], s[MOMENT_Y] = c_a * m_along - s_a * m_across, s_a * m_along + c_a * m_across
    s[CAVITATED] = 0.0
    if not complete:
        return 0.0
    # The planar face is a strip of the mean circumference: what flows in flows out.
    s[FLOW_INNER] = flow_i * d_beta * (r_m if f[PLANAR] != 0.0 else 1.0)
    s[FLOW_OUTER] = flow_o * d_beta * (r_m if f[PLANAR] != 0.0 else 1.0)
    # Couette drag, and the pressure pushing on the slope of the film (by parts: no dp/dtheta needed).
    pressure_part = -3.0 * mu * across * d_beta * twist * r_m if f[TILT_AT_MEAN] != 0.0 else 0.5 * m_across
    s[TORQUE] = mu * s[SPIN_DIFFERENCE] * d_beta * drag + tilt * pressure_part
    return tilt * pressure_part


@inner_kernel()
def relative_clearance(h, swing):
    """Mean film `h` over its `swing` around the circle, in one unit: 1 where the faces meet, 0 for a film closed
    somewhere, 1e9 without a swing."""
    if h <= swing:
        return 0.0
    return h / swing if swing > 0.0 else 1e9


@inner_kernel()
def angle_count(f, ratio, bent):
    """Number of angles for a `ratio` of mean film to swing, `bent` where the film meets its floor somewhere; `f` the
    film's block.  The trapezoid's error falls as exp(-N eta), cosh(eta) = ratio.
    **Source** Trefethen & Weideman (2014), SIAM Review 56, 385: trapezoidal rule of periodic analytic functions."""
    wanted = f[LOG_ERROR] / math.acosh(ratio if ratio < 1e9 else 1e9) if ratio > 1.0 else MOST_ANGLES / 8
    if bent and wanted < f[LOW_ANGLES]:
        wanted = f[LOW_ANGLES]
    for i in range(len(ANGLES)):
        if f[ANGLE_COUNTS + i] >= wanted:
            return int(f[ANGLE_COUNTS + i])
    return MOST_ANGLES


@inner_kernel()
def line_sums(q0, q, r_i, planar, a, b, h_a, h_b, x_k, w_k):
    """Integrals of Q/h^3, r^2 Q/h^3, r^3 Q/h^3 (over r unless planar) from d = a to b, films h_a to h_b; then
    the same three of 1/h^3."""
    h_g = math.sqrt(h_a * h_b)
    root = math.sqrt(h_g / h_a)
    t, u_a, u_s = (root - 1.0) / (root + 1.0), 1.0 / root, 1.0 / (root + 1.0 / root)
    per_h, span = 1.0 / h_g, b - a
    scale = span * (1.0 - t * t) * u_s * per_h**3
    reach = 0.5 * (1.0 - t) * u_s * span
    p_0 = p_2 = p_3 = e_0 = e_2 = e_3 = 0.0
    for k in range(len(x_k)):
        tx = t * x_k[k]
        both = 1.0 / ((1.0 - tx) * (1.0 + tx))
        back = (1.0 + tx) * both
        u, v = (1.0 + tx) * back, (1.0 - tx) * (1.0 - tx) * both
        d = a + reach * (1.0 + x_k[k]) * back * (u + u_a)
        r = r_i + d
        weight = w_k[k] * scale * back * back * v**5
        unit = weight if planar else weight / r
        slope = unit * (q0 + d * (q[0] + d * (q[1] + d * q[2])))
        p_0 += slope
        p_2 += slope * r * r
        p_3 += slope * r**3
        e_0 += unit
        e_2 += unit * r * r
        e_3 += unit * r**3
    return p_0, p_2, p_3, e_0, e_2, e_3


@inner_kernel()
def cubic(z_rate, tilt_rate, r_i, r_o, mean, planar):
    """Coefficients of d, d^2, d^3 in `Phi = int f r dr` (planar: `int f dr`), and the d where f changes sign
    (-1: nowhere)."""
    if mean:
        rate = z_rate + tilt_rate * 0.5 * (r_i + r_o)
        return ((rate, 0.0, 0.0) if planar else (rate * r_i, 0.5 * rate, 0.0)), -1.0
    rate = z_rate + tilt_rate * r_i
    turn = -rate / tilt_rate if tilt_rate != 0.0 else -1.0
    if planar:
        return (rate, 0.5 * tilt_rate, 0.0), turn
    return (rate * r_i, 0.5 * (rate + tilt_rate * r_i), tilt_rate / 3.0), turn


# Steps over the radius, at least, and angles of the grid.
FIELD_STEPS, FIELD_ANGLES = 16, 48


def _radii(f):
    """Radii (m) between which the film thickness is linear (both edges, or those of the profile), how many equal steps
    lie between each and the next, and the radii (m) of the grid."""
    nodes = f[[INNER_RADIUS, OUTER_RADIUS]]
    if f[PROFILE] != 0.0:
        nodes = f[PROFILE_RADII : PROFILE_RADII + int(f[PROFILE])].copy()
    widths = np.diff(nodes)
    steps = np.ceil(FIELD_STEPS * widths / (nodes[-1] - nodes[0]) - 1e-9).astype(np.int64)
    parts = [a + width * np.arange(n) / n for a, width, n in zip(nodes, widths, steps, strict=False)]
    return nodes, steps, np.concatenate([*parts, nodes[-1:]])


def grid(f):
    """Radii (m) of the grid, edges and nodes of a profile among them, and its angles (rad)."""
    return _radii(f)[2], 2.0 * math.pi / FIELD_ANGLES * np.arange(FIELD_ANGLES)


@inner_kernel()
def _thicknesses(f, s, nodes, steps, theta, h):
    """Film thickness `h` (radii,) at one angle, m; below the floor as the film's force sees it."""
    at, here = 0, 0.0
    for n in range(len(nodes)):
        there = regularised_thickness(film_thickness(f, s, nodes[n], theta), f[FLOOR])
        for i in range(steps[n - 1] if n > 0 else 0):
            h[at], at = here + (there - here) * i / steps[n - 1], at + 1
        here = there
    h[at] = here


def fields(f, s, out):
    """Pressure (Pa, absolute) of a gap state `s` on the grid, `out` (1, radii, angles); with the film's floor where it
    has one."""
    _pressure(f, s, *_radii(f), out[0])


@outer_kernel()
def _pressure(f, s, nodes, steps, r, out):
    """As `fields`, `out` (radii, angles), at the radii `r` (m): `steps` of them from one of the `nodes` to the next."""
    mean, planar = f[TILT_AT_MEAN] != 0.0, f[PLANAR] != 0.0
    per, p_i, p_o, g = 12.0 * s[VISCOSITY], s[INNER_PRESSURE], s[OUTER_PRESSURE], centrifugal(f, s)
    # Integrals of Phi / (r h^3) and of 1 / (r h^3) from the inner radius.
    h, driven, through = np.empty(len(r)), np.zeros(len(r)), np.zeros(len(r))
    for j in range(FIELD_ANGLES):
        theta = 2.0 * math.pi / FIELD_ANGLES * j
        sin, cos = math.sin(theta), math.cos(theta)
        _thicknesses(f, s, nodes, steps, theta, h)
        tilt_rate = s[GX_RATE] * sin - s[GY_RATE] * cos + s[MEAN_SPIN] * (s[GX] * cos + s[GY] * sin)
        # A cone that grows is a tilting of every radius alike.
        tilt_rate += s[CONING_RATE]
        q, _ = cubic(s[DZ_RATE] - s[CONING_RATE] * r[0], tilt_rate, r[0], r[-1], mean, planar)
        for k in range(1, len(r)):
            x_k, w_k = rule_at(f, points_for(f, h[k - 1], h[k]))
            part = line_sums(0.0, q, r[0], planar, r[k - 1] - r[0], r[k] - r[0], h[k - 1], h[k], x_k, w_k)
            driven[k], through[k] = driven[k - 1] + part[0], through[k - 1] + part[3]
        c = ((p_o - p_i - 0.5 * g * (r[-1] ** 2 - r[0] ** 2)) / per - driven[-1]) / through[-1]
        for k in range(len(r)):
            p = p_i + per * (driven[k] + c * through[k]) + 0.5 * g * (r[k] ** 2 - r[0] ** 2)
            out[k, j] = max(p, f[CAVITATION]) if f[HAS_CAVITATION] != 0.0 else p
