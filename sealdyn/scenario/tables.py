"""The tables of a scenario file: what each may hold, and the scene that they make."""

import dataclasses
import math
import re
from collections.abc import Iterable, Iterator, Set
from dataclasses import dataclass, field
from functools import cache
from pathlib import Path
from typing import Annotated, Any, Literal

from pydantic import Field, TypeAdapter, ValidationError

from .. import __version__
from ..extensions import OUTSIDE, OutsideError, digest, outside_names
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
from ..units import QuantityError, Time, quoted
from .errors import (
    CIRCUMFERENTIAL_RULES,
    LIP_RULES,
    explained,
    nearest_of,
    refuse,
    unknown_rules,
)
from .keys import LENGTH, bare_keys, held_at, leaves, radius_key, with_radii
from .motion_files import part_at, table_at, with_columns

# Raised when a key is renamed, goes, or means something else; new keys alone do not raise it.
SCHEMA = 1
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
    given: Iterable[str] | None = None,
    bare: Iterable[str] | None = None,
    folder: Path | None = None,
    held: dict | None = None,
    asked: Set[str] = frozenset(),
) -> dict[str, Any]:
    """What a Scenario holds (`scene`, `run`, `application`, `study`, `given`, `bare`, `reading`) of tables whose values
    are written as in a file, or were read before.  `given`, `bare`: dotted keys that the user wrote, and of numbers
    without a unit, those of the tables unless told; `given` without those on which no run hangs.  `folder`, `held`
    and `asked` as of motion_files.py.  Raises SceneError."""
    _refuse_newer(raw)
    kind = kind_of(raw)
    wrong = [*_odd_numbers(raw, kind)]
    bare = frozenset(bare_keys(raw) if bare is None else bare)
    raw, halved = with_radii(raw, kind, wrong)
    given = (key for key, _ in leaves(raw, kind)) if given is None else (radius_key(kind, key) for key in given)
    given = frozenset(key for key in given if key.partition(".")[0] not in BESIDE_THE_RUN)
    raw, unread, unsaid = with_columns(raw, kind, folder, held, asked)
    reading = _tilt_of_tir(raw)
    wrong += [*unread, *_run_and_study(raw)]
    try:
        file = _reader(kind).validate_python(raw)
    except ValidationError as error:
        wrong += explained(kind, raw, error.errors(include_url=False))
    # What the values are together is asked where each can be.
    refuse(wrong)
    # Powers of the numbers are taken from here on.
    refuse_extremes(file)
    if kind is RadialFile:
        refuse(_impossible_radially(file))
    else:
        refuse(_bodies(file, raw))
        file = _completed(file, kind)
        refuse(_impossible(file, halved, given))
    scene_of = RadialScene if kind is RadialFile else Scene
    scene = scene_of(**{f.name: getattr(file, f.name) for f in dataclasses.fields(scene_of)})
    loads = [getattr(getattr(scene, ring, None), "load", None) for ring in RING_NAMES]
    if any(load is not None and load.model is not None for load in loads):
        # Loaded where there is something to sample.
        from .loads import with_samples

        scene = with_samples(scene, file.run)
    parts = {"run": file.run, "application": file.application, "study": file.study}
    return {"scene": scene, **parts, "given": given, "bare": bare.union(unsaid), "reading": reading}


def _refuse_newer(raw: dict) -> None:
    """Raises SceneError for a `schema` above SCHEMA: what else is unknown in such tables is not wrong, only newer."""
    found = raw.get("schema")
    if isinstance(found, int) and found > SCHEMA:
        expected = f"at most {SCHEMA}, all that sealdyn {__version__} reads: install a newer sealdyn for this file"
        raise SceneError("schema", quoted(found), expected)


def kind_of(raw: dict) -> type:
    """The dataclass of the tables `raw`, with options of what they take from outside.  Raises SceneError."""
    return RadialFile if any(table in raw for table in RADIAL) else _with_options(named_outside(raw))


def _with_options(found: tuple[tuple[str, str], ...]) -> type:
    if not found:
        return ScenarioFile
    from .own_options import with_options

    return with_options(ScenarioFile, found)


def named_outside(raw: dict) -> tuple[tuple[str, str], ...]:
    """What the tables `raw` take from outside: ("films/NAME", digest of its source), sorted.  Raises SceneError for
    what cannot be read, for a load that is not there, and for a film that is not but has options."""
    found = set()
    for place, room in OUTSIDE.items():
        table, known = table_at(raw, place), (Film if room == "films" else Load).__dataclass_fields__
        options = [key for key, held in table.items() if isinstance(held, dict) or dataclasses.is_dataclass(held)]
        model = table.get("model")
        for word in [model, *(key for key in options if key not in known)]:
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
                hint = "" if made else nearest_of(word, outside_names(room))
                key = f"{place}.{'model' if word == model else word}"
                raise SceneError(key, error.found, error.expected + hint) from None
            found.add((f"{room}/{word}", made))
    return tuple(sorted(found))


