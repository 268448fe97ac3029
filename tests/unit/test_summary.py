"""What a summary advises."""

from pathlib import Path

import numpy as np
import pytest

from sealdyn.dynamics.signals import signals
from sealdyn.scenario.reader import read_scenario
from sealdyn.simulation.simulate import prepare_run, simulate_in_memory

SEAL = Path(__file__).parents[2] / "scenarios" / "fms_reference.toml"


@pytest.mark.parametrize("start", ["rest", "steady"])
def test_a_run_that_is_not_steady_is_not_told_to_start_as_it_did(start):
    """Above its threshold the reference seal's whirl grows from any start."""
    changes = ["run.turns=3", "run.accuracy=1e-8", "shaft.speed=6500 rad/s", f"run.start='{start}'"]
    sentence = simulate_in_memory(read_scenario(SEAL, changes))["relative_misalignment"]["steady_said"]
    assert sentence.startswith("not steady") and ("run.start" in sentence) == (start == "rest")


@pytest.mark.parametrize("film", ["linear", "radial"])
def test_leakage_runs_from_high_to_low_pressure_also_where_they_turn(film):
    """Pressures that change sides halfway: as much leaks after it as before."""
    changes = [
        f"film.model='{film}'", "film.coning=0", "run.start='rest'", "run.duration='20 ms'", "run.samples=200",
        "rotor.runout=0", "stator.misalignment=0", "closing.balance_ratio=0.8",
        "film.outer_pressure={time=[0, '10 ms', '10.1 ms'], value=['3 bar', '3 bar', '1 bar']}",
        "film.inner_pressure={time=[0, '10 ms', '10.1 ms'], value=['1 bar', '1 bar', '3 bar']}",
    ]  # fmt: skip
    scenario = read_scenario(SEAL, changes)
    run, *_ = prepare_run(scenario)
    first, last = run.segment(0), run.segment(len(run.intervals) - 1)
    n = first.n
    found = [float(signals(part, np.zeros(1), *np.zeros((2, 1, n)))["leakage_inner"][0]) for part in (first, last)]
    assert found[0] > 0 and found[1] == pytest.approx(found[0], rel=0.1)
