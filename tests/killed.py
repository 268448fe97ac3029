"""A study killed in the middle, as by the machine: no handler runs."""

import json
import os
import signal
import subprocess
import sys
import time
from pathlib import Path

COMMAND = [sys.executable, "-m", "sealdyn.cli", "study"]


def kill_midway(command, journal: Path, finished: int, **how) -> list[str]:
    """Run the command until its journal holds more than `finished` points, then kill it; the journal's lines, the first
    of them its head."""
    process = subprocess.Popen(command, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL, **how)
    begun = time.monotonic()
    while not (journal.exists() and len(journal.read_text().splitlines()) > finished + 1):
        assert process.poll() is None and time.monotonic() - begun < 120
        time.sleep(0.02)
    os.kill(process.pid, signal.SIGKILL)
    process.wait()
    return journal.read_text().splitlines()


def mark_first(journal: Path, output: str, value: float):
    """Change an output of the first finished point: it shows in the answer if, and only if, the point is not run
    again."""
    head, first, *others = journal.read_text().splitlines()
    entry = json.loads(first)
    entry["row"][output] = value
    journal.write_text("\n".join([head, json.dumps(entry), *others]) + "\n")
