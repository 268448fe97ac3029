"""Files that give the motion of a carrier: their columns take their place in a scenario's tables."""

import csv
import io
import math
import os
import re
import stat
from pathlib import Path

from ..scene.excitation import MOTION_COLUMNS
from ..units import MOST_LISTED, SECONDS, Angle, Length, QuantityError, quoted
from .errors import ScenarioError

NAMES = ("time", *MOTION_COLUMNS)
QUANTITIES = dict(zip(NAMES, (SECONDS, Length.__metadata__[0], *[Angle.__metadata__[0]] * 2), strict=True))
# "axial", "axial (um)" and "axial [um]".
TITLE = re.compile(r"\s*(\w+)\s*(?:[(\[]\s*(.*?)\s*[)\]])?\s*")
BEGINNING = re.compile(r"\s*(\w+)")
NUMBER = re.compile(r"\s*[+-]?(?:(?:[0-9]+\.?[0-9]*|\.[0-9]+)(?:[eE][+-]?[0-9]+)?|nan|inf)\s*", re.IGNORECASE)
WITH_COMMA = re.compile(r"\s*[+-]?[0-9]*,[0-9]+(?:[eE][+-]?[0-9]+)?\s*")
MOST_BYTES = 1 << 26
# Below this a number is nothing: what is left of a zero.
NOTHING = 1e-25
A_FILE = "a CSV file with a line of names, time and axial, tilt_x or tilt_y with units in brackets, or HDF5 (.h5)"


def with_columns(
    raw: dict, name: str, folder: Path | None, held: dict, wrong: list[ScenarioError], bare: list[str]
) -> dict:
    """The tables `raw` of the scenario `name` with the columns of the files that their motions name, beside the files'
    names.  Files are looked for from `folder`; `held`: an archive's resolved tables, whose columns stand for the file
    of that name.  What is wrong with a file goes to `wrong`, keys of columns without a unit to `bare`."""
    for table in ("shaft", "housing"):
        motion, kept = _motion(raw, table), _motion(held, table)
        if not isinstance(motion.get("file"), str) or "time" in motion:
            continue
        file, key = motion["file"], f"{table}.motion.file"
        try:
            columns = {} if kept.get("file") == file else _columns((folder or Path()) / file)
            given = {column: values for column, (values, _) in columns.items()} or kept
            bare += [f"{table}.motion.{column}" for column, (_, unit) in columns.items() if not unit]
        except QuantityError as error:
            wrong.append(ScenarioError(name, key, error.found, error.expected))
            # Another thing that is wrong is not this one's fault.
            given = {"time": [float(n) for n in range(6)], "axial": [0.0] * 5 + [1e-9]}
        columns = {column: given[column] for column in NAMES if given.get(column) is not None}
        raw = {**raw, table: {**raw[table], "motion": {**columns, **motion}}}
    return raw


def _motion(tables: dict, table: str) -> dict:
    """The motion of shaft or housing among tables of whatever shape; empty without one."""
    above = tables.get(table)
    motion = above.get("motion") if isinstance(above, dict) else None
    return motion if isinstance(motion, dict) else {}


def refuse_files_elsewhere(raw: dict, name: str, held: dict, asked) -> None:
    """Raises ScenarioError where an archive's scenario, its tables `raw`, names a file that the archive does not hold
    (`held`: its resolved tables): a stranger's words open none.  Keys that the user has `asked` for are his own."""
    for table in ("shaft", "housing"):
        motion, kept = _motion(raw, table), _motion(held, table)
        own = asked & {table, f"{table}.motion", f"{table}.motion.file"}
        if own or "time" in motion or "file" not in motion:
            continue
        if kept.get("file") != motion["file"] or "time" not in kept:
            key = f"{table}.motion.file"
            found = f"{quoted(motion['file'])}, which the archive does not hold"
            raise ScenarioError(name, key, found, f"--set {key}=FILE, where it is meant")


