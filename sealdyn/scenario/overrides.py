"""Overrides of a scenario's keys, "rotor.runout=0.2 mrad", before it is read."""

import tomllib
from typing import Any

from ..units import quoted
from .errors import ScenarioError

# Giving one of these with --set takes its alternatives in the file away.
ALTERNATIVES = {
    "turns": ("duration",),
    "duration": ("turns",),
    "samples": ("samples_per_turn",),
    "samples_per_turn": ("samples",),
    "displacement": ("acceleration",),
    "acceleration": ("displacement",),
    "radius": ("tilt_stiffness", "tilt_damping"),
    "tilt_stiffness": ("radius",),
    "tilt_damping": ("radius",),
}


def override_key(raw: dict, override: str, name: str) -> None:
    """Set one "key=value": the value is TOML where it can be, else a string."""
    key, equals, written = (part.strip() for part in override.partition("="))
    name = f"{name} (--set {quoted(override)})"
    if not key or not equals:
        raise ScenarioError(name, "", "no key=value", 'for example rotor.runout="0.2 mrad"')
    *path, last = key.split(".")
    place: Any = raw
    for step in path:
        place = _entry(place, step, key, name)
    if isinstance(place, list):
        _entry(place, last, key, name)
        place[int(last)] = _value(written)
        return
    for alternative in ALTERNATIVES.get(last, ()):
        place.pop(alternative, None)
    place[last] = _value(written)


def _entry(place: Any, step: str, key: str, name: str) -> Any:
    if isinstance(place, list):
        if not step.isdecimal() or len(step) > 6 or int(step) >= len(place):
            raise ScenarioError(name, key, f"entry {quoted(step)}", f"0 to {len(place) - 1}: the file has {len(place)}")
        below = place[int(step)]
    else:
        below = place.setdefault(step, {})
    if not isinstance(below, (dict, list)):
        raise ScenarioError(name, key, f"{quoted(below)} at {quoted(step)}", "a table there")
    return below


def _value(written: str) -> Any:
    try:
        tree = tomllib.loads(f"value = {written}")
    except (ValueError, RecursionError):
        return written
    return tree["value"] if set(tree) == {"value"} else written
