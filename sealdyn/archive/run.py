"""One HDF5 file per run: scenario, provenance, named series with units, fields, events, and the state to go on from.

How a run survives being killed.  HDF5 cannot be interrupted while it rearranges its own bookkeeping, so
it never does that in a file anybody reads: the skeleton is written once beside the run with room to spare
and renamed into place; rows then go straight to the places HDF5 has reserved for them; a record of how
many rows count (two slots in turn, each with a checksum) goes last.  Whatever instant the run ends at, the
file opens and one record is whole.  When the room is used up, or the run is done, the file is written anew
and renamed again.  A run that is done before its rows have waited long enough is written once.  Readers need
no lock and no luck.
"""

import json
import os
import shutil
import time as clock
import zlib
from contextlib import contextmanager
from datetime import UTC, datetime
from pathlib import Path

import h5py
import numpy as np

from ..status import Status
from .fields import (
    FIELD_TIME,
    MOST_IN_PLACE,
    Fields,
    Series,
    attach_scale,
    create_fields,
    describe,
    names_over,
    reserve,
    scale_of,
)
from .made_as import must_be_readable
from .seal import is_whole, seal
from .soundness import ArchiveError, begin_writing, end_writing, is_sound, must_be_sound
from .space import DATASET, FILE, hdf5_with_room

# Archives of the first format have no fields.
FORMAT, OLDER = "sealdyn archive 2", ("sealdyn archive 1",)
STATUSES = (Status.OK, Status.INACCURATE, Status.COLLAPSED, Status.FAILED, Status.INTERRUPTED)
SMALLEST_ROOM, LARGEST_FIRST_ROOM, BLOCK = 4096, 1 << 20, 1 << 16
SLOT, LOG = 1 << 14, 1 << 14
# Of its room a finished archive fills at least this.
SHARE = 0.9
# What reading a file that this program did not write, or somebody has changed, may raise.
ODD = (KeyError, OSError, ValueError, TypeError, AttributeError, IndexError, RuntimeError, ArithmeticError, EOFError)


def followed(path) -> Path:
    """Where an archive really is: of a symlink its target."""
    path = Path(path)
    return Path(os.path.realpath(path)) if path.is_symlink() else path


def partial_path(path) -> Path:
    """Where a run that is to become `path` lives until it is complete."""
    path = followed(path)
    return path.with_name(path.stem + ".partial.h5")


