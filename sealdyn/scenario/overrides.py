"""Values set at dotted keys before a scenario is read: overrides "rotor.runout=0.2 mrad", and values of any kind."""

import tomllib
from dataclasses import fields, is_dataclass
from typing import Any

import numpy as np

from ..scene.variants import ALTERNATIVES
from ..toml_line import toml_line
from ..units import quoted
from .errors import ScenarioError


def override_key(raw: dict, override: str, name: str) -> None:
    """Set one "key=value" in the tables `raw` of the scenario `name`: the value is TOML where it can be, else a string.
    Raises ScenarioError."""
    key, written = key_and_words(override, name)
    set_value(raw, key, value_of(written), f"{name} (--set {quoted(override)})")


def key_and_words(override: str, name: str) -> tuple[str, str]:
    """Key and value, as it is written, of "key=value".  Raises ScenarioError, of the scenario `name`."""
    key, equals, written = (part.strip() for part in override.partition("="))
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
