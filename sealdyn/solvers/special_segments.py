"""Integrators of special segments: the exact motion of a linear scene of constant conditions, by its matrix
exponential, and TR-BDF2 for segments that settle a stage themselves, with kinks that the Newton iteration of a library
does not pass, such as cavities that open and close.

    y_1 = y + d h (y' + y_1'),   y_2 = y + h (w y' + w y_1' + d y_2'),   d = 1 - 1/sqrt 2, w = sqrt 2 / 4

**Source** of TR-BDF2: Bank et al. (1985), IEEE Trans. CAD 4, 436; as a Runge-Kutta method with an embedded one of third
order: Hosea & Shampine (1996), Appl. Numer. Math. 20, 21.  Second order, L-stable: what is infinitely stiff is gone
after a step, and neither stage remembers more of the past than the step's start.
"""

import math

import numpy as np

from .contract import BETWEEN, BLOCK_OF_STEPS, SolverFailure, failure_message

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


D, W = 1.0 - math.sqrt(0.5), 0.25 * math.sqrt(2.0)
# The step's result less the embedded one of third order, over h, of the three rates.
ERROR = np.array([W - (1.0 - W) / 3.0, W - (3.0 * W + 1.0) / 3.0, D - D / 3.0])
# First step over the shortest period; limits of a step's change; the least step over its end.
FIRST, GROW, SHRINK, SAFE, LEAST = 1e-8, 5.0, 0.2, 0.85, 1e-13
# Newton's last change over the tolerance.
ARRIVED = 3e-2


def trbdf2(segment, tau, y, method, tolerance, counts):
    """Steps with the contract of contract.py.  The segment has a `stage(tau, alpha, base, guess, near, small)`:
    unknowns and rates with the residual zero where these are alpha (y - base), None where there are none; `settled`,
    how often it settled its film; and `stage_error(error, alpha)`, the size of an error (size,) of a step relative to
    the scales.  **Raises** SolverFailure."""
    y, yp = segment.start(tau, y.copy())
    h = min(FIRST * segment.shortest_period, segment.longest_step() or math.inf)
    most, end = segment.longest_step() or math.inf, segment.length
    ts: list[float] = []
    ys: list[np.ndarray] = []
    yps: list[np.ndarray] = []
    bend = np.zeros_like(y)
    counts.back_end = "TR-BDF2, film settled at each stage"
    while tau < end:
        h = min(h, most)
        # No crumb is left for the last step.
        h = end - tau if h > 0.999 * (end - tau) else min(h, 0.5 * (end - tau)) if h > 0.5 * (end - tau) else h
        if h < LEAST * end:
            if ts:
                yield np.array(ts), np.array(ys), np.array(yps)
            reason = segment.failure() or "the step vanishes"
            raise SolverFailure(failure_message(method, f"{reason}.", tau))
        before = segment.settled
        found = _step(segment, tau, h, y, yp, bend, tolerance)
        counts.rhs += segment.settled - before
        if found is None:
            counts.unsolved += 1
            h *= 0.25
            continue
        y_new, yp_new, size = found
        size /= tolerance
        factor = min(GROW, max(SHRINK, SAFE * size ** (-1.0 / 3.0))) if size > 0.0 else GROW
        if not size <= 1.0:
            counts.rejected += 1
            h *= min(factor, 0.9) if size < math.inf else SHRINK
            continue
        bend = (yp_new - yp) / h
        tau, y, yp = end if h == end - tau else tau + h, y_new, yp_new
        segment.failure()
        counts.orders[1] += 1
        ts.append(tau)
        ys.append(y)
        yps.append(yp)
        # The matrix of a stage is kept while the step is.
        h *= factor if factor > 1.2 or factor < 1.0 else 1.0
        if len(ts) == BLOCK_OF_STEPS or tau >= end:
            yield np.array(ts), np.array(ys), np.array(yps)
            ts, ys, yps = [], [], []
    return


def _step(segment, tau, h, y, yp, bend, tolerance):
    """Unknowns and rates at the end of a step and the size of its error; None where a stage has no solution.  `bend`
    (size,): how the rates changed over the step before."""
    alpha, small = 1.0 / (D * h), ARRIVED * tolerance
    base = y + D * h * yp
    reach = 2.0 * D * h
    first = segment.stage(tau + reach, alpha, base, y + reach * (yp + 0.5 * reach * bend), y, small)
    if first is None:
        return None
    y_1, yp_1 = first
    base = y + h * W * (yp + yp_1)
    left = h - reach
    second = segment.stage(tau + h, alpha, base, y_1 + left * (yp_1 + 0.5 * left * (yp_1 - yp) / reach), y_1, small)
    if second is None:
        return None
    y_2, yp_2 = second
    error = h * (ERROR[0] * yp + ERROR[1] * yp_1 + ERROR[2] * yp_2)
    return y_2, yp_2, segment.stage_error(error, alpha)
