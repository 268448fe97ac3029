"""A scenario file becomes a scene, and the same scenario with other values: TOML in, dataclasses out.  All input errors
end here, in one line each."""

import dataclasses
import os
import stat
import tomllib
from collections.abc import Iterable, Mapping, Set
from dataclasses import dataclass, field
from itertools import takewhile
from pathlib import Path
from types import ModuleType
from typing import Any, Self

from ..answers import toml_text
from ..extensions import OUTSIDE, OutsideError, digest, use
from ..films import own_film_names
from ..numerics.piecewise_linear import PiecewiseLinear
from ..scene import scene as scenes
from ..scene.application import Application, RadialApplication
from ..scene.checks import unused
from ..scene.radial import RadialScene
from ..scene.rings import INERTIAL, RING_NAMES
from ..scene.scene import Scene, SceneError
from ..unit_names import spelled_like
from ..units import is_gauge, quoted
from .errors import ScenarioError, scene_errors_of, set_by
from .keys import bare_keys, leaves
from .motion_files import PLACES, is_asked, part_at, quantities_of_files, table_at, whole_file, with_part
from .overrides import (
    as_written,
    key_and_words,
    opened,
    overrides_of,
    refuse_unbounded,
    refuse_unreadable,
    set_value,
    unquoted_quantity,
    value_of,
    without_arrays,
)
from .tables import Run, kind_of, kind_of_scene, read_tables

__all__ = [
    "Run",
    "Scenario",
    "ScenarioError",
    "parse_scenario",
    "read_scenario",
]
# Of a file.
MOST_BYTES = 1 << 21


