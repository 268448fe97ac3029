"""Writing of the one HDF5 file of a run: scenario, provenance, named series with units, fields, events, and the state
to go on from.

How a run survives being killed.  HDF5 cannot be interrupted while it rearranges its own bookkeeping, so
it never does that in a file anybody reads: the skeleton is written once beside the run with room to spare
and renamed into place; rows then go straight to the places HDF5 has reserved for them; a record of how
many rows count (two slots in turn, each with a checksum) goes last.  Whatever instant the run ends at, the
file opens and one record is whole.  When the room is used up, or the run is done, the file is written anew
and renamed again.  A run that is done before its rows have waited long enough is written once.  Readers need
no lock and no luck.
"""

import time as clock
import zlib
from contextlib import contextmanager
from datetime import UTC, datetime
from pathlib import Path

import h5py
import numpy as np

from ..status import Status
from .files import (
    DATASET,
    FILE,
    ArchiveError,
    begin_writing,
    end_writing,
    hdf5_in_place_of,
    mark_sound,
    partial_path,
    seal,
)
from .run import (
    FIELD_TIME,
    FORMAT,
    MOST_IN_PLACE,
    STATUSES,
    Fields,
    Series,
    attach_scale,
    create_fields,
    describe,
    events_of,
    names_over,
    opened_run,
    read_info,
    read_log,
    reserve,
    to_json,
)

SMALLEST_ROOM, LARGEST_FIRST_ROOM, BLOCK = 4096, 1 << 20, 1 << 16
SLOT, LOG = 1 << 14, 1 << 14
# Bytes of an event beside its words: two numbers, and three words' places.
EVENT = 160
# Of its room a finished archive fills at least this.
SHARE = 0.9


