"""What a study asks of a scenario: its settings, the values of a key it goes through, and the same scenario with
other values."""

import contextlib
import dataclasses
import json
import re
import typing
from collections.abc import Iterator
from types import UnionType
from typing import Any

import numpy as np
from pydantic import TypeAdapter, ValidationError

from ..scene import scene as scenes
from ..scene.checks import check_scene
from ..scene.scene import SceneError
from ..unit_names import dimension_and_factor, is_unit
from ..units import Quantity, quantity_of, quoted
from .errors import ScenarioError, nearest_of, scene_errors_of
from .overrides import refuse_unbounded
from .reader import Scenario
from .tables import refuse_extremes

NUMBER = re.compile(r"\s*([+-]?(?:\d++(?:\.\d*+)?|\.\d++)(?:[eE][+-]?\d+)?)\s*(.*?)\s*")
# Points of a grid, and any count that a study is given.
MOST = 1_000_000
# Units of temperature whose zero is no zero.
SCALES = {"degC", "degF"}
AXIS = '"key=from:to:count", "key=from:to:count:log" or "key=a,b,c"'


def study_settings(scenario: Scenario, name: str, kind: type, flags: dict[str, Any]):
    """Settings of study `name` (underscored): defaults, overridden by `[study.NAME]`, overridden by flags.
    A flag "a, b, c" of a setting that is a list is read as a list.  Raises ScenarioError for unknown keys or values,
    like any other table."""
    known, table = [f.name for f in dataclasses.fields(kind)], f"study.{name}"
    with scene_errors_of(scenario.name):
        refuse_unbounded(flags, table)
        raw = written_settings(scenario, name, kind, flags)
        for key in raw:
            if key not in known:
                expected = f"one of {', '.join(known)}{nearest_of(key, known)}" if known else "no settings"
                raise SceneError(f"{table}.{key}", "an unknown key", expected)
        try:
            settings = TypeAdapter(kind).validate_python(raw)
            refuse_extremes(settings, table, MOST)
            return settings
        except ValidationError as error:
            first = error.errors(include_url=False)[0]
            key = ".".join(str(part) for part in first["loc"] if isinstance(part, str) and part in known)
            context = first.get("ctx", {}).get("error")
            found = getattr(context, "found", repr(first.get("input")))
            raise SceneError(f"{table}.{key}", found, getattr(context, "expected", first["msg"])) from None
        except RecursionError:
            raise SceneError(table, "lists too deep", "values") from None


def written_settings(scenario: Scenario, name: str, kind: type, flags: dict[str, Any]) -> dict[str, Any]:
    """Settings of study `name` (underscored) as they were written, of the flags and of `[study.NAME]`."""
    tables = [table for study, table in scenario.study.items() if study.replace("-", "_") == name]
    written = {key.replace("-", "_"): value for table in tables for key, value in table.items()}
    return written | {key.replace("-", "_"): value for key, value in _listed(flags, kind).items()}


@dataclasses.dataclass(frozen=True)
class Words:
    """The quantity of numbers in words, which `values_in_si` reads: `Annotated[str, Words(SPEED)]`."""

    quantity: Quantity


# Settings of numbers that another setting names the key of, and which.
KEYED = {"values": ("over", "key"), "begin": ("key",), "end": ("key",), "judge": ("key",)}
LAW = re.compile(r"\s*\w+\((.*)\)\s*")


def bare_settings(written: dict[str, Any], kind: type) -> Iterator[tuple[str, str, Any, list[float]]]:
    """Numbers without a unit among the settings of a study as they were `written`: the setting, the dotted key that
    they are values of, or "" and the type of the setting, and the numbers.  What is no setting was refused before."""
    takes = typing.get_type_hints(kind, include_extras=True)
    for setting, value in written.items():
        entries, holds = value if isinstance(value, list | tuple) else [value], takes.get(setting)
        if quantity_of(holds):
            yield setting, "", holds, _bare(",".join(map(str, entries)))
            continue
        named = [written[key] for key in KEYED.get(setting, ()) if isinstance(written.get(key), str)]
        if named:
            yield setting, named[0], None, _bare(",".join(map(str, entries)))
        for words in entries if not named else []:
            key, equals, values = str(words).partition("=")
            if equals:
                yield setting, key.strip(), None, _bare(values)


