"""Every method (the matrix exponential: test_exact_motion.py) on every kind of scene: error within the asked accuracy,
energy residual within ten times it."""

import numpy as np
import pytest
from scenes import fmr, fms, fmsr, free_ring, housing_vibration, large_tilt, run, runup

TURNS = dict(turns=6)
SCENES = {
    "fmr": (fmr(), TURNS), "fmr-linear": (fmr("linear"), TURNS), "fms": (fms(), TURNS), "fmsr": (fmsr(), TURNS),
    "fmsr-linear": (fmsr("linear"), TURNS), "large-tilt": (large_tilt(), dict(turns=6, start="steady")),
    "housing": (housing_vibration(), TURNS), "runup": (runup(), dict(duration=0.03)),
    "fast-slender-rotor": (fmr("linear", 3.0, speed=8000.0), TURNS), "free-precession": (free_ring(), TURNS),
}  # fmt: skip
METHODS = ["adams", "bdf", "ida", "dop853", "radau"]


@pytest.fixture(scope="module")
def reference():
    """DOP853 at its own limit, 2e-13 of every scale."""
    found = {}

    def of(name):
        if name not in found:
            scene, options = SCENES[name]
            found[name] = run(scene, accuracy=6e-12, method="dop853", per_turn=32, **options)
        return found[name]

    return of


@pytest.mark.parametrize("method", METHODS)
@pytest.mark.parametrize("name", SCENES)
def test_error_and_energy_within_the_asked_accuracy(name, method, reference):
    """Error of displacements and rates at 32 samples a turn (steps and dense output together), over their scales."""
    exact = reference(name)
    assert exact.outcome.status == "ok"
    scene, options = SCENES[name]
    for accuracy in (1e-4, 1e-6) if method == "radau" else (1e-4, 1e-6, 1e-8):
        found = run(scene, accuracy=accuracy, method=method, per_turn=32, **options)
        assert found.outcome.status == "ok"
        assert np.max(np.abs(found.scaled() - exact.scaled())) < accuracy
        assert found.outcome.energy_residual < 10 * accuracy


@pytest.mark.core
@pytest.mark.parametrize("method", METHODS)
def test_error_falls_with_the_accuracy(method, reference):
    """Proportionally, by regression: a method that stopped listening would show a flat line.  Radau IIA is of order 5
    with an estimate of order 3: its step goes with tolerance^(1/4), its error with tolerance^(5/4)."""
    accuracies = np.array([1e-3, 1e-4, 1e-5, 1e-6, 1e-7, 1e-8])
    errors = []
    for accuracy in accuracies:
        found = run(SCENES["fms"][0], accuracy=accuracy, method=method, per_turn=32, **TURNS)
        errors.append(np.max(np.abs(found.scaled() - reference("fms").scaled())))
    slope = np.polyfit(np.log(accuracies), np.log(errors), 1)[0]
    assert slope == pytest.approx(1.25 if method == "radau" else 1.0, abs=0.25)
