"""Extremes of the gap found between steps: motions known in closed form, whatever the sampling."""

import math
from dataclasses import replace

import numpy as np
import pytest
from scenes import CLEARANCE, INERTIA, NOTHING, R_I, SPEED, SUPPORT, film, fmr, fms, free_ring, ring, run

from sealdyn.dynamics.extrema import H_TAU, LEAST, LEAST_TAU, MOST, MOST_TAU, H, falls_outwards
from sealdyn.scene.excitation import Shaft, Whirl
from sealdyn.scene.rings import AxialRunout, Rotor, Stator
from sealdyn.scene.scene import Initial, RingStart

EMPTY_FILM = film("linear", coefficients=NOTHING)
UNDAMPED = replace(SUPPORT, axial_damping=0.0)
NATURAL = math.sqrt(SUPPORT.axial_stiffness / 1.0)
TURN = 2 * math.pi / SPEED


def bouncing(amplitude, rate=0.0):
    """A stator on undamped springs in a film that does nothing: dz = amplitude cos(w t) + rate/w sin(w t)."""
    start = Initial(stator=RingStart(z=amplitude, z_rate=rate))
    return fms(film=EMPTY_FILM, stator=Stator(**ring(support=UNDAMPED)), rotor=Rotor(), initial=start)


@pytest.mark.parametrize("method", ["adams", "bdf", "dop853"])
@pytest.mark.parametrize("per_turn", [1, 64])
def test_smallest_gap_of_a_bounce(method, per_turn):
    amplitude, rate = 0.3e-5, 2e-3
    found = run(bouncing(amplitude, rate), turns=3, accuracy=1e-10, method=method, per_turn=per_turn)
    lowest = CLEARANCE - math.hypot(amplitude, rate / NATURAL)
    assert found.record(0)[H] == pytest.approx(lowest, rel=1e-9)
    phase = math.atan2(rate / NATURAL, amplitude)
    beats = (found.record(0)[H_TAU] * NATURAL - phase - math.pi) / (2 * math.pi)
    # At an extremum the time is worth the square root of the value.
    assert abs(beats - round(beats)) < 1e-4


@pytest.mark.core
def test_largest_and_smallest_tilt_of_free_precession():
    """Two circles, forward and backward: |g| between the sum and the difference of their radii."""
    tilt, tilt_rate = 20e-6, 5e-3
    polar, k = 2 * INERTIA, SUPPORT.axial_stiffness * SUPPORT.radius**2 / 2
    fast, slow = np.roots([-INERTIA, polar * SPEED, k])
    a = (tilt_rate - slow * tilt) / (fast - slow)
    b = tilt - a
    found = run(free_ring(0.5, tilt, tilt_rate), turns=20, accuracy=1e-10, per_turn=1)
    assert found.record(0)[MOST] == pytest.approx(abs(a) + abs(b), rel=1e-9)
    assert found.record(0)[LEAST] == pytest.approx(abs(abs(a) - abs(b)), rel=1e-9)
    for slot, sign in ((MOST_TAU, 1), (LEAST_TAU, -1)):
        turned = a * np.exp(1j * fast * found.record(0)[slot]) / (b * np.exp(1j * slow * found.record(0)[slot]))
        assert abs(turned / abs(turned) - sign) < 1e-4


@pytest.mark.parametrize("order", [7, 30, 200])
@pytest.mark.parametrize("method", ["adams", "bdf", "dop853"])
def test_every_dip_of_an_imposed_gap_is_found(method, order):
    """The rigid rotor nods `order` times a turn under a stator that hardly moves: the steps are the stator's, the
    dips the rotor's.  Two tones beat, so that one dip in the run is the deepest; another amplitude every time."""
    deepest = []
    for share in np.linspace(0.9, 1.1, 9):
        a, b = 0.3e-5 * share, 0.2e-5
        runout = [AxialRunout(order=order, amplitude=a), AxialRunout(order=order + 0.25, amplitude=b, phase=1.0)]
        scene = fms(film=EMPTY_FILM, stator=Stator(**ring()), rotor=Rotor(axial_runout=runout))
        found = run(scene, turns=5, accuracy=1e-8, method=method, per_turn=1)
        t = np.linspace(0, 5 * 2 * math.pi, 2_000_001)
        shown = (a * np.cos(order * t) + b * np.cos((order + 0.25) * t + 1.0)).max()
        deepest.append((CLEARANCE - found.record(0)[H]) / shown - 1)
    assert np.max(np.abs(deepest)) < 1e-6


