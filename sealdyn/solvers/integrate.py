"""Integrate any problem with any method into any sink.

A problem offers `n` displacements first in its unknowns, `legs` (each with `length`), `begin(k)`,
`rhs(tau, y, yp)`, `residual(tau, y, yp, res)`, `start_rates`, `jacobian`, `scales`, `motion`, `energies`,
`derivatives`, `watch`, `y0`, `memory`, `works` (where they stand), `impulses`, `longest_step`,
and `sticking`: None, or what finds and makes changes of the equations between steps.
A sink takes what has been integrated.  Nothing here knows of seals or files.
"""

import time as clock
from dataclasses import dataclass, replace
from fractions import Fraction
from functools import partial

import numpy as np

from ..numerics.hermite import sample
from .contract import Counts, SolverFailure, tolerance_for
from .energy_audit import Audit
from .methods import METHODS
from .sundials import BLOCK, FEW

# Steps kept to the left of what is worked on, and left for later on the right: neighbours for dense output.
OVERLAP = 4
CRUMB = 1e-14
# By how much a tolerance is sharpened when errors grow too large.
SHARPER = 10.0


@dataclass
class Outcome:
    """How a run ended: status, a sentence, counts, wall time (s), last leg, leg time and unknowns."""

    status: str
    message: str
    counts: Counts
    wall_time: float
    leg: int
    tau: float
    y: np.ndarray
    tolerance: float
    energy_residual: float = 0.0


def solve(
    problem, method: str, accuracy: float, sink, *, audit=None, errors=None, resume=None, steps=None, tolerance=None
) -> Outcome:
    """Integrate a problem leg by leg, chunk by chunk, into a sink.

    `method` one of METHODS, `accuracy` relative to each unknown's scale; `audit` an Audit to go on with; `errors` a
    StepErrors that is shown every step, or None; `resume` = (leg, tau, y) continues.  Another method comes as `steps`,
    a generator with the contract of solvers/methods.py, called `method`, with its own `tolerance`.
    The sink offers `due(leg_index) -> leg times of output`, `take(leg_index, times, q, q_rate)`,
    `state(leg_index, tau, y)`, `event(leg_index, tau, event)`, and may raise KeyboardInterrupt from `take` to stop.
    Returns an Outcome; a failed run is a result.
    """
    begun = clock.perf_counter()
    steps, tolerance = steps or METHODS[method], tolerance or tolerance_for(method, accuracy, problem.memory)
    counts, audit = Counts(), audit or Audit(problem)
    first, tau, y = resume if resume else (0, 0.0, problem.y0.copy())
    status, message, index = "ok", "done", first

    def method_over(leg, tau, y):
        return steps(problem, leg, tau, y, method, tolerance, counts)

    def sharper():
        """Whether there is a sharper tolerance to go on with, which then is the run's."""
        nonlocal tolerance
        found = tolerance > errors.least
        tolerance = max(tolerance / SHARPER, errors.least)
        return found

    try:
        for index in range(first, len(problem.legs)):
            leg = problem.begin(index)
            if problem.sticking and index == first and not resume:
                problem.sticking.start(tau, y)
            while True:
                counts.restarts += 1
                tau, y, collapse = _run_leg(
                    problem, index, leg, tau, y, method_over, sink, audit, errors, sharper, counts
                )
                if collapse or tau >= leg.length:
                    break
            if collapse:
                status, message = "collapsed", collapse
                break
            if index + 1 < len(problem.legs):
                tau = 0.0
    except SolverFailure as failure:
        status, message, tau, y = "failed", str(failure), *problem.last
    except KeyboardInterrupt:
        status, message, tau, y = "interrupted", "interrupted by the user", *problem.last
    return Outcome(status, message, counts, clock.perf_counter() - begun, index, tau, y, tolerance, audit.residual())


def _advance(problem, leg, method_over, tau, y, until):
    """Unknowns at `until`, integrated from tau."""
    if until - tau <= CRUMB * max(abs(until), leg.length):
        # Too short for any solver's first step: nothing moves in it.
        return y.copy()
    for _, ys, _ in method_over(replace(leg, span=Fraction(until)), tau, y):
        last = ys[-1]
    return last.copy()


def _blocks(steps, least):
    """Steps gathered into blocks of at least `least`, so that what follows is done on arrays; a solver that gives
    up hands over what it has before it says so."""
    waiting, count = [], 0
    try:
        for t, y, yp in steps:
            waiting.append((t, y, yp))
            count += len(t)
            if count >= least:
                yield _joined(waiting)
                waiting, count = [], 0
    except SolverFailure as failure:
        if waiting:
            yield (*_joined(waiting), failure)
        raise
    if waiting:
        yield _joined(waiting)


def _joined(waiting):
    t, y = np.concatenate([w[0] for w in waiting]), np.concatenate([w[1] for w in waiting])
    yp = None if waiting[0][2] is None else np.concatenate([w[2] for w in waiting])
    return t, y, yp


