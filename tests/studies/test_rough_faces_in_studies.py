"""Studies of a seal that rides on its asperities: the same seal as a run has, and as forces integrated here have.

A flat face, 50 mm, 11 bar; of its closing force asperities carry two fifths.
"""

import math

import numpy as np
import pytest
from oracles import christensen, opening_force
from scenes import started
from scipy.optimize import brentq

from sealdyn.analysis.whirl_in_time import growth_rate
from sealdyn.dynamics.model import Model
from sealdyn.scenario.reader import parse_scenario, with_values
from sealdyn.scene.scene import frozen_at_start, unforced, without
from sealdyn.solvers.contract import Recorder
from sealdyn.solvers.integrate import solve
from sealdyn.studies import coefficients, critical_speed, equilibrium
from sealdyn.studies._runner import run_study
from sealdyn.studies.stability.grid import Grid
from sealdyn.studies.transmissibility.arrangements import measured, seals_of

R_I, R_O, ROUGH, STRENGTH = 0.025, 0.029, 0.15e-6, 180e6
P_O, P_I, RATIO, SPRING = 12e5, 1e5, 0.8, 100.0
AREA = math.pi * (R_O**2 - R_I**2)
CLOSING = (P_O * RATIO + P_I * (1 - RATIO)) * AREA + SPRING
PUMP = """
[shaft]
speed = "309 rad/s"
[film]
model = "radial"
inner_radius = "25 mm"
outer_radius = "29 mm"
coning = "0 mrad"
viscosity = "0.9 mPa*s"
outer_pressure = "12 bar"
inner_pressure = "1 bar"
[closing]
balance_ratio = 0.8
spring_force = "100 N"
[contact]
roughness = "0.15 um"
compressive_strength = "180 MPa"
[rotor]
runout = "1 urad"
[stator]
mass = "0.15 kg"
transverse_inertia = "3e-5 kg*m^2"
polar_inertia = "6e-5 kg*m^2"
[stator.support]
axial_stiffness = "1e5 N/m"
axial_damping = "50 N*s/m"
radius = "27 mm"
[run]
turns = 2
accuracy = 1e-6
"""


@pytest.fixture(scope="module")
def pump():
    return parse_scenario(PUMP, "pump")


def film_force(clearance):
    return opening_force(clearance, 0.0, P_I, P_O, r_i=R_I, r_o=R_O)


def rough_force(clearance):
    return STRENGTH * AREA * christensen(clearance, 3 * ROUGH, 1.0)[0]


def tilted_rough_moment(clearance, tilt):
    """Moment (N m) of the asperities against a tilt about the x axis: h = C + tilt r sin(theta)."""
    r, w = np.polynomial.legendre.leggauss(40)
    r, w = 0.5 * (R_I + R_O) + 0.5 * (R_O - R_I) * r, 0.5 * (R_O - R_I) * w
    theta = 2 * np.pi * np.arange(64) / 64
    rows = [STRENGTH * christensen(clearance + tilt * x * math.sin(a), 3 * ROUGH, 1.0)[0] * x * x * math.sin(a) * v
            for x, v in zip(r, w, strict=True) for a in theta]  # fmt: skip
    return 2 * np.pi / 64 * float(np.sum(rows))


@pytest.fixture(scope="module")
def clearance():
    return brentq(lambda c: film_force(c) + rough_force(c) - CLOSING, 0.05e-6, 0.449e-6, xtol=1e-18)


@pytest.mark.core
def test_equilibrium_is_where_film_and_asperities_carry_the_closing_force(pump, clearance):
    (root,) = equilibrium.run(pump, equilibrium.Settings(points=11), None)["roots"]
    assert root["clearance"] == pytest.approx(clearance, rel=1e-8) and root["stable"]
    assert root["film_force"] == pytest.approx(film_force(clearance), rel=1e-8)
    assert root["contact_force"] == pytest.approx(rough_force(clearance), rel=1e-6) and root["contact_force"] > 300
    supported = (root["film_force"] - P_I * AREA) / (CLOSING - P_I * AREA)
    assert root["load_support"] == pytest.approx(supported, rel=1e-7)
    step = 1e-4 * clearance
    slope = (rough_force(clearance + step) - rough_force(clearance - step)) / (2 * step)
    # Flat faces: the film's force does not change with the clearance.
    assert root["stiffness"] == pytest.approx(-slope, rel=1e-6)


@pytest.mark.parametrize("pressure", ["1 bar", "3.3 bar", "12.7 bar"])
def test_a_film_between_equal_pressures_carries_nothing(pressure):
    """Not what rounding leaves of the film's force less the pressure all around."""
    same = [f"film.{side}_pressure={pressure}" for side in ("inner", "outer")]
    (root,) = equilibrium.run(parse_scenario(PUMP, "pump", same), equilibrium.Settings(points=11), None)["roots"]
    assert root["load_support"] == 0.0 and root["contact_force"] == pytest.approx(100.0, rel=1e-6)


