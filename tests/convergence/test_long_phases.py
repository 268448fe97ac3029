"""Phases after a million turns against fifty digits, through the compiled kernel; a plain float phase fails."""

import cmath
import math

import mpmath
import numpy as np
import pytest
from scenes import fmr, ring

from sealdyn.dynamics.imposed_motion import (
    OSCILLATOR_COUNT,
    OSCILLATORS,
    PER_RING,
    ROW,
    TILT_X,
    TILT_Y,
    Z,
    harmonics_of_segment,
    imposed_state,
)
from sealdyn.dynamics.intervals import split_at_breaks
from sealdyn.scene.excitation import AxialVibration, Housing, Shaft, Whirl
from sealdyn.scene.rings import ROTOR, STATOR, AxialRunout, Rotor, Stator

RATIO, TONE, ORDER = 0.4837, 5400.0, 7


@pytest.fixture(autouse=True)
def fifty_digits():
    with mpmath.workdps(50):
        yield


def scene(speed):
    return fmr(
        shaft=Shaft(speed=speed, whirl=[Whirl(ratio=RATIO, angle=1.0)]),
        rotor=Rotor(axial_runout=[AxialRunout(order=ORDER, amplitude=1.0)], **ring()),
        stator=Stator(),
        housing=Housing(axial=[AxialVibration(frequency=TONE, displacement=1.0)]),
    )


def by_kernel(made, leg, tau):
    """exp(i phase) of the whirl, cosines of the runout and of the housing tone."""
    rows = harmonics_of_segment(made.shaft, made.housing, made.rotor, made.stator, leg)
    p, c = np.zeros(OSCILLATORS + ROW * len(rows)), np.zeros(2 * PER_RING)
    p[OSCILLATOR_COUNT], p[OSCILLATORS:] = len(rows), rows.ravel()
    imposed_state(tau, p, c)
    rotor, stator = PER_RING * ROTOR, PER_RING * STATOR
    return complex(c[rotor + TILT_X], c[rotor + TILT_Y]), c[rotor + Z], c[stator + Z]


def by_digits(speed, leg, tau):
    t = mpmath.mpf(leg.start.numerator) / leg.start.denominator + mpmath.mpf(tau)
    angle = mpmath.mpf(speed) * t
    whirl = mpmath.mpf(RATIO) * angle
    runout, tone = mpmath.cos(ORDER * angle), mpmath.cos(2 * mpmath.pi * mpmath.mpf(TONE) * t)
    return complex(mpmath.cos(whirl), mpmath.sin(whirl)), float(runout), float(tone)


def by_floats(speed, leg, tau):
    t = leg.time + tau
    return cmath.exp(1j * RATIO * speed * t), math.cos(ORDER * speed * t), math.cos(2 * math.pi * TONE * t)


def worst(found, speed, legs):
    """Largest error of each of the three over places in the last legs."""
    made, errors = scene(speed), np.zeros(3)
    for leg in legs[-3:]:
        # Places at no whole part of a turn, where a cosine would not show its phase.
        for tau in leg.length * np.mod(np.arange(1, 60) * 0.6180339887498949, 1.0):
            exact = by_digits(speed, leg, float(tau))
            told = found(made, leg, float(tau)) if found is by_kernel else found(speed, leg, float(tau))
            errors = np.maximum(errors, [abs(a - b) for a, b in zip(told, exact, strict=True)])
    return errors


# Measured errors (whirl at 0.48, runout of order 7, 5.4 kHz tone), radians of phase:
#   10 000 rpm   legs 5e-13, 1.3e-11, 3e-11     floats 5e-10, 7e-9, 4e-8
#   16 Hz        legs 6e-13, 1.2e-11, 6e-10     floats 4e-10, 5e-9, 3e-7
# A leg is at most 2000 turns: a phase inside it is as good as a float of that size, whatever came before.
@pytest.mark.core
@pytest.mark.parametrize("speed", [1047.1975511965977, 2 * math.pi * 16.0], ids=["10000 rpm", "16 Hz"])
def test_phases_after_a_million_turns(speed):
    legs = split_at_breaks(2 * math.pi * 1e6 / speed, speed, 0.0, [])
    inside = 2 * math.pi * 2000
    largest = inside * np.array([RATIO, ORDER, 2 * math.pi * TONE / speed])
    kept, lost = (worst(found, speed, legs) for found in (by_kernel, by_floats))
    assert np.all(kept < 2.5 * np.spacing(largest))
    assert np.all(lost > 50 * kept) and lost[0] > 1e-10