@dataclass(frozen=True, repr=False)
class Scenario:
    """A scene with its run, and the file it came from.

    `text` and `overrides` say where the scene came from; they are not parsed again.  `study` {study: {setting: value}};
    `question` the comment at the head of the file; `given`: dotted keys of scene and run that the user wrote.
    `reading`: the runout as written where it is a total indicator reading, which follows the outer radius.  `bare`:
    keys, table.key, of numbers that were written without a unit; `gauge`: keys of the film's pressures that were
    written as gauge.  `foreign_start`: a file to start from that an archive names and nobody else, which is not opened.
    Scenarios that run alike are equal, wherever they came from, whatever studies are to ask of them, and whatever the
    seal is for (`application`, None without that table).

    >>> scenario = sealdyn.read_scenario("fms.toml").with_(rotor__runout="20 urad")
    >>> scenario.scene.rotor.runout, scenario == sealdyn.Scenario.from_dict(scenario.to_dict())
    (2e-05, True)
    """

    scene: Scene | RadialScene
    run: Run
    study: dict = field(default_factory=dict, compare=False)
    text: str = field(default="", compare=False)
    name: str = field(default="scene", compare=False)
    path: Path | None = field(default=None, compare=False)
    overrides: list[str] = field(default_factory=list, compare=False)
    question: str = field(default="", compare=False)
    given: frozenset[str] = frozenset()
    reading: Any = None
    bare: frozenset[str] = field(default=frozenset(), compare=False)
    application: Application | RadialApplication | None = field(default=None, compare=False)
    gauge: frozenset[str] = field(default=frozenset(), compare=False)
    foreign_start: str = field(default="", compare=False)
    # Scene and run that the text and the overrides say.
    read: tuple | None = field(default=None, compare=False, repr=False)

    def __post_init__(self) -> None:
        """An archive holds the text: another scene or run beside it is refused, but of what sets `read` to None."""
        now = self.scene, self.run
        if self.text and self.read not in (None, now):
            found = "a scene or run other than its text says"
            raise ScenarioError(self.name, "scene", found, 'with_({"film.clearance": "8 um"}), which changes both')
        object.__setattr__(self, "read", now)

    def __repr__(self) -> str:
        from ..report.in_python import shortened
        from ..report.text import question_of

        keys = [line for line in self.to_toml().splitlines() if line.strip() and not line.startswith("#")]
        return shortened([f"Scenario {self.name}: {' '.join(question_of(self.question).split())}", *keys])

    def _repr_html_(self) -> str:
        from ..report.in_python import keys_html

        return keys_html(self.to_dict(), f"{self.name}: {self.question}")

    def resolved(self) -> dict:
        """Nested SI values of every key, defaults included; only dicts, lists, numbers, strings, None."""
        tree = dataclasses.asdict(self.scene)
        for ring in (tree[name] for name in RING_NAMES if name in tree):
            if ring["load"] and ring["load"]["model"] is not None:
                # Its samples follow.
                ring["load"]["samples"] = None
        tree |= {"run": dataclasses.asdict(self.run), "study": self.study}
        if self.application is not None:
            tree["application"] = dataclasses.asdict(self.application)
        return _plain(tree)

    @classmethod
    def from_dict(cls, tables: dict[str, Any], name: str = "scene", question: str = "") -> Self:
        """Scenario of tables as a file has them, {"film": {"clearance": "10 um", ...}, ...}: quantities are strings
        with units or SI numbers.  `question` is put at the head of its text.  Raises ScenarioError."""
        with scene_errors_of(name):
            return parse_scenario(text_of(tables, question), name)

    def to_dict(self) -> dict[str, Any]:
        """Its tables as they were written, overrides in them: `Scenario.from_dict` makes an equal scenario of them."""
        with scene_errors_of(self.name):
            raw = _tables_of(self.text, self.overrides)
        columns, held = self.motions(), self.resolved()
        for key in (*columns, *quantities_of_files(raw, kind_of_scene(self.scene))):
            # Whole without the file, which is looked for from somewhere else then.
            raw = with_part(raw, key, columns.get(key, part_at(held, key)))
        return raw

    def to_toml(self) -> str:
        """Its text as a file has it; with overrides the tables are written anew, below the head of the file."""
        with scene_errors_of(self.name):
            files = any("file" in motion for motion in self.motions().values())
            anew = self.overrides or files or quantities_of_files(_tables_of(self.text), kind_of_scene(self.scene))
            return text_of(self.to_dict(), self.question) if anew else self.text

    def motions(self) -> dict[str, dict[str, Any]]:
        """Motions and loads by samples, of "shaft.motion" and the other PLACES: their columns (SI), and the name of
        their file if they came from one."""
        if isinstance(self.scene, RadialScene):
            return {}
        given = {}
        for key in PLACES:
            table = self.scene
            for step in key.split("."):
                # Samples of a load from outside are its own.
                table = getattr(table, step, None) if step != "samples" or not table or table.model is None else None
            if table is not None:
                given[key] = {k: v for k, v in _plain(dataclasses.asdict(table)).items() if v is not None}
        return given

    def with_(self, values: Mapping[str, Any] | None = None, /, **more: Any) -> Self:
        """The scenario with other values at dotted keys: `with_({"film.clearance": "5 um"})`, or with two underscores
        for each dot, `with_(film__clearance=5e-6)`.  Strings as the user writes them, SI numbers, tables.
        Raises ScenarioError."""
        return with_values(self, {**(values or {}), **{key.replace("__", "."): value for key, value in more.items()}})

    def with_film(self, source: str | os.PathLike[str] | ModuleType, **options: Any) -> Self:
        """The scenario with a film from outside and its options, those of `[film.NAME]`: its file `films/NAME.py`, or
        the module of one.  The folder above `films` is on SEALDYN_PATH from then on, here and in processes that are
        started from here.  Raises ScenarioError.

        >>> scenario = sealdyn.read_scenario("fms.toml").with_film("own/films/flat_springs.py", stiffness="2e7 N/m")
        >>> scenario.scene.film.model
        'flat_springs'
        """
        file = Path(getattr(source, "__file__", None) or str(source))
        try:
            name = use("films", file)
            if name in own_film_names():
                raise OutsideError(f"{file}, a name of the package's own", "another name")
        except OutsideError as error:
            raise ScenarioError(self.name, "film.model", error.found, error.expected) from None
        return self.with_({"film.model": name, **{f"film.{name}.{key}": value for key, value in options.items()}})

    def unused(self) -> list[str]:
        """Known keys, dotted, that the user gave and that this scene does not use."""
        return [] if isinstance(self.scene, RadialScene) else unused(self.scene, self.given)


def read_scenario(path: str | os.PathLike, overrides: Iterable[str] = ()) -> Scenario:
    """Scenario of a TOML file, or of the archive (.h5) of a run or study with its overrides; `overrides` are strings
    "rotor.runout=0.2 mrad".  Raises `ScenarioError`, ArchiveError.

    >>> sealdyn.read_scenario("fms.toml", ["film.clearance=8 um"]).scene.film.clearance
    8e-06
    """
    path = Path(path)
    if path.suffix == ".h5":
        return _of_archive(path, overrides)
    try:
        _must_be_readable(path)
        text = whole_file(path, MOST_BYTES).decode("utf-8-sig")
    except FileNotFoundError:
        near = spelled_like(path.name, _neighbours(path), 3, 0.5)
        hint = f"; nearest {', '.join(near)}" if near else ""
        raise ScenarioError(str(path), "", "no such file", "a scenario file (TOML)" + hint) from None
    except IsADirectoryError:
        raise ScenarioError(str(path), "", "a folder", "a scenario file (TOML)") from None
    except UnicodeDecodeError as error:
        raise ScenarioError(path.name, "", f"no UTF-8 text (byte {error.start})", "a scenario file (TOML)") from None
    except (OSError, ValueError) as error:
        why = getattr(error, "strerror", None) or str(error)
        raise ScenarioError(quoted(str(path)), "", f"an unreadable file ({why})", "a scenario file (TOML)") from None
    return parse_scenario(text, path.name, overrides, path)


