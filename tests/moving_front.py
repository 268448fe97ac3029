"""A cavity that opens and closes between parallel faces that are squeezed, in closed form.

    (H^3 P_x)_x = 2 (theta H)_t,  0 < x < 1,  H(t) given,  P = EDGE at both edges,  P >= 0

Full film: P = EDGE - (H'/H^3) x (1 - x).  It tears when P falls to 0 in the middle: there a cavity spans at once from
front to front, where P = 0 and P_x = 0, and inside it theta H stays what it was.  The fronts that grow are those where
P and its slope vanish; while they come back, they sweep up liquid:

    full from 0 to the front s: P = EDGE - (EDGE/s + b s) x + b x^2,  b = H'/H^3
    flow at the front:          H^3 P_x(s) = -2 (H - m(s)) s',  m(x) = what theta H was left there

**Source** derived here; the case and its numbers after Optasanu & Bonneau (2000) and Ausas, Jai & Buscaglia (2009).
"""

import math

import numpy as np
from scipy.integrate import solve_ivp
from scipy.optimize import brentq

EDGE = 0.025


def height(t):
    """H(t)."""
    return 0.375 + 0.125 * math.cos(4.0 * math.pi * t)


def height_rate(t):
    """H'(t)."""
    return -0.5 * math.pi * math.sin(4.0 * math.pi * t)


def _growing(t):
    """Where a full film with P = P_x = 0 at its end reaches to: EDGE = b s^2."""
    return math.sqrt(EDGE * height(t) ** 3 / height_rate(t))


def rupture():
    """When the film tears: EDGE = b/4."""
    return brentq(lambda t: height_rate(t) / height(t) ** 3 - 4.0 * EDGE, 0.25, 0.3)


def turning():
    """When the front is nearest to the edge: H'/H^3 is largest."""
    return brentq(lambda t: _growing(t + 1e-6) - _growing(t - 1e-6), 0.26, 0.45)


def fronts(times):
    """Front at `times` after its turning, and when the cavity has closed."""
    begun, torn = turning(), rupture()
    # What is left where the front passed outwards, at the time it did; in the middle since it tore.
    passed = np.linspace(torn + 1e-9, begun, 20001)
    where, left = np.array([_growing(t) for t in passed]), np.array([height(t) for t in passed])
    where, left = where[::-1], left[::-1]

    def rate(t, s):
        s = min(float(s[0]), 0.5)
        kept = np.interp(s, where, left)
        b = height_rate(t) / height(t) ** 3
        slope = -EDGE / s + b * s
        return [-(height(t) ** 3) * slope / (2.0 * (height(t) - kept))]

    def closed(t, s):
        return s[0] - 0.5

    closed.terminal = True
    # A little after the turning, where front and what is left there are the same: along the growing law backwards.
    start = begun + 2e-4
    found = solve_ivp(rate, (start, 0.8), [_growing(begun) * (1.0 + 1e-5)], events=closed, rtol=1e-10, atol=1e-12,
                      dense_output=True)  # fmt: skip
    return [float(found.sol(t)[0]) for t in times], float(found.t_events[0][0])
