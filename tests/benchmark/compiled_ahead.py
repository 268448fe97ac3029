"""After `sealdyn compile` runs compile nothing.

    NUMBA_CACHE_DIR=EMPTY python tests/benchmark/compiled_ahead.py [--kinds] [SCENARIO ...]

Of the shipped scenarios those named (default: pump_seal, rough faces that are warm; fmr_reference; gas_dam_reference):
compiling all takes many minutes.  With --kinds kernels of other kinds of films and seals too, by the beginning of a run
of each, for tests that are run in several processes: each of these would compile what it needs.
"""

import json
import subprocess
import sys
import tempfile
from pathlib import Path

import sealdyn
from sealdyn.kernel_cache import compiling

COUNT = """
import json, sys
from sealdyn import cli, kernel_cache
from sealdyn.analysis import desk

shipped = desk.shipped_paths
desk.shipped_paths = lambda: {name: path for name, path in shipped().items() if name in NAMES}

found = []
kernel_cache.compiling.append(found.append)
sys.argv = ["sealdyn", *sys.argv[1:]]
try:
    cli.main()
except SystemExit as end:
    print(json.dumps([end.code, len(found)]), file=sys.stderr)
"""

# Scenario -> what shortens it and its beginning; outputs of many runs at once, with integrals over time and without.
KINDS = {
    "hang_up": {"run.turns": 0.1}, "film_by_numbers": {"run.turns": 0.1},
    "circumferential_reference": {"run.turns": 0.1}, "giving_o_ring": {"run.turns": 0.1},
    "rub": {"run.turns": 0.1, "film.model": "profiled"},
    "lebeck_n3": {"run.turns": 0.01, "film.reynolds": {"cells_r": 5, "cells_theta": 36, "grid_accuracy": 1.0}},
    "gas_reynolds_reference": {"run.turns": 0.01, "run.accuracy": 1e-2, "film.gas_reynolds": {"cells": [6, 16]}},
    "dry_gas_seal": {"run.turns": 0.01, "run.accuracy": 1e-2, "film.gas_reynolds.columns": 4},
}  # fmt: skip
MANY = {"fms_reference": {"run.turns": 0.1}, "tolerance": {"run.turns": 0.1}}


def compiled_by(names, *words):
    """Exit code of a verb in a process of its own, and how often numba began or ended to compile."""
    program = f"NAMES = {names}\n{COUNT}"
    done = subprocess.run([sys.executable, "-c", program, *map(str, words)], capture_output=True, text=True)
    return json.loads(done.stderr.splitlines()[-1])


def compile_kinds(folder):
    """Compile what KINDS and MANY need, in this process."""
    found = []
    compiling.append(found.append)
    for name, changes in KINDS.items():
        sealdyn.simulate(sealdyn.example(name).with_(changes), Path(folder) / "kind.h5")
    for name, changes in MANY.items():
        for output in ("h_min.value", "leakage.mean"):
            sealdyn.simulate_many(sealdyn.example(name).with_(changes), [{}, {}], [output], workers=1)
    print(f"other kinds: {len(found) // 2} kernels")


def main(names, kinds=False):
    """Compile ahead, run, count."""
    code, count = compiled_by(names, "compile")
    print(f"compile: exit code {code}, {count // 2} kernels", flush=True)
    bad = code != 0 or count < 200
    with tempfile.TemporaryDirectory() as folder:
        for name in names:
            scenario = f"scenarios/{name}.toml"
            code, count = compiled_by(names, "run", scenario, "--no-plot", "--out", Path(folder) / "a.h5")
            print(f"run {scenario}: exit code {code}, {count // 2} kernels")
            bad = bad or code not in (0, 5) or count > 0
        if kinds:
            compile_kinds(folder)
    return int(bad)


if __name__ == "__main__":
    words = [word for word in sys.argv[1:] if word != "--kinds"]
    sys.exit(main(words or ["pump_seal", "fmr_reference", "gas_dam_reference"], "--kinds" in sys.argv))
