"""Stiff and sudden scenes: the method that crawls or fails beside the ones that survive.

Numbers in comments: measured at accuracy 1e-6 by tests/benchmark/stiff_and_sudden.py, which also draws them.
"""

import math
import sys
from dataclasses import replace
from functools import lru_cache
from pathlib import Path

import numpy as np
import pytest
from scenes import film, fmr, prepared, run, started
from scipy.integrate import quad, solve_ivp

from sealdyn.faces.geometry import TOUCH, regularised_thickness
from sealdyn.scene.rings import Rotor
from sealdyn.scene.scene import Initial, RingStart
from sealdyn.simulation.selection import choose_method

sys.path.insert(0, str(Path(__file__).parents[1] / "benchmark"))
import stiff_and_sudden as measured

IMPLICIT = ("adams", "bdf", "ida", "radau")
# Flat annulus of scenarios/squeeze.toml: F = -D1/h^3 dh/dt (Reynolds' equation, integrated by hand).
C, R_I, R_O, SPRINGS = 1e-5, 0.032, 0.036, 5e6
D1 = 1.5 * math.pi * 0.5e-3 * (R_O**4 - R_I**4 - (R_O**2 - R_I**2) ** 2 / math.log(R_O / R_I))
# Neighbouring runs part as dh/dt grows: from h^3 (C - h) at 1 % to its largest, at three quarters of the clearance.
PARTING = 0.75**3 * 0.25 / (0.01**3 * 0.99)


@lru_cache(maxsize=32)
def by(name, method, accuracy=None):
    return (measured.by_scipy if method.isupper() else measured.by_package)(name, method, accuracy)


# --- who survives, and how right ---------------------------------------------------------------------


# Errors: adams 4e-8, bdf 3e-8, ida 4e-9, radau 3e-10 after the fall; 7e-8, 3e-8, 2e-8, 4e-10 with the impact.
@pytest.mark.parametrize("name", ["pressure_step", "impact"])
@pytest.mark.parametrize("method", IMPLICIT)
def test_survivors_are_right(name, method):
    one = by(name, method)
    assert one.status == "ok"
    assert measured.error(name, method, one) < 1e-6
    assert one.residual < 10 * 1e-6


# PARTING is 1e5: an error near 1 % is that much larger when the ring comes loose.  No method keeps an error of 1e-6
# there (adams 4e-5, bdf 3e-4, ida 2e-4, radau 3e-6).  Asserted: a hundredth of what an error of 1e-6 at the start
# would become.
@pytest.mark.parametrize("method", IMPLICIT)
def test_survivors_of_the_squeeze_are_as_right_as_the_scene_allows(method):
    one = by("squeeze", method)
    assert one.status == "ok"
    assert measured.error("squeeze", method, one) < 0.01 * PARTING * 1e-6
    assert one.residual < 10 * 1e-6


@pytest.mark.parametrize("method", ["adams", "bdf", "ida", "radau"])
@pytest.mark.parametrize("part", [0.02, 0.1, 0.2])
def test_flat_ring_comes_loose_when_reynolds_says(method, part):
    """Time at which the film has grown to a part of the clearance, from the quadrature of D1/h^3 dh/dt = k (C - h)."""
    scenario = measured.scenario("squeeze")
    expected = D1 / SPRINGS * quad(lambda h: 1 / (h**3 * (C - h)), 0.01 * C, part * C, epsrel=1e-12)[0]
    found = run(scenario.scene, accuracy=1e-7, method=method, duration=8.0, per_turn=2.5)
    # Time is close to linear in 1/h^2.
    film = C - found.q[:, 0]
    assert np.interp(-((part * C) ** -2), -(film**-2), found.times) == pytest.approx(expected, rel=1e-5)


# --- who crawls or fails -----------------------------------------------------------------------------


# 100 000 right-hand sides carry DOP853 to 7.8 us and RK45 to 6.9 us of the 8 s (0.7 s of wall time: eight days to go).
# BDF ends with 2066 right-hand sides, with fast-math in the film with 3356.  LSODA takes what the last bits decide:
# 2338 to 10 102 at twelve tolerances that differ in their ninth digit.
@pytest.mark.parametrize("method", ["dop853", "RK45"])
def test_explicit_methods_stick_with_the_flat_ring(method):
    stuck, survivor = by("squeeze", method), by("squeeze", "bdf")
    assert "crawls" in (stuck.status if method.isupper() else stuck.found.outcome.message)
    assert stuck.times[-1] < 1e-5 * survivor.times[-1]
    # About 1e-9 s a step: the stability limit over the film's decay of 6.8e9 per second.
    assert np.diff(stuck.times)[10:].max() < 10 / (D1 / (0.01 * C) ** 3)
    assert survivor.calls < 10_000 and by("squeeze", "LSODA").calls < 30_000


