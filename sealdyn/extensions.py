"""Films and studies from outside this package: which there are, where their source stands, and what it is called.

SEALDYN_PATH names folders, of which each may hold `films/NAME.py` and `studies/NAME.py`; an installed package names
modules by the entry points `sealdyn.films` and `sealdyn.studies`.  A file of a folder is a module of this package's
room, `sealdyn.films.NAME`, and imports as its neighbours do; a name of the package's own, or of an earlier folder, is
taken already.  Archives keep a digest of the source, never what would be executed.
"""

import hashlib
import os
from collections.abc import Iterator
from functools import cache
from importlib.metadata import entry_points
from importlib.util import find_spec
from pathlib import Path

ROOMS = ("films", "studies")
VARIABLE = "SEALDYN_PATH"


def folders(room: str) -> list[str]:
    """Folders of SEALDYN_PATH that hold a room ("films", "studies"), in their order."""
    given = [Path(part).absolute() / room for part in os.environ.get(VARIABLE, "").split(os.pathsep) if part]
    return [str(folder) for folder in given if folder.is_dir()]


@cache
def installed(room: str) -> dict[str, str]:
    """Modules of installed packages by the names that they give them in a room."""
    return {entry.name: entry.value for entry in entry_points(group=f"sealdyn.{room}")}


def in_folders(room: str) -> list[str]:
    """Names of the files that SEALDYN_PATH has of a room, sorted."""
    found = (Path(folder).glob("*.py") for folder in folders(room))
    return sorted({file.stem for files in found for file in files if not file.stem.startswith("_")})


def source_of(room: str, name: str) -> Path | None:
    """The file of what comes from outside by this name; None of what does not."""
    for folder in folders(room):
        if (file := Path(folder) / f"{name}.py").is_file():
            return file
    module = installed(room).get(name)
    spec = find_spec(module) if module else None
    return Path(spec.origin) if spec and spec.origin else None


def digest(room: str, name: str) -> str | None:
    """Sixteen hexadecimal digits of the source of what comes from outside by this name; None of what does not."""
    source = source_of(room, name)
    return None if source is None else digest_of(source)


def digest_of(source: Path) -> str:
    """Sixteen hexadecimal digits of a file."""
    return hashlib.sha256(source.read_bytes()).hexdigest()[:16]


def all_digests() -> dict[str, str]:
    """Digests of all that comes from outside, by "films/NAME" or "studies/NAME"."""
    return {f"{room}/{name}": found for room, name in _all() if (found := digest(room, name))}


def is_outside(source: Path) -> bool:
    """Whether a file is the source of something from outside."""
    beside = any(str(source.parent) == folder for room in ROOMS for folder in folders(room))
    return beside or any(source == source_of(room, name) for room in ROOMS for name in installed(room))


def _all() -> Iterator[tuple[str, str]]:
    for room in ROOMS:
        yield from ((room, name) for name in sorted({*in_folders(room), *installed(room)}))
