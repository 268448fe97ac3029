"""A wavy ring that bends: its compliance by the strain energy, and Lebeck's operating points."""

import math

import numpy as np
import pytest
from scipy.integrate import quad

from sealdyn.analysis.elastic_ring import ElasticRing, operating_point, operating_points
from sealdyn.analysis.sources import lebeck_1979

RING = ElasticRing(bending_stiffness=77.0, torsion_ratio=6.0, radius=47.54e-3)
HALF = lebeck_1979.HALF
PRESSURES = lebeck_1979.VISCOSITY * lebeck_1979.SPEED * (lebeck_1979.OUTER / HALF) ** 2


@pytest.mark.parametrize("order", [2, 3, 6])
def test_compliance_makes_work_and_strain_energy_least(order):
    """Deflection w cos and twist t cos of a ring under a load that is a cosine too, the twist free: curvature
    t/r - w''/r^2, torsion t'/r + w'/r^2."""
    r, stiff, soft = RING.radius, RING.bending_stiffness, RING.bending_stiffness / RING.torsion_ratio

    def energy(w, t):
        def density(a):
            # A ring that tilts as a whole, w = -t r of order 1, has neither.
            curvature = (order**2 * w / r**2 + t / r) * math.cos(order * a)
            torsion = order * (t / r + w / r**2) * math.sin(order * a)
            return 0.5 * r * (stiff * curvature**2 + soft * torsion**2)

        return quad(density, 0.0, 2.0 * math.pi, epsrel=1e-12)[0]

    # A quadratic form in w and t: its matrix by three energies.
    ww, tt, both = energy(1.0, 0.0), energy(0.0, 1.0), energy(1.0, 1.0)
    matrix = np.array([[2 * ww, both - ww - tt], [both - ww - tt, 2 * tt]])
    # Load of 1 N per rad, a harmonic of int p r dr: work pi w.
    w, _ = np.linalg.solve(matrix, [math.pi, 0.0])
    assert RING.compliance(order) == pytest.approx(w, rel=1e-10)


def test_the_largest_waviness_that_o_rings_can_give():
    for order, published in ((6, 3.57), (9, 0.684)):
        found = RING.largest_waviness(order, 0.005 * PRESSURES, 0.5 * lebeck_1979.OUTER) / HALF
        assert found == pytest.approx(published, rel=2e-3)


@pytest.mark.slow
def test_three_waves_have_three_operating_points():
    scene = lebeck_1979.scene_of(lebeck_1979.ROWS[1], (12, 90))
    found = operating_points(scene, RING, 3, 35.0 * HALF, np.geomspace(0.1, 20.0, 24) * HALF)
    assert [point.net / HALF for point, _ in found] == pytest.approx([0.291, 1.79, 10.8], rel=0.02)
    assert [holds for _, holds in found] == [True, False, True]


def test_six_waves_have_one():
    scene = lebeck_1979.scene_of(lebeck_1979.ROWS[2], (6, 36))
    nets = np.geomspace(0.1, 3.5, 10) * HALF
    initial = [operating_point(scene, RING, 6, net).initial for net in nets]
    assert np.all(np.diff(initial) > 0.0)


def test_a_film_that_presses_levels_the_waves():
    scene = lebeck_1979.scene_of(lebeck_1979.ROWS[1], (6, 36))
    point = operating_point(scene, RING, 3, 0.3 * HALF)
    assert point.initial > 10.0 * point.net
    stiff = ElasticRing(bending_stiffness=77e6, torsion_ratio=6.0, radius=47.54e-3)
    assert operating_point(scene, stiff, 3, 0.3 * HALF).initial == pytest.approx(point.net, rel=1e-3)
