"""Periodic orbits by shooting and by harmonic balance: against each other, linear answers, the matrix exponential and
plain transients."""

from dataclasses import replace

import numpy as np
import pytest
from command import SCENARIOS
from scenes import fmr, fms, fmsr, free_ring, started

import sealdyn
from sealdyn.analysis import shooting
from sealdyn.analysis.harmonic_balance import HarmonicBalance, NotSmooth
from sealdyn.analysis.shooting import ForcedWave, NoOrbit, NotOneSpeed, Shooter
from sealdyn.scene.excitation import Shaft, Whirl
from sealdyn.simulation.selection import choose_method
from sealdyn.solvers.contract import Recorder
from sealdyn.solvers.integrate import solve

PERIODIC = ["fmr_reference", "fms_reference", "fmsr_both_flexible", "massless_ring"]


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
    # What is left of a start near by has decayed by then.
    ready = started(scenario.scene, 40 * orbit.period, accuracy)
    ready.y0 = ready.steady_start()
    recorder = Recorder(orbit.period)
    solve(ready, choose_method(ready)[0], accuracy, recorder)
    _, q, _ = recorder.arrays()
    n = ready.model.unknowns.n
    assert np.max(np.abs(q[-1] - orbit.start[:n]) / ready.model.scales[:n]) < accuracy


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


# --- points of the forcing's frame ---------------------------------------------------------------------

ONE_SPEED = {
    "fms, runout": fms(own=0.0),
    "fms, misalignment": fms(runout=0.0),
    "fmr, misalignment of its own": fmr(fixed=0.0),
    "fmr, above its threshold": fmr(fixed=0.0, speed=9000.0),
    "fmsr, misalignment of the rotor": fmsr(fixed=0.0),
}


@pytest.mark.parametrize("name", ONE_SPEED)
def test_what_is_forced_at_one_speed_is_a_point_of_its_frame(name):
    scene = ONE_SPEED[name]
    wave, shooter = ForcedWave(scene), Shooter(scene)
    point, orbit = wave.find(), shooter.find()
    assert point.start == pytest.approx(orbit.start, abs=1e-9 * np.max(shooter.scales))
    assert point.extremes["h_min"]["value"] == pytest.approx(orbit.extremes["h_min"]["value"], rel=1e-9)
    assert wave.multiplier(point) == pytest.approx(np.max(np.abs(orbit.multipliers)), rel=1e-4)


def apart(forced, angles):
    """How far, in units of the scales, a gas film's point is from where a run in time is after 30 turns."""
    values = ["rotor.runout=0", "stator.misalignment=0", forced, f"film.gas_reynolds.cells=[4, {angles}]"]
    scene = sealdyn.read_scenario(SCENARIOS / "gas_reynolds_reference.toml", values).scene
    wave = ForcedWave(scene, 1e-7)
    point, recorder = wave.find(), Recorder(2.0 * np.pi / scene.shaft.speed)
    ready = started(scene, 30 * recorder.interval, 1e-7)
    ready.y0[: len(point.start)] = wave.guess()
    ready.segment(0).settle_film(0.0, ready.y0)
    solve(ready, "ida", 1e-7, recorder)
    n = ready.model.unknowns.n
    # It is another than the linear response.
    assert np.max(np.abs(point.start - wave.guess())[:n] / wave.scales) > 1e-4
    return np.max(np.abs(recorder.arrays()[1][-1] - point.start[:n]) / wave.scales)


def test_a_film_that_stores_turns_with_the_forcing_too():
    """What stands does so to the tolerance of the run; what turns passes the cells, which err by their square."""
    assert apart("stator.misalignment=2 mrad", 12) < 1e-7
    coarse, fine = (apart("rotor.runout=2 mrad", angles) for angles in (12, 24))
    assert coarse < 3e-4
    assert coarse / fine == pytest.approx(4.0, rel=0.2)


def test_two_speeds_have_no_common_frame():
    for scene in (fms(), fmr(), replace(fms(own=0.0), shaft=Shaft(speed=1000.0, whirl=[Whirl(ratio=0.5, angle=1e-6)]))):
        with pytest.raises(NotOneSpeed):
            ForcedWave(scene)


# --- harmonic balance ----------------------------------------------------------------------------------