class ArchiveWriter:
    """Writes one run, row by row, in bounded memory.

    `series` maps a column's name to its `Series`; `time` (s) is added when missing.  `fields`: what is kept over
    a grid at a few of the rows.  `meta` becomes root attributes.  `expected_rows` spares copying: room for so
    many rows is reserved at once.  Rows wait in memory for at most `interval` seconds or `buffer_rows` rows; before,
    there is no file.
    With `resume`, goes on from `<stem>.partial.h5`, or from a `path` that was interrupted: `rows`, `state` say
    from where; without either it starts anew.  Raises `ArchiveError` when the series or fields differ from those
    of the file resumed.
    """

    def __init__(
        self,
        path,
        *,
        scenario_text: str,
        resolved: dict,
        meta: dict,
        series: dict[str, Series],
        fields: Fields | None = None,
        resume: bool = False,
        expected_rows: int = 0,
        interval: float = 0.3,
        buffer_rows: int = BLOCK,
    ):
        self.path, self.partial = Path(path), partial_path(path)
        self.rows, self.instants, self.state = 0, 0, {}
        self._series = {"time": Series("s", "time", "ms", 1e3), **series}
        self._fields = fields
        self._attributes = {
            "title": self.path.stem,
            "program": "sealdyn",
            "created": datetime.now(UTC).isoformat(timespec="seconds"),
            **meta,
            "scenario": scenario_text,
            "resolved": resolved,
        }
        self._interval, self._buffer_rows = interval, buffer_rows
        self._waiting, self._state, self._log, self._sequence = [], {}, b"", 0
        self._room, self._slot, self._log_room, self._file, self._ended = 0, SLOT, LOG, None, False
        self.path.parent.mkdir(parents=True, exist_ok=True)
        self._first_room = min(expected_rows + 1, LARGEST_FIRST_ROOM) if expected_rows else SMALLEST_ROOM
        self._written = clock.monotonic()
        source = self._resumable() if resume else None
        if source:
            self._take_over(source)
            self._reserve(source, self._first_room)
        else:
            # What an earlier run has left here is not this one's.
            self.partial.unlink(missing_ok=True)

    def append(self, columns: dict, state: dict | None = None, fields: dict | None = None) -> None:
        """Adds rows: one array of equal length for every series.  `state` (numbers, strings, arrays) is
        what a continued run starts from after these rows; the last one given is kept.  `fields`: arrays (instants, ...)
        at some of these rows' times, which stand in `field_time`."""
        if set(columns) != set(self._series):
            raise ValueError(f"columns differ from the series: {sorted(set(columns) ^ set(self._series))}")
        columns = {name: np.array(columns[name], "<f8", ndmin=1) for name in self._series}
        lengths = {len(values) for values in columns.values()}
        if len(lengths) != 1:
            raise ValueError(f"columns of unequal length: {sorted(lengths)}")
        fields = self._fields.checked(fields, self._appended()[1]) if fields else {}
        # Rows know their place, so that a flush broken off by Ctrl-C can simply be done again.
        self._waiting.append((self._appended(), columns, fields, self.state if state is None else state))
        self.state = self._waiting[-1][-1]
        late = clock.monotonic() - self._written >= self._interval
        if late or self._appended()[0] - self.rows >= self._buffer_rows:
            self.flush()

    def events(self, events: list[dict]) -> None:
        """Adds events: dicts with kind, time (s), value, text; other keys are kept as JSON."""
        self._log += b"".join(_to_json(event).encode() + b"\n" for event in events)

    def flush(self) -> None:
        """Hands everything waiting to the operating system; after it, a kill loses nothing.

        Raises OSError where the disk takes no more: what was written before stays, and the writer has ended.
        """
        with self._or_left():
            self._flush()

    def _flush(self) -> None:
        (rows, instants), state, log = self._appended(), self.state, self._log
        record = self._record(rows, instants, state, log)
        full = rows > self._room or len(record) > self._slot or len(log) > self._log_room
        if full or not self._file:
            self._slot = max(self._slot, 2 * len(record))
            self._log_room = max(self._log_room, 2 * len(log))
            self._reserve(self.partial, max(rows, self._first_room))
            record = self._record(rows, instants, state, log)
        for name, first, values in self._pieces():
            self._write(self._place[name] + first * values.strides[0], values.tobytes())
        self._write(self._place["log"] + self._logged, log[self._logged :])
        # The record last: it is what makes the bytes above count.
        self._write(self._place["record"] + (self._sequence % 2) * self._slot, record)
        self.rows, self.instants, self._state = rows, instants, state
        self._logged, self._sequence = len(log), self._sequence + 1
        self._waiting, self._written = [], clock.monotonic()

    def finish(self, status: str, message: str, summary: dict) -> Path:
        """Completes the archive and gives it its name; returns where it is.  `status` one of STATUSES, else ValueError.

        An interrupted run does not replace a complete archive: it stays at `partial_path(path)`.
        OSError as of `flush`.
        """
        if status not in STATUSES:
            raise ValueError(f"status {status!r} is none of {', '.join(STATUSES)}")
        with self._or_left():
            return self._finish(status, message, summary)

    def _finish(self, status: str, message: str, summary: dict) -> Path:
        if self._file:
            self.flush()
        target = self.path
        if status == Status.INTERRUPTED and not self._may_replace():
            target = self.partial
        rows, instants = self._appended()
        self._attributes |= {"status": status, "message": message, "summary": summary}
        self._attributes |= {"rows": rows, "instants": instants}
        if rows > SHARE * self._room and 0 < self._room <= MOST_IN_PLACE:
            written = self._shortened(target)
        else:
            # What has much room to spare gives it back.
            written = self._rewritten(target, rows, instants, self.partial, self._attributes)
        with written as file:
            # Of a run that is written once, all.
            for name, _, values in self._pieces():
                h5py.h5d.open(file.id, name.encode()).write(h5py.h5s.ALL, h5py.h5s.ALL, values)
            file.create_group("restart").attrs["state"] = _to_json(self.state)
            _write_events(file, _read_log(self._log))
            seal(file)
        is_sound(target)
        if target != self.partial:
            self.partial.unlink(missing_ok=True)
        self.rows, self.instants, self._waiting, self._ended = rows, instants, [], True
        return target

    def close(self) -> None:
        """Leaves the run as it is, to be continued."""
        if not self._ended:
            self.flush()
            self._close()
            self._ended = True

    @contextmanager
    def _or_left(self):
        """What is written; where the disk takes no more the run is left as it is there, to be continued."""
        try:
            yield
        except OSError:
            self._close()
            self._ended = True
            raise

    def _close(self) -> None:
        if self._file:
            end_writing(self._file)
            self._file.close()
        self._file = None

    def _appended(self) -> tuple[int, int]:
        """Rows, and instants of the fields, with those that wait."""
        if not self._waiting:
            return self.rows, self.instants
        (row, instant), columns, fields, _ = self._waiting[-1]
        return row + len(columns["time"]), instant + len(fields.get(FIELD_TIME, ()))

    def _pieces(self) -> list[tuple[str, int, np.ndarray]]:
        """What waits: the name of a series or field, the first of its rows or instants, and their values."""
        series = [(row, columns) for (row, _), columns, _, _ in self._waiting]
        fields = [(instant, values) for (_, instant), _, values, _ in self._waiting if values]
        return [
            (name, parts[0][0], np.concatenate([values[name] for _, values in parts]))
            for parts in (series, fields)
            for name in (parts[0][1] if parts else ())
        ]

    # -- continuing --------------------------------------------------------------------------------

    def _resumable(self):
        if self.partial.exists():
            return self.partial
        return self.path if self.path.exists() and self._may_replace() else None

    def _may_replace(self) -> bool:
        try:
            return read_info(self.path)["status"] == Status.INTERRUPTED
        except ArchiveError:
            return True

    def _take_over(self, source):
        with _opened(source) as (file, record):
            if set(names_over(file, "time")) != set(self._series):
                raise ArchiveError(f"{source}: cannot be continued, its series differ from this run's")
            # An older archive has none: they begin where it is continued.
            if FIELD_TIME in file and not (self._fields and self._fields.are_those_of(file)):
                raise ArchiveError(f"{source}: cannot be continued, its fields differ from this run's")
            self.rows, self.instants, self.state = record["rows"], record["instants"], record["state"]
            self._attributes["created"] = file.attrs["created"]
            self.events(_events(file, record))
        self._state = self.state

    # -- the file ----------------------------------------------------------------------------------

    def _record(self, rows: int, instants: int, state: dict, log: bytes) -> bytes:
        record = {"sequence": self._sequence, "rows": rows, "instants": instants, "log": len(log), "state": state}
        text = _to_json(record).encode()
        return b"%08x %s\n" % (zlib.crc32(text), text)

    def _reserve(self, source, rows: int) -> None:
        """Writes the file anew with room for `rows` and as many again, what counts in `source` copied."""
        attributes = {**self._attributes, "status": str(Status.RUNNING), "message": ""}
        room = self._room if rows <= self._room else max(rows, 2 * self.rows)
        log = self._log
        record = self._record(self.rows, self.instants, self._state, log)
        self._slot = max(self._slot, 2 * len(record))
        self._log_room = max(self._log_room, 2 * len(log))
        most = self._fields.most if self._fields else 0
        with self._rewritten(self.partial, room, most, source, attributes, early=True) as file:
            restart = file.create_group("restart")
            restart.attrs["note"] = "rows beyond those of the newest whole record are room, not data"
            names = [*self._series, *(self._fields.over_time() if self._fields else ())]
            places = {name: file[name] for name in names}
            places["record"] = restart.create_dataset("record", data=np.zeros((2, self._slot), "u1"))
            places["log"] = restart.create_dataset("log", data=np.zeros(self._log_room, "u1"))
            restart["log"][: len(log)] = np.frombuffer(log, "u1")
            restart["record"][self._sequence % 2, : len(record)] = np.frombuffer(record, "u1")
            seal(file)
            place = {name: _offset(item) for name, item in places.items()}
        self._room, self._place, self._logged, self._sequence = room, place, len(log), self._sequence + 1
        self._written = clock.monotonic()
        self._file = open(self.partial, "r+b", buffering=0)  # noqa: SIM115  kept for the whole run
        begin_writing(self._file)

    @contextmanager
    def _rewritten(self, target: Path, room: int, instants: int, source, attributes: dict, early: bool = False):
        """A complete new file that takes the place of `target` when the block ends; `early` as in `reserve`."""
        with self._beside(target) as fresh, hdf5_with_room(fresh, self._size(room, instants)) as file:
            _write_attributes(file, {"format": FORMAT, **attributes})
            for name, series in self._series.items():
                reserve(file, name, series, (room,), early)
            attach_scale(file, "time", self._series)
            if self._fields:
                create_fields(file, self._fields, instants, early)
            if source and self.rows:
                with h5py.File(source, "r") as old:
                    for name in self._series:
                        _copy_rows(old[name], file[name], self.rows)
                    for name in self._fields.over_time() if self.instants else ():
                        file[name][: self.instants] = old[name][: self.instants]
            yield file

    @contextmanager
    def _shortened(self, target: Path):
        """A copy of the file without its spare room and restart group, which takes the place of `target` when the block
        ends."""
        with self._beside(target) as fresh:
            shutil.copyfile(self.partial, fresh)
            # Beside the rows.
            more = self._size(0, 0)
            with hdf5_with_room(fresh, fresh.stat().st_size + more, "r+") as file:
                _write_attributes(file, self._attributes)
                lengths = dict.fromkeys(self._series, self.rows)
                lengths |= dict.fromkeys(self._fields.over_time() if self._fields else (), self.instants)
                for name, length in lengths.items():
                    item = h5py.h5d.open(file.id, name.encode())
                    item.set_extent((length, *item.shape[1:]))
                del file["restart"]
                yield file

    @contextmanager
    def _beside(self, target: Path):
        """Where the file is written that takes the place of `target` at once when the block ends."""
        fresh = target.with_name(target.name + ".new")
        try:
            yield fresh
            self._close()
            os.replace(fresh, target)
        except BaseException:
            fresh.unlink(missing_ok=True)
            raise

    def _size(self, rows: int, instants: int) -> int:
        """Bytes of a file with so many rows and instants, at most."""
        columns, words = len(self._series), sum(len(str(value)) for value in self._attributes.values())
        values = rows * columns
        if self._fields:
            columns += len(self._fields.series) + len(self._fields.grid)
            values += instants * (1 + len(self._fields.series) * int(np.prod(self._fields.shape)))
            values += sum(self._fields.shape)
        # Words and events are kept as they are, and in a heap.
        return 8 * values + 4 * (words + self._log_room + len(self._log)) + 3 * self._slot + FILE + DATASET * columns

    def _write(self, place: int, data: bytes) -> None:
        self._file.seek(place)
        view = memoryview(data)
        while view:
            view = view[self._file.write(view) :]


