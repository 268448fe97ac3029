"""Files of samples, of the motion of a carrier, the force on a ring, or any quantity over time: their columns take
their place in a scenario's tables."""

import csv
import io
import math
import os
import re
import stat
from bisect import bisect_left, bisect_right
from collections.abc import Set
from pathlib import Path
from typing import Any, get_type_hints

from ..scene.excitation import ACCELERATIONS, MOTION_COLUMNS
from ..scene.forces import LOAD_COLUMNS
from ..scene.scene import SceneError
from ..scene.tabulated import COLUMNS, Tabulated
from ..units import (
    MOST_LISTED,
    SECONDS,
    Acceleration,
    Angle,
    AngularAcceleration,
    Force,
    Length,
    Moment,
    QuantityError,
    Speed,
    VaryingQuantity,
    quantity_of,
    quoted,
)
from .keys import held_at, is_marked, leaves

# Of a file; what is more than MOST_LISTED is cut to the run.
MOST_ROWS = 5_000_000
# What each column may be.
KINDS = {
    "time": (SECONDS,), "axial": Length.__metadata__, "tilt_x": Angle.__metadata__, "tilt_y": Angle.__metadata__,
    "axial_acceleration": Acceleration.__metadata__, "tilt_x_acceleration": AngularAcceleration.__metadata__,
    "tilt_y_acceleration": AngularAcceleration.__metadata__, "force": Force.__metadata__,
    "moment_x": Moment.__metadata__, "moment_y": Moment.__metadata__,
}  # fmt: skip
MOTION = {name: KINDS[name][0] for name in ("time", *MOTION_COLUMNS, *ACCELERATIONS)}
LOADS = {name: KINDS[name][0] for name in ("time", *LOAD_COLUMNS)}
FILM = {name: quantity_of(get_type_hints(Tabulated, include_extras=True)[name]) for name in COLUMNS}
# Tables of samples, dotted.
PLACES = {
    "shaft.motion": MOTION,
    "housing.motion": MOTION,
    "stator.load.samples": LOADS,
    "rotor.load.samples": LOADS,
    "film.tabulated": FILM,
}
# "axial", "axial (um)" and "axial [um]".
TITLE = re.compile(r"\s*(\w+)\s*(?:[(\[]\s*(.*?)\s*[)\]])?\s*")
BEGINNING = re.compile(r"\s*(\w+)")
NUMBER = re.compile(r"\s*[+-]?(?:(?:[0-9]+\.?[0-9]*|\.[0-9]+)(?:[eE][+-]?[0-9]+)?|nan|inf)\s*", re.IGNORECASE)
WITH_COMMA = re.compile(r"\s*[+-]?[0-9]*,[0-9]+(?:[eE][+-]?[0-9]+)?\s*")
MOST_BYTES = 1 << 26
TABLE = "table."
# Below this a number is nothing: what is left of a zero.
NOTHING = 1e-25


