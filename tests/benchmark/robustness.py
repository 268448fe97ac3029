"""The attack on everything that comes from outside, counted.

    python tests/benchmark/robustness.py [--quick] [--only NAME] [--jobs 2]

What is attacked and how stands in attack/, a file for each.  Anything but an answer or one of the program's own
errors in one line came through: a traceback, a warning of Python, a signal, a line too long to read, ten seconds
without a word, a number that is none, a row lost.  The whole takes some two hours with two jobs and goes on where it
was stopped: what is done stands in a journal, which the gallery shows, with the commit that was attacked; --quick makes
some 200 draws in a minute.
"""

import argparse
import json
import os
import subprocess
import sys
import tempfile
import time
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

if __name__ == "__main__":
    sys.path.insert(0, str(Path(__file__).parents[1]))

from benchmark.attack.archives import archives
from benchmark.attack.continues import CASES, continues
from benchmark.attack.disks import disks
from benchmark.attack.kills import kills, study_kills
from benchmark.attack.motions import motions
from benchmark.attack.outcome import Ledger
from benchmark.attack.runs import runs
from benchmark.attack.scenarios import scenarios
from benchmark.attack.settings import settings
from benchmark.attack.soak import soak
from benchmark.attack.worlds import WORLDS, worlds

from sealdyn.numerics.interruption import VARIABLES

JOURNAL = Path(__file__).parents[2] / "outputs" / "gallery" / "robustness.jsonl"
# Each with its cases: all, a quick sample; and how many make a batch.
PARTS = {
    "scenarios": (scenarios, 20_000, 120, 1000),
    "motions": (motions, 2000, 40, 250),
    "runs": (runs, 2000, 10, 100),
    "archives": (archives, 1000, 10, 25),
    "settings": (settings, 2000, 10, 100),
    "kills": (kills, 100, 1, 5),
    "continues": (continues, len(CASES), 2, 6),
    "study_kills": (study_kills, 400, 2, 20),
    "worlds": (worlds, len(WORLDS), 2, 4),
    "disks": (disks, 100, 3, 10),
    "soak": (soak, 30, 0, 30),
}
# A batch that takes longer (s) is a hang.
PATIENCE = 3600


def main():
    """Attack, and print what came through."""
    words = argparse.ArgumentParser()
    words.add_argument("--quick", action="store_true")
    words.add_argument("--only", choices=PARTS)
    words.add_argument("--jobs", type=int, default=2)
    words.add_argument("--seed", type=int, default=2026)
    words.add_argument("--journal", help="finished batches (default: that of the gallery; none if quick)")
    words.add_argument("--batch", nargs=3, help=argparse.SUPPRESS)
    asked = words.parse_args()
    if asked.batch:
        name, first, last = asked.batch
        return _be_the_batch(name, asked.seed, range(int(first), int(last)))
    journal = Path(asked.journal) if asked.journal else None if asked.quick else JOURNAL
    ledger, begun, done = Ledger(), time.monotonic(), _kept(journal, asked.seed)
    for batch in done.values():
        ledger.add(batch["counts"], batch["ways"])
    left, code = [batch for batch in _batches(asked) if batch not in done], _code()
    print(f"{len(left)} batches, {len(done)} were done before", flush=True)
    with ThreadPoolExecutor(asked.jobs) as jobs:
        for batch, found in jobs.map(lambda batch: (batch, _batch(batch, asked.seed)), left):
            ledger.add(found["counts"], found["ways"])
            if journal:
                with open(journal, "a") as file:
                    file.write(json.dumps({"batch": batch, "seed": asked.seed, "code": code, **found}) + "\n")
            ways = f"{', '.join(found['ways'])}"[:2000]
            print(f"{batch[0]} {batch[1]}-{batch[2]} {found['seconds']:.0f} s {ways}", flush=True)
    spent = sum(batch["seconds"] for batch in done.values())
    for name, count in sorted(ledger.counts.items()):
        print(f"{name:40s} {count}")
    for how in ledger.ways:
        print(f"  {how}")
    print(f"{time.monotonic() - begun:.0f} s, {spent:.0f} s of batches before; came through: {len(ledger.ways)}")
    return 1 if ledger.ways else 0


def _batches(asked):
    for name, (_, whole, quick, size) in PARTS.items():
        if asked.only in (None, name):
            count = quick if asked.quick else whole
            for first in range(0, count, size):
                yield name, first, min(first + size, count)


def _kept(journal, seed) -> dict:
    if not (journal and journal.exists()):
        return {}
    lines = [json.loads(line) for line in journal.read_text().splitlines() if line.endswith("}")]
    return {tuple(line["batch"]): line for line in lines if line["seed"] == seed}


def _code() -> str:
    """The commit of what is attacked, "" where there is none."""
    words = ["git", "-C", str(Path(__file__).parent), "rev-parse", "--short", "HEAD"]
    try:
        return subprocess.run(words, capture_output=True, text=True).stdout.strip()
    except OSError:
        return ""


def _batch(batch, seed) -> dict:
    """What a batch counts, in a process of its own: it may crash."""
    begun, found = time.monotonic(), Ledger()
    words = [sys.executable, __file__, "--seed", str(seed), "--batch", *map(str, batch)]
    try:
        alone = {**os.environ, **dict.fromkeys(VARIABLES, "1")}
        done = subprocess.run(
            words, capture_output=True, text=True, timeout=PATIENCE, stdin=subprocess.DEVNULL, env=alone
        )
        found.add(**json.loads(done.stdout.splitlines()[-1]))
    except subprocess.TimeoutExpired:
        found.note(batch[0], "escaped", "a batch without an end", str(batch))
    except (ValueError, IndexError):
        found.note(batch[0], "escaped", f"a batch ended by {done.returncode}: {done.stderr[-300:]}", str(batch))
    return {"counts": found.counts, "ways": found.ways, "seconds": time.monotonic() - begun}


def _be_the_batch(name, seed, numbers):
    ledger = Ledger()
    with tempfile.TemporaryDirectory() as folder:
        PARTS[name][0](ledger, seed, numbers, Path(folder))
    print(json.dumps({"counts": ledger.counts, "ways": ledger.ways}))
    return 0


if __name__ == "__main__":
    raise SystemExit(main())
