"""One pass: a scenario becomes a run, the run a trajectory, the trajectory an archive."""

import json
import math
import os
import platform
import time as clock
from collections.abc import Callable
from contextlib import contextmanager
from dataclasses import replace
from functools import cache
from importlib.metadata import version
from pathlib import Path

import numpy as np

from .. import __version__, archive
from ..archive import ArchiveWriter, only_writer, partial_path
from ..dynamics.cautions import Caution, Concern
from ..dynamics.extrema import H_LEG, H_RADIUS, H_TAU, H_THETA, H
from ..dynamics.intervals import largest_value
from ..dynamics.sampled_motion import COARSE, PER_PERIOD, motions
from ..dynamics.signals import PARTS
from ..scenario.reader import Scenario
from ..scene.radial import RadialScene
from ..scene.rings import RING_NAMES
from ..scene.scene import SceneError
from ..solvers.contract import Counts, Enough, Status, attainable
from ..solvers.energy_audit import EnergyAudit
from ..solvers.integrate import Outcome, solve
from .certificate import TrialRun, Try, certify, choose_tolerance, ended, interrupted, judged, next_try, without
from .plausibility import refuse_large, unit_warnings
from .result import Result, plain
from .selection import Start, check_method, choose_method, choose_start, select_film
from .sinks import ArchiveSink, Tally, TallySink, what_is_kept
from .summary import parts, summarise
from .verification_run import Comparison


def sampling(duration: float, fastest: float, settings) -> tuple[float, int]:
    """Sample interval (s) and number of intervals of a run of `duration` (s), its shaft turning at `fastest` (rad/s) at
    most; `settings` as the `[run]` table."""
    if settings.samples is not None:
        return duration / settings.samples, settings.samples
    if fastest == 0.0:
        return duration / 1000, 1000
    count = max(1, round(duration * fastest / (2 * math.pi) * settings.samples_per_turn))
    exact = duration * fastest / (2 * math.pi) * settings.samples_per_turn
    if abs(exact - count) < 1e-6 * count:
        return duration / count, count
    interval = 2 * math.pi / fastest / settings.samples_per_turn
    return interval, int(duration / interval)


def simulate(
    scenario: Scenario,
    out: str | os.PathLike | None = None,
    *,
    progress: Callable[[float, float], None] | None = None,
    stop: Callable[[], bool] | None = None,
    resume: bool = False,
    allow_large: bool = False,
) -> Result:
    """Run a scenario into an archive.

    `scenario` from `read_scenario`; `out` the archive's path (default outputs/<name>.h5); `progress(t, end)` is
    called as time advances (s); `stop()` returning true ends the run cleanly; `resume` goes on where an
    interrupted or killed run left off, also after a KeyboardInterrupt.  A run that fails is a result with its status.
    `allow_large`: also a run of a day or of an archive of gigabytes (simulation/plausibility.py).
    Raises SceneError or ArchiveError for a scene or file that cannot be, or that another run is writing.

    >>> result = sealdyn.simulate(sealdyn.read_scenario("fms.toml"), "fms.h5")
    >>> result.summary["end"]["time"] == result.summary["end"]["asked"]
    True
    """
    out = Path(out) if out else Path("outputs") / f"{scenario.name}.h5"
    refuse_large(scenario, allow_large)
    with only_writer(out) as out:
        if isinstance(scenario.scene, RadialScene):
            from .radial import simulate_radial

            return simulate_radial(scenario, out, progress, stop, resume)
        return _simulate(scenario, out, progress, stop, resume)


