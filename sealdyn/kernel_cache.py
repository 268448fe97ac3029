"""Compiled kernels on disk: one folder for each state of the sources that kernels are made of.

numba keeps a kernel until the file it stands in changes; it does not see that a constant or a kernel of another file
has changed, and would go on with the old one.  So the folder's name is a digest of all these files, and kernels of
other sources stand in folders of their own.  Kernels of other versions of Python and of other processors need no care:
numba keeps them apart.  Nor does it matter whether a kernel was compiled in this process or loaded: no kernel uses
fast-math, so both have the same bits (tests/benchmark/equal_bits.py).
"""

import contextlib
import hashlib
import os
import shutil
import tempfile
import warnings
from collections.abc import Callable
from functools import cache
from pathlib import Path

from .extensions import digest_of, is_outside

PACKAGE = Path(__file__).parent
# Rooms and files in which kernels stand, and all that these import.
SOURCES = (
    "closed_form", "dynamics", "faces", "films", "numerics", "quantities.py", "radial_seals", "scene", "solvers",
    "status.py", "unit_names.py", "units.py",
)  # fmt: skip
PREFIX, NEWEST = "sealdyn-kernels-", 3
# Called with 1 as numba begins to compile a kernel that is not kept, with -1 as it ends; one may need another first.
compiling: list[Callable[[int], None]] = []


def kernel_sources() -> list[Path]:
    """Files that kernels are made of, in a fixed order."""
    places = (PACKAGE / source for source in SOURCES)
    return sorted(file for place in places for file in ([place] if place.is_file() else place.rglob("*.py")))


@cache
def solvers_digest() -> str:
    """What today's films, equations and solvers are called: a digest of the files that kernels are made of."""
    digest = hashlib.sha256()
    for file in kernel_sources():
        digest.update(str(file.relative_to(PACKAGE)).encode() + file.read_bytes())
    return digest.hexdigest()[:16]


@cache
def kernel_folder() -> Path:
    """The folder of kernels of today's sources; it can be written.

    It stands below NUMBA_CACHE_DIR, or beside the sources, or in the user's folder of caches: the first that can be
    written.  Kernels kept where nothing can be written are read from there; new ones are then kept in a temporary
    folder, which goes when this process ends, with a warning if none were kept.
    """
    folders = [place / (PREFIX + solvers_digest()) for place in _places()]
    for folder in folders:
        with contextlib.suppress(OSError):
            _make(folder)
            return folder
    return _temporary_folder(folders)


def _places() -> list[Path]:
    """Folders that may hold folders of kernels, the best first."""
    if elsewhere := os.environ.get("NUMBA_CACHE_DIR"):
        return [Path(elsewhere)]
    user = os.environ.get("XDG_CACHE_HOME") or os.environ.get("LOCALAPPDATA") or os.path.expanduser("~/.cache")
    return [PACKAGE / "__pycache__", Path(user)]


def _make(folder: Path):
    """Make the folder, mark it as used today, and leave the newest of its kind."""
    is_new = not folder.is_dir()
    folder.mkdir(parents=True, exist_ok=True)
    tempfile.TemporaryFile(dir=folder).close()
    os.utime(folder)
    if is_new:
        kept = sorted(folder.parent.glob(PREFIX + "*"), key=lambda other: other.stat().st_mtime, reverse=True)
        for other in kept[NEWEST:]:
            shutil.rmtree(other, ignore_errors=True)


def _temporary_folder(folders: list[Path]) -> Path:
    """A temporary folder with links to the kernels of the first of the folders that has any."""
    global _temporary
    _temporary = tempfile.TemporaryDirectory(prefix="sealdyn_kernels_", ignore_cleanup_errors=True)
    folder = Path(_temporary.name) / folders[0].name
    folder.mkdir()
    kept = next(filter(None, ([*other.glob("*.nb[ic]")] for other in folders)), [])
    for file in kept:
        os.symlink(file.absolute(), folder / file.name)
    # Processes that are started from here keep theirs in the same place.
    os.environ["NUMBA_CACHE_DIR"] = _temporary.name
    if not kept:
        warnings.warn(
            "no folder for compiled kernels can be written: every run compiles them again; "
            "let NUMBA_CACHE_DIR name one that can",
            stacklevel=3,
        )
    return folder


def kept_kernels() -> list[Path]:
    """Files of kept kernels of today's sources."""
    return [*kernel_folder().glob("*.nb[ic]")]


@cache
def _names_package(path: Path) -> bool:
    """Whether a file that is no part of this package imports from it."""
    return path.is_file() and not path.is_relative_to(PACKAGE) and PACKAGE.name.encode() in path.read_bytes()


class KernelLocator:
    """Where numba keeps a kernel of `SOURCES`, or of another file whose constants may be this package's; functions of
    others are left to numba."""

    def __init__(self, function, file: str):
        self._py_file, path = file, Path(file)
        # One from outside by its own source besides: the folder's name has that of this package alone.
        ours = path.is_relative_to(PACKAGE)
        place = ".".join(path.relative_to(PACKAGE).parts[:-1]) if ours else f"outside-{digest_of(path)}"
        self._name = f"{place}-{function.__code__.co_firstlineno}"

    @classmethod
    def from_function(cls, py_func, py_file: str):
        """A locator of a function of this package's kernels or of a file that may use its constants, or None."""
        path = Path(py_file)
        ours = any(path.is_relative_to(PACKAGE / source) for source in SOURCES)
        return cls(py_func, py_file) if ours or is_outside(path) or _names_package(path) else None

    def ensure_cache_path(self):
        """The folder stands."""

    def get_cache_path(self) -> str:
        """The folder of kept kernels."""
        return str(kernel_folder())

    def get_source_stamp(self) -> str:
        """What the sources were: the folder's name."""
        return kernel_folder().name

    def get_disambiguator(self) -> str:
        """What tells kernels of one name and file name apart: room and line."""
        return self._name
