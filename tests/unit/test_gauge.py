"""Gauge pressures: read as absolute ones wherever a scenario or a study has them, and never as differences."""

import pytest
from command import SCENARIOS

import sealdyn
from sealdyn.numerics.piecewise_linear import PiecewiseLinear
from sealdyn.scenario.reader import ScenarioError, parse_scenario, with_values
from sealdyn.scenario.settings import axis, values_in_si
from sealdyn.studies.tolerance.scatter import read_scatter

FMR = (SCENARIOS / "fmr_reference.toml").read_text()


def parse(text, *overrides):
    return parse_scenario(text, "seal.toml", overrides)


@pytest.mark.core
def test_a_scene_in_gauge_is_the_scene_in_absolute_pressures():
    gauge = parse(FMR, "film.outer_pressure=5 barg", "film.inner_pressure=0 psig")
    assert gauge == parse(FMR, "film.outer_pressure=6.01325 bar", "film.inner_pressure=1 atm")
    assert gauge.gauge == {"film.outer_pressure", "film.inner_pressure"} and not parse(FMR).gauge
    # What was read is absolute, and is not read as gauge again.
    assert with_values(gauge, {"film.clearance": "10 um"}).scene == gauge.scene


def test_tables_over_time_entry_by_entry():
    rising = parse(FMR, "film.outer_pressure={ time = [0, 1], value = ['5 barg', '8 bar'] }")
    assert rising.scene.film.outer_pressure == PiecewiseLinear((0.0, 1.0), (601325.0, 8e5))
    assert rising.gauge == {"film.outer_pressure"}


def test_axes_and_sweeps_take_gauge_pressures(tmp_path):
    found = axis("film.outer_pressure=5:6 barg:2", "seal", "study.sweep.vary")
    assert found["given"] == ["5.0 barg", "6.0 barg"] and found["unit"] == "barg"
    rows = []
    for vary in ("film.outer_pressure=5:6 barg:2", "film.outer_pressure=6.01325:7.01325 bar:2"):
        flags = {"vary": vary, "outputs": "leakage.mean"}
        answer = sealdyn.run_study("sweep", parse(FMR, "run.turns=2"), tmp_path / "s.h5", flags=flags, workers=1)
        rows.append([row["leakage.mean"] for row in answer["rows"]])
    assert rows[0] == rows[1]


@pytest.mark.parametrize("words", ["k=20 degC:300 K:3", "k=5 barg:7 bar:3"])
def test_ends_that_count_from_different_zeros_are_refused(words):
    with pytest.raises(ScenarioError, match="units of one kind"):
        axis(words, "seal", "study.sweep.vary")


def test_a_list_of_different_scales_is_read_entry_by_entry():
    assert axis("k=20 degC, 300 K", "seal", "w")["given"] == ["20 degC", "300 K"]
    assert axis("k=5 barg, 7 bar", "seal", "w")["given"] == ["5 barg", "7 bar"]


@pytest.mark.parametrize("words, unit", [("20:30 degC:3", "K"), ("5:7 barg:3", "Pa")])
def test_where_a_factor_is_all_a_unit_has_scales_are_refused(words, unit):
    with pytest.raises(ScenarioError):
        values_in_si(parse(FMR), words, unit, "study.rub.values")


def test_a_width_is_no_gauge_pressure():
    (scatter,) = read_scatter(parse(FMR), ["film.outer_pressure = normal(5 barg +- 0.3 bar)"])
    assert scatter.centre == 601325.0 and scatter.law.std() == pytest.approx(1e4, rel=1e-12)
    with pytest.raises(ScenarioError, match="barg"):
        read_scatter(parse(FMR), ["film.outer_pressure = normal(5 bar +- 0.3 barg)"])
