"""The examples on the page of the house run as they stand there."""

import json
import os
import re
import shutil
import subprocess
import sys
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[2]
FILM, STUDY = "films/table.py", "studies/largest_tilt.py"


@pytest.fixture(scope="module")
def house(tmp_path_factory):
    """A folder with the film and the study of the page, and the environment that finds them."""
    folder = tmp_path_factory.mktemp("house")
    study, film = re.findall(r"^```python\n(.*?)^```$", (ROOT / "sealdyn" / "README.md").read_text(), re.M | re.S)
    for name, text in ((FILM, film), (STUDY, study)):
        (folder / name).parent.mkdir()
        (folder / name).write_text(text)
    return folder, {**os.environ, "SEALDYN_PATH": str(folder)}


def begun(house, *words, **environment):
    folder, found = house
    line = [sys.executable, "-m", "sealdyn.cli", *words, "--json", "--no-plot"]
    return subprocess.run(line, cwd=folder, env={**found, **environment}, capture_output=True, text=True)


def answer(house, *words):
    done = begun(house, *words)
    assert done.returncode == 0, done.stderr
    return json.loads(done.stdout)


def test_the_film_by_a_table(house):
    scenario = str(ROOT / "scenarios" / "fmr_reference.toml")
    found = answer(house, "run", scenario, "--set", "film.model=table", "--set", "run.turns=5", "--out", "a.h5")
    assert found["status"] == "ok" and found["film"]["axial_stiffness"] == pytest.approx(2e7, rel=1e-6)
    assert found["leakage"]["mean"] is None and found["friction"]["power"] is None
    again = answer(house, "run", "a.h5", "--out", "again.h5")
    assert again["film"] == found["film"]
    near = json.loads(begun(house, "run", scenario, "--set", "film.model=tabel").stdout)
    assert "table" in near["message"]


def test_names_of_the_package_are_taken(house):
    """By no file outside, and "auto" chooses none from there."""
    folder, _ = house
    other = folder / "taken"
    (other / "films").mkdir(parents=True)
    (other / "films" / "radial.py").write_text("raise ValueError('never read')\n")
    shutil.copy(folder / FILM, other / FILM)
    scenario = str(ROOT / "scenarios" / "fms_reference.toml")
    for model in ("radial", "auto"):
        words = ("run", scenario, "--set", f"film.model={model}", "--set", "run.turns=2", "--out", "d.h5")
        found = json.loads(begun(house, *words, SEALDYN_PATH=str(other)).stdout)
        assert found["status"] == "ok" and found["model"]["film"] in ("radial", "linear")


def test_the_study_of_the_tilt(house):
    found = answer(house, "study", "largest-tilt", str(ROOT / "scenarios" / "fms_reference.toml"), "--out", "b.h5",
                   "--workers", "1", "--set", "run.turns=20")  # fmt: skip
    assert len(found["tilt"]) == 3 and found["tables"][0]["rows"]
