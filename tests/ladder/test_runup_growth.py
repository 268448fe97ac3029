"""Growth of a small whirl past the threshold against the integral of its linear growth rate, and the slow limit.

The oracle is a ring of its own: one complex equation with the speed in it, written down here with Green's
coefficients and integrated by SciPy; its eigenvalues are the roots of a quadratic.
"""

from itertools import pairwise

import numpy as np
import pytest
from command import SCENARIOS
from oracles import green_film
from scipy.integrate import quad, solve_ivp

from sealdyn.analysis.rotating_wave import free_model, tilt_mode
from sealdyn.dynamics import stability_thresholds
from sealdyn.dynamics.stability_thresholds import one_by_one
from sealdyn.numerics.time_series import centres, tracked
from sealdyn.scenario.reader import read_scenario
from sealdyn.studies.runup.ramp_run import RampCycle, run_cycle
from sealdyn.studies.runup.speed_ramp import measured_growth, predicted_growth

SCALE, INERTIA = 1e-5 / 0.04, 8e-4
SUPPORT_K, SUPPORT_D = 400.0, 0.24
RATES = (3000.0, 6000.0, 20000.0)
FILM_K, FILM_D = green_film()


def stator(w):
    """Damping and stiffness of a flexible stator at the speed w, per unit of inertia."""
    return (SUPPORT_D + FILM_D) / INERTIA, (SUPPORT_K + FILM_K - 0.5j * w * FILM_D) / INERTIA


def rotor(w, polar=INERTIA / 3.0):
    """The same of a flexible rotor: gyroscopic term, and dampers that turn with it."""
    damping = SUPPORT_D + FILM_D - 1j * polar * w
    return damping / INERTIA, (SUPPORT_K + FILM_K - 1j * w * (SUPPORT_D + 0.5 * FILM_D)) / INERTIA


def whirl(ring, w) -> complex:
    """The least damped eigenvalue."""
    d, k = ring(w)
    return max(np.roots([1.0, d, k]), key=lambda v: v.real)


def threshold(ring, low=2000.0, high=12000.0) -> float:
    """By bisection: where the whirl neither grows nor decays."""
    while high - low > 1e-9 * high:
        middle = 0.5 * (low + high)
        low, high = (low, middle) if whirl(ring, middle).real > 0 else (middle, high)
    return low


def scenario(name="runup_past_threshold", *overrides, model="linear"):
    return read_scenario(SCENARIOS / f"{name}.toml", [f"film.model={model}", *overrides])


def passage(asked, rate, kick=1e-3, hold=0.0, per_turn=16):
    """The trip past the threshold and back, and the mode along it."""
    ready = free_model(asked.scene, 1000.0)
    crossing = stability_thresholds.thresholds(one_by_one(lambda w: ready.linear_scene(speed=w)), 500.0, 2e4)[0]
    mode = tilt_mode(ready, 0.9 * crossing, 1.05 * crossing, crossing)
    trip = RampCycle("shaft.speed", 0.97 * crossing, 1.05 * crossing, rate, 0.005, hold, 0.002, crossing)
    return run_cycle(asked, trip, per_turn, mode, kick * SCALE), trip, mode


def shaft(trip):
    def speed(t):
        return np.interp(t, [trip.settle, trip.top, trip.back, trip.home], [trip.begin, trip.end, trip.end, trip.begin])

    return speed


def oracle(ring, trip, times, start):
    """The complex ring integrated from a whirl met at the first of the times."""
    speed, first = shaft(trip), whirl(ring, trip.crossing)

    def rates(t, y):
        d, k = ring(speed(t))
        return [y[1], -d * y[1] - k * y[0]]

    ends = [times[0], *sorted({t for t in (trip.top, trip.back) if times[0] < t < times[-1]}), times[-1]]
    y, out = np.array([1.0, first]) * start, np.empty(len(times), complex)
    for a, b in pairwise(ends):
        found = solve_ivp(rates, (a, b), y, method="DOP853", rtol=1e-11, atol=1e-16, dense_output=True)
        inside = (times >= a) & (times <= b)
        out[inside], y = found.sol(times[inside])[0], found.y[:, -1]
    return out


@pytest.mark.parametrize("rate", RATES)
def test_linear_film_passes_as_the_complex_ring_does(rate):
    """Free whirl of the program (two runs subtracted, forcing and all) against SciPy on one complex equation, held a
    while at the top; and both against what is foretold."""
    run, trip, mode = passage(scenario(), rate, hold=0.01)
    times, tilt = run.free
    assert abs(tilt[0]) == pytest.approx(1e-3 * SCALE, rel=2e-3)
    expected = oracle(stator, trip, times, tilt[0])
    assert tilt / expected == pytest.approx(np.ones(len(times)), abs=3e-4)
    integral, factor = predicted_growth(mode, trip, times)
    assert np.log(np.abs(expected / expected[0])) == pytest.approx(integral + factor - factor[0], abs=5e-3)


@pytest.mark.parametrize("rate", RATES)
def test_growth_is_the_integral_of_the_linear_growth_rate(rate):
    """The issue's 5 %: -0.7 to +0.1 % by the integral of the quadratic's roots alone, 0.1 % with the factor."""
    run, trip, mode = passage(scenario(), rate, kick=3e-4)
    found = measured_growth(mode, trip, run.free, SCALE)
    upto = found["speed"] if found["until"] < trip.top else None
    one_way = quad(lambda w: whirl(stator, w).real, trip.crossing, trip.end, epsrel=1e-10)[0]
    if upto is not None:
        integral = quad(lambda w: whirl(stator, w).real, trip.crossing, upto, epsrel=1e-10)[0] / rate
    else:
        back = quad(lambda w: whirl(stator, w).real, found["speed"], trip.end, epsrel=1e-10)[0]
        integral = (one_way + back) / rate
    assert found["integral"] == pytest.approx(integral, rel=1e-4)
    assert found["measured"] == pytest.approx(integral, rel=0.05)
    assert found["measured"] == pytest.approx(found["with_factor"], rel=2e-3)


