"""Quadrature over the accepted steps of a solver: what is integrated is known anywhere between them, at a price."""

import math

import numpy as np

from .kernel import outer_kernel

# Lobatto's rule of five points on [0, 1], its inner points, their weights and that of an outer one: exact to degree
# seven, LOBATTO_ERROR (w h)^LOBATTO_ORDER for an oscillation w on a panel h.
INNER = 0.5 - 0.5 * math.sqrt(3.0 / 7.0), 0.5, 0.5 + 0.5 * math.sqrt(3.0 / 7.0)
INNER_WEIGHTS, OUTER_WEIGHT = (49.0 / 180.0, 16.0 / 45.0, 49.0 / 180.0), 1.0 / 20.0
LOBATTO_ERROR, LOBATTO_ORDER = 7e-10, 8
# Steps in a panel at most: of a smooth motion that a method of order five follows, they are resolved about as well as
# by the method.  And by how much they may differ.
TOGETHER, UNLIKE = 6, 4.0


@outer_kernel()
def lobatto(t, begin, end, until, longest, times, weights):
    """Points `times` (s) and their `weights` (s) of Lobatto's rule of five over the steps [begin, end] of `t` (s), no
    farther than `until`; returns how many, or -1 where there is no room for them.

    A panel is one step or a few alike, at most `longest` (s); a longer step is several.  The first point is the step
    `begin`, whose weight is added to."""
    a, k, count = t[begin], begin, 1
    if len(times) == 0:
        return -1
    times[0] = a
    while k < end:
        first, b = t[k + 1] - t[k], min(t[k + 1], until)
        k += 1
        taken = 1
        while k < end and taken < TOGETHER:
            step, far = t[k + 1] - t[k], min(t[k + 1], until)
            if far - a > longest or step > UNLIKE * first or UNLIKE * step < first:
                break
            b = far
            k += 1
            taken += 1
        if b <= a:
            continue
        pieces = max(1, math.ceil((b - a) / longest))
        if count + 4 * pieces > len(times):
            return -1
        width, low = (b - a) / pieces, a
        for piece in range(pieces):
            weights[count - 1] += OUTER_WEIGHT * width
            for i in range(3):
                times[count + i], weights[count + i] = low + INNER[i] * width, INNER_WEIGHTS[i] * width
            low = b if piece == pieces - 1 else a + (piece + 1) * width
            times[count + 3], weights[count + 3] = low, OUTER_WEIGHT * width
            count += 4
        a = b
    return count


def points(t, begin: int, end: int, until: float, longest: float) -> tuple[np.ndarray, np.ndarray]:
    """The same as arrays of their own."""
    room = 1 + 4 * int(end - begin + (until - t[begin]) / longest)
    times, weights = np.empty(room), np.zeros(room)
    count = lobatto(t, begin, end, until, longest, times, weights)
    return times[:count], weights[:count]
