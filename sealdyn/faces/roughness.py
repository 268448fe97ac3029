"""Rough faces at a mean film h: share in contact, mean film, and the two contact laws as polynomials.

**Source** Lebeck, Teale & Pierce, ONR ME-95(79)ONR-414-1 (1979), ch. 2 (Christensen's polynomial heights);
Greenwood & Williamson, *Proc. R. Soc. A* 295 (1966), eqs. 10-12 (Gaussian heights).

A law is a *series*: with u = 0 where the asperities first meet and u = 1 where all are flattened it is u^4 Q(v),
v = 2u - 1, so that it begins smoothly; beyond u = 1 it goes on as a cubic at most.
"""

import math
from functools import lru_cache

import numpy as np

from ..scene.contact import HALF_HEIGHT, REACH

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


def mean_film(x):
    """E(H)/c of the film between Christensen's surfaces at mean film h = x c; elementwise.  0 for x <= -1.

    **Source** Lebeck et al. (1979), ch. 2: the mean of max(h + d, 0) over Christensen's heights d, here factored.
    """
    x = np.asarray(x, dtype=float)
    u = np.clip(0.5 * (1.0 - x), 0.0, 1.0)
    inside = x + 2.0 * u**5 * (7.0 - u * (14.0 - u * (10.0 - 2.5 * u)))
    return np.where(x <= -1.0, 0.0, inside)


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
