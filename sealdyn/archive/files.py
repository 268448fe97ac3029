"""Files of archives: what may be read, who may write, and what was altered.

HDF5 may crash or never end on a file from elsewhere, so that each is looked through in a process of its own before
anything of it is used:

    python -m sealdyn.archive.files FILE

prints nothing and ends with 0 for a sound file, else says what is wrong with it.
"""

import errno
import hashlib
import json
import os
import shutil
import signal
import stat
import subprocess
import sys
from contextlib import contextmanager, suppress
from pathlib import Path

import h5py
import numpy as np
from filelock import FileLock, Timeout

from ..status import Status

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

# What reading a file that this program did not write, or somebody has changed, may raise.
READING_ERRORS = (
    KeyError, OSError, ValueError, TypeError, AttributeError, IndexError, RuntimeError, ArithmeticError, EOFError,
)  # fmt: skip
# A seal, what a run goes on from, and texts of a study beside the root attributes.
SEAL, STATE, TEXTS = "seal", "restart", ("json/answer", "json/panels")
# What a full or failing disk says.
FULL = frozenset(
    getattr(errno, name) for name in ("ENOSPC", "EDQUOT", "EFBIG", "EIO", "ENXIO", "ESTALE") if hasattr(errno, name)
)
# File systems that cannot give room beforehand.
UNABLE = (errno.EINVAL, errno.EOPNOTSUPP, errno.ENOSYS)
# HDF5's own switch for its locks, which is ours, too; what HDF5 says where it gets none, and of one that another holds.
LOCKING, NO_LOCK = "HDF5_USE_FILE_LOCKING", "unable to lock file"
HELD = tuple(f"errno = {number}," for number in (errno.EAGAIN, errno.EACCES))
# File systems that have none.
LOCKLESS = (errno.ENOSYS, errno.ENOLCK, errno.EOPNOTSUPP, errno.EINVAL)
# Bytes of bookkeeping: of a file, and of each dataset.
FILE, DATASET = 1 << 18, 1 << 13


class ArchiveError(Exception):
    """A file that cannot be read as an archive, or cannot be continued; one line, and the `status` of a run of it.

    >>> try:
    ...     sealdyn.open_archive("nothing.h5")
    ... except sealdyn.ArchiveError as error:
    ...     print(error)
    nothing.h5: no such file
    """

    status = Status.INVALID


def link_target(path: str | os.PathLike) -> Path:
    """Where an archive really is: of a symlink its target."""
    path = Path(path)
    return Path(os.path.realpath(path)) if path.is_symlink() else path


def file_stem(name: str) -> str:
    """The name of a scenario, which may be a stranger's word, as that of a file in a folder: letters, digits and marks,
    nothing that leads elsewhere."""
    # Bytes of a name that is no text here are kept.
    own = (mark.isprintable() or "\udc80" <= mark <= "\udcff" for mark in name)
    kept = "".join(mark if fine and mark not in '/\\:*?"<>|' else "_" for mark, fine in zip(name, own, strict=True))
    return kept.strip(". ") or "scene"


def partial_path(path: str | os.PathLike) -> Path:
    """Where a run that is to become `path` lives until it is complete."""
    path = link_target(path)
    return path.with_name(path.stem + ".partial.h5")


# --- soundness -------------------------------------------------------------------------------------------


def mark_sound(path: str | os.PathLike) -> None:
    """Note that this process wrote the file, and wrote it well."""
    _sound.add(file_identity(path))


def begin_writing(file) -> None:
    """This process begins to write an open file, which is sound at any time, until `end_writing`."""
    _writing.add(file_identity(file.fileno())[:2])


def end_writing(file) -> None:
    """This process is about to close a file that it has written."""
    _writing.discard(file_identity(file.fileno())[:2])


def must_be_sound(path: str | os.PathLike) -> None:
    """Raises ArchiveError for a file that holds links to elsewhere, datasets in other files, types or sizes that no
    archive has, or that HDF5 cannot read; FileNotFoundError for one that is not there (any more)."""
    identity = file_identity(path)
    if identity in _sound or identity[:2] in _writing:
        return
    must_have_an_end(path)
    found = read_apart(__name__, os.path.abspath(path))
    if found is None:
        raise ArchiveError(f"{path}: damaged (HDF5 does not come to an end with it)")
    if found.returncode < 0:
        raise ArchiveError(f"{path}: damaged (HDF5 crashes on it)")
    if found.returncode and not os.path.exists(path):
        # A run has ended meanwhile, and its file has another name.
        raise FileNotFoundError(path)
    if found.returncode:
        lines = found.stdout.decode(errors="replace").splitlines() or ["HDF5 cannot read it"]
        if held := held_in_words(lines[-1]):
            raise ArchiveError(f"{path}: {held}")
        raise ArchiveError(f"{path}: damaged or not an archive ({lines[-1][:200]})")
    _sound.add(identity)