def _simulate(scenario, out, progress, stop, resume) -> Result:
    """The same, while nobody else writes there."""
    begun = clock.perf_counter()
    run, method, why, interval, count, by_model = prepare_run(scenario)
    series, fields = what_is_kept(run.model)
    one = Try(method, None, why)
    tries = []
    while True:
        writer = ArchiveWriter(
            out,
            scenario_text=scenario.text,
            resolved=scenario.resolved(),
            meta=_meta(scenario, one.method),
            series=series,
            fields=fields,
            resume=resume,
            expected_rows=count,
        )
        sink = ArchiveSink(run, writer, interval, count, Tally(), progress, stop)
        audit = EnergyAudit()
        sink.audit = audit
        restart = _resumed(run, writer, sink, audit) if resume and writer.rows else None
        if restart and "start" in writer.state:
            # A run begun is not begun elsewhere, whatever would be chosen now.
            with _own_state(writer):
                begin = Start(**writer.state["start"])
            _start(run, scenario, begin)
        trial, sink.errors = one.start(run)
        if restart and sink.errors and writer.state.get("errors"):
            with _own_state(writer):
                sink.errors.restore(writer.state["errors"])
        seen = Comparison(run) if sink.errors is None and one.method != "expm" else None
        try:
            outcome = solve(
                run, one.method, run.model.accuracy, sink, audit=audit, errors=sink.errors, seen=seen, resume=restart,
                **_found(trial),
            )  # fmt: skip
            found, outcome = certificate(run, one.method, outcome, sink.errors, by_model, seen, progress, stop)
        except KeyboardInterrupt:
            # As if killed: what was written goes on.
            writer.close()
            raise
        again = next_try(run, scenario.run.solver, one, outcome, found, tries)
        if again is None:
            break
        tries.append((one, outcome.tolerance, found))
        writer.close()
        run, one, resume = run.anew(), again, False
    sink.flush(outcome.segment, outcome.tau, outcome.y)
    if outcome.status != Status.INTERRUPTED:
        # What an interrupted run has not written yet it will meet again.
        run.contacts.tell(sink.log, end=(run.end_time(outcome.segment, outcome.tau), outcome.y))
        sink.write_events()
    found, outcome = judged(found, outcome, tries)
    summary = summarise(scenario, run, outcome, sink.tally, one.method, _reasons(one.why, trial, outcome.counts))
    summary["certificate"] = found
    if found["met"] is False:
        summary["warnings"].append(f"accuracy {found['said']}")
    summary["wall_time"] = clock.perf_counter() - begun
    path = partial_path(out) if outcome.status == Status.INTERRUPTED else out
    summary["archive"] = str(path)
    if outcome.status != Status.INTERRUPTED:
        writer.events(_events(run, outcome))
    path = writer.finish(str(outcome.status), outcome.message, json.loads(json.dumps(summary)))
    summary["archive"] = str(path)
    return Result(str(outcome.status), outcome.message, summary, path)


def _found(trial: TrialRun | None) -> dict:
    """What a trial asks of `solve`."""
    return {"tolerance": trial.tolerance, "steps": trial.steps} if trial else {}


def _reasons(why: str, trial: TrialRun | None, counts: Counts) -> str:
    parts = [why, *([trial.said] if trial else [])]
    return "; ".join([*parts, *([counts.slow] if counts.slow else [])])


def certificate(run, method, outcome, errors, by_model, seen, progress=None, stop=None) -> tuple[dict, Outcome]:
    """How wrong the run is estimated to be (simulation/certificate.py), as part of the summary: `asked`, `estimated`,
    `solver`, `model` (relative errors, None where not estimated), `met`, `horizon` (s) and `said`, a sentence; and the
    outcome, interrupted if the measuring was."""
    asked = run.model.accuracy
    if outcome.status != Status.OK:
        return without(asked, ended(outcome.status)), outcome
    measured = cells = None
    if seen:
        try:
            how = {"method": method, "tolerance": outcome.tolerance}
            apart, cells = seen.error_over_time(progress, stop, **how), seen.error_of_cells(progress, stop, **how)
        except Enough:
            return interrupted(asked, outcome)
        measured = None if apart is None else (seen.times, apart)
    found = certify(run, method, outcome.tolerance, errors, by_model, measured, cells)
    beside = {} if found.grid is None else {"cells": found.cells, "grid_asked": found.grid}
    unseen = "; the run was done before it was continued, begun anew it is measured"
    found = replace(found, said=found.said + unseen) if seen and seen.columns is None else found
    return {"asked": found.asked, "estimated": found.estimated, "solver": found.solver, "model": found.model,
            "met": found.met, "horizon": found.horizon, **beside, "said": found.said}, outcome  # fmt: skip


