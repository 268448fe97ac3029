"""One pass: a scenario becomes a problem, the problem a trajectory, the trajectory an archive."""

import json
import math
import os
import platform
import time as clock
from collections.abc import Callable
from dataclasses import dataclass
from fractions import Fraction
from importlib.metadata import version
from pathlib import Path

import numpy as np

from .. import __version__, archive
from ..archive import ArchiveWriter, Series, partial_path
from ..dynamics.segments import time_of_angle
from ..dynamics.signals import signals, wave_names
from ..numerics.piecewise_linear import PiecewiseLinear
from ..scene.rings import RING_NAMES
from ..scene.scene import SceneError
from ..solvers.contract import attainable
from ..solvers.energy_audit import Audit
from ..solvers.integrate import solve
from .certificate import TrialRun, certify, choose_tolerance, error_estimator
from .film_selection import select_film
from .summary import summarise

SERIES = {
    "shaft_angle": Series("rad", "shaft angle, modulo one turn"),
    "shaft_speed": Series("rad/s", "shaft speed"),
    "relative_tilt_x": Series("rad", "relative tilt about xi, stator minus rotor"),
    "relative_tilt_y": Series("rad", "relative tilt about eta, stator minus rotor"),
    "relative_misalignment": Series("rad", "relative misalignment of the faces"),
    "relative_precession": Series("rad", "direction of the relative tilt, from xi"),
    "axial_gap_change": Series("m", "change of the axial gap from the design clearance"),
    "h_min": Series("m", "smallest film thickness over the face"),
    "h_min_angle": Series("rad", "angle of the smallest film thickness, from xi"),
    "h_min_radius": Series("m", "radius of the smallest film thickness"),
    "film_force": Series("N", "opening force of the film"),
    "film_moment_x": Series("N m", "film moment on the stator about xi"),
    "film_moment_y": Series("N m", "film moment on the stator about eta"),
    "closing_force": Series("N", "closing force"),
    "leakage_inner": Series("m^3/s", "leakage at the inner radius, from high to low pressure"),
    "leakage_outer": Series("m^3/s", "leakage at the outer radius, from high to low pressure"),
    "friction_torque": Series("N m", "friction torque on the rotor"),
    "friction_power": Series("W", "friction power"),
    "cavitated_fraction": Series("1", "share of the face at the cavitation pressure"),
}
CONTACT_SERIES = {
    "contact_force": Series("N", "contact force, opening"),
    "contact_moment_x": Series("N m", "contact moment on the stator about xi"),
    "contact_moment_y": Series("N m", "contact moment on the stator about eta"),
    "contact_torque": Series("N m", "friction torque of contact on the rotor"),
    "contact_area_fraction": Series("1", "share of the face that touches"),
    "contact_pressure": Series("Pa", "largest contact pressure"),
    "wear_rate": Series("m/s", "wear depth rate of both faces, mean over the face"),
}
SEAL_SERIES = {
    "seal_friction": ("N", "axial friction of the secondary seal on the {}"),
    "seal_moment_x": ("N m", "friction moment of the secondary seal on the {} about xi"),
    "seal_moment_y": ("N m", "friction moment of the secondary seal on the {} about eta"),
    "seal_sliding_speed": ("m/s", "sliding speed of the {} on its secondary seal"),
    "seal_stuck": ("1", "1 while the {} sticks on its secondary seal"),
}
PARTS = {
    "z": ("m", "axial displacement"),
    "tilt_x": ("rad", "tilt about xi"),
    "tilt_y": ("rad", "tilt about eta"),
    "z_rate": ("m/s", "axial velocity"),
    "tilt_x_rate": ("rad/s", "tilt rate about xi"),
    "tilt_y_rate": ("rad/s", "tilt rate about eta"),
}


# Single events kept in an archive; a seal that rubs for hours has more, which are counted.
MOST_EVENTS = 20_000


