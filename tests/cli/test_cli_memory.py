"""Memory does not grow with the run."""

import subprocess
import sys

import pytest
from command import REFERENCE, settings

ASKED = """
import resource, sys
from sealdyn.cli import main
sys.argv = sys.argv[1:]
try:
    main()
except SystemExit as end:
    print(end.code, resource.getrusage(resource.RUSAGE_SELF).ru_maxrss, file=sys.stderr)
"""


def resident(turns: int, folder) -> float:
    """Largest resident memory (MB) of a run of so many turns."""
    asked = settings({"run.turns": turns, "run.samples_per_turn": 4})
    line = [sys.executable, "-c", ASKED, "sealdyn", "run", str(REFERENCE), *asked, "--no-plot", "--json"]
    done = subprocess.run(line, cwd=folder, capture_output=True, text=True, check=True)
    code, kilobytes = done.stderr.split()[-2:]
    assert code in ("0", "None")
    return int(kilobytes) / (1 << 10 if sys.platform != "darwin" else 1 << 20)


@pytest.mark.slow
def test_memory_does_not_grow_with_the_run(tmp_path):
    short, long = resident(2000, tmp_path), resident(20000, tmp_path)
    assert long < short + 15
    assert long < 400
