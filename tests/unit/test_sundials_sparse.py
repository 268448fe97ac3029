"""Films with unknowns of their own (radial_cells.py) on the compiled loop, against scikit-sundae: same motion, same
counts, the film's own sentence where it fails, a way back."""

import math
from dataclasses import replace
from functools import partial

import numpy as np
import pytest
import radial_cells
from numba import cfunc, njit
from radial_cells import film_of
from scenes import CLEARANCE, MISALIGNMENT, R_I, SPEED, Sink, fmr, fms, fmsr, prepared, ring, runup

from sealdyn.dynamics import coupled_native
from sealdyn.dynamics.model import Model
from sealdyn.faces.geometry import ROTOR_ANGLE
from sealdyn.scene.forces import Contact
from sealdyn.scene.rings import Stator
from sealdyn.solvers import methods, sundials_direct, sundials_libraries, sundials_python
from sealdyn.solvers.contract import Cause, Counts, SolverFailure
from sealdyn.solvers.integrate import solve
from sealdyn.solvers.methods import METHODS

TURN = 2 * np.pi / SPEED
MASSLESS = fms(stator=Stator(**ring(mass=0.0, transverse_inertia=0.0, polar_inertia=0.0, misalignment=25e-6)))
BACK_ENDS = {"compiled loop": "", "scikit-sundae": "python"}
CASES = {
    "stator": (fms(), {}), "both rings": (fmsr(), {}), "massless stator": (MASSLESS, {}),
    "asperities": (replace(fms(runout=3e-4), contact=Contact(roughness=1e-7, compressive_strength=3e8)), {}),
    "storing": (fms(), {"compressibility": 1e-6}),
    "by differences": (fmsr(), {"compressibility": 1e-8, "own_derivatives": False}), "changing speed": (runup(), {}),
}  # fmt: skip


def on_film(scene, duration=2 * TURN, **more):
    return prepared(scene, duration, 1e-6, model_class=partial(Model, film=film_of(8, 12, **more)))


def end(ready, steps, tolerance):
    """Unknowns over their scales at the end of the first segment, and what it cost."""
    segment, y, counts = ready.segment(0), ready.y0.copy(), Counts()
    segment.settle_film(0.0, y)
    for _, ys, yps in steps(segment, 0.0, y, "ida", tolerance, counts):
        last = ys[-1]
        assert yps.shape == ys.shape
    return last[: segment.film.stop] / segment.scales[: segment.film.stop], counts


@pytest.mark.parametrize("name", CASES)
def test_the_same_motion_as_through_scikit_sundae(name):
    """Both within some hundred tolerances of each other, at about the same cost; the sharper the nearer."""
    scene, more = CASES[name]
    ready = on_film(scene, **more)
    for tolerance in (1e-6, 1e-9):
        (direct, counts), (other, others) = (end(ready, s, tolerance) for s in (METHODS["ida"], sundials_python.ida))
        assert counts.back_end.startswith("SUNDIALS 7") and not counts.slow
        assert np.max(np.abs(direct - other)) < 1000 * tolerance
        assert 0.5 < counts.rhs / others.rhs < 2.0 and 0.5 < counts.jacobians / others.jacobians < 2.0


@pytest.mark.core
def test_each_jacobian_costs_an_evaluation_per_unknown_of_the_rings_and_one(monkeypatch):
    """As through scikit-sundae, where the same steps, which may grow as much, cost the same."""
    monkeypatch.setattr(sundials_direct, "GROWTH", 2.0)
    ready = on_film(fms())
    (_, counts), (_, others) = (end(ready, steps, 1e-7) for steps in (METHODS["ida"], sundials_python.ida))
    assert (counts.rhs, counts.jacobians) == (others.rhs, others.jacobians)
    assert counts.rhs > counts.jacobians * 7 > 0 and sum(counts.orders) > 100


