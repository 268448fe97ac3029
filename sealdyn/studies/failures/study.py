"""Failures: twelve places where methods fail, each failing method run beside the one that survives it.

The exhibits are small scenes of the reference seal (exhibits/); the scenario is told what the program does with it.
"""

import importlib
import pkgutil
from dataclasses import dataclass

from ...scenario.errors import ScenarioError
from ...scene.scene import SceneError
from ...simulation.simulate import prepare_run
from ...status import Status
from . import cases

units = {"rows/failing_error": "the row's unit", "rows/survivor_error": "the row's unit"}


@dataclass(frozen=True)
class Settings:
    """`items`: numbers of the exhibits to show (default all twelve)."""

    __pydantic_config__ = {"extra": "forbid"}  # noqa: RUF012

    items: tuple[int, ...] | int = ()


def run(scenario, settings, tools) -> dict:
    """All exhibits in the order of their items, and what the program would choose for the scenario."""
    names = exhibit_names()
    wanted = (settings.items,) if isinstance(settings.items, int) else settings.items
    unknown = set(wanted) - set(names.values())
    if unknown:
        raise ScenarioError(scenario.name, "study.failures.items", str(sorted(unknown)), "items from 1 to 12")
    chosen = [name for name, item in names.items() if item in wanted or not wanted]
    found = tools.map(shown, [{"exhibit": name} for name in chosen], "exhibit")
    rows = []
    for name, part in zip(chosen, found, strict=True):
        title = name.replace("_", " ")
        rows += part.get("rows") or [{"item": names[name], "title": title, "failed": part["failed"]}]
    answer = {"rows": rows, "items": sorted({row["item"] for row in rows}), "scenario": chosen_for(scenario)}
    if any("failed" in row for row in rows):
        answer["status"] = Status.FAILED
    return {**answer, "verdict": sentences(answer)}


def exhibit_names() -> dict[str, int]:
    """Names of the exhibits there are and their items, in order."""
    found = [m.name for m in pkgutil.iter_modules(cases.__path__) if not m.name.startswith("_")]
    items = {name: importlib.import_module(f"{cases.__name__}.{name}").ITEM for name in found}
    return dict(sorted(items.items(), key=lambda pair: pair[1]))


def shown(point: dict) -> dict:
    """The rows of one exhibit."""
    return {"rows": importlib.import_module(f"{cases.__name__}.{point['exhibit']}").show()}


def chosen_for(scenario) -> dict:
    """Method, why, and warnings that the program has for the scenario before it runs."""
    try:
        run, method, why, *_ = prepare_run(scenario)
    except SceneError as error:
        return {"refused": str(error)}
    return {
        "film": run.model.interface.name,
        "method": method,
        "why": why,
        "warnings": [caution.sentence for caution in run.cautions],
    }


def sentences(answer) -> list[str]:
    """The verdict: one line per row, then the scenario."""
    lines = []
    for row in answer["rows"]:
        start = f"{row['item']} {row['title']}: "
        if "failed" in row:
            lines.append(start + f"the exhibit itself failed ({row['failed']})")
        elif "absent" in row:
            lines.append(start + row["absent"])
        else:
            lines.append(
                f"{start}{row['failing']}, {said(row['failing_error'])}; {row['survivor']}, "
                f"{said(row['survivor_error'])} ({row['unit']}).  By default the program {row['default']}."
            )
    own = answer["scenario"]
    if "refused" in own:
        return [*lines, f"this scenario is refused: {own['refused']}"]
    warned = f"; warned: {'; '.join(own['warnings'])}" if own["warnings"] else ""
    return [*lines, f"for this scenario it takes {own['method']} ({own['why']}) on the {own['film']} film{warned}"]


def said(error) -> str:
    """A number as a person reads it; no answer is no number."""
    return "no answer" if error is None else f"{error:.2g}"
