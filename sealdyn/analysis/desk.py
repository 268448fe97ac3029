"""What the program's verbs beside `run` and `study` say.  Of a scenario before it runs: its scene in SI, the model
chosen, cautions, and the design rules; what runs compile, made ready before them.  In Python `sealdyn.check`,
`design_rules`, `validate`, `compare`, `review`: a scenario is a Scenario, or the path of a TOML file or an archive,
with `overrides` as of `sealdyn.run`."""

import contextlib
import os
import tempfile
from collections.abc import Callable, Iterable, Mapping
from pathlib import Path
from time import monotonic
from typing import Any

from ..closed_form.tilting_ring import couette_reynolds
from ..films import film_named, film_names, film_of
from ..kernel_cache import compiling, kept_kernels, kernel_folder
from ..radial_seals.followers import closed_form_sentences
from ..report.comparison import comparison
from ..report.review import review as page_of
from ..scenario.errors import ScenarioError, scene_errors_of
from ..scenario.reader import Scenario, read_scenario, scenario_of, with_values
from ..scenario.templates import shipped_paths
from ..scene.fluid import highest_density
from ..scene.patterns import faces_tilt, grooves_of, waves_of
from ..scene.radial import RadialScene
from ..scene.scene import SceneError, frozen_at_start
from ..simulation.batch import simulate_many
from ..simulation.film_error import reynolds_comparison
from ..simulation.heat import heat_cautions, heat_of
from ..simulation.plausibility import LAMINAR, scene_cautions, size_of, unit_warnings
from ..simulation.result import plain
from ..simulation.selection import prepare_run
from ..simulation.simulate import simulate
from ..simulation.summary import model_chosen
from ..solvers.methods import METHODS
from ..status import Status
from . import design_rules as rules
from . import other_rules
from .sources import checks, sources_of_film, wanted_sources

# Of a shipped run's length: what is computed of it to have its kernels compiled.
SHARE = 0.05
# Time (s) without a kernel being compiled after which one by a method that is not its own is left.
QUIET = 3.0


def checked(scenario: Scenario) -> dict:
    """The answer of `sealdyn check --json`, SI.  Raises SceneError and ArchiveError of a run that cannot be made
    ready."""
    found = {"status": Status.OK, "message": "the scene is possible", "scene": scenario.resolved()}
    run, plan = prepare_run(scenario)
    size = size_of(scenario, plan.count)
    if isinstance(scenario.scene, RadialScene):
        followers = run.model.followers
        return found | {
            "model": {"followers": followers.count, "solver": plan.method, "reasons": [f"solver: {plan.why}"]},
            "closed_form": closed_form_sentences(followers, scenario.scene.shaft),
            "warnings": unit_warnings(scenario),
            "design_rules": other_rules.findings(scenario),
            "equilibria": [],
        }
    grooves, rough = _over_grooves(scenario.scene, run.model.clearance) if grooves_of(scenario.scene)[1] else ({}, [])
    warm = [] if run.model.heat is None else heat_cautions(run.model.given, run.model.heat)
    told = [caution.sentence for caution in (*run.cautions, *scene_cautions(scenario, run.model), *warm)]
    return (
        found
        | grooves
        | {
            "gauge": sorted(scenario.gauge),
            "model": plain(model_chosen(scenario, run, plan)),
            "clearance": run.model.clearance,
            "equilibria": [vars(e) for e in run.model.interface.equilibria],
            "warnings": rough + told,
            "heat": plain(heat_of(run.model.given, run.model.heat)),
            "design_rules": rules.findings(scenario, run.model),
            "beside_reynolds": reynolds_comparison(run),
            "size": {key: getattr(size, key) for key in ("turns", "rows", "bytes", "seconds")},
        }
    )


def _over_grooves(scene, clearance: float) -> tuple[dict, list[str]]:
    """What is known of the grooves of a scene at a clearance (m), and what warns."""
    # Loaded for grooves only.
    from ..films._grooved.aligned import aligned_film

    film, (face, (one,)) = aligned_film(frozen_at_start(scene), clearance), grooves_of(scene)
    condition, deep = film.fine.film.conditions, float(film.fine.film.h.max())
    sliding = abs(condition.relative_speed) * one.reach[1]
    reynolds = couette_reynolds(highest_density(scene.film), condition.viscosity, sliding, deep)
    rough = [f"perhaps turbulent: Couette Reynolds number {reynolds:.0f} in the grooves"] if reynolds > LAMINAR else []
    known = {"face": face, "pumping": film.pumping, "depth_over_film": one.depth / clearance}
    return {"grooves": known | {"reynolds_number": reynolds}}, rough


def rules_of(scenario: Scenario) -> list[dict]:
    """What the design rules find of any scenario, broken ones first.  Raises as `checked`."""
    if isinstance(scenario.scene, RadialScene):
        found = other_rules.findings(scenario)
    else:
        found = rules.findings(scenario, prepare_run(scenario)[0].model)
    order = ("fail", "note", "acknowledged", "pass", "not applicable")
    return sorted(found, key=lambda row: order.index(row["verdict"]))