def _of_archive(path: Path, overrides: Iterable[str]) -> Scenario:
    overrides = list(overrides)
    # Whoever reads text does not wait for HDF5.
    from ..archive import is_study, read_info, read_study

    info = (read_study if is_study(path) else read_info)(path)
    given = [*map(str, info.get("overrides", [])), *overrides]
    held = info.get("resolved")
    name = str(info.get("name", path.stem))
    held = held if isinstance(held, dict) else {}
    with scene_errors_of(name):
        asked = {key_and_words(override)[0] for override in overrides}
        _same_outside(info.get("outside"), held, asked)
    scenario = parse_scenario(str(info["scenario"]), name, given, held=held, asked=asked)
    foreign = scenario.run.start.endswith(".h5") and not asked & {"run", "run.start"}
    return dataclasses.replace(scenario, foreign_start=scenario.run.start if foreign else "")


def _same_outside(made_with: Any, held: dict, asked: Set[str]) -> None:
    """Raises SceneError where what an archive was made with comes from outside and is gone, or is another; `held`
    are its resolved tables, of keys that the user has `asked` for others are meant."""
    for place, made in made_with.items() if isinstance(made_with, dict) else ():
        room, _, called = str(place).partition("/")
        for table in (table for table, held_in in OUTSIDE.items() if held_in == room):
            key, what = f"{table}.model", room.removesuffix("s")
            if is_asked(key, asked) or table_at(held, table).get("model") != called:
                continue
            if (today := digest(room, called)) == made:
                continue
            found = f'"{called}", of another source ({today}) than the archive\'s ({made})'
            expected = f"the {what} that the archive was made with, or --set {key}={called}, where today's is meant"
            if today is None:
                found = f'"{called}", which is neither installed nor on SEALDYN_PATH'
                expected = f"the {what} that the archive was made with (source {made})"
            raise SceneError(key, found, expected)


def _must_be_readable(path):
    """Raises ScenarioError for what has no end, or would take long."""
    found = path.stat()
    if not stat.S_ISREG(found.st_mode) and not path.is_dir():
        raise ScenarioError(quoted(str(path)), "", "a pipe or a device", "a scenario file (TOML)")
    if found.st_size > MOST_BYTES:
        few = f"a scenario file (TOML) of at most {MOST_BYTES} bytes"
        raise ScenarioError(quoted(str(path)), "", f"{found.st_size} bytes", few)


def parse_scenario(
    text: str, name: str, overrides=(), path: Path | None = None, held: dict | None = None, asked=frozenset()
) -> Scenario:
    """Scenario of TOML text; `name` is what errors call it.  Files that it names are looked for beside `path`, or are
    `held`: the resolved tables of an archive, whose words open no others; keys that the user has `asked` for may.
    Raises `ScenarioError`."""
    with scene_errors_of(name):
        raw = _tables_of(text, overrides)
        refuse_unbounded(raw)
        found = read_tables(raw, folder=path and path.parent, held=held, asked=asked)
    gauge = frozenset(f"film.{key}" for key, value in table_at(raw, "film").items() if is_gauge(value))
    found |= {"text": text, "question": _question(text), "overrides": list(overrides), "gauge": gauge}
    return Scenario(**found, name=name.removesuffix(".toml"), path=path)


def text_of(tables: dict[str, Any], question: str = "") -> str:
    """The TOML text of a scenario's tables, with the question as the comment at its head.  Raises SceneError."""
    refuse_unbounded(tables)
    try:
        written = toml_text(without_arrays(tables))
    except (TypeError, ValueError, AttributeError, RecursionError) as error:
        found = f"what TOML cannot hold ({' '.join(str(error).split())[:200] or type(error).__name__})"
        raise SceneError("", found, "tables of strings, numbers and lists") from None
    return "".join(f"# {line}".rstrip() + "\n" for line in question.splitlines()) + written


def _neighbours(path: Path) -> list[str]:
    try:
        return [p.name for p in path.parent.iterdir() if p.suffix in (".toml", ".h5")]
    except OSError:
        return []


