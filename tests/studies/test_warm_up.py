"""Warm-up and Stribeck curve: the start of a pump seal, the end of a course, energy, and the states of speeds."""

import numpy as np
import pytest
from scipy.interpolate import CubicSpline
from warm_seals import INSIDE, warm_seal

import sealdyn
from sealdyn.dynamics.model import Model
from sealdyn.dynamics.warm_state import Warming, at_work, warming
from sealdyn.simulation.heat import heat_cautions
from sealdyn.studies.wear import INFO

RINGS = {
    "stator": {"resistance": 0.3694, "coning_per_watt": 2.5756e-6, "time_constant": 1.169},
    "rotor": {"resistance": 0.04777, "coning_per_watt": 2.494e-7, "time_constant": 0.517},
}
# Made by an independent program without the squeeze of the film: time (s), rise (K), coning (rad), clearance (m), heat.
START = (
    (0.5, 1.5288, 6.8641e-5, 1.9023e-7, 115.68),
    (1.0, 5.0939, 1.1211e-4, 1.8563e-7, 233.14),
    (2.0, 7.8626, 1.4587e-4, 1.8419e-7, 193.87),
    (5.0, 8.0856, 1.4859e-4, 1.8413e-7, 191.16),
)
# By all cells of both rings, of a program of finite volumes: time (s), rise (K), coning (rad), heat (W).
DRAWN = {
    "film.heat": {"stator": {"convection": 13590.0, "wetted_length": 0.012}, "rotor": {"convection": 21572.0}},
    "stator.body": {
        "inner_radius": 0.029, "outer_radius": 0.036, "length": 0.02, "conductivity": 10.0, "modulus": 2e10,
        "poisson": 0.2, "expansion": 4.5e-6, "density": 1800.0, "specific_heat": 750.0,
    },
    "rotor.body": {
        "inner_radius": 0.029, "outer_radius": 0.038, "length": 0.01, "conductivity": 125.0, "modulus": 4.1e11,
        "poisson": 0.16, "expansion": 4e-6, "density": 3100.0, "specific_heat": 670.0,
    },
}  # fmt: skip
START_DRAWN = (
    (0.5, 2.45, 7.22e-5, 112.4),
    (1.0, 6.17, 1.128e-4, 230.1),
    (2.0, 7.65, 1.379e-4, 201.3),
    (5.0, 7.99, 1.506e-4, 189.7),
)


@pytest.fixture
def pump():
    scenario = sealdyn.example("pump_seal")
    return scenario.with_({"film.heat": RINGS})


@pytest.mark.core
def test_start_of_the_pump_is_that_of_an_independent_program(pump, monkeypatch, tmp_path):
    squeezed = Warming.damping
    monkeypatch.setattr(Warming, "damping", lambda self, *at: 1e-2 * squeezed(self, *at))
    found = sealdyn.run_study("warm-up", pump, tmp_path / "found.h5", flags={"start": 1.0, "hold": 4.0})
    for time, *row in START:
        here = [float(CubicSpline(found["time"], found[key])(time)) for key in ("rise", "coning", "clearance", "power")]
        assert here == pytest.approx(row, rel=1e-3), time
    assert found["energy_residual"] < 1e-9


def test_so_is_that_of_rings_from_their_drawings(monkeypatch, tmp_path):
    """Six states a ring beside all cells of both."""
    squeezed = Warming.damping
    monkeypatch.setattr(Warming, "damping", lambda self, *at: 1e-2 * squeezed(self, *at))
    seal = sealdyn.example("pump_seal").with_(DRAWN)
    found = sealdyn.run_study("warm-up", seal, tmp_path / "found.h5", flags={"start": 1.0, "hold": 4.0})
    for time, *row in START_DRAWN:
        here = [float(CubicSpline(found["time"], found[key])(time)) for key in ("rise", "coning", "power")]
        assert here == pytest.approx(row, rel=0.012), time


