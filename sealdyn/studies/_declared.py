"""What may be written and asked, for people and editors: the JSON schema of scenario files with what every key means,
and of each study its settings, what it asks, and how long it takes."""

import ast
import dataclasses
import inspect
import json
import re
from collections.abc import Iterator
from dataclasses import dataclass
from itertools import pairwise
from typing import Any

from pydantic import TypeAdapter

from ..scenario.errors import ScenarioError, nearest_of
from ..scenario.keys import diameters, table_in, tables
from ..scenario.own_options import all_outside, with_options
from ..scenario.settings import study_settings
from ..scenario.tables import RadialFile, ScenarioFile, film_choices
from ..scene.film import Film
from . import study_names
from ._runner import setting_warnings, study_info, study_module


@dataclass(frozen=True)
class Setting:
    """A setting of a study: its key, what it holds with the SI unit, its default as one types it ("" if there is none),
    and what it means."""

    key: str
    holds: str
    default: str
    meaning: str


def about(name: str) -> str:
    """What study `name` (hyphens or underscores) is, in a line."""
    return " ".join((study_module(name).__doc__ or "").split("\n\n")[0].split())


def settings_of(name: str) -> list[Setting]:
    """The settings of study `name`."""
    kind = study_module(name).Settings
    table = table_schema(kind)
    rows = []
    for one in dataclasses.fields(kind):
        holds = table["properties"][one.name]
        default = "" if one.default in (None, (), "") else typed(one.default)
        rows.append(Setting(one.name, words_of(holds), default, holds["description"].splitlines()[0]))
    return rows


def refuse_unknown_studies(scenario) -> None:
    """Raises ScenarioError for a table [study.NAME] of a study that there is not."""
    names = study_names()
    for name in scenario.study:
        if name.replace("_", "-") not in names:
            expected = f"one of {', '.join(names)}{nearest_of(name.replace('_', '-'), names)}"
            raise ScenarioError(scenario.name, f"study.{name}", "an unknown study", expected)


def refuse_settings(scenario) -> list[str]:
    """What is odd in the tables [study.NAME], in sentences.  Raises ScenarioError for what its study does not take."""
    said = []
    for name in scenario.study:
        study = name.replace("-", "_")
        study_settings(scenario, study, study_module(study).Settings, {})
        said += setting_warnings(scenario, study, {})
    return said


def help_text(name: str) -> str:
    """What study `name` is, its settings and its time; of no study which there are."""
    if name.replace("_", "-") not in study_names():
        return "\n\n".join(f"{known}: {about(known)}" for known in study_names())
    lines = [
        f"--{s.key.replace('_', '-')} ({s.holds}{f'; default {s.default}' if s.default else ''}): {s.meaning}"
        for s in settings_of(name)
    ]
    return "\n\n".join([about(name), *lines, f"Time: {time_of(name)}."])


def time_of(name: str) -> str:
    """How long study `name` takes, in words."""
    words, seconds = study_info(name).timed
    return f"{seconds} s of processor time on one core with `{words}` and no other settings"


def words_of(holds: dict) -> str:
    """What a value of a JSON schema is, in words: "time, s", "integer", "list of number or string"."""
    if "quantity" in holds:
        several = "list of " if holds.get("type") == "array" else ""
        return f"{several}{holds['quantity']}, {holds['unit']}"
    if "enum" in holds:
        return ", ".join(json.dumps(word) for word in holds["enum"])
    if "anyOf" in holds:
        return " or ".join(dict.fromkeys(map(words_of, holds["anyOf"])))
    if holds.get("type") == "array":
        return f"list of {words_of(holds.get('items', {}))}"
    return {"boolean": "true or false"}.get(holds.get("type"), holds.get("type", "value"))


def typed(value) -> str:
    """A value as one types it."""
    return f"{value:g}" if isinstance(value, float) else json.dumps(value)


def list_studies() -> dict[str, str]:
    """The studies there are, and what each asks.

    >>> sealdyn.list_studies()["critical-speed"]
    'Where does the seal start to whirl, and what becomes of it?'
    """
    return {name: study_info(name).asks or about(name) for name in study_names()}


