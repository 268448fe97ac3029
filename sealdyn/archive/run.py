"""The one HDF5 file of a run: how quantities are laid out over time and over a grid, and reading of everything but the
series, of one series, one field, or of all as an xarray Dataset.

A file that is still written, or was left by a killed run, holds rows up to its newest whole record (run_writer.py).
"""

import json
import os
import zlib
from contextlib import contextmanager
from functools import cached_property
from pathlib import Path
from typing import NamedTuple

import h5py
import numpy as np
from h5py import h5a, h5d, h5ds, h5p, h5s, h5t

from ..status import Status
from .files import (
    READING_ERRORS,
    ArchiveError,
    file_identity,
    held_in_words,
    must_be_readable,
    must_be_sound,
    must_be_whole,
    partial_path,
    root_attributes,
)

TEXT_TYPE = h5py.string_dtype()
TEXT = h5t.py_create(TEXT_TYPE, logical=True)
ONE = h5s.create(h5s.SCALAR)
# The dimension of the instants at which fields are kept.
FIELD_TIME = "field_time"
# Rows of a series in one chunk: HDF5 takes 4 GiB.
MOST_IN_PLACE = 1 << 28


class Series(NamedTuple):
    """What a stranger must know of a column; `display_unit`, when given, is what people read it in, `display_factor`
    how many of it make one of `units`."""

    units: str
    long_name: str
    display_unit: str = ""
    display_factor: float = 1.0


class Fields(NamedTuple):
    """Fields of one grid, kept at `most` instants at most: `series` maps a field's name to its `Series`, `grid` that of
    a coordinate to its `Series` and values (m,), in the order of the fields' dimensions."""

    series: dict[str, Series]
    grid: dict[str, tuple[Series, np.ndarray]]
    most: int

    @property
    def shape(self) -> tuple[int, ...]:
        """Of one field at one instant."""
        return tuple(len(values) for _, values in self.grid.values())

    def over_time(self) -> dict[str, Series]:
        """All that grows with the instants: their times (s), and the fields."""
        return {FIELD_TIME: Series("s", "time of the fields", "ms", 1e3), **self.series}

    def checked(self, given: dict, kept: int) -> dict[str, np.ndarray]:
        """Fields as they are written; raises ValueError if they are others, or too many after `kept` instants."""
        arrays = {name: np.array(given[name], "<f8") for name in self.over_time()}
        count = len(arrays[FIELD_TIME])
        for name, values in arrays.items():
            if values.shape != (count, *(() if name == FIELD_TIME else self.shape)):
                raise ValueError(f"{name} has the shape {values.shape}, not that of {count} instants")
        if kept + count > self.most:
            raise ValueError(f"fields at {kept + count} instants, more than {self.most}")
        return arrays if count else {}

    def are_those_of(self, file) -> bool:
        """Whether an archive holds the same fields on the same grid."""
        return set(*names_over(file, FIELD_TIME)) == set(self.over_time()) and all(
            name in file and np.array_equal(file[name][()], values) for name, (_, values) in self.grid.items()
        )


def scale_of(file, name: str) -> str | None:
    """Name of the dimension scale along a dataset's first dimension, its own if it is one; None: there is no dataset of
    this name."""
    item = file.get(name)
    # Groups (events, what a run goes on from) have no dimensions.
    if not hasattr(item, "dims"):
        return None
    return (item.name if item.is_scale else item.dims[0][0].name).removeprefix("/")


def names_over(file, *scales: str) -> list[list[str]]:
    """For each of the `scales` the names of the datasets whose first dimension it is, the scale among them."""
    found = {name: scale_of(file, name) for name in file}
    return [[name for name, scale in found.items() if scale == wanted] for wanted in scales]


def reserve(file, name: str, series: Series, shape: tuple[int, ...], early: bool):
    """A dataset with room for `shape`, NaN until written, which stays where it is in the file: a single chunk, so that
    it can be shortened there, or in one piece where HDF5 has no chunk so large.  It has its place at once if `early`,
    else with its first values."""
    plan, most = h5p.create(h5p.DATASET_CREATE), None
    if shape[0] <= MOST_IN_PLACE:
        plan.set_chunk(tuple(max(length, 1) for length in shape))
        most = h5s.UNLIMITED, *shape[1:]
    plan.set_alloc_time(h5d.ALLOC_TIME_EARLY if early else h5d.ALLOC_TIME_LATE)
    plan.set_fill_value(np.array(np.nan))
    space = h5s.create_simple(shape, most)
    describe(h5d.create(file.id, name.encode(), h5t.IEEE_F64LE, space, plan), series._asdict())


