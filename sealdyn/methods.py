"""The integrators: CVODE and IDA through scikit-sundae, SciPy's references, the matrix exponential.

Each is a generator over one leg of a problem: it yields blocks `(times (m,), unknowns (m, size), derivatives or
None)` of accepted steps, in leg time, the first after the start, the last at the leg's end.
"""

from dataclasses import dataclass

import numpy as np

# Measured over the shipped scenarios (tests/convergence): error relative to the scales, per solver tolerance, of a
# damped scene and per remembered period of an undamped one.  Multistep methods err by up to a tolerance a step
# and always the same way; CVODE's Adams stays at low order on an undamped oscillation (its step may only grow by
# half or more), so it takes some seventy steps a period whatever the tolerance.
SAFETY = {
    "adams": (60.0, 100.0),
    "bdf": (400.0, 400.0),
    "ida": (200.0, 400.0),
    "dop853": (60.0, 3.0),
    "radau": (30.0, 3.0),
    "expm": (1.0, 0.0),
}
TIGHTEST = 3e-14
# Blocks of single steps; chunks of SUNDIALS' steps, and what a healthy one may cost (evaluations per
# fastest forcing period): beyond it something is closing or crawling, and it is walked step by step.
BLOCK, FIRST_CHUNK, STEPS_PER_CHUNK, BUDGET = 192, 20.0, 3000, 400.0
# Steps handed over at once where the equations may change.
FEW = 12


class SolverFailure(RuntimeError):
    """A solver gave up: the sentence says why and what to try."""


@dataclass
class Counts:
    """Own counts; a solver's own omit finite-difference Jacobians."""

    rhs: int = 0
    steps: int = 0
    jacobians: int = 0
    restarts: int = 0


def tolerance_for(method: str, accuracy: float, memory: float) -> float:
    """Solver tolerance that keeps the asked accuracy with this method.

    `memory` is for how many of its fastest periods the scene remembers an error: one or so when it is well damped,
    the whole run when it is not.  Never below TIGHTEST, where rounding takes over.
    """
    damped, per_period = SAFETY[method]
    return max(accuracy / max(damped, per_period * memory), TIGHTEST)


def attainable(method: str, memory: float) -> float:
    """Best accuracy this method can keep on a scene of that memory."""
    damped, per_period = SAFETY[method]
    return TIGHTEST * max(damped, per_period * memory)


def _tolerances(problem, tolerance):
    absolute = tolerance * problem.scales
    # The sum of absolute powers has kinks and only normalises the audit: no error control on it.
    absolute[-1] = 1e30
    return absolute


def _longest(problem):
    """Longest step as SUNDIALS wants it: 0 means any."""
    longest = problem.longest_step()
    return longest if np.isfinite(longest) else 0.0


def _in_chunks(solver, problem, leg, tau, y, yp, method, counts, allow):
    """Steps of a SUNDIALS solver over a leg, many at a time.

    `solve` over two times returns every step at half the cost of asking for them one by one, but cannot be
    stopped: so a chunk may cost so many evaluations only (`allow`), else it is walked again step by step.
    The integrator restarts at each chunk, some thirty short steps in thousands.
    """
    span, end = FIRST_CHUNK * problem.fast_time, leg.length
    if problem.sticking:
        # Equations that may change at any step are not integrated far ahead.
        yield from _one_by_one(solver, end, tau, y, yp, method, FEW)
        return
    while tau < end:
        # No crumb at the end of a leg: its steps would drown in rounding.
        stop = end if tau + 1.2 * span >= end else tau + span
        before = counts.rhs
        allow(int(BUDGET * (stop - tau) / problem.fast_time) + 2000)
        try:
            result = (
                solver.solve(np.array([tau, stop]), y) if yp is None else solver.solve(np.array([tau, stop]), y, yp)
            )
        except _TooLong:
            allow(None)
            counts.rhs = before
            yield from _one_by_one(solver, stop, tau, y, yp, method)
            tau, y, yp = _one_by_one.last
            continue
        if len(result.t) > 1:
            yield result.t[1:], result.y[1:], None if yp is None else result.yp[1:]
        if not result.success:
            raise SolverFailure(_said(method, result.message, result.t[-1]))
        taken = len(result.t) - 1
        tau, y, yp = float(result.t[-1]), result.y[-1].copy(), None if yp is None else result.yp[-1].copy()
        span = (stop - tau + span) * min(max(STEPS_PER_CHUNK / max(taken, 1), 0.2), 4.0)


