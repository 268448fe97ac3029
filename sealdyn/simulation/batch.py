"""Many runs of one scenario with other values: one compiled loop, Python only before and after it.

What CVODE integrates, without friction that sticks, goes through the loop (dynamics/batch_loop.py); all others, radial
seals among them, and runs that do not end well, go one by one.  The loop has no trial and follows no errors: its runs
have the cautious tolerance of solvers/contract.py, and their numbers are those of single runs within the asked
accuracy.
"""

from __future__ import annotations

import os
from collections.abc import Callable, Iterable, Mapping
from contextlib import closing, suppress
from dataclasses import replace
from functools import partial
from itertools import product
from threading import Event, Thread
from typing import TYPE_CHECKING, Any

import numpy as np

from ..archive import as_dataset, columns_of
from ..dynamics.extrema import slack, watched_level
from ..dynamics.native import thinnest_value
from ..dynamics.tally import ROW, Tally
from ..numerics.parallel import AT_ONCE, Together, processes
from ..scenario.errors import ScenarioError
from ..scenario.overrides import without_arrays
from ..scenario.reader import Scenario, scenario_of, with_values
from ..scene.radial import RadialScene
from ..scene.scene import SceneError
from ..solvers.contract import MOST_ORDERS, Cause, Counts, Status, tolerance_for
from ..solvers.integrate import STIFF, Outcome
from ..solvers.methods import looped
from .result import (
    START,
    asks_speeds,
    common_outputs,
    missing_outputs,
    output,
    unit_of,
    with_choices,
    without_equal_choices,
)
from .selection import prepare_run, starts_of
from .simulate import in_memory, own_friction
from .summary import parts, state_names
from .verification_run import ProgressSink

if TYPE_CHECKING:
    import pandas
    import xarray

# What is asked of a face seal, and of a radial one, unless told.
OUTPUTS = ("h_min.value", "h_min.steady", "relative_misalignment.max")
RADIAL_OUTPUTS = ("whole.largest_gap", "settled.contact_share")
# Starts that all runs may share, the better first.
ALIKE = ("steady", "rest")
# Length (s) of a run that only shows what a summary has.
MOMENT = 1e-6


def simulate_many(
    scenario: Scenario,
    sets: Iterable[Mapping[str, Any]],
    outputs: Iterable[str] | None = None,
    *,
    workers: int | None = None,
    progress: Callable[[int, int], None] | None = None,
) -> xarray.Dataset:
    """Many runs of a scenario in memory, as an `xarray.Dataset` over the dimension `run`.

    `sets`: of each run {dotted key: value}, values as for `with_values` (scenario/settings.py); `outputs`: dotted keys
    of the run's summary, of which means and largest values ("leakage.mean") cost most, none the least; `workers`
    processes (None: all cores); `progress(done, all)`.  Variables are the outputs, of a face seal the end state
    (end.state.*, SI), `status` and `message`; a run that cannot be has the status "not possible" and its reason as
    message.
    **Valid** runs with the same unknowns.
    Raises ScenarioError if no run can be read, SceneError if the first that can be read cannot be run.

    >>> scenario = sealdyn.read_scenario("fms.toml")
    >>> data = sealdyn.simulate_many(scenario, [{"rotor.runout": 1e-5}, {"rotor.runout": 2e-5}], workers=1)
    >>> 1e6 * data["h_min.value"].values.round(8)
    array([9.68, 9.36])
    """
    sets = [dict(values) for values in sets]
    first = first_ready(scenario, sets)
    names = [] if _is_radial(scenario) else state_names(first.model.unknowns)
    outputs = _output_list(scenario, outputs)
    outputs = [*dict.fromkeys([*outputs, *(f"end.state.{name}" for name in names)])]
    rows = rows_of(scenario, sets, with_choices(scenario.scene, outputs), workers, progress)
    units = {name: unit_of(name) for name in outputs}
    axis = {"key": "run", "values": range(len(sets)), "unit": None}
    return as_dataset({"keys": ["run"], "axes": [axis], "rows": rows, "outputs": outputs, "output_units": units})


