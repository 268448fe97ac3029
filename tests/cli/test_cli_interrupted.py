"""Ctrl-C, kill -9 and going on: nothing that was written is lost, and the end is that of an unbroken run."""

import csv
import io
import json
import os
import random
import signal
import subprocess
import sys
import time
from pathlib import Path

import pytest
from command import REFERENCE, SCENARIOS, finished, sealdyn, settings, started, until
from killed import mark_first

from sealdyn.archive import ArchiveError, column, field, partial_path, read_info

# Both rings' forcing, no sample beyond need; several blocks of steps.
TURNS, PER_TURN = 600, 8
LONG = settings({"run.turns": TURNS, "run.samples_per_turn": PER_TURN})
# The program, which does something to itself at a point of its progress, told `done` of `end` (s): no machine is too
# fast or too slow for that.  What has been computed is written at once.
ITSELF = """
import os, signal, sys
from sealdyn import cli
from sealdyn.archive import ArchiveWriter

ArchiveWriter.__init__.__kwdefaults__["interval"] = 0.0
once = []

class Told(cli.Progress):
    def __enter__(self):
        {first}
        return super().__enter__()

    def __call__(self, done, end, words=None):
        super().__call__(done, end, words)
        if {when} and not once:
            once.append({then})

cli.Progress = Told
sys.argv[0] = "sealdyn"
cli.main()
"""
SCALES = {"rotor_z": 1e-5, "rotor_tilt_x": 1e-5 / 0.04, "rotor_tilt_y": 1e-5 / 0.04, "h_min": 1e-5, "time": 1.0}
PRESSURE = 5e5


def rows(path) -> int:
    """Rows that count in an archive, none if there is none yet."""
    try:
        return read_info(path)["rows"]
    except ArchiveError:
        return 0


def itself(*words, cwd, when="False", then="None", first="pass"):
    """The program as a process of its own that does `first` as its progress begins, and `then` once when `when`."""
    line = [sys.executable, "-c", ITSELF.format(when=when, then=then, first=first), *map(str, words)]
    return subprocess.Popen(line, cwd=cwd, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)


def agree(path, other, accuracy=1e-6):
    """Both archives end alike, and are alike on the way."""
    count = rows(path)
    assert count == rows(other)
    for name, scale in SCALES.items():
        assert column(path, name) == pytest.approx(column(other, name), rel=0, abs=accuracy * scale), name
    assert (field(path, "field_time") == field(other, "field_time")).all() and len(field(path, "field_time")) == 32
    assert field(path, "pressure") == pytest.approx(field(other, "pressure"), rel=0, abs=100 * accuracy * PRESSURE)


@pytest.fixture(scope="module")
def unbroken(tmp_path_factory):
    folder = tmp_path_factory.mktemp("unbroken")
    assert sealdyn("run", REFERENCE, *LONG, "--no-plot", cwd=folder).code == 0
    return folder / "outputs" / "fmr_reference.h5"


@pytest.fixture(scope="module")
def interrupted(tmp_path_factory):
    """A short complete run, replaced by a long one that is looked at and interrupted while it is written."""
    folder = tmp_path_factory.mktemp("interrupted")
    archive = folder / "outputs" / "fmr_reference.h5"
    assert sealdyn("run", REFERENCE, *settings({"run.turns": 2}), "--no-plot", cwd=folder).code == 0
    seen = {"complete": archive.read_bytes(), "folder": folder, "archive": archive}
    held = dict(when="done > 0.2 * end", then="os.kill(os.getpid(), signal.SIGSTOP)")
    process = itself("run", REFERENCE, *LONG, "--json", cwd=folder, **held)
    # It holds itself while it is looked at.
    assert os.WIFSTOPPED(os.waitpid(process.pid, os.WUNTRACED)[1])
    seen["show"] = sealdyn("show", partial_path(archive), cwd=folder)
    seen["show json"] = sealdyn("show", partial_path(archive), "--json", cwd=folder)
    seen["csv"] = sealdyn("show", partial_path(archive), "--csv", cwd=folder)
    seen["answer"], _ = ended_by(signal.SIGINT, process)
    return seen


def test_show_works_while_a_run_writes(interrupted):
    assert interrupted["show"].code == 0
    found = interrupted["show json"].found
    assert found["status"] == "running" and found["rows"] > 300
    table = list(csv.reader(io.StringIO(interrupted["csv"].out)))
    assert table[0][0] == "time [s]" and "h_min [m]" in table[0]
    assert len(table) > found["rows"]
    times = [float(row[0]) for row in table[1:]]
    assert times == sorted(set(times))
    assert all(len(row) == len(table[0]) and "nan" not in row for row in table)


