"""Forces and moments from outside on a floating ring: motion, work, rest, and what is refused."""

import math
from dataclasses import replace
from itertools import pairwise

import numpy as np
import pytest
from command import SCENARIOS
from scenes import fmr, fms, prepared, run
from scipy.integrate import solve_ivp
from scipy.optimize import brentq

from sealdyn.dynamics import equations
from sealdyn.dynamics.model import Model
from sealdyn.numerics.piecewise_linear import PiecewiseLinear
from sealdyn.scenario.reader import ScenarioError, parse_scenario, read_scenario
from sealdyn.scene.excitation import Shaft
from sealdyn.scene.film import Coefficients
from sealdyn.scene.forces import Load, LoadSamples, LoadTone, SecondarySeal
from sealdyn.scene.scene import SceneError, frozen_at, unforced

FMS = (SCENARIOS / "fms_reference.toml").read_text()
FILM = Coefficients(tilt_stiffness=5000.0, tilt_damping=3.6, axial_stiffness=2e7, axial_damping=9e3)
STEP = PiecewiseLinear((0.0, 0.004, 0.004, 0.01), (0.0, 20.0, 50.0, -30.0))
TONE = LoadTone(frequency=300.0, force=25.0, moment=0.03, direction=0.4, phase=0.2)


def loaded(load, model="linear", **parts):
    """Green's floating stator with nothing but a load to move it; and the film's own numbers, if linear."""
    scene = fms(model, runout=0.0, own=0.0, **parts)
    film = replace(scene.film, coefficients=FILM) if model == "linear" else scene.film
    return replace(scene, film=film, stator=replace(scene.stator, load=load))


def by_hand(pull, moment, times, speed=1000.0):
    """Displacement and complex tilt of that stator from its equations of motion, by scipy."""
    spring, damper, arm = 5e5, 300.0, 0.04**2 / 2

    def rates(t, y):
        (z, v, x, y_, v_x, v_y), (m_x, m_y) = y, moment(t)
        # The wedge of the mean spin, and no gyroscopic term of a stator at rest.
        wedge = 0.5 * speed * FILM.tilt_damping
        k, d = spring * arm + FILM.tilt_stiffness, damper * arm + FILM.tilt_damping
        force = pull(t) - (spring + FILM.axial_stiffness) * z - (damper + FILM.axial_damping) * v
        turned = [m_x - k * x - d * v_x - wedge * y_, m_y - k * y_ - d * v_y + wedge * x]
        return [v, force, v_x, v_y, *(moment / 8e-4 for moment in turned)]

    ends, y, found = [0.0, 0.004, times[-1]], np.zeros(6), []
    for begin, end in pairwise(ends):
        inside = times[(times >= begin) & ((times < end) | (end == times[-1]))]
        step = solve_ivp(rates, (begin, end), y, "DOP853", [*inside[inside < end], end], rtol=1e-11, atol=1e-18)
        found.append(step.y[:, : len(inside)])
        y = step.y[:, -1]
    z, _, x, y_, *_ = np.hstack(found)
    return z, x + 1j * y_


@pytest.mark.core
def test_motion_is_that_of_the_equations():
    w = 2 * math.pi * TONE.frequency
    load = Load(force=STEP, moment_x=0.01, moment_y=-0.02, tone=[TONE])
    found = run(loaded(load), duration=0.01, accuracy=1e-9)

    def pull(t):
        part = slice(0, 2) if t < 0.004 else slice(2, 4)
        return np.interp(t, STEP.time[part], STEP.value[part]) + TONE.force * math.cos(w * t + TONE.phase)

    def moment(t):
        size = TONE.moment * math.cos(w * t + TONE.phase)
        return 0.01 + size * math.cos(TONE.direction), -0.02 + size * math.sin(TONE.direction)

    z, tilt = by_hand(pull, moment, np.asarray(found.times))
    assert np.abs(found.q[:, 0] - z).max() < 1e-7 * np.abs(z).max()
    assert np.abs(found.tilt("stator") - tilt).max() < 1e-7 * np.abs(tilt).max()
    assert found.outcome.energy_residual < 1e-9


def test_work_of_a_force_is_force_times_way():
    tone = replace(TONE, moment=0.0)
    found = run(loaded(Load(tone=[tone]), "radial"), duration=0.01, accuracy=1e-9, per_turn=4096)
    t, z = np.asarray(found.times), found.q[:, 0]
    force = tone.force * np.cos(2 * math.pi * tone.frequency * t + tone.phase)
    work = np.sum(0.5 * (force[1:] + force[:-1]) * np.diff(z))
    place = found.model.unknowns.works.start + equations.WORKS.index("carrier")
    assert found.ready.last[2][place] == pytest.approx(work, rel=1e-4) and work > 0.0
    assert found.outcome.energy_residual < 1e-9


def test_samples_of_a_tone_are_the_tone():
    time = np.arange(-8, 260) / 20000.0
    wave = np.cos(2 * math.pi * TONE.frequency * time + TONE.phase)
    columns = {"force": TONE.force * wave, "moment_x": TONE.moment * math.cos(TONE.direction) * wave,
               "moment_y": TONE.moment * math.sin(TONE.direction) * wave}  # fmt: skip
    samples = LoadSamples(time=tuple(time), **{name: tuple(column) for name, column in columns.items()})
    one, other = (run(loaded(load, "radial"), duration=0.01, accuracy=1e-9)
                  for load in (Load(tone=[TONE]), Load(samples=samples)))  # fmt: skip
    assert np.abs(one.q - other.q).max(axis=0) == pytest.approx(0.0, abs=1e-6 * np.abs(one.q).max())
    assert other.outcome.energy_residual < 1e-9 and np.abs(one.q[:, 0]).max() > 1e-7
    # Samples have no harmonics.
    with pytest.raises(SceneError) as error:
        other.ready.segment(0).steady_motion()
    assert error.value.key == "stator.load.samples"