def _tables_of(text: str, overrides: Iterable[str] = ()) -> dict:
    """The tables of a scenario's text with its overrides set.  Raises SceneError."""
    refuse_unreadable(text)
    try:
        raw = tomllib.loads(text)
    except tomllib.TOMLDecodeError as error:
        if bare := unquoted_quantity(text, str(error)):
            raise SceneError(*bare) from None
        raise SceneError("", f"no TOML: {error}", 'lines like clearance = "10 um" under [film]') from None
    except (ValueError, RecursionError):
        raise SceneError("", "numbers too long or tables too deep", "a scenario file (TOML)") from None
    if not raw:
        raise SceneError("", "an empty file", "the tables [shaft], [film], [rotor], [stator]")
    for override in overrides:
        key, written = key_and_words(override)
        with set_by(override):
            set_value(raw, key, value_of(written))
    return raw


def _question(text: str) -> str:
    """The comment block at the head of the file."""
    lines = takewhile(lambda line: line.startswith("#"), text.lstrip("\ufeff").splitlines())
    return "\n".join(line.lstrip("#").strip() for line in lines)


def _plain(value: Any) -> Any:
    if isinstance(value, PiecewiseLinear):
        return {"time": list(value.time), "value": list(value.value)}
    if isinstance(value, dict):
        return {str(k): _plain(v) for k, v in value.items()}
    if isinstance(value, (list, tuple)):
        return [_plain(v) for v in value]
    return value if value is None or isinstance(value, (bool, int, float, str)) else str(value)


def with_values(scenario: Scenario, values: Mapping[str, Any]) -> Scenario:
    """The scenario with other values at dotted keys, read and checked like a file's; its text is not read again.

    `values`: SI numbers, strings as the user writes them ("0.2 mrad", "steady", TOML), `PiecewiseLinear`, tables.
    Raises ScenarioError.
    """
    with scene_errors_of(scenario.name):
        overrides = overrides_of(values)
        tables, given = _opened_tables(scenario, values), set(scenario.given)
        for (key, value), override in zip(values.items(), overrides, strict=True):
            value = value_of(value) if isinstance(value, str) else without_arrays(value)
            with set_by(override):
                set_value(tables, key, value)
                kind = kind_of(tables)
            table, _, last = key.rpartition(".")
            gone = {key, *(f"{table}.{other}" for other in scenes.ALTERNATIVES.get(last, ()))}
            given = {k for k in given if k not in gone and not k.startswith(f"{key}.")}
            given.update(k for k, _ in leaves({key: as_written(value)}, kind))
        told = {key: value_of(value) for key, value in values.items() if isinstance(value, str)}
        bare = [key for key in scenario.bare if key not in told]
        bare += [key for step, value in told.items() for key in bare_keys(value, step)]
        found = read_tables(tables, given, bare, scenario.path and scenario.path.parent)
    start = "" if {"run", "run.start"} & set(values) else scenario.foreign_start
    return dataclasses.replace(
        scenario, **found, overrides=[*scenario.overrides, *overrides], foreign_start=start, read=None
    )


def _opened_tables(scenario: Scenario, values: Mapping[str, Any]) -> dict[str, Any]:
    """The tables of a scenario that was read, as a file would have them, without what follows from other keys where
    `values` are set."""
    tables = {name: opened(table) for name, table in opened(scenario.scene).items()}
    tables |= {"run": opened(scenario.run), "study": scenario.study}
    tables |= {"application": opened(scenario.application)} if scenario.application is not None else {}
    for ring in (ring for ring in RING_NAMES if ring in tables):
        if body := tables[ring].pop("body", None):
            # A body's mass follows it; where a mass or an inertia is, or was, set, the others stay and the body goes.
            own = dict(zip(INERTIAL, body.inertia(), strict=True))
            if not any(f"{ring}.{key}" in values or tables[ring][key] != own[key] for key in INERTIAL):
                tables[ring] = {key: held for key, held in tables[ring].items() if key not in INERTIAL} | {"body": body}
        if load := tables[ring].get("load"):
            made = ("samples",) if load.model is not None else ()
            tables[ring]["load"] = {key: held for key, held in opened(load).items() if key not in made}
    if scenario.reading is not None:
        tables["rotor"]["runout"] = scenario.reading
    return tables


def scenario_of(source: Scenario | str | os.PathLike, overrides: Mapping[str, Any] | Iterable[str] = ()) -> Scenario:
    """The scenario itself or that of a file (TOML, or an archive), with `overrides`: {dotted key: value}, or strings
    "key=value".  Raises ScenarioError, ArchiveError."""
    if isinstance(overrides, Mapping):
        if isinstance(source, Scenario):
            return with_values(source, overrides) if overrides else source
        with scene_errors_of(str(source)):
            overrides = overrides_of(overrides)
    overrides = [overrides] if isinstance(overrides, str) else list(overrides)
    if not isinstance(source, Scenario):
        return read_scenario(source, overrides)
    with scene_errors_of(source.name):
        pairs = [key_and_words(override) for override in overrides]
    # One after the other: a key may come twice.
    for key, written in pairs:
        source = with_values(source, {key: written})
    return source
