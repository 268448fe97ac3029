"""A command at its terminal: its progress bar, and how it ends: exit codes, refusals in one line, interruptions and
what they leave."""

import atexit
import contextlib
import errno
import gc
import json
import os
import sys
from datetime import timedelta
from math import inf
from pathlib import Path
from threading import Lock, Timer
from time import monotonic

from .numerics.interruption import CODE, Interruption, deafen, stop_children
from .quantities import in_words
from .status import Status
from .units import cut, printable

DONE, BAD_INPUT, COLLAPSED, FAILED, CHECK_FAILED, INTERRUPTED = 0, 2, 3, 4, 5, CODE
EXIT = {
    Status.OK: DONE,
    Status.INACCURATE: CHECK_FAILED,
    Status.INVALID: BAD_INPUT,
    Status.COLLAPSED: COLLAPSED,
    Status.FAILED: FAILED,
    Status.INTERRUPTED: INTERRUPTED,
}
# Time (s) after which a wait is worth a progress bar.
PATIENCE = 1.0
# Address space (bytes) that a run and its libraries ask for, as measured: of kernels that are kept, and compiled.
MEMORY, COMPILING = 700_000_000, 1_100_000_000
# Verbs that load kernels.
COMPUTING = ("run", "check", "study", "validate")
# Characters of an error.
LONGEST = 1000
# New objects after which Python looks for cyclic garbage: imports and compilation make many and leave little.
GARBAGE = 100_000


def say(*lines, cells: bool = False, error: bool = False):
    """Print lines, in which there may be words of a file, whatever they hold; `cells`: rows of CSV, of which quoted
    cells may go over several lines; `error`: on standard error."""
    for line in lines:
        words = printable(str(line), "\n\t" if cells else "")
        print(words, file=sys.stderr if error else sys.stdout, flush=error)


# SIGINT, SIGTERM and SIGHUP, and what they find: "words", a function that says what is kept, and whether the verb has
# already "answered".
interruption = Interruption()
left = {}


def leaves(words, answered=False):
    """What an interruption finds from now on."""
    left.update(words=words, answered=answered)


@contextlib.contextmanager
def libraries_on_stderr():
    """Keep standard output ours: SUNDIALS prints its warnings there, straight from C."""
    sys.stdout.flush()
    ours = os.dup(1)
    os.dup2(2, 1)
    try:
        yield
    finally:
        os.dup2(ours, 1)
        os.close(ours)


def kept_of_run(archive: Path, words: list[str]) -> str:
    """What an interrupted run has left, and the words of the command that goes on."""
    if not archive.exists():
        return "nothing is kept"
    return f"{archive} keeps the run so far; go on with: sealdyn run {' '.join(words)}"


def kept_of_study(journal: Path, results: Path | None) -> str:
    """What an interrupted study has left."""
    if results is not None:
        return f"finished points are kept in {results}; the same command goes on"
    count = len(journal.read_text().splitlines()) - 1 if journal.exists() else 0
    if count < 1:
        return "no point was finished, nothing is kept"
    return f"{count} finished point{'s' * (count > 1)} kept in {journal}; the same command goes on"


class Stop(Exception):
    """Ends a verb with a status and a sentence; of a scenario with every ScenarioError, the sentence's own first."""

    def __init__(self, status: str, message: str, errors=()):
        super().__init__(message)
        self.status, self.message, self.errors = status, message, errors


@contextlib.contextmanager
def reads(path):
    """What is read and drawn of an archive: errors that a file made or changed elsewhere leads to end here."""
    from numpy import errstate

    from .archive import READING_ERRORS, ArchiveError

    try:
        # Numbers of no world, times what makes them micrometres.
        with errstate(over="raise"):
            yield
    except ArchiveError as error:
        raise Stop(Status.INVALID, str(error)) from None
    except BrokenPipeError:
        raise
    except READING_ERRORS as error:
        what = " ".join(str(error).split())[:200]
        line = f"{path}: holds something that sealdyn did not write there ({type(error).__name__}: {what})"
        raise Stop(Status.INVALID, line) from None


def not_written(error: OSError, where, kept: str) -> Stop:
    """What ends a verb whose output cannot be written: its place was wrong from the start, or the disk is full."""
    from .archive import is_full

    line = f"{where}: cannot be written ({error.strerror or error})"
    return Stop(Status.FAILED, f"{line}; {kept}") if is_full(error) else Stop(Status.INVALID, line)


