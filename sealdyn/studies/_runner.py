"""One pass of a study: settings, points on all cores, answer, archive; and a study asked for in Python, with its answer
in memory."""

from __future__ import annotations

import importlib
import json
import os
import sys
from collections.abc import Callable, Iterable, Mapping
from contextlib import nullcontext
from dataclasses import asdict, dataclass, field, replace
from functools import cached_property
from pathlib import Path
from tempfile import TemporaryDirectory
from time import monotonic
from typing import TYPE_CHECKING, Any

from .. import __version__, studies
from ..answers import as_json, plain
from ..archive import answer_as_dataset, file_stem, link_target, only_writer, write_study
from ..films import film_of
from ..numerics.parallel import Checkpoint, Results, evaluate, processes
from ..quantities import in_words, reading_in
from ..report.text import written_units
from ..scenario.errors import ScenarioError, nearest_of, scene_errors_of
from ..scenario.keys import radius_key
from ..scenario.overrides import without_arrays
from ..scenario.reader import Scenario, scenario_of
from ..scenario.settings import bare_settings, study_settings, without, written_settings
from ..scenario.tables import kind_of_scene
from ..scene import scene as scenes
from ..scene.patterns import face_orders, faces_tilt, grooves_of, waves_of
from ..scene.radial import RadialScene
from ..scene.scene import SceneError
from ..simulation.plausibility import declared, unusual, usual_of
from ..simulation.result import at_hand, provenance
from ..status import Status
from ..units import printable
from . import Info, study_names

if TYPE_CHECKING:
    import xarray

    from ..report.charts.page import Figure


# Time (s) of one process beyond which a study says after its first point what the others will take.
LONG = 60.0


def archive_of(name: str, scenario, out=None) -> Path:
    """Where study `name` (hyphens or underscores) of a scenario puts its archive, if it is not told (`out`)."""
    return link_target(out if out else Path("outputs") / f"{file_stem(scenario.name)}-{name.replace('_', '-')}.h5")


def journal_of(out: Path) -> Path:
    """Where finished points are kept until the archive `out` is there."""
    return out.with_suffix(".partial.jsonl")


def study_module(name: str):
    """The study `name` (hyphens or underscores)."""
    return importlib.import_module(studies.study_module(name.replace("-", "_")))


def study_info(name: str) -> Info:
    """What study `name` (hyphens or underscores) declares of itself."""
    return study_module(name).INFO


def setting_warnings(scenario, name: str, flags: dict) -> list[str]:
    """Sentences on the bare numbers that are not usual among the settings of study `name` (underscored), of its `flags`
    and of [study.NAME]: the rule of simulation/plausibility.py."""
    kind, settings, said = kind_of_scene(scenario.scene), study_module(name).Settings, []
    for setting, key, holds, values in bare_settings(written_settings(scenario, name, settings, flags), settings):
        where = f"study.{name}.{setting}"
        known = declared(kind, radius_key(kind, key)) if key else usual_of(holds)
        said += unusual(f"{key} of {where}" if key else where, values, known)
    return said


@dataclass
class StudyContext:
    """What a study is handed: a crew for its points, and progress.  Points are kept in `results` where there is such a
    folder, else in the `journal`, like anything else of an interrupted study; `failures` are the reasons of points that
    failed; `name` of the study."""

    journal: Checkpoint
    crew: object
    progress: object
    results: Results | None = None
    failures: list[str] = field(default_factory=list)
    name: str = ""

    def map(self, function, points: list, what: str = "points", keep: tuple[str, ...] = ()) -> list[dict]:
        """Rows of `function(point)` for JSON-able points, in their order, `{"failed": reason}` for one that failed; in
        front of each what its point has of the names `keep`."""
        if not points:
            return []
        store, begun, kept = self.results or self.journal, monotonic(), []

        def say(done: int, everything: int):
            self.say(done / everything, f"{what}: {done} of {everything}")
            kept.append(done)
            spent, left = monotonic() - begun, everything - done
            # The first that was not kept from before: what it took, the others will.
            if len(kept) == 2 and spent * left > LONG:
                self.tell(f"{what}: the first took {in_words('time', spent)}, {left} are left")

        rows = evaluate(function, points, store, self.crew, say, what)
        self.failures += [row["failed"] for row in rows if "failed" in row]
        return [{name: point[name] for name in keep} | row for point, row in zip(points, rows, strict=True)]

    def tell(self, words: str):
        """A line before a long wait, for those who watch the progress."""
        if self.progress:
            print(printable(words), file=sys.stderr, flush=True)

    def alone(self) -> StudyContext:
        """For points that measure time: one after the other in this process, not to be kept for others, without
        progress."""
        return replace(self, crew=processes(1), results=None, progress=None)

    def say(self, fraction: float, words: str = ""):
        """Report progress, a share of the whole, and what is being done (else the study's name)."""
        if self.progress:
            self.progress(fraction, 1.0, words or self.name)


