"""Compiled kernels that no longer fit their sources are thrown away.

numba keeps a kernel until the file it stands in changes; it does not see that a constant or a kernel of another file
has changed, and would go on with the old one.
"""

import contextlib
import hashlib
import os
from pathlib import Path

PACKAGE = Path(__file__).parent
STAMP = "kernels.stamp"


def sources() -> list[Path]:
    """Files that hold kernels or the constants they take in."""
    return sorted(PACKAGE.rglob("*.py"))


def kept_kernels() -> list[Path]:
    """Files of kept kernels, beside their sources or where NUMBA_CACHE_DIR says."""
    elsewhere = os.environ.get("NUMBA_CACHE_DIR")
    # There a folder is named after the one that its sources are in.
    rooms = {path.parent.name for path in sources()}
    folders = [PACKAGE] if not elsewhere else [f for room in rooms for f in Path(elsewhere).glob(f"{room}_*")]
    return [kept for folder in folders for kept in folder.rglob("*.nb[ic]")]


def drop_stale_kernels() -> bool:
    """Delete the kept kernels if any source of kernels differs from when they were made; says whether it did.
    A folder that cannot be written is left alone."""
    digest = hashlib.sha256()
    for path in sources():
        digest.update(path.name.encode() + path.read_bytes())
    folder = os.environ.get("NUMBA_CACHE_DIR") or PACKAGE / "__pycache__"
    stamp, found = Path(folder) / STAMP, digest.hexdigest()
    with contextlib.suppress(OSError):
        if stamp.read_text() == found:
            return False
    dropped = False
    with contextlib.suppress(OSError):
        for kept in kept_kernels():
            kept.unlink(missing_ok=True)
            dropped = True
        stamp.parent.mkdir(parents=True, exist_ok=True)
        stamp.write_text(found)
    return dropped
