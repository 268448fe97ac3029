"""Friction of a secondary seal: the closed wrench against the circle integral, and the limit surface."""

import math
import re
import typing

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scenes import fms, ring

from sealdyn.analysis.poincare_map import PeriodMap
from sealdyn.dynamics.secondary_seal import excess, sliding
from sealdyn.scene.forces import SecondarySeal, secondary_seal_errors
from sealdyn.scene.rings import Stator
from sealdyn.scene.scene import SceneError

LINE, RADIUS = 37.0, 0.045
speeds = st.floats(-1.0, 1.0).filter(lambda x: abs(x) > 1e-6)


def circle(v, q_x, q_y, points=100_001):
    """-F' sign(v(theta)) and its moments, by the midpoint rule around the circle."""
    theta = (np.arange(points) + 0.5) * 2 * np.pi / points
    line = -LINE * np.sign(v + RADIUS * (q_x * np.sin(theta) - q_y * np.cos(theta)))
    d = RADIUS * 2 * np.pi / points
    lever = line * RADIUS * d
    return np.array([line.sum() * d, (lever * np.sin(theta)).sum(), -(lever * np.cos(theta)).sum()])


@settings(deadline=None, max_examples=40)
@given(speeds, speeds, speeds)
def test_wrench_is_the_circle_integral(v, q_x, q_y):
    out = np.zeros(3)
    speed = sliding(RADIUS * v, q_x, q_y, LINE, RADIUS, 1e-12, False, out)
    assert speed == pytest.approx(RADIUS * math.sqrt(v * v + q_x * q_x + q_y * q_y))
    exact, scale = circle(RADIUS * v, q_x, q_y), 2 * math.pi * RADIUS * LINE
    assert np.abs(out - exact) / [scale, scale * RADIUS, scale * RADIUS] == pytest.approx(0.0, abs=1e-4)


@pytest.mark.core
@pytest.mark.parametrize("angle", np.linspace(0.02, 1.5, 12))
def test_sliding_loads_lie_on_the_limit_surface(angle):
    """What the seal gives while sliding is the most it can hold while stuck."""
    out = np.zeros(3)
    sliding(math.sin(angle) * 1e-3, 1e-3 / RADIUS * 0.6, -1e-3 / RADIUS * 0.8, LINE, RADIUS, 1e-12, False, out)
    assert excess(*out, LINE, RADIUS) == pytest.approx(0.0, abs=1e-12)
    assert excess(*(0.999 * out), LINE, RADIUS) < 0 < excess(*(1.001 * out), LINE, RADIUS)


@settings(deadline=None, max_examples=40)
@given(speeds, speeds, speeds)
def test_friction_takes_the_circle_integral_of_speed(v, q_x, q_y):
    """Power = -F' times the integral of |v|: never gives energy, whatever the law."""
    out = np.zeros(3)
    sliding(RADIUS * v, q_x, q_y, LINE, RADIUS, 1e-12, False, out)
    theta = (np.arange(100_001) + 0.5) * 2 * np.pi / 100_001
    lost = LINE * RADIUS * np.mean(np.abs(RADIUS * (v + q_x * np.sin(theta) - q_y * np.cos(theta)))) * 2 * np.pi
    assert -(out @ [RADIUS * v, q_x, q_y]) == pytest.approx(lost, rel=1e-6)
    sliding(RADIUS * v, q_x, q_y, LINE, RADIUS, 0.1, True, out)
    assert 0 < -(out @ [RADIUS * v, q_x, q_y]) < lost


def test_below_the_band_friction_fades_linearly_and_stays_finite():
    out, half = np.zeros(3), np.zeros(3)
    sliding(1e-3, 2e-2, 1e-2, LINE, RADIUS, 1.0, False, out)
    sliding(0.5e-3, 1e-2, 0.5e-2, LINE, RADIUS, 1.0, False, half)
    assert 2 * half == pytest.approx(out, rel=1e-12)
    assert sliding(0.0, 0.0, 0.0, LINE, RADIUS, 1e-9, False, out) == 0.0 and not out.any()


def test_breakaway_of_force_and_moment():
    seal = SecondarySeal(radius=RADIUS, friction_force=12.0)
    force, moment = seal.breakaway()
    assert force == pytest.approx(12.0)
    assert excess(force, 0, 0, seal.line(), RADIUS) == pytest.approx(0, abs=1e-12)
    assert excess(0, moment, 0, seal.line(), RADIUS) == pytest.approx(0, abs=1e-12)
    assert moment == pytest.approx(2 / math.pi * force * RADIUS)


@pytest.mark.parametrize(
    "table,key",
    [
        (dict(radius=0.0, line_friction=1.0), "radius"),
        (dict(radius=1.0), "line_friction"),
        (dict(radius=1.0, line_friction=1.0, friction_force=1.0), "line_friction"),
        (dict(radius=1.0, friction_force=-1.0), "friction_force"),
        (dict(radius=1.0, line_friction=1.0, law="regularised"), "width"),
        (dict(radius=1.0, line_friction=1.0, width=1.0), "width"),
    ],
)
def test_faults_name_the_key(table, key):
    assert [fault[0] for fault in secondary_seal_errors(SecondarySeal(**table))] == [key]
    assert not secondary_seal_errors(SecondarySeal(radius=1.0, line_friction=1.0))


def test_a_map_that_refuses_a_sticking_ring_names_a_law_that_there_is():
    seal = SecondarySeal(radius=RADIUS, line_friction=LINE)
    period_map = PeriodMap(fms(stator=Stator(**ring(secondary_seal=seal))))
    with pytest.raises(SceneError) as refused:
        period_map.step(np.zeros(period_map.size))
    law = re.search('"(.*?)"', refused.value.expected)[1]
    assert law in typing.get_args(typing.get_type_hints(SecondarySeal)["law"])