def sweep(
    source: Scenario | str | os.PathLike,
    grid: Mapping[str, Iterable[Any]],
    outputs: Iterable[str] | str | None = None,
    *,
    workers: int | None = None,
    progress: Callable[[int, int], None] | None = None,
) -> pandas.DataFrame:
    """Runs of a scenario over a grid of keys, as a `pandas.DataFrame`: a row a run, indexed by the keys.

    `grid` {dotted key: values}, SI numbers or "5 um", of which the first varies slowest; `outputs` dotted keys of the
    summary, the columns beside `status` and `message`; `attrs["units"]` {column: unit}.  Where a run was not possible
    numbers are NaN, the status is "not possible" and the message its reason.  `workers`, `progress` as in
    `simulate_many`.
    Raises ScenarioError if no run can be read, a key has no values, or there is no such output.

    >>> table = sealdyn.sweep("fms.toml", {"rotor.runout": ["10 urad", 2e-5]}, "h_min.value", workers=1)
    >>> table["h_min.value"].round(8).to_dict()
    {'10 urad': 9.68e-06, 2e-05: 9.36e-06}
    """
    import pandas

    scenario = scenario_of(source)
    outputs = _output_list(scenario, outputs)
    axes = {key: list(without_arrays(values)) for key, values in grid.items()}
    if not axes or not all(axes.values()):
        empty = next((key for key in axes if not axes[key]), "")
        raise ScenarioError(scenario.name, empty, "no values", 'values to go through: {"rotor.runout": [1e-5, 2e-5]}')
    places = list(product(*axes.values()))
    sets = [dict(zip(axes, place, strict=True)) for place in places]
    # A grid may begin where no seal can be; kernels are loaded once for all processes in any case.
    with suppress(SceneError):
        first_ready(scenario, sets)
    refuse_outputs(scenario, sets, outputs, "outputs")
    asked = with_choices(scenario.scene, outputs)
    rows = rows_of(scenario, sets, asked, workers, progress)
    outputs = without_equal_choices(rows, asked, outputs, axes)
    names = list(axes)
    index = pandas.Index([place[0] for place in places], name=names[0]) if len(axes) == 1 else None
    index = pandas.MultiIndex.from_tuples(places, names=names) if index is None else index
    table = pandas.DataFrame(columns_of(rows, outputs), index=index)
    table.attrs["units"] = {output: unit_of(output) for output in outputs if unit_of(output)}
    return table


def _is_radial(scenario) -> bool:
    return isinstance(scenario.scene, RadialScene)


def _output_list(scenario, outputs) -> list[str]:
    """Outputs as a list; the usual ones of the kind of seal where none are told."""
    if outputs is None:
        return [*(RADIAL_OUTPUTS if _is_radial(scenario) else OUTPUTS)]
    return [outputs] if isinstance(outputs, str) else list(outputs)


def rows_of(scenario, sets: list[dict], outputs: list[str], workers, progress) -> list[dict]:
    """A row of each run, in their order: its outputs, `status`, and `message` or `failed` unless it ended well."""

    def evaluate(function, points):
        rows = [None] * len(points)
        with closing(processes(workers)(function, dict(enumerate(points)), "runs")) as answers:
            for done, (k, row, _) in enumerate(answers):
                rows[k] = row
                if progress:
                    progress(done + 1, len(points))
        return rows

    points = [{"set": values, "outputs": outputs} for values in sets]
    return rows_alike(scenario, Together(partial(run_many, scenario)), points, evaluate)