def _write_attributes(file, attributes: dict):
    for name, value in attributes.items():
        describe(file.id, {name: value if isinstance(value, str | int | float) else _to_json(value)})


def _copy_rows(old, new, rows: int) -> None:
    for start in range(0, rows, BLOCK):
        stop = min(start + BLOCK, rows)
        new[start:stop] = old[start:stop]


def _offset(item) -> int:
    """Where a dataset's values stand in the file: in one piece, or in one chunk."""
    return item.id.get_offset() if item.chunks is None else item.id.get_chunk_info(0).byte_offset


def _write_events(file, events: list[dict]) -> None:
    group = file.create_group("events")
    if not events:
        return
    for name in ("time", "value"):
        group[name] = np.array([event.get(name, np.nan) for event in events], "<f8")
    for name in ("kind", "text"):
        group[name] = np.array([str(event.get(name, "")) for event in events], h5py.string_dtype())
    columns = tuple(group)
    rest = [{k: v for k, v in event.items() if k not in columns} for event in events]
    group["details"] = np.array([_to_json(item) for item in rest], h5py.string_dtype())
    group["time"].attrs["units"] = "s"
    attach_scale(group, "time", list(group))


def _to_json(value) -> str:
    def plain(item):
        if isinstance(item, np.ndarray):
            return {"array": item.tolist()}
        if isinstance(item, np.generic):
            return item.item()
        return str(item)

    return json.dumps(value, default=plain)


