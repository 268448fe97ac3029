"""Files that HDF5 does not come to an end with: their looking through ends, and leaves no process behind."""

import os
import signal
import subprocess
import sys
import time

import h5py
import pytest

from sealdyn.archive import ArchiveError
from sealdyn.archive.files import must_be_sound


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
