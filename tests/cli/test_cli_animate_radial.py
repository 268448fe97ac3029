"""The motion of a radial seal as a film: pictures of real runs, what stands in them, their errors."""

import itertools
from dataclasses import replace
from functools import partial

import numpy as np
import pytest
from command import SCENARIOS, sealdyn
from drawn import frames, panel
from PIL import Image

from sealdyn.archive import FIELD_TIME, column, field
from sealdyn.radial_seals.model import RadialModel, RadialRun
from sealdyn.report.charts.followers import REACH, Around, moving_panels
from sealdyn.report.charts.moving import moments, stage
from sealdyn.report.charts.page import CONTACT, FILM
from sealdyn.report.charts.record import Run
from sealdyn.scenario.reader import read_scenario
from sealdyn.simulation.simulate import simulate
from sealdyn.solvers.contract import Status
from sealdyn.solvers.integrate import solve

LIP, SEGMENTS = (SCENARIOS / "radial" / f"{name}_reference.toml" for name in ("lip", "circumferential"))
TURNS, SAMPLES, PER_TURN = 3, 24, 6
LOST = ("shaft.eccentricity=0.3 mm", f"run.turns={TURNS}", f"run.samples_per_turn={SAMPLES}")


def run(path, out, *values):
    words = [word for value in values for word in ("--set", value)]
    done = sealdyn("run", path, *words, "--no-plot", "--out", out, cwd=out.parent)
    assert done.code == 0, done.err
    return Run(out)


def staged(found, turns=2.0, per_turn=PER_TURN):
    """Figure, what moves it, and the progress of its pictures."""
    around = Around(found)
    at = around.nearest(moments(found, turns, per_turn, found.path))
    return *stage(found, partial(moving_panels, around), at), at


@pytest.fixture(scope="module")
def folder(tmp_path_factory):
    folder = tmp_path_factory.mktemp("film")
    run(SEGMENTS, folder / "a.h5", *LOST)
    lobes = "shaft.lobes=[{order = 3, amplitude = '0.02 mm', phase = '40 deg'}]"
    run(LIP, folder / "rides.h5", "run.turns=2", "shaft.speed='-3000 rpm'", lobes, "shaft.offset_direction='70 deg'")
    return folder


def test_pictures_of_a_stretch(folder):
    answer = sealdyn("animate", "a.h5", "--turns", 2, "--per-turn", PER_TURN, cwd=folder)
    assert answer.code == 0 and answer.out.strip() == "a.gif"
    pictures, loop = frames(folder / "a.gif")
    assert loop == 0 and len(pictures) == 2 * PER_TURN + 1
    assert all((one != other).any() for one, other in itertools.pairwise(pictures))


def test_the_shaft_is_that_of_the_equations(folder):
    """Offset, eccentricity and lobes on a shaft that turns backward, at every kept instant."""
    around = Around(Run(folder / "rides.h5"))
    scenario = read_scenario(folder / "rides.h5")
    segment = RadialRun(RadialModel(scenario.scene, 1e-6), 0.1).segment()
    times = field(folder / "rides.h5", FIELD_TIME)
    assert len(around.at) == len(times) > 100
    for k in (0, 1, 50, len(times) - 1):
        there = segment.surface(times[k])[:, 0]
        np.testing.assert_allclose(around.surface(around.theta, around.at[k]), there, atol=1e-12)
    # It rides: the followers stand on it.
    np.testing.assert_allclose(around.displacement(around.at[50]), segment.surface(times[50])[:, 0], atol=1e-12)


def test_followers_stand_where_the_gap_says(folder):
    """A foot is as far from the enlarged shaft as the enlarged gap, and of the colour of what it does."""
    found = Run(folder / "a.h5")
    figure, movers, at = staged(found)
    around, ax = Around(found), panel(figure, "Cross-section")
    times = float(ax.get_title("left").split()[-3])
    feet, shaft = ax.collections[0], ax.patches[0]
    radius, seen = 25.0, set()
    assert times * 1e3 * around.reach(at) <= REACH * radius
    for moment in at:
        for move in movers:
            move(moment)
        gaps, loads = (around.values(name, moment) for name in ("gap", "follower_load"))
        ring = shaft.get_xy()
        for j, path in enumerate(feet.get_paths()):
            towards = np.array([np.cos(around.theta[j]), np.sin(around.theta[j])])
            foot = (path.vertices @ towards).min()
            surface = radius + times * 1e3 * around.surface(around.theta[j], moment)
            assert foot == pytest.approx(surface + times * 1e3 * gaps[j], abs=3e-3 * radius)
            assert np.abs(ring @ towards - surface).min() < 0.02 * radius
            colour = tuple(np.round(feet.get_facecolor()[j][:3], 3))
            seen.add((loads[j] <= 0, colour))
    colours = [tuple(np.round([int(c[k : k + 2], 16) / 255 for k in (1, 3, 5)], 3)) for c in (CONTACT, FILM)]
    assert seen == {(False, colours[0]), (True, colours[1])}


