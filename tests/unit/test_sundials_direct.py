"""The compiled loop over SUNDIALS against scikit-sundae and DOP853: same motion, honest counts, a way back."""

import os
import subprocess
import sys
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from scenes import SPEED, fmr, fms, fmsr, prepared, runup

from sealdyn.scenario.reader import Scenario, read_scenario
from sealdyn.scene.forces import Contact
from sealdyn.scene.rings import Stator
from sealdyn.simulation.simulate import simulate_in_memory
from sealdyn.solvers import methods, sundials_direct, sundials_libraries, sundials_python
from sealdyn.solvers.contract import Counts, SolverFailure
from sealdyn.solvers.methods import METHODS

ROOT = Path(__file__).parents[2]
TURN = 2 * np.pi / SPEED
MASSLESS = replace(fms(), stator=Stator(support=fms().stator.support, misalignment=25e-6))
SCENES = {
    "fmr": fmr(), "fms-linear": fms("linear"), "fmsr": fmsr(), "runup": runup(),
    "contact": replace(fms(runout=3e-4), contact=Contact(roughness=1e-7, compressive_strength=3e8)),
    "massless": MASSLESS,
}  # fmt: skip


def end(ready, steps, method, tolerance):
    """Unknowns over their scales at the end of three turns, and what it cost."""
    segment, counts = ready.segment(0), Counts()
    for _, ys, _ in steps(segment, 0.0, ready.y0.copy(), method, tolerance, counts):
        last = ys[-1]
    return last[: segment.n_mechanical] / segment.scales[: segment.n_mechanical], counts


@pytest.mark.parametrize("method", ["adams", "bdf", "ida"])
@pytest.mark.parametrize("name", SCENES)
def test_the_same_motion_as_through_scikit_sundae(name, method):
    """Both within some hundred tolerances of each other, at about the same cost; the sharper the nearer."""
    ready = prepared(SCENES[name], 3 * TURN, 1e-6)
    wheel = getattr(sundials_python, "ida" if method == "ida" else "cvode")
    if name == "massless" and method != "ida":
        pytest.skip("a massless ring has a residual only")
    for tolerance in (1e-6, 1e-9):
        (direct, counts), (other, others) = (end(ready, steps, method, tolerance) for steps in (METHODS[method], wheel))
        assert counts.back_end.startswith("SUNDIALS 7")
        assert np.max(np.abs(direct - other)) < 1000 * tolerance
        assert 0.5 < counts.rhs / others.rhs < 2.0


@pytest.mark.core
def test_every_step_has_an_order_and_jacobians_are_counted():
    ready = prepared(fmr(), 10 * TURN, 1e-6)
    for method, highest in (("adams", 12), ("bdf", 5)):
        counts, steps = Counts(), 0
        for ts, _, _ in METHODS[method](ready.segment(0), 0.0, ready.y0.copy(), method, 1e-8, counts):
            steps += len(ts)
        assert sum(counts.orders) == steps and not any(counts.orders[highest:])
        # Each Jacobian costs an evaluation per mechanical unknown.
        assert counts.jacobians > 0 and counts.rhs > counts.jacobians * ready.model.unknowns.n_mechanical + steps
        assert counts.rejected > 0


def test_blocks_go_on_without_a_new_start(monkeypatch):
    """Handed over in blocks of seven the steps are the same to the bit."""
    ready, found = prepared(fms(), 5 * TURN, 1e-6), []
    for rows in (7, 1024):
        monkeypatch.setattr(sundials_direct, "BLOCK", rows)
        blocks = list(METHODS["adams"](ready.segment(0), 0.0, ready.y0.copy(), "adams", 1e-7, Counts()))
        assert all(len(block[0]) <= rows for block in blocks)
        found.append([np.concatenate([block[i] for block in blocks]) for i in range(2)])
    assert np.array_equal(found[0][0], found[1][0]) and np.array_equal(found[0][1], found[1][1])


def test_what_sundials_says_when_it_gives_up():
    """A right-hand side that is no number from the start."""
    ready = prepared(fmr(), TURN, 1e-6)
    y0 = ready.y0.copy()
    y0[0] = np.nan
    with pytest.raises(SolverFailure, match=r"adams gave up 0 s into this segment: CV_\w+ "):
        list(METHODS["adams"](ready.segment(0), 0.0, y0, "adams", 1e-6, Counts()))


