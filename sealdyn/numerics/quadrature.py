"""Quadrature over the accepted steps of a solver: what is integrated is known anywhere between them, at a price."""

import math

import numpy as np

from .kernel import outer_kernel

# Lobatto's rule of four points on [0, 1], its inner points and the weights of an outer and of an inner one: exact to
# degree five, 6.6e-7 (w h)^6 for an oscillation w on a panel h.
INNER = 0.5 - 0.5 / math.sqrt(5.0), 0.5 + 0.5 / math.sqrt(5.0)
OUTER_WEIGHT, INNER_WEIGHT = 1.0 / 12.0, 5.0 / 12.0
LOBATTO_ERROR = 6.6e-7
# Steps in a panel at most: of a smooth motion that a method of order five follows, they are resolved as well as by the
# method.  And by how much they may differ.
TOGETHER, UNLIKE = 4, 4.0


@outer_kernel()
def lobatto(t, begin, end, until, longest, times, weights):
    """Points `times` (s) and their `weights` (s) of Lobatto's rule of four over the steps [begin, end] of `t` (s), no
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
        if count + 3 * pieces > len(times):
            return -1
        width, low = (b - a) / pieces, a
        for piece in range(pieces):
            weights[count - 1] += OUTER_WEIGHT * width
            for i in range(2):
                times[count + i], weights[count + i] = low + INNER[i] * width, INNER_WEIGHT * width
            low = b if piece == pieces - 1 else a + (piece + 1) * width
            times[count + 2], weights[count + 2] = low, OUTER_WEIGHT * width
            count += 3
        a = b
    return count


def points(t, begin: int, end: int, until: float, longest: float) -> tuple[np.ndarray, np.ndarray]:
    """The same as arrays of their own."""
    room = 1 + 3 * int(end - begin + (until - t[begin]) / longest)
    times, weights = np.empty(room), np.zeros(room)
    count = lobatto(t, begin, end, until, longest, times, weights)
    return times[:count], weights[:count]