def rows_alike(scenario, function, points: list[dict], evaluate) -> list[dict]:
    """Rows of `function` of the points (as `run_many` has them, START among their outputs), by `evaluate(function,
    points)`: runs whose start is left open begin alike, on the steady response if all can, else at rest if all can.
    What begins otherwise shows other numbers, whatever is varied; where neither can be, each keeps its own start."""
    rows = evaluate(function, points)
    starts = {row[START] for row in rows if row.get(START)}
    if len(starts) < 2 or scenario.run.start != "auto" or any("run.start" in point["set"] for point in points):
        return rows
    begun = [{"set": point["set"]} for point, row in zip(points, rows, strict=True) if row.get(START)]
    able = evaluate(partial(starts_at, scenario), begun)
    if common := next((start for start in ALIKE if all(each[start] for each in able)), None):
        again = [k for k, row in enumerate(rows) if row.get(START) not in (None, common)]
        anew = [{**points[k], "set": {**points[k]["set"], "run.start": common}} for k in again]
        for k, row in zip(again, evaluate(function, anew), strict=True):
            rows[k] = row
    return rows


def starts_at(scenario, point: dict) -> dict[str, bool]:
    """`starts_of` (selection.py) the scenario with the values of a point."""
    return starts_of(with_values(scenario, point["set"]))


def first_ready(scenario, sets):
    """The first of the runs that can be read, made ready (RunState), so that kernels are loaded once for all processes.
    Raises the first one's ScenarioError if none can be read, SceneError if it cannot be run."""
    first = ScenarioError(scenario.name, "sets", "none", "values of at least one run")
    for k, values in enumerate(sets):
        try:
            found = with_values(scenario, values)
        except ScenarioError as error:
            first = error if k == 0 else first
        else:
            return prepare_run(found)[0]
    raise first


def refuse_outputs(scenario, sets: list[dict], outputs, where: str) -> None:
    """Raises ScenarioError, which names `where`, for outputs that no summary of these runs has: found before any is
    run, by a moment of the first that can be one."""
    if set(outputs) <= {"status", "message", *common_outputs(scenario.scene)}:
        return
    for values in sets:
        try:
            parts = in_memory(with_values(scenario, {**values, "run.duration": MOMENT}), asks_speeds(outputs))
        except (ScenarioError, SceneError):
            continue
        if wrong := missing_outputs(parts, outputs):
            raise ScenarioError(scenario.name, where, ", ".join(wrong), f"others: {'; '.join(wrong.values())}")
        return


def run_many(scenario, points: list[dict]) -> list:
    """Of each point {"set": {dotted key: value}, "outputs": dotted keys of the summary}: a row of its outputs, status,
    and message when the run did not end well; or the exception why it cannot be."""
    return [row for k in range(0, len(points), AT_ONCE) for row in _rows_in_loop(scenario, points[k : k + AT_ONCE])]


def _rows_in_loop(scenario, points) -> list:
    rows, alike = [None] * len(points), {}
    for k, point in enumerate(points):
        try:
            one = with_values(scenario, point["set"])
            if _is_radial(one):
                continue
            run = LoopedRun(one, point["outputs"])
        except Exception as error:
            rows[k] = error
            continue
        if run.structure:
            alike.setdefault(run.structure, []).append((k, run))
    for some in alike.values():
        integrate([run for _, run in some])
        for k, run in some:
            if run.outcome and own_friction(run.run, run.outcome, run.tally) is None:
                row = _row_or_error(_row, run.parts(), points[k])
                # What is tallied after all, or is not there, is a matter for the whole summary.
                rows[k] = None if isinstance(row, NotTallied) else row
    return [row if row is not None else _row_or_error(_single_run, scenario, points[k]) for k, row in enumerate(rows)]


def _row_or_error(function, *given):
    try:
        return function(*given)
    except Exception as error:
        return error


def _single_run(scenario, point) -> dict:
    return _row(in_memory(with_values(scenario, point["set"]), asks_speeds(point["outputs"]), lowest=False), point)


def _row(parts, point) -> dict:
    row = {key: output(parts, key) for key in ("status", *point["outputs"])}
    return row if row["status"] == Status.OK else {**row, "message": parts["message"]}


