"""Radial film: Reynolds' equation solved exactly over the radius at every angle, none around the circle.

**Source** Reynolds' equation without circumferential pressure flow, integrated by moment integrals:

    r h^3 p' = 12 mu (Phi + c),   Phi = integral of f r dr,   f = dh/dt + wm dh/dtheta
    int p r dr   = [p r^2 / 2] - 1/2 int r^2 p' dr,      int p r^2 dr = [p r^3 / 3] - 1/3 int r^3 p' dr

(the planar, narrow-seal variant drops r in the first line; inertia adds g r to p', `centrifugal`).  Force, moments and
leakage need only single integrals of powers of r over h^3; the trapezoidal rule around the circle is spectrally
accurate.
**Valid** narrow and moderately wide faces, incompressible, laminar; no pressure flow around the circle.

Two choices make it cheap.  The circle starts at the thinnest place, so that h is even in beta, the
half circle is enough and turning the tilt turns the moment to rounding.  And the Gauss points sit in

    h = h_g ((1 + t x)/(1 - t x))^2,   h_g^2 = h_i h_o,   t = (q - 1)/(q + 1),   q = (h_o/h_i)^(1/4)

a rational stand-in for "points in ln h": nothing but one root and divisions, no cancellation for flat
or diverging faces (t = 0, t < 0), and the nearest singularity of the integrand is at x = -1/t.

Between rough faces, which may meet, the law has a bend at its floor, where even angles would converge as slowly as
1/N^3: Gauss points between the bends, on panels no longer than their distance from where the law has a pole (in the
complex plane too).  The error falls as 4.2^(-2 n) with the points of a panel, however thin the film.
"""

import math
from dataclasses import replace
from functools import partial

import numpy as np
from numba import njit

from ...faces.geometry import (
    CONING_RATE,
    DZ_RATE,
    FLOOR,
    INNER_PRESSURE,
    INNER_RADIUS,
    OUTER_PRESSURE,
    OUTER_RADIUS,
    PLANAR,
    TILT_AT_MEAN,
    VISCOSITY,
    edges_of,
    regularised_thickness,
    tilt_frame,
)
from ...numerics.kernel import inner_kernel, value_kernel
from .. import _radial_quadrature
from .._contract import PRESSURE, Film
from .._radial_quadrature import (
    COSINES,
    MOST_ANGLES,
    PANEL_RULE,
    RADIAL_POINTS,
    SINES,
    angle_count,
    centrifugal,
    fields,
    grid,
    points_for,
    relative_clearance,
    rule_at,
    write_circle,
)
from . import OFFER

# Angles worked on side by side, and their rows: what their Gauss points need, and the integrals over 1/h^3 of 1, Phi's
# even and its odd part; the three with r^2; with r^3; the integral of r^3/h.
LANES, ROWS = 16, 16
ROW = SINES - COSINES
T, REACH, SCALE, U_I, H_G, EVEN, A0, AE, A1, B0, BE, B1, C0, CE, C1, D0 = range(ROWS)
# No panel between two bends of the law is shorter (rad).
SHORTEST = 1e-9


def accepts(film, waves=()) -> str:
    """What faces it takes, "" if it can take these."""
    return "plain cones only" if waves or (film is not None and film.profile is not None) else ""


def parameters(film, clearance: float, error: float = 1e-8) -> np.ndarray:
    """The film's block of the parameter array (films/_radial_quadrature.py).  Raises ValueError for a table with a
    floor of the pressure, which these kernels do not know."""
    if film.cavitation_pressure is not None:
        raise ValueError("a floor of the pressure is for films/radial/floored.py")
    return _radial_quadrature.parameters(film, clearance, error)


@inner_kernel()
def angles_for(f, h_i, h_o, swing_i, swing_o):
    """Number of angles for the edge that is nearer to touching: films and swings of `edges_of`."""
    inner, outer = relative_clearance(h_i, swing_i), relative_clearance(h_o, swing_o)
    return angle_count(f, inner if inner < outer else outer, False)


