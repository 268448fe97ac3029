"""Smallest film thickness over the values of any key: how much of it the seal takes.

    SEALDYN_PATH=scenarios/own sealdyn study least-film scenarios/fms_reference.toml \
        --set stator.load.model=gear_pulse --set "stator.load.gear_pulse.force=20 N" \
        --key stator.load.gear_pulse.force --values 10,20,40
"""

from dataclasses import dataclass
from functools import partial
from typing import Any

from sealdyn import Scenario
from sealdyn.answers import Answer, Axis, Panel, Series, Table
from sealdyn.quantities import in_words
from sealdyn.scenario.reader import with_values
from sealdyn.simulation.simulate import simulate_in_memory
from sealdyn.studies import Info

INFO = Info(
    timed=("fms_reference", 1),
    asks="How thin does the film become?",
    units={"value": "1", "h_min": "m"},
    along={"": ("value",)},
    wavy=True,
)


@dataclass(frozen=True)
class Settings:
    """The `[study.least_film]` table."""

    key: str = "rotor.runout"
    """Dotted, of the scenario."""
    values: tuple[float, ...] = (1e-5, 2e-5, 4e-5)
    """Of the key, SI."""


def run(scenario: Scenario, settings: Settings, tools: Any) -> Answer:
    """Smallest film thickness at every value."""
    rows = tools.map(partial(thinnest, scenario), [{settings.key: value} for value in settings.values])
    thin = [row.get("h_min") for row in rows]
    least = min((h for h in thin if h is not None), default=None)
    columns = [("1", settings.key), ("m", "smallest film thickness"), ("1", "failed")]
    lines = [[value, row.get("h_min"), row.get("failed")] for value, row in zip(settings.values, rows, strict=True)]
    panel = Panel(
        "Smallest film",
        Axis("1", settings.key),
        Axis("m"),
        [Series("line", settings.values, thin, style="film circle")],
    )
    numbers = {"value": list(settings.values), "h_min": thin}
    return Answer(numbers, f"The film is at least {in_words('m', least)}.", [Table("films", columns, lines)], [panel])


def thinnest(scenario: Scenario, values: dict[str, float]) -> dict[str, Any]:
    """One point: a module-level function of JSON-able values, so that any process can compute it."""
    return {"h_min": simulate_in_memory(with_values(scenario, values))["h_min"]["value"]}
