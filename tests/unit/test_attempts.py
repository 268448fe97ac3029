"""What is tried after a try: a sharper one that gives up loses nothing of those before."""

import numpy as np
import pytest
from scenes import fms, started

from sealdyn.simulation.certificate import next_plan
from sealdyn.simulation.selection import Plan, Start
from sealdyn.solvers.contract import Cause, Counts, Status
from sealdyn.solvers.integrate import Outcome

ASKED = 1e-5


def certificate(error):
    return {"solver": error, "asked": ASKED}


def plan(method, tolerance, why, last=False):
    return Plan("radial", method, tolerance, Start("rest"), why, last=last)


GAVE_UP = certificate(None)
TRIES = [
    (plan("adams", None, "chosen"), 1e-7, certificate(2e-4)),
    (plan("adams", 1e-9, "chosen; sharper"), 1e-9, certificate(4e-5)),
]


def following(solver, one, error, tries):
    """What follows `one`, which erred by `error`, or gave up where that is None."""
    counts = Counts()
    counts.steps = 10_000
    status, cause = (Status.OK, Cause.DONE) if error else (Status.FAILED, Cause.METHOD_GAVE_UP)
    outcome = Outcome(status, cause, "", counts, 1.0, 0, 0.01, np.zeros(1), one.tolerance or 1e-7)
    return next_plan(started(fms(), 0.01), solver, one, outcome, certificate(error), tries)


@pytest.mark.core
@pytest.mark.parametrize("solver", ["auto", "adams"])
def test_a_sharper_try_that_gives_up_loses_nothing(solver):
    one = plan("adams", 1e-11, "chosen; sharper; sharper")
    found = following(solver, one, None, TRIES)
    if solver == "auto":
        assert found.method == "bdf" and not found.last
        tries = [*TRIES, (one, 1e-11, GAVE_UP)]
        # The other method gives up as well, or is no better: back to the best of those that ended.
        also = following(solver, found, None, tries)
        found = following(solver, found, 9e-5, tries)
        assert (also.method, also.tolerance, also.last) == ("adams", 1e-9, True)
    assert (found.method, found.tolerance, found.last) == ("adams", 1e-9, True)


def test_a_first_try_that_gives_up_is_the_answer():
    assert following("auto", plan("adams", None, ""), None, []) is None
    assert following("auto", plan("adams", 1e-9, "", last=True), None, TRIES) is None
