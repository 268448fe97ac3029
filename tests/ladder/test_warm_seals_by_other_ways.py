"""What a warm seal does not depend on, and what it has in common with seals that are not warm."""

import math

import numpy as np
import pytest
from warm_seals import INSIDE, VG32, scene_of, warm_seal

import sealdyn
from sealdyn import Scenario
from sealdyn.dynamics.warm_state import warming

RINGS = warm_seal().to_dict()["film"]["heat"]
PARTS = ("rise", "coning", "clearance", "viscosity", "power", "loop_gain", "slow")


def states(*changes, **values):
    return warming(scene_of(*changes, **values)).states


def are_alike(found, expected, rel=1e-9):
    assert len(found) == len(expected) > 0
    for one, other in zip(found, expected, strict=True):
        for part in PARTS:
            assert getattr(one, part) == pytest.approx(getattr(other, part), rel=rel), part
        assert one.stable == other.stable


def without(scenario, *keys, **film):
    """The scenario without dotted keys, and with these in [film]."""
    table = scenario.to_dict()
    for key in keys:
        name, _, last = key.rpartition(".")
        held = table
        for part in name.split(".") if name else ():
            held = held[part]
        del held[last]
    table["film"] |= film
    return Scenario.from_dict(table, "seal")


def run(scenario, turns=1):
    result = sealdyn.run(scenario.with_({"run.turns": turns}) if turns else scenario)
    assert result.status == "ok"
    return result


def runs_alike(one, other, rel=1e-6):
    for name in ("h_min", "stator_tilt_x", "stator_z"):
        found, expected = one.data[name].values, other.data[name].values
        assert np.max(np.abs(found - expected)) <= rel * np.max(np.abs(expected)), name
    for part, key in (("leakage", "mean"), ("friction", "power")):
        assert one.summary[part][key] == pytest.approx(other.summary[part][key], rel=rel)


@pytest.mark.core
@pytest.mark.parametrize("changes", [{}, INSIDE], ids=["outside", "inside"])
def test_a_given_clearance_is_the_closing_force_that_holds_it_unheated(changes):
    scenario = warm_seal(changes)
    cold = warming(scenario.scene).cold_state.clearance
    given = without(scenario, "closing", clearance=cold)
    are_alike(warming(given.scene).states, warming(scenario.scene).states, 1e-6)


def test_a_ring_that_is_not_named_is_one_that_takes_nothing():
    alone = {"film.heat": {"stator": RINGS["stator"]}}
    insulated = {"film.heat": {**RINGS, "rotor": {"resistance": 1e12, "coning_per_watt": 1e-6, "time_constant": 1.0}}}
    are_alike(states(alone), states(insulated), 1e-7)
    # All of the heat but the leakage's goes to the one.
    (state,) = states(alone)
    assert state.power - state.carried * state.rise == pytest.approx(state.rise / 0.4055, rel=1e-9)


def test_rings_may_change_places():
    """One temperature: which ring takes which share does not matter."""
    are_alike(states({"film.heat": {"stator": RINGS["rotor"], "rotor": RINGS["stator"]}}), states())


def test_heat_does_not_know_which_way_or_which_ring_turns():
    speed = scene_of().shaft.speed
    are_alike(states(shaft__speed=-speed), states())
    are_alike(states(shaft__speed=0.4 * speed, stator__speed=-0.6 * speed), states())
    one = run(warm_seal(shaft__speed=-speed))
    assert one.summary["friction"]["power"] == pytest.approx(run(warm_seal()).summary["friction"]["power"], rel=1e-6)


def test_a_seal_turned_inside_out_is_as_warm():
    """Of a narrow face, where the two sides of it are all but alike: pressures and cones change sides."""
    narrow = {"film.inner_radius": 0.9995, "film.outer_radius": 1.0005, "shaft.speed": 20.0, "film.coning": 1e-4}
    narrow |= {"film.heat": {"stator": {"resistance": 5e-3, "coning_per_watt": 5e-8, "time_constant": 1.0}}}
    inside_out = {
        "film.coning": -1e-4, "film.outer_pressure": 1e5, "film.inner_pressure": 1.1e6,
        "film.heat": {"stator": {"resistance": 5e-3, "coning_per_watt": -5e-8, "time_constant": 1.0}},
    }  # fmt: skip
    (one,), (other,) = states(narrow), states(narrow | inside_out)
    assert one.rise > 0.1 and one.coning > 1.01e-4
    for part in ("rise", "power", "loop_gain"):
        assert getattr(one, part) == pytest.approx(getattr(other, part), rel=5e-3), part
    assert one.coning == pytest.approx(-other.coning, rel=5e-3)
    # The thinnest film is at the other edge.
    assert one.clearance == pytest.approx(other.clearance + 1e-3 * other.coning, rel=5e-3)


