"""The slow scale of wear on stand-ins for the short runs: flat faces, elastic faces whose whole history is known."""

import itertools
import math

import numpy as np
import pytest
from scipy.linalg import expm

from sealdyn.studies.wear import rosenbrock
from sealdyn.studies.wear.rosenbrock import Average, Control, HatBasis, NoAverage, WearState, advance, unevenness

R_I, R_O, SPEED, LOAD, PER = 0.032, 0.040, 1000.0, 500.0, 2.5e-18
HOUR, ROUGH = 3600.0, 1e-7
STIFF = 3e12  # pressure per depth of a bed of springs (Pa/m): the load presses it in by a roughness


def integral(power):
    """int r^power dA over the face."""
    return 2 * math.pi * (R_O ** (power + 2) - R_I ** (power + 2)) / (power + 2)


AREA = integral(0)


def moments(radius, power):
    """int r^power phi_i phi_j dA by Gauss points, exact for these polynomials; shares nothing with Hats."""
    x, w = np.polynomial.legendre.leggauss(6)
    out = np.zeros((len(radius), len(radius)))
    for a, b in itertools.pairwise(radius):
        r = 0.5 * (a + b) + 0.5 * (b - a) * x
        phi = np.array([np.interp(r, radius, row) for row in np.eye(len(radius))])
        out += np.pi * (b - a) * (phi * w * r ** (power + 1)) @ phi.T
    return out


class Springs:
    """A bed of springs under a constant load: p = STIFF (approach - depth), all of it touching."""

    def __init__(self, radius, slope=True):
        self.mass, self.arm, self.slope = moments(radius, 0), moments(radius, 1), slope
        ones = np.ones(len(radius))
        # Approach from the load, then int p r phi dA, all linear in the depths.
        row = self.mass @ ones / AREA
        self.matrix = PER * SPEED * STIFF * (np.outer(self.arm @ ones, row) - self.arm)
        self.constant = PER * SPEED * (self.arm @ ones) * LOAD / AREA
        self.calls = 0

    def __call__(self, depth, motion):
        self.calls += 1
        nodal = self.constant + self.matrix @ depth
        return Average(nodal, float(nodal.sum()), self.matrix if self.slope else None, motion=self.calls)

    def exact(self, start, time):
        """Depths at a time (s) by the exponential of the system with its constant as one more unknown."""
        n = len(start)
        system = np.zeros((n + 1, n + 1))
        system[:n, :n] = np.linalg.solve(self.mass, self.matrix)
        system[:n, n] = np.linalg.solve(self.mass, self.constant)
        return (expm(system * time) @ np.append(start, 1.0))[:n]


def radii(nodes=17):
    return np.linspace(R_I, R_O, nodes)


def control(accuracy=1e-3, allowed=1.0):
    return Control(ROUGH, accuracy, allowed * ROUGH)


def last(averages, radius, hours, start=None, **given):
    worn = WearState(0.0, np.zeros(len(radius)) if start is None else start)
    return list(advance(averages, HatBasis(radius), worn, hours * HOUR, control(**given)))[-1][0]


# --- hats ----------------------------------------------------------------------------------------------


def test_masses_of_the_hats():
    radius = np.array([0.032, 0.0325, 0.0341, 0.037, 0.040])
    hats = HatBasis(radius)
    assert hats.mass == pytest.approx(moments(radius, 0), rel=1e-13, abs=0.0)
    assert hats.areas.sum() == pytest.approx(AREA, rel=1e-14, abs=0.0)


@pytest.mark.core
def test_flat_faces_wear_in_proportion_to_their_radius():
    """k p W r at every node, the ends too: no lumping of the half hats there."""
    radius = radii()
    nodal = PER * SPEED * LOAD / AREA * moments(radius, 1) @ np.ones(17)
    rate, exact = HatBasis(radius).rates(nodal)
    assert exact
    assert rate == pytest.approx(PER * LOAD / AREA * SPEED * radius, rel=1e-12, abs=0.0)


@pytest.mark.parametrize("touched", [[0], [8], [7, 8], [16]])
def test_a_narrow_contact_lets_no_face_grow_and_keeps_its_volume(touched):
    nodal = np.zeros(17)
    nodal[touched] = 1e-12
    hats = HatBasis(radii())
    rate, exact = hats.rates(nodal)
    assert not exact
    assert rate.min() >= 0.0 and not np.delete(rate, touched).any()
    assert hats.volume(rate) == pytest.approx(nodal.sum(), rel=1e-12, abs=0.0)


