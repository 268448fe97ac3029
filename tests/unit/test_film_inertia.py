"""Centrifugal inertia of the film: its push from the radial momentum of Couette flow, force, moment, leakage, torque
and floored pressures by other means, and where the rest of the program has to know it."""

from dataclasses import replace

import pytest
import test_film_radial
from numpy.polynomial import Polynomial
from oracles import floored_wrench, radial_wrench
from scenes import CLEARANCE, R_I, R_O, SPEED, film, fms, started
from test_film_radial import CONVERGING, DIVERGING, FACES, MU, P_I, P_O, deviation, face_of, gap_state, kernel

from sealdyn.dynamics.model import Model
from sealdyn.faces import geometry
from sealdyn.films import film_named, film_names
from sealdyn.films._radial_quadrature import centrifugal
from sealdyn.films.profiled import film as profiled
from sealdyn.films.radial import film as radial
from sealdyn.films.radial import floored
from sealdyn.numerics.piecewise_linear import PiecewiseLinear
from sealdyn.scene.film import Profile
from sealdyn.scene.scene import Closing, SceneError
from sealdyn.simulation.selection import select_film

DENSITY = 870.0
SPINS = [(0.0, SPEED), (SPEED, 0.0), (SPEED, SPEED), (-0.7 * SPEED, SPEED), (3.0 * SPEED, -0.4 * SPEED)]


def push_of(w_s, w_r):
    """p'/r (Pa/m^2) that lets no fluid flow outwards: radial momentum over the film, height by height, no slip."""
    turning = (Polynomial([w_s, w_r - w_s])) ** 2 * DENSITY

    # mu u'' = p' - rho W^2 r in y = z/h, u(0) = u(1) = 0, int u dy = 0: linear in p', so two flows decide.
    def flow(slope):
        bend = (Polynomial([slope]) - turning).integ(2)
        line = bend - Polynomial([0.0, bend(1.0)])
        return line.integ()(1.0)

    size = DENSITY * max(w_s**2, w_r**2)
    return -size * flow(0.0) / (flow(size) - flow(0.0))


def block(coning=CONVERGING, geometry="cylindrical", tilt_radius="local", error=1e-13, **more):
    module = radial if more.get("cavitation_pressure") is None else floored
    table = film(coning=coning, geometry=geometry, tilt_radius=tilt_radius, density=DENSITY, inertia=True, **more)
    return module.parameters(table, CLEARANCE, error)


def spun_state(face, share, seed, w_s, w_r, **more):
    return test_film_radial.random_state(face, share, seed, mean_spin=0.5 * (w_s + w_r), **more)


@pytest.mark.core
@pytest.mark.parametrize(("w_s", "w_r"), SPINS)
def test_the_push_is_that_of_the_radial_momentum_of_couette_flow(w_s, w_r):
    s = gap_state([0.0] * 6 + [0.5 * (w_s + w_r), MU, P_I, P_O], w_r - w_s)
    assert centrifugal(block(), s) == pytest.approx(push_of(w_s, w_r), rel=1e-12)
    assert centrifugal(block(), s) == pytest.approx(DENSITY * (3 * w_s**2 + 4 * w_s * w_r + 3 * w_r**2) / 10, rel=1e-12)


@pytest.mark.parametrize(("coning", "geometry", "tilt_radius"), FACES)
def test_wrench_leakage_and_torque_against_shooting(coning, geometry, tilt_radius):
    w_s, w_r = -0.7 * SPEED, 2.0 * SPEED
    face = face_of(coning, geometry, tilt_radius)
    state = spun_state(face, 0.3, 7, w_s, w_r)
    force, moment, inner, outer, couette, turned = radial_wrench(face, state, 384, push_of(w_s, w_r))
    found = kernel(block(coning, geometry, tilt_radius), state, w_r - w_s)
    assert deviation(found, (force, moment)) < 1e-11
    assert found[2:4] == pytest.approx((inner, outer), rel=1e-10)
    assert found[4] == pytest.approx(MU * (w_r - w_s) * couette - 0.5 * turned, rel=1e-10)
    # And it matters.
    plain = kernel(radial.parameters(film(coning=coning, geometry=geometry, tilt_radius=tilt_radius), CLEARANCE), state)
    assert deviation(plain, (force, moment)) > 1e-3


@pytest.mark.parametrize(("coning", "geometry", "tilt_radius"), FACES)
def test_floored_pressures_against_a_dense_grid(coning, geometry, tilt_radius):
    """The fluid is thrown outwards: the dry part is not where it is without inertia."""
    w_s, w_r = 0.0, 3.0 * SPEED
    face = face_of(coning, geometry, tilt_radius)
    for pressures, seed in (((0.0, 5e5), 11), ((3e5, 1e5), 12)):
        state = spun_state(face, 0.3, seed, w_s, w_r, pressures=pressures, squeeze=3.0)
        expected = floored_wrench(face, state, 0.0, 2000, 401, push_of(w_s, w_r))
        found = kernel(block(coning, geometry, tilt_radius, error=1e-9, cavitation_pressure=0.0), state, w_r - w_s)
        assert apart(found, expected) < 3e-5
        still = radial_floored(coning, geometry, tilt_radius, state)
        assert apart(still, expected) > 1e-3


