"""Coulomb friction of a secondary seal in time against what can be worked out on paper."""

import math
from dataclasses import replace

import numpy as np
import pytest
from scenes import CLEARANCE, INERTIA, NOTHING, R_O, SUPPORT, film, fmr, fms, ring, run

from sealdyn.numerics.piecewise_linear import PiecewiseLinear
from sealdyn.scene.excitation import AngularVibration, AxialVibration, Housing
from sealdyn.scene.film import Coefficients
from sealdyn.scene.rings import Rotor, SecondarySeal, Stator
from sealdyn.scene.scene import Initial, RingStart

STIFFNESS, MASS, RADIUS = SUPPORT.axial_stiffness, 1.0, 0.04
UNDAMPED = replace(SUPPORT, axial_damping=0.0)
TILT_K = STIFFNESS * SUPPORT.radius**2 / 2
NATURAL = math.sqrt(STIFFNESS / MASS)
EMPTY = film("linear", coefficients=NOTHING)
# A film that is nothing but a tilt spring: it turns a tilt of the other ring into a moment.
SPRING = 300.0
SPRING_FILM = film("linear", coefficients=Coefficients(tilt_stiffness=SPRING, tilt_damping=0.0, axial_stiffness=1e5,
                                                       axial_damping=0.0))  # fmt: skip


def seal(**given):
    return SecondarySeal(radius=RADIUS, **given)


def holding(moment):
    """A seal whose largest friction moment is this."""
    return seal(line_friction=moment / (4 * RADIUS**2))


# --- one degree of freedom -----------------------------------------------------------------------------


def oscillator(friction, start, turns, method="adams", accuracy=1e-6, **changes):
    scene = fms(film=EMPTY, own=0.0, runout=0.0, initial=Initial(stator=RingStart(z=start)),
                stator=Stator(**ring(support=UNDAMPED),
                              secondary_seal=seal(friction_force=friction, **changes)))  # fmt: skip
    return run(scene, duration=turns * 2 * math.pi / NATURAL, method=method, accuracy=accuracy)


# Measured at accuracy 1e-6: rest within 5e-8 of the clearance for all, stop time within 7e-8 s.
@pytest.mark.parametrize("method", ["adams", "bdf", "ida", "dop853", "radau"])
@pytest.mark.parametrize("start,friction", [(5e-6, 0.31), (-3.3e-6, 0.2)])
def test_coulomb_oscillator_loses_four_f_over_k_a_cycle_and_stops(method, start, friction):
    accuracy = 1e-6
    found = oscillator(friction, start, 6, method, accuracy)
    dead, x, swings = friction / STIFFNESS, start, 0
    while abs(x) > dead:
        x, swings = -math.copysign(abs(x) - 2 * dead, x), swings + 1
    stopped = swings * math.pi / NATURAL
    assert [event["kind"] for event in found.events] == ["stick"]
    assert found.events[0]["time"] == pytest.approx(stopped, abs=accuracy * CLEARANCE * NATURAL * STIFFNESS / friction)
    assert found.q[-1, 0] == pytest.approx(x, abs=accuracy * CLEARANCE)
    assert found.outcome.energy_residual < 10 * accuracy
    # Stuck means stuck: not a bit moves from the stop to the end.
    after = found.times > found.events[0]["time"]
    assert after.sum() > 10 and np.ptp(found.q[after, 0]) == 0.0 and not found.rates[after].any()


@pytest.mark.core
def test_a_ring_at_rest_inside_the_dead_band_stays():
    found = oscillator(2.6, 5e-6, 3)
    assert not found.events and np.ptp(found.q[:, 0]) == 0.0 and found["stator_seal_stuck"].all()


@pytest.mark.parametrize("width", [1e-3, 1e-4, 1e-5])
def test_the_regularised_law_creeps_where_the_seal_sticks(width):
    """Inside the dead band a load of half the friction makes it creep at width/sqrt(3); a real one stays."""
    friction = 5.0
    x = 0.5 * friction / STIFFNESS
    smooth = oscillator(friction, x, 0.1, law="regularised", width=width)
    crept = x - smooth.q[-1, 0]
    assert crept == pytest.approx(width / math.sqrt(3) * smooth.times[-1], rel=0.3)
    assert oscillator(friction, x, 0.1).q[-1, 0] == x


