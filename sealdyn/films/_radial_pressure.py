"""The pressure of the films without pressure flow around the circle, over the face.

**Source** Reynolds' equation along a radius, as in radial/film.py:

    r h^3 p' = 12 mu (Phi + c),   Phi = integral of f r dr,   f = dh/dt + wm dh/dtheta

(planar: no r; inertia adds g r to p'), integrated from each radius of the grid to the next by the Gauss rule that
serves the film ratio between them: how fine the grid is does not matter to the pressures on it.
**Valid** where these films are; between faces without waves.
"""

import math

import numpy as np

from ..faces.film_thickness import film_thickness
from ..faces.geometry import (
    CONING_RATE,
    DZ_RATE,
    FLOOR,
    GX,
    GX_RATE,
    GY,
    GY_RATE,
    INNER_PRESSURE,
    INNER_RADIUS,
    MEAN_SPIN,
    OUTER_PRESSURE,
    OUTER_RADIUS,
    PLANAR,
    PROFILE,
    PROFILE_RADII,
    TILT_AT_MEAN,
    VISCOSITY,
    regularised_thickness,
)
from ..numerics.kernel import inner_kernel, outer_kernel
from ._fields import PRESSURE
from ._radial_line import cubic, line_sums
from ._radial_quadrature import CAVITATION, HAS_CAVITATION, RADIAL_POINTS, RULE_SIZE, RULES, centrifugal, points_for

FIELDS = (PRESSURE,)
# Steps over the radius, at least, and angles of the grid.
STEPS, ANGLES = 16, 48


def _nodes(f):
    """Radii (m) between which the film thickness is linear: both edges, or those of the profile."""
    if f[PROFILE] == 0.0:
        return np.array([f[INNER_RADIUS], f[OUTER_RADIUS]])
    return f[PROFILE_RADII : PROFILE_RADII + int(f[PROFILE])].copy()


def _steps(nodes):
    """Equal steps between each node and the next, and how many in all."""
    steps, total = np.empty(len(nodes) - 1, np.int64), 0
    for n in range(len(steps)):
        steps[n] = math.ceil(STEPS * (nodes[n + 1] - nodes[n]) / (nodes[-1] - nodes[0]) - 1e-9)
        total += steps[n]
    return steps, total


def _radii(nodes, steps, total):
    """Radii (m) of the grid."""
    r, at = np.empty(total + 1), 0
    for n in range(len(steps)):
        for i in range(steps[n]):
            r[at], at = nodes[n] + (nodes[n + 1] - nodes[n]) * i / steps[n], at + 1
    r[at] = nodes[-1]
    return r


def grid(f):
    """Radii (m) of the grid, edges and nodes of a profile among them, and its angles (rad)."""
    nodes = _nodes(f)
    return _radii(nodes, *_steps(nodes)), 2.0 * math.pi / ANGLES * np.arange(ANGLES)


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
    nodes = _nodes(f)
    steps, total = _steps(nodes)
    _pressure(f, s, nodes, steps, _radii(nodes, steps, total), out[0])


@outer_kernel()
def _pressure(f, s, nodes, steps, r, out):
    """As `fields`, `out` (radii, angles), at the radii `r` (m): `steps` of them from one of the `nodes` to the next."""
    mean, planar = f[TILT_AT_MEAN] != 0.0, f[PLANAR] != 0.0
    per, p_i, p_o, g = 12.0 * s[VISCOSITY], s[INNER_PRESSURE], s[OUTER_PRESSURE], centrifugal(f, s)
    # Integrals of Phi / (r h^3) and of 1 / (r h^3) from the inner radius.
    h, driven, through = np.empty(len(r)), np.zeros(len(r)), np.zeros(len(r))
    for j in range(ANGLES):
        theta = 2.0 * math.pi / ANGLES * j
        sin, cos = math.sin(theta), math.cos(theta)
        _thicknesses(f, s, nodes, steps, theta, h)
        tilt_rate = s[GX_RATE] * sin - s[GY_RATE] * cos + s[MEAN_SPIN] * (s[GX] * cos + s[GY] * sin)
        # A cone that grows is a tilting of every radius alike.
        tilt_rate += s[CONING_RATE]
        q, _ = cubic(s[DZ_RATE] - s[CONING_RATE] * r[0], tilt_rate, r[0], r[-1], mean, planar)
        for k in range(1, len(r)):
            rule = RULES + RULE_SIZE * points_for(f, h[k - 1], h[k])
            first, points = rule + 2, int(f[rule])
            x_k, w_k = f[first : first + points], f[first + RADIAL_POINTS[-1] : first + RADIAL_POINTS[-1] + points]
            part = line_sums(0.0, q, r[0], planar, r[k - 1] - r[0], r[k] - r[0], h[k - 1], h[k], x_k, w_k)
            driven[k], through[k] = driven[k - 1] + part[0], through[k - 1] + part[3]
        c = ((p_o - p_i - 0.5 * g * (r[-1] ** 2 - r[0] ** 2)) / per - driven[-1]) / through[-1]
        for k in range(len(r)):
            p = p_i + per * (driven[k] + c * through[k]) + 0.5 * g * (r[k] ** 2 - r[0] ** 2)
            out[k, j] = max(p, f[CAVITATION]) if f[HAS_CAVITATION] != 0.0 else p
