"""Integrate any run with any method, past any observers, into any sink.

A run offers `segment(index) -> Segment` for each of its `intervals`, `duration`, `y0`, `memory`, `last`, its observers:
`stick_slip` (None, or what finds changes of the equations between steps), `extrema` and `contacts`.
A sink takes what has been integrated.  Nothing here knows of seals or files.
"""

import math
import time as clock
from dataclasses import dataclass

import numpy as np

from .contract import (
    FEW,
    MANY,
    OVERLAP,
    Block,
    Cause,
    Change,
    Counts,
    Enough,
    Retry,
    SolverFailure,
    Status,
    Stop,
    TooDear,
    tolerance_for,
)
from .methods import METHODS
from .run_error import EnergyAudit

# A run that does not get on ends (Advance): so many accepted steps, or changes of the equations, must bring it on by
# this share of what it has before it.
STEPS, CHANGES = 20_000, 1000
SHARE_STEPS, SHARE_CHANGES = 1e-5, 1e-6
# What it has before it: the run, or so many of its shortest periods.
PERIODS = 1e4
_STEPS = (
    "no advance: {count} steps brought {span:.1e} s of motion, up to t = {time:.6g} s; try another run.solver (bdf or "
    "ida where the scene is stiff), a looser run.accuracy, or look whether the film is closing there"
)
_DEAR = "too dear: {count} evaluations brought this run to t = {time:.6g} s, many times the work of the run before"
_CHANGES = (
    "no advance: {count} changes between sticking and slipping within {span:.1e} s of motion, up to t = {time:.6g} s; "
    'dry friction cannot say what happens there: law = "regularised" and a width of the secondary seal can'
)


class Advance:
    """Watches how far a run of `length` (s) and shortest period `period` (s) gets.

    At the pace at which it gives up, the run would take 2e9 steps or 1e9 changes (stick-slip chatter): hours of
    compiled steps, days of others.  `work`: evaluations that it may take in all.  Counts decide, not the clock:
    another machine finds the same."""

    def __init__(self, length: float, period: float, work: float = math.inf):
        self.ahead, self.changes, self.work = min(length, PERIODS * period), 0, work
        # Time and count where a window began.
        self.since_step = self.since_change = None

    def see(self, time: float, steps: int, work: int = 0) -> None:
        """So many `steps` were made, with so many evaluations (`work`), up to `time` (s).  Raises SolverFailure for a
        run that does not get on, or costs too much."""
        if work > self.work:
            raise TooDear(_DEAR.format(count=work, time=time))
        self.since_step = self._look(self.since_step, time, steps, STEPS, SHARE_STEPS * self.ahead, _STEPS)

    def change(self, time: float) -> None:
        """The equations changed at `time` (s).  Raises SolverFailure for a run that does not get on."""
        self.changes += 1
        self.since_change = self._look(
            self.since_change, time, self.changes, CHANGES, SHARE_CHANGES * self.ahead, _CHANGES
        )

    def _look(self, since, time, count, window, least, sentence):
        if since is None:
            return time, count
        if count - since[1] < window:
            return since
        if time - since[0] < least:
            raise SolverFailure(sentence.format(count=count - since[1], span=time - since[0], time=time))
        return time, count

    def state(self) -> dict:
        """What a continued run needs: how many changes there were, and where the windows began."""
        return {"changes": self.changes, "step": self.since_step, "change": self.since_change}

    def restore(self, state: dict):
        """Go on from `state`."""
        self.changes, self.since_step, self.since_change = state["changes"], state["step"], state["change"]


# A stretch shorter than this share of its time is no step for any solver.
CRUMB = 1e-14
# A step (s) in which nothing moves: powers of it, which interpolation divides by, are nothing.
LEAST_STEP = 1e-25
# Steps from one step's start to a point within it, beyond which the equations are not smooth there.
CRAWLING = 1000
# Accepted steps after which every method starts anew, whoever looks: a run can be continued from there to the bit, as
# nothing of a method's history is left.  Some seconds or half a minute of work: of cells that tear and fill, of another
# film with unknowns of its own, of a method in Python, and of a compiled one.  A multistep method loses up to a hundred
# steps each time until it has found its order again.
RENEWED_CELLS, RENEWED_FILM, RENEWED_PYTHON, RENEWED = 500, 4000, 5000, 200_000
# Multistep methods of stiff scenes: beside their short steps accelerations are the less exact (Block.at).
STIFF = ("bdf", "ida", "trbdf2")
# Methods whose steps are made by compiled loops.
COMPILED = ("adams", "bdf", "ida")


