"""A ring as a fin, its rigid coning and its cooling, against integrals and the numbers of other programs."""

import numpy as np
import pytest
from scipy.integrate import quad, solve_bvp

from sealdyn.closed_form.ring_fin import (
    becker,
    chilton_colburn,
    circumference_moment,
    coning_per_speed_squared,
    face_moment,
    rigid_coning,
    ring_cooling,
    ring_fin,
    turning_reynolds,
)

CARBON = dict(conductivity=10.0, expansion=4.5e-6, poisson=0.2, density=1800.0, specific_heat=750.0)
STEEL = dict(conductivity=15.0, expansion=16e-6, poisson=0.3, density=7950.0, specific_heat=500.0)
# Water of 40 degC: density, viscosity, specific heat, conductivity.
WATER = 992.16, 6.5378e-4, 4178.3, 0.62839


@pytest.mark.core
@pytest.mark.parametrize(
    "material, wet_bore, resistance", [(CARBON, False, 0.459), (STEEL, True, 0.37362)], ids=["outside", "bore"]
)
def test_resistance_of_an_independent_program(material, wet_bore, resistance):
    fin = ring_fin(0.0305, 0.034, 0.01, convection=5000.0, wet_bore=wet_bore, **material)
    assert fin.resistance == pytest.approx(resistance, rel=2e-5)


@pytest.mark.parametrize("wet_bore", [False, True], ids=["outside", "bore"])
@pytest.mark.parametrize("length, convection", [(0.003, 300.0), (0.01, 5000.0), (0.03, 3e4), (0.2, 5e5)])
def test_the_fin_by_integrals(length, convection, wet_bore):
    """Profile across the section and along the ring by quadrature, and the turns that its strains make."""
    a, b, k, nu, alpha = 0.03, 0.037, 15.0, 0.3, 16e-6
    fin = ring_fin(a, b, length, convection=convection, wet_bore=wet_bore, **STEEL)
    wet, dry = (a, b) if wet_bore else (b, a)
    width, both = b - a, abs(b**2 - a**2)

    def heat(r):
        # Through r of a source that gives 1 W/m^2 at the wetted radius, even over the section.
        return wet / r * (r**2 - dry**2) / (wet**2 - dry**2) / k

    def above(r):
        # Temperature above the wetted side's.
        return abs(quad(heat, r, wet)[0])

    inside = quad(lambda r: above(r) * r, a, b)[0] * 2 / both
    effective = 1 / (1 / convection + inside)
    m = np.sqrt(effective * 2 * wet / (k * both))
    solved = solve_bvp(
        lambda x, y: [y[1], m**2 * y[0]],
        lambda at, end: [at[1] + 1 / (k * np.pi * both), end[1]],
        np.linspace(0.0, length, 400), np.zeros((2, 400)), tol=1e-8, max_nodes=200_000,
    )  # fmt: skip

    def rise(x):
        return solved.sol(x)[0]

    assert fin.resistance == pytest.approx(rise(0.0), rel=1e-5)
    store = 7950 * 500 * np.pi * both * quad(lambda x: rise(x) ** 2, 0, length, limit=200)[0]
    assert fin.time_constant == pytest.approx(store / rise(0.0), rel=1e-4)
    # A hoop strain alpha T and the moment that turns the section back; then the bent section, its mean turn taken off.
    middle = (a + b) / 2
    turn = 12 / length**3 * alpha * middle * quad(lambda x: rise(x) * (length / 2 - x), 0, length, limit=200)[0]
    across = (above(a) - above(b)) / width * effective
    bent = (1 + nu) * alpha * across
    # Slope at the face less the mean slope: what the curvature adds along x, weighed as a line through u(x).
    weight = lambda x: 1 - 3 * (x / length) ** 2 + 2 * (x / length) ** 3  # noqa: E731
    axial = bent * quad(lambda x: rise(x) * weight(x), 0, length, limit=200)[0]
    assert fin.coning_per_watt == pytest.approx(turn + axial, abs=1e-4 * (abs(turn) + abs(axial)))


def test_formulas_go_on_into_thin_sections_and_short_rings():
    """Where terms cancel, a series (z = 0.02) and limits of a thin ring (w/r = 2e-4) follow without a step."""
    short = [ring_fin(0.03, 0.036, 0.001, convection=h, **CARBON).coning_per_watt for h in np.linspace(20.0, 24.0, 41)]
    assert np.ptp(short) < 3e-4 * short[0]
    widths = 2e-4 * np.array([0.97, 0.99, 1.01, 1.03])
    thin = np.log([ring_fin(1.0, 1.0 + width, 0.01, convection=1e12, **CARBON) for width in widths])
    assert np.abs(np.diff(thin, 2, axis=0)).max() < 2e-3


def test_moments_by_quadrature():
    """About the section's middle: on the circumference, on the face; and the turn of a rigid section under one."""
    a, b, length = 0.029, 0.036, 0.02
    moment = quad(lambda x: 3e5 * b * (x - length / 2), 0, 0.012)[0]
    assert circumference_moment(b, length, 0.012, 3e5) == pytest.approx(moment, rel=1e-12)

    def pressure(r):
        return 1e5 + 4e5 * (r - 0.0305) / 0.0035

    moment = quad(lambda r: pressure(r) * (r - 0.0325) * r, 0.0305, 0.034)[0]
    assert face_moment(0.0325, 0.0305, 0.034, 1e5, 5e5) == pytest.approx(moment, rel=1e-12)
    # Strain energy of the hoop strain x/r of a unit turn.
    energy = quad(lambda r: 20e9 / r, a, b)[0] * quad(lambda x: x**2, -length / 2, length / 2)[0]
    assert rigid_coning(a, b, length, 20e9, 2.0) == pytest.approx(2.0 / energy, rel=1e-9)


def test_spin_closes_a_film_a_little():
    """At 1000 rad/s 2.5 urad of 7 mm of carbon, 0.2 urad of silicon carbide."""
    carbon = coning_per_speed_squared(0.029, 0.036, 0.007, 20e9, 0.2, 1800.0)
    silicon_carbide = coning_per_speed_squared(0.029, 0.036, 0.007, 410e9, 0.16, 3100.0)
    assert (carbon * 1e6, silicon_carbide * 1e6) == pytest.approx((-2.5e-6, -0.16e-6), rel=0.03)


def test_cooling_by_the_analogy_of_heat_and_friction():
    """Becker's convection within -31 and +32 % of it from Re 1e4 to 3e6, in water."""
    for reynolds, more in ((1e4, 0.32), (1e5, 0.10), (1e6, -0.18), (3e6, -0.31)):
        speed = 2 * reynolds * WATER[1] / WATER[0] / 0.072**2
        assert turning_reynolds(speed, 0.072, *WATER[:2]) == pytest.approx(reynolds)
        found = becker(speed, 0.072, *WATER) / chilton_colburn(speed, 0.072, *WATER)
        assert found == pytest.approx(1 + more, abs=0.01)


def test_cooling_of_the_rings_of_a_pump():
    """2950 rpm, water of 40 degC: 13590 W/(m^2 K) at 72 mm of a ring that stands, 21572 if it turned."""
    stands, turns = (ring_cooling(-308.923278, 0.072, WATER, turns) for turns in (False, True))
    assert (stands.value, turns.value) == pytest.approx((13590, 21572), rel=1e-3)
    assert (stands.low, stands.high) == (stands.value / 2, stands.value * 2)
    assert stands.extrapolated and not ring_cooling(20.0, 0.072, WATER, True).extrapolated
