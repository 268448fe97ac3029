"""What a reader meets in the world, drawn with a seed: an answer or one line, and numbers that are those of the file.

A sample of `python tests/benchmark/robustness.py --only motions`; of scenarios: tests/cli/test_robustness.py.
"""

import pytest
from benchmark.attack.motions import motions
from benchmark.attack.outcome import Ledger


@pytest.mark.core
@pytest.mark.parametrize(("kind", "first", "count"), [("CSV", 0, 300), ("HDF5", 1, 12)])
def test_files_of_samples_hold_what_an_independent_reader_finds(tmp_path, kind, first, count):
    ledger = Ledger()
    motions(ledger, 11, range(first, first + 2 * count, 2), tmp_path)
    assert ledger.ways == {}
    assert (
        ledger.counts[f"motion {kind}: done"] > count // 20 and ledger.counts[f"motion {kind}: refused"] > count // 20
    )
