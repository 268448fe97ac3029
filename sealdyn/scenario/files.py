"""Reading of files that come from anywhere: nothing that has no end, or keeps its reader waiting."""

import os
import stat
from pathlib import Path


def whole_file(path: Path, most: int) -> bytes:
    """The bytes of a file; raises OSError for pipes, devices, what has more than `most` bytes, and what the system
    makes up as it is read and has none now."""
    # Of a pipe without a writer, or the kernel's messages, it does not wait.
    with open(os.open(path, os.O_RDONLY | getattr(os, "O_NONBLOCK", 0) | getattr(os, "O_BINARY", 0)), "rb") as file:
        if not stat.S_ISREG(os.fstat(file.fileno()).st_mode):
            raise OSError("a pipe or a device")
        data = file.read(most + 1)
    if data is None or len(data) > most:
        raise OSError(f"more than {most} bytes" if data else "nothing in it now")
    return data
