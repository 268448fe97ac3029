"""Whether a file from elsewhere is one that HDF5 may read: looked through in a process of its own, where HDF5 may
crash, before anything of it is used.

    python -m sealdyn.archive.soundness FILE

prints nothing and ends with 0 for a sound file, else says what is wrong with it.
"""

import os
import signal
import subprocess
import sys
from pathlib import Path

import h5py
import numpy as np

# Longest time (s), processor time (s) and most memory (bytes) that looking through takes; objects, attributes and depth
# of groups at most.  The system ends what runs in circles, even if whoever asked is gone.
PATIENCE, WORK, MEMORY, MOST, DEEPEST = 30, 4, 8 << 30, 10_000, 8
# How a process ends that the system has ended for its work, where it does.
ENDLESS = -getattr(signal, "SIGXCPU", 1000)
# Bytes that a dataset may have beyond those it holds in the file.
UNHELD = 1 << 26
# Kinds of numbers (numpy's letters) in an archive; words besides.
NUMBERS = "fiub"

# Files found sound, or written by this process, as they were then; those that it is writing (device, inode).
_sound, _writing = set(), set()


class ArchiveError(Exception):
    """A file that cannot be read as an archive, or cannot be continued; one line.

    >>> try:
    ...     sealdyn.open_archive("nothing.h5")
    ... except sealdyn.ArchiveError as error:
    ...     print(error)
    nothing.h5: no such file
    """


def is_sound(path) -> None:
    """This process wrote the file, and wrote it well."""
    _sound.add(_identity(path))


def begin_writing(file) -> None:
    """This process begins to write an open file, which is sound at any time, until `end_writing`."""
    _writing.add(_identity(file.fileno())[:2])


def end_writing(file) -> None:
    """This process is about to close a file that it has written."""
    _writing.discard(_identity(file.fileno())[:2])


def must_be_sound(path) -> None:
    """Raises ArchiveError for a file that holds links to elsewhere, datasets in other files, types or sizes that no
    archive has, or that HDF5 cannot read; FileNotFoundError for one that is not there (any more)."""
    identity = _identity(path)
    if identity in _sound or identity[:2] in _writing:
        return
    # Of the folder where the program is run nothing is loaded.
    words = [sys.executable, "-P", "-m", __name__, os.path.abspath(path)]
    among = {**os.environ, "PYTHONPATH": os.pathsep.join(filter(None, sys.path))}
    try:
        found = subprocess.run(words, capture_output=True, timeout=PATIENCE, env=among, stdin=subprocess.DEVNULL)
        endless = found.returncode == ENDLESS
    except subprocess.TimeoutExpired:
        endless = True
    if endless:
        raise ArchiveError(f"{path}: damaged (HDF5 does not come to an end with it)")
    if found.returncode < 0:
        raise ArchiveError(f"{path}: damaged (HDF5 crashes on it)")
    if found.returncode and not os.path.exists(path):
        # A run has ended meanwhile, and its file has another name.
        raise FileNotFoundError(path)
    if found.returncode:
        lines = found.stdout.decode(errors="replace").splitlines() or ["HDF5 cannot read it"]
        raise ArchiveError(f"{path}: damaged or not an archive ({lines[-1][:200]})")
    _sound.add(identity)


def _identity(path):
    about = os.stat(path)
    return about.st_dev, about.st_ino, about.st_size, about.st_mtime_ns


class Unsound(Exception):
    """What is wrong, in words."""


def look_through(path) -> None:
    """All of a file that is not the values of its series; raises Unsound, or whatever HDF5 raises."""
    with h5py.File(path, "r") as file:
        _look(file, "", set(), 0)


def _look(group, name, seen, depth):
    _look_at_attributes(group, name or "/")
    for step in group:
        below = f"{name}/{step}"
        link = group.get(step, getlink=True)
        if not isinstance(link, h5py.HardLink):
            raise Unsound(f"{below} is a link to elsewhere")
        item = group[step]
        place = h5py.h5o.get_info(item.id).addr
        if place in seen or len(seen) >= MOST or depth > DEEPEST:
            raise Unsound(f"{below} is there twice, or there are too many objects")
        seen.add(place)
        if isinstance(item, h5py.Group):
            _look(item, below, seen, depth + 1)
        elif isinstance(item, h5py.Dataset):
            _look_at_dataset(item, below)
        else:
            raise Unsound(f"{below} is a type, not data")


def _look_at_attributes(item, name):
    if len(item.attrs) > MOST:
        raise Unsound(f"{name} has {len(item.attrs)} attributes")
    for key, value in item.attrs.items():
        if isinstance(value, h5py.Empty):
            raise Unsound(f"attribute {key} of {name} is empty")
        # What dimension scales are made of; everything else is a number or a word.
        if key not in ("DIMENSION_LIST", "REFERENCE_LIST") and np.asarray(value).dtype.kind not in NUMBERS + "OSU":
            raise Unsound(f"attribute {key} of {name} is of type {np.asarray(value).dtype}")


def _look_at_dataset(item, name):
    plan = item.id.get_create_plist()
    if plan.get_layout() == h5py.h5d.VIRTUAL or plan.get_external_count():
        raise Unsound(f"{name} stands in other files")
    if plan.get_nfilters():
        raise Unsound(f"{name} is compressed: h5repack -f NONE makes it readable")
    _look_at_attributes(item, name)
    words = h5py.check_string_dtype(item.dtype) is not None
    if item.shape is None or (item.dtype.kind not in NUMBERS and not words):
        raise Unsound(f"{name} is of type {item.dtype}")
    held = item.id.get_storage_size()
    if item.size * item.dtype.itemsize > held + UNHELD:
        raise Unsound(f"{name} is to have {item.size * item.dtype.itemsize:.3g} bytes and holds {held}")
    if words:
        item.asstr()[()]
    elif item.size:
        item[(0,) * item.ndim], item[tuple(length - 1 for length in item.shape)]
    for dimension in item.dims:
        for scale in dimension.values():
            if scale.ndim != 1 or scale.shape[0] != item.shape[dimension._dimension]:
                raise Unsound(f"{name} has a dimension of another length than {scale.name}")


def main():
    """The other process."""
    # Not everywhere.
    try:
        import resource

        resource.setrlimit(resource.RLIMIT_AS, (MEMORY, MEMORY))
        resource.setrlimit(resource.RLIMIT_CORE, (0, 0))
        resource.setrlimit(resource.RLIMIT_CPU, (WORK, WORK + 1))
    except (ImportError, ValueError, OSError):
        pass
    path = Path(sys.argv[1])
    try:
        look_through(path)
    except Unsound as found:
        print(found)
        return 1
    except MemoryError:
        print("it asks for more memory than there is")
        return 1
    except Exception as error:
        print(" ".join(str(error).split()) or type(error).__name__)
        return 1
    return 0


if __name__ == "__main__":
    # HDF5's own way to end may crash, too.
    code = main()
    sys.stdout.flush()
    os._exit(code)
