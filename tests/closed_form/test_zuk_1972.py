"""Zuk's tables and viscous forms: the dam against the print, and the forms against quadrature."""

import math

import numpy as np
import pytest
from scipy.integrate import quad

from sealdyn.closed_form import zuk_1972 as zuk
from sealdyn.films import _gas_dam as gas

SEAL = zuk.CRUISE
LENGTH = SEAL.outer_radius - SEAL.inner_radius
AROUND = math.pi * (SEAL.inner_radius + SEAL.outer_radius)
MU, R, T = 3.4e-5, SEAL.gas_constant, SEAL.temperature
TILTS = [(1e-6, 3e-6), (3e-6, 1e-6), (4e-6, 4.01e-6), (4e-6, 3.99e-6), (0.5e-6, 8e-6)]
PRESSURES = [(15e5, 1e5), (2e5, 1.9e5), (8e5, 1e3)]


def computed(row):
    """(leakage, force, centre, exit Mach number) of the dam in a row's conditions."""
    f = gas.parameters(
        SEAL.inner_radius,
        SEAL.outer_radius,
        SEAL.temperature,
        gas_constant=R,
        heat_ratio=SEAL.heat_ratio,
        sutherland=SEAL.sutherland,
        friction="laminar",
        width="zuk" if row.tilt else "constant",
    )
    out = np.zeros(gas.DAM_SIZE)
    films = row.mean_film - row.tilt * LENGTH / 2, row.mean_film + row.tilt * LENGTH / 2
    assert gas.dam(f, *films, SEAL.high_pressure, SEAL.low_pressure, out) == gas.SOLVED
    centre = 0.5 + out[gas.MOMENT] / (out[gas.FORCE] * LENGTH)
    return out[gas.MASS_FLOW] * AROUND, out[gas.FORCE] * AROUND, centre, out[gas.EXIT_MACH]


@pytest.mark.parametrize("row", zuk.ZUK_1972, ids=lambda row: f"{row.tilt:g}-{row.mean_film / zuk.MIL:.1f}mil")
def test_published_rows(row):
    leakage, force, centre, mach = computed(row)
    assert leakage == pytest.approx(row.leakage, rel=5e-3)
    assert mach == pytest.approx(row.exit_mach, rel=5e-3)
    assert force == pytest.approx(row.corrected_force, rel=1e-3)
    assert centre == pytest.approx(row.corrected_centre, rel=1e-3)
    if row.tilt == 0:
        assert force == pytest.approx(row.force, rel=5e-3)
        assert centre == pytest.approx(row.centre, rel=5e-3)


def test_printed_forces_of_tilted_faces_cannot_be():
    most = (SEAL.high_pressure - SEAL.low_pressure) * LENGTH * AROUND
    *_, small, _, convergent = zuk.ZUK_1972
    assert convergent.force > most > convergent.corrected_force
    # His own viscous form at 0.1 mil, where the exit Mach number is 0.09.
    films = small.mean_film - small.tilt * LENGTH / 2, small.mean_film + small.tilt * LENGTH / 2
    force, _ = zuk.tilted_load(*films, LENGTH, SEAL.high_pressure, SEAL.low_pressure)
    assert force * AROUND / zuk.POUND_FORCE == pytest.approx(82.8, abs=0.05)


@pytest.mark.core
@pytest.mark.parametrize("films", TILTS)
def test_mass_flows_balance_the_momentum(films):
    """2 f R T G^2 int dx/h^3 is the drop of P^2."""
    p_1, p_2 = 15e5, 1e5
    resistance = quad(lambda x: 1 / (films[0] + (films[1] - films[0]) * x / LENGTH) ** 3, 0, LENGTH, epsrel=1e-12)[0]
    args = (*films, LENGTH, p_1, p_2, MU, R, T)
    for flow, factor in (
        (zuk.laminar_mass_flow(*args), lambda re: 24 / re),
        (zuk.turbulent_mass_flow(*args), lambda re: 0.079 / re**0.25),
    ):
        drop = 2 * factor(2 * flow / MU) * R * T * flow**2 * resistance
        assert drop == pytest.approx(p_1**2 - p_2**2, rel=1e-10)


@pytest.mark.parametrize("radii", [(0.05, 0.09), (0.09, 0.05)])
def test_radial_mass_flows_balance_the_momentum(radii):
    squares, h = (6e5) ** 2, 5e-6
    for function, factor in (
        (zuk.radial_laminar_mass_flow, lambda re: 24 / re),
        (zuk.radial_turbulent_mass_flow, lambda re: 0.079 / re**0.25),
    ):
        flow = function(h, *radii, squares, MU, R, T)

        def slope(r, flow=flow, factor=factor):
            per_width = flow / (2 * math.pi * r)
            return 2 * factor(2 * per_width / MU) * R * T * per_width**2 / h**3

        assert quad(slope, min(radii), max(radii), epsrel=1e-12)[0] == pytest.approx(squares, rel=1e-10)
    # The coefficient of the corrected eq. 17.
    group = h**3 * squares / (MU**0.25 * R * T * abs(radii[0] ** -0.75 - radii[1] ** -0.75))
    assert flow / (2 * math.pi * group ** (4 / 7)) == pytest.approx(2.689, abs=5e-4)


def test_radial_pressures_follow_their_flows():
    for radii in ((0.05, 0.09), (0.09, 0.05)):
        for turbulent, power in ((False, 1.0), (True, 1.75)):
            ends = zuk.radial_pressure(np.array(radii), *radii, 9e5, 1e5, turbulent=turbulent)
            assert ends == pytest.approx([9e5, 1e5], rel=1e-9)
            # r^power dP^2/dr is the same everywhere.
            r, step = np.linspace(0.06, 0.08, 5), 1e-6
            up, down = (zuk.radial_pressure(r + s, *radii, 9e5, 1e5, turbulent=turbulent) ** 2 for s in (step, -step))
            flux = r**power * (up - down)
            assert np.ptp(flux) < 1e-6 * abs(flux[0])


@pytest.mark.parametrize("pressures", PRESSURES)
def test_loads_are_integrals_of_the_pressure(pressures):
    p_2 = pressures[1]

    def moments(films):
        def gauge(x):
            return zuk.pressure(x, *films, LENGTH, *pressures) - p_2

        force = quad(gauge, 0, LENGTH, epsrel=1e-11, limit=200)[0]
        return force, quad(lambda x: gauge(x) * x, 0, LENGTH, epsrel=1e-11, limit=200)[0] / (force * LENGTH)

    for films in TILTS:
        assert zuk.tilted_load(*films, LENGTH, *pressures) == pytest.approx(moments(films), rel=1e-7)
    assert zuk.parallel_load(LENGTH, *pressures) == pytest.approx(moments((2e-6, 2e-6)), rel=1e-8)


def test_tilt_that_rounding_would_spoil_is_refused():
    with pytest.raises(ValueError, match="tilted"):
        zuk.tilted_load(1e-6, 1.0001e-6, LENGTH, 2e5, 1e5)


def test_tilt_with_b_of_zero():
    """P h constant: P = P1 h1/h."""
    h_1, h_2, p_1 = 1e-6, 2e-6, 4e5
    force, _ = zuk.tilted_load(h_1, h_2, LENGTH, p_1, p_1 / 2)
    assert force == pytest.approx(LENGTH * (p_1 * math.log(2) - p_1 / 2), rel=1e-12)