def test_dip_of_a_whirling_rigid_rotor():
    """Runout and whirl beat: |g| reaches the sum of both once in the run, between the steps."""
    shaft = Shaft(speed=SPEED, whirl=[Whirl(ratio=0.42, angle=40e-6, phase=1.0)])
    scene = fms(film=EMPTY_FILM, shaft=shaft, stator=Stator(**ring()), rotor=Rotor(runout=60e-6))
    found = run(scene, turns=8, accuracy=1e-8, per_turn=1)
    assert found.record(0)[MOST] == pytest.approx(100e-6, rel=1e-8)
    assert found.record(0)[LEAST] == pytest.approx(20e-6, rel=1e-8)
    assert found.record(0)[H] == pytest.approx(CLEARANCE - R_I * 100e-6, rel=1e-8)


@pytest.mark.parametrize("method", ["adams", "bdf", "dop853", "ida"])
def test_collapse_is_located(method):
    """A bounce deeper than the clearance ends at the floor: when, on the way down, in closed form."""
    amplitude = 1.4 * CLEARANCE
    found = run(bouncing(amplitude), turns=3, accuracy=1e-9, method=method, per_turn=16)
    assert found.outcome.status == "collapsed"
    instant = math.acos(-(CLEARANCE * (1 - 1e-3)) / amplitude) / NATURAL
    assert found.outcome.tau == pytest.approx(instant, rel=1e-8)
    assert found.record(0)[H] == pytest.approx(1e-3 * CLEARANCE, rel=1e-5)
    assert found.times[-1] == pytest.approx(instant, rel=1e-8)


def test_a_short_dip_below_the_floor_is_a_collapse():
    """The gap is below the floor for less than one degree of shaft angle, once in 40 turns."""
    ratio = 1 + 1 / 40
    runout = [AxialRunout(1, 0.5 * CLEARANCE), AxialRunout(ratio, 0.4992 * CLEARANCE, math.pi)]
    scene = fms(film=EMPTY_FILM, stator=Stator(**ring()), rotor=Rotor(axial_runout=runout))
    found = run(scene, turns=40, accuracy=1e-4, method="adams", per_turn=1)
    assert found.outcome.status == "collapsed"
    assert found.outcome.tau == pytest.approx(20 * TURN, rel=0.02)


def test_windows_see_only_their_own_time():
    """A decaying tilt: the last turn's largest is smaller than the first's."""
    found = run(fmr("linear", own=0.0, fixed=0.0, initial=Initial(rotor=RingStart(tilt_x=50e-6))), turns=2)
    whole, last, before = (found.record(k)[MOST] for k in range(3))
    assert whole == pytest.approx(50e-6, rel=1e-6)
    assert last < 0.1 * before
    assert before == whole


@pytest.mark.parametrize("kind", range(3))
def test_what_falls_outwards_has_no_dip_beside_its_end(kind):
    """Three tones, the fastest seen at three points a radian as in a scan, whose end is lower than the point beside it:
    the end is the least of the last interval wherever it is said to be, and mostly it is said where it is."""
    rng, said, right = np.random.default_rng(kind), 0, 0
    for _ in range(4000):
        w, phase, size = rng.uniform(0.0, [1.0, 1.0, 0.3]), rng.uniform(0.0, 2 * np.pi, 3), rng.uniform(0.0, 1.0, 3)
        scan = int(rng.integers(3, 7))
        tones = lambda x, w=w, phase=phase, size=size: size @ np.cos(np.outer(w, x) + phase[:, None])  # noqa: E731
        points, inside = np.zeros((scan + 1, 3)), tones(np.linspace(scan - 1, scan, 200) / 3)
        points[:, kind] = tones(np.arange(scan + 1) / 3)
        if points[scan, kind] > points[scan - 1, kind]:
            continue
        backwards = points[::-1].copy()
        end = falls_outwards(points, kind, scan, scan)
        assert falls_outwards(backwards, kind, 0, scan) == end
        assert not falls_outwards(points, kind, 1, scan)
        if inside[-1] == inside.min():
            right += 1
            said += end
        # So shallow a dip is rounding.
        assert not end or inside[-1] - inside.min() < 1e-10 * size.sum()
    assert said > 0.9 * right