def _bare(words: str) -> list[float]:
    """Numbers of "a, b", the ends of "a:b:count", the arguments of "normal(a, b)"; none if one of them has a unit."""
    words = law[1] if (law := LAW.fullmatch(words)) else words
    entries = words.split(":")[:2] if ":" in words else words.split(",")
    found = [NUMBER.fullmatch(entry) for entry in entries]
    return [float(match[1]) for match in found if match] if all(m and not m[2] for m in found) else []


def _listed(flags: dict[str, Any], kind: type) -> dict[str, Any]:
    """The flags, words and numbers given for lists split at commas; a setting that also takes words is left alone."""
    takes, out = typing.get_type_hints(kind), {}
    for key, value in flags.items():
        kinds = set(_alternatives(takes.get(key.replace("-", "_"))))
        if kinds & {tuple, list} and str not in kinds and isinstance(value, str | int | float):
            value = [_plain(entry.strip()) for entry in value.split(",")] if isinstance(value, str) else [value]
        out[key] = value
    return out


def _alternatives(annotation):
    """The kinds a setting may be of, lists without their contents."""
    origin, inner = typing.get_origin(annotation), typing.get_args(annotation)
    if origin in (typing.Union, UnionType):
        for kind in inner:
            yield from _alternatives(kind)
    elif origin is typing.Annotated:
        yield from _alternatives(inner[0])
    else:
        yield origin or annotation


def _plain(words: str):
    """A number where it is one, as a flag's single value would be."""
    with contextlib.suppress(ValueError, RecursionError):
        return json.loads(words)
    return words


def without(scenario: Scenario, what) -> tuple[Scenario, list[str]]:
    """The scenario without `what`, names of scenes.LEFT_OUT ("contact" leaves the film alone), and the names of the
    tables that were left out.  Raises ScenarioError for another name, and if no scene can be so."""
    for word in what:
        if word not in scenes.LEFT_OUT:
            raise ScenarioError(scenario.name, "--without", f'"{word}"', " or ".join(scenes.LEFT_OUT))
    names = scenes.tables_of(scenario.scene, what)
    if not names:
        return scenario, []
    scene = scenes.without(scenario.scene, what)
    with scene_errors_of(scenario.name):
        check_scene(scene, scenario.run)
    return dataclasses.replace(scenario, scene=scene, read=None), names


def axis(words: str, name: str, where: str) -> dict:
    """`{key, unit, given, values}` of "key=from:to:count[:log]" or "key=a,b,c": `given` strings as a scenario would
    have them, `values` the numbers in `unit` (or the words themselves, `unit` None).  A number without a unit takes
    that of its neighbours.  Raises ScenarioError that names scenario `name` and setting `where`."""
    key, equals, written = (part.strip() for part in words.partition("="))
    if not (key and equals and written):
        raise ScenarioError(name, where, repr(words), AXIS)
    parts = written.split(":")
    if len(parts) == 1:
        entries = [entry.strip() for entry in written.split(",")]
        matches = [NUMBER.fullmatch(entry) for entry in entries]
        if not all(matches) or not _alike(matches):
            return {"key": key, "unit": None, "given": entries, "values": entries}
        values, unit = _in_one_unit(matches)
    else:
        ends = [NUMBER.fullmatch(part) for part in parts[:2]]
        count, even_ratio = parts[2:3], parts[3:] == ["log"]
        if not all(ends) or not (count and count[0].strip().isdecimal()) or (parts[3:] and not even_ratio):
            raise ScenarioError(name, where, repr(words), AXIS)
        if not _alike(ends) and ends[0][2] != ends[1][2]:
            raise ScenarioError(name, where, repr(words), "ends in units of one kind")
        (low, high), unit = _in_one_unit(ends)
        if even_ratio and not low * high > 0:
            raise ScenarioError(name, where, repr(words), "ends of one sign, not zero, for log")
        if len(count[0]) > 20 or int(count[0]) > MOST:
            raise ScenarioError(name, where, f"{quoted(count[0].strip())} values", f"at most {MOST}")
        spread = np.geomspace if even_ratio else np.linspace
        # Twelve digits: 0.3 mrad is written so, not as 0.30000000000000004 mrad.
        values = [float(f"{v:.12g}") for v in spread(low, high, int(count[0]))]
    return {"key": key, "unit": unit, "given": [f"{v!r} {unit}".strip() for v in values], "values": values}


