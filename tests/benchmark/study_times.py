"""What each study costs: processor time of one run of every study with its default settings, on one core: what `timed`
in its file and the table of the README say.

    python tests/benchmark/study_times.py [study ...]

Compiled kernels are reused (run it twice after an edit of a kernel); figures are not drawn.  Processor time of the
command and its worker, which a busy machine stretches less than wall time.
"""

import json
import platform
import resource
import subprocess
import sys
import tempfile
from pathlib import Path

from sealdyn.scenario.templates import shipped_paths
from sealdyn.studies import study_names
from sealdyn.studies._runner import study_info

ROOT = Path(__file__).parents[2]
COMMANDS = {name: study_info(name.replace("-", "_")).timed[0].split() for name in study_names()}


def cost(study: str, scenario: str, *flags: str) -> tuple[float, str]:
    """Processor time (s) of a study, and how it ended."""
    before = resource.getrusage(resource.RUSAGE_CHILDREN)
    with tempfile.TemporaryDirectory() as folder:
        command = [sys.executable, "-m", "sealdyn.cli", "study", study, str(shipped_paths()[scenario]), *flags,
                   "--workers", "1", "--no-plot", "--json", "--out", str(Path(folder) / "study.h5")]  # fmt: skip
        done = subprocess.run(command, cwd=ROOT, capture_output=True, text=True)
    after = resource.getrusage(resource.RUSAGE_CHILDREN)
    seconds = after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime
    return seconds, json.loads(done.stdout).get("status", "ok") if done.stdout else f"exit {done.returncode}"


def main():
    print(f"{platform.processor() or platform.machine()}, Python {platform.python_version()}")
    for study in sys.argv[1:] or COMMANDS:
        seconds, status = cost(study, *COMMANDS[study])
        print(f"{study:18} {' '.join(COMMANDS[study]):60} {seconds:7.1f} s  {status}", flush=True)


if __name__ == "__main__":
    main()
