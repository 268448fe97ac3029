"""The command line as the tests use it: called in this process (fast) or started as a process of its own."""

import contextlib
import io
import json
import re
import signal
import subprocess
import sys
import time
from pathlib import Path
from typing import NamedTuple

import pytest

from sealdyn import cli, read_scenario

SCENARIOS = Path(__file__).parents[1] / "scenarios"
REFERENCE = SCENARIOS / "fmr_reference.toml"


class Answer(NamedTuple):
    """What a command left: exit code, standard output, standard error."""

    code: int
    out: str
    err: str

    @property
    def found(self) -> dict:
        """Standard output as one strict JSON object: NaN and Infinity are no JSON."""
        answer = json.loads(self.out, parse_constant=lambda word: pytest.fail(f"{word} is no JSON"))
        assert isinstance(answer, dict)
        return answer


def read(name: str, *overrides: str):
    """A shipped scenario with these values set."""
    return read_scenario(SCENARIOS / f"{name}.toml", list(overrides))


def settings(changes: dict) -> list[str]:
    """`--set` arguments of dotted keys and TOML values."""
    return [word for key, value in changes.items() for word in ("--set", f"{key}={value}")]


def sealdyn(*arguments, cwd) -> Answer:
    """One command in this process, in folder `cwd`; what it does to signals is undone."""
    out, err, before = io.StringIO(), io.StringIO(), sys.argv
    handlers = {number: signal.getsignal(number) for number in (signal.SIGINT, signal.SIGTERM)}
    sys.argv = ["sealdyn", *map(str, arguments)]
    code = 0
    try:
        with contextlib.chdir(cwd), contextlib.redirect_stdout(out), contextlib.redirect_stderr(err):
            cli.main()
    except SystemExit as end:
        code = end.code or 0
    finally:
        sys.argv = before
        for number, handler in handlers.items():
            signal.signal(number, handler)
    return Answer(code, out.getvalue(), err.getvalue())


def started(*arguments, cwd) -> subprocess.Popen:
    """One command as a process of its own."""
    line = [sys.executable, "-m", "sealdyn.cli", *map(str, arguments)]
    return subprocess.Popen(line, cwd=cwd, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)


def finished(process, timeout=120) -> Answer:
    """What a started command left."""
    out, err = process.communicate(timeout=timeout)
    return Answer(process.returncode, out, err)


def said(err: str) -> list[str]:
    """Lines of standard error, but for what a slow machine is told besides."""
    return [line for line in err.strip().splitlines() if not line.startswith(("compiling kernels", "making ready"))]


def until(happened, process, timeout=60):
    """Wait until `happened()`; the process must not end before."""
    limit = time.monotonic() + timeout
    while not happened():
        if process.poll() is not None:
            pytest.fail(f"ended too early ({process.returncode}): {process.communicate()}")
        assert time.monotonic() < limit, "nothing happened"
        time.sleep(0.01)


def short(scenario: Path, turns=6) -> list[str]:
    """Settings that shorten a scenario of more turns; one given as a duration has its story in it."""
    found = re.search(r"^turns\s*=\s*([\d.]+)", scenario.read_text(), re.M)
    return settings({"run.turns": turns}) if found and float(found[1]) > turns else []
