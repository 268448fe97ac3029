"""What does a start from rest, and a stop, cost over the same turns at speed?

    OPENBLAS_NUM_THREADS=1 python tests/benchmark/startups.py [turns] [names that contain this]

Twenty small seals (tests/starting_seals.py), each run as `sealdyn run` does it, certificate and retries included.  A
table: processor time (s, kernels warm) of the cycle and of the turns at speed, their ratio, the cycle's steps and
evaluations in its last try, method, status and why.  Ends with 1 where a ratio passes RATIO or a run ends otherwise
than "ok" or "inaccurate".
"""

import sys
import tempfile
import time
from pathlib import Path

sys.path.insert(0, str(Path(__file__).parents[1]))

from starting_seals import SEALS, cycle

from sealdyn.scenario.reader import with_values
from sealdyn.simulation.simulate import simulate

RATIO = 20.0
# Share of a run that loads its kernels beforehand.
WARM = 0.01


def timed(scenario, folder: Path) -> tuple[float, dict]:
    """Processor time (s) and summary of a run."""
    begun = time.process_time()
    found = simulate(scenario, folder / "run.h5").summary
    return time.process_time() - begun, found


def compared(name: str, turns: float, folder: Path) -> tuple[float, float, dict]:
    """Processor times (s) of a seal's cycle and of its turns at speed, and the summary of the cycle."""
    moving, steady = cycle(name, turns)
    for one in (with_values(moving, {"run.duration": WARM * moving.run.duration}), *cycle(name, WARM * turns)):
        simulate(one, folder / "warm.h5")
    at_speed, _ = timed(steady, folder)
    cycled, found = timed(moving, folder)
    return cycled, at_speed, found


def main(turns: float = 4.0, part: str = "") -> int:
    """The table; returns the process's exit code."""
    bad = 0
    print(f"{'seal':28}{'cycle s':>9}{'speed s':>9}{'ratio':>8}{'steps':>9}{'rhs':>9}  method  status")
    with tempfile.TemporaryDirectory() as folder:
        for name in (name for name in SEALS if part in name):
            cycled, at_speed, found = compared(name, turns, Path(folder))
            ratio, counts = cycled / at_speed, found["counts"]
            fine = ratio <= RATIO and found["status"] in ("ok", "inaccurate")
            bad += not fine
            print(
                f"{name:28}{cycled:9.2f}{at_speed:9.2f}{ratio:8.1f}{counts['steps']:9}{counts['rhs']:9}"
                f"  {found['model']['solver']:7} {found['status']}: {found['certificate']['said']}",
                flush=True,
            )
    print(f"{bad} beyond {RATIO:g} times the turns at speed, or without an answer")
    return bool(bad)


if __name__ == "__main__":
    sys.exit(main(*(kind(given) for kind, given in zip((float, str), sys.argv[1:], strict=False))))
