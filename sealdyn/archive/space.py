"""Room on the disk before HDF5 writes: a write of its own that fails may crash it, or never lets go of the file."""

import errno
import os
import shutil
from contextlib import contextmanager
from pathlib import Path

import h5py

# What a full or failing disk says.
FULL = frozenset(
    getattr(errno, name) for name in ("ENOSPC", "EDQUOT", "EFBIG", "EIO", "ENXIO", "ESTALE") if hasattr(errno, name)
)
# File systems that cannot give room beforehand.
UNABLE = (errno.EINVAL, errno.EOPNOTSUPP, errno.ENOSYS)
# Bytes of bookkeeping: of a file, and of each dataset.
FILE, DATASET = 1 << 18, 1 << 13


def is_full(error: OSError) -> bool:
    """Whether an error is that of a disk that is full, has no quota left or fails."""
    return error.errno in FULL or (error.errno is None and "unable to" in str(error).lower())


@contextmanager
def hdf5_with_room(path: Path, size: int, mode: str = "w"):
    """An open HDF5 file (`mode` "w" anew, "r+" as it is) that may grow to `size` bytes whatever others write meanwhile.
    Raises OSError where the disk has no such room."""
    _assure(path, size)
    with h5py.File(path, mode) as file:
        # Writing it anew has given back what it had.
        _assure(path, size)
        yield file
        file.flush()
        end = file.id.get_filesize()
    if path.stat().st_size > end:
        os.truncate(path, end)


def _assure(path: Path, size: int) -> None:
    with open(path, "ab") as file:
        if hasattr(os, "posix_fallocate"):
            try:
                os.posix_fallocate(file.fileno(), 0, size)
                return
            except OSError as error:
                if error.errno not in UNABLE:
                    raise
        if shutil.disk_usage(path.parent).free < size - os.fstat(file.fileno()).st_size:
            raise OSError(errno.ENOSPC, os.strerror(errno.ENOSPC), str(path))
