"""The study followability: its curves are the closed form's, its runs confirm them, its figure draws."""

import pytest
from command import SCENARIOS

import sealdyn

RADIAL = SCENARIOS / "radial"


@pytest.mark.core
def test_runs_confirm_the_curve():
    found = sealdyn.study("followability", RADIAL / "circumferential_reference.toml", runs=1, speed="9000,12000 rpm",
                          workers=1)  # fmt: skip
    (row,) = found.answer["runs"]
    assert abs(row["apart"]) < 1e-4 and row["closed_form"] == pytest.approx(row["eccentricity"], rel=1e-4)
    (curve,) = found.answer["curves"]
    # P - F over m w^2.
    assert curve["eccentricity"] == pytest.approx([0.425 / (0.004 * (w * 3.14159265358979 / 30) ** 2)
                                                   for w in (9000, 12000)])  # fmt: skip
    assert len(found.plot().axes) == 1


def test_a_curve_for_each_value_of_a_key():
    found = sealdyn.study("followability", RADIAL / "lip_reference.toml", runs=0, vary="lip.preload=40,80 N/m",
                          speed="1000:3000 rpm:3")  # fmt: skip
    one, other = (curve["eccentricity"] for curve in found.answer["curves"])
    assert all(a is not None and (b is None or b > a) for a, b in zip(one, other, strict=True))
    assert "negative" in found.message


def test_a_limit_beyond_the_radius_is_none():
    slow = sealdyn.read_scenario(RADIAL / "circumferential_reference.toml").with_(shaft__speed="5 rpm")
    found = sealdyn.study("followability", slow, runs=1, speed="5,6 rpm", workers=1)
    assert found.verdict[0] == "At 5 rpm any eccentricity is followed."
    assert found.answer["runs"][0]["closed_form"] is None and found.answer["most"] == 0.2 * found.answer["radius"]


@pytest.mark.parametrize("flags, words", [({"speed": "1:2:x rpm"}, "speed"), ({"vary": "lip.nothing=1,2"}, "nothing"),
                                          ({"speed": "0,3000 rpm"}, "a speed of 0"),
                                          ({"runs": -1}, "0 to 50")])  # fmt: skip
def test_settings_that_cannot_be(flags, words):
    with pytest.raises(sealdyn.ScenarioError, match=words):
        sealdyn.study("followability", RADIAL / "lip_reference.toml", **flags)
