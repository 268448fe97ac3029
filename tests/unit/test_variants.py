"""Other values at dotted keys: of scenes as they are, and of scenarios as a user writes them."""

import pickle
from dataclasses import replace

import pytest
from command import SCENARIOS
from scenes import fmr, fms

from sealdyn.numerics.piecewise_linear import PiecewiseLinear
from sealdyn.scenario import reader
from sealdyn.scenario.overrides import overrides_of
from sealdyn.scenario.reader import ScenarioError, parse_scenario
from sealdyn.scene.checks import scene_errors
from sealdyn.scene.excitation import AxialVibration, Housing
from sealdyn.scene.forces import Contact
from sealdyn.scene.patterns import Waviness
from sealdyn.scene.rings import AxialRunout, Support
from sealdyn.scene.scene import SceneError, counterpart, part, tables_at_end, with_values

TEXT = (SCENARIOS / "fms_reference.toml").read_text()
TONE = '\n[[housing.axial]]\nfrequency = "50 Hz"\ndisplacement = "1 um"\n'
RAMP = PiecewiseLinear((0.0, 0.5), (100.0, 900.0))
ROUGH = Contact(roughness=2e-7, compressive_strength=3e8)
SHAKEN = replace(fms(), housing=Housing(axial=[AxialVibration(50.0, 1e-6), AxialVibration(60.0, 2e-6)]))


@pytest.mark.parametrize(
    "key, value",
    [
        ("rotor.runout", 2e-4), ("shaft.speed", RAMP), ("film.model", "profiled"), ("film.floor", 0.01),
        ("initial.stator.tilt_x", 1e-5), ("stator.support.axial_damping", 12.0), ("housing.axial.1.frequency", 70.0),
        ("rotor.axial_runout", [AxialRunout(2.0, 1e-6)]), ("contact", ROUGH), ("stator.support", None),
        ("stator.unphysical_inertia", True),
    ],
)  # fmt: skip
def test_one_value_changes_and_nothing_else(key, value):
    changed = with_values(SHAKEN, {key: value})
    assert part(changed, key) == value and part(SHAKEN, key) != value
    assert with_values(changed, {key: part(SHAKEN, key)}) == SHAKEN


@pytest.mark.parametrize(
    "key",
    ["rotor.runuot", "housing.axial.2.frequency", "housing.axial.x", "contact.roughness", "shaft.speed.value", ""],
)
def test_a_key_the_scene_has_not_is_refused(key):
    with pytest.raises(SceneError) as refused:
        with_values(SHAKEN, {"film.floor": 0.01, key: 1.0})
    assert refused.value.key == key


def test_a_value_takes_its_alternatives_away():
    tilt = with_values(fms(), {"stator.support": Support(5e5, 300.0, tilt_stiffness=400.0, tilt_damping=0.2)})
    ring = with_values(tilt, {"stator.support.radius": 0.04}).stator.support
    assert (ring.radius, ring.tilt_stiffness, ring.tilt_damping) == (0.04, None, None)
    again = with_values(fms(), {"stator.support.radius": 0.04, "stator.support.tilt_damping": 0.1}).stator.support
    assert (again.radius, again.tilt_damping) == (None, 0.1)
    shaken = with_values(SHAKEN, {"housing.axial.0.acceleration": 3.0}).housing.axial
    assert (shaken[0].displacement, shaken[0].acceleration, shaken[1]) == (None, 3.0, SHAKEN.housing.axial[1])


def test_tables_end():
    assert tables_at_end(with_values(fms(), {"shaft.speed": RAMP})) == with_values(fms(), {"shaft.speed": 900.0})


# --- scenarios ------------------------------------------------------------------------------------------


def scenario(*overrides, text=TEXT):
    return parse_scenario(text, "seal.toml", overrides)


@pytest.mark.parametrize(
    "values",
    [
        {"rotor.runout": "0.1 mrad"},
        {"rotor.runout": "5 um TIR", "film.outer_radius": "42 mm"},
        {"rotor.runout": 1e-4, "film.outer_radius": 0.042},
        {"shaft.speed": "{ time = [0, 1], value = ['9550 rpm', 900] }"},
        {"shaft.speed": RAMP, "run.duration": 0.1},
        {"run.start": "steady", "run.samples": 16, "run.accuracy": 1e-5},
        {"film.model": "linear", "film.coefficients": "radial"},
        {"contact.roughness": "0.2 um", "contact.compressive_strength": 3e8},
        {"contact": ROUGH},
        {"stator.support.tilt_stiffness": "400 N*m/rad", "stator.support.axial_damping": 0},
        {"initial.stator.tilt_x": "1 urad"},
        {"shaft.whirl": [{"ratio": 0.5, "angle": "1 urad"}]},
        {"film.coefficients": {"tilt_stiffness": 1, "tilt_damping": 1, "axial_stiffness": 1, "axial_damping": 1}},
        {"stator.unphysical_inertia": True},
    ],
    ids=lambda values: ",".join(values),
)
def test_values_are_those_of_overrides(values):
    changed = reader.with_values(scenario("run.turns=5"), values)
    written = scenario("run.turns=5", *overrides_of(values))
    assert (changed.scene, changed.run, changed.given) == (written.scene, written.run, written.given)
    assert changed.overrides == written.overrides and changed.text == TEXT


