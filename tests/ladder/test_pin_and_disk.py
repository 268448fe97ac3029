"""Pin and disk: a ring that slides axially on its secondary seal, pressed by a stiff film against a disk that runs out.

    m z'' + K_s z + F sign(z') = K_f (a cos(w t + e) - z),    k = K_s + K_f,  P = K_f a,  w_n^2 = k / m
Held while |P cos - k z| < F.  Between two stops the motion is z = -+F/k + free vibration + X cos(w t + e), X = (P/k) /
(1 - (w/w_n)^2): worked out here, with nothing of the package.
"""

import math
from dataclasses import replace

import numpy as np
import pytest
from scenes import CLEARANCE, SUPPORT, film, fms, ring, run
from scipy.optimize import brentq

from sealdyn.scene.film import Coefficients
from sealdyn.scene.rings import AxialRunout, Rotor, SecondarySeal, Stator
from sealdyn.scene.scene import Initial, RingStart

MASS, PRESSED, RUNOUT = 1.0, 2e6, 4e-6
K = SUPPORT.axial_stiffness + PRESSED
P, NATURAL = PRESSED * RUNOUT, math.sqrt(K / MASS)
STIFF = film("linear", coefficients=Coefficients(tilt_stiffness=0.0, tilt_damping=0.0, axial_stiffness=PRESSED,
                                                 axial_damping=0.0))  # fmt: skip
ACCURACY = 1e-6


def pin(friction, speed, turns, start=0.0, phase=0.0, method="adams"):
    """A run of the pin from rest at `start` (m)."""
    seal = SecondarySeal(radius=0.04, friction_force=friction)
    scene = fms(
        film=STIFF, own=0.0, speed=speed, initial=Initial(stator=RingStart(z=start)),
        stator=Stator(**ring(support=replace(SUPPORT, axial_damping=0.0)), secondary_seal=seal),
        rotor=Rotor(axial_runout=[AxialRunout(order=1, amplitude=RUNOUT, phase=phase)]),
    )  # fmt: skip
    return run(scene, turns=turns, accuracy=ACCURACY, method=method)


# --- sliding without a stop ---------------------------------------------------------------------------


def sliding(friction, speed):
    """Phase of the runout and z over half a turn (a function of time) of the motion that turns back at +-A, at once.

    **Source** Den Hartog (1931), forced vibration with Coulomb friction: A^2 = X^2 - (F/k)^2 U^2,
    U = sin(pi/b) / (b (1 + cos(pi/b))), b = w/w_n; its free vibration is -F/k (cos w_n t + U b sin w_n t).
    """
    b = speed / NATURAL
    sweep, dead = P / K / (1 - b * b), friction / K
    u = math.sin(math.pi / b) / (b * (1 + math.cos(math.pi / b)))
    # sweep cos(e) = A > 0, sweep sin(e) = -dead u.
    amplitude = math.sqrt(sweep**2 - (dead * u) ** 2)
    phase = math.atan2(-dead * u / sweep, amplitude / sweep)

    def z(t):
        free = np.cos(NATURAL * t) + u * b * np.sin(NATURAL * t)
        return dead * (1 - free) + sweep * np.cos(speed * t + phase)

    half = np.linspace(0.0, math.pi / speed, 2001)
    # It turns back at both ends, goes one way between them, and does not hold there.
    assert [z(0.0), z(half[-1])] == pytest.approx([amplitude, -amplitude])
    assert np.all(np.diff(z(half)) < 0)
    assert abs(P * math.cos(phase) - K * amplitude) > friction
    return phase, amplitude, z


@pytest.mark.parametrize("method", ["adams", "bdf", "ida", "dop853", "radau"])
@pytest.mark.parametrize("ratio,share", [(0.6, 0.4), (0.75, 0.2), (1.6, 0.3)])
def test_a_pin_that_slides_all_the_way(method, ratio, share):
    """Below and above the resonance, on the closed form's orbit for three turns."""
    speed, friction = ratio * NATURAL, share * P
    phase, amplitude, z = sliding(friction, speed)
    found = pin(friction, speed, 3, start=amplitude, phase=phase, method=method)
    half, part = np.divmod(found.times * speed / math.pi, 1.0)
    expected = np.where(half % 2, -1, 1) * z(part * math.pi / speed)
    assert np.max(np.abs(found.q[:, 0] - expected)) < 3 * ACCURACY * CLEARANCE
    # Burnt in a turn: the way there and back against the friction.
    force = found["stator_seal_friction"] * found.rates[:, 0]
    assert -np.trapezoid(force, found.times) == pytest.approx(3 * 4 * friction * amplitude, rel=3e-3)
    assert found.outcome.energy_residual < 10 * ACCURACY


