"""TR-BDF2 for segments that settle a stage themselves: what has kinks that the Newton iteration of a library does not
pass, such as cavities that open and close.

    y_1 = y + d h (y' + y_1'),   y_2 = y + h (w y' + w y_1' + d y_2'),   d = 1 - 1/sqrt 2, w = sqrt 2 / 4

**Source** Bank et al. (1985), IEEE Trans. CAD 4, 436; as a Runge-Kutta method with an embedded one of third order:
Hosea & Shampine (1996), Appl. Numer. Math. 20, 21.  Second order, L-stable: what is infinitely stiff is gone after a
step, and neither stage remembers more of the past than the step's start.
"""

import math

import numpy as np

from .contract import BLOCK_OF_STEPS, SolverFailure, failure_message

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
    ts, ys, yps, bend = [], [], [], np.zeros_like(y)
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
        ts.append(tau), ys.append(y), yps.append(yp)
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
