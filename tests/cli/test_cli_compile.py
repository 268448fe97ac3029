"""Kernels made beforehand by `sealdyn compile`, after which runs compile nothing; and the line that says so."""

import json
import os
import subprocess
import sys
import time

import pytest

from sealdyn import kernel_cache, terminal

# One of those that ship, with rough faces that are warm: compiling all takes many minutes.
RUNS = ("pump_seal",)
COUNT = """
import json, sys
from sealdyn import cli, kernel_cache
from sealdyn.analysis import check

shipped = check.shipped_paths
check.shipped_paths = lambda: {name: path for name, path in shipped().items() if name in RUNS}

found = []
kernel_cache.compiling.append(found.append)
sys.argv = ["sealdyn", *sys.argv[1:]]
try:
    cli.main()
except SystemExit as end:
    print(json.dumps([end.code, len(found)]), file=sys.stderr)
"""


def compiled_by(folder, *words):
    """Exit code of a verb, and how often numba began or ended to compile."""
    done = subprocess.run(
        [sys.executable, "-c", f"RUNS = {RUNS}\n{COUNT}", *map(str, words)], capture_output=True, text=True,
        env={**os.environ, "NUMBA_CACHE_DIR": str(folder / "kernels")},
    )  # fmt: skip
    return json.loads(done.stderr.splitlines()[-1])


@pytest.mark.slow
def test_after_compile_runs_compile_nothing(tmp_path):
    code, count = compiled_by(tmp_path, "compile")
    assert code == 0 and count > 100
    found = {
        name: compiled_by(tmp_path, "run", f"scenarios/{name}.toml", "--no-plot", "--out", tmp_path / "a.h5")
        for name in RUNS
    }
    assert {name: count for name, (_, count) in found.items() if count} == {}
    assert all(code in (0, 5) for code, _ in found.values())


def test_any_verb_says_once_that_it_compiles(monkeypatch, capsys):
    """Compiling that lasts is told when the next kernel begins, on a terminal or not; what is done at once is not."""
    monkeypatch.setattr(terminal, "PATIENCE", 0.05)
    with terminal.Progress() as bar:
        bar.timer.cancel()
        (tell,) = kernel_cache.compiling
        tell(1), tell(-1)
        assert capsys.readouterr().err == ""
        time.sleep(0.06)
        tell(1), tell(1), tell(-1), tell(-1)
        assert capsys.readouterr().err.count("\n") == 1
    assert kernel_cache.compiling == []
