"""Two runs side by side, and export to other programs."""

import csv
import io
import re

import numpy as np
import pytest
from command import REFERENCE, sealdyn
from scipy.io import loadmat

from sealdyn.archive import column, read_info
from sealdyn.report.comparison import comparison_lines

SHORT = ["--set", "run.turns=2", "--set", "run.samples_per_turn=16", "--no-plot"]


@pytest.fixture(scope="module")
def folder(tmp_path_factory):
    folder = tmp_path_factory.mktemp("two")
    for name, more in (("a", []), ("again", []), ("b", ["--set", "stator.misalignment=50 urad"])):
        assert sealdyn("run", REFERENCE, *SHORT, *more, "--out", f"{name}.h5", cwd=folder).code == 0
    sealdyn("study", "equilibrium", REFERENCE, "--no-plot", "--out", "study.h5", cwd=folder)
    return folder


@pytest.mark.core
def test_what_differs(folder):
    found = sealdyn("compare", "a.h5", "b.h5", "--json", cwd=folder).found
    before = read_info(folder / "a.h5")["resolved"]["stator"]["misalignment"]
    (scene,) = found["scene"]
    assert scene["key"] == "stator.misalignment" and scene["values"] == pytest.approx([before, 50e-6])
    tilts = [read_info(folder / f"{name}.h5")["summary"]["relative_misalignment"]["max"] for name in "ab"]
    (row,) = [row for row in found["summary"] if row["key"] == "relative_misalignment.max"]
    assert row["values"] == tilts and row["change"] == pytest.approx(tilts[1] / tilts[0] - 1)
    (film,) = [row for row in found["series"] if row["name"] == "h_min"]
    apart = np.abs(column(folder / "a.h5", "h_min") - column(folder / "b.h5", "h_min")).max()
    assert film["most"] == pytest.approx(apart)


@pytest.mark.parametrize("words", [["a.h5", "nothing.h5"], ["study.h5", "a.h5"], ["a.h5", "study.h5"]])
def test_bad_input_is_one_line(words, folder):
    answer = sealdyn("compare", *words, cwd=folder)
    assert answer.code == 2 and len(answer.err.strip().splitlines()) == 1
    assert any(word in answer.err for word in ("nothing.h5", "study"))


def test_what_the_accuracy_does_not_resolve_is_no_change():
    """Noise below it has no per cent, films and tilts at the same instants neither."""
    found = {"names": ["a", "b"], "status": ["ok", "ok"], "scene": []}
    tilt = {"key": "relative_misalignment.max", "values": [3.2e-10, 3.5e-10], "change": 0.1, "resolved": [1e-9, 1e-9]}
    film = {"key": "h_min.value", "values": [1e-6, 1.1e-6], "change": 0.1, "resolved": [1e-9, 1e-9]}
    series = [{"name": "h_min", "unit": "m", "most": 1e-7, "resolved": [1e-9, 1e-9]},
              {"name": "relative_misalignment", "unit": "rad", "most": 4e-11, "resolved": [1e-9, 1e-9]}]  # fmt: skip
    thin, small, *same = comparison_lines(found | {"summary": [tilt, film], "series": series})[-4:]
    assert thin.endswith("1 -> 1.1  (+10 %)")
    assert small.endswith("nrad      below 1 -> below 1  (no change that the accuracy resolves)")
    assert same[0].endswith("h_min differs by up to 0.1 um")
    assert same[1].endswith("relative_misalignment has no change that the accuracy resolves (2 nrad)")


def test_the_resolution_is_that_of_each_run(folder):
    found = sealdyn("compare", "a.h5", "b.h5", "--json", cwd=folder).found
    summary = read_info(folder / "a.h5")["summary"]
    (film,) = [row for row in found["summary"] if row["key"] == "h_min.value"]
    assert film["resolved"][0] == summary["accuracy"] * summary["film"]["clearance"]
    assert not any("resolved" in row for row in found["summary"] if row["key"] == "friction.power")


