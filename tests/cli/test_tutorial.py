"""The tutorial as its reader runs it: a process of its own in an empty folder; its asserts hold what it prints."""

import subprocess
import sys

from command import SCENARIOS

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
    assert [cell.split(".")[0] for cell in cells] == [str(number + 1) for number in range(10)]
    assert all("assert" in cell and len(cell.splitlines()) <= 20 for cell in cells)