def si_unit(scene, key: str) -> str:
    """SI unit of the quantity at a dotted key of a scene, "SI" if it has none.  Raises AttributeError or KeyError for a
    key that there is not."""
    owner, _, name = key.rpartition(".")
    kind = typing.get_type_hints(type(scenes.part(scene, owner)), include_extras=True)[name]
    held = quantity_of(kind)
    return held.unit if held else "SI"


def with_own_unit(scene, axis: dict) -> dict:
    """An `axis` with the SI unit of its key as `si`, in which numbers without a unit are: "1" for pure numbers, "SI"
    where the scene does not hold the key."""
    try:
        unit = si_unit(scene, axis["key"])
    except (AttributeError, KeyError, IndexError, ValueError):
        return {**axis, "si": "SI"}
    return {**axis, "si": "1" if unit == "SI" else unit}


def must_be_number(scenario: Scenario, key: str, where: str) -> None:
    """Raises ScenarioError, that names the setting `where`, unless `key` is one of the scenario's scene that has a
    number."""
    try:
        si_unit(scenario.scene, key)
        odd = isinstance(scenes.part(scenario.scene, key), str | bool | tuple | list | dict)
    except (AttributeError, KeyError, IndexError, TypeError, ValueError):
        odd = True
    if odd or dataclasses.is_dataclass(scenes.part(scenario.scene, key)):
        hint = "" if key in scenario.given else nearest_of(key, scenario.given)
        raise ScenarioError(scenario.name, where, quoted(key), f"the key of a number of the scene{hint}")


def values_in_si(scenario: Scenario, words: str, unit: str, where: str) -> list[float]:
    """Numbers of "from:to:count[:log]" or "a, b, c" in SI, of a quantity with the SI unit `unit`; those without a unit
    are SI.  Raises ScenarioError that names the setting `where`."""
    given = axis(f"values={words}", scenario.name, where)
    written = given["unit"]
    if (
        written is None
        or written in SCALES
        or (written and not (is_unit(written) and is_unit(unit) and _one_kind(written, unit)))
    ):
        expected = f'numbers, "a, b, c" or "from:to:count[:log]", in {unit} or its like'
        raise ScenarioError(scenario.name, where, f'"{words}"', expected)
    factor = float(dimension_and_factor(written)[1]) if written else 1.0
    return [float(f"{factor * v:.12g}") for v in given["values"]]


def _alike(matches) -> bool:
    """Whether the units written are one, or convertible into each other: those that count from another zero are not."""
    units = {m[2] for m in matches if m[2]}
    if len(units) < 2:
        return True
    return not units & SCALES and all(map(is_unit, units)) and _one_kind(*units)


def _one_kind(*units) -> bool:
    return len({dimension_and_factor(unit)[0] for unit in units}) < 2


def _in_one_unit(matches) -> tuple[list[float], str]:
    """Numbers in the last unit written; those without a unit are in it already."""
    units = [m[2] for m in matches]
    unit = next((u for u in reversed(units) if u), "")

    def number(match):
        own = match[2]
        if own in ("", unit) or not (is_unit(own) and is_unit(unit)):
            return float(match[1])
        return float(match[1]) * float(dimension_and_factor(own)[1] / dimension_and_factor(unit)[1])

    return [number(m) for m in matches], unit
