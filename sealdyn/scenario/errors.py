"""What is wrong with a scenario, in one line (file, table, key, found, expected, nearest valid spelling); what each of
its tables may hold, in words; names of the design rules that it may acknowledge."""

import dataclasses
import math
import re
import types
import typing
from collections.abc import Iterable, Iterator
from contextlib import contextmanager
from typing import Any

from ..extensions import OUTSIDE
from ..scene.scene import SceneError
from ..unit_names import spelled_like
from ..units import (
    Density,
    ListedQuantity,
    Quantity,
    QuantityError,
    VaryingQuantity,
    Velocity,
    cut,
    printable,
    quoted,
)
from .keys import LENGTH, diameters, is_list, table_in, tables, without_indices

VELOCITY, DENSITY = (kind.__metadata__[0] for kind in (Velocity, Density))
KINEMATIC = Quantity("kinematic viscosity", "m^2/s", '"1 cSt"')
NOTHING = object()
MISSING = ("nothing", "no such table")
# Words of the trade that are no keys, and the keys that are meant, wherever the table has one.
MEANT = {
    "stiffness": ("axial_stiffness",), "spring_rate": ("axial_stiffness",), "damping": ("axial_damping",),
    "hardness": ("compressive_strength",), "friction": ("friction_coefficient", "friction_force"),
    "wear_coefficient": ("stator_wear_coefficient",), "waves": ("waviness",), "gap": ("clearance",),
    "film_thickness": ("clearance",), "inertia": ("transverse_inertia",), "rpm": ("speed",), "od": ("outer_diameter",),
    "id": ("inner_diameter",), "spring": ("spring_force",), "balance": ("balance_ratio",),
}  # fmt: skip
# A pure number as some write it.
PERCENT = re.compile(r"\s*([+-]?\d+(?:\.\d*)?)\s*(?:%|percent|per cent)\s*")
# What `nearest` says of a key of the same table.
NEAR = re.compile(r"nearest '(\w+)'(?:, by its keys)?$")
# Keys that stand in no table.
ABOVE_TABLES = ("schema",)
# Characters of what was expected: it may list names.
LONGEST = 600
# Of the keys that there are.
FEW_WORDS = 400
# Lines about one file.
MOST = 50


class ScenarioError(Exception):
    """A scenario that cannot be run; its text is one line.  `key` is dotted, table first.  `others`: what else is wrong
    with the same scenario, ScenarioErrors.

    >>> try:
    ...     sealdyn.run("fms.toml", {"film.clearence": 1e-5})
    ... except sealdyn.ScenarioError as error:
    ...     print(error.key, "--", error)
    film.clearence -- fms.toml: [film] clearence: found an unknown key; expected a key of [film]; nearest 'clearance'
    """

    others: "tuple[ScenarioError, ...]" = ()

    def __init__(self, name: str, key: str, found: str, expected: str):
        super().__init__(name, key, found, expected)
        self.name, self.key, self.found, self.expected = name, key, found, expected

    def __str__(self):
        table, _, last = self.key.rpartition(".")
        where = f"[{table}] {last}" if table else last if last in ABOVE_TABLES else f"[{last}]" if last else ""
        where = f"{cut(where)}: " if where else ""
        return printable(f"{cut(self.name)}: {where}found {cut(self.found)}; expected {cut(self.expected, LONGEST)}")


@contextmanager
def scene_errors_of(name: str) -> Iterator[None]:
    """What is wrong with a scene or its tables, raised as a ScenarioError of the scenario `name`."""
    try:
        yield
    except SceneError as error:
        name += "".join(getattr(error, "__notes__", ()))
        first, *rest = (ScenarioError(name, e.key, e.found, e.expected) for e in (error, *error.others))
        first.others = tuple(rest)
        raise first from None


@contextmanager
def set_by(override: str) -> Iterator[None]:
    """What is wrong with a value that was set is told with its override, behind the name of the scenario."""
    try:
        yield
    except SceneError as error:
        error.add_note(f" (--set {quoted(override)})")
        raise


