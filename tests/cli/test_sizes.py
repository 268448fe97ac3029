"""Sizes are reckoned before they hurt, and numbers of no world are refused by the key that holds them."""

import json
import subprocess
import sys
from pathlib import Path

import pytest

from sealdyn.scenario.errors import ScenarioError
from sealdyn.scenario.reader import parse_scenario, read_scenario
from sealdyn.scene.scene import SceneError
from sealdyn.simulation.plausibility import size_of
from sealdyn.simulation.simulate import simulate

SEAL = Path(__file__).parents[2] / "scenarios" / "fms_reference.toml"
COMMAND = [sys.executable, "-m", "sealdyn.cli"]


def said(*words):
    """Exit code, standard output and lines of standard error of a command without a terminal."""
    found = subprocess.run([*COMMAND, *words], capture_output=True, text=True, timeout=120, stdin=subprocess.DEVNULL)
    return found.returncode, found.stdout, found.stderr.strip().splitlines()


@pytest.mark.parametrize(
    ("override", "key"),
    [("run.turns=1e9", "run.samples_per_turn"), ("run.samples_per_turn=1000000000", "run.samples_per_turn"),
     ("run.duration=1e6 s", "run.samples_per_turn"), ("run.samples=10000000000", "run.samples")],
)  # fmt: skip
def test_a_large_run_is_told_and_not_begun(override, key, tmp_path):
    out = tmp_path / "a.h5"
    code, _, (line,) = said("run", str(SEAL), "--set", override, "--out", str(out))
    assert code == 2 and key in line and "GB" in line and "rows" in line and "--yes" in line
    assert list(tmp_path.iterdir()) == []
    with pytest.raises(SceneError, match="allow_large=True"):
        simulate(read_scenario(SEAL, [override]), out)


def test_a_run_beyond_any_machine_is_not_begun_whatever_is_said(tmp_path):
    code, _, (line,) = said("run", str(SEAL), "--set", "run.turns=1e14", "--yes", "--out", str(tmp_path / "a.h5"))
    assert code == 2 and "years" in line and "--yes" not in line
    with pytest.raises(SceneError):
        simulate(read_scenario(SEAL, ["run.turns=1e14"]), tmp_path / "a.h5", allow_large=True)


@pytest.mark.core
def test_check_tells_the_size():
    size = size_of(read_scenario(SEAL, ["run.turns=1e7"]))
    # Measured: 180 GB.
    assert size.rows == pytest.approx(6.4e8) and 1e11 < size.bytes < 4e11
    code, out, _ = said("check", str(SEAL), "--set", "run.turns=1e7", "--json")
    assert code == 0 and json.loads(out)["size"]["rows"] == pytest.approx(6.4e8)
    code, out, _ = said("check", str(SEAL), "--set", "run.turns=1e7")
    assert "1e+07 turns, 6.4e+08 rows" in out


EXTREME = [
    ("run.turns=1e300", "turns"), ("run.samples=1" + 400 * "0", "samples"), ("film.coning=1e308", "coning"),
    ("film.outer_radius=1e200 m", "outer_radius"), ("shaft.speed=1e100", "speed"), ("film.coning=1e-320", "coning"),
    ("stator.mass=1e100 kg", "mass"), ("closing.balance_ratio='nan'", "balance_ratio"), ("run.turns='inf'", "turns"),
]  # fmt: skip


@pytest.mark.parametrize(("override", "key"), EXTREME)
def test_numbers_of_no_world_are_refused_by_their_key(override, key):
    with pytest.raises(ScenarioError) as refused:
        read_scenario(SEAL, [override])
    assert key in str(refused.value) and "\n" not in str(refused.value) and len(str(refused.value)) < 300


def test_tables_too():
    text = SEAL.read_text().replace('speed = "1000 rad/s"', 'speed = { time = ["0 s", "1 s"], value = [1000, 1e200] }')
    assert "1e200" in text
    with pytest.raises(ScenarioError, match="speed"):
        parse_scenario(text, "seal")
