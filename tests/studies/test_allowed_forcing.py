"""What faces that touch at rest allow, and the onset of films that store: against a static balance around the circle,
and ramps."""

import numpy as np
import pytest
from command import SCENARIOS
from in_process import InProcess
from own_wavy_wear import touching
from scipy.optimize import brentq

from sealdyn import read_scenario
from sealdyn.studies import contact_onset
from sealdyn.studies.contact_onset import Settings, allowed, ramped

# A ring that does not follow: the faces are as far out of square as the shaft.
STUBBORN = ["stator.support={axial_stiffness=2e4, axial_damping=30, tilt_stiffness=1e9}", "run.accuracy=1e-5"]
INNER, OUTER, HALF, STRENGTH, CONING = 0.032, 0.040, 3e-7, 100e6, 60e-6


def largest_pressure(tilt):
    """Contact pressure (Pa) at the thinnest place of faces `tilt` (rad) out of square that carry the closing force: the
    film of every angle by itself, that of a cone (its wedge adds and takes away the same), and asperities."""
    theta = 2.0 * np.pi * (np.arange(90) + 0.5) / 90
    node, share = np.polynomial.legendre.leggauss(24)
    r = 0.5 * (INNER + OUTER) + 0.5 * (OUTER - INNER) * node
    area = 0.5 * (OUTER - INNER) * share * r * 2.0 * np.pi / 90

    def gap(clearance):
        return clearance + CONING * (r - INNER) + tilt * r * np.cos(theta)[:, None]

    def excess(clearance):
        h = gap(clearance)
        along = np.linspace(INNER, OUTER, 501)
        thick = np.maximum(clearance + CONING * (along - INNER) + tilt * along * np.cos(theta)[:, None], 0.3 * HALF)
        resistance = np.cumsum(1.0 / (thick**3 * along), axis=1)
        pressed = 1e5 + 3e5 * resistance / resistance[:, -1:]
        film = sum(np.interp(r, along, row) @ area for row in pressed)
        rough = float((STRENGTH * touching(h / HALF) @ area).sum())
        closing = (4e5 * 0.75 + 1e5 * 0.25) * np.pi * (OUTER**2 - INNER**2) + 60.0
        return film + rough - closing

    clearance = brentq(excess, 0.3 * HALF, 3e-6)
    thinnest = min(clearance - tilt * INNER, clearance + CONING * (OUTER - INNER) - tilt * OUTER)
    return STRENGTH * touching(thinnest / HALF)


def test_a_ring_that_does_not_follow_allows_what_a_static_balance_says():
    scenario = read_scenario(SCENARIOS / "run_in.toml", STUBBORN)
    found = allowed(scenario, {"key": "rotor.runout", "share": 0.5, "limit": "pressure"})
    assert found["at_rest"] == pytest.approx(largest_pressure(0.0), rel=0.02)
    assert largest_pressure(found["value"]) / largest_pressure(0.0) == pytest.approx(1.5, rel=0.02)
    assert max(found["path"]["rise"]) >= 0.5


@pytest.mark.slow
def test_a_ring_that_follows_allows_any_small_tilt():
    scenario = read_scenario(SCENARIOS / "run_in.toml", ["run.accuracy=1e-5"])
    answer = contact_onset.run(scenario, Settings(limit="wear"), InProcess())
    found = answer.numbers["allowed"]
    assert answer.numbers["nonlinear"] == 0.0 and found["value"] is None and "failed" not in found
    assert answer.numbers["units"]["allowed/at_rest"] == "m/s"
    none = read_scenario(SCENARIOS / "run_in.toml", ["contact.stator_wear_coefficient=0",
                                                     "contact.rotor_wear_coefficient=0"])  # fmt: skip
    assert allowed(none, {"key": "rotor.runout", "share": 0.1, "limit": "wear"})["failed"]
    assert "allowed" not in contact_onset.run(scenario, Settings(share=0.0), InProcess()).numbers


GAS = ["film.gas_reynolds={cells=[6, 16]}", "run.accuracy=0.05", "stator.misalignment=0"]


@pytest.mark.slow
def test_a_film_that_stores_touches_at_the_end_of_a_ramp():
    """A ring that does not follow: the faces meet where the tilt closes the gap at the inner radius, opening or not."""
    stubborn = "stator.support={axial_stiffness=1e10, axial_damping=1e5, tilt_stiffness=1e7, tilt_damping=10}"
    scenario = read_scenario(SCENARIOS / "gas_reynolds_reference.toml", [*GAS, stubborn])
    closes = 4e-6 / 0.060
    found = ramped(scenario, "rotor.runout", closes, 1e-2, 0.0)
    assert found["nonlinear"] == pytest.approx(closes, rel=0.05)
    assert found["ramps"][0] == pytest.approx(found["ramps"][1], rel=0.02)


@pytest.mark.slow
def test_a_ring_that_follows_on_gas_does_not_touch_within_twice_its_linear_onset():
    scenario = read_scenario(SCENARIOS / "gas_reynolds_reference.toml", GAS)
    answer = contact_onset.run(scenario, Settings(), InProcess())
    assert answer.numbers["not_before"] > answer.numbers["formula"] and "failed" not in answer.numbers
