"""Circular whirls against eigenvalues at small amplitude, and against an integrator that knows nothing of them."""

import math

import numpy as np
import pytest
from scenes import fmr, fms, fmsr, rates_of
from scipy.integrate import solve_ivp

from sealdyn.analysis.rotating_wave import RotatingWave, branch, contact_tilt_aligned, free_model
from sealdyn.dynamics.stability_thresholds import one_by_one, thresholds

SEALS = {"fms": fms(), "fmr": fmr(c=3.0), "fmsr": fmsr()}


@pytest.fixture(scope="module", params=SEALS)
def family(request):
    scene = SEALS[request.param]
    model = free_model(scene, 1000.0)
    threshold = thresholds(one_by_one(lambda w: model.linear_scene(speed=w)), 1e2, 1e5)[0]
    model = free_model(scene, threshold, accuracy=1e-10)
    return request.param, scene, threshold, model, branch(model, threshold)


@pytest.mark.core
def test_leaves_the_threshold_with_the_square_of_the_amplitude(family):
    name, _, threshold, model, whirls = family
    least_damped = max((m for m in model.linear_scene().modes() if m.kind == "tilt"), key=lambda m: m.value.real)
    assert whirls[0].frequency == pytest.approx(least_damped.value.imag, rel=1e-3)
    shift = [(w.speed - threshold) / w.amplitude**2 for w in whirls[1:4]]
    assert shift == pytest.approx([shift[0]] * 3, rel=0.02)
    assert (shift[0] > 0) == (name == "fmr")
    # Exchange of stability: a falling family is unstable, a rising one stable.
    assert all((w.growth < 0) == (name == "fmr") for w in whirls)


def test_ends_at_contact(family):
    _, _, _, model, whirls = family
    last = whirls[-1]
    assert last.h_min == pytest.approx(model.face[4], rel=1e-6)
    assert all(w.h_min > last.h_min for w in whirls[:-1])
    # It opens the gap on its way: the tilt goes beyond that which closes an unopened one.
    assert last.amplitude > 1.3 * contact_tilt_aligned(model)


@pytest.mark.parametrize("place", [8, 24, 40])
def test_another_integrator_stays_on_the_whirl(family, place):
    _, scene, _, _, whirls = family
    whirl = whirls[place]
    model = free_model(scene, whirl.speed, accuracy=1e-10)
    rhs, end = rates_of(model.segment()), 3 * 2 * math.pi / whirl.frequency
    absolute = 1e-12 * model.scales
    found = solve_ivp(rhs, (0, end), whirl.y, method="DOP853", rtol=1e-11, atol=absolute).y[: model.unknowns.n, -1]
    # Whole turns later it is back where it was.
    assert found == pytest.approx(whirl.q, abs=1e-7 * np.max(np.abs(whirl.q)))


@pytest.mark.slow
def test_departs_at_the_growth_rate_stated(family):
    """A nudge of a thousandth grows or dies as the linearisation in the turning frame says, not as at rest."""
    _, scene, _, _, whirls = family
    whirl = whirls[30]
    model = free_model(scene, whirl.speed, accuracy=1e-10)
    whirling, rhs = RotatingWave(model), rates_of(model.segment())
    start = whirling.state(whirl.q * 1.001, whirl.frequency)
    times = np.linspace(0.6, 1.6, 60) / abs(whirl.growth)
    found = solve_ivp(rhs, (0, times[-1]), start, method="DOP853", t_eval=times, rtol=1e-10, atol=1e-11 * model.scales)
    apart = np.abs(whirling.relative(found.y[: model.unknowns.n])) / whirl.amplitude - 1
    rate = np.polyfit(times, np.log(np.abs(apart)), 1)[0]
    assert rate == pytest.approx(whirl.growth, rel=0.03)
