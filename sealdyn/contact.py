"""Asperity contact of the faces: load, moments, friction, wear, and the energy it stores.

**Source** the laws: asperities.py.  Friction as a share of the load or of the touching area and wear by Archard's
law: Lebeck, Teale & Pierce, ONR ME-95(79)ONR-414-1 (1979).
**Valid** rigid coned faces, rough at a scale far below their width; dry, and without memory.

Contact depends on the film thickness alone, so it has a potential: V = int W(h) dA, dW/dh = -p_c, force and
moments are minus its derivatives, and turning costs nothing but friction.  A law is a polynomial over the touching
part of a radius: Gauss points are exact there.  Around the circle the touching arc is split where an edge of the
face enters or leaves the asperities; between the integrand is analytic, and Gauss points converge exponentially
however narrow the arc.
"""

import math
from dataclasses import dataclass
from typing import Literal

import numpy as np
from numba import njit

from .asperities import (
    BEYOND,
    HALF_HEIGHT,
    REACH,
    SERIES_SIZE,
    christensen_series,
    gaussian_series,
    scaled,
    stored,
)
from .gap import (
    CONTACT_AREA,
    CONTACT_ENERGY,
    CONTACT_FORCE,
    CONTACT_PRESSURE,
    CONTACT_TORQUE,
    CONTACT_X,
    CONTACT_Y,
    DZ,
    GX,
    GY,
    INNER_RADIUS,
    OUTER_RADIUS,
    SPIN_DIFFERENCE,
    TILT_AT_MEAN,
    WEAR,
    edge_gaps,
)
from .units import AsperityDensity, Length, Stress, WearCoefficient


@dataclass(frozen=True)
class Contact:
    """The `[contact]` table.  `roughness` is the composite rms of both faces, `compressive_strength` that of the
    softer one; shear of the touching area is `shear_strength`, or `friction_coefficient` (0.1 when neither is given)
    times the contact pressure; `asperity_...` and the composite `modulus` belong to Greenwood and Williamson."""

    __pydantic_config__ = {"extra": "forbid"}  # noqa: RUF012

    roughness: Length
    law: Literal["christensen", "greenwood-williamson"] = "christensen"
    compressive_strength: Stress | None = None
    friction_coefficient: float | None = None
    shear_strength: Stress | None = None
    stator_wear_coefficient: WearCoefficient = 0.0
    rotor_wear_coefficient: WearCoefficient = 0.0
    asperity_density: AsperityDensity | None = None
    asperity_radius: Length | None = None
    modulus: Stress | None = None


LAW_KEYS = {
    "christensen": ("compressive_strength",),
    "greenwood-williamson": ("asperity_density", "asperity_radius", "modulus"),
}
# Gauss points of a panel around the circle: error below 1e-10 of the load (tests/convergence).
ANGLE_POINTS = {"christensen": 12, "greenwood-williamson": 20}

# Block layout: then the series, then nodes and weights on [0, 1] of the radius and of a panel of the circle.
TOP, SPAN, SHEAR_OF_LOAD, SHEAR_OF_AREA, WEAR_PER_LOAD, FACE_AREA, RADIAL, AROUND, LOAD = range(9)
AREA = LOAD + SERIES_SIZE
ENERGY = AREA + SERIES_SIZE
NODES = ENERGY + SERIES_SIZE


def faults(contact: Contact) -> list[tuple[str, str, str]]:
    """What cannot be in a `[contact]` table: (key, found, expected), in the order of the table."""
    bad = []
    wanted = ("roughness", *LAW_KEYS[contact.law])
    for law, keys in LAW_KEYS.items():
        if law != contact.law:
            bad += [
                (key, f"a value, with law = {contact.law!r}", f'nothing, or law = "{law}"')
                for key in keys
                if getattr(contact, key) is not None
            ]
    for key in wanted:
        value = getattr(contact, key)
        if value is None:
            bad.append((key, "nothing", f'a value > 0: law = "{contact.law}" needs it'))
        elif not 0.0 < value < math.inf:
            bad.append((key, f"{value:g}", "a value > 0"))
    if contact.friction_coefficient is not None and contact.shear_strength is not None:
        bad.append(("shear_strength", "a value beside friction_coefficient", "one of the two"))
    for key in ("friction_coefficient", "shear_strength", "stator_wear_coefficient", "rotor_wear_coefficient"):
        value = getattr(contact, key)
        if value is not None and not 0.0 <= value < math.inf:
            bad.append((key, f"{value:g}", "a value >= 0"))
    return bad


def levels(contact: Contact) -> tuple[float, float, float]:
    """Mean films h (m), with c = 3 rms roughnesses: (film_floor, touch, collapse).

    film_floor  0.6 c: below it the smooth film law is continued (`gap.above_floor`, floor/2 at h = 0), as rough
                faces do: E(H^3)^(1/3) at h = 0 is 0.30 c (Christensen), 0.31 c (Gaussian).
    touch       where the first asperities meet: c; 5 rms for Gaussian heights, whose load there is 1e-7 of that at 0.
    collapse    -c: all asperities are flattened, and the law has nothing more to say.
    """
    c = HALF_HEIGHT * contact.roughness
    return 0.6 * c, c if contact.law == "christensen" else REACH * contact.roughness, -c