class ArchiveWriter:
    """Writes one run, row by row, in bounded memory.

    `series` maps a column's name to its `Series`; `time` (s) is added when missing.  `fields`: what is kept over
    a grid at a few of the rows.  `meta` becomes root attributes.  `expected_rows` spares copying: room for so
    many rows is reserved at once.  Rows wait in memory for at most `interval` seconds or `buffer_rows` rows; before,
    there is no file.
    With `resume`, goes on from `<stem>.partial.h5`, or from a `path` that was interrupted: `rows`, `state` say
    from where, `goes_on_from` that part of it comes again; without either it starts anew.  Raises `ArchiveError` when
    the series or fields differ from those of the file resumed.
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
        # Events handed over; rows, instants and events that will come once more.
        self._told, self._again = 0, [0, 0, 0]
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
        again, columns = self._again[0] > 0, self._unwritten(0, columns)
        fields = self._unwritten(1, fields) if fields else {}
        fields = self._fields.checked(fields, self._counts()[1]) if fields else {}
        if again and not len(columns["time"]):
            # All of it is there, and a later state.
            return
        # Rows know their place, so that a flush broken off by Ctrl-C can simply be done again.
        self._waiting.append((self._counts(), columns, fields, self.state if state is None else state))
        self.state = self._waiting[-1][-1]
        late = clock.monotonic() - self._written >= self._interval
        if late or self._counts()[0] - self.rows >= self._buffer_rows:
            self.flush()

    def events(self, events: list[dict]) -> None:
        """Adds events: dicts with kind, time (s), value, text; other keys are kept as JSON."""
        kept = self._unwritten(2, {"": events})[""]
        self._told += len(kept)
        self._log += b"".join(to_json(event).encode() + b"\n" for event in kept)

    def counts(self) -> tuple[int, int, int]:
        """Rows, instants of the fields and events so far, with those that wait, less those that come again."""
        rows, instants, events = (
            here - again for here, again in zip((*self._counts(), self._told), self._again, strict=True)
        )
        return rows, instants, events

    def goes_on_from(self, written) -> None:
        """What comes goes on from so many rows, instants and events (`counts`): what is here already comes again, and
        is not written twice.  Raises ValueError where that much is not here."""
        self._again = [here - int(was) for here, was in zip(self.counts(), written, strict=True)]
        if min(self._again) < 0 or min(written) < 0:
            raise ValueError("it does not hold what it says that it does")

    def note(self, **attributes) -> None:
        """Change root attributes, as `meta`."""
        self._attributes |= attributes

    def _unwritten(self, kind: int, values: dict) -> dict:
        """Rows, instants or events without those that are here already."""
        skip = min(self._again[kind], len(next(iter(values.values()))))
        self._again[kind] -= skip
        return {name: part[skip:] for name, part in values.items()}

    def flush(self) -> None:
        """Hands everything waiting to the operating system; after it, a kill loses nothing.

        Raises OSError where the disk takes no more: what was written before stays, and the writer has ended.
        """
        with self._left_on_error():
            self._flush()

    def _flush(self) -> None:
        (rows, instants), state, log = self._counts(), self.state, self._log
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
        with self._left_on_error():
            return self._finish(status, message, summary)

    def _finish(self, status: str, message: str, summary: dict) -> Path:
        if self._file:
            self.flush()
        target = self.path
        if status == Status.INTERRUPTED and not self._may_replace():
            target = self.partial
        rows, instants = self._counts()
        self._attributes |= {"status": status, "message": message, "summary": summary}
        self._attributes |= {"rows": rows, "instants": instants}
        if rows > SHARE * self._room and 0 < self._room <= MOST_IN_PLACE:
            written = self._shorten(target)
        else:
            # What has much room to spare gives it back.
            written = self._rewrite(target, rows, instants, self.partial, self._attributes)
        with written as file:
            # Of a run that is written once, all.
            for name, _, values in self._pieces():
                h5py.h5d.open(file.id, name.encode()).write(h5py.h5s.ALL, h5py.h5s.ALL, values)
            file.create_group("restart").attrs["state"] = to_json(self.state)
            _write_events(file, read_log(self._log))
            seal(file)
        mark_sound(target)
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
    def _left_on_error(self):
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

    def _counts(self) -> tuple[int, int]:
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
        with opened_run(source) as (file, record):
            if set(*names_over(file, "time")) != set(self._series):
                raise ArchiveError(f"{source}: cannot be continued, its series differ from this run's")
            if not (self._fields.are_those_of(file) if self._fields else FIELD_TIME not in file):
                raise ArchiveError(f"{source}: cannot be continued, its fields differ from this run's")
            self.rows, self.instants, self.state = record["rows"], record["instants"], record["state"]
            self._attributes["created"] = file.attrs["created"]
            self.events(events_of(file, record))
        self._state = self.state

    # -- the file ----------------------------------------------------------------------------------

    def _record(self, rows: int, instants: int, state: dict, log: bytes) -> bytes:
        record = {"sequence": self._sequence, "rows": rows, "instants": instants, "log": len(log), "state": state}
        text = to_json(record).encode()
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
        with self._rewrite(self.partial, room, most, source, attributes, early=True) as file:
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
    def _rewrite(self, target: Path, room: int, instants: int, source, attributes: dict, early: bool = False):
        """A complete new file that takes the place of `target` when the block ends; `early` as in `reserve`."""
        with hdf5_in_place_of(target, self._size(room, instants), before=self._close) as file:
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
    def _shorten(self, target: Path):
        """A copy of the file without its spare room and restart group, which takes the place of `target` when the block
        ends."""
        size = self.partial.stat().st_size + self._size(0, 0)
        with hdf5_in_place_of(target, size, self.partial, self._close) as file:
            _write_attributes(file, self._attributes)
            lengths = dict.fromkeys(self._series, self.rows)
            lengths |= dict.fromkeys(self._fields.over_time() if self._fields else (), self.instants)
            for name, length in lengths.items():
                item = h5py.h5d.open(file.id, name.encode())
                item.set_extent((length, *item.shape[1:]))
            del file["restart"]
            yield file

    def _size(self, rows: int, instants: int) -> int:
        """Bytes of a file with so many rows and instants, at most."""
        columns, words = len(self._series), sum(len(str(value)) for value in self._attributes.values())
        values = rows * columns
        if self._fields:
            columns += len(self._fields.series) + len(self._fields.grid)
            values += instants * (1 + len(self._fields.series) * int(np.prod(self._fields.shape)))
            values += sum(self._fields.shape)
        # Words and events are kept as they are, and in a heap; a state that was not written before stands there whole.
        words += self._log_room + len(self._log) + len(to_json(self.state))
        return 8 * values + 4 * words + EVENT * self._told + 3 * self._slot + FILE + DATASET * columns

    def _write(self, place: int, data: bytes) -> None:
        self._file.seek(place)
        view = memoryview(data)
        while view:
            view = view[self._file.write(view) :]


def _write_attributes(file, attributes: dict):
    for name, value in attributes.items():
        describe(file.id, {name: value if isinstance(value, str | int | float) else to_json(value)})


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
    group["details"] = np.array([to_json(item) for item in rest], h5py.string_dtype())
    group["time"].attrs["units"] = "s"
    attach_scale(group, "time", list(group))