def _from_json(text):
    return json.loads(text, object_hook=lambda d: np.array(d["array"]) if set(d) == {"array"} else d)


# -- reading ---------------------------------------------------------------------------------------


@contextmanager
def _opened(path):
    """The file at `path` (or the run that is still to become it) and its newest whole record."""
    with _open_file(Path(path)) as file:
        must_be_readable(file, path, (FORMAT, *OLDER), "a sealdyn archive")
        try:
            if not is_whole(file):
                raise ArchiveError(f"{path}: what it says was altered since it was written")
            yield file, {"instants": 0} | _checked(file, _read_record(file))
        except ODD as error:
            words = " ".join(str(error).split())[:200]
            raise ArchiveError(f"{path}: damaged ({words or type(error).__name__})") from error


def _checked(file, record: dict) -> dict:
    """The record of an archive; raises ValueError where that cannot be."""
    room = {"rows": file["time"].shape[0], "instants": file[FIELD_TIME].shape[0] if FIELD_TIME in file else 0}
    for name, most in room.items():
        if not 0 <= record.get(name, 0) <= most:
            raise ValueError(f"{record[name]} {name} where there is room for {most}")
    for name in names_over(file, "time"):
        if file[name].shape != file["time"].shape or file[name].dtype.kind != "f":
            raise ValueError(f"{name} is no series of numbers over time")
    for name in ("status", "message", "scenario"):
        if not isinstance(file.attrs[name], str):
            raise TypeError(f"{name} is no text")
    if file.attrs["status"] not in (*STATUSES, Status.RUNNING):
        raise ValueError(f"status {file.attrs['status'][:40]}")
    if not isinstance(record["state"], dict):
        raise TypeError("what it goes on from is no table")
    return record


