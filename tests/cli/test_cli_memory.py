"""Memory does not grow with the run."""

import subprocess
import sys
from pathlib import Path

import pytest
from command import REFERENCE, settings

# The high-water mark of this process image: the resource usage of a child starts at its parent's.
ASKED = """
import sys
from pathlib import Path
from sealdyn.cli import main
sys.argv = sys.argv[1:]
try:
    main()
except SystemExit as end:
    mark = [line for line in Path("/proc/self/status").read_text().splitlines() if line.startswith("VmHWM")]
    print(end.code, mark[0].split()[1], file=sys.stderr)
"""


def resident(turns: int, folder) -> float:
    """Largest resident memory (MB) of a run of so many turns."""
    asked = settings({"run.turns": turns, "run.samples_per_turn": 8})
    line = [sys.executable, "-c", ASKED, "sealdyn", "run", str(REFERENCE), *asked, "--no-plot", "--json"]
    done = subprocess.run(line, cwd=folder, capture_output=True, text=True, check=True)
    code, kilobytes = done.stderr.split()[-2:]
    assert code in ("0", "None")
    return int(kilobytes) / (1 << 10)


@pytest.mark.slow
@pytest.mark.skipif(not Path("/proc/self/status").exists(), reason="reads the process status of Linux")
def test_memory_does_not_grow_with_the_run(tmp_path):
    short, long = resident(1000, tmp_path), resident(6000, tmp_path)
    assert long < short + 9
    assert long < 400
