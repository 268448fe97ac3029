"""Failures: fourteen places where methods fail, each failing method run beside the one that survives it, and which of
them this seal comes to.

The exhibits are small scenes of published seals (cases/), so that their errors are known; of the scenario the study
says which places it meets and why, and what the program does with it.
"""

import importlib
import pkgutil
from dataclasses import dataclass

from ...scenario.errors import ScenarioError
from ...scene.scene import SceneError
from ...simulation.selection import prepare_run
from ...status import Status
from . import cases

units = {"failing_error": "the row's unit", "survivor_error": "the row's unit", "item": "1", "items": "1"}
ALONG = {"rows": ("item",)}
WITH_WAVES = True


# A scenario (and flags) with which the default settings take so much processor time (s) on one core.
TIMED = ("fms_reference", 41)


@dataclass(frozen=True)
class Settings:
    """Which exhibits."""

    items: tuple[int, ...] | int = ()
    """Numbers of the exhibits to show; empty: all."""


def run(scenario, settings, tools) -> dict:
    """All exhibits in the order of their items, and what the program would choose for the scenario."""
    names = exhibit_names()
    wanted = (settings.items,) if isinstance(settings.items, int) else settings.items
    unknown = set(wanted) - set(names.values())
    if unknown:
        raise ScenarioError(
            scenario.name, "study.failures.items", str(sorted(unknown)), f"items from 1 to {max(names.values())}"
        )
    chosen = [name for name, item in names.items() if item in wanted or not wanted]
    found = tools.map(shown, [{"exhibit": name} for name in chosen], "exhibit")
    rows = []
    own, met = chosen_for(scenario, chosen)
    for name, part in zip(chosen, found, strict=True):
        title = place_of(name)
        shows = part.get("rows") or [{"item": names[name], "title": title, "failed": part["failed"]}]
        rows += [{**row, "met": met.get(name, "")} for row in shows]
    places = [{"item": names[name], "place": place_of(name), "met": why} for name, why in met.items() if why]
    answer = {"rows": rows, "items": sorted({row["item"] for row in rows}), "scenario": own, "met": places}
    if any("failed" in row for row in rows):
        answer["status"] = Status.FAILED
    return {**answer, "verdict": sentences(answer)}


def exhibit_names() -> dict[str, int]:
    """Names of the exhibits there are and their items, in order."""
    found = [m.name for m in pkgutil.iter_modules(cases.__path__) if not m.name.startswith("_")]
    items = {name: importlib.import_module(f"{cases.__name__}.{name}").ITEM for name in found}
    return dict(sorted(items.items(), key=lambda pair: pair[1]))


def place_of(name: str) -> str:
    """What a place is called within a sentence."""
    return name.replace("_", " ").replace("coulomb", "Coulomb")


def shown(point: dict) -> dict:
    """The rows of one exhibit."""
    return {"rows": importlib.import_module(f"{cases.__name__}.{point['exhibit']}").show()}


def chosen_for(scenario, exhibits) -> tuple[dict, dict[str, str]]:
    """Method, why, and warnings that the program has for the scenario before it runs; and {exhibit: what of the
    scenario brings it there, or empty}."""
    try:
        run, plan = prepare_run(scenario)
    except SceneError as error:
        return {"refused": str(error)}, {}
    own = {
        "film": run.model.interface.name,
        "method": plan.method,
        "why": plan.why,
        "warnings": [caution.sentence for caution in run.cautions],
    }
    return own, {
        name: importlib.import_module(f"{cases.__name__}.{name}").meets(scenario.scene, run) for name in exhibits
    }


def tables(answer) -> list:
    """Each method that fails beside the one that survives; then the places this seal comes to."""
    columns = (("", "item"), ("place", "title"), ("fails", "failing"), ("error", "failing_error"),
               ("survives", "survivor"), ("error", "survivor_error"), ("unit", "unit"))  # fmt: skip
    met = (("", "item"), ("this seal comes to", "place"), ("since", "met"))
    return [(answer["rows"], columns), (answer.get("met", []), met)]


def sentences(answer) -> list[str]:
    """The verdict: the places, and what the program does with the scenario."""
    shown = {row["title"] for row in answer["rows"] if "failed" not in row}
    lines = [f"In each of {len(shown)} places a method fails beside one that survives."]
    own = answer["scenario"]
    if "refused" in own:
        lines.append(f"This scenario is refused: {own['refused']}.")
    else:
        met = ", ".join(f"{row['place']} ({row['met']})" for row in answer["met"])
        count = f"{len(answer['met'])} of their {len(answer['items'])} kinds: {met}" if met else "none of them"
        lines.append(f"This seal comes to {count}.")
        warned = f"; warned: {'; '.join(own['warnings'])}" if own["warnings"] else ""
        lines.append(
            f"For this scenario the program takes {own['method']} ({own['why']}) on the {own['film']} film{warned}."
        )
    return lines
