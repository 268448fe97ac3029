"""Phases after a million turns, tables cut at their kinks and steps, and the time a shaft angle takes."""

import math
from fractions import Fraction
from itertools import pairwise

import mpmath
import numpy as np
import pytest
from command import SCENARIOS
from scenes import fmr, fms, ring, started
from scipy.integrate import quad

from sealdyn.dynamics import imposed_motion as M
from sealdyn.dynamics import intervals
from sealdyn.dynamics.intervals import Instant, constant_and_slope, modulo_turn, split_at_breaks, time_of_angle
from sealdyn.numerics.piecewise_linear import PiecewiseLinear
from sealdyn.scenario.reader import read_scenario
from sealdyn.scene.excitation import AngularVibration, Housing, Shaft, Whirl
from sealdyn.scene.rings import STATOR, Rotor, Stator
from sealdyn.simulation.simulate import prepare_run

SPEED = 1047.1975511965977  # 10 000 rpm, not a whole number of rad/s
MILLION = 2 * math.pi * 1e6 / SPEED


def exact(number):
    return mpmath.mpf(number.numerator) / number.denominator if isinstance(number, Fraction) else mpmath.mpf(number)


@pytest.fixture(autouse=True)
def fifty_digits():
    with mpmath.workdps(50):
        yield


def circle(phase):
    return complex(mpmath.cos(phase), mpmath.sin(phase))


def imposed(scene, leg, tau):
    """State of both carriers, (2, PER_RING), from the compiled kernel."""
    rows = M.harmonics_of_segment(scene.shaft, scene.housing, scene.rotor, scene.stator, leg)
    p = np.zeros(M.OSCILLATORS + M.ROW * len(rows))
    p[M.OSCILLATOR_COUNT], p[M.OSCILLATORS :] = len(rows), rows.ravel()
    c = np.zeros(2 * M.PER_RING)
    M.imposed_state(tau, p, c)
    return c.reshape(2, M.PER_RING)


# --- phases ---------------------------------------------------------------------------------------------


