"""Compiled kernels on disk: where numba keeps those of this package, and away with them when they fit no more.

numba keeps a kernel until the file it stands in changes; it does not see that a constant or a kernel of another file
has changed, and would go on with the old one.  Kernels of other versions of Python or numba and of other processors
need no care: numba keeps them apart.  Nor does it matter whether a kernel was compiled in this process or loaded: no
kernel uses fast-math, so both have the same bits (tests/unit/test_equal_bits.py).
"""

import contextlib
import hashlib
import os
import re
import warnings
from pathlib import Path

PACKAGE = Path(__file__).parent
STAMP = "kernels.stamp"
# What a kernel has above its first line.
KERNEL = re.compile(rb"^@(njit|cfunc|(outer|value|inner|lazy)_kernel|c_function)\b", re.MULTILINE)
# Relative imports at the left margin: dots, module, names.
IMPORT = re.compile(rb"^from (\.+)([\w.]*) import (\([^)]*\)|[^\n]*)", re.MULTILINE)


def _sources() -> dict[Path, bytes]:
    """All source files of the package.  Path -> content."""
    files = (Path(folder, name) for folder, _, names in os.walk(PACKAGE) for name in names if name.endswith(".py"))
    return {path: path.read_bytes() for path in files}


def kernel_sources(texts: dict[Path, bytes] | None = None) -> dict[Path, bytes]:
    """Files that hold kernels, and all that they import, however far: the constants they take in.  Path -> content;
    `texts` those of all source files, if read already."""
    texts = texts or _sources()
    found, ahead = set(), [path for path, text in texts.items() if KERNEL.search(text)]
    while ahead:
        path = ahead.pop()
        if path in found:
            continue
        found.add(path)
        for dots, module, names in IMPORT.findall(texts[path]):
            target = path.parents[len(dots) - 1].joinpath(*filter(None, module.decode().split(".")))
            if (file := target.with_suffix(".py")) not in texts:
                modules = ("__init__", *re.findall(r"\w+", names.decode()))
                ahead += [file for file in (target / f"{module}.py" for module in modules) if file in texts]
            else:
                ahead.append(file)
    return {path: texts[path] for path in sorted(found)}


def _writable(folder: Path) -> bool:
    """Whether files can be made in the folder, which is made if it can be."""
    with contextlib.suppress(OSError):
        folder.mkdir(parents=True, exist_ok=True)
    return folder.is_dir() and os.access(folder, os.W_OK | os.X_OK)


def _shared_folder() -> Path | None:
    """The folder where numba keeps kernels away from their sources; None: it keeps them beside their sources."""
    if elsewhere := os.environ.get("NUMBA_CACHE_DIR"):
        return Path(elsewhere)
    if _writable(PACKAGE / "__pycache__"):
        return None
    from numba.misc.appdirs import AppDirs

    return Path(AppDirs(appname="numba", appauthor=False).user_cache_dir)


def kernel_folders() -> list[Path]:
    """Folders of this package's kept kernels; they need not exist."""
    shared = _shared_folder()
    return [_kept_in(folder, shared) for folder in sorted({path.parent for path in PACKAGE.rglob("*.py")})]


def _kept_in(folder: Path, shared: Path | None) -> Path:
    """Where the kernels of a source folder are kept."""
    if shared is None:
        return folder / "__pycache__"
    # numba's own names: a source folder's name and the SHA-1 of its path.
    return shared / f"{folder.name}_{hashlib.sha1(os.path.abspath(folder).encode()).hexdigest()}"


def kept_kernels() -> list[Path]:
    """Files of this package's kept kernels."""
    return [kept for folder in kernel_folders() for kept in folder.glob("*.nb[ic]")]


def clear_stale_kernels() -> bool:
    """Delete the kept kernels if any source of kernels differs from when they were made; returns whether it deleted
    any.
    Where no kernel can be kept at all, this process and its children keep them in a temporary folder, with a warning
    (numba would raise)."""
    texts, stamp, before = _sources(), _kept_in(PACKAGE, _shared_folder()) / STAMP, ["", ""]
    whole = _digest(texts)
    with contextlib.suppress(OSError):
        before = [*stamp.read_text().split(), "", ""][:2]
    if before[0] == whole:
        # Nothing has changed at all, so that nobody needs to ask what kernels import.
        return False
    of_kernels = _digest(kernel_sources(texts))
    if not _writable(stamp.parent):
        if before[1] != of_kernels:
            _keep_for_this_process()
        return False
    kept = kept_kernels() if before[1] != of_kernels else []
    for file in kept:
        file.unlink(missing_ok=True)
    stamp.write_text(f"{whole} {of_kernels}")
    return bool(kept)


def _digest(texts: dict[Path, bytes]) -> str:
    """Digest of files, names and contents."""
    digest = hashlib.sha256()
    for path in sorted(texts):
        digest.update(str(path.relative_to(PACKAGE)).encode() + texts[path])
    return digest.hexdigest()


def _keep_for_this_process():
    """Let numba keep kernels in a temporary folder, which goes when this process ends."""
    global _temporary
    import tempfile

    from numba.core import config

    _temporary = tempfile.TemporaryDirectory(prefix="sealdyn_kernels_", ignore_cleanup_errors=True)
    # numba looks at the environment once; the processes started from here look again.
    os.environ["NUMBA_CACHE_DIR"] = config.CACHE_DIR = _temporary.name
    warnings.warn(
        "no folder for compiled kernels can be written: every run compiles them again; "
        "let NUMBA_CACHE_DIR name one that can",
        stacklevel=3,
    )
