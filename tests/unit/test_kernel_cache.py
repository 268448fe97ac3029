"""Kernels kept on disk, stale, foreign and damaged, in a package of two kernels that keeps them as sealdyn does: one
takes in a constant and calls a kernel of other files, in folders of their own."""

import os
import re
import shutil
import subprocess
import sys
import time
from contextlib import contextmanager

import pytest
from numba import njit
from numba.core import event

import sealdyn.kernel_cache

FILES = {
    "faces/slots.py": "WIDTH = 2.0\n",
    "faces/thickness.py": "from ..numerics.kernel import outer_kernel\n\n\n@outer_kernel\ndef thick(x):\n"
    "    return 10.0 * x\n",
    "films/deep/wide.py": "from ...faces import (\n    slots,\n)\nfrom ...faces.thickness import thick\n"
    "from ...numerics.kernel import outer_kernel\n\nWIDTH = slots.WIDTH\n\n\n"
    "@outer_kernel\ndef wide(x):\n    return WIDTH * thick(x)\n",
    "report.py": "",
}
CALL = """
from plain.films.deep.wide import wide
from plain.kernel_cache import kept_kernels
print(wide(1.0), sum(wide.stats.cache_misses.values()), len(kept_kernels()))
"""
COLD, WARM = (20.0, 1, 4), (20.0, 0, 4)
PACKAGE = sealdyn.kernel_cache.PACKAGE


PLACES = ["where NUMBA_CACHE_DIR says"]
PLACES += [pytest.param(p, marks=pytest.mark.slow) for p in ("beside the sources", "in the user's folder", "nowhere")]


@pytest.fixture(params=PLACES)
def package(request, tmp_path):
    """A function that calls the kernel in a new process: result, kernels compiled, files kept; and what it says."""
    root, user = tmp_path / "plain", tmp_path / "user"
    for name, text in FILES.items():
        (root / name).parent.mkdir(parents=True, exist_ok=True)
        (root / name).write_text(text)
    (root / "numerics").mkdir()
    for name in ("extensions.py", "kernel_cache.py", "numerics/kernel.py"):
        shutil.copy(PACKAGE / name, root / name)
    environment = {k: v for k, v in os.environ.items() if k != "NUMBA_CACHE_DIR"}
    environment |= {"XDG_CACHE_HOME": str(user), "PYTHONDONTWRITEBYTECODE": "1"}
    if request.param.startswith("where"):
        environment["NUMBA_CACHE_DIR"] = str(tmp_path / "elsewhere")
    elif not request.param.startswith("beside"):
        # A file in the folder's place: not even root can write into it.
        (root / "__pycache__").touch()
        if request.param == "nowhere":
            user.touch()

    def call():
        line = [sys.executable, "-c", CALL]
        done = subprocess.run(line, cwd=tmp_path, env=environment, capture_output=True, text=True)
        assert done.returncode == 0, done.stderr
        result, misses, kept = done.stdout.split()
        return (float(result), int(misses), int(kept)), done.stderr

    call.root, call.keeps = root, request.param != "nowhere"
    return call


def changed(package, name, old, new):
    file = package.root / name
    file.write_text(file.read_text().replace(old, new) if old else new)


def test_kernels_are_kept_wherever_can_be_written(package):
    found, words = package()
    assert found == COLD and ("NUMBA_CACHE_DIR" in words) == (not package.keeps)
    assert package()[0] == (WARM if package.keeps else COLD)
    changed(package, "faces/slots.py", "2.0", "3.0")
    assert package()[0] == (30.0, 1, 4)


@pytest.mark.parametrize("package", PLACES[:1], indirect=True)
def test_stale_kernels_are_made_anew(package):
    assert package()[0] == COLD
    changed(package, "report.py", "", "print\n")
    assert package()[0] == WARM
    # A constant of another folder, imported as a module; a kernel of another file.
    changed(package, "faces/slots.py", "2.0", "3.0")
    assert package()[0] == (30.0, 1, 4)
    changed(package, "faces/thickness.py", "10.0", "100.0")
    assert package()[0] == (300.0, 1, 4)
    # Those of the first sources are still there.
    changed(package, "faces/slots.py", "3.0", "2.0")
    changed(package, "faces/thickness.py", "100.0", "10.0")
    assert package()[0] == WARM


@pytest.mark.parametrize("package", PLACES[:1], indirect=True)
def test_the_newest_three_stay_and_all_of_others(package, tmp_path):
    """The folder may be shared: other packages' kernels are left alone."""
    other = tmp_path / "elsewhere" / "films_of_another_package" / "wide.wide-9.py311.1.nbc"
    other.parent.mkdir(parents=True)
    other.write_bytes(b"kernel")
    assert package()[0] == COLD
    prefix = sealdyn.kernel_cache.PREFIX
    older = [other.parents[1] / f"{prefix}{days}" for days in (1, 2, 3)]
    for days, folder in enumerate(older, start=1):
        folder.mkdir()
        os.utime(folder, (time.time() - 86400.0 * days,) * 2)
    changed(package, "faces/slots.py", "2.0", "3.0")
    assert package()[0] == (30.0, 1, 4)
    assert [folder.exists() for folder in older] == [True, False, False] and other.exists()
    assert len(list(other.parents[1].glob(prefix + "*"))) == 3
    changed(package, "faces/slots.py", "3.0", "2.0")
    assert package()[0] == WARM