def run_study(
    name: str,
    scenario: Scenario,
    out: str | os.PathLike | None = None,
    *,
    flags: Mapping[str, Any] | None = None,
    workers: int | None = None,
    scheduler: Any = None,
    results: str | os.PathLike | None = None,
    progress: Callable[[float, float, str], None] | None = None,
    leave_out: Iterable[str] = (),
) -> dict[str, Any]:
    """Run study `name` (hyphens or underscores) on a scenario; returns its answer with `archive` added: what
    `sealdyn.study` does below its `Answer`.  **Deprecated** as a door: call that.

    `flags` override the scenario's `[study.NAME]`; an interrupted study goes on from its journal beside `out`.
    Points are evaluated by `workers` processes (None: all cores), or by the workers of a Dask `scheduler`: its address
    "tcp://host:port", a `dask.distributed.Client`, or any `concurrent.futures.Executor`.  `results`: a folder that
    keeps finished points for other studies, and for those of other machines.
    `leave_out`: "contact" for the film alone, or "secondary-seal".
    Raises ScenarioError, SceneError, ClusterError (numerics.cluster), ArchiveError where another writes the archive.

    >>> scenario = sealdyn.read_scenario("fms.toml")
    >>> answer = sealdyn.run_study("equilibrium", scenario, "balance.h5", flags={"points": 11}, workers=1)
    >>> answer["archive"], answer["roots"][0]["stable"]
    ('balance.h5', True)
    """
    name = name.replace("-", "_")
    module, info, radial = study_module(name), study_info(name), isinstance(scenario.scene, RadialScene)
    _refuse_seal(name, info, scenario.scene)
    studied, left_out, springs = scenario, [], []
    # What can be left out, a face seal has.
    if not radial:
        studied, left_out = without(scenario, leave_out)
        if "secondary-seal" in info.refuses:
            scene, springs = scenes.with_springs_for_seals(studied.scene)
            studied = replace(studied, scene=scene, read=None)
        _refuse(name, studied.scene, info.refuses)
    settings = study_settings(scenario, name, module.Settings, flags or {})
    out = archive_of(name, scenario, out)
    asked_for = json.loads(json.dumps(asdict(settings), default=str))
    asked = [__version__, name, scenario.text, list(scenario.overrides), asked_for, left_out]
    # Files may have changed since.
    identity = json.dumps([*asked, *filter(None, [scenario.motions()])], sort_keys=True)
    with only_writer(out) as out:
        journal = Checkpoint(journal_of(out), identity)
        kept = _folder(results) if results else None
        with _crew(workers, scheduler) as crew:
            tools = StudyContext(journal, crew, progress, kept, name=name.replace("_", "-"))
            with reading_in(written_units({"scenario": scenario.text, "overrides": scenario.overrides})):
                answer = module.run(studied, settings, tools)
        notes, failures = setting_warnings(scenario, name, flags or {}), tools.failures
        known = " ".join([answer.found, *answer.notes])
        # Unless the study has told it itself.
        if failures and failures[0] not in known:
            notes.append(f"Failed points: {len(failures)}; the first: {failures[0]}")
        if info.warm and not radial and studied.scene.film.heat is not None:
            notes.append(info.warm)
        if info.aligned and not radial and (askew := _moment(studied.scene)):
            notes.append(f"The numbers are of aligned faces, which do not stay so: {askew}.")
        for key in springs:
            seal = scenes.part(scenario.scene, key)
            stiffness, reach = in_words("axial_stiffness", seal.springs()[0]), in_words("travel", seal.reach())
            notes.append(f"[{key}] is a spring of {stiffness}, as in small motion: from {reach} on it slides.")
        if left_out:
            notes.append(f"Left out as asked: {', '.join(f'[{table}]' for table in left_out)}.")
        panels = plain(answer.panels)
        answer = as_json(replace(answer, notes=[*answer.notes, *notes]))
        answer = {"status": Status.OK, "message": " ".join(answer["verdict"]), "study": name, "left_out": left_out,
                  **answer}  # fmt: skip
        meta = provenance(scenario) | {"study": name, "settings": asked_for, "asks": info.asks}
        write_study(out, scenario.text, scenario.resolved(), meta, answer, info.units, info.along, panels)
        journal.done()
    return {**answer, "archive": str(out)}


