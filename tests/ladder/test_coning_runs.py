"""Runs whose coning follows time, speed and temperature, against the axial equation solved in words of its own, and
against the scene that has the other coning from the start."""

from dataclasses import replace

import numpy as np
import pytest
from scenes import CLEARANCE, R_I, R_O, film, fmr, fms
from scipy.integrate import solve_ivp

from sealdyn.dynamics.model import Model
from sealdyn.dynamics.run_state import RunState
from sealdyn.dynamics.signals import signals
from sealdyn.faces.geometry import DZ
from sealdyn.numerics.piecewise_linear import PiecewiseLinear
from sealdyn.scene.excitation import Shaft
from sealdyn.scene.forces import Contact
from sealdyn.simulation.selection import choose_method
from sealdyn.solvers.contract import Recorder, Status
from sealdyn.solvers.integrate import solve

MU, P_I, P_O, CONING = 0.5e-3, 1e5, 6e5, 3.125e-3
RAMP = PiecewiseLinear((0.002, 0.006, 0.010), (200.0, 1200.0, 700.0))


def followed(scene, duration, accuracy=1e-7, samples=200):
    """Times (s), gap (m) and series of a run."""
    run = RunState(Model(scene, accuracy), duration)
    recorder = Recorder(duration / samples)
    outcome = solve(run, choose_method(run)[0], accuracy, recorder)
    t, q, rate = recorder.arrays()
    parts = [
        (leg, (t >= leg.time - 1e-15) & (t <= leg.time + leg.length + 1e-15))
        for leg in (run.segment(k) for k in range(len(run.intervals)))
    ]
    seen = [signals(leg, t[at] - leg.time, q[at], rate[at]) for leg, at in parts]
    return run, outcome, t, q, {name: np.concatenate([s[name] for s in seen]) for name in seen[0]}


def axial(**law):
    """Green's rotor on a film whose cone opens, faces square."""
    table = film(outer_pressure=P_O, inner_pressure=P_I, geometry="planar", **law)
    return replace(fmr(film=table, own=0.0, fixed=0.0), shaft=Shaft(speed=RAMP))


def planar_force(gap, gap_rate, coning, rate, points=401):
    """Opening force (N) of an aligned planar cone: h^3 p' = 12 mu (int h' dr + c), Simpson's rule."""
    r = np.linspace(R_I, R_O, points)
    step, d = r[1] - r[0], r - R_I
    h = gap + coning * d
    driven = gap_rate * d + 0.5 * rate * d * d
    weights = np.ones(points)
    weights[1:-1:2], weights[2:-1:2] = 4.0, 2.0
    weights *= step / 3.0
    c = ((P_O - P_I) / (12.0 * MU) - weights @ (driven / h**3)) / (weights @ h**-3.0)
    slope = 12.0 * MU * (driven + c) / h**3
    # Of p r over the face by parts.
    return np.pi * (P_O * R_O**2 - P_I * R_I**2) - np.pi * (weights @ (slope * r * r))


@pytest.mark.parametrize("law", ["speed", "time"])
def test_the_gap_follows_the_cone_as_the_axial_equation_says(law):
    if law == "speed":
        scene = axial(coning=CONING, coning_per_speed_squared=1.5e-9)
    else:
        scene = axial(coning=PiecewiseLinear((0.002, 0.006, 0.010), (CONING, CONING + 2.1e-3, CONING + 0.7e-3)))
    run, outcome, t, q, seen = followed(scene, 0.014)
    assert outcome.status == Status.OK
    closing, support = run.model.closing_force(), scene.rotor.support

    def cone(time):
        at, before = (RAMP.at(x) for x in (time, time - 1e-9))
        if law == "speed":
            return CONING + 1.5e-9 * at**2, 1.5e-9 * (at**2 - before**2) / 1e-9
        return scene.film.coning.at(time), (scene.film.coning.at(time) - scene.film.coning.at(time - 1e-9)) / 1e-9

    def rates(time, y):
        z, v = y
        # The rotor's displacement closes the gap.
        force = closing - planar_force(CLEARANCE - z, -v, *cone(time))
        return [v, (force - support.axial_stiffness * z - support.axial_damping * v) / scene.rotor.mass]

    expected, y, begin = np.empty(len(t)), [0.0, 0.0], 0.0
    for end in (0.002, 0.006, 0.010, 0.014):
        at = (t >= begin) & (t <= end)
        ends = np.append(t[at], end)
        found = solve_ivp(rates, (begin, end), y, "Radau", np.unique(ends), rtol=1e-9, atol=1e-16)
        expected[at], y, begin = np.interp(t[at], found.t, found.y[0]), found.y[:, -1], end
    assert np.max(np.abs(q[:, 0] - expected)) < 3e-6 * CLEARANCE
    # The film is worth the trouble: it opens by a good part of itself, and the squeeze of the cone shows.
    assert np.max(np.abs(expected)) > 0.3 * CLEARANCE
    assert seen["coning"] == pytest.approx([cone(time)[0] for time in t], rel=1e-9)


