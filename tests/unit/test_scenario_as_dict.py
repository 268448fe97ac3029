"""Scenarios as tables and text: there and back without a change, with any values set on the way."""

import functools
import tomllib

import numpy as np
import pytest
from command import SCENARIOS
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from sealdyn import Scenario, ScenarioError, read_scenario
from sealdyn.scenario.reader import parse_scenario

SHIPPED = sorted(SCENARIOS.glob("*.toml"))
CHANGES = {
    "film.clearance": st.one_of(st.floats(1e-6, 1e-3), st.integers(2, 200).map("{} um".format)),
    "shaft.speed": st.one_of(st.floats(1.0, 1e4), st.just({"time": [0.0, 1.0], "value": ["10 rpm", 2.5]})),
    "rotor.runout": st.sampled_from(["20 um TIR", 0, 2e-5, "30 urad"]),
    "run.turns": st.integers(1, 500),
    "run.duration": st.sampled_from(["20 ms", 0.5]),
    "study.sweep.vary": st.sampled_from([["rotor.runout=0:1 mrad:3"], "rotor.runout=1,2"]),
}


@functools.cache
def shipped(path):
    return read_scenario(path)


def reference():
    return shipped(next(path for path in SHIPPED if path.stem == "fms_reference"))


def alike(found, scenario):
    return found == scenario and found.study == scenario.study and found.question == scenario.question


def test_a_shipped_scenario_comes_back_as_it_went():
    for scenario in map(shipped, SHIPPED):
        again = Scenario.from_dict(scenario.to_dict(), scenario.name, scenario.question)
        if "file = " in scenario.text:
            # Whole without its file.
            assert (again.scene, again.run) == (scenario.scene, scenario.run), scenario.name
            continue
        assert alike(again, scenario), scenario.name
        assert scenario.to_toml() == scenario.text
        assert scenario.to_dict() == tomllib.loads(scenario.text)


@settings(max_examples=100, deadline=None, suppress_health_check=list(HealthCheck))
@given(st.sampled_from(SHIPPED), st.lists(st.sampled_from(list(CHANGES)), min_size=1, unique=True), st.data())
def test_so_does_one_with_other_values(path, keys, data):
    changed = shipped(path)
    for key in keys:
        try:
            changed = changed.with_({key: data.draw(CHANGES[key])})
        except ScenarioError as error:
            # Not every seal can be of every clearance.
            assert "\n" not in str(error)
    whole = Scenario.from_dict(changed.to_dict(), changed.name, changed.question)
    if "file = " in changed.text:
        assert (whole.scene, whole.run) == (changed.scene, changed.run)
        return
    assert alike(whole, changed)
    again = parse_scenario(changed.to_toml(), changed.name)
    assert alike(again, changed) and again.to_toml() == again.text


@pytest.mark.core
def test_a_scenario_of_tables_is_read_like_a_file():
    tables = reference().to_dict()
    tables["film"]["clearance"] = np.float64(8e-6)
    tables["shaft"]["speed"] = {"time": np.arange(2), "value": [900, 950]}
    tables["contact"] = None
    found = Scenario.from_dict(tables, "mine", "Does it hold?")
    assert found.scene.film.clearance == 8e-6 and found.scene.shaft.speed.time == (0, 1)
    assert found.name == "mine" and found.question == "Does it hold?" and found.text.startswith("# Does it hold?\n")


def test_values_are_set_by_dotted_keys_or_double_underscores():
    by_key = reference().with_({"film.clearance": "5 um", "rotor.runout": np.float64(2e-5)})
    assert by_key.scene.film.clearance == 5e-6 and by_key.scene.rotor.runout == 2e-5
    assert reference().with_(film__clearance="5 um", rotor__runout=2e-5) == by_key
    # What was there is left alone.
    assert reference().scene.film.clearance == 1e-5 and not reference().overrides


@pytest.mark.parametrize(
    "make, told",
    [
        (lambda: reference().with_(film__clerance="5 um"), ["[film] clerance", "nearest 'clearance'"]),
        (lambda: reference().with_({"film.clearance": "5 kg"}), ["[film] clearance", "5 kg", "a length"]),
        (lambda: reference().with_({"film.clearance": object()}), ["[film] clearance", "a number"]),
        (lambda: reference().with_({"film.clearance": None}), ["[film] clearance", "None"]),
        (lambda: reference().with_({"film.clearance": float("nan")}), ["[film] clearance", "a finite number"]),
        (lambda: Scenario.from_dict({}), ["scene", "an empty file"]),
        (lambda: Scenario.from_dict({"film": {"clearance": {1, 2}}}), ["scene", "what TOML cannot hold"]),
        (lambda: Scenario.from_dict({**reference().to_dict(), "fillm": {}}), ["fillm", "nearest 'film'"]),
    ],
)
def test_what_is_wrong_is_told_in_one_line(make, told):
    with pytest.raises(ScenarioError) as refused:
        make()
    said = str(refused.value)
    assert "\n" not in said and all(part in said for part in told), said
