"""A scenario file becomes a scene: TOML in, dataclasses out.  All input errors end here, in one line each."""

import dataclasses
import difflib
import math
import os
import re
import stat
import tomllib
from collections.abc import Iterable, Iterator, Mapping
from dataclasses import dataclass, field
from functools import cache
from pathlib import Path
from typing import Annotated, Any, Literal, Self

from pydantic import Field, TypeAdapter, ValidationError

from ..films import all_film_names, film_of
from ..numerics.piecewise_linear import PiecewiseLinear
from ..scene.application import Application, RadialApplication, application_errors
from ..scene.checks import scene_errors, unused
from ..scene.excitation import Motion
from ..scene.radial import RADIAL, RadialScene, radial_errors
from ..scene.rings import INERTIAL, RING_NAMES, with_inertia
from ..scene.scene import Scene, SceneError
from ..toml_line import toml_text
from ..units import Length, QuantityError, Time, is_gauge, quoted
from .errors import (
    CIRCUMFERENTIAL_RULES,
    LIP_RULES,
    ScenarioError,
    explained,
    tables,
    together,
    unknown_rules,
    without_indices,
)
from .motion_files import with_columns
from .overrides import SCHEMA, override_key, radius_key, refuse_newer, unquoted_quantity, with_radii, without_arrays

__all__ = [
    "Run",
    "Scenario",
    "ScenarioError",
    "parse_scenario",
    "read_scenario",
]


# Numbers in SI units beyond which nothing of this world is.
SMALLEST, LARGEST = 1e-25, 1e15
# Of a file.
MOST_BYTES = 1 << 21
STARTS = r"^(auto|rest|steady|.+\.h5)$"
# What no number of a run hangs on.
BESIDE_THE_RUN = ("study", "application", "schema")


@dataclass(frozen=True)
class Run:
    """The `[run]` table: how long, how often sampled, how exact, by which method, from which start.

    `turns` of the shaft (default 60) or `duration` (s); `samples_per_turn` (default 64; of a shaft at rest: 1000 in
    all) or `samples` in all.  `start` "auto": on the linear steady response where that is stable and leaves the film
    open; at rest with `[initial]`, and, unless the faces would overlap there, with contact, a secondary seal, a film
    with unknowns of its own, or tables.
    """

    __pydantic_config__ = {"extra": "forbid"}  # noqa: RUF012

    turns: Annotated[float, Field(gt=0)] | None = None
    """Of the shaft (60 without `duration`)."""
    duration: Time | None = None
    """In place of `turns`."""
    samples_per_turn: Annotated[int, Field(gt=0)] | None = None
    """Of the archive (64 without `samples`; 1000 in all if the shaft stands)."""
    samples: Annotated[int, Field(gt=0)] | None = None
    """In all, in place of `samples_per_turn`."""
    accuracy: Annotated[float, Field(gt=1e-13, le=1e-1)] = 1e-6
    """Asked error of displacements, relative to clearance, and of tilts, to clearance / outer radius."""
    solver: Literal["auto", "adams", "bdf", "ida", "dop853", "radau", "expm", "trbdf2"] = "auto"
    """Method; "auto" chooses by stiffness and inertia."""
    start: Annotated[str, Field(pattern=STARTS)] = "auto"
    """Untilted ("rest"), linear steady response ("steady"), end of an archive; "auto": steady if stable, else rest."""


@dataclass(frozen=True)
class ScenarioFile(Scene):
    """A scenario file: the scene, how to run it, what the seal is for, and settings of studies (each study knows its
    own)."""

    __pydantic_config__ = {"extra": "forbid"}  # noqa: RUF012

    run: Run = field(default_factory=Run)
    """How long, how exact, by which method."""
    application: Application | None = None
    """What the seal is asked to do: for design rules, no number of a run hangs on it."""
    study: dict[str, dict[str, Any]] = field(default_factory=dict)
    """Settings of studies, one table [study.NAME] each."""
    schema: Annotated[int, Field(ge=1, le=SCHEMA)] = SCHEMA
    """Version of these keys; without it the present one."""


