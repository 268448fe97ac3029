"""One writer of an archive at a time: it holds a lock beside it, which ends with its process, however that ends."""

import os
from contextlib import contextmanager, suppress
from pathlib import Path

from filelock import FileLock, Timeout

from .run import ArchiveError


@contextmanager
def only_writer(path):
    """While the block lasts nobody else writes the archive `path`, its partial file or its journal, in this process or
    another one of this machine.  Raises ArchiveError where somebody does."""
    path = Path(os.path.realpath(path))
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
        yield
    finally:
        # Before it is free: whoever waits for it sees that it is gone, and makes a new one.
        with suppress(OSError):
            beside.unlink()
        lock.release()
