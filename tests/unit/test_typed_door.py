"""The public names as a type checker sees them."""

import os
import re
import subprocess
import sys
from pathlib import Path

import pytest
import typed_door
from command import SCENARIOS

import sealdyn

SCRIPT = Path(typed_door.__file__)
# What a checker must refuse, a line each.
WRONG = """import sealdyn
sealdyn.simulat("pump.toml")
sealdyn.run(3)
sealdyn.run("pump.toml", out=3)
sealdyn.study("equilibrium", "pump.toml").data.h_mni + 1 + sealdyn.__version__.year
sealdyn.examples() + 1
sealdyn.example("fms_reference").with__({})
sealdyn.run("pump.toml").plot.orbits()
sealdyn.study("equilibrium", "pump.toml", pionts=61)
sealdyn.study("equilibrium", "pump.toml", points="many")
sealdyn.study("equilibirum", "pump.toml")
sealdyn.Simulation("pump.toml").step("1 ms")
"""


@pytest.mark.core
def test_every_public_name_is_in_the_script():
    assert set(re.findall(r"sealdyn\.(\w+)", SCRIPT.read_text())) == {*sealdyn.__all__, "__version__"}


def test_the_script_runs(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    typed_door.main(tmp_path)
    assert {path.name for path in tmp_path.iterdir()} == {"kept.h5", "e.h5", "page.html", "moved.png"}


@pytest.mark.slow
def test_a_type_checker_agrees_and_finds_what_is_wrong(tmp_path):
    """Of the script, of the examples of scenarios/own, and of lines that are wrong: one start for all."""
    pytest.importorskip("mypy", reason='mypy is not installed: pip install -e ".[test]"')
    wrong, own = tmp_path / "wrong.py", sorted((SCENARIOS / "own").glob("*/*.py"))
    wrong.write_text(WRONG)
    # A checker does not see through the finder of an editable installation: it is shown the folder,
    # and asked of these files alone.
    words = [sys.executable, "-m", "mypy", "--config-file=", "--strict", "--follow-imports=silent"]
    place = os.environ | {"MYPYPATH": str(Path(sealdyn.__file__).parents[1])}
    words += ["--cache-dir", tmp_path / "cache", SCRIPT, *own, wrong]
    done = subprocess.run(words, capture_output=True, text=True, cwd=SCRIPT.parent, env=place)
    errors = re.findall(r"^(.*?)(\w+\.py):(\d+): error: ", done.stdout, re.MULTILINE)
    found = {int(line) for _, name, line in errors if name == wrong.name}
    assert len(own) == 3 and found == set(range(2, WRONG.count("\n") + 1)), done.stdout
    assert all(name == wrong.name for _, name, _ in errors), done.stdout
