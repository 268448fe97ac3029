"""SIGINT, SIGTERM, SIGHUP and SIGXCPU (`ulimit -t`) while the program is still being loaded: one line, exit code 130.

It imports nothing that takes time; `interruption` (numerics/interruption.py) hears the signals from when the command
line is carried out.
"""

import os
import signal
import sys

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
