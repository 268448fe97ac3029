"""The study of film pressure: words for the gap state, bad ones in one line, rough faces, and its figure."""

from pathlib import Path

import numpy as np
import pytest
from drawn import curve, drawn, panel, text_trouble

from sealdyn import read_scenario
from sealdyn.archive import read_study
from sealdyn.report.charts import study_pressure
from sealdyn.scenario.errors import ScenarioError
from sealdyn.studies import equilibrium, pressure
from sealdyn.studies._runner import run_study
from sealdyn.studies.pressure import Settings

SCENARIOS = Path(__file__).parents[2] / "scenarios"
REFERENCE = read_scenario(SCENARIOS / "fms_reference.toml")


def answer(at="", scenario=REFERENCE):
    return pressure.run(scenario, Settings(at), None)


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
        ("clearence=3 um", "clearence", "nearest 'clearance'"),
        ("speed=3", "speed", "clearance or tilt"),
        ("tilt", "tilt", "clearance=5 um, tilt=0.1 mrad"),
        ("tilt=", "tilt=", "clearance=5 um, tilt=0.1 mrad"),
        ("clearance=1 um, clearance=2 um", "clearance twice", "once"),
        ("clearance=0", "0", "> 0"),
        ("clearance=-1 um", "-1 um", "> 0"),
        ("clearance=5 bar", "pressure", "in m"),
        ("tilt=nan", "nan", "finite"),
        ("tilt=3 mm", "length", "in rad"),
        ("tilt=0.32 mrad", "0.32 mrad", "below 0.3122 mrad"),
        ("tilt=-0.32 mrad", "-0.32 mrad", "below 0.3122 mrad"),
        ("tilt=1e300", "1e+303 mrad", "below 0.3122 mrad"),
        ("clearance=1e300", "1e+300 m", "size of a film's"),
        ("clearance=1e-300", "1e-300 m", "size of a film's"),
        (5, "5", "clearance or tilt"),
    ],
)
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
    fine, coarse = answer("tilt=0.1 mrad"), answer("tilt=0.312 mrad")
    off = [np.subtract(found["integrated"]["moment"], found["moment"]) for found in (fine, coarse)]
    off = [np.hypot(*o) / np.hypot(*found["moment"]) for o, found in zip(off, (fine, coarse), strict=True)]
    assert off[0] < 0.003 and off[1] > 0.015 and len(coarse["verdict"]) > len(fine["verdict"])
    drawn_down = answer("tilt=0.1 mrad", read_scenario(SCENARIOS / "fms_reference.toml", ["film.outer_pressure=0 bar"]))
    floors = ["film.cavitation_pressure" in " ".join(found["verdict"]) for found in (fine, drawn_down)]
    assert np.min(drawn_down["pressure"]["p"]) < 0 and floors == [False, True]


def test_what_asperities_carry_is_told_apart():
    found = answer("", read_scenario(SCENARIOS / "run_in.toml"))
    closing = found["force"] + found["contact_force"]
    assert found["contact_force"] > 0.01 * closing
    # Film and asperities balance the closing force, which the equilibrium knows.
    known = equilibrium.run(read_scenario(SCENARIOS / "run_in.toml"), equilibrium.Settings(points=3), None)
    assert closing == pytest.approx(known["closing_force"], rel=1e-6)


def test_archive_and_figure(tmp_path):
    flags = {"at": ["clearance=8 um", "tilt=0.15 mrad"]}
    found = run_study("pressure", REFERENCE, tmp_path / "p.h5", flags=flags, workers=1)
    assert read_study(found["archive"])["answer"]["pressure"] == found["pressure"]
    figure = drawn(study_pressure, found["archive"], tmp_path / "p.png")
    above, below = panel(figure, "Over the radius"), panel(figure, "Around the circle")
    r, mean = curve(above, "mean of the circle")
    assert r == pytest.approx(1e3 * np.array(found["pressure"]["r"]))
    assert mean == pytest.approx(1e-5 * np.array(found["pressure"]["p"]).mean(axis=1))
    degrees, middle = curve(below, "at r = 36 mm")
    assert (degrees[0], degrees[-1], middle[0]) == (0.0, 360.0, middle[-1])
    assert ", bar" in above.get_ylabel() and text_trouble(figure) == ([], [])


def test_a_film_without_a_field_has_a_page_that_says_so(tmp_path):
    scenario = read_scenario(SCENARIOS / "fms_reference.toml", ["film.model=linear"])
    found = run_study("pressure", scenario, tmp_path / "p.h5", workers=1)
    figure = drawn(study_pressure, found["archive"], tmp_path / "p.png")
    assert any("linear" in text.get_text() for ax in figure.axes for text in ax.texts)
    assert text_trouble(figure) == ([], [])


def test_further_clearances_are_those_of_their_own(tmp_path):
    flags = {"at": "clearance=8 um", "beside": ["9 um", "10um", 1.2e-5]}
    out = run_study("pressure", REFERENCE, tmp_path / "beside.h5", flags=flags, workers=1)["archive"]
    found = read_study(out)["answer"]
    assert [other["clearance"] for other in found["beside"]] == pytest.approx([9e-6, 1e-5, 1.2e-5])
    for other in found["beside"]:
        own = answer(f"clearance={other['clearance']}")
        for name in pressure.BESIDE:
            assert other[name] == own[name], name
        assert other["circle_mean"] == pytest.approx(own["profiles"]["circle_mean"])
    figure = drawn(study_pressure, out, tmp_path / "beside.png")
    assert text_trouble(figure) == ([], [])
    axes = panel(figure, "Over the radius")
    _, mean = curve(axes, "at 12 µm")
    assert mean == pytest.approx(1e-5 * np.array(found["beside"][2]["circle_mean"]))
    with pytest.raises(ScenarioError, match="beside: found"):
        pressure.run(REFERENCE, Settings("", "5 bar"), None)
