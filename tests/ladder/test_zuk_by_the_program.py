"""The study of film pressure gives Zuk's table: leakage, force, centre of pressure and exit Mach number of his seal."""

import pytest
from command import SCENARIOS

from sealdyn.closed_form import zuk_1972 as zuk
from sealdyn.scenario.reader import read_scenario, with_values
from sealdyn.studies import pressure

REFERENCE = SCENARIOS / "gas_dam_reference.toml"
WIDTH = zuk.CRUISE.outer_radius - zuk.CRUISE.inner_radius


def answer(row):
    """His conventions: laminar, constant width where parallel, his gas constant."""
    factor, s = zuk.CRUISE.sutherland
    gas = {"gas_constant": zuk.CRUISE.gas_constant, "heat_ratio": zuk.CRUISE.heat_ratio,
           "reference_viscosity": factor * 273.15**1.5 / (273.15 + s), "sutherland_temperature": s}  # fmt: skip
    values = {
        "film.gas": gas, "film.gas_dam": {"friction": "laminar", "width": "zuk" if row.tilt else "constant"},
        "film.coning": row.tilt, "film.clearance": row.mean_film - row.tilt * WIDTH / 2,
    }  # fmt: skip
    scenario = with_values(read_scenario(REFERENCE), values)
    return pressure.run(scenario, pressure.Settings(), None).numbers


@pytest.mark.core
@pytest.mark.parametrize("row", zuk.ZUK_1972, ids=lambda row: f"{row.tilt:g}-{row.mean_film / zuk.MIL:.1f}mil")
def test_rows_of_the_table(row):
    found = answer(row)
    assert found["mass_flow"] == pytest.approx(row.leakage, rel=5e-3)
    assert found["exit_mach"] == pytest.approx(row.exit_mach, rel=5e-3)
    # Forces of tilted rows are wrong in print (validation says why): those computed without the error.
    sharp = 1e-3 if row.tilt else 5e-3
    assert found["gauge_force"] == pytest.approx(row.corrected_force, rel=sharp)
    assert found["centre_of_pressure"] == pytest.approx(row.corrected_centre, rel=sharp)
    if not row.tilt:
        assert found["gauge_force"] == pytest.approx(row.force, rel=5e-3)
        assert found["centre_of_pressure"] == pytest.approx(row.centre, rel=5e-3)
    # What is drawn is what was summed up.
    assert found["integrated"]["force"] == pytest.approx(found["force"], rel=2e-3)