@dataclass(frozen=True)
class RadialFile(RadialScene):
    """A scenario file of a radial seal."""

    __pydantic_config__ = {"extra": "forbid"}  # noqa: RUF012

    schema: Annotated[int, Field(ge=1, le=SCHEMA)] = SCHEMA
    """Version of these keys; without it the present one."""
    run: Run = field(default_factory=Run)
    """How long, how exact, by which method."""
    application: RadialApplication | None = None
    """Which rules it breaks on purpose."""
    study: dict[str, dict[str, Any]] = field(default_factory=dict)
    """Settings of studies, one table [study.NAME] each."""


@dataclass(frozen=True)
class Scenario:
    """A scene with its run, and the file it came from.

    `text` and `overrides` say where the scene came from; they are not parsed again.  `study` {study: {setting: value}};
    `question` the comment at the head of the file; `given`: dotted keys of scene and run that the user wrote.
    `reading`: the runout as written where it is a total indicator reading, which follows the outer radius.  `bare`:
    keys, table.key, of numbers that were written without a unit; `gauge`: keys of the film's pressures that were
    written as gauge.
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

    def resolved(self) -> dict:
        """Nested SI values of every key, defaults included; only dicts, lists, numbers, strings, None."""
        tree = dataclasses.asdict(self.scene) | {"run": dataclasses.asdict(self.run), "study": self.study}
        if self.application is not None:
            tree["application"] = dataclasses.asdict(self.application)
        return _plain(tree)

    @classmethod
    def from_dict(cls, tables: dict[str, Any], name: str = "scene", question: str = "") -> Self:
        """Scenario of tables as a file has them, {"film": {"clearance": "10 um", ...}, ...}: quantities are strings
        with units or SI numbers.  `question` is put at the head of its text.  Raises ScenarioError."""
        return parse_scenario(text_of(tables, name, question), name)

    def to_dict(self) -> dict[str, Any]:
        """Its tables as they were written, overrides in them: `Scenario.from_dict` makes an equal scenario of them."""
        raw = _toml(self.text, self.name)
        for override in self.overrides:
            override_key(raw, override, self.name)
        for table, motion in self.motions().items():
            # Whole without the file, which is looked for from somewhere else then.
            raw[table]["motion"] = motion
        return raw

    def to_toml(self) -> str:
        """Its text as a file has it; with overrides the tables are written anew, below the head of the file."""
        anew = self.overrides or any("file" in motion for motion in self.motions().values())
        return text_of(self.to_dict(), self.name, self.question) if anew else self.text

    def motions(self) -> dict[str, dict[str, Any]]:
        """Motions by samples, of "shaft" and "housing": their columns (SI), and the name of their file if they came
        from one."""
        if isinstance(self.scene, RadialScene):
            return {}
        tables = {"shaft": self.scene.shaft, "housing": self.scene.housing}
        given = {name: _plain(dataclasses.asdict(table.motion)) for name, table in tables.items() if table.motion}
        return {name: {k: v for k, v in motion.items() if v is not None} for name, motion in given.items()}

    def with_(self, values: Mapping[str, Any] | None = None, /, **more: Any) -> Self:
        """The scenario with other values at dotted keys: `with_({"film.clearance": "5 um"})`, or with two underscores
        for each dot, `with_(film__clearance=5e-6)`.  Strings as the user writes them, SI numbers, tables.
        Raises ScenarioError."""
        from .settings import with_values

        return with_values(self, {**(values or {}), **{key.replace("__", "."): value for key, value in more.items()}})

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
        text = path.read_bytes().decode("utf-8-sig")
    except FileNotFoundError:
        near = difflib.get_close_matches(path.name, _neighbours(path), 3, 0.5)
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
    # Whoever reads text does not wait for HDF5.
    from ..archive import is_study, read_info, read_study

    info = (read_study if is_study(path) else read_info)(path)
    given = [*map(str, info.get("overrides", [])), *overrides]
    held = info.get("resolved")
    name = str(info.get("name", path.stem))
    return parse_scenario(str(info["scenario"]), name, given, held=held if isinstance(held, dict) else None)


def _must_be_readable(path):
    """Raises ScenarioError for what has no end, or would take long."""
    found = path.stat()
    if not stat.S_ISREG(found.st_mode) and not path.is_dir():
        raise ScenarioError(quoted(str(path)), "", "a pipe or a device", "a scenario file (TOML)")
    if found.st_size > MOST_BYTES:
        few = f"a scenario file (TOML) of at most {MOST_BYTES} bytes"
        raise ScenarioError(quoted(str(path)), "", f"{found.st_size} bytes", few)


def parse_scenario(text: str, name: str, overrides=(), path: Path | None = None, held: dict | None = None) -> Scenario:
    """Scenario of TOML text; `name` is what errors call it.  Files that it names are looked for beside `path`, or are
    `held`: the resolved tables of an archive.  Raises `ScenarioError`."""
    raw = _toml(text, name)
    for override in overrides:
        override_key(raw, override, name)
    bare = frozenset(_bare_keys(raw))
    gauge = frozenset(f"film.{key}" for key, value in _table(raw, "film").items() if is_gauge(value))
    found = read_tables(raw, name, folder=path and path.parent, held=held)
    name = name.removesuffix(".toml")
    return Scenario(
        **found, bare=bare, gauge=gauge, text=text, name=name, path=path, overrides=list(overrides),
        question=_question(text),
    )  # fmt: skip


def read_tables(
    raw: dict, name: str, given: frozenset[str] | None = None, folder: Path | None = None, held: dict | None = None
) -> dict[str, Any]:
    """What a Scenario holds (`scene`, `run`, `application`, `study`, `given`, `reading`) of tables whose values are
    written as in a file, or were read before.  `given`: dotted keys that the user wrote, all of the tables' unless
    told, without those on which no run hangs; `folder` and `held` as of motion_files.py.
    Raises `ScenarioError`."""
    refuse_newer(raw, name)
    kind = RadialFile if any(table in raw for table in RADIAL) else ScenarioFile
    wrong = [*_odd_numbers(raw, name, kind=kind)]
    raw, halved = with_radii(raw, kind, name, wrong)
    given = given_keys(raw, kind=kind) if given is None else (radius_key(kind, key) for key in given)
    given = frozenset(key for key in given if key.partition(".")[0] not in BESIDE_THE_RUN)
    raw = with_columns(raw, name, folder, held or {}, wrong)
    reading = _total_indicator_reading(raw)
    _tilt_of_tir(raw)
    wrong += [*_run_and_study(raw, name)]
    try:
        file = _reader(kind).validate_python(raw)
    except ValidationError as error:
        wrong += explained(name, kind, raw, error.errors(include_url=False))
    if kind is RadialFile:
        return {**_radial(file if not wrong else None, wrong, name), "given": given}
    if not wrong:
        # Powers of the numbers are taken from here on.
        refuse_extremes(file, name)
        wrong += _bodies(file, raw, name)
    if wrong:
        # What the values are together is asked where each can be.
        raise together(wrong)
    file = dataclasses.replace(file, rotor=with_inertia(file.rotor), stator=with_inertia(file.stator))
    refuse_extremes(file, name)
    if impossible := _impossible(file):
        halves = [f"{e.found}, half of {halved[e.key]}" if e.key in halved else e.found for e in impossible]
        found = zip(impossible, halves, strict=True)
        raise together([ScenarioError(name, e.key, words, e.expected) for e, words in found])
    if "run.samples_per_turn" in given and not _turns(file.shaft.speed):
        raise ScenarioError(name, "run.samples_per_turn", "a shaft at rest", "[run] samples, the number in all")
    scene = Scene(**{f.name: getattr(file, f.name) for f in dataclasses.fields(Scene)})
    parts = {"run": file.run, "application": file.application, "study": file.study}
    return {"scene": scene, **parts, "given": given, "reading": reading}


def _radial(file: RadialFile | None, wrong: list[ScenarioError], name: str) -> dict[str, Any]:
    """What a Scenario of a radial seal holds; raises what is `wrong` with it."""
    if wrong:
        raise together(wrong)
    refuse_extremes(file, name)
    wrong = [ScenarioError(name, key, found, expected) for key, found, expected in radial_errors(file)]
    if file.run.start not in ("auto", "steady"):
        wrong.append(
            ScenarioError(name, "run.start", quoted(file.run.start), '"auto": a radial seal begins on the shaft')
        )
    if file.run.solver in ("ida", "expm", "trbdf2"):
        found = quoted(file.run.solver)
        wrong.append(
            ScenarioError(name, "run.solver", found, 'of a radial seal "auto", "dop853", "radau", "adams" or "bdf"')
        )
    if not wrong and file.run.turns is not None and not _turns(file.shaft.speed):
        wrong.append(ScenarioError(name, "run.turns", "a shaft at rest", "[run] duration and samples"))
    if file.application is not None:
        unknown = unknown_rules(file.application.acknowledge, LIP_RULES if file.lip else CIRCUMFERENTIAL_RULES)
        wrong += [ScenarioError(name, f"application.{key}", found, expected) for key, found, expected in unknown]
    if wrong:
        raise together(wrong)
    scene = RadialScene(**{f.name: getattr(file, f.name) for f in dataclasses.fields(RadialScene)})
    return {"scene": scene, "run": file.run, "application": file.application, "study": file.study}


def text_of(tables: dict[str, Any], name: str, question: str = "") -> str:
    """The TOML text of a scenario's tables, with the question as the comment at its head.  Raises ScenarioError."""
    try:
        written = toml_text(without_arrays(tables))
    except (TypeError, ValueError, AttributeError, RecursionError) as error:
        found = f"what TOML cannot hold ({' '.join(str(error).split())[:200] or type(error).__name__})"
        raise ScenarioError(name, "", found, "tables of strings, numbers and lists") from None
    return "".join(f"# {line}".rstrip() + "\n" for line in question.splitlines()) + written


