"""Supports of two tilt stiffnesses, a centre of mass off the axis, and weight: runs and exponents against the complex
equations, written out here, by Floquet's theory and in closed form."""

import math
from dataclasses import replace

import numpy as np
import pytest
from scenes import GIVEN, INERTIA, SPEED, film, prepared, ring, started
from scipy.integrate import solve_ivp

from sealdyn.dynamics.modes import verdict
from sealdyn.scenario.tables import Run
from sealdyn.scene.checks import scene_errors, unused
from sealdyn.scene.excitation import Housing, Shaft
from sealdyn.scene.film import Coefficients
from sealdyn.scene.patterns import tilt_is_imposed
from sealdyn.scene.rings import MassCentre, Rotor, Stator, Support
from sealdyn.scene.scene import Scene, SceneError, uneven_supports
from sealdyn.solvers.contract import Recorder
from sealdyn.solvers.integrate import solve
from sealdyn.studies.transmissibility.arrangements import seals_of

K_F, D_F, K_FZ, D_FZ = GIVEN
D_S, AXIS, OWN, FIXED = 0.24, 0.3, 25e-6, 40e-6
ARM, OFF, PHASE, GRAVITY = 6e-3, 20e-6, 0.7, 9.81
CENTRE = MassCentre(axial=ARM, eccentricity=OFF, phase=PHASE)


def support(*stiffness, damping=D_S, axis=AXIS):
    return Support(axial_stiffness=5e5, axial_damping=300.0, tilt_stiffness=stiffness, tilt_damping=damping,
                   tilt_axis=axis)  # fmt: skip


def seal(rotor=None, stator=None, speed=SPEED, given=GIVEN, c=3.0, centre=CENTRE):
    """A seal on a film of given numbers, a floating ring on the `rotor` or `stator` support that is given."""
    rotor = Rotor(**ring(c, support=rotor, mass_centre=centre), misalignment=OWN) if rotor else Rotor(runout=OWN)
    floats = ring(c, support=stator, mass_centre=centre) if stator else {}
    return Scene(
        shaft=Shaft(speed=speed), film=film("linear", coefficients=Coefficients(*given)), rotor=rotor,
        stator=Stator(**floats, misalignment=FIXED), housing=Housing(gravity=GRAVITY),
    )  # fmt: skip


def rotor_rates(t, y, mean, half, w=SPEED, c=3.0):
    """Right-hand side for gamma = y[0] + i y[1] and its rate, of a floating rotor over a fixed stator."""
    g, v = y[0] + 1j * y[1], y[2] + 1j * y[3]
    turned = np.exp(1j * w * t)
    e = g - OWN * turned
    moment = -mean * e - half * (turned * np.exp(1j * AXIS)) ** 2 * e.conjugate() - D_S * (v - 1j * w * g)
    moment -= K_F * (g - FIXED) + D_F * (v - 0.5j * w * (g - FIXED))
    moment += 1j * INERTIA / c * w * v
    # A force across the shaft, of size f and direction d, on the arm a: r x F = i a f exp(i d).
    moment += 1j * ARM * (OFF * w**2 * turned * np.exp(1j * PHASE) - 1j * GRAVITY)
    a = moment / INERTIA
    return [v.real, v.imag, a.real, a.imag]


def end_of(run, method="adams"):
    sink = Recorder()
    outcome = solve(run, method, run.model.accuracy, sink)
    return outcome, run.last[2][: run.model.unknowns.n]


def test_a_rotor_on_two_pins_moves_as_its_equation_says():
    """Unbalance, weight and two stiffnesses; and energy, for which turning the axes does work."""
    duration = 3.1 * 2 * math.pi / SPEED
    run = prepared(seal(support(900.0, 100.0)), duration, 1e-9)
    outcome, q = end_of(run)
    at = run.model.unknowns.names.index("rotor_tilt_x")
    own = solve_ivp(rotor_rates, (0, duration), np.zeros(4), "DOP853", rtol=1e-12, atol=1e-18, args=(500.0, 400.0))
    assert q[at : at + 2] == pytest.approx(own.y[:2, -1], rel=1e-7, abs=1e-13)
    assert outcome.energy_residual < 1e-8


