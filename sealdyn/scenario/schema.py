"""The JSON schema of scenario files, with what every key means."""

import ast
import dataclasses
import inspect
import re
from collections.abc import Iterator
from itertools import pairwise
from typing import Any

from pydantic import TypeAdapter

from ..scene.film import Film
from .keys import diameters, table_in, tables
from .tables import ScenarioFile, film_choices


def json_schema(file: type = ScenarioFile) -> dict:
    """JSON schema (draft 2020-12) of a scenario file, for editors; `file` tables.RadialFile for those of radial seals.

    The first line of a key's description is its meaning (the docstring below it in its class), the next what is
    expected; `quantity` and `unit` name what it holds."""
    schema = _without_null(TypeAdapter(file).json_schema())
    for kind, table in {id(table): (kind, table) for kind, table in _tables(file, schema, schema["$defs"])}.values():
        keys = table["properties"]
        if issubclass(kind, Film):
            keys["model"]["enum"] = film_choices()
        for key, meaning in _meanings(kind).items():
            keys[key]["description"] = "\n".join([meaning, *filter(None, [keys[key].get("description")])])
        _add_diameters(table, kind)
    return {"$schema": "https://json-schema.org/draft/2020-12/schema", **schema, "title": "sealdyn scenario"}


def table_schema(kind: type) -> dict:
    """JSON schema of a table that is no part of a scene: keys with what they mean, what is expected, and defaults."""
    table = _without_null(TypeAdapter(kind).json_schema())
    for key, meaning in _meanings(kind).items():
        holds = table["properties"][key]
        holds["description"] = "\n".join([meaning, *filter(None, [holds.get("description")])])
    return table


def _add_diameters(table: dict, kind: type) -> None:
    """Beside each radius of a table's schema its diameter: one of the two, or at most one."""
    twins = {radius: diameter for diameter, radius in diameters(tables(kind)[""]).items()}
    properties = {}
    for key, holds in table["properties"].items():
        properties[key] = holds
        if key in twins:
            expected = holds["description"].splitlines()[-1]
            properties[twins[key]] = holds | {"description": f"In place of `{key}`: twice that.\n{expected}"}
    table["properties"] = properties
    either = {r: [{"required": [r]}, {"required": [d]}] for r, d in twins.items()}
    if not twins:
        return
    needed = table.get("required", [])
    both = {r: {"not": {"required": [r, d]}} for r, d in twins.items()}
    table["allOf"] = [{"oneOf": ways} if r in needed else both[r] for r, ways in either.items()]
    table["required"] = [key for key in needed if key not in twins]


def _tables(kind: type, table: dict, definitions: dict) -> Iterator[tuple[type, dict]]:
    """The dataclass of every table and its schema, `kind` and all below it; one that stands in several places often."""
    yield kind, table
    for f in dataclasses.fields(kind):
        if below := table_in(f.type):
            # Of several dataclasses of one name a definition has a longer one.
            place = re.search(r"#/\$defs/([^']+)", str(table["properties"][f.name]))
            yield from _tables(below, definitions[place[1]], definitions)


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
