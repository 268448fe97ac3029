"""A wavy ring that bends: its compliance by the strain energy, and Lebeck's operating points."""

import math
from dataclasses import replace

import numpy as np
import pytest
from scipy.integrate import quad

from sealdyn.analysis.sources import lebeck_1979
from sealdyn.dynamics.elastic_ring import at_rest, operating_point, operating_points
from sealdyn.scene.rings import ElasticRing
from sealdyn.studies.elastic_ring import release

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


@pytest.mark.core
def test_the_largest_waviness_that_o_rings_can_give():
    for order, published in ((6, 3.57), (9, 0.684)):
        found = RING.largest_waviness(order, 0.005 * PRESSURES, 0.5 * lebeck_1979.OUTER) / HALF
        assert found == pytest.approx(published, rel=2e-3)


def seal(row, cells, initial=35.0, ring=RING):
    scene = lebeck_1979.scene_of(lebeck_1979.ROWS[row], cells)
    waves = [replace(scene.stator.waviness[0], amplitude=initial * HALF)]
    return replace(scene, stator=replace(scene.stator, elastic=ring, waviness=waves))


@pytest.fixture(scope="module")
def three_waves():
    scene = seal(1, (8, 48))
    return scene, operating_points(scene, [operating_point(scene, net * HALF) for net in (0.1, 0.5, 1, 2.5, 5, 20)])


def test_of_three_operating_points_the_middle_one_does_not_hold(three_waves):
    _, found = three_waves
    assert [point.net / HALF for point, _ in found] == pytest.approx([0.291, 1.79, 10.8], rel=0.08)
    assert [holds for _, holds in found] == [True, False, True]


@pytest.mark.slow
def test_three_waves_have_lebecks_three_operating_points():
    scene = seal(1, (12, 60))
    along = [operating_point(scene, net * HALF) for net in (0.2, 0.4, 1.2, 2.4, 8, 13)]
    found = [point.net / HALF for point, _ in operating_points(scene, along)]
    assert found == pytest.approx([0.291, 1.79, 10.8], rel=0.02)


def test_let_go_they_do_what_the_slope_says(three_waves):
    """The film's cells in time know nothing of the slope; the middle one goes to the others, or past them and back."""
    scene, found = three_waves
    nets = [point.net for point, _ in found]
    for (point, holds), share in zip(found, (1.3, 0.97, 0.8), strict=True):
        time, wave, clearance = release(scene, point.net, share * point.net, 1.0, 60)
        end, others = abs(wave[-1]), [net for net in nets if net != point.net]
        assert time[-1] == 1.0 and clearance[-1] > 0.0
        near = [point.net] if holds else others
        assert min(abs(end / net - 1.0) for net in near) < 3e-3


def test_a_lifted_ring_rests_on_the_largest_that_holds(three_waves):
    scene, found = three_waves
    (wave,) = at_rest(scene).stator.waviness
    assert wave.amplitude == pytest.approx(found[-1][0].net, rel=1e-5)
    assert wave.phase == pytest.approx(-found[-1][0].turned, rel=1e-4)
    assert at_rest(at_rest(scene)) == at_rest(scene)


def test_a_stiff_ring_keeps_its_waves():
    scene = seal(1, (6, 36), 0.5, ElasticRing(bending_stiffness=77e6, torsion_ratio=6.0, radius=47.54e-3))
    assert at_rest(scene).stator.waviness[0].amplitude == pytest.approx(0.5 * HALF, rel=1e-3)


def test_the_film_of_the_whole_circle_bends_it_alike():
    """A tilt that is imposed takes the alike sectors away, not what bends the aligned ring."""
    scene = seal(1, (6, 36), 0.6)
    whole = replace(scene, film=replace(scene.film, reynolds=replace(scene.film.reynolds, sectors=1)))
    one, other = (operating_point(s, 0.3 * HALF) for s in (scene, whole))
    assert (one.initial, one.turned) == pytest.approx((other.initial, other.turned), rel=1e-9)


def test_six_waves_have_one():
    scene = seal(2, (6, 36))
    nets = np.geomspace(0.1, 3.5, 10) * HALF
    assert np.all(np.diff([operating_point(scene, net).initial for net in nets]) > 0.0)


def test_a_film_that_presses_levels_the_waves():
    point = operating_point(seal(1, (6, 36)), 0.3 * HALF)
    assert point.initial > 10.0 * point.net
