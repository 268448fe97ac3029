"""Harmonic balance, its extremes and its period, against integration in time and closed forms written out here."""

import math

import numpy as np
import pytest
from scenes import GIVEN, INERTIA, SPEED, SUPPORT, free_ring, ring, started
from scenes import of_given_film as run_of
from scipy.integrate import solve_ivp

from sealdyn.dynamics.intervals import common_period
from sealdyn.dynamics.modes import Harmonic
from sealdyn.scene.excitation import AngularVibration, Housing, Shaft, Whirl
from sealdyn.scene.rings import Rotor, Stator
from sealdyn.simulation.margin import steady_extremes

K_F, D_F, *_ = GIVEN
K_S, D_S = SUPPORT.tilt()
SLENDER = INERTIA / 3


TONES = Housing(
    angular=[
        AngularVibration(frequency=75.0, displacement=20e-6, direction=0.7, phase=0.4),
        AngularVibration(frequency=333.0, displacement=8e-6, direction=-1.1),
    ]
)


def shaken(t):
    """The housing's tilt and rate, complex."""
    tilt = rate = 0.0
    for frequency, amplitude, direction, phase in ((75.0, 20e-6, 0.7, 0.4), (333.0, 8e-6, -1.1, 0.0)):
        w, axis = 2 * math.pi * frequency, np.exp(1j * direction)
        tilt = tilt + amplitude * np.cos(w * t + phase) * axis
        rate = rate - amplitude * w * np.sin(w * t + phase) * axis
    return tilt, rate


def must_come_to(whole, acceleration):
    """The steady tilt is that of an integration from rest, long enough for the start to be forgotten."""

    def slopes(t, y):
        g, v = complex(*y[:2]), complex(*y[2:])
        a = acceleration(t, g, v)
        return [v.real, v.imag, a.real, a.imag]

    y = solve_ivp(slopes, (0, 0.05), np.zeros(4), "DOP853", rtol=1e-12, atol=1e-17).y[:, -1]
    q, q_rate = whole.segment(0).steady_motion()[0](0.05)
    assert abs(complex(*q[1:]) - complex(*y[:2])) < 1e-9 * 40e-6
    assert abs(complex(*q_rate[1:]) - complex(*y[2:])) < 1e-9 * 40e-6 * SPEED


def test_two_tones_about_fixed_axes_shake_a_flexible_stator():
    """The housing carries it: springs and dampers feel the tones, and the rotor's whirl comes through the film."""

    def acceleration(t, g, v):
        carrier, carrier_rate = shaken(t)
        whirl = 15e-6 * np.exp(0.42j * SPEED * t)
        relative, relative_rate = g - whirl, v - 0.42j * SPEED * whirl
        support = D_S * (v - carrier_rate) + K_S * (g - carrier - 10e-6)
        return -(support + K_F * relative + D_F * (relative_rate - 0.5j * SPEED * relative)) / INERTIA

    shaft = Shaft(speed=SPEED, whirl=[Whirl(ratio=0.42, angle=15e-6)])
    whole = run_of(stator=Stator(**ring(3.0, misalignment=10e-6)), housing=TONES, shaft=shaft, turns=20)
    must_come_to(whole, acceleration)


def test_two_tones_about_fixed_axes_shake_a_flexible_rotor_through_the_film():
    """A rigid stator goes with the housing; the rotor's own misalignment turns."""

    def acceleration(t, g, v):
        carrier, carrier_rate = shaken(t)
        relative, relative_rate = carrier - g, carrier_rate - v
        push = K_F * relative + D_F * (relative_rate - 0.5j * SPEED * relative)
        own = D_S * (v - 1j * SPEED * g) + K_S * (g - 25e-6 * np.exp(1j * (SPEED * t + 0.2)))
        return (push - own + 1j * SLENDER * SPEED * v) / INERTIA

    rotor = Rotor(**ring(3.0, misalignment=25e-6, misalignment_phase=0.2))
    must_come_to(run_of(rotor=rotor, housing=TONES, turns=20), acceleration)


@pytest.mark.parametrize("ratio", [0.42, -1.3])
def test_whirl_of_the_shaft_carries_a_flexible_rotor(ratio):
    """The rotor's springs and its turning dampers feel the whirl: complex answer at ratio times the speed."""
    s = 1j * ratio * SPEED
    carried = D_S * (s - 1j * SPEED) + K_S
    film_part = D_F * (s - 0.5j * SPEED) + K_F
    answer = 15e-6 * carried / (INERTIA * s * s - 1j * SLENDER * SPEED * s + carried + film_part)
    shaft = Shaft(speed=SPEED, whirl=[Whirl(ratio=ratio, angle=15e-6)])
    whole = run_of(rotor=Rotor(**ring(3.0)), shaft=shaft)
    for t in (0.0, 1.7e-3):
        q, rate = whole.segment(0).steady_motion()[0](t)
        assert complex(*q[1:]) == pytest.approx(answer * np.exp(s * t), rel=1e-12)
        assert complex(*rate[1:]) == pytest.approx(s * answer * np.exp(s * t), rel=1e-12)


