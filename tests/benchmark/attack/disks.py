"""Disks that are full at any byte: one line, exit 4, the archive readable to its last chunk, and it goes on."""

import contextlib
import random
import resource
import shutil
import signal
import subprocess
from pathlib import Path

from sealdyn.archive import ArchiveError, partial_path, read_info

from .kills import COMMAND, PATIENCE, SEAL, clear, ended, unlike
from .outcome import judged
from .runs import unsound

SETTINGS = ("--set", "run.turns=2000", "--set", "run.samples_per_turn=80", "--no-plot")


def disks(ledger, seed, numbers, folder: Path) -> None:
    """Runs that find room for so many bytes and no more: by the system's limit of a file's size, or, where one may be
    made, on a disk of that size."""
    for number in numbers:
        chance = random.Random(f"disk {seed} {number}")
        most = int(10 ** chance.uniform(3.0, 8.2))
        with _disk(folder / f"disk-{number}", most if number % 2 else None) as disk:
            out = (disk or folder) / f"disk-{number}.h5"
            code, error = _ran(out, None if disk else most)
            how = judged(code, error, (0, 4))[1] or _too_many(code, error) or _unreadable(partial_path(out))
            outcome = "done" if code == 0 else "refused"
            if not how and code == 4 and partial_path(out).exists():
                _give_room(disk)
                code, _, error = ended(("run", SEAL, *SETTINGS, "--out", out, "--continue"))
                how, outcome = judged(code, error)[1] or unsound(out) or unlike(out, folder, 160_001), "gone on with"
            ledger.note("full disk", "escaped" if how else outcome, how and f"{how} ({most} bytes, {disk})", error)
            clear(folder, f"disk-{number}.")


def _ran(out, most):
    def limited():
        signal.signal(signal.SIGXFSZ, signal.SIG_IGN)
        resource.setrlimit(resource.RLIMIT_FSIZE, (most, most))

    words = (*COMMAND, "run", str(SEAL), *SETTINGS, "--out", str(out))
    try:
        done = subprocess.run(words, capture_output=True, timeout=PATIENCE, preexec_fn=limited if most else None)
    except subprocess.TimeoutExpired:
        return 70, "no end"
    return done.returncode, done.stderr.decode(errors="replace")


@contextlib.contextmanager
def _disk(place: Path, size: int | None):
    """A disk of so many bytes; None where none is asked for, or may not be made."""
    place.mkdir()
    made = size and shutil.which("mount")
    made = made and not subprocess.run(
        ["mount", "-t", "tmpfs", "-o", f"size={max(size, 4096)}", "none", place], capture_output=True
    ).returncode  # fmt: skip
    try:
        yield place if made else None
    finally:
        if made:
            subprocess.run(["umount", "-l", place], check=True)
        place.rmdir()


def _give_room(disk):
    if disk:
        subprocess.run(["mount", "-o", "remount,size=400m", disk], check=True)


def _too_many(code, error) -> str:
    # Beside warnings and the bar of the progress.
    lines = [line for line in error.splitlines() if "WARNING" not in line and "remaining: " not in line]
    return f"{len(lines)} lines" if code == 4 and len(lines) > 1 else ""


def _unreadable(path) -> str:
    try:
        if path.exists():
            read_info(path)
        return ""
    except ArchiveError as error:
        return f"partial file: {error}"
