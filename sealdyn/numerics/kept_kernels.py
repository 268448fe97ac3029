"""Kept kernels are read with a checksum: one that was damaged is compiled anew, which is said once.

numba reads whatever stands there: of a file cut short it raises, and a changed byte of machine code it runs.
"""

import io
import warnings
import zlib
from contextlib import contextmanager
from pathlib import Path

from numba.core.caching import IndexDataCacheFile

# Behind what numba writes, and which it does not read: this and the sum.
MARK = b"\0sum "
_told = []


def check_kept_kernels() -> None:
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
        if not _told:
            warnings.warn(f"kept kernels were damaged and are compiled anew ({path.parent})", stacklevel=2)
        _told.append(path)
        return otherwise


def _is_whole(found: bytes) -> bool:
    content, mark, told = found[: -len(MARK) - 4], found[-len(MARK) - 4 : -4], found[-4:]
    return mark != MARK or told == _sum(content)


def _sum(content: bytes) -> bytes:
    return zlib.crc32(content).to_bytes(4, "big")