def test_a_moment_that_turns_is_two_tones():
    frequency = 1000.0 / (2 * math.pi)
    turning = Load(moment_x=0.03, turns=True)
    tones = [LoadTone(frequency=frequency, moment=0.03),
             LoadTone(frequency=frequency, moment=0.03, direction=math.pi / 2, phase=-math.pi / 2)]  # fmt: skip
    scene = fmr(own=0.0, fixed=0.0)
    one, other = (run(replace(scene, rotor=replace(scene.rotor, load=load)), duration=0.01, accuracy=1e-9)
                  for load in (turning, Load(tone=tones)))  # fmt: skip
    assert np.abs(one.q - other.q).max() < 1e-7 * np.abs(one.q).max()


@pytest.mark.parametrize("floating", ["stator", "rotor"])
def test_a_constant_force_moves_the_rest(floating):
    pull = 20.0
    scene = fms("radial", runout=0.0, own=0.0) if floating == "stator" else fmr("radial", fixed=0.0, own=0.0)
    scene = replace(scene, **{floating: replace(getattr(scene, floating), load=Load(force=pull))})
    ready = prepared(scene, 0.01, 1e-8, start="steady")
    model, sign = ready.model, 1.0 if floating == "stator" else -1.0
    force, c = model.interface.opening_force, model.clearance

    def excess(z):
        return sign * (force(c + sign * z, 0.0, 5e5) - force(c, 0.0, 5e5)) - 5e5 * z + pull

    z = brentq(excess, -0.5 * c, 0.5 * c, xtol=1e-18)
    assert model.axial_shift() == pytest.approx(sign * z, rel=1e-7)
    # Stability is asked of the same rest.
    assert Model(unforced(scene, 1000.0)).axial_shift() == pytest.approx(sign * z, rel=1e-7)
    # It begins there, and stays.
    found = run(scene, duration=0.005, accuracy=1e-9, start="steady")
    assert found.q[:, 0] == pytest.approx(z, rel=1e-5)


def test_functions_of_time_stop_where_a_scene_is_held():
    scene = loaded(Load(force=STEP))
    assert frozen_at(scene, 0.003).stator.load.force == pytest.approx(15.0)


TABLE = '[stator.load.samples]\nfile = "pull.csv"\n'


def test_a_file_gives_its_columns(tmp_path):
    (tmp_path / "pull.csv").write_text("time (ms), force (kN), moment_y (N*mm)\n" + "".join(
        f"{n}, {0.01 * n}, {n}\n" for n in range(8)))  # fmt: skip
    (tmp_path / "seal.toml").write_text(FMS + TABLE)
    found = read_scenario(tmp_path / "seal.toml", ["run.duration=0.005", "run.samples=50"])
    samples = found.scene.stator.load.samples
    assert samples.force == pytest.approx([10.0 * n for n in range(8)]) and samples.moment_x is None
    assert samples.moment_y == pytest.approx([1e-3 * n for n in range(8)])
    # Whole without the file.
    assert parse_scenario(found.to_toml(), "seal.toml").scene == found.scene


@pytest.mark.parametrize(
    ("text", "key"),
    [
        ("[stator.load.samples]\ntime = [0, 1, 2, 3, 4, 5]", "stator.load.samples.force"),
        ("[stator.load.samples]\ntime = [0, 1, 2]\nforce = [0, 1, 2]", "stator.load.samples.time"),
        ('[stator.load]\nforce = "3 m"', "stator.load.force"),
        (TABLE, "stator.load.samples.file"),
    ],
)
def test_what_a_load_cannot_be(text, key):
    with pytest.raises(ScenarioError) as error:
        parse_scenario(f"{FMS}\n{text}\n", "seal.toml")
    assert error.value.key == key


def test_a_rigid_ring_feels_no_load():
    scenario = parse_scenario(FMS + '[rotor.load]\nforce = "5 N"\n', "seal.toml")
    assert "rotor.load.force" in scenario.unused()
    scene = fms(shaft=Shaft(speed=1000.0))
    scene = replace(scene, rotor=replace(scene.rotor, load=Load(force=5.0)))
    assert not prepared(scene, 0.01, 1e-6).model.axial_shift()


def test_a_ring_that_sticks_holds_a_load_up_to_its_friction():
    ramp = PiecewiseLinear((0.0, 0.04), (0.0, 80.0))
    scene = loaded(Load(force=ramp), "radial")
    held = replace(scene.stator, secondary_seal=SecondarySeal(radius=0.035, friction_force=50.0))
    found = run(replace(scene, stator=held), duration=0.04, accuracy=1e-7)
    slips = found.times[np.argmax(np.abs(found.q[:, 0]) > 1e-10)]
    assert 50.0 <= 2000.0 * slips < 50.5 and found.q[-1, 0] > 2e-6
    assert found.outcome.energy_residual < 1e-8


def test_a_file_without_a_line_of_names(tmp_path):
    (tmp_path / "pull.csv").write_text("".join(f"{n}, x, {10 * n}\n" for n in range(8)))
    table = TABLE + 'titles = ["time (ms)", "", "force (N)"]\n'
    (tmp_path / "seal.toml").write_text(FMS + table)
    found = read_scenario(tmp_path / "seal.toml", ["run.duration=0.005", "run.samples=50"])
    assert found.scene.stator.load.samples.force == tuple(10.0 * n for n in range(8))
    assert parse_scenario(found.to_toml(), "seal.toml").scene == found.scene
