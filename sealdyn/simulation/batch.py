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
from functools import partial
from itertools import product
from typing import TYPE_CHECKING, Any

from ..archive import as_dataset, columns_of
from ..numerics.parallel import AT_ONCE, Together, processes
from ..scenario.errors import ScenarioError
from ..scenario.overrides import without_arrays
from ..scenario.reader import Scenario
from ..scenario.settings import scenario_of, with_values
from ..scene.radial import RadialScene
from ..scene.scene import SceneError
from ..solvers.contract import Status
from .looped_run import LoopedRun, NotSampled, integrate
from .outputs import common, missing, output, unit_of, with_speeds
from .radial import prepare_radial
from .simulate import in_memory, prepare_run
from .summary import state_names

if TYPE_CHECKING:
    import pandas
    import xarray

# What is asked of a face seal, and of a radial one, unless told.
OUTPUTS = ("h_min.value", "relative_misalignment.max")
RADIAL_OUTPUTS = ("whole.largest_gap", "settled.contact_share")
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
    of the run's summary, of which those made of samples ("leakage.mean") cost most, none the least; `workers`
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
    outputs = _asked(scenario, outputs)
    outputs = [*dict.fromkeys([*outputs, *(f"end.state.{name}" for name in names)])]
    rows = rows_of(scenario, sets, outputs, workers, progress)
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
    outputs = _asked(scenario, outputs)
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
    rows = rows_of(scenario, sets, outputs, workers, progress)
    names = list(axes)
    index = pandas.Index([place[0] for place in places], name=names[0]) if len(axes) == 1 else None
    index = pandas.MultiIndex.from_tuples(places, names=names) if index is None else index
    table = pandas.DataFrame(columns_of(rows, outputs), index=index)
    table.attrs["units"] = {output: unit_of(output) for output in outputs if unit_of(output)}
    return table


def _is_radial(scenario) -> bool:
    return isinstance(scenario.scene, RadialScene)


def _asked(scenario, outputs) -> list[str]:
    """Outputs as a list; the usual ones of the kind of seal where none are told."""
    if outputs is None:
        return [*(RADIAL_OUTPUTS if _is_radial(scenario) else OUTPUTS)]
    return [outputs] if isinstance(outputs, str) else list(outputs)


def rows_of(scenario, sets: list[dict], outputs: list[str], workers, progress) -> list[dict]:
    """A row of each run, in their order: its outputs, `status`, and `message` or `failed` unless it ended well."""
    todo = {k: {"set": values, "outputs": outputs} for k, values in enumerate(sets)}
    rows = [None] * len(sets)
    with closing(processes(workers)(Together(partial(run_many, scenario)), todo, "runs")) as answers:
        for done, (k, row, _) in enumerate(answers):
            rows[k] = row
            if progress:
                progress(done + 1, len(sets))
    return rows


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
            return (prepare_radial if _is_radial(found) else prepare_run)(found)[0]
    raise first


def refuse_outputs(scenario, sets: list[dict], outputs, where: str) -> None:
    """Raises ScenarioError, which names `where`, for outputs that no summary of these runs has: found before any is
    run, by a moment of the first that can be one."""
    if set(outputs) <= {"status", "message", *common(scenario.scene)}:
        return
    for values in sets:
        try:
            parts = in_memory(with_values(scenario, {**values, "run.duration": MOMENT}), with_speeds(outputs))
        except (ScenarioError, SceneError):
            continue
        if wrong := missing(parts, outputs):
            raise ScenarioError(scenario.name, where, ", ".join(wrong), f"others: {'; '.join(wrong.values())}")
        return


def run_many(scenario, points: list[dict]) -> list:
    """Of each point {"set": {dotted key: value}, "outputs": dotted keys of the summary}: a row of its outputs, status,
    and message when the run did not end well; or the exception why it cannot be."""
    return [row for k in range(0, len(points), AT_ONCE) for row in _at_once(scenario, points[k : k + AT_ONCE])]


def _at_once(scenario, points) -> list:
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
            if run.outcome:
                row = _caught(_row, run.parts(), points[k])
                # What is made of samples after all, or is not there, is a matter for the whole summary.
                rows[k] = None if isinstance(row, NotSampled) else row
    return [row if row is not None else _caught(_alone, scenario, points[k]) for k, row in enumerate(rows)]


def _caught(function, *given):
    try:
        return function(*given)
    except Exception as error:
        return error


def _alone(scenario, point) -> dict:
    return _row(in_memory(with_values(scenario, point["set"]), with_speeds(point["outputs"])), point)


def _row(parts, point) -> dict:
    row = {key: output(parts, key) for key in ("status", *point["outputs"])}
    return row if row["status"] == Status.OK else {**row, "message": parts["message"]}