# Contacts of one run at most, numbers that a run may hand over, and seconds between two looks at the keyboard; points
# of the tally that there is room for: in any run, and in a shortest period.
MOST_CONTACTS, MOST_OUTPUT, PATIENCE = 256, 4_000_000, 0.1
LEAST_ROOM, ROOM = 10_000, 200
# Parts of the summary that are means or largest values, and what only a run of its own has.
TALLIED = (
    "leakage", "friction", "relative_misalignment.mean", "contact.force", "contact.share_of_closing",
    "contact.share_of_load", "contact.torque", "contact.max_area_fraction", "contact.max_pressure", "contact.wear_rate",
    "film.max_cavitated_fraction", "warnings",
)  # fmt: skip
# Those that are extremes between steps.
EXTREMES = ("h_min", "relative_misalignment")
OWN = ("energy_residual", "counts.back_end")


class LoopedRun:
    """A scenario made ready: `run`, `plan`, `segments`; `structure` is equal for runs that can share a loop, and None
    for one that can be in none.  `outcome` (solvers/integrate.py) is None until it has ended well."""

    def __init__(self, scenario, outputs):
        self.scenario, self.outputs, self.outcome = scenario, outputs, None
        self.run, self.plan = prepare_run(scenario, lowest=False)
        run, unknowns = self.run, self.run.model.unknowns
        self.method = self.plan.method
        self.tolerance = tolerance_for(self.method, run.model.accuracy, run.memory)
        self.structure = None
        self.tallied, self.watched = (any(key.startswith(asked) for key in outputs) for asked in (TALLIED, EXTREMES))
        # Whether a warm seal rubs as its state counts is a matter of means.
        self.tallied = self.tallied or run.model.heat is not None
        self.segments = [run.segment(index) for index in range(len(run.intervals))]
        alone = run.stick_slip or any(key.startswith(OWN) for key in outputs) or not looped(self.segments[0])
        self.room = LEAST_ROOM + int(ROOM * run.duration / run.model.shortest_period) if self.tallied else 0
        heavy = self.room * unknowns.n > MOST_OUTPUT
        if alone or heavy or self.method not in ("adams", "bdf"):
            return
        self.tally = Tally(run.model) if self.tallied else Untallied()
        thinnest, touching = thinnest_value(run.model.face), run.model.contact is not None
        places = tuple(unknowns.rate_places)
        kernels = thinnest, touching, unknowns.impulse
        self.structure = self.method, unknowns.size, places, *kernels, self.tallied, self.watched

    def parts(self) -> dict:
        """The `parts` of its summary (summary.py), once it has ended."""
        plan = replace(self.plan, why=f"{self.plan.why}; one loop for many runs, cautious tolerance")
        return parts(self.scenario, self.run, plan, self.outcome, self.tally, asks_speeds(self.outputs))

    def ends(self, runs, i, touching, output):
        """Take what the loop has left in row `i`."""
        run, last = self.run, self.segments[-1]
        run.extrema.records = runs.records[i] if self.watched else Untallied()
        if touching:
            run.contacts.open[:] = touching.open[i]
            run.contacts.waiting = list(touching.rows[i, : touching.found[i]])
        steps, rhs, jacobians, rejected, unsolved = map(int, runs.counts[i])
        counts = Counts(rhs, steps, jacobians, len(self.segments), rejected, unsolved, runs.orders[i].tolist())
        y, said = runs.y[i].copy(), str(Cause.DONE)
        run.last = last.index, last.length, y
        self.outcome = Outcome(
            Status.OK, Cause.DONE, said, counts, 0.0, last.index, last.length, y, self.tolerance, np.nan
        )
        run.contacts.tell(ProgressSink(run).log, end=(run.end_time(last.index, last.length), y))
        if self.tallied:
            for k, segment in enumerate(self.segments):
                at = slice(*runs.whole[runs.stretches[i] + k, 2:4])
                # A block of steps begins where the one before ends.
                blocks = np.flatnonzero(np.diff(output.times[at]) <= 0.0) + 1
                taken = (output.times, output.weights, output.q, output.q_rate)
                for parts_of_block in zip(*(np.split(part[at], blocks) for part in taken), strict=True):
                    self.tally.take_motion(segment, *parts_of_block)


