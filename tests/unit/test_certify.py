"""The choice of the film and the certificate, against the errors themselves."""

import math
from dataclasses import replace
from types import SimpleNamespace

import numpy as np
import pytest
import scenes
from command import SCENARIOS
from scenes import CLEARANCE, R_O, SPEED, TILT_SCALE, apart, fmr, fms, fmsr, free_ring, prepared, ring, run, started

from sealdyn.numerics.piecewise_linear import PiecewiseLinear
from sealdyn.scenario.reader import read_scenario
from sealdyn.scenario.tables import Run
from sealdyn.scene.excitation import AngularVibration, Housing
from sealdyn.scene.forces import Contact
from sealdyn.scene.rings import Stator
from sealdyn.simulation import certificate, verification_run
from sealdyn.simulation import film_error as film_comparison
from sealdyn.simulation.certificate import LOOSER, certify, choose_tolerance, error_estimator, solver_error
from sealdyn.simulation.film_error import model_error, model_errors
from sealdyn.simulation.selection import Plan, Start, select_film
from sealdyn.simulation.simulate import simulate, simulate_in_memory
from sealdyn.simulation.verification_run import Comparison, ProgressSink, sharper
from sealdyn.solvers.contract import TIGHTEST, Counts, Recorder, tolerance_for
from sealdyn.solvers.integrate import solve
from sealdyn.solvers.run_error import GlobalErrorEstimate

TURN = 2 * math.pi / SPEED


def on(scene, model, **changes):
    return replace(scene, film=replace(scene.film, model=model, **changes))


def film_change(found):
    """Change of the film at the outer radius, in clearances, at every sample: axial and angular, complex."""
    names, total = found.ready.model.unknowns.names, {}
    for ring_name, sign in (("stator", 1.0), ("rotor", -1.0)):
        for part in ("z", "tilt_x", "tilt_y"):
            if f"{ring_name}_{part}" in names:
                column = found.q[:, names.index(f"{ring_name}_{part}")]
                total[part] = total.get(part, 0.0) + sign * column
    z = total.get("z", np.zeros(len(found.times)))
    return z / CLEARANCE, R_O / CLEARANCE * (total["tilt_x"] + 1j * total["tilt_y"])


SCENES = {
    "fms": fms(own=0.05 * TILT_SCALE, runout=0.1 * TILT_SCALE),
    "fmr": fmr(own=0.1 * TILT_SCALE, fixed=0.05 * TILT_SCALE),
    "fmsr": fmsr(own=0.2 * TILT_SCALE, fixed=0.1 * TILT_SCALE),
    "shaken": scenes.housing_vibration(),
    "larger": fmr(own=0.3 * TILT_SCALE, fixed=0.5 * TILT_SCALE),
}
UNSTABLE = fmr(c=3.0, speed=1.1 * 8684.0, own=1e-3 * TILT_SCALE, fixed=0.0)


@pytest.mark.core
@pytest.mark.parametrize("start", ["rest", "steady"])
@pytest.mark.parametrize("name", SCENES)
def test_model_error_is_the_difference_of_the_films(name, start):
    """Both films run at 1e-9; what the two motions differ by is what was estimated, within a third."""
    motions = []
    for model, changes in (("linear", {"coefficients": "radial"}), ("radial", {})):
        found = run(on(SCENES[name], model, **changes), turns=12, accuracy=1e-9, start=start)
        motions.append(film_change(found))
    z, tilt = (a - b for a, b in zip(*motions, strict=True))
    actual = np.max(np.abs(z) + np.abs(tilt))
    ready = started(on(SCENES[name], "linear", coefficients="radial"), 12 * TURN, 1e-9)
    if start == "steady":
        ready.y0 = ready.steady_start()
    assert actual > 1e-6
    film, leakage = model_errors(ready)
    assert 0.7 * actual < film < 1.6 * actual
    # Squeeze and the cube of the film weigh more than the film itself.
    assert film < leakage < 60 * film


