"""Which type of seal a duty allows: the guide's tables by hand, and that no harder duty allows more."""

from dataclasses import replace

import pytest
from hypothesis import given
from hypothesis import strategies as st

from sealdyn.analysis.design_rules import findings
from sealdyn.analysis.other_rules import Duty, limits, suited
from sealdyn.analysis.other_rules import findings as radial_findings
from sealdyn.scenario.reader import read_scenario
from sealdyn.simulation.simulate import prepare_run

FACE, LIP, RIBBED, SEGMENTS = "face seal", "conventional lip seal", "hydrodynamic lip seal", "circumferential seal"
# ft/min and psi.
FPM, PSI, MM = 0.3048 / 60, 6894.757, 1e-3
SHAFT = Duty(speed=0.0, pressure=0.0, runout=0.0, eccentricity=0.0, travel=0.0, diameter=0.1)


def allowed(**asked):
    return {row["type"]: row["allowed"] for row in suited(replace(SHAFT, **asked))}


@pytest.mark.core
@pytest.mark.parametrize(
    ("asked", "types"),
    [
        ({}, {FACE, LIP, RIBBED, SEGMENTS}),
        # No table goes faster than its type.
        ({"speed": 4001 * FPM}, {FACE, RIBBED, SEGMENTS}),
        ({"speed": 7010 * FPM}, {FACE, SEGMENTS}),
        ({"speed": 15_000 * FPM}, {FACE}),
        ({"speed": 20_001 * FPM}, set()),
        # Table 3.1: at 3 psi 2000 ft/min; table 3.3: at 20.6 kPa 1220 m/min, at 34.4 kPa 610.
        ({"pressure": 3 * PSI, "speed": 1990 * FPM}, {FACE, LIP, RIBBED}),
        ({"pressure": 3 * PSI, "speed": 2010 * FPM}, {FACE, RIBBED}),
        ({"pressure": 20.6e3, "speed": 1210 / 60}, {FACE, RIBBED}),
        ({"pressure": 0.9 * PSI, "speed": 1000 * FPM}, {FACE, LIP, RIBBED, SEGMENTS}),
        ({"pressure": 5.1 * PSI}, {FACE}),
        ({"pressure": 700e4}, set()),
        # Table 3.2: 0.254 mm in all allow 2000 ft/min; a hydrodynamic lip takes 0.127 mm.
        ({"eccentricity": 0.254 * MM, "speed": 1990 * FPM}, {FACE, LIP, SEGMENTS}),
        ({"eccentricity": 0.254 * MM, "speed": 2010 * FPM}, {FACE, SEGMENTS}),
        ({"eccentricity": 0.39 * MM}, {FACE, SEGMENTS}),
        # Table 3.4: 0.254 mm TIR allow 2440 m/min, half a thousandth of the diameter; table 3.8: 0.254 mm from 3044 on.
        ({"runout": 0.254 * MM, "speed": 2430 / 60, "diameter": 0.6}, {FACE, SEGMENTS}),
        ({"runout": 0.254 * MM, "speed": 2450 / 60, "diameter": 0.6}, {FACE}),
        ({"runout": 0.06 * MM, "speed": 1.0}, {FACE, LIP, RIBBED}),
        ({"runout": 0.26 * MM, "speed": 3050 / 60}, set()),
        # What rides on the shaft follows any travel.
        ({"travel": 1.28 * MM}, {LIP, RIBBED, SEGMENTS}),
    ],
)
def test_the_guides_tables_by_hand(asked, types):
    asked = {"eccentricity": 0.5 * asked.get("runout", 0.0), **asked}
    found = allowed(**asked)
    assert {name for name in found if found[name]} == types


def test_what_is_not_said_leaves_a_type_open_and_what_is_beyond_rules_it_out():
    found = {row["type"]: row for row in suited(Duty(speed=7.0, pressure=1e5))}
    assert found[FACE]["allowed"] is None and found[FACE]["unknown"] == ["runout", "travel"]
    assert found[LIP]["allowed"] is False and [b["what"] for b in found[LIP]["beyond"]] == ["pressure"]
    assert found[LIP]["beyond"][0]["most"] == pytest.approx(5 * PSI)


SIZES = st.fixed_dictionaries({
    "speed": st.floats(0, 120), "pressure": st.floats(0, 1e7), "runout": st.floats(0, 6e-4),
    "eccentricity": st.floats(0, 5e-4), "travel": st.floats(0, 2e-3),
})  # fmt: skip


@given(SIZES, st.sampled_from(["speed", "pressure", "runout", "eccentricity", "travel"]), st.floats(1.0, 4.0))
def test_no_harder_duty_allows_another_type(asked, key, times):
    easy, hard = allowed(**asked), allowed(**{**asked, key: times * asked[key]})
    assert all(easy[name] or not hard[name] for name in easy)


def test_every_type_has_a_speed_and_a_pressure():
    for name, checks in limits(SHAFT).items():
        assert [what for what, *_ in checks][:2] == ["speed", "pressure"], name


@pytest.mark.parametrize(("file", "own"), [("lip_reference", LIP), ("circumferential_reference", SEGMENTS)])
def test_radial_seals_are_judged_by_their_own_type(file, own):
    scenario = read_scenario(f"scenarios/radial/{file}.toml")
    (row,) = (row for row in radial_findings(scenario) if row["rule"] == "seal_type")
    (ours,) = (one for one in row["types"] if one["type"] == own)
    assert (row["verdict"] == "note") == (ours["allowed"] is False)
    assert {one["type"] for one in row["types"]} == {FACE, LIP, RIBBED, SEGMENTS}


def test_a_data_sheet_selects():
    """The pump of the shipped file: 10 bar of water at 55 mm; only faces seal that."""
    scenario = read_scenario("scenarios/pump_seal.toml")
    (row,) = (row for row in findings(scenario, prepare_run(scenario)[0].model) if row["rule"] == "seal_type")
    assert row["verdict"] == "pass" and {one["type"] for one in row["types"] if one["allowed"]} == {FACE}