@dataclass
class Outcome:
    """How a run ended: status, cause, a sentence, counts, wall time (s), the last segment's index, time in it (s) and
    unknowns (size,) there, the tolerance it ended with, and the residual of the energy audit."""

    status: Status
    cause: Cause
    message: str
    counts: Counts
    wall_time: float
    segment: int
    tau: float
    y: np.ndarray
    tolerance: float
    energy_residual: float = 0.0


def solve(
    run, method: str, accuracy: float, sink, *, audit=None, errors=None, seen=None, tally=None, resume=None, steps=None,
    tolerance=None, work: float = math.inf, points=None,
) -> Outcome:  # fmt: skip
    """Integrate a run segment by segment, chunk by chunk, into a sink.

    `method` one of METHODS, `accuracy` relative to each unknown's scale; `audit` an EnergyAudit to go on with; `errors`
    a GlobalErrorEstimate that is shown every step, or None, `seen` and `tally` other observers, or None; `resume` =
    (segment index, tau (s), y (size,)) continues; with a fourth, the account that `points(segment, tau, y, account)` is
    given at every start of the method, it continues to the bit.
    Another method comes as `steps`, a generator with the contract of contract.py, called `method`, with its own
    `tolerance`.  `work`: evaluations of the right-hand side after which the run gives up.
    The sink offers `due(segment)`, segment times (m,) (s) of output, `take(segment, times, q, q_rate)` of displacements
    and rates (m, n), after them the film's unknowns (m, n) if it has any, `state(segment, tau, y)`,
    `event(segment, tau, event)`, and may raise Enough from `take` or `state` to stop.
    Returns an Outcome; a failed run is a result.
    """
    begun, counts, audit = clock.perf_counter(), Counts(), audit or EnergyAudit()
    steps, tolerance = steps or METHODS[method], tolerance or tolerance_for(method, accuracy, run.memory)
    others = [observer for observer in (seen, tally) if observer]
    observers = [*([errors] if errors else []), run.extrema, run.contacts, audit, *others]
    if errors:
        errors.tolerance = tolerance
    index, tau, y, *account = resume if resume else (0, 0.0, run.y0.copy())
    advance = Advance(run.duration, run.segment(index).shortest_period, work)
    if account:
        tolerance, counts = account[0]["tolerance"], Counts(**account[0]["counts"])
        advance.restore(account[0]["advance"])
    status, cause, message = Status.OK, Cause.DONE, str(Cause.DONE)
    segment = run.segment(index)
    if not resume:
        segment.settle_film(tau, y)
    if run.stick_slip and not resume:
        segment = run.segment(index, run.stick_slip.start(segment, tau, y))
    try:
        while True:
            if points:
                points(segment, tau, y, {"tolerance": tolerance, "counts": vars(counts), "advance": advance.state()})
            counts.restarts += 1
            found = _integrate(run, segment, tau, y, (steps, method, tolerance, counts, advance), observers, sink)
            index, tau, y = run.last
            if isinstance(found, Stop):
                status, cause, message = Status.COLLAPSED, found.cause, found.message
                break
            if isinstance(found, Retry):
                tolerance = found.tolerance
            elif isinstance(found, Change):
                advance.change(segment.time + tau)
                segment, y = run.segment(index, found.modes), found.y
                if found.event:
                    sink.event(segment, tau, found.event)
            elif segment.last:
                break
            if tau >= segment.length:
                if segment.last:
                    break
                segment, tau = run.segment(index + 1), 0.0
    except SolverFailure as failure:
        reason = segment.failure()
        message = f"{reason}; {failure}" if reason else str(failure)
        status, cause = Status.FAILED, failure.cause
    except Enough:
        status, cause, message = Status.INTERRUPTED, Cause.INTERRUPTED, str(Cause.INTERRUPTED)
    index, tau, y = run.last if status in (Status.FAILED, Status.INTERRUPTED) else (segment.index, tau, y)
    spent = clock.perf_counter() - begun
    return Outcome(status, cause, message, counts, spent, index, tau, y, tolerance, audit.residual())