def test_rings_that_take_all_heat_are_those_of_an_isothermal_run():
    cooled = {name: ring | {"resistance": 1e-9, "coning_per_watt": 0.0} for name, ring in RINGS.items()}
    warm = warm_seal({"film.heat": cooled})
    runs_alike(run(warm), run(without(warm, "film.heat")))


def test_without_heat_a_liquid_is_its_numbers():
    """Of the temperature, and of a table of it over time."""
    plain = without(warm_seal({"film.coning": 4e-4}), "film.heat")
    numbers = {"viscosity": 7.976e-4, "density": 995.65, "specific_heat": 4180.0, "vapour_pressure": 4247.0}
    runs_alike(run(plain), run(without(plain, "film.liquid", "film.temperature", **numbers)), 5e-3)


# --- what changes over time ------------------------------------------------------------------------------

TIMES = [0.0, 0.02]


@pytest.mark.parametrize("heat", [False, True], ids=["cold", "warm"])
def test_a_table_of_temperatures_is_one_of_viscosities(heat):
    """With rings that take heat: above the table by the rise that the start has."""
    changing = {"film.temperature": {"time": TIMES, "value": [303.15, 343.15]}, "film.coning": 4e-4}
    warm = warm_seal(changing, run__duration=0.02)
    scenario = warm if heat else without(warm, "film.heat")
    state = warming(warm.scene).states[0]
    rise, coning = (state.rise, state.coning) if heat else (0.0, 4e-4)
    times = np.linspace(*TIMES, 101)
    viscosity = np.exp(-10.57455285 + 552.34120971 / (303.15 + 2000.0 * times + rise - 142.78519617))
    keys = "film.liquid", "film.temperature", *(["film.heat"] if heat else [])
    table = {"time": times.tolist(), "value": viscosity.tolist()}
    one, other = run(scenario, None), run(without(scenario, *keys, viscosity=table, coning=coning), None)
    # Between the points of the table the program has 16 more.
    runs_alike(one, other, 2e-3)


def test_a_table_of_spring_forces_goes_on_with_heat():
    """The spring that the seal starts with decides its heat; what it does later still moves the film."""
    ramp = {"closing.spring_force": {"time": TIMES, "value": [40.0, 80.0]}, "film.coning": 4e-4}
    one = run(warm_seal(ramp, run__duration=0.02), None)
    still = run(warm_seal({"film.coning": 4e-4}, run__duration=0.02), None)
    assert one.data["h_min"].values[0] == pytest.approx(still.data["h_min"].values[0], rel=1e-3)
    assert one.data["h_min"].values[-1] < 0.95 * still.data["h_min"].values[-1]


PRESSED = {"film.coning_per_pressure": 1e-10, "film.coning_reference_pressure": 1e6}


def test_coning_by_pressure_is_coning():
    are_alike(states(PRESSED), states())
    are_alike(states(PRESSED | {"film.coning_reference_pressure": 9e5}), states(film__coning=6e-5))
    # Sealed inside the difference is the other way round, and counts the same.
    at_other = INSIDE | PRESSED | {"film.coning_reference_pressure": 9e5}
    are_alike(states(at_other), states(INSIDE, film__coning=-1.9e-4))


@pytest.mark.parametrize("inside", [False, True], ids=["outside", "inside"])
def test_coning_by_pressure_follows_a_ramp(inside):
    """A run under a pressure that grows is that with a table of the coning."""
    side, sign = ("inner", -1.0) if inside else ("outer", 1.0)
    start = INSIDE if inside else {"film.coning": 2e-4}
    ramp = {f"film.{side}_pressure": {"time": TIMES, "value": [1.1e6, 1.6e6]}}
    law = {"film.coning_per_pressure": sign * 1e-10, "film.coning_reference_pressure": 1e6}
    cold = without(warm_seal(start, ramp, run__duration=0.02), "film.heat")
    by_law = run(cold.with_(law), None)
    table = {"film.coning": {"time": TIMES, "value": [sign * 2e-4, sign * 2.5e-4]}}
    runs_alike(by_law, run(cold.with_(table), None), 1e-5)
    # It matters: half a clearance.
    plain = run(cold, None)
    assert by_law.data["h_min"].values[-1] != pytest.approx(plain.data["h_min"].values[-1], rel=0.05)


def test_coning_by_temperature_follows_the_sealed_liquid_not_the_rise():
    law = {"film.coning_per_kelvin": 1e-6, "film.coning_reference_temperature": 293.15}
    are_alike(states(law), states(film__coning=6e-5))


def test_the_power_of_a_turning_pair_is_torque_times_relative_speed():
    for changes in ({}, INSIDE, {"film.liquid": VG32, "film.temperature": 333.15}):
        (state, *_) = states(changes)
        speed = abs(scene_of(changes).shaft.speed)
        assert state.power - state.flow_power == pytest.approx(state.torque * speed, rel=1e-12)
    assert math.isfinite(state.torque)