def _one_by_one(solver, end, tau, y, yp, method, block=BLOCK):
    """The same, step by step: for stretches that may not end well."""
    solver.init_step(tau, y) if yp is None else solver.init_step(tau, y, yp)
    ts, ys, yps = [], [], []
    result = None
    while tau < end:
        result = solver.step(end, "onestep", end)
        if result.success:
            tau = result.t
            ts.append(tau)
            ys.append(result.y)
            yps.append(None if yp is None else result.yp)
        if ts and (len(ts) >= block or tau >= end or not result.success):
            yield np.array(ts), np.array(ys), None if yp is None else np.array(yps)
            _one_by_one.last = (ts[-1], ys[-1], yps[-1])
            ts, ys, yps = [], [], []
        if not result.success:
            raise SolverFailure(_said(method, result.message, result.t))


class _TooLong(Exception):
    """A chunk costs more evaluations than any healthy one."""


def _counting(counts):
    """A counter to call before each evaluation, and a switch that limits how many more there may be."""
    limit = [None]

    def allow(calls):
        limit[0] = None if calls is None else counts.rhs + calls

    def check():
        counts.rhs += 1
        if limit[0] is not None and counts.rhs > limit[0]:
            raise _TooLong

    return check, allow


def cvode(problem, leg, tau, y, method, tolerance, counts, **options):
    """Steps of CVODE, Adams if so called, else BDF; `options` of its own, such as `max_order`."""
    from sksundae.cvode import CVODE

    rhs, jacobian = problem.rhs, problem.jacobian
    check, allow = _counting(counts)

    def counted(t, y, yp):
        check()
        rhs(t, y, yp)

    def counted_jacobian(t, y, yp, jac):
        counts.jacobians += 1
        counts.rhs += problem.n_mechanical
        jacobian(t, y, yp, jac)

    solver = CVODE(
        counted,
        method="Adams" if method == "adams" else "BDF",
        rtol=tolerance,
        atol=_tolerances(problem, tolerance),
        jacfn=counted_jacobian,
        max_step=_longest(problem),
        max_num_steps=1_000_000,
        **options,
    )
    yield from _in_chunks(solver, problem, leg, tau, y, None, method, counts, allow)


def _ida(problem, leg, tau, y, method, tolerance, counts):
    from sksundae.ida import IDA

    inner = problem.residual
    check, allow = _counting(counts)

    def counted(t, y, yp, res):
        check()
        inner(t, y, yp, res)

    options = {"algebraic_idx": problem.algebraic} if len(problem.algebraic) else {}
    solver = IDA(counted, rtol=tolerance, atol=_tolerances(problem, tolerance), max_num_steps=1_000_000,
                 max_step=_longest(problem), **options)  # fmt: skip
    yield from _in_chunks(solver, problem, leg, tau, y, problem.start_rates(tau, y), method, counts, allow)


def _scipy(problem, leg, tau, y, method, tolerance, counts):
    from scipy.integrate import DOP853, Radau

    kind = DOP853 if method == "dop853" else Radau
    yield from scipy_steps(kind, kind is Radau, problem, leg, tau, y, method, tolerance, counts)


