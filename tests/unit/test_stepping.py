"""A run in steps: that of `run`, what is set between steps, snapshots, and what is refused."""

import math
import pickle

import numpy as np
import pytest
from command import SCENARIOS

import sealdyn

# Shaft speed of the reference seals, rad/s.
W = 1000.0


def reference(name="fms_reference", **changes):
    """A shipped seal with other values at its keys, two underscores for a dot."""
    return sealdyn.read_scenario(SCENARIOS / f"{name}.toml").with_(**changes)


def lasting(scenario, end, samples=100):
    """The scenario with a run from rest to an end (s)."""
    run = {"duration": end, "samples": samples, "start": "rest", "accuracy": 1e-6}
    return sealdyn.Scenario.from_dict({**scenario.to_dict(), "run": run})


def misses(state, data, index, scenario):
    """How far the rings of a state are from a run's sample, over the scales of their motion."""
    gap = float(sealdyn.check(scenario)["clearance"])
    scale = {"z": gap, "tilt_x": gap / scenario.scene.film.outer_radius}
    scale["tilt_y"], speed = scale["tilt_x"], abs(float(data.shaft_speed.max())) or W
    found = []
    for ring in ("rotor", "stator"):
        for part, size in scale.items():
            if f"{ring}_{part}_rate" in data:
                found.append(abs(state[f"{ring}_{part}"] - float(data[f"{ring}_{part}"][index])) / size)
                rate = f"{ring}_{part}_rate"
                found.append(abs(state[rate] - float(data[rate][index])) / size / speed)
    return max(found)


GAS = {"run.turns": 0.1, "run.samples_per_turn": 320, "film.gas_reynolds": {"cells": [6, 16]}, "run.accuracy": 1e-5}


