"""A run with contact and stick-slip, stopped and continued, is the run that was never stopped."""

import json
from pathlib import Path

import numpy as np
import pytest

from sealdyn.archive import column, read_info
from sealdyn.dynamics.model import Model
from sealdyn.dynamics.stick_slip import StickSlip
from sealdyn.scenario.reader import read_scenario
from sealdyn.simulation.simulate import simulate

RUB = Path(__file__).parents[2] / "scenarios" / "rub.toml"
SEAL = ["stator.secondary_seal.radius=45 mm", "stator.secondary_seal.line_friction=40 N/m", "run.turns=45"]


@pytest.mark.parametrize("stop_at", [3, pytest.param(9, marks=pytest.mark.slow)])
def test_continued_as_if_never_stopped(tmp_path, stop_at):
    scenario = read_scenario(RUB, SEAL)
    whole = simulate(scenario, tmp_path / "whole.h5")
    calls = iter(range(10**9))
    first = simulate(scenario, tmp_path / "part.h5", stop=lambda: next(calls) == stop_at)
    assert first.status == "interrupted"
    again = simulate(scenario, tmp_path / "part.h5", resume=True)
    assert again.status == "ok"
    # What was done before the stop is in no comparison, unless the run was done again as a whole.
    said = again.summary["certificate"]["said"]
    assert "against a sharper run" in said and (" s on" in said) != any(
        "again, sharper" in reason for reason in again.summary["model"]["reasons"]
    )
    assert again.summary["contact"]["touches"] == whole.summary["contact"]["touches"] > 3
    assert again.summary["secondary_seal"]["sticks"] == whole.summary["secondary_seal"]["sticks"] >= 1
    kinds = [[event["kind"] for event in read_info(path)["events"]] for path in (again.archive, whole.archive)]
    assert kinds[0] == kinds[1]
    scale = 1e-5
    for name in ("h_min", "axial_gap_change"):
        ours, theirs = (column(result.archive, name) for result in (again, whole))
        assert np.max(np.abs(ours - theirs)) < 10 * scenario.run.accuracy * scale


@pytest.mark.core
def test_a_ring_that_has_just_slipped_is_remembered_as_such():
    """It may be captured again only once it has been fast: the archive's state says so."""
    model = Model(read_scenario(RUB, SEAL).scene)
    before, after = StickSlip(model), StickSlip(model)
    before.leaving[0] = True
    after.restore(json.loads(json.dumps(before.state())))
    assert after.leaving == before.leaving and after.stuck == before.stuck
