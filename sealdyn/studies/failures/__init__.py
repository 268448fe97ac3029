"""Failures: fourteen places where methods fail, each failing method run beside the one that survives it, and which of
them this seal comes to.

The exhibits are small scenes of published seals (cases/), so that their errors are known; of the scenario the study
says which places it meets and why, and what the program does with it.
"""

import importlib
import pkgutil
from dataclasses import dataclass

from ...answers import Answer, Axis, Panel, Series, Table, table_of
from ...scenario.errors import ScenarioError
from ...scene.scene import SceneError
from ...simulation.selection import prepare_run
from ...status import Status
from .. import Info
from . import cases

INFO = Info(
    timed=("fms_reference", 41),
    asks="Where do methods fail, by how much, and what survives?",
    wavy=True,
    units={"failing_error": "the row's unit", "survivor_error": "the row's unit", "item": "1", "items": "1"},
    along={"rows": ("item",)},
)
# Beginnings of the units that are no share and no angle: each has a panel of its own.
OWN_UNITS = ("right-hand sides per second", "right-hand sides per turn", "dips", "overlap", "unbalanced, N", "Hz")


@dataclass(frozen=True)
class Settings:
    """Which exhibits."""

    items: tuple[int, ...] | int = ()
    """Numbers of the exhibits to show; empty: all."""


def run(scenario, settings, tools) -> Answer:
    """All exhibits in the order of their items, and what the program would choose for the scenario."""
    names = exhibit_names()
    wanted = (settings.items,) if isinstance(settings.items, int) else settings.items
    unknown = set(wanted) - set(names.values())
    if unknown:
        expected = f"items from 1 to {max(names.values())}"
        raise ScenarioError(scenario.name, "study.failures.items", str(sorted(unknown)), expected)
    chosen = [name for name, item in names.items() if item in wanted or not wanted]
    found = tools.map(shown, [{"exhibit": name} for name in chosen], "exhibit")
    rows = []
    own, met = chosen_for(scenario, chosen)
    for name, part in zip(chosen, found, strict=True):
        title = place_of(name)
        shows = part.get("rows") or [{"item": names[name], "title": title, "failed": part["failed"]}]
        rows += [{**row, "met": met.get(name, "")} for row in shows]
    places = [{"item": names[name], "place": place_of(name), "met": why} for name, why in met.items() if why]
    numbers = {"rows": rows, "items": sorted({row["item"] for row in rows}), "scenario": own, "met": places}
    if any("failed" in row for row in rows):
        numbers["status"] = Status.FAILED
    return Answer(numbers, _found(numbers), _tables(numbers), _panels(rows), _notes(numbers))


def exhibits() -> dict[str, tuple]:
    """{name: (item, shows, meets)} of the exhibits there are, by their items."""
    found = {}
    for file in pkgutil.iter_modules(cases.__path__):
        found |= importlib.import_module(f"{cases.__name__}.{file.name}").EXHIBITS
    return dict(sorted(found.items(), key=lambda pair: pair[1][0]))


def exhibit_names() -> dict[str, int]:
    """Names of the exhibits there are and their items, in order."""
    return {name: item for name, (item, *_) in exhibits().items()}


def place_of(name: str) -> str:
    """What a place is called within a sentence."""
    return name.replace("_", " ").replace("coulomb", "Coulomb")


def shown(point: dict) -> dict:
    """The rows of one exhibit."""
    _, shows, _ = exhibits()[point["exhibit"]]
    return {"rows": [row for show in shows for row in show()]}


def chosen_for(scenario, names) -> tuple[dict, dict[str, str]]:
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
    known = exhibits()
    return own, {name: known[name][2](scenario.scene, run) for name in names}


