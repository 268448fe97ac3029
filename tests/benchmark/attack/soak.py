"""Run after run in one process: memory, open files, threads and what stands on disk do not grow."""

import os
import random
import threading
import time
import warnings
from pathlib import Path

from sealdyn.archive import open_archive
from sealdyn.scenario.reader import read_scenario
from sealdyn.simulation.simulate import simulate
from sealdyn.studies._runner import run_study

SCENARIOS = Path(__file__).parents[3] / "scenarios"
SCENES = ("fms_reference", "fmr_reference", "rub", "hang_up", "gas_dam_reference", "squeeze")
# Minutes of a soak, seconds before it is measured from, growth allowed (MB).
MINUTES, WARM, GROWN = 1.0, 20.0, 60.0


def soak(ledger, seed, numbers, folder: Path) -> None:
    """So many minutes of it, without a break."""
    chance, end = random.Random(f"soak {seed}"), time.monotonic() + 60 * MINUTES * len(numbers)
    warm, before, count = time.monotonic() + WARM, None, 0
    while time.monotonic() < end:
        _one(chance, folder)
        count += 1
        if before is None and time.monotonic() > warm:
            before = _held()
        for path in folder.glob("soak*"):
            path.unlink()
    after = _held()
    how = ""
    for what, most in (("megabytes", GROWN), ("files", 3), ("threads", 1), ("left on disk", 0)):
        grown = after[what] - (before or after)[what]
        if grown > most:
            how = f"{grown:.0f} more {what} after {count} runs"
    if len(list(folder.iterdir())):
        how = how or f"left {[path.name for path in folder.iterdir()][:3]}"
    ledger.note("minute of soak", "escaped" if how else "clean", how)
    ledger.counts["minute of soak: clean"] += len(numbers) - 1 if not how else 0
    ledger.counts["run of the soak: done"] += count


def _one(chance, folder):
    scene, out = chance.choice(SCENES), folder / "soak.h5"
    text = (SCENARIOS / f"{scene}.toml").read_text()
    short = ["run.turns=4"] if "turns =" in text else ["run.samples=50"]
    scenario = read_scenario(SCENARIOS / f"{scene}.toml", short)
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        simulate(scenario, out)
        open_archive(out).close()
        if chance.random() < 0.1:
            run_study("equilibrium", scenario, folder / "soak-study.h5", workers=1)


def _held() -> dict:
    pages = int(Path("/proc/self/statm").read_text().split()[1])
    return {
        "megabytes": pages * os.sysconf("SC_PAGE_SIZE") / 1e6,
        "files": len(os.listdir("/proc/self/fd")),
        "threads": threading.active_count(),
        "left on disk": 0,
    }