def read_motion(path: Path) -> dict[str, list[float]]:
    """Columns of a file, SI: `time` (s) and what there is of `axial` (m), `tilt_x` and `tilt_y` (rad).  Raises
    QuantityError."""
    return {name: values for name, (values, _) in _columns(path).items()}


def _columns(path: Path) -> dict[str, tuple[list[float], str]]:
    """Columns of a file, SI, and the unit in which it has them."""
    try:
        size = path.stat().st_size if path.is_file() else None
    except (OSError, ValueError):
        size = None
    if size is None:
        raise QuantityError(f"{quoted(str(path))}, no such file", A_FILE)
    if size > MOST_BYTES:
        raise QuantityError(f"{quoted(path.name)}, {size} bytes", f"at most {MOST_BYTES} bytes")
    columns = _hdf5(path) if path.suffix in (".h5", ".hdf5") else _csv(path)
    if "time" not in columns or len(columns) < 2:
        there = ", ".join(columns) or "none of them"
        raise QuantityError(f"{quoted(path.name)} with the columns {there}", A_FILE)
    return {name: (_in_si(path.name, name, *columns[name]), columns[name][1]) for name in columns}


def _in_si(file: str, name: str, values: list[float], unit: str) -> list[float]:
    try:
        factor = QUANTITIES[name].read(f"1 {unit}") if unit else 1.0
    except QuantityError as error:
        raise QuantityError(f"{quoted(file)}, column {name}: {error.found}", error.expected) from None
    for n, value in enumerate(values):
        if not math.isfinite(value):
            raise QuantityError(f"{quoted(file)}, column {name}, sample {n + 1}: {value}", "a finite number")
    return [factor * value if abs(factor * value) >= NOTHING else 0.0 for value in values]


def _hdf5(path: Path) -> dict[str, tuple[list[float], str]]:
    # Loaded only where such a file is read.
    from ..archive import ArchiveError
    from ..archive.columns import read_columns

    try:
        return read_columns(path, NAMES, MOST_LISTED)
    except ArchiveError as error:
        raise QuantityError(str(error), A_FILE) from None


def _csv(path: Path) -> dict[str, tuple[list[float], str]]:
    try:
        text = whole_file(path, MOST_BYTES).decode("utf-8-sig")
    except (OSError, UnicodeDecodeError):
        raise QuantityError(f"{quoted(path.name)}, no readable text", A_FILE) from None
    rows = _rows(path.name, text)
    if not rows:
        raise QuantityError(f"{quoted(path.name)}, an empty file", A_FILE)
    if len(rows) - 1 > MOST_LISTED:
        raise QuantityError(f"{quoted(path.name)}, {len(rows) - 1} samples", f"at most {MOST_LISTED}")
    (_, titles), *rows = rows
    for line, row in rows:
        # What a decimal comma makes of a number, where commas separate.
        if len(row) > len(titles) and any(cell.strip() for cell in row[len(titles) :]):
            found = f"{quoted(path.name)}, line {line}: {len(row)} cells below {len(titles)} names"
            raise QuantityError(found, "one cell below each name, and a decimal point")
    found = {}
    for place, title in enumerate(titles):
        read, begins = TITLE.fullmatch(title), BEGINNING.match(title)
        name = begins[1].lower() if begins else ""
        if name not in NAMES:
            continue
        if read is None:
            raise QuantityError(f"{quoted(path.name)}, a column {quoted(title)}", f'"{name}" or "{name} (unit)"')
        if name in found:
            raise QuantityError(f"{quoted(path.name)}, column {name} twice", "each column once")
        found[name] = [_number(path.name, name, line, row, place) for line, row in rows], read[2] or ""
    return found


def _rows(file: str, text: str) -> list[tuple[int, list[str]]]:
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
        raise QuantityError(f"{quoted(file)}, no CSV ({error})", A_FILE) from None


def _number(file: str, name: str, line: int, row: list[str], place: int) -> float:
    cell = row[place] if place < len(row) else ""
    if NUMBER.fullmatch(cell):
        return float(cell)
    held = quoted(cell) if place < len(row) else "nothing"
    expected = f"a {QUANTITIES[name].name} as a number"
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
