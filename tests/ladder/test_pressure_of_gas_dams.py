"""The study of film pressure on a gas dam: what the field sums up to (Zuk's rows: test_zuk_by_the_program.py)."""

import numpy as np
import pytest
from command import SCENARIOS

from sealdyn import read_scenario
from sealdyn.closed_form.zuk_1972 import CRUISE
from sealdyn.scenario.errors import ScenarioError
from sealdyn.studies import pressure
from sealdyn.studies.pressure import Settings

REFERENCE = SCENARIOS / "gas_dam_reference.toml"


def answer(at="", *overrides):
    return pressure.run(read_scenario(REFERENCE, overrides), Settings(at), None).numbers


@pytest.mark.core
def test_the_field_sums_up_to_the_dams_force_and_moments():
    found = answer("tilt = 0.03 mrad")
    assert found["integrated"]["force"] == pytest.approx(found["force"], rel=2e-3)
    assert found["integrated"]["moment"] == pytest.approx(found["moment"], abs=0.02 * np.hypot(*found["moment"]))
    assert found["moment"][0] < -0.1 and found["moment"][1] == 0.0


@pytest.mark.parametrize("at, found", [("clearance=1 mm", "0.001 m"), ("clearance=0.6 mm,tilt=4 mrad", "chokes")])
def test_a_dam_without_a_solution_says_why(at, found):
    with pytest.raises(ScenarioError) as error:
        answer(at)
    assert found in error.value.found and error.value.key == "study.pressure.at"


@pytest.mark.parametrize("width", ["radial", "zuk", "constant"])
def test_a_wide_dam_presses_where_its_width_says(width):
    """On true areas, or everywhere on the mean circumference: on a dam so wide they differ by a tenth."""
    found = answer("", "film.inner_radius=2 in", "film.coning=0", f'film.gas_dam={{width="{width}"}}')
    assert found["integrated"]["force"] == pytest.approx(found["force"], rel=2e-3)
    p, r = np.array(found["pressure"]["p"])[:, 0] - CRUISE.low_pressure, np.array(found["pressure"]["r"])
    share = (r - r[0]) / (r[-1] - r[0])
    p *= r if width == "radial" else 0.5 * (r[0] + r[-1])
    assert found["gauge_force"] == pytest.approx(2 * np.pi * np.trapezoid(p, r), rel=2e-3)
    centre = np.trapezoid(p * share, r) / np.trapezoid(p, r)
    assert found["centre_of_pressure"] == pytest.approx(centre, rel=0.01)
