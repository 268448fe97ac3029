"""Archives that another program holds open, and file systems without locks: held is not damaged."""

import errno
import fcntl
import os
import subprocess
import sys

import pytest
from command import SCENARIOS, said, sealdyn

from sealdyn.archive import ArchiveError, only_writer
from sealdyn.scenario.reader import read_scenario
from sealdyn.simulation.simulate import simulate

SEAL = SCENARIOS / "fms_reference.toml"
SHORT = ("run.turns=1", "run.samples_per_turn=16")
HOLD = "import h5py, sys, time\nwith h5py.File(sys.argv[1], 'r+'):\n    print('held', flush=True)\n    time.sleep(600)"
WITHOUT = "HDF5_USE_FILE_LOCKING"


@pytest.fixture
def held(tmp_path):
    """An archive that another process holds open."""
    path = tmp_path / "held.h5"
    simulate(read_scenario(SEAL, SHORT), tmp_path / "other.h5")
    path.write_bytes((tmp_path / "other.h5").read_bytes())
    with subprocess.Popen([sys.executable, "-c", HOLD, path], stdout=subprocess.PIPE) as process:
        process.stdout.readline()
        yield path
        process.kill()


@pytest.mark.parametrize("verb", ["show", "plot", "run", "compare", "start"])
def test_a_file_held_open_is_not_called_damaged(verb, held):
    words = {
        "compare": ["compare", held, held.with_name("other.h5")],
        "start": ["run", SEAL, "--set", f"run.start={held}", "--out", held.with_name("new.h5")],
    }.get(verb, [verb, held])
    answer = sealdyn(*words, cwd=held.parent)
    assert answer.code == 2 and WITHOUT in answer.err and "damaged" not in answer.err
    assert len(said(answer.err)) == 1


def test_without_locks_it_is_read(held):
    words = [sys.executable, "-m", "sealdyn.cli", "show", str(held)]
    done = subprocess.run(words, capture_output=True, env={**os.environ, WITHOUT: "FALSE"}, timeout=60)
    assert done.returncode == 0 and done.stderr == b""


@pytest.mark.parametrize("number", [errno.ENOSYS, errno.ENOLCK, errno.EOPNOTSUPP])
def test_a_file_system_without_locks(number, tmp_path, monkeypatch):
    """Said; and written there all the same where the locks of HDF5 are switched off, or only tried."""

    def refused(*_):
        raise OSError(number, "no locks")

    monkeypatch.setattr(fcntl, "flock", refused)
    with pytest.raises(ArchiveError, match=WITHOUT), only_writer(tmp_path / "a.h5"):
        pass
    assert list(tmp_path.iterdir()) == []
    for without in ("FALSE", "BEST_EFFORT"):
        monkeypatch.setenv(WITHOUT, without)
        result = simulate(read_scenario(SEAL, SHORT), tmp_path / "a.h5")
        assert result.status == "ok" and [path.name for path in tmp_path.iterdir()] == ["a.h5"]