# --- the step ------------------------------------------------------------------------------------------


def test_no_contact_no_wear():
    nothing, fresh = Average(np.zeros(5), 0.0), WearState(0.0, np.zeros(5))
    found = list(advance(lambda depth, motion: nothing, HatBasis(radii(5)), fresh, 1e6, control()))
    assert found[-1][0].time == 1e6
    assert not found[-1][0].depth.any()
    assert len(found) < 5


@pytest.mark.parametrize("guess", ["exact", "half", "none"])
def test_order_three_with_any_slope(guess):
    """Slope of the error over the steps' length; steps are taken by hand, without control."""
    radius = radii(9)
    springs = Springs(radius)
    slope = {"exact": 1.0, "half": 0.5, "none": 0.0}[guess] * np.linalg.solve(springs.mass, springs.matrix)
    span, start = 0.2 * HOUR, 0.3 * ROUGH * np.sin(300 * radius) + ROUGH
    errors = []
    for count in (16, 32, 64):
        depth, h = start.copy(), span / count
        left = np.linalg.inv(np.eye(9) - rosenbrock.IMPLICIT[0, 0] * h * slope)
        for _ in range(count):
            k = np.zeros((4, 9))
            for i in range(4):
                rate = np.linalg.solve(springs.mass, springs(depth + h * rosenbrock.ALPHA[i] @ k, None).nodal)
                k[i] = left @ (rate + h * slope @ (rosenbrock.IMPLICIT[i, :i] @ k[:i]))
            depth = depth + h * rosenbrock.WEIGHTS @ k
        errors.append(np.max(np.abs(depth - springs.exact(start, span))))
    orders = np.log2(np.array(errors[:-1]) / errors[1:])
    assert orders == pytest.approx([3.0, 3.0], abs=0.25), (errors, orders)
    for weights in (rosenbrock.WEIGHTS, rosenbrock.LOWER):
        assert weights.sum() == pytest.approx(1.0, abs=1e-14)


@pytest.mark.parametrize("slope", [True, False])
@pytest.mark.parametrize("accuracy", [1e-2, 1e-4, 1e-6])
def test_elastic_faces_run_in_as_the_exponential_says(slope, accuracy):
    """Whole history of faces that start uneven; at 1e-6 the depths agree with the exact ones to 1e-6 of the roughness
    (they are about one), by implicit and by explicit steps."""
    radius, start = radii(), 0.5 * ROUGH * (radii() - R_I) / (R_O - R_I)
    springs = Springs(radius, slope)
    worn = WearState(0.0, start)
    for worn, _ in advance(springs, HatBasis(radius), worn, 4 * HOUR, control(accuracy)):  # noqa: B020
        assert worn.depth == pytest.approx(springs.exact(start, worn.time), abs=accuracy * ROUGH)
    assert worn.time == 4 * HOUR


def test_run_in_faces_wear_evenly():
    """p v is uniform: k W F / (2 pi (r_o - r_i)) everywhere."""
    radius = radii()
    springs = Springs(radius)
    worn = last(springs, radius, 200.0)
    rate, _ = HatBasis(radius).rates(springs(worn.depth, None).nodal)
    assert rate == pytest.approx(PER * SPEED * LOAD / (2 * math.pi * (R_O - R_I)), rel=1e-6, abs=0.0)
    assert unevenness(rate) < 1e-6


def test_implicit_steps_do_not_crawl_where_nothing_changes():
    """Two thousand hours of a profile that lasts: explicit steps stay at a fraction of the roughness."""
    radius, calls = radii(), []
    for slope in (True, False):
        springs = Springs(radius, slope)
        last(springs, radius, 2000.0, accuracy=1e-2)
        calls.append(springs.calls)
    assert calls[0] < 300
    assert calls[1] > 5 * calls[0]


def test_volume_is_the_integral_of_its_rate():
    radius, start = radii(), 2e-7 * np.cos(400 * radii())
    springs = Springs(radius)
    worn = last(springs, radius, 7.0, start)
    assert worn.volume == pytest.approx(HatBasis(radius).volume(worn.depth - start), rel=1e-12, abs=0.0)


