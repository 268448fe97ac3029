"""One pass of a radial seal: a scenario becomes a run, the run a trajectory, the trajectory an archive."""

import json
import math
import time as clock
from types import SimpleNamespace

import numpy as np

from ..archive import FIELD_TIME, ArchiveWriter, Fields, Series, partial_path
from ..dynamics.intervals import largest_value, time_of_angle
from ..radial_seals import observers
from ..radial_seals.model import RadialModel, RadialRun
from ..radial_seals.summary import summary_of
from ..scene.scene import SceneError
from ..solvers.contract import Status, tolerance_for
from ..solvers.energy_audit import EnergyAudit
from ..solvers.integrate import solve
from .certificate import ended, interrupted, without
from .result import Result, plain
from .sinks import ArchiveSink, Tally
from .verification_run import SHARPER, Nothing, sharper

# Instants at which gap and load around the shaft are kept, at most.
MOST_INSTANTS = 600
# Decay over forcing from which a scene is stiff.
STIFF = 50.0
# Instants at which two runs are compared.
COMPARED = 1000
GOLDEN = 0.6180339887498949
# The least share of the asked accuracy that a certificate tells, and the sharpest that it measures with.
LEAST_TOLD, SHARPEST = 0.05, 1e-13


def prepare_radial(scenario):
    """A scenario of a radial seal made ready: run, method, a sentence why, sample interval (s), their number."""
    from .simulate import sampling

    scene, settings = scenario.scene, scenario.run
    model = RadialModel(scene, settings.accuracy)
    duration = settings.duration
    if duration is None:
        try:
            duration = time_of_angle(scene.shaft.speed, 2.0 * math.pi * settings.turns)
        except ValueError as error:
            raise SceneError("run.turns", f"{settings.turns:g} turns ({error})", "fewer turns, or a duration") from None
    run = RadialRun(model, duration)
    interval, count = sampling(duration, largest_value(scene.shaft.speed), settings)
    method, why = settings.solver, "asked for"
    if method == "auto":
        found = model.followers
        decay = found.damping / found.mass
        stiff = decay > STIFF * model.reference_rate
        method = "radau" if stiff else "dop853"
        why = "every change of contact is a new start: a one-step method" + (", and the lip is stiff" if stiff else "")
    return run, method, why, interval, count


def simulate_radial(scenario, out, progress=None, stop=None, resume=False) -> Result:
    """Run a scenario of a radial seal into an archive, as `simulate`."""
    from .simulate import _meta, _own_state, _resumed

    begun = clock.perf_counter()
    run, method, why, interval, count = prepare_radial(scenario)
    series = {name: Series(*about) for name, about in observers.SERIES.items()}
    grid = {"theta": (Series("rad", "angle, from the x axis", "deg", 180 / math.pi), run.model.followers.angles)}
    fields = Fields({name: Series(*about) for name, about in observers.FIELDS.items()}, grid, MOST_INSTANTS + 2)
    writer = ArchiveWriter(
        out, scenario_text=scenario.text, resolved=scenario.resolved(), meta=_meta(scenario, method), series=series,
        fields=fields, resume=resume, expected_rows=count,
    )  # fmt: skip
    sink, audit, seen = RadialSink(run, writer, interval, count, progress, stop), EnergyAudit(), Apart(run)
    sink.audit = audit
    restart = None
    if resume and writer.rows:
        restart = _resumed(run, writer, sink, audit)
        with _own_state(writer):
            seen.restore(writer.state["modes"]["seen"])
    sink.seen = seen
    tolerance = tolerance_for(method, run.model.accuracy, run.memory)
    try:
        outcome = solve(run, method, run.model.accuracy, sink, audit=audit, seen=seen, resume=restart,
                        tolerance=tolerance)  # fmt: skip
        found, outcome = _certificate(run, method, outcome, seen, progress, stop)
    except KeyboardInterrupt:
        writer.close()
        raise
    sink.flush(outcome.segment, outcome.tau, outcome.y)
    if outcome.status != Status.INTERRUPTED:
        sink.write_events()
    summary = plain(summary_of(scenario, run, outcome, method, why))
    summary["certificate"] = found
    if found["met"] is False:
        summary["warnings"].append(f"accuracy {found['said']}")
        if summary["status"] == Status.OK:
            message = found["said"]
            if found["solver"] is not None:
                message = f"not as exact as asked: estimated {found['solver']:.1e}, asked {found['asked']:.0e}"
            summary |= {"status": str(Status.INACCURATE), "message": message}
    summary["wall_time"] = clock.perf_counter() - begun
    summary["archive"] = str(partial_path(out) if outcome.status == Status.INTERRUPTED else out)
    path = writer.finish(str(summary["status"]), summary["message"], json.loads(json.dumps(plain(summary))))
    summary["archive"] = str(path)
    return Result(str(summary["status"]), summary["message"], plain(summary), path)


