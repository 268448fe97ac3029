"""Kept kernels that a disk or a hand has damaged: compiled anew, said once, never run."""

import os
import subprocess
import sys

import pytest

KERNELS = """
from sealdyn.numerics.kernel import outer_kernel

@outer_kernel
def twice(x):
    return 2.0 * x

@outer_kernel
def thrice(x):
    return 3.0 * x

print(twice(2.0), thrice(2.0), sum(twice.stats.cache_hits.values()), sum(thrice.stats.cache_hits.values()))
"""


def cut(data):
    return data[: len(data) // 2]


def one_bit(data):
    """In the machine code: numba would run it."""
    at = len(data) // 2
    return data[:at] + bytes([data[at] ^ 1]) + data[at + 1 :]


def nonsense(data):
    return bytes(255 - byte for byte in data)


def nothing(data):
    return b""


@pytest.mark.core
@pytest.mark.parametrize("files", ["*.nbc", "*.nbi"])
@pytest.mark.parametrize("damage", [cut, one_bit, nonsense, nothing])
def test_damaged(tmp_path, damage, files):
    program = tmp_path / "program.py"
    program.write_text(KERNELS)
    words = {**os.environ, "NUMBA_CACHE_DIR": str(tmp_path / "kept"), "PYTHONPATH": os.pathsep.join(sys.path)}

    def call():
        done = subprocess.run([sys.executable, program], env=words, capture_output=True, text=True, timeout=300)
        assert done.returncode == 0, done.stderr
        return done.stdout.split(), done.stderr

    def kept():
        return sorted(path for path in (tmp_path / "kept").rglob(files) if "program" in path.name)

    call()
    assert call() == (["4.0", "6.0", "1", "1"], "")
    assert len(kept()) == 2
    for path in kept():
        path.write_bytes(damage(path.read_bytes()))
    answer, said = call()
    assert answer == ["4.0", "6.0", "0", "0"]
    assert said.count("damaged and are compiled anew") == 1
    assert call() == (["4.0", "6.0", "1", "1"], "")
