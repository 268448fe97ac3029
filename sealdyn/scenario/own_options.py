"""Options of films and loads from outside: their tables [film.NAME] and [stator.load.NAME] are read like all others.

The file of a film or a load may have a frozen dataclass `Options`, its fields annotated with types of units.py.  Where
a scenario names it, the dataclasses of its tables, from the file's down to that of `[film]` or of a load, have one more
field of that name.  Such a class knows the sources that were `found`: a process that has others, or none, has no use
for what was pickled of it.
"""

import contextlib
import dataclasses
import pickle
import typing
from functools import cache

from pydantic import TypeAdapter
from pydantic.errors import PydanticUserError

from ..extensions import OUTSIDE, OutsideError, digest, outside_module, outside_names
from ..films import own_film_names
from ..scene.film import Film
from ..scene.forces import Load
from ..scene.rings import Rotor, Stator
from ..scene.scene import SceneError
from .errors import expected_of, refuse
from .keys import table_in

ROOMS = {Film: "films", Load: "loads"}
# Keys of their tables; what a file of each room has.
KEYS = {room: {f.name for f in dataclasses.fields(kind)} for kind, room in ROOMS.items()}
HAS = {"films": ("FILM", "OFFER"), "loads": ("load",)}
# Those that scenes are made of, and are pickled.
KINDS = {kind.__name__: kind for kind in (Film, Load, Rotor, Stator)}


def all_outside() -> tuple[tuple[str, str], ...]:
    """All films and loads that there are outside and can be read: ("films/NAME", digest of its source)."""
    found = []
    for room in HAS:
        for word in sorted(outside_names(room) - {*own_film_names(), *KEYS[room]}):
            with contextlib.suppress(OutsideError):
                options_of(room, word)
                found.append((f"{room}/{word}", digest(room, word)))
    return tuple(found)


def with_options(kind: type, found: tuple[tuple[str, str], ...]) -> type:
    """The dataclass `kind` of a table where it, and the tables below it, have the options of what was `found` outside;
    itself where there are none.  Raises OutsideError."""
    rooms = _rooms_below(kind)
    return _widened(kind, tuple(pair for pair in found if pair[0].partition("/")[0] in rooms))


@cache
def _rooms_below(kind: type) -> frozenset[str]:
    below = [table for f in dataclasses.fields(kind) if (table := table_in(f.type))]
    return frozenset([ROOMS[kind]] if kind in ROOMS else []).union(*map(_rooms_below, below))


@cache
def _widened(kind: type, found: tuple[tuple[str, str], ...]) -> type:
    if not found:
        return kind
    changed = []
    for f in dataclasses.fields(kind):
        table = table_in(f.type)
        if table and (wider := with_options(table, found)) is not table:
            default = {
                key: held
                for key in ("default", "default_factory")
                if (held := getattr(f, key)) is not dataclasses.MISSING
            }
            changed.append((f.name, wider if f.type is table else wider | None, dataclasses.field(**default)))
    for room, name in (place.split("/") for place, _ in found if kind in ROOMS):
        if (options := options_of(room, name)) is not None:
            changed.append((name, options | None, dataclasses.field(default=None)))
    own = {"found": found, "__reduce__": _reduced, "__module__": __name__, "__doc__": kind.__doc__}
    made = dataclasses.make_dataclass(kind.__name__, changed, bases=(kind,), namespace=own, frozen=True)
    made.__module__ = __name__
    return made


class Missing:
    """What stands for a pickled table in a process that has other sources, or none: whoever asks it for anything is
    told so."""

    def __init__(self, error: OutsideError):
        self._error = error

    def __getattr__(self, name: str):
        raise self._error


def _remade(kind: str, found: tuple[tuple[str, str], ...], state: bytes):
    """A table that was pickled, or a Missing: an unpickling that raises ends the process of whoever waits for it."""
    for place, made in found:
        if (today := digest(*place.split("/"))) != made:
            there = "neither installed nor on SEALDYN_PATH" if today is None else f"of another source ({today})"
            return Missing(OutsideError(f"{place}, {there}", f"the source {made} in every process"))
    table = object.__new__(with_options(KINDS[kind], found))
    vars(table).update(pickle.loads(state))
    return table


def _reduced(table):
    return _remade, (type(table).__name__, type(table).found, pickle.dumps(vars(table)))


def options_of(room: str, name: str) -> type | None:
    """The `Options` of what comes from outside by this name, None of what has none.  Raises OutsideError."""
    kind = getattr(outside_module(room, name, *HAS[room]), "Options", None)
    if kind is None:
        return None
    if name in KEYS[room]:
        raise OutsideError(f'"{name}", with Options beside a key of that name', "a file of another name")
    if not dataclasses.is_dataclass(kind) or not kind.__dataclass_params__.frozen:
        raise OutsideError(f'"{name}", whose Options are no frozen dataclass', "@dataclass(frozen=True)")
    try:
        hints = typing.get_type_hints(kind, include_extras=True)
        for f in dataclasses.fields(kind):
            # Of a file whose annotations are text.
            f.type = hints[f.name]
        kind.__pydantic_config__ = {"extra": "forbid"}
        TypeAdapter(kind)
    except (NameError, TypeError, PydanticUserError) as error:
        raise OutsideError(
            f'"{name}", whose Options cannot be read ({error})', "fields annotated with types of sealdyn.units"
        ) from None
    return kind


def with_default_options(file):
    """The tables of a file with the default options of the models from outside that it names.  Raises SceneError for
    options that are needed and not given, and what their `errors()` find."""
    wrong = []
    for place, room in OUTSIDE.items():
        ring, _, load = place.rpartition(".")
        table = getattr(getattr(file, ring), load) if ring else file.film
        if table is None or type(table) in ROOMS or not digest(room, table.model or ""):
            continue
        if (kind := options_of(room, table.model)) is None:
            continue
        key, options = f"{place}.{table.model}", getattr(table, table.model)
        if options is None:
            try:
                options = kind()
            except TypeError:
                wrong.append(SceneError(key, "no such table", expected_of(key, kind)))
                continue
            table = dataclasses.replace(table, **{table.model: options})
            held = dataclasses.replace(getattr(file, ring), load=table) if ring else table
            file = dataclasses.replace(file, **{ring or "film": held})
        for below, found, expected in options.errors() if hasattr(options, "errors") else ():
            wrong.append(SceneError(f"{key}.{below}", found, expected))
    refuse(wrong)
    return file
