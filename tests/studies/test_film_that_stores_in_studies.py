"""Studies of a film that stores (radial_cells.py): right at the motion's frequency, or refused with one sentence."""

import numpy as np
import pytest
from command import SCENARIOS
from in_process import InProcess
from radial_cells import film_of

from sealdyn import read_scenario
from sealdyn.analysis.shooting import NoOrbit
from sealdyn.dynamics import interface, modes, stability_thresholds
from sealdyn.dynamics.model import Model
from sealdyn.dynamics.stability_thresholds import one_by_one
from sealdyn.scenario.reader import with_values
from sealdyn.scene.scene import frozen_at_start
from sealdyn.simulation.simulate import simulate_in_memory
from sealdyn.studies import campbell, contact_onset, critical_speed, stability, steady_state, transmissibility
from sealdyn.studies.runup import Settings as RunupSettings
from sealdyn.studies.runup.plan import planned
from sealdyn.studies.runup.ramp_run import overshoot, quasi_static
from sealdyn.studies.transmissibility.arrangements import seals_of

STORING = 1e-6


@pytest.fixture(autouse=True)
def stored(monkeypatch):
    """Every film is one that stores."""
    monkeypatch.setattr(interface, "film_of", lambda scene, film=None: film_of(8, 8, STORING))


def reference(arrangement="fms", *overrides):
    return read_scenario(SCENARIOS / f"{arrangement}_reference.toml", ["film.model=radial", *overrides])


def modes_at(scenario, speed):
    return Model(frozen_at_start(scenario.scene)).linear_scene(speed=speed).modes()


@pytest.mark.parametrize("arrangement", ["fms", "fmr"])
def test_campbell_follows_the_modes_of_every_speed(arrangement):
    scenario = reference(arrangement)
    found = campbell.run(scenario, campbell.Settings(points=25, speed_to=9000.0), InProcess()).numbers
    for i in (0, 8, 24):
        expected = [m.value for m in modes_at(scenario, found["speed"][i])]
        for mode in found["modes"]:
            signed = mode["growth_rate"][i] + 1j * mode["signed_frequency"][i]
            assert min(min(abs(signed - v), abs(signed - v.conjugate())) for v in expected) < 1e-6 * abs(signed)
    # What oscillates is smooth.
    for mode in found["modes"]:
        signed = np.array(mode["signed_frequency"])
        assert np.abs(np.diff(signed, 2)).max() < 0.5 * max(np.ptp(signed), 1.0)


def test_campbell_crosses_zero_damping_at_the_critical_speed():
    scenario = reference()
    found = campbell.run(scenario, campbell.Settings(points=61, speed_to=12000.0), InProcess()).numbers
    model = Model(frozen_at_start(scenario.scene))
    critical = stability_thresholds.thresholds(one_by_one(lambda w: model.linear_scene(speed=w)), 300.0, 3e4, 40)[0]
    crossing = next(p["speed"] for p in found["thresholds"] if p["what"] == "damping")
    assert crossing == pytest.approx(critical, rel=1e-4)


def test_stability_map_is_that_of_every_scene():
    scenario = reference()
    settings = stability.Settings(x="shaft.speed=1000:9000:3", y="film.viscosity=3e-4,5e-4", confirm=0)
    found = stability.run(scenario, settings, InProcess())
    for j, viscosity in enumerate((3e-4, 5e-4)):
        for i, speed in enumerate((1000.0, 5000.0, 9000.0)):
            expected = modes_at(with_values(scenario, {"film.viscosity": viscosity}), speed)
            assert found["growth_rate"][j][i] == pytest.approx(expected[0].value.real, rel=1e-8)
    rotor = frozen_at_start(reference("fmr").scene)
    assert stability.unconditional(rotor)["limit"] is None


@pytest.mark.slow
def test_critical_speed_has_no_formula_and_no_family_of_whirls():
    scenario = reference()
    answer = critical_speed.run(scenario, critical_speed.Settings(turns=20), InProcess())
    assert answer["formula"] is None and answer["formula_reason"]
    assert answer["time_domain"]["value"] == pytest.approx(answer["eigenvalue"], rel=1e-3)
    assert answer["nonlinear"]["tipping"] == [] and answer["nonlinear"]["verdict"]


