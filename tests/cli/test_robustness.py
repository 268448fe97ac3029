"""A sample of the attack that `python tests/benchmark/robustness.py` makes: nothing comes through."""

import pytest
from benchmark.attack.archives import archives
from benchmark.attack.disks import disks
from benchmark.attack.outcome import Ledger
from benchmark.attack.scenarios import scenarios
from benchmark.attack.worlds import WORLDS, world


@pytest.mark.core
def test_scenarios():
    ledger = Ledger()
    scenarios(ledger, 7, range(1000))
    assert ledger.ways == {}
    assert ledger.counts["scenario read: done"] > 50 and ledger.counts["scenario read: refused"] > 500


@pytest.mark.slow
def test_archives(tmp_path):
    ledger = Ledger()
    archives(ledger, 7, range(10), tmp_path)
    assert ledger.ways == {}
    assert ledger.counts["archive crafted: refused"] > 5 and ledger.counts["archive corrupted: refused"] > 5


@pytest.mark.slow
def test_full_disks(tmp_path):
    """The first by the limit of a file's size, the other on a disk of that size where one may be made."""
    ledger = Ledger()
    disks(ledger, 7, range(2), tmp_path)
    assert ledger.ways == {}


OFTEN = (
    "figures for a screen that is none", "output closed", "output full", "output read by nobody", "a symlink",
    "a FIFO as output", "names without UTF-8", "unicode names, C locale", "endless scenario", "16 open files",
    "nothing can be written", "files of the names of modules", "a folder of other letters",
)  # fmt: skip


@pytest.mark.parametrize("name", OFTEN)
def test_worlds(name, tmp_path):
    outcome, how, error = world(WORLDS[name], tmp_path)
    assert how == "" and outcome in ("done", "refused"), error