def refuse(errors: Iterable[SceneError]) -> None:
    """Raises the first of the errors, if any, with the others in its `others`: one of each key, MOST in all."""
    kept: dict[str, SceneError] = {}
    for error in errors:
        kept.setdefault(error.key, error)
    if not kept:
        return
    first, *rest = kept.values()
    if len(rest) >= MOST:
        rest = [*rest[: MOST - 2], SceneError("", f"{len(rest) - MOST + 2} more", "those above corrected first")]
    first.others = tuple(rest)
    raise first


def expected_of(key: str, holds: Any) -> str:
    """What a key expects, in words."""
    for part in getattr(holds, "__metadata__", ()):
        if isinstance(part, Quantity | ListedQuantity):
            return part.expected()
        if isinstance(part, VaryingQuantity):
            return part.quantity.expected()
    words = [a for a in typing.get_args(holds) if a is not type(None)]
    if typing.get_origin(holds) is typing.Literal:
        return "one of " + ", ".join(f'"{w}"' for w in words)
    if is_list(holds):
        return f"tables [[{key}]] (double brackets) with the keys {', '.join(keys_in(words[0]))}"
    if dataclasses.is_dataclass(holds):
        return f"one table [{key}] with the keys {', '.join(keys_in(holds))}"
    if words and typing.get_origin(holds) in (typing.Union, types.UnionType):
        return " or ".join(expected_of(key, w) for w in words)
    if typing.get_origin(holds) is typing.Annotated:
        return expected_of(key, words[0])
    if typing.get_origin(holds) is list:
        return f"a list, each {expected_of(key, words[0])}"
    plain = {float: "a number", int: "a whole number", bool: "true or false", str: "a string"}
    return plain.get(holds, "a table" if typing.get_origin(holds) is dict else "something else")


def keys_in(kind: type) -> list[str]:
    """Keys of the table that a dataclass describes."""
    return [f.name for f in dataclasses.fields(kind)]


def nearest_of(word: Any, known: Iterable[str], cutoff: float = 0.6) -> str:
    """The end of a line that refuses a word: "; nearest 'clearance'" of those that are known, or nothing."""
    near = spelled_like(word, known, 1, cutoff)
    return f"; nearest '{near[0]}'" if near else ""


def nearest(kind: type, path: str, key: str) -> str:
    """Where an unknown key belongs: the table that has it, or the nearest spelling here, or elsewhere."""
    every = {table: keys | diameters(keys) for table, keys in tables(kind).items()}
    here = list(every.get(without_indices(path), {}))
    elsewhere = [f"[{table}]" for table, keys in every.items() if key in keys and table]
    top = [table for table in every if table and table.rpartition(".")[2] == key]
    if top:
        above, _, last = top[0].rpartition(".")
        return f"the table is [[{top[0]}]]" if is_list(every[above][last]) else f"the table is [{top[0]}]"
    if meant := [word for word in MEANT.get(key.lower(), ()) if word in here]:
        return f"nearest '{meant[0]}'"
    close = spelled_like(key, here)
    if elsewhere and not (close and close[0].startswith(key)):
        return f"'{key}' belongs to {' or '.join(elsewhere[:3])}"
    if close:
        return f"nearest '{close[0]}'"
    # Of two tables that have a key, the outer one.
    names = {k: table for table in sorted(filter(None, every), key=lambda t: -t.count(".")) for k in every[table]}
    if meant := [word for word in MEANT.get(key.lower(), ()) if word in names]:
        return f"nearest '{meant[0]}' in [{names[meant[0]]}]"
    close = spelled_like(key, names)
    if close:
        return f"nearest '{close[0]}' in [{names[close[0]]}]"
    return cut(f"the keys here are {', '.join(here)}", FEW_WORDS)