MOTIONS = {
    "fms": fms(),
    "fms, nearly unstable": fms("radial", speed=5600.0),
    "fmr": fmr("radial"),
    "fmsr": fmsr("radial"),
    "subharmonic whirl": replace(fms(), shaft=Shaft(speed=1000.0, whirl=[Whirl(ratio=0.5, angle=1e-4)])),
    "massless": replace(fms(), stator=replace(fms().stator, mass=0.0, transverse_inertia=0.0, polar_inertia=0.0)),
    "far out": fms("radial", runout=2.5e-3),
}


@pytest.mark.parametrize("name", MOTIONS)
def test_harmonic_balance_finds_what_shooting_finds(name):
    """Starts, thinnest films and multipliers of what is differenced and integrated in ways of their own."""
    balance, shooter = HarmonicBalance(MOTIONS[name]), Shooter(MOTIONS[name])
    orbit, wanted = balance.with_multipliers(balance.find()), shooter.find()
    assert np.max(np.abs(orbit.start[: shooter.size] - wanted.start) / shooter.scales) < 1e-8
    for key in ("value", "radius"):
        assert orbit.extremes["h_min"][key] == pytest.approx(wanted.extremes["h_min"][key], rel=1e-6)
    for end in ("min", "max"):
        tilts = orbit.extremes["relative_misalignment"], wanted.extremes["relative_misalignment"]
        assert tilts[0][end] == pytest.approx(tilts[1][end], rel=3e-5)
    largest = np.max(np.abs(wanted.multipliers))
    assert balance.multiplier(orbit) == pytest.approx(largest, rel=1e-3 if largest < 1e-3 else 1e-5)
    assert orbit.stable is wanted.stable


def test_its_samples_are_those_of_the_orbit_in_time():
    scene = fms("radial", runout=2.5e-3)
    balance, shooter = HarmonicBalance(scene), Shooter(scene)
    found = balance.extremes(balance.find().points, per_period=16)
    wanted = shooter.extremes(shooter.find().start, per_period=16, accuracy=1e-9)
    assert found["times"] == pytest.approx(wanted["times"], rel=1e-12)
    for name, unit in (("displacements", 1.0), ("rates", balance.pace)):
        assert np.max(np.abs(found[name] - wanted[name]) / (unit * balance.scales)) < 1e-7


def test_harmonics_are_added_until_the_last_are_nothing():
    """The nearer to contact the more; their count is no matter of the first guess."""
    counts = []
    for tilt in (1e-5, 2e-3):
        balance = HarmonicBalance(fms("radial", runout=tilt, own=0.5 * tilt), 1e-7)
        orbit = balance.find()
        again = balance.find(orbit.points)
        assert np.max(np.abs(again.points - orbit.points) / balance.scales) < 1e-8
        counts.append(len(orbit.points))
    assert counts[0] < counts[1]


def test_an_undamped_ring_has_no_isolated_orbit_but_its_rest():
    balance = HarmonicBalance(free_ring())
    orbit = balance.with_multipliers(balance.find())
    assert np.max(np.abs(np.abs(orbit.multipliers) - 1)) < 1e-9


def test_a_motion_of_too_many_cycles_is_left_to_shooting():
    whirl = [Whirl(ratio=59 / 60, angle=1e-6)]
    with pytest.raises(NotSmooth):
        HarmonicBalance(replace(fms(), shaft=Shaft(speed=1000.0, whirl=whirl)))


def test_an_orbit_that_closes_the_film_is_none():
    scene = fms("radial", runout=4.5e-3, own=4.5e-4)
    low = HarmonicBalance(scene).find().extremes["h_min"]["of_clearance"]
    for floor, wanted in ((0.9 * low, True), (1.1 * low, False)):
        balance = HarmonicBalance(replace(scene, film=replace(scene.film, floor=floor)))
        if wanted:
            assert balance.find().extremes["h_min"]["of_clearance"] == pytest.approx(low, rel=1e-6)
        else:
            with pytest.raises(NoOrbit):
                balance.find()


def test_a_gas_dam_comes_back_to_the_orbit():
    """A film that rings and is dear: one period in time from where harmonic balance says."""
    scene = sealdyn.read_scenario(SCENARIOS / "gas_dam_reference.toml", ["rotor.runout=1 mrad"]).scene
    orbit = HarmonicBalance(scene, 1e-6).find()
    assert orbit.extremes["h_min"]["of_clearance"] < 0.5
    shooter = Shooter(scene, 1e-6, tight=1e-9)
    assert np.max(np.abs(shooter.flow(orbit.start) - orbit.start) / shooter.scales) < 1e-6