def test_blocks_go_on_without_a_new_start(monkeypatch):
    """Handed over in blocks of seven the steps are the same to the bit."""
    ready, found = on_film(fmsr()), []
    for rows in (7, 1024):
        monkeypatch.setattr(sundials_direct, "BLOCK", rows)
        y = ready.y0.copy()
        segment = ready.segment(0)
        segment.settle_film(0.0, y)
        blocks = list(METHODS["ida"](segment, 0.0, y, "ida", 1e-7, Counts()))
        found.append([np.concatenate([block[i] for block in blocks]) for i in range(3)])
    assert all(np.array_equal(one, other) for one, other in zip(*found, strict=True))


def test_a_step_that_is_left_gives_everything_back():
    """A thousand integrations begun and dropped: no memory stays."""
    resource = pytest.importorskip("resource")
    ready = on_film(fms())
    segment, y, sizes = ready.segment(0), ready.y0.copy(), []
    segment.settle_film(0.0, y)
    begun = segment.start(0.0, y)
    segment.start = lambda tau, y: begun
    for _ in range(3):
        for _ in range(300):
            next(METHODS["ida"](segment, 0.0, y, "ida", 1e-3, Counts()))
        sizes.append(resource.getrusage(resource.RUSAGE_SELF).ru_maxrss)
    # In KiB; one integrator holds some 200.
    assert sizes[2] - sizes[1] < 4000


def test_the_sparse_solver_keeps_to_one_thread():
    """Its OpenMP would gather one for each core at every matrix."""
    library = sundials_libraries.libraries()
    assert library.why_not_sparse == ""
    openmp = library.opened[-1]
    if not hasattr(openmp, "omp_get_max_threads"):
        pytest.skip("SuperLU_MT without OpenMP")
    openmp.omp_set_num_threads(3)
    end(on_film(fms(), 0.1 * TURN), METHODS["ida"], 1e-6)
    assert openmp.omp_get_max_threads() == 1


# --- failures ---------------------------------------------------------------------------------------


def ended(ready, monkeypatch, choice, **more):
    """Outcome and sink of a run on one back end."""
    monkeypatch.setenv(methods.CHOICE, choice)
    sink = Sink(2 * TURN, TURN / 64)
    outcome = solve(ready, "ida", 1e-6, sink, **more)
    assert bool(outcome.counts.slow) == bool(choice)
    return outcome, sink


def test_a_film_without_a_solution_ends_the_run_with_its_sentence(monkeypatch):
    """On both back ends at about the same time; the compiled loop also has the motion up to there."""
    times = []
    for choice in BACK_ENDS.values():
        ready = on_film(fmr(own=1e-3, fixed=0.0), thinnest=0.88 * CLEARANCE)
        outcome, sink = ended(ready, monkeypatch, choice)
        assert outcome.status == "failed" and outcome.cause == Cause.METHOD_GAVE_UP
        sentence, time = outcome.message.split(" (at ")
        assert sentence == radial_cells.STATUS[2]
        times.append(float(time.split(" s ")[0]))
        if not choice:
            assert 0.8 * times[0] < outcome.tau <= times[0] and sink.times[-1][-1] > 0.5 * outcome.tau
    assert 0.05 * TURN < times[0] == pytest.approx(times[1], rel=0.1)


def test_a_film_without_a_solution_beside_the_state_has_no_derivatives_there():
    """The state itself can be, the rotor a little further out cannot; whoever asks next gets the next answer."""
    # A step of the rotor's z is 1e-7 of the clearance.
    tilt = 10 * MISALIGNMENT
    ready = on_film(fmr(fixed=tilt), thinnest=CLEARANCE * (1 - 0.5e-7) - R_I * tilt)
    segment = ready.segment(0)
    y, yp, data = np.zeros(segment.size), np.zeros(segment.size), np.empty(segment.pattern.nnz)
    segment.residual(0.0, y, yp, np.empty(segment.size))
    with pytest.raises(SolverFailure, match=radial_cells.STATUS[2]):
        segment.residual_derivatives(0.0, y, yp, 1e3, data)
    assert segment.failure() == ""
    y[0] = -1e-6 * CLEARANCE
    segment.residual_derivatives(0.0, y, yp, 1e3, data)


