"""A run has the same bits whether its kernels were just compiled or loaded from disk, in whatever order they are first
used, and with whatever vector unit they are compiled for."""

import ast
import os
import subprocess
import sys
from pathlib import Path

import pytest

from sealdyn.numerics import kernel

ROOT = Path(__file__).parents[2]
SCENARIOS = ROOT / "scenarios"
DECORATORS = {"njit", "cfunc", "partial", *(name for name in vars(kernel) if name.endswith(("_kernel", "c_function")))}
# Scene -> what shortens it.
SCENES = {
    "fms_reference": "run.turns=3", "rub": "run.turns=3", "massless_ring": "run.turns=2",
    "fmsr_both_flexible": "run.turns=3", "hang_up": "run.turns=3", "ludwig_allen": "run.turns=1",
    "squeeze": "run.duration=0.5", "pressure_step": "run.turns=3",
}  # fmt: skip
RUN = """
import hashlib, sys
from pathlib import Path
import h5py, sealdyn

folder, *scenes = sys.argv[1:]
for path, short in zip(scenes[::2], scenes[1::2]):
    archive = Path(folder) / (Path(path).stem + ".h5")
    sealdyn.simulate(sealdyn.read_scenario(path, [short]), archive)
    digest = hashlib.sha256()
    with h5py.File(archive) as file:
        series = []
        file.visititems(lambda name, item: series.append(name) if isinstance(item, h5py.Dataset) else None)
        for name in sorted(n for n in series if file[n].dtype.kind == "f"):
            digest.update(name.encode() + file[name][()].tobytes())
    print(Path(path).stem, len(series), digest.hexdigest())
"""


def bits(scenes, folder, cache, **environment):
    """Scene -> digest of all that its archive holds in floating point, from a process of its own."""
    asked = [word for scene in scenes for word in (str(SCENARIOS / f"{scene}.toml"), SCENES[scene])]
    done = subprocess.run(
        [sys.executable, "-c", RUN, str(folder), *asked],
        env=os.environ | {"NUMBA_CACHE_DIR": str(cache)} | environment,
        cwd=ROOT,
        capture_output=True,
        text=True,
    )
    assert done.returncode == 0, done.stderr
    return dict(line.split(" ", 1) for line in done.stdout.splitlines())


@pytest.mark.slow
def test_compiled_loaded_and_on_another_vector_unit(tmp_path):
    compiled = bits(SCENES, tmp_path, tmp_path / "kernels")
    assert compiled.keys() == SCENES.keys()
    assert bits(reversed(SCENES), tmp_path, tmp_path / "kernels") == compiled
    # The plainest processor of this machine's kind: with fast-math its sums were others.
    assert bits(reversed(SCENES), tmp_path, tmp_path / "plain", NUMBA_CPU_NAME="generic") == compiled


@pytest.mark.core
def test_no_kernel_leaves_its_rounding_to_the_compiler():
    """Fast-math, or threads: the sums of a kernel would hang on what the optimiser makes of it, which differs between
    a kernel compiled beside its callees and one that finds them on disk."""
    for path in (ROOT / "sealdyn").rglob("*.py"):
        for node in ast.walk(ast.parse(path.read_text())):
            if isinstance(node, ast.Call) and isinstance(node.func, ast.Name) and node.func.id in DECORATORS:
                if node.func.id == "partial" and path.name != "kernel.py":
                    continue
                wild = {word.arg for word in node.keywords} - {"inline", "nogil"}
                if path.name == "kernel.py":
                    # None: OPTIONS, looked at below.
                    wild -= {None, "no_cfunc_wrapper"}
                assert not wild, f"{path.name}, line {node.lineno}: {wild}"
                # What kernels have in common stands in one place; what is laid into its caller is no kernel.
                plain = node.func.id not in ("njit", "cfunc") or path.name == "kernel.py"
                assert plain or node.keywords[0].arg == "inline", path
    assert kernel.OPTIONS == {"cache": True, "error_model": "numpy"}