@dataclass(frozen=True)
class Result:
    """What a run leaves: status, a sentence, the summary of interface.md as a dict, and where the archive is."""

    status: str
    message: str
    summary: dict
    archive: Path


@dataclass
class Tally:
    """Running means and maxima of the sampled series; kept in the archive to go on from."""

    rows: int = 0
    sums: dict = None
    largest: dict = None

    NAMES = ("relative_misalignment", "leakage_inner", "leakage_outer", "friction_torque", "friction_power",
             "cavitated_fraction", "film_force", "shaft_speed", "axial_gap_change", "closing_force", "contact_force",
             "contact_torque", "contact_area_fraction", "contact_pressure", "wear_rate")  # fmt: skip

    def add(self, columns):
        names = [name for name in self.NAMES if name in columns]
        self.sums = self.sums or dict.fromkeys(names, 0.0)
        self.largest = self.largest or dict.fromkeys(names, -math.inf)
        self.rows += len(columns["time"])
        for name in self.sums:
            self.sums[name] += float(columns[name].sum())
            self.largest[name] = max(self.largest[name], float(columns[name].max()))

    def mean(self, name: str) -> float:
        return self.sums[name] / self.rows if self.rows and name in self.sums else math.nan


class ArchiveSink:
    """Takes what the solver has integrated: signals into the archive, restart data beside them."""

    def __init__(self, problem, writer, dt, count, tally, progress, stop):
        self.problem, self.writer, self.dt, self.count = problem, writer, dt, count
        self.tally, self.progress, self.stop = tally, progress, stop
        self.audit = self.errors = None
        self.waiting = None
        self.logged, self.pending = 0, []

    def due(self, index: int) -> np.ndarray:
        """Leg times of the samples in leg `index`, counted from the nearest sample so that they stay exact."""
        leg = self.problem.legs[index]
        first = max(0, math.ceil(leg.time / self.dt - 1e-9))
        # The offset of the first sample is taken in exact arithmetic.
        offset = float(Fraction(self.dt) * first - leg.start)
        last = index + 1 == len(self.problem.legs)
        end = leg.length
        number = math.floor((end - offset) / self.dt + 1e-9) + 1
        taus = offset + self.dt * np.arange(max(number, 0))
        # A sample at a leg's end belongs to the next leg, whose parameters it shows; the run's last stays.
        keep = (taus >= -1e-12 * end) & ((taus < end * (1 - 1e-12)) | last)
        return np.clip(taus[keep & (first + np.arange(len(taus)) <= self.count)], 0.0, end)

    def take(self, index, taus, q, q_rate):
        columns = signals(self.problem, taus, q, q_rate)
        self.tally.add(columns)
        if self.waiting is None:
            self.waiting = columns
        else:
            self.waiting = {k: np.concatenate([self.waiting[k], columns[k]]) for k in columns}

    def event(self, index, tau, event):
        self.log([{**event, "time": self.problem.legs[index].time + tau}])

    def log(self, events):
        """Keep events until the next flush; beyond the most that an archive keeps they are only counted."""
        kept = events[: max(MOST_EVENTS - self.logged, 0)]
        self.logged += len(kept)
        self.pending += kept

    def state(self, index, tau, y):
        self.flush(index, tau, y)
        if self.progress:
            leg = self.problem.legs[index]
            self.progress(leg.time + tau, self.problem.duration)
        if self.stop and self.stop():
            raise KeyboardInterrupt

    def flush(self, index, tau, y):
        """Rows, what happened, and the state to go on from: all three belong together."""
        if self.waiting is None:
            return
        problem = self.problem
        problem.tell_contacts(self.log)
        self.write_events()
        state = {
            "leg": index,
            "tau": tau,
            "y": np.asarray(y),
            "records": problem.records.ravel(),
            "tally": {"rows": self.tally.rows, "sums": self.tally.sums, "largest": self.tally.largest},
            "audit": self.audit.kept(),
            "errors": self.errors and self.errors.kept(),
            "modes": problem.kept_modes() | {"logged": self.logged},
            "names": problem.names,
        }
        self.writer.append(self.waiting, state)
        self.waiting = None

    def write_events(self):
        if self.pending:
            self.writer.events(self.pending)
        self.pending = []