@pytest.mark.parametrize("solver", ["adams", "bdf", "ida"])
def test_steps_that_come_to_nothing_end_the_run(solver, capfd):
    """A spring beyond all measure: steps of no length, which SUNDIALS would go on with for ever."""
    scenario = read_scenario(ROOT / "scenarios" / "fms_reference.toml", ["run.turns=1", f"run.solver={solver}"])
    stator = scenario.scene.stator
    # No file may say so.
    stiff = replace(stator, support=replace(stator.support, axial_stiffness=1e300))
    with np.errstate(over="ignore"):
        summary = simulate_in_memory(Scenario(replace(scenario.scene, stator=stiff), scenario.run))
    assert summary["status"] == "failed" and f"{solver} gave up 0 s into this segment" in summary["message"]
    assert "WARNING" not in "".join(capfd.readouterr())


def test_a_step_that_is_left_gives_everything_back():
    """Ten thousand integrations begun and dropped: no memory stays."""
    resource = pytest.importorskip("resource")
    ready = prepared(fmr(), TURN, 1e-6)
    segment, sizes = ready.segment(0), []
    for _ in range(3):
        for _ in range(2000):
            next(METHODS["bdf"](segment, 0.0, ready.y0.copy(), "bdf", 1e-3, Counts()))
        sizes.append(resource.getrusage(resource.RUSAGE_SELF).ru_maxrss)
    # In KiB; one integrator holds some 20.
    assert sizes[2] - sizes[1] < 4000


@pytest.fixture
def looked_for_anew(monkeypatch):
    """Libraries are looked for again, with what a test changes, and after it."""
    sundials_libraries.libraries.cache_clear()
    yield monkeypatch
    sundials_libraries.libraries.cache_clear()


def test_another_version_is_refused_and_scikit_sundae_serves(looked_for_anew):
    looked_for_anew.setattr(sundials_libraries, "MAJOR", 6)
    assert "SUNDIALS 7" in methods.why_slow() and "where 6 is known" in methods.why_slow()
    ready, counts = prepared(fmr(), TURN, 1e-6), Counts()
    list(METHODS["adams"](ready.segment(0), 0.0, ready.y0.copy(), "adams", 1e-6, counts))
    assert counts.back_end == methods.SCIKIT_SUNDAE


def test_what_compiled_code_would_miss_is_found_first(looked_for_anew):
    """Linked to a function that is not there, it would end the process."""
    looked_for_anew.setattr(sundials_libraries, "COMPILED", ("CVode", "CVodeOfAnotherName"))
    assert methods.why_slow().endswith("SUNDIALS offers no CVodeOfAnotherName")


def test_a_setting_that_sundials_refuses_is_told():
    with pytest.raises(OSError, match=r"SUNDIALS refused CVodeSetMaxOrd \(-2\d\)"):
        list(METHODS["bdf"](prepared(fmr(), TURN, 1e-6).segment(0), 0.0, np.zeros(12), "bdf", 1e-6, Counts(),
                            max_order=-1))  # fmt: skip


RUN = """
import sys, sealdyn
from sealdyn.simulation.simulate import simulate_in_memory
summary = simulate_in_memory(sealdyn.read_scenario("scenarios/fms_reference.toml", ["run.turns=2"]))
print(summary["counts"]["back_end"], "|", "sksundae.cvode" in sys.modules, "|", summary["model"]["reasons"])
"""


@pytest.mark.parametrize("choice", ["", "python"])
def test_a_run_says_when_it_is_slow(choice):
    """By the environment; the compiled loop never imports scikit-sundae's Python."""
    done = subprocess.run([sys.executable, "-c", RUN], env=os.environ | {methods.CHOICE: choice}, cwd=ROOT,
                          capture_output=True, text=True)  # fmt: skip
    assert done.returncode == 0, done.stderr
    back_end, imported, reasons = done.stdout.split(" | ")
    assert back_end.startswith("scikit" if choice else "SUNDIALS") and imported == str(bool(choice))
    assert ("through scikit-sundae, several times slower" in reasons) == bool(choice)