def _impossible(file: ScenarioFile) -> list[SceneError]:
    """What no scene can have together, and, where there is nothing of that kind, what its film does not take."""
    bad = []
    try:
        _check_film_name(file.film.model)
    except SceneError as error:
        bad.append(error)
    bad += scene_errors(file, file.run)
    if file.application is not None:
        wrong = application_errors(file.application) + unknown_rules(file.application.acknowledge)
        bad += [SceneError(f"application.{key}", found, expected) for key, found, expected in wrong]
    try:
        _ = bad or film_of(file)
    except SceneError as error:
        bad.append(error)
    return bad


def film_choices() -> list[str]:
    """What `film.model` takes."""
    return ["auto", *all_film_names()]


def _check_film_name(name: str) -> None:
    if name not in film_choices():
        near = [choice for choice in film_choices() if name and choice.startswith(f"{name}_")]
        near = near or difflib.get_close_matches(name, film_choices(), 1)
        expected = "one of " + ", ".join(f'"{m}"' for m in film_choices())
        hint = "; nearest " + " and ".join(f"'{choice}'" for choice in near) if near else ""
        raise SceneError("film.model", f'"{name[:40]}"', expected + hint)


@cache
def _reader(kind: type) -> TypeAdapter:
    return TypeAdapter(kind)