def _refuse_seal(name: str, info: Info, scene):
    """Raises SceneError for a seal of a kind that the study `name` does not know."""
    study, radial = name.replace("_", "-"), isinstance(scene, RadialScene)
    if info.seals not in ("any", "radial" if radial else "face"):
        if radial:
            key, found = "lip" if scene.lip else "circumferential", "a radial seal"
            known = [one for one in study_names() if study_info(one).seals != "face"]
            raise SceneError(key, found, f"a face seal for {study}; of radial ones there are {', '.join(known)}")
        raise SceneError("film", "a face seal", f"[lip] or [circumferential]: {study} is of radial seals")
    if radial:
        return
    if (face := grooves_of(scene)[0]) and not info.grooved:
        known = [one for one in study_names() if study_info(one).grooved]
        served = f"none, a run, or one of the studies {', '.join(known)}"
        raise SceneError(f"{face}.grooves", "grooves in a face", f"{served}: {name} does not reckon with grooves")
    if not info.wavy and ((wavy := waves_of(scene)) or scene.film.pads):
        expected = f"none: this study ({name}) knows faces that are the same all around"
        raise SceneError(_key_of_pattern(scene), "wavy faces" if wavy else "pads", expected)


def _key_of_pattern(scene) -> str:
    """Key of what a scene has around its faces."""
    waves = "rotor.waviness" if scene.rotor.waviness else "stator.waviness"
    return waves if waves_of(scene) else "film.pads"


def _refuse(name: str, scene, refused):
    """Raises SceneError for what the study `name` cannot reckon with."""
    study, way = name.replace("_", "-"), "{} left out (--without {})"
    if "secondary-seal" in refused and (seals := scenes.seals_that_stick(scene)):
        found = f"a ring that its secondary seal holds in small motion, of which {study} asks"
        raise SceneError(seals[0], found, way.format("the seal", "secondary-seal"))
    if "contact" in refused and scene.contact:
        raise SceneError("contact", f"faces that may touch, with which {study} does not reckon",
                         way.format("contact", "contact"))  # fmt: skip
    if "moment" in refused and (askew := _moment(scene)):
        found = f"aligned faces that do not stay so ({askew})"
        raise SceneError(_key_of_pattern(scene), found, f"faces that do, for {study}")


def _moment(scene) -> str:
    """What turns aligned faces of a scene by itself, in words; "" where nothing does."""
    if not faces_tilt(scene) or film_of(scene).unknowns is None:
        return ""
    return f"waves, pads or grooves of order {' and '.join(map(str, face_orders(scene)))} press with a moment"


def _crew(workers: int | None, scheduler):
    """Who evaluates points, as a context."""
    if scheduler is None:
        return nullcontext(processes(workers))
    from ..numerics.cluster import workers_of

    return workers_of(scheduler)


