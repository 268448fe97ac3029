"""Every public name of the package with its type: checked by mypy, and run (test_typed_door.py)."""

from pathlib import Path
from typing import Any, assert_type

import xarray
from matplotlib.figure import Figure

import sealdyn


def scenarios() -> sealdyn.Scenario:
    """Read, made and changed."""
    assert_type(sealdyn.examples(), dict[str, str])
    scenario = sealdyn.example("fms_reference").with_({"run.turns": 2}, run__samples_per_turn=8)
    assert_type(scenario, sealdyn.Scenario)
    tables = scenario.to_dict()
    assert_type(tables, dict[str, Any])
    assert_type(sealdyn.Scenario.from_dict(tables, "again"), sealdyn.Scenario)
    assert_type(scenario.to_toml(), str)
    assert_type(scenario.unused(), list[str])
    try:
        sealdyn.read_scenario(Path("nothing.toml"), ["run.turns=2"])
    except sealdyn.ScenarioError as error:
        assert_type(error.key, str)
        assert_type(error.expected, str)
    return scenario


def runs(scenario: sealdyn.Scenario, folder: Path) -> None:
    """In memory, in an archive, and as numbers alone."""
    result = sealdyn.run(scenario, {"rotor.runout": "20 urad"})
    assert_type(result, sealdyn.Result)
    assert_type(result.status, str)
    assert_type(result.summary, dict[str, Any])
    assert_type(result.archive, Path | None)
    assert_type(result.data, xarray.Dataset)
    assert_type(result.plot.orbit(turns=2.0), Figure)
    kept = sealdyn.simulate(scenario, folder / "kept.h5", resume=False)
    assert_type(kept, sealdyn.Result)
    with sealdyn.open_archive(folder / "kept.h5") as data:
        assert_type(data, xarray.Dataset)
    assert_type(sealdyn.read_scenario(folder / "kept.h5"), sealdyn.Scenario)
    try:
        sealdyn.open_archive("nothing.h5")
    except sealdyn.ArchiveError as missing:
        assert_type(str(missing), str)
    try:
        numbers = sealdyn.evaluate(scenario, {"film.clearance": "9 um"}, ["h_min.value"])
        assert_type(numbers, dict[str, Any])
    except sealdyn.RunEnded as ended:
        assert_type(ended.status, str)
    # Of pandas a checker knows no types.
    table = sealdyn.sweep(scenario, {"film.coning": [1e-3, "2 mrad"]}, "h_min.value", workers=1)
    assert len(table) == 2
    assert_type(sealdyn.simulate_many(scenario, [{"rotor.runout": 1e-5}], ["h_min.value"], workers=1), xarray.Dataset)


def steps(scenario: sealdyn.Scenario) -> None:
    """A run in steps."""
    seal = sealdyn.Simulation(scenario, {"rotor.runout": "20 urad"})
    seal.set(shaft_speed="990 rad/s", shaft_tilt_x=(1e-6, 0.0, 2.0))
    kept = seal.snapshot()
    assert_type(seal.step(1e-4), dict[str, float])
    seal.restore(kept)
    assert_type(seal.step_to(2e-4)["h_min"], float)
    assert_type(seal.time, float)
    assert_type(seal.units, dict[str, str])
    assert_type(seal.events, list[dict[str, Any]])


def studies(scenario: sealdyn.Scenario, folder: Path) -> None:
    """With an archive and without."""
    answer = sealdyn.study("equilibrium", scenario, workers=1, points=5)
    assert_type(answer, sealdyn.Answer)
    assert_type(answer.verdict, list[str])
    assert_type(answer.data, xarray.Dataset)
    assert_type(answer.plot(), Figure)
    table = sealdyn.shaft_table(scenario, [900.0, "9000 rpm"], whirl_ratio=0.5)
    assert_type(table, dict[str, Any])
    assert_type(sealdyn.dyrobes_table(table, 3, "seal"), str)
    assert_type(sealdyn.run_study("equilibrium", scenario, folder / "e.h5", workers=1), dict[str, Any])


def verbs(scenario: sealdyn.Scenario, folder: Path) -> None:
    """What else the program says."""
    assert_type(sealdyn.check(scenario)["warnings"], Any)
    assert_type(sealdyn.design_rules(scenario), list[dict[str, Any]])
    assert_type(sealdyn.validate("green-1989"), list[dict[str, Any]])
    assert_type(sealdyn.compare(folder / "kept.h5", folder / "kept.h5"), dict[str, Any])
    assert_type(sealdyn.review([folder / "kept.h5"], folder / "page.html"), Path)
    assert_type(sealdyn.animate(folder / "kept.h5", folder / "moved.png"), Path)
    assert_type(sealdyn.schema(), dict[str, Any])
    assert_type(sealdyn.list_studies(), dict[str, str])
    assert_type(sealdyn.list_outputs(scenario), dict[str, str])


def main(folder: Path) -> None:
    """Everything once, archives in a folder."""
    assert_type(sealdyn.__version__, str)
    scenario = scenarios()
    runs(scenario, folder)
    steps(scenario)
    studies(scenario, folder)
    verbs(scenario, folder)