def apart(found, expected):
    """Of force and moment, relative to the force (never below a bar on the face)."""
    size = max(expected[0], 1e5 * test_film_radial.AREA)
    return max(abs(found[0] - expected[0]), abs(found[1] - expected[1]) / R_O) / size


def radial_floored(coning, geometry, tilt_radius, state):
    table = film(coning=coning, geometry=geometry, tilt_radius=tilt_radius, cavitation_pressure=0.0)
    return kernel(floored.parameters(table, CLEARANCE, 1e-9), state)


def test_a_line_thrown_dry_inside_the_face():
    """Faces at rest against each other's tilt, both edges above the floor: spin alone empties the inside, and what is
    left is a parabola in r^2 over 1/h^3, here by the dense grid too."""
    face, (w_s, w_r) = face_of(test_film_radial.FLAT), (0.0, 12.0 * SPEED)
    state = [0.0] * 6 + [0.5 * (w_s + w_r), MU, 1e5, 1e5]
    s = gap_state(state, w_r - w_s)
    floored.flow(block(test_film_radial.FLAT, error=1e-9, cavitation_pressure=0.0), s)
    expected, _ = floored_wrench(face, state, 0.0, 8, 200_001, push_of(w_s, w_r))
    assert s[geometry.FORCE] == pytest.approx(expected, rel=1e-8)
    assert 0.3 < s[geometry.CAVITATED] < 0.95


@pytest.mark.parametrize("tilt_radius", ["local", "mean"])
@pytest.mark.parametrize("shape", ["cylindrical", "planar"])
@pytest.mark.parametrize("coning", [CONVERGING, DIVERGING])
def test_a_cone_as_a_profile_is_the_same(coning, shape, tilt_radius):
    state = spun_state(face_of(coning, shape, tilt_radius), 0.3, 5, 0.0, SPEED)
    middle = 0.036
    cone = Profile((R_I, middle, R_O), (0.0, coning * (middle - R_I), coning * (R_O - R_I)))
    table = film(coning=0.0, profile=cone, geometry=shape, tilt_radius=tilt_radius, density=DENSITY, inertia=True)
    f = profiled.parameters(table, CLEARANCE, 1e-13)
    s = gap_state(state)
    profiled.flow(f, s)
    force, moment, inner, outer, torque = kernel(block(coning, shape, tilt_radius), state)
    assert s[geometry.FORCE] == pytest.approx(force, rel=1e-11)
    assert abs(complex(s[geometry.MOMENT_X], s[geometry.MOMENT_Y]) - moment) < 1e-11 * abs(moment)
    found = s[[geometry.FLOW_INNER, geometry.FLOW_OUTER, geometry.TORQUE]]
    assert found == pytest.approx((inner, outer, torque), rel=1e-10)


def heavy(**changes):
    return film("radial", density=1000.0, inertia=True, **changes)


@pytest.mark.parametrize("changes", [{}, {"cavitation_pressure": 0.0}], ids=["full", "floored"])
def test_the_seal_is_in_balance_where_it_stands(changes):
    """Closing force, equilibrium and the run's own film agree, with the stator turning too."""
    given = heavy(clearance=None, outer_pressure=6e5, inner_pressure=1e5, **changes)
    scene = fms(film=given, closing=Closing(0.8, 40.0), own=0.0, runout=0.0)
    for speed in (0.0, -800.0):
        model = Model(replace(scene, stator=replace(scene.stator, speed=speed)), 1e-8)
        assert model.axial_shift() == pytest.approx(0.0, abs=1e-9 * model.clearance)
        still = Model(replace(scene, film=replace(given, inertia=False)), 1e-8)
        assert model.clearance != pytest.approx(still.clearance, rel=1e-3)


def test_another_speed_is_another_film():
    """Matrices at another speed are those of the scene at that speed, and a run-up moves the gap."""
    scene = fms(film=heavy(), own=0.0, runout=0.0)
    model = Model(scene, 1e-8)
    still, fast = Model(replace(scene, film=replace(scene.film, inertia=False)), 1e-8), model.linear_scene(speed=1500.0)
    # What it throws outwards is missing inside.
    assert model.closing_force() < still.closing_force() - 30.0
    assert fast.film_k[1, 1] != pytest.approx(model.linear_scene().film_k[1, 1], rel=1e-2)
    ramp = PiecewiseLinear((0.0, 0.01, 0.02), (SPEED, SPEED, 1500.0))
    ready = started(replace(scene, shaft=replace(scene.shaft, speed=ramp)), 0.03)
    last = ready.segment(len(ready.intervals) - 1)
    here = ready.model.linear_scene(last.interval)
    assert here.film_k == pytest.approx(fast.film_k, rel=1e-6, abs=1e-6 * abs(fast.film_k[0, 0]))
    assert abs(ready.model.axial_shift(last.interval)) > 1e-3 * CLEARANCE


def test_a_linear_film_has_no_inertia():
    table = replace(heavy(), model="auto")
    assert film_names(table) == ["radial"] and film_named("linear").accepts(table)
    with pytest.raises(SceneError):
        Model(fms(film=replace(table, model="linear")))
    run, error = select_film(fms(film=table), type("Run", (), {"accuracy": 1e-4, "duration": 0.01})(), lambda run: None)
    assert run.model.interface.name == "radial" and error is None
