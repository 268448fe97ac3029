"""Files that have no end, and machines that give little: one line within seconds, and nothing is left behind."""

import contextlib
import os
import resource
import subprocess
import sys
from pathlib import Path

import pytest
from command import SCENARIOS, sealdyn

from sealdyn.archive import files, only_writer, partial_path
from sealdyn.scenario.motion_files import whole_file

SEAL = SCENARIOS / "fms_reference.toml"
SHORT = ("--set", "run.turns=1", "--set", "run.samples_per_turn=16", "--no-plot")
PLAIN_C = {"LC_ALL": "C", "PYTHONUTF8": "0", "PYTHONCOERCECLOCALE": "0"}


def told(*words, cwd, limit=None, env=None, patience=100):
    """Exit code and lines of a command, of a machine with one `limit` (resource, most)."""
    given = [sys.executable, "-m", "sealdyn.cli", *map(str, words)]
    limited = (lambda: resource.setrlimit(limit[0], (limit[1], resource.getrlimit(limit[0])[1]))) if limit else None
    among = {**os.environ, **(env or {})}
    done = subprocess.run(
        given, cwd=cwd, env=among, preexec_fn=limited, capture_output=True, timeout=patience, stdin=subprocess.DEVNULL
    )
    lines = done.stderr.decode(errors="replace").splitlines()
    return done.returncode, [line for line in lines if "remaining" not in line and "first run" not in line]


@pytest.mark.parametrize("kind", ["a pipe", "a device", "nothing in it"])
@pytest.mark.parametrize("used", ["scenario", "show", "plot", "run", "start", "motion", "motion in HDF5"])
def test_files_without_an_end(used, kind, tmp_path):
    """Nobody waits for a pipe that no one writes, nor for the messages of a kernel."""
    path = tmp_path / {"scenario": "x.toml", "motion": "x.csv"}.get(used, "x.h5")
    if kind == "a pipe":
        os.mkfifo(path)
    elif kind == "a device":
        path.symlink_to("/dev/zero")
    else:
        path.write_bytes(b"")
    words = {
        "scenario": ["check", path],
        "start": ["run", SEAL, *SHORT, "--set", f"run.start={path}"],
        "motion": ["check", SEAL, "--set", f"shaft.motion={{file='{path}'}}"],
    }
    words["motion in HDF5"] = words["motion"]
    answer = sealdyn(*words.get(used, [used, path]), cwd=tmp_path)
    assert answer.code == 2 and len(answer.err.splitlines()) == 1 and "Traceback" not in answer.err


def test_what_would_wait_is_not_read(tmp_path):
    """Of a file that says nothing now, as the kernel's messages, and of a long one."""
    os.mkfifo(tmp_path / "pipe")
    (tmp_path / "long").write_bytes(bytes(101))
    for name in ("pipe", "long"):
        with pytest.raises(OSError):
            whole_file(tmp_path / name, 100)
    assert len(whole_file(tmp_path / "long", 101)) == 101
    messages = Path("/proc/kmsg")
    if messages.exists() and os.access(messages, os.R_OK) and os.geteuid() == 0:
        with contextlib.suppress(OSError):
            assert len(whole_file(messages, 1 << 20)) <= 1 << 20


def test_a_study_without_descriptors_ends(tmp_path):
    """It waited for workers that had been begun when the next one could not be."""
    words = ("study", "sweep", SEAL, "--vary", "rotor.runout=0:1mrad:5", "--workers", 4, "--no-plot")
    code, lines = told(*words, cwd=tmp_path, limit=(resource.RLIMIT_NOFILE, 20))
    assert code in (0, 2, 4) and len(lines) <= 1


@pytest.mark.parametrize(("most", "verb"), [(100 << 20, "run"), (500 << 20, "check"), (640 << 20, "run")])
def test_little_memory_is_said(most, verb, tmp_path):
    """In place of what libraries and the compiler end the process with: words of their own, or none."""
    code, lines = told(verb, SEAL, *SHORT[:-1], cwd=tmp_path, limit=(resource.RLIMIT_AS, most))
    assert code == 4 and len(lines) == 1 and "ulimit -v" in lines[0]


