"""The solvers: CVODE, IDA and the reference methods, on any problem.

A problem offers `n` displacements first in its unknowns, `legs` (each with `length`), `begin(k)`,
`rhs(tau, y, yp)`, `residual(tau, y, yp, res)`, `start_rates`, `jacobian`, `scales`, `motion`, `energies`,
`watch`, `y0`; its last six unknowns are works; and a sink takes what has been integrated.  Nothing here knows of seals or files.
"""

import time as clock
from dataclasses import dataclass, field

import numpy as np

from .dense import sample

# Measured: error of displacements and rates relative to their scales, per solver tolerance, over the shipped
# scenarios (tests/convergence).  The user's accuracy is divided by it.
SAFETY = {"adams": 60.0, "bdf": 200.0, "ida": 200.0, "dop853": 30.0, "radau": 30.0, "expm": 1.0}
# Steps kept to the left of what is worked on, and left for later on the right: neighbours for dense output.
OVERLAP = 4
# Blocks of single steps; chunks of SUNDIALS' steps, and what a healthy one may cost (evaluations per
# fastest forcing period): beyond it something is closing or crawling, and it is walked step by step.
BLOCK, FIRST_CHUNK, STEPS_PER_CHUNK, BUDGET = 192, 20.0, 3000, 1500.0
TIGHTEST = 3e-14


class SolverFailure(RuntimeError):
    """A solver gave up: the sentence says why and what to try."""


@dataclass
class Counts:
    """Own counts; a solver's own omit finite-difference Jacobians."""

    rhs: int = 0
    steps: int = 0
    jacobians: int = 0
    restarts: int = 0


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
    extra: dict = field(default_factory=dict)


def tolerance_for(method: str, accuracy: float) -> float:
    """Solver tolerance that keeps the asked accuracy with this method."""
    return max(accuracy / SAFETY[method], TIGHTEST)


def _tolerances(problem, tolerance):
    absolute = tolerance * problem.scales
    # The sum of absolute powers has kinks and only normalises the audit: no error control on it.
    absolute[-1] = 1e30
    return absolute


def _in_chunks(solver, problem, leg, tau, y, yp, method, counts, allow):
    """Steps of a SUNDIALS solver over a leg, many at a time.

    `solve` over two times returns every step at half the cost of asking for them one by one, but cannot be
    stopped: so a chunk may cost so many evaluations only (`allow`), else it is walked again step by step.
    The integrator restarts at each chunk, some thirty short steps in thousands.
    """
    span, end = FIRST_CHUNK * problem.fast_time, leg.length
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


def _one_by_one(solver, end, tau, y, yp, method):
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
        if ts and (len(ts) >= BLOCK or tau >= end or not result.success):
            yield np.array(ts), np.array(ys), None if yp is None else np.array(yps)
            _one_by_one.last = (ts[-1], ys[-1], yps[-1])
            ts, ys, yps = [], [], []
        if not result.success:
            raise SolverFailure(_said(method, result.message, result.t))


class _TooLong(Exception):
    """A chunk costs more evaluations than any healthy one."""


def _counting(function, counts):
    """`function` counted, and a switch that limits how many calls more it takes."""
    limit = [None]

    def allow(calls):
        limit[0] = None if calls is None else counts.rhs + calls

    def check():
        counts.rhs += 1
        if limit[0] is not None and counts.rhs > limit[0]:
            raise _TooLong

    return check, allow


def _cvode(problem, leg, tau, y, method, tolerance, counts):
    from sksundae.cvode import CVODE

    rhs, jacobian = problem.rhs, problem.jacobian
    check, allow = _counting(rhs, counts)

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
        max_num_steps=1_000_000,
    )
    yield from _in_chunks(solver, problem, leg, tau, y, None, method, counts, allow)


def _ida(problem, leg, tau, y, method, tolerance, counts):
    from sksundae.ida import IDA

    inner = problem.residual
    check, allow = _counting(inner, counts)

    def counted(t, y, yp, res):
        check()
        inner(t, y, yp, res)

    options = {"algebraic_idx": problem.algebraic} if len(problem.algebraic) else {}
    solver = IDA(counted, rtol=tolerance, atol=_tolerances(problem, tolerance), max_num_steps=1_000_000, **options)
    yield from _in_chunks(solver, problem, leg, tau, y, problem.start_rates(tau, y), method, counts, allow)