@pytest.mark.parametrize("package", PLACES[:1], indirect=True)
@pytest.mark.parametrize("missing", [False, True])
def test_kept_kernels_that_are_read_only(package, tmp_path, missing):
    """They are read; those that are not among them are made, and nothing is said."""
    package()
    (folder,) = (tmp_path / "elsewhere").iterdir()
    if missing:
        for file in folder.glob("wide*"):
            file.unlink()
    before = sorted(folder.iterdir())
    with unwritable(folder):
        assert package() == ((20.0, int(missing), 4), "")
    assert sorted(folder.iterdir()) == before


@contextmanager
def unwritable(folder):
    """A folder into which nobody writes, root neither: skipped where the system has no such thing."""
    if os.geteuid():
        folder.chmod(0o555)
    elif not shutil.which("chattr") or subprocess.run(["chattr", "+i", folder], capture_output=True).returncode:
        pytest.skip("root writes everywhere here")
    try:
        yield
    finally:
        folder.chmod(0o755) if os.geteuid() else subprocess.run(["chattr", "-i", folder], check=True)


IMPORTS = re.compile(r"^from (\.+)([\w.]*) import (\([^)]*\)|[^\n]*)", re.MULTILINE)
KERNEL = re.compile(r"^@(njit|cfunc|(outer|value|inner|lazy)_kernel|c_function)\b", re.MULTILINE)


@pytest.mark.core
def test_sources_of_kernels_hold_all_that_kernels_are_made_of():
    """Files of kernels and all that they import, however far."""
    texts = {path: path.read_text() for path in PACKAGE.rglob("*.py")}
    found, ahead = set(), [path for path, text in texts.items() if KERNEL.search(text)]
    assert len(ahead) > 30
    while ahead:
        path = ahead.pop()
        found.add(path)
        for dots, module, names in IMPORTS.findall(texts[path]):
            target = path.parents[len(dots) - 1].joinpath(*filter(None, module.split(".")))
            modules = [target.with_suffix(".py")]
            modules += [target / f"{name}.py" for name in ("__init__", *re.findall(r"\w+", names))]
            ahead += [file for file in modules if file in texts and file not in found]
    found -= {PACKAGE / "kernel_cache.py", PACKAGE / "extensions.py"}
    assert found <= set(sealdyn.kernel_cache.kernel_sources())


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


def test_a_function_value_is_kept_as_the_kernel_that_a_call_compiles():
    """What is kept goes by the signature that was asked for, with its return type or without."""
    from sealdyn.dynamics.native import Value

    @njit
    def plain(f, s):
        s[0] = f[0]

    with event.install_recorder("numba:compile") as seen:
        Value(plain)
    assert seen.buffer and {found.data["return_type"] for _, found in seen.buffer} == {None}


KERNELS = """
from sealdyn.numerics.kernel import outer_kernel

@outer_kernel
def one(x):
    return 1.0 * x

@outer_kernel
def two(x):
    return 2.0 * x

@outer_kernel
def three(x):
    return 3.0 * x

@outer_kernel
def four(x):
    return 4.0 * x

for kernel in (one, two, three, four):
    print(kernel(2.0), sum(kernel.stats.cache_hits.values()))
"""


# Half a file, one with a bit turned (in the machine code: numba would run it), nonsense, nothing.
DAMAGES = (
    lambda data: data[: len(data) // 2],
    lambda data: data[: (at := len(data) // 2)] + bytes([data[at] ^ 1]) + data[at + 1 :],
    lambda data: bytes(255 - byte for byte in data),
    lambda data: b"",
)


@pytest.fixture(scope="module")
def warm(tmp_path_factory):
    """Calls the program of four kernels, which are kept: what it prints and says; the files of the four."""
    folder = tmp_path_factory.mktemp("kernels")
    program = folder / "program.py"
    program.write_text(KERNELS)
    words = {**os.environ, "NUMBA_CACHE_DIR": str(folder / "kept"), "PYTHONPATH": os.pathsep.join(sys.path)}

    def call():
        done = subprocess.run([sys.executable, program], env=words, capture_output=True, text=True, timeout=300)
        assert done.returncode == 0, done.stderr
        return done.stdout.split(), done.stderr

    def kept(files):
        return sorted(path for path in (folder / "kept").rglob(files) if "program" in path.name)

    call()
    assert call() == (printed(1), "")
    return call, kept


def printed(hits):
    """What the program prints where each kernel was so often found."""
    return [word for value in ("2.0", "4.0", "6.0", "8.0") for word in (value, str(hits))]


@pytest.mark.parametrize("files", ["*.nbc", "*.nbi"])
def test_damaged(warm, files):
    """Each of the four kernels in a way of its own."""
    call, kept = warm
    for path, damage in zip(kept(files), DAMAGES, strict=True):
        path.write_bytes(damage(path.read_bytes()))
    answer, said = call()
    assert answer == printed(0)
    assert said.count("damaged and are compiled anew") == 1
    assert call() == (printed(1), "")
