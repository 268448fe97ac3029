"""Zuk's table: the dam against the print."""

import math

import numpy as np
import pytest
from oracles import viscous_dam_load

from sealdyn.closed_form import zuk_1972 as zuk
from sealdyn.films import _gas_dam as gas

SEAL = zuk.CRUISE
LENGTH = SEAL.outer_radius - SEAL.inner_radius
AROUND = math.pi * (SEAL.inner_radius + SEAL.outer_radius)


def computed(row):
    """(leakage, force, centre, exit Mach number) of the dam in a row's conditions."""
    f = gas.parameters(
        SEAL.inner_radius,
        SEAL.outer_radius,
        SEAL.temperature,
        gas_constant=SEAL.gas_constant,
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


@pytest.mark.core
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
    force, _ = viscous_dam_load(films, LENGTH, (SEAL.high_pressure, SEAL.low_pressure))
    assert force * AROUND / zuk.POUND_FORCE == pytest.approx(82.8, abs=0.05)