def test_the_steady_response_is_where_the_equation_stays():
    """Harmonic balance: mean, once and twice a turn; here by the equation alone over a turn."""
    run = started(seal(support(900.0, 100.0)), 2 * math.pi / SPEED, 1e-9)
    at = run.model.unknowns.names.index("rotor_tilt_x")
    places = [at, at + 1, *run.model.unknowns.rate_places[at : at + 2]]
    start = run.steady_start()[places]
    own = solve_ivp(rotor_rates, (0, run.duration), start, "DOP853", rtol=1e-12, atol=1e-18, args=(500.0, 400.0))
    scale = np.max(np.abs(own.y), axis=1)
    assert np.max(np.abs(own.y[:, -1] - start) / scale) < 1e-9
    answers = run.model.segment().steady_motion()[1]
    assert {abs(round(h.frequency / SPEED)) for h, q in answers if np.max(np.abs(q)) > 1e-12} == {0, 1, 2}


def frame(w, mean, c, given=GIVEN, damping=D_S):
    """Polynomial of the rotor's tilt in the frame that turns with it."""
    k, d = given[:2]
    polar = INERTIA / c
    return np.array([INERTIA, damping + d + 1j * w * (2 * INERTIA - polar),
                     mean + k + (polar - INERTIA) * w**2 + 0.5j * w * d])  # fmt: skip


def tilt_rates(linear):
    return sorted({round(m.value.real, 6) for m in linear.modes() if m.kind == "tilt"})


@pytest.mark.parametrize("speed", [300.0, 2600.0])
def test_exponents_are_roots_in_the_turning_frame(speed):
    linear = started(seal(support(900.0, 100.0), speed=speed), 0.1).model.linear_scene()
    p = frame(speed, 500.0, 3.0)
    whole = np.polymul(p, p.conj())
    whole[-1] -= 400.0**2
    assert tilt_rates(linear) == pytest.approx(sorted({round(r, 6) for r in np.roots(whole).real}), rel=1e-8)


@pytest.mark.parametrize("speed", [600.0, 800.0])
def test_a_whirl_locked_to_the_shaft_grows_beyond_the_closed_form(speed):
    """The region of a turning, uneven support: half difference above |K + (J - I) w^2 + i w D_f/2|."""
    given = 0.0, 0.02, K_FZ, D_FZ
    limit = abs(np.polyval(frame(speed, 500.0, 10.0, given), 0.0))
    assert limit < 400.0
    for share, expected in ((0.99, "stable"), (1.01, "unstable")):
        stiffness = 500.0 + share * limit, 500.0 - share * limit
        linear = started(seal(support(*stiffness), speed=speed, given=given, c=10.0), 0.1).model.linear_scene()
        assert verdict(linear.modes()) == expected


def two_rings(t, y, w, uneven, weights):
    """As rotor_rates, of both rings, free: y the tilts and rates of stator and rotor as four complex numbers."""
    s, r, v_s, v_r = y
    (k, half), (k_t, half_t) = uneven
    k_f, d_f = weights
    push = k_f * (s - r) + d_f * (v_s - v_r - 0.5j * w * (s - r))
    twice = np.exp(2j * (w * t + AXIS))
    a_s = -push - k * s - half * np.exp(2j * AXIS) * s.conj() - D_S * v_s
    a_r = push - k_t * r - half_t * twice * r.conj() - D_S * (v_r - 1j * w * r) + 1j * INERTIA / 3 * w * v_r
    return np.array([v_s, v_r, a_s / INERTIA, a_r / INERTIA])


