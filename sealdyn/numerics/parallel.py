"""Many points on all cores, each remembered as soon as it is done.

Finished points go to a checkpoint file, one JSON line each, flushed at once, or to a folder of results (results.py): a
study killed half-way and started again repeats nothing.  A point that fails is a row with its reason.
"""

import hashlib
import json
import os
from concurrent.futures import ProcessPoolExecutor, as_completed
from contextlib import closing
from functools import partial
from multiprocessing import get_all_start_methods, get_context
from pathlib import Path

from .results import content_keys
from .threads import one_thread


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
            self.path.write_text(json.dumps({"identity": self.identity}) + "\n")
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
    Raises TypeError for what cannot be told by its content (results.content_keys).
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
    if count == 1 or len(todo) < 2:
        for key, point in todo.items():
            yield key, *row_of(function, point)
        return
    # Forked workers inherit the compiled kernels; where there is no fork they load them.  One point at a time.
    way = get_context("fork" if "fork" in get_all_start_methods() else "spawn")
    with ProcessPoolExecutor(min(count, len(todo)), mp_context=way, initializer=one_thread) as pool:
        waiting = {pool.submit(row_of, function, point): key for key, point in todo.items()}
        try:
            for future in as_completed(waiting):
                yield waiting[future], *future.result()
        finally:
            pool.shutdown(wait=False, cancel_futures=True)


def row_of(function, point: dict) -> tuple[dict, bool]:
    """The row of one point, {"failed": reason} where the function raises, and whether it lasts: a full disk, too little
    memory or a library that is not there say nothing about the point."""
    try:
        return function(point), True
    except Exception as error:
        lasting = not isinstance(error, OSError | MemoryError | ImportError)
        return {"failed": f"{type(error).__name__}: {error}"}, lasting