def test_a_shaken_housing_carries_its_ring_until_it_slips():
    """The ring sticks to the housing while m a + k x stays below the friction, and slips above."""
    amplitude, hertz = 2e-6, 60.0
    w = 2 * math.pi * hertz
    # Ring and housing move together, so the spring does not stretch: only inertia pulls.
    needed = MASS * amplitude * w * w
    for factor, kinds in ((1.02, set()), (0.98, {"stick", "slip"})):
        scene = fms(film=EMPTY, own=0.0, runout=0.0,
                    housing=Housing(axial=[AxialVibration(frequency=hertz, displacement=amplitude)]),
                    initial=Initial(stator=RingStart(z=amplitude)),
                    stator=Stator(**ring(support=UNDAMPED),
                                  secondary_seal=seal(friction_force=factor * needed)))  # fmt: skip
        found = run(scene, duration=4 / hertz, accuracy=1e-6)
        assert {event["kind"] for event in found.events} == kinds
        assert found.outcome.energy_residual < 1e-5
        if not kinds:
            assert found.q[:, 0] == pytest.approx(amplitude * np.cos(w * found.times), abs=1e-6 * CLEARANCE)


# --- tilt about a fixed axis ---------------------------------------------------------------------------


@pytest.mark.slow
def test_hysteresis_loop_of_a_slowly_tilted_ring():
    """A slow moment about a fixed axis: the tilt holds until the moment has changed by twice the friction moment, then
    follows it at distance M_f / K; the loop's area is 4 M_f (M - M_f) / K."""
    hertz, tilt = 2.0, 100e-6
    stiffness, moment = TILT_K + SPRING, SPRING * tilt
    friction = 0.3 * moment
    scene = fmr(film=SPRING_FILM, own=0.0, fixed=0.0, speed=0.0,
                housing=Housing(angular=[AngularVibration(frequency=hertz, displacement=tilt)]),
                rotor=Rotor(**ring(support=UNDAMPED), secondary_seal=holding(friction)))  # fmt: skip
    found = run_at_rest(scene, 2 / hertz, 800)
    last = found.times > 1.01 / hertz
    gamma = found.q[last, found.ready.model.unknowns.names.index("rotor_tilt_x")]
    drive = moment * np.cos(2 * np.pi * hertz * found.times[last])
    # Slow: inertia is (2 pi 2 Hz)^2 I / K = 2e-4 of the spring.
    assert np.max(gamma) == pytest.approx((moment - friction) / stiffness, rel=2e-3)
    area = abs(np.trapezoid(np.append(drive, drive[0]), np.append(gamma, gamma[0])))
    assert area == pytest.approx(4 * friction * (moment - friction) / stiffness, rel=1e-2)
    # It holds over half the change 2 M_f of the moment from each turning point, and does not creep.
    stuck = found["rotor_seal_stuck"][last] == 1
    assert stuck.any() and {e["kind"] for e in found.events} == {"stick", "slip"}
    assert np.max(np.abs(np.diff(gamma)[stuck[1:] & stuck[:-1]])) == 0.0
    assert np.ptp(drive[stuck & (gamma > 0.5 * gamma.max())]) == pytest.approx(2 * friction, rel=2e-2)
    assert found.outcome.energy_residual < 1e-5


def run_at_rest(scene, duration, points):
    """A run of a scene whose shaft does not turn."""
    from scenes import Run, Sink, prepared

    from sealdyn.solvers.integrate import solve

    ready = prepared(scene, duration, 1e-6)
    sink = Sink(ready.duration, duration / points)
    return Run(ready, solve(ready, "adams", 1e-6, sink), sink)


# --- under a rotating moment ---------------------------------------------------------------------------


@pytest.mark.parametrize("share", [0.97, 0.5])
def test_a_stator_holds_a_rotating_moment_below_the_limit(share):
    runout, speed = 20e-6, 300.0
    friction = SPRING * runout / share
    scene = fms(film=SPRING_FILM, own=0.0, runout=runout, speed=speed,
                stator=Stator(**ring(), secondary_seal=holding(friction)))  # fmt: skip
    found = run(scene, turns=5)
    assert not found.events and np.ptp(found.q) == 0.0 and found["stator_seal_stuck"].all()


