"""What a summary advises."""

from pathlib import Path

import pytest

from sealdyn.scenario.reader import read_scenario
from sealdyn.simulation.simulate import simulate_in_memory

SEAL = Path(__file__).parents[2] / "scenarios" / "fms_reference.toml"


@pytest.mark.parametrize("start", ["rest", "steady"])
def test_a_run_that_is_not_steady_is_not_told_to_start_as_it_did(start):
    """Above its threshold the reference seal's whirl grows from any start."""
    changes = ["run.turns=3", "run.accuracy=1e-8", "shaft.speed=6500 rad/s", f"run.start='{start}'"]
    sentence = simulate_in_memory(read_scenario(SEAL, changes))["relative_misalignment"]["steady_said"]
    assert sentence.startswith("not steady") and ("run.start" in sentence) == (start == "rest")