def scipy_steps(kind, implicit, problem, leg, tau, y, method, tolerance, counts):
    """Steps of one of SciPy's solvers (the class `kind`); an `implicit` one is given the problem's Jacobian."""
    inner = problem.rhs

    def counted(t, y):
        counts.rhs += 1
        yp = np.empty_like(y)
        inner(t, y, yp)
        return yp

    def differences(t, y):
        # SciPy's own steps of the tolerance times 1e-8 drown beside a clearance.
        matrix = np.empty((problem.size, problem.size))
        counts.jacobians += 1
        counts.rhs += problem.n_mechanical
        problem.jacobian(t, np.array(y), None, matrix)
        return matrix

    options = {"jac": differences} if implicit else {}
    # SciPy's own floor on rtol is 100 eps; the absolute part carries the accuracy below it.  Its norm is an average:
    # the unweighted last unknown would only loosen it, by sqrt(n/(n-1)).
    solver = kind(counted, tau, y, leg.length, rtol=max(tolerance, 2.3e-14), atol=_tolerances(problem, tolerance),
                  max_step=problem.longest_step(), **options)  # fmt: skip
    while solver.status == "running":
        # A trial stage may fly off and overflow; the error norm then refuses the step.
        with np.errstate(all="ignore"):
            message = solver.step()
        if solver.status == "failed":
            raise SolverFailure(_said(method, message, solver.t))
        yield np.array([solver.t]), solver.y[None, :].copy(), None


# What lies between exact steps is interpolated (dense.py); that error is at most this share of the tolerance.  For
# exp(x) through six steps of x radians it is BY x^12 at most, or WORST; at a leg's ends, where all neighbours are on
# one side, 2000 times as much: there the steps are half as long.
BETWEEN, BY, WORST, CONDITIONS, MOST_RADIANS = 0.1, 1e-7, 30.0, 12, 1.5
# Steps at once: while their length changes fast, and as long as it would not change by much; at the ends; points of the
# quadrature in each.
CHANGING, LASTING, AT_ENDS, POINTS = 8, (256, 128, 64, 32, 16), 4, 5


def _expm(problem, leg, tau, y, method, tolerance, counts):
    """Exact steps of a linear scene, as long as what moves in it allows; the works by Gauss quadrature on them."""
    motion, n, fresh = problem.exact_motion(), problem.n_mechanical, True
    points, weights = np.polynomial.legendre.leggauss(POINTS)
    while tau < leg.length:
        free = y[:n] - motion.forced([tau])[0]
        step, count = _exact_step(*motion.parts(free, problem.scales[:n]), tolerance)
        widths = _widths(leg.length - tau, step, AT_ENDS if fresh else count, fresh)
        times, fresh = tau + np.cumsum(widths), False
        if leg.length - times[-1] < 0.5 * widths[-1]:
            times[-1] = leg.length
        inside = (times[:, None] - 0.5 * widths[:, None] * (1.0 - points)).ravel()
        at, count = np.concatenate([times, inside]), len(times)
        states = np.zeros((len(at), problem.size))
        states[:, :n] = motion.forced(at) + motion.free(free, at - tau)
        powers = problem.derivatives(inside, states[count:])[:, n:].reshape(count, POINTS, -1)
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


def _widths(left, step, count, fresh) -> np.ndarray:
    """Widths of the next `count` steps, or of all that are `left` (s), the last few of them and fresh ones half as
    long."""
    if fresh:
        return np.full(count, min(0.5 * step, left / (2 * count)))
    if left > (count + AT_ENDS) * step:
        return np.full(count, step)
    whole = int(np.ceil(max(left / step - 0.5 * AT_ENDS, 0.0)))
    widths = np.concatenate([np.ones(whole), np.full(AT_ENDS, 0.5)])
    return widths * left / widths.sum()


METHODS = {"adams": cvode, "bdf": cvode, "ida": _ida, "dop853": _scipy, "radau": _scipy, "expm": _expm}


def _said(method, message, tau):
    return (
        f"{method} gave up {tau:.6g} s into this leg: {message}  "
        "Try a looser run.accuracy, another run.solver, or look whether the film is closing there."
    )
