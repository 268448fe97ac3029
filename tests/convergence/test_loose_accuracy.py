"""A loose accuracy costs no more than a sharp one: steps that fail again and again are no saving."""

import pytest
from command import SCENARIOS

from sealdyn import read_scenario
from sealdyn.simulation.selection import prepare_run
from sealdyn.solvers.contract import Recorder
from sealdyn.solvers.integrate import solve


@pytest.mark.core
def test_steps_do_not_fail_for_ever_at_order_one():
    """A ring of little mass on a film of many unknowns, which hide the errors of its rates."""

    def counts(accuracy):
        values = [f"run.accuracy={accuracy}", "run.turns=3", "film.gas_reynolds.columns=6"]
        run, plan = prepare_run(read_scenario(SCENARIOS / "dry_gas_seal.toml", values))
        assert plan.method == "ida"
        return solve(run, "ida", accuracy, Recorder(run.duration)).counts

    loose, sharp = counts(5e-2), counts(1e-2)
    assert loose.rejected < 0.1 * loose.steps
    assert loose.rhs < 1.3 * sharp.rhs