@njit(inline="always")
def _sums(at, lanes, x_k, w_k, r_i, r_m, z_rate, mean, planar, complete):
    """Add up the radial integrals of `lanes` angles side by side.  Inlined, the sizes of `at` are known and the inner
    loop fills vector registers; every angle's sum keeps the order of its points, so the result has the same bits with
    any vector unit (what fast-math would not keep)."""
    for i in range(A0, ROWS):
        for j in range(lanes):
            at[i, j] = 0.0
    for k in range(len(x_k)):
        x, w = x_k[k], w_k[k]
        for j in range(lanes):
            tx = at[T, j] * x
            fore, aft = 1.0 + tx, 1.0 - tx
            both = 1.0 / (fore * aft)
            back = fore * both
            u, v = fore * back, aft * aft * both
            d = at[REACH, j] * (1.0 + x) * back * (u + at[U_I, j])
            r = r_i + d
            weight = w * at[SCALE, j] * (back * back) * v**5
            if planar:
                phi_0, phi_1, a = d, d * (r_i + 0.5 * d), weight
            else:
                phi_0, phi_1 = d * (r_i + 0.5 * d), d * (r_i * r_i + d * (r_i + d * (1.0 / 3.0)))
                a = weight / r
            if mean:
                phi_1 = r_m * phi_0
            phi = z_rate * phi_0 - at[EVEN, j] * phi_1
            b = a * r * r
            c = b * r
            at[A0, j] += a
            at[AE, j] += a * phi
            at[A1, j] += a * phi_1
            at[B0, j] += b
            at[BE, j] += b * phi
            at[C0, j] += c
            at[CE, j] += c * phi
            at[C1, j] += c * phi_1
            if complete:
                h = at[H_G, j] * u * u
                at[B1, j] += b * phi_1
                at[D0, j] += weight * (h * h) * r**3


@njit(inline="always")
def _lines(at, lanes, width):
    """From the films at both edges (in rows U_I and H_G) what the Gauss points of each angle need."""
    for j in range(lanes):
        h_i, h_o = at[U_I, j], at[H_G, j]
        h_g = math.sqrt(h_i * h_o)
        q = math.sqrt(h_g / h_i)
        t, share = (q - 1.0) / (q + 1.0), width * q / (q * q + 1.0)
        at[H_G, j], at[T, j], at[U_I, j] = h_g, t, 1.0 / q
        at[SCALE, j] = (1.0 - t * t) * share / (h_g * h_g * h_g)
        at[REACH, j] = 0.5 * (1.0 - t) * share


