"""sealdyn: time-domain rotor dynamics of flexibly mounted mechanical face seals.

result = sealdyn.run("scenarios/fmr_reference.toml", {"rotor.runout": "50 urad"})
result.summary["h_min"]["value"]                     # m
result.data                                          # xarray Dataset
result.plot.overview()                               # matplotlib Figure
"""

from .numerics import interruption

if interruption.is_the_program():
    # Before anything slow is imported.
    interruption.hear()

from importlib import import_module
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from .analysis.desk import check, compare, design_rules, review, validate
    from .archive import ArchiveError, open_archive
    from .report.charts.animation import animate
    from .scenario.errors import ScenarioError
    from .scenario.reader import Scenario, read_scenario
    from .scenario.templates import example, examples
    from .simulation.batch import simulate_many, sweep
    from .simulation.result import Result
    from .simulation.run import RunEnded, evaluate, list_outputs, run
    from .simulation.simulate import simulate
    from .simulation.stepping import Simulation
    from .studies._asked import study
    from .studies._declared import list_studies, schema
    from .studies._runner import Answer, run_study
    from .studies.shaft_impedance import dyrobes_table, shaft_table

__version__ = "0.1.0"
__all__ = [
    "Answer",
    "ArchiveError",
    "Result",
    "RunEnded",
    "Scenario",
    "ScenarioError",
    "Simulation",
    "animate",
    "check",
    "compare",
    "design_rules",
    "dyrobes_table",
    "evaluate",
    "example",
    "examples",
    "list_outputs",
    "list_studies",
    "open_archive",
    "read_scenario",
    "review",
    "run",
    "run_study",
    "schema",
    "shaft_table",
    "simulate",
    "simulate_many",
    "study",
    "sweep",
    "validate",
]

# Where each name stands; loaded on first use, so that `sealdyn --help` answers at once.
_PLACES = {
    "analysis.desk": ("check", "compare", "design_rules", "review", "validate"),
    "archive": ("ArchiveError", "open_archive"),
    "report.charts.animation": ("animate",),
    "scenario.errors": ("ScenarioError",),
    "scenario.reader": ("Scenario", "read_scenario"),
    "scenario.templates": ("example", "examples"),
    "simulation.batch": ("simulate_many", "sweep"),
    "simulation.result": ("Result",),
    "simulation.run": ("RunEnded", "evaluate", "list_outputs", "run"),
    "simulation.simulate": ("simulate",),
    "simulation.stepping": ("Simulation",),
    "studies._declared": ("list_studies", "schema"),
    "studies._runner": ("Answer", "run_study", "study"),
    "studies.shaft_impedance": ("dyrobes_table", "shaft_table"),
}


if not TYPE_CHECKING:
    # Unseen by type checkers, which would take any name for one of the package's.
    def __getattr__(name: str):
        for place, names in _PLACES.items():
            if name in names:
                return getattr(import_module(f"{__name__}.{place}"), name)
        raise AttributeError(f"module 'sealdyn' has no attribute {name!r}")


def __dir__() -> list[str]:
    return [*__all__, "__version__"]