def explained(kind: type, raw: dict, errors: list[dict]) -> list[SceneError]:
    """SceneErrors of pydantic's errors, the most telling first: unknown keys, wrong values, missing keys, but not
    those missing that are there misspelt.  `kind` is the scenario's dataclass, `raw` its tables."""
    rank = {"unexpected_keyword_argument": 0, "missing": 2}
    relevant = [e for e in errors if not _beside_the_point(raw, e["loc"])] or errors
    # More than are told need no words.
    found = [_explained(kind, raw, e) for e in sorted(relevant, key=lambda e: rank.get(e["type"], 1))[: 4 * MOST]]
    meant = {key for error in found for key in _meant(error)}
    return [error for error in found if not (error.found in MISSING and error.key in meant)]


def _meant(error: SceneError) -> list[str]:
    """Dotted keys that an unknown key may have been meant for."""
    near = NEAR.search(error.expected) if error.found.startswith("an unknown") else None
    if not near:
        return []
    table, dot, _ = error.key.rpartition(".")
    return [table + dot + near[1], table + dot + near[1].replace("diameter", "radius")]


def _explained(kind: type, raw: dict, error: dict) -> SceneError:
    unknown = error["type"] == "unexpected_keyword_argument"
    path, holds, value = _follow(kind, raw, error["loc"], keep_last=unknown)
    key = ".".join(path)
    if unknown:
        return _unknown(kind, path, error["input"])
    if error["type"] == "missing" or value is NOTHING:
        found = MISSING[bool(table_in(holds))]
        return SceneError(key, found, expected_of(key, holds))
    cause = error.get("ctx", {}).get("error")
    if isinstance(cause, QuantityError):
        return SceneError(key, cause.found, cause.expected + _in_place(key, value, raw))
    expected = _expected_here(path, holds, error)
    words = [w for a in (holds, *typing.get_args(holds)) for w in typing.get_args(a) if isinstance(w, str)]
    hint = nearest_of(value, words)
    inside = [word for word in words if isinstance(value, str) and value and value.lower() in word]
    hint = hint or (f"; nearest '{inside[0]}'" if inside else "")
    if isinstance(value, str) and (percent := PERCENT.fullmatch(value)):
        expected += f", e.g. {float(percent[1]) / 100:.6g}"
    return SceneError(key, quoted(value), expected + hint)


def _in_place(key: str, value: Any, raw: dict) -> str:
    """What may be written in place of a `value` (as the file has it) of another dimension at a key; "" if nothing."""
    if key == "rotor.runout" and _si(LENGTH, value) is not None:
        return f', or a total indicator reading, "{value.strip()} TIR"'
    if key == "film.viscosity" and (kinematic := _si(KINEMATIC, value)) is not None:
        return f"; a kinematic one times the density: {_times_density(kinematic, value, raw.get('film'))}"
    film, velocity = raw.get("film"), _si(VELOCITY, value)
    if key not in ("shaft.speed", "stator.speed") or velocity is None or not isinstance(film, dict):
        return ""
    radii = [_si(LENGTH, film.get(f"{edge}_radius")) for edge in ("inner", "outer")]
    if None in radii or sum(radii) <= 0.0:
        return ""
    rpm = velocity / (0.5 * sum(radii)) * 30.0 / math.pi
    return f'; {quoted(value)} at the mean radius of the face is "{rpm:.6g} rpm"'


def _times_density(kinematic: float, value: str, film: Any) -> str:
    """What a kinematic viscosity (m^2/s) is with the film's density (kg/m^3), or that of water."""
    density = film.get("density") if isinstance(film, dict) else None
    told = density if isinstance(density, int | float) else _si(DENSITY, density)
    told = told if told and told > 0.0 else 1000.0
    return f'{quoted(value)} at {told:.6g} kg/m^3 is "{1e3 * told * kinematic:.6g} mPa*s"'


def _si(kind: Any, value: Any) -> float | None:
    """SI value of a string that is a quantity of this kind (or of a number, of a length); None of anything else."""
    if not isinstance(value, str) and kind is not LENGTH:
        return None
    try:
        return kind.read(value)
    except QuantityError:
        return None