def test_coefficients_over_speed_and_frequency(tmp_path):
    words = ["--points", 3, "--frequency", "0:2kHz:4", "--no-plot", "--out", "c.h5"]
    done = sealdyn("study", "coefficients", REFERENCE, *words, "--json", cwd=tmp_path)
    table = done.found["table"]
    assert len(table) == 20 and {len(values) for values in table.values()} == {12}
    assert table["frequency"][:4] == pytest.approx((2 * np.pi * np.linspace(0, 2000, 4)).tolist())
    # At the scene's own speed the matrices are the answer's.
    at = table["speed"].index(min(table["speed"], key=lambda w: abs(w - done.found["at"]["speed"])))
    assert table["k_tilt_x_tilt_x"][at] == pytest.approx(done.found["stiffness"][1][1], rel=1e-9)
    assert table["d_axial_axial"][at] == pytest.approx(done.found["damping"][0][0], rel=1e-9)

    printed = sealdyn("show", "c.h5", "--csv", cwd=tmp_path).out
    rows = list(csv.DictReader(io.StringIO(printed)))
    assert [float(row["k_tilt_x_tilt_y [N*m/rad]"]) for row in rows] == table["k_tilt_x_tilt_y"]
    assert [float(row["frequency [rad/s]"]) for row in rows] == table["frequency"]
    heads = [
        sealdyn("show", "c.h5", "--csv", "--table", "against_clearance", "--units", units, cwd=tmp_path).out.split("]")[
            0
        ]
        for units in ("si", "read")
    ]
    assert [head.rpartition(" ")[2] for head in heads] == ["[m", "[um"]
    assert sealdyn("show", "c.h5", "--mat", "c.mat", cwd=tmp_path).code == 0
    found = loadmat(tmp_path / "c.mat")
    assert {name: found[name][:, 0].tolist() for name in table} == table
    # For a person the verdict, as the study printed it.
    assert done.found["verdict"][0] in sealdyn("show", "c.h5", cwd=tmp_path).out


@pytest.mark.core
def test_a_run_for_matlab(tmp_path):
    sealdyn("run", REFERENCE, "--set", "run.turns=2", "--no-plot", "--out", "x.h5", cwd=tmp_path)
    done = sealdyn("show", "x.h5", "--mat", "x.mat", cwd=tmp_path)
    assert done.code == 0 and re.fullmatch(r"x\.mat: \d+ series of the run, \d+ rows", done.out.strip())
    found = loadmat(tmp_path / "x.mat")
    for name in ("time", "h_min", "mass_flow_outer"):
        assert np.array_equal(found[name][:, 0], column(tmp_path / "x.h5", name))


def test_what_cannot_be_exported_says_so(tmp_path):
    sealdyn("study", "equilibrium", REFERENCE, "--no-plot", "--out", "e.h5", cwd=tmp_path)
    sealdyn("run", REFERENCE, "--set", "run.turns=1", "--no-plot", "--out", "r.h5", cwd=tmp_path)
    asked = {
        ("e.h5", "--csv"): "one of roots, curve",
        ("e.h5", "--table", "curv", "--mat", "e.mat"): "nearest 'curve'",
        ("e.h5", "--mat", "e.txt"): ".mat",
        ("r.h5", "--table", "curve"): "archive of a run",
    }
    for words, hint in asked.items():
        done = sealdyn("show", *words, cwd=tmp_path)
        assert done.code == 2 and hint in done.err and len(done.err.splitlines()) == 1
    assert not (tmp_path / "e.mat").exists()
    done = sealdyn("show", "e.h5", "--table", "curve", "--mat", "e.mat", cwd=tmp_path)
    assert done.code == 0 and "columns of the table curve" in done.out and done.out.endswith("241 rows\n")
    assert loadmat(tmp_path / "e.mat")["opening_force"].shape == (241, 1)