def with_columns(
    raw: dict, kind: type, folder: Path | None, held: dict | None, asked: Set[str]
) -> tuple[dict, list[SceneError], list[str]]:
    """The tables `raw`, of a `kind` of file, with the columns of the files that they name, what is wrong with a file,
    and keys of columns without a unit.  A table of samples keeps the file's name beside them, a quantity over time does
    not.  Files are looked for from `folder`; `held`: an archive's resolved tables, whose columns stand for the file of
    that name.  Raises SceneError for a file that the archive does not hold: a stranger's words open none, but keys that
    the user has `asked` for."""
    over_time = quantities_of_files(raw, kind)
    wrong: list[SceneError] = []
    bare: list[str] = []
    for table, known in (PLACES | over_time).items():
        motion, kept, key = table_at(raw, table), table_at(held, table), f"{table}.file"
        first, file = next(iter(known)), motion.get("file")
        if "file" not in motion or first in motion:
            continue
        if table in over_time:
            kept = {"file": file, **kept} if "value" in kept and not is_asked(key, asked) else {}
        if held is not None and not is_asked(key, asked) and (first not in kept or kept.get("file") != file):
            found = f"{quoted(file)}, which the archive does not hold"
            raise SceneError(key, found, f"--set {key}=FILE, where it is meant")
        if not isinstance(file, str):
            continue
        try:
            columns = {}
            if kept.get("file") != file:
                columns = file_columns((folder or Path()) / file, known, motion.get("titles"), _end(raw))
                if table in over_time:
                    if len(columns) > 2:
                        found = f"{quoted(file)} with the columns {', '.join(columns)}"
                        raise QuantityError(found, f"time and one of {', '.join(list(known)[1:])}")
                    columns = {column if column == "time" else "value": read for column, read in columns.items()}
                elif "time" in known:
                    columns = _once(file, columns)
            given = {column: values for column, (values, _) in columns.items()} or kept
            bare += [f"{table}.{column}" for column, (_, unit) in columns.items() if not unit]
        except QuantityError as error:
            wrong.append(SceneError(key, error.found, error.expected))
            # Another thing that is wrong is not this one's fault.
            _, second, *_ = known
            given = {first: [float(n) for n in range(1, 7)], second: [0.0] * 5 + [1e-9]}
            given |= {"time": [float(n) for n in range(6)], "value": [1.0] * 6} if first == "time" else {}
        if table in over_time:
            columns = {column: given[column] for column in ("time", "value") if column in given}
            columns |= {step: held for step, held in motion.items() if step not in ("file", "titles")}
        else:
            columns = {column: given[column] for column in known if given.get(column) is not None} | motion
        raw = with_part(raw, table, columns)
    return raw, wrong, bare


def is_asked(key: str, asked: Set[str]) -> bool:
    """Whether a dotted key, or a table that it stands in, is among those that are `asked` for."""
    return any(f"{key}.".startswith(f"{step}.") for step in asked)


def quantities_of_files(raw: dict, kind: type) -> dict[str, dict]:
    """What is given over time by a file, { file = "speed.csv" }, in the tables `raw` of a `kind` of file: dotted key ->
    {column: quantity}, time and the key's own name or "value"."""
    found: dict[str, dict] = {}
    for key, value in leaves(raw, kind):
        if isinstance(value, dict) and "file" in value and is_marked(holds := held_at(kind, key), VaryingQuantity):
            quantity = quantity_of(holds)
            found[key] = {"time": SECONDS, key.rpartition(".")[2]: quantity, "value": quantity}
    return found


def _end(raw: dict) -> float | None:
    """End (s) of the run that the tables ask for, where it can be read from them."""
    run, shaft = table_at(raw, "run"), table_at(raw, "shaft")
    try:
        if "duration" in run:
            return SECONDS.read(run["duration"])
        speed = abs(Speed.__metadata__[0].read(shaft.get("speed")))
        return 2 * math.pi * float(run.get("turns", 60)) / speed if speed else None
    except (QuantityError, TypeError, ValueError):
        # What is wrong is told where the keys are read.
        return None


def _once(file: str, columns: dict) -> dict:
    """The columns without what stands there twice: programs write a moment once before and once after an event.
    Raises QuantityError for a jump."""
    times = columns["time"][0]
    twice = {n for n in range(1, len(times)) if times[n] == times[n - 1]}
    for name, (values, _) in columns.items():
        for n in sorted(twice):
            if not math.isclose(values[n], values[n - 1], rel_tol=1e-9):
                found = f"{quoted(file)}, column {name}: {values[n - 1]:g} and {values[n]:g} at {times[n]:g} s"
                raise QuantityError(found, "one value at a time: samples are joined by a smooth curve")
    return {
        name: ([v for n, v in enumerate(values) if n not in twice], unit) for name, (values, unit) in columns.items()
    }


