"""Many points on all cores, each remembered as soon as it is done.

Finished points go to a checkpoint file, one JSON line each, flushed at once, or to a folder of results, where
a row stands under the SHA-256 of what was evaluated, written aside and renamed: no reader sees half of it, and several
machines may write into one folder without locks.  A study killed half-way and started again repeats nothing; a point
finished by anyone who shares a folder is finished for all.  A point that fails is a row with its reason.
"""

import contextlib
import hashlib
import json
import os
import time
from collections import Counter
from collections.abc import Callable
from concurrent.futures import FIRST_COMPLETED, ProcessPoolExecutor, wait
from concurrent.futures.process import BrokenProcessPool
from contextlib import closing
from dataclasses import dataclass, fields, is_dataclass
from functools import partial
from itertools import islice
from multiprocessing import active_children, get_all_start_methods, get_context
from pathlib import Path
from types import FunctionType
from typing import Any
from uuid import uuid4

import numpy as np

from .. import __version__
from ..extensions import all_digests
from .interruption import one_thread, serve, stop_children


def content_keys(function, points: list) -> list[str]:
    """SHA-256 (hexadecimal) of what decides the row of `function(point)`, for each of the points: the version of this
    package, what comes from outside it, the function and all it is bound to, the point.

    `function` stands in a module, or is a `partial` of one that does; dataclasses bound to it count by the fields that
    compare.  The name of an archive stands for its content.  Raises TypeError for what is neither data nor a
    function.
    """
    evaluated, outside = _plain(function), all_digests()
    made_by = [__version__, outside] if outside else [__version__]
    texts = (json.dumps([*made_by, evaluated, _plain(point)], sort_keys=True) for point in points)
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


# Points that a process gets at once where that pays: so many at most, and for so long (s).
AT_ONCE, PIECE = 64, 0.5
# How often a point may be among those whose processes are killed before it is given one of its own.
ENDED = 2


@dataclass(frozen=True)
class Together:
    """A function of many points whose rows cost less together than one by one: `function(points)` returns for each its
    row, or the exception why there is none."""

    function: Callable

    def __call__(self, point: dict) -> dict:
        """The row of one point."""
        (row,) = self.function([point])
        if isinstance(row, Exception):
            raise row
        return row


class Checkpoint:
    """Finished points of one study on disk: `rows` {key: row}.  `identity` is everything that decides the answers
    (scenario, settings, version): a file of another identity is not used."""

    def __init__(self, path: Path, identity: str):
        self.path, self.rows = Path(path), {}
        self.identity = hashlib.sha256(identity.encode()).hexdigest()
        if self.path.exists():
            self._read()

    def _read(self):
        lines = self.path.read_text().splitlines()
        try:
            if json.loads(lines[0])["identity"] != self.identity:
                return
        except (IndexError, KeyError, ValueError):
            return
        whole = []
        for line in lines[1:]:
            try:
                entry = json.loads(line)
            except ValueError:
                # The line being written when the study was killed.
                continue
            whole.append(line)
            self.rows[entry["key"]] = entry["row"]
        self.path.write_text("\n".join([lines[0], *whole]) + "\n")

    def get(self, key: str) -> dict | None:
        """The row of a point, None if it is not done."""
        return self.rows.get(key)

    def add(self, key: str, row: dict):
        """Keep the row of a point (a dict that JSON takes) under its key, on disk at once."""
        # No file before the first point: a refused study leaves nothing behind.
        if not self.rows:
            self.path.parent.mkdir(parents=True, exist_ok=True)
            try:
                self.path.write_text(json.dumps({"identity": self.identity}) + "\n")
            except OSError:
                self.path.unlink(missing_ok=True)
                raise
        self.rows[key] = row
        with self.path.open("a") as file:
            file.write(json.dumps({"key": key, "row": row}) + "\n")

    def done(self):
        """Delete the file: the study is complete, its archive holds everything."""
        self.path.unlink(missing_ok=True)


def evaluate(function, points: list, store, crew, say, what: str) -> list[dict]:
    """Rows (dicts) of `function(point)` for all points, in their order; one that raises is {"failed": reason}.

    `points` dicts that JSON takes; `store` the Checkpoint or Results that spares the points it has, and keeps the
    others as they come; `crew` who evaluates: `processes(count)`, or a scheduler's workers (cluster.py); `say(done,
    all)` is called after each; `what` is what the points are called where the crew is watched.
    Raises TypeError for what cannot be told by its content (content_keys).
    """
    keys = content_keys(function, points)
    rows = {key: row for key in dict.fromkeys(keys) if (row := store.get(key)) is not None}
    todo = {key: point for key, point in zip(keys, points, strict=True) if key not in rows}
    everything = len(rows) + len(todo)
    say(len(rows), everything)
    with closing(crew(function, todo, what)) as answers:
        for key, row, lasting in answers:
            # As it will be read again.
            rows[key] = json.loads(json.dumps(row))
            if lasting:
                store.add(key, rows[key])
            say(len(rows), everything)
    return [rows[key] for key in keys]


