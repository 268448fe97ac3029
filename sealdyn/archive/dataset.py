"""What an archive holds as an xarray Dataset: series over time, or the answer of a study over what it varies."""

from __future__ import annotations

import os
from typing import TYPE_CHECKING

import numpy as np

from .run import open_run
from .soundness import ArchiveError
from .study import is_study, number_columns, read_study

if TYPE_CHECKING:
    import xarray

# Lists of an answer that are no numbers where they are empty.
NO_NUMBERS = ("left_out", "verdict")


def open_archive(path: str | os.PathLike) -> xarray.Dataset:
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


def as_dataset(answer: dict) -> xarray.Dataset:
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
    variables = {}
    for name, values in columns_of(rows, outputs).items():
        unit = answer["output_units"].get(name, "")
        variables[name] = (list(answer["keys"]), values.reshape(shape), {"units": unit} if unit else {})
    attributes = {name: str(answer[name]) for name in ("study", "status", "message") if name in answer}
    return xarray.Dataset(variables, coordinates, attributes)


def tables_as_dataset(answer: dict, units: dict[str, str], along: dict[str, tuple[str, ...]]) -> xarray.Dataset:
    """Every list of numbers in the answer of a study as an `xarray.Dataset`: "curve/h_min" is the variable curve.h_min,
    and the column of a list of rows, "modes/frequency", lies along the dimension of its rows, modes.

    `units` {"curve/h_min": unit}; `along` {table: names of columns along which its others lie, in the order of their
    axes, its own columns or those of the answer itself}, which become dimensions with coordinates.  Axes that are not
    told have dimensions of their own.
    """
    import xarray

    answer, of_rows = _with_columns(answer)
    columns = {key: values for key, values in number_columns(answer) if key not in NO_NUMBERS}
    told = {}
    for table, names in along.items():
        pairs = [(f"{table}/{name}", name) for name in names]
        told[table] = [own if own in columns else above for own, above in pairs]
    axes = {key for keys in told.values() for key in keys if key in columns and columns[key].ndim == 1}
    variables = {}
    for key, values in columns.items():
        table, name, unit = key.rpartition("/")[0], key.replace("/", "."), units.get(key, "")
        dimensions = [name] if key in axes else [f"{name}.{axis}" for axis in range(values.ndim)]
        others = [*([table] if table in of_rows else []), *told.get(table, ())]
        for axis, other in enumerate(others[: values.ndim] if key not in axes else ()):
            fits = other in axes and values.shape[axis : axis + 1] == columns[other].shape
            own = axis == 0 and other == table and table in of_rows
            along_it = other.replace("/", ".")
            if (fits or own) and along_it not in dimensions:
                dimensions[axis] = along_it
        variables[name] = (dimensions, values, {"units": unit} if unit else {})
    attributes = {name: str(answer[name]) for name in ("study", "status", "message") if name in answer}
    return xarray.Dataset(variables, attrs=attributes)


def _with_columns(answer: dict) -> tuple[dict, set[str]]:
    """The answer with a table of columns for each list of rows, and the names of these."""
    lists = {key: held for key, held in answer.items() if isinstance(held, list) and held}
    rows = {key for key, held in lists.items() if all(isinstance(entry, dict) for entry in held)}
    columns = {}
    for key in rows:
        # A row that failed has other names.
        names = dict.fromkeys(name for row in answer[key] for name in row)
        columns[key] = {name: [row.get(name) for row in answer[key]] for name in names}
    return {**answer, **columns}, rows


def columns_of(rows: list[dict], outputs: list[str]) -> dict[str, np.ndarray]:
    """{name: (n,)} of the outputs, and `status` and `message`, of rows (n) of runs: numbers with NaN for what there is
    not, or words with none for it; a point that failed is "not possible", the message its reason."""
    columns = {output: _values([row.get(output) for row in rows]) for output in outputs}
    columns["status"] = _values([str(row.get("status", "not possible")) for row in rows])
    columns["message"] = _values([row.get("failed", row.get("message", "")) for row in rows])
    return columns


def _units(unit: str | None) -> dict:
    """Words have none."""
    return {} if unit is None else {"units": unit or "SI"}


def _values(column: list) -> np.ndarray:
    """Numbers (n,) with NaN for what there is not, or words with none for it."""
    if all(value is None or isinstance(value, int | float) for value in column):
        return np.array([np.nan if value is None else value for value in column], float)
    return np.array(["" if value is None else str(value) for value in column])
