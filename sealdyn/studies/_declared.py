"""What studies declare, in words and as a schema: their settings, what they ask, how long they take."""

import dataclasses
import json
from dataclasses import dataclass
from typing import Any

from ..scenario.errors import ScenarioError, nearest_of
from ..scenario.own_options import all_outside, with_options
from ..scenario.schema import json_schema, table_schema
from ..scenario.settings import study_settings
from ..scenario.tables import RadialFile, ScenarioFile
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
    return " ".join((study_module(name.replace("-", "_")).__doc__ or "").split("\n\n")[0].split())


def settings_of(name: str) -> list[Setting]:
    """The settings of study `name`."""
    kind = study_module(name.replace("-", "_")).Settings
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
    words, seconds = study_info(name.replace("-", "_")).timed
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
    return {name: study_info(name.replace("-", "_")).asks or about(name) for name in study_names()}


def schema(radial: bool = False) -> dict[str, Any]:
    """The JSON schema of scenario files of face seals (or of radial ones) with the settings of every study.

    >>> "film" in sealdyn.schema()["properties"]
    True
    """
    found = json_schema(RadialFile if radial else with_options(ScenarioFile, all_outside()))
    tables = {name.replace("-", "_"): _table(name) for name in study_names()}
    study = found["properties"]["study"]
    told = {"type": "object", "properties": tables, "additionalProperties": False}
    return {**found, "properties": {**found["properties"], "study": {"description": study["description"], **told}}}


def _table(name: str) -> dict:
    """The schema of the settings of a study, with what it is and how long it takes."""
    table = table_schema(study_module(name.replace("-", "_")).Settings)
    return {**table, "description": f"{about(name)}  {time_of(name)}.", "additionalProperties": False}
