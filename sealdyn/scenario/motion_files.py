"""Files of samples, of the motion of a carrier or of the force on a ring: their columns take their place in a
scenario's tables."""

import csv
import io
import math
import os
import re
import stat
from pathlib import Path
from typing import get_type_hints

from ..scene.excitation import ACCELERATIONS, MOTION_COLUMNS
from ..scene.loads import LOAD_COLUMNS
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
    quantity_of,
    quoted,
)
from .errors import ScenarioError, raw_at

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
    raw: dict, name: str, folder: Path | None, held: dict, wrong: list[ScenarioError], bare: list[str]
) -> dict:
    """The tables `raw` of the scenario `name` with the columns of the files that their motions name, beside the files'
    names.  Files are looked for from `folder`; `held`: an archive's resolved tables, whose columns stand for the file
    of that name.  What is wrong with a file goes to `wrong`, keys of columns without a unit to `bare`."""
    for table, known in PLACES.items():
        motion, kept = samples_at(raw, table), samples_at(held, table)
        if not isinstance(motion.get("file"), str) or next(iter(known)) in motion:
            continue
        file, key = motion["file"], f"{table}.file"
        try:
            columns = (
                {} if kept.get("file") == file else _columns((folder or Path()) / file, known, motion.get("titles"))
            )
            given = {column: values for column, (values, _) in columns.items()} or kept
            bare += [f"{table}.{column}" for column, (_, unit) in columns.items() if not unit]
        except QuantityError as error:
            wrong.append(ScenarioError(name, key, error.found, error.expected))
            # Another thing that is wrong is not this one's fault.
            first, second, *_ = known
            given = {first: [float(n) for n in range(1, 7)], second: [0.0] * 5 + [1e-9]}
            given |= {"time": [float(n) for n in range(6)]} if first == "time" else {}
        columns = {column: given[column] for column in known if given.get(column) is not None}
        raw = _replaced(raw, table.split("."), {**columns, **motion})
    return raw


def _replaced(tables: dict, path: list[str], value: dict) -> dict:
    """The tables with another value at a path."""
    step, *rest = path
    return {**tables, step: _replaced(tables[step], rest, value) if rest else value}


def samples_at(tables, table: str) -> dict:
    """The samples at a dotted place of tables of whatever shape; empty without any."""
    tables = raw_at(tables, table.split("."))
    return tables if isinstance(tables, dict) else {}


def refuse_files_elsewhere(raw: dict, name: str, held: dict, asked) -> None:
    """Raises ScenarioError where an archive's scenario, its tables `raw`, names a file that the archive does not hold
    (`held`: its resolved tables): a stranger's words open none.  Keys that the user has `asked` for are his own."""
    for table, known in PLACES.items():
        motion, kept = samples_at(raw, table), samples_at(held, table)
        steps = f"{table}.file".split(".")
        own = asked & {".".join(steps[:n]) for n in range(1, len(steps) + 1)}
        first = next(iter(known))
        if own or first in motion or "file" not in motion:
            continue
        if kept.get("file") != motion["file"] or first not in kept:
            key = f"{table}.file"
            found = f"{quoted(motion['file'])}, which the archive does not hold"
            raise ScenarioError(name, key, found, f"--set {key}=FILE, where it is meant")


def read_motion(path: Path, known=MOTION) -> dict[str, list[float]]:
    """Columns of a file, SI: `time` (s) and what there is of `axial` (m), `tilt_x` and `tilt_y` (rad), or of other
    `known` quantities {name: Quantity}.  Raises QuantityError."""
    return {name: values for name, (values, _) in _columns(path, known).items()}


def _a_file(known) -> str:
    first, *others = known
    names = f"{first} and its like"
    if first == "time":
        names = f"time and {', '.join(others[:2])} or {others[2]}"
        names += "" if len(others) == 3 else " (or their ..._acceleration)"
    return f"a CSV file with a line of names (or titles for it), {names} with units in brackets, or HDF5 (.h5)"


def _columns(path: Path, known, titles=None) -> dict[str, tuple[list[float], str]]:
    """Columns of a file, SI, and the unit in which it has them; `titles` of a CSV file without a line of names."""
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
    return {name: (_in_si(path.name, name, known[name], *columns[name]), columns[name][1]) for name in columns}


def _in_si(file: str, name: str, quantity, values: list[float], unit: str) -> list[float]:
    try:
        factor = quantity.read(f"1 {unit}") if unit else 1.0
    except QuantityError as error:
        raise QuantityError(f"{quoted(file)}, column {name}: {error.found}", error.expected) from None
    for n, value in enumerate(values):
        if not math.isfinite(value):
            raise QuantityError(f"{quoted(file)}, column {name}, sample {n + 1}: {value}", "a finite number")
    return [factor * value if abs(factor * value) >= NOTHING else 0.0 for value in values]


def _hdf5(path: Path, known) -> dict[str, tuple[list[float], str]]:
    # Loaded only where such a file is read.
    from ..archive import ArchiveError
    from ..archive.columns import read_columns

    try:
        found = read_columns(path, (*known, *(TABLE + name for name in known)), MOST_LISTED)
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
    if len(rows) - 1 > MOST_LISTED:
        raise QuantityError(f"{quoted(path.name)}, {len(rows) - 1} samples", f"at most {MOST_LISTED}")
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