def test_no_step_changes_the_shape_by_more_than_allowed():
    radius = radii()
    springs = Springs(radius)
    states = advance(springs, HatBasis(radius), WearState(0.0, np.zeros(17)), 2 * HOUR, control(0.5, 0.01))
    steps = [worn.depth for worn, _ in states]
    changes = np.ptp(np.diff(steps, axis=0), axis=1)
    assert changes.max() <= 0.01 * ROUGH * (1 + 1e-12)
    assert changes.max() > 0.004 * ROUGH


@pytest.mark.slow
def test_allowed_also_holds_where_wear_hastens_wear():
    """Rates that grow with the depth: what a step will wear cannot be read off its start."""
    radius = radii()
    mass, shape = moments(radius, 0), (radius - R_I) / (R_O - R_I)

    def hastening(depth, motion):
        nodal = mass @ (1e-11 * shape * (1.0 + 20.0 * depth / ROUGH))
        return Average(nodal, float(nodal.sum()))

    start = WearState(0.0, np.zeros(17))
    found = [w.depth for w, _ in advance(hastening, HatBasis(radius), start, 1.2 * HOUR, control(1.0, 0.05))]
    assert np.ptp(np.diff(found, axis=0), axis=1).max() <= 0.05 * ROUGH * (1 + 1e-12)


def test_taken_up_from_any_step_it_goes_on_the_same():
    radius, start = radii(), ROUGH * (radii() - R_I) / (R_O - R_I) / 3
    whole = [w for w, _ in advance(Springs(radius), HatBasis(radius), WearState(0.0, start), 3 * HOUR, control())]
    rest = [w for w, _ in advance(Springs(radius), HatBasis(radius), whole[4], 3 * HOUR, control())]
    assert len(rest) == len(whole) - 4
    for a, b in zip(whole[4:], rest, strict=True):
        assert (a.time, a.volume, a.span) == (b.time, b.volume, b.span)
        assert np.array_equal(a.depth, b.depth)


def test_a_stage_that_fails_is_tried_shorter():
    """A short run that fails when too much is worn at once."""
    radius = radii()
    springs, failed = Springs(radius), []

    def fragile(depth, motion):
        if np.ptp(depth - before[-1]) > 2e-9:
            failed.append(depth)
            raise NoAverage("collapsed", "crushed")
        return springs(depth, motion)

    before = [np.zeros(17)]
    for worn, _ in advance(fragile, HatBasis(radius), WearState(0.0, before[0]), 0.3 * HOUR, control(1.0)):
        before.append(worn.depth)
    assert failed
    assert before[-1] == pytest.approx(springs.exact(before[0], 0.3 * HOUR), abs=1e-2 * ROUGH)


def test_a_run_that_never_works_says_why():
    def broken(depth, motion):
        if depth.any():
            raise NoAverage("failed", "adams gave up")
        return Springs(radii())(depth, motion)

    with pytest.raises(NoAverage, match="gave up"):
        list(advance(broken, HatBasis(radii()), WearState(0.0, np.zeros(17)), HOUR, control()))


def test_a_wall_is_met_and_said():
    """Beyond some depth no short run works: it is neared in a few steps, not for ever."""
    springs, calls = Springs(radii()), []

    def wall(depth, motion):
        calls.append(1)
        if depth.max() > 0.5 * ROUGH:
            raise NoAverage("collapsed", "crushed")
        return springs(depth, motion)

    found = []
    with pytest.raises(NoAverage, match="crushed"):
        found.extend(w for w, _ in advance(wall, HatBasis(radii()), WearState(0.0, np.zeros(17)), 9 * HOUR, control()))
    assert len(calls) < 150


def test_scatter_is_not_taken_for_an_error():
    """Averages known to one per cent only: the steps do not shrink to find what is not there."""
    radius, noise = radii(), np.random.default_rng(1)
    counts = []
    for told in (True, False):
        springs = Springs(radius)

        def rough(depth, motion, springs=springs, told=told):
            found = springs(depth, motion)
            shaken = found.nodal * (1 + 0.01 * noise.standard_normal(17))
            return Average(shaken, float(shaken.sum()), found.slope, 0.02 * found.nodal if told else None)

        steps = advance(rough, HatBasis(radius), WearState(0.0, np.zeros(17)), 20 * HOUR, control(1e-4))
        counts.append(len(list(itertools.islice(steps, 4000))))
    assert counts[0] < 200
    assert counts[1] > 3 * counts[0]
