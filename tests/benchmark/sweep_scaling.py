"""How a sweep scales from one process to two.

    python tests/benchmark/sweep_scaling.py [points]

Reference FMS seal, radial film, runs of 400 turns over the runout; a fresh process for each measurement, wall time
of the whole command.  Asked: at least 1.8 where one process takes 30 s or more.
"""

import json
import platform
import subprocess
import sys
import tempfile
import time
from pathlib import Path

SCENARIO = Path(__file__).parents[2] / "scenarios" / "fms_reference.toml"
WANTED = 1.8


def timed(workers: int, points: int, folder: Path):
    """Wall time (s) and rows of the sweep on so many processes."""
    command = [
        sys.executable, "-m", "sealdyn.cli", "study", "sweep", str(SCENARIO), "--set", "run.turns=400",
        "--vary", f"rotor.runout=1:60 urad:{points}", "--workers", str(workers), "--no-plot", "--json",
        "--out", str(folder / f"{workers}.h5"),
    ]  # fmt: skip
    begun = time.perf_counter()
    done = subprocess.run(command, check=True, capture_output=True, text=True)
    return time.perf_counter() - begun, json.loads(done.stdout)["rows"]


def main():
    points = int(sys.argv[1]) if len(sys.argv) > 1 else 96
    with tempfile.TemporaryDirectory() as folder:
        timed(1, 1, Path(folder))
        one, rows_of_one = timed(1, points, Path(folder))
        two, rows_of_two = timed(2, points, Path(folder))
    print(f"{platform.processor() or platform.machine()}, Python {platform.python_version()}, {points} points")
    print(f"one process {one:.1f} s, two {two:.1f} s: {one / two:.2f} times (asked: {WANTED} from 30 s on)")
    assert rows_of_one == rows_of_two, "rows differ"
    if one < 30:
        print("shorter than 30 s: give more points")
    return 0 if one / two >= WANTED else 1


if __name__ == "__main__":
    sys.exit(main())