def _tables(numbers) -> list[Table]:
    """Each method that fails beside the one that survives; then the places this seal comes to."""
    names = {"item": "item", "title": "place", "failing": "fails", "failing_error": "error", "survivor": "survives",
             "survivor_error": "error", "unit": "unit"}  # fmt: skip
    met = (("1", "item", "item"), ("1", "this seal comes to", "place"), ("1", "since", "met"))
    return [table_of("places", [("1", words, key) for key, words in names.items()], numbers["rows"]),
            table_of("met", met, numbers["met"])]  # fmt: skip


def _found(numbers) -> str:
    """Which of the places this seal comes to."""
    shown = {row["title"] for row in numbers["rows"] if "failed" not in row}
    found = f"In each of {len(shown)} places a method fails beside one that survives"
    if "refused" in numbers["scenario"]:
        return f"{found}; this scenario is refused: {numbers['scenario']['refused']}."
    met = ", ".join(f"{row['place']} ({row['met']})" for row in numbers["met"])
    count = f"{len(numbers['met'])} of their {len(numbers['items'])} kinds: {met}" if met else "none of them"
    return f"{found}; this seal comes to {count}."


def _notes(numbers) -> list[str]:
    """What the program does with the scenario, and exhibits that failed."""
    own, said = numbers["scenario"], []
    if "refused" not in own:
        warned = f"; warned: {'; '.join(own['warnings'])}" if own["warnings"] else ""
        said.append(f"The program takes {own['method']} ({own['why']}) on the {own['film']} film{warned}.")
    return said + [f"{row['title']}: the exhibit failed: {row['failed']}" for row in numbers["rows"] if "failed" in row]


def _panels(rows) -> list[Panel]:
    """Errors of each method that fails and of the one that survives: shares and angles together, else by unit."""
    rows = [row for row in rows if "failed" not in row]
    by_unit = {unit: [row for row in rows if row["unit"].startswith(unit)] for unit in OWN_UNITS}
    by_unit = {held[0]["unit"]: held for held in by_unit.values() if held}
    shares = [row for row in rows if not row["unit"].startswith(OWN_UNITS)]
    alone = len(by_unit)
    panels = [_panel("Shares and angles (rad)", "error", shares, 0.24 * len(shares) / 3.0 + 0.5)] if shares else []
    tall = max(0.36, panels[0].tall / alone) if panels and alone else 0.4
    for k, (unit, held) in enumerate(by_unit.items()):
        panels.append(_panel("" if k else "In units of their own", unit, held, tall, below=k > 0))
    return panels or [Panel("Errors", note="every exhibit failed")]


def _panel(title: str, unit: str, rows, tall: float, below: bool = False) -> Panel:
    """A line for each row, from the survivor's error to that of the method that fails."""
    known = [error for row in rows for error in (row["failing_error"], row["survivor_error"]) if error]
    low, high = 0.1 * min(known, default=1.0), 10.0 * max(known, default=1.0)
    series = []
    for k, row in enumerate(rows):
        failing, survivor = row["failing_error"], row["survivor_error"]
        series.append(Series("line", [survivor or low, failing or high], [k, k], style="grey thin"))
        if failing is None:
            series.append(Series("words", [high * (low / high) ** 0.1], [k], style="bad", names=["no answer"]))
        if not survivor:
            series.append(Series("words", [low * (high / low) ** 0.07], [k], style="blue", names=["none"]))
    for name, label, style in (("failing_error", "the method that fails", "bad cross"),
                               ("survivor_error", "the survivor", "blue circle")):  # fmt: skip
        there = [k for k, row in enumerate(rows) if row[name]]
        if there:
            series.append(Series("marks", [rows[k][name] for k in there], there, style=f"{style} front",
                                 label=label if title else ""))  # fmt: skip
    words = [f"{'this seal: ' if row['met'] else ''}{row['item']} {row['title']}" for row in rows]
    return Panel(
        title,
        Axis("1", unit, scale="log", low=low, high=high),
        Axis(words=words, low=-0.6, high=len(rows) - 0.4),
        series,
        below=below,
        tall=tall,
        down=True,
    )