def test_a_pin_from_rest_finds_that_orbit():
    speed, friction = 0.6 * NATURAL, 0.4 * P
    phase, amplitude, _ = sliding(friction, speed)
    found = pin(friction, speed, 60, phase=phase)
    last = found.times > 58 * 2 * math.pi / speed
    assert found.q[last, 0].max() == pytest.approx(amplitude, rel=1e-6)


# --- sticking at both ends ----------------------------------------------------------------------------


def stick_slip(friction, speed):
    """Height at which the pin holds, shaft angles (rad) at which it lets go and is caught again, of the motion with two
    stops a turn: let go where P cos = k z - F, caught at the first turning point, at the opposite height."""
    b, dead = speed / NATURAL, friction / K
    sweep = P / K / (1 - b * b)

    def slip(height):
        leave = math.acos((K * height - friction) / P)
        # z = dead + c cos(w_n t) + s sin(w_n t) + sweep cos, at rest at `height` at first.
        c = height - dead - sweep * math.cos(leave)
        s = b * sweep * math.sin(leave)

        def z(t):
            return dead + c * math.cos(NATURAL * t) + s * math.sin(NATURAL * t) + sweep * math.cos(speed * t + leave)

        def rate(t):
            free = s * math.cos(NATURAL * t) - c * math.sin(NATURAL * t)
            return NATURAL * free - speed * sweep * math.sin(speed * t + leave)

        times = np.linspace(0.0, 2 * math.pi / speed, 4001)[1:]
        after = next(i for i, t in enumerate(times) if i > 3 and rate(t) >= 0)
        stop = brentq(rate, times[after - 1], times[after], xtol=1e-15)
        return leave, leave + speed * stop, z(stop)

    height = brentq(lambda x: x + slip(x)[2], 0.02 * P / K, 1.2 * P / K, xtol=1e-18)
    leave, caught, _ = slip(height)
    # Held there until the other side pulls.
    pull = P * np.cos(np.linspace(caught, leave + math.pi, 200)[:-1]) + K * height
    assert caught < leave + math.pi and np.all(np.abs(pull) < friction)
    return height, leave, caught


@pytest.mark.parametrize("method", ["adams", "ida", "dop853"])
@pytest.mark.parametrize("ratio,share", [(0.25, 0.6), (0.4, 0.7), (0.1, 0.85)])
def test_a_pin_that_sticks_twice_a_turn(method, ratio, share):
    """What holds forgets what was: from rest the orbit is there after four turns, to 1.2e-5 rad (measured)."""
    speed, friction = ratio * NATURAL, share * P
    height, leave, caught = stick_slip(friction, speed)
    found = pin(friction, speed, 6, method=method)
    late = [e for e in found.events if e["time"] * speed > 4 * 2 * math.pi]
    assert {e["kind"] for e in late} == {"stick", "slip"} and len(late) in (7, 8, 9)
    for event in late:
        angle = event["time"] * speed % math.pi
        expected = (leave if event["kind"] == "slip" else caught) % math.pi
        # Half a turn on everything is the same, the other way up.
        assert (angle - expected + math.pi / 2) % math.pi - math.pi / 2 == pytest.approx(0.0, abs=4e-5)
    last = found.times * speed > 4 * 2 * math.pi
    held = last & (found["stator_seal_stuck"] == 1)
    assert np.abs(found.q[held, 0]) == pytest.approx(height, abs=1e-5 * CLEARANCE)
    share_held = 1 - (caught - leave) / math.pi
    assert held.sum() / last.sum() == pytest.approx(share_held, abs=0.03)
    assert found.outcome.energy_residual < 10 * ACCURACY


def test_slowly_turned_it_follows_behind_by_the_dead_band():
    """Without inertia to speak of it holds until the pull has changed by 2 F, then follows to +-(P - F)/k, in steps."""
    friction, speed = 0.5 * P, 0.02 * NATURAL
    found = pin(friction, speed, 2, start=(P - friction) / K)
    last = found.times * speed > 2 * math.pi
    assert [found.q[last, 0].max(), -found.q[last, 0].min()] == pytest.approx(2 * [(P - friction) / K], rel=0.03)
    first = next(e["time"] for e in found.events if e["kind"] == "slip" and e["time"] * speed > 2 * math.pi)
    assert math.cos(first * speed) == pytest.approx(1 - 2 * friction / P, abs=0.05)


@pytest.mark.core
def test_a_pin_held_by_more_than_the_disk_pulls_stays():
    found = pin(1.01 * P, 0.3 * NATURAL, 3)
    assert not found.events and np.ptp(found.q) == 0.0 and found["stator_seal_stuck"].all()
    assert pin(0.99 * P, 0.3 * NATURAL, 3, start=0.0).events
