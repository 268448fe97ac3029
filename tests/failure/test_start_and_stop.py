"""Seals that start from rest and come back to it, or never turn: no dearer than the same turns at speed."""

import math

import pytest
from starting_seals import cycle

from sealdyn.dynamics.intervals import constant_and_slope, split_at_breaks
from sealdyn.numerics.piecewise_linear import PiecewiseLinear
from sealdyn.scenario.reader import with_values
from sealdyn.simulation.selection import prepare_run
from sealdyn.simulation.simulate import simulate_in_memory

TURNS = 0.5


@pytest.mark.core
def test_what_only_decays_sets_no_pace():
    """A film squeezed at rest forgets within nanoseconds: no period of interest, but stiff."""
    moving, steady = cycle("liquid", TURNS)
    (start, plan), (at_speed, _) = prepare_run(moving), prepare_run(steady)
    turn = 2 * math.pi / steady.scene.shaft.speed
    assert start.model.linear_scene().eigen()[0].real.min() < -1e6 / turn
    assert start.model.shortest_period == pytest.approx(turn) == at_speed.model.shortest_period
    assert start.model.reference_rate == pytest.approx(2 * math.pi / turn)
    assert plan.method == "bdf"


@pytest.mark.parametrize("name", ["liquid", "dry, O-ring", "gas dam", "no mass"])
def test_a_start_and_a_stop_cost_what_the_same_turns_do(name):
    found, at_speed = (simulate_in_memory(one) for one in cycle(name, TURNS))
    assert found["status"] == at_speed["status"] == "ok"
    for count in ("steps", "rhs"):
        assert found["counts"][count] < 20 * at_speed["counts"][count]


def test_a_seal_that_stands_still_gets_to_the_end():
    """Nothing ever turns: the slowest decay is the pace."""
    _, steady = cycle("liquid, tight O-ring", TURNS)
    found = simulate_in_memory(with_values(steady, {"shaft.speed": 0.0, "run.duration": 2.0, "run.samples": 100}))
    assert found["status"] == "ok" and found["counts"]["steps"] < 3000


def test_a_ring_that_sticks_after_a_stop_needs_no_steps_for_the_time_it_stands():
    _, steady = cycle("liquid, tight O-ring", TURNS)
    stopped = PiecewiseLinear((0.0, 0.02, 60.0), (steady.scene.shaft.speed, 0.0, 0.0))
    found = simulate_in_memory(with_values(steady, {"shaft.speed": stopped, "run.duration": 60.0, "run.samples": 100}))
    assert found["status"] == "ok" and found["counts"]["steps"] < 3000


@pytest.mark.core
def test_the_end_of_a_run_is_what_its_last_ramp_comes_to():
    """Stiffness is looked for there too: no interval starts with it."""
    speed = PiecewiseLinear((0.0, 0.5), (0.0, 400.0))
    intervals = split_at_breaks(0.5, speed, 0.0, [speed])
    assert [constant_and_slope(speed, one)[0] for one in intervals] == [0.0]
    assert constant_and_slope(speed, intervals.end)[0] == pytest.approx(400.0, rel=2e-3)
    assert intervals.end.time + intervals.end.length == pytest.approx(0.5, rel=1e-12)
    assert float(intervals.end.rotor_angle) == pytest.approx(100.0, rel=5e-3)
