"""Asperities pressed together on an annulus whose gap is linear in r and tilted: integrals of the laws.

A law is a polynomial over the touching part of a radius: Gauss points are exact there.  Around the circle the touching
arc is split where an edge of the annulus enters or leaves the asperities; between the integrand is analytic, and Gauss
points converge exponentially however narrow the arc.
"""

import math

from ..numerics.kernel import inner_kernel
from .roughness import BEYOND, SERIES_SIZE

# Layout of the contact block: then the series, then nodes and weights on [0, 1] of the radius and of a panel of the
# circle.
TOP, SPAN, SHEAR_OF_LOAD, SHEAR_OF_AREA, WEAR_PER_LOAD, FACE_AREA, RADIAL, AROUND, LOAD = range(9)
AREA = LOAD + SERIES_SIZE
ENERGY = AREA + SERIES_SIZE
NODES = ENERGY + SERIES_SIZE


@inner_kernel()
def pressed(k, series, u, head):
    """A law at u: `head` (u^4 or u^5) times its series in v = 2u - 1, or what continues it beyond u = 1; in the unit of
    the series (LOAD Pa, AREA 1, ENERGY J/m^2), whose first slot in the block `k` is `series`."""
    if u > 1.0:
        e, tail = u - 1.0, series + BEYOND
        return k[tail] + e * (k[tail + 1] + e * (k[tail + 2] + e * k[tail + 3]))
    if u <= 0.0:
        return 0.0
    v, value = 2.0 * u - 1.0, 0.0
    for n in range(series + 1 + int(k[series]), series, -1):
        value = value * v + k[n]
    return head * value


@inner_kernel()
def _part(k, r_i, r_a, r_b, u_a, u_b, complete):
    """Integrals over a smooth part of a radius: of p r, p r^2; and, if `complete`, of area r, area r^2, energy r,
    p r^2 (r - r_i)."""
    points = int(k[RADIAL])
    load = arm = area = area_arm = energy = outwards = 0.0
    for n in range(points):
        y = k[NODES + n]
        u, r = u_a + y * (u_b - u_a), r_a + y * (r_b - r_a)
        w = k[NODES + points + n] * (r_b - r_a) * r
        head = u * u * u * u
        p = w * pressed(k, LOAD, u, head)
        load += p
        arm += p * r
        if complete:
            a = w * pressed(k, AREA, u, head)
            area += a
            area_arm += a * r
            energy += w * pressed(k, ENERGY, u, head * u)
            outwards += p * r * (r - r_i)
    return load, arm, area, area_arm, energy, outwards


@inner_kernel()
def touching_radius(k, r_i, r_o, u_i, u_o, complete):
    """As `_part`, over all of a radius that touches; u is linear between u_i and u_o."""
    # From the less to the more pressed end; going inwards the integrals change sign.
    turn = 1.0 if u_i <= u_o else -1.0
    r_a, u_a, r_b, u_b = (r_i, u_i, r_o, u_o) if u_i <= u_o else (r_o, u_o, r_i, u_i)
    if u_b <= 0.0:
        return 0.0, 0.0, 0.0, 0.0, 0.0, 0.0
    if u_a < 0.0:
        r_a, u_a = r_a - u_a * (r_b - r_a) / (u_b - u_a), 0.0
    if u_a >= 1.0 or u_b <= 1.0:
        a, b, c, d, e, g = _part(k, r_i, r_a, r_b, u_a, u_b, complete)
        return turn * a, turn * b, turn * c, turn * d, turn * e, turn * g
    r_1 = r_a + (1.0 - u_a) * (r_b - r_a) / (u_b - u_a)
    a, b, c, d, e, g = _part(k, r_i, r_a, r_1, u_a, 1.0, complete)
    a1, b1, c1, d1, e1, g1 = _part(k, r_i, r_1, r_b, 1.0, u_b, complete)
    return turn * (a + a1), turn * (b + b1), turn * (c + c1), turn * (d + d1), turn * (e + e1), turn * (g + g1)


@inner_kernel()
def _crossing(low, swing, level):
    """Angle from the thinnest place where low + swing (1 - cos beta) passes `level`; 0 or pi if it never does."""
    if level <= low:
        return 0.0
    if level >= low + 2.0 * swing:
        return math.pi
    return 2.0 * math.asin(math.sqrt((level - low) / (2.0 * swing)))


@inner_kernel()
def annulus(k, r_i, r_o, r_m, tilt, low_i, low_o, complete):
    """Load (N), its integral with the radius (N m), its moment along the tilt (N m); and, if `complete`, touching area
    (m^2), its integral with the radius (m^3), stored energy (J), and the load's integral with r (r - r_i) (N m^2).

    `k` the contact block; the gap is linear in r, smallest `low_i` at r_i and `low_o` at r_o (m), and tilted by `tilt`
    (rad) at its own radius, or at `r_m` (m) if that is not 0.
    """
    mean, top, per_span = r_m != 0.0, k[TOP], 1.0 / k[SPAN]
    swing_i, swing_o = (r_m * tilt, r_m * tilt) if mean else (r_i * tilt, r_o * tilt)

    # Where an edge of it meets the first asperities, and where its last are flattened.
    b_1, b_2 = _crossing(low_i, swing_i, top), _crossing(low_o, swing_o, top)
    b_3, b_4 = _crossing(low_i, swing_i, top - k[SPAN]), _crossing(low_o, swing_o, top - k[SPAN])
    end, points, nodes = max(b_1, b_2), int(k[AROUND]), NODES + 2 * int(k[RADIAL])

    load = arm = along = area = area_arm = energy = outwards = start = 0.0
    while start < end:
        stop = end
        for b in (b_1, b_2, b_3, b_4):
            if start < b < stop:
                stop = b
        for n in range(points):
            # 1 - cos beta = 2 sin^2(beta / 2): no cancellation in a narrow arc.
            rise = 2.0 * math.sin(0.5 * (start + k[nodes + n] * (stop - start))) ** 2
            u_i, u_o = (top - low_i - swing_i * rise) * per_span, (top - low_o - swing_o * rise) * per_span
            a, b, c, d, e, g = touching_radius(k, r_i, r_o, u_i, u_o, complete)
            w = 2.0 * (stop - start) * k[nodes + points + n]
            load += w * a
            arm += w * b
            # Where the tilt's arm is the mean radius so is the moment's: else there were no potential.
            along -= w * (1.0 - rise) * (r_m * a if mean else b)
            area += w * c
            area_arm += w * d
            energy += w * e
            outwards += w * g
        start = stop
    return load, arm, along, area, area_arm, energy, outwards