def _integrate(run, segment, tau, y, how, observers, sink) -> Stop | Change | Retry | None:
    """Integrate a segment from `tau`, to its end (None) or to what an observer finds; `run.last` says how far."""
    steps, method, tolerance, counts, advance = how

    def method_over(segment, tau, y):
        return steps(segment, tau, y, method, tolerance, counts)

    sticking, transition = run.stick_slip, None
    for observer in (*observers, *([sticking] if sticking else [])):
        observer.begin(segment, tau, y)
    y, yp = segment.start(tau, y) if segment.has_residual_form else (y, np.zeros_like(y))
    t, ys, yps = np.array([tau]), y[None, :].copy(), yp[None, :]
    due = sink.due(segment)
    done = int(np.searchsorted(due, tau, side="left" if tau == 0.0 else "right"))
    watched = looked = 0
    begun, most = counts.steps, _renewed_after(segment, method)
    run.last = (segment.index, tau, y)
    for block_t, block_y, block_yp, *failed in _gathered(method_over(segment, tau, y), FEW if sticking else MANY):
        counts.steps += len(block_t)
        _must_move(segment, np.diff(block_t, prepend=t[-1]), block_y)
        advance.see(segment.time + float(block_t[-1]), counts.steps, counts.rhs)
        t, ys = np.concatenate([t, block_t]), np.concatenate([ys, block_y])
        yps = np.concatenate([yps, np.zeros_like(block_y) if block_yp is None else block_yp])
        if sticking:
            # It cuts the steps before anybody else sees them.
            transition = sticking.accept(
                Block(segment, t, ys, yps, looked, len(t) - 1, stiff=method in STIFF),
                lambda tau, y, until: _advanced(method_over, segment, tau, y, until),
            )
            if transition:
                upto = transition.step + 1
                t, ys = np.append(t[:upto], transition.time), np.vstack([ys[:upto], transition.y])
                # A ring without mass moves as its forces ask, at the transition too.
                there = segment.start(transition.time, transition.y)[1] if np.any(segment.lacks_inertia) else None
                yps = np.zeros_like(ys) if there is None else np.vstack([yps[:upto], there])
                failed = []
            looked = len(t) - 1
        count = len(t)
        ended = t[-1] >= segment.length or bool(failed) or transition is not None
        renewed = not ended and counts.steps - begun >= most
        last_block = ended or renewed
        # Leave the last intervals until their right-hand neighbours exist, unless there are none to come.
        upto = count - 1 if last_block else count - 1 - OVERLAP
        if upto > watched:
            block, stop = Block(segment, t, ys, yps, watched, upto, stiff=method in STIFF), None
            for observer in observers:
                found = observer.accept(block)
                if isinstance(found, Retry):
                    return found
                if isinstance(found, Stop):
                    block, stop = block.cut(found.time), found
            done = _hand_over(block, due, done, sink)
            if stop:
                run.last = (segment.index, stop.time, _end_of(block))
                return stop
            run.last = (segment.index, float(t[upto]), ys[upto].copy())
            sink.state(segment, *run.last[1:])
        if transition:
            # Made only now: what the sink keeps to go on from is still the state before it.
            return sticking.make(transition)
        if renewed:
            return Retry(tolerance)
        # Keep neighbours to the left of what comes next.
        keep = max(0, upto - OVERLAP)
        t, ys, yps, watched, looked = t[keep:], ys[keep:], yps[keep:], upto - keep, looked - keep
    return None


def _renewed_after(segment, method) -> int:
    """Accepted steps after which the method starts anew."""
    if segment.film.stop > segment.film.start:
        return RENEWED_CELLS if method == "trbdf2" else RENEWED_FILM
    return RENEWED if method in COMPILED else RENEWED_PYTHON


def _must_move(segment, steps, ys):
    """Raises SolverFailure for `steps` (m,) (s) that lead nowhere, and unknowns (m, size) that are no numbers."""
    least = float(np.min(steps[steps > 0.0], initial=np.inf))
    if least < LEAST_STEP or not np.isfinite(ys).all():
        raise SolverFailure(
            f"steps of {least:.1e} s, with which nothing moves: forces that large on rings that light; look at "
            "the units of radii, pressures, stiffnesses, masses and inertias"
        )


def _advanced(method_over, segment, tau, y, until):
    """Unknowns at `until`, integrated from tau; None where that takes so many steps that the equations jump between."""
    if until - tau <= CRUMB * max(abs(until), segment.length):
        # Too short for any solver's first step: nothing moves in it.
        return y.copy()
    count = 0
    for _, ys, _ in method_over(segment.until(until), tau, y):
        count, last = count + len(ys), ys[-1]
        if count > CRAWLING:
            return None
    return last.copy()


def _gathered(steps, least):
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


def _end_of(block) -> np.ndarray:
    """Unknowns where a block has been cut; works are those of the next step."""
    y, segment = block.ys[block.end].copy(), block.segment
    q, q_rate = block.at(np.array([block.until]))
    there = segment.model.vector(q[0], q_rate[0])
    y[: segment.n_mechanical] = there[: segment.n_mechanical]
    for x in block.film_at(np.array([block.until])):
        y[segment.film] = x[0]
    return y


def _hand_over(block, due, done, sink) -> int:
    """Output due in a block, and at its cut; returns how many are done."""
    until = block.t[block.end] if block.until is None else block.until
    last = int(np.searchsorted(due, until, side="right"))
    times = due[done:last]
    if block.until is not None and not (len(times) and times[-1] == until):
        times = np.append(times, until)
    if len(times):
        sink.take(block.segment, times, *block.at(times), *block.film_at(times))
    return last
