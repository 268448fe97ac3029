"""Numbers of studies as an engineer reads them."""

import math

import pytest

from sealdyn.report.text import study_lines
from sealdyn.studies._words import frequencies, quantity, shown_in, speed


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
