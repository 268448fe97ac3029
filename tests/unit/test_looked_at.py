"""Scales of what the accuracy is about."""

import math

import pytest
from scenes import CLEARANCE, R_I, R_O, SPEED, film, fms, prepared

from sealdyn.numerics.piecewise_linear import PiecewiseLinear
from sealdyn.scene.excitation import Shaft
from sealdyn.simulation.verification_run import ErrorScales

VOLUME = math.pi * (R_O**2 - R_I**2) * CLEARANCE


def scales(duration=0.01, **scene):
    return ErrorScales(prepared(fms(**scene), duration, 1e-6))


@pytest.mark.core
def test_the_rate_is_that_of_the_run():
    """A table that goes on beyond the run does not loosen what is promised of it."""
    faster = Shaft(speed=PiecewiseLinear((0.0, 0.1), (SPEED, 11.0 * SPEED)))
    assert scales(0.01, shaft=faster).rate == pytest.approx(2.0 * SPEED)
    assert scales(0.2, shaft=faster).rate == pytest.approx(11.0 * SPEED)
    slower = Shaft(speed=PiecewiseLinear((0.0, 0.1), (SPEED, 0.0)))
    assert scales(0.2, shaft=slower).rate == SPEED


def test_leakage_where_nothing_flows_through():
    """Between equal pressures only what squeezing makes comes and goes: of the clearance's volume, not of itself."""
    still = scales(film=film(outer_pressure=5e5, inner_pressure=5e5))
    assert still.leakage == pytest.approx(VOLUME * SPEED)
    through = scales(film=film(outer_pressure=5e5, inner_pressure=1e5))
    assert through.leakage == pytest.approx(scales(film=film(outer_pressure=4e5, inner_pressure=0.0)).leakage)
    assert through.leakage != pytest.approx(VOLUME * SPEED, rel=0.1)
