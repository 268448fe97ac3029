"""Rough faces at a mean film h: share in contact, mean cube, the contact laws as polynomials, and their integrals
over an annulus whose gap is linear in r and tilted.

**Source** Lebeck, Teale & Pierce, ONR ME-95(79)ONR-414-1 (1979), ch. 2 (Christensen's polynomial heights);
Greenwood & Williamson, *Proc. R. Soc. A* 295 (1966), eqs. 10-12 (Gaussian heights).  Plateaus: the report's Gaussian
heights s of both faces that end at t s touch on the share Phi(-t)^2 of the area once the mean film is below 2 t s,
however much below; its load begins with a jump.  Here plateaus have a finish of their own, Christensen's heights, on
which they meet: the jump is its limit, and load, area and energy are those of Christensen's law on that share.  What
slopes from a plateau into a valley does not touch.

A law is a *series*: with u = 0 where the asperities first meet and u = 1 where all are flattened it is u^4 Q(v),
v = 2u - 1, so that it begins smoothly; beyond u = 1 it goes on as a cubic at most.

A law is a polynomial over the touching part of a radius: Gauss points are exact there.  Around the circle the touching
arc is split where an edge of the annulus enters or leaves the asperities; between the integrand is analytic, and Gauss
points converge exponentially however narrow the arc.
"""

import math
from functools import lru_cache

import numpy as np

from ..numerics.kernel import inner_kernel
from ..scene.forces import HALF_HEIGHT, REACH

# A series in a block: degree of Q, its coefficients (room for DEGREE), and four of the continuation.
DEGREE = 16
BEYOND = DEGREE + 2
SERIES_SIZE = BEYOND + 4


def contact_fraction(x):
    """Share P(x) of the area in contact at mean film h = x c, Christensen's heights; elementwise.

    **Source** Lebeck et al. (1979): `1/2 - (35/32)(x - x^3 + 3x^5/5 - x^7/7)`, here factored about x = 1.
    """
    u = np.clip(0.5 * (1.0 - np.asarray(x, dtype=float)), 0.0, 1.0)
    return u**4 * (35.0 - u * (84.0 - u * (70.0 - 20.0 * u)))


def mean_film_cubed(x):
    """E(H^3)/c^3 of the film between Christensen's surfaces at mean film h = x c; elementwise.  0 for x <= -1.

    **Source** Lebeck et al. (1979), ch. 2: the mean cube, in place of h^3 in Poiseuille flow.
    """
    x = np.asarray(x, dtype=float)
    t = np.clip(x, -1.0, 1.0)
    even = 7 / 256 + t**2 * (105 / 256 + t**2 * (35 / 128 + t**2 * (-7 / 128 + t**2 * (3 / 256 - t**2 / 768))))
    return np.where(x >= 1.0, x**3 + x / 3.0, even + t / 6.0 + t**3 / 2.0)


def gaussian_overlap(n: float, d):
    """F_n(d) = int_d^inf (s - d)^n phi(s) ds, phi the normal density; dimensionless, d elementwise, -4 <= d <= 6.

    **Source** Greenwood & Williamson (1966), eq. 12.
    """
    node, weight = np.polynomial.legendre.leggauss(160)
    # s = d + w^2 makes half powers smooth; beyond d + 14 nothing is left.
    w = 0.5 * math.sqrt(14.0) * (1.0 + node)
    s = np.asarray(d, dtype=float)[..., None] + w * w
    density = np.exp(-0.5 * s * s) / math.sqrt(2.0 * math.pi)
    return density @ (math.sqrt(14.0) * weight * w ** (2.0 * n + 1.0))


def plateau_share(truncation: float) -> float:
    """Share of the area on which both of two faces with Gaussian heights are cut off at `truncation` of their own rms
    heights above the mean plane.

    **Source** Lebeck et al. (1979), ch. 2, `Phi(-t/s)^2`.
    """
    return (0.5 * math.erfc(truncation / math.sqrt(2.0))) ** 2