def _scipy(problem, leg, tau, y, method, tolerance, counts):
    from scipy.integrate import DOP853, Radau

    # SciPy's own floor on rtol is 100 eps; the absolute part carries the accuracy below it.
    absolute = _tolerances(problem, tolerance)
    inner = problem.rhs

    def counted(t, y):
        counts.rhs += 1
        yp = np.empty_like(y)
        inner(t, y, yp)
        return yp

    kind = DOP853 if method == "dop853" else Radau
    # DOP853's norm is an average: the unweighted last unknown would only loosen it, by sqrt(n/(n-1)).
    solver = kind(counted, tau, y, leg.length, rtol=max(tolerance, 2.3e-14), atol=absolute)
    while solver.status == "running":
        message = solver.step()
        if solver.status == "failed":
            raise SolverFailure(_said(method, message, solver.t))
        yield np.array([solver.t]), solver.y[None, :].copy(), None


def _expm(problem, leg, tau, y, method, tolerance, counts):
    """Exact steps of a linear scene; the works by Gauss quadrature on the exact motion."""
    exact = problem.exact_motion(tau, y)
    points, weights = np.polynomial.legendre.leggauss(10)
    step = problem.fast_time / 12.0
    count = max(1, int(np.ceil((leg.length - tau) / step)))
    times = np.linspace(tau, leg.length, count + 1)
    y = y.copy()
    yp = np.empty_like(y)
    n = problem.n_mechanical
    for a, b in zip(times[:-1], times[1:], strict=True):
        for x, weight in zip(points, weights, strict=True):
            at = 0.5 * (a + b) + 0.5 * (b - a) * x
            inside = np.concatenate([exact(at), y[n:]])
            problem.rhs(at, inside, yp)
            counts.rhs += 1
            y[n:] += 0.5 * (b - a) * weight * yp[n:]
        y[:n] = exact(b)
        yield np.array([b]), y[None, :].copy(), None


METHODS = {"adams": _cvode, "bdf": _cvode, "ida": _ida, "dop853": _scipy, "radau": _scipy, "expm": _expm}


def _said(method, message, tau):
    return (
        f"{method} gave up {tau:.6g} s into this leg: {message}  "
        "Try a looser run.accuracy, another run.solver, or look whether the film is closing there."
    )


def solve(problem, method: str, accuracy: float, sink, *, audit=None, resume=None) -> Outcome:
    """Integrate a problem leg by leg, chunk by chunk, into a sink.

    `method` one of METHODS, `accuracy` relative to each unknown's scale; `audit` an Audit to go on with;
    `resume` = (leg, tau, y) continues.
    The sink offers `due(leg_index) -> leg times of output`, `take(leg_index, times, q, q_rate)`,
    `state(leg_index, tau, y)`, and may raise KeyboardInterrupt from `take` to stop.
    Returns an Outcome; a failed run is a result.
    """
    begun = clock.perf_counter()
    tolerance = tolerance_for(method, accuracy)
    counts, audit = Counts(), audit or Audit(problem)
    first, tau, y = resume if resume else (0, 0.0, problem.y0.copy())
    status, message, index = "ok", "done", first
    try:
        for index in range(first, len(problem.legs)):
            leg = problem.begin(index)
            counts.restarts += 1
            steps = METHODS[method](problem, leg, tau, y, method, tolerance, counts)
            tau, y, collapse = _run_leg(problem, index, leg, tau, y, steps, sink, audit, counts)
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


def _blocks(steps):
    """Steps gathered into blocks of at least BLOCK, so that what follows is done on arrays; a solver that gives
    up hands over what it has before it says so."""
    waiting, count = [], 0
    try:
        for t, y, yp in steps:
            waiting.append((t, y, yp))
            count += len(t)
            if count >= BLOCK:
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


def _run_leg(problem, index, leg, tau, y, steps, sink, audit, counts):
    """Integrate one leg; returns the last leg time, unknowns, and the sentence of a collapse (or "")."""
    t, ys = np.array([tau]), y[None, :].copy()
    yps = problem.start_rates(tau, y)[None, :] if problem.massless else np.zeros_like(ys)
    audit.begin(tau, y)
    due = sink.due(index)
    done = int(np.searchsorted(due, tau, side="left" if tau == 0.0 else "right"))
    watched = 0
    problem.last = (tau, y)
    for block_t, block_y, block_yp, *failed in _blocks(steps):
        counts.steps += len(block_t)
        t, ys = np.concatenate([t, block_t]), np.concatenate([ys, block_y])
        yps = np.concatenate([yps, np.zeros_like(block_y) if block_yp is None else block_yp])
        count = len(t)
        last_block = t[-1] >= leg.length or bool(failed)
        # Leave the last intervals until their right-hand neighbours exist, unless there are none to come.
        upto = count - 1 if last_block else count - 1 - OVERLAP
        if upto > watched:
            q, q_rate = problem.motion(ys, yps)
            fallen = problem.watch(index, t, q, q_rate, count, watched, upto)
            audit.take(t, ys, watched, upto if fallen < 0 else int(np.searchsorted(t, fallen)) - 1)
            done = _hand_over(index, t, q, q_rate, watched, upto, due, done, fallen, sink)
            if fallen >= 0:
                here, rate = _at(t, q, q_rate, watched, upto, np.array([fallen]))
                end = ys[int(np.searchsorted(t, fallen))].copy()
                end[: problem.n_mechanical] = problem.unknowns(here[0], rate[0])[: problem.n_mechanical]
                return fallen, end, problem.collapse_sentence(index, fallen)
            problem.last = (float(t[upto]), ys[upto].copy())
            sink.state(index, *problem.last)
        # Keep neighbours to the left of what comes next.
        keep = max(0, upto - OVERLAP)
        t, ys, yps, watched = t[keep:], ys[keep:], yps[keep:], upto - keep
    return float(t[-1]), ys[-1].copy(), ""


