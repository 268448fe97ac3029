"""What a process loads and makes ready: only what it was asked for.  By modules and kernels, not by time."""

import json
import os
import subprocess
import sys
from pathlib import Path

import pytest

from sealdyn.kernel_cache import kept_kernels

ROOT = Path(__file__).parents[2]
RUN = """
import json, sys
from sealdyn import cli

sys.argv = ["sealdyn", *sys.argv[1:]]
try:
    cli.main()
except SystemExit as end:
    assert not end.code, end.code
"""
TELL = """
from types import ModuleType
import json, sys

ours = [module for name, module in sys.modules.items() if name.startswith("sealdyn")]
kernels = {v for module in ours for v in vars(module).values() if hasattr(v, "py_func") and v.overloads}
# Those of numerics/kernel.py that are compiled at their first use.
late = [v for module in ours for v in vars(module).values() if type(v).__name__ == "AtFirstUse"]
kernels |= {v.function for v in late if "compiled" in vars(v)}
names = [f"{k.__module__.removeprefix('sealdyn.')}.{k.__name__}" for k in kernels]
print(json.dumps({"modules": sorted(sys.modules), "kernels": names}), file=sys.stderr)
"""


def loaded(code, *words):
    """Modules and kernels (made ready from Python or for a function value) of a process at its end."""
    command = [sys.executable, "-c", code + TELL, *map(str, words)]
    done = subprocess.run(command, cwd=ROOT, capture_output=True, text=True, env=os.environ.copy())
    assert done.returncode == 0, done.stderr
    found = json.loads(done.stderr.splitlines()[-1])
    return set(found["modules"]), set(found["kernels"])


def run(tmp_path, scenario, *words):
    return loaded(RUN, "run", f"scenarios/{scenario}.toml", "--no-plot", "--out", tmp_path / "run.h5", *words)


@pytest.mark.core
def test_the_package_alone_loads_nothing():
    modules, _ = loaded("import sealdyn\n")
    heavy = {"numpy", "scipy", "numba", "h5py", "pydantic", "typer", "rich", "matplotlib", "xarray", "sksundae", "pint"}
    assert not modules & heavy


BESIDE_A_RUN = {
    "matplotlib", "PIL", "sksundae", "xarray", "h5netcdf", "distributed", "scipy.optimize", "scipy.integrate",
    "scipy.stats", "scipy.signal", "scipy.special", "pint",
    "sealdyn.report.charts", "sealdyn.studies", "sealdyn.analysis",
}  # fmt: skip
OF_OTHERS = (
    "floored", "cavitated", "contact_load", "thinnest_of_waves", "locate_contacts", "profiled", "residual_at",
    "_step_ida",
)  # fmt: skip


# Files of the package, without those that only name a folder: 145 once.
MOST_FILES = 86
FOLDERS = {f"{path.parent.relative_to(ROOT)}".replace("/", ".") for path in ROOT.glob("sealdyn/**/__init__.py")}


def files_of_package(modules):
    return {name for name in modules if name.startswith("sealdyn.")} - FOLDERS


def named(kernels, names):
    return sorted(kernel for kernel in kernels if any(name in kernel for name in names))


def test_a_run_without_figure_loads_no_more_than_it_needs(tmp_path):
    modules, kernels = run(tmp_path, "fms_reference", "--set", "run.turns=2")
    assert not modules & BESIDE_A_RUN
    assert len(files_of_package(modules)) <= MOST_FILES
    assert "films.radial.film.wrench" in kernels and "faces.contact.no_load" in kernels
    assert not named(kernels, OF_OTHERS), kernels


def test_a_kernel_called_with_many_constants_is_compiled_once(tmp_path):
    """A literal in the call may be a type of its own: the arrays of a segment's block once took six kernels."""
    run(tmp_path, "fms_reference", "--set", "run.turns=2")
    assert len([kept for kept in kept_kernels() if kept.match("native.array-*.nbc")]) == 1


def test_a_linear_run_needs_no_sundials(tmp_path):
    words = ("--set", "film.model=linear", "--set", "run.turns=2")
    modules, kernels = run(tmp_path, "fms_reference", *words)
    assert not modules & (BESIDE_A_RUN | {"scipy.sparse"})
    # Its leakage is that of the radial film, which it is judged by.
    assert not named(kernels, (*OF_OTHERS, "films.radial.film.wrench"))


def test_what_a_scene_has_is_made_ready(tmp_path):
    _, kernels = run(tmp_path, "fms_reference", "--set", "run.turns=1", "--set", "film.cavitation_pressure='0 bar'")
    assert named(kernels, ["floored.wrench"])
