"""What is known of a scenario before it runs: its scene in SI, the model chosen, cautions, and the design rules.  What
runs compile, made ready before them."""

import contextlib
import tempfile
from collections.abc import Callable
from pathlib import Path
from time import monotonic

from ..closed_form.tilting_ring import couette_reynolds
from ..films import film_named, film_names, film_of
from ..kernel_cache import compiling, kept_kernels, kernel_folder
from ..radial_seals.followers import closed_form_sentences
from ..scenario.errors import ScenarioError
from ..scenario.reader import Scenario, read_scenario, with_values
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
from . import design_rules, radial_rules

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
            "design_rules": radial_rules.findings(scenario),
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
            "design_rules": design_rules.findings(scenario, run.model),
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
        found = radial_rules.findings(scenario)
    else:
        found = design_rules.findings(scenario, prepare_run(scenario)[0].model)
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