def parameters(contact: Contact, face: np.ndarray, points: int | None = None) -> np.ndarray:
    """The contact's block of the parameter array, float64.

    `face` the leading slots of a film's block, `points` Gauss points of each panel around the circle.
    """
    points = points or ANGLE_POINTS[contact.law]
    if contact.law == "christensen":
        load = scaled(christensen_series(), contact.compressive_strength)
        area = christensen_series()
    else:
        number = contact.asperity_density * contact.asperity_radius * contact.roughness
        stiff = 4.0 / 3.0 * number * contact.modulus * math.sqrt(contact.roughness / contact.asperity_radius)
        load, area = scaled(gaussian_series(1.5), stiff), scaled(gaussian_series(1.0), math.pi * number)
    # Exact for u^4 Q(v) r^2, and for the energy u^5 R(v) r.
    radial = (4 + int(load[0]) + 2) // 2 + 1
    k = np.zeros(NODES + 2 * (radial + points))
    _, top, bottom = levels(contact)
    k[TOP], k[SPAN] = top, top - bottom
    k[SHEAR_OF_AREA] = contact.shear_strength or 0.0
    if contact.shear_strength is None:
        k[SHEAR_OF_LOAD] = 0.1 if contact.friction_coefficient is None else contact.friction_coefficient
    k[WEAR_PER_LOAD] = contact.stator_wear_coefficient + contact.rotor_wear_coefficient
    k[FACE_AREA] = math.pi * (face[OUTER_RADIUS] ** 2 - face[INNER_RADIUS] ** 2)
    k[LOAD:AREA], k[AREA:ENERGY], k[ENERGY:NODES] = load, area, stored(load, top - bottom)
    k[RADIAL], k[AROUND], first = radial, points, NODES
    for count in (radial, points):
        node, weight = np.polynomial.legendre.leggauss(count)
        k[first : first + count] = 0.5 * (1.0 + node)
        k[first + count : first + 2 * count] = 0.5 * weight
        first += 2 * count
    return k


@njit(cache=True)
def _at(k, series, u, head):
    """A law at u: head (u^4 or u^5) times its series in v = 2u - 1, or what continues it beyond u = 1."""
    if u > 1.0:
        e, tail = u - 1.0, series + BEYOND
        return k[tail] + e * (k[tail + 1] + e * (k[tail + 2] + e * k[tail + 3]))
    if u <= 0.0:
        return 0.0
    v, value = 2.0 * u - 1.0, 0.0
    for n in range(series + 1 + int(k[series]), series, -1):
        value = value * v + k[n]
    return head * value


@njit(cache=True)
def _part(k, r_a, r_b, u_a, u_b, complete):
    """Integrals over a smooth part of a radius: of p r, p r^2; and, if `complete`, of area r, area r^2, energy r."""
    points = int(k[RADIAL])
    load = arm = area = area_arm = energy = 0.0
    for n in range(points):
        y = k[NODES + n]
        u, r = u_a + y * (u_b - u_a), r_a + y * (r_b - r_a)
        w = k[NODES + points + n] * (r_b - r_a) * r
        head = u * u * u * u
        p = w * _at(k, LOAD, u, head)
        load += p
        arm += p * r
        if complete:
            a = w * _at(k, AREA, u, head)
            area += a
            area_arm += a * r
            energy += w * _at(k, ENERGY, u, head * u)
    return load, arm, area, area_arm, energy


@njit(cache=True, error_model="numpy")
def _radius(k, r_i, r_o, u_i, u_o, complete):
    """As `_part`, over all of a radius that touches; u is linear between u_i and u_o."""
    # From the less to the more pressed end; going inwards the integrals change sign.
    turn = 1.0 if u_i <= u_o else -1.0
    r_a, u_a, r_b, u_b = (r_i, u_i, r_o, u_o) if u_i <= u_o else (r_o, u_o, r_i, u_i)
    if u_b <= 0.0:
        return 0.0, 0.0, 0.0, 0.0, 0.0
    if u_a < 0.0:
        r_a, u_a = r_a - u_a * (r_b - r_a) / (u_b - u_a), 0.0
    if u_a >= 1.0 or u_b <= 1.0:
        a, b, c, d, e = _part(k, r_a, r_b, u_a, u_b, complete)
        return turn * a, turn * b, turn * c, turn * d, turn * e
    r_1 = r_a + (1.0 - u_a) * (r_b - r_a) / (u_b - u_a)
    a, b, c, d, e = _part(k, r_a, r_1, u_a, 1.0, complete)
    a1, b1, c1, d1, e1 = _part(k, r_1, r_b, 1.0, u_b, complete)
    return turn * (a + a1), turn * (b + b1), turn * (c + c1), turn * (d + d1), turn * (e + e1)


