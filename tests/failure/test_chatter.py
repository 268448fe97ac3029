"""Runs that switch or step without getting anywhere: what can be mended is, and the others end and say so."""

import numpy as np
import pytest
from command import SCENARIOS

from sealdyn.archive import read_info
from sealdyn.scenario.reader import read_scenario
from sealdyn.simulation.simulate import simulate
from sealdyn.solvers.contract import SolverFailure
from sealdyn.solvers.integrate import CHANGES, METHODS, STEPS, Advance

SQUEEZE = SCENARIOS / "squeeze.toml"


@pytest.mark.parametrize("friction", [0.1187, 15.0])
@pytest.mark.parametrize("accuracy", [2e-4, 1e-3])
def test_a_nearly_closed_film_that_damps_a_million_times_does_not_chatter(friction, accuracy, tmp_path):
    """What a film that thin makes of the error of a velocity is no load on the seal.  It was, and such a run changed
    between sticking and slipping a thousand times within a microsecond."""
    seal = f'rotor.secondary_seal={{radius = "35.7 mm", friction_force = "{friction} N"}}'
    short = ["run.duration='10 ms'", "run.samples=40", f"run.accuracy={accuracy}", "rotor.runout='38.5 urad'"]
    found = simulate(read_scenario(SQUEEZE, [seal, *short]), tmp_path / "x.h5").summary
    assert found["status"] == "ok"
    assert found["secondary_seal"]["sticks"] + found["secondary_seal"]["slips"] < 10


@pytest.mark.core
def test_steps_that_bring_nothing_end_a_run():
    watch = Advance(1.0, 1e-3)
    for k in range(STEPS):
        watch.see(1e-12 * k, k)
    with pytest.raises(SolverFailure, match=r"no advance: .* steps brought"):
        for k in range(STEPS, 2 * STEPS):
            watch.see(1e-12 * k, k)


def test_steps_of_a_billion_to_the_run_end_it():
    """A start in 0.5 s of 120 000 steps of 0.1 ns stood still for 2364 hours, and said nothing."""
    watch = Advance(0.7, 1 / 60)
    with pytest.raises(SolverFailure):
        for k in range(3 * STEPS):
            watch.see(1.17e-10 * k, k)


def test_changes_that_bring_nothing_end_a_run():
    watch = Advance(1.0, 1e-3)
    with pytest.raises(SolverFailure, match="changes between sticking and slipping"):
        for k in range(2 * CHANGES):
            watch.change(1e-12 * k)


def test_a_slow_but_steady_run_goes_on():
    """A hundred million steps: dear, and what was asked for."""
    watch = Advance(1.0, 1e-3)
    for k in range(0, 10**8, 10**4):
        watch.see(1e-8 * k, k)


def test_a_run_without_advance_is_a_result(monkeypatch, tmp_path):
    """Its archive says failed, up to when, why, and what helps."""

    def crawling(segment, tau, y, method, tolerance, counts):
        rest = np.zeros((64, segment.size))
        while True:
            yield tau + 1e-14 * np.arange(1, 65), np.tile(y, (64, 1)), rest
            tau += 64e-14

    monkeypatch.setitem(METHODS, "bdf", crawling)
    scenario = read_scenario(SQUEEZE, ["run.solver='bdf'"])
    found = simulate(scenario, tmp_path / "x.h5").summary
    assert found["status"] == "failed" and "no advance" in found["message"] and "run.solver" in found["message"]
    assert read_info(tmp_path / "x.h5")["status"] == "failed"


def test_a_trial_that_crawls_is_given_up(tmp_path):
    """Springs that pull by ten radians close the film within microseconds, which only the run itself sees; the trial of
    a tolerance went on behind it for minutes."""
    scenario = read_scenario(
        SQUEEZE.with_name("fms_reference.toml"), ["stator.misalignment='10 rad'", "run.turns=0.5", "run.start=rest"]
    )
    assert simulate(scenario, tmp_path / "x.h5").status == "collapsed"