@pytest.mark.parametrize("drawn", [False, True])
def test_a_run_in_time_follows_the_same_course(drawn, pump, tmp_path):
    """Faces that cone as they warm suck a smooth film thinner at first, which rings in motion show, too; of loads that
    change faster than rings warm the temperature of the start is kept."""
    table = {"time": [0.0, 2.0], "value": [30.0, 308.9]}
    seal = sealdyn.example("pump_seal") if drawn else warm_seal({"film.coning": 5e-5})
    seal = seal.with_({"shaft.speed": table, "run.duration": 1.8, "run.accuracy": 1e-4, "rotor.runout": 1e-9})
    found = sealdyn.study("warm-up", seal, begin="warm").answer
    expected = CubicSpline(found["time"], found["clearance"])
    run = sealdyn.simulate(seal, tmp_path / "run.h5")
    time, thinnest = run.data.time.values, run.data.h_min.values
    assert run.status == "ok"
    assert thinnest == pytest.approx(expected(time), rel=0.01)
    rise = float(CubicSpline(found["time"], found["rise"])(1.8))
    assert run.summary["heat"]["end"]["rise"] == pytest.approx(rise, rel=0.01)
    assert 0.6 < thinnest.min() / thinnest[0] < (1.0 if drawn else 0.8)
    assert Model(seal.scene).course.residual < 1e-9
    quick = seal.with_({"shaft.speed": {"time": [0.0, 0.02], "value": [30.0, 308.9]}})
    assert Model(quick.scene).course is None


def test_a_film_that_collapses_on_the_way_is_told():
    found = []
    for speed in (400.0, 1500.0):
        model = Model(warm_seal(INSIDE, {"shaft.speed": {"time": [0.0, 1.0], "value": [300.0, speed]}}).scene)
        found.append((model.course.collapsed is not None, len(heat_cautions(model.given, model.heat))))
    (steady, few), (collapsed, more) = found
    assert collapsed and not steady and more == few + 1


@pytest.mark.parametrize("rings", [RINGS, None])
def test_course_ends_in_the_warm_state_and_cools_to_the_cold_one(pump, rings, tmp_path):
    scenario = pump if rings else sealdyn.example("pump_seal")
    found = sealdyn.run_study(
        "warm-up", scenario, tmp_path / "found.h5", flags={"hold": 120.0, "stop": 1.0, "rest": 200.0}
    )
    state = warming(scenario.scene).working()
    warm = int(np.searchsorted(found["time"], 121.0))
    for key in ("rise", "coning", "clearance", "power"):
        assert found[key][warm] == pytest.approx(getattr(state, key), rel=2e-3), key
    assert found["energy_residual"] < 1e-8
    assert abs(found["rise"][-1]) < 0.01 * state.rise
    assert found["clearance"][-1] == pytest.approx(found["clearance"][0], rel=1e-2)


@pytest.mark.slow
def test_a_slow_start_from_rest_in_time_goes_along_the_stribeck_curve(pump, tmp_path):
    """Torque and leakage of a run of 100 s; rings of 1.2 s lag behind by a twentieth at the lowest speed here."""
    course = {"shaft.speed": {"time": [0.0, 100.0], "value": [0.0, 308.9]}, "run.duration": 100.0}
    plain = {"run.accuracy": 1e-4, "run.samples_per_turn": 1, "rotor.runout": 1e-9, "stator.misalignment": 0}
    starting = pump.with_({**course, **plain})
    run = sealdyn.simulate(starting, tmp_path / "run.h5")
    found = sealdyn.study("stribeck", starting, speed_from=60.0, points=5).answer
    when = np.array(found["speed"]) / 308.9 * 100.0
    assert run.status == "ok" and found["leakage"][-1] > 1.5 * found["leakage"][0]
    for key, name, within in (("torque", "friction_torque", 0.01), ("leakage", "leakage_inner", 0.05)):
        passed = np.interp(when, run.data.time.values, np.abs(run.data[name].values))
        assert passed == pytest.approx(np.abs(found[key]), rel=within), key


