"""Many runs of one scenario with other values: one compiled loop, Python only before and after it.

What CVODE integrates, without friction that sticks, goes through the loop (dynamics/batch_loop.py); all others, and
runs that do not end well, go one by one.  The loop has no trial and follows no errors: its runs have the cautious
tolerance of solvers/contract.py, and their numbers are those of single runs within the asked accuracy.
"""

from collections.abc import Iterable
from contextlib import closing
from functools import partial

from ..archive import as_dataset
from ..numerics.parallel import AT_ONCE, Together, processes
from ..scenario.errors import ScenarioError
from ..scenario.settings import with_values
from ..solvers.contract import Status
from .looped_run import LoopedRun, NotSampled, integrate
from .outputs import output, unit_of, with_speeds
from .simulate import in_memory, prepare_run
from .summary import state_names

OUTPUTS = ("h_min.value", "relative_misalignment.max")


def simulate_many(
    scenario, sets: Iterable[dict], outputs: Iterable[str] = OUTPUTS, *, workers: int | None = None, progress=None
):
    """Many runs of a scenario in memory, as an `xarray.Dataset` over the dimension `run`.

    `sets`: of each run {dotted key: value}, values as for `with_values` (scenario/settings.py); `outputs`: dotted keys
    of the run's summary, of which those made of samples ("leakage.mean") cost most, none the least; `workers`
    processes (None: all cores); `progress(done, all)`.  Variables are the outputs, the end state (end.state.*, SI),
    `status` and `message`; a run that cannot be has the status "not possible" and its reason as message.
    **Valid** runs with the same unknowns.
    Raises ScenarioError if no run can be read, SceneError if the first that can be read cannot be run.
    """
    sets = [dict(values) for values in sets]
    names = state_names(first_ready(scenario, sets).model.unknowns)
    outputs = [*dict.fromkeys([*outputs, *(f"end.state.{name}" for name in names)])]
    todo = {k: {"set": values, "outputs": outputs} for k, values in enumerate(sets)}
    rows = [None] * len(sets)
    with closing(processes(workers)(Together(partial(run_many, scenario)), todo, "runs")) as answers:
        for done, (k, row, _) in enumerate(answers):
            rows[k] = row
            if progress:
                progress(done + 1, len(sets))
    units = {name: unit_of(name) for name in outputs}
    axis = {"key": "run", "values": range(len(sets)), "unit": None}
    return as_dataset({"keys": ["run"], "axes": [axis], "rows": rows, "outputs": outputs, "output_units": units})


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


def run_many(scenario, points: list[dict]) -> list:
    """Of each point {"set": {dotted key: value}, "outputs": dotted keys of the summary}: a row of its outputs, status,
    and message when the run did not end well; or the exception why it cannot be."""
    return [row for k in range(0, len(points), AT_ONCE) for row in _at_once(scenario, points[k : k + AT_ONCE])]


def _at_once(scenario, points) -> list:
    rows, alike = [None] * len(points), {}
    for k, point in enumerate(points):
        try:
            run = LoopedRun(with_values(scenario, point["set"]), point["outputs"])
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
    row = {"status": parts["status"], **{key: output(parts, key) for key in point["outputs"]}}
    return row if row["status"] == Status.OK else {**row, "message": parts["message"]}
