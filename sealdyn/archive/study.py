"""The answer of a study in one netCDF-4 file, the scenario inside: plain `xarray.open_dataset` reads its columns."""

from __future__ import annotations

import json
import os
from datetime import UTC, datetime
from pathlib import Path
from typing import TYPE_CHECKING

import h5py
import numpy as np

from ..quantities import QUANTITIES
from .files import (
    DATASET,
    FILE,
    READING_ERRORS,
    ArchiveError,
    hdf5_in_place_of,
    is_named,
    mark_sound,
    must_be_readable,
    must_be_sound,
    must_be_whole,
    root_attributes,
    seal,
)
from .run import open_run, utf8_text
from .tables import Variable, answer_variables, grid_variables, long_columns, tables

if TYPE_CHECKING:
    import xarray

FORMAT = "sealdyn study 2"
# How netCDF-4 calls a dimension without values, in the attribute NAME of its scale.
NO_VALUES = "This is a netCDF dimension but not a netCDF variable.%10d"


def write_study(
    path: str | os.PathLike,
    scenario_text: str,
    resolved: dict,
    meta: dict,
    answer: dict,
    units: dict,
    along=(),
    panels=(),
) -> Path:
    """Write the answer of a study as netCDF-4: each of its columns (`tables.answer_variables`, to which `units` and
    `along` belong) a dataset of the root group with its dimensions, coordinates, units and long name.  The scenario's
    text, `resolved`, `meta`, `units` and `along` become root attributes; the answer to the bit and the `panels` (plain
    data, from which the archive draws itself) stand as JSON in the group `json`.
    Replaces an existing file only when complete; returns its path."""
    path = Path(path)
    path.parent.mkdir(parents=True, exist_ok=True)
    found = list({v.name: v for v in answer_variables(answer, units, dict(along))}.values())
    texts = {"answer": json.dumps(answer), "panels": json.dumps(list(panels or ()))}
    attributes = {
        "format": FORMAT,
        "program": "sealdyn",
        "created": datetime.now(UTC).isoformat(timespec="seconds"),
        **meta,
        "scenario": scenario_text,
        "resolved": resolved,
        "units": units,
        "along": dict(along),
    }
    # What stands along the dimension of another name is a coordinate only where the file says so.
    coordinates = [v.name for v in found if v.coordinate and v.dimensions != (v.name,)]
    attributes |= {"coordinates": " ".join(coordinates)} if coordinates else {}
    words = sum(map(len, texts.values())) + sum(len(_attribute(value)) for value in attributes.values())
    size = words + sum(v.values.nbytes + 16 * v.values.size for v in found)
    objects = sum(1 + v.values.ndim for v in found)
    with hdf5_in_place_of(path, 4 * size + FILE + DATASET * objects) as file:
        for name, value in attributes.items():
            file.attrs[name] = value if isinstance(value, int | float) else _attribute(value)
        for name, text in texts.items():
            file.create_dataset(f"json/{name}", data=text, dtype=h5py.string_dtype())
        _write_variables(file, found)
        seal(file)
    mark_sound(path)
    return path


def _attribute(value) -> str:
    return utf8_text(value) if isinstance(value, str) else json.dumps(value)


def _write_variables(file, found: list[Variable]) -> None:
    """The variables as datasets of an open file, those without values that are dimensions only, too."""
    for variable in found:
        _write_variable(file, variable)
    for variable in found:
        if variable.dimensions == (variable.name,):
            file[variable.name].make_scale(variable.name)
    for variable in found:
        if variable.dimensions != (variable.name,):
            for axis, dimension in enumerate(variable.dimensions):
                scale = _scale(file, dimension, variable.values.shape[axis], f"{variable.name}.{axis}")
                file[variable.name].dims[axis].attach_scale(scale)


def _write_variable(file, variable: Variable) -> None:
    values, attributes = variable.values, {"long_name": _long_name(variable.name)}
    if variable.units:
        attributes["units"] = variable.units
    if values.dtype.kind == "b":
        # NetCDF has no truths; xarray reads them again from numbers of this attribute.
        values, attributes["dtype"] = values.astype("i1"), "bool"
    if values.dtype.kind == "U":
        words = np.array([utf8_text(word) for word in values.ravel().tolist()], object).reshape(values.shape)
        item = file.create_dataset(variable.name, data=words, dtype=h5py.string_dtype())
    else:
        item = file.create_dataset(variable.name, data=values)
    for name, value in attributes.items():
        item.attrs[name] = value


def _long_name(name: str) -> str:
    """Of a column "curve.h_min": the quantity's, else its own name in words."""
    last = name.rpartition(".")[2]
    known = QUANTITIES[last].name if last in QUANTITIES else ""
    return known or name.replace(".", " ").replace("_", " ")


def _scale(file, name: str, length: int, otherwise: str):
    """The scale of a dimension, made where there is none; of one that is no dimension of this `length` another name."""
    for known in (name, otherwise):
        if known not in file:
            scale = file.create_dataset(known, (length,), "f4")
            scale.make_scale(NO_VALUES % length)
            return scale
        if file[known].is_scale and file[known].shape == (length,):
            return file[known]
    raise ValueError(f"{name} is no dimension of {length}")


def is_study(path: str | os.PathLike) -> bool:
    """Whether there is the file of a study at `path`, of this format or another."""
    try:
        must_be_sound(path)
        with h5py.File(path, "r") as file:
            return is_named(str(file.attrs.get("format")), FORMAT)
    except (ArchiveError, OSError, RuntimeError):
        return False


def read_study(path: str | os.PathLike) -> dict:
    """Everything of a study's file: `answer`, `panels`, `scenario`, `resolved`, and the other root attributes (JSON
    ones decoded).  Raises ArchiveError."""
    path = Path(path)
    if not path.is_file():
        raise ArchiveError(f"{path}: no such file")
    try:
        must_be_sound(path)
        with h5py.File(path, "r") as file:
            must_be_readable(file, path, FORMAT, "a sealdyn study")
            must_be_whole(file, path)
            info = root_attributes(file)
            for name in ("answer", "panels"):
                info[name] = json.loads(file[f"json/{name}"].asstr()[()])
            if not isinstance(info["answer"], dict) or not all(isinstance(info[n], str) for n in ("study", "scenario")):
                raise TypeError("its answer is no table, or its scenario no text")
            if not all(isinstance(info[name], dict) for name in ("units", "along")):
                raise TypeError("its units or dimensions are no table")
            return {**info, "written": info["answer"].get("written", {})}
    except READING_ERRORS as error:
        words = " ".join(str(error).split())[:200]
        raise ArchiveError(f"{path}: damaged ({words or type(error).__name__})") from error


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
    """The answer of any study as an `xarray.Dataset`: `as_dataset` over a grid of keys; else every list in it,
    "curve/h_min" as the variable curve.h_min, and the column of a list of rows, "modes/frequency", along the dimension
    of its rows, modes.  `units` and `along` as in `tables.variables`; what others lie along is a coordinate."""
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


def _dataset(answer: dict, found: list[Variable]) -> xarray.Dataset:
    import xarray

    held = {v.name: (v.dimensions, v.values, {"units": v.units} if v.units else {}) for v in found}
    attributes = {name: str(answer[name]) for name in ("study", "status", "message") if name in answer}
    return xarray.Dataset(held, attrs=attributes).set_coords([v.name for v in found if v.coordinate])