@pytest.mark.parametrize("drawn", [False, True])
def test_stribeck_has_the_warm_state_of_each_speed(drawn, pump, tmp_path):
    """Of rings from their drawings with the convection of that speed, too."""
    pump = sealdyn.example("pump_seal") if drawn else pump
    found = sealdyn.run_study("stribeck", pump, tmp_path / "found.h5", flags={"points": 3})
    for k, speed in enumerate(found["speed"]):
        state = warming(pump.with_(shaft__speed=speed).scene).working()
        assert found["temperature"][k] == pytest.approx(state.rise, rel=1e-6)
        assert found["torque"][k] == pytest.approx(state.torque, rel=1e-6)
        assert found["leakage"][k] == pytest.approx(state.leakage, rel=1e-6)
        assert at_work(pump.scene, speed)[1].rise == pytest.approx(state.rise, rel=1e-8)
    # Unheated faces keep their clearance; their viscous torque grows with the speed.
    assert np.ptp(found["unheated"]["clearance"]) < 1e-9 * found["unheated"]["clearance"][0]
    assert np.all(np.diff(found["unheated"]["torque"]) > 0.0)


def test_cold_faces_at_full_speed_are_no_collapse():
    """What follows the heat at once may balance at a second, far hotter place, which a seal does not jump to: a start
    without duration is the limit of short ones."""
    seal = sealdyn.example("pump_seal").with_({"film.outer_pressure": 5e5})
    at_once, short = (sealdyn.study("warm-up", seal, start=start, hold=0.5).answer for start in (0.0, 0.002))
    assert at_once["collapsed"] is None and max(at_once["power"]) < 2.0 * at_once["power"][0]
    for key in ("rise", "coning", "clearance", "power"):
        here, there = (float(CubicSpline(found["time"], found[key])(0.3)) for found in (at_once, short))
        assert here == pytest.approx(there, rel=0.01), key


def test_loads_with_tables_are_those_of_the_scenario(pump):
    """A speed that stays is no start from rest where a pressure changes; what is asked for beside is added."""
    rising = pump.with_({"film.outer_pressure": {"time": [0.0, 2.0], "value": [5e5, 1.1e6]}})
    speed = pump.scene.shaft.speed
    found = sealdyn.study("warm-up", rising).answer
    assert found["time"][-1] == 2.0 and set(found["speed"]) == {speed}
    found = sealdyn.study("warm-up", rising, hold=3.0, stop=1.0).answer
    assert found["time"][-1] == 6.0 and found["speed"][0] == speed and found["speed"][-1] == 0.0
    turning = pump.with_({"shaft.speed": {"time": [0.0, 2.0], "value": [0.0, speed]}})
    assert sealdyn.study("warm-up", turning, hold=1.0).answer["time"][-1] == 3.0
    for given, key in (({"start": 1.0}, "start"), ({"stop": 1.0}, "stop"), ({"hold": -1.0}, "hold")):
        with pytest.raises(sealdyn.ScenarioError) as error:
            sealdyn.study("warm-up", turning, **given)
        assert error.value.key == f"study.warm_up.{key}"


def test_warm_up_needs_time_constants(pump, tmp_path):
    bare = {name: {**ring, "time_constant": None} for name, ring in RINGS.items()}
    cold = pump.with_({"film.heat": {name: {k: v for k, v in ring.items() if v} for name, ring in bare.items()}})
    with pytest.raises(sealdyn.ScenarioError) as error:
        sealdyn.run_study("warm-up", cold, tmp_path / "found.h5")
    assert error.value.key == "film.heat.stator.time_constant"


def test_a_temperature_that_stays_while_the_speed_changes_is_told(pump):
    turning = pump.with_({"run.turns": 1, "shaft.speed": {"time": [0.0, 0.05], "value": [308.0, 309.0]}})
    told = {name: sealdyn.run(scenario).summary["warnings"] for name, scenario in (("held", pump), ("ramp", turning))}
    assert sum("heat" in line for line in told["ramp"]) == sum("heat" in line for line in told["held"]) + 1


def test_wear_of_warm_faces_says_what_it_holds(pump, tmp_path):
    worn = pump.with_({"contact.stator_wear_coefficient": "1e-15 1/Pa", "rotor.runout": 0, "stator.misalignment": 0})
    found = sealdyn.run_study("wear", worn, tmp_path / "found.h5", flags={"duration": 60.0})
    assert INFO.warm in found["notes"]
    assert found["history"]["cold_coning"][0] == pytest.approx(5e-5, rel=1e-6)
    by_heat = np.subtract(found["history"]["coning"], found["history"]["cold_coning"])
    assert by_heat == pytest.approx(at_work(pump.scene)[1].coned_by, rel=1e-9)
