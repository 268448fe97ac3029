"""How an attack went: counted, and each way through told once."""

import collections
import contextlib
import math
import os
import signal
import subprocess
import sys
import tempfile
import time
import traceback
import warnings
from pathlib import Path

from sealdyn.archive import ArchiveError, columns, files
from sealdyn.scenario.errors import ScenarioError
from sealdyn.scene.scene import SceneError

# Longest time that anything may take without a word (s), longest line of an error.
PATIENCE, LONGEST = 10, 500
# How a process that was ended for its slowness counts.
SLOW = -99


class Ledger:
    """`counts` of what happened, by its name; `ways` of what came through, each with an example."""

    def __init__(self):
        self.counts, self.ways = collections.Counter(), {}

    def add(self, counts: dict, ways: dict) -> None:
        """What another counted."""
        for name, count in counts.items():
            # Of times the longest.
            self.counts[name] = max(self.counts[name], count) if name.endswith("(ms)") else self.counts[name] + count
        for how, example in ways.items():
            self.ways.setdefault(how, example)

    def slowest(self, what: str, seconds: float, example="") -> None:
        """Keep the longest processor time (s) of one, as a count of milliseconds."""
        name, took = f"{what}: slowest (ms)", round(1e3 * seconds)
        if took > self.counts[name]:
            self.counts[name] = took

    def note(self, what: str, outcome: str, how: str = "", example="") -> None:
        """One attempt."""
        self.counts[f"{what}: {outcome}"] += 1
        if how:
            self.ways.setdefault(f"{what}: {how}", example)


class TooLong(BaseException):
    """Nothing was said for too long."""


def shared(seconds: float) -> int:
    """So many seconds of a machine that others use, too: longer by the processes that wait for each core."""
    return math.ceil(seconds * max(1.0, os.getloadavg()[0] / os.cpu_count()))


def _late(*_):
    raise TooLong


def tried(action, patience=PATIENCE):
    """What an action of this process gives; whether it is "done", "refused" or "escaped"; and how it escaped."""
    signal.signal(signal.SIGALRM, _late)
    signal.alarm(shared(patience))
    try:
        with warnings.catch_warnings():
            warnings.simplefilter("error")
            return action(), "done", ""
    except (ScenarioError, SceneError, ArchiveError) as refused:
        return None, "refused", one_line(refused)
    except (Exception, TooLong) as escaped:
        return None, "escaped", place(escaped)
    finally:
        signal.alarm(0)


def one_line(error) -> str:
    """What is wrong with the words of an error of the program's own; "" if nothing."""
    line = str(error)
    return f"{len(line)} characters: {line[:80]!r}" if "\n" in line or len(line) > LONGEST else ""


def place(error) -> str:
    """An error that came through, and where it rose."""
    frames = traceback.extract_tb(error.__traceback__)
    where = [frame for frame in frames if "sealdyn" in frame.filename] or frames
    place = f"{Path(where[-1].filename).name}:{where[-1].lineno}"
    return f"{type(error).__name__}: {str(error)[:90]} ({place})"


def command(*words, patience=PATIENCE) -> tuple[int, str, str]:
    """Exit code (negative: the signal that ended it), standard output and error of a verb, in a fork of this process
    without a terminal."""
    with tempfile.TemporaryFile() as out, tempfile.TemporaryFile() as error:
        child = os.fork()
        if child == 0:
            _be_the_command(words, out, error)
        code, end = None, time.monotonic() + shared(patience)
        while code is None:
            done, status = os.waitpid(child, os.WNOHANG)
            if done:
                code = os.waitstatus_to_exitcode(status)
            elif time.monotonic() > end:
                # With whatever it has begun.
                os.killpg(child, signal.SIGKILL)
                os.waitpid(child, 0)
                code = SLOW
            else:
                time.sleep(0.005)
        texts = []
        for stream in (out, error):
            stream.seek(0)
            texts.append(stream.read().decode(errors="replace"))
    return code, *texts


def _be_the_command(words, out, error):
    code = 70
    try:
        os.setsid()
        for number, stream in enumerate((os.open(os.devnull, os.O_RDONLY), out.fileno(), error.fileno())):
            os.dup2(stream, number)
        from sealdyn import cli

        sys.argv = ["sealdyn", *map(str, words)]
        try:
            cli.main()
            code = 0
        except SystemExit as end:
            code = end.code if isinstance(end.code, int) else 0 if end.code is None else 1
    except BaseException:
        traceback.print_exc()
    with contextlib.suppress(Exception):
        sys.stdout.flush()
        sys.stderr.flush()
    os._exit(code)


@contextlib.contextmanager
def read_in_forks(really=False):
    """What the program reads in a process of its own is read in a fork of this one, which need not be started: the same
    code and bounds, and a crash is its own; `really`: as the program does it."""
    before = files.read_apart
    files.read_apart = columns.read_apart = before if really else _read_in_fork
    try:
        yield
    finally:
        files.read_apart = columns.read_apart = before


def _read_in_fork(module, *words):
    with tempfile.TemporaryFile() as out:
        child = os.fork()
        if child == 0:
            code = 70
            try:
                for number in (signal.SIGALRM, signal.SIGXCPU, signal.SIGTERM):
                    signal.signal(number, signal.SIG_DFL)
                os.dup2(os.open(os.devnull, os.O_RDWR), 2)
                sys.argv, sys.stdout = [module, *words], open(out.fileno(), "w", closefd=False)  # noqa: SIM115
                code = (columns if module == columns.__name__ else files).main()
                sys.stdout.flush()
            finally:
                os._exit(code)
        try:
            end = time.monotonic() + files.PATIENCE
            while not (done := os.waitpid(child, os.WNOHANG))[0]:
                if time.monotonic() > end:
                    return None
                time.sleep(0.002)
            child = None
        finally:
            if child:
                os.kill(child, signal.SIGKILL)
                os.waitpid(child, 0)
        out.seek(0)
        code = os.waitstatus_to_exitcode(done[1])
        return None if code == files.ENDLESS else subprocess.CompletedProcess(words, code, out.read(), b"")


def judged(code: int, error: str, allowed=(0, 2, 3, 4, 5), most=2) -> tuple[str, str]:
    """Outcome and, of what came through, how, of a command that ended so, and may refuse in so many lines at `most`."""
    lines = error.strip().splitlines()
    if code == SLOW:
        return "escaped", "no end"
    if code < 0:
        return "escaped", f"signal {-code}"
    if "Traceback" in error or code not in allowed:
        return "escaped", f"exit {code}: {' '.join(lines[-1:])[:150]}"
    if any(len(line) > LONGEST for line in lines) or (code == 2 and len(lines) > most):
        return "a long line", f"{len(lines)} lines, {max(map(len, lines))} characters: {lines[0][:80]!r}"
    return ("refused" if code == 2 else "done"), ""