def _folder(path) -> Results:
    """Made at once: a folder that cannot be written is found out before the first point is done."""
    Path(path).mkdir(parents=True, exist_ok=True)
    return Results(path)


@dataclass(frozen=True, repr=False)
class Answer:
    """What a study leaves: its name, `status` (a value of Status), a sentence, the `verdict` in sentences, the `answer`
    as a dict (as `study --json` prints it, SI), and the path of the archive, or None and its `content` where it was
    kept in memory only.

    >>> answer = sealdyn.study("equilibrium", "fms.toml", points=11)
    >>> answer.verdict[0]
    'The seal rides at 10 um: the film carries the closing force there, stably.'
    >>> answer.data.coords["curve.clearance"].attrs["units"]
    'm'
    >>> answer.plot().savefig("equilibrium.svg")
    """

    study: str
    status: str
    message: str
    verdict: list[str]
    answer: dict[str, Any] = field(repr=False)
    archive: Path | None
    content: bytes | None = field(default=None, repr=False)

    @cached_property
    def data(self) -> xarray.Dataset:
        """Its numbers as an `xarray.Dataset` with units.  Of a study over keys the dimensions are the keys, the
        variables its outputs and the `status` and `message` of each point; of others every list of numbers of the
        answer, "curve.h_min", along the columns that its study names."""
        info = study_info(self.study)
        return answer_as_dataset(self.answer, info.units, info.along)

    def __repr__(self) -> str:
        from ..report.in_python import study_repr

        return study_repr(self.study, self.answer)

    def _repr_html_(self) -> str:
        from ..report.in_python import study_html

        return study_html(self.answer)

    def plot(self) -> Figure:
        """Its figure, of matplotlib; `figure.savefig("map.svg")` writes it."""
        from ..report.panels import draw

        with at_hand(self.archive, self.content) as path:
            return draw(path)


def study(
    name: str,
    source: Scenario | str | os.PathLike,
    *,
    out: str | os.PathLike | None = None,
    workers: int | None = None,
    scheduler: Any = None,
    results: str | os.PathLike | None = None,
    progress: Callable[[float, float, str], None] | None = None,
    without: Iterable[str] = (),
    **settings: Any,
) -> Answer:
    """Answer a question about a scenario, or that of a TOML file or an archive: `sealdyn.study("sweep", scenario,
    vary="rotor.runout=0:1 mrad:21")`.  Without `out` nothing is left on disk.

    `name` with hyphens or underscores; `settings` those of `[study.NAME]`, which a type checker knows of the package's
    own studies; `without` "contact" or "secondary-seal"; the others as in `run_study`.
    Raises ScenarioError for what cannot be studied, ClusterError, ArchiveError.

    >>> answer = sealdyn.study("sweep", "fms.toml", vary="rotor.runout=10,20 urad", outputs="h_min.value")
    >>> 1e6 * answer.data["h_min.value"].values.round(8)
    array([9.68, 9.36])
    """
    scenario, name = scenario_of(source), name.replace("_", "-")
    names = study_names()
    if name not in names:
        hint = nearest_of(name, names)
        raise ScenarioError(scenario.name, "study", f'"{name}"', f"one of {', '.join(names)}{hint}")
    how = {"workers": workers, "scheduler": scheduler, "results": results, "progress": progress}
    how |= {"leave_out": [without] if isinstance(without, str) else list(without), "flags": without_arrays(settings)}
    with scene_errors_of(scenario.name):
        if out is not None:
            answer = run_study(name, scenario, out, **how)
            return _answer(answer, Path(answer["archive"]))
        with TemporaryDirectory() as folder:
            answer = run_study(name, scenario, Path(folder) / "study.h5", **how)
            return _answer({**answer, "archive": None}, None, Path(answer["archive"]).read_bytes())


def _answer(answer: dict, archive: Path | None, content: bytes | None = None) -> Answer:
    told = {"status": str(answer["status"]), "message": answer["message"], "verdict": answer["verdict"]}
    return Answer(answer["study"], **told, answer=answer, archive=archive, content=content)