def _expected_here(path: list[str], holds: Any, error: dict) -> str:
    key = without_indices(".".join(path))
    if path[-1].isdigit():
        return f"a table [[{key}]]"
    if error["type"] == "string_pattern_mismatch":
        return '"auto", "rest", "steady" or an archive "file.h5"'
    signs = {"gt": ">", "ge": ">=", "lt": "<", "le": "<="}
    limit = "".join(f" {signs[k]} {v:g}" for k, v in error.get("ctx", {}).items() if k in signs)
    return expected_of(key, holds) + limit


def _unknown(kind: type, path: list[str], value: Any) -> SceneError:
    table, key = ".".join(path[:-1]), path[-1]
    what, valid = ("an unknown key", f"a key of [{table}]") if table else ("an unknown table", "a known table")
    if isinstance(value, dict) and table in OUTSIDE:
        valid += f", or the name of one of the {OUTSIDE[table]} on SEALDYN_PATH, which this is not"
    near, like = nearest(kind, table, key), _table_like(kind, table, key, value)
    near = f"nearest {like}" if like and not near.startswith("the table") else near
    return SceneError(".".join([*path[:-1], quoted(key).strip('"')]), what, f"{valid}; {near}")


def _table_like(kind: type, path: str, key: str, raw: Any) -> str:
    """The table below a path that is spelled like one, or has most of its keys, more than half of them; "" if none."""
    keys = set(raw) if isinstance(raw, dict) else set()
    below = {table.rpartition("."): known | diameters(known) for table, known in tables(kind).items() if table}
    every = {last: known for (above, _, last), known in below.items() if above == without_indices(path)}
    if keys and (close := spelled_like(key, every)):
        return f"'{close[0]}'"
    best = max(every, key=lambda table: len(keys.intersection(every[table])), default="")
    return f"'{best}', by its keys" if best and 2 * len(keys.intersection(every[best])) > len(keys) else ""


def _beside_the_point(raw: dict, location: tuple) -> bool:
    """A key that holds a word or a table gets errors for both; the file's own kind is the one meant."""
    value = raw
    for step in location:
        if isinstance(step, str) and step.startswith("literal["):
            return isinstance(value, dict)
        try:
            value = value[step]
        except (KeyError, IndexError, TypeError):
            return isinstance(step, str) and step[:1].isupper() and not isinstance(value, dict)
    return False


def _follow(kind: type, raw: Any, location: tuple, keep_last: bool) -> tuple[list[str], Any, Any]:
    """Path of keys, what the last one holds and what the file has there; drops pydantic's names of types."""
    path, holds, value = [], kind, raw
    for n, step in enumerate(location):
        table = table_in(holds)
        keys = tables(table)[""] if table else {}
        if isinstance(step, int):
            holds = typing.get_args(holds)[0] if is_list(holds) else holds
            value = value[step] if isinstance(value, list) and step < len(value) else NOTHING
        elif step in keys:
            holds = keys[step]
            value = value.get(step, NOTHING) if isinstance(value, dict) else NOTHING
        elif not (keep_last and n == len(location) - 1):
            continue
        path.append(str(step))
    return path, holds, value


FACE_RULES = (
    "axial_travel", "balance", "choking", "coking", "face_pressure", "face_width", "film_stiffness", "film_thickness",
    "finish", "flatness", "gear_resonance", "hang_up", "heat", "leakage", "life", "lubricant_side", "misalignment",
    "pressure_velocity", "runout", "seal_temperature", "seal_type", "shaft_resonance", "sliding_speed",
)  # fmt: skip
LIP_RULES = ("lip_eccentricity", "lip_load", "lip_pressure", "lip_speed", "seal_type")
CIRCUMFERENTIAL_RULES = (
    "axial_load", "garter_load", "hang_up", "seal_type", "segment_pressure", "segment_runout", "segment_speed",
)  # fmt: skip


def unknown_rules(acknowledged, known: tuple[str, ...] = FACE_RULES) -> list[tuple[str, str, str]]:
    """What is wrong with the names of rules that are acknowledged, of the `known` ones: (key, found, expected)."""
    return [
        (f"acknowledge.{name}", "an unknown design rule",
         f"one of {', '.join(known)}{nearest_of(name, known, 0.0)}")
        for name in acknowledged
        if name not in known
    ]  # fmt: skip