@pytest.mark.parametrize("speed", [300.0, 1500.0])
@pytest.mark.parametrize("share", [1.05, 1.5, 4.0])
def test_a_stator_slips_on_a_circle_above_it(share, speed):
    """|gamma| = sqrt(M^2 - M_f^2) / |K - I w^2|, loss per turn 2 pi |gamma| M_f."""
    runout, stiffness = 20e-6, TILT_K + SPRING
    moment = SPRING * runout
    friction = moment / share
    radius = math.sqrt(moment**2 - friction**2) / abs(stiffness - INERTIA * speed**2)
    scene = fms(film=SPRING_FILM, own=0.0, runout=runout, speed=speed,
                stator=Stator(**ring(support=UNDAMPED), secondary_seal=holding(friction)))  # fmt: skip
    found = run(scene, turns=60, accuracy=1e-6)
    last = found.times > 59 * 2 * math.pi / speed
    assert np.abs(found.tilt("stator")[last]) == pytest.approx(radius, rel=2e-3)
    power = found["stator_seal_moment_x"] * found["stator_tilt_x_rate"]
    power += found["stator_seal_moment_y"] * found["stator_tilt_y_rate"]
    assert -np.mean(power[last]) * 2 * math.pi / speed == pytest.approx(2 * math.pi * radius * friction, rel=2e-3)
    assert found.outcome.energy_residual < 1e-5


@pytest.mark.parametrize("other", [0.0, -400.0, 700.0])
def test_a_spinning_ring_slips_on_a_circle(other):
    """A rotor of spin W under a moment turning at w: q = i (w - W) gamma turns with it, so
    |gamma| = sqrt(M^2 - M_f^2) / |K - I w^2 + J W w|, and the seal burns M_f |w - W| |gamma|."""
    spin, tilt = 500.0, 30e-6
    stiffness, polar = TILT_K + SPRING, INERTIA / 0.5
    moment = SPRING * tilt
    friction = 0.6 * moment
    radius = math.sqrt(moment**2 - friction**2) / abs(stiffness - INERTIA * other**2 + polar * spin * other)
    scene = fmr(film=SPRING_FILM, own=0.0, speed=spin, stator=Stator(misalignment=tilt, speed=other),
                rotor=Rotor(**ring(support=UNDAMPED), secondary_seal=holding(friction)))  # fmt: skip
    found = run(scene, turns=60, accuracy=1e-6)
    last = found.times > 59 * 2 * math.pi / spin
    gamma = found.tilt("rotor")[last]
    assert np.abs(gamma) == pytest.approx(radius, rel=2e-3)
    assert radius < CLEARANCE / R_O
    assert found["rotor_seal_sliding_speed"][last] == pytest.approx(RADIUS * abs(other - spin) * radius, rel=2e-3)
    assert found.outcome.energy_residual < 1e-5


def test_a_spinning_ring_turns_with_a_synchronous_moment():
    """w = W: the seal sees no sliding and holds; the ring stays where it was in its carrier."""
    spin, tilt = 500.0, 30e-6
    friction = 1.5 * SPRING * tilt
    scene = fmr(film=SPRING_FILM, own=0.0, speed=spin, stator=Stator(misalignment=tilt, speed=spin),
                rotor=Rotor(**ring(), secondary_seal=holding(friction)))  # fmt: skip
    found = run(scene, turns=10)
    assert found["rotor_seal_stuck"].all() and np.max(np.abs(found.q)) < 1e-6 * CLEARANCE / R_O


def test_a_stuck_ring_turns_with_its_carrier():
    """A rotor that sticks at a tilt carries it round: gamma = gamma_0 exp(i W t), W constant or running up."""
    tilt = 30e-6
    for speed in (500.0, PiecewiseLinear((0.0, 0.05), (500.0, 900.0))):
        first = speed if isinstance(speed, float) else speed.value[0]
        scene = fmr(film=SPRING_FILM, own=0.0, fixed=0.0, speed=speed,
                    initial=Initial(rotor=RingStart(tilt_x=tilt, tilt_y_rate=first * tilt)),
                    rotor=Rotor(**ring(), secondary_seal=holding(10 * (TILT_K + SPRING) * tilt)))  # fmt: skip
        found = run(scene, duration=0.05, accuracy=1e-7)
        angle = first * found.times if isinstance(speed, float) else 500.0 * found.times + 4000.0 * found.times**2
        assert found["rotor_seal_stuck"].all()
        assert found.tilt("rotor") == pytest.approx(tilt * np.exp(1j * angle), abs=1e-6 * CLEARANCE / R_O)


def test_the_energy_dropped_at_a_capture_is_told():
    """What is lost when a ring is caught is the kinetic energy it had left: below band squared."""
    found = oscillator(0.31, 5e-6, 6)
    (event,) = found.events
    assert 0 < event["value"] <= 0.5 * MASS * found.ready.model.capture_speed**2
    assert found.ready.stick_slip.dropped == event["value"]
