"""What equal bits rest on; runs are compared by `python tests/benchmark/equal_bits.py`, thrice in `.ci/run`."""

import ast
from pathlib import Path

import pytest

from sealdyn.numerics import kernel

ROOT = Path(__file__).parents[2]
DECORATORS = {"njit", "cfunc", "partial", *(name for name in vars(kernel) if name.endswith(("_kernel", "c_function")))}


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