def test_interrupt_ends_cleanly(interrupted):
    answer = interrupted["answer"]
    assert answer.code == 130
    assert answer.found["status"] == "interrupted" and answer.found["figure"] is None
    assert "--continue" in answer.err and "Traceback" not in answer.err
    info = read_info(interrupted["folder"] / answer.found["archive"])
    assert info["status"] == "interrupted"
    assert 300 < info["rows"] < TURNS * PER_TURN
    assert info["summary"]["end"]["time"] < info["summary"]["end"]["asked"]


def test_a_complete_archive_is_replaced_only_by_a_complete_one(interrupted):
    assert interrupted["archive"].read_bytes() == interrupted["complete"]


@pytest.mark.core
def test_an_interrupted_run_goes_on_to_where_an_unbroken_one_ends(interrupted, unbroken):
    folder = interrupted["folder"]
    other = sealdyn("run", REFERENCE, "--continue", "--json", cwd=folder)
    assert other.code == 2 and other.found["status"] == "invalid"
    answer = sealdyn("run", REFERENCE, *LONG, "--continue", "--json", "--no-plot", cwd=folder)
    assert answer.code == 0, answer.out
    agree(interrupted["archive"], unbroken)
    assert not partial_path(interrupted["archive"]).exists()
    whole, found = read_info(unbroken)["summary"], answer.found
    assert found["relative_misalignment"]["mean"] == pytest.approx(whole["relative_misalignment"]["mean"], rel=1e-5)
    assert found["h_min"]["value"] == pytest.approx(whole["h_min"]["value"], abs=1e-11)
    assert found["energy_residual"] < 1e-5
    again = sealdyn("run", REFERENCE, *LONG, "--continue", "--json", cwd=folder)
    assert again.code == 0 and again.found["status"] == "ok" and "counts" not in again.found


# --- anything else --------------------------------------------------------------------------------------

# Measured: 0.05 to 0.2 s, and 1.5 s where compiled code does not hear; a machine under load needs several times that.
SOON = 10.0
SWEEP = ["sweep", SCENARIOS / "fms_reference.toml", *settings({"run.turns": 3000}), "--vary",
         "rotor.runout=0.01 mrad:0.1 mrad:400", "--outputs", "energy_residual", "--workers", 2]  # fmt: skip
# Points one after the other in one process, single points on two, and many at once on two.
STUDIES = {
    "steady-state": ["steady-state", SCENARIOS / "fms_reference.toml", "--approach", "0.5,0.8,0.9", "--workers", 1],
    "sweep": SWEEP,
    "tolerance": ["tolerance", SCENARIOS / "tolerance.toml", "--workers", 2],
}


def ended_by(number, process) -> tuple:
    """What a process leaves that is sent a signal, held or not, and after how long (s)."""
    begun = time.monotonic()
    process.send_signal(number)
    process.send_signal(signal.SIGCONT)
    return finished(process, timeout=6 * SOON), time.monotonic() - begun


def points_in(journal) -> int:
    return len(journal.read_text().splitlines()) - 1 if journal.exists() else 0


@pytest.mark.parametrize(
    "name, number",
    [("steady-state", signal.SIGTERM), ("sweep", signal.SIGINT), ("tolerance", signal.SIGTERM)],
    ids=str,
)
def test_a_study_ends_soon_and_says_what_is_kept(tmp_path, name, number):
    journal = tmp_path / "x.partial.jsonl"
    process = started("study", *STUDIES[name], "--out", "x.h5", "--json", cwd=tmp_path)
    until(lambda: points_in(journal) > 0, process, timeout=120)
    answer, after = ended_by(number, process)
    assert answer.code == 130 and after < SOON
    assert answer.found["status"] == "interrupted" and str(journal.name) in answer.found["message"]
    assert answer.err.splitlines()[-1] == answer.found["message"] and "Traceback" not in answer.err
    # Every line is whole, and none is lost.
    lines = [json.loads(line) for line in journal.read_text().splitlines()]
    assert f" {len(lines) - 1} finished" in answer.found["message"] and not (tmp_path / "x.h5").exists()


