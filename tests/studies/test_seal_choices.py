"""Coning and inertia ratio in the transmissibility study: the stiffest film, the rotor's ratio I/J, axial groups."""

import numpy as np
import pytest
from command import SCENARIOS
from in_process import InProcess
from scipy.integrate import quad
from scipy.optimize import minimize_scalar

from sealdyn import read_scenario
from sealdyn.closed_form import film_coefficients, optimum_coning
from sealdyn.closed_form.green_1989 import GREEN_1989_ROUNDED
from sealdyn.studies import transmissibility
from sealdyn.studies.transmissibility import Settings

# Green's seal: N m/rad, N m s/rad, kg m^2, rad/s.
K, D, K_S, D_S, INERTIA, SPEED = 5790.58, 4.082, 400.0, 0.24, 8e-4, 1000.0


def answer(file="fmr_reference.toml", overrides=("film.model=linear",)):
    scenario = read_scenario(SCENARIOS / file, overrides)
    return transmissibility.run(scenario, Settings(points=2, time_points=0), InProcess()).numbers


@pytest.fixture(scope="module")
def greens():
    return answer()


@pytest.mark.parametrize("inner, outer, drop", [(0.032, 0.04, 5e5), (0.032, 0.04, -5e5), (0.06, 0.1, 5e5)])
def test_no_other_coning_makes_a_narrow_film_stiffer(inner, outer, drop):
    """Thinnest place kept, at the edge of the lower pressure; of `film_coefficients`, whose coning grows outwards."""
    thinnest, sign = 10e-6, np.sign(drop)
    low, high = (inner, outer) if drop > 0 else (outer, inner)

    def stiffness(coning):
        clearance = thinnest + (0.0 if drop > 0 else coning * (outer - inner))
        return film_coefficients(inner, outer, clearance, sign * coning, 5e-4, drop).tilt_stiffness

    best = optimum_coning(low, high, thinnest)
    found = minimize_scalar(lambda c: -stiffness(c), bounds=(0, 10 * best), method="bounded", options={"xatol": 1e-12})
    assert best == pytest.approx(found.x, rel=1e-6)
    largest = np.pi * abs(drop) * low**2 * (outer**2 - inner**2) / (16 * thinnest)
    assert stiffness(best) == pytest.approx(largest if drop > 0 else -found.fun, rel=1e-12)


@pytest.mark.core
def test_greens_seal_has_the_coning_of_the_stiffest_film(greens):
    """He prints b = 12.5; 2 / (R (1 - R)) at R = 0.8."""
    own, narrow, stiffest = greens["over_coning"]
    assert (own["of_thinnest"], narrow["of_thinnest"]) == pytest.approx((12.5, 12.5), rel=1e-12)
    assert stiffest["of_thinnest"] == pytest.approx(12.5, rel=1e-3)
    for row in (own, narrow):
        assert row["tilt_stiffness"] == pytest.approx(K, rel=1e-4)
        assert [row[name] for name in ("fmr", "fms")] == pytest.approx([0.126, 0.141], abs=1e-3)


@pytest.mark.parametrize("pressed", ["outside", "inside"])
def test_the_stiffest_film_over_the_radius(pressed):
    """Of planes turned about a diameter, integrated here: K = -pi int r^2 dp/dgamma dr, thinnest at the edge of the
    lower pressure."""
    overrides = ["film.model=radial", "film.geometry=planar"]
    if pressed == "inside":
        # The cone of the file turned round: 35 um at the inner edge, 10 um at the outer.
        overrides += ["film.outer_pressure=0", "film.inner_pressure=5e5", "film.coning=-3.125 mrad",
                      "film.clearance=35 um"]  # fmt: skip
    r_i, r_o, thinnest, drop = 0.032, 0.04, 10e-6, 5e5

    def stiffness(coning):
        """h^3 p' = const; a tilt of 1 takes r off h, and p answers to first order."""
        high, low = (r_o, r_i) if pressed == "outside" else (r_i, r_o)

        def h(r):
            return thinnest + coning * abs(r - low)

        whole = quad(lambda r: h(r) ** -3, r_i, r_o)[0]

        # With F(r) = int_low^r h^-3: p = drop F/whole, and of h' = -r: F' = int 3 r h^-4.
        def part(n, r):
            return abs(quad(lambda x: x**n / h(x) ** (3 + n), low, r)[0])

        more = 3 * part(1, high)

        def change(r):
            return drop * (3 * part(1, r) / whole - part(0, r) * more / whole**2)

        # The moment that turns back is that of the pressure at the thin side, p r^2 dr cos^2.
        return np.pi * quad(lambda r: change(r) * r**2, r_i, r_o, epsrel=1e-8)[0]

    (own, _, found) = answer(overrides=overrides)["over_coning"]
    assert own["tilt_stiffness"] == pytest.approx(stiffness(own["coning"]), rel=1e-6)
    best = minimize_scalar(lambda c: -stiffness(c), bounds=(1e-3, 6e-3), method="bounded", options={"xatol": 1e-6})
    assert found["coning"] == pytest.approx(best.x, rel=3e-3)
    assert found["tilt_stiffness"] == pytest.approx(-best.fun, rel=1e-6)