@pytest.mark.parametrize("speed", [700.0, 1100.0])
def test_two_uneven_supports_grow_as_floquet_says(speed):
    """Stator on pins that stand, rotor on pins that turn: no frame knows constants, Hill's method does not need one."""
    uneven, given = ((500.0, 300.0), (450.0, 350.0)), (900.0, 0.05, K_FZ, D_FZ)
    scene = seal(support(800.0, 100.0), support(800.0, 200.0), speed, given)
    linear = started(scene, 0.1).model.linear_scene()
    period, n = math.pi / speed, 8

    def rates(t, y):
        parts = y.reshape(4, 2, n)
        return np.array([[f.real, f.imag] for f in two_rings(t, parts[:, 0] + 1j * parts[:, 1], speed, uneven,
                                                             given[:2])]).ravel()  # fmt: skip

    found = solve_ivp(rates, (0, period), np.eye(n).ravel(), "DOP853", rtol=1e-12, atol=1e-15)
    multipliers = np.linalg.eigvals(found.y[:, -1].reshape(n, n))
    expected = np.log(np.abs(multipliers)) / period
    found = [m.value.real for m in linear.modes() if m.kind == "tilt"]
    assert max(found) == pytest.approx(max(expected), rel=1e-6)
    for rate in expected:
        assert min(abs(rate - f) for f in found) < 1e-6 * max(abs(expected))


def test_pins_that_stand_are_a_matrix():
    """A floating stator: the roots of two constant stiffnesses, about the axes at which they are given."""
    linear = started(seal(stator=support(900.0, 100.0)), 0.1).model.linear_scene()
    s, _ = linear.eigen()
    at = np.exp(2j * AXIS)
    for value in s:
        if abs(value.imag) > 0 and min(abs(value - m.value) for m in linear.modes() if m.kind == "tilt") < 1.0:
            wedge = 0.5 * SPEED * D_F
            own = INERTIA * value**2 + (D_S + D_F) * value + K_F + 500.0
            k = 400.0 * np.array([[at.real, at.imag], [at.imag, -at.real]])
            whole = own * np.eye(2) + k + wedge * np.array([[0, 1], [-1, 0]])
            assert abs(np.linalg.det(whole)) < 1e-8 * abs(own) ** 2 + 1e-6 * K_F**2


def test_equal_stiffnesses_are_one():
    scene = seal(support(500.0, 500.0))
    even = seal(replace(support(500.0), tilt_stiffness=500.0))
    assert not uneven_supports(scene)
    values = [started(s, 0.1).model.linear_scene().modes() for s in (scene, even)]
    assert [m.value for m in values[0]] == [m.value for m in values[1]]


def test_a_study_of_one_stiffness_refuses_two():
    with pytest.raises(SceneError) as found:
        seals_of(seal(support(900.0, 100.0)))
    assert found.value.key == "rotor.support.tilt_stiffness"
    linear = started(seal(support(900.0, 100.0)), 0.1).model.linear_scene()
    for ask in (linear.pencil, linear.state_matrix):
        with pytest.raises(SceneError):
            ask()


@pytest.mark.parametrize(
    ("change", "key"),
    [
        ({"support": support(900.0, 100.0, 50.0)}, "rotor.support.tilt_stiffness"),
        ({"support": support(900.0, -1.0)}, "rotor.support.tilt_stiffness"),
        ({"mass": 0.0, "transverse_inertia": 0.0, "polar_inertia": 0.0}, "rotor.mass_centre"),
    ],
)
def test_what_cannot_be_is_refused(change, key):
    scene = seal(support(500.0))
    scene = replace(scene, rotor=replace(scene.rotor, **change))
    assert [error.key for error in scene_errors(scene, Run(turns=1))] == [key]


def test_gravity_needs_a_ring_that_feels_it():
    given = {"housing.gravity", "housing.gravity_direction", "rotor.support.tilt_axis"}
    assert unused(seal(support(500.0, 500.0)), given) == ["rotor.support.tilt_axis"]
    assert unused(seal(support(900.0, 100.0), centre=None), given) == ["housing.gravity", "housing.gravity_direction"]


def test_weight_or_unbalance_alone_tilts_a_ring():
    scene = seal(support(500.0, 500.0))
    scene = replace(scene, rotor=replace(scene.rotor, misalignment=0.0), stator=Stator(), housing=Housing())
    still = replace(scene, rotor=replace(scene.rotor, mass_centre=replace(CENTRE, eccentricity=0.0)))
    assert tilt_is_imposed(scene) and not tilt_is_imposed(still)
    assert tilt_is_imposed(replace(still, housing=Housing(gravity=GRAVITY)))
