"""What is known of a scenario before it runs: its scene in SI, the model chosen, cautions, and the design rules."""

from ..radial_seals.followers import closed_form_sentences
from ..scenario.reader import Scenario
from ..scene.radial import RadialScene
from ..simulation.film_error import reynolds_comparison
from ..simulation.heat import heat_cautions, heat_of
from ..simulation.plausibility import scene_cautions, size_of, unit_warnings
from ..simulation.result import plain
from ..simulation.selection import prepare_run
from ..simulation.summary import model_chosen
from ..status import Status
from . import design_rules, radial_rules


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
    return found | {
        "gauge": sorted(scenario.gauge),
        "model": plain(model_chosen(scenario, run, plan)),
        "clearance": run.model.clearance,
        "equilibria": [vars(e) for e in run.model.interface.equilibria],
        "warnings": [
            caution.sentence for caution in (*run.cautions, *scene_cautions(scenario, run.model), *_of_heat(run.model))
        ],
        "heat": plain(heat_of(run.model.given, run.model.heat)),
        "design_rules": design_rules.findings(scenario, run.model),
        "beside_reynolds": reynolds_comparison(run),
        "size": {key: getattr(size, key) for key in ("turns", "rows", "bytes", "seconds")},
    }


def _of_heat(model) -> list:
    return [] if model.heat is None else heat_cautions(model.given, model.heat)


def rules_of(scenario: Scenario) -> list[dict]:
    """What the design rules find of any scenario, broken ones first.  Raises as `checked`."""
    if isinstance(scenario.scene, RadialScene):
        found = radial_rules.findings(scenario)
    else:
        found = design_rules.findings(scenario, prepare_run(scenario)[0].model)
    order = ("fail", "note", "acknowledged", "pass", "not applicable")
    return sorted(found, key=lambda row: order.index(row["verdict"]))