def outside_of(scene: Scene | RadialScene) -> tuple[tuple[str, str], ...]:
    """The same of a scene."""
    rings = (getattr(scene, name, None) for name in RING_NAMES)
    tables = getattr(scene, "film", None), *(getattr(ring, "load", None) for ring in rings)
    return tuple(sorted({pair for table in tables for pair in getattr(table, "found", ())}))


def kind_of_scene(scene: Scene | RadialScene) -> type:
    """The dataclass of the tables of a scene's file."""
    return RadialFile if isinstance(scene, RadialScene) else _with_options(outside_of(scene))


def _completed(file: ScenarioFile, kind: type) -> ScenarioFile:
    """The file with the options and inertias that follow from what it says.  Raises SceneError."""
    if kind is not ScenarioFile:
        from .own_options import with_default_options

        file = with_default_options(file)
    file = dataclasses.replace(file, rotor=with_inertia(file.rotor), stator=with_inertia(file.stator))
    refuse_extremes(file)
    return file


def _impossible_radially(file: RadialFile) -> list[SceneError]:
    """What no radial seal can have together."""
    bad = [SceneError(*error) for error in radial_errors(file)]
    if file.run.start not in ("auto", "steady"):
        bad.append(SceneError("run.start", quoted(file.run.start), '"auto": a radial seal begins on the shaft'))
    if file.run.solver in ("ida", "expm", "trbdf2"):
        expected = 'of a radial seal "auto", "dop853", "radau", "adams" or "bdf"'
        bad.append(SceneError("run.solver", quoted(file.run.solver), expected))
    if not bad and file.run.turns is not None and not _turns(file.shaft.speed):
        bad.append(SceneError("run.turns", "a shaft at rest", "[run] duration and samples"))
    if file.application is not None:
        unknown = unknown_rules(file.application.acknowledge, LIP_RULES if file.lip else CIRCUMFERENTIAL_RULES)
        bad += [SceneError(f"application.{key}", *words) for key, *words in unknown]
    return bad


def _impossible(file: ScenarioFile, halved: dict[str, str], given: frozenset[str]) -> list[SceneError]:
    """What no scene can have together, and, where there is nothing of that kind, what its film does not take, or the
    run."""
    bad = [*_unknown_film(file.film.model), *scene_errors(file, file.run)]
    if file.application is not None:
        wrong = application_errors(file.application) + unknown_rules(file.application.acknowledge)
        bad += [SceneError(f"application.{key}", *words) for key, *words in wrong]
    try:
        _ = bad or film_of(file)
    except SceneError as error:
        bad.append(error)
    if not bad and "run.samples_per_turn" in given and not _turns(file.shaft.speed):
        bad.append(SceneError("run.samples_per_turn", "a shaft at rest", "[run] samples, the number in all"))
    halves = [f"{e.found}, half of {halved[e.key]}" if e.key in halved else e.found for e in bad]
    return [SceneError(e.key, found, e.expected) for e, found in zip(bad, halves, strict=True)]


def film_choices() -> list[str]:
    """What `film.model` takes."""
    return ["auto", *all_film_names()]


def _unknown_film(name: str) -> Iterator[SceneError]:
    # What is installed beside this package is asked for other names only: that takes its time.
    if name not in ("auto", *own_film_names()) and name not in film_choices():
        near = [choice for choice in film_choices() if name and choice.startswith(f"{name}_")]
        near = near or spelled_like(name, film_choices())
        expected = "one of " + ", ".join(f'"{m}"' for m in film_choices())
        hint = "; nearest " + " and ".join(f"'{choice}'" for choice in near) if near else ""
        yield SceneError("film.model", f'"{name[:40]}"', expected + hint)


@cache
def _reader(kind: type) -> TypeAdapter:
    return TypeAdapter(kind)


def _odd_numbers(tree: Any, kind: type, key: str = "") -> Iterator[SceneError]:
    """Not a number, infinite, and true or false for a number; a study may hold what it likes."""
    below = tree.items() if isinstance(tree, dict) else enumerate(tree) if isinstance(tree, list) else ()
    for step, value in below:
        path = f"{key}.{step}" if key else str(step)
        if path not in ("study", "application.acknowledge"):
            yield from _odd_numbers(value, kind, path)
    if isinstance(tree, float) and not math.isfinite(tree):
        yield SceneError(key, str(tree), "a finite number")
    if isinstance(tree, bool) and key and held_at(kind, key) is not bool:
        yield SceneError(key, quoted(tree), "a number or a string with a unit")


