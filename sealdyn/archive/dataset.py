"""What an archive holds as an xarray Dataset: series over time, or the answer of a study over what it varies."""

from __future__ import annotations

import os
from typing import TYPE_CHECKING

import numpy as np

from .run import open_run
from .study import is_study, read_study
from .tables import Variable, answer_variables, grid_variables, long_columns, tables, variables

if TYPE_CHECKING:
    import xarray


def open_archive(path: str | os.PathLike) -> xarray.Dataset:
    """The archive as an `xarray.Dataset`.

    Of a run, lazily loaded: series over `time` with units, fields over `field_time` and their grid; `attrs` hold the
    scenario text, status, message, and `resolved` and `summary` as JSON.
    Of a study what `sealdyn.study(...).data` is: its numbers along the keys that it went through, or along what its
    study names; `attrs` hold the scenario text too.  Raises ArchiveError.

    >>> with sealdyn.open_archive(sealdyn.run("fms.toml", out="fms.h5").archive) as data:
    ...     print(data.h_min.dims, data.h_min.units, data.attrs["status"])
    ('time',) m ok
    """
    if not is_study(path):
        return open_run(path)
    study = read_study(path)
    data = answer_as_dataset(study["answer"], study["units"], study["along"])
    return data.assign_attrs({name: study[name] for name in ("name", "version", "scenario")})


def answer_as_dataset(answer: dict, units: dict, along: dict) -> xarray.Dataset:
    """The answer of any study as an `xarray.Dataset`: `as_dataset` over a grid of keys, else `tables_as_dataset`."""
    return _dataset(answer, answer_variables(answer, units, along))


def answer_tables(study: dict) -> dict[str, dict[str, np.ndarray]]:
    """Every table of what `read_study` returns, {table: {"h_min [m]": column}}, columns of equal length (tables.py)."""
    found = answer_variables(study["answer"], study["units"], study["along"])
    named = tables(found, study["study"].replace("_", "-"))
    return {name: long_columns(members, found, name) for name, members in named.items()}


def as_dataset(answer: dict) -> xarray.Dataset:
    """The answer of a sweep as an `xarray.Dataset`.

    Dimensions are the keys that were varied, in their order, coordinates their values as they were given; variables are
    the outputs, `status` and `message` of each run.  `units` are attributes.  Where a point failed numbers are NaN,
    words empty, the status is "not possible" and the message its reason.
    """
    return _dataset(answer, grid_variables(answer))


def tables_as_dataset(answer: dict, units: dict, along: dict) -> xarray.Dataset:
    """Every list in the answer of a study as an `xarray.Dataset`: "curve/h_min" is the variable curve.h_min, and the
    column of a list of rows, "modes/frequency", lies along the dimension of its rows, modes.  `units` and `along` as in
    `tables.variables`; what others lie along is a coordinate.
    """
    return _dataset(answer, variables(answer, units, along))


def _dataset(answer: dict, found: list[Variable]) -> xarray.Dataset:
    import xarray

    held = {v.name: (v.dimensions, v.values, {"units": v.units} if v.units else {}) for v in found}
    attributes = {name: str(answer[name]) for name in ("study", "status", "message") if name in answer}
    return xarray.Dataset(held, attrs=attributes).set_coords([v.name for v in found if v.coordinate])
