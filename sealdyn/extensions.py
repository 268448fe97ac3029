"""Films, loads and studies from outside this package: which there are, where their source stands, what it is called.

SEALDYN_PATH names folders, of which each may hold `films/NAME.py`, `loads/NAME.py` and `studies/NAME.py`; an installed
package names modules by the entry points `sealdyn.films` and their like.  A file of a folder is a module of this
package, `sealdyn.films.NAME`, and imports as its neighbours do; a name of the package's own, or of an earlier folder,
is taken already.  Archives keep a digest of the source, never what would be executed.
"""

import hashlib
import importlib
import os
import sys
from functools import cache
from importlib.metadata import entry_points
from importlib.util import find_spec
from pathlib import Path
from types import ModuleType

# And the package of each.
ROOMS = {"films": "films", "loads": "scenario.loads", "studies": "studies"}
# Tables of a scenario whose `model` may be one, and its room.
OUTSIDE = {"film": "films", "stator.load": "loads", "rotor.load": "loads"}
VARIABLE = "SEALDYN_PATH"


class OutsideError(ImportError):
    """What comes from outside and cannot be used: what was found, and what is expected."""

    def __init__(self, found: str, expected: str):
        super().__init__(found, expected)
        self.found, self.expected = found, expected

    def __str__(self):
        return f"found {self.found}; expected {self.expected}"


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


def outside_names(room: str) -> set[str]:
    """Names of all that comes from outside into a room."""
    return {*in_folders(room), *installed(room)}


def source_of(room: str, name: str) -> Path | None:
    """The file of what comes from outside by this name; None of what does not."""
    if not name.isidentifier() or name.startswith("_"):
        return None
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


# Modules by import path and source.
_loaded: dict[tuple[str, str], ModuleType] = {}


def outside_module(room: str, name: str, *has: str) -> ModuleType:
    """The module that comes from outside by this name, of today's source.  Raises
    OutsideError where there is none, where it cannot be loaded, and where it has nothing by one of the names `has`."""
    source = source_of(room, name)
    if source is None:
        raise OutsideError(f'"{name}", which is neither installed nor on {VARIABLE}', f"{room}/{name}.py there")
    path = f"{__package__}.{ROOMS[room]}.{name}" if name in in_folders(room) else installed(room)[name]
    made = path, digest_of(source)
    try:
        if made not in _loaded:
            if any(other == path for other, _ in _loaded):
                sys.modules.pop(path, None)
            if name in in_folders(room):
                place = importlib.import_module(f"{__package__}.{ROOMS[room]}")
                place.__path__[:] = [str(Path(place.__file__ or "").parent), *folders(room)]
            importlib.invalidate_caches()
            _loaded[made] = importlib.import_module(path)
        # What is pickled by its name is found there.
        module = sys.modules[path] = _loaded[made]
    except Exception as error:
        raise OutsideError(
            f'"{name}", {source}: {type(error).__name__}: {error}', "a file that can be loaded"
        ) from None
    if not any(hasattr(module, one) for one in has):
        raise OutsideError(f'"{name}", {source}, without {has[0]}', f"a file that has {has[0]}")
    return module


def use(room: str, file: Path) -> str:
    """The name of a file `films/NAME.py`, or of another room, whose folder SEALDYN_PATH names from now on, in this
    process and in those that it starts.  Raises OutsideError."""
    file = file.absolute()
    if not file.is_file() or file.parent.name != room or file.suffix != ".py" or not file.stem.isidentifier():
        raise OutsideError(str(file), f"a file {room}/NAME.py")
    given = os.environ.get(VARIABLE, "")
    if str(file.parent) not in folders(room):
        os.environ[VARIABLE] = os.pathsep.join(filter(None, [given, str(file.parent.parent)]))
    if (first := source_of(room, file.stem)) is None or not first.samefile(file):
        os.environ[VARIABLE] = given
        raise OutsideError(f"{file}, beside {first} of the same name", "another name")
    return file.stem


def all_digests() -> dict[str, str]:
    """Digests of all that comes from outside, by "films/NAME" and its like."""
    every = ((room, name) for room in ROOMS for name in sorted(outside_names(room)))
    return {f"{room}/{name}": found for room, name in every if (found := digest(room, name))}


def is_outside(source: Path) -> bool:
    """Whether a file is the source of something from outside."""
    beside = any(str(source.parent) == folder for room in ROOMS for folder in folders(room))
    return beside or any(source == source_of(room, name) for room in ROOMS for name in installed(room))