@pytest.mark.parametrize("start", ["rest", "steady"])
def test_model_error_does_not_depend_on_how_many_steps_are_taken_at_once(start, monkeypatch):
    ready = prepared(on(SCENES["fmsr"], "linear", coefficients="radial"), 12 * TURN, 1e-6, start)
    monkeypatch.setattr(film_comparison, "STEADY", 4)
    found = []
    for at_once in (7, 1000):
        monkeypatch.setattr(film_comparison, "AT_ONCE", at_once)
        found.append(model_errors(ready))
    # Leakage is counted relative to the largest seen so far.
    assert found[0] == pytest.approx(found[1], rel=1e-3) and found[0][0] == pytest.approx(found[1][0], rel=1e-10)


def measured(ready, method, tolerance):
    """A run, and how far it is from a sharper one at the instants where they are compared."""
    seen = Comparison(ready)
    outcome = solve(ready, method, ready.model.accuracy, ProgressSink(ready), tolerance=tolerance, seen=seen)
    assert outcome.status == "ok"
    return seen, seen.error_over_time(method=method, tolerance=tolerance)


@pytest.mark.parametrize("method", ["adams", "bdf", "dop853", "radau"])
@pytest.mark.parametrize("accuracy", [1e-3, 1e-5, 1e-7])
def test_solver_error_is_neither_hidden_nor_made_up(method, accuracy):
    """A run done twice, against a run at 1e-12, in everything that is looked at: at least the true error, and below
    what was asked."""
    ready = prepared(fms(), 6 * TURN, accuracy)
    tolerance = tolerance_for(method, accuracy, ready.memory)
    seen, apart = measured(ready, method, tolerance)
    sharp = Comparison(ready.anew(), seen.times)
    assert solve(sharp.run, "dop853", accuracy, ProgressSink(ready), tolerance=1e-12, seen=sharp).status == "ok"
    true = float(seen.scales.errors(seen.columns, sharp.columns).max())
    estimate = solver_error(method, tolerance, apart)
    assert true / 3 < estimate + 1e-10 and estimate < accuracy


@pytest.mark.parametrize("method", ["adams", "bdf"])
def test_a_measuring_run_has_a_budget(method, monkeypatch):
    """Before, it might take any work, hours after a run of seconds.  What it did not see is not said to be right."""
    monkeypatch.setattr(verification_run, "BUDGET", 0.5)
    monkeypatch.setattr(certificate, "UNBOUNDED", 0)
    ready = prepared(fms(), 60 * TURN, 1e-5)
    seen = Comparison(ready)
    outcome = solve(ready, method, 1e-5, ProgressSink(ready), seen=seen)
    work = verification_run.budget(method, outcome.counts)
    apart = seen.error_over_time(method=method, tolerance=outcome.tolerance, work=work)
    assert seen.dear and np.isfinite(apart[0]) and np.isnan(apart[-1]) and not np.isinf(apart).any()
    plan = Plan("radial", method, None, Start("rest"), "")
    found, ended = certificate.certificate(ready, plan, outcome, None, seen)
    assert ended.status == "ok" and found["solver"] is None and found["horizon"] is None
    monkeypatch.setattr(verification_run, "BUDGET", 10.0)
    seen.dear = ""
    found, _ = certificate.certificate(ready, plan, outcome, None, seen)
    assert found["solver"] < 1e-5


@pytest.mark.parametrize("thicker, method", [(1.0, "dop853"), (1e4, "bdf")], ids=["gentle", "stiff"])
def test_no_explicit_method_measures_where_decay_is_fast(thicker, method):
    """Radau at its floor of tolerance was measured by DOP853, which crawls there."""
    scene = fms()
    scene = replace(scene, film=replace(scene.film, viscosity=thicker * scene.film.viscosity))
    run = prepared(scene, TURN, 1e-5)
    assert sharper("radau", TIGHTEST, run, certificate._would_take_bdf(run))[0] == method
    assert sharper("bdf", TIGHTEST, run)[0] == "radau"


@pytest.mark.slow
def test_an_undamped_scene_adds_its_errors_up():
    scene, found = free_ring(), []
    for turns in (20, 1000):
        ready = prepared(scene, turns * TURN, 1e-3)
        tolerance = tolerance_for("adams", 1e-3, ready.memory)
        found.append(solver_error("adams", tolerance, measured(ready, "adams", tolerance)[1]))
    ways = ("adams", 1e-3), ("expm", 1e-9)
    true = [run(scene, turns=1000, accuracy=accuracy, method=method, per_turn=4) for method, accuracy in ways]
    drift = np.max(np.abs(true[0].scaled() - true[1].scaled())[:, : true[0].model.unknowns.n])
    assert 0 < found[0] < 1e-3 and drift / 3 < found[1] < 1e-3


