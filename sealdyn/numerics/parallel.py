"""Many points on all cores, each remembered as soon as it is done.

Finished points go to a checkpoint file, one JSON line each, flushed at once: a study killed half-way and started again
repeats nothing.  A point that fails is a row with its reason.
"""

import hashlib
import json
import os
from concurrent.futures import ProcessPoolExecutor, as_completed
from multiprocessing import get_all_start_methods, get_context
from pathlib import Path


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


def evaluate(function, points: list, journal: Checkpoint, workers: int | None, say, what: str) -> list[dict]:
    """Rows (dicts) of `function(point)` for all points, in their order; one that raises is {"failed": reason}.

    `points` dicts that JSON takes; `journal` the Checkpoint, which spares the points it has; `workers` processes (None:
    all cores); `say(done, all)` is called after each; `what` sets these points apart from others of the study.
    **Valid** more than one worker: `function` and its answers can be pickled.
    """
    keys = [f"{what}:{json.dumps(point, sort_keys=True)}" for point in points]
    todo = [i for i, key in enumerate(keys) if key not in journal.rows]
    say(len(points) - len(todo), len(points))
    workers = workers or os.cpu_count() or 1
    if workers == 1 or len(todo) < 2:
        for i in todo:
            journal.add(keys[i], _safe(function, points[i]))
            say(len(points) - len(todo) + todo.index(i) + 1, len(points))
    else:
        # Forked workers inherit the compiled kernels; where there is no fork they load them.  One point at a time.
        way = "fork" if "fork" in get_all_start_methods() else "spawn"
        with ProcessPoolExecutor(min(workers, len(todo)), mp_context=get_context(way)) as pool:
            waiting = {pool.submit(_safe, function, points[i]): i for i in todo}
            try:
                for count, future in enumerate(as_completed(waiting), 1):
                    journal.add(keys[waiting[future]], future.result())
                    say(len(points) - len(todo) + count, len(points))
            except BaseException:
                pool.shutdown(wait=False, cancel_futures=True)
                raise
    return [journal.rows[key] for key in keys]


def _safe(function, point) -> dict:
    try:
        return function(point)
    except KeyboardInterrupt:
        raise
    except Exception as error:
        return {"failed": f"{type(error).__name__}: {error}"}
