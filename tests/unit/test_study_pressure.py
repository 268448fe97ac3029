"""The study of film pressure: words for the gap state, bad ones in one line, rough faces, and its figure."""

import functools

import numpy as np
import pytest
from command import SCENARIOS
from drawn import text_trouble

from sealdyn import read_scenario
from sealdyn.archive import read_study
from sealdyn.report.panels import draw
from sealdyn.scenario.errors import ScenarioError
from sealdyn.studies import pressure
from sealdyn.studies._runner import run_study
from sealdyn.studies.pressure import Settings


@functools.cache
def reference():
    return read_scenario(SCENARIOS / "fms_reference.toml")


def whole(at="", scenario=None):
    return pressure.run(scenario or reference(), Settings(at), None)


def answer(at="", scenario=None):
    return whole(at, scenario).numbers


@pytest.mark.parametrize(
    "at", ["clearance=8 um, tilt=0.1 mrad", ("clearance = 8um", "tilt=1e-4"), "tilt=100 urad,clearance=8e-6,", ]
)  # fmt: skip
def test_the_gap_state_may_be_written_in_any_way(at):
    found = answer(at)
    assert (found["clearance"], found["tilt"]) == pytest.approx((8e-6, 1e-4), rel=1e-12)
    # Coned faces are thinnest inside, where the stator is tilted towards the rotor.
    low = found["h_min"]
    assert low["value"] == pytest.approx(8e-6 - 0.032 * 1e-4) and low["radius"] == 0.032
    assert low["theta"] == pytest.approx(1.5 * np.pi)


@pytest.mark.core
def test_nothing_said_is_the_aligned_equilibrium():
    found = answer()
    assert found["clearance"] == 1e-5 and found["tilt"] == 0.0 and found["gauge_force"] == found["force"]
    assert abs(found["moment"][0]) < 1e-9 * found["force"] * 0.04


@pytest.mark.parametrize(
    "at, found, expected",
    [
        ("clearence=3 um", "clearence", "nearest 'clearance'"), ("speed=3", "speed", "clearance or tilt"),
        ("tilt", "tilt", "clearance=5 um, tilt=0.1 mrad"), ("tilt=", "tilt=", "clearance=5 um, tilt=0.1 mrad"),
        ("clearance=1 um, clearance=2 um", "clearance twice", "once"), ("clearance=0", "0", "> 0"),
        ("clearance=-1 um", "-1 um", "> 0"), ("clearance=5 bar", "pressure", "in m"), ("tilt=nan", "nan", "finite"),
        ("tilt=3 mm", "length", "in rad"), ("tilt=0.32 mrad", "320 urad", "below 312.2 urad"),
        ("tilt=-0.32 mrad", "-320 urad", "below 312.2 urad"), ("tilt=1e300", "1e+303 mrad", "below 312.2 urad"),
        ("clearance=1e300", "1e+300 m", "size of a film's"), ("clearance=1e-300", "1e-300 m", "size of a film's"),
        (5, "5", "clearance or tilt"),
    ],
)  # fmt: skip
def test_a_bad_gap_state_is_one_line(at, found, expected):
    with pytest.raises(ScenarioError) as error:
        answer(at)
    assert error.value.key == "study.pressure.at" and "\n" not in str(error.value)
    assert found in error.value.found and expected in error.value.expected


def test_diverging_faces_need_a_clearance():
    scenario = read_scenario(SCENARIOS / "fms_reference.toml", ["film.coning=-1 mrad"])
    with pytest.raises(ScenarioError, match="larger clearance"):
        answer("clearance=5 um", scenario)


def test_equal_pressures_have_no_gauge_force_and_no_centre():
    found = answer("", read_scenario(SCENARIOS / "fms_reference.toml", ["film.inner_pressure=5 bar"]))
    assert found["gauge_force"] == 0.0 and found["centre_of_pressure"] is None and found["leakage"] == 0.0


def test_a_coarse_grid_and_a_pressure_below_zero_are_said():
    """Nearly touching: the grid of the film no longer sums up to its moment."""
    fine, coarse = whole("tilt=0.1 mrad"), whole("tilt=0.312 mrad")
    assert len(coarse.notes) == len(fine.notes) + 1
    fine, coarse = fine.numbers, coarse.numbers
    off = [np.subtract(found["integrated"]["moment"], found["moment"]) for found in (fine, coarse)]
    off = [np.hypot(*o) / np.hypot(*found["moment"]) for o, found in zip(off, (fine, coarse), strict=True)]
    assert off[0] < 0.003 and off[1] > 0.015
    drawn_down = whole("tilt=0.1 mrad", read_scenario(SCENARIOS / "fms_reference.toml", ["film.outer_pressure=0 bar"]))
    assert np.min(drawn_down.numbers["pressure"]["p"]) < 0
    assert "film.cavitation_pressure" in " ".join(drawn_down.notes)


def test_what_asperities_carry_is_told_apart(tmp_path):
    found = answer("", read_scenario(SCENARIOS / "run_in.toml"))
    closing = found["force"] + found["contact_force"]
    assert found["contact_force"] > 0.01 * closing
    # Film and asperities balance the closing force, which the equilibrium knows.
    known = run_study("equilibrium", read_scenario(SCENARIOS / "run_in.toml"), tmp_path / "e.h5", flags={"points": 3})
    assert closing == pytest.approx(known["closing_force"], rel=1e-6)


def series(found, title):
    """Series of a panel of a tilted or a further face, by their labels."""
    (held,) = (one for one in found.panels if one.title == title)
    return {one.label: one for one in held.series}


def test_the_archive_and_what_is_drawn(tmp_path):
    flags = {"at": ["clearance=8 um", "tilt=0.15 mrad"]}
    found = run_study("pressure", reference(), tmp_path / "p.h5", flags=flags, workers=1)
    assert read_study(found["archive"])["answer"]["pressure"] == found["pressure"]
    shown = whole("clearance=8 um, tilt=0.15 mrad")
    mean = series(shown, "Over the radius")["mean of the circle"]
    assert mean.x == found["pressure"]["r"]
    assert mean.y == pytest.approx(np.array(found["pressure"]["p"]).mean(axis=1))
    middle = series(shown, "Around the circle")["at r = 36 mm"]
    assert middle.x[-1] - middle.x[0] == pytest.approx(2 * np.pi) and middle.y[0] == middle.y[-1]
    assert text_trouble(draw(found["archive"])) == ([], [])


def test_a_film_without_a_field_says_so():
    (panel,) = whole("", read_scenario(SCENARIOS / "fms_reference.toml", ["film.model=linear"])).panels
    assert not panel.series and "linear" in panel.note


def test_further_clearances_are_those_of_their_own():
    shown = pressure.run(reference(), Settings("clearance=8 um", ("9 um", "10um", 1.2e-5)), None)
    found = shown.numbers
    assert [other["clearance"] for other in found["beside"]] == pytest.approx([9e-6, 1e-5, 1.2e-5])
    for other in found["beside"]:
        own = answer(f"clearance={other['clearance']}")
        for name in pressure.BESIDE:
            assert other[name] == own[name], name
        assert other["circle_mean"] == pytest.approx(own["profiles"]["circle_mean"])
    assert series(shown, "Over the radius")["at 12 um"].y == found["beside"][2]["circle_mean"]
    with pytest.raises(ScenarioError, match="beside: found"):
        pressure.run(reference(), Settings("", "5 bar"), None)