def test_an_interrupted_study_goes_on(tmp_path):
    journal, words = tmp_path / "x.partial.jsonl", ["study", *STUDIES["steady-state"], "--out", "x.h5", "--json"]
    process = started(*words, cwd=tmp_path)
    until(lambda: points_in(journal) > 0, process, timeout=120)
    ended_by(signal.SIGTERM, process)
    mark_first(journal, "shooting", -1.0)
    found = sealdyn(*words, cwd=tmp_path).found
    assert found["near_threshold"][0]["shooting"] == -1.0 and not journal.exists()


@pytest.mark.parametrize("number", [signal.SIGINT, signal.SIGTERM])
@pytest.mark.parametrize(
    "words", [["check", REFERENCE], ["study", "contact-onset", REFERENCE, "--workers", 1]], ids=["check", "study"]
)
def test_what_has_finished_nothing_says_so(tmp_path, words, number):
    process = itself(*words, "--json", cwd=tmp_path, first="os.kill(os.getpid(), signal.SIGSTOP)")
    assert os.WIFSTOPPED(os.waitpid(process.pid, os.WUNTRACED)[1])
    answer, after = ended_by(number, process)
    assert answer.code == 130 and after < SOON and answer.found["status"] == "interrupted"
    assert answer.err.splitlines()[-1] == answer.found["message"] and "Traceback" not in answer.err
    assert not (tmp_path / "outputs").exists()


@pytest.mark.parametrize("number", [signal.SIGINT, signal.SIGTERM, signal.SIGHUP])
@pytest.mark.parametrize("loaded", ["sealdyn", "typer", "sealdyn.terminal"])
def test_a_signal_in_the_first_moments(number, loaded):
    """While the program is loaded, as Python tells what it has imported: one line, exit 130."""
    if signal.getsignal(number) is signal.SIG_IGN:
        pytest.skip("ignored by whoever started this, as under nohup")
    words = [sys.executable, "-X", "importtime", "-m", "sealdyn.cli", "list", "--json"]
    pipes = {"stdout": subprocess.PIPE, "stderr": subprocess.PIPE, "text": True}
    with subprocess.Popen(words, bufsize=1, **pipes) as process:
        for line in process.stderr:
            if line.split("|")[-1].strip() == loaded:
                break
        process.send_signal(number)
        out, err = process.communicate(timeout=60)
    lines = [line for line in err.splitlines() if not line.startswith("import time:")]
    assert process.returncode == 130 and json.loads(out) == {"status": "interrupted", "message": lines[0]}
    assert len(lines) == 1


def test_a_closed_terminal_changes_nothing_under_nohup():
    """SIGHUP that is ignored stays so, also in the first moments."""
    asked = "import os, signal, sys; signal.signal(signal.SIGHUP, signal.SIG_IGN); sys.argv = ['sealdyn', '--help']\n"
    asked += "import sealdyn; os.kill(os.getpid(), signal.SIGHUP); from sealdyn.cli import main; main()"
    done = subprocess.run([sys.executable, "-c", asked], capture_output=True, text=True, timeout=60)
    assert done.returncode == 0 and "sealdyn" in done.stdout


def test_who_only_uses_the_package_keeps_his_signals():
    """Handlers are those of the command alone."""
    asked = "import signal, sealdyn; print(signal.getsignal(signal.SIGTERM) == signal.SIG_DFL)"
    assert subprocess.run([sys.executable, "-c", asked], capture_output=True, text=True, timeout=60).stdout == "True\n"


def test_an_interruption_at_any_moment_of_loading(tmp_path):
    """Half-loaded libraries keep quiet, and the exit code is ours (moments in s; a check takes about one)."""
    for moment in (0.0, 0.02, 0.05, 0.1, 0.2, 0.3, 0.4, 0.6):
        process = started("check", REFERENCE, "--json", cwd=tmp_path)
        until(lambda process=process: hears(process), process)
        time.sleep(moment)
        answer, after = ended_by(signal.SIGINT, process)
        if answer.code == 0:
            break
        assert answer.code == 130 and answer.found["status"] == "interrupted" and after < SOON, moment
        lines = [line for line in answer.err.splitlines() if not line.startswith("compiling kernels")]
        assert lines == [answer.found["message"]], moment


def test_a_library_that_makes_another_error_of_an_interruption():
    """Pydantic, broken off while it builds a schema, raised an error of its own, which came out as a traceback."""
    asked = (
        "import os, signal, sys\nfrom sealdyn import cli\n"
        "def app(**_):\n"
        "    try:\n        os.kill(os.getpid(), signal.SIGINT)\n        [None for _ in range(10**6)]\n"
        "    except KeyboardInterrupt:\n        raise ValueError('no schema') from None\n"
        "cli.app = app\nsys.argv = ['sealdyn', 'check', '--json']\ncli.main()\n"
    )
    done = subprocess.run([sys.executable, "-c", asked], capture_output=True, text=True, timeout=60)
    assert done.returncode == 130 and "Traceback" not in done.stderr
    assert json.loads(done.stdout)["status"] == "interrupted"


