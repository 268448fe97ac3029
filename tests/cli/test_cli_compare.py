"""Two runs side by side."""

import numpy as np
import pytest
from command import REFERENCE, sealdyn

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
