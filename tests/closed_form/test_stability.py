"""Whirl thresholds against eigenvalues of the complex tilt equation; Table 1 of Green (1989), every row recomputed: the
rows that disagree are named with their size."""

import numpy as np
import pytest
from oracles import contact_tilt, tilt_roots
from scipy.optimize import brentq

from sealdyn import closed_form
from sealdyn.closed_form import (
    critical_forcing,
    film_coefficients,
    fmr_critical_speed,
    fmr_whirl_ratio,
    fms_critical_speed,
    fms_whirl_ratio,
    superposed,
    unconditional_inertia_ratio,
)
from sealdyn.closed_form.green_1989 import GREEN_1989, GREEN_1989_ROUNDED, GREEN_1989_SEAL, green_1989_tilt

REFERENCE = {"support_stiffness": 400.0, "support_damping": 0.24}
REFERENCE |= {"film_stiffness": 5790.5836, "film_damping": 4.0820736, "transverse_inertia": 8e-4}


def eigenvalues(seal, speed, flexible):
    support = dict(k_s=seal["support_stiffness"], d_s=seal["support_damping"])
    film, body = dict(k=seal["film_stiffness"], d=seal["film_damping"]), dict(inertia=seal["transverse_inertia"])
    return tilt_roots(speed, flexible, polar=seal["polar_inertia"], **body, **support, **film)


def crossing(seal, flexible, top=1e5):
    """Lowest speed where an eigenvalue crosses into growth, and its whirl ratio; None if there is none."""
    speeds = np.geomspace(1.0, top, 400)
    growth = np.array([eigenvalues(seal, w, flexible).real.max() for w in speeds])
    if growth.max() < 0:
        return None
    first = int(np.argmax(growth > 0))
    speed = brentq(lambda w: eigenvalues(seal, w, flexible).real.max(), speeds[first - 1], speeds[first], xtol=1e-9)
    roots = eigenvalues(seal, speed, flexible)
    return speed, roots[roots.real.argmax()].imag / speed


LAWS = {"rotor": (fmr_critical_speed, fmr_whirl_ratio), "stator": (fms_critical_speed, fms_whirl_ratio)}


@pytest.mark.parametrize("flexible", ["rotor", "stator"])
@pytest.mark.parametrize("inertia_ratio", [3.0, 10.0, np.inf])
@pytest.mark.parametrize("change", [{}, {"support_damping": 2.0}, {"film_stiffness": -300.0}])
def test_threshold_is_where_an_eigenvalue_crosses(flexible, inertia_ratio, change):
    seal = REFERENCE | {"polar_inertia": 8e-4 / inertia_ratio} | change
    critical_speed, whirl_ratio = LAWS[flexible]
    speed, ratio = crossing(seal, flexible)
    assert critical_speed(**seal) == pytest.approx(speed, rel=1e-9)
    damping = {name: seal[name] for name in ("support_damping", "film_damping")}
    assert whirl_ratio(**damping) == pytest.approx(ratio, rel=1e-9)
    for factor, sign in ((0.99, -1), (1.01, 1)):
        assert sign * eigenvalues(seal, factor * speed, flexible).real.max() > 0


def test_a_film_with_negative_damping_whirls_backward():
    seal = REFERENCE | {"support_damping": 5.0, "film_damping": -2.0, "polar_inertia": 0.0}
    speed, ratio = crossing(seal, "stator")
    assert ratio < 0
    assert fms_critical_speed(**seal) == pytest.approx(speed, rel=1e-9)


@pytest.mark.core
def test_reference_seal_thresholds():
    # 5.89e3 rad/s printed as 5.9e3; none for c = 1/2.
    assert fms_critical_speed(**REFERENCE) == pytest.approx(5.89e3, abs=5.0)
    assert fmr_critical_speed(**REFERENCE, polar_inertia=16e-4) is None
    assert crossing(REFERENCE | {"polar_inertia": 16e-4}, "rotor", top=1e7) is None


def test_short_disk_is_stable_at_every_speed():
    damping = {name: REFERENCE[name] for name in ("support_damping", "film_damping")}
    limit = unconditional_inertia_ratio(**damping)
    assert limit == pytest.approx(1.895, abs=5e-4)
    shorter = REFERENCE | {"polar_inertia": 8e-4 / (0.999 * limit)}
    assert fmr_critical_speed(**shorter) is None
    assert crossing(shorter, "rotor", top=1e7) is None
    longer = REFERENCE | {"polar_inertia": 8e-4 / (1.001 * limit)}
    assert fmr_critical_speed(**longer) == pytest.approx(crossing(longer, "rotor", top=1e7)[0], rel=1e-8)


def test_nothing_that_could_whirl_has_no_threshold():
    seal = REFERENCE | {"polar_inertia": 0.0}
    assert fms_critical_speed(**seal | {"film_damping": 0.0}) is None
    for law in (fms_critical_speed, fmr_critical_speed):
        assert law(**seal | {"transverse_inertia": 0.0}) is None


@pytest.mark.parametrize("wrong", [{"film_stiffness": -400.0}, {"film_damping": -0.24}])
def test_formulas_refuse_what_they_cannot_answer(wrong):
    for law in (fms_critical_speed, fmr_critical_speed):
        with pytest.raises(ValueError, match="must be positive"):
            law(**REFERENCE | {"polar_inertia": 1e-4} | wrong)


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
