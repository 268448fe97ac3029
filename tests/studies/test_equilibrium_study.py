"""Equilibrium study: forces integrated here, several clearances, none at all."""

import numpy as np
import pytest
from command import REFERENCE
from oracles import opening_force
from scipy.optimize import brentq

import sealdyn
from sealdyn import read_scenario
from sealdyn.archive import read_study
from sealdyn.scenario.reader import parse_scenario, with_values
from sealdyn.studies import equilibrium
from sealdyn.studies._runner import run_study
from sealdyn.studies.equilibrium import Settings


def answer(scenario, **settings):
    return equilibrium.run(scenario, Settings(**settings), None)


def balanced(coning, ratio, spring, inner="0 bar"):
    text = REFERENCE.read_text().replace('clearance = "10 um"', "").replace('"3.125 mrad"', f'"{coning} mrad"')
    text = text.replace('inner_pressure = "0 bar"', f'inner_pressure = "{inner}"')
    return parse_scenario(text + f"[closing]\nbalance_ratio = {ratio}\nspring_force = {spring}\n", "balanced")


def opening(clearance, coning):
    return opening_force(clearance, coning, 0.0, 5e5)


@pytest.mark.core
def test_converging_film_rides_where_the_forces_balance():
    found = answer(balanced(3.125, 0.75, 50.0))
    area = np.pi * (0.04**2 - 0.032**2)
    wanted = brentq(lambda c: opening(c, 3.125e-3) - (0.75 * 5e5 * area + 50), 1e-6, 1e-4)
    (root,) = found["roots"]
    assert root["clearance"] == pytest.approx(wanted, rel=1e-7) and root["stable"]
    step = 1e-8
    slope = (opening(wanted + step, 3.125e-3) - opening(wanted - step, 3.125e-3)) / (2 * step)
    assert root["stiffness"] == pytest.approx(-slope, rel=1e-4)


def test_given_clearance_is_its_own_equilibrium():
    found = answer(read_scenario(REFERENCE))
    assert [r["clearance"] for r in found["roots"]] == [pytest.approx(10e-6, rel=1e-9)]
    assert found["closing_force"] == pytest.approx(opening(10e-6, 3.125e-3), rel=1e-8)


def test_diverging_film_has_an_unstable_equilibrium():
    found = answer(balanced(-0.1, 0.45, 0.0))
    (root,) = found["roots"]
    assert not root["stable"] and root["stiffness"] < 0
    assert root["clearance"] == pytest.approx(
        brentq(lambda c: opening(c, -1e-4) - found["closing_force"], 0.9e-6, 1e-3), rel=1e-6
    )


def test_two_supports_hold_a_film_in_series():
    """What they just hold makes the stiffness of the two rings' axial motion singular."""
    scenario = read_scenario(REFERENCE.with_name("fmsr_both_flexible.toml"))
    scenario = with_values(scenario, {"stator.support.axial_stiffness": 2e5})
    rotor, stator = (ring.support.axial_stiffness for ring in (scenario.scene.rotor, scenario.scene.stator))
    film = -answer(scenario)["support_stiffness"]
    matrix = np.array([[rotor + film, -film], [-film, stator + film]])
    assert np.linalg.eigvalsh(matrix) == pytest.approx([0.0, np.trace(matrix)], abs=1e-9 * rotor)


def test_no_equilibrium_is_an_answer_not_an_error():
    found = answer(balanced(3.125, 0.3, 0.0))
    assert found["roots"] == [] and found["closing_force"] < min(found["curve"]["opening_force"])


def test_range_limits_what_is_reported():
    assert answer(read_scenario(REFERENCE), clearance_from=2e-5, clearance_to=1e-4)["roots"] == []


def test_curve_is_the_opening_force():
    found = answer(read_scenario(REFERENCE), points=7)["curve"]
    for clearance, force in zip(found["clearance"], found["opening_force"], strict=True):
        assert force == pytest.approx(opening(clearance, 3.125e-3), rel=1e-7)


def test_a_scenario_without_a_question_has_a_figure_too(tmp_path):
    text = "".join(line for line in REFERENCE.read_text().splitlines(True) if not line.startswith("#"))
    found = run_study("equilibrium", parse_scenario(text, "[bare]"), tmp_path / "bare.h5", workers=1)
    study = read_study(found["archive"])
    assert (study["question"], study["name"]) == ("", "[bare]")
    above, below = study["panels"]
    assert above["series"][0]["y"] == found["curve"]["opening_force"]
    assert below["series"][0]["y"] == found["curve"]["stiffness"]
    assert sealdyn.study("equilibrium", parse_scenario(text, "[bare]"), workers=1).plot().axes
