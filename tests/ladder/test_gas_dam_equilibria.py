"""Axial stiffness of gas dams at cruise: where parallel and divergent ones are statically unstable."""

import numpy as np
import pytest
from command import SCENARIOS
from scipy.optimize import brentq

from sealdyn.closed_form.zuk_1972 import CRUISE, MIL
from sealdyn.films.gas_dam import film as gas_dam
from sealdyn.scenario.reader import read_scenario, with_values
from sealdyn.scene.film import Film
from sealdyn.scene.fluid import Gas, GasDam
from sealdyn.studies import equilibrium

WIDTH = CRUISE.outer_radius - CRUISE.inner_radius


def stiffness(mean_film, tilt, friction="blend"):
    """-dF/dh (N/m) at a mean film (mil)."""
    clearance = mean_film * MIL - tilt * WIDTH / 2
    factor, s = CRUISE.sutherland
    reference = factor * 273.15**1.5 / (273.15 + s)
    table = Film(
        model="gas_dam", gas=Gas(CRUISE.gas_constant, CRUISE.heat_ratio, reference, 273.15, s), clearance=clearance,
        temperature=CRUISE.temperature, inner_radius=CRUISE.inner_radius, outer_radius=CRUISE.outer_radius,
        inner_pressure=CRUISE.high_pressure, outer_pressure=CRUISE.low_pressure, coning=tilt,
        gas_dam=GasDam(friction=friction, width="zuk" if tilt else "constant"),
    )  # fmt: skip
    force, step = gas_dam.opening_law(table), 1e-3 * clearance
    ends = (force(clearance + x, CRUISE.high_pressure, CRUISE.low_pressure) for x in (-step, step))
    return -float(np.diff(list(ends))[0]) / (2 * step)


@pytest.mark.parametrize("tilt,mils", [(0.0, 0.551), (0.002, 0.635)])
def test_parallel_and_divergent_dams_are_unstable_when_thin(tilt, mils):
    """Choking makes the thicker ones stable."""
    assert brentq(stiffness, 0.3, 0.9, args=(tilt,)) == pytest.approx(mils, abs=0.002)
    assert all(stiffness(h, tilt) < 0 for h in np.linspace(0.15, 0.99 * mils, 9))
    assert all(stiffness(h, tilt) > 0 for h in np.linspace(1.01 * mils, 1.0, 5))


@pytest.mark.core
def test_a_convergent_dam_is_stable():
    assert all(stiffness(h, -0.002) > 0 for h in np.linspace(0.1, 1.0, 19))


def test_a_study_names_the_unstable_one():
    """At a parallel film of 0.3 mil, and the same load at 0.9 mil once more, where it is stable."""
    scenario = read_scenario(SCENARIOS / "gas_dam_reference.toml")
    parallel = with_values(scenario, {"film.coning": 0.0, "film.clearance": "0.3 mil"})
    answer = equilibrium.run(parallel, equilibrium.Settings(), None)
    thin, thick = answer["roots"]
    assert not thin["stable"] and thin["clearance"] == pytest.approx(0.3 * MIL, rel=1e-6)
    assert thick["stable"] and 0.7 * MIL < thick["clearance"] < 1.2 * MIL
    (loose,) = [root["clearance"] for root in answer["roots"] if not root["stable"]]
    assert loose == pytest.approx(7.62e-6, rel=1e-3)
