"""Settings of a study: lists given as one flag, and errors of one line."""

import dataclasses
import functools
import math
from functools import cache

import pytest
from command import SCENARIOS

from sealdyn.scenario.errors import ScenarioError
from sealdyn.scenario.reader import read_scenario
from sealdyn.scenario.settings import MOST, axis, si_unit, study_settings, values_in_si
from sealdyn.studies import study_names
from sealdyn.studies._declared import help_text, settings_of
from sealdyn.studies._declared import schema as whole_schema
from sealdyn.studies._runner import study_info, study_module

SCENARIO = SCENARIOS / "fms_reference.toml"


@functools.cache
def scenario():
    return read_scenario(SCENARIO)


def settings(study, **flags):
    return study_settings(scenario(), study, study_module(study).Settings, flags)


@pytest.mark.parametrize(
    "study, key, words, found",
    [
        ("rub", "whirl_speeds", "5700 rad/s, 60000 rpm", (5700.0, 2000 * math.pi)),
        ("rub", "whirl-speeds", "5700", (5700.0,)),
        ("rub", "whirl_speeds", 5700, (5700.0,)),
        ("rub", "whirl_speeds", ["5700 rad/s", 6000], (5700.0, 6000.0)),
        ("work_precision", "methods", "adams,dop853", ("adams", "dop853")),
        ("work_precision", "methods", "adams", ("adams",)),
        ("contact_onset", "values", "0.1 mrad, 2e-4", ("0.1 mrad", 2e-4)),
        ("steady_state", "approach", "0.9, 0.95", (0.9, 0.95)),
        ("failures", "items", "3, 5", (3, 5)),
        ("failures", "items", 3, (3,)),
        ("sealing_number", "starts", "closed form, open", ("closed form", "open")),
        ("sealing_number", "force_ratios", "1.5, 2", (1.5, 2.0)),
    ],
)
def test_a_list_may_be_one_flag(study, key, words, found):
    read = getattr(settings(study, **{key: words}), key.replace("-", "_"))
    assert read == pytest.approx(found) if all(isinstance(v, float) for v in found) else read == found


def test_words_with_commas_of_their_own_stay_whole():
    read = settings("sweep", vary="rotor.runout=1 urad,2 urad", outputs="film,leakage")
    assert read.vary == "rotor.runout=1 urad,2 urad" and read.outputs == "film,leakage"
    assert settings("rub", values="1 mrad:2 mrad:3").values == "1 mrad:2 mrad:3"


@pytest.mark.parametrize(
    "study, key, words, told",
    [
        ("rub", "whirl_speeds", "5700 rad/s, 6000 kg", ["study.rub] whirl_speeds", "6000 kg", "speed of rotation"]),
        ("rub", "whirl_speeds", "5700 rad/s,, 6000", ["study.rub] whirl_speeds", "speed of rotation"]),
        ("failures", "items", "3, many", ["study.failures] items", "many", "integer"]),
        ("steady_state", "approach", "0.9, near", ["study.steady_state] approach", "near", "number"]),
        ("rub", "whirl_speds", "1, 2", ["study.rub] whirl_speds", "nearest 'whirl_speeds'"]),
    ],
)
def test_a_bad_entry_is_one_line(study, key, words, told):
    with pytest.raises(ScenarioError) as refused:
        settings(study, **{key: words})
    said = str(refused.value)
    assert "\n" not in said and all(part in said for part in told), said


@pytest.mark.parametrize("words", ["3 m, 1 bar", "1 bar, 3 rpm", "1 foo, 2 bar"])
def test_units_of_another_kind_are_not_converted(words):
    """What is no value of the key is left as it is written, for the scenario to refuse."""
    entries = [entry.strip() for entry in words.split(",")]
    assert axis(f"film.outer_pressure={words}", "s", "w")["given"] == entries
    with pytest.raises(ScenarioError, match="units of one kind"):
        axis(f"film.outer_pressure={words.replace(', ', ':')}:3", "s", "w")


@pytest.mark.parametrize(
    "words, unit, found",
    [
        ("20 urad:40 urad:3", "rad", (2e-5, 3e-5, 4e-5)),
        ("1 mrad", "rad", (1e-3,)),
        ("1e-5, 2e-5", "rad", (1e-5, 2e-5)),
        ("1 bar/s:100 bar/s:3:log", "Pa/s", (1e5, 1e6, 1e7)),
    ],
)
def test_values_come_in_si(words, unit, found):
    assert values_in_si(scenario(), words, unit, "study.rub.values") == pytest.approx(found, rel=1e-12)


@pytest.mark.parametrize("sign", [1, -1])
def test_whole_numbers_are_of_a_size_that_can_be_counted(sign):
    assert settings("rub", ramp=sign * MOST).ramp == sign * MOST
    with pytest.raises(ScenarioError) as refused:
        settings("rub", ramp=sign * (MOST + 1))
    assert refused.value.key == "study.rub.ramp" and str(sign * (MOST + 1)) in refused.value.found


@pytest.mark.parametrize("words", ["10 um:20 um:3", "1 bar", "3 foo", "much", "1 foo:2 foo:3", "1 rad, 2 m"])
def test_values_of_another_kind_are_refused(words):
    with pytest.raises(ScenarioError) as refused:
        values_in_si(scenario(), words, "rad", "study.rub.values")
    assert refused.value.key == "study.rub.values" and words in refused.value.found


@pytest.mark.core
def test_units_of_keys():
    units = {"rotor.runout": "rad", "film.outer_pressure": "Pa", "stator.support.axial_stiffness": "N/m"}
    assert {key: si_unit(scenario().scene, key) for key in units} == units
    for key in ("rotor.runuot", "rotar.runout", "runout", "film.model.x"):
        with pytest.raises((AttributeError, KeyError)):
            si_unit(scenario().scene, key)


schema = cache(whole_schema)


@pytest.mark.parametrize("name", study_names())
def test_every_setting_is_described_wherever_it_is_asked_for(name):
    """Help, JSON schema: what it holds, its unit, its default, what it means; and the time that the study takes."""
    _, seconds = study_info(name.replace("-", "_")).timed
    help = " ".join(help_text(name).split())
    table = schema()["properties"]["study"]["properties"][name.replace("-", "_")]
    assert f"{seconds} s of processor time" in help and f"{seconds} s of processor time" in table["description"]
    fields = dataclasses.fields(study_module(name.replace("-", "_")).Settings)
    assert fields and set(table["properties"]) == {field.name for field in fields}
    for field, told in zip(fields, settings_of(name), strict=True):
        assert told.key == field.name and told.meaning[-1] == "." and told.holds != "value"
        assert (
            f"--{field.name.replace('_', '-')} ({told.holds}" in help.replace("\\[", "[") and told.meaning[:20] in help
        )
        assert table["properties"][field.name]["description"].startswith(told.meaning)
        if isinstance(field.default, float | bool | int):
            assert table["properties"][field.name]["default"] == field.default
