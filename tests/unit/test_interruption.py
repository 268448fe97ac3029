"""Interruption: processes that hear a signal or do not, workers, and files that HDF5 does not come to an end with."""

import json
import os
import signal
import subprocess
import sys
import time

import h5py
import pytest
from command import SCENARIOS

from sealdyn.archive import ArchiveError
from sealdyn.archive.files import must_be_sound
from sealdyn.dynamics.model import Model
from sealdyn.dynamics.stick_slip import StickSlip
from sealdyn.numerics.interruption import CODE
from sealdyn.scenario.reader import read_scenario

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


RUB = SCENARIOS / "rub.toml"
SEAL = ["stator.secondary_seal.radius=45 mm", "stator.secondary_seal.line_friction=40 N/m"]


@pytest.mark.core
def test_a_ring_that_has_just_slipped_is_remembered_as_such():
    """It may be captured again only once it has been fast: the archive's state says so."""
    model = Model(read_scenario(RUB, SEAL).scene)
    before, after = StickSlip(model), StickSlip(model)
    before.leaving[0] = True
    after.restore(json.loads(json.dumps(before.state())))
    assert after.leaving == before.leaving and after.stuck == before.stuck


@pytest.fixture
def endless(tmp_path):
    """Words of two attributes stand in one heap; behind the first there is nothing, of no length."""
    path = tmp_path / "endless.h5"
    with h5py.File(path, "w") as file:
        file.attrs["one"], file.attrs["two"] = "a" * 64, "b" * 64
    data = bytearray(path.read_bytes())
    second = data.index(b"b" * 64) - 16
    end = data.index(b"GCOL") + int.from_bytes(data[data.index(b"GCOL") + 8 :][:8], "little")
    data[second:end] = bytes(end - second)
    path.write_bytes(data)
    return path


def test_a_file_in_circles_is_refused(endless):
    with pytest.raises(ArchiveError, match="does not come to an end"):
        must_be_sound(endless)


@pytest.mark.core
@pytest.mark.skipif(sys.platform != "linux", reason="looks for processes in /proc")
def test_whoever_asked_may_be_gone(endless):
    """It was left behind, and went on for ever."""
    asks = f"from sealdyn.archive.files import must_be_sound; must_be_sound({str(endless)!r})"
    process = subprocess.Popen([sys.executable, "-c", asks])
    until(lambda: lookers(endless))
    os.kill(process.pid, signal.SIGKILL)
    process.wait()
    until(lambda: not lookers(endless))


def lookers(path):
    """Processes whose words hold this path, but for the one that was asked."""
    found = []
    for number in filter(str.isdigit, os.listdir("/proc")):
        try:
            with open(f"/proc/{number}/cmdline", "rb") as file:
                words = file.read().split(b"\0")
        except OSError:
            continue
        found += [number] if os.fsencode(path) in words else []
    return found


def until(there):
    end = time.monotonic() + 60
    while not there():
        assert time.monotonic() < end
        time.sleep(0.05)
