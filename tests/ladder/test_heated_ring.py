"""A ring from its drawing: temperatures, coning and their course in time, against finite elements and formulas."""

from dataclasses import replace

import numpy as np
import pytest

from sealdyn.faces.ring_coning import RingBody, pressure_coning
from sealdyn.faces.ring_heat import ring_heat

CARBON = dict(
    density=1800.0, modulus=20e9, poisson=0.2, expansion=4.5e-6, conductivity=10.0, specific_heat=750.0
)  # fmt: skip
SILICON_CARBIDE = dict(
    density=3100.0, modulus=410e9, poisson=0.16, expansion=4e-6, conductivity=125.0, specific_heat=670.0
)  # fmt: skip
STEEL = dict(
    density=7950.0, modulus=193e9, poisson=0.3, expansion=16e-6, conductivity=15.0, specific_heat=500.0
)  # fmt: skip


def body(inner, outer, length, material, convection, band=None, wetted=None, wet="outer") -> RingBody:
    """A ring by its radii and length in mm."""
    band = (inner, outer) if band is None else band
    sizes = [1e-3 * x for x in (inner, outer, length, *band)]
    return RingBody(*sizes, **material, convection=convection, wetted_length=1e-3 * (wetted or length), wet=wet)


# Rows of an independent program: R (K/W), X (rad/W) and crown (m/W) by finite elements, R, X and time constant (s) by
# finite volumes of the same size, and by how much X may differ from finite elements.
ROWS = {
    "carbon, face is section": (
        body(30.5, 34, 10, CARBON, 5000.0),
        (0.45519, 6.2619e-6, 7.29e-10), (0.45546, 6.2522e-6, 0.7497), 0.03,
    ),
    "silicon carbide, wet face": (
        body(29, 38, 8, SILICON_CARBIDE, 8000.0, (30.5, 34)),
        (0.079492, 2.4778e-7, 5.06e-11), (0.07965, 2.5144e-7, 1.301), 0.04,
    ),
    "steel, wet bore": (
        body(30.5, 34, 10, STEEL, 5000.0, wet="bore"),
        (0.372, 1.2438e-5, 1.9e-9), (0.37217, 1.2471e-5, 2.211), 0.04,
    ),
    "carbon, O-ring": (
        body(29, 36, 20, CARBON, 5000.0, (30.5, 34), 12),
        (0.42178, 2.6839e-6, 7.39e-10), (0.42405, 2.7428e-6, 1.708), 0.05,
    ),
}  # fmt: skip


@pytest.mark.core
@pytest.mark.parametrize("name", ROWS)
def test_rows_of_an_independent_program(name):
    ring, (resistance, coning, crown), volumes, within = ROWS[name]
    found = ring_heat(ring)
    assert found.resistance == pytest.approx(resistance, rel=0.02)
    assert found.coning_per_watt == pytest.approx(coning, rel=within)
    # Its crown is the height of what finite elements bow, a parabola the one that ours is.
    assert found.crown_per_watt == pytest.approx(crown, rel=0.08)
    # Another division of radii into cells; its time constant is over the resistance of the cells alone.
    assert (found.resistance, found.coning_per_watt) == pytest.approx(volumes[:2], rel=5e-3)
    assert found.time_constant == pytest.approx(volumes[2], rel=0.02)


@pytest.mark.parametrize(
    "o_ring, elements, shell", [(12, -4.598e-5, -4.734e-5), (16, -2.407e-5, -2.598e-5), (20, 9.37e-6, 9.33e-6)]
)
def test_pressure_and_where_the_o_ring_sits(o_ring, elements, shell):
    """One bar turns the ring of carbon by +9 to -46 urad, by the place of its O-ring (independent program)."""
    ring = replace(ROWS["carbon, O-ring"][0], wetted_length=1e-3 * o_ring)
    balance = np.sqrt(0.034**2 - 0.8 * (0.034**2 - 0.0305**2))
    found = pressure_coning(ring, 1e5, balance)
    assert found == pytest.approx(elements, rel=0.1)
    assert found == pytest.approx(shell, rel=0.02)