@pytest.mark.core
def test_at_a_constant_speed_it_is_that_coning():
    law = dict(coning_per_speed_squared=-4e-10, coning_per_kelvin=5e-6, coning_reference_temperature=300.0)
    table = film(outer_pressure=P_O, inner_pressure=P_I)
    changed = fms(film=replace(table, temperature=340.0, **law))
    plain = fms(film=replace(table, coning=CONING - 4e-10 * 1e6 + 5e-6 * 40.0))
    _, _, _, q, seen = followed(changed, 0.02)
    run, _, _, expected, other = followed(plain, 0.02)
    assert np.max(np.abs(q - expected)) < 1e-9 * CLEARANCE / R_O
    for name, values in other.items():
        scale = max(np.max(np.abs(values)), 1e-12)
        assert np.max(np.abs(seen[name] - values)) < 1e-6 * scale, name
    assert "coning" in seen and "coning" not in other
    assert Model(changed).linear_scene().eigen()[0] == pytest.approx(run.model.linear_scene().eigen()[0], rel=1e-9)


@pytest.mark.parametrize("tilt", [0.0, 2e-5])
def test_no_thinnest_film_is_missed_while_the_cone_turns_over(tilt):
    """Of a ring too heavy to follow the faces are nearest at the inner edge, then, while the cone closes outwards, at
    the outer one."""
    turning = Shaft(speed=PiecewiseLinear((0.0, 0.008), (-1000.0, 1000.0)))
    law = dict(coning=-1.05e-3, coning_per_speed_squared=4e-9)
    scene = fms(film=film(outer_pressure=P_O, inner_pressure=P_I, **law), own=2.0 * tilt, runout=tilt)
    heavy = replace(scene.stator, mass=1e5, transverse_inertia=1e2, polar_inertia=2e2)
    run, outcome, _, _, seen = followed(replace(scene, stator=heavy, shaft=turning), 0.008, samples=20000)
    assert outcome.status == Status.OK
    record = run.extrema.records[0]
    assert record[0] <= np.min(seen["h_min"]) + 1e-15
    assert record[0] == pytest.approx(np.min(seen["h_min"]), rel=1e-5)
    assert record[3] == R_O and set(seen["h_min_radius"]) == {R_I, R_O}


def test_a_cone_that_closes_ends_the_run_where_the_edge_meets_the_floor():
    closed = PiecewiseLinear((0.0, 0.02), (0.0, -4e-3))
    table = film(outer_pressure=P_O, inner_pressure=P_O, coning=closed, clearance=CLEARANCE)
    run, outcome, _, _, _ = followed(fms(film=table, own=0.0, runout=0.0), 0.02)
    assert outcome.status == Status.COLLAPSED
    leg = run.segment(outcome.segment)
    gap = CLEARANCE + leg.gap_state(outcome.tau, outcome.y)[DZ]
    outer = gap + closed.at(leg.time + outcome.tau) * (R_O - R_I)
    assert outer == pytest.approx(1e-3 * CLEARANCE, abs=1e-5 * CLEARANCE)


def test_rough_faces_meet_where_the_cone_brings_them_together():
    contact = Contact(roughness=0.1e-6, compressive_strength=3e8, friction_coefficient=0.1)
    closed = PiecewiseLinear((0.0, 0.01), (0.0, -1.5e-3))
    table = film(outer_pressure=P_O, inner_pressure=P_O, coning=closed, clearance=3e-6)
    _, outcome, _, _, seen = followed(fms(film=table, own=0.0, runout=0.0, contact=contact), 0.012)
    assert outcome.status == Status.OK
    # Dry land carries part of the load in the end, at the outer edge.
    assert seen["contact_force"][0] == 0.0
    assert seen["contact_force"][-1] > 1.0
    assert seen["h_min_radius"][-1] == R_O
