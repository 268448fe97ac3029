"""One pass: a scenario becomes a run, the run a trajectory, the trajectory an archive."""

import json
import math
import os
import time as clock
from collections.abc import Callable
from contextlib import contextmanager
from copy import deepcopy
from dataclasses import asdict, replace
from pathlib import Path

import numpy as np

from .. import archive
from ..archive import ArchiveWriter, only_writer, partial_path
from ..dynamics.extrema import H_LEG, H_RADIUS, H_TAU, H_THETA, H
from ..dynamics.tally import Tally
from ..scenario.reader import Scenario, with_values
from ..scene.radial import RadialScene
from ..solvers.contract import Status
from ..solvers.integrate import Outcome, solve
from ..solvers.methods import METHODS
from .certificate import TrialRun, certificate, first_steps, judgement, next_plan
from .result import Result, plain, provenance
from .selection import Plan, Start, prepare_run, set_start
from .sinks import ArchiveSink, RadialSink, archived_series
from .summary import parts, settled_friction
from .verification_run import Comparison, ProgressSink, RadialComparison, price

# By which the friction of the aligned film is counted where the run's is another.
FRICTION = "film.heat.friction"


def simulate(
    scenario: Scenario,
    out: str | os.PathLike | None = None,
    *,
    progress: Callable[[float, float], None] | None = None,
    stop: Callable[[], bool] | None = None,
    resume: bool = False,
    allow_large: bool = False,
) -> Result:
    """Run a scenario into an archive: what `sealdyn.run` does below its `Result`.  **Deprecated** as a door: call that.

    `scenario` from `read_scenario`; `out` the archive's path (default outputs/<name>.h5); `progress(t, end)` is
    called as time advances (s); `stop()` returning true ends the run cleanly; `resume` goes on where an
    interrupted or killed run left off, also after a KeyboardInterrupt.  A run that fails is a result with its status.
    `allow_large`: also a run of a day or of an archive of gigabytes (simulation/plausibility.py).
    Raises SceneError or ArchiveError for a scene or file that cannot be, or that another run is writing.

    >>> result = sealdyn.simulate(sealdyn.read_scenario("fms.toml"), "fms.h5")
    >>> result.summary["end"]["time"] == result.summary["end"]["asked"]
    True
    """
    out = Path(out) if out else Path("outputs") / f"{archive.file_stem(scenario.name)}.h5"
    with only_writer(out) as out:
        begun = going_on(scenario, out) if resume else scenario
        result, friction = _simulate(begun, out, progress, stop, resume, allow_large)
        if friction is not None and begun is scenario:
            warmer = with_values(scenario, {FRICTION: friction})
            result, _ = _simulate(warmer, out, progress, stop, False, allow_large)
        return result


def going_on(scenario: Scenario, out: Path) -> Scenario:
    """The scenario that an interrupted run goes on with: where it was done once more with its own friction, that."""
    source = archive.partial_path(out) if archive.partial_path(out).exists() else out
    more = list(archive.read_info(source).get("overrides", ()))[len(scenario.overrides) :] if source.exists() else []
    key, _, value = str(more[0]).partition("=") if len(more) == 1 else ("", "", "")
    return with_values(scenario, {FRICTION: value}) if key == FRICTION else scenario


def _simulate(scenario, out, progress, stop, resume, allow_large) -> tuple[Result, float | None]:
    """The same, while nobody else writes there; and the factor of the aligned film's friction by which a settled run
    would have the heat of its own."""
    begun = clock.perf_counter()
    run, plan = prepare_run(scenario, allow_large)
    tries = []
    radial = isinstance(scenario.scene, RadialScene)
    kind_of_sink, compared = (RadialSink, RadialComparison) if radial else (ArchiveSink, Comparison)
    series, fields = archived_series(run.model)
    while True:
        writer = ArchiveWriter(
            out,
            scenario_text=scenario.text,
            resolved=scenario.resolved(),
            meta={**provenance(scenario), "solver": plan.method, "accuracy": scenario.run.accuracy},
            series=series,
            fields=fields,
            resume=resume,
            expected_rows=plan.count,
        )
        if resume and writer.rows:
            plan, tries = _begun(run, scenario.scene, plan, writer)
        tally = None if radial else Tally(run.model)
        sink = kind_of_sink(run, writer, plan.interval, plan.count, tally, progress, stop)
        sink.begun = {
            "start": vars(run.start),
            "plan": asdict(plan),
            "tries": [[asdict(p), *rest] for p, *rest in tries],
        }
        trial, sink.errors = first_steps(run, plan)
        sink.seen = compared(run) if sink.errors is None and plan.method != "expm" else None
        restart = _restart(run, writer, sink) if resume and writer.rows else None
        try:
            outcome = solve(
                run, plan.method, run.model.accuracy, sink, audit=sink.audit, errors=sink.errors, seen=sink.seen,
                tally=tally, resume=restart, work=plan.work / price(plan.method), points=sink.point,
                tolerance=trial and trial.tolerance, steps=trial and trial.steps,
            )  # fmt: skip
            found, outcome = certificate(run, plan, outcome, sink.errors, sink.seen, progress, stop)
        except KeyboardInterrupt:
            # As if killed: what was written goes on.
            writer.close()
            raise
        again = next_plan(run, scenario.run.solver, plan, outcome, found, tries)
        if again is None:
            break
        tries.append((plan, outcome.tolerance, found))
        writer.close()
        run, plan, resume = run.anew(), again, False
    sink.flush(outcome.segment, outcome.tau, outcome.y)
    if outcome.status != Status.INTERRUPTED:
        # What an interrupted run has not written yet it will meet again.
        run.contacts.tell(sink.log, end=(run.end_time(outcome.segment, outcome.tau), outcome.y))
        sink.write_events()
    found, outcome = judgement(found, outcome, tries)
    summary = plain(parts(scenario, run, _completed_plan(plan, trial, outcome), outcome, sink.tally))
    summary["certificate"] = found
    if found["met"] is False:
        summary["warnings"].append(f"accuracy {found['said']}")
    summary["wall_time"] = clock.perf_counter() - begun
    path = partial_path(out) if outcome.status == Status.INTERRUPTED else out
    summary["archive"] = str(path)
    if outcome.status != Status.INTERRUPTED and not radial:
        writer.events(_events(run, outcome))
    path = writer.finish(str(outcome.status), outcome.message, json.loads(json.dumps(summary)))
    summary["archive"] = str(path)
    return Result(str(outcome.status), outcome.message, summary, path), own_friction(run, outcome, sink.tally)


