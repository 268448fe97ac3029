"""Hang-up: the spring against secondary-seal friction and inertia, predicted by the check and seen in the run."""

from pathlib import Path

import numpy as np
import pytest

from sealdyn.analysis.seal_figures import followability
from sealdyn.archive import column
from sealdyn.scenario.reader import read_scenario
from sealdyn.simulation.simulate import prepare_run, simulate

SCENARIO = Path(__file__).parents[2] / "scenarios" / "hang_up.toml"
AMPLITUDE, MASS, SPEED, STIFFNESS, FRICTION = 20e-6, 1.0, 1000.0, 2e5, 15.0


def rule(*changes):
    return followability(prepare_run(read_scenario(SCENARIO, changes))[0].model)


@pytest.mark.core
def test_the_rule_is_spring_against_friction_and_inertia():
    found = rule()
    needed = FRICTION + (MASS * SPEED**2 - STIFFNESS) * AMPLITUDE
    assert found["needed"] == pytest.approx(needed, rel=1e-5)
    assert found["inertia"] == pytest.approx(MASS * AMPLITUDE * SPEED**2, rel=1e-5)
    assert found["available"] == 25.0 and not found["holds"]
    assert rule("closing.spring_force=31.2 N")["holds"]


def test_nothing_to_follow_no_rule():
    assert followability(prepare_run(read_scenario(SCENARIO.parent / "fms_reference.toml"))[0].model) is None


@pytest.mark.parametrize("share,together", [(0.9, False), (1.1, True)])
def test_the_run_parts_where_the_rule_says_so(tmp_path, share, together):
    """A tenth on either side: the gap opens by 1.6 um and the faces never meet again, or by 0.2 um, less than the
    height of the asperities (measured over the spring: 4.7, 1.6, 0.68, 0.33, 0.21, 0.13 um at 0.8, 0.9, 0.95, 1.05,
    1.1, 1.2 times the rule; without air in the gap 1.26 and 0.29 um at 0.95 and 1.05)."""
    needed = rule()["needed"]
    result = simulate(read_scenario(SCENARIO, [f"closing.spring_force={share * needed} N", "run.turns=4"]),
                      tmp_path / "hang_up.h5")  # fmt: skip
    assert result.status == "ok"
    time, gap = (column(result.archive, name) for name in ("time", "axial_gap_change"))
    widest = np.max(gap[time > 2 * np.pi / SPEED])
    force = column(result.archive, "contact_force")[time > 2 * np.pi / SPEED]
    if together:
        assert widest < 0.3e-6 and force.max() > 20.0
    else:
        assert widest > 1e-6 and force.max() == 0.0
    assert result.summary["energy_residual"] < 10 * 1e-5
    assert result.summary["secondary_seal"]["slips"] > 5
