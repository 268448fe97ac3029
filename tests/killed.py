"""A study killed in the middle, as by the machine: no handler runs."""

import json
import signal
import subprocess
import sys
from pathlib import Path

COMMAND = [sys.executable, "-m", "sealdyn.cli", "study"]
# A program that kills itself as soon as its journal holds as many points as the first word says; the other words are
# those of `sealdyn study`.  Whoever watched it from outside would be too late on a fast machine, or a busy one.
KILLED = """
import os, signal, sys
from sealdyn.numerics.parallel import Checkpoint

points, add = int(sys.argv.pop(1)), Checkpoint.add

def last(self, key, row):
    add(self, key, row)
    if len(self.rows) == points:
        os.kill(os.getpid(), signal.SIGKILL)

Checkpoint.add = last
from sealdyn import cli
cli.main()
"""


def kill_midway(command, journal: Path, finished: int) -> list[str]:
    """Run a command (of COMMAND) until its journal holds more than `finished` points, when it is killed; the journal's
    lines, the first of them its head."""
    words = [sys.executable, "-c", KILLED, str(finished + 1), *command[command.index("study") :]]
    done = subprocess.run(words, stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, text=True, timeout=300)
    assert done.returncode == -signal.SIGKILL, done.stderr
    return journal.read_text().splitlines()


def mark_first(journal: Path, output: str, value: float):
    """Change an output of the first finished point: it shows in the answer if, and only if, the point is not run
    again."""
    head, first, *others = journal.read_text().splitlines()
    entry = json.loads(first)
    entry["row"][output] = value
    journal.write_text("\n".join([head, json.dumps(entry), *others]) + "\n")
