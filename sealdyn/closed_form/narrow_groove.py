"""Narrow-groove theory: spiral grooves so many that the pressure across a pitch is a saw tooth without height.

    K1 = [ sin^2 a b (1-b) (h_g^3 - h_l^3)^2 + h_g^3 h_l^3 ] / D,    D = (1-b) h_g^3 + b h_l^3
    K2 = sin a cos a b (1-b) (h_g^3 - h_l^3)(h_g - h_l) / D
    liquid   p' = 12 mu [ w r K2/K1 - Q/(2 pi r K1) ]          gas   K1 p p' = 12 mu [ w r K2 p - Q/(2 pi r) ]

h_g, h_l films of groove and land (m), b the groove's share of the pitch, a its angle to the circle (positive where its
radius grows with the angle), w the entrainment in the frame of the grooves (rad/s; faces/pattern.py `turning`), Q the
flow outwards (liquid m^3/s, gas Pa m^3/s).
**Source** Muijderman (1964); Malanoski & Pan (1965), J. Basic Eng. 87, 547; derived here.  In coordinates n across and
s along the edges the flow q_n and the gradient p_s are the same in groove and land.  With q = -h^3 grad p/(12 mu) +
h w r t (t along the circle; gas: times p) the mean of p_n over the pitch follows from q_n, the mean of q_s from p_s;
turned back to the radius, with no mean gradient around the circle, they give the mean radial flow above.
**Valid** the limit of infinitely many grooves: with 12 the film has 5 to 13 % less force and up to a quarter less flow
(the ends cost 2.6/count).  A check and a first guess, no film.
"""

import math
from typing import NamedTuple

import numpy as np
from scipy.optimize import brentq


class GroovedFace(NamedTuple):
    """Face and grooves: radii (m) of the face and of the grooved annulus, `angle` (rad), `share` of the pitch, `depth`
    and `clearance` over the lands (m)."""

    inner_radius: float
    outer_radius: float
    groove_inner_radius: float
    groove_outer_radius: float
    angle: float
    share: float
    depth: float
    clearance: float


def groove_coefficients(face: GroovedFace) -> tuple[float, float]:
    """K1 (m^3) and K2 (m) of the grooved annulus."""
    cube, land, b = (face.clearance + face.depth) ** 3, face.clearance**3, face.share
    sin, cos = math.sin(face.angle), math.cos(face.angle)
    mixed, step = b * (1.0 - b), cube - land
    whole = (1.0 - b) * cube + b * land
    return (sin * sin * mixed * step * step + cube * land) / whole, sin * cos * mixed * step * face.depth / whole


def pumped_pressure(face: GroovedFace, viscosity: float, entrainment: float) -> float:
    """Rise of pressure (Pa) outwards over the grooved annulus of a liquid that does not flow: 6 mu w (K2/K1)
    (r_2^2 - r_1^2)."""
    k1, k2 = groove_coefficients(face)
    rise = face.groove_outer_radius**2 - face.groove_inner_radius**2
    return 6.0 * viscosity * entrainment * k2 / k1 * rise


def muijderman_number(angle: float, films: float, lands: float = 1.0) -> float:
    """g1 of |p_2 - p_1| = 3 mu W (r_2^2 - r_1^2) g1/h_l^2, W = 2 w, for the ratio `films` of land to groove film and
    `lands` of land to groove width; at most 0.091176, at 15.68 degrees, films 0.2737, lands 1."""
    cube, slope = films**3, 1.0 / math.tan(angle)
    below = (1.0 + lands * cube) * (lands + cube) + cube * slope * slope * (1.0 + lands) ** 2
    return films**2 * slope * lands * (1.0 - films) * (1.0 - cube) / below


class NarrowGrooves(NamedTuple):
    """Absolute opening force (N), and flow outwards (m^3/s of a liquid, Pa m^3/s of a gas)."""

    force: float
    flow: float


# Points of Gauss' rule on each annulus of a liquid; steps of Runge and Kutta's on each of a gas.
POINTS, STEPS = np.polynomial.legendre.leggauss(40), 200


