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


# Kernels of a copy are compiled anew.
pytestmark = pytest.mark.slow


@pytest.fixture(scope="module")
def house(tmp_path_factory):
    """A copy of the package with the film and the study of the page, and the environment that finds it."""
    folder = tmp_path_factory.mktemp("house")
    shutil.copytree(ROOT / "sealdyn", folder / "sealdyn", ignore=shutil.ignore_patterns("__pycache__"))
    study, film = re.findall(r"^```python\n(.*?)^```$", (ROOT / "sealdyn" / "README.md").read_text(), re.M | re.S)
    (folder / "sealdyn" / FILM).write_text(film)
    (folder / "sealdyn" / STUDY).write_text(study)
    return folder, {**os.environ, "PYTHONPATH": str(folder)}


def answer(house, *words):
    folder, environment = house
    line = [sys.executable, "-m", "sealdyn.cli", *words, "--json", "--no-plot"]
    done = subprocess.run(line, cwd=folder, env=environment, capture_output=True, text=True)
    assert done.returncode == 0, done.stderr
    return json.loads(done.stdout)


def test_the_film_by_a_table(house):
    scenario = str(ROOT / "scenarios" / "fmr_reference.toml")
    found = answer(house, "run", scenario, "--set", "film.model=table", "--set", "run.turns=5", "--out", "a.h5")
    assert found["status"] == "ok" and found["film"]["axial_stiffness"] == pytest.approx(2e7, rel=1e-6)
    assert found["leakage"]["mean"] is None and found["friction"]["power"] is None


def test_the_study_of_the_tilt(house):
    found = answer(house, "study", "largest-tilt", str(ROOT / "scenarios" / "fms_reference.toml"), "--out", "b.h5",
                   "--workers", "1", "--set", "run.turns=20")  # fmt: skip
    assert len(found["tilt"]) == 3 and found["tables"][0]["rows"]