def test_a_process_that_reads_apart_has_bounds_of_its_own(tmp_path, monkeypatch):
    """Memory, work, and no image of it where it crashes."""
    (tmp_path / "bounded.py").write_text(
        "import resource\nfrom sealdyn.archive.files import bound_this_process\n\nbound_this_process()\n"
        "kinds = resource.RLIMIT_AS, resource.RLIMIT_CORE, resource.RLIMIT_CPU\n"
        "print(*(resource.getrlimit(kind)[0] for kind in kinds))\n"
    )
    monkeypatch.syspath_prepend(tmp_path)
    assert list(map(int, files.read_apart("bounded").stdout.split())) == [files.MEMORY, 0, files.WORK]


def test_memory_for_what_is_not_computed(tmp_path):
    code, lines = told("new", "fms", cwd=tmp_path, limit=(resource.RLIMIT_AS, 500 << 20))
    assert code == 0 and len(lines) == 1 and (tmp_path / "fms.toml").exists()


@pytest.mark.parametrize("setting", [{"NUMBA_DISABLE_JIT": "1"}, {"NUMBA_NUM_THREADS": "0"}])
def test_settings_of_the_compiler_change_nothing(setting, tmp_path):
    """Kernels are compiled and take one thread, whatever is set."""
    code, lines = told("run", SEAL, *SHORT, cwd=tmp_path, env=setting)
    assert code == 0 and not lines


def test_a_reader_that_has_seen_enough_is_no_error(tmp_path):
    ours, theirs = os.pipe()
    os.close(ours)
    given = [sys.executable, "-m", "sealdyn.cli", "schema"]
    done = subprocess.run(given, cwd=tmp_path, stdout=theirs, stderr=subprocess.PIPE, timeout=100)
    os.close(theirs)
    assert done.returncode == 0 and done.stderr == b""


def test_little_time_of_the_processor_is_an_interruption(tmp_path):
    """`ulimit -t`: what was computed is kept."""
    words = ("run", SEAL, "--set", "run.turns=2e5", "--set", "run.samples_per_turn=8", "--no-plot", "--out", "a.h5")
    code, lines = told(*words, cwd=tmp_path, limit=(resource.RLIMIT_CPU, 4))
    assert code == 130 and lines[-1].startswith("interrupted")


def test_no_blocks_on_the_disk(tmp_path):
    code, lines = told("run", SEAL, *SHORT, "--out", "a.h5", cwd=tmp_path, limit=(resource.RLIMIT_FSIZE, 0))
    assert code == 4 and len(lines) == 1 and list(tmp_path.iterdir()) == []


def test_names_of_other_letters_in_a_plain_locale(tmp_path):
    """Run, study, page: the name stays what it is."""
    name = "L\u00e4ufer \u5bc6\u5c01"
    (tmp_path / f"{name}.toml").write_bytes(SEAL.read_bytes())
    for words in (["run", f"{name}.toml", *SHORT[:-1]], ["report", f"outputs/{name}.h5"]):
        code, lines = told(*words, cwd=tmp_path, env=PLAIN_C)
        assert code == 0 and not lines
    assert (tmp_path / "outputs" / f"{name}.h5").exists() and (tmp_path / "report.html").exists()


def test_what_a_killed_writer_left_goes_with_the_next(tmp_path):
    """Half files of archive and partial archive, and its lock."""
    out = tmp_path / "a.h5"
    for left in (out.with_name("a.h5.new"), partial_path(out).with_name("a.partial.h5.new"), tmp_path / ".a.lock"):
        left.write_bytes(b"half")
    with only_writer(out):
        pass
    assert list(tmp_path.iterdir()) == []