@inner_kernel()
def circle(f, s, edges, nodes, first, stride, half, d_beta, complete):
    """Integrate over the face, between `edges_of` it, at `half` angles of half the circle.  `nodes` holds from `first`
    on, every `stride` slots, their cosines, ROW slots farther their sines and another ROW farther their weights, in
    units of `d_beta` (rad).  `complete` asks for leakage and friction torque too; returns the torque's part that the
    pressure has on the slope of the film."""
    r_i, r_o, floor = f[INNER_RADIUS], f[OUTER_RADIUS], f[FLOOR]
    mean, planar = f[TILT_AT_MEAN] != 0.0, f[PLANAR] != 0.0
    width, r_m = r_o - r_i, 0.5 * (r_i + r_o)
    mu, p_i, p_o = s[VISCOSITY], s[INNER_PRESSURE], s[OUTER_PRESSURE]
    # In p - g r^2/2 the film is one without inertia.
    g = centrifugal(f, s)
    p_i, p_o = p_i - 0.5 * g * r_i * r_i, p_o - 0.5 * g * r_o * r_o

    # In the frame of the tilt f is even part + odd part.
    frame = tilt_frame(s)
    along = frame[3]
    # A cone that grows is a tilting of every radius alike.
    cone_rate = s[CONING_RATE]
    z_rate = s[DZ_RATE] - cone_rate * r_i
    h_i0, h_o0, swing_i, swing_o = edges

    low = h_i0 - swing_i < floor or h_o0 - swing_o < floor
    thin = points_for(f, regularised_thickness(h_i0 - swing_i, floor), regularised_thickness(h_o0 - swing_o, floor))
    thick = points_for(f, regularised_thickness(h_i0 + swing_i, floor), regularised_thickness(h_o0 + swing_o, floor))
    x_k, w_k = rule_at(f, thin if thin > thick else thick)
    drive = (p_o - p_i) / (12.0 * mu)

    if planar:
        whole_0, whole_1 = width, r_m * width
    else:
        whole_0, whole_1 = 0.5 * (r_o * r_o - r_i * r_i), (r_o**3 - r_i**3) * (1.0 / 3.0)
    if mean:
        whole_1 = r_m * whole_0

    at = np.empty((ROWS, LANES))
    force = moment_even = moment_odd = flow_i = flow_o = drag = twist = 0.0
    for done in range(0, half, LANES):
        count = half - done if half - done < LANES else LANES
        # Whole vector registers: behind the half circle its last angle again.
        lanes = (count + 3) // 4 * 4
        for j in range(lanes):
            cos_b = nodes[first + (done + j if done + j < half else half - 1) * stride]
            h_i, h_o = h_i0 - swing_i * cos_b, h_o0 - swing_o * cos_b
            if low:
                h_i, h_o = regularised_thickness(h_i, floor), regularised_thickness(h_o, floor)
            at[EVEN, j], at[U_I, j], at[H_G, j] = along * cos_b - cone_rate, h_i, h_o
        _lines(at, lanes, width)
        # Laid in twice, each without the other's questions, so that the rest is compiled once.
        if complete:
            _sums(at, lanes, x_k, w_k, r_i, r_m, z_rate, mean, planar, True)
        else:
            _sums(at, lanes, x_k, w_k, r_i, r_m, z_rate, mean, planar, False)
        for j in range(count):
            n = first + (done + j) * stride
            cos_b, sin_b, twice = nodes[n], nodes[n + ROW], nodes[n + 2 * ROW]
            edge, edge_odd = (drive - at[AE, j]) / at[A0, j], -at[A1, j] / at[A0, j]
            force += twice * (at[BE, j] + edge * at[B0, j])
            moment_even += twice * cos_b * (at[CE, j] + edge * at[C0, j])
            moment_odd += twice * sin_b * sin_b * (at[C1, j] + edge_odd * at[C0, j])
            if complete:
                flow_i -= twice * edge
                flow_o -= twice * (edge + z_rate * whole_0 - at[EVEN, j] * whole_1)
                drag += twice * at[D0, j]
                twist += twice * sin_b * sin_b * (at[B1, j] + edge_odd * at[B0, j])

    sums = force, moment_even, moment_odd, flow_i, flow_o, drag, twist
    return write_circle(f, s, frame, g, d_beta, sums, complete)