def test_a_run_settles_at_the_equilibrium_of_the_study(pump, clearance):
    """Started 0.05 um further apart: in 0.2 s it is back."""
    scene = with_values(pump, {"rotor.runout": 0.0, "initial.stator.z": "0.05 um"}).scene
    ready, recorder = started(scene, 0.2, 1e-8), Recorder(0.05)
    ready.y0[0] = 0.05e-6
    solve(ready, "bdf", 1e-8, recorder)
    (_, q, _) = recorder.arrays()
    assert q[0, 0] == 0.05e-6
    assert Model(scene).clearance + q[-1, 0] == pytest.approx(clearance, rel=1e-6)


def test_a_secondary_seal_holds_the_ring_beside_its_equilibrium(pump, clearance):
    sealed = with_values(pump, {"stator.secondary_seal": {"radius": "30 mm", "friction_force": "20 N"}})
    found = equilibrium.run(sealed, equilibrium.Settings(points=11), None)
    (root,) = found["roots"]
    assert found["friction"] == pytest.approx(20.0, rel=1e-12)
    wanted = [brentq(lambda c, f=f: film_force(c) + rough_force(c) - CLOSING - f, 0.05e-6, 0.449e-6) for f in (20, -20)]
    assert root["held"] == pytest.approx(wanted, rel=1e-6)
    assert root["clearance"] == pytest.approx(clearance, rel=1e-8)


def test_coefficients_are_the_slopes_of_film_and_asperities(pump, clearance):
    found = coefficients.run(pump, coefficients.Settings(points=3), None).numbers
    alone = Model(frozen_at_start(without(pump.scene, ["contact"]), clearance=clearance)).film_matrices()
    stiffness, step = np.array(found["stiffness"]), 1e-4 * clearance
    axial = (rough_force(clearance - step) - rough_force(clearance + step)) / (2 * step)
    tilt = -tilted_rough_moment(clearance, step / R_O) / (step / R_O)
    assert stiffness[0, 0] - alone[0][0, 0] == pytest.approx(axial, rel=1e-6)
    assert stiffness[1, 1] - alone[0][1, 1] == pytest.approx(tilt, rel=1e-5) and alone[0][1, 1] < 0.01 * tilt
    # Asperities do not damp.
    assert np.array(found["damping"]) == pytest.approx(alone[1], rel=1e-6, abs=1e-6 * alone[1][1, 1])


def test_coefficients_of_tilted_rough_faces(pump, clearance):
    """The same slope about a standing tilt, from forces integrated here."""
    tilt, step = 0.25 * clearance / R_O, 1e-3 * clearance / R_O
    found = coefficients.run(pump, coefficients.Settings(points=3, tilt=tilt), None).numbers["tilted"]
    gap = clearance + found["at"]["axial_opening"]
    slope = -(tilted_rough_moment(gap, tilt + step) - tilted_rough_moment(gap, tilt - step)) / (2 * step)
    assert found["stiffness"][1][1] == pytest.approx(slope, rel=0.01)


def test_whirl_in_time_decays_as_the_eigenvalues_say(pump):
    """A small tilt that is let go, in the nonlinear equations with contact."""
    scene = frozen_at_start(with_values(pump, {"stator.support.axial_damping": 5.0}).scene)
    found = growth_rate(unforced(scene, 309.0), 309.0, 20, "bdf", 1e-7)
    model = Model(unforced(scene, 309.0))
    eigenvalue = max(mode.value.real for mode in model.linear_scene().modes() if mode.kind == "tilt")
    assert found["rate"] == pytest.approx(eigenvalue, rel=1e-3, abs=3 * found["uncertainty"])


def test_stability_map_follows_the_roughness(pump):
    """Of each roughness the map has the growth rate of that scene."""
    values = np.array([0.1e-6, 0.15e-6])
    grid = Grid(pump, {"contact.roughness": values, "stator.support.axial_damping": np.array([10.0, 50.0])})
    total, _ = grid.rates()
    for i, rough in enumerate(values):
        own = with_values(pump, {"contact.roughness": float(rough), "stator.support.axial_damping": 50.0})
        wanted = Model(frozen_at_start(own.scene)).linear_scene().modes()[0].value.real
        assert total[1, i] == pytest.approx(wanted, rel=1e-6)
    assert total[1, 0] != pytest.approx(total[1, 1], rel=0.01)


def test_transmissibility_in_time_is_that_of_linear_algebra(pump):
    seals = seals_of(pump.scene)
    for seal in seals:
        point = {"seal": seal, "speed": 309.0, "accuracy": 1e-8, "longest": 4000.0}
        row = measured(pump.scene, point)
        assert [row[q] for q in ("static", "dynamic")] == pytest.approx(seals[seal].algebra(309.0)[:2], rel=1e-4)


def test_beyond_the_threshold_asperities_bound_the_whirl(pump):
    """The family of whirls of the film alone would be another seal's."""
    model = Model(unforced(pump.scene, 309.0))
    found = critical_speed.beyond(model, pump.scene, 309.0, critical_speed.Settings(), None)
    assert found["tipping"] == [] and "branch" not in found


def test_asperities_that_touch_at_rest_need_no_forcing(pump, tmp_path, clearance):
    answer = run_study("contact-onset", pump, tmp_path / "a.h5")
    assert answer["status"] == "ok" and answer["nonlinear"] == answer["formula"] == 0.0
    assert answer["contact_force"] == pytest.approx(rough_force(clearance), rel=1e-6)
    assert answer["closing_force"] == pytest.approx(CLOSING, rel=1e-9)