def compile_all(progress: Callable[[float, float, str], None]) -> str:
    """Compiles what runs need and is not kept yet, and says what is: computes the beginning of every shipped scenario,
    alone and many at once, and of each film that takes one, by every method that can.  `progress(done, all, words)`."""
    paths, met, last = shipped_paths(), set(), [0.0]

    def note(_=0):
        last[0] = monotonic()

    compiling.append(note)
    with tempfile.TemporaryDirectory() as folder:
        for done, (name, path) in enumerate(paths.items()):
            given = read_scenario(path)
            given = given.with_({f"run.{key}": SHARE * value for key in ("turns", "duration")
                                 if (value := getattr(given.run, key))})  # fmt: skip
            radial = isinstance(given.scene, RadialScene)
            for scenario in (given, *(() if radial else _others(given, met))):
                film = "" if radial else f", film {scenario.scene.film.model}"
                progress(done, len(paths), f"{name}{film}, {scenario.run.solver}")
                note()
                # What cannot be computed so is refused before a kernel is called, or after; by a method that is made
                # for other scenes it would take hours.
                stop = None if scenario is given else lambda: monotonic() - last[0] > QUIET
                with contextlib.suppress(SceneError):
                    simulate(scenario, Path(folder) / "run.h5", stop=stop)
            if radial or film_of(given.scene).unknowns is None:
                # Others are stepped one by one there, too.
                progress(done, len(paths), f"{name}, many runs")
                simulate_many(given, [{}, {}], workers=1)
    compiling.remove(note)
    progress(len(paths), len(paths), "compiled")
    return f"{kernel_folder()}: {len(kept_kernels())} files of kernels"


def _others(scenario: Scenario, met: set):
    """The scenario with each film without unknowns that takes its faces, by each method, where they are the first of
    their kind."""
    scene = scenario.scene
    for film in film_names(scene.film, waves_of(scene)):
        kind = film, scene.contact is not None, faces_tilt(scene)
        if kind not in met and film_named(film).unknowns is None:
            for solver in ("auto", *METHODS):
                with contextlib.suppress(ScenarioError):
                    yield with_values(scenario, {"film.model": film, "run.solver": solver})
        met.add(kind)


Source = Scenario | str | os.PathLike
Overrides = Mapping[str, Any] | Iterable[str]


def check(source: Source, overrides: Overrides = ()) -> dict[str, Any]:
    """What `sealdyn check --json` prints, SI: the `scene` resolved, `model`, `equilibria`, `warnings`, `design_rules`.
    **Raises** ScenarioError for what cannot be run.

    >>> str(sealdyn.check("fms.toml")["status"])
    'ok'
    """
    scenario = scenario_of(source, overrides)
    with scene_errors_of(scenario.name):
        return checked(scenario)


def design_rules(source: Source, overrides: Overrides = ()) -> list[dict[str, Any]]:
    """What the design rules find, broken ones first: `rule`, `verdict` ("fail", "note", "pass" ...), value, limit and
    source of each.  **Raises** ScenarioError for what cannot be run.

    >>> sealdyn.design_rules("fms.toml")[0]["verdict"]
    'fail'
    """
    scenario = scenario_of(source, overrides)
    with scene_errors_of(scenario.name):
        return rules_of(scenario)


def validate(source: str | None = None) -> list[dict[str, Any]]:
    """Published numbers beside computed ones, of one source ("zuk-1972") or of all, a row each with its `verdict`.
    **Raises** ValueError for no such source.

    >>> "FAILED" in {row["verdict"] for row in sealdyn.validate("green-1989")}
    False
    """
    return [row for rows in checks(wanted_sources(source)).values() for row in rows]


def compare(one: str | os.PathLike, other: str | os.PathLike) -> dict[str, Any]:
    """What the archives of two runs have different, as `sealdyn compare --json` prints it.  **Raises** ArchiveError.

    >>> files = [sealdyn.run("fms.toml", {"film.clearance": gap}, out=f"{gap}.h5").archive for gap in (8e-6, 9e-6)]
    >>> [row["key"] for row in sealdyn.compare(*files)["scene"]]
    ['film.clearance']
    """
    return comparison(one, other)


def review(archives: Iterable[str | os.PathLike], out: str | os.PathLike = "report.html", title: str = "") -> Path:
    """Write one page of the archives of runs and studies for a design review, and return its path.  **Raises**
    ArchiveError, and ScenarioError for a run whose scenario cannot be read again.

    >>> kept = sealdyn.run("fms.toml", out="kept.h5").archive
    >>> sealdyn.review([kept], "page.html").name
    'page.html'
    """
    return page_of(list(archives), out, title, lambda path, _: rules_of(read_scenario(path)), sources_of_film)
