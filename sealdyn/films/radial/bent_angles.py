"""Angles for a film that meets its floor: there its law has a bend, and even angles would converge as slowly as 1/N^3.

Gauss points between the bends, on panels no longer than their distance from where the law has a pole (in the complex
plane too): the error falls as 4.2^(-2 n) with the points of a panel, however thin the film.
"""

import math

import numpy as np

from ...faces.geometry import FLOOR
from ...numerics.kernel import inner_kernel
from .._radial_quadrature import MOST_ANGLES, PANEL_RULE, RADIAL_POINTS

# What is known of an angle: cosine, sine, weight.  At most so many on the half circle.
COSINE, SINE, WEIGHT = range(3)
MOST = MOST_ANGLES // 2


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
    real = math.acos(min(max(cosine, -1.0), 1.0))
    imaginary = math.acosh(max(abs(cosine), 1.0))
    return math.hypot(max(real - end, begin - real, 0.0), imaginary)


@inner_kernel()
def bent_angles(f, h_i, h_o, swing_i, swing_o, out):
    """Write cosines, sines and weights of angles on the half circle into `out` (3, MOST); returns how many.  `f` the
    film's block; mean films and swings (m) as for `angles_for`."""
    floor, rule = f[FLOOR], int(f[PANEL_RULE])
    points = int(f[rule])
    bends = _bend(h_i, swing_i, floor), _bend(h_o, swing_o, floor)
    begin, count = 0.0, 0
    for piece in range(3):
        until = min(bends) if piece == 0 else max(bends) if piece == 1 else math.pi
        while begin < until:
            end = until
            while count + 2 * points <= MOST and end - begin > min(
                _room(h_i, swing_i, floor, begin, end), _room(h_o, swing_o, floor, begin, end)
            ):
                end = 0.5 * (begin + end)
            for k in range(points if count + points <= MOST else 0):
                angle = begin + 0.5 * (end - begin) * (1.0 + f[rule + 2 + k])
                out[COSINE, count], out[SINE, count] = math.cos(angle), math.sin(angle)
                out[WEIGHT, count] = 0.5 * (end - begin) * f[rule + 2 + RADIAL_POINTS[-1] + k]
                count += 1
            begin = end
    return count


@inner_kernel()
def meets_floor(f, h_i, h_o, swing_i, swing_o):
    """Whether an edge's film is below the floor at some angles and above it at others."""
    return abs(h_i - f[FLOOR]) < swing_i or abs(h_o - f[FLOOR]) < swing_o


@inner_kernel()
def no_angles(bent):
    """Room for `bent_angles` where the film is `bent`, else hardly any."""
    return np.empty((3, MOST if bent else 1))
