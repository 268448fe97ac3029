"""Tables for other programs: CSV and MATLAB files of runs and of a film's coefficients over speed and frequency."""

import csv
import io
import re

import numpy as np
import pytest
from command import REFERENCE, sealdyn
from scipy.io import loadmat

from sealdyn.archive import column


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
