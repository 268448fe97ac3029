"""What a study asks of a scenario: its settings, and the same scenario with other values."""

import dataclasses
from typing import Any

from pydantic import TypeAdapter, ValidationError

from .scenario import Scenario, parse_scenario
from .scenario_errors import ScenarioError


def study_settings(scenario: Scenario, name: str, kind: type, flags: dict[str, Any]):
    """Settings of study `name` (underscored): defaults, overridden by `[study.NAME]`, overridden by flags.
    Raises ScenarioError for unknown keys or values, like any other table."""
    given = {**scenario.study.get(name, {}), **flags}
    known = [f.name for f in dataclasses.fields(kind)]
    raw = {key.replace("-", "_"): value for key, value in given.items()}
    for key in raw:
        if key not in known:
            import difflib

            near = difflib.get_close_matches(key, known, 1)
            hint = f"; nearest {near[0]}" if near else ""
            expected = f"one of {', '.join(known)}{hint}" if known else "no settings"
            raise ScenarioError(scenario.name, f"study.{name}.{key}", "an unknown key", expected)
    try:
        return TypeAdapter(kind).validate_python(raw)
    except ValidationError as error:
        first = error.errors(include_url=False)[0]
        key = ".".join(str(part) for part in first["loc"] if isinstance(part, str) and part in known)
        context = first.get("ctx", {}).get("error")
        found = getattr(context, "found", repr(first.get("input")))
        expected = getattr(context, "expected", first["msg"])
        raise ScenarioError(scenario.name, f"study.{name}.{key}", found, expected) from None


def varied(scenario: Scenario, values: dict[str, Any]) -> Scenario:
    """The scenario with other values at dotted keys (SI numbers or strings with units).  Raises ScenarioError."""
    more = [f"{key}={_written(value)}" for key, value in values.items()]
    return parse_scenario(scenario.text, scenario.name, [*scenario.overrides, *more], scenario.path)


def _written(value: Any) -> str:
    if isinstance(value, bool):
        return str(value).lower()
    return repr(float(value)) if isinstance(value, int | float) else str(value)
