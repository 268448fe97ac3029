"""Waves of a face that stands still under a gas film that stores: starts, small motion, runs, refusals."""

from dataclasses import replace

import numpy as np
import pytest
from gas_faces import gap_state, gas_film

from sealdyn.dynamics.equilibrium import axial_excess
from sealdyn.dynamics.model import Model
from sealdyn.dynamics.run_state import RunState
from sealdyn.faces import geometry
from sealdyn.films import film_of
from sealdyn.scene.excitation import Shaft
from sealdyn.scene.patterns import Waviness
from sealdyn.scene.rings import Rotor, Stator, Support
from sealdyn.scene.scene import Scene, SceneError
from sealdyn.simulation.stability import stability
from sealdyn.solvers.contract import Recorder, Status
from sealdyn.solvers.integrate import solve

WAVE = Waviness(3, 1.2e-6, 0.4)
CLEARANCE = 5e-6


def seal(film=None, wave=WAVE, speed=1500.0, **rotor):
    support = Support(axial_stiffness=5e4, axial_damping=100.0, radius=0.04)
    ring = dict(mass=0.3, transverse_inertia=3e-4, polar_inertia=5e-4)
    film = film or gas_film((8, 48), coning=-2e-4)
    waves = [wave] if wave else []
    return Scene(
        shaft=Shaft(speed=speed), film=film, rotor=Rotor(**rotor),
        stator=Stator(**ring, support=support, waviness=waves),
    )  # fmt: skip


def test_the_given_clearance_is_held_with_its_waves():
    model = Model(seal(), 1e-4)
    # Nothing moves: neither off the clearance nor round.
    assert abs(model.axial_shift()) < 1e-9 * CLEARANCE
    s = gap_state(model.scene.film, 1500.0)
    excess = axial_excess(model, s, model.closing_force())
    assert abs(excess(0.0)) < 1e-8 * model.closing_force()
    # And the waves have their share in it, which grows with the speed.
    shares = [
        Model(seal(speed=speed), 1e-4).closing_force() / Model(seal(wave=None, speed=speed), 1e-4).closing_force() - 1.0
        for speed in (1e-3, 1500.0)
    ]
    assert shares[1] > shares[0] + 1e-3


def test_a_clearance_is_found_between_wavy_faces():
    held = Model(seal(), 1e-4)
    closing = replace(
        held.scene.closing, balance_ratio=held.closing.balance_ratio, spring_force=held.closing.spring
    )  # fmt: skip
    scene = replace(held.scene, film=replace(held.scene.film, clearance=None), closing=closing)
    found = Model(scene, 1e-4)
    assert found.clearance == pytest.approx(CLEARANCE, rel=1e-6)


@pytest.mark.core
def test_small_motion_between_waves_is_that_of_the_differences():
    """Stiffness at rest against differences of the steady film; three waves are the same in all directions."""
    model = Model(seal(), 1e-4)
    stiffness, damping = model.film_matrices()
    step = 1e-3 * CLEARANCE
    forces = []
    for dz in (-step, step):
        s = gap_state(model.scene.film, 1500.0, dz=dz)
        model.interface.wrench(model.f, s)
        forces.append(s[geometry.FORCE])
    assert stiffness[0, 0] == pytest.approx((forces[0] - forces[1]) / (2.0 * step), rel=1e-4)
    assert stiffness[1, 1] == pytest.approx(stiffness[2, 2], rel=1e-6)
    assert damping[1, 1] == pytest.approx(damping[2, 2], rel=1e-4)
    found = stability(model, model.start, model.linear_scene(), speeds=True)
    # Which speeds are critical takes too long to find between waves, and is said.
    assert found["verdict"] == "stable" and found["thresholds"] is None and found["critical_speed"] is None


def test_a_square_ring_stays_where_it_is_and_a_moved_one_comes_back():
    scene = seal()
    for dz, most in ((0.0, 1e-6), (2e-7, 0.06)):
        initial = replace(scene.initial, stator=replace(scene.initial.stator, z=dz)) if dz else scene.initial
        run = RunState(Model(replace(scene, initial=initial), 1e-5), 0.004)
        recorder = Recorder(1e-4)
        outcome = solve(run, "ida", 1e-5, recorder)
        assert outcome.status == Status.OK
        _, q, *_ = recorder.arrays()
        assert np.max(np.abs(q[-5:, 0])) < most * (dz or CLEARANCE)


def test_waves_that_turn_are_refused():
    for key, scene in {
        "rotor.waviness": seal(wave=None, waviness=[WAVE]),
        "stator.waviness": replace(seal(), stator=replace(seal().stator, speed=10.0)),
    }.items():
        with pytest.raises(SceneError) as caught:
            film_of(scene)
        assert caught.value.key == key and "stands still" in caught.value.expected
    # A shaft that stands still turns no waves.
    assert film_of(replace(seal(wave=None, waviness=[WAVE], speed=0.0)))
