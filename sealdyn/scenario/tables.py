"""The tables of a scenario file: what each may hold, and the scene that they make."""

import dataclasses
import math
import re
from collections.abc import Iterator
from dataclasses import dataclass, field
from functools import cache
from pathlib import Path
from typing import Annotated, Any, Literal

from pydantic import Field, TypeAdapter, ValidationError

from ..extensions import OUTSIDE, OutsideError, digest, in_folders, installed
from ..films import all_film_names, film_of, own_film_names
from ..numerics.piecewise_linear import PiecewiseLinear
from ..scene import Strict
from ..scene.application import Application, RadialApplication, application_errors
from ..scene.checks import scene_errors
from ..scene.excitation import Motion
from ..scene.film import Film
from ..scene.forces import Load
from ..scene.radial import RADIAL, RadialScene, radial_errors
from ..scene.rings import INERTIAL, RING_NAMES, with_inertia
from ..scene.scene import Scene, SceneError
from ..unit_names import spelled_like
from ..units import Length, QuantityError, Time, quoted
from .errors import (
    CIRCUMFERENTIAL_RULES,
    LIP_RULES,
    ScenarioError,
    explained,
    nearest_of,
    scene_errors_of,
    tables,
    together,
    unknown_rules,
    without_indices,
)
from .motion_files import samples_at, with_columns
from .overrides import SCHEMA, radius_key, refuse_newer, with_radii

# Numbers in SI units beyond which nothing of this world is.
SMALLEST, LARGEST = 1e-25, 1e15
STARTS = r"^(auto|rest|steady|.+\.h5)$"
# What no number of a run hangs on.
BESIDE_THE_RUN = ("study", "application", "schema")


@dataclass(frozen=True)
class Run(Strict):
    """The `[run]` table: how long, how often sampled, how exact, by which method, from which start.

    `turns` of the shaft (default 60) or `duration` (s); `samples_per_turn` or `samples` in all (default 64 a turn, of a
    shaft at rest 1000 in all, and 8 a period of the fastest motion that is imposed).  `start` "auto": on the linear
    steady response where that is stable and leaves the film open; at rest with `[initial]`, and, unless the faces would
    overlap there, with contact, a secondary seal, a film with unknowns of its own, or tables.
    """

    turns: Annotated[float, Field(gt=0)] | None = None
    """Of the shaft (60 without `duration`)."""
    duration: Time | None = None
    """In place of `turns`."""
    samples_per_turn: Annotated[int, Field(gt=0)] | None = None
    """Of the archive; without it or `samples` 64 (1000 in all if the shaft stands), or 8 a period of what is imposed
    fastest: tones, a sweep's end, waves as they pass."""
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

    schema: Annotated[int, Field(ge=1, le=SCHEMA)] = SCHEMA
    """Version of these keys; without it the present one."""
    run: Run = field(default_factory=Run)
    """How long, how exact, by which method."""
    application: RadialApplication | None = None
    """Which rules it breaks on purpose."""
    study: dict[str, dict[str, Any]] = field(default_factory=dict)
    """Settings of studies, one table [study.NAME] each."""


def read_tables(
    raw: dict,
    name: str,
    given: frozenset[str] | None = None,
    folder: Path | None = None,
    held: dict | None = None,
    bare: list[str] | None = None,
) -> dict[str, Any]:
    """What a Scenario holds (`scene`, `run`, `application`, `study`, `given`, `reading`) of tables whose values are
    written as in a file, or were read before.  `given`: dotted keys that the user wrote, all of the tables' unless
    told, without those on which no run hangs; `folder`, `held` and `bare` as of motion_files.py.
    Raises `ScenarioError`."""
    refuse_newer(raw, name)
    kind = kind_of(raw, name)
    wrong = [*_odd_numbers(raw, name, kind=kind)]
    raw, halved = with_radii(raw, kind, name, wrong)
    given = given_keys(raw, kind=kind) if given is None else (radius_key(kind, key) for key in given)
    given = frozenset(key for key in given if key.partition(".")[0] not in BESIDE_THE_RUN)
    raw = with_columns(raw, kind, name, folder, held or {}, wrong, [] if bare is None else bare)
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
    if kind is not ScenarioFile:
        from .own_options import with_default_options

        file = with_default_options(file, name, wrong)
        if wrong:
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
    if any(load is not None and load.model is not None for load in (scene.stator.load, scene.rotor.load)):
        # Loaded where there is something to sample.
        from .loads import with_samples

        with scene_errors_of(name):
            scene = with_samples(scene, file.run)
    parts = {"run": file.run, "application": file.application, "study": file.study}
    return {"scene": scene, **parts, "given": given, "reading": reading}


def kind_of(raw: dict, name: str) -> type:
    """The dataclass of the tables `raw` of the scenario `name`, with options of what they take from outside.  Raises
    ScenarioError."""
    if any(table in raw for table in RADIAL):
        return RadialFile
    return _with_options(named_outside(raw, name))


def _with_options(found: tuple[tuple[str, str], ...]) -> type:
    if not found:
        return ScenarioFile
    from .own_options import with_options

    return with_options(ScenarioFile, found)