# CVODE's Adams survives at the orders 1 and 2, which are stable however stiff the scene: 11 380 steps and 13 570
# right-hand sides where BDF takes 1198 and 2066.
@pytest.mark.core
def test_adams_pays_for_the_squeeze_with_steps():
    adams, bdf = by("squeeze", "adams"), by("squeeze", "bdf")
    assert adams.steps > 5 * bdf.steps and adams.calls > 4 * bdf.calls


# At a coarse accuracy Adams' undamped decay shows: energy residual 2.3e-2 at accuracy 1e-3; BDF's is 1.9e-5.
def test_audit_exposes_adams_at_coarse_accuracy():
    adams, bdf = by("squeeze", "adams", 1e-3), by("squeeze", "bdf", 1e-3)
    assert adams.residual > 10 * 1e-3 and bdf.residual < 1e-3


# After the fall the film holds DOP853 to 11 us a step, and RK45 to 6 us, until the end: 46 768 and 48 976
# right-hand sides; BDF 913, IDA 1247, Adams 1908.
@pytest.mark.parametrize("method", ["dop853", "RK45"])
def test_explicit_methods_crawl_on_the_closed_film(method):
    crawling, survivor = by("pressure_step", method), by("pressure_step", "bdf")
    assert crawling.status == "ok" and measured.error("pressure_step", method, crawling) < 1e-6
    assert crawling.calls > 10 * survivor.calls
    late = [np.diff(one.times[one.times > 0.03]).max() for one in (crawling, survivor)]
    assert late[0] < 0.2 * late[1]


# --- impact ------------------------------------------------------------------------------------------


# An impact is sudden but not stiff: DOP853 needs 77 steps and 1148 right-hand sides, BDF 712 and 1641.
@pytest.mark.parametrize("method", ["dop853", "RK45"])
def test_explicit_methods_take_an_impact_well(method):
    one = by("impact", method)
    assert one.status == "ok" and measured.error("impact", method, one) < 1e-6
    assert one.steps < by("impact", "bdf").steps


@pytest.mark.parametrize("method", [*IMPLICIT, "dop853"])
def test_film_alone_does_not_stop_the_impact(method):
    """Without [contact] the run ends on the floor with a sentence, with it the ring lifts off."""
    scene = measured.scenario("impact").scene
    fallen = measured.by_package("impact", method, scene=replace(scene, contact=None))
    assert fallen.status == "collapsed"
    said = fallen.found.outcome.message
    assert all(word in said for word in ("film collapsed at t = ", "inner radius 32 mm", "theta = ", "Try "))
    assert fallen.found.times[-1] == pytest.approx(fallen.found.record(0)[1], rel=1e-9)
    stopped, events = by("impact", method).found, []
    stopped.ready.contacts.tell(events.extend, end=(stopped.outcome.tau, stopped.outcome.y))
    assert [event["kind"] for event in events] == ["contact"] and np.isfinite(events[0]["lift_off"])
    assert 0 < stopped.record(0)[0] < stopped.ready.model.face[TOUCH]


