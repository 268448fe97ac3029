"""The decorators of compiled kernels.

All are kept on disk and divide as IEEE 754 says, not by Python's rules: an exception cannot pass through C, and a
kernel that left this open would take the rule of whoever calls it first.  None leaves its rounding to the compiler:
no fast-math, no threads.  Kernels on disk carry a checksum: one that was damaged is compiled anew, which is said once.
"""

import io
import warnings
import zlib
from contextlib import contextmanager
from dataclasses import dataclass
from functools import cached_property, partial
from pathlib import Path

from numba import cfunc, njit
from numba.core.caching import IndexDataCacheFile
from numba.extending import register_jitable

# --- checksums ----------------------------------------------------------------------------------------

# numba reads whatever stands there: of a file cut short it raises, and a changed byte of machine code it runs.

# Behind what numba writes, and which it does not read: this and the sum.
MARK = b"\0sum "
_warned = []


def check_kernel_sums() -> None:
    """From now on this process writes and reads kept kernels with their sums; those without are read as numba does."""
    names = "_open_for_write", "_load_index", "_load_data"
    opened, index, data = (getattr(IndexDataCacheFile, name) for name in names)

    @contextmanager
    def open_for_write(self, path):
        with opened(self, path) as file:
            yield (whole := io.BytesIO())
            file.write(whole.getvalue() + MARK + _sum(whole.getvalue()))

    def load_index(self):
        return _read(Path(self._index_path), lambda: index(self), {})

    def load_data(self, name):
        # None: not there.
        return _read(Path(self._data_path(name)), lambda: data(self, name), None)

    IndexDataCacheFile._open_for_write = open_for_write
    IndexDataCacheFile._load_index, IndexDataCacheFile._load_data = load_index, load_data


def _read(path: Path, load, otherwise):
    """What `load` reads of a kept file; `otherwise` of one that is damaged."""
    try:
        if not _is_whole(path.read_bytes()):
            raise ValueError("another sum")
        return load()
    except FileNotFoundError:
        return otherwise
    except PermissionError:
        raise
    except Exception:
        if not _warned:
            warnings.warn(f"kept kernels were damaged and are compiled anew ({path.parent})", stacklevel=2)
        _warned.append(path)
        return otherwise


def _is_whole(found: bytes) -> bool:
    content, mark, kept = found[: -len(MARK) - 4], found[-len(MARK) - 4 : -4], found[-4:]
    return mark != MARK or kept == _sum(content)


def _sum(content: bytes) -> bytes:
    return zlib.crc32(content).to_bytes(4, "big")


check_kernel_sums()
OPTIONS = {"cache": True, "error_model": "numpy"}

# Each is compiled with no more ways in than it needs: those from Python and from C take a quarter of a kernel's time.
# Called from Python and by kernels.
outer_kernel = partial(njit, **OPTIONS, no_cfunc_wrapper=True)
# Called from Python and by kernels, and handed to kernels as a function value.
value_kernel = partial(njit, **OPTIONS)
# Called by kernels only; called from Python it runs as Python.
inner_kernel = partial(register_jitable, **OPTIONS, no_cfunc_wrapper=True)


@dataclass(frozen=True)
class AtFirstUse:
    """A function of fixed signature, which a decorator would compile as its file is imported: here when its `address`
    is asked for (`c_function`), or when it is first called (`lazy_kernel`)."""

    decorator: object
    function: object

    @cached_property
    def compiled(self):
        """What numba makes of it."""
        return self.decorator(self.function)

    @property
    def address(self) -> int:
        """Where C finds it."""
        return self.compiled.address

    def __call__(self, *arguments):
        return self.compiled(*arguments)


def c_function(signature):
    """Decorator of what is called by C only."""
    return partial(AtFirstUse, cfunc(signature, **OPTIONS))


def lazy_kernel(signature, **options):
    """Decorator of a kernel of fixed signature that is called from Python only."""
    return partial(AtFirstUse, outer_kernel(signature, **options))
