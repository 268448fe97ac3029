"""Two floating rings: the closed form against the rings' equations in turning axes and in 40 digits."""

import mpmath as mp
import numpy as np
import pytest
from oracles import tilts_in_turning_axes

from sealdyn import closed_form
from sealdyn.closed_form import TiltingRing, fmsr_relative_tilts

# Green's ring, short and long; a light one; a heavy one on a stiff damped support.
SHORT, LONG = (8e-4, 16e-4, 400.0, 0.24), (8e-4, 8e-4 / 3, 400.0, 0.24)
LIGHT, HEAVY = (3e-5, 2e-5, 90.0, 0.0), (4e-3, 7e-3, 3000.0, 2.5)
K_F, D_F = 5790.583579096709, 4.082073628553869
SEALS = [(SHORT, SHORT, K_F, D_F), (LONG, SHORT, K_F, D_F), (HEAVY, LIGHT, 900.0, 2.0), (LIGHT, LONG, -30.0, 0.7)]


def closed(w, rotor, stator, k=K_F, d=D_F):
    return fmsr_relative_tilts(w, k, d, TiltingRing(*rotor), TiltingRing(*stator))


@pytest.mark.parametrize("rotor, stator, k, d", SEALS)
@pytest.mark.parametrize("w", [1.0, 350.0, 1000.0, 2700.0, -1800.0])
def test_rings_in_turning_axes(rotor, stator, k, d, w):
    static, dynamic = closed(w, rotor, stator, k, d)
    expected = tilts_in_turning_axes(0.0, w, k, d, rotor, stator, own_stator=1.0)
    assert [static.real, static.imag] == pytest.approx(expected, rel=1e-10, abs=1e-12)
    expected = tilts_in_turning_axes(w, w, k, d, rotor, stator, own_rotor=1.0)
    assert [dynamic.real, dynamic.imag] == pytest.approx(expected, rel=1e-10, abs=1e-12)


def numbers(ring, w):
    names = ("transverse_inertia", "polar_inertia", "support_stiffness", "support_damping")
    return dict(zip(names, ring, strict=True), speed=w, film_stiffness=K_F, film_damping=D_F)


@pytest.mark.parametrize("w", [400.0, 1000.0, 2500.0])
def test_one_support_stiffened_leaves_greens_formulas(w):
    """The distance falls as one over the stiffness."""
    apart = []
    for stiff in (1e8, 1e10):
        static, dynamic = np.abs(closed(w, SHORT, (8e-4, 0.0, stiff, 0.24)))
        fmr = [
            static / closed_form.fmr_static(**numbers(SHORT, w)),
            dynamic / closed_form.fmr_dynamic(**numbers(SHORT, w)),
        ]
        static, dynamic = np.abs(closed(w, (8e-4, 16e-4, stiff, 0.24), SHORT))
        fms = [
            static / closed_form.fms_static(**numbers(SHORT, w)),
            dynamic / closed_form.fms_dynamic(**numbers(SHORT, w)),
        ]
        apart.append(np.abs(np.array(fmr + fms) - 1))
    assert np.all(apart[0] < 1e-3) and apart[1] == pytest.approx(apart[0] / 100, rel=0.01, abs=1e-9)


# --- Green's conjecture, in 40 digits -----------------------------------------------------------------


