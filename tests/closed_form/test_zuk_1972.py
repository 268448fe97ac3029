"""Zuk's viscous form of a tilted row; his tables: tests/ladder/test_zuk_by_the_program.py."""

import math

import pytest
from oracles import viscous_dam_load

from sealdyn.closed_form import zuk_1972 as zuk

SEAL = zuk.CRUISE
LENGTH = SEAL.outer_radius - SEAL.inner_radius
AROUND = math.pi * (SEAL.inner_radius + SEAL.outer_radius)


@pytest.mark.core
def test_the_viscous_form_of_a_tilted_row():
    """At 0.1 mil, where the exit Mach number is 0.09."""
    *_, small, _, _ = zuk.ZUK_1972
    films = small.mean_film - small.tilt * LENGTH / 2, small.mean_film + small.tilt * LENGTH / 2
    force, _ = viscous_dam_load(films, LENGTH, (SEAL.high_pressure, SEAL.low_pressure))
    assert force * AROUND / zuk.POUND_FORCE == pytest.approx(82.8, abs=0.05)