def followed(ready, method, trial, sharp=1e-13):
    """True largest error of displacements of a run (relative to their scales), and the estimate of its own steps."""
    assert error_estimator(ready, method)
    # Without what else is looked at.
    errors = GlobalErrorEstimate(ready.segment(0))
    told = {"tolerance": trial.tolerance, "steps": trial.steps, "errors": errors}
    exact = "dop853", {"tolerance": sharp}
    return apart(ready, (method, told), exact, ready.model.shortest_period / 12), errors.worst


@pytest.mark.parametrize("method", ["adams", "bdf"])
@pytest.mark.parametrize("accuracy", [1e-3, 1e-7])
@pytest.mark.parametrize("name,start", [("fmsr", "rest"), ("shaken", "rest"), ("larger", "rest"), ("larger", "steady")])
def test_a_tolerance_on_trial_keeps_the_accuracy(name, start, method, accuracy):
    """Looser than the cautious one, and the run at it is still as exact as was asked; its own steps tell its error
    within half (by Adams at 1e-7 several times too much, cause not found)."""
    ready = prepared(on(SCENES[name], "radial"), 30 * TURN, accuracy, start)
    trial = choose_tolerance(ready, method)[0]
    cautious = tolerance_for(method, accuracy, ready.memory)
    assert cautious <= trial.tolerance <= LOOSER * cautious * (1 + 1e-12)
    true, estimate = followed(ready, method, trial)
    # Rounding decides the orders Adams takes at 1e-7: with the accuracy moved by 1e-9 to 0.1 of itself the estimate is
    # 0.97 to 12 times the true error of the shaken scene, 0.97 to 3 times that of the larger; threefold for others.
    unsure = {"shaken": 36.0, "larger": 9.0} if (method, accuracy) == ("adams", 1e-7) else {}
    most = unsure.get(name, 1.5)
    assert true < accuracy and true / 1.5 < estimate < most * true


@pytest.mark.parametrize("accuracy", [1e-3, 1e-5])
def test_what_comes_after_the_stretch_is_not_forgotten(accuracy):
    """A faint vibration at 60 times the shaft speed: the stretch is a twentieth of a turn and shows nothing."""
    faint = AngularVibration(frequency=60.5 * SPEED / (2 * math.pi), displacement=1e-5 * TILT_SCALE)
    scene = replace(on(SCENES["larger"], "radial"), housing=Housing(angular=[faint]))
    ready = prepared(scene, 10 * TURN, accuracy)
    true, estimate = followed(ready, "adams", choose_tolerance(ready, "adams")[0])
    # Measured 0.64 and 0.7 of the true error: which steps Adams takes here hangs on rounding.
    assert true / 3 < estimate < accuracy


def test_a_run_goes_on_from_its_trial(monkeypatch):
    """The steps of the stretch are the run's first; what they cost is counted."""
    monkeypatch.setattr(certificate, "SHARE", 5.0)
    ready = prepared(SCENES["fmsr"], 5 * TURN, 1e-4)
    trial, sink = choose_tolerance(ready, "adams")[0], Recorder(TURN / 32)
    assert len(trial.times) > 10 and trial.times[-1] == pytest.approx(3 * ready.model.shortest_period)
    blocks = list(trial.steps(ready.segment(0), 0.0, ready.y0.copy(), "adams", trial.tolerance, Counts()))
    assert blocks[0][0] is trial.times and blocks[1][0][0] > trial.times[-1] and blocks[-1][0][-1] == 5 * TURN
    outcome = solve(ready, "adams", 1e-4, sink, tolerance=trial.tolerance, steps=trial.steps)
    assert outcome.counts.rhs > trial.counts.rhs > 30
    # A run that is taken up later does not begin again.
    late = trial.steps(ready.segment(0), TURN, trial.unknowns[-1].copy(), "adams", trial.tolerance, Counts())
    assert next(late)[0][0] > TURN


