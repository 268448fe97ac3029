"""SIGINT and SIGTERM end a process that hears them and one that does not, and no worker outlives its parent."""

import os
import signal
import subprocess
import sys
import time

import pytest

from sealdyn.numerics.interruption import CODE

# Measured: GRACE and some hundredths; a machine under load needs several times as long.
SOON = 10.0
DEAF = """
import hashlib, os, time
from sealdyn.numerics.interruption import Interruption

with Interruption() as interruption:
    interruption.last_words = lambda: os.write(1, b"kept")
    said = False
    while True:
        try:
            if not said:
                said = True
                print("ready", flush=True)
            {waits}
        except KeyboardInterrupt:
            pass
"""
WAITS = {"in compiled code": 'hashlib.pbkdf2_hmac("sha256", b"", b"", 10**9)', "swallowing": "time.sleep(0.01)"}
PARENT = """
import os, time
from sealdyn.numerics.parallel import processes

def sleep(point):
    time.sleep(600)
    return {}

answers = processes(2)(sleep, {k: {"k": k} for k in range(4)}, "naps")
print("ready", flush=True)
list(answers)
"""


def begun(code):
    """A process in a group of its own that has said that it is ready."""
    process = subprocess.Popen([sys.executable, "-c", code], stdout=subprocess.PIPE, start_new_session=True)
    assert process.stdout.readline() == b"ready\n"
    return process


def gone(group) -> bool:
    """Whether the group of processes is empty; zombies nobody has waited for count as gone."""
    found = subprocess.run(["ps", "-o", "stat=", "-g", str(group)], capture_output=True, text=True).stdout.split()
    return all(state.startswith("Z") for state in found)


def until_gone(group):
    limit = time.monotonic() + SOON
    while not gone(group) and time.monotonic() < limit:
        time.sleep(0.05)
    found = gone(group)
    if not found:
        os.killpg(group, signal.SIGKILL)
    return found


@pytest.mark.parametrize("number", [signal.SIGINT, signal.SIGTERM])
@pytest.mark.parametrize("waits", WAITS.values(), ids=WAITS)
def test_a_process_that_does_not_hear_is_ended_with_its_last_words(waits, number):
    process = begun(DEAF.format(waits=waits))
    before = time.monotonic()
    process.send_signal(number)
    try:
        out, _ = process.communicate(timeout=SOON)
    finally:
        process.kill()
    assert (process.returncode, out) == (CODE, b"kept") and time.monotonic() - before < SOON


@pytest.mark.parametrize("number", [signal.SIGKILL, signal.SIGTERM])
def test_workers_do_not_outlive_their_parent(number):
    process = begun(PARENT)
    time.sleep(1.0)
    assert not gone(process.pid)
    process.send_signal(number)
    process.wait()
    assert until_gone(process.pid)