def _neighbours(path: Path) -> list[str]:
    try:
        return [p.name for p in path.parent.iterdir() if p.suffix in (".toml", ".h5")]
    except OSError:
        return []


def _toml(text: str, name: str) -> dict:
    try:
        raw = tomllib.loads(text)
    except tomllib.TOMLDecodeError as error:
        if bare := unquoted_quantity(text, str(error)):
            raise ScenarioError(name, *bare) from None
        raise ScenarioError(name, "", f"no TOML: {error}", 'lines like clearance = "10 um" under [film]') from None
    except (ValueError, RecursionError):
        raise ScenarioError(name, "", "numbers too long or tables too deep", "a scenario file (TOML)") from None
    if not raw:
        raise ScenarioError(name, "", "an empty file", "the tables [shaft], [film], [rotor], [stator]")
    return raw


def _odd_numbers(
    tree: Any, name: str, key: str = "", depth: int = 0, kind: type = ScenarioFile
) -> Iterator[ScenarioError]:
    """Not a number, infinite, and true or false for a number; a study may hold what it likes."""
    if depth > 20:
        raise ScenarioError(name, "", "tables too deep", "at most 3 levels")
    below = tree.items() if isinstance(tree, dict) else enumerate(tree) if isinstance(tree, list) else ()
    for step, value in below:
        path = f"{key}.{step}" if key else str(step)
        if path not in ("study", "application.acknowledge"):
            yield from _odd_numbers(value, name, path, depth + 1, kind)
    if isinstance(tree, float) and not math.isfinite(tree):
        yield ScenarioError(name, key, str(tree), "a finite number")
    if isinstance(tree, bool) and key:
        table, _, last = without_indices(key).rpartition(".")
        if tables(kind).get(table, {}).get(last) is not bool:
            yield ScenarioError(name, key, quoted(tree), "a number or a string with a unit")