@pytest.mark.core
def test_over_the_inertia_ratio_of_a_floating_rotor(greens):
    """Green's equation of the response to its own misalignment, and his threshold, at every ratio; printed at 1/2 and
    3: 0.055 and 0.066 dynamic, 0.126 and 0.137 in all, no critical speed and 8.684e3 rad/s by his formula."""
    found, static = greens["over_inertia_ratio"], abs((K_S - 1j * D_S * SPEED) / (K + K_S - 1j * (D_S + D / 2) * SPEED))
    rows = dict(zip(found["ratio"], zip(*found["fmr"].values(), strict=True), strict=True))
    whirl = (D_S + D / 2) / (D_S + D)
    assert found["stable_to"] == pytest.approx(1 / whirl, rel=1e-3)
    for ratio, (dynamic, total, critical) in rows.items():
        expected = abs(K_S / ((1 / ratio - 1) * INERTIA * SPEED**2 + K + K_S + 0.5j * D * SPEED))
        assert (dynamic, total) == pytest.approx((expected, static + expected), rel=1e-3)
        assert (critical is None) == (ratio < 1 / whirl)
        if critical:
            assert critical == pytest.approx(np.sqrt((K + K_S) / INERTIA / (whirl * (whirl - 1 / ratio))), rel=3e-3)
    assert rows[0.5][:2] == pytest.approx((0.055, 0.126), abs=1e-3) and rows[3.0][:2] == pytest.approx(
        (0.066, 0.137), abs=1e-3
    )
    assert rows[3.0][2] == pytest.approx(8.684e3, rel=1e-3)


def test_two_floating_rings_over_the_inertia_ratio(greens):
    """Both on their supports, by a small system of equations in the frame of the shaft, written here."""
    found = greens["over_inertia_ratio"]
    for ratio, dynamic in zip(found["ratio"], found["fmsr"]["dynamic"], strict=True):
        film = K + 0.5j * D * SPEED
        stator = K_S - INERTIA * SPEED**2 + 1j * D_S * SPEED
        rotor = K_S + (1 / ratio - 1) * INERTIA * SPEED**2
        tilts = np.linalg.solve([[stator + film, -film], [-film, rotor + film]], [0.0, K_S])
        assert dynamic == pytest.approx(abs(tilts[0] - tilts[1]), rel=1e-3)


def test_axial_groups_of_greens_seal(greens):
    """I = m r_o^2 / 2 and K_s = K_z r_s^2 / 2 with r_s = r_o: mass and support have twice his groups of tilt.  The
    narrow film's from its own pressure, K_z = 2 pi R_m (1 - R) P b (1 - R) / (2 + b (1 - R))^2, D_z = 2 D_f / R_m^2."""
    axial, tilt = greens["groups"]["axial"], greens["groups"]
    for ring in ("rotor", "stator"):
        assert axial[ring]["mass"] == pytest.approx(2 * tilt[ring]["transverse_inertia"], rel=1e-12)
        assert axial[ring]["mass"] == pytest.approx(2 * GREEN_1989_ROUNDED["transverse_inertia"], rel=5e-3)
        assert axial[ring]["stiffness"] == pytest.approx(2 * GREEN_1989_ROUNDED["support_stiffness"], rel=5e-3)
        assert axial[ring]["damping"] == pytest.approx(2 * GREEN_1989_ROUNDED["support_damping"], rel=5e-3)
    stiffness = 2 * np.pi * 0.9 * 0.2 * tilt["pressure_drop"] * 12.5 * 0.2 / (2 + 12.5 * 0.2) ** 2
    assert axial["film"]["stiffness"] == pytest.approx(stiffness, rel=1e-9)
    assert axial["film"]["damping"] == pytest.approx(2 * GREEN_1989_ROUNDED["film_damping"] / 0.9**2, rel=5e-3)


def test_where_there_is_nothing_to_choose():
    given = answer(overrides=["film.model=linear", "film.coefficients.tilt_stiffness=5791",
                              "film.coefficients.tilt_damping=4", "film.coefficients.axial_stiffness=1e6",
                              "film.coefficients.axial_damping=1e3"])  # fmt: skip
    assert given["over_coning"] == [] and given["over_inertia_ratio"]["ratio"]
    massless = answer(overrides=["film.model=linear", "rotor.transverse_inertia=0", "rotor.polar_inertia=0"])
    assert massless["over_inertia_ratio"] == {} and len(massless["over_coning"]) == 3
