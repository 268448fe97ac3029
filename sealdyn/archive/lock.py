"""One writer of an archive at a time: it holds a lock beside it, which ends with its process, however that ends."""

import os
from contextlib import contextmanager, suppress
from pathlib import Path

from filelock import FileLock, Timeout

from .run import followed
from .soundness import ArchiveError


@contextmanager
def only_writer(path):
    """While the block lasts nobody else writes the archive `path`, its partial file or its journal, in this process or
    another one of this machine; gives where it really is.  Raises ArchiveError where somebody does, and where no file
    can be."""
    place = followed(path)
    if place.is_symlink() or (place.exists() and not place.is_file()):
        raise ArchiveError(f"{path}: found what is no file (a folder, a pipe, a device, a link to itself)")
    path = Path(os.path.realpath(place))
    made = [folder for folder in path.parents if not folder.exists()]
    path.parent.mkdir(parents=True, exist_ok=True)
    beside = path.with_name(f".{path.stem}.lock")
    lock = FileLock(beside, timeout=0)
    try:
        lock.acquire()
    except Timeout:
        raise ArchiveError(
            f"{path}: another run or study is writing it; let it end, or choose another file (--out)"
        ) from None
    try:
        yield place
    finally:
        # Before it is free: whoever waits for it sees that it is gone, and makes a new one.
        with suppress(OSError):
            beside.unlink()
        lock.release()
        # Folders in which nothing came to stand.
        with suppress(OSError):
            for folder in made:
                folder.rmdir()