def describe(item, attributes: dict):
    """Attributes (words, whole and other numbers) of an object of HDF5 (its low-level identifier: three times faster),
    in place of those that it has."""
    for name, value in attributes.items():
        if h5a.exists(item, name.encode()):
            h5a.delete(item, name.encode())
        data = np.array(utf8_text(value), TEXT_TYPE) if isinstance(value, str) else np.array(value)
        kind = TEXT if isinstance(value, str) else h5t.py_create(data.dtype)
        h5a.create(item, name.encode(), kind, ONE).write(data)


def utf8_text(text: str) -> str:
    """A text as HDF5 takes it: of a name that is no UTF-8 the odd bytes are spelt out."""
    return text.encode("utf-8", "backslashreplace").decode()


def attach_scale(file, scale: str, names, dimension: int = 0):
    """Make `scale` this dimension of all these datasets, by default the first."""
    along = h5d.open(file.id, scale.encode())
    h5ds.set_scale(along, scale.encode())
    for name in names:
        if name != scale:
            h5ds.attach_scale(h5d.open(file.id, name.encode()), along, dimension)


def create_fields(file, fields: Fields, instants: int, early: bool) -> None:
    """Room for so many instants of the fields (`early` as in `reserve`), their grid beside them as dimension scales."""
    for name, (series, values) in fields.grid.items():
        item = file.create_dataset(name, data=np.asarray(values, "<f8"))
        describe(item.id, series._asdict())
    for name, series in fields.over_time().items():
        reserve(file, name, series, (instants, *(() if name == FIELD_TIME else fields.shape)), early)
    for dimension, scale in enumerate((FIELD_TIME, *fields.grid)):
        attach_scale(file, scale, fields.series, dimension)


FORMAT = "sealdyn archive 2"
# Archives whose words and layout were looked at, as they were then: a figure reads one series after another.
_looked_at: set[tuple] = set()
STATUSES = (Status.OK, Status.INACCURATE, Status.COLLAPSED, Status.FAILED, Status.INTERRUPTED)


def to_json(value) -> str:
    """JSON of numbers, words, tables and arrays, which `from_json` gives back."""

    def plain(item):
        if isinstance(item, np.ndarray):
            return {"array": item.tolist()}
        if isinstance(item, np.generic):
            return item.item()
        return str(item)

    return json.dumps(value, default=plain)


def from_json(text: str | bytes):
    """What `to_json` was given."""
    return json.loads(text, object_hook=lambda d: np.array(d["array"]) if set(d) == {"array"} else d)


@contextmanager
def opened_run(path: str | os.PathLike):
    """The file at `path` (or the run that is still to become it) and its newest whole record."""
    with _open_file(Path(path)) as file:
        must_be_readable(file, path, FORMAT, "a sealdyn archive")
        try:
            # Of the file that is open: a run that ends meanwhile gives it another name.
            record, identity = _read_record(file), file_identity(file.id.get_vfd_handle())
            if identity not in _looked_at:
                must_be_whole(file, path)
                _check(file, record)
                _looked_at.add(identity)
            yield file, record
        except READING_ERRORS as error:
            words = " ".join(str(error).split())[:200]
            raise ArchiveError(f"{path}: damaged ({words or type(error).__name__})") from error


def _check(file, record: dict) -> None:
    """Raises ValueError for a record or series that no archive has, TypeError for words that are none."""
    room = {"rows": file["time"].shape[0], "instants": file[FIELD_TIME].shape[0] if FIELD_TIME in file else 0}
    for name, most in room.items():
        if not 0 <= record[name] <= most:
            raise ValueError(f"{record[name]} {name} where there is room for {most}")
    for name in names_over(file, "time")[0]:
        if file[name].shape != file["time"].shape or file[name].dtype.kind != "f":
            raise ValueError(f"{name} is no series of numbers over time")
    for name in ("status", "message", "scenario"):
        if not isinstance(file.attrs[name], str):
            raise TypeError(f"{name} is no text")
    if file.attrs["status"] not in (*STATUSES, Status.RUNNING):
        raise ValueError(f"status {file.attrs['status'][:40]}")
    if not isinstance(record["state"], dict):
        raise TypeError("what it goes on from is no table")


def _read_record(file) -> dict:
    if "record" not in file["restart"]:
        state = from_json(file["restart"].attrs["state"])
        rows, instants = int(file.attrs["rows"]), int(file.attrs["instants"])
        return {"rows": rows, "instants": instants, "state": state}
    return _newest_record(file["restart/record"][()])


def _open_file(path: Path):
    for candidate in (path, partial_path(path), path):
        # A run may finish between two looks: then what was partial has its final name.
        if candidate.is_file():
            try:
                must_be_sound(candidate)
                return h5py.File(candidate, "r")
            except FileNotFoundError:
                continue
            except OSError as error:
                damaged = "truncated or damaged" if h5py.is_hdf5(candidate) else "not an HDF5 file"
                what = held_in_words(error) or damaged
                raise ArchiveError(f"{candidate}: {what}") from error
    raise ArchiveError(f"{path}: {'not a file' if path.exists() else 'no such file'}")


