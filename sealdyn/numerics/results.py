"""Content-addressed rows: a point finished by anyone who shares a folder is finished for all.

A row stands under the SHA-256 of what was evaluated.  It is written aside and renamed: no reader sees half of it, and
several machines may write into one folder without locks.
"""

import hashlib
import json
import os
from dataclasses import fields, is_dataclass
from functools import partial
from pathlib import Path
from types import FunctionType
from typing import Any
from uuid import uuid4

import numpy as np

from .. import __version__


def content_keys(function, points: list) -> list[str]:
    """SHA-256 (hexadecimal) of what decides the row of `function(point)`, for each of the points: the version of this
    package, the function and all it is bound to, the point.

    `function` stands in a module, or is a `partial` of one that does; dataclasses bound to it count by the fields that
    compare.  The name of an archive stands for its content.  Raises TypeError for what is neither data nor a
    function.
    """
    evaluated = _plain(function)
    texts = (json.dumps([__version__, evaluated, _plain(point)], sort_keys=True) for point in points)
    return [hashlib.sha256(text.encode()).hexdigest() for text in texts]


def _plain(value: Any) -> Any:
    """What JSON takes, equal for what is equal."""
    if isinstance(value, partial):
        return {"function": _plain(value.func), "bound": [_plain(value.args), _plain(value.keywords)]}
    if is_dataclass(value) and not isinstance(value, type):
        held = {f.name: _plain(getattr(value, f.name)) for f in fields(value) if f.compare}
        return {"kind": _name(type(value)), "fields": held}
    if isinstance(value, dict):
        return {str(key): _plain(held) for key, held in value.items()}
    if isinstance(value, list | tuple):
        return [_plain(entry) for entry in value]
    if isinstance(value, set | frozenset):
        return sorted(value)
    if isinstance(value, str) and value.endswith(".h5") and Path(value).is_file():
        return {"content": hashlib.sha256(Path(value).read_bytes()).hexdigest()}
    if value is None or isinstance(value, bool | int | float | str):
        return value
    if isinstance(value, np.ndarray | np.generic):
        return {"kind": str(value.dtype), "values": value.tolist()}
    if isinstance(value, FunctionType | type):
        return _name(value)
    raise TypeError(f"{value!r} cannot be told from others by its content")


def _name(thing) -> str:
    return f"{thing.__module__}.{thing.__qualname__}"


class Results:
    """Rows in a folder, one file each, by their content_keys; anything else in the folder is left alone."""

    def __init__(self, folder):
        self.folder = Path(folder)

    def get(self, key: str) -> dict | None:
        """The row of a point; None if it is not there, or not whole."""
        try:
            entry = json.loads(self._path(key).read_text())
        except (OSError, ValueError):
            return None
        whole = isinstance(entry, dict) and entry.get("key") == key and isinstance(entry.get("row"), dict)
        return entry["row"] if whole else None

    def add(self, key: str, row: dict):
        """Keep the row of a point (a dict that JSON takes) for everyone."""
        self.folder.mkdir(parents=True, exist_ok=True)
        aside = self._path(f"{key}-{uuid4().hex}").with_suffix(".new")
        try:
            aside.write_text(json.dumps({"key": key, "version": __version__, "row": row}))
            os.replace(aside, self._path(key))
        finally:
            aside.unlink(missing_ok=True)

    def _path(self, key: str) -> Path:
        return self.folder / f"{key}.json"