def _at(t, q, q_rate, begin, end, times):
    out, out_rate = np.empty((len(times), q.shape[1])), np.empty((len(times), q.shape[1]))
    sample(t, q, q_rate, len(t), begin, end, times, out, out_rate)
    return out, out_rate


def _hand_over(index, t, q, q_rate, begin, end, due, done, fallen, sink) -> int:
    """Output due in steps [begin, end], or up to a collapse and at it; returns how many are done."""
    until = fallen if fallen >= 0 else t[end]
    last = int(np.searchsorted(due, until, side="right"))
    times = due[done:last]
    if fallen >= 0 and not (len(times) and times[-1] == fallen):
        times = np.append(times, fallen)
    if len(times):
        sink.take(index, times, *_at(t, q, q_rate, begin, end, times))
    return last


class Recorder:
    """A sink that keeps displacements in memory, every `interval` seconds; none without an interval."""

    def __init__(self, problem, interval: float | None = None):
        self.problem, self.interval, self.parts = problem, interval, []

    def due(self, index):
        leg = self.problem.legs[index]
        if self.interval is None:
            return np.empty(0)
        first = max(0, int(np.ceil(leg.time / self.interval - 1e-9)))
        taus = (first + np.arange(int(leg.length / self.interval) + 2)) * self.interval - leg.time
        end = leg.length * (1 + 1e-12)
        last = index + 1 == len(self.problem.legs)
        return np.clip(taus[(taus >= 0) & ((taus < leg.length * (1 - 1e-12)) | last) & (taus <= end)], 0, leg.length)

    def take(self, index, taus, q, q_rate):
        self.parts.append((self.problem.legs[index].time + taus, q, q_rate))

    def state(self, index, tau, y):
        pass

    def arrays(self):
        """Times (m,), displacements (m, n), rates (m, n)."""
        return tuple(np.concatenate([part[i] for part in self.parts]) for i in range(3))


class Audit:
    """Energy balance: largest |dE - sum of works| over the sum of integrals of |power|, at every step."""

    def __init__(self, problem):
        self.problem, self.worst, self.moved = problem, 0.0, 0.0
        self.energy0 = self.works0 = self.last = None

    def begin(self, tau, y):
        """A leg begins; the first fixes the zero of energy and works.  At a step of an imposed motion the
        spring energy jumps (its end is moved in no time): that work is booked here."""
        energy = float(self.problem.energies(np.array([tau]), y[None, :])[0])
        if self.energy0 is None:
            self.energy0, self.works0 = energy, y[-6:-1].sum()
        else:
            self.energy0 += energy - self.last
        self.last = energy

    def take(self, t, ys, begin, end):
        """Check the steps (begin, end] of the running leg."""
        if end <= begin:
            return
        energies = self.problem.energies(t[begin + 1 : end + 1], ys[begin + 1 : end + 1])
        works = ys[begin + 1 : end + 1, -6:-1].sum(axis=1)
        defects = np.abs(energies - self.energy0 - (works - self.works0))
        self.worst = max(self.worst, float(defects.max()))
        self.last, self.moved = float(energies[-1]), float(ys[end, -1])

    def kept(self) -> dict:
        """What a continued run needs."""
        return {"worst": self.worst, "moved": self.moved, "energy0": self.energy0, "works0": self.works0,
                "last": self.last}  # fmt: skip

    def restore(self, kept: dict):
        """Go on from `kept`."""
        self.worst, self.moved, self.last = kept["worst"], kept["moved"], kept["last"]
        self.energy0, self.works0 = kept["energy0"], kept["works0"]

    def residual(self) -> float:
        """The one number; 0 when nothing is exchanged."""
        return self.worst / self.moved if self.moved > 0 else 0.0
