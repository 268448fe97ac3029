"""Integrators that no library has: the exact motion of a linear scene of constant conditions, by its matrix
exponential; TR-BDF2 for segments that settle a stage themselves, with kinks that the Newton iteration of a library does
not pass, such as cavities that open and close; and implicit collocation of high order with its own step control, the
reference that no run integrates with.

    y_1 = y + d h (y' + y_1'),   y_2 = y + h (w y' + w y_1' + d y_2'),   d = 1 - 1/sqrt 2, w = sqrt 2 / 4

**Source** of TR-BDF2: Bank et al. (1985), IEEE Trans. CAD 4, 436; as a Runge-Kutta method with an embedded one of third
order: Hosea & Shampine (1996), Appl. Numer. Math. 20, 21.  Second order, L-stable: what is infinitely stiff is gone
after a step, and neither stage remembers more of the past than the step's start.  Of collocation: Hairer & Wanner
(1996), Solving ODEs II, IV.5 and IV.8: at Gauss nodes it has order 2 s, at the right-hand Radau nodes 2 s - 1 and damps
what is infinitely stiff.
**Valid** of collocation: smooth scenes reach rounding; kinks of the right-hand side cost short steps, not accuracy.
"""

import math
from functools import lru_cache

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


# Stages; the error estimate is filtered with this multiple of the step, so that what is stiff does not count.
GAUSS, RADAU, FILTER = 6, 5, 0.2
# Steps per fastest period at least: the motion between them is interpolated.
PER_PERIOD, MOST = 48, 4000
ITERATIONS, SLOW, ROUNDING = 14, 0.3, 2e-16
SHORTEST = 1e-12


@lru_cache
def rule(stages: int, radau: bool):
    """Nodes (s,), matrix (s, s) and weights (s,) of the collocation on [0, 1], the error weights (s + 1,) of the
    quadrature through the start and all nodes but the first, the weights (2, s) that carry the nodes on to 0 and 1."""
    if radau:
        # (P_s - P_{s-1}) on [-1, 1]: its roots include the right end.
        shifted = np.polynomial.legendre.Legendre([0.0] * (stages - 1) + [-1.0, 1.0])
        nodes = np.sort(shifted.roots().real)
        nodes[-1] = 1.0
    else:
        nodes = np.polynomial.legendre.leggauss(stages)[0]
    points, weights = np.polynomial.legendre.leggauss(stages)
    c = 0.5 * (1.0 + nodes)

    def integrals(knots, upto):
        """Integrals of the Lagrange polynomials on `knots` from 0 to `upto`."""
        at = 0.5 * upto * (1.0 + points)
        values = [math.prod((at - b) / (a - b) for b in knots if b != a) for a in knots]
        return np.array([0.5 * upto * float(weights @ v) for v in values])

    matrix = np.array([integrals(c, x) for x in c])
    b = integrals(c, 1.0)
    other = integrals(np.concatenate([[0.0], c[1:]]), 1.0)
    error = np.concatenate([[other[0], 0.0], other[1:]]) - np.concatenate([[0.0], b])
    return c, matrix, b, error, _carried(c, np.array([0.0, 1.0]))