def read_apart(module: str, *words: str) -> subprocess.CompletedProcess | None:
    """What `python -m module words ...` has done, in a process of its own, on a file with which HDF5 may crash; None
    where it does not come to an end."""
    # Of the folder where the program is run nothing is loaded.
    call = [sys.executable, "-P", "-m", module, *words]
    among = {**os.environ, "PYTHONPATH": os.pathsep.join(filter(None, sys.path))}
    try:
        found = subprocess.run(call, capture_output=True, timeout=PATIENCE, env=among, stdin=subprocess.DEVNULL)
    except subprocess.TimeoutExpired:
        return None
    return None if found.returncode == ENDLESS else found


def bound_this_process() -> None:
    """Bound memory and work of the process in which `read_apart` reads, where the system can."""
    with suppress(ImportError):
        import resource

        for kind, bound in (
            (resource.RLIMIT_AS, (MEMORY, MEMORY)),
            (resource.RLIMIT_CORE, (0, 0)),
            (resource.RLIMIT_CPU, (WORK, WORK + 1)),
        ):
            with suppress(ValueError, OSError):
                resource.setrlimit(kind, bound)


def must_have_an_end(path: str | os.PathLike) -> None:
    """Raises ArchiveError for pipes and devices, and for what the system makes up as it is read: it has no size."""
    about = os.stat(path)
    if not stat.S_ISREG(about.st_mode) or not about.st_size:
        raise ArchiveError(f"{path}: {'an empty file' if stat.S_ISREG(about.st_mode) else 'not a file'}")


def held_in_words(error) -> str:
    """What it means that HDF5 could not lock a file; empty for another error of its."""
    words = str(error)
    if NO_LOCK not in words:
        return ""
    if any(number in words for number in HELD):
        return f"another program holds it open; expected that it closes the file, or {LOCKING}=FALSE"
    return f"where it is files cannot be locked; {LOCKING}=FALSE does without"


def file_identity(path):
    """What differs of a file that is another, or was written to: device, inode, size, time."""
    about = os.stat(path)
    return about.st_dev, about.st_ino, about.st_size, about.st_mtime_ns


class Unsound(Exception):
    """What is wrong, in words."""


def look_through(path: str | os.PathLike) -> None:
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
    bound_this_process()
    try:
        look_through(sys.argv[1])
        return 0
    except MemoryError:
        print("it asks for more memory than there is")
    except Exception as error:
        print(" ".join(str(error).split()) or type(error).__name__)
    return 1


# --- format and seal -------------------------------------------------------------------------------------


def must_be_readable(file, path, known: str, what: str) -> None:
    """Raises ArchiveError for an open file whose format is another than the `known` "NAME NUMBER"; `what` this program
    calls such a file."""
    written = str(file.attrs.get("format", ""))
    if written == known:
        return
    if not is_named(written, known):
        raise ArchiveError(f"{path}: an HDF5 file, but not {what}")
    by = " ".join(str(file.attrs.get("version", "")).split())[:40]
    of = f"of sealdyn {by}" if by else "of another sealdyn"
    raise ArchiveError(f'{path}: a "{written}" {of}; this program reads "{known}"')


# Root attributes that are words, and those that are tables or lists, kept as JSON.
WORDS = (
    "name", "question", "title", "created", "version", "solver", "solvers", "program", "study", "scenario", "status",
    "message",
)  # fmt: skip
TABLES = {"summary": dict, "resolved": dict, "libraries": dict, "units": dict, "along": dict, "overrides": list}


def root_attributes(file) -> dict:
    """The root attributes of an open archive, as they were written: words, numbers, tables.  Raises TypeError for a
    word or a table that is something else, ValueError for what is no JSON."""
    found = {}
    for name, value in file.attrs.items():
        value = value.tolist() if hasattr(value, "tolist") else value
        if isinstance(value, str) and name not in WORDS and value[:1] in ("{", "["):
            # Numbers only: what a run goes on from has its arrays elsewhere.
            value = json.loads(value)
        if not isinstance(value, str if name in WORDS else TABLES.get(name, object)):
            raise TypeError(f"its {name} is no {'text' if name in WORDS else 'table'}")
        found[name] = value
    if not all(isinstance(override, str) for override in found.get("overrides", [])):
        raise TypeError("its overrides are no text")
    return found


def is_named(written: str, known: str) -> bool:
    """Whether a format is that of `known`, whatever its number."""
    name, _, number = written.rpartition(" ")
    return number.isdecimal() and name == known.rpartition(" ")[0]


