"""A kernel kept from before a constant of another file changed is not used again."""

import os
import shutil
import subprocess
import sys
from pathlib import Path

PACKAGE = Path(__file__).parents[2] / "sealdyn"
TOUCH = "from sealdyn.faces.geometry import edge_gaps; print(edge_gaps.__name__)"


def python(code, folder):
    environment = {k: v for k, v in os.environ.items() if k != "NUMBA_CACHE_DIR"}
    command = [sys.executable, "-c", code]
    return subprocess.run(command, cwd=folder, env=environment, capture_output=True, text=True, check=True).stdout


def test_changed_constant_drops_every_kernel(tmp_path):
    copy = tmp_path / "sealdyn"
    shutil.copytree(PACKAGE, copy, ignore=shutil.ignore_patterns("__pycache__"))
    python("import sealdyn", tmp_path)
    kept = copy / "films" / "__pycache__" / "radial.wrench-1.py311.nbi"
    kept.parent.mkdir(exist_ok=True)
    kept.write_bytes(b"kernel")
    python(TOUCH, tmp_path)
    assert kept.exists()
    gap = copy / "faces/geometry.py"
    gap.write_text(gap.read_text().replace("GAP_STATE_SIZE = 28", "GAP_STATE_SIZE = 29"))
    python(TOUCH, tmp_path)
    assert not kept.exists()


def test_a_change_elsewhere_keeps_them(tmp_path):
    copy = tmp_path / "sealdyn"
    shutil.copytree(PACKAGE, copy, ignore=shutil.ignore_patterns("__pycache__"))
    python("import sealdyn", tmp_path)
    kept = copy / "__pycache__" / "gap.h_min-1.py311.nbi"
    kept.write_bytes(b"kernel")
    report = copy / "report.py"
    report.write_text(report.read_text() + "\n")
    python("import sealdyn", tmp_path)
    assert kept.exists()
