"""Dense output from the accepted steps: Hermite interpolation through several steps at once.

scikit-sundae gives no dense output and charges a call for every output point.  Each step however yields
displacement and rate, so n neighbouring steps give 2n conditions: a polynomial of degree 2n - 1 through
six steps is exact to far below the step's own error, at a fraction of the cost.
**Valid** between steps of like size; neighbours much shorter or longer than the interval are left out, and so is
what only grows with the degree: the steps' own errors, magnified where short steps stand beside a longer one (after
each start of a solver: up to 26 times).  At worst the two ends of the interval remain: a cubic.

And quadrature over the steps: what is integrated is known anywhere between them, at a price.
"""

import math

import numpy as np

from .kernel import inner_kernel, outer_kernel

NODES = 6
SHORTEST, LONGEST = 0.3, 4.0
# Six steps of a motion add terms that fall by more than this from each step to the next.
FALLS = 0.25
# Outer points of Gauss's rule of three on [-1, 1].
GAUSS = math.sqrt(0.6)


@inner_kernel()
def window(t, k, count, longest):
    """First and one-past-last step (int, int) that the interpolant of the interval [t[k], t[k+1]] uses; `t` (s) the
    times of the `count` steps; up to `longest` times as long."""
    first, last = k, k + 2
    span = t[k + 1] - t[k]
    go_left = go_right = True
    while last - first < NODES and (go_left or go_right):
        go_left = go_left and first > 0 and SHORTEST * span <= t[first] - t[first - 1] <= longest * span
        go_right = go_right and last < count and SHORTEST * span <= t[last] - t[last - 1] <= longest * span
        left_near = go_left and (not go_right or k - first <= last - (k + 2))
        if left_near:
            first -= 1
        elif go_right:
            last += 1
    return first, last


@inner_kernel()
def fit(t, q, q_rate, k, count, table, nodes):
    """Divided differences (confluent, Newton form) of every displacement for interval k.

    `t` (count,), `q` and `q_rate` (count, n); `table` (2 NODES, n) and `nodes` (2 NODES,) are filled.
    Returns the number of conditions used: 4 (a cubic) to 2 NODES.
    """
    first, last = window(t, k, count, LONGEST)
    size = 2 * (last - first)
    # Order the steps by distance from the interval: the leading terms are then the cubic.
    left, right, near = k, k + 1, k + 1
    for m in range(0, size, 2):
        nodes[m] = nodes[m + 1] = t[near]
        for i in range(q.shape[1]):
            table[m, i], table[m + 1, i] = q[near, i], q_rate[near, i]
        if near == right:
            right += 1
            near = left if left >= first else right
        else:
            left -= 1
            near = right if right < last else left
    # In its second place each step holds its rate: the first difference there.
    for m in range(size - 2, 0, -2):
        span = nodes[m] - nodes[m - 2]
        for i in range(q.shape[1]):
            table[m, i] = (table[m, i] - table[m - 2, i]) / span
    for order in range(2, size):
        for m in range(size - 1, order - 1, -1):
            span = nodes[m] - nodes[m - order]
            for i in range(q.shape[1]):
                table[m, i] = (table[m, i] - table[m - 1, i]) / span
    _drop_noise(0.5 * (t[k] + t[k + 1]), table, nodes, size)
    return size