@pytest.mark.core
def test_gap_and_load_are_those_of_the_archive(folder):
    found = Run(folder / "a.h5")
    figure, movers, at = staged(found)
    k = 7
    for move in movers:
        move(at[k])
    row = int(np.argmin(np.abs(found.progress - at[k])))
    gap, load = (panel(figure, title) for title in ("Gap around the shaft", "Load around the shaft"))
    values, edges, _ = gap.patches[0].get_data()
    assert values.max() == pytest.approx(1e6 * column(found.path, "largest_gap")[row])
    np.testing.assert_allclose(0.5 * (edges[1:] + edges[:-1]), np.degrees(field(found.path, "theta")), atol=1e-9)
    assert load.patches[0].get_data()[0].sum() == pytest.approx(column(found.path, "load")[row])
    # Nothing leaves its panel at any picture.
    for ax in (gap, load):
        low, high = ax.get_ylim()
        for moment in at:
            for move in movers:
                move(moment)
            drawn = ax.patches[0].get_data()[0]
            assert low <= drawn.min() and drawn.max() <= high


def test_pictures_are_of_kept_instants_only(tmp_path, monkeypatch):
    """Of a long run few instants of a turn are kept: no picture between them is made up, and it is said."""
    monkeypatch.setattr("sealdyn.simulation.sinks.MOST_RADIAL", 120)
    found = run(SEGMENTS, tmp_path / "long.h5", "run.turns=20")
    figure, _, at = staged(found, 4.0, 36)
    kept = np.interp(field(found.path, FIELD_TIME), found.values("time"), found.progress)
    assert set(at) <= set(kept) and 20 <= len(at) <= 30 and (np.diff(at) > 0).all()
    assert f"{len(at)} kept instants" in panel(figure, "Cross-section").get_xlabel()


def test_a_run_that_failed_or_was_broken_off(tmp_path, monkeypatch):
    """As far as it went; of an archive without a single instant one line."""
    looks = iter(range(10_000))
    scenario = read_scenario(SEGMENTS, ["run.turns=3", "shaft.eccentricity='0.3 mm'"])
    part = simulate(scenario, tmp_path / "part.h5", stop=lambda: next(looks) > 12)
    assert part.status == "interrupted"
    assert sealdyn("animate", part.archive, "--out", tmp_path / "part.gif", cwd=tmp_path).code == 0
    monkeypatch.setattr(
        "sealdyn.simulation.simulate.solve",
        lambda *args, **more: replace(solve(*args, **more), status=Status.FAILED, message="gave up"),
    )
    failed = simulate(scenario, tmp_path / "failed.h5")
    assert failed.status == "failed"
    assert sealdyn("animate", failed.archive, "--out", tmp_path / "failed.png", cwd=tmp_path).code == 0
    monkeypatch.setattr("sealdyn.simulation.sinks.MOST_RADIAL", 0)
    none = simulate(scenario, tmp_path / "none.h5")
    refused = sealdyn("animate", none.archive, cwd=tmp_path)
    assert refused.code == 2 and "no gap around the shaft" in refused.err and refused.err.strip().count("\n") == 0


def test_a_shaft_that_stands_still(tmp_path):
    """Its pictures are of milliseconds."""
    run(SEGMENTS, tmp_path / "still.h5", "shaft.speed=0", "run.duration='20 ms'")
    answer = sealdyn("animate", "still.h5", "--turns", 2, "--per-turn", 4, cwd=tmp_path)
    assert answer.code == 0, answer.err
    with Image.open(tmp_path / "still.gif") as film:
        assert film.n_frames >= 1
