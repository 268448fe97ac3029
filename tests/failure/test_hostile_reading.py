"""What a reader meets in the world, drawn with a seed: an answer or one line, and numbers that are those of the file.

A sample of `python tests/benchmark/robustness.py --only scenarios` and `--only motions`.
"""

import pytest
from benchmark.attack.motions import motions
from benchmark.attack.outcome import Ledger
from benchmark.attack.scenarios import EVERY, scenarios


@pytest.mark.core
def test_scenarios_of_any_kind_are_read_or_refused():
    """None of these is checked whole, which would compile films."""
    ledger = Ledger()
    scenarios(ledger, 11, [number for number in range(450) if number % EVERY])
    assert ledger.ways == {}
    assert ledger.counts["scenario read: done"] > 15 and ledger.counts["scenario read: refused"] > 150
    assert ledger.counts["scenario sized: done"] > 15


@pytest.mark.parametrize(("kind", "first", "count"), [("CSV", 0, 300), ("HDF5", 1, 12)])
def test_files_of_samples_hold_what_an_independent_reader_finds(tmp_path, kind, first, count):
    ledger = Ledger()
    motions(ledger, 11, range(first, first + 2 * count, 2), tmp_path)
    assert ledger.ways == {}
    assert (
        ledger.counts[f"motion {kind}: done"] > count // 20 and ledger.counts[f"motion {kind}: refused"] > count // 20
    )