@pytest.mark.parametrize(
    "values",
    [
        {"rotor.runuot": "0.1 mrad"}, {"rotor.runout": "0.1 mm"}, {"rotor.runout": "much"},
        {"rotor.runout": "5 um TIR", "film.outer_radius": "5 bar"}, {"rotor.runout": float("nan")},
        {"rotor.runout": "9 mrad"}, {"rotor": 3}, {"contact.roughness": "0.2 um"},
        {"film.coning": "{ time = [0, 0, 1], value = [1e-3, 2e-3, 2e-3] }"},
        {"film.density": "{ time = [0, 1], value = [900, 800] }"}, {"film.coning_per_kelvin": "1 urad"},
        {"film.coning_per_kelvin": "1 urad/K"}, {"film.model": "raidal"}, {"film.inner_radius": "41 mm"},
        {"closing.spring_force": 50, "closing.balance_ratio": 0.75}, {"housing.axial.0.frequency": 50},
        {"housing.axial.first": 50}, {"run.solver": "adam"}, {"run.start": "stedy"},
        {"shaft.speed": 0, "run.samples_per_turn": 8, "run.duration": 1},
        {"stator.support.radius": "1 mm", "stator.support.tilt_stiffness": "-3 N*m/rad"},
    ],
    ids=lambda values: ",".join(values),
)  # fmt: skip
def test_errors_are_those_of_overrides(values):
    """The same line, but that structural ones print the override as it was given."""
    text = TEXT + TONE if "first" in str(values) else TEXT
    with pytest.raises(ScenarioError) as written:
        scenario(*overrides_of(values), text=text)
    with pytest.raises(ScenarioError) as changed:
        reader.with_values(replace(scenario(text=text), name="seal.toml"), values)
    assert str(changed.value) == str(written.value)


def test_total_indicator_reading_follows_the_outer_radius():
    """TIR / (2 r_o), at whatever outer radius, until another runout is given."""
    read = scenario('rotor.runout="8 um TIR"')
    for _ in range(2):
        read = reader.with_values(read, {"film.outer_radius": 0.05, "film.coning": 1e-3})
        assert read.scene.rotor.runout == 8e-6 / (2 * 0.05)
    read = reader.with_values(read, {"rotor.runout": 1e-5})
    assert reader.with_values(read, {"film.outer_radius": 0.045}).scene.rotor.runout == 1e-5


@pytest.mark.core
def test_what_was_read_is_not_changed_by_what_is_made_of_it():
    read = scenario(text=f"{TEXT}{TONE}[study.rub]\ndown = true\n")
    kept = pickle.dumps(read)
    changed = reader.with_values(read, {"housing.axial.0.frequency": 70.0, "study.rub.down": False})
    assert changed.scene.housing.axial[0].frequency == 70.0 and changed.study["rub"]["down"] is False
    assert pickle.loads(kept) == read


@pytest.mark.parametrize("made", [fms, fmr])
def test_a_ring_keeps_the_waves_of_its_face_on_the_other_side(made):
    """They were dropped."""
    own, other = [Waviness(2, 1e-7)], [Waviness(3, 2e-7)]
    scene = made()
    scene = replace(scene, stator=replace(scene.stator, waviness=own), rotor=replace(scene.rotor, waviness=other))
    turned = counterpart(scene)
    assert turned.rotor.waviness == own and turned.stator.waviness == other


def test_heated_rings_change_places_whole():
    """What heats and cools a ring goes with it, and the partner keeps its body: another arrangement was refused."""
    read = reader.read_scenario(SCENARIOS / "pump_seal.toml")
    turned, scene = counterpart(read.scene), read.scene
    assert (turned.film.heat.stator, turned.film.heat.rotor) == (scene.film.heat.rotor, scene.film.heat.stator)
    assert (turned.stator.body, turned.rotor.body) == (scene.rotor.body, scene.stator.body)
    assert not scene_errors(turned, read.run)
    assert counterpart(turned).film == scene.film
