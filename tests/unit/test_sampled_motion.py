"""Motion of a carrier by samples: the spline in the compiled kernels, its bounds, files and what is wrong with them."""

import math
from dataclasses import replace

import h5py
import numpy as np
import pytest
from command import SCENARIOS
from scenes import fmr, fms, run
from scipy.interpolate import make_interp_spline

from sealdyn.dynamics.equations import LEG_AT
from sealdyn.dynamics.imposed_motion import MOTION_AT, PER_RING, Z_ACCELERATION, Z_RATE, Z, imposed_state
from sealdyn.dynamics.model import Model
from sealdyn.dynamics.run_state import Concern
from sealdyn.dynamics.step_bounds import imposed_gap
from sealdyn.dynamics.swept_motion import sampled
from sealdyn.scenario.reader import ScenarioError, parse_scenario, read_scenario
from sealdyn.scene.excitation import AxialVibration, Housing, Motion, Shaft
from sealdyn.scene.scene import SceneError
from sealdyn.simulation.batch import run_many
from sealdyn.simulation.run import evaluate
from sealdyn.simulation.simulate import prepare_run
from sealdyn.studies._runner import run_study

FMR = (SCENARIOS / "fmr_reference.toml").read_text()
TONE, AMPLITUDE, TILT = 400.0, 2e-7, 3e-6


def tone(rate, long=0.05, tilt=0.0):
    """A cosine of TONE (Hz) along the axis, sampled at `rate` (Hz) a little beyond `long` (s); a turning tilt."""
    time = np.arange(-8, round(rate * long) + 9) / rate
    w = 2 * math.pi * TONE
    axial, tilts = AMPLITUDE * np.cos(w * time), (tilt * np.cos(w * time), tilt * np.sin(w * time))
    columns = {"axial": tuple(axial), **({"tilt_x": tuple(tilts[0]), "tilt_y": tuple(tilts[1])} if tilt else {})}
    return Motion(time=tuple(time), **columns)


def shaken(rate, **changes):
    return fmr(fixed=0.0, housing=Housing(motion=replace(tone(rate), **changes)))


@pytest.mark.core
def test_kernel_is_the_spline_and_its_derivatives():
    time = np.sort(np.random.default_rng(1).uniform(0.0, 1.0, 60))
    time[0], time[-1] = 0.0, 1.0
    axial, x, y = np.random.default_rng(2).normal(size=(3, 60)) * [[1e-6], [1e-5], [1e-5]]
    motion = Motion(time=tuple(time), axial=tuple(axial), tilt_x=tuple(x), tilt_y=tuple(y))
    segment = Model(fms(shaft=Shaft(speed=1000.0, motion=motion), runout=0.0, own=0.0)).segment()
    c, gap = np.zeros(2 * PER_RING), np.zeros(6)
    splines = [make_interp_spline(time, column, k=5) for column in (axial, x, y)]
    for t in (0.0, *time[1:5], 0.3, 0.77, 1.0):
        imposed_state(t, segment.p[LEG_AT:], c)
        imposed_gap(t, segment.p, segment.w[: 2 * PER_RING], gap)
        for n, spline in enumerate(splines):
            for at, order in ((Z, 0), (Z_RATE, 1), (Z_ACCELERATION, 2)):
                scale = np.abs(spline.derivative(order)(time)).max() if order else np.abs(spline(time)).max()
                assert c[PER_RING + at + n] == pytest.approx(spline.derivative(order)(t) if order else spline(t),
                                                             abs=1e-9 * scale)  # fmt: skip
        # Of a rigid rotor the gap feels all of it, against the stator.
        assert gap == pytest.approx(-c[PER_RING : PER_RING + 6], rel=1e-12, abs=1e-20)
    assert not np.any(c[:PER_RING])
    assert segment.p[LEG_AT + MOTION_AT] == 0.0


def test_a_stretch_of_time_has_the_pieces_it_needs():
    spline = sampled(tone(8000.0, 0.5))
    whole, part = spline.block(0.0, 0.5), spline.block(0.2, 0.01)
    assert part[0] <= 8000.0 * 0.01 + 2 and len(part) < 0.05 * len(whole)
    assert part[1] <= 0.0 and part[1 + int(part[0])] >= 0.01 - 1e-12


def test_bounds_hold_the_motion():
    random = np.random.default_rng(3).normal(size=(3, 200))
    motion = Motion(time=tuple(np.arange(200.0) / 1000.0), axial=tuple(random[0]), tilt_x=tuple(random[1]),
                    tilt_y=tuple(random[2]))  # fmt: skip
    reach, fourth = sampled(motion).reach(0.0, 0.199)
    t = np.linspace(0.0, 0.199, 5001)
    splines = [make_interp_spline(motion.time, column, k=5) for column in motion.columns()]
    values, fourths = ([np.abs(s.derivative(n)(t) if n else s(t)).max() for s in splines] for n in (0, 4))
    for bound, found in ((reach, values), (fourth, fourths)):
        assert found[0] <= bound[0] * (1 + 1e-9) < 4.0 * found[0]
        assert max(found[1:]) <= bound[1] * (1 + 1e-9) < 8.0 * max(found[1:])


