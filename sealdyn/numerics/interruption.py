"""SIGINT, SIGTERM, SIGHUP and SIGXCPU (`ulimit -t`): while the program is still being loaded one line and exit code
130; later they end a command within GRACE, in order where that can be, else at once.

The package imports this before all else, so nothing is imported here that takes time.
Python hears a signal only between two of its own instructions, and compiled code, compilers and libraries keep it
waiting; what they call back may even swallow the KeyboardInterrupt.  So a thread watches what the system's handler
writes as the signal comes, and ends the process when its time is up.  What is then on disk is what a killed process
leaves, and archives and journals are made for that.
"""

import os
import signal
import sys
from contextlib import contextmanager
from functools import cache
from threading import Thread, current_thread, main_thread

SIGNALS = (signal.SIGINT, signal.SIGTERM, *(getattr(signal, n) for n in ("SIGHUP", "SIGXCPU") if hasattr(signal, n)))
CODE = 130
_SAID = "interrupted: nothing is kept"


def is_the_program() -> bool:
    """Whether this process is the command, `sealdyn` or `python -m sealdyn.cli`, and not one that uses the package."""
    as_module = {"-m", "sealdyn.cli"} <= set(sys.orig_argv)
    return as_module or os.path.splitext(os.path.basename(sys.argv[0] if sys.argv else ""))[0] == "sealdyn"


def hear() -> None:
    """From now on each of the signals ends the process; SIGHUP not where it is ignored (nohup)."""
    for number in SIGNALS:
        if signal.getsignal(number) != signal.SIG_IGN or number in SIGNALS[:2]:
            signal.signal(number, end)


def end(number, frame) -> None:
    """End the process, and say so; past Python's own streams, and with nothing imported."""
    try:
        os.write(2, f"{_SAID}\n".encode())
        if "--json" in sys.argv:
            os.write(1, f'{{"status": "interrupted", "message": "{_SAID}"}}\n'.encode())
    finally:
        os._exit(CODE)


# Seconds from the signal to the end.
GRACE = 1.5


class Interruption:
    """A context that hears SIGINT, SIGTERM and SIGHUP: the first raises KeyboardInterrupt, unless somebody `looks` by
    himself; others change nothing.  `asked` lists the first one; `last_words()` is called if the process is ended at
    once.  **Valid** in the main thread; entered elsewhere it hears nothing."""

    def __init__(self):
        self.asked, self.last_words, self._looking = [], None, False
        self._wire = None

    def __enter__(self):
        self.asked, self.last_words, self._looking = [], None, False
        if current_thread() is main_thread():
            # Takes time to load, and the first moments of a process need none.
            import socket

            ours, theirs = self._wire = socket.socketpair()
            theirs.setblocking(False)
            self._wakeup = signal.set_wakeup_fd(theirs.fileno(), warn_on_full_buffer=False)
            # nohup: a closed terminal is to change nothing.
            heard = [n for n in SIGNALS if n in SIGNALS[:2] or signal.getsignal(n) != signal.SIG_IGN]
            self._handlers = {number: self._replaced(number) for number in heard}
            self._unraised, sys.unraisablehook = sys.unraisablehook, self._swallowed
            Thread(target=self._watch, args=(ours,), daemon=True).start()
        return self

    def __exit__(self, *error):
        if self.asked:
            # All is said; the watch goes on, for the interpreter may still wait for a thread.
            self.last_words = None
        elif self._wire:
            signal.set_wakeup_fd(self._wakeup)
            for number, handler in self._handlers.items():
                signal.signal(number, handler)
            sys.unraisablehook = self._unraised
            self._wire[1].close()
            self._wire = None

    @contextmanager
    def looks(self):
        """Somebody looks whether `asked` has anything: no KeyboardInterrupt."""
        self._looking = True
        try:
            yield
        finally:
            self._looking = False

    def _replaced(self, number):
        """The handler that is put back in the end; those of the first moments have had theirs."""
        before = signal.signal(number, self._hear)
        default = signal.default_int_handler if number == signal.SIGINT else signal.SIG_DFL
        return default if before is end else before

    def _hear(self, number, frame):
        if not self.asked:
            self.asked.append(number)
            if not self._looking:
                raise KeyboardInterrupt

    def _swallowed(self, what):
        """A KeyboardInterrupt raised where Python calls back without a caller: nothing to tell, the watch ends it."""
        if not issubclass(what.exc_type, KeyboardInterrupt):
            self._unraised(what)

    def _watch(self, wire):
        while (heard := wire.recv(1)) and heard[0] not in SIGNALS:
            pass
        wire.settimeout(GRACE)
        try:
            while heard:
                heard = wire.recv(1)
        except TimeoutError:
            self._break_off()
        wire.close()

    def _break_off(self):
        try:
            stop_children()
            if self.last_words:
                self.last_words()
        finally:
            os._exit(CODE)


def stop_children(spared=()):
    """End the processes that this one has started with multiprocessing, at once, except those `spared`."""
    if "multiprocessing" in sys.modules:
        from multiprocessing import active_children

        for child in active_children():
            if child not in spared:
                child.kill()


def serve():
    """Make this process one that others start and end: it hears no Ctrl-C and no closed terminal, which are its
    parent's, and does not outlive the parent."""
    from multiprocessing import parent_process

    signal.set_wakeup_fd(-1)
    for number in SIGNALS:
        signal.signal(number, signal.SIG_DFL if number == signal.SIGTERM else signal.SIG_IGN)
    Thread(target=_end_with, args=(parent_process(),), daemon=True).start()


def _end_with(parent):
    parent.join()
    os._exit(CODE)


def deafen() -> None:
    """From now on the signals change nothing: for the last moments of a process."""
    if current_thread() is main_thread():
        for number in SIGNALS:
            signal.signal(number, signal.SIG_IGN)


# One thread for linear algebra: matrices here have a dozen rows, and threads of every worker's BLAS only get in each
# other's way.
VARIABLES = ("OPENBLAS_NUM_THREADS", "MKL_NUM_THREADS", "OMP_NUM_THREADS")


@cache
def one_thread():
    """Keep this process to one thread of BLAS and OpenMP: libraries that are loaded, and those that are still to be."""
    from threadpoolctl import threadpool_limits

    for name in VARIABLES:
        os.environ.setdefault(name, "1")
    threadpool_limits(1)