def simulate_in_memory(scenario, speeds: bool = False) -> dict:
    """A run without an archive: the summary as `run --json` prints it, without a certificate; critical and resonance
    speeds only if `speeds`.  Raises SceneError or ArchiveError."""
    begun = clock.perf_counter()
    summary = plain(in_memory(scenario, speeds))
    return {**summary, "wall_time": clock.perf_counter() - begun}


def in_memory(scenario, speeds: bool = False) -> dict:
    """The same, as its `parts` (summary.py)."""
    if isinstance(scenario.scene, RadialScene):
        from .radial import radial_in_memory

        return radial_in_memory(scenario)
    run, method, why, interval, count, _ = prepare_run(scenario)
    sink, (trial, errors) = TallySink(run, interval, count), choose_tolerance(run, method)
    outcome = solve(run, method, run.model.accuracy, sink, errors=errors, **_found(trial))
    run.contacts.tell(sink.log, end=(run.end_time(outcome.segment, outcome.tau), outcome.y))
    return parts(scenario, run, outcome, sink.tally, method, _reasons(why, trial, outcome.counts), speeds)


def prepare_run(scenario):
    """A scenario made ready: run (RunState with its start and windows), method, a sentence why, sample interval (s),
    number of intervals, and a linear film's estimated error (or None).
    Raises SceneError, which names the numbers that may want a unit, or ArchiveError."""
    try:
        return _prepared(scenario)
    except SceneError as error:
        if not (meant := unit_warnings(scenario)):
            raise
        raise SceneError(error.key, error.found, f"{error.expected}; {'; '.join(meant)}") from None


def _prepared(scenario):
    refuse_large(scenario, allowed=True)
    settings = scenario.run
    chosen = []

    def begin(run):
        # Once for the scene, by the film it asks for: a simpler film tried for it starts where that one does.
        if not chosen:
            chosen.append(choose_start(run, settings.start))
        _start(run, scenario, chosen[0])

    run, by_model = select_film(scenario.scene, settings, begin)
    interval, count = sampling(run.duration, largest_value(scenario.scene.shaft.speed), settings)
    run.check_loads()
    method, why = settings.solver, "asked for"
    if method != "auto":
        check_method(run.model, method)
    else:
        method, why = choose_method(run)
    best = attainable(method, run.memory)
    if best > settings.accuracy:
        sentence = f"accuracy: errors add up over {run.memory:.3g} periods; {method} keeps {best:.1e} at best"
        run.cautions.append(Caution(Concern.ACCURACY, sentence))
    run.watch_last_periods()
    fastest = run.fastest_forcing()
    if fastest * interval > math.pi:
        frequency = fastest / (2 * math.pi)
        sentence = (
            f"aliasing: forcing at {frequency:.5g} Hz needs more than {2 * frequency * run.duration:.0f} samples "
            f"in all, {count} asked: raise run.samples_per_turn"
        )
        run.cautions.append(Caution(Concern.ALIASING, sentence))
    for ring, sampled in motions(scenario.scene).items():
        if sampled.coarse > COARSE:
            table, share = ("housing", "shaft")[ring], 100.0 * sampled.coarse
            sentence = (
                f"aliasing: {share:.2g} % of the power of the rate of {table}.motion has fewer than {PER_PERIOD} "
                "samples a period: give it finer"
            )
            run.cautions.append(Caution(Concern.ALIASING, sentence))
    return run, method, why, interval, count, by_model


