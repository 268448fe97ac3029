"""A sample of the attack of `python tests/benchmark/robustness.py`, which `.ci/run` makes with `--quick`, archives and
full disks too: nothing comes through."""

import pytest
from benchmark.attack.outcome import Ledger
from benchmark.attack.scenarios import scenarios
from benchmark.attack.worlds import WORLDS, world


@pytest.mark.core
def test_scenarios():
    ledger = Ledger()
    scenarios(ledger, 7, range(1000))
    assert ledger.ways == {}
    assert ledger.counts["scenario read: done"] > 50 and ledger.counts["scenario read: refused"] > 500
    assert ledger.counts["scenario sized: done"] > 50


OFTEN = (
    "output closed", "output full", "output read by nobody", "names without UTF-8", "unicode names, C locale",
    "16 open files", "nothing can be written", "files of the names of modules",
)  # fmt: skip


@pytest.mark.parametrize("name", OFTEN)
def test_worlds(name, tmp_path):
    outcome, how, error = world(WORLDS[name], tmp_path)
    assert how == "" and outcome in ("done", "refused"), error
