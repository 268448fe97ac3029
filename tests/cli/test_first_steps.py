"""What stands at the beginning: the first screen, its commands, and what the shell completes."""

import os
import subprocess
import sys

import pytest
from command import finished, sealdyn, started

from sealdyn.analysis.validation import source_names
from sealdyn.cli import CHARTS, FIRST_STEPS
from sealdyn.scenario.templates import kinds
from sealdyn.studies import study_names


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
        answer = finished(started(*words, cwd=tmp_path))
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
    ("sealdyn study ", study_names()), ("sealdyn study st", ["stability", "steady-state"]),
    ("sealdyn new ", kinds()), ("sealdyn new fms", ["fms", "fmsr"]), ("sealdyn validate ", source_names()),
    ("sealdyn plot a.h5 --kind ", [*CHARTS]), ("sealdyn run a.toml --no", ["--no-plot"]),
])  # fmt: skip
def test_the_shell_completes_what_there_is_a_choice_of(line, offered):
    assert sorted(completed(line)) == sorted(offered)