def _start(run, scenario, begun: Start):
    """Initial unknowns: rest, the linear steady state, an archive's last state, and what [initial] gives."""
    unknowns, start = run.model.unknowns, begun.taken
    run.start, run.y0 = begun, np.zeros(unknowns.size)
    if start == "steady":
        run.y0, run.extrema.steady = run.steady_start(), True
    elif start != "rest":
        rates = unknowns.n + np.arange(unknowns.n_mechanical - unknowns.n)
        y = _last_unknowns(start, unknowns)
        run.y0[: unknowns.n] = y[: unknowns.n]
        run.y0[rates] = y[rates]
    for k, ring in ((0, scenario.scene.initial.stator), (1, scenario.scene.initial.rotor)):
        for part in PARTS:
            given = getattr(ring, part)
            base = f"{RING_NAMES[k]}_{part.removesuffix('_rate')}"
            if given is None or base not in unknowns.names:
                continue
            place = unknowns.names.index(base)
            place = unknowns.rate_places[place] if part.endswith("_rate") else place
            if place >= 0:
                run.y0[place] = given
    run.check_start()


def _last_unknowns(start, unknowns) -> np.ndarray:
    """The unknowns (size,) that the archive `start` ends with."""
    state = archive.last_state(start)
    if not state:
        raise archive.ArchiveError(f"{start}: holds no last state to start from")
    try:
        names, y = [str(name) for name in state["names"]], np.array(state["y"], float)
    except archive.READING_ERRORS as error:
        raise archive.ArchiveError(f"{start}: its last state is none of this program's ({error})") from None
    if names != unknowns.names or y.shape != (unknowns.size,):
        found, wanted = (", ".join(one)[:200] for one in (names, unknowns.names))
        raise SceneError("run.start", f"{start} with unknowns {found}", f"an archive with the unknowns {wanted}")
    if not np.all(np.isfinite(y)):
        raise archive.ArchiveError(f"{start}: its last state is no number")
    return y


@contextmanager
def _own_state(writer):
    """Reading the state that a run goes on from; ArchiveError where it is none of such a run."""
    try:
        yield
    except archive.READING_ERRORS as error:
        raise archive.ArchiveError(
            f"{writer.path}: cannot be continued, its state is none of this run ({error})"
        ) from None


def _resumed(run, writer, sink, audit):
    """Where a run goes on: segment, time in it (s), unknowns (size,)."""
    state = writer.state
    with _own_state(writer):
        run.extrema.restore(state["records"])
        tally = state["tally"]
        sink.tally.rows, sink.tally.sums, sink.tally.largest = tally["rows"], tally["sums"], tally["largest"]
        audit.restore(state["audit"])
        run.restore_modes(state["modes"])
        sink.logged = int(state["modes"]["logged"])
        leg, tau, y = int(state["leg"]), float(state["tau"]), np.array(state["y"], dtype=float)
        if not 0 <= leg < len(run.intervals) or y.shape != run.y0.shape or not np.all(np.isfinite([tau, *y])):
            raise ValueError("unknowns of another kind or number")
    return leg, tau, y


@cache
def _libraries() -> dict[str, str]:
    """Versions of what decides the numbers; looked up once, since each costs milliseconds."""
    names = ("numpy", "scipy", "scikit-sundae", "h5py", "numba")
    return {name: version(name) for name in names} | {"python": platform.python_version()}


def _meta(scenario, method) -> dict:
    return {
        "version": __version__,
        "libraries": _libraries(),
        "solver": method,
        "accuracy": scenario.run.accuracy,
        "question": scenario.question,
        "overrides": list(scenario.overrides),
        "name": scenario.name,
    }


def _events(run, outcome) -> list[dict]:
    record = run.extrema.extremes()[0]
    events = []
    if math.isfinite(record[H]):
        at = run.end_time(int(record[H_LEG]), record[H_TAU])
        kind = "collapse" if outcome.status == Status.COLLAPSED else "film_minimum"
        events.append({"kind": kind, "time": at, "value": record[H], "text": outcome.message,
                       "theta": record[H_THETA], "radius": record[H_RADIUS]})  # fmt: skip
    if outcome.status == Status.FAILED:
        at = run.end_time(outcome.segment, outcome.tau)
        events.append({"kind": "failure", "time": at, "value": math.nan, "text": outcome.message})
    return events
