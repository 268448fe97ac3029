"""After `sealdyn compile` runs compile nothing.

    NUMBA_CACHE_DIR=EMPTY python tests/benchmark/compiled_ahead.py [SCENARIO ...]

Of the shipped scenarios those named (default: pump_seal, rough faces that are warm; fmr_reference; gas_dam_reference):
compiling all takes many minutes.
"""

import json
import subprocess
import sys
import tempfile
from pathlib import Path

COUNT = """
import json, sys
from sealdyn import cli, kernel_cache
from sealdyn.analysis import check

shipped = check.shipped_paths
check.shipped_paths = lambda: {name: path for name, path in shipped().items() if name in NAMES}

found = []
kernel_cache.compiling.append(found.append)
sys.argv = ["sealdyn", *sys.argv[1:]]
try:
    cli.main()
except SystemExit as end:
    print(json.dumps([end.code, len(found)]), file=sys.stderr)
"""


def compiled_by(names, *words):
    """Exit code of a verb in a process of its own, and how often numba began or ended to compile."""
    program = f"NAMES = {names}\n{COUNT}"
    done = subprocess.run([sys.executable, "-c", program, *map(str, words)], capture_output=True, text=True)
    return json.loads(done.stderr.splitlines()[-1])


def main(names):
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
    return int(bad)


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:] or ["pump_seal", "fmr_reference", "gas_dam_reference"]))