@inner_kernel()
def even_circle(f, s, complete):
    """`circle` with even angles, as many as the film's block `f` asks for."""
    edges = edges_of(f, s)
    angles = angles_for(f, *edges)
    return circle(f, s, edges, f, COSINES, MOST_ANGLES // angles, angles // 2 + 1, 2.0 * math.pi / angles, complete)


@value_kernel()
def wrench(f, s):
    """Force (N) and moments (N m) of the film on the stator, from the gap state, into the gap state."""
    even_circle(f, s, False)


@value_kernel()
def flow(f, s):
    """As `wrench`; also flow in +r (m^3/s) at both radii and the friction torque on the rotor (N m):
    `int [mu (W_r - W_s) r^3/h + (h/2) r dp/dtheta] dr dtheta`, what the shaft supplies."""
    even_circle(f, s, True)


# --- between rough faces ------------------------------------------------------------------------------


@inner_kernel()
def _bend(h, swing, floor):
    """The angle from the thinnest place at which an edge with mean film `h` (m) and its swing (m) meets the floor, pi
    where it does not."""
    return math.acos((h - floor) / swing) if abs(h - floor) < swing else math.pi


@inner_kernel()
def _room(h, swing, floor, begin, end):
    """Distance of a panel (rad, between two bends) from the nearest pole of an edge's film law: at h = 0, of its
    continuation below the floor at h = 2 floor."""
    if swing <= 0.0:
        return math.inf
    low = h - swing * math.cos(0.5 * (begin + end)) < floor
    cosine = (h - 2.0 * floor if low else h) / swing
    if abs(cosine) < 1.0:
        pole = math.acos(cosine)
        return begin - pole if pole < begin else pole - end
    apart = begin if cosine > 0.0 else math.pi - end
    return math.hypot(apart, math.acosh(abs(cosine)))


@inner_kernel()
def bent_angles(f, h_i, h_o, swing_i, swing_o, out):
    """Write cosines, sines and weights of angles on the half circle into `out` (3 ROW,); returns how many.  `f` the
    film's block; films and swings (m) of `edges_of`."""
    floor, rule = f[FLOOR], int(f[PANEL_RULE])
    points = int(f[rule])
    first, last = _bend(h_i, swing_i, floor), _bend(h_o, swing_o, floor)
    if first > last:
        first, last = last, first
    begin, count = 0.0, 0
    for piece in range(3):
        until = first if piece == 0 else last if piece == 1 else math.pi
        while begin < until:
            end = until
            # There is always room for what is left of each piece; trial states may be anything.
            while (count + 4 * points <= ROW and end - begin > SHORTEST) and (
                _room(h_i, swing_i, floor, begin, end) < end - begin
                or _room(h_o, swing_o, floor, begin, end) < end - begin
            ):
                end = 0.5 * (begin + end)
            for k in range(points):
                angle = begin + 0.5 * (end - begin) * (1.0 + f[rule + 2 + k])
                out[count], out[ROW + count] = math.cos(angle), math.sin(angle)
                # Both halves of the circle.
                out[2 * ROW + count] = (end - begin) * f[rule + 2 + RADIAL_POINTS[-1] + k]
                count += 1
            begin = end
    return count


@inner_kernel()
def rough_circle(f, s, complete):
    """`circle` with angles of its own where the film meets its floor."""
    h_i, h_o, swing_i, swing_o = edges = edges_of(f, s)
    if abs(h_i - f[FLOOR]) >= swing_i and abs(h_o - f[FLOOR]) >= swing_o:
        return even_circle(f, s, complete)
    nodes = np.empty(3 * ROW)
    half = bent_angles(f, h_i, h_o, swing_i, swing_o, nodes)
    return circle(f, s, edges, nodes, 0, 1, half, 1.0, complete)


@value_kernel()
def rough_wrench(f, s):
    """As `wrench`, between rough faces."""
    rough_circle(f, s, False)


@value_kernel()
def rough_flow(f, s):
    """As `flow`, between rough faces."""
    rough_circle(f, s, True)


_SMOOTH = Film(
    **OFFER._asdict(),
    accepts=accepts,
    parameters=parameters,
    opening_law=partial(_radial_quadrature.opening_law, parameters, wrench),
    wrench=wrench,
    flow=flow,
    quantities=(PRESSURE,),
    grid=grid,
    fields=fields,
    floored=f"{__package__}.floored",
)
_ROUGH = replace(
    _SMOOTH,
    opening_law=partial(_radial_quadrature.opening_law, parameters, rough_wrench),
    wrench=rough_wrench,
    flow=rough_flow,
)
FILM = replace(_SMOOTH, rough=_ROUGH)