def fixed_steps(name, per_point):
    """Classical Runge-Kutta at so many fixed steps a point, what many a home-made simulation does: largest error over
    the scales, or infinity."""
    scenario = measured.scenario(name)
    ready = prepared(scenario.scene, scenario.run.duration, 1e-6)
    segment, n = ready.segment(0), ready.model.unknowns.n
    step, y, rates = ready.duration / measured.POINTS / per_point, ready.y0.copy(), np.zeros((4, segment.size))
    exact, worst = measured.reference(name, "DOP853"), 0.0
    for k in range(measured.POINTS * per_point):
        for stage, part in enumerate((0.0, 0.5, 0.5, 1.0)):
            segment.rhs((k + part) * step, y + part * step * rates[stage - 1], rates[stage])
        y = y + step / 6 * (rates[0] + 2 * rates[1] + 2 * rates[2] + rates[3])
        if not np.isfinite(y).all():
            return math.inf
        if (k + 1) % per_point == 0:
            error = y[:n] / segment.scales[:n] - exact[(k + 1) // per_point]
            worst = max(worst, float(np.max(np.abs(error))))
    return worst


# 105 steps a turn blow up, 209 err by 5e-2 of the clearance, 2094 (8000 right-hand sides) by 2.5e-6.
def test_fixed_steps_do_not_see_the_impact_coming():
    assert fixed_steps("impact", 1) == math.inf
    assert fixed_steps("impact", 2) > 1e-2
    assert fixed_steps("impact", 20) < 1e-5


# --- beyond the other face ---------------------------------------------------------------------------


# 24 of DOP853's 100 001 trial states in the squeeze have h <= 0, the farthest at h = -1e214 m.
def test_trial_states_beyond_the_other_face_do_no_harm():
    one = by("squeeze", "dop853")
    assert one.closed > 0
    assert np.isfinite(one.q).all() and one.found.record(0)[0] > 0.0099 * C


@pytest.mark.parametrize("name", measured.SCENES)
def test_right_hand_side_is_finite_beyond_the_other_face(name):
    scenario = measured.scenario(name)
    ready = prepared(scenario.scene, scenario.run.duration, 1e-6)
    rates = np.empty(ready.model.unknowns.size)
    for k in range(len(ready.intervals)):
        segment = ready.segment(k)
        for beyond in (1 - 1e-12, 1.0, 1 + 1e-12, 1.5, 10.0, 1e6):
            for speed in (-1.0, 0.0, 1.0):
                y = ready.y0.copy()
                y[0], y[ready.model.unknowns.rate_places[0]] = beyond * ready.model.clearance, speed
                segment.rhs(0.0, y, rates)
                assert np.isfinite(rates).all(), (beyond, speed)


def thrown(thickness, method, **tolerances):
    """A flat ring of 1 kg thrown down at 1 m/s under 5 kN, its film D1/h^3 with `thickness(h)` for h, for 10 ms."""
    beyond = [0, 0]

    def rates(t, y):
        beyond[0] += 1
        beyond[1] += y[0] <= 0
        if beyond[0] > 20_000:
            raise RuntimeError("crawls")
        return [y[1], -5000.0 - D1 / thickness(y[0]) ** 3 * y[1]]

    return solve_ivp(rates, (0.0, 0.01), [C, -1.0], method, **tolerances), beyond[1]


# RK45 at its default tolerances goes through to h = -0.26 m in four steps and calls it a success; with the film
# continued below a floor it crawls, and says so.  Radau passes 6 trial states with h <= 0 and is right: 0.259 um.
@pytest.mark.core
def test_a_raw_film_lets_the_faces_through_silently():
    through, _ = thrown(lambda h: h, "RK45")
    assert through.success and through.y[0, -1] < -0.1
    with pytest.raises(RuntimeError, match="crawls"):
        thrown(lambda h: regularised_thickness(h, 1e-3 * C), "RK45")
    right, beyond = thrown(lambda h: regularised_thickness(h, 1e-3 * C), "Radau")
    assert right.success and beyond > 0 and right.y[0].min() > 0
    # Momentum, exactly: F t + m v = D1/2 (1/h^2 - 1/C^2), once the ring is slow.
    assert right.y[0, -1] == pytest.approx((1 / C**2 + 2 * (5000.0 * 0.01 + 1.0) / D1) ** -0.5, rel=1e-3)


# A film of its mean thickness passes h = 0 without a pole: every method brings the ring back, 3.3 um beyond the face.
@pytest.mark.parametrize("method", ["RK45", "DOP853", "Radau", "BDF", "LSODA"])
def test_a_film_of_mean_thickness_lets_the_faces_through_and_looks_fine(method):
    wide, width, middle, stiffness, viscosity = 2.5e-5, 0.008, 0.036, 1.2e7, 0.5e-3

    def rates(t, y):
        damping = 2 * math.pi * middle * viscosity * width**3 / (y[0] + wide / 2) ** 3
        return [y[1], -stiffness * (y[0] - C) - damping * y[1]]

    ring = solve_ivp(rates, (0.0, 0.01), [C, -0.3], method, rtol=1e-6, atol=1e-12)
    assert ring.success and ring.y[0].min() < -3e-6
    assert ring.y[0, -1] == pytest.approx(C, rel=1e-6)


@pytest.mark.parametrize("method", [*IMPLICIT, "dop853"])
def test_the_same_throw_ends_collapsed(method):
    scene = fmr(own=0.0, fixed=0.0, film=film(), initial=Initial(rotor=RingStart(z_rate=0.3)))
    found = run(scene, turns=1, method=method, per_turn=16)
    assert found.outcome.status == "collapsed" and "film collapsed at t = " in found.outcome.message
    assert found["h_min"][-1] == pytest.approx(1e-3 * C, rel=1e-6)


# --- the choice --------------------------------------------------------------------------------------


# Decay over motion of interest: 40 at the design clearance of the pressure step but 408 after the fall; 4.6 at the
# design clearance of the squeeze but 4.8 million where it starts.
@pytest.mark.parametrize(
    "name, survivor",
    [
        ("pressure_step", "bdf"),
        ("squeeze", "bdf"),
        ("impact", "adams"),
    ],
)
def test_auto_chooses_the_survivor(name, survivor):
    scenario = measured.scenario(name)
    ready = prepared(scenario.scene, scenario.run.duration, scenario.run.accuracy)
    assert choose_method(ready)[0] == survivor


def test_massless_ring_takes_ida_and_is_as_right():
    scene = measured.scenario("squeeze").scene
    light = replace(scene, rotor=Rotor(support=scene.rotor.support))
    assert choose_method(started(light, 8.0))[0] == "ida"
    found = run(light, method="ida", duration=8.0, per_turn=2.5)
    exact = by("squeeze", "ida").q
    assert found.outcome.status == "ok"
    assert abs(found.q[-1, 0] / C - exact[-1, 0]) < 1e-6
