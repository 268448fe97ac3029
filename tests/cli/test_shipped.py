"""What comes with the program: scenarios by name, first steps, completion of words, the tutorial, a wheel."""

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
from sealdyn.analysis.sources import source_names
from sealdyn.cli import CHARTS, FIRST_STEPS
from sealdyn.scenario.templates import kinds
from sealdyn.studies import study_names

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
    data = {".toml", ".html", ".json", ".pyi"}
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


def test_the_first_screen_says_what_to_do_and_fits(tmp_path):
    answer = sealdyn(cwd=tmp_path)
    assert answer.code == 0 and not answer.err and max(map(len, answer.out.splitlines())) <= 100
    lines = [line.split("  ")[1] for line in answer.out.splitlines() if line.startswith("  ")]
    assert lines == [line for line, _ in FIRST_STEPS]
    helped = " ".join(sealdyn("--help", cwd=tmp_path).out.split())
    assert all(line in helped for line, _ in FIRST_STEPS[:-2])


@pytest.mark.slow
def test_its_commands_work_one_after_the_other(tmp_path):
    """As typed, in an empty folder."""
    for line, _ in FIRST_STEPS:
        _, *words = line.split()
        answer = sealdyn(*words, cwd=tmp_path)
        assert answer.code == 0, (line, answer.err)
    made = {str(path.relative_to(tmp_path)) for path in tmp_path.rglob("*.*") if path.is_file()}
    of_study = {f"outputs/fms-stability.{kind}" for kind in ("h5", "png")}
    assert made == {"fms.toml", "outputs/fms.h5", "outputs/fms.png"} | of_study


@pytest.mark.core
def test_a_study_without_a_name_names_them(tmp_path):
    helped = " ".join(sealdyn("study", "--help", cwd=tmp_path).out.split())
    assert all(f"{name}: " in helped.replace("- ", "-") for name in study_names())


def completed(line: str, shell="bash") -> list[str]:
    """What the shell offers at the end of a command line."""
    words = line.split(" ")
    asked = {"COMP_WORDS": line, "COMP_CWORD": str(len(words) - 1), "_SEALDYN_COMPLETE": f"complete_{shell}"}
    code = "import sys; sys.argv = ['sealdyn']; from sealdyn.cli import main; main()"
    return subprocess.run(
        [sys.executable, "-c", code], env=os.environ | asked, capture_output=True, text=True, check=True
    ).stdout.split()


@pytest.mark.parametrize(("line", "offered"), [
    ("sealdyn study ", study_names()), ("sealdyn study st", ["stability", "steady-state", "stribeck"]),
    ("sealdyn new ", kinds()), ("sealdyn new fms", ["fms", "fmsr"]), ("sealdyn validate ", source_names()),
    ("sealdyn plot a.h5 --kind ", [*CHARTS]), ("sealdyn run a.toml --no", ["--no-plot"]),
])  # fmt: skip
def test_the_shell_completes_what_there_is_a_choice_of(line, offered):
    assert sorted(completed(line)) == sorted(offered)


TUTORIAL = SCENARIOS / "tutorial.py"
LEFT = {"fms.toml", "better.toml", "review.html"}
OUTPUTS = {f"outputs/{name}" for name in (
    "first.h5", "first.png", "better.h5", "better-stability.h5", "better-stability.png",
)}  # fmt: skip


def test_the_tutorial_does_what_it_says(tmp_path):
    done = subprocess.run([sys.executable, TUTORIAL], cwd=tmp_path, capture_output=True, text=True, timeout=600)
    assert done.returncode == 0, done.stderr
    made = {path.relative_to(tmp_path).as_posix() for path in tmp_path.rglob("*") if path.is_file()}
    assert made == LEFT | OUTPUTS


def test_every_cell_is_short_and_holds_a_number_to_what_it_says():
    _, *cells = TUTORIAL.read_text().split("\n# %% ")
    assert [cell.split(".")[0] for cell in cells] == [str(number + 1) for number in range(11)]
    assert all("assert" in cell and len(cell.splitlines()) <= 20 for cell in cells)
