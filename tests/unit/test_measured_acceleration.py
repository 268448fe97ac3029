"""Measured accelerations as motion: integrated twice, drift removed."""

import math

import numpy as np
import pytest

from sealdyn.numerics.twice_integrated import twice_integrated
from sealdyn.scene.excitation import Motion

CORNER, AMPLITUDE = 5.0, 1e-6


def record(frequency, long=2.0, rate=8000.0):
    """Times, displacement and acceleration of a tone."""
    time = np.arange(round(long * rate) + 1) / rate
    moved = AMPLITUDE * np.cos(2 * math.pi * frequency * time + 0.3)
    return time, moved, -((2 * math.pi * frequency) ** 2) * moved


@pytest.mark.parametrize("frequency", [25.0, 50.0, 200.0])
def test_a_tone_has_its_displacement(frequency):
    time, moved, measured = record(frequency)
    found, _ = twice_integrated(time, measured, CORNER)
    off, period = np.abs(found - moved) / AMPLITUDE, round(8000.0 / CORNER)
    share = CORNER / frequency
    # What the ends miss has faded to 1e-4 of itself.
    assert off[2 * period : -2 * period].max() < 3 * share**4 + 3e-4 * share
    assert off.max() < share


def test_an_offset_and_a_trend_go_exactly():
    time, _, measured = record(50.0)
    still, (offset, pace) = twice_integrated(time, measured, CORNER)
    found, (more, faster) = twice_integrated(time, measured + 3.0 + 0.5 * (time - time[-1] / 2), CORNER)
    assert np.abs(found - still).max() < 1e-6 * AMPLITUDE
    assert (more - offset, faster - pace) == pytest.approx((3.0, 0.5), rel=1e-9)
    # Without a drift removed, it is ten million amplitudes.
    assert 0.5 * 3.0 * time[-1] ** 2 > 1e6 * AMPLITUDE
    # What is slower than the corner goes.
    slow, _ = twice_integrated(*record(0.5)[::2], CORNER)
    assert np.abs(slow).max() < 0.05 * AMPLITUDE


def test_uneven_samples_and_another_length():
    rate, long = 4000.0, 1.3
    time = (np.arange(round(long * rate)) + 0.2 * np.random.default_rng(4).uniform(size=round(long * rate))) / rate
    w = 2 * math.pi * 60.0
    found, _ = twice_integrated(time, -w * w * AMPLITUDE * np.sin(w * time) + 7.0, CORNER)
    inside = (time > 0.4) & (time < 0.9)
    assert np.abs(found - AMPLITUDE * np.sin(w * time))[inside].max() < 2e-4 * AMPLITUDE


def test_a_motion_has_the_columns_of_its_accelerations():
    time, moved, measured = record(200.0, 0.6)
    motion = Motion(time=tuple(time), axial_acceleration=tuple(measured + 2.0), drift_below=CORNER, tilt_x=tuple(moved))
    axial, tilt, none = motion.columns()
    middle = slice(len(time) // 3, 2 * len(time) // 3)
    assert np.asarray(axial)[middle] == pytest.approx(moved[middle], abs=1e-3 * AMPLITUDE)
    assert tilt == motion.tilt_x and not any(none)
    assert motion.moves("axial") and not motion.moves("tilt_y")
    assert len(motion.remarks("housing.motion")) == 1