def _annuli(face: GroovedFace):
    """(inner radius, outer radius, K1, K2) of the plain and grooved annuli, from the inside out."""
    k1, k2 = groove_coefficients(face)
    plain = face.clearance**3
    limits = face.inner_radius, face.groove_inner_radius, face.groove_outer_radius, face.outer_radius
    three = zip(limits[:-1], limits[1:], (plain, k1, plain), (0.0, k2, 0.0), strict=True)
    return [annulus for annulus in three if annulus[1] > annulus[0]]


def narrow_groove_liquid(
    face: GroovedFace, viscosity: float, entrainment: float, inner_pressure: float, outer_pressure: float
) -> NarrowGrooves:
    """Full film of a liquid (Pa s, rad/s, Pa absolute): p' integrated in closed form, the flow from the pressures at
    the edges, the force by parts."""
    pumped, resistance, annuli = 0.0, 0.0, _annuli(face)
    for a, b, k1, k2 in annuli:
        pumped += 6.0 * viscosity * entrainment * k2 / k1 * (b * b - a * a)
        resistance += 6.0 * viscosity / (math.pi * k1) * math.log(b / a)
    flow = (pumped - (outer_pressure - inner_pressure)) / resistance
    force = math.pi * (outer_pressure * face.outer_radius**2 - inner_pressure * face.inner_radius**2)
    nodes, weights = POINTS
    for a, b, k1, k2 in annuli:
        r = 0.5 * (a + b) + 0.5 * (b - a) * nodes
        slope = 12.0 * viscosity * (entrainment * r * k2 / k1 - flow / (2.0 * math.pi * r * k1))
        force -= math.pi * 0.5 * (b - a) * float(weights @ (slope * r * r))
    return NarrowGrooves(force, flow)


def narrow_groove_gas(
    face: GroovedFace, viscosity: float, entrainment: float, inner_pressure: float, outer_pressure: float
) -> NarrowGrooves:
    """Film of an isothermal gas without slip (Pa s, rad/s, Pa absolute): p^2/2 marched outwards, the flow that meets
    the pressure at the outer edge by Brent's method, since p there falls as the flow grows.  Raises ValueError where
    none meets it."""
    least, annuli = 1e-6 * inner_pressure, _annuli(face)

    def march(flow: float) -> tuple[float, float]:
        """p^2/2 at the outer edge (Pa^2), and the force (N)."""
        half_square, force = 0.5 * inner_pressure**2, 0.0
        for a, b, k1, k2 in annuli:
            carried, lost = 12.0 * viscosity * entrainment * k2 / k1, 6.0 * viscosity * flow / (math.pi * k1)

            def slopes(r, y, carried=carried, lost=lost):
                p = math.sqrt(max(2.0 * y, least * least))
                return carried * r * p - lost / r, 2.0 * math.pi * r * p

            step = (b - a) / STEPS
            for n in range(STEPS):
                r = a + n * step
                s1, f1 = slopes(r, half_square)
                s2, f2 = slopes(r + 0.5 * step, half_square + 0.5 * step * s1)
                s3, f3 = slopes(r + 0.5 * step, half_square + 0.5 * step * s2)
                s4, f4 = slopes(r + step, half_square + step * s3)
                half_square += step / 6.0 * (s1 + 2.0 * (s2 + s3) + s4)
                force += step / 6.0 * (f1 + 2.0 * (f2 + f3) + f4)
        return half_square, force

    def missed(flow: float) -> float:
        return march(flow)[0] - 0.5 * outer_pressure**2

    # From a film that drags nothing.
    high = max(inner_pressure, outer_pressure) ** 2 * face.clearance**3 / viscosity
    low = -high
    while missed(low) < 0.0 and low > -1e6 * high:
        low *= 2.0
    flow = brentq(missed, low, high, xtol=1e-13 * high, rtol=1e-13)
    return NarrowGrooves(march(flow)[1], flow)