class Progress:
    """Progress bar on standard error: how far, what is being done, and the time, which moves in any case, and in a line
    that kernels are compiled, where they are.  What is done in a second needs none."""

    def __init__(self):
        self.bar = self.task = None
        # Kernels that are being compiled, one needing the other, and when the first was begun.
        self.compiling, self.compiled_from = 0, 0.0
        self.now = {"completed": 0.0, "total": 1.0, "words": "making ready"}
        # A run that is done once more, sharper or to measure its error, begins again.
        self.runs = 1
        # Clock (s) and motion (s): two seconds ago or one, and one second ago or less; and when it moved last.
        self.marks, self.moved = [], monotonic()
        self.lock, self.timer = Lock(), Timer(PATIENCE, self._show_if_it_can)
        self.timer.daemon = True

    def __enter__(self):
        from .kernel_cache import compiling

        compiling.append(self._compile)
        self.timer.start()
        return self

    def __exit__(self, *error):
        from .kernel_cache import compiling

        compiling.remove(self._compile)
        self.timer.cancel()
        with self.lock:
            if self.bar:
                self.bar.stop()

    def __call__(self, done: float, end: float, words: str | None = None):
        """`done` of `end`; without `words` both are times (s)."""
        again = done < self.now["completed"]
        if words is None:
            self.runs += again
            self.marks = [] if again else self.marks
            left = " s: summing up" if done >= end else f" of {end:.4g} s{self._pace(done)}"
            moved = f"t = {done:.4g}{left}"
            words = moved if self.runs == 1 else f"run {self.runs}: {moved}"
        self.moved = monotonic() if done != self.now["completed"] else self.moved
        self.now = {"completed": done, "total": end, "words": printable(words)}
        if self.bar:
            if again:
                self.task = self._line(self.bar)
            self.bar.update(self.task, **self.now)

    def _line(self, bar):
        """A line that has moved by nothing yet, in place of the one there was, its clock going on."""
        before = [task.start_time for task in bar.tasks]
        for task in bar.task_ids:
            bar.remove_task(task)
        line = bar.add_task("", visible=False, **self.now)
        if before:
            bar.tasks[0].start_time = before[0]
        bar.update(line, visible=True)
        return line

    def _pace(self, done: float) -> str:
        """How much motion a second of the clock brings: a run that crawls shows it."""
        now = monotonic()
        if not self.marks or now - self.marks[-1][0] > PATIENCE:
            self.marks = [*self.marks[-1:], (now, done)]
        since, was = self.marks[0]
        return f", {(done - was) / (now - since):.2g} s each second" if now > since and done > was else ""

    def remaining(self, task) -> str:
        """The time that is left, in words: none that has been promised before and is over."""
        left = task.time_remaining
        if left is None or monotonic() - self.moved > left + PATIENCE:
            return "remaining: not known" if not task.finished else ""
        return f"remaining: {timedelta(seconds=int(left))}"

    def _compile(self, more: int):
        """numba has begun (1) or ended (-1) to compile a kernel that is not kept on disk yet."""
        self.compiling += more
        self.compiled_from = self.compiled_from or monotonic()
        with self.lock:
            if self.compiled_from < inf and monotonic() - self.compiled_from > PATIENCE:
                self.compiled_from = inf
                line = "compiling kernels once on this machine (a minute or so) ..."
                self.bar.console.print(line) if self.bar else say(line, error=True)
            if self.bar:
                words = ": compiling kernels" if self.compiling else ""
                self.bar.update(self.task, words=self.now["words"] + words)

    def _show_if_it_can(self):
        # What has no descriptors left for it goes on without a bar.
        with contextlib.suppress(OSError, ImportError):
            self._show()

    def _show(self):
        from rich.console import Console
        from rich.progress import BarColumn, Progress, ProgressColumn, TextColumn, TimeElapsedColumn
        from rich.text import Text

        watch = self

        class Remaining(ProgressColumn):
            """The time that is left, as far as it is known."""

            max_refresh = 0.5

            def render(self, task):
                return Text(watch.remaining(task), style="progress.remaining")

        with self.lock:
            if self.timer.finished.is_set():
                return
            bar = Progress(
                TextColumn("{task.fields[words]}", markup=False),
                BarColumn(),
                TextColumn("{task.percentage:>3.0f}%"),
                TimeElapsedColumn(),
                Remaining(),
                console=Console(stderr=True),
                transient=False,
            )
            self.task = self._line(bar)
            bar.start()
            self.bar = bar


def drawn(chart: str, archive: Path) -> str | None:
    """The figure beside an archive that is complete; if it cannot be drawn that is said, and changes nothing."""
    import importlib

    figure = archive.with_suffix(".png")
    try:
        importlib.import_module(f"sealdyn.report.{chart}").draw(archive, figure)
    except Exception as error:
        what = " ".join(str(error).split())[:200]
        line = f"warning: {figure} was not drawn ({type(error).__name__}: {what}); the archive is whole"
        say(line, error=True)
        return None
    return str(figure)


def carried_out(verbs):
    """Carries out the command line by its `verbs` and ends the process: one line for every error, never a traceback."""
    _open_streams()
    as_json = "--json" in sys.argv
    gc.set_threshold(GARBAGE)
    # Python would look through all that was loaded once more as it ends.
    atexit.register(gc.freeze)
    # What is done by then is done, and the exit code says how.
    atexit.register(deafen)
    leaves(lambda: "nothing is kept")
    try:
        with interruption:
            # Standard output itself: while libraries print, it is not where it was.
            out = os.dup(1)
            interruption.last_words = lambda: _break_off(as_json, out)
            try:
                _run(verbs, as_json)
            finally:
                # Python would wait for workers that were begun and not used.
                stop_children()
                os.close(out)
    except KeyboardInterrupt:
        # It came before the first thing was done, or after the last.
        _end_interrupted(as_json)


