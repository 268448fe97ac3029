"""Tables before they are read: how deep, long and many what comes in may be, before anything in it is read or searched;
values set at dotted keys, and the commonest slip, a quantity whose number and unit stand without quotation marks.

Files, `--set`, the scenarios of archives, settings of studies and tables made in Python all pass `refuse_unbounded`;
behind it a text is one that a terminal can print, a key is a string, an integer one that Python prints, and whatever
goes down the tables comes to an end.
"""

import re
import tomllib
from collections.abc import Mapping
from dataclasses import fields, is_dataclass
from typing import Any

import numpy as np

from ..answers import toml_line
from ..scene.scene import ALTERNATIVES, SceneError
from ..units import quoted
from .errors import set_by

# Levels of tables and lists, characters of a key and of a string, entries in all (the samples of two motions and their
# like), and the largest integer.
DEEPEST, LONGEST_KEY, LONGEST_STRING, MOST_ENTRIES, LARGEST = 20, 200, 10_000, 2_000_000, 10**40
# Characters of a text, which may hold the samples of motions.
MOST_CHARACTERS = 1 << 26
# Dotted keys beyond any table, which a TOML parser goes through once for each of their parts, and digits in a row that
# no number has: some parsers take the square of their count.
PART = r"""(?:"(?:[^"\\\n]|\\.)*+"|'[^'\n]*+'|[^\s.=,#\[\]{}"']++)"""
DEEP_KEY = re.compile(rf"(?<![^\s.=,#\[\]{{}}])(?:{PART}[ \t]*+\.[ \t]*+){{{DEEPEST}}}")
LONG_NUMBER = re.compile(r"(?<!\d)\d{2000}")


def refuse_unreadable(text: str) -> None:
    """Raises SceneError for a text that would take a parser long."""
    if not isinstance(text, str):
        raise SceneError("", quoted(text), "text")
    if len(text) > MOST_CHARACTERS:
        raise SceneError("", f"{len(text)} characters", f"at most {MOST_CHARACTERS}")
    if surrogate := _surrogate(text):
        raise SceneError("", f"half a character ({surrogate})", "text in UTF-8")
    for pattern, what in ((DEEP_KEY, "tables too deep"), (LONG_NUMBER, "a number of thousands of digits")):
        if place := pattern.search(text):
            line = text.count("\n", 0, place.start()) + 1
            raise SceneError("", f"{what} (line {line})", "a scenario file (TOML)")


def refuse_unbounded(tree: Any, key: str = "") -> None:
    """Raises SceneError for tables that are deeper, longer or more than a scenario's, or hold keys that are no strings;
    `key` is the path to them."""
    left, entries = [(tree, key, 0)], 0
    while left:
        held, path, depth = left.pop()
        if isinstance(held, np.ndarray):
            held = held.tolist()
        if isinstance(held, dict | list | tuple):
            entries += len(held)
            if depth >= DEEPEST:
                raise SceneError(path, "tables too deep", "at most 3 levels")
            if entries > MOST_ENTRIES:
                raise SceneError(path, f"more than {MOST_ENTRIES} entries", "fewer")
        if isinstance(held, dict):
            for step, below in held.items():
                if not isinstance(step, str):
                    raise SceneError(path, f"the key {quoted(step)}", "a string as a key")
                if len(step) > LONGEST_KEY or _surrogate(step):
                    expected = f"a key of at most {LONGEST_KEY} characters, in UTF-8"
                    raise SceneError(path, f"the key {quoted(step)}", expected)
                left.append((below, f"{path}.{step}" if path else step, depth + 1))
        elif isinstance(held, list | tuple):
            # Numbers by the thousand are neither long nor deep.
            left += [(below, path, depth + 1) for below in held if not isinstance(below, float)]
        elif isinstance(held, str):
            if len(held) > LONGEST_STRING:
                raise SceneError(path, f"a string of {len(held)} characters", f"at most {LONGEST_STRING}")
            if surrogate := _surrogate(held):
                raise SceneError(path, f"half a character ({surrogate})", "text in UTF-8")
        elif isinstance(held, int) and abs(held) > LARGEST:
            raise SceneError(path, quoted(held, 40), f"a number of at most {LARGEST:.0e} in size")


def _surrogate(text: str) -> str:
    """The half of a character in a text, which no file can hold, as code; "" if there is none."""
    try:
        text.encode()
    except UnicodeEncodeError as error:
        return f"U+{ord(text[error.start]):04X}"
    return ""


# Characters of a line on which a quantity is looked for.
LONGEST_LINE = 300
PLACE = re.compile(r"\(at line (\d+), column (\d+)\)")
HEADER = re.compile(r"\s*\[+\s*([\w.\s-]+?)\s*\]+\s*(?:#.*)?")
KEY = re.compile(r"([\w.-]+)\s*=\s*(?![\s=])")
NUMBER = r"[+-]?(?:\d++(?:\.\d*+)?|\.\d++)(?:[eE][+-]?\d++)?"
QUANTITY = re.compile(rf"(?<![\w.])({NUMBER}\s*[^\W\d][^,\]}}#\"'=]*)")


