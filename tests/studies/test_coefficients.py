"""Coefficients study: against differences of forces from a solver of Reynolds' equation that shares no code."""

from pathlib import Path

import numpy as np
import pytest
from oracles import radial_wrench

from sealdyn import read_scenario, run_study
from sealdyn.studies import coefficients
from sealdyn.studies.coefficients import Settings

SCENARIOS = Path(__file__).parents[2] / "scenarios"
FACE = (0.032, 0.040, 10e-6, 3.125e-3, False, False)


def answer(name="fmr_reference", overrides=(), **settings):
    settings = {"points": 3} | settings
    return coefficients.run(read_scenario(SCENARIOS / f"{name}.toml", overrides), Settings(**settings), None)


def by_differences(dz, tilt, speed=1000.0):
    """Stiffness and damping (3, 3) by central differences of the shooting solution."""

    def wrench(moved):
        state = (*moved, 0.5 * speed, 0.5e-3, 0.0, 5e5)
        force, moment, *_ = radial_wrench(FACE, state, 48)
        return np.array([force, moment.real, moment.imag])

    base = np.array([dz, tilt, 0.0, 0.0, 0.0, 0.0])
    steps = np.array([2e-8, 1e-6, 1e-6, 1e-5, 1e-3, 1e-3])
    columns = []
    for k in range(6):
        near, far = (
            (wrench(base + n * steps[k] * np.eye(6)[k]) - wrench(base - n * steps[k] * np.eye(6)[k]))
            / (2 * n * steps[k])
            for n in (1, 2)
        )
        columns.append((4 * near - far) / 3)
    jacobian = -np.array(columns).T
    return jacobian[:, :3], jacobian[:, 3:]


@pytest.mark.parametrize("tilt", [0.0, 150e-6])
def test_matrices_are_the_derivatives_of_the_film_forces(tilt):
    found = answer(tilt=tilt)
    state = (
        found["tilted"] if tilt else {"stiffness": found["stiffness"], "damping": found["damping"], "at": found["at"]}
    )
    stiffness, damping = by_differences(state["at"]["axial_opening"], tilt)
    for got, wanted in ((state["stiffness"], stiffness), (state["damping"], damping)):
        size = np.sqrt(np.outer(np.abs(np.diag(wanted)), np.abs(np.diag(wanted))))
        assert np.max(np.abs(np.array(got) - wanted) / size) < 2e-5


def test_aligned_film_is_isotropic_with_half_speed_cross_stiffness():
    found = answer()
    k, d = np.array(found["stiffness"]), np.array(found["damping"])
    assert k[1, 2] == pytest.approx(500 * d[1, 1], rel=1e-9) and k[2, 1] == pytest.approx(-k[1, 2], rel=1e-9)
    assert k[1, 1] == pytest.approx(5099.5, rel=1e-4) and d[1, 1] == pytest.approx(3.649, rel=1e-3)
    assert np.all(k[0, 1:] == 0) and np.all(d[0, 1:] == 0)


def test_cross_stiffness_of_faces_that_turn_against_each_other():
    """A wedge film turns with the mean of both faces: (w + w_s)/2 = -w/4 at w_s = -3/2 w."""
    found = answer("fms_reference", ["stator.speed=-1500 rad/s"])
    k, d = np.array(found["stiffness"]), np.array(found["damping"])
    assert k[1, 2] == pytest.approx(-250 * d[1, 1], rel=1e-9)
    assert "-0.25 of the shaft speed times the damping (-0.25 for a wedge film)" in found["verdict"][1]


def test_tilted_state_is_the_mean_of_the_linear_steady_state_in_axial_balance():
    found = answer("fmr_reference", ["stator.misalignment=0.25 mrad"])["tilted"]
    k, d, k_s, d_s, w = 5099.5, 3.6486, 400.0, 0.24, 1000.0
    wanted = 0.25e-3 * (k_s - 1j * d_s * w) / (k_s + k - 1j * (d_s + d / 2) * w)
    assert found["at"]["tilt_x"] + 1j * found["at"]["tilt_y"] == pytest.approx(wanted, rel=1e-4)
    dz, tilt = found["at"]["axial_opening"], abs(wanted)
    state = (dz, tilt, 0, 0, 0, 0, 500.0, 0.5e-3, 0.0, 5e5)
    force = radial_wrench(FACE, state, 48)[0] - radial_wrench(FACE, (0, 0, *state[2:]), 48)[0]
    assert dz > 0 and force == pytest.approx(5e5 * dz, abs=1e-4)


def test_a_seal_with_runout_alone_is_linearised_about_its_turning_tilt():
    found = answer("fms_reference", ["stator.misalignment=0"])["tilted"]
    assert found["at"]["whirl"] == 1000.0


def test_a_tilt_without_axial_balance_is_a_row_with_its_reason():
    # A linear film does not feel the faces touch: nothing lifts them off.
    found = answer(overrides=["film.model=linear"], tilt=2e-3)
    assert found["tilted"]["stiffness"] is None and "0.002 rad" in found["tilted"]["said"]


def test_sweeps_follow_green_and_the_damping_law():
    found = answer(overrides=["film.model=linear"], points=5)
    speed = found["against_speed"]
    for w, k, d in zip(speed["speed"], speed["stiffness"], speed["damping"], strict=True):
        assert k[1][2] == pytest.approx(0.5 * w * d[1][1], rel=1e-8, abs=1e-9)
    b = 3.125e-3
    for c, k in zip(found["against_clearance"]["clearance"], found["against_clearance"]["stiffness"], strict=True):
        wanted = np.pi * 5e5 * (b * 0.032 - c) * (0.036 * 0.008 / (2 * c + b * 0.008)) ** 2
        assert k[1][1] == pytest.approx(wanted, rel=1e-7)


def test_wavy_rough_faces(tmp_path):
    """Axial stiffness as the equilibrium has it from its opening force; motion at the shaft's frequency meets more, the
    cavities do not follow."""
    scenario = read_scenario(SCENARIOS / "lebeck_n6.toml", ["film.reynolds.cells_r=6", "film.reynolds.cells_theta=144"])
    found = run_study("coefficients", scenario, tmp_path / "c.h5", flags={"points": 3}, workers=1)
    (root,) = run_study("equilibrium", scenario, tmp_path / "e.h5", flags={"points": 3}, workers=1)["roots"]
    assert found["stiffness"][0][0] == pytest.approx(root["stiffness"], rel=1e-5)
    assert found["synchronous"]["stiffness"][0][0] > 1.05 * found["stiffness"][0][0]
    assert found["at"]["h_min"] == pytest.approx(root["clearance"] - 0.275e-6, rel=1e-9)
    # Six waves do not tell the tilts apart, nor tilt and opening.
    k, d = np.array(found["stiffness"]), np.array(found["damping"])
    assert [k[1, 1], k[1, 2], d[1, 1]] == pytest.approx([k[2, 2], -k[2, 1], d[2, 2]], rel=1e-6)
    assert np.abs(k[0, 1:]).max() < 1e-6 * k[0, 0] * 0.05
    assert any("table of slow motion" in said for said in found["verdict"])
