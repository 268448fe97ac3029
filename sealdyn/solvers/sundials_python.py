"""CVODE and IDA through scikit-sundae: Python at every evaluation.  Any segment, any system that it has a wheel for."""

import warnings

import numpy as np

from .contract import FEW, MANY, MOST_STEPS, SolverFailure, absolute_tolerances, failure_message, longest_step

# Chunks of SUNDIALS' steps, and what a healthy one may cost (evaluations per fastest forcing period): beyond it
# something is closing or crawling, and it is walked step by step.
FIRST_CHUNK, STEPS_PER_CHUNK, BUDGET = 20.0, 3000, 400.0


def _in_chunks(solver, segment, tau, y, yp, method, counts, allow):
    """Steps of a SUNDIALS solver over a segment, many at a time.

    `solve` over two times returns every step at half the cost of asking for them one by one, but cannot be
    stopped: so a chunk may cost so many evaluations only (`allow`), else it is walked again step by step.
    The integrator restarts at each chunk, some thirty short steps in thousands.
    """
    span, end = FIRST_CHUNK * segment.shortest_period, segment.length
    if segment.may_change:
        # Equations that may change at any step are not integrated far ahead.
        yield from _one_by_one(solver, end, tau, y, yp, method, FEW)
        return
    while tau < end:
        # No crumb at the end of a segment: its steps would drown in rounding.
        stop = end if tau + 1.2 * span >= end else tau + span
        before = counts.rhs
        allow(int(BUDGET * (stop - tau) / segment.shortest_period) + 2000)
        try:
            result = (
                solver.solve(np.array([tau, stop]), y) if yp is None else solver.solve(np.array([tau, stop]), y, yp)
            )
        except _TooLong:
            allow(None)
            counts.rhs = before
            tau, y, yp = yield from _one_by_one(solver, stop, tau, y, yp, method)
            continue
        if len(result.t) > 1:
            yield result.t[1:], result.y[1:], None if yp is None else result.yp[1:]
        if not result.success:
            raise SolverFailure(failure_message(method, result.message, result.t[-1]))
        taken = len(result.t) - 1
        tau, y, yp = float(result.t[-1]), result.y[-1].copy(), None if yp is None else result.yp[-1].copy()
        span = (stop - tau + span) * min(max(STEPS_PER_CHUNK / max(taken, 1), 0.2), 4.0)


def _one_by_one(solver, end, tau, y, yp, method, block=MANY):
    """The same, step by step: for stretches that may not end well.  Returns time, unknowns and derivatives there."""
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
            y, yp = ys[-1], yps[-1]
            ts, ys, yps = [], [], []
        if not result.success:
            raise SolverFailure(failure_message(method, result.message, result.t))
    return tau, y, yp


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


def cvode(segment, tau, y, method, tolerance, counts, max_order: int | None = None):
    """Steps of CVODE, Adams if so called, else BDF, with the contract of contract.py.
    **Raises** SolverFailure."""
    from sksundae.cvode import CVODE

    options = {"max_order": max_order} if max_order else {}

    rhs, jacobian = segment.rhs, segment.jacobian
    check, allow = _counting(counts)

    def counted(t, y, yp):
        check()
        rhs(t, y, yp)

    def counted_jacobian(t, y, yp, jac):
        counts.jacobians += 1
        counts.rhs += segment.n_mechanical
        jacobian(t, y, yp, jac)

    solver = CVODE(
        counted,
        method="Adams" if method == "adams" else "BDF",
        rtol=tolerance,
        atol=absolute_tolerances(segment, tolerance),
        jacfn=counted_jacobian,
        max_step=longest_step(segment),
        max_num_steps=MOST_STEPS,
        **options,
    )
    yield from _in_chunks(solver, segment, tau, y, None, method, counts, allow)


def ida(segment, tau, y, method, tolerance, counts, max_order: int | None = None):
    """Steps of IDA, on the residual form, with the contract of contract.py; `y` is made consistent first.
    **Raises** SolverFailure."""
    from sksundae.ida import IDA

    inner = segment.residual
    check, allow = _counting(counts)

    def counted(t, y, yp, res):
        check()
        inner(t, y, yp, res)

    options = {"algebraic_idx": segment.algebraic} if len(segment.algebraic) else {}
    options |= {"max_order": max_order} if max_order else {}
    if segment.film.stop > segment.film.start:
        options |= _film_options(segment, counts)
    y, yp = segment.start(tau, y)
    with warnings.catch_warnings():
        # It warns that a pattern beside derivatives is used for its shape only.
        warnings.simplefilter("ignore", UserWarning)
        solver = IDA(counted, rtol=tolerance, atol=absolute_tolerances(segment, tolerance), max_num_steps=MOST_STEPS,
                     max_step=longest_step(segment), **options)  # fmt: skip
    yield from _in_chunks(solver, segment, tau, y, yp, method, counts, allow)


def _film_options(segment, counts) -> dict:
    """Options of IDA for a film with unknowns: its pattern, and the derivatives that the segment knows."""
    derivatives = segment.residual_derivatives

    def jacobian(t, y, yp, res, cj, data):
        counts.jacobians += 1
        counts.rhs += segment.n_mechanical + 1
        derivatives(t, y, yp, cj, data)

    return {"linsolver": "sparse", "sparsity": segment.pattern, "jacfn": jacobian}