def test_a_run_with_samples_of_a_tone_is_the_run_with_the_tone():
    long, exact = 0.02, Housing(axial=[AxialVibration(frequency=TONE, displacement=AMPLITUDE)])
    by_tone = run(fmr(fixed=0.0, housing=exact), duration=long, accuracy=1e-9)
    off = []
    for rate in (4000.0, 8000.0):
        by_samples = run(shaken(rate), duration=long, accuracy=1e-9)
        assert by_samples.outcome.status == "ok"
        off.append(np.abs(by_samples.q - by_tone.q).max(axis=0)[0] / AMPLITUDE)
        # Found between the samples of the archive by the same watch.
        assert by_samples.record(0)[0] == pytest.approx(by_tone.record(0)[0], abs=3 * off[-1] * AMPLITUDE + 1e-14)
    assert off[0] < 3e-3 and off[1] < off[0] / 16


def test_energy_of_a_run_is_accounted_for():
    moved = fms(shaft=Shaft(speed=1000.0, motion=tone(8000.0, tilt=TILT)), runout=0.0)
    found = run(moved, duration=0.03, accuracy=1e-8)
    assert found.outcome.status == "ok" and found.model.unknowns.with_tilt
    assert found.outcome.energy_residual < 1e-7


def test_scene_takes_no_steady_response():
    scenario = scenario_of(tone(8000.0, tilt=TILT))
    ready, plan = prepare_run(scenario)
    method = plan.method
    assert ready.start.taken == "rest" and method != "expm" and ready.period(-1) is None
    with pytest.raises(SceneError) as error:
        ready.segment(0).steady_motion()
    assert error.value.key == "shaft.motion"


def test_a_run_beyond_the_samples_is_refused_and_coarse_ones_are_told():
    with pytest.raises(SceneError) as error:
        prepare_run(scenario_of(tone(8000.0, 0.01), duration=0.02))
    assert error.value.key == "shaft.motion.time"
    for rate, warned in ((8000.0, False), (1000.0, True)):
        ready, *_ = prepare_run(scenario_of(tone(rate, 0.02), duration=0.01))
        told = [caution for caution in ready.cautions if caution.concern is Concern.ALIASING]
        assert bool(told) == warned


def test_runs_together_are_those_by_themselves():
    scenario = scenario_of(tone(8000.0, tilt=TILT))
    points = [{"set": {"rotor.mass": mass}, "outputs": ["relative_misalignment.mean"]} for mass in (0.5, 1.0)]
    together = [row["relative_misalignment.mean"] for row in run_many(scenario, points)]
    alone = [evaluate(scenario, p["set"], p["outputs"])["relative_misalignment.mean"] for p in points]
    assert together == pytest.approx(alone, rel=1e-5)
    still = evaluate(parse_scenario(FMR, "seal.toml"), {"run.duration": 0.02, "run.samples": 100}, points[0]["outputs"])
    assert abs(still["relative_misalignment.mean"] - alone[1]) > 1e-4 * alone[1]


def test_no_study_goes_on_beyond_the_samples(tmp_path):
    with pytest.raises(SceneError) as error:
        run_study("steady-state", scenario_of(tone(8000.0, tilt=TILT)), tmp_path / "s.h5", workers=1)
    assert error.value.key == "shaft.motion.time"


# --- scenarios and files ------------------------------------------------------------------------------


def scenario_of(motion, duration=0.02):
    columns = {name: list(value) for name, value in vars(motion).items() if value is not None}
    values = {"shaft.motion": columns, "run.duration": duration, "run.samples": 100}
    return parse_scenario(FMR, "seal.toml").with_(values)


def write_csv(path, motion, title="time (ms), axial (um), tilt_x (urad), tilt_y [urad], else"):
    rows = np.array([motion.time, *motion.columns()]).T * [1e3, 1e6, 1e6, 1e6]
    lines = [title, "# a remark", *(", ".join(map(repr, map(float, row))) + ", x" for row in rows)]
    path.write_text("\n".join(lines))


def write_hdf5(path, motion):
    with h5py.File(path, "w") as file:
        for name, column, factor, unit in zip(
            ("time", "axial", "tilt_x", "tilt_y"), [motion.time, *motion.columns()], (1.0, 1e6, 1.0, 1.0),
            (b"s", "um", None, "rad"), strict=True,
        ):  # fmt: skip
            file[name] = np.array(column) * factor
            if unit:
                file[name].attrs["units"] = unit