@pytest.mark.parametrize(("name", "changes", "factor"), [
    ("fms_reference", {"run.turns": 2}, 3.0),
    ("impact", {}, 3.0),
    ("gas_reynolds_reference", GAS, 3.0),
    ("massless_ring", {"run.turns": 1}, 3.0),
])  # fmt: skip
def test_steps_of_any_size_make_the_run(name, changes, factor):
    """Of a liquid, with contact, of a film with unknowns, of a ring without mass; from a thousandth of the run to half
    of it at a time.  Contacts are those of the run, wherever steps end."""
    scenario = reference(name).with_(changes)
    result = sealdyn.run(scenario)
    data, seal = result.data, sealdyn.Simulation(scenario)
    last, least = data.sizes["time"] - 1, math.inf
    for index in (1, 2, 3, 5, last // 4, last // 4 + 1, last // 2, last):
        state = seal.step_to(float(data.time[index]))
        least = min(least, state["least_h_min"])
        assert misses(state, data, index, scenario) < factor * scenario.run.accuracy
        assert state["h_min"] == pytest.approx(float(data.h_min[index]), rel=10 * scenario.run.accuracy)
    assert least == pytest.approx(result.summary["h_min"]["value"], rel=10 * scenario.run.accuracy)
    contacts = [event for event in seal.events if event["kind"] == "contact"]
    told = result.summary["contact"] or {"touches": 0}
    assert len(contacts) == told["touches"]
    if contacts:
        assert contacts[0]["time"] == pytest.approx(told["first"], rel=1e-4)
        assert contacts[0]["lift_off"] - contacts[0]["time"] == pytest.approx(told["longest"], rel=1e-4)


def test_a_contact_is_the_same_in_one_step_and_in_many():
    """Deeper than any end of a step, and over several of them."""
    scenario, found = reference("impact"), []
    for steps in (1, 40):
        seal = sealdyn.Simulation(scenario)
        for _ in range(steps):
            seal.step(4e-4 / steps)
        found.append(seal.events[0])
    for key in ("time", "deepest", "lift_off", "value", "impulse"):
        assert found[0][key] == pytest.approx(found[1][key], rel=1e-4)


@pytest.mark.parametrize(("table", "name", "numbers"), [
    ("shaft.speed", "shaft_speed", (W, 1200.0, 0.0)),
    ("shaft.speed", "shaft_speed", (W, W, 2e4)),
    ("film.outer_pressure", "outer_pressure", (5e5, 5.2e5, 0.0)),
    ("film.outer_pressure", "outer_pressure", (5e5, 5e5, 1e6)),
])  # fmt: skip
def test_what_is_set_does_what_a_table_does(table, name, numbers):
    """A step and a ramp of speed and pressure, with the closing force that follows it."""
    before, after, rate = numbers
    at, end = 3e-3, 6e-3
    ramp = {"time": [0.0, at, at, end], "value": [before, before, after, after + rate * (end - at)]}
    plain = lasting(reference(), end)
    data = sealdyn.run(plain.with_({table: ramp})).data
    seal = sealdyn.Simulation(plain)
    seal.step(at)
    seal.set(**{name: (after, rate)})
    for _ in range(3):
        state = seal.step((end - at) / 3)
    assert misses(state, data, -1, plain) < 5e-6
    for key in ("shaft_speed", "closing_force", "film_force", "leakage_inner", "friction_torque"):
        assert state[key] == pytest.approx(float(data[key][-1]), rel=2e-5)
    assert math.remainder(state["shaft_angle"] - float(data.shaft_angle[-1]), 2 * np.pi) == pytest.approx(0, abs=1e-9)


@pytest.mark.parametrize("carrier", ["shaft", "housing"])
def test_motion_of_a_carrier_is_that_of_its_samples(carrier):
    """A parabola, set anew on the way, and the same by samples; of a shaft that is the rotor, and of a housing behind
    springs."""
    motion = {"z": (1e-7, 2e-4, 0.1), "tilt_x": (0.0, 1e-3, -0.5), "tilt_y": (2e-6, 0.0, 0.7)}
    time = np.linspace(0.0, 4e-3, 9)
    values = {k: (x + v * time + 0.5 * a * time**2).tolist() for k, (x, v, a) in motion.items()}
    scenario = lasting(reference(rotor__runout=1e-5), time[-1])
    sampled = {"time": time.tolist(), "axial": values["z"], "tilt_x": values["tilt_x"], "tilt_y": values["tilt_y"]}
    data = sealdyn.run(scenario.with_({f"{carrier}.motion": sampled})).data
    seal = sealdyn.Simulation(scenario)
    seal.set(**{f"{carrier}_{part}": terms for part, terms in motion.items()})
    seal.step(1.5e-3)
    t = seal.time
    # As another program would say it, from where it is.
    seal.set(**{f"{carrier}_{k}": (x + v * t + 0.5 * a * t * t, v + a * t, a) for k, (x, v, a) in motion.items()})
    state = seal.step_to(float(data.time[-1]))
    assert misses(state, data, -1, scenario) < 5e-6


LINEAR = {"film.model": "linear", "film.coefficients": {
    "tilt_stiffness": 3000.0, "tilt_damping": 1.5, "axial_stiffness": 4e6, "axial_damping": 2000.0}}  # fmt: skip


@pytest.mark.parametrize("ring", ["stator", "rotor"])
def test_loads_on_a_ring_move_it_as_its_springs_let_it(ring):
    """Where it comes to rest in a linear film: force over both springs, moment over both and the film's cross
    stiffness; and shaft and housing carry them."""
    name = {"stator": "fms_reference", "rotor": "fmr_reference"}[ring]
    given = {"rotor.misalignment": 0.0, "stator.misalignment": 0.0, "rotor.runout": 0.0, "run.accuracy": 1e-8}
    scenario = reference(name).with_({**LINEAR, **given})
    seal = sealdyn.Simulation(scenario)
    force, moment = 2.0, 0.02 + 0.01j
    seal.set(**{f"{ring}_force": force, f"{ring}_moment_x": moment.real, f"{ring}_moment_y": f"{moment.imag} N*m"})
    state = seal.step(0.4)
    support = getattr(scenario.scene, ring).support
    k_z, (k, d) = support.axial_stiffness, support.tilt()
    # A damper that turns with the rotor: -i w d; the film's, at the mean spin.
    turned = (-1j * W * d if ring == "rotor" else 0.0) - 1j * 0.5 * W * 1.5
    tilt = moment / (k + 3000.0 + turned)
    assert state[f"{ring}_z"] == pytest.approx(force / (k_z + 4e6), rel=1e-5)
    assert complex(state[f"{ring}_tilt_x"], state[f"{ring}_tilt_y"]) == pytest.approx(tilt, rel=1e-5)
    assert state["shaft_force"] + state["housing_force"] == pytest.approx(force, rel=1e-5)
    carried = [complex(state[f"{c}_moment_x"], state[f"{c}_moment_y"]) for c in ("shaft", "housing")]
    assert sum(carried) == pytest.approx(moment, rel=1e-5)


def test_a_snapshot_is_gone_back_to_and_on_from():
    """To the bit, with what was imposed; also in another simulation of the same seal, and from its pickle."""
    scenario = reference("impact")
    seal = sealdyn.Simulation(scenario)
    seal.step(5e-5)
    seal.set(shaft_speed=(900.0, 10.0), outer_pressure=5.01e5)
    seal.step(3e-5)
    kept = seal.snapshot()
    first = [seal.step(4e-5) for _ in range(3)], seal.events
    seal.restore(kept)
    assert seal.time == kept.time and not seal.events
    again = [seal.step(4e-5) for _ in range(3)], seal.events
    other = sealdyn.Simulation(scenario)
    other.restore(pickle.loads(pickle.dumps(kept)))
    assert first == again == ([other.step(4e-5) for _ in range(3)], other.events)
    with pytest.raises(ValueError, match="snapshot"):
        sealdyn.Simulation(reference("fms_reference")).restore(kept)


def test_a_set_is_kept_by_a_snapshot_before_the_next_step():
    seal = sealdyn.Simulation(reference())
    seal.step(1e-3)
    seal.set(shaft_tilt_x=1e-6, shaft_speed=(W, 5e4))
    kept = seal.snapshot()
    first = seal.step(1e-3)
    seal.restore(kept)
    assert seal.step(1e-3) == first and first["shaft_angle"] == pytest.approx(2.0 + 0.5 * 5e4 * 1e-6, rel=1e-12)


def test_the_state_shows_what_has_just_been_set():
    seal = sealdyn.Simulation(reference(rotor__runout=0.0))
    before = seal.step(1e-3)
    seal.set(shaft_tilt_y="2 urad", inner_pressure="0.5 bar")
    state = seal.state
    assert state["rotor_tilt_y"] == 2e-6 and state["time"] == before["time"]
    assert state["film_force"] > before["film_force"]
    assert set(seal.units) == set(state)


def test_a_film_that_closes_ends_it():
    seal = sealdyn.Simulation(reference())
    seal.step(1e-3)
    seal.set(shaft_tilt_x=(0.0, 1.0))
    for _ in range(2):
        with pytest.raises(sealdyn.RunEnded) as ended:
            seal.step(1e-2)
    assert ended.value.status == "collapsed"
    assert 1e-3 < seal.time < 1.1e-2 and seal.state["h_min"] < 2e-8


@pytest.mark.parametrize(("name", "values", "key", "found"), [
    ("fms_reference", {"shaft_sped": 900.0}, "shaft_sped", "nothing"),
    ("fms_reference", {"shaft_speed": "900 m"}, "shaft_speed", "900 m"),
    ("fms_reference", {"shaft_speed": (900.0, 1.0, 2.0)}, "shaft_speed", "900"),
    ("fms_reference", {"shaft_z": (0.0, math.nan)}, "shaft_z", "nan"),
    ("fms_reference", {"shaft_z": ()}, "shaft_z", ""),
    ("fms_reference", {"rotor_moment_x": 0.1}, "rotor_moment_x", "rigid"),
    ("fmsr_both_flexible", {"stator_force": 1.0}, "stator_force", "two"),
    ("pump_seal", {"shaft_speed": 300.0}, "shaft_speed", "heat"),
])  # fmt: skip
def test_what_cannot_be_set_is_refused(name, values, key, found):
    seal = sealdyn.Simulation(reference(name))
    with pytest.raises(sealdyn.ScenarioError) as error:
        seal.set(**values)
    assert error.value.key == key and found in error.value.found


@pytest.mark.parametrize("duration", [0.0, -1.0, math.nan, math.inf])
def test_no_step_goes_back_or_nowhere(duration):
    seal = sealdyn.Simulation(reference())
    with pytest.raises(ValueError, match="duration"):
        seal.step(duration)
    with pytest.raises(ValueError, match="time"):
        seal.step_to(duration)


@pytest.mark.parametrize(("name", "changes", "key"), [
    ("radial/lip_reference", {}, "radial"), ("fms_reference", {"film.model": "linear", "run.solver": "expm"},
                                             "run.solver"),
])  # fmt: skip
def test_what_cannot_be_stepped_is_refused(name, changes, key):
    with pytest.raises(sealdyn.ScenarioError) as error:
        sealdyn.Simulation(reference(name).with_(changes))
    assert error.value.key == key
