"""Orders over the shaft's exact angle: what is known of a made-up sweep must come back."""

import math

import numpy as np
import pytest
from scenes import fms, started

from sealdyn.numerics.piecewise_linear import PiecewiseLinear
from sealdyn.numerics.time_series import FOLDED, at_the_edge, centres, peak, resolution, tracked, waterfall
from sealdyn.studies.runup.ramp_run import EvenAngleSink, RampCycle

PER_TURN = 32


def numbers(turns, first=0):
    return first + np.arange(turns * PER_TURN)


@pytest.mark.core
def test_an_order_comes_back_alone():
    """Amplitude and phase of order 1 among a standing tilt, the half order against the shaft and the second order."""
    number = numbers(40, first=7)
    angle = 2 * np.pi * number / PER_TURN
    wanted = 3e-5 * np.exp(0.7j)
    others = 1e-5 + 4e-5 * np.exp(-0.5j * angle) + 2e-5j * np.exp(2j * angle)
    found = tracked(wanted * np.exp(1j * angle) + others, number, PER_TURN, 8, 1.0, [0, 5, 200])
    assert found == pytest.approx(np.full(3, wanted), rel=1e-12)
    half = tracked(others, number, PER_TURN, 8, -0.5, [0, 100])
    assert half == pytest.approx(np.full(2, 4e-5), rel=1e-12)


def test_a_real_signal_gives_its_cosine():
    number = numbers(20, first=100_000_003)
    signal = 2e-6 * np.cos(3 * 2 * np.pi * (number % PER_TURN) / PER_TURN + 0.4)
    found = tracked(signal, number, PER_TURN, 6, 3.0, [0, 50])
    assert found == pytest.approx(np.full(2, 2e-6 * np.exp(0.4j)), rel=1e-9)


def test_an_amplitude_that_changes_evenly_is_its_value_in_the_middle():
    number = numbers(40)
    signal = (1.0 + 0.01 * number / PER_TURN) * np.exp(2j * np.pi * number / PER_TURN)
    firsts = np.array([0, 320, 640])
    middle = firsts + (8 * PER_TURN - 1) / 2
    assert tracked(signal, number, PER_TURN, 8, 1.0, firsts) == pytest.approx(1 + 0.01 * middle / PER_TURN, rel=1e-12)


def test_in_the_waterfall_orders_stand_and_frequencies_move():
    """A sweep from 1000 to 3000 rad/s with a whirl at 700 rad/s: sampled over the angle, the order stays on its line
    while the whirl's order falls as 700 over the speed."""
    number = numbers(600)
    angle, slope = 2 * np.pi * number / PER_TURN, (3000.0**2 - 1000.0**2) / (2 * 2 * np.pi * 600)
    speed = np.sqrt(1000.0**2 + 2 * slope * angle)
    time = (speed - 1000.0) / slope
    signal = np.exp(1j * angle) + 0.1 * np.exp(700j * time)
    turns = 16
    firsts = centres(0, len(number), turns * PER_TURN, speed, 20)
    rows, orders, share = waterfall(signal, PER_TURN, turns, firsts, -1.5, 2.5)
    assert rows.shape == (20, len(orders))
    assert np.all(orders[np.argmax(rows, axis=1)] == 1.0)
    # The whirl, at least 4.8 lines away, reaches over by Hann's side lobes: a thousandth of its tenth.
    assert rows.max(axis=1) == pytest.approx(np.ones(20), rel=2e-4)
    slow = np.where(orders < 0.85, rows, 0.0)
    middle = speed[firsts + turns * PER_TURN // 2]
    assert orders[np.argmax(slow, axis=1)] == pytest.approx(700 / middle, abs=1.0 / turns)
    assert share < 1e-9
    # Windows evenly over the speed, all of them inside.
    assert np.diff(middle) == pytest.approx(np.full(19, np.ptp(middle) / 19), rel=0.05)
    assert firsts[-1] + turns * PER_TURN <= len(number)
    assert resolution(turns) == pytest.approx(1.5 / 16)


def test_content_at_the_edge_of_the_band_is_noticed():
    """Order 31 of 32 samples a turn folds to -1 and cannot be told; a tail that reaches the edge can."""
    number = numbers(16)
    angle = 2 * np.pi * number / PER_TURN
    *_, clean = waterfall(np.exp(1j * angle), PER_TURN, 16, [0], -1.5, 2.5)
    *_, tail = waterfall(np.exp(1j * angle) + 0.02 * np.exp(15j * angle), PER_TURN, 16, [0], -1.5, 2.5)
    assert clean < 1e-12 < FOLDED < tail
    orders = np.arange(-16.0, 16.0)
    assert at_the_edge(orders, np.where(orders == 15, 1e-12, 0.0), 0.1, still=1e-9) == 0.0


def test_peak():
    speed = np.linspace(1000.0, 2000.0, 101)
    at, height = peak(speed, 5.0 - ((speed - 1503.7) / 400) ** 2)
    assert (at, height) == pytest.approx((1503.7, 5.0), rel=1e-9)
    assert peak(speed, speed) is None
    assert peak(speed[:2], speed[:2]) is None


def test_trip():
    trip = RampCycle("shaft.speed", 100.0, 500.0, 1000.0, 0.1, hold=0.2, rest=0.05, crossing=300.0)
    assert trip.crossed() == pytest.approx((0.3, 0.9))
    table = trip.table()
    assert table.time == pytest.approx((0.0, 0.1, 0.3, 0.5, 0.7, 0.9, 1.1, 1.15))
    assert table.value == (100.0, 100.0, 300.0, 500.0, 500.0, 300.0, 100.0, 100.0)
    step = RampCycle("film.outer_pressure", 5e5, 1e5, None, 0.1, hold=0.2, rest=0.1).table()
    assert step.at(0.1 - 1e-9) == 5e5 and step.at(0.1) == 1e5 and step.at(0.3001) == 5e5


def test_samples_stand_at_even_angles():
    """Times between two samples, speed integrated over them exactly: 1/32 of a turn each, over kinks and reversals of
    the ramp, none twice and none left out."""
    times, values = (0.0, 0.01, 0.11, 0.15, 0.25), (0.0, 300.0, 4000.0, 4000.0, 500.0)
    ready = started(fms("linear", speed=PiecewiseLinear(times, values)), 0.25)
    sink = EvenAngleSink(PER_TURN)
    found, first = [], []
    for k, leg in enumerate(ready.intervals):
        taus = sink.due(ready.segment(k))
        found.append(leg.time + taus)
        first.append(sink.first)
    found = np.concatenate(found)
    angle = [np.trapezoid(*_up_to(times, values, t)[::-1]) for t in found]
    assert np.array(angle) * PER_TURN / (2 * np.pi) == pytest.approx(np.arange(len(found)), abs=1e-7)
    whole = np.trapezoid(values, times)
    assert len(found) == math.floor(whole * PER_TURN / (2 * np.pi)) + 1


def _up_to(times, values, t):
    kept = [x for x in times if x < t]
    return np.array([*kept, t]), np.interp([*kept, t], times, values)