def refuse_extremes(value: Any, name: str, key: str = "", counted: float = LARGEST) -> None:
    """Not a number, infinite, and numbers so large or small that products of a few of them are (in SI); whole numbers
    are at most `counted`.  Raises ScenarioError that names the key below `key`."""
    if isinstance(value, Motion):
        # Of thousands of samples one may cross zero anywhere.
        below = [(k, max(map(abs, held))) for k, held in vars(value).items() if isinstance(held, tuple) and held]
    elif dataclasses.is_dataclass(value):
        below = [(f.name, getattr(value, f.name)) for f in dataclasses.fields(value) if f.name != "study"]
    else:
        below = enumerate(value) if isinstance(value, (list, tuple)) else ()
    for step, part in below:
        # Of a table, its columns.
        refuse_extremes(part, name, key if isinstance(step, int) else f"{key}.{step}" if key else step, counted)
    if isinstance(value, int) and abs(value) > counted:
        raise ScenarioError(name, key, quoted(value), f"at most {counted:g}")
    if isinstance(value, int | float) and value != 0 and not SMALLEST <= abs(value) <= LARGEST:
        found = f"{value:.3g}" if isinstance(value, float) else quoted(value)
        raise ScenarioError(name, key, f"{found} (SI)", f"0, or a number from {SMALLEST:g} to {LARGEST:g} in size")


def given_keys(tree: dict, key: str = "", kind: type = ScenarioFile) -> list[str]:
    """Dotted keys of a scenario's tables (`tree`), down to what is no table; `key` is the path to the tree."""
    found = []
    for step, value in tree.items() if isinstance(tree, dict) else enumerate(tree):
        path = f"{key}.{step}" if key else str(step)
        is_table = without_indices(path) in tables(kind) and isinstance(value, (dict, list))
        found += given_keys(value, path, kind) if is_table and path != "study" else [path]
    return found


def _total_indicator_reading(raw: dict) -> Any:
    """`rotor.runout` as written where any of it is a total indicator reading, "20 um TIR"; else None."""
    runout = _table(raw, "rotor").get("runout")
    return runout if any(map(_reading, _entries(runout))) else None


def _tilt_of_tir(raw: dict) -> None:
    """`runout = "20 um TIR"`, the total indicator reading at the outer radius, becomes TIR / (2 r_o)."""
    rotor, outer = _table(raw, "rotor"), _table(raw, "film").get("outer_radius")
    runout = rotor.get("runout")
    tilts = [_tilt(entry, outer) for entry in _entries(runout)]
    if tilts and "runout" in rotor:
        rotor["runout"] = {**runout, "value": tilts} if isinstance(runout, dict) else tilts[0]


