"""Whirl thresholds against eigenvalues of the complex tilt equation."""

import numpy as np
import pytest
from oracles import tilt_roots
from scipy.optimize import brentq

from sealdyn.closed_form import (
    axial_mode_stable,
    fmr_critical_speed,
    fmr_whirl_ratio,
    fms_critical_speed,
    fms_whirl_ratio,
    unconditional_inertia_ratio,
)

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


def test_printed_rotor_threshold_disagrees_by_three_and_a_half_percent():
    # Green (1989) prints 8.4e3 rad/s for c = 3.  Formula and eigenvalues agree with each other on 8.684e3.
    seal = REFERENCE | {"polar_inertia": 8e-4 / 3}
    computed = fmr_critical_speed(**seal)
    assert computed == pytest.approx(8.684e3, abs=0.5)
    assert crossing(seal, "rotor")[0] == pytest.approx(computed, rel=1e-9)
    assert computed / 8.4e3 - 1 == pytest.approx(0.034, abs=5e-4)
    # The print is what the formula gives with the film's stiffness alone.
    without_support = fmr_critical_speed(**seal | {"support_stiffness": 0.0})
    assert without_support == pytest.approx(8.4e3, abs=50)


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


def test_axial_mode():
    assert axial_mode_stable(support_stiffness=5e5, film_stiffness=-4e5)
    assert not axial_mode_stable(support_stiffness=5e5, film_stiffness=-5e5)
