"""A sample of the attack that `python tests/benchmark/robustness.py` makes: nothing comes through."""

from benchmark.attack.archives import archives
from benchmark.attack.outcome import Ledger
from benchmark.attack.scenarios import scenarios


def test_scenarios():
    ledger = Ledger()
    scenarios(ledger, 7, range(1000))
    assert ledger.ways == {}
    assert ledger.counts["scenario read: done"] > 50 and ledger.counts["scenario read: refused"] > 500


def test_archives(tmp_path):
    ledger = Ledger()
    archives(ledger, 7, range(10), tmp_path)
    assert ledger.ways == {}
    assert ledger.counts["archive crafted: refused"] > 5 and ledger.counts["archive corrupted: refused"] > 5
