"""The radial film (film.py) between rough faces: its law has a bend at its floor, where even angles would converge as
slowly as 1/N^3.

Gauss points between the bends, on panels no longer than their distance from where the law has a pole (in the complex
plane too): the error falls as 4.2^(-2 n) with the points of a panel, however thin the film.
"""

import math

import numpy as np

from ...faces.geometry import FLOOR
from ...numerics.kernel import inner_kernel, value_kernel
from .. import _radial_quadrature
from .._radial_quadrature import PANEL_RULE, RADIAL_POINTS
from .film import FIELDS, ROW, RUNG, accepts, circle, edges_of, even_circle, fields, grid, parameters

__all__ = ["FIELDS", "RUNG", "accepts", "fields", "flow", "grid", "opening_law", "parameters", "wrench"]


def opening_law(film, mean_spin=0.0, spin_difference=0.0):
    """Opening force (N) of the aligned film, as that of film.py."""
    return _radial_quadrature.opening_law(film, parameters, wrench, mean_spin, spin_difference)


# No panel is shorter (rad).
SHORTEST = 1e-9


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
    """`circle` of film.py, with angles of its own where the film meets its floor."""
    h_i, h_o, swing_i, swing_o = edges = edges_of(f, s)
    if abs(h_i - f[FLOOR]) >= swing_i and abs(h_o - f[FLOOR]) >= swing_o:
        return even_circle(f, s, complete)
    nodes = np.empty(3 * ROW)
    half = bent_angles(f, h_i, h_o, swing_i, swing_o, nodes)
    return circle(f, s, edges, nodes, 0, 1, half, 1.0, complete)


@value_kernel()
def wrench(f, s):
    """Force (N) and moments (N m) of the film on the stator, from the gap state, into the gap state."""
    rough_circle(f, s, False)


@value_kernel()
def flow(f, s):
    """As `wrench`; also flow in +r (m^3/s) at both radii and the friction torque on the rotor (N m)."""
    rough_circle(f, s, True)
