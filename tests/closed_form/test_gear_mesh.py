"""The shipped gear mesh: displacement of the housing and motion of the film in their own words."""

import math
from pathlib import Path

import numpy as np
import pytest
from scenes import run

from sealdyn import read_scenario

SCENARIO = Path(__file__).parents[2] / "scenarios" / "gear_mesh.toml"


@pytest.mark.core
def test_film_takes_what_the_mass_does_not_follow():
    w = 2 * math.pi * 5400.0
    displacement = 45 * 9.80665 / w**2
    assert displacement == pytest.approx(0.3833e-6, rel=2e-4)
    found = run(read_scenario(SCENARIO).scene, turns=8, accuracy=1e-7, per_turn=512, start="steady")
    stiffness, damping = (matrix[0, 0] for matrix in found.model.film_matrices())
    ring = 5e5 - w**2 * 1.0 + 300j * w
    # Rotor and film in series with the housing.
    expected = displacement * abs(ring / (ring + stiffness + 1j * w * damping))
    gap = found["axial_gap_change"][-4 * 512 :]
    # The film is stiffer as it closes: second order in the motion, 4 % of the clearance.
    assert 0.5 * np.ptp(gap) == pytest.approx(expected, rel=2e-3)
