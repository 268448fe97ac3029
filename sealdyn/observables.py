"""What the user looks at of a run, and how wrong a method has it: h_min, relative misalignment, leakage, impulse."""

import math
import time as clock
from dataclasses import dataclass, field

import numpy as np

from .audit import Audit
from .methods import Counts, SolverFailure
from .recorder import Recorder
from .signals import signals
from .solve import _run_leg
from .watch import LEAST, MOST, H

OBSERVABLES = ("h_min", "relative_misalignment", "leakage", "contact_impulse")
WHERE = ("end", "over_time", "steady")
# A leakage below this share of what the aligned film would pass is none.
NOTHING = 1e-12


class TakesTooLong(SolverFailure):
    """A run is stopped because it has taken too long."""


@dataclass
class Observed:
    """One run as it is looked at: status and reason, wall time (s) of the integration alone, own counts, sample times
    (m,) with `series` (m,) by name, located `steady` extremes over the last forcing period or None, `impulse` (N s)
    or None, and the scales that errors are relative to; `processor` time (s) of the same, less than
    the wall's on a busy machine."""

    status: str
    reason: str
    wall: float
    counts: Counts
    times: np.ndarray
    series: dict
    steady: dict | None
    impulse: float | None
    scales: dict = field(default_factory=dict)
    processor: float = 0.0


class Sampler(Recorder):
    """Keeps what is looked at, at even times."""

    def take(self, index, taus, q, q_rate):
        problem = self.problem
        columns = signals(problem, taus, q, q_rate)
        side = "leakage_inner" if problem.closing.outer_is_high else "leakage_outer"
        self.parts.append(
            (columns["time"], columns["h_min"], columns["relative_misalignment"], columns[side])
        )  # fmt: skip


class _Stopwatch:
    """Time spent inside a method's own steps; ends a run that has spent too much."""

    def __init__(self, limit):
        self.limit, self.spent, self.processor = limit, 0.0, 0.0

    def timed(self, steps):
        while True:
            begun, busy = clock.perf_counter(), clock.process_time()
            try:
                block = next(steps, None)
            finally:
                self.processor += clock.process_time() - busy
                self.spent += clock.perf_counter() - begun
            if block is None:
                return
            if self.spent > self.limit:
                raise TakesTooLong(f"stopped after {self.spent:.3g} s")
            yield block


def observe(problem, steps, method: str, tolerance: float, limit: float = math.inf, samples: int = 400) -> Observed:
    """Integrate a problem with a method's generator `steps` (contract of methods.py) and look at it.

    `limit` (s) of integration; `samples` intervals over the run.  The gap is watched and contacts, sticking and
    collapse are found as in any run, but the clock runs only inside the method.
    """
    counts, watch = Counts(), _Stopwatch(limit)
    sink = Sampler(problem, problem.duration / samples)
    status, reason, y = "ok", "", problem.y0.copy()

    def method_over(leg, tau, y):
        return watch.timed(steps(problem, leg, tau, y, method, tolerance, counts))

    try:
        with np.errstate(all="ignore"):
            y, reason = _through_legs(problem, method_over, sink, counts)
        status = "collapsed" if reason else "ok"
    except TakesTooLong as stopped:
        status, reason = "stopped", str(stopped)
    except (SolverFailure, np.linalg.LinAlgError) as failure:
        status, reason = "failed", str(failure)
    if status == "ok" and not np.all(np.isfinite(y)):
        status, reason = "failed", "overflowed"
    found = _observed(problem, status, reason, watch.spent, counts, sink, y)
    found.processor = watch.processor
    return found


def _through_legs(problem, method_over, sink, counts):
    """All legs, with every change of the equations; the unknowns at the end and the sentence of a collapse or ""."""
    audit, y = Audit(problem), problem.y0.copy()
    for index in range(len(problem.legs)):
        leg, tau = problem.begin(index), 0.0
        if problem.sticking and index == 0:
            problem.sticking.start(tau, y)
        while tau < leg.length:
            tau, y, collapse = _run_leg(problem, index, leg, tau, y, method_over, sink, audit, counts)
            if collapse:
                return y, collapse
    return y, ""


def _observed(problem, status, reason, wall, counts, sink, y) -> Observed:
    columns = [np.concatenate([part[i] for part in sink.parts]) if sink.parts else np.empty(0) for i in range(4)]
    record, steady = problem.records[1], None
    if status == "ok" and math.isfinite(record[H]) and math.isfinite(record[MOST]):
        steady = {"h_min": [record[H]], "relative_misalignment": [record[LEAST], record[MOST]]}
        late = columns[0] >= problem.windows[1][0] * (1 - 1e-12)
        if late.sum() > 1:
            steady["leakage"] = [float(np.max(columns[3][late])), float(np.min(columns[3][late]))]
    place = problem.layout.impulse
    impulse = float(y[place]) if problem.contact is not None and place is not None else None
    series = dict(zip(OBSERVABLES, columns[1:], strict=False))
    scales = {"h_min": problem.clearance, "relative_misalignment": problem.clearance / problem.scene.film.outer_radius}
    if len(columns[3]) and np.max(np.abs(columns[3])) > 0:
        scales["leakage"] = float(np.max(np.abs(columns[3])))
    if impulse:
        scales["contact_impulse"] = abs(impulse)
    return Observed(status, reason, wall, counts, columns[0], series, steady, impulse, scales)


def errors(found: Observed, exact: Observed) -> dict:
    """Errors of a run against another: `{where: {observable: error}}`, relative to the clearance, the clearance over
    the outer radius, the largest leakage and the whole impulse of `exact`; an empty dict where there is nothing to
    compare.  **Source** maximum and final-time errors as in Hairer & Wanner's work-precision diagrams."""
    none = {where: {} for where in WHERE}
    if found.status != "ok" or exact.status != "ok" or len(found.times) != len(exact.times):
        return none
    out = none
    for name, scale in exact.scales.items():
        if name == "contact_impulse":
            out["end"][name] = out["over_time"][name] = abs(found.impulse - exact.impulse) / scale
            continue
        away = np.abs(found.series[name] - exact.series[name]) / scale
        out["end"][name], out["over_time"][name] = float(away[-1]), float(away.max())
        if found.steady and exact.steady and name in found.steady and name in exact.steady:
            pairs = zip(found.steady[name], exact.steady[name], strict=True)
            out["steady"][name] = float(max(abs(a - b) for a, b in pairs) / scale)
    return out


def worst(by_where: dict) -> dict:
    """The largest error of any observable, per `where`; None where there is none."""
    return {where: max(found.values(), default=None) for where, found in by_where.items()}