class TallySink(ArchiveSink):
    """Takes the same samples, and keeps their means and maxima only."""

    def __init__(self, problem, dt, count):
        super().__init__(problem, None, dt, count, Tally(), None, None)

    def take(self, index, taus, q, q_rate):
        self.tally.add(signals(self.problem, taus, q, q_rate))

    def log(self, events):
        pass

    def flush(self, index, tau, y):
        pass


def sampling(scenario) -> tuple[float, float, int]:
    """Duration (s), sample interval (s) and number of intervals of a scenario's run."""
    run, speed = scenario.run, scenario.scene.shaft.speed
    if run.duration is not None:
        duration = run.duration
    else:
        try:
            duration = time_of_angle(speed, 2 * math.pi * run.turns)
        except ValueError as error:
            raise SceneError("run.turns", str(error), "run.duration instead") from None
    if run.samples is not None:
        return duration, duration / run.samples, run.samples
    fastest = max(abs(v) for v in speed.value) if isinstance(speed, PiecewiseLinear) else abs(speed)
    if fastest == 0.0:
        return duration, duration / 1000, 1000
    count = max(1, round(duration * fastest / (2 * math.pi) * run.samples_per_turn))
    exact = duration * fastest / (2 * math.pi) * run.samples_per_turn
    if abs(exact - count) < 1e-6 * count:
        return duration, duration / count, count
    interval = 2 * math.pi / fastest / run.samples_per_turn
    return duration, interval, int(duration / interval)


def simulate(
    scenario,
    out: str | os.PathLike | None = None,
    *,
    progress: Callable[[float, float], None] | None = None,
    stop: Callable[[], bool] | None = None,
    resume: bool = False,
) -> Result:
    """Run a scenario into an archive.

    `scenario` from `read_scenario`; `out` the archive's path (default outputs/<name>.h5); `progress(t, end)` is
    called as time advances (s); `stop()` returning true ends the run cleanly; `resume` goes on where an
    interrupted or killed run left off.  A run that fails is a result with its status.
    Raises ImpossibleScene or ArchiveError for a scene or file that cannot be.
    """
    begun = clock.perf_counter()
    out = Path(out) if out else Path("outputs") / f"{scenario.name}.h5"
    problem, method, why, interval, count, by_model = prepare_run(scenario)
    writer = ArchiveWriter(
        out,
        scenario_text=scenario.text,
        resolved=scenario.resolved(),
        meta=_meta(scenario, method),
        series=_series(problem),
        resume=resume,
        expected_rows=count,
    )
    sink = ArchiveSink(problem, writer, interval, count, Tally(), progress, stop)
    audit = Audit(problem)
    sink.audit, sink.errors = audit, error_estimator(problem, method)
    restart = _resumed(problem, writer, sink, audit) if resume and writer.rows else None
    trial = choose_tolerance(problem, method)
    outcome = solve(
        problem, method, problem.accuracy, sink, audit=audit, errors=sink.errors, resume=restart, **_tried(trial)
    )
    sink.flush(outcome.leg, outcome.tau, outcome.y)
    if outcome.status != "interrupted":
        # What an interrupted run has not written yet it will meet again.
        problem.tell_contacts(sink.log, end=(problem.legs[outcome.leg].time + outcome.tau, outcome.y))
        sink.write_events()
    summary = summarise(scenario, problem, outcome, sink.tally, method, _reasons(why, trial))
    summary["certificate"] = certificate(problem, method, outcome, sink.errors, by_model)
    summary["wall_time"] = clock.perf_counter() - begun
    path = partial_path(out) if outcome.status == "interrupted" else out
    summary["archive"] = str(path)
    if outcome.status != "interrupted":
        writer.events(_events(problem, outcome))
    path = writer.finish(outcome.status, outcome.message, json.loads(json.dumps(summary)))
    summary["archive"] = str(path)
    return Result(outcome.status, outcome.message, summary, path)


