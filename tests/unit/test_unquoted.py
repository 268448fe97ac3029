"""Quantities without quotation marks: the line that says so names key, line and how to write it."""

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from sealdyn.scenario.reader import ScenarioError, parse_scenario


def refusal(text: str) -> ScenarioError:
    with pytest.raises(ScenarioError) as caught:
        parse_scenario(text, "seal.toml")
    return caught.value


@pytest.mark.parametrize(
    "text, key, line, written",
    [
        ('[film]\ninner_radius = "25 mm"\nviscosity = 8 cP\n', "film.viscosity", 3, "8 cP"),
        ("[film]\nviscosity = 8cP # of oil\n", "film.viscosity", 2, "8cP"),
        ("[film]\nviscosity = 0.8e-3 Pa*s\n", "film.viscosity", 2, "0.8e-3 Pa*s"),
        ("[film]\nviscosity = .8 mPa.s\n", "film.viscosity", 2, ".8 mPa.s"),
        ("shaft.speed = 2950 rpm\n", "shaft.speed", 1, "2950 rpm"),
        ("[[rotor.waviness]]\norder = 2\namplitude = -1 um", "rotor.waviness.amplitude", 3, "-1 um"),
        ("[stator]\nsupport = { axial_stiffness = 30 N/mm, x = 1 }", "stator.support.axial_stiffness", 2, "30 N/mm"),
        ("[shaft]\nspeed = { time = [0, 1 s], value = [0, 1] }", "shaft.speed.time", 2, "1 s"),
        ("[shaft.speed]\ntime = [\n0,\n1 s,\n]", "shaft.speed.time", 4, "1 s"),
    ],
)
def test_a_quantity_without_quotation_marks(text, key, line, written):
    error = refusal(text)
    assert error.key == key
    assert error.found == f"{written} without quotation marks (line {line})" and f'"{written}"' in error.expected


@pytest.mark.core
@pytest.mark.parametrize("text", ["[film\nclearance = ", "[film]\nmodel = radial\n", "x = 1 = 2", "a = [1, 2\nb"])
def test_other_slips_keep_the_words_of_the_parser(text):
    assert refusal(text).key == "" and "no TOML" in str(refusal(text))


@settings(deadline=None)
@given(st.text(alphabet='ab1.= \n[]{}",#-e', max_size=60))
def test_any_text_ends_in_one_line(text):
    assert str(refusal(text)).isprintable()
