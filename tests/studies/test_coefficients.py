"""Coefficients study: against differences of forces from a solver of Reynolds' equation that shares no code."""

from dataclasses import replace

import numpy as np
import pytest
from command import SCENARIOS
from drawn import text_trouble
from oracles import opening_force, radial_wrench
from scipy.optimize import brentq

import sealdyn
from sealdyn import read_scenario, run_study
from sealdyn.analysis.film_matrices import State, matrices
from sealdyn.closed_form import radial_film_coefficients
from sealdyn.dynamics.model import Model
from sealdyn.report.panels import draw
from sealdyn.scenario.reader import with_values
from sealdyn.scene.scene import frozen_at_start
from sealdyn.studies import coefficients
from sealdyn.studies.coefficients import Settings

FACE = (0.032, 0.040, 10e-6, 3.125e-3, False, False)


def answer(name="fmr_reference", overrides=(), **settings):
    settings = {"points": 3} | settings
    return coefficients.run(read_scenario(SCENARIOS / f"{name}.toml", overrides), Settings(**settings), None).numbers


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


@pytest.mark.core
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


def test_cross_stiffness_of_faces_that_turn_against_each_other():
    """A wedge film turns with the mean of both faces: (w + w_s)/2 = -w/4 at w_s = -3/2 w."""
    found = answer("fms_reference", ["stator.speed=-1500 rad/s"])
    k, d = np.array(found["stiffness"]), np.array(found["damping"])
    assert k[1, 2] == pytest.approx(-250 * d[1, 1], rel=1e-9)


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


def balanced(*overrides, **settings):
    """Green's face on a closing force, which decides the clearance."""
    seal = read_scenario(SCENARIOS / "fms_reference.toml", ["film.model=radial"])
    film = replace(seal.scene.film, clearance=None)
    closing = replace(seal.scene.closing, balance_ratio=0.85, spring_force=40.0)
    seal = replace(seal, scene=replace(seal.scene, film=film, closing=closing), read=None)
    return coefficients.run(with_values(seal, dict(overrides)), Settings(**{"points": 2} | settings), None)


def test_a_point_of_the_map_is_the_study_at_that_speed_and_coning():
    found = balanced(speed="500:2000 rad/s:3", coning="2:4 mrad:3").numbers["map"]
    assert found["speed"] == [500.0, 1250.0, 2000.0] and found["coning"] == [0.002, 0.003, 0.004]
    assert found["frequency"] == [0.0] and np.shape(found["stiffness"]) == (3, 1, 3, 3, 3)
    alone = balanced(("shaft.speed", 2000.0), ("film.coning", 0.003)).numbers
    for name in ("stiffness", "damping"):
        assert found[name][2][0][1] == alone[name]
    assert found["clearance"][2][0][1] == alone["at"]["clearance"]


def test_the_map_has_a_row_for_every_point():
    table = balanced(speed="6000:12000 rpm:2", frequency="0, 2 kHz").tables[-1]
    assert table.columns[:2] == [("speed", "speed"), ("frequency", "frequency")]
    speeds, frequencies = (np.pi / 30 * np.array([6000, 12000]), 2 * np.pi * np.array([0.0, 2000.0]))
    wanted = [[w, f] for w in speeds for f in frequencies]
    assert np.array([row[:2] for row in table.rows]) == pytest.approx(np.array(wanted))


def test_the_map_over_coning_is_the_closed_form_at_the_clearance_of_the_closing_force():
    found = balanced(coning="2:4 mrad:3").numbers["map"]
    r_i, r_o, area = 0.032, 0.040, np.pi * (0.040**2 - 0.032**2)
    closing = 0.85 * 5e5 * area + 40.0
    for c, coning in enumerate(found["coning"]):
        clearance = brentq(lambda h, b=coning: opening_force(h, b, 0.0, 5e5) - closing, 1e-6, 1e-4, xtol=1e-16)
        assert found["clearance"][0][0][c] == pytest.approx(clearance, rel=1e-8)
        wanted = radial_film_coefficients(
            inner_radius=r_i, outer_radius=r_o, clearance=clearance, coning=coning, viscosity=0.5e-3,
            pressure_drop=5e5,
        )  # fmt: skip
        k, d = (np.array(found[name][0][0][c]) for name in ("stiffness", "damping"))
        assert [k[1, 1], d[1, 1], k[0, 0], d[0, 0]] == pytest.approx(list(wanted), rel=1e-6)


def test_coning_that_leaves_no_film_is_told():
    whole = balanced(coning="-1:3 mrad:3")
    found = whole.numbers
    assert found["map"]["stiffness"][0][0][0] == [[None] * 3] * 3 and found["table"]["k_axial_axial"][0] is None
    assert found["map"]["failed"][0]["points"] == [{"speed": 1000.0, "coning": -0.001}]
    assert any("No film at 1 points of the map" in said for said in whole.notes)


def test_a_film_that_stores_has_its_own_matrices_at_every_frequency_of_the_map():
    seal = read_scenario(SCENARIOS / "gas_reynolds_reference.toml", ["film.gas_reynolds.cells=[6, 8]"])
    settings = Settings(points=2, frequency="0:2 kHz:3", speed="500, 1000")
    found = coefficients.run(seal, settings, None).numbers["map"]
    assert np.shape(found["damping"]) == (2, 3, 3, 3)
    model = Model(frozen_at_start(seal.scene, speed=1000.0), 1e-10)
    k, d = matrices(model, State(), omega=2 * np.pi * 1000.0)
    for name, wanted in (("stiffness", k), ("damping", d)):
        assert np.max(np.abs(found[name][1][1] - wanted)) < 1e-8 * np.max(np.abs(wanted))
    assert found["stiffness"][1][2][0][0] > 1.01 * found["stiffness"][1][0][0][0]


def test_its_dataset_lies_along_speed_frequency_and_coning(tmp_path):
    axes = {"speed": "500:2000 rad/s:4", "frequency": "0, 100 Hz", "coning": "2:4 mrad:3"}
    seal, out = SCENARIOS / "fmr_reference.toml", tmp_path / "c.h5"
    data = sealdyn.study("coefficients", seal, points=2, workers=1, out=out, **axes).data
    axes = ("map.speed", "map.frequency", "map.coning")
    assert data["map.stiffness"].dims[:3] == axes and data["map.clearance"].dims == axes
    assert data["map.coning"].attrs["units"] == "rad" and data["map.speed"].size == 4
    # Elements by what they are, with coning and without.
    assert data["map.stiffness"].dims[3:] == data["stiffness"].dims == ("force", "motion")
    without = sealdyn.study("coefficients", seal, points=2, workers=1, frequency="0, 100 Hz").data["map.stiffness"]
    assert without.dims == ("map.speed", "map.frequency", "force", "motion")
    cross = without.sel(force="moment_x", motion="tilt_y")
    assert cross.values == pytest.approx(without.values[:, :, 1, 2])
    assert text_trouble(draw(out)) == ([], [])
