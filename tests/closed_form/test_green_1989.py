"""Table 1 of Green (1989), every row recomputed; the rows that disagree are named with their size."""

import pytest

from sealdyn import closed_form
from sealdyn.closed_form import (
    GREEN_1989,
    GREEN_1989_ROUNDED,
    GREEN_1989_SEAL,
    contact_tilt,
    critical_forcing,
    film_coefficients,
    green_1989_tilt,
    superposed,
)

FILM = ("inner_radius", "outer_radius", "clearance", "coning", "viscosity", "pressure_drop")
FACE = FILM[:4]
# How far, in units of the last printed digit, the computed value lies from the print.
DISAGREE = {
    ("critical_misalignment", "FMR", 0.5): 4.3,
    ("critical_misalignment", "FMR", 3.0): 2.2,
    ("critical_misalignment", "FMS", None): 1.2,
    ("critical_speed", "FMR", 3.0): 2.9,
}


def exact(inertia_ratio):
    film = film_coefficients(**{name: GREEN_1989_SEAL[name] for name in FILM})
    return green_1989_tilt(film.tilt_stiffness, film.tilt_damping, inertia_ratio or 0.5), 1.0


def rounded(inertia_ratio):
    inertia = GREEN_1989_ROUNDED["transverse_inertia"]
    return GREEN_1989_ROUNDED | {"polar_inertia": inertia / (inertia_ratio or 0.5)}, 1000.0


def compute(row, seal, speed_unit):
    """The quantity of one row, from the formulas, in the unit of the table."""
    flexible = row.arrangement.lower()
    static = getattr(closed_form, f"{flexible}_static")(**seal)
    dynamic = getattr(closed_form, f"{flexible}_dynamic")(**seal)
    if row.quantity == "static_transmissibility":
        return static
    if row.quantity == "dynamic_transmissibility":
        return dynamic
    if row.quantity == "maximum_relative_misalignment":
        return superposed(static, dynamic)[0]
    if row.quantity == "critical_misalignment":
        unit = GREEN_1989_SEAL["clearance"] / GREEN_1989_SEAL["outer_radius"]
        touch = contact_tilt(**{name: GREEN_1989_SEAL[name] for name in FACE})
        own, transmitted = (dynamic, static) if flexible == "fmr" else (static, dynamic)
        return critical_forcing(touch, own * unit, transmitted) / unit
    still = {name: value for name, value in seal.items() if name != "speed"}
    threshold = getattr(closed_form, f"{flexible}_critical_speed")(**still)
    return None if threshold is None else threshold * speed_unit


@pytest.mark.core
@pytest.mark.parametrize("row", GREEN_1989, ids=lambda r: f"{r.arrangement}-{r.quantity}-{r.inertia_ratio}")
def test_table_1(row):
    computed = compute(row, *exact(row.inertia_ratio))
    if row.value is None:
        assert computed is None
        return
    digits = abs(computed - row.value) / row.last_digit
    expected = DISAGREE.get((row.quantity, row.arrangement, row.inertia_ratio))
    if expected is None:
        assert digits < 1
    else:
        assert digits == pytest.approx(expected, abs=0.1)


def test_rounded_inputs_explain_one_critical_misalignment():
    # 16.76 is what the digits printed in the paper give; 16.86 and 14.8 stay unexplained, within 0.8 %.
    rows = {(r.arrangement, r.inertia_ratio): r for r in GREEN_1989 if r.quantity == "critical_misalignment"}
    row = rows["FMR", 3.0]
    assert compute(row, *rounded(3.0)) == pytest.approx(row.value, abs=0.005)
    for row in rows.values():
        assert compute(row, *rounded(row.inertia_ratio)) == pytest.approx(row.value, rel=8e-3)


def test_rounded_inputs_move_no_threshold():
    for row in GREEN_1989:
        if row.quantity == "critical_speed" and row.value is not None:
            by_digits = compute(row, *rounded(row.inertia_ratio))
            assert by_digits == pytest.approx(compute(row, *exact(row.inertia_ratio)), rel=2e-4)