def schema(radial: bool = False) -> dict[str, Any]:
    """The JSON schema of scenario files of face seals (or of radial ones) with the settings of every study.

    >>> "film" in sealdyn.schema()["properties"]
    True
    """
    found = json_schema(RadialFile if radial else with_options(ScenarioFile, all_outside()))
    asked = {name.replace("-", "_"): _table(name) for name in study_names()}
    study = found["properties"]["study"]
    told = {"type": "object", "properties": asked, "additionalProperties": False}
    return {**found, "properties": {**found["properties"], "study": {"description": study["description"], **told}}}


def _table(name: str) -> dict:
    """The schema of the settings of a study, with what it is and how long it takes."""
    table = table_schema(study_module(name).Settings)
    return {**table, "description": f"{about(name)}  {time_of(name)}.", "additionalProperties": False}


# --- the schema of a file ---------------------------------------------------------------------------------


def json_schema(file: type = ScenarioFile) -> dict:
    """JSON schema (draft 2020-12) of a scenario file, for editors; `file` tables.RadialFile for those of radial seals.

    The first line of a key's description is its meaning (the docstring below it in its class), the next what is
    expected; `quantity` and `unit` name what it holds."""
    schema = _without_null(TypeAdapter(file).json_schema())
    for kind, table in {
        id(table): (kind, table) for kind, table in _tables_below(file, schema, schema["$defs"])
    }.values():
        if issubclass(kind, Film):
            table["properties"]["model"]["enum"] = film_choices()
        _add_meanings(table, kind)
        _add_diameters(table, kind)
    return {"$schema": "https://json-schema.org/draft/2020-12/schema", **schema, "title": "sealdyn scenario"}


def table_schema(kind: type) -> dict:
    """JSON schema of a table that is no part of a scene: keys with what they mean, what is expected, and defaults."""
    table = _without_null(TypeAdapter(kind).json_schema())
    _add_meanings(table, kind)
    return table


def _add_meanings(table: dict, kind: type) -> None:
    """Before what is expected of each key of a table's schema, what it means."""
    for key, meaning in _meanings(kind).items():
        holds = table["properties"][key]
        holds["description"] = "\n".join([meaning, *filter(None, [holds.get("description")])])


def _add_diameters(table: dict, kind: type) -> None:
    """Beside each radius of a table's schema its diameter: one of the two, or at most one."""
    twins = {radius: diameter for diameter, radius in diameters(tables(kind)[""]).items()}
    if not twins:
        return
    properties = {}
    for key, holds in table["properties"].items():
        properties[key] = holds
        if key in twins:
            expected = holds["description"].splitlines()[-1]
            properties[twins[key]] = holds | {"description": f"In place of `{key}`: twice that.\n{expected}"}
    table["properties"] = properties
    needed = table.get("required", [])
    table["allOf"] = [
        {"oneOf": [{"required": [r]}, {"required": [d]}]} if r in needed else {"not": {"required": [r, d]}}
        for r, d in twins.items()
    ]
    table["required"] = [key for key in needed if key not in twins]


def _tables_below(kind: type, table: dict, definitions: dict) -> Iterator[tuple[type, dict]]:
    """The dataclass of every table and its schema, `kind` and all below it; one that stands in several places often."""
    yield kind, table
    for f in dataclasses.fields(kind):
        if below := table_in(f.type):
            # Of several dataclasses of one name a definition has a longer one.
            place = re.search(r"#/\$defs/([^']+)", str(table["properties"][f.name]))
            yield from _tables_below(below, definitions[place[1]], definitions)


def _meanings(kind: type) -> dict[str, str]:
    """Docstring below each field of a dataclass; of the inherited ones too."""
    found = {}
    for part in filter(dataclasses.is_dataclass, reversed(kind.__mro__)):
        if "found" in vars(part):
            # Widened by the options of what comes from outside.
            continue
        for key, text in pairwise(ast.parse(inspect.getsource(part)).body[0].body):
            if isinstance(key, ast.AnnAssign) and isinstance(text, ast.Expr):
                found[key.target.id] = re.sub(r"\s*\n\s*", " ", text.value.value)
    return found


def _without_null(schema: Any) -> Any:
    """TOML has no null: an absent key is absent."""
    if isinstance(schema, list):
        return [_without_null(s) for s in schema if s != {"type": "null"}]
    if not isinstance(schema, dict):
        return schema
    kept = {k: _without_null(v) for k, v in schema.items() if (k, v) != ("default", None)}
    only = kept.get("anyOf", [])
    return {k: v for k, v in kept.items() if k != "anyOf"} | only[0] if len(only) == 1 else kept