def _newest_record(slots) -> dict:
    whole = []
    for slot in slots:
        check, _, text = slot.tobytes().split(b"\n", 1)[0].partition(b" ")
        if check == b"%08x" % zlib.crc32(text):
            whole.append(from_json(text))
    if not whole:
        raise ValueError("no whole record of its rows")
    return max(whole, key=lambda record: record["sequence"])


def read_log(log: bytes) -> list[dict]:
    return [from_json(line) for line in log.splitlines()]


def events_of(file, record: dict) -> list[dict]:
    """Events up to a record: a running run has them in its log."""
    if "log" in record:
        return read_log(file["restart/log"][: record["log"]].tobytes())
    return _read_events(file["events"])


def _read_events(group) -> list[dict]:
    if "time" not in group:
        return []
    columns = {k: group[k].asstr()[()] if k in ("kind", "text", "details") else group[k][()] for k in group}
    details = columns.pop("details")
    rows = zip(*(columns[k].tolist() for k in columns), strict=True)
    return [dict(zip(columns, row, strict=True)) | json.loads(d) for row, d in zip(rows, details, strict=True)]


def read_info(path: str | os.PathLike) -> dict:
    """Everything but the series and fields: status, message, summary, scenario, resolved, rows, instants, restart,
    events, series and fields (name -> `Series`), grid (dimension of the fields -> length) and the other root
    attributes.  Works while the run is written."""
    with opened_run(path) as (file, record):
        info = {"summary": {}, **root_attributes(file)}
        over_time, over_instants = names_over(file, "time", FIELD_TIME)
        info["series"] = {name: _series(file[name].attrs) for name in over_time}
        names = [name for name in over_instants if name != FIELD_TIME]
        info["fields"] = {name: _series(file[name].attrs) for name in names}
        info["grid"] = {d[0].name[1:]: d[0].size for name in names[:1] for d in file[name].dims}
        if names:
            # What lies beyond is room, not data.
            info["grid"][FIELD_TIME] = record["instants"]
        counts = {name: record[name] for name in ("rows", "instants")}
        return info | counts | {"restart": record["state"], "events": events_of(file, record)}


def _series(attributes) -> Series:
    return Series(*(attributes[name] for name in Series._fields))


def last_state(path: str | os.PathLike) -> dict:
    """What a continued run starts from: the state given with the last row that counts.  Raises `ArchiveError`."""
    with opened_run(path) as (_, record):
        return record["state"]


def column(path: str | os.PathLike, name: str, rows: slice = slice(None)) -> np.ndarray:
    """One series (rows,), float64, SI, or a slice of it, without loading the rest.  Raises `ArchiveError`."""
    with opened_run(path) as (file, record):
        if scale_of(file, name) != "time":
            raise ArchiveError(f"{path}: has no series {name!r}")
        return file[name][slice(*rows.indices(record["rows"]))]


def field(path: str | os.PathLike, name: str) -> np.ndarray:
    """One field (instants, ...), the `field_time` of its instants (instants,) or a coordinate of its grid; SI."""
    with opened_run(path) as (file, record):
        scale = scale_of(file, name)
        if scale in (None, "time"):
            raise ArchiveError(f"{path}: has no field {name!r}")
        return file[name][: record["instants"]] if scale == FIELD_TIME else file[name][()]


def open_run(path: str | os.PathLike):
    """The archive as a lazily loaded `xarray.Dataset`: series over `time` with units, fields over `field_time` and
    their grid; `attrs` hold the scenario text, status, message, and `resolved` and `summary` as JSON."""
    import xarray
    from xarray.backends import CachingFileManager, H5NetCDFStore

    with opened_run(path) as (file, record):
        name = file.filename
    if not os.path.exists(name):
        # The run has ended meanwhile, and its file has another name.
        return open_run(path)
    try:
        store = H5NetCDFStore(CachingFileManager(_of_known_lengths, name, mode="r"), mode="r")
        dataset = xarray.open_dataset(store, decode_times=False)
    except READING_ERRORS as error:
        raise ArchiveError(f"{path}: damaged ({' '.join(str(error).split())[:200]})") from error
    counts = {"time": record["rows"], FIELD_TIME: record["instants"]}
    dataset = dataset.isel({name: slice(0, count) for name, count in counts.items() if name in dataset.dims})
    return dataset.assign_attrs(rows=record["rows"])


def _of_known_lengths(name: str, mode: str):
    """The file by h5netcdf, which looks through all series for the length of a dimension that can grow whenever it is
    asked for it, some hundred times as a file is opened: here once."""
    import h5netcdf
    from h5netcdf.dimensions import Dimension

    class Known(Dimension):
        size = cached_property(Dimension.size.fget)

    file = h5netcdf.File(name, mode, decode_vlen_strings=True)
    for dimension in file.dimensions.values():
        dimension.__class__ = Known
    return file
