"""Two runs or studies on one output: the second is turned away, the first is not touched, a dead one holds nothing."""

import os
import signal

import pytest
from command import SCENARIOS, said, sealdyn, settings, started, until
from killed import COMMAND, kill_midway

from sealdyn.archive import ArchiveError, only_writer, read_info
from sealdyn.scenario.reader import read_scenario
from sealdyn.simulation.simulate import simulate
from sealdyn.studies._runner import run_study

SEAL = SCENARIOS / "fms_reference.toml"
RUN = ["run", SEAL, "--no-plot", *settings({"run.turns": 200000, "run.samples_per_turn": 8}), "--out"]


def turned_away(words, out):
    """One line, exit code 2, of this process: the other one writes."""
    code, _, err = sealdyn(*words, cwd=out.parent)
    assert code == 2, err
    (line,) = said(err)
    assert str(out) in line and "another run or study is writing it" in line and "--out" in line


def left(folder):
    return sorted(path.name for path in folder.iterdir())


def test_the_second_run_is_turned_away_and_a_dead_one_holds_nothing(tmp_path):
    out = tmp_path / "a.h5"
    partial = tmp_path / "a.partial.h5"
    first = started(*RUN, out, cwd=tmp_path)
    until(partial.exists, first, timeout=120)
    try:
        turned_away([*RUN, out], out)
        turned_away([*RUN, out, "--continue"], out)
        turned_away(["study", "critical-speed", SEAL, "--out", out, "--workers", 1], out)
        with pytest.raises(ArchiveError, match="another run or study"):
            simulate(read_scenario(SEAL), out)
        with pytest.raises(ArchiveError, match="another run or study"):
            run_study("equilibrium", read_scenario(SEAL), out)
        assert first.poll() is None
    finally:
        os.kill(first.pid, signal.SIGKILL)
        first.wait()
    kept = read_info(partial)["rows"]
    assert kept > 0
    assert sealdyn(*RUN, out, "--set", "run.turns=2", cwd=tmp_path).code == 0
    assert read_info(out)["status"] == "ok" and left(tmp_path) == ["a.h5"]


def test_workers_of_a_dead_study_hold_nothing(tmp_path):
    out = tmp_path / "s.h5"
    command = [*COMMAND, "sweep", str(SEAL), "--out", str(out), "--no-plot", "--workers", "2",
               "--vary", "shaft.speed=8000 rpm:12000 rpm:40", "--outputs", "h_min.value"]  # fmt: skip
    kill_midway(command, tmp_path / "s.partial.jsonl", 1)
    # At once, whether or not its workers have noticed.
    again = sealdyn(*command[command.index("study") :], cwd=tmp_path)
    assert again.code == 0, again.err
    assert left(tmp_path) == ["s.h5"]


@pytest.mark.core
def test_a_lock_is_of_the_file_not_of_its_name(tmp_path):
    (tmp_path / "link.h5").symlink_to(tmp_path / "a.h5")
    with only_writer(tmp_path / "a.h5"):
        with pytest.raises(ArchiveError), only_writer(tmp_path / "link.h5"):
            pass
        with only_writer(tmp_path / "b.h5"):
            pass
    with only_writer(tmp_path / "a.h5"):
        pass
    assert left(tmp_path) == ["link.h5"]