def own_friction(run, outcome, tally) -> float | None:
    """The factor of the aligned film's friction that is a run's; None where the warm state counts that, or the run did
    not end, or takes no heat."""
    if tally is None or run.model.heat is None or outcome.status not in (Status.OK, Status.INACCURATE):
        return None
    from .heat import counted, is_another

    friction, aligned = settled_friction(run.model, tally), counted(run.model.heat)
    factor = run.model.given.film.heat.friction
    return factor * friction / aligned if is_another(friction, aligned) else None


def _completed_plan(plan: Plan, trial: TrialRun | None, outcome: Outcome) -> Plan:
    """The plan with all reasons that a run has had."""
    slow = outcome.counts.slow
    return replace(plan, why="; ".join([plan.why, *([trial.said] if trial else []), *([slow] if slow else [])]))


def simulate_in_memory(scenario, speeds: bool = False) -> dict:
    """A run without an archive: the summary as `run --json` prints it, without a certificate; critical and resonance
    speeds only if `speeds`.  Raises SceneError or ArchiveError."""
    begun = clock.perf_counter()
    summary = plain(in_memory(scenario, speeds))
    return {**summary, "wall_time": clock.perf_counter() - begun}


def in_memory(scenario, speeds: bool = False, lowest: bool = True, again: bool = False) -> dict:
    """The same, as its `parts` (summary.py); `again`: with the friction of a run before."""
    run, plan = prepare_run(scenario, lowest=lowest)
    sink, tally = ProgressSink(run), None if isinstance(scenario.scene, RadialScene) else Tally(run.model)
    trial, errors = first_steps(run, plan)
    outcome = solve(
        run, plan.method, run.model.accuracy, sink, errors=errors, tally=tally,
        tolerance=trial and trial.tolerance, steps=trial and trial.steps,
    )  # fmt: skip
    run.contacts.tell(sink.log, end=(run.end_time(outcome.segment, outcome.tau), outcome.y))
    if not again and (friction := own_friction(run, outcome, tally)) is not None:
        return in_memory(with_values(scenario, {FRICTION: friction}), speeds, lowest, again=True)
    return parts(scenario, run, _completed_plan(plan, trial, outcome), outcome, tally, speeds)


@contextmanager
def _own_state(writer):
    """Reading the state that a run goes on from; ArchiveError where it is none of such a run."""
    try:
        yield
    except archive.READING_ERRORS as error:
        raise archive.ArchiveError(
            f"{writer.path}: cannot be continued, its state is none of this run ({error})"
        ) from None


def _begun(run, scene, plan, writer):
    """The plan that a run goes on by, and what was tried before it; a run begun is not begun elsewhere, whatever would
    be chosen now."""
    state = writer.state
    with _own_state(writer):
        begin = Start(**state["start"])
        plan = _plan_of(state["plan"])
        tries = [(_plan_of(before), float(tolerance), dict(found)) for before, tolerance, found in state["tries"]]
    writer.note(solver=plan.method)
    set_start(run, scene, begin)
    return plan, tries


def _plan_of(kept: dict) -> Plan:
    """A plan as it was kept."""
    plan = Plan(**{**kept, "start": Start(**kept["start"])})
    if plan.method not in METHODS or not (plan.tolerance is None or plan.tolerance > 0.0):
        raise ValueError("no method that this program has")
    return plan


def _restart(run, writer, sink) -> tuple | None:
    """Where a run goes on, as `resume` of `solve`: the last start of its method that was kept; None: its beginning."""
    with _own_state(writer):
        point = writer.state["point"]
        writer.goes_on_from(point["written"] if point else (0, 0, 0))
        if point is None:
            return None
        leg, tau, y, account = (
            int(point["leg"]),
            float(point["tau"]),
            np.array(point["y"], dtype=float),
            deepcopy(point["account"]),
        )
        if not 0 <= leg < len(run.intervals) or y.shape != run.y0.shape or not np.all(np.isfinite([tau, *y])):
            raise ValueError("unknowns of another kind or number")
        if not account["tolerance"] > 0.0:
            raise ValueError("no tolerance")
        sink.restore(point)
    return leg, tau, y, account


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