def unquoted_quantity(text: str, error: str) -> tuple[str, str, str] | None:
    """Key (dotted), found and expected of the quantity without quotation marks on which the TOML parser stumbled over
    `text`, by its message `error`; None if it was something else."""
    if not (place := PLACE.search(error)):
        return None
    row, column = int(place[1]), int(place[2]) - 1
    lines = text.splitlines()[:row]
    line = lines[-1] if len(lines) == row else ""
    if len(line) > LONGEST_LINE:
        return None
    for quantity in QUANTITY.finditer(line):
        # The parser stops within it: at the unit, or at the number's first character.
        if quantity.start() <= column <= quantity.end():
            written = quantity[1].strip()
            found = f"{written} without quotation marks (line {row})"
            return _key(lines, quantity.start()), found, f'a quantity with its unit in quotation marks, "{written}"'
    return None


def _key(lines: list[str], column: int) -> str:
    """Dotted key of what stands at a column of the last of the lines."""
    before = [line for line in reversed(lines[:-1]) if len(line) <= LONGEST_LINE]
    table = next((match[1] for line in before if (match := HEADER.fullmatch(line))), "")
    for line in (lines[-1][:column], *before):
        if keys := [match for match in KEY.finditer(line)]:
            # Of an inline table, its own key first.
            inline = keys[:1] if "{" in line[: keys[-1].start()] else []
            parts = [table, *(match[1] for match in (*inline, keys[-1]))]
            return ".".join(dict.fromkeys(filter(None, parts)))
    return table


def key_and_words(override: str) -> tuple[str, str]:
    """Key and value, as it is written, of "key=value".  Raises SceneError."""
    refuse_unreadable(override)
    key, equals, written = (part.strip() for part in override.partition("="))
    refuse_unbounded(key.split("."))
    with set_by(override):
        if not key or not equals:
            raise SceneError("", "no key=value", 'for example rotor.runout="0.2 mrad"')
    return key, written


def set_value(raw: dict, key: str, value: Any) -> None:
    """Set one dotted key of a scenario's tables and take its alternatives away; tables that were read before are
    opened on the way to the key.  Raises SceneError where the way leads through none."""
    *path, last = key.split(".")
    place: Any = raw
    for step in path:
        place = _entry(place, step, key)
    if isinstance(place, list):
        _entry(place, last, key)
        place[int(last)] = value
        return
    for alternative in ALTERNATIVES.get(last, ()):
        place.pop(alternative, None)
    place[last] = value


def opened(table: Any) -> dict:
    """Keys and values of a table that was read, as a file would have them: no empty keys, lists for tuples."""
    held = {f.name: getattr(table, f.name) for f in fields(table)}
    return {k: list(v) if isinstance(v, tuple) else v for k, v in held.items() if v is not None and v != []}


def _entry(place: Any, step: str, key: str) -> Any:
    if isinstance(place, list):
        if not step.isdecimal():
            entry = key.replace(f".{step}", f".0.{step}", 1)
            count = f" to {entry.replace('.0.', f'.{len(place) - 1}.', 1)}" if len(place) > 1 else ""
            raise SceneError(key, f"a list of {len(place)} at {quoted(step)}", f"its entry too: {entry}{count}")
        if len(step) > 6 or int(step) >= len(place):
            raise SceneError(key, f"entry {quoted(step)}", f"0 to {len(place) - 1}: the file has {len(place)}")
        step = int(step)
        below = place[step]
    else:
        below = place.setdefault(step, {})
    if is_dataclass(below):
        below = opened(below)
    elif isinstance(below, (dict, list)):
        below = below.copy()
    else:
        raise SceneError(key, f"{quoted(below)} at {quoted(str(step))}", "a table there")
    # What was read is never changed: its copy is.
    place[step] = below
    return below


def without_arrays(value: Any) -> Any:
    """A value as a file could have it: plain numbers and lists for those of numpy, tables without keys of None."""
    if isinstance(value, np.generic | np.ndarray):
        return value.tolist()
    if isinstance(value, dict):
        return {key: without_arrays(held) for key, held in value.items() if held is not None}
    return [without_arrays(entry) for entry in value] if isinstance(value, list | tuple) else value


def value_of(written: str) -> Any:
    """What a string holds: TOML where it can be, else the string itself."""
    try:
        tree = tomllib.loads(f"value = {written}")
    except (ValueError, RecursionError):
        return written
    return tree["value"] if set(tree) == {"value"} else written


def overrides_of(values: Mapping[str, Any]) -> list[str]:
    """The overrides "key=value" that set values at dotted keys: strings as they stand, anything else (SI) written as
    TOML.  Raises SceneError for what no file can have."""
    refuse_unbounded(values)
    overrides = []
    for key, value in values.items():
        value = without_arrays(value)
        try:
            overrides.append(f"{key}={value if isinstance(value, str) else toml_line(as_written(value))}")
        except (TypeError, ValueError, RecursionError):
            expected = "a string, a number, a list or a table"
            raise SceneError(str(key), quoted(str(value)), expected) from None
    return overrides


def as_written(value: Any) -> Any:
    """What a file would have for a value: dicts for tables that were read, lists for tuples."""
    if is_dataclass(value):
        value = opened(value)
    if isinstance(value, dict):
        return {key: as_written(held) for key, held in value.items()}
    return [as_written(entry) for entry in value] if isinstance(value, list | tuple) else value
