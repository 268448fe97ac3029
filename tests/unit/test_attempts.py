"""What is tried after a try: a sharper one that gives up loses nothing of those before."""

import tempfile
from dataclasses import replace

import numpy as np
import pytest
from hard_families import one_of
from patterned_faces import scenario
from scenes import fms, started

from sealdyn.simulation.certificate import judgement, next_plan
from sealdyn.simulation.selection import Plan, Start
from sealdyn.simulation.simulate import simulate
from sealdyn.solvers.contract import Cause, Counts, SolverFailure, Status
from sealdyn.solvers.integrate import Advance, Outcome

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


def following(solver, one, error, tries, steps=10_000, evaluations=0, missing=0.0):
    """What follows `one`, which erred by `error`, or gave up where that is None, `missing` a share of its work."""
    counts = Counts()
    counts.steps, counts.rhs = steps, evaluations
    status, cause = (Status.OK, Cause.DONE) if error else (Status.FAILED, Cause.METHOD_GAVE_UP)
    outcome = Outcome(status, cause, "", counts, 1.0, 0, 0.01, np.zeros(1), one.tolerance or 1e-7)
    outcome = replace(outcome, energy_residual=missing)
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


def test_no_explicit_method_is_tried_where_decay_is_fast():
    """A stiff scene has had BDF and Radau: DOP853 would take a day, and the best of those before is in hand."""
    bdf = plan("bdf", None, "stiff")
    # One sharper run that errs as much does so by chance, two do not.
    tries = [(bdf, 1e-7, certificate(1.5e-4))]
    assert following("auto", plan("bdf", 1e-9, "sharper"), 1.4e-4, tries, steps=400).method == "bdf"
    tries.append((plan("bdf", 1e-9, "sharper"), 1e-9, certificate(1.4e-4)))
    radau = following("auto", plan("bdf", 1e-11, "sharper"), 1.3e-4, tries, steps=400)
    assert radau.method == "radau"
    tries = [(bdf, 1e-7, certificate(1.5e-5)), (plan("bdf", 1e-9, ""), 1e-9, certificate(1.4e-5))]
    assert following("auto", radau, 9e-5, tries, steps=400).last
    # Where nothing is stiff the same goes on.
    adams = [(plan("adams", None, ""), 1e-7, certificate(1.5e-5)), tries[1]]
    assert following("auto", radau, 9e-5, adams, steps=400).method == "dop853"


def test_a_retry_has_so_many_times_the_work_of_the_first_run():
    first = plan("bdf", None, "stiff")
    second = following("auto", first, 1.4e-4, [], evaluations=1000)
    assert first.work == np.inf and 3_000 < second.work < 30_000
    third = following("auto", second, 6e-5, [(first, 1e-7, certificate(1.4e-4))], evaluations=9000)
    assert third.work == second.work
    with pytest.raises(SolverFailure):
        Advance(1.0, 1.0, second.work).see(0.5, 10, 30_001)


def test_a_run_that_misses_energy_is_done_again_sharper():
    """However exact its places are; and no more than the tries that any run has."""
    first, error = plan("bdf", None, "stiff"), 0.3 * ASKED
    assert following("auto", first, error, [], missing=9 * ASKED) is None
    tries, one = [], first
    while (found := following("auto", one, error, tries, missing=20 * ASKED)) is not None:
        sharper = found.tolerance is not None and found.tolerance <= 0.2 * (one.tolerance or 1e-7)
        assert sharper or found.method != "bdf"
        tries.append((one, one.tolerance or 1e-7, certificate(error)))
        one = found
    assert 1 <= len(tries) < 4


@pytest.mark.parametrize(("before", "now", "status"), [
    (25.0, 1.2, Status.OK), (1.2, 25.0, Status.OK), (0.05, 0.04, Status.OK), (0.05, 0.01, Status.INACCURATE),
    (25.0, 0.01, Status.INACCURATE),
])  # fmt: skip
def test_errors_as_large_as_the_motion_are_alike(before, now, status):
    """Whether sharper tries help is not seen from their size: chaos has a horizon and is no failure."""
    tries = [(plan("adams", None, ""), 1e-7, certificate(before) | {"horizon": 0.01})]
    found = certificate(now) | {"horizon": 0.02, "said": "said"}
    outcome = Outcome(Status.OK, Cause.DONE, "", Counts(), 1.0, 0, 0.03, np.zeros(1), 1e-10)
    outcome = replace(outcome, energy_residual=0.0)
    judged, ended = judgement(found, outcome, tries)
    assert ended.status == status and ("horizon of predictability" in judged["said"]) == (status == Status.OK)
    if min(before, now) > 1.0:
        assert following("adams", plan("adams", 1e-13, ""), 11.7, tries, steps=10) is None


@pytest.mark.parametrize("seed,number", [(3001, 9), (4001, 68)])
def test_gentle_motion_of_a_stiff_film_is_audited_by_a_sharper_run(seed, number):
    """A tilt of a thousandth of what closes the film, as exact as asked, whose work is not: no false alarm."""
    drawn = one_of("runup", np.random.default_rng([seed, number]))
    run = dict(duration=drawn.duration, turns=None, accuracy=drawn.accuracy, start=drawn.start, solver="auto")
    with tempfile.TemporaryDirectory() as folder:
        found = simulate(scenario(drawn.scene, **run), f"{folder}/a.h5").summary
    assert found["certificate"]["met"] and found["energy_residual"] <= 10 * drawn.accuracy
    assert found["status"] == "ok" and any("again, sharper" in reason for reason in found["model"]["reasons"])
