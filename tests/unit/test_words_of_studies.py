"""Numbers of studies as an engineer reads them."""

import math

import pytest

from sealdyn.report.text import study_lines
from sealdyn.studies._words import frequencies, quantity, shown_in, speed, wear, wearing
from sealdyn.studies.wear import study as wear_study


@pytest.mark.parametrize(
    ("value", "unit", "words"),
    [
        (4.8979e-3, "rad", "4.8979 mrad"),
        (-25e-6, "rad", "-25 urad"),
        (5e-6, "m", "5 um"),
        (0.04, "m", "40 mm"),
        (1e5, "Pa", "1 bar"),
        (1e-9, "m^3/s", "3.6 ml/h"),
        (1e-3, "m^3/s", "60 l/min"),
        (0.75, "1", "0.75"),
        (3.0, "", "3"),
        (2.0, "N", "2 N"),
        (0.0, "rad", "0 urad"),
        (1000.0, "rad/s", "1000 rad/s (9549.3 rpm)"),
        (38849.4, "rad/s", "38849 rad/s (370980 rpm)"),
    ],
)
def test_a_quantity_in_words(value, unit, words):
    assert quantity(value, unit) == words


def test_values_of_one_table_have_one_unit():
    unit, factor = shown_in("rad", [1e-5, None, math.nan, 2e-3])
    assert (unit, factor) == ("mrad", 1e3)
    assert shown_in("m", []) == ("um", 1e6) and shown_in("kg", [1.0]) == ("kg", 1.0)


def test_speeds_and_frequencies():
    assert speed(2 * math.pi * 50) == "314.16 rad/s (3000 rpm)"
    assert frequencies(2 * math.pi * 100, 2 * math.pi * 200) == "628.32 to 1256.6 rad/s (100 to 200 Hz)"
    assert frequencies(1000.0, 1000.0) == "1000 rad/s (159.15 Hz)"


def test_speeds_of_a_table_have_no_exponent():
    rows = [{"w": 5600.0}, {"w": 5.6e6}, {"w": 0.01}]
    cells = [line.strip() for line in study_lines({"verdict": []}, [(rows, (("rpm", "w", 30 / math.pi),))])]
    assert cells == ["rpm", "53480", "5.348e+07", "0.09549"]


def test_wear_has_one_unit_and_names_who_wears():
    assert wear(3.18e-7 / 3600) == "0.318 um/h" and wear(1.82e-6 / 3600) == "1.82 um/h"
    assert wearing({"stator": 1e-16, "rotor": 0.0}) == "the stator"
    profile = {"stator": [[1e-7, 2e-7]], "rotor": [[0.0, 0.0]]}
    answer = {"end": {"kind": "run-in", "said": "run in"}, "history": {"time": [360.0], "wear_rate": [1e-10]},
              "profile": profile, "coefficients": [1e-16, 0.0], "extrapolated": None, "steps": 1, "not_settled": 0,
              "coarse": 0, "radius": [1, 2], "tilt_over_roughness": 0.0, "unstable": False}  # fmt: skip
    said = wear_study.sentences(answer, wear_study.Settings())[1]
    assert "not computed, 100 h come to 36.16 um of the stator (see" in said
    later = answer | {"extrapolated": {"time": 3600.0, "stator": [1e-6, 2e-6], "rotor": [0.0, 0.0]}}
    assert wear_study.sentences(later, wear_study.Settings())[1].endswith("to 1 h: stator 2 um.")