def radial_in_memory(scenario) -> dict:
    """A run without an archive: its summary, without a certificate."""
    run, method, why, *_ = prepare_radial(scenario)
    sink, tolerance = Nothing(run, None, None), tolerance_for(method, run.model.accuracy, run.memory)
    outcome = solve(run, method, run.model.accuracy, sink, audit=EnergyAudit(), tolerance=tolerance)
    return summary_of(scenario, run, outcome, method, why)


class RadialSink(ArchiveSink):
    """Takes the series of a radial seal into the archive, and at a few instants what is around the shaft."""

    def __init__(self, run, writer, dt, count, progress, stop):
        run.start = SimpleNamespace(taken="riding", why="all followers on the shaft, where that pulls nowhere")
        run.model.unknowns = SimpleNamespace(names=[f"u{j}" for j in range(run.model.followers.count)])
        super().__init__(run, writer, dt, count, Tally(), progress, stop)
        self.kept = np.rint(np.linspace(0, count, min(count + 1, MOST_INSTANTS)))
        self.seen = None

    def flush(self, index, tau, y):
        """As ArchiveSink, with what is compared."""
        self.run.seen = self.seen
        super().flush(index, tau, y)

    def take(self, segment, taus, q, q_rate, x=None):
        """Series and fields at segment times (m,) (s) of displacements and rates (m, n)."""
        found, around = observers.columns(segment, taus, q, q_rate)
        self.tally.rows += len(taus)
        number = found["time"] / self.dt
        at = np.flatnonzero(np.isin(np.rint(number), self.kept) & (np.abs(number - np.rint(number)) < 1e-6))
        if len(at):
            fields = {FIELD_TIME: found["time"][at], **{name: values[at] for name, values in around.items()}}
            self.waiting_fields = fields if self.waiting_fields is None else {
                name: np.concatenate([self.waiting_fields[name], fields[name]]) for name in fields}  # fmt: skip
        self.waiting = found if self.waiting is None else {
            name: np.concatenate([self.waiting[name], found[name]]) for name in found}  # fmt: skip


class Apart:
    """An observer that keeps displacements and loads at instants of the whole run, for comparison with a sharper run;
    how far two are apart is relative to the scales of displacements and to the largest load."""

    def __init__(self, run):
        self.run = run
        self.times = np.sort(np.mod(GOLDEN * np.arange(1, COMPARED + 1), 1.0)) * run.duration
        self.columns = np.full((COMPARED, 2 * run.model.followers.count), np.nan)

    def begin(self, segment, tau, y):
        """Nothing to do."""

    def accept(self, block):
        """Take in the instants in a block's new steps."""
        until = block.t[block.end] if block.until is None else block.until
        first, last = np.searchsorted(self.times, block.segment.time + np.array([block.t[block.begin], until]))
        if last > first:
            taus = self.times[first:last] - block.segment.time
            us, vs = block.at(taus)
            _, around = observers.columns(block.segment, taus, us, vs)
            self.columns[first:last] = np.hstack([us, around["follower_load"]])

    def state(self):
        """What a continued run needs."""
        done = ~np.isnan(self.columns[:, 0])
        return {"done": int(done.sum()), "columns": self.columns[done].tolist()}

    def restore(self, state):
        """Go on from `state`."""
        self.columns[: state["done"]] = np.array(state["columns"]).reshape(state["done"], -1)


def _certificate(run, method, outcome, seen, progress, stop):
    """Twice what the run and a sharper one differ by, as part of the summary, and the outcome."""
    asked = run.model.accuracy
    if outcome.status != Status.OK:
        return without(asked, ended(outcome.status)), outcome
    # Sharper steps and sharper events: how long a step may be and what counts as contact follow from the accuracy.
    model = RadialModel(run.model.scene, max(run.model.accuracy / SHARPER, SHARPEST))
    again = RadialRun(model, run.duration)
    other = Apart(again)
    how, tolerance = sharper(method, outcome.tolerance, run)
    second = solve(again, how, model.accuracy, Nothing(again, progress, stop), tolerance=tolerance, seen=other)
    if second.status == Status.INTERRUPTED:
        return interrupted(asked, outcome)
    if second.status != Status.OK:
        return without(asked, f"a sharper run {second.status} ({second.message})") | {"met": False}, outcome
    n = run.model.followers.count
    loads = np.nanmax(np.abs(other.columns[:, n:]), initial=0.0) or 1.0
    scales = np.concatenate([np.full(n, run.model.length), np.full(n, loads)])
    apart = np.nanmax(np.abs(seen.columns - other.columns) / scales, axis=1)
    # A load jumps where a follower lands: beside a jump two runs differ by all of it.
    error = 2.0 * float(np.quantile(apart, 0.99)) if len(apart) else 0.0
    # Errors between the steps are not followed below this.
    error = max(error, LEAST_TOLD * asked)
    met = error <= asked
    how = f"twice the difference from a sharper run, at 99 % of {COMPARED} instants"
    said = f"asked {asked:.0e}, estimated {error:.1e} ({how})" + ("" if met else "; NOT met")
    return {"asked": asked, "estimated": error, "solver": error, "model": None, "met": met, "horizon": None,
            "said": said}, outcome  # fmt: skip