def processes(count: int | None = None):
    """The crew of `count` processes of this machine (None: all cores).
    **Valid** more than one: functions and their rows can be pickled."""
    return partial(_on_processes, count or os.cpu_count() or 1)


def _on_processes(count: int, function, todo: dict, what: str):
    """(key, row, lasting) of the points {key: point} as they come; what waits is not begun once the reader has left."""
    pieces = _Pieces(function, todo, count)
    if count == 1 or len(todo) < 2:
        while some := pieces.next():
            yield from _with_keys(some, pieces.took(some, _timed(function, [todo[key] for key in some])))
        return
    # Forked workers inherit the compiled kernels; where there is no fork they load them.
    way = get_context("fork" if "fork" in get_all_start_methods() else "spawn")
    broke = Counter()
    while True:
        waiting = {}
        try:
            yield from _with_pool(way, min(count, len(todo)), function, todo, pieces, waiting)
            return
        except BrokenProcessPool:
            # A process was killed, and the others with it: what they had is begun again, each point by itself.
            lost = [key for some in waiting.values() for key in some]
            broke.update(lost)
            pieces.again += [[key] for key in lost if broke[key] <= ENDED]
            for key in lost:
                if broke[key] > ENDED:
                    yield key, *_by_itself(way, function, todo[key])


def _with_pool(way, count: int, function, todo: dict, pieces, waiting: dict):
    """The same, while no process is killed; `waiting` {future: keys} is what has been handed out."""
    others = active_children()
    with ProcessPoolExecutor(count, mp_context=way, initializer=_begin) as pool:
        try:
            while True:
                # No process waits for its next piece.
                while len(waiting) < 2 * count and (some := pieces.next()):
                    waiting[pool.submit(_timed, function, [todo[key] for key in some])] = some
                if not waiting:
                    return
                for future in wait(waiting, return_when=FIRST_COMPLETED).done:
                    timed = future.result()
                    some = waiting.pop(future)
                    yield from _with_keys(some, pieces.took(some, timed))
        finally:
            if waiting:
                # The reader has left, or was interrupted: nobody waits for what is being done.
                stop_children(spared=others)


def _by_itself(way, function, point: dict) -> tuple[dict, bool]:
    """`row_of` a point that may kill whoever works on it, in a process of its own."""
    with ProcessPoolExecutor(1, mp_context=way, initializer=_begin) as pool:
        try:
            return pool.submit(row_of, function, point).result()
        except BrokenProcessPool:
            return {"failed": "its process was ended from outside, or crashed: too little memory?"}, False


def _begin():
    """What a process does first."""
    serve()
    one_thread()


class _Pieces:
    """Points that one process gets at once: a single one, or as many as it does in PIECE seconds if the function takes
    them Together.  What is killed loses no more."""

    def __init__(self, function, todo: dict, count: int):
        self.keys, self.left, self.count, self.again = iter(todo), len(todo), count, []
        self.together, self.size = isinstance(function, Together), 1

    def next(self) -> list:
        """Keys of the next piece; none at the end.  The last ones are small, so that all processes end together."""
        if self.again:
            return self.again.pop()
        some = list(islice(self.keys, min(self.size, max(self.left // (2 * self.count), 1))))
        self.left -= len(some)
        return some

    def took(self, some: list, timed: tuple):
        """What `_timed` answers to a piece, less the time."""
        answers, seconds = timed
        if self.together:
            self.size = max(1, min(AT_ONCE, int(len(some) * PIECE / max(seconds, 1e-9))))
        return answers


def _timed(function, points: list[dict]):
    """Rows of the points, and how long (s) they took."""
    begun = time.perf_counter()
    return rows_of(function, points), time.perf_counter() - begun


def _with_keys(keys, answers):
    for key, answer in zip(keys, answers, strict=True):
        yield key, *answer


def rows_of(function, points: list[dict]) -> list[tuple[dict, bool]]:
    """`row_of` for each of the points, Together if that is how the function takes them."""
    if isinstance(function, Together):
        with contextlib.suppress(Exception):
            return [_failed(row) if isinstance(row, Exception) else (row, True) for row in function.function(points)]
        # One of them may have spoilt it for all.
    return [row_of(function, point) for point in points]


def row_of(function, point: dict) -> tuple[dict, bool]:
    """The row of one point, {"failed": reason} where the function raises, and whether it lasts: a full disk, too little
    memory or a library that is not there say nothing about the point."""
    try:
        return function(point), True
    except Exception as error:
        return _failed(error)


def _failed(error: Exception) -> tuple[dict, bool]:
    lasting = not isinstance(error, OSError | MemoryError | ImportError)
    # The package's own errors and a ValueError are sentences about the point; of anything else its kind tells more.
    own = type(error).__module__.startswith(f"{__package__.partition('.')[0]}.")
    said = str(error) if str(error) and (own or isinstance(error, ValueError)) else f"{type(error).__name__}: {error}"
    return {"failed": said}, lasting
