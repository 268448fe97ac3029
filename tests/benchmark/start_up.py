"""What a run costs before it computes: python tests/benchmark/start_up.py [--scenario FILE] [--repeats N] [--cold]

Processor time (user and system) of whole processes of `sealdyn run`: a second process, whose kernels and byte code are
on disk, with and without its figure, the help, and with --cold a first one that compiles its kernels into an empty
folder.  Minimum of several; other work on the machine shows all the same, so compare in turns.
"""

import argparse
import os
import resource
import subprocess
import sys
import tempfile
from pathlib import Path

ROOT = Path(__file__).parents[2]


def processor_time(words, folder, **environment) -> float:
    """User and system time (s) of one `sealdyn` process, its byte code kept below the folder."""
    before = resource.getrusage(resource.RUSAGE_CHILDREN)
    kept = {key: value for key, value in os.environ.items() if key != "PYTHONDONTWRITEBYTECODE"}
    kept |= {"PYTHONPYCACHEPREFIX": str(Path(folder) / "byte_code"), **environment}
    subprocess.run([sys.executable, "-m", "sealdyn.cli", *words], env=kept, cwd=ROOT, check=True, capture_output=True)
    after = resource.getrusage(resource.RUSAGE_CHILDREN)
    return after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime


def main():
    asked = argparse.ArgumentParser()
    asked.add_argument("--scenario", default="scenarios/fms_reference.toml")
    asked.add_argument("--repeats", type=int, default=5)
    asked.add_argument("--cold", action="store_true", help="the first run too, which compiles")
    given = asked.parse_args()
    with tempfile.TemporaryDirectory() as folder:
        run = ["run", given.scenario, "--out", str(Path(folder) / "run.h5")]
        rows = {"second process, no figure": [*run, "--no-plot"], "second process, figure": run, "help": ["--help"]}
        times = {name: [] for name in rows}
        for _ in range(given.repeats + 1):
            for name, words in rows.items():
                times[name].append(processor_time(words, folder))
        # The first round writes byte code and kernels.
        times = {name: found[1:] for name, found in times.items()}
        if given.cold:
            empty = {"NUMBA_CACHE_DIR": str(Path(folder) / "kernels")}
            times["first process, no figure"] = [processor_time([*run, "--no-plot"], folder, **empty)]
    for name, found in times.items():
        print(f"{name:28s}{min(found):7.2f} s   ({', '.join(f'{t:.2f}' for t in found)})")


if __name__ == "__main__":
    main()