def total(name, w):
    """Total transmissibility of Green's seal, c = 1/2, from the complex equations of both rings in mpmath; a support
    that is not there is rigid."""
    k_s, d_s, inertia, polar = mp.mpf(400), mp.mpf("0.24"), mp.mpf("8e-4"), mp.mpf("16e-4")
    face = dict(r=mp.mpf("0.8"), b=mp.mpf("12.5"), w=mp.mpf(1000))
    r, b = face["r"], face["b"]
    # His film coefficients in SI: S r_o^4 / C = 6 mu w (r_o/C)^2 (1 - R)^2 r_o^4 / C.
    unit = 6 * mp.mpf("0.5e-3") * 1000 * 4000**2 * (1 - r) ** 2 * mp.mpf("0.04") ** 4 / mp.mpf("1e-5")
    drop = mp.mpf("0.5e6") * mp.mpf("0.04") ** 4 / mp.mpf("1e-5")
    k_f = mp.pi * drop * (b * r - 1) * ((1 - r**2) / (4 + 2 * b * (1 - r))) ** 2
    g = (mp.log(1 + b * (1 - r)) - 2 * b * (1 - r) / (2 + b * (1 - r))) / (b**3 * (1 - r) ** 2)
    d_f = 2 * mp.pi * ((1 + r) / 2) ** 3 * g * unit / 1000
    found = mp.mpf(0)
    for frequency in (mp.mpf(0), w):
        film = k_f + 1j * (frequency - w / 2) * d_f
        matrix, push = mp.matrix([[1, 0], [0, 1]]), mp.matrix([frequency != 0, frequency == 0])
        if name in ("fmr", "fmsr"):
            own = k_s - inertia * frequency**2 + polar * w * frequency + 1j * (frequency - w) * d_s
            matrix[0, 0], matrix[0, 1], push[0] = own + film, -film, k_s * (frequency != 0)
        if name in ("fms", "fmsr"):
            own = k_s - inertia * frequency**2 + 1j * frequency * d_s
            matrix[1, 1], matrix[1, 0], push[1] = own + film, -film, k_s * (frequency == 0)
        tilts = mp.lu_solve(matrix, push)
        found += abs(tilts[1] - tilts[0])
    return found


@pytest.mark.core
def test_greens_conjecture_in_40_digits():
    with mp.workdps(40):
        here = {name: float(total(name, mp.mpf(1000))) for name in ("fmr", "fms", "fmsr")}
        crossings = [mp.findroot(lambda w: total("fmsr", w) - total("fmr", w), guess) for guess in (1300, 2300)]
        excess = [
            [total("fmsr", w) > total(name, w) for w in map(mp.mpf, range(100, 4001, 50))] for name in ("fmr", "fms")
        ]
    assert here == {name: pytest.approx(v, abs=5e-5) for name, v in dict(fmr=0.1256, fms=0.1411, fmsr=0.0729).items()}
    assert [float(w) for w in crossings] == pytest.approx([1346.0508, 2327.1723], abs=1e-3)
    speeds = np.arange(100, 4001, 50)
    assert np.array_equal(excess[0], (speeds > 1346) & (speeds < 2328)) and not any(excess[1])
    for w in (1000.0, 1346.0508, 2000.0, 3500.0):
        assert sum(np.abs(closed(w, SHORT, SHORT))) == pytest.approx(float(total("fmsr", mp.mpf(w))), rel=1e-9)


def test_what_the_two_rings_do_to_the_rotors_own_misalignment():
    """A thin disk seen from its shaft has no dip and no peak, I - J = -I stiffens it; the stator has its dip at its own
    resonance on the support; the stiff film between couples both: (I w^2)^2 = K_s^2 + 2 K_s K_f is the peak."""
    speeds = np.linspace(200.0, 4000.0, 3801)
    # Without dampers both are sharp.
    undamped = (8e-4, 16e-4, 400.0, 0.0)
    dynamic = np.abs(fmsr_relative_tilts(speeds, K_F, 0.0, TiltingRing(*undamped), TiltingRing(*undamped))[1])
    assert speeds[np.argmin(dynamic)] == pytest.approx((400.0 / 8e-4) ** 0.5, abs=1.0)
    assert speeds[np.argmax(dynamic)] == pytest.approx(((400.0**2 + 2 * 400.0 * K_F) ** 0.5 / 8e-4) ** 0.5, abs=1.0)


def test_speed_may_be_an_array():
    speeds = np.linspace(0, 3000, 7)
    swept = closed(speeds, LONG, SHORT)
    for part in (0, 1):
        assert swept[part] == pytest.approx([closed(w, LONG, SHORT)[part] for w in speeds])
