"""The exact motion of a linear scene of constant conditions, by its matrix exponential."""

import numpy as np

from .contract import BETWEEN

# What lies between exact steps is interpolated (numerics/hermite.py); that error is at most BETWEEN of the
# tolerance.  For exp(x) through six steps of x radians it is BY x^12 at most, or WORST; at a segment's ends, where all
# neighbours are on one side, 2000 times as much: there the steps are half as long.
BY, WORST, CONDITIONS, MOST_RADIANS = 1e-7, 30.0, 12, 1.5
# Steps at once: while their length changes fast, and as long as it would not change by much; at the ends; points of the
# quadrature in each.
CHANGING, LASTING, AT_ENDS, POINTS = 8, (256, 128, 64, 32, 16), 4, 5
# Share of a decaying part below which its decay, and not what is found of it, says how large it is.
ROUNDED = 1e-3


def expm(segment, tau, y, method, tolerance, counts):
    """Exact steps of a linear scene, with the contract of contract.py, as long as what moves in it allows; the works by
    Gauss quadrature on them.  **Valid** linear film, constant conditions, rings with mass."""
    motion, n, fresh, before = segment.exact_motion(), segment.n_mechanical, True, None
    points, weights = np.polynomial.legendre.leggauss(POINTS)
    while tau < segment.length:
        free = y[:n] - motion.forced([tau])[0]
        exponents, sizes = motion.parts(free, segment.scales[:n])
        # What is small as a displacement may be large as a rate.
        sizes = sizes * np.maximum(np.abs(exponents) / segment.reference_rate, 1.0)
        if before is not None and motion.sound:
            # What is left far beyond its decay is rounding of the rest, which no step need follow.
            due = before[1] * np.exp(np.minimum(exponents.real * (tau - before[0]), 0.0))
            sizes = np.where(due < ROUNDED * sizes, due, sizes)
        before = tau, sizes
        step, count = _exact_step(exponents, sizes, tolerance)
        step = min(step, segment.longest_step())
        widths = _widths(segment.length - tau, step, AT_ENDS if fresh else count, fresh)
        times, fresh = tau + np.cumsum(widths), False
        if segment.length - times[-1] < 0.5 * widths[-1]:
            times[-1] = segment.length
        inside = (times[:, None] - 0.5 * widths[:, None] * (1.0 - points)).ravel()
        at, count = np.concatenate([times, inside]), len(times)
        states = np.zeros((len(at), segment.size))
        states[:, :n] = motion.forced(at) + motion.free(free, at - tau)
        powers = segment.derivatives(inside, states[count:])[:, n:].reshape(count, POINTS, -1)
        counts.rhs += len(inside)
        states[:count, n:] = y[n:] + np.cumsum(0.5 * widths[:, None] * (weights @ powers), axis=0)
        tau, y = float(times[-1]), states[count - 1].copy()
        yield times, states[:count], None


def _exact_step(exponents, sizes, tolerance) -> tuple[float, int]:
    """Longest step (s) whose interpolation keeps the tolerance, and how many of them: few where a part dies away or
    grows and the step will change.  `exponents` (1/s) of what moves and its `sizes` beside the scales."""
    budget, rates = BETWEEN * tolerance / max(len(sizes), 1), np.abs(exponents)

    def longest(sizes):
        seen = (sizes * WORST > budget) & (rates > 0)
        if not np.any(seen):
            return np.inf
        radians = np.minimum((budget / (BY * sizes[seen])) ** (1.0 / CONDITIONS), MOST_RADIANS)
        return float(np.min(radians / rates[seen]))

    def after(time):
        return sizes * np.exp(np.minimum(exponents.real * time, 50.0))

    step = longest(sizes)
    if not np.isfinite(step):
        return step, CHANGING
    for count in LASTING:
        if 0.8 * step < longest(after(count * step)) < 1.3 * step:
            return step, count
    return min(step, longest(np.maximum(sizes, after(CHANGING * step)))), CHANGING


def _widths(remaining, step, count, fresh) -> np.ndarray:
    """Widths of the next `count` steps, or of all that are `remaining` (s), the last few of them and fresh ones half as
    long."""
    if fresh:
        return np.full(count, min(0.5 * step, remaining / (2 * count)))
    if remaining > (count + AT_ENDS) * step:
        return np.full(count, step)
    whole = int(np.ceil(max(remaining / step - 0.5 * AT_ENDS, 0.0)))
    widths = np.concatenate([np.ones(whole), np.full(AT_ENDS, 0.5)])
    return widths * remaining / widths.sum()