@pytest.mark.parametrize("name,accuracy", [("larger", 1e-7), ("fmsr", 1e-5), ("fms", 1e-6)])
def test_a_run_that_turns_out_too_loose_goes_on_sharper(name, accuracy, monkeypatch):
    """A trial that believes anything: the run's own steps tell, before what they lead to is handed over."""
    monkeypatch.setattr(certificate, "TRIAL_SAFETY", 1e-9)
    monkeypatch.setattr(certificate, "ENERGY", 1e9)
    monkeypatch.setattr(certificate, "LOOSER", 300.0)
    ready, times = prepared(on(SCENES[name], "radial"), 30 * TURN, accuracy), []

    class Seen(Recorder):
        def take(self, segment, taus, q, q_rate):
            times.append(taus)
            super().take(segment, taus, q, q_rate)

    (trial, errors), found = choose_tolerance(ready, "adams"), []
    cautious = tolerance_for("adams", accuracy, ready.memory)
    assert trial.tolerance > 50 * cautious
    told = {"tolerance": trial.tolerance, "steps": trial.steps, "errors": errors}
    for kind, method, options in ((Seen, "adams", told), (Recorder, "dop853", {"tolerance": 1e-13})):
        sink = kind(TURN / 32)
        outcome = solve(ready, method, accuracy, sink, **options)
        found.append((sink.arrays()[1] / ready.model.scales[: ready.model.unknowns.n], outcome))
    assert cautious <= found[0][1].tolerance < trial.tolerance and found[0][1].counts.restarts > 1
    assert np.max(np.abs(found[0][0] - found[1][0])) < accuracy and found[0][1].energy_residual < 10 * accuracy
    # Every sample once, in order.
    assert len(found[0][0]) == len(found[1][0]) and np.all(np.diff(np.concatenate(times)) > 0)


def test_a_trial_that_errs_too_much_is_done_again_sharper(monkeypatch):
    """The tolerance goes down with the estimated error, and never below the cautious one."""
    ready = prepared(SCENES["fmsr"], 30 * TURN, 1e-4)
    cautious = tolerance_for("adams", 1e-4, ready.memory)
    monkeypatch.setattr(certificate, "SHARE", 5.0)
    taken = choose_tolerance(ready, "adams")[0]
    assert taken.tolerance == LOOSER * cautious and len(taken.times)
    monkeypatch.setattr(certificate, "SHARE", 0.3)
    sharper = choose_tolerance(ready, "adams")[0]
    assert cautious < sharper.tolerance < taken.tolerance and not len(sharper.times)
    monkeypatch.setattr(certificate, "SHARE", 1e-6)
    assert choose_tolerance(ready, "adams")[0].tolerance == cautious
    monkeypatch.setattr(certificate, "SHARE", 1.0)
    monkeypatch.setattr(certificate, "ENERGY", 1e-6)
    assert choose_tolerance(ready, "adams")[0].tolerance == cautious


@pytest.mark.parametrize("accuracy", [1e-3, 1e-4, 1e-5, 1e-6, 1e-8])
@pytest.mark.parametrize("name", ["fms_reference", "fmr_reference", "fmsr_both_flexible"])
def test_a_tolerance_on_trial_keeps_the_energy(name, accuracy):
    """Ten times the accuracy, although the motion is but a tenth of a scale."""
    path = SCENARIOS / f"{name}.toml"
    summary = simulate_in_memory(read_scenario(path, [f"run.accuracy={accuracy}"]))
    assert summary["energy_residual"] < 10 * accuracy


@pytest.mark.parametrize(
    "scene",
    [
        replace(fms(), contact=Contact(roughness=1e-7, compressive_strength=3e8)),
        fms(speed=PiecewiseLinear((0.0, 0.01), (1000.0, 1100.0))),
        UNSTABLE,
        free_ring(),
    ],
    ids=["contact", "run-up", "unstable", "undamped"],
)
def test_where_a_stretch_does_not_tell_of_the_run(scene):
    assert choose_tolerance(prepared(scene, 30 * TURN, 1e-5), "adams")[0] is None