def collocation(segment, tau, y, method, tolerance, counts):
    """Steps of a segment from `tau` (s) and the unknowns `y` (size,), with the contract of contract.py; `method`
    "gauss" or "radau_nodes".

    `tolerance` bounds the embedded error estimate, which is of far lower order than the method: the error itself is
    orders smaller.  A massless ring is integrated through its consistent derivatives.
    **Raises** SolverFailure where the step vanishes, and for an undamped massless ring.
    """
    radau = method != "gauss"
    c, a, b, error, ends = rule(RADAU if radau else GAUSS, radau)
    rhs, n = _rates(segment, counts), segment.n_mechanical
    scale, largest = segment.scales[:n], min(segment.shortest_period / PER_PERIOD, segment.longest_step())
    if not segment.imposed_pace and not len(segment.rows):
        # Nothing is imposed: what creeps for many periods need not be followed by each of them.
        largest = max(largest, segment.length / MOST)
    order = len(c) + 1
    h = min(1e-3 * segment.shortest_period / PER_PERIOD, segment.length - tau)
    f, stages, inverse, jac, built = rhs(tau, y), None, None, None, None
    while tau < segment.length:
        h = segment.length - tau if tau + 1.0001 * h >= segment.length else h
        if h < SHORTEST * max(segment.length, 1e-300) and tau + h < segment.length:
            raise SolverFailure(f"collocation gave up {tau:.6g} s into this segment: its step vanished")
        if jac is None:
            jac = _jacobian(rhs, tau, y, f, segment)
            built = None
        if built != h:
            inverse, built = np.linalg.inv(np.eye(n * len(c)) - h * np.kron(a, jac)), h
        guess = np.tile(f, (len(c), 1)) if stages is None else stages
        k = _stages(rhs, tau, h, y, guess, c, a, inverse, n, scale)
        if k is None:
            # A fresh matrix first, then shorter steps.
            h, jac, stages = (h, None, None) if stages is not None else (0.3 * h, None, None)
            continue
        there = y + h * (b @ k)
        f_there = rhs(tau + h, there)
        # Between the ends and their nodes nobody has looked: a kink there shows in the derivatives at the ends.
        before, after = np.stack([f, f_there]) - ends @ k
        embedded = error[0] * f + error[1:] @ k
        estimates = h * np.stack([embedded, 0.5 * c[0] * before, 0.5 * (1.0 - c[-1]) * after])[:, :n].T
        estimates = np.linalg.solve(np.eye(n) - FILTER * h * jac, estimates)
        size = float(np.max(np.abs(estimates) / scale[:, None])) / tolerance
        factor = min(max(0.8 * max(size, 1e-12) ** (-1.0 / order), 0.2), 3.0)
        if size > 1.0:
            h, stages = factor * h, None
            continue
        tau = segment.length if h == segment.length - tau else tau + h
        y, f = there, f_there
        yield np.array([tau]), y[None, :].copy(), f[None, :].copy()
        following = min(largest, factor * h)
        # The same step again keeps the matrix.
        following = h if h <= following < 1.3 * h else following
        # The derivatives carried on to the nodes of the next step.
        stages = _carried(c, 1.0 + following / h * c) @ k
        if counts.steps % 8 == 0 or following != h:
            jac = None
        h = following
        counts.jacobians += jac is None


def _rates(segment, counts):
    """The right-hand side; a massless ring's from its consistent derivatives."""
    if segment.has_residual_form:
        if len(segment.algebraic):
            raise SolverFailure("collocation needs derivatives, and an undamped massless ring has none")

        def consistent(t, y):
            counts.rhs += 1
            return segment.start(t, y)[1]

        return consistent

    def plain(t, y):
        counts.rhs += 1
        yp = np.empty(segment.size)
        segment.rhs(t, y, yp)
        return yp

    return plain


def _jacobian(rhs, t, y, f, segment):
    n = segment.n_mechanical
    jac, moved = np.empty((n, n)), y.copy()
    for j in range(n):
        step = 1e-7 * max(abs(y[j]), segment.scales[j])
        moved[j] = y[j] + step
        jac[:, j] = (rhs(t, moved)[:n] - f[:n]) / step
        moved[j] = y[j]
    return jac


def _stages(rhs, tau, h, y, k, c, a, inverse, n, scale):
    """Derivatives at the nodes (s, size) by simplified Newton; None if it does not converge."""
    k, before = k.copy(), math.inf
    for _ in range(ITERATIONS):
        places = y + h * (a @ k)
        fresh = np.array([rhs(tau + x * h, place) for x, place in zip(c, places, strict=True)])
        if not np.all(np.isfinite(fresh)):
            return None
        # The works feed nothing back: they take the fresh values.
        change = (inverse @ (fresh - k)[:, :n].ravel()).reshape(len(c), n)
        fresh[:, :n] = k[:, :n] + change
        k = fresh
        size = float(np.max(np.abs(h * change) / scale))
        if size < 50 * ROUNDING:
            return k
        if size > SLOW * before:
            # Rounding, or no contraction.
            return k if size < 1e-11 else None
        before = size
    return None


def _carried(c, at):
    """Weights (m, s) of values at the nodes for their polynomial at other places."""
    return np.array([[math.prod((x - e) / (d - e) for e in c if e != d) for d in c] for x in at])
