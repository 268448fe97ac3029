"""What an archive holds as an xarray Dataset: series over time, or the answer of a study over what it varies."""

import numpy as np

from .run import open_run
from .soundness import ArchiveError
from .study import is_study, read_study


def open_archive(path):
    """The archive as an `xarray.Dataset`.

    Of a run, lazily loaded: series over `time` with units, fields over `field_time` and their grid; `attrs` hold the
    scenario text, status, message, and `resolved` and `summary` as JSON.
    Of a study over a grid of keys: `as_dataset`; `attrs` hold the scenario text too.  Raises ArchiveError, also for
    studies whose answers are no grid (`read_study` reads those).
    """
    if not is_study(path):
        return open_run(path)
    study = read_study(path)
    if not {"axes", "rows", "outputs"} <= set(study["answer"]):
        raise ArchiveError(f"{path}: the answer of {study['study']} is no grid of rows: read_study reads it")
    return as_dataset(study["answer"]).assign_attrs({name: study[name] for name in ("name", "version", "scenario")})


def as_dataset(answer: dict):
    """The answer of a sweep as an `xarray.Dataset`.

    Dimensions are the keys that were varied, in their order, coordinates their values as they were given; variables are
    the outputs, `status` and `message` of each run.  `units` are attributes.  Where a point failed numbers are NaN,
    words empty, the status is "not possible" and the message its reason.
    """
    import xarray

    axes, rows = answer["axes"], answer["rows"]
    shape = tuple(len(axis["values"]) for axis in axes)
    coordinates = {axis["key"]: (axis["key"], axis["values"], _units(axis["unit"])) for axis in axes}
    # A key that is varied and asked for is the coordinate already.
    outputs = [output for output in answer["outputs"] if output not in coordinates]
    columns = {output: [row.get(output) for row in rows] for output in outputs}
    columns["status"] = [str(row.get("status", "not possible")) for row in rows]
    columns["message"] = [row.get("failed", row.get("message", "")) for row in rows]
    variables = {}
    for name, column in columns.items():
        values = _values(column).reshape(shape)
        unit = answer["output_units"].get(name, "")
        variables[name] = (list(answer["keys"]), values, {"units": unit} if unit else {})
    attributes = {name: str(answer[name]) for name in ("study", "status", "message") if name in answer}
    return xarray.Dataset(variables, coordinates, attributes)


def _units(unit: str | None) -> dict:
    """Words have none."""
    return {} if unit is None else {"units": unit or "SI"}


def _values(column: list) -> np.ndarray:
    """Numbers (n,) with NaN for what there is not, or words with none for it."""
    if all(value is None or isinstance(value, int | float) for value in column):
        return np.array([np.nan if value is None else value for value in column], float)
    return np.array(["" if value is None else str(value) for value in column])