@pytest.mark.core
def test_phase_after_a_million_turns():
    legs = split_at_breaks(MILLION, SPEED, -300.0, [])
    assert len(legs) >= 500
    for leg in (legs[1], legs[len(legs) // 2], legs[-1]):
        for spin, angle in ((SPEED, leg.rotor_angle), (-300.0, leg.stator_angle)):
            turned = mpmath.mpf(spin) * exact(leg.start)
            assert abs(circle(modulo_turn(angle)) - circle(turned)) < 1e-15
    # What plain floating point makes of the same angle: 1.2e-10 rad at the last leg's start.
    naive = abs(circle(SPEED * legs[-1].time) - circle(mpmath.mpf(SPEED) * exact(legs[-1].start)))
    assert naive > 1e-11


def test_phase_of_a_ramp():
    """The angle is the integral of a speed table, whatever legs it is cut into."""
    speed = PiecewiseLinear((0.0, 10.0, 2010.0, 2020.0), (0.0, 1000.0, 1500.0, -200.0))
    legs = split_at_breaks(2020.0, speed, 0.0, [speed])
    assert len(legs) > 100
    ends = {0.0: 0, 10.0: 5000, 2010.0: 5000 + 2000 * 1250, 2020.0: 5000 + 2000 * 1250 + 6500}
    for leg in legs:
        if leg.time in ends:
            assert abs(float(leg.rotor_angle - ends[leg.time])) < 1e-9
        # Inside: w0 t + slope t^2 / 2 of the straight piece.
        since = exact(leg.start) - 10
        if 0 < since < 2000:
            turned = 5000 + 1000 * since + since**2 / 8
            # A table's own slope is a float: some 1e-13 of half a million turns.
            assert abs(exact(leg.rotor_angle) - turned) < 1e-8


def test_rates_are_the_slopes_of_the_imposed_motion():
    """Ramped speed, ramped runout, fixed-axis and turning motions: rates against differences of the displacements."""
    ramp = PiecewiseLinear((0.0, 1.0), (100.0, 900.0))
    scene = fmr(
        shaft=Shaft(speed=ramp, whirl=[Whirl(ratio=-0.5, angle=0.5)]),
        rotor=Rotor(runout=PiecewiseLinear((0.0, 1.0), (0.2, 1.2)), runout_phase=0.4),
        stator=Stator(**ring()),
        housing=Housing(angular=[AngularVibration(frequency=31.0, displacement=0.7, direction=0.6, phase=0.2)]),
    )
    leg = split_at_breaks(1.0, ramp, 0.0, [ramp])[0]
    step, tau = 1e-6, 0.37
    late, early, now = (imposed(scene, leg, tau + x) for x in (step, -step, 0.0))
    for ring_index in range(2):
        for place, rate in ((M.TILT_X, M.TILT_X_RATE), (M.TILT_Y, M.TILT_Y_RATE)):
            slope = (late[ring_index, place] - early[ring_index, place]) / (2 * step)
            assert now[ring_index, rate] == pytest.approx(slope, rel=1e-6, abs=1e-4)
    tilt = 0.7 * math.cos(2 * math.pi * 31.0 * tau + 0.2) * np.exp(0.6j)
    assert complex(now[STATOR, M.TILT_X], now[STATOR, M.TILT_Y]) == pytest.approx(tilt, rel=1e-12)
    angle = 100 * tau + 400 * tau**2
    tilt = (0.2 + tau) * np.exp(1j * (angle + 0.4)) + 0.5 * np.exp(-0.5j * angle)
    assert complex(now[1, M.TILT_X], now[1, M.TILT_Y]) == pytest.approx(tilt, rel=1e-12)


# --- legs -----------------------------------------------------------------------------------------------


STEPPED = PiecewiseLinear((0.0, 1.0, 1.0, 2.0, 3.5), (5.0, 7.0, -2.0, -2.0, 4.0))


def test_legs_tile_time_and_stop_at_every_kink():
    other = PiecewiseLinear((0.5, 2.2), (1.0, 2.0))
    legs = split_at_breaks(4.0, 100.0, 0.0, [100.0, STEPPED, other])
    assert [leg.time for leg in legs] == [0.0, 0.5, 1.0, 2.0, 2.2, 3.5]
    for a, b in pairwise(legs):
        assert a.start + a.span == b.start
    assert legs[-1].start + legs[-1].span == 4
    # A table beyond the run leaves no leg behind.
    assert len(split_at_breaks(0.4, 100.0, 0.0, [STEPPED, other])) == 1


def test_value_and_slope_on_each_side_of_a_step():
    legs = split_at_breaks(5.0, 0.0, 0.0, [STEPPED])
    found = [constant_and_slope(STEPPED, leg) for leg in legs]
    expected = [(5.0, 2.0), (-2.0, 0.0), (-2.0, 4.0), (4.0, 0.0)]
    assert np.allclose(found, expected, rtol=0, atol=1e-13)
    assert constant_and_slope(3.25, legs[0]) == (3.25, 0.0)
    # Held before the first time of a table.
    late = PiecewiseLinear((1.0, 2.0), (3.0, 4.0))
    found = [constant_and_slope(late, leg) for leg in split_at_breaks(2.0, 0.0, 0.0, [late])]
    assert np.allclose(found, [(3, 0), (3, 1)])


# --- time of an angle ----------------------------------------------------------------------------------


def turned_by(table, t):
    """Angle turned, either way round, by quadrature between the table's times and sign changes."""
    places = sorted({x for x in table.time if 0 < x < t} | {0.0, t})
    total = 0.0
    for a, b in pairwise(places):
        early, late = table.at(a + 1e-9 * (b - a)), table.at(b - 1e-9 * (b - a))
        turning = [a + (b - a) * early / (early - late)] if early * late < 0 else None
        total += quad(lambda x: abs(table.at(x)), a, b, points=turning, epsabs=1e-12, epsrel=1e-12)[0]
    return total


TABLES = {
    "run-up from rest": PiecewiseLinear((0.0, 2.0), (0.0, 800.0)),
    "reversal": PiecewiseLinear((0.0, 1.0, 3.0, 4.0), (300.0, 300.0, -500.0, -500.0)),
    "steps": PiecewiseLinear((0.0, 1.0, 1.0, 2.0), (100.0, 100.0, 400.0, 50.0)),
    "a stop between": PiecewiseLinear((0.0, 1.0, 2.0, 3.0), (200.0, 0.0, 0.0, 600.0)),
    "late table": PiecewiseLinear((2.0, 3.0), (100.0, 700.0)),
}


@pytest.mark.parametrize("table", TABLES.values(), ids=TABLES)
def test_time_of_an_angle(table):
    for angle in (0.5, 30.0, 200.0, 431.0, 2500.0):
        assert turned_by(table, time_of_angle(table, angle)) == pytest.approx(angle, rel=1e-9)


def test_what_has_come_to_rest_has_no_speed():
    """Not what is left of rounding, over which a whirl ratio would be a number."""
    for top, long in ((100.0, 0.7), (523.598, 0.3), (1047.2, 1.1)):
        stop = PiecewiseLinear((0.0, 0.1, 0.1 + long), (top, top, 0.0))
        last = split_at_breaks(0.1 + long, 0.0, 0.0, [stop])[-1]
        assert constant_and_slope(stop, Instant.of(last, last.length))[0] == 0.0


def test_time_of_an_angle_at_constant_speed():
    assert time_of_angle(500.0, 100.0) == pytest.approx(0.2, rel=1e-15)
    assert time_of_angle(-500.0, 100.0) == pytest.approx(0.2, rel=1e-15)


@pytest.mark.parametrize("speed", [0.0, PiecewiseLinear((0.0, 1.0), (100.0, 0.0))])
def test_an_angle_that_is_never_turned(speed):
    with pytest.raises(ValueError, match="turn"):
        time_of_angle(speed, 51.0)


def test_a_shaft_that_drives_nothing_is_no_forcing():
    """An aligned seal has nothing that samples could alias; a misaligned one has the turning of the shaft."""
    assert started(fms(speed=SPEED, own=0.0, runout=0.0), 0.01).fastest_forcing() == 0.0
    assert started(fms(speed=SPEED, own=25e-6, runout=0.0), 0.01).fastest_forcing() == SPEED


def test_a_billion_turns_cost_no_more_than_a_few(monkeypatch):
    """Intervals are made when they are asked for, and what is gathered over a run asks for few of them."""
    asked, make = [], intervals.Interval.__init__
    monkeypatch.setattr(intervals.Interval, "__init__", lambda *how, **named: asked.append(0) or make(*how, **named))
    scenario = SCENARIOS / "fms_reference.toml"
    run = prepare_run(read_scenario(scenario, ["run.turns=1e9"]))[0]
    assert len(run.intervals) in (500_000, 500_001) and len(asked) < 5000
    assert run.intervals[-1].rotor_angle == 1000 * run.intervals[-1].start


def test_few_intervals_stand_for_all():
    """The first and the last between break points among them; slices and negative places as in a list."""
    ramp = PiecewiseLinear((0.0, 10.0, 40.0), (0.0, 5e5, 5e5))
    legs = split_at_breaks(40.0, ramp, 0.0, [ramp])
    starts = [leg.start for leg in legs]
    assert starts == sorted(starts) and len(starts) == len(legs) > 10 * intervals.FEW
    few = [leg.start for leg in legs.few]
    assert len(few) == 2 * intervals.FEW and set(few) < set(starts)
    assert {starts[0], starts[-1], Fraction(10)} < set(few) and max(s for s in starts if s < 10) in few
    assert legs[-1] == legs[len(legs) - 1] and legs[::500] == [legs[k] for k in range(0, len(legs), 500)]
    # What one has turned is where the next one begins.
    for k in (0, 5, len(legs) - 2):
        turned = legs[k + 1].rotor_angle - legs[k].rotor_angle
        assert float(turned) == pytest.approx(float(intervals.angle_turned(ramp, legs[k])), rel=1e-12)
    with pytest.raises(IndexError):
        legs[len(legs)]
