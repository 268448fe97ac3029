"""`sealdyn validate`, Green: every row of his Table 1 holds, and the one that the print has wrong says so."""

import pytest

from sealdyn import closed_form
from sealdyn.analysis.sources import green_1989
from sealdyn.analysis.validation import report


@pytest.fixture(scope="module")
def rows():
    return green_1989.checks()


# What Green prints and what is computed from his formulas: (seal, c, quantity) -> printed, computed, verdict.
TABLE = {
    ("FMR", None, "static_transmissibility"): (0.071, 0.0707, "agrees"),
    ("FMR", 0.5, "dynamic_transmissibility"): (0.055, 0.0549, "agrees"),
    ("FMR", 3.0, "dynamic_transmissibility"): (0.066, 0.0665, "agrees"),
    ("FMR", 0.5, "maximum_relative_misalignment"): (0.126, 0.1256, "agrees"),
    ("FMR", 3.0, "maximum_relative_misalignment"): (0.137, 0.1372, "agrees"),
    ("FMR", 0.5, "critical_misalignment"): (16.86, 16.90, "rounding"),
    ("FMR", 3.0, "critical_misalignment"): (16.76, 16.74, "rounding"),
    ("FMR", 0.5, "critical_speed"): (None, None, "agrees"),
    ("FMR", 3.0, "critical_speed"): (8.4e3, 8.684e3, "print differs"),
    ("FMS", None, "static_transmissibility"): (0.061, 0.0614, "agrees"),
    ("FMS", None, "dynamic_transmissibility"): (0.080, 0.0797, "agrees"),
    ("FMS", None, "maximum_relative_misalignment"): (0.141, 0.1411, "agrees"),
    ("FMS", None, "critical_misalignment"): (14.8, 14.91, "rounding"),
    ("FMS", None, "critical_speed"): (5.9e3, 5.89e3, "agrees"),
}


@pytest.mark.core
def test_every_row_has_its_verdict(rows):
    found = {(r["arrangement"], r["inertia_ratio"], r["quantity"]): r for r in rows}
    assert found.keys() == TABLE.keys() and len(rows) == len(TABLE)
    for key, (published, computed, verdict) in TABLE.items():
        row = found[key]
        assert (row["published"], row["verdict"]) == (published, verdict), key
        for road in ("formula", "linear_algebra", "time_domain"):
            assert row[road] is None if computed is None else row[road] == pytest.approx(computed, rel=1e-3), key


def test_the_three_roads_agree_far_better_than_the_digits_printed(rows):
    """Measured: 1e-15 to 2e-7 apart, an extreme's slack among it."""
    assert all(row["roads_apart"] < 6e-7 for row in rows if row["roads_apart"] is not None)


def test_the_print_that_differs_is_explained(rows):
    (row,) = [r for r in rows if r["verdict"] == "print differs"]
    assert row["deviation"] == pytest.approx(0.034, abs=5e-4)
    assert "8.399e3" in row["remark"]
    # The explanation's arithmetic: film stiffness alone in place of support plus film.
    film = closed_form.film_coefficients(0.032, 0.04, 1e-5, 3.125e-3, 0.5e-3, 5e5)
    d_s, c = 300.0 * 0.04**2 / 2, 3.0
    nu = (d_s + film.tilt_damping / 2) / (d_s + film.tilt_damping)
    assert (film.tilt_stiffness / 8e-4 / (nu * (nu - 1 / c))) ** 0.5 == pytest.approx(8.399e3, rel=1e-4)


def test_report_shows_every_row_and_remark(rows, capsys):
    report({"green-1989": rows})
    printed = capsys.readouterr().out
    assert "print differs" in printed and "8683.96" in printed and "none" in printed
    assert all(row["remark"] in printed for row in rows)
    assert len(printed.splitlines()) == 2 + len(rows) + len({row["remark"] for row in rows if row["remark"]})


WRONG = {
    "fmr_static": 0, "fmr_dynamic": 1, "fmr_critical_speed": 8, "fms_static": 9, "fms_dynamic": 10,
    "fms_critical_speed": 13,
}  # fmt: skip


@pytest.mark.parametrize("wrong", WRONG)
def test_a_wrong_formula_fails(wrong, monkeypatch):
    """One per cent off in one road: its row fails."""
    right = getattr(closed_form, wrong)
    monkeypatch.setattr(green_1989.cf, wrong, lambda **numbers: 1.01 * right(**numbers))
    monkeypatch.setattr(green_1989.cf, "GREEN_1989", [closed_form.GREEN_1989[WRONG[wrong]]])
    (row,) = green_1989.checks()
    assert row["quantity"].startswith(wrong[4:]) and row["arrangement"] == wrong[:3].upper()
    assert row["verdict"] == "FAILED" and row["remark"] == "the three methods disagree"
    assert row["roads_apart"] == pytest.approx(1 - 1 / 1.01, rel=1e-3)