def test_derivatives_that_fail_end_the_integration():
    """The compiled loop passes on what they say."""
    ready = on_film(fms())
    segment, y = ready.segment(0), ready.y0.copy()
    segment.settle_film(0.0, y)
    begun = segment.start(0.0, y)
    segment.start = lambda tau, y: begun
    failing = cfunc(coupled_native.OF_DERIVATIVES)(failing_derivatives)
    segment.native = replace(segment.native, derivatives=failing.address)
    with pytest.raises(SolverFailure, match="IDA_LSETUP_FAIL"):
        list(METHODS["ida"](segment, 0.0, y, "ida", 1e-6, Counts()))


@pytest.mark.filterwarnings("ignore::pytest.PytestUnraisableExceptionWarning")
@pytest.mark.parametrize("choice", BACK_ENDS.values(), ids=BACK_ENDS)
@pytest.mark.parametrize("name", ["residual", "wrench", "jacobian", "wrench_jacobian"])
def test_a_kernel_that_raises_an_error_is_not_believed(monkeypatch, name, choice):
    """Beyond half a turn: its own part of the equations is no number then, which IDA alone would not see."""
    # Steps that grow faster ask for a Jacobian there.
    monkeypatch.setattr(sundials_direct, "GROWTH", 2.0)
    film = replace(film_of(8, 12), **{name: RAISING[name]})
    outcome, _ = ended(prepared(fms(), 2 * TURN, 1e-6, model_class=partial(Model, film=film)), monkeypatch, choice)
    assert outcome.status == "failed" and "not a number" in outcome.message
    assert choice or 0.45 * TURN < outcome.tau < (0.51 if name in ("residual", "wrench") else 1.0) * TURN


# --- the way back -----------------------------------------------------------------------------------


def test_without_superlu_only_films_with_unknowns_go_through_scikit_sundae(monkeypatch):
    monkeypatch.setattr(sundials_libraries, "SPARSE_SOLVER", "sunlinsolofanothername")
    sundials_libraries.libraries.cache_clear()
    try:
        _, counts = end(on_film(fms(), 0.1 * TURN), METHODS["ida"], 1e-6)
        assert counts.back_end == methods.SCIKIT_SUNDAE
        assert counts.slow == methods.why_slow(sparse=True) and "no library sunlinsolofanothername" in counts.slow
        assert not methods.why_slow()
        counts = Counts()
        ready = prepared(fms(), 0.1 * TURN, 1e-6)
        list(METHODS["ida"](ready.segment(0), 0.0, ready.y0.copy(), "ida", 1e-6, counts))
        assert counts.back_end.startswith("SUNDIALS 7") and not counts.slow
    finally:
        sundials_libraries.libraries.cache_clear()


# --- kernels ----------------------------------------------------------------------------------------


def failing_derivatives(tau, alpha, y, yp, values, data):
    return coupled_native.FAILED


@njit
def residual(f, s, x, x_rate, res):
    if s[ROTOR_ANGLE] > math.pi:
        raise ValueError("beyond half a turn")
    return radial_cells.residual(f, s, x, x_rate, res)


@njit
def wrench(f, s, x):
    if s[ROTOR_ANGLE] > math.pi:
        raise ValueError("beyond half a turn")
    radial_cells.wrench(f, s, x)


@njit
def jacobian(f, s, x, x_rate, alpha, data):
    if s[ROTOR_ANGLE] > math.pi:
        raise ValueError("beyond half a turn")
    radial_cells.jacobian(f, s, x, x_rate, alpha, data)


@njit
def wrench_jacobian(f, s, x, rows):
    if s[ROTOR_ANGLE] > math.pi:
        raise ValueError("beyond half a turn")
    radial_cells.wrench_jacobian(f, s, x, rows)


RAISING = {kernel.__name__: kernel for kernel in (residual, wrench, jacobian, wrench_jacobian)}