def named_outside(raw: dict, name: str) -> tuple[tuple[str, str], ...]:
    """What the tables `raw` of the scenario `name` take from outside: ("films/NAME", digest of its source), sorted.
    Raises ScenarioError for what cannot be read, for a load that is not there, and for a film that is not but has
    options."""
    found = set()
    for place, room in OUTSIDE.items():
        table, known = samples_at(raw, place), (Film if room == "films" else Load).__dataclass_fields__
        model = table.get("model")
        for word in [model, *(key for key in table if key not in known and key != model and _is_table(table[key]))]:
            if not isinstance(word, str) or (room == "films" and word in (*own_film_names(), "auto")):
                continue
            made = digest(room, word)
            if made is None and (word != model or (room == "films" and word not in table)):
                # The reader of the tables says what is wrong with it.
                continue
            try:
                # Loaded where something comes from outside, as all of own_options.py is.
                from .own_options import options_of

                options_of(room, word)
            except OutsideError as error:
                hint = "" if made else nearest_of(word, {*in_folders(room), *installed(room)})
                key = f"{place}.{'model' if word == model else word}"
                raise ScenarioError(name, key, error.found, error.expected + hint) from None
            found.add((f"{room}/{word}", made))
    return tuple(sorted(found))


def _is_table(value: Any) -> bool:
    return isinstance(value, dict) or dataclasses.is_dataclass(value)


def outside_of(scene: Scene | RadialScene) -> tuple[tuple[str, str], ...]:
    """The same of a scene."""
    rings = (getattr(scene, name, None) for name in RING_NAMES)
    tables = getattr(scene, "film", None), *(getattr(ring, "load", None) for ring in rings)
    return tuple(sorted({pair for table in tables for pair in getattr(table, "found", ())}))


def kind_of_scene(scene: Scene | RadialScene) -> type:
    """The dataclass of the tables of a scene's file."""
    return RadialFile if isinstance(scene, RadialScene) else _with_options(outside_of(scene))


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
    # What is installed beside this package is asked for other names only: that takes its time.
    if name not in ("auto", *own_film_names()) and name not in film_choices():
        near = [choice for choice in film_choices() if name and choice.startswith(f"{name}_")]
        near = near or spelled_like(name, film_choices())
        expected = "one of " + ", ".join(f'"{m}"' for m in film_choices())
        hint = "; nearest " + " and ".join(f"'{choice}'" for choice in near) if near else ""
        raise SceneError("film.model", f'"{name[:40]}"', expected + hint)


@cache
def _reader(kind: type) -> TypeAdapter:
    return TypeAdapter(kind)


def _odd_numbers(tree: Any, name: str, key: str = "", kind: type = ScenarioFile) -> Iterator[ScenarioError]:
    """Not a number, infinite, and true or false for a number; a study may hold what it likes."""
    below = tree.items() if isinstance(tree, dict) else enumerate(tree) if isinstance(tree, list) else ()
    for step, value in below:
        path = f"{key}.{step}" if key else str(step)
        if path not in ("study", "application.acknowledge"):
            yield from _odd_numbers(value, name, path, kind)
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
    runout = table_of(raw, "rotor").get("runout")
    return runout if any(map(_reading, entries_of(runout))) else None


def _tilt_of_tir(raw: dict) -> None:
    """`runout = "20 um TIR"`, the total indicator reading at the outer radius, becomes TIR / (2 r_o)."""
    rotor, outer = table_of(raw, "rotor"), table_of(raw, "film").get("outer_radius")
    runout = rotor.get("runout")
    tilts = [_tilt(entry, outer) for entry in entries_of(runout)]
    if tilts and "runout" in rotor:
        rotor["runout"] = {**runout, "value": tilts} if isinstance(runout, dict) else tilts[0]


def entries_of(runout: Any) -> list:
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


def table_of(raw: dict, key: str) -> dict:
    """A table of the file, empty if it is none (the reader says so)."""
    return raw[key] if isinstance(raw.get(key), dict) else {}


def _bodies(file: ScenarioFile, raw: dict, name: str) -> Iterator[ScenarioError]:
    """A ring has a mass, or a body that gives it, or both as `sealdyn check` prints them."""
    for ring in (key for key in RING_NAMES if getattr(file, key).body):
        own, by_body = getattr(file, ring), with_inertia(getattr(file, ring))
        for key in INERTIAL:
            value, follows = getattr(own, key), getattr(by_body, key)
            if key in table_of(raw, ring) and not math.isclose(value, follows, rel_tol=1e-9):
                expected = f"nothing, or what follows from the body, {follows:g}"
                yield ScenarioError(name, f"{ring}.{key}", f"{value:g} beside [{ring}.body]", expected)


def _run_and_study(raw: dict, name: str) -> Iterator[ScenarioError]:
    """What depends on several keys: how long and how often, and that studies are tables."""
    for study, settings in table_of(raw, "study").items():
        if not isinstance(settings, dict):
            yield ScenarioError(name, f"study.{study}", quoted(settings), "a table [study.NAME] of a study's settings")
    for ring in RING_NAMES:
        load = table_of(table_of(raw, ring), "load")
        if "model" in load and "samples" in load:
            yield ScenarioError(name, f"{ring}.load.samples", "samples and a model", "one of the two")
    raw.setdefault("run", {})
    run = table_of(raw, "run")
    for one, other in (("turns", "duration"), ("samples_per_turn", "samples")):
        if one in run and other in run:
            yield ScenarioError(name, f"run.{one}", f"{one} and {other}", "one of the two")
    if "duration" not in run:
        run.setdefault("turns", 60)


def _turns(speed) -> bool:
    """Whether the shaft ever turns."""
    return any(speed.value) if isinstance(speed, PiecewiseLinear) else bool(speed)
