"""What the user looks at of a run, and how wrong a method has it: h_min, relative misalignment, leakage, impulse; of a
radial seal its largest gap, least load and friction torque."""

import math
import time as clock
from dataclasses import dataclass, field

import numpy as np

from ...dynamics.extrema import LEAST, MOST, H
from ...dynamics.signals import signals
from ...scene.radial import RadialScene
from ...simulation.verification_run import JUMP_QUANTILE
from ...solvers.contract import Counts, Recorder, SolverFailure, Status
from ...solvers.integrate import solve

OBSERVABLES = ("h_min", "relative_misalignment", "leakage", "contact_impulse")
OF_FOLLOWERS = ("largest_gap", "least_load", "friction_torque")
WHERE = ("end", "over_time", "steady")
# A leakage below this share of what the aligned film would pass is none.
NOTHING = 1e-12


@dataclass
class Observed:
    """One run as it is looked at: status and reason, `processor` time (s) of the integration alone, own counts, sample
    times (m,) with `series` (m,) by name, located `steady` extremes over the last forcing period or None,
    `impulse` (N s) or None, and the scales that errors are relative to; which of the series `jump`, as the leakage of
    cells that tear does, and the loads of followers."""

    status: str
    reason: str
    processor: float
    counts: Counts
    times: np.ndarray
    series: dict
    steady: dict | None
    impulse: float | None
    scales: dict = field(default_factory=dict)
    jump: tuple[str, ...] = ()


class Sampler(Recorder):
    """Keeps what is looked at, at even times."""

    def take(self, segment, taus, q, q_rate, x=None):
        columns = signals(segment, taus, q, q_rate, x)
        side = "leakage_inner" if segment.model.closing.outer_is_high else "leakage_outer"
        self.parts.append(
            (columns["time"], columns["h_min"], columns["relative_misalignment"], columns[side])
        )  # fmt: skip


class RadialSampler(Recorder):
    """The same of a radial seal."""

    def take(self, segment, taus, q, q_rate, x=None):
        # Its kernels are loaded for a radial seal only.
        from ...radial_seals.observers import columns

        found, _ = columns(segment, taus, q, q_rate)
        self.parts.append([found[name] for name in ("time", *OF_FOLLOWERS)])


class _Stopwatch:
    """A method's steps, with the time spent inside them; ends a run that has spent too much."""

    def __init__(self, steps, limit):
        self.steps, self.limit = steps, limit
        self.spent, self.stopped = 0.0, False

    def __call__(self, *where):
        steps = self.steps(*where)
        while True:
            begun = clock.process_time()
            try:
                block = next(steps, None)
            except np.linalg.LinAlgError as error:
                raise SolverFailure(str(error)) from error
            finally:
                self.spent += clock.process_time() - begun
            if block is None:
                return
            if self.spent > self.limit:
                self.stopped = True
                raise SolverFailure(f"stopped after {self.spent:.3g} s")
            yield block


def is_radial(scene) -> bool:
    """Whether a scene is of a radial seal, not of a face seal."""
    return isinstance(scene, RadialScene)


def observe(run, steps, method: str, tolerance: float, limit: float = math.inf, samples: int = 400) -> Observed:
    """Integrate a run with a method's generator `steps` (contract of solvers/contract.py) and look at it.

    `limit` (s) of processor time; `samples` intervals over the run.  The gap is watched and contacts, sticking and
    collapse are found as in any run, but the clock runs only inside the method.
    """
    radial = is_radial(run.model.scene)
    watch, sink = _Stopwatch(steps, limit), (RadialSampler if radial else Sampler)(run.duration / samples)
    with np.errstate(all="ignore"):
        outcome = solve(run, method, run.model.accuracy, sink, steps=watch, tolerance=tolerance)
    status, reason = str(outcome.status), "" if outcome.status == Status.OK else outcome.message
    if watch.stopped:
        status = "stopped"
    elif status == Status.OK and not np.all(np.isfinite(outcome.y)):
        status, reason = Status.FAILED, "overflowed"
    look = _observed_radial if radial else _observed
    return look(run, status, reason, watch.spent, outcome.counts, sink, outcome.y)


def _observed(run, status, reason, processor, counts, sink, y) -> Observed:
    columns = _columns(sink)
    record, steady = run.extrema.records[1], None
    if status == Status.OK and math.isfinite(record[H]) and math.isfinite(record[MOST]):
        steady = {"h_min": [record[H]], "relative_misalignment": [record[LEAST], record[MOST]]}
        late = columns[0] >= run.extrema.windows[1][0] * (1 - 1e-12)
        if late.sum() > 1:
            steady["leakage"] = [float(np.max(columns[3][late])), float(np.min(columns[3][late]))]
    place = run.model.unknowns.impulse
    impulse = float(y[place]) if run.model.contact is not None and place is not None else None
    series = dict(zip(OBSERVABLES, columns[1:], strict=False))
    scales = {
        "h_min": run.model.clearance,
        "relative_misalignment": run.model.clearance / run.model.scene.film.outer_radius,
    }
    if len(columns[3]) and np.max(np.abs(columns[3])) > 0:
        scales["leakage"] = float(np.max(np.abs(columns[3])))
    if impulse:
        scales["contact_impulse"] = abs(impulse)
    jump = ("leakage",) if run.model.interface.film.settle is not None else ()
    return Observed(status, reason, processor, counts, columns[0], series, steady, impulse, scales, jump=jump)


def _observed_radial(run, status, reason, processor, counts, sink, y) -> Observed:
    times, *columns = _columns(sink)
    series = dict(zip(OF_FOLLOWERS, columns, strict=True))
    scales = {name: float(np.max(np.abs(values), initial=0.0)) or 1.0 for name, values in series.items()}
    scales["largest_gap"] = run.model.length
    return Observed(status, reason, processor, counts, times, series, None, None, scales, jump=OF_FOLLOWERS[1:])


def _columns(sink):
    """What was kept, (m,) each."""
    return [np.concatenate([part[i] for part in sink.parts]) if sink.parts else np.empty(0) for i in range(4)]


def errors(found: Observed, exact: Observed) -> dict:
    """Errors of a run against another: `{where: {observable: error}}`, relative to the clearance, the clearance over
    the outer radius, the largest leakage and the whole impulse of `exact`, of a radial seal to the swing of its shaft,
    the largest of its least loads and torques; an empty dict where there is nothing to compare.
    **Source** maximum and final-time errors as in Hairer & Wanner's work-precision diagrams."""
    none = {where: {} for where in WHERE}
    if found.status != Status.OK or exact.status != Status.OK or len(found.times) != len(exact.times):
        return none
    out = none
    for name, scale in exact.scales.items():
        if name == "contact_impulse":
            out["end"][name] = out["over_time"][name] = abs(found.impulse - exact.impulse) / scale
            continue
        away = np.abs(found.series[name] - exact.series[name]) / scale
        # Where loads jump, two runs never jump at one instant.
        largest = np.quantile(away, JUMP_QUANTILE) if name in exact.jump else away.max()
        out["end"][name], out["over_time"][name] = float(away[-1]), float(largest)
        if found.steady and exact.steady and name in found.steady and name in exact.steady:
            pairs = zip(found.steady[name], exact.steady[name], strict=True)
            out["steady"][name] = float(max(abs(a - b) for a, b in pairs) / scale)
    return out


def worst(by_where: dict) -> dict:
    """The largest error of any observable, per `where`; None where there is none."""
    return {where: max(found.values(), default=None) for where, found in by_where.items()}