def seal(file) -> None:
    """Seal an archive: its root attributes as they are, and its texts."""
    names = sorted(set(file.attrs) - {SEAL})
    file.attrs[SEAL] = f"{_digest(file, names)} {' '.join(names)}"


def must_be_whole(file, path) -> None:
    """Raises ArchiveError for an archive that says another thing than when it was sealed, whatever has been added; not
    for one without a seal."""
    digest, *names = str(file.attrs.get(SEAL, "")).split(" ")
    if digest and not (set(names) <= set(file.attrs) and digest == _digest(file, names)):
        raise ArchiveError(f"{path}: what it says was altered since it was written")


def _digest(file, names) -> str:
    said = {name: _plain(file.attrs[name]) for name in names}
    if STATE in file and "state" in file[STATE].attrs:
        said["/state"] = _plain(file[STATE].attrs["state"])
    for name in TEXTS:
        if isinstance(file.get(name), h5py.Dataset):
            said[f"/{name}"] = _plain(file[name][()])
    return hashlib.sha256(json.dumps(said, sort_keys=True).encode()).hexdigest()[:16]


def _plain(value):
    if isinstance(value, bytes):
        return value.decode(errors="replace")
    return value.item() if hasattr(value, "item") else str(value)


# --- one writer at a time --------------------------------------------------------------------------------


@contextmanager
def only_writer(path: str | os.PathLike):
    """While the block lasts nobody else writes the archive `path`, its partial file or its journal, in this process or
    another one of this machine; gives where it really is.  Raises ArchiveError where somebody does, and where no file
    can be."""
    place = link_target(path)
    if place.is_symlink() or (place.exists() and not place.is_file()):
        raise ArchiveError(f"{path}: found what is no file (a folder, a pipe, a device, a link to itself)")
    path = Path(os.path.realpath(place))
    made = [folder for folder in path.parents if not folder.exists()]
    path.parent.mkdir(parents=True, exist_ok=True)
    beside = path.with_name(f".{path.stem}.lock")
    lock = FileLock(beside, timeout=0, fallback_to_soft=False)
    try:
        _acquire(lock, path)
        for begun in (path, partial_path(path)):
            # Half a file of a writer that was killed.
            with suppress(OSError):
                begun.with_name(begun.name + ".new").unlink()
        yield place
    finally:
        # Before it is free: whoever waits for it sees that it is gone, and makes a new one.
        with suppress(OSError):
            if lock.is_locked:
                beside.unlink()
        lock.release()
        # Folders in which nothing came to stand.
        with suppress(OSError):
            for folder in made:
                folder.rmdir()


def _acquire(lock, path) -> None:
    """Take the lock of an archive; where none can be had that is an error, unless locks are switched off."""
    wanted = os.environ.get(LOCKING, "").upper()
    if wanted in ("FALSE", "0"):
        return
    try:
        lock.acquire()
    except Timeout:
        raise ArchiveError(
            f"{path}: another run or study is writing it; let it end, or choose another file (--out)"
        ) from None
    except (OSError, NotImplementedError) as error:
        if getattr(error, "errno", None) not in (None, *LOCKLESS):
            raise
        with suppress(OSError):
            os.unlink(lock.lock_file)
        if wanted != "BEST_EFFORT":
            raise ArchiveError(
                f"{path}: files cannot be locked there; {LOCKING}=FALSE does without, if nobody else writes it"
            ) from None


# --- room on the disk ------------------------------------------------------------------------------------


def is_full(error: OSError) -> bool:
    """Whether an error is that of a disk that is full, has no quota left or fails."""
    return error.errno in FULL or (error.errno is None and "unable to" in str(error).lower())


@contextmanager
def hdf5_in_place_of(target: Path, size: int, source: Path | None = None, before=lambda: None):
    """An open HDF5 file, new or a copy of `source`, that may grow to `size` bytes whatever others write meanwhile; when
    the block ends without an error, and `before()` is called, it takes the place of `target` at once.  Raises OSError
    where the disk has no such room."""
    fresh = target.with_name(target.name + ".new")
    try:
        if source is not None:
            shutil.copyfile(source, fresh)
        _assure(fresh, size)
        with h5py.File(fresh, "w" if source is None else "r+") as file:
            # Writing it anew has given back what it had.
            _assure(fresh, size)
            yield file
            file.flush()
            end = file.id.get_filesize()
        if fresh.stat().st_size > end:
            os.truncate(fresh, end)
        before()
        os.replace(fresh, target)
    except BaseException:
        fresh.unlink(missing_ok=True)
        raise


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


if __name__ == "__main__":
    # HDF5's own way to end may crash, too.
    code = main()
    sys.stdout.flush()
    os._exit(code)