def _read_record(file) -> dict:
    if "record" not in file["restart"]:
        state = _from_json(file["restart"].attrs["state"])
        rows, instants = int(file.attrs["rows"]), int(file.attrs.get("instants", 0))
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
                what = "truncated or damaged" if h5py.is_hdf5(candidate) else "not an HDF5 file"
                raise ArchiveError(f"{candidate}: {what}") from error
    raise ArchiveError(f"{path}: {'not a file' if path.exists() else 'no such file'}")


def _newest_record(slots) -> dict:
    whole = []
    for slot in slots:
        check, _, text = slot.tobytes().split(b"\n", 1)[0].partition(b" ")
        if check == b"%08x" % zlib.crc32(text):
            whole.append(_from_json(text))
    if not whole:
        raise ValueError("no whole record of its rows")
    return max(whole, key=lambda record: record["sequence"])


def _read_log(log: bytes) -> list[dict]:
    return [_from_json(line) for line in log.splitlines()]


def _events(file, record: dict) -> list[dict]:
    """Events up to a record: a running run has them in its log."""
    if "log" in record:
        return _read_log(file["restart/log"][: record["log"]].tobytes())
    return _read_events(file["events"])


def _read_events(group) -> list[dict]:
    if "time" not in group:
        return []
    columns = {k: group[k].asstr()[()] if k in ("kind", "text", "details") else group[k][()] for k in group}
    details = columns.pop("details")
    rows = zip(*(columns[k].tolist() for k in columns), strict=True)
    return [dict(zip(columns, row, strict=True)) | json.loads(d) for row, d in zip(rows, details, strict=True)]


