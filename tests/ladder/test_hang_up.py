"""Hang-up: the spring against secondary-seal friction and inertia, predicted by the check and seen in the run."""

import numpy as np
import pytest
from command import SCENARIOS

from sealdyn.analysis.seal_figures import followability
from sealdyn.archive import column
from sealdyn.scenario.reader import read_scenario
from sealdyn.simulation.simulate import prepare_run, simulate

SCENARIO = SCENARIOS / "hang_up.toml"
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


TILT = ("rotor.axial_runout=[]", "rotor.runout=300 urad", "shaft.speed=2000 rad/s", "initial.stator.z=14 um")


def test_a_face_that_runs_out_asks_for_friction_and_inertia_of_the_tilt():
    """Friction of a ring that tilts alone, 2 R/pi of its breakaway force, a quarter turn ahead of inertia less springs;
    at most on the arm of the outer radius."""
    inertia, speed, tilt, radius, face = 8e-4, 2000.0, 300e-6, 0.045, (0.032, 0.040)
    friction = 2.0 * radius * FRICTION / np.pi
    springs = (0.5 * STIFFNESS * 0.04**2 - inertia * speed**2) * tilt
    moment, found = np.hypot(friction, springs), rule(*TILT)
    assert found["needed"] == pytest.approx(moment / face[1], rel=1e-9)
    assert found["sure"] == pytest.approx(moment * 4 * face[1] / (face[0] ** 2 + face[1] ** 2), rel=1e-9)
    assert not found["holds"] and rule(*TILT, "closing.spring_force=26 N")["holds"]
    # Slow, the ring that has parted asks for more than one that tilts.
    assert rule(*TILT, "shaft.speed=1000 rad/s", "rotor.runout=200 urad")["needed"] == pytest.approx(FRICTION)


def test_both_runouts_ask_for_less_than_their_sum():
    """The circle integral of friction, here by its midpoint rule, of a ring that slides and tilts at once."""
    waves = "[{order=1,amplitude=20e-6},{order=2,amplitude=4e-6,phase=0.9}]"
    changes = (f"rotor.axial_runout={waves}", "rotor.runout=200 urad", "initial.stator.z=40 um")
    phi = np.linspace(0.0, 2 * np.pi, 721)
    theta = (np.arange(4000) + 0.5) * 2 * np.pi / 4000
    turned, radius, w = 200e-6 * np.exp(1j * phi), 0.045, SPEED
    rate, q = -w * (AMPLITUDE * np.sin(phi) + 8e-6 * np.sin(2 * phi + 0.9)), 1j * w * turned
    sliding = np.sign(rate[:, None] + radius * (np.outer(q.real, np.sin(theta)) - np.outer(q.imag, np.cos(theta))))
    force = -FRICTION * np.mean(sliding, axis=1)
    moment = FRICTION * radius * np.mean(sliding * (np.sin(theta) - 1j * np.cos(theta)), axis=1)
    moment = moment + (0.5 * STIFFNESS * 0.04**2 - 8e-4 * w**2) * turned
    pull = (MASS * w**2 - STIFFNESS) * AMPLITUDE * np.cos(phi)
    pull = pull + (4 * MASS * w**2 - STIFFNESS) * 4e-6 * np.cos(2 * phi + 0.9)
    assert rule(*changes)["needed"] == pytest.approx(np.max(pull + force + np.abs(moment) / 0.04), rel=1e-3)


def test_nothing_to_follow_no_rule():
    assert followability(prepare_run(read_scenario(SCENARIO.parent / "fms_reference.toml"))[0].model) is None


@pytest.mark.parametrize("share,together", [(0.9, False), (1.1, True)])
def test_the_run_parts_where_the_rule_says_so(tmp_path, share, together):
    """A tenth on either side: the gap opens by 1.6 um and the faces never meet again, or by 0.2 um, less than the
    height of the asperities (measured over the spring: 4.7, 1.6, 0.68, 0.33, 0.21, 0.13 um at 0.8, 0.9, 0.95, 1.05,
    1.1, 1.2 times the rule; without air in the gap 1.26 and 0.29 um at 0.95 and 1.05)."""
    needed = rule()["needed"]
    result = simulate(read_scenario(SCENARIO, [f"closing.spring_force={share * needed} N", "run.turns=2"]),
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
    assert result.summary["secondary_seal"]["slips"] > 3