@lru_cache(maxsize=1)
def christensen_series() -> np.ndarray:
    """Slots (SERIES_SIZE,) of the contact fraction of Christensen's heights, c (u = 0) to -c (u = 1): exact."""
    return series(np.polynomial.Polynomial([35.0, -84.0, 70.0, -20.0])(np.polynomial.Polynomial([0.5, 0.5])).coef)


@lru_cache(maxsize=4)
def gaussian_series(n: float) -> np.ndarray:
    """Slots (SERIES_SIZE,) of F_n(h / rms), from 5 rms (u = 0) to -3 rms (u = 1): least squares of the relative error
    where F_n is above 1e-5.  Within 1e-3 of F_n up to 3.5 rms; beyond, the load is below 1e-5 of that at h = 0 and ends
    smoothly."""
    v = np.cos(np.pi * (np.arange(800) + 0.5) / 800)
    u = 0.5 * (1.0 + v)
    exact = gaussian_overlap(n, REACH - (REACH + HALF_HEIGHT) * u)
    weight = (exact + 1e-5) ** -0.75
    columns = (weight * u**4)[:, None] * np.polynomial.chebyshev.chebvander(v, DEGREE)
    found = np.linalg.lstsq(columns, weight * exact, rcond=None)[0]
    return series(np.polynomial.chebyshev.cheb2poly(found))


def series(q: np.ndarray) -> np.ndarray:
    """Slots (SERIES_SIZE,) of u^4 Q(v), `q` (degree + 1,) the coefficients of Q, lowest first; continued beyond u = 1
    with the same value, slope and bend."""
    slots = np.zeros(SERIES_SIZE)
    slots[0], slots[1 : 1 + len(q)] = len(q) - 1, q
    whole = np.polynomial.Polynomial([0.5, 0.5]) ** 4 * np.polynomial.Polynomial(q)
    beyond = np.array([whole(1.0), 2.0 * whole.deriv()(1.0), 2.0 * whole.deriv(2)(1.0)])
    # Christensen's law is constant there: rounding must not grow with (u - 1)^2.
    slots[BEYOND : BEYOND + 3] = np.where(np.abs(beyond) < 1e-9 * beyond[0], 0.0, beyond)
    return slots


def scaled(slots: np.ndarray, factor: float) -> np.ndarray:
    """The slots (SERIES_SIZE,) of a series times a factor, whose unit it takes; its degree stays."""
    return np.concatenate([slots[:1], factor * slots[1:]])


def stored(load: np.ndarray, span: float) -> np.ndarray:
    """Slots (SERIES_SIZE,) of the energy W = span int_0^u p du = u^5 R(v) (J/m^2) from those of the load p (Pa) and the
    span (m): from 5 R + u dR/du = span Q, highest power first."""
    degree = int(load[0])
    q, r = load[1 : 2 + degree], np.zeros(degree + 2)
    for n in range(degree, -1, -1):
        r[n] = (span * q[n] - (n + 1) * r[n + 1]) / (5 + n)
    slots = np.zeros(SERIES_SIZE)
    slots[: degree + 2] = degree, *r[:-1]
    p, slope, bend = load[BEYOND : BEYOND + 3]
    slots[BEYOND:] = r.sum(), span * p, span * slope / 2.0, span * bend / 3.0
    return slots


# Layout of the contact block: then the series; annuli of a face with grooves, how many (0: none), room for their radii
# and for the share of each that is land; then nodes and weights on [0, 1] of the radius and of a panel of the circle.
MOST_ANNULI = 4
TOP, SPAN, SHEAR_OF_LOAD, SHEAR_OF_AREA, WEAR_PER_LOAD, FACE_AREA, RADIAL, AROUND, LOAD = range(9)
AREA = LOAD + SERIES_SIZE
ENERGY = AREA + SERIES_SIZE
ANNULI = ENERGY + SERIES_SIZE
ANNULUS_RADII, LAND_SHARES = ANNULI + 1, ANNULI + 2 + MOST_ANNULI
NODES = LAND_SHARES + MOST_ANNULI


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
