"""What the wedge of a tilted narrow face carries under a sealed pressure, cavitated over part of its width.

Over the width x = 0..1 the pressure above the cavity's is `a + (b - a) x + 6 P x (1 - x)`: a line between the edges and
the parabola of the wedge, whose mean is P.  In the diverging half P < 0, and the quadratic is below zero between two
roots as soon as `6 |P| > (sqrt a + sqrt b)^2`.  Without what is below, the mean above the line is

    P,      in the diverging half, cavitated:  -|P| (1 - D^(3/2)),   D = 1 - 2 (a + b)/(6 |P|) + ((b - a)/(6 |P|))^2

D^(1/2) the share of the width that is dry; without pressure D = 1 (half-Sommerfeld), without a cavity D = 0 (full
Sommerfeld, whose two halves push and pull alike: no force).  So the load is what the cavity keeps from pulling, and
a film too thick for a cavity carries nothing; which edge has the higher pressure does not matter.

**Source** derived here: planar Reynolds equation without pressure flow around the circle, pressure cut at the cavity's
(half-Sommerfeld over the width, as Ludwig & Allen, NASA TN D-8102 (1976), have around the circle).
The dry middle is off the mean radius by (a - b)/(12 |P|) of the width, towards the lower pressure, which counts
to the first order of dR/R.
**Valid** as `ludwig_allen`, with pressures at both edges not below the cavity's.  All dimensionless: `amplitude` e =
h1/h0, `number` N = h0^2 L / (mu U dR^3) with L the closing load that the line leaves; forces over L, moments over R L.
"""

import math
from functools import lru_cache
from typing import NamedTuple

import numpy as np
from scipy.optimize import brentq, minimize_scalar

# Gauss points over the cavity, in the angle whose cosine is the place: powers of D at its ends become whole ones there.
_X, _W = np.polynomial.legendre.leggauss(64)
PLACES, WEIGHTS = -np.cos(0.5 * math.pi * (1 + _X)), 0.5 * math.pi * _W * np.sin(0.5 * math.pi * (1 + _X))
# h1/h0 of nearly parallel, nearly touching faces; how many between are tried; angles of a full circle.
FLAT, CLOSE, TRIED, ANGLES = 1e-6, 1 - 1e-6, 40, 64


class Edges(NamedTuple):
    """p R dR / L of the pressures at the inner and the outer edge above the cavity's, and the face's `width` dR / R
    where the cavity's place in it counts."""

    inner: float = 0.0
    outer: float = 0.0
    width: float = 0.0

    @property
    def sealed(self) -> bool:
        """Whether there is any pressure."""
        return self.inner > 0.0 or self.outer > 0.0


def _dry(depth, inner, outer):
    """Share of the width that is dry under a parabola of curvature 2 `depth` > 0."""
    below = 1 - 2 * (inner + outer) / depth + ((outer - inner) / depth) ** 2
    return np.sqrt(np.maximum(np.where(depth > (np.sqrt(inner) + np.sqrt(outer)) ** 2, below, 0.0), 0.0))


class _Angles(NamedTuple):
    """Angles gamma of Sommerfeld's (1904) substitution tan(theta/2) = ((1 + e)/(1 - e))^(1/2) tan(gamma/2), theta from
    the thickest film, in which 1/h^3 is a polynomial: cosine and sine of theta, h/h0, dtheta per dgamma."""

    cos: np.ndarray
    sin: np.ndarray
    thickness: np.ndarray
    measure: np.ndarray

    @classmethod
    def at(cls, e: float, gamma):
        rest, root = 1 - e * np.cos(gamma), math.sqrt((1 - e) * (1 + e))
        return cls((np.cos(gamma) - e) / rest, root * np.sin(gamma) / rest, root**2 / rest, root / rest)


def _cavity(amplitude: float, number: float, edges: Edges):
    """Where the diverging half cavitates: its angles counted backwards, their weights; there 6 |P| over the wedge's
    scale, sum and difference of the edges' pressures over 6 |P|, the dry share, and what its place adds to its area.
    None where nothing does."""
    inner, outer = 2 * number * edges.inner, 2 * number * edges.outer
    e, need = amplitude, (math.sqrt(inner) + math.sqrt(outer)) ** 2
    scale = 6 * e / ((1 - e) * (1 + e)) ** 2.5

    def above(gamma):
        return scale * math.sin(gamma) * (1 - e * math.cos(gamma)) ** 2 - need

    # 6 |P| has one summit, where cos + 2 e = 3 e cos^2.
    summit = math.acos(-4 * e / (1 + math.sqrt(1 + 24 * e * e)))
    if not above(summit) > 0.0:
        return None
    begin, end = (x if above(x) >= 0.0 else brentq(above, x, summit, xtol=1e-15) for x in (0.0, math.pi))
    gamma = 0.5 * (begin + end) + 0.5 * (end - begin) * PLACES
    there = _Angles.at(e, gamma)
    depth = scale * np.sin(gamma) * (1 - e * np.cos(gamma)) ** 2
    weight, sums, drop = 0.5 * (end - begin) * WEIGHTS * there.measure, (inner + outer) / depth, (outer - inner) / depth
    return there, weight, depth, sums, drop, _dry(depth, inner, outer), -0.5 * edges.width * drop


