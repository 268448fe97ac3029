"""Disks that are full at any byte: one line, exit 4, the archive readable to its last chunk, and it goes on."""

import random
import resource
import signal
import subprocess
from pathlib import Path

from sealdyn.archive import ArchiveError, partial_path, read_info

from .kills import COMMAND, PATIENCE, SEAL, clear, ended, unlike
from .outcome import judged
from .runs import unsound

SETTINGS = ("--set", "run.turns=2000", "--set", "run.samples_per_turn=80", "--no-plot")


def disks(ledger, seed, numbers, folder: Path) -> None:
    """Runs that may write so many bytes and no more, by the system's limit of a file's size."""
    for number in numbers:
        chance, out = random.Random(f"disk {seed} {number}"), folder / f"disk-{number}.h5"
        most = int(10 ** chance.uniform(2.5, 7.8))
        words = ("run", SEAL, *SETTINGS, "--out", out)

        def limited(most=most):
            signal.signal(signal.SIGXFSZ, signal.SIG_IGN)
            resource.setrlimit(resource.RLIMIT_FSIZE, (most, most))

        try:
            done = subprocess.run(
                [*COMMAND, *map(str, words)], capture_output=True, timeout=PATIENCE, preexec_fn=limited
            )
            code, error = done.returncode, done.stderr.decode(errors="replace")
        except subprocess.TimeoutExpired:
            code, error = 70, "no end"
        how = judged(code, error, (0, 4))[1]
        lines = [line for line in error.splitlines() if "compiling" not in line and "WARNING" not in line]
        if not how and code == 4 and len(lines) > 1:
            how = f"{len(lines)} lines"
        how = how or _unreadable(partial_path(out))
        if not how and code == 4:
            code, _, error = ended((*words, "--continue"))
            how = judged(code, error)[1] or unsound(out) or unlike(out, folder)
            outcome = "gone on with"
        else:
            outcome = "done"
        ledger.note("full disk", "escaped" if how else outcome, how and f"{how} ({most} bytes)", error)
        clear(folder, f"disk-{number}")


def _unreadable(path) -> str:
    try:
        if path.exists():
            read_info(path)
        return ""
    except ArchiveError as error:
        return f"partial file: {error}"