@pytest.fixture
def folder(tmp_path):
    motion = tone(8000.0, tilt=TILT)
    write_csv(tmp_path / "shaft.csv", motion)
    write_hdf5(tmp_path / "shaft.h5", motion)
    text = FMR + '\n[shaft.motion]\nfile = "shaft.csv"\n'
    (tmp_path / "seal.toml").write_text(text)
    return tmp_path


RUN = ("run.duration=0.02", "run.samples=100")


def test_csv_and_hdf5_are_the_same(folder):
    by_csv = read_scenario(folder / "seal.toml", RUN)
    by_hdf5 = read_scenario(folder / "seal.toml", [*RUN, "shaft.motion.file=shaft.h5"])
    motion = tone(8000.0, tilt=TILT)
    for found in (by_csv, by_hdf5):
        for name, column in zip(("time", "axial", "tilt_x", "tilt_y"), [motion.time, *motion.columns()], strict=True):
            assert getattr(found.scene.shaft.motion, name) == pytest.approx(column, rel=1e-12, abs=1e-20)
    assert by_csv.with_({"shaft.motion.file": "shaft.h5"}).scene == by_hdf5.scene
    # Whole without the file.
    again = parse_scenario(by_csv.to_toml(), "seal.toml")
    assert again.scene == by_csv.scene and type(by_csv).from_dict(by_csv.to_dict()).scene == by_csv.scene


@pytest.mark.parametrize(
    ("text", "words"),
    [
        (None, "no such file"), ("", "an empty file"), ("time, tilt\n" + "0, 0\n" * 6, "time"),
        ("axial, tilt_x\n" + "0, 0\n" * 6, "axial"), ("time (m), axial\n" + "0, 0\n" * 6, "column time"),
        ("time, axial\n0, 0\n1, nan\n", "sample 2"), ("time, axial\n0, 0\n1, one\n", "line 3"),
        ("time, axial\n0, 0\n1\n", "line 3"), ("time, axial, axial\n0, 0, 0\n", "twice"),
    ],
)  # fmt: skip
def test_what_is_wrong_with_a_file(folder, text, words):
    (folder / "shaft.csv").unlink() if text is None else (folder / "shaft.csv").write_text(text)
    with pytest.raises(ScenarioError) as error:
        read_scenario(folder / "seal.toml", RUN)
    assert error.value.key == "shaft.motion.file" and words in error.value.found and not error.value.others


def test_hdf5_files_that_are_none(folder):
    with h5py.File(folder / "grid.h5", "w") as file:
        file["time"], file["axial"] = np.zeros((6, 2)), np.zeros(6)
    (folder / "text.h5").write_text("time")
    for name in ("grid.h5", "text.h5"):
        with pytest.raises(ScenarioError) as error:
            read_scenario(folder / "seal.toml", [f"shaft.motion.file={name}"])
        assert error.value.key == "shaft.motion.file"


RISING = "time = [0, 1, 2, 3, 4, 5]"
MEASURED = "time = [0, 0.1, 0.2, 0.3, 0.4, 0.5]\naxial_acceleration = [0, 1, 0, 1, 0, 1]"


@pytest.mark.parametrize(
    ("table", "key"),
    [
        ("axial = [1e-6, 2e-6]", "time"),
        ("time = [0, 1, 2]\naxial = [0, 1e-6, 0]", "time"),
        (RISING, "axial"),
        (f"{RISING}\naxial = [0, 1e-6]", "axial"),
        ("time = [0, 1, 2, 2, 4, 5]\naxial = [0, 0, 0, 0, 0, 1e-6]", "time"),
        ("time = [0, 1, 2, 2.0001, 4, 5]\naxial = [0, 0, 0, 0, 0, 1e-6]", "time"),
        ("time = [1, 2, 3, 4, 5, 6]\naxial = [0, 0, 0, 0, 0, 1e-6]", "time"),
        (f"{RISING}\naxial = [0, 0, 0, 0, 0, nan]", "axial.5"),
        (f'{RISING}\naxial = [0, 0, 0, 0, 0, "1 urad"]', "axial"),
        (f"{RISING}\naxial = 1e-6", "axial"),
        (MEASURED, "drift_below"),
        (f"{MEASURED}\ndrift_below = 1", "drift_below"),
        (f"{MEASURED}\ndrift_below = 4\naxial = [0, 1e-6, 0, 0, 0, 0]", "axial_acceleration"),
        (f"{RISING}\naxial = [0, 0, 0, 0, 0, 1e-6]\ndrift_below = 1", "drift_below"),
        (f"{MEASURED}\ndrift_below = 4".replace("[0, 1, 0, 1, 0, 1]", "[0, 1]"), "axial_acceleration"),
    ],
)
def test_what_samples_cannot_be(table, key):
    with pytest.raises(ScenarioError) as error:
        parse_scenario(f"{FMR}\n[housing.motion]\n{table}\n", "seal.toml")
    assert error.value.key == f"housing.motion.{key}"