def _entries(runout: Any) -> list:
    entries = runout.get("value") if isinstance(runout, dict) else [runout]
    return entries if isinstance(entries, list) else []


def _reading(entry: Any) -> re.Match | None:
    return re.fullmatch(r"(.*\S)\s*\bTIR\s*", entry) if isinstance(entry, str) else None


def _tilt(entry: Any, outer_radius: Any) -> Any:
    """The tilt (rad) of a total indicator reading; anything else as it is."""
    reading, length = _reading(entry), Length.__metadata__[0]
    try:
        return length.read(reading[1]) / (2 * length.read(outer_radius)) if reading else entry
    except (QuantityError, ZeroDivisionError):
        # The reader of the tables says what is wrong with either.
        return entry


def _table(raw: dict, key: str) -> dict:
    """A table of the file, empty if it is none (the reader says so)."""
    return raw[key] if isinstance(raw.get(key), dict) else {}


def _bodies(file: ScenarioFile, raw: dict, name: str) -> Iterator[ScenarioError]:
    """A ring has a mass, or a body that gives it, or both as `sealdyn check` prints them."""
    for ring in (key for key in RING_NAMES if getattr(file, key).body):
        own, by_body = getattr(file, ring), with_inertia(getattr(file, ring))
        for key in INERTIAL:
            value, follows = getattr(own, key), getattr(by_body, key)
            if key in _table(raw, ring) and not math.isclose(value, follows, rel_tol=1e-9):
                expected = f"nothing, or what follows from the body, {follows:g}"
                yield ScenarioError(name, f"{ring}.{key}", f"{value:g} beside [{ring}.body]", expected)


def _run_and_study(raw: dict, name: str) -> Iterator[ScenarioError]:
    """What depends on several keys: how long and how often, and that studies are tables."""
    for study, settings in _table(raw, "study").items():
        if not isinstance(settings, dict):
            yield ScenarioError(name, f"study.{study}", quoted(settings), "a table [study.NAME] of a study's settings")
    raw.setdefault("run", {})
    run = _table(raw, "run")
    for one, other in (("turns", "duration"), ("samples_per_turn", "samples")):
        if one in run and other in run:
            yield ScenarioError(name, f"run.{one}", f"{one} and {other}", "one of the two")
    if "duration" not in run:
        run.setdefault("turns", 60)
    if "samples" not in run:
        run.setdefault("samples_per_turn", 64)


def _bare_keys(tables: dict, of: str = "") -> Iterator[str]:
    """Dotted keys of numbers without a unit."""
    for key, value in tables.items():
        if of and _is_bare(value):
            yield f"{of}{key}"
        if isinstance(value, dict):
            yield from _bare_keys(value, f"{of}{key}.")


def _is_bare(value: Any) -> bool:
    """Whether a value other than 0, or any of a table's, is written without a unit."""
    return any(isinstance(entry, int | float) and entry != 0 for entry in _entries(value))


def _turns(speed) -> bool:
    """Whether the shaft ever turns."""
    return any(speed.value) if isinstance(speed, PiecewiseLinear) else bool(speed)


def _question(text: str) -> str:
    """The comment block at the head of the file."""
    lines = []
    for line in text.lstrip("\ufeff").splitlines():
        if not line.startswith("#"):
            break
        lines.append(line.lstrip("#").strip())
    return "\n".join(lines)


def _plain(value: Any) -> Any:
    if isinstance(value, PiecewiseLinear):
        return {"time": list(value.time), "value": list(value.value)}
    if isinstance(value, dict):
        return {str(k): _plain(v) for k, v in value.items()}
    if isinstance(value, (list, tuple)):
        return [_plain(v) for v in value]
    return value if value is None or isinstance(value, (bool, int, float, str)) else str(value)
