"""Runs and studies killed at any moment: no row is lost, what is left goes on, nobody is left behind."""

import os
import random
import signal
import subprocess
import sys
import time
from pathlib import Path

from sealdyn.archive import ArchiveError, partial_path, read_info
from sealdyn.studies import study_names
from sealdyn.studies._runner import journal_of

from .outcome import judged
from .runs import unsound

SCENARIOS = Path(__file__).parents[3] / "scenarios"
SEAL = SCENARIOS / "fmr_reference.toml"
COMMAND = [sys.executable, "-m", "sealdyn.cli"]
# Some seconds of solving.
SETTINGS = ("--set", "run.turns=20000", "--set", "run.samples_per_turn=8", "--no-plot")
ROWS = 160_001
# Kinds that are told apart by a scene of their own.
SCENES = {
    "equilibrium": "run_in",
    "load-support": "lebeck_n3",
    "elastic-ring": "lebeck_elastic",
    "wear": "run_in",
    "rub": "rub_chaotic",
    "runup": "runup_past_threshold",
    "sealing-number": "ludwig_allen",
    "tolerance": "tolerance",
}
WORDS = {
    "load-support": ("--vary", "contact.roughness=0.1:0.4um:7"),
    "sweep": ("--vary", "rotor.runout=0:1mrad:21"),
}
# Latest moment of a kill (power of ten, s), longest wait for one that goes on.
LATEST, PATIENCE = 0.9, 60
EACH = 20


def kills(ledger, seed, numbers, folder: Path) -> None:
    """Runs, each killed up to three times and gone on with to its end."""
    for number in numbers:
        chance, out = random.Random(f"kill {seed} {number}"), folder / f"kill-{number}.h5"
        how, seen = "", 0
        for _ in range(chance.choice((1, 1, 2, 3))):
            code, _ = _killed(("run", SEAL, *SETTINGS, *_on(out), "--out", out), chance.uniform(0.2, 4.0))
            rows = _rows(out)
            how = how or (f"{seen - rows} rows lost" if rows < seen else "")
            seen = rows
            if code == 0:
                break
        code, _, error = ended(("run", SEAL, *SETTINGS, *_on(out), "--out", out))
        how = how or judged(code, error)[1] or unsound(out) or unlike(out, folder, ROWS)
        ledger.note("run killed", "escaped" if how else "gone on with", how, error)
        clear(folder, f"kill-{number}")


def study_kills(ledger, seed, numbers, folder: Path) -> None:
    """Each kind of study, killed; its workers end with it, and it goes on."""
    names = study_names()
    for number in numbers:
        chance, name = random.Random(f"study {seed} {number}"), names[number % len(names)]
        out = folder / f"study-{number}.h5"
        scene = SCENARIOS / f"{SCENES.get(name, 'fms_reference')}.toml"
        words = ("study", name, scene, *WORDS.get(name, ()), "--no-plot", "--workers", 2, "--out", out)
        code, group = _killed(words, 10 ** chance.uniform(-0.6, LATEST))
        how = _orphans(group)
        if not how and code == 0:
            ledger.note("study killed", "done before")
        else:
            # It goes on: what it has kept is read, and killed it leaves no more behind than before.
            code, group = _killed(words, PATIENCE / 10, stop=signal.SIGTERM)
            how = how or _orphans(group) or ("" if code in (0, 130, 3) else f"exit {code} when it went on")
            ledger.note("study killed", "escaped" if how else "goes on", how and f"{name}: {how}", str(words))
        left = [path.name for path in folder.glob(f"study-{number}*") if path not in (out, journal_of(out))]
        left = [path for path in left if not path.endswith(".lock")]
        if left:
            ledger.note("study killed", "escaped", f"{name} left {left}")
        clear(folder, f"study-{number}")


def _killed(words, after, stop=signal.SIGKILL):
    """Exit code of a command that is ended after so many seconds, and its group of processes."""
    quiet = {"stdin": subprocess.DEVNULL, "stdout": subprocess.DEVNULL, "stderr": subprocess.DEVNULL}
    process = subprocess.Popen([*COMMAND, *map(str, words)], start_new_session=True, **quiet)
    try:
        process.wait(after)
    except subprocess.TimeoutExpired:
        process.send_signal(stop)
        try:
            process.wait(10)
        except subprocess.TimeoutExpired:
            os.killpg(process.pid, signal.SIGKILL)
            return "never", process.pid
    return process.returncode, process.pid


def ended(words):
    """Exit code, standard output and error of a command."""
    try:
        done = subprocess.run([*COMMAND, *map(str, words)], capture_output=True, timeout=2 * PATIENCE)
    except subprocess.TimeoutExpired:
        return 70, "", "no end"
    return done.returncode, done.stdout.decode(errors="replace"), done.stderr.decode(errors="replace")


def _on(out) -> tuple:
    """Before its first write a run has nothing to go on from."""
    return ("--continue",) if out.exists() or partial_path(out).exists() else ()


def _rows(out) -> int:
    for path in (partial_path(out), out):
        try:
            if path.exists():
                return read_info(path)["rows"]
        except ArchiveError:
            pass
    return 0


def _orphans(group) -> str:
    """Workers that outlive what started them by more than some seconds."""
    end = time.monotonic() + 5
    while time.monotonic() < end:
        try:
            os.killpg(group, 0)
        except ProcessLookupError:
            return ""
        time.sleep(0.05)
    os.killpg(group, signal.SIGKILL)
    return "workers were left behind"


def unlike(out, folder, rows: int) -> str:
    """How a run that went on is unlike a whole one of so many rows; "" if it is alike."""
    if not out.exists():
        return "no archive"
    left = [path.name for path in folder.glob(f"{out.stem}.*") if path != out]
    if read_info(out)["rows"] != rows:
        return f"{read_info(out)['rows']} rows instead of {rows}"
    return f"left {left}" if left else ""


def clear(folder, stem):
    """Remove what a case left."""
    for path in folder.glob(f"{stem}*"):
        path.unlink()
