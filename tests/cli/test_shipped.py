"""What comes with the program: its scenarios by name, its version, completion of words; from a wheel, too."""

import os
import shutil
import subprocess
import sys
import tomllib
import zipfile
from pathlib import Path

import pytest
from command import SCENARIOS, sealdyn

import sealdyn as package
from sealdyn import ScenarioError, example, examples, read_scenario

ROOT = SCENARIOS.parent
PATHS = {path.stem: path for path in sorted(SCENARIOS.rglob("*.toml"), key=lambda path: path.stem)}
NAMES = [*PATHS]


@pytest.mark.core
def test_every_scenario_is_listed_with_its_question(tmp_path):
    answer = sealdyn("list", cwd=tmp_path)
    lines = answer.out.splitlines()
    assert answer.code == 0 and str(SCENARIOS) in lines[0]
    assert [line.split()[0] for line in lines[1:]] == NAMES
    assert all(line.endswith("?") for line in lines[1:])
    found = sealdyn("list", "--json", cwd=tmp_path).found["scenarios"]
    assert {row["name"]: row["question"] for row in found} == examples()
    assert [row["file"] for row in found] == [*map(str, PATHS.values())]


def test_a_scenario_is_read_by_its_name():
    for name in NAMES:
        assert example(name) == read_scenario(PATHS[name])
        assert example(name).question.split()[:3] == examples()[name].split()[:3]
    for wrong in ("fms_referense", "../scenarios/fms_reference", ""):
        with pytest.raises(ScenarioError) as refused:
            example(wrong)
        assert "sealdyn list" in str(refused.value) and "\n" not in str(refused.value)
    with pytest.raises(ScenarioError, match="nearest 'fms_reference'"):
        example("fms_referense")


def test_the_version_is_that_of_the_package(tmp_path):
    answer = sealdyn("--version", cwd=tmp_path)
    version = tomllib.loads((ROOT / "pyproject.toml").read_text())["project"]["version"]
    assert answer == (0, f"sealdyn {version}\n", "") and package.__version__ == version


def test_every_folder_is_a_package_that_is_named():
    named = tomllib.loads((ROOT / "pyproject.toml").read_text())["tool"]["setuptools"]["packages"]
    folders = {path.parent.relative_to(ROOT) for path in (ROOT / "sealdyn").rglob("*.py")}
    assert sorted(named) == sorted([*(".".join(folder.parts) for folder in folders), "sealdyn.scenarios"])


@pytest.mark.slow
def test_a_wheel_holds_the_scenarios(tmp_path):
    """Built of a copy, since building leaves files beside the sources; nothing of it is run, kernels would compile."""
    source, installed = tmp_path / "source", tmp_path / "installed"
    for folder in ("sealdyn", "scenarios"):
        shutil.copytree(ROOT / folder, source / folder, ignore=shutil.ignore_patterns("__pycache__"))
    for name in ("pyproject.toml", "README.md", "LICENSE"):
        shutil.copy(ROOT / name, source / name)
    pip = [sys.executable, "-m", "pip", "--quiet", "--disable-pip-version-check"]
    subprocess.run([*pip, "wheel", "--no-deps", "--wheel-dir", tmp_path, source], check=True)
    (wheel,) = tmp_path.glob("*.whl")
    with zipfile.ZipFile(wheel) as file:
        held = {Path(name) for name in file.namelist() if ".dist-info" not in name}
    sources = {path.relative_to(source) for path in (source / "sealdyn").rglob("*.py")}
    scenarios = {path.relative_to(source) for path in (source / "scenarios").rglob("*") if path.is_file()}
    shipped = {"sealdyn" / path for path in scenarios}
    data = {".toml", ".html", ".json"}
    others = {path.relative_to(source) for path in (source / "sealdyn").rglob("*") if path.suffix in data}
    assert held == sources | shipped | others | {Path("sealdyn/py.typed")}

    subprocess.run([*pip, "install", "--no-deps", "--target", installed, wheel], check=True)
    code = "import sealdyn; print(sealdyn.__file__, *(sealdyn.example(name).name for name in sealdyn.examples()))"
    environment = os.environ | {"PYTHONPATH": str(installed)}
    done = subprocess.run(
        [sys.executable, "-c", code], cwd=tmp_path, env=environment, capture_output=True, text=True, check=True
    )
    place, *names = done.stdout.split()
    assert Path(place).is_relative_to(installed) and names == NAMES
