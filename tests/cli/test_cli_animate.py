"""The motion as a film: pictures of a real run, its stretch, its errors."""

import itertools

import numpy as np
import pytest
from command import REFERENCE, sealdyn
from drawn import frames
from hypothesis import given
from hypothesis import strategies as st
from PIL import Image

from sealdyn.report.charts.animation import OPEN, _enlarged, _panels, _Rows
from sealdyn.report.charts.moving import stage
from sealdyn.report.charts.record import Run

TURNS, SAMPLES, PER_TURN = 3, 24, 6


@pytest.fixture(scope="module")
def folder(tmp_path_factory):
    folder = tmp_path_factory.mktemp("film")
    words = ["--set", f"run.turns={TURNS}", "--set", f"run.samples_per_turn={SAMPLES}", "--no-plot"]
    sealdyn("run", REFERENCE, *words, "--out", folder / "a.h5", cwd=folder)
    sealdyn("study", "equilibrium", REFERENCE, "--no-plot", "--out", folder / "study.h5", cwd=folder)
    return folder


def test_pictures_of_a_stretch(folder):
    answer = sealdyn("animate", "a.h5", "--turns", 2, "--per-turn", PER_TURN, cwd=folder)
    assert answer.code == 0 and answer.out.strip() == "a.gif"
    pictures, loop = frames(folder / "a.gif")
    assert loop == 0 and len(pictures) == 2 * PER_TURN + 1
    # Something moves in each of them.
    assert all((one != other).any() for one, other in itertools.pairwise(pictures))


def test_a_still(folder):
    assert sealdyn("animate", "a.h5", "--out", "still.png", cwd=folder).code == 0
    with Image.open(folder / "still.png") as still:
        assert still.width > 800 and not getattr(still, "is_animated", False)


def test_a_video(folder):
    pytest.importorskip("imageio_ffmpeg", reason="an extra: sealdyn[video]")
    assert sealdyn("animate", "a.h5", "--out", "a.mp4", "--turns", 1, "--per-turn", 4, cwd=folder).code == 0
    assert (folder / "a.mp4").read_bytes()[4:8] == b"ftyp"


@pytest.mark.core
def test_the_film_is_that_of_the_archive(folder):
    """At samples the thinnest place is h_min; between them a straight line."""
    run = Run(folder / "a.h5")
    rows, radius, angle = _Rows(run, 5), np.array([[run.film("inner_radius")]]), np.linspace(0, 2 * np.pi, 20_001)
    for k in (0, 7, 20):
        least = rows.thickness(radius, angle, rows.at[k]).min()
        assert least == pytest.approx(run.values("h_min")[5 + k], rel=1e-6)
    between = rows.thickness(radius, angle, 0.5 * (rows.at[3] + rows.at[4]))
    ends = [rows.thickness(radius, angle, rows.at[k]) for k in (3, 4)]
    assert between == pytest.approx(np.mean(ends, axis=0), rel=1e-9)


@given(level=st.floats(1e-7, 1e-4), tilts=st.lists(st.floats(-1e-4, 1e-4).filter(lambda x: abs(x) > 1e-9), min_size=1))
def test_enlarged_tilts_leave_the_gap_open(level, tilts):
    wedge = 0.04 * np.array(tilts)
    times = _enlarged(np.full(len(tilts), level), wedge, np.abs(wedge).max())
    assert times >= 1
    assert times == 1 or (level + times * wedge).min() >= OPEN * level * (1 - 1e-9)


@pytest.mark.parametrize(
    ("words", "said"),
    [
        (["a.h5", "--out", "a.avi"], ".gif"),
        (["study.h5"], "study"),
        (["a.h5", "--per-turn", "100000"], "at most"),
        (["nothing.h5"], "nothing.h5"),
    ],
)
def test_bad_input_is_one_line(words, said, folder):
    before = sorted(folder.iterdir())
    answer = sealdyn("animate", *words, cwd=folder)
    assert answer.code == 2 and said in answer.err and len(answer.err.strip().splitlines()) == 1
    assert sorted(folder.iterdir()) == before


@pytest.mark.parametrize("speed", [1000, -1000])
def test_the_mark_on_the_rotor_turns_as_the_shaft_does(tmp_path, speed):
    words = ["--set", "run.turns=0.7", "--set", f"shaft.speed={speed} rad/s", "--no-plot"]
    assert sealdyn("run", REFERENCE, *words, "--out", "a.h5", cwd=tmp_path).code == 0
    run = Run(tmp_path / "a.h5")
    figure, movers = stage(run, _panels, run.progress[[0, -1]])
    (mark,) = [line for line in figure.axes[1].lines if line.get_marker() == "v"]
    for row in (0, len(run.progress) // 3, -1):
        for move in movers:
            move(run.progress[row])
        shaft = run.values("shaft_angle")[row]
        assert np.cos(mark.get_xdata()[0] - shaft) == pytest.approx(1.0, abs=1e-6)