@pytest.mark.parametrize("number", [signal.SIGINT, signal.SIGTERM])
def test_a_signal_in_the_last_moments_changes_nothing(number):
    """It ended a study that was complete by the signal itself."""
    asked = (
        f"import atexit, os, sys; atexit.register(os.kill, os.getpid(), {int(number)}); from sealdyn.cli import main\n"
    )
    asked += "sys.argv = ['sealdyn', '--help']; main()"
    assert subprocess.run([sys.executable, "-c", asked], capture_output=True, timeout=60).returncode == 0


def hears(process) -> bool:
    """Whether a process has a handler of its own for SIGTERM."""
    status = Path(f"/proc/{process.pid}/status")
    if not status.exists():
        pytest.skip("no /proc to see it in")
    mask = next(line for line in status.read_text().splitlines() if line.startswith("SigCgt"))
    return bool(int(mask.split()[1], 16) >> (signal.SIGTERM - 1) & 1)


def test_a_run_is_interrupted_while_it_is_done_once_more(tmp_path):
    """In the run that its certificate rests on, which the progress tells."""
    late = dict(when="self.runs == 2 and done > 0", then="os.kill(os.getpid(), signal.SIGTERM)")
    words = ["run", SCENARIOS / "massless_ring.toml", *settings({"run.turns": 200}), "--no-plot", "--json"]
    answer = finished(itself(*words, cwd=tmp_path, **late))
    assert answer.code == 130 and answer.found["status"] == "interrupted"
    assert answer.found["certificate"]["met"] is None and answer.found["archive"] in answer.err
    assert rows(tmp_path / answer.found["archive"]) > 200


@pytest.mark.slow
def test_killed_at_random_instants(tmp_path, unbroken):
    """One run killed three times, each time continued; the archive is readable after every kill.  It is killed by a
    clock of its own, which nothing handles, soon after a point of its progress.  More kills, of ten scenes:
    tests/benchmark/attack/continues.py."""
    archive, chance = tmp_path / "outputs" / "fmr_reference.h5", random.Random(1989)
    reached = [0]
    for kill in range(3):
        alarm = f"signal.setitimer(signal.ITIMER_VIRTUAL, {chance.uniform(0.001, 0.03)})"
        # One of them while the program takes over, the others while it writes.
        where = {"first": alarm} if kill == 1 else {"when": f"done > {0.2 + 0.1 * kill} * end", "then": alarm}
        process = itself(
            "run", REFERENCE, *LONG, "--no-plot", *["--continue"] * (reached[-1] > 0), cwd=tmp_path, **where
        )
        said = process.communicate(timeout=120)
        assert process.returncode == -signal.SIGVTALRM, said
        assert not archive.exists()
        if partial_path(archive).exists():
            shown = sealdyn("show", partial_path(archive), "--json", cwd=tmp_path).found
            assert shown["status"] == "running"
            reached.append(shown["rows"])
            for name in SCALES:
                values = column(partial_path(archive), name)
                assert len(values) == shown["rows"] and (values == values).all()
            at, pressures = (field(partial_path(archive), name) for name in ("field_time", "pressure"))
            assert at[-1] <= values[-1] and (pressures == pressures).all()
    assert reached == sorted(reached) and len(set(reached)) > 2
    assert sealdyn("run", REFERENCE, *LONG, "--no-plot", "--continue", cwd=tmp_path).code == 0
    agree(archive, unbroken)


def test_a_signal_before_the_first_thing_is_done_says_so():
    """Here as the watch is about to start."""
    early = """
import os, signal, sys
from sealdyn import cli
from sealdyn.numerics import interruption

class Early(interruption.Thread):
    def start(self):
        os.kill(os.getpid(), signal.SIGINT)

interruption.Thread = Early
sys.argv = ["sealdyn", "check", sys.argv[1], "--json"]
cli.main()
"""
    done = subprocess.run([sys.executable, "-c", early, str(REFERENCE)], capture_output=True, text=True)
    assert done.returncode == 130 and json.loads(done.stdout)["status"] == "interrupted"
    assert done.stderr.splitlines() == [json.loads(done.stdout)["message"]]