@pytest.mark.parametrize("rate", RATES)
def test_growth_in_the_radial_film(rate):
    """With 10 urad of runout and misalignment: within 1.5 %; the rest is the square of the forced tilt."""
    run, trip, mode = passage(scenario(model="radial"), rate)
    found = measured_growth(mode, trip, run.free, SCALE)
    assert trip.crossing == pytest.approx(5588.7, abs=0.1)
    assert found["measured"] > 0.8
    assert abs(found["error"]) < 0.05
    assert abs(found["error_with_factor"]) < 0.015


def test_what_forcing_adds_goes_with_its_square():
    """Growth of a nonlinear film about a forced tilt: 25 urad of runout add 5 %, half of it a quarter as much."""
    errors = []
    for runout in ("0 urad", "12.5 urad", "25 urad"):
        run, trip, mode = passage(scenario("fms_reference", f"rotor.runout={runout}", model="radial"), 20000.0, 3e-4)
        errors.append(measured_growth(mode, trip, run.free, SCALE)["error_with_factor"])
    assert abs(errors[0]) < 2e-3
    assert 0.03 < errors[2] < 0.08
    assert (errors[2] - errors[0]) / (errors[1] - errors[0]) == pytest.approx(4.0, rel=0.15)


@pytest.mark.core
def test_the_factor_of_one_ring_is_a_square_root():
    """(2 lambda + D/I)**(-1/2) of the flexible stator, whose damping does not change with the speed."""
    ready = free_model(scenario().scene, 1000.0)
    mode = tilt_mode(ready, 4000.0, 8000.0, 5890.0)
    speeds = np.linspace(4000.0, 8000.0, 9)
    d = (SUPPORT_D + FILM_D) / INERTIA
    roots = [np.log(abs(2 * whirl(stator, w) + d)) for w in speeds]
    assert mode.gained(4000.0, speeds) == pytest.approx(-0.5 * (np.array(roots) - roots[0]), abs=1e-6)
    assert mode.growth(speeds) == pytest.approx([whirl(stator, w).real for w in speeds], rel=1e-6)
    assert mode.frequency(5890.0) == pytest.approx(whirl(stator, 5890.0).imag, rel=1e-6)


def test_a_flexible_rotor_whose_gyroscopic_term_changes():
    """FMR of c = 3 past its 8684 rad/s: damping changes with the speed as well; oracle and factor both hold."""
    overrides = [f"rotor.polar_inertia={INERTIA / 3}", "stator.misalignment=10 urad", "rotor.misalignment=10 urad"]
    run, trip, mode = passage(scenario("fmr_reference", *overrides), 40000.0)
    assert trip.crossing == pytest.approx(threshold(rotor), rel=1e-8)
    times, tilt = run.free
    expected = oracle(rotor, trip, times, tilt[0])
    assert tilt / expected == pytest.approx(np.ones(len(times)), abs=3e-4)
    k = int(np.searchsorted(times, trip.top))
    integral, factor = predicted_growth(mode, trip, times)
    measured = np.log(np.abs(tilt / tilt[0]))
    assert measured[k] == pytest.approx(integral[k] + factor[k], abs=2e-3)
    assert abs(factor[k]) > 5 * abs(measured[k] - integral[k] - factor[k])


def transmitted(w):
    """Relative tilt of a flexible stator per unit of runout (Green 1989): amplitude and phase to the runout."""
    numerator = SUPPORT_K - INERTIA * w**2 + 1j * w * SUPPORT_D
    return -numerator / (SUPPORT_K + FILM_K - INERTIA * w**2 + 1j * w * (SUPPORT_D + 0.5 * FILM_D))


def swept(rate, begin=1200.0, end=3600.0, per_turn=32, turns=8):
    """Speeds and tracked relative tilt per runout, on the way up and down."""
    asked = scenario("fms_reference", "stator.misalignment=0 rad", "run.accuracy=1e-8")
    run = run_cycle(asked, RampCycle("shaft.speed", begin, end, rate, 0.02, rest=0.01), per_turn)
    number, times, speed, tilt, _ = run.samples
    trip, out = RampCycle("shaft.speed", begin, end, rate, 0.02), []
    for a, b in ((trip.settle, trip.top), (trip.back, trip.home)):
        firsts = centres(*np.searchsorted(times, (a, b)), turns * per_turn, speed, 400)
        middle = firsts + turns * per_turn // 2
        out.append((speed[middle], tracked(tilt, number, per_turn, turns, 1.0, firsts) / 25e-6))
    return out


def test_a_stationary_sweep_is_the_slow_limit():
    """The tracked amplitude and phase tend to Green's steady response as the rate; up and down lie on its two sides."""
    errors, sides = [], []
    for rate in (32000.0, 16000.0, 8000.0, 4000.0):
        (up, found_up), (down, found_down) = swept(rate)
        at = np.linspace(1900.0, 2900.0, 21)
        rise = np.interp(at, up, found_up) - transmitted(at)
        fall = np.interp(at, down[::-1], found_down[::-1]) - transmitted(at)
        errors.append(np.max(np.abs(rise)))
        sides.append(np.max(np.abs(rise + fall)) / np.max(np.abs(rise)))
    orders = np.log2(np.array(errors[:-1]) / errors[1:])
    assert orders == pytest.approx(np.ones(3), abs=0.1), errors
    assert errors[-1] < 5e-3
    # What is even in the rate (window and second order) falls faster than what is odd.
    assert sides[-1] < 0.3 * sides[0] + 0.02, sides