@inner_kernel()
def _drop_noise(middle, table, nodes, size):
    """Zero what each further step adds in the middle of the interval, from where it is more than the step before did:
    the motion's terms shrink, those of the steps' errors grow.  Terms that were small by chance are followed by ones
    that fall again, and fast."""
    pairs, steps, product = np.zeros((NODES, table.shape[1])), size // 2, 1.0
    for m in range(size):
        pair = pairs[m // 2]
        for i in range(len(pair)):
            term = abs(table[m, i] * product)
            pair[i] = term if term > pair[i] else pair[i]
        product *= middle - nodes[m]
    for i in range(table.shape[1]):
        for j in range(2, steps):
            if pairs[j, i] > pairs[j - 1, i]:
                falls = j + 1 < steps
                for later in range(j + 1, steps):
                    falls = falls and pairs[later, i] < FALLS * pairs[later - 1, i]
                if not falls:
                    for m in range(2 * j, size):
                        table[m, i] = 0.0
                    break


@inner_kernel()
def value(table, nodes, size, at, q, q_rate):
    """Displacements and rates (n,) at the time `at` from the differences of `fit` (Horner), into `q` and `q_rate`;
    `size` conditions."""
    for i in range(len(q)):
        q[i], q_rate[i] = table[size - 1, i], 0.0
    for m in range(size - 2, -1, -1):
        x = at - nodes[m]
        for i in range(len(q)):
            q_rate[i] = q_rate[i] * x + q[i]
            q[i] = q[i] * x + table[m, i]


@outer_kernel()
def sample(t, q, q_rate, count, begin, end, times, out, out_rate):
    """Displacements and rates at increasing `times` (m,), all inside steps [begin, end] of the `count`, into `out` and
    `out_rate` (m, n); `t` (count,), `q`, `q_rate` (count, n)."""
    n = q.shape[1]
    table, nodes = np.zeros((2 * NODES, n)), np.zeros(2 * NODES)
    k, size = begin, 0
    for j in range(len(times)):
        moved = size == 0
        while k < end - 1 and times[j] > t[k + 1]:
            k += 1
            moved = True
        if moved:
            size = fit(t, q, q_rate, k, count, table, nodes)
        value(table, nodes, size, times[j], out[j], out_rate[j])


@outer_kernel()
def sample_doubtful(t, q, q_rate, count, begin, end, times, out):
    """As `sample`, without the rates, of `q` whose rates may be inexact: in a stiff scene those magnify an error of `q`
    by the fastest decay.  Between two steps where the rates move the interpolant by more than the values alone leave
    open, they are left out.
    **Valid** steps that are short beside the motion, as those of a multistep method."""
    n = q.shape[1]
    table, nodes, unused = np.zeros((2 * NODES, n)), np.zeros(2 * NODES), np.empty(n)
    plain, own, there = np.zeros((n, NODES)), np.zeros(NODES), np.empty(n)
    trusted = np.ones(n, dtype=np.bool_)
    k, size, known = begin, 0, 0
    for j in range(len(times)):
        moved = size == 0
        while k < end - 1 and times[j] > t[k + 1]:
            k += 1
            moved = True
        if moved:
            size = fit(t, q, q_rate, k, count, table, nodes)
            known = _plain(t, q, k, count, plain, own)
            middle = 0.5 * (t[k] + t[k + 1])
            value(table, nodes, size, middle, there, unused)
            for i in range(n):
                found, last = _newton(plain, own, known, i, middle)
                trusted[i] = abs(there[i] - found) <= last
        value(table, nodes, size, times[j], out[j], unused)
        for i in range(n):
            if not trusted[i]:
                out[j, i], _ = _newton(plain, own, known, i, times[j])


@inner_kernel()
def _plain(t, q, k, count, table, own):
    """Divided differences of the values alone at the steps around interval `k`, into `table`, and these steps, from the
    nearest, into `own`; returns how many.  Beside a short step (a run's last) longer ones are counted in: two values
    alone would not tell how well they do."""
    first, last = window(t, k, count, math.inf)
    left, right, near = k, k + 1, k + 1
    for m in range(last - first):
        own[m] = t[near]
        for i in range(q.shape[1]):
            table[i, m] = q[near, i]
        if near == right:
            right += 1
            near = left if left >= first else right
        else:
            left -= 1
            near = right if right < last else left
    for i in range(q.shape[1]):
        for order in range(1, last - first):
            for m in range(last - first - 1, order - 1, -1):
                table[i, m] = (table[i, m] - table[i, m - 1]) / (own[m] - own[m - order])
    return last - first


@inner_kernel()
def _newton(table, nodes, count, i, at):
    """Value of row `i` at the time `at`, and the size of the last of its terms there."""
    total, product, term = 0.0, 1.0, 0.0
    for m in range(count):
        term = table[i, m] * product
        total += term
        product *= at - nodes[m]
    return total, abs(term)


@outer_kernel()
def integrals(t, rates, begin, end):
    """Integrals (end - begin, n) of `rates` (m, n) at the times `t` (m,) over each step of [begin, end]: of the
    polynomial through the steps around it.
    **Valid** steps short beside the motion: a tenth of a radian leaves 1e-10 of it."""
    count, n = rates.shape
    out = np.zeros((end - begin, n))
    for k in range(begin, end):
        first, last = window(t, k, count, LONGEST)
        width = t[k + 1] - t[k]
        for j in range(first, last):
            # Of the Lagrange polynomial that is one there: three Gauss points are exact to degree five.
            weight = 0.0
            for point in range(3):
                at = t[k] + 0.5 * width * (1.0 + (point - 1) * GAUSS)
                value = 8.0 / 18.0 if point == 1 else 5.0 / 18.0
                for m in range(first, last):
                    if m != j:
                        value *= (at - t[m]) / (t[j] - t[m])
                weight += value
            for i in range(n):
                out[k - begin, i] += width * weight * rates[j, i]
    return out


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