class NotTallied(Exception):
    """A mean, a largest value or an extreme was asked for, and none were kept."""


class Untallied:
    """In place of a tally or of records where none were kept: all it has to say is NotTallied."""

    def __getattr__(self, name):
        raise NotTallied

    def __getitem__(self, key):
        raise NotTallied


def integrate(alike: list[LoopedRun]):
    """Integrate runs of one structure; those that end well get their outcome.  Raises KeyboardInterrupt within
    PATIENCE."""
    # Compiled and linked with the libraries as it is imported.
    from ..dynamics import batch_loop as loop
    from ..solvers.sundials_direct import cvode_for
    from ..solvers.sundials_libraries import words_for

    first = alike[0]
    runs, touching, output = _loop_arrays(alike, loop)
    told, y, absolute = np.zeros(2, dtype=np.int64), np.empty(runs.y.shape[1]), np.ones(runs.y.shape[1])
    words = words_for(first.segments[0], first.segments[0].native.rates)
    with cvode_for(y, absolute, words, first.method) as (memory, vector, tolerances):
        cvode = loop.Integrator(memory.value, vector.value, tolerances.value, y, absolute, words)
        given = cvode, runs, thinnest_value(first.run.model.face), touching, output, told
        _call_in_thread(loop.integrate_many, given, told)
    for i, one in enumerate(alike):
        if runs.status[i] == loop.DONE:
            one.ends(runs, i, touching, output)


def _call_in_thread(loop, given, told):
    """Call the loop where it does not keep Python from seeing a KeyboardInterrupt; told of one it stops, and only then
    is this left, since others own what it works on."""
    failures, ended = [], Event()

    def call():
        try:
            loop(*given)
        except Exception as error:
            failures.append(error)
        finally:
            ended.set()

    Thread(target=call).start()
    interrupted = False
    while not ended.is_set():
        try:
            ended.wait(PATIENCE)
        except KeyboardInterrupt:
            interrupted, told[0] = True, 1
    if interrupted:
        raise KeyboardInterrupt
    if failures:
        raise failures[0]


def _loop_arrays(alike, loop):
    """The runs as the loop takes them."""
    models, count = [one.run.model for one in alike], len(alike)
    stretches = np.cumsum([0, *(len(one.segments) for one in alike)])
    segments = [segment for one in alike for segment in one.segments]
    runs = loop.Runs(
        stretches,
        np.array([[s.native.data, s.index, 0, 0] for s in segments]),
        np.array([loop.numbers(segment) for segment in segments]),
        np.array([segment.swing for segment in segments]),
        np.array([one.tolerance for one in alike]),
        alike[0].watched,
        np.array([slack(model) for model in models]),
        np.array([watched_level(model) for model in models]),
        np.array([one.run.extrema.windows for one in alike], dtype=float),
        np.array([one.run.extrema.records for one in alike]),
        np.array([model.scales for model in models]),
        np.array([one.run.y0 for one in alike]),
        alike[0].segments[0].rate_places,
        np.full(count, loop.STOPPED),
        np.zeros((count, 5), dtype=np.int64),
        np.zeros((count, MOST_ORDERS), dtype=np.int64),
    )
    touching = output = None
    if models[0].contact is not None:
        touching = loop.Touching(
            models[0].unknowns.impulse,
            np.array([model.gap_error() for model in models]),
            np.array([one.run.contacts.open for one in alike]),
            np.empty((count, MOST_CONTACTS, ROW)),
            np.zeros(count, dtype=np.int64),
        )
    if alike[0].tallied:
        room = np.cumsum([0, *(one.room for one in alike)])
        q, q_rate = np.empty((2, room[-1], models[0].unknowns.n))
        output = loop.Output(room, np.empty(room[-1]), np.zeros(room[-1]), q, q_rate, alike[0].method in STIFF)
    return runs, touching, output
