"""Rings that waves or a pad tilt: small motion about their rest, in time and by the eigenvalues about it."""

from dataclasses import replace

import numpy as np
import pytest
from own_rest import rest
from patterned_faces import THREE, TWO, UM, gas, liquid, pads, seal

from sealdyn.dynamics.model import Model
from sealdyn.dynamics.run_state import RunState
from sealdyn.simulation.selection import choose_method
from sealdyn.solvers.contract import Recorder
from sealdyn.solvers.integrate import solve

HIGH = [replace(wave, amplitude=1.1 * UM) for wave in (TWO, THREE)]
# Scene, duration (s), pace (1/s), accuracy.
SCENES = {
    "waves": (seal(liquid(cells=(4, 48), clearance=3.2 * UM), stator=HIGH), 0.025, 400.0),
    "one pad": (seal(gas(pads(1, 1.5), cells=(4, 24)), 1500.0), 0.006, 900.0),
}


def slow_modes(samples, interval, count):
    """Exponents (count,) (1/s) of what decays in samples (m, n), an `interval` (s) apart: the linear map from each to
    the next, in their leading directions.
    **Source** Schmid (2010), Journal of Fluid Mechanics 656, 5-28."""
    left, sizes, right = np.linalg.svd(samples[:-1].T, full_matrices=False)
    step = left[:, :count].T @ samples[1:].T @ right[:count].T / sizes[:count]
    return np.log(np.linalg.eigvals(step) + 0j) / interval


@pytest.mark.core
@pytest.mark.parametrize("name", SCENES)
def test_a_small_motion_decays_as_the_modes_about_the_rest_say(name):
    """Before, the modes were those of aligned faces: growth rates 2 and 3 % off."""
    scene, duration, pace = SCENES[name]
    model = Model(scene, 1e-6)
    linear, interval = model.linear_scene(), duration / 40
    units = np.array([scene.film.clearance, *2 * [scene.film.clearance / scene.film.outer_radius]])
    run, sink = RunState(model, duration), Recorder(interval)
    run.y0[:3] = linear.rest + 0.002 * units * [1.0, 0.5, -0.3]
    assert solve(run, choose_method(run)[0], 1e-6, sink).status == "ok"
    _, q, rate = sink.arrays()
    # Fast squeeze is over by then.
    found = slow_modes(np.hstack([(q - linear.rest) / units, rate / units / pace])[4:], interval, 3)
    for mode in linear.modes()[:2]:
        assert np.min(np.abs(found - mode.value)) < 0.01 * abs(mode.value)
    assert max(found.real) == pytest.approx(linear.modes()[0].value.real, rel=0.01)


RESTS = {
    "rotor": seal(liquid(), stator=(TWO, THREE), floats="rotor"),
    "both": seal(liquid(), stator=(TWO, THREE), floats="stator rotor"),
    "turning stator": replace(
        seal(liquid(), 0.0, rotor=(TWO, THREE)),
        stator=replace(seal(liquid(), 0.0).stator, speed=800.0),
    ),
}


@pytest.mark.parametrize("name", RESTS)
def test_the_rest_is_the_root_of_forces_and_moments(name):
    scene = RESTS[name]
    parts = [part for z, tilt in rest(scene).values() for part in (z, tilt.real, tilt.imag)]
    size = np.max(np.abs(parts[1:3]))
    found = Model(scene, 1e-3).linear_scene().rest
    # Measured 0.5 % with these cells, of which the test beside it asks 1 %.
    assert np.abs(np.array(found) - parts)[np.arange(len(parts)) % 3 > 0] == pytest.approx(0.0, abs=0.015 * size)