def refuse_extremes(value: Any, key: str = "", counted: float = LARGEST) -> None:
    """Not a number, infinite, and numbers so large or small that products of a few of them are (in SI); whole numbers
    are at most `counted`.  Raises SceneError that names the key below `key`."""
    if isinstance(value, Motion):
        # Of thousands of samples one may cross zero anywhere.
        below = [(k, max(map(abs, held))) for k, held in vars(value).items() if isinstance(held, tuple) and held]
    elif dataclasses.is_dataclass(value):
        below = [(f.name, getattr(value, f.name)) for f in dataclasses.fields(value) if f.name != "study"]
    else:
        below = enumerate(value) if isinstance(value, (list, tuple)) else ()
    for step, part in below:
        # Of a table, its columns.
        refuse_extremes(part, key if isinstance(step, int) else f"{key}.{step}" if key else step, counted)
    if isinstance(value, int) and abs(value) > counted:
        raise SceneError(key, quoted(value), f"at most {counted:g}")
    if isinstance(value, int | float) and value != 0 and not SMALLEST <= abs(value) <= LARGEST:
        found = f"{value:.3g}" if isinstance(value, float) else quoted(value)
        raise SceneError(key, f"{found} (SI)", f"0, or a number from {SMALLEST:g} to {LARGEST:g} in size")


def _tilt_of_tir(raw: dict) -> Any:
    """`runout = "20 um TIR"`, the total indicator reading at the outer radius, becomes TIR / (2 r_o).  The runout as it
    was written where any of it is one, else None."""
    rotor, outer = table_at(raw, "rotor"), part_at(raw, "film.outer_radius")
    runout = rotor.get("runout")
    entries = runout.get("value") if isinstance(runout, dict) else [runout]
    if not isinstance(entries, list) or not any(map(_reading, entries)):
        return None
    tilts = [_tilt(entry, outer) for entry in entries]
    rotor["runout"] = {**runout, "value": tilts} if isinstance(runout, dict) else tilts[0]
    return runout


def _reading(entry: Any) -> re.Match | None:
    return re.fullmatch(r"(.*\S)\s*\bTIR\s*", entry) if isinstance(entry, str) else None


def _tilt(entry: Any, outer_radius: Any) -> Any:
    """The tilt (rad) of a total indicator reading; anything else as it is."""
    reading = _reading(entry)
    try:
        return LENGTH.read(reading[1]) / (2 * LENGTH.read(outer_radius)) if reading else entry
    except (QuantityError, ZeroDivisionError):
        # The reader of the tables says what is wrong with either.
        return entry


def _bodies(file: ScenarioFile, raw: dict) -> Iterator[SceneError]:
    """A ring has a mass, or a body that gives it, or both as `sealdyn check` prints them."""
    for ring in (key for key in RING_NAMES if getattr(file, key).body):
        own, by_body = getattr(file, ring), with_inertia(getattr(file, ring))
        for key in INERTIAL:
            value, follows = getattr(own, key), getattr(by_body, key)
            if key in table_at(raw, ring) and not math.isclose(value, follows, rel_tol=1e-9):
                expected = f"nothing, or what follows from the body, {follows:g}"
                yield SceneError(f"{ring}.{key}", f"{value:g} beside [{ring}.body]", expected)


def _run_and_study(raw: dict) -> Iterator[SceneError]:
    """What depends on several keys: how long and how often, and that studies are tables."""
    for study, settings in table_at(raw, "study").items():
        if not isinstance(settings, dict):
            yield SceneError(f"study.{study}", quoted(settings), "a table [study.NAME] of a study's settings")
    for ring in RING_NAMES:
        load = table_at(raw, f"{ring}.load")
        if "model" in load and "samples" in load:
            yield SceneError(f"{ring}.load.samples", "samples and a model", "one of the two")
    raw.setdefault("run", {})
    run = table_at(raw, "run")
    for one, other in (("turns", "duration"), ("samples_per_turn", "samples")):
        if one in run and other in run:
            yield SceneError(f"run.{one}", f"{one} and {other}", "one of the two")
    if "duration" not in run:
        run.setdefault("turns", 60)


def _turns(speed) -> bool:
    """Whether the shaft ever turns."""
    return any(speed.value) if isinstance(speed, PiecewiseLinear) else bool(speed)
