"""Many points on the workers of a Dask scheduler, on as many machines as it has, or of any executor.

Workers may join, leave and die: what a worker had not handed in is evaluated by another.
"""

import asyncio
import logging
import platform
from concurrent.futures import BrokenExecutor, Executor, ThreadPoolExecutor, as_completed
from contextlib import contextmanager
from functools import partial
from threading import Lock

from .. import __version__
from .interruption import one_thread
from .parallel import row_of

PATIENCE = 10.0
"""Time (s) within which a scheduler has to be reached, and to answer."""
# Another day it may have been the machine: it does not last.
DEADLY = {"failed": "KilledWorker: all workers that tried this point died"}, False
# Nobody has made solvers and kernels for several threads of one process.
TURN = Lock()


class ClusterError(Exception):
    """A scheduler or workers that cannot be used; one line."""


@contextmanager
def workers_of(scheduler):
    """The crew (parallel.evaluate) of a scheduler: its address "tcp://host:port", or a `dask.distributed.Client`, or
    any `concurrent.futures.Executor` (of mpi4py, of a batch system), which stay open.  Raises ClusterError."""
    if isinstance(scheduler, Executor):
        yield partial(_on_executor, scheduler)
        return
    try:
        from distributed import Client
    except ImportError:
        raise ClusterError('a scheduler needs Dask: pip install "sealdyn[dask]"') from None
    if isinstance(scheduler, Client):
        _check_workers(scheduler)
        yield partial(_on_workers, scheduler)
        return
    try:
        # A client that fails to connect has more to say when it is deleted; a question has not.  It is asked in a
        # thread, for a notebook has a loop of its own.
        with ThreadPoolExecutor(1) as aside:
            aside.submit(asyncio.run, _identity(scheduler)).result()
        # What becomes of the scheduler is told by ClusterError, in a line.
        logging.getLogger("distributed.client").setLevel(logging.CRITICAL)
        client = Client(scheduler, timeout=PATIENCE, set_as_default=False)
    except (OSError, ValueError) as error:
        found = f'no Dask scheduler at "{scheduler}" ({str(error) or "no answer"})'
        raise ClusterError(f"scheduler: found {found}; expected tcp://host:port of one") from None
    with client:
        _check_workers(client)
        yield partial(_on_workers, client)


async def _identity(address: str):
    from distributed.core import rpc

    async with rpc(address, timeout=PATIENCE) as scheduler:
        # To connect, and to be answered.
        await asyncio.wait_for(scheduler.identity(), 2 * PATIENCE)


def _check_workers(client):
    """Refuse workers of another version; those that join later are asked by each point."""
    # Words, for a worker without this package could not read a function of it.
    found = client.run(eval, "__import__('sealdyn').__version__", on_error="return")
    for worker, version in found.items():
        if version != __version__:
            version = repr(version) if isinstance(version, Exception) else f"sealdyn {version}"
            raise ClusterError(f"worker {worker}: found {version}; expected sealdyn {__version__}")


def _on_executor(executor: Executor, function, todo: dict, what: str):
    """(key, row, lasting) of the points {key: point} as they come; what waits is not begun once the reader has left.
    Raises ClusterError."""
    waiting = {executor.submit(_answer, __version__, function, point): key for key, point in todo.items()}
    try:
        for future in as_completed(waiting):
            yield waiting[future], *future.result()
    except BrokenExecutor as error:
        raise ClusterError(f"executor: {error}") from None
    finally:
        for future in waiting:
            future.cancel()


def _on_workers(client, function, todo: dict, what: str):
    """(key, row, lasting) of the points {key: point} as they come; DEADLY of one that kills its workers.
    Raises ClusterError."""
    from distributed import KilledWorker

    deadly = []
    for key, found in _handed_in(client, function, todo, what):
        if isinstance(found, KilledWorker):
            deadly.append(key)
        else:
            yield key, *found
    # Dask blames all points that a dead worker had before it: alone, each shows what it does.
    for key in deadly:
        for _, found in _handed_in(client, function, {key: todo[key]}, f"{what} alone"):
            yield key, *(DEADLY if isinstance(found, KilledWorker) else found)


def _handed_in(client, function, todo: dict, what: str):
    """(key, answer or KilledWorker) of the points as they come.  What waits is cancelled when the reader leaves."""
    from distributed import KilledWorker
    from distributed import as_completed as completed_on

    # Named by content, so that a point which two studies ask for at the same time is evaluated once.
    waiting = {
        client.submit(partial(_answer, __version__, function, point), key=f"{what}-{key}"): key
        for key, point in todo.items()
    }
    try:
        # Answers are fetched beside those that are read here, not one round trip after the other.
        for future, found in completed_on(list(waiting), client.loop, with_results=True, raise_errors=False):
            if future.status == "error":
                _, found, _ = found
            elif future.status != "finished":
                found = ClusterError(f"scheduler: lost with {len(waiting)} points to do; the others are kept")
            if isinstance(found, BaseException) and not isinstance(found, KilledWorker):
                raise found if isinstance(found, ClusterError) else ClusterError(f"a worker's {found!r}")
            yield waiting.pop(future), found
    finally:
        client.cancel(list(waiting))


def _answer(version: str, function, point: dict) -> tuple[dict, bool]:
    """What a worker does for one point: `row_of`."""
    if version != __version__:
        raise ClusterError(f"worker {platform.node()}: found sealdyn {__version__}; expected sealdyn {version}")
    with TURN:
        one_thread()
        return row_of(function, point)