@pytest.mark.core
def test_transmissibility_is_harmonic_balance_alone():
    scenario = reference()
    settings = transmissibility.Settings(points=3, speed_to=3000.0, time_points=1)
    answer = transmissibility.run(scenario, settings, InProcess())
    assert not answer["formula_holds"] and all("failed" in row for row in answer["time_domain"])
    seal = seals_of(scenario.scene)["fms"]
    linear = seal.linear(3000.0)
    slow = linear.at_frequency(0.0)
    assert not seal.formula_holds(0.0)
    turning = modes.Harmonic(3000.0, 1, np.array([0, 1, -1j]), np.zeros(3))
    fast, other = (abs(np.dot([0, 1, 1j], s.relative(turning, s.response(turning)))) / 2 for s in (linear, slow))
    assert answer["fms"]["dynamic"][-1] == pytest.approx(fast, rel=1e-9)
    assert abs(fast / other - 1) > 0.05


def test_the_onset_is_run_in_time():
    """Without orbits; a slower ramp, held at its end, touches there and not below."""
    scenario = reference("fms", "run.duration=5 ms")
    point = {"key": "rotor.runout", "margin": 1e-3, "tolerance": 1e-6, "most": 1e3, "set": {}, "floor": False}
    row = contact_onset.onset(scenario, point)
    assert "path" not in row and "multiplier" not in row and row["formula"] > 0
    assert row["nonlinear"] == row["ramps"][-1] == pytest.approx(row["ramps"][0], rel=0.01)

    def held(value):
        ramp = {"time": [0.0, 0.06], "value": [0.0, value]}
        values = {"rotor.runout": ramp, "run.duration": 0.09, "run.start": "steady", "film.floor": point["margin"]}
        return simulate_in_memory(with_values(scenario, values))

    assert held(0.95 * row["nonlinear"])["status"] == "ok"
    assert held(1.02 * row["nonlinear"])["status"] == "collapsed"


def test_runup_is_planned_by_the_modes_at_speed():
    scenario = reference()
    plan = planned(scenario, RunupSettings())
    model = Model(frozen_at_start(scenario.scene))
    expected = stability_thresholds.thresholds(one_by_one(lambda w: model.linear_scene(speed=w)), 300.0, 3e4, 40)[0]
    assert plan["threshold"] == pytest.approx(expected, rel=1e-6) and plan["mode"] is None


def test_a_slow_ramp_of_a_pressure_has_the_leakage_at_rest():
    found = quasi_static(reference(), "film.outer_pressure", 5e5, 3e5)
    assert all(np.isfinite(found["leakage"])) and found["leakage"][0] > found["leakage"][-1] > 0
    none = {"h_min": [1e-6, 1.0001e-6], "relative_misalignment": [1e-6, 1e-6], "leakage": [1e-9, 2e-9]}
    row = {"h_min": 0.9995e-6, "relative_misalignment": 1e-6, "leakage": 2e-9, "leakage_least": 1e-9}
    assert overshoot(row, none)["h_min"] is None and overshoot(row, none)["leakage"] == 0.0


def test_summary_has_modes_and_steady_state_at_their_frequencies():
    scenario = reference("fms", "run.duration=30 ms", "run.start=steady")
    summary = simulate_in_memory(scenario)
    expected = modes_at(scenario, scenario.scene.shaft.speed)
    assert summary["stability"]["growth_rate"] == pytest.approx(expected[0].value.real, rel=1e-8)
    assert "static_transmissibility" not in summary["closed_form"]
    tilt, theory = summary["relative_misalignment"], summary["closed_form"]
    # The rest is the film's nonlinearity.
    assert theory["relative_max"] == pytest.approx(tilt["steady_max"], rel=1e-4)


def test_a_steady_state_of_a_film_that_stores_is_told_from_time(monkeypatch):
    """Where no orbit of rings and film is found."""
    monkeypatch.setattr(steady_state.FilmBalance, "find", lambda self: raised(NoOrbit("none")))
    scenario = reference("fms", "run.duration=3 ms", "run.accuracy=1e-2")
    found = steady_state.run(scenario, steady_state.Settings(), InProcess())
    assert found["orbit"] is None and found["h_min"]["value"] > 0
    assert found["reason"] in found.found


def raised(error):
    raise error


def test_a_steady_state_of_a_film_that_stores_is_that_of_rings_and_film():
    """Of little forcing it is the linear one; whether the seal keeps it is not known."""
    found = steady_state.run(reference("fms"), steady_state.Settings(), InProcess())
    assert found["multipliers"] is None and found["stable"] is None and found.notes
    tilt, theory = found["relative_misalignment"], found["linear"]
    assert tilt["max"] == pytest.approx(theory["relative_max"], rel=1e-3)
    assert tilt["min"] == pytest.approx(theory["relative_min"], rel=1e-2)
    assert max(found["orbit"]["relative_misalignment"]) == pytest.approx(tilt["max"], rel=1e-3)
