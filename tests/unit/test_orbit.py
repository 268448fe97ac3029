"""Periodic orbits by shooting: against harmonic balance, the matrix exponential and plain transients."""

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from scenes import fmr, fms, fmsr, free_ring, started

import sealdyn
from sealdyn.analysis import shooting
from sealdyn.analysis.shooting import NoOrbit, Shooter
from sealdyn.scene.excitation import Shaft, Whirl
from sealdyn.simulation.selection import choose_method
from sealdyn.solvers.contract import Recorder
from sealdyn.solvers.integrate import solve

SCENARIOS = Path(__file__).parents[2] / "scenarios"
PERIODIC = ["fmr_reference", "fms_reference", "fmsr_both_flexible", "massless_ring"]
PERIODIC += [pytest.param("housing_vibration", marks=pytest.mark.slow)]


@pytest.mark.parametrize("scene", [fmr("linear"), fmr("linear", c=3.0), fms("linear"), fmsr("linear")])
def test_linear_orbit_is_the_harmonic_balance(scene):
    shooter = Shooter(scene)
    # Start elsewhere: Newton must come home in one step.
    orbit = shooter.find(np.zeros(shooter.size))
    assert np.max(np.abs(orbit.start - shooter.guess()) / shooter.scales) < 1e-10


@pytest.mark.parametrize("scene", [fmr("linear"), fms("linear"), fms("linear", speed=5500.0), fmsr("linear")])
def test_multipliers_are_the_exponentials_of_the_eigenvalues(scene):
    shooter = Shooter(scene)
    orbit = shooter.find()
    values, shapes = shooter.model.linear_scene().eigen()
    # A linear scene without axial forcing integrates its tilts only.
    tilt = [v for v, s in zip(values, shapes.T, strict=True) if np.linalg.norm(s[0::3]) < 1e-6 * np.linalg.norm(s)]
    assert len(tilt) == len(orbit.multipliers)
    for exact in np.exp(np.array(tilt) * orbit.period):
        nearest = orbit.multipliers[np.argmin(np.abs(orbit.multipliers - exact))]
        assert abs(nearest - exact) < 1e-8 * max(1.0, abs(exact) / 1e-2 * 1e-2)
        if abs(exact) > 1e-2:
            assert abs(nearest / exact - 1) < 1e-8


@pytest.mark.parametrize("name", PERIODIC)
def test_orbit_agrees_with_a_long_transient(name):
    scenario = sealdyn.read_scenario(SCENARIOS / f"{name}.toml")
    accuracy = scenario.run.accuracy
    shooter = Shooter(scenario.scene, accuracy)
    orbit = shooter.find()
    turns = 60 if name != "housing_vibration" else 12
    ready = started(scenario.scene, turns * orbit.period, accuracy)
    recorder = Recorder(orbit.period)
    solve(ready, choose_method(ready)[0], accuracy, recorder)
    _, q, _ = recorder.arrays()
    assert (
        np.max(np.abs(q[-1] - orbit.start[: ready.model.unknowns.n]) / ready.model.scales[: ready.model.unknowns.n])
        < accuracy
    )


def test_orbit_is_periodic_and_stable_below_the_threshold_and_not_above():
    for speed, stable in ((5500.0, True), (5650.0, False)):
        orbit = Shooter(fms("radial", speed=speed)).find()
        assert orbit.residual < 1e-10
        assert orbit.stable is stable


@pytest.mark.core
def test_incommensurate_forcing_has_no_period():
    scene = fmr("linear")
    scene = replace(scene, shaft=replace(scene.shaft, whirl=[Whirl(ratio=2**0.5, angle=1e-6)]))
    with pytest.raises(NoOrbit):
        Shooter(scene)


def test_an_undamped_ring_is_neutral():
    orbit = Shooter(free_ring()).find()
    assert np.max(np.abs(np.abs(orbit.multipliers) - 1)) < 1e-9


def test_a_stiff_film_has_an_orbit():
    """A film of a micrometre pushes the ring back 1e4 times faster than it turns: multipliers of the eigenvalues."""
    film = replace(fms().film, clearance=1e-6, coning=3e-4, viscosity=1e-3)
    scene = replace(fms(), film=film, shaft=Shaft(speed=300.0))
    shooter = Shooter(scene)
    values = np.array([mode.value for mode in shooter.model.linear_scene().modes()])
    assert np.max(-values.real) * shooter.period > 1e4
    orbit = shooter.find()
    assert np.max(np.abs(orbit.start - shooter.guess()) / shooter.scales) < 1e-3
    slowest = np.exp(np.max(values.real) * shooter.period)
    assert np.max(np.abs(orbit.multipliers)) == pytest.approx(slowest, rel=1e-3)


def test_explicit_steps_on_a_stiff_film_give_way_to_implicit_ones(monkeypatch):
    wanted = Shooter(fms("radial")).find()
    shooter = Shooter(fms("radial"))
    monkeypatch.setattr(shooting, "METHODS", {**shooting.METHODS, "dop853": endless})
    assert shooter.find().start == pytest.approx(wanted.start, abs=1e-8 * np.max(shooter.scales))
    assert shooter.method == "bdf"


def endless(segment, tau, y, method, tolerance, counts):
    """Steps that lead nowhere."""
    while True:
        counts.rhs += 12
        yield np.array([tau]), y[None, :], None


def test_a_trial_that_closes_the_film_is_told_from_a_stiff_film(monkeypatch):
    monkeypatch.setattr(shooting, "METHODS", {**shooting.METHODS, "dop853": endless})
    shooter = Shooter(fms("radial"))
    closed = np.zeros(shooter.size)
    closed[shooter.model.unknowns.names.index("stator_z")] = -0.995 * shooter.model.clearance
    with pytest.raises(NoOrbit) as given_up:
        shooter.flow(closed)
    assert given_up.value.film < shooting.CLOSED and shooter.method == "dop853"
