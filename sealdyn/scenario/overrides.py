"""Tables before they are read: values set at dotted keys, diameters in place of radii, the version of the keys, and the
commonest slip, a quantity whose number and unit stand without quotation marks."""

import dataclasses
import re
import tomllib
from dataclasses import fields, is_dataclass
from functools import lru_cache
from typing import Any

import numpy as np

from .. import __version__
from ..answers import toml_line
from ..scene.scene import ALTERNATIVES
from ..units import Length, QuantityError, quoted
from .errors import ScenarioError, diameters, refuse_unbounded, refuse_unreadable, table_in, tables, without_indices

# Raised when a key is renamed, goes, or means something else; new keys alone do not raise it.
SCHEMA = 1


def refuse_newer(raw: dict, name: str) -> None:
    """Raises ScenarioError for the tables of a scenario whose `schema` is above SCHEMA: what else is unknown in it is
    not wrong, only newer."""
    found = raw.get("schema")
    if isinstance(found, int) and found > SCHEMA:
        expected = f"at most {SCHEMA}, all that sealdyn {__version__} reads: install a newer sealdyn for this file"
        raise ScenarioError(name, "schema", quoted(found), expected)


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


LENGTH = Length.__metadata__[0]


@lru_cache(4096)
def _radii(kind: type, table: str = "") -> dict[str, str]:
    """{key of a diameter: that of its radius} of a table, by its dotted path, of the dataclass `kind`."""
    return diameters(tables(kind).get(table, {}))


def radius_key(kind: type, key: str) -> str:
    """The dotted key of the radius, if `key` is that of its diameter; else `key`.  `kind`: the scenario's dataclass."""
    table, _, last = key.rpartition(".")
    twin = _radii(kind, without_indices(table)).get(last)
    return f"{table}.{twin}" if twin else key


def with_radii(tree: Any, kind: type, name: str, wrong: list, path: str = "") -> tuple[Any, dict[str, str]]:
    """The tables `tree` of the dataclass `kind` with every diameter halved under the key of its radius, and which were:
    {dotted key of the radius: key of the diameter}.  To `wrong` are appended ScenarioErrors, of the scenario `name`,
    for diameters beside their radius and for those that are no length, which are then any."""
    halved = {}
    if isinstance(tree, list):
        entries = [with_radii(entry, kind, name, wrong, f"{path}.{n}") for n, entry in enumerate(tree)]
        return [entry for entry, _ in entries], {key: twin for _, found in entries for key, twin in found.items()}
    if not isinstance(tree, dict):
        return tree, halved
    keys, tree = {f.name: f.type for f in dataclasses.fields(kind)}, tree.copy()
    for key in tree:
        if inner := table_in(keys.get(key)):
            tree[key], below = with_radii(tree[key], inner, name, wrong, f"{path}.{key}".strip("."))
            halved |= below
    for diameter, radius in _radii(kind).items():
        if diameter in tree:
            try:
                tree[radius] = _half(tree, diameter, radius, f"{path}.{diameter}", name)
            except ScenarioError as error:
                wrong.append(error)
                tree[radius] = 1.0
            del tree[diameter]
            halved[f"{path}.{radius}"] = diameter
    return tree, halved


def _half(table: dict, diameter: str, radius: str, key: str, name: str) -> float:
    if radius in table:
        raise ScenarioError(name, key, f"{diameter} and {radius}", "one of the two")
    try:
        return LENGTH.read(table[diameter]) / 2
    except QuantityError as error:
        raise ScenarioError(name, key, error.found, error.expected) from None


def override_key(raw: dict, override: str, name: str) -> None:
    """Set one "key=value" in the tables `raw` of the scenario `name`: the value is TOML where it can be, else a string.
    Raises ScenarioError."""
    key, written = key_and_words(override, name)
    set_value(raw, key, value_of(written), f"{name} (--set {quoted(override)})")


def key_and_words(override: str, name: str) -> tuple[str, str]:
    """Key and value, as it is written, of "key=value".  Raises ScenarioError, of the scenario `name`."""
    refuse_unreadable(override, name)
    key, equals, written = (part.strip() for part in override.partition("="))
    refuse_unbounded(key.split("."), name)
    if not key or not equals:
        name = f"{name} (--set {quoted(override)})"
        raise ScenarioError(name, "", "no key=value", 'for example rotor.runout="0.2 mrad"')
    return key, written


def set_value(raw: dict, key: str, value: Any, name: str) -> None:
    """Set one dotted key of a scenario's tables and take its alternatives away; tables that were read before are
    opened on the way to the key.  Raises ScenarioError, of the scenario `name`, where the way leads through none."""
    *path, last = key.split(".")
    place: Any = raw
    for step in path:
        place = _entry(place, step, key, name)
    if isinstance(place, list):
        _entry(place, last, key, name)
        place[int(last)] = value
        return
    for alternative in ALTERNATIVES.get(last, ()):
        place.pop(alternative, None)
    place[last] = value


def opened(table: Any) -> dict:
    """Keys and values of a table that was read, as a file would have them: no empty keys, lists for tuples."""
    held = {f.name: getattr(table, f.name) for f in fields(table)}
    return {k: list(v) if isinstance(v, tuple) else v for k, v in held.items() if v is not None and v != []}


def _entry(place: Any, step: str, key: str, name: str) -> Any:
    if isinstance(place, list):
        if not step.isdecimal():
            entry = key.replace(f".{step}", f".0.{step}", 1)
            count = f" to {entry.replace('.0.', f'.{len(place) - 1}.', 1)}" if len(place) > 1 else ""
            raise ScenarioError(
                name, key, f"a list of {len(place)} at {quoted(step)}", f"its entry too: {entry}{count}"
            )
        if len(step) > 6 or int(step) >= len(place):
            raise ScenarioError(name, key, f"entry {quoted(step)}", f"0 to {len(place) - 1}: the file has {len(place)}")
        step = int(step)
        below = place[step]
    else:
        below = place.setdefault(step, {})
    if is_dataclass(below):
        below = opened(below)
    elif isinstance(below, (dict, list)):
        below = below.copy()
    else:
        raise ScenarioError(name, key, f"{quoted(below)} at {quoted(str(step))}", "a table there")
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


def override_of(key: str, value: Any) -> str:
    """The override "key=value" that sets a value: a string as it stands, anything else (SI) written as TOML."""
    if isinstance(value, str):
        return f"{key}={value}"
    return f"{key}={toml_line(as_written(value))}"


def as_written(value: Any) -> Any:
    """What a file would have for a value: dicts for tables that were read, lists for tuples."""
    if is_dataclass(value):
        value = opened(value)
    if isinstance(value, dict):
        return {key: as_written(held) for key, held in value.items()}
    return [as_written(entry) for entry in value] if isinstance(value, list | tuple) else value