def _run_leg(problem, index, leg, tau, y, method_over, sink, audit, errors, sharper, counts):
    """Integrate one leg, or up to a change of its equations or of the tolerance; returns the last leg time, unknowns,
    and the sentence of a collapse (or "")."""
    sticking = problem.sticking
    steps, change = method_over(leg, tau, y), None
    t, ys = np.array([tau]), y[None, :].copy()
    yps = problem.start_rates(tau, y)[None, :] if problem.massless else np.zeros_like(ys)
    audit.begin(tau, y)
    due = sink.due(index)
    done = int(np.searchsorted(due, tau, side="left" if tau == 0.0 else "right"))
    watched = looked = 0
    problem.last = (tau, y)
    for block_t, block_y, block_yp, *failed in _blocks(steps, BLOCK if sticking is None else FEW):
        counts.steps += len(block_t)
        t, ys = np.concatenate([t, block_t]), np.concatenate([ys, block_y])
        yps = np.concatenate([yps, np.zeros_like(block_y) if block_yp is None else block_yp])
        if sticking:
            change = sticking.find(t, ys, looked, len(t) - 1, partial(_advance, problem, leg, method_over))
            if change:
                step, at, there, ring = change
                t, ys = np.append(t[: step + 1], at), np.vstack([ys[: step + 1], there])
                yps, failed = np.zeros_like(ys), []
            looked = len(t) - 1
        count = len(t)
        last_block = t[-1] >= leg.length or bool(failed) or change is not None
        # Leave the last intervals until their right-hand neighbours exist, unless there are none to come.
        upto = count - 1 if last_block else count - 1 - OVERLAP
        if upto > watched:
            q, q_rate = problem.motion(ys, yps)
            # A massless ring has none.
            slopes = None if problem.massless else problem.derivatives(t, ys)
            accelerations = None if slopes is None else np.ascontiguousarray(slopes[:, problem.rate_places])
            if errors is not None:
                before = errors.kept()
                errors.take(t, ys, accelerations, watched, upto)
                if errors.worst > errors.allowed and sharper():
                    errors.restore(before)
                    return *problem.last, ""
            fallen = problem.watch(index, t, q, q_rate, problem.impulses(ys), count, watched, upto)
            checked = upto if fallen < 0 else int(np.searchsorted(t, fallen)) - 1
            audit.take(t, ys, watched, checked, slopes[:, problem.works] if errors is not None else None)
            motion = t, q, q_rate, accelerations
            done = _hand_over(index, motion, watched, upto, due, done, fallen, sink)
            if fallen >= 0:
                here, rate = _at(motion, watched, upto, np.array([fallen]))
                end = ys[int(np.searchsorted(t, fallen))].copy()
                end[: problem.n_mechanical] = problem.unknowns(here[0], rate[0])[: problem.n_mechanical]
                return fallen, end, problem.collapse_sentence(index, fallen)
            problem.last = (float(t[upto]), ys[upto].copy())
            sink.state(index, *problem.last)
        if change:
            tau, y = float(t[-1]), ys[-1].copy()
            y, event = sticking.change(tau, y, ring)
            sink.event(index, tau, event)
            return tau, y, ""
        # Keep neighbours to the left of what comes next.
        keep = max(0, upto - OVERLAP)
        t, ys, yps, watched, looked = t[keep:], ys[keep:], yps[keep:], upto - keep, looked - keep
    return float(t[-1]), ys[-1].copy(), ""


def _at(motion, begin, end, times):
    """Displacements and rates at `times` inside steps [begin, end] of a `motion`: times, displacements, rates and
    accelerations at steps.

    Rates are interpolated with the accelerations at the steps: the slope of the displacements' interpolant would
    magnify their error by one over the step.
    """
    first, last = max(0, begin - OVERLAP), min(len(motion[0]), end + OVERLAP + 1)
    t, q, q_rate, acceleration = (None if part is None else part[first:last] for part in motion)
    count = last - first
    out, slope = np.empty((len(times), q.shape[1])), np.empty((len(times), q.shape[1]))
    sample(t, q, q_rate, count, begin - first, end - first, times, out, slope)
    if acceleration is None:
        return out, slope
    rate = np.empty_like(out)
    sample(t, q_rate, acceleration, count, begin - first, end - first, times, rate, slope)
    return out, rate


def _hand_over(index, motion, begin, end, due, done, fallen, sink) -> int:
    """Output due in steps [begin, end], or up to a collapse and at it; returns how many are done."""
    until = fallen if fallen >= 0 else motion[0][end]
    last = int(np.searchsorted(due, until, side="right"))
    times = due[done:last]
    if fallen >= 0 and not (len(times) and times[-1] == fallen):
        times = np.append(times, fallen)
    if len(times):
        sink.take(index, times, *_at(motion, begin, end, times))
    return last