def carried(amplitude: float, number: float, edges: Edges) -> np.ndarray:
    """Force, sine and cosine moment (3,) of a film, over L and R L; scalar arguments.  The sine moment is about the
    diameter through thickest and thinnest film, the cosine one about the tilt axis.  **Source**, **Valid**, units as
    the module."""
    # The full circle pulls as it pushes; its sine moment is twice the half film's.
    held = np.array([0.0, 0.5 * math.pi * amplitude / ((1 - amplitude) * (1 + amplitude)) ** 1.5, 0.0])
    found = _cavity(amplitude, number, edges)
    if found is not None:
        at, weight, depth, _, _, dry, beside = found
        kept = weight * depth * dry**3 / 12
        arm = kept * (1 + 2 * beside)
        held += [np.sum(kept * (1 + beside)), -np.sum(arm * at.sin), np.sum(arm * at.cos)]
    return held / number


def balance(amplitude: float, edges: Edges) -> tuple[float, float, float]:
    """Sealing number N of the film h1/h0 = `amplitude` that carries L, its sine and cosine moment over R L; scalar
    arguments.  **Source**, **Valid**, units as the module."""
    e, rest = amplitude, (1 - amplitude) * (1 + amplitude)
    # Without pressure nothing carries more.
    most = e / rest**2
    if not edges.sealed:
        return most, 0.25 * math.pi * math.sqrt(rest), -e
    high, low = most * (1 + 1e-9), 0.5 * most
    while carried(e, low, edges)[0] < 1.0:
        high, low = low, 0.5 * low
    number = brentq(lambda number: carried(e, number, edges)[0] - 1.0, low, high, xtol=1e-13 * low, rtol=1e-13)
    _, sine, cosine = carried(e, number, edges)
    return number, float(sine), float(cosine)


@lru_cache(maxsize=64)
def moment_limits(edges: Edges) -> tuple[float, float, float]:
    """Moment over R L of the film between nearly parallel faces, the largest there is, and h1/h0 of that one (0: the
    moment falls with the tilt from parallel faces on).  Without pressure pi/4, 1, 1.  **Source**, **Valid**, units as
    the module."""
    if not edges.sealed:
        return 0.25 * math.pi, 1.0, 1.0

    def moment(e):
        return math.hypot(*balance(e, edges)[1:])

    tried = np.linspace(FLAT, CLOSE, TRIED)
    best = int(np.argmax([moment(e) for e in tried]))
    least = moment(FLAT)
    if best == 0:
        return least, least, 0.0
    bounds = (tried[best - 1], tried[min(best + 1, TRIED - 1)])
    at = float(minimize_scalar(lambda e: -moment(e), bounds=bounds, method="bounded", options={"xatol": 1e-9}).x)
    return least, moment(at), at


def slopes(amplitude: float, edges: Edges) -> tuple[np.ndarray, np.ndarray]:
    """Derivatives (2, 2) of force and sine moment (rows) by h0, h1 (over h0), and by their rates (over h0 and the mean
    spin), at the film that carries L, all up to one factor.  **Source**, **Valid**, units as the module."""
    e, number = amplitude, balance(amplitude, edges)[0]

    def summed(at, sign, pushed, turned):
        h, cos, sin = at.thickness, at.cos, sign * at.sin
        wedge = e * sin / h**3
        columns = np.array([-3 * wedge / h, (sin - 3 * e * sin * cos / h) / h**3, -1 / h**3, -cos / h**3])
        return np.array([columns @ pushed, columns @ (turned * sin)])

    whole = _Angles.at(e, 2 * math.pi / ANGLES * np.arange(ANGLES))
    weight = 2 * math.pi / ANGLES * whole.measure
    found = summed(whole, 1.0, weight, weight)
    there = _cavity(e, number, edges)
    if there is not None:
        at, weight, _, sums, drop, dry, beside = there
        # d(|P| D^(3/2)) / d|P|: what of a deeper wedge the cavity takes; its place goes as 1/|P|.
        more = 3 * dry * (sums - drop**2)
        found -= summed(at, -1.0, *(weight * (dry**3 + (1 + order * beside) * more) for order in (1, 2)))
    return found[:, :2], found[:, 2:]
