"""Steady pressures at a gap state, whose rates are those of the gap: Newton's method on the balances of all cells.

Angles are taken up from both sides of the first one in turn, 0, 1, -1, 2, ...: neighbours on the circle are at most two
apart, so that elimination stays in a band.
"""

import numpy as np

from ...faces.geometry import INNER_PRESSURE, OUTER_PRESSURE
from ...numerics.kernel import inner_kernel, outer_kernel
from .balance import AFTER, BEFORE, INNER, OUTER, OWN, rates, slopes, state
from .cells import ANGLES, CELLS, thickness_rates, thicknesses

# Newton's steps, the change of a pressure after which only rounding is left, and how near to zero a step may take a
# pressure; the change from which on what closing adds counts fully.
MOST_STEPS, ARRIVED, NEAREST, NEAR = 200, 1e-9, 0.1, 0.01
# Least pressure, and least pressure of which flows have their slope, as shares of the lower one of the edges.
LEAST, SLOPED = 1e-6, 1e-3
UNSOLVED = 1


@inner_kernel()
def _place(k, angles):
    """Place in the band of angle k."""
    return 2 * k - 1 if 0 < k <= angles // 2 else 2 * (angles - k) % (2 * angles)


@inner_kernel()
def _eliminate(band, y):
    """Solve with a band matrix (n, 2 width + 1), its diagonal in the middle, and `y` (n,), both of which it spoils; the
    solution is left in `y`.  Returns whether all pivots are numbers other than 0."""
    n, width = band.shape[0], band.shape[1] // 2
    for i in range(n):
        pivot = band[i, width]
        if not abs(pivot) > 0.0:
            return False
        last = min(width, n - 1 - i)
        for down in range(1, last + 1):
            share = band[i + down, width - down] / pivot
            if share != 0.0:
                for across in range(1, last + 1):
                    band[i + down, width - down + across] -= share * band[i, width + across]
                y[i + down] -= share * y[i]
    for i in range(n - 1, -1, -1):
        for across in range(1, min(width, n - 1 - i) + 1):
            y[i] -= band[i, width + across] * y[i + across]
        y[i] /= band[i, width]
    return True


@inner_kernel()
def _first(f, s, x):
    """Pressures of a flow over the radius alone between still faces: p^2 falls with the way."""
    angles, cells = int(f[ANGLES]), int(f[CELLS])
    p_i, p_o = s[INNER_PRESSURE], s[OUTER_PRESSURE]
    h, _, ways, _, _, _ = state(f, s, x)
    for k in range(angles):
        total, reached = np.sum(1.0 / ways[k]), 0.0
        for j in range(cells):
            reached += 1.0 / (ways[k, j] * total)
            x[k * cells + j] = h[k, j + 1] * (p_i * p_i + reached * (p_o * p_o - p_i * p_i)) ** 0.5


@outer_kernel()
def start(f, s, x):
    """Unknowns `x` (n,) of the steady film at a gap state: p h_t + wm d(p h)/dtheta = what flows in.  A film that opens
    so fast that it would be drawn empty keeps the least pressure.  Returns 0, or a code where none is found."""
    angles, cells = int(f[ANGLES]), int(f[CELLS])
    n, width = angles * cells, 2 * cells
    x[:] = 0.0
    _first(f, s, x)
    h, h_rate = np.empty((angles, cells + 2)), np.empty((angles, cells))
    thicknesses(f, s, h, np.empty(angles))
    thickness_rates(f, s, h, h_rate)
    left, rows, band, y = np.empty(n), np.empty((n, 5)), np.empty((n, 2 * width + 1)), np.empty(n)
    far, strayed, low = True, False, min(s[INNER_PRESSURE], s[OUTER_PRESSURE])
    for _ in range(MOST_STEPS):
        now = state(f, s, x)
        rates(f, s, x, *now, left)
        # Where no pressure is left, a flow does not know its slope.
        _, p, ways, slips, ways_around, slips_around = now
        slopes(f, s, h, np.maximum(p, SLOPED * low), ways, slips, ways_around, slips_around, rows)
        band[:] = 0.0
        for k in range(angles):
            here = _place(k, angles) * cells
            after, before = _place((k + 1) % angles, angles) * cells, _place((k - 1) % angles, angles) * cells
            for j in range(cells):
                i, at = k * cells + j, here + j
                squeezed = h_rate[k, j] / h[k, j + 1]
                y[at] = left[i] - squeezed * x[i]
                # Far below its pressure a film that closes would be driven farther down by what closing has of it.
                band[at, width] = (max(squeezed, 0.0) if far else squeezed) - rows[i, OWN]
                if j > 0:
                    band[at, width - 1] -= rows[i, INNER]
                if j < cells - 1:
                    band[at, width + 1] -= rows[i, OUTER]
                band[at, width + after - here] -= rows[i, AFTER]
                band[at, width + before - here] -= rows[i, BEFORE]
        if not _eliminate(band, y):
            return UNSOLVED
        change = highest = 0.0
        for k in range(angles):
            for j in range(cells):
                i, before = k * cells + j, x[k * cells + j]
                x[i] = max(before + y[_place(k, angles) * cells + j], NEAREST * before, LEAST * low * h[k, j + 1])
                change = max(change, abs(x[i] - before) / h[k, j + 1])
                highest = max(highest, x[i] / h[k, j + 1])
        if not change < np.inf:
            return UNSOLVED
        if change < ARRIVED * highest:
            return 0
        # Once has shown whether it may count.
        strayed |= not far and change > NEAR * highest
        far = strayed or change > NEAR * highest
    return UNSOLVED