def _cut(file: str, columns: dict, end: float | None) -> dict:
    """The columns from before the start of a run to beyond its `end`, MOST_LISTED samples: where a smooth curve is cut
    off is nothing to see fifty samples away.  Raises QuantityError."""
    times = columns["time"][0]
    expected = f"at most {MOST_LISTED}"
    if end is None:
        raise QuantityError(f"{quoted(file)}, {len(times)} samples", f"{expected}, or a [run] duration to be cut to")
    for n in range(1, len(times)):
        if not times[n] >= times[n - 1]:
            raise QuantityError(f"{quoted(file)}, time {times[n]:g} after {times[n - 1]:g} s", "times that increase")
    first, last = max(bisect_right(times, 0.0) - 1, 0), min(bisect_left(times, end) + 1, len(times))
    if last - first > MOST_LISTED - 100:
        raise QuantityError(f"{quoted(file)}, {last - first} samples in {end:g} s", f"{expected}, or a shorter run")
    first = max(first - (MOST_LISTED - last + first) // 2, 0)
    return {name: (values[first : first + MOST_LISTED], unit) for name, (values, unit) in columns.items()}


def with_part(tables: Any, key: str, value: Any) -> Any:
    """The tables with another value at a dotted key."""
    step, _, rest = key.partition(".")
    if isinstance(tables, list):
        return [with_part(entry, rest, value) if n == int(step) else entry for n, entry in enumerate(tables)]
    return {**tables, step: with_part(tables[step], rest, value) if rest else value}


def part_at(tables: Any, key: str) -> Any:
    """What stands at a dotted key of tables of whatever shape, None where there is no such key."""
    for step in key.split("."):
        if isinstance(tables, list):
            tables = tables[int(step)] if step.isdigit() and int(step) < len(tables) else None
        else:
            tables = tables.get(step) if isinstance(tables, dict) else None
    return tables


def table_at(tables: Any, key: str) -> dict:
    """The table at a dotted key of tables; empty if it is none (the reader says so)."""
    found = part_at(tables, key)
    return found if isinstance(found, dict) else {}


def _a_file(known) -> str:
    first, *others = known
    names = f"{first} and its like"
    if others[-1] == "value":
        names = f"time and {others[0]}"
    elif first == "time":
        names = f"time and {', '.join(others[:2])} or {others[2]}"
        names += "" if len(others) == 3 else " (or their ..._acceleration)"
    return f"a CSV file with a line of names (or titles for it), {names} with units in brackets, or HDF5 (.h5)"


def file_columns(path: Path, known, titles=None, end: float | None = None) -> dict[str, tuple[list[float], str]]:
    """Columns of a file, SI, and the unit in which it has them, of the `known` quantities {name: Quantity}; `titles` of
    a CSV file without a line of names, `end` (s) of the run to which a long record is cut.  Raises QuantityError."""
    a_file = _a_file(known)
    try:
        size = path.stat().st_size if path.is_file() else None
    except (OSError, ValueError):
        size = None
    if size is None:
        raise QuantityError(f"{quoted(str(path))}, no such file", a_file)
    if size > MOST_BYTES:
        raise QuantityError(f"{quoted(path.name)}, {size} bytes", f"at most {MOST_BYTES} bytes")
    columns = _hdf5(path, known) if path.suffix in (".h5", ".hdf5") else _csv(path, known, titles)
    if next(iter(known)) not in columns or len(columns) < 2:
        there = ", ".join(columns) or "none of them"
        raise QuantityError(f"{quoted(path.name)} with the columns {there}", a_file)
    columns = {name: (_in_si(path.name, name, known[name], *columns[name]), columns[name][1]) for name in columns}
    return _cut(path.name, columns, end) if len(columns[next(iter(known))][0]) > MOST_LISTED else columns


def _in_si(file: str, name: str, quantity, values: list[float], unit: str) -> list[float]:
    try:
        factor = quantity.read(f"1 {unit}") if unit else 1.0
    except QuantityError as error:
        raise QuantityError(f"{quoted(file)}, column {name}: {error.found}", error.expected) from None
    for n, value in enumerate(values):
        if not math.isfinite(value):
            raise QuantityError(f"{quoted(file)}, column {name}, sample {n + 1}: {value}", "a finite number")
    return [factor * value if abs(factor * value) >= NOTHING else 0.0 for value in values]


def _most(known) -> int:
    """Samples that a file may have."""
    return MOST_ROWS if "time" in known else MOST_LISTED


def _hdf5(path: Path, known) -> dict[str, tuple[list[float], str]]:
    # Loaded only where such a file is read.
    from ..archive import ArchiveError
    from ..archive.columns import read_columns

    try:
        found = read_columns(path, (*known, *(TABLE + name for name in known)), _most(known))
    except ArchiveError as error:
        raise QuantityError(str(error), _a_file(known)) from None
    # As they stand in the archive of a study.
    return {name.removeprefix(TABLE): column for name, column in found.items()}


def _csv(path: Path, known, titles) -> dict[str, tuple[list[float], str]]:
    try:
        text = whole_file(path, MOST_BYTES).decode("utf-8-sig")
    except (OSError, UnicodeDecodeError):
        raise QuantityError(f"{quoted(path.name)}, no readable text", _a_file(known)) from None
    rows = _rows(path.name, text, _a_file(known))
    if isinstance(titles, list):
        # What is no text is told where the keys are read.
        rows = [(0, [str(title) for title in titles]), *rows]
    if not rows:
        raise QuantityError(f"{quoted(path.name)}, an empty file", _a_file(known))
    if len(rows) - 1 > _most(known):
        raise QuantityError(f"{quoted(path.name)}, {len(rows) - 1} samples", f"at most {_most(known)}")
    (_, names), *rows = rows
    for line, row in rows:
        # What a decimal comma makes of a number, where commas separate.
        if len(row) > len(names) and any(cell.strip() for cell in row[len(names) :]):
            found = f"{quoted(path.name)}, line {line}: {len(row)} cells below {len(names)} names"
            raise QuantityError(found, "one cell below each name, and a decimal point")
    found = {}
    for place, title in enumerate(names):
        read, begins = TITLE.fullmatch(title), BEGINNING.match(title)
        name = begins[1].lower() if begins else ""
        if name not in known:
            continue
        if read is None:
            raise QuantityError(f"{quoted(path.name)}, a column {quoted(title)}", f'"{name}" or "{name} (unit)"')
        if name in found:
            raise QuantityError(f"{quoted(path.name)}, column {name} twice", "each column once")
        found[name] = [_number(path.name, name, known[name], line, row, place) for line, row in rows], read[2] or ""
    return found


def _rows(file: str, text: str, a_file: str) -> list[tuple[int, list[str]]]:
    """Rows of a CSV file with the line on which each ends; a quoted cell may go over several."""
    numbers = []

    def lines():
        for n, line in enumerate(io.StringIO(text, newline=""), 1):
            if line.strip() and not line.startswith("#"):
                numbers.append(n)
                yield line

    first = next(lines(), "")
    numbers.clear()
    separator = next((mark for mark in (";", "\t") if mark in first), ",")
    reader = csv.reader(lines(), delimiter=separator, skipinitialspace=True)
    try:
        return [(numbers[reader.line_num - 1], row) for row in reader]
    except csv.Error as error:
        raise QuantityError(f"{quoted(file)}, no CSV ({error})", a_file) from None


def _number(file: str, name: str, quantity, line: int, row: list[str], place: int) -> float:
    cell = row[place] if place < len(row) else ""
    if NUMBER.fullmatch(cell):
        return float(cell)
    held = quoted(cell) if place < len(row) else "nothing"
    expected = f"a {quantity.name} as a number"
    if WITH_COMMA.fullmatch(cell):
        held, expected = f"{held}, a decimal comma", f"{expected} with a decimal point"
    raise QuantityError(f"{quoted(file)}, line {line}, column {name}: {held}", expected)


def whole_file(path: Path, most: int) -> bytes:
    """The bytes of a file; raises OSError for pipes, devices, what has more than `most` bytes, and what the system
    makes up as it is read and has none now."""
    # Of a pipe without a writer, or the kernel's messages, it does not wait.
    with open(os.open(path, os.O_RDONLY | getattr(os, "O_NONBLOCK", 0) | getattr(os, "O_BINARY", 0)), "rb") as file:
        if not stat.S_ISREG(os.fstat(file.fileno()).st_mode):
            raise OSError("a pipe or a device")
        data = file.read(most + 1)
    if data is None or len(data) > most:
        raise OSError(f"more than {most} bytes" if data else "nothing in it now")
    return data