def _tried(trial: TrialRun | None) -> dict:
    """What a trial asks of `solve`."""
    return {"tolerance": trial.tolerance, "steps": trial.steps} if trial else {}


def _reasons(why: str, trial: TrialRun | None) -> str:
    return f"{why}; {trial.said}" if trial else why


def certificate(problem, method, outcome, errors, by_model) -> dict:
    """How wrong the run is estimated to be (simulation/certificate.py), as part of the summary."""
    if outcome.status != "ok":
        return {"asked": problem.accuracy, "estimated": None, "solver": None, "model": None,
                "said": f"no certificate: the run {outcome.status}"}  # fmt: skip
    found = certify(problem, method, errors, by_model)
    return {"asked": found.asked, "estimated": found.estimated, "solver": found.solver, "model": found.model,
            "said": found.said}  # fmt: skip


def simulate_in_memory(scenario) -> dict:
    """A run without an archive: the summary of interface.md.  Raises ImpossibleScene or ArchiveError."""
    begun = clock.perf_counter()
    problem, method, why, interval, count, _ = prepare_run(scenario)
    sink, trial = TallySink(problem, interval, count), choose_tolerance(problem, method)
    outcome = solve(problem, method, problem.accuracy, sink, errors=error_estimator(problem, method), **_tried(trial))
    problem.tell_contacts(sink.log, end=(problem.legs[outcome.leg].time + outcome.tau, outcome.y))
    summary = summarise(scenario, problem, outcome, sink.tally, method, _reasons(why, trial))
    return {**summary, "wall_time": clock.perf_counter() - begun}


def prepare_run(scenario):
    """A scenario made ready: problem (started and with its windows), method, why, sample interval (s), count, and a
    linear film's estimated error.
    Raises ImpossibleScene or ArchiveError."""
    duration, interval, count = sampling(scenario)
    accuracy = scenario.run.accuracy
    problem, by_model = select_film(scenario.scene, duration, accuracy, lambda p: _start(p, scenario))
    method, why = problem.solver()
    if scenario.run.solver != "auto":
        method, why = scenario.run.solver, "asked for"
    _check_method(problem, method)
    best = attainable(method, problem.memory)
    if best > accuracy:
        problem.warnings.append(
            f"accuracy: errors add up over {problem.memory:.3g} periods; {method} keeps {best:.1e} at best"
        )
    _set_windows(problem)
    fastest = problem.fastest_forcing()
    if fastest * interval > math.pi:
        problem.warnings.append(
            f"aliasing: forcing at {fastest / (2 * math.pi):.5g} Hz needs more than "
            f"{2 * fastest * duration / (2 * math.pi):.0f} samples in all, {count} asked: raise run.samples_per_turn"
        )
    return problem, method, why, interval, count, by_model


def _start(problem, scenario):
    """Initial unknowns: rest, the linear steady state, an archive's last state, and what [initial] gives."""
    if scenario.run.start == "steady":
        problem.y0 = problem.steady_start()
    elif scenario.run.start != "rest":
        state = archive.last_state(scenario.run.start)
        if not state:
            raise archive.ArchiveError(f"{scenario.run.start}: holds no last state to start from")
        rates = problem.n + np.arange(problem.n_mechanical - problem.n)
        if list(state["names"]) != problem.names or len(state["y"]) != problem.size:
            raise SceneError(
                "run.start",
                f"{scenario.run.start} with unknowns {', '.join(state['names'])}",
                f"an archive with the unknowns {', '.join(problem.names)}",
            )
        problem.y0[: problem.n] = state["y"][: problem.n]
        problem.y0[rates] = state["y"][rates]
    for k, ring in ((0, scenario.scene.initial.stator), (1, scenario.scene.initial.rotor)):
        for part in PARTS:
            given = getattr(ring, part)
            base = f"{RING_NAMES[k]}_{part.removesuffix('_rate')}"
            if given is None or base not in problem.names:
                continue
            place = problem.names.index(base)
            place = problem.rate_places[place] if part.endswith("_rate") else place
            if place >= 0:
                problem.y0[place] = given
    problem.check_start()