def choose(scene, accuracy, start=None):
    settings = Run(duration=10 * TURN, accuracy=accuracy)
    return select_film(on(scene, "auto"), settings, start or (lambda ready: None))[0]


def test_the_lowest_film_that_keeps_the_accuracy():
    gentle = SCENES["fms"]
    error = model_error(started(on(gentle, "linear", coefficients="radial"), 10 * TURN, 1e-6))
    assert choose(gentle, 2.2 * error).model.interface.name == "linear"
    assert choose(gentle, 1.8 * error).model.interface.name == "radial"
    assert any("film auto" in reason for reason in choose(gentle, 1.8 * error).reasons)


@pytest.mark.parametrize(
    "scene",
    [
        replace(fms(), contact=Contact(roughness=1e-7, compressive_strength=3e8)),
        on(fms(), "auto", cavitation_pressure=0.0),
        fms(speed=PiecewiseLinear((0.0, 0.01), (1000.0, 1100.0))),
        fms(stator=Stator(**ring() | {"transverse_inertia": 0.0, "polar_inertia": 0.0, "mass": 0.0})),
        UNSTABLE,
    ],
    ids=["contact", "cavitation", "run-up", "massless", "unstable"],
)
def test_where_a_linear_film_has_no_place(scene):
    assert choose(scene, 1e-2).model.interface.name == "radial"


def test_leakage_of_a_chosen_linear_film_is_the_radial_films():
    """The motion may be linear; what leaks at a clearance is not for the narrow-seal formula to say."""
    ready = choose(SCENES["fmsr"], 1e-2)
    assert ready.model.interface.name == "linear" and ready.model.observed[0].name == "radial"


def test_the_sentence_says_what_was_asked_and_what_was_found():
    ready = choose(SCENES["fms"], 1e-2)
    found = certify(ready, "adams", 1e-8, SimpleNamespace(worst=1e-9))
    assert found.estimated == pytest.approx(found.solver + found.model)
    assert found.said.startswith("asked 1e-02, estimated ") and "model" in found.said and "NOT met" not in found.said
    linear = started(on(SCENES["larger"], "linear", coefficients="radial"), 10 * TURN, 1e-6)
    assert "NOT met: try a higher film rung" in certify(linear, "adams", 1e-8).said


SHARPER = "run.accuracy"


@pytest.mark.parametrize(
    ("method", "advice"), [("adams", '"dop853"'), ("bdf", '"radau"'), ("ida", SHARPER), ("radau", SHARPER)]
)
def test_what_to_try_fits_the_scene(method, advice):
    """Where the solver errs too much: no explicit method for what BDF was chosen for, none at all in place of IDA."""
    found = certify(choose(SCENES["fms"], 1e-4), method, 1e-8, SimpleNamespace(worst=1.0), 0.0).said
    assert "NOT met: try " in found and advice in found.partition("try ")[2]
    assert method == "adams" or "dop853" not in found


def test_a_run_stopped_while_it_is_measured_is_measured_when_it_goes_on(tmp_path):
    scenario = read_scenario(SCENARIOS / "massless_ring.toml", ["run.turns=30"])
    reached = [0.0]
    again = []

    def progress(t, _):
        again.extend([t] * (t < reached[-1]))
        reached.append(t)

    first = simulate(scenario, tmp_path / "x.h5", progress=progress, stop=lambda: bool(again))
    assert first.status == "interrupted" and first.summary["end"]["time"] == first.summary["end"]["asked"]
    rest = simulate(scenario, tmp_path / "x.h5", resume=True)
    assert rest.status == "ok" and rest.summary["certificate"]["met"]
    assert rest.summary["certificate"] == simulate(scenario, tmp_path / "whole.h5").summary["certificate"]


def test_whether_a_run_is_as_exact_as_asked_is_not_known_from_its_film_alone():
    """A run done before it is continued, of a film with cells: what these err by says nothing of the solver."""

    def met(**errors):
        return certificate.Certificate(asked=1e-3, said="", **errors).met

    assert met(solver=None, model=1e-4) is None and met(solver=1e-4, model=1e-4) is True
    assert met(solver=None, model=2e-3) is False and met(solver=None, model=None) is None
    assert met(solver=1e-4, model=None, cells=0.1, grid=0.01) is False
