"""Kernels kept on disk, stale, foreign and damaged, in a package of two kernels that keeps them as sealdyn does: one
takes in a constant and calls a kernel of other files, in folders of their own."""

import os
import shutil
import subprocess
import sys
from pathlib import Path

import pytest
from numba import njit

import sealdyn.kernel_cache

FILES = {
    "__init__.py": "from .kernel_cache import clear_stale_kernels\n\ncleared = clear_stale_kernels()\n",
    "faces/__init__.py": "",
    "faces/slots.py": "WIDTH = 2.0\n",
    "faces/thickness.py": "from numba import njit\n\n\n@njit(cache=True)\ndef thick(x):\n    return 10.0 * x\n",
    "films/deep/__init__.py": "",
    "films/deep/wide.py": "from numba import njit\n\nfrom ...faces import (\n    slots,\n)\n"
    "from ...faces.thickness import thick\n\nWIDTH = slots.WIDTH\n\n\n"
    "@njit(cache=True)\ndef wide(x):\n    return WIDTH * thick(x)\n",
    "report.py": "",
}
CALL = """
import plain
from plain.films.deep.wide import wide
from plain.kernel_cache import kept_kernels
print(wide(1.0), sum(wide.stats.cache_misses.values()), len(kept_kernels()), plain.cleared)
"""
WARM = (20.0, 0, 4, False)


PLACES = ["where NUMBA_CACHE_DIR says"]
PLACES += [pytest.param(p, marks=pytest.mark.slow) for p in ("beside the sources", "in the user's folder", "nowhere")]


@pytest.fixture(params=PLACES)
def package(request, tmp_path):
    """A function that calls the kernel in a new process: result, kernels compiled, files kept, whether cleared."""
    root, user = tmp_path / "plain", tmp_path / "user"
    for name, text in FILES.items():
        (root / name).parent.mkdir(parents=True, exist_ok=True)
        (root / name).write_text(text)
    shutil.copy(Path(sealdyn.kernel_cache.__file__), root / "kernel_cache.py")
    environment = {k: v for k, v in os.environ.items() if k != "NUMBA_CACHE_DIR"}
    environment |= {"XDG_CACHE_HOME": str(user), "PYTHONDONTWRITEBYTECODE": "1"}
    if request.param.startswith("where"):
        environment["NUMBA_CACHE_DIR"] = str(tmp_path / "elsewhere")
    elif not request.param.startswith("beside"):
        if sys.platform != "linux":
            pytest.skip("the user's folder is named otherwise")
        # A file in the folder's place: not even root can write into it.
        for folder in [root, *(path for path in root.rglob("*") if path.is_dir())]:
            (folder / "__pycache__").touch()
        if request.param == "nowhere":
            user.touch()

    def call():
        done = subprocess.run(
            [sys.executable, "-c", CALL], cwd=tmp_path, env=environment, capture_output=True, text=True
        )
        assert done.returncode == 0, done.stderr
        result, misses, kept, cleared = done.stdout.split()
        return (float(result), int(misses), int(kept), cleared == "True"), done.stderr

    call.root, call.keeps = root, request.param != "nowhere"
    return call


def changed(package, name, old, new):
    file = package.root / name
    file.write_text(file.read_text().replace(old, new) if old else new)


def test_stale_kernels_are_made_anew(package):
    cold = (20.0, 1, 4, False)
    found, words = package()
    assert found == cold and ("NUMBA_CACHE_DIR" in words) == (not package.keeps)
    assert package()[0] == (WARM if package.keeps else cold)
    # A constant of another folder, imported as a module; a kernel of another file.
    changed(package, "faces/slots.py", "2.0", "3.0")
    assert package()[0] == (30.0, 1, 4, package.keeps)
    changed(package, "faces/thickness.py", "10.0", "100.0")
    assert package()[0] == (300.0, 1, 4, package.keeps)


def test_a_change_elsewhere_keeps_them(package):
    package()
    changed(package, "report.py", "", "print\n")
    assert package()[0][1] == (0 if package.keeps else 1)


@pytest.mark.parametrize("package", ["where NUMBA_CACHE_DIR says"], indirect=True)
def test_kernels_of_others_stay(package, tmp_path):
    """The folder may be shared: another package's kernels, and those of a copy elsewhere, are left alone."""
    package()
    other = tmp_path / "elsewhere" / "plain_of_another_place" / "wide.wide-9.py311.1.nbc"
    other.parent.mkdir()
    other.write_bytes(b"kernel")
    changed(package, "faces/slots.py", "2.0", "3.0")
    assert package()[0] == (30.0, 1, 4, True) and other.exists()


@pytest.mark.core
def test_sources_of_this_package_reach_their_constants():
    """Files of kernels, and a file without a kernel whose numbers a kernel takes in."""
    found = {path.name for path in sealdyn.kernel_cache.kernel_sources()}
    assert {"film.py", "geometry.py", "contact.py", "roughness.py"} <= found
    assert not {"cli.py", "summary.py"} & found


DECORATORS = ["njit", "cfunc", "outer_kernel", "value_kernel", "inner_kernel", "lazy_kernel", "c_function"]


@pytest.mark.parametrize("decorator", DECORATORS)
def test_all_that_is_compiled_is_a_kernel(tmp_path, decorator):
    text = f"from .b import WIDTH\n\n\n@{decorator}()\ndef a(x):\n    return WIDTH\n".encode()
    texts = {tmp_path / "a.py": text, tmp_path / "b.py": b"WIDTH = 1.0\n", tmp_path / "c.py": b"OTHER = 1.0\n"}
    assert [path.name for path in sealdyn.kernel_cache.kernel_sources(texts)] == ["a.py", "b.py"]


def test_only_what_has_an_address_is_a_function_value():
    """Called by the address 0 the process would end."""
    from sealdyn.dynamics.native import Value
    from sealdyn.films.radial.film import wrench

    @njit(no_cfunc_wrapper=True)
    def without(f, s):
        s[0] = f[0]

    assert Value(wrench).address != 0
    with pytest.raises(TypeError, match="without"):
        Value(without)


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