@pytest.mark.core
def test_balance_at_turning_and_standing_forcing_is_the_closed_form():
    whole = run_of(rotor=Rotor(**ring(3.0, misalignment=1e-5)), stator=Stator(misalignment=1e-5))
    linear, found = whole.model.linear_scene(), {}
    for harmonic in whole.segment(0).harmonics():
        relative = linear.relative(harmonic, linear.response(harmonic))
        # A circle Re(a e^{iwt}) has a_y = -i a_x; a standing vector is real.
        standing = harmonic.frequency == 0.0
        length = math.hypot(relative[1].real, relative[2].real) if standing else abs(relative[1])
        assert standing or relative[2] == pytest.approx(-1j * relative[1], rel=1e-12)
        found[harmonic.frequency] = length / 1e-5
    k, d = K_S + K_F, D_S + D_F / 2
    assert found[0.0] == pytest.approx(abs((K_S - 1j * D_S * SPEED) / (k - 1j * d * SPEED)), rel=1e-12)
    turning = abs(K_S / ((SLENDER - INERTIA) * SPEED**2 + k + 0.5j * SPEED * D_F))
    assert found[SPEED] == pytest.approx(turning, rel=1e-12)


def test_forcing_a_ring_at_its_undamped_mode_answers_without_bound():
    """Near the forward root of the free ring the answer grows as one over the distance."""
    linear = started(free_ring(), 1.0).model.linear_scene()
    root = SPEED + math.sqrt(SPEED**2 + K_S / INERTIA)
    turning = np.array([0.0, 1e-6, -1e-6j])
    none = np.zeros(3, dtype=complex)
    answers = [np.linalg.norm(linear.response(Harmonic(root + off, 1, none, turning))) for off in (1e-2, 1e-3)]
    assert answers[1] / answers[0] == pytest.approx(10.0, rel=1e-3)


# --- extremes and periods ------------------------------------------------------------------------------


class Given:
    """Relative motion as it is handed in."""

    def relative(self, harmonic, answer):
        return answer


def extremes(parts, period):
    zero = np.zeros(3, dtype=complex)
    return steady_extremes(Given(), [(Harmonic(w, 0, zero, zero), np.array(a)) for w, a in parts], period)


def turning(amplitude, phase=0.0):
    vector = amplitude * np.exp(1j * phase)
    return [0.0, vector, -1j * vector]


def test_extremes_of_a_standing_and_a_turning_vector():
    most, least, closing = extremes([(0.0, [0, 3e-6, 4e-6]), (SPEED, turning(2e-6, 0.3))], 2 * math.pi / SPEED)
    assert (most, least, closing) == (pytest.approx(7e-6, rel=1e-12), pytest.approx(3e-6, rel=1e-12), 0.0)


def test_extremes_of_several_tones_against_a_search():
    """Incommensurate-looking phases, ratio 2 : 3 : 7, axial motion too."""
    draw = np.random.default_rng(2)
    parts = [(w * 100.0, draw.normal(size=3) + 1j * draw.normal(size=3)) for w in (2, 3, 7)]
    t = np.linspace(0, 2 * math.pi / 100, 400_001)
    x = sum(np.outer(np.exp(1j * w * t), a).real for w, a in parts)
    tilt = np.hypot(x[:, 1], x[:, 2])
    most, least, closing = extremes(parts, 2 * math.pi / 100)
    assert most == pytest.approx(tilt.max(), rel=1e-8)
    assert least == pytest.approx(tilt.min(), abs=1e-4 * tilt.max())
    assert least <= tilt.min()
    assert closing == pytest.approx(-x[:, 0].min(), rel=1e-8)


def test_extremes_of_an_oscillation_through_zero():
    most, least, _ = extremes([(500.0, [0, 3e-6, 4e-6])], 2 * math.pi / 500)
    assert most == pytest.approx(5e-6, rel=1e-12)
    assert least < 1e-6 * most


def test_extremes_without_a_period_are_bounds():
    parts = [(100.0, turning(3e-6)), (100.0 * math.sqrt(2), turning(2e-6)), (77.0, [1e-6, 0, 0])]
    assert extremes(parts, None) == (pytest.approx(5e-6, rel=1e-12), 0.0, pytest.approx(1e-6, rel=1e-12))
    assert extremes([], None) == (0.0, 0.0, 0.0)


def test_common_period():
    assert common_period([10.0]) == pytest.approx(2 * math.pi / 10, rel=1e-15)
    assert common_period([10.0, -15.0, 0.0]) == pytest.approx(2 * math.pi / 5, rel=1e-14)
    assert common_period([1000.0, 1000.0 * 7 / 3, 1000.0 / 2]) == pytest.approx(2 * math.pi / (1000 / 6), rel=1e-14)
    assert common_period([6.0, 9.0, 8.0]) == pytest.approx(2 * math.pi, rel=1e-14)
    assert common_period([1.0, math.sqrt(2)]) is None
    assert common_period([]) is None and common_period([0.0]) is None
