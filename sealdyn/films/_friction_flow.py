"""Adiabatic flow of an ideal gas with wall friction through a channel whose area changes, in closed form.

**Source** The equation that Zuk, NASA TM X-68022 (1972), marches: Fanning friction factor f, film h, area A, x along
the flow, g the ratio of specific heats,

    dm/m = (-2 dA/A + 2 g f m dx/h) (1 + d m)/(1 - m),   m = M^2,   d = (g - 1)/2

Where e = dA/A / (g f dx/h) is constant (the `shape`) it integrates.  Upstream of a place where S = 1/m + d is S_b, in
a variable t that grows against the flow,

    a = 1 + e d,   k = (exp(e t) - 1)/(e S_b),   S = S_b exp(-e t)(1 + a k)
    2 g f int dx/h = t - (1 + d) ln(1 + a k)/a

(derived here: dS = (a - e S) dt, 2 g f dx/h = (S - 1 - d)/S dt).  It is regular at m = 1, at e = 0, e = 1 and a = 0,
and on the line m = e, which no flow crosses: channels that narrow or widen, flows that speed up or slow down are one
formula.
**Valid** subsonic to sonic.
"""

import math

from ..numerics.kernel import inner_kernel


@inner_kernel()
def shrinkage(z):
    """(1 - exp(-z))/z."""
    return 1.0 if z == 0.0 else -math.expm1(-z) / z


@inner_kernel()
def blended_friction(laminar, turbulent, reynolds):
    """Fanning friction factor (f_l^8 + f_t^8)^(1/8) of f_l = `laminar`/Re and f_t = `turbulent`/Re^(1/4), of which one
    may be 0."""
    laminar, turbulent = laminar / reynolds, turbulent / math.sqrt(math.sqrt(reynolds))
    large, small = max(laminar, turbulent), min(laminar, turbulent)
    if small == 0.0:
        return large
    square = (small / large) * (small / large)
    return large * math.sqrt(math.sqrt(math.sqrt(1.0 + square * square * square * square)))


@inner_kernel()
def upstream(shape, state, t, d):
    """S and 2 g f int dx/h at `t` upstream of where S is `state`."""
    z, a = shape * t, 1.0 + shape * d
    if z > 40.0:
        # On the line m = e, to rounding.
        return a / shape, t - (1.0 + d) * (z + math.log(a / (shape * state))) / a
    grown = math.expm1(z)
    k = grown / (shape * state) if shape != 0.0 else t / state
    log = math.log1p(a * k) / a if a != 0.0 else k
    return state * (1.0 + a * k) / (1.0 + grown), t - (1.0 + d) * log


@inner_kernel()
def span(shape, state, wanted, start, d):
    """t at which 2 g f int dx/h is `wanted`, and S there, by Newton's method from `start` (0: none); t = -1 where the
    flow would have been sonic before."""
    if shape * (state - d) >= 1.0:
        # The flow slows down: from below Newton's steps stay below, and leave the subsonic range only if the flow does.
        t = wanted
    elif start > 0.0:
        t = start
    else:
        t = wanted + (1.0 + d) * math.log1p((wanted + math.sqrt(2.0 * (1.0 + d) * wanted)) / state)
    for _ in range(60):
        if shape * t < -600.0:
            # A start too near to a sonic exit has thrown a step far out.
            t = -1.0 / shape
        here, length = upstream(shape, state, t, d)
        if not here - d > 1.0:
            return -1.0, state
        step = (wanted - length) * here / (here - d - 1.0)
        # Newton's method squares what is left, and so does S along its slope.
        if abs(step) <= 1e-7 * t:
            return t + step, here + (1.0 - shape * (here - d)) * step
        t = max(t + step, 0.5 * t)
    return -1.0, state