@njit(cache=True)
def _crossing(low, swing, level):
    """Angle from the thinnest place where low + swing (1 - cos beta) passes `level`; 0 or pi if it never does."""
    if level <= low:
        return 0.0
    if level >= low + 2.0 * swing:
        return math.pi
    return 2.0 * math.asin(math.sqrt((level - low) / (2.0 * swing)))


@njit(cache=True, error_model="numpy")
def _circle(k, f, tilt, low_i, low_o, complete):
    """As `_part`, over the whole face; with the moment of the load about the axis of the tilt in third place."""
    r_i, r_o, mean = f[INNER_RADIUS], f[OUTER_RADIUS], f[TILT_AT_MEAN] != 0.0
    top, per_span, r_m = k[TOP], 1.0 / k[SPAN], 0.5 * (r_i + r_o)
    swing_i, swing_o = (r_m * tilt, r_m * tilt) if mean else (r_i * tilt, r_o * tilt)

    # Where an edge of the face meets the first asperities, and where its last are flattened.
    b_1, b_2 = _crossing(low_i, swing_i, top), _crossing(low_o, swing_o, top)
    b_3, b_4 = _crossing(low_i, swing_i, top - k[SPAN]), _crossing(low_o, swing_o, top - k[SPAN])
    end, points, nodes = max(b_1, b_2), int(k[AROUND]), NODES + 2 * int(k[RADIAL])

    load = arm = along = area = area_arm = energy = start = 0.0
    while start < end:
        stop = end
        for b in (b_1, b_2, b_3, b_4):
            if start < b < stop:
                stop = b
        for n in range(points):
            # 1 - cos beta = 2 sin^2(beta / 2): no cancellation in a narrow arc.
            rise = 2.0 * math.sin(0.5 * (start + k[nodes + n] * (stop - start))) ** 2
            u_i, u_o = (top - low_i - swing_i * rise) * per_span, (top - low_o - swing_o * rise) * per_span
            a, b, c, d, e = _radius(k, r_i, r_o, u_i, u_o, complete)
            w = 2.0 * (stop - start) * k[nodes + points + n]
            load += w * a
            arm += w * b
            # Where the tilt's arm is the mean radius so is the moment's: else there were no potential.
            along -= w * (1.0 - rise) * (r_m * a if mean else b)
            area += w * c
            area_arm += w * d
            energy += w * e
        start = stop
    return load, arm, along, area, area_arm, energy


@njit(cache=True)
def _face(k, f, s, complete):
    """Write the contact slots.  `complete` asks for friction, area, energy and wear too."""
    s[CONTACT_FORCE] = s[CONTACT_X] = s[CONTACT_Y] = 0.0
    if complete:
        s[CONTACT_TORQUE] = s[CONTACT_AREA] = s[CONTACT_PRESSURE] = s[CONTACT_ENERGY] = s[WEAR] = 0.0
    tilt = math.hypot(s[GX], s[GY])
    low_i, low_o = edge_gaps(f, s[DZ], tilt)
    if min(low_i, low_o) >= k[TOP]:
        return
    load, arm, along, area, area_arm, energy = _circle(k, f, tilt, low_i, low_o, complete)
    s[CONTACT_FORCE] = load
    # The pressure is even about the thinnest place: its moment is along the tilt.
    if tilt > 0.0:
        s[CONTACT_X], s[CONTACT_Y] = along * s[GX] / tilt, along * s[GY] / tilt
    if complete:
        shear, spin = k[SHEAR_OF_LOAD] * arm + k[SHEAR_OF_AREA] * area_arm, s[SPIN_DIFFERENCE]
        s[CONTACT_TORQUE] = math.copysign(shear, spin) if spin != 0.0 else 0.0
        u = (k[TOP] - min(low_i, low_o)) / k[SPAN]
        s[CONTACT_PRESSURE] = _at(k, LOAD, u, u**4)
        s[CONTACT_AREA], s[CONTACT_ENERGY] = area / k[FACE_AREA], energy
        s[WEAR] = k[WEAR_PER_LOAD] * abs(spin) * arm / k[FACE_AREA]


@njit(cache=True)
def press(k, f, s):
    """Contact force (N, opening) and moments (N m) on the stator, into the gap state: minus the derivatives of
    CONTACT_ENERGY.  `k` this module's block, `f` a film's (faces), `s` the gap state."""
    _face(k, f, s, False)


@njit(cache=True)
def rub(k, f, s):
    """As `press`; also the friction torque the shaft supplies (N m, sign of SPIN_DIFFERENCE), share of the face in
    contact, largest contact pressure (Pa), stored energy (J), and mean depth rate of wear of both faces (m/s).

    The normal pressure needs no torque on the slope of the faces: p_c is a function of h, so around any circle
    `int p_c dh/dtheta dtheta = -[W] = 0`.
    """
    _face(k, f, s, True)