def _refuse_little_memory():
    """Where they find no memory libraries and the compiler end the process in their own words, or in none: said before,
    and, of verbs that compute, instead."""
    allowed = -1
    with contextlib.suppress(ImportError, OSError, ValueError):
        import resource

        allowed = resource.getrlimit(resource.RLIMIT_AS)[0]
    if not 0 <= allowed < COMPILING:
        return
    from .kernel_cache import kept_kernels

    needed = MEMORY if kept_kernels() else COMPILING
    line = f"memory is limited to {in_words('B', allowed)} (ulimit -v): at least {in_words('B', needed)} are needed"
    if allowed < needed and sys.argv[1:2] and sys.argv[1] in COMPUTING:
        raise Stop(Status.FAILED, f"{line} to compute")
    if allowed < needed:
        say(f"{line} for what is computed", error=True)


def _open_streams():
    """Standard streams that were closed lead nowhere: else the first file opened would take their place."""
    for number in range(3):
        try:
            os.write(number, b"") if number else os.fstat(number)
        except OSError as error:
            # A full device is found out by what is written.
            if error.errno != errno.EBADF:
                continue
            os.dup2(nowhere := os.open(os.devnull, os.O_RDWR), number)
            if nowhere != number:
                os.close(nowhere)
    for name in ("stdin", "stdout", "stderr"):
        if getattr(sys, name) is None:
            setattr(sys, name, open(os.devnull, "r" if name == "stdin" else "w"))  # noqa: SIM115


def _run(verbs, as_json: bool):
    try:
        _refuse_little_memory()
        code = verbs(standalone_mode=False)
        sys.stdout.flush()
        if code == INTERRUPTED:
            # A KeyboardInterrupt comes out as this code, too.
            _end_interrupted(as_json)
        sys.exit(code if isinstance(code, int) else DONE)
    except Stop as stop:
        _refuse(stop.status, stop.message, as_json, stop.errors)
    except (BrokenPipeError, SystemExit) as end:
        # Whoever read us has seen enough, of which Typer makes a 1; keep the interpreter from complaining at exit.
        if isinstance(end, SystemExit) and end.code != 1:
            raise
        os.dup2(os.open(os.devnull, os.O_WRONLY), 1)
        sys.exit(DONE)
    except (MemoryError, ImportError) as error:
        # Libraries that find no memory cannot be loaded.
        _refuse(Status.FAILED, f"sealdyn: not enough memory, or a library that cannot be loaded ({error})", as_json)
    except OSError as error:
        if error.errno is None:
            _refuse(Status.FAILED, f"sealdyn: the system refuses something ({error})", as_json)
        # Everything else that is written has its own words.
        os.dup2(os.open(os.devnull, os.O_WRONLY), 1)
        line = f"standard output: cannot be written ({error.strerror or error})"
        print(line, file=sys.stderr)
        sys.exit(FAILED)
    except KeyboardInterrupt:
        _end_interrupted(as_json)
    except Exception as error:
        if interruption.asked:
            # A library that was being loaded has made another error of the KeyboardInterrupt, as pydantic does.
            _end_interrupted(as_json)
        # A misused command line: the parser's own errors can say what they mean in one line.
        if not hasattr(error, "format_message"):
            raise
        _refuse(Status.INVALID, f"sealdyn: {error.format_message()}  See sealdyn --help.", as_json)


def _end_interrupted(as_json: bool):
    """Ends with what is kept, in a line, and as JSON unless that has been printed.  Nothing is imported any more: an
    import that was broken off would begin anew, and some libraries say so."""
    # Python ends itself with the signal, not with our code, if a text was being executed; the next one undoes that.
    exec("")
    line = f"interrupted: {left['words']()}"
    say(line, error=True)
    if as_json and not left["answered"]:
        print(json.dumps({"status": Status.INTERRUPTED, "message": line}))
    sys.exit(INTERRUPTED)


def _break_off(as_json: bool, out: int):
    """Last words of a process that is ended at once, past Python's own streams."""
    line = f"interrupted: {left['words']()}"
    # A progress bar hides the cursor.
    os.write(2, f"{chr(27) + '[?25h' if os.isatty(2) else ''}{printable(line)}\n".encode())
    if as_json and not left["answered"]:
        os.write(out, f"{json.dumps({'status': Status.INTERRUPTED, 'message': line})}\n".encode())


def _refuse(status: str, message: str, as_json: bool, errors=()):
    """Says why a verb does not do what was asked, and ends."""
    lines = [cut(" ".join(str(said).split()), LONGEST) for said in errors or [message]]
    told = {"status": status, "message": lines[0]}
    if errors:
        told["errors"] = [
            {"message": line, "key": error.key, "found": error.found, "expected": error.expected}
            for line, error in zip(lines, errors, strict=True)
        ]
    if as_json:
        print(json.dumps(told))
    else:
        say(*lines, error=True)
    sys.exit(EXIT[status])