def read_info(path) -> dict:
    """Everything but the series and fields: status, message, summary, scenario, resolved, rows, instants, restart,
    events, series and fields (name -> `Series`), grid (dimension of the fields -> length) and the other root
    attributes.  Works while the run is written."""
    with _opened(path) as (file, record):
        info = {name: value.item() if hasattr(value, "item") else value for name, value in file.attrs.items()}
        for name in file.attrs.keys() - {"scenario", "title", "message"}:
            # Dicts and lists were stored as JSON: they come back as what they were.
            if isinstance(info[name], str) and info[name][:1] in ("{", "["):
                info[name] = _from_json(info[name])
        info.setdefault("summary", {})
        info["series"] = {name: _series(file[name].attrs) for name in names_over(file, "time")}
        names = [name for name in names_over(file, FIELD_TIME) if name != FIELD_TIME]
        info["fields"] = {name: _series(file[name].attrs) for name in names}
        info["grid"] = {d[0].name[1:]: d[0].size for name in names[:1] for d in file[name].dims}
        if names:
            # What lies beyond is room, not data.
            info["grid"][FIELD_TIME] = record["instants"]
        counts = {name: record[name] for name in ("rows", "instants")}
        return info | counts | {"restart": record["state"], "events": _events(file, record)}


def _series(attributes) -> Series:
    """Older archives have no display unit: their series are shown in `units`."""
    return Series(**{field: attributes[field] for field in Series._fields if field in attributes})


def last_state(path) -> dict:
    """What a continued run starts from: the state given with the last row that counts.  Raises `ArchiveError`."""
    with _opened(path) as (_, record):
        return record["state"]


def column(path, name: str, rows: slice = slice(None)) -> np.ndarray:
    """One series (rows,), float64, SI, or a slice of it, without loading the rest.  Raises `ArchiveError`."""
    with _opened(path) as (file, record):
        if scale_of(file, name) != "time":
            raise ArchiveError(f"{path}: has no series {name!r}")
        return file[name][slice(*rows.indices(record["rows"]))]


def field(path, name: str) -> np.ndarray:
    """One field (instants, ...), the `field_time` of its instants (instants,) or a coordinate of its grid; SI."""
    with _opened(path) as (file, record):
        scale = scale_of(file, name)
        if scale in (None, "time"):
            raise ArchiveError(f"{path}: has no field {name!r}")
        return file[name][: record["instants"]] if scale == FIELD_TIME else file[name][()]


def open_run(path):
    """The archive as a lazily loaded `xarray.Dataset`: series over `time` with units, fields over `field_time` and
    their grid; `attrs` hold the scenario text, status, message, and `resolved` and `summary` as JSON."""
    import xarray

    with _opened(path) as (file, record):
        name = file.filename
    try:
        dataset = xarray.open_dataset(name, engine="h5netcdf", decode_times=False)
    except ODD as error:
        raise ArchiveError(f"{path}: damaged ({' '.join(str(error).split())[:200]})") from error
    counts = {"time": record["rows"], FIELD_TIME: record["instants"]}
    dataset = dataset.isel({name: slice(0, count) for name, count in counts.items() if name in dataset.dims})
    return dataset.assign_attrs(rows=record["rows"])