def _check_method(problem, method):
    if problem.massless and method != "ida":
        raise SceneError("run.solver", f'"{method}" for a massless ring', '"ida" (or "auto")')
    if method == "expm" and not (problem.linear and problem.constant):
        what = "a nonlinear film, contact or friction" if not problem.linear else "parameters that change with time"
        raise SceneError("run.solver", f'"expm" with {what}', 'film.model = "linear" and constant parameters')


def _set_windows(problem):
    """The last two forcing periods, for the steady state."""
    problem.begin(len(problem.legs) - 1)
    period, end = problem.period(), problem.duration
    constant_from = problem.leg.time if len(problem.legs) > 1 and not problem.constant else 0.0
    if period and end - 2 * period >= constant_from - 1e-9 * end:
        problem.windows[1:] = [[end - period, end], [end - 2 * period, end - period]]
    problem.begin(0)


def _resumed(problem, writer, sink, audit):
    state = writer.state
    problem.records[:] = np.array(state["records"], dtype=float).reshape(problem.records.shape)
    tally = state["tally"]
    sink.tally.rows, sink.tally.sums, sink.tally.largest = tally["rows"], tally["sums"], tally["largest"]
    audit.restore(state["audit"])
    if sink.errors and state.get("errors"):
        sink.errors.restore(state["errors"])
    problem.restore_modes(state["modes"])
    sink.logged = int(state["modes"]["logged"])
    return int(state["leg"]), float(state["tau"]), np.array(state["y"], dtype=float)


def _series(problem) -> dict[str, Series]:
    series = {}
    for k, name in enumerate(RING_NAMES):
        for part in list(PARTS)[: 6 if problem.floats[k] else 3]:
            units, long_name = PARTS[part]
            series[f"{name}_{part}"] = Series(units, f"{long_name} of the {name}")
    for names in wave_names(problem.face):
        for name, part in zip(names, ("cosine", "sine"), strict=True):
            series[name] = Series("m", f"{part} part of the gap's wave of order {name.rpartition('_')[2]}, from xi")
    if problem.contact is not None:
        series |= CONTACT_SERIES
    for k in problem.layout.seals:
        for part, (units, long_name) in SEAL_SERIES.items():
            series[f"{RING_NAMES[k]}_{part}"] = Series(units, long_name.format(RING_NAMES[k]))
    return {**series, **SERIES}


def _meta(scenario, method) -> dict:
    libraries = ("numpy", "scipy", "scikit-sundae", "h5py", "numba")
    return {
        "version": __version__,
        "libraries": {name: version(name) for name in libraries} | {"python": platform.python_version()},
        "solver": method,
        "accuracy": scenario.run.accuracy,
        "question": scenario.question,
        "overrides": list(scenario.overrides),
        "name": scenario.name,
    }


def _events(problem, outcome) -> list[dict]:
    record = problem.records[0]
    events = []
    if math.isfinite(record[0]):
        at = problem.legs[int(record[8])].time + record[1]
        kind = "collapse" if outcome.status == "collapsed" else "film_minimum"
        events.append({"kind": kind, "time": at, "value": record[0], "text": outcome.message,
                       "theta": record[2], "radius": record[3]})  # fmt: skip
    if outcome.status == "failed":
        at = problem.legs[outcome.leg].time + outcome.tau
        events.append({"kind": "failure", "time": at, "value": math.nan, "text": outcome.message})
    return events
