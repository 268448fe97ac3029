"""A stator on an O-ring that sticks and slips twenty times: errors, events and heat at every accuracy."""

import math

import numpy as np
import pytest
from judge import Instants
from scenes import NOTHING, SPEED, film, prepared
from scipy.integrate import solve_ivp

from sealdyn.scene.excitation import AxialVibration, Housing, Shaft
from sealdyn.scene.rings import Rotor, SecondarySeal, Stator, Support
from sealdyn.scene.scene import Scene
from sealdyn.simulation.selection import choose_method
from sealdyn.simulation.verification_run import Comparison, ErrorScales
from sealdyn.solvers.integrate import solve

DURATION, MASS, FRICTION, SPRING, AMPLITUDE, TONE = 0.2, 0.5, 5.0, 2e5, 20e-6, 2 * math.pi * 100.0
SCENE = Scene(
    shaft=Shaft(speed=SPEED), film=film("linear", coefficients=NOTHING, clearance=1e-4, coning=0.0), rotor=Rotor(),
    housing=Housing(axial=[AxialVibration(frequency=100.0, displacement=AMPLITUDE)]),
    stator=Stator(mass=MASS, transverse_inertia=4e-4, polar_inertia=8e-4,
                  support=Support(axial_stiffness=SPRING, axial_damping=2.0, radius=0.045),
                  secondary_seal=SecondarySeal(radius=0.045, friction_force=FRICTION)),
)  # fmt: skip
TIMES = np.sort(np.random.default_rng(3).uniform(0.0, DURATION, 1500))


class Events(Instants):
    def __init__(self, *given):
        super().__init__(*given)
        self.events = []

    def event(self, segment, tau, event):
        self.events.append((segment.time + tau, event["kind"]))


def at(accuracy, method=None, tolerance=None):
    run = prepared(SCENE, DURATION, accuracy, "rest")
    scales, seen, chosen = ErrorScales(run), Comparison(run), method or choose_method(run)[0]
    sink = Events(scales, TIMES)
    outcome = solve(run, chosen, accuracy, sink, tolerance=tolerance, seen=seen)
    assert outcome.status == "ok"
    return run, scales, sink, seen, (chosen, outcome.tolerance)


@pytest.fixture(scope="module")
def truth():
    return at(1e-8, "bdf", 1e-12)[2]


@pytest.mark.parametrize("accuracy", [1e-2, 1e-3, 1e-4, 1e-6])
def test_errors_and_events_are_within_the_accuracy(accuracy, truth):
    run, scales, sink, seen, (method, tolerance) = at(accuracy)
    times, kinds = (np.array(list(column)) for column in zip(*sink.events, strict=True))
    true, true_kinds = (np.array(list(column)) for column in zip(*truth.events, strict=True))
    assert (run.stick_slip.sticks, run.stick_slip.slips) == (20, 20) and np.all(kinds == true_kinds)
    # Measured 3.5: rings that come to rest slowly, whose time no velocity tells better.
    assert np.max(np.abs(times - true)) * scales.rate < 12 * accuracy
    away = np.min(np.abs(TIMES[:, None] - true), axis=1) > accuracy / scales.rate
    errors = scales.errors(sink.all(), truth.all())[away].max(axis=0)
    # Measured 0.11.
    assert np.all(errors < 0.35 * accuracy), errors / accuracy
    apart = seen.error_over_time(method=method, tolerance=tolerance)
    assert np.nanmax(apart) > 0.3 * errors.max() or errors.max() < accuracy / 100
    assert 0.0 < run.stick_slip.dropped < 1e-3 * FRICTION * AMPLITUDE


@pytest.mark.parametrize("method", ["dop853", "ida"])
def test_other_methods_agree(method, truth):
    _, scales, sink, _, _ = at(1e-3, method)
    away = np.min(np.abs(TIMES[:, None] - [t for t, _ in truth.events]), axis=1) > 1e-3 / scales.rate
    assert np.all(scales.errors(sink.all(), truth.all())[away] < 0.5e-3)


@pytest.mark.core
def test_the_first_slide_is_one_of_constant_friction(truth):
    """Until the ring first comes to rest on the housing, which starts at its crest, nothing jumps."""

    def rates(t, x):
        spring = SPRING * (x[0] - AMPLITUDE * math.cos(TONE * t)) + 2.0 * (x[1] + AMPLITUDE * TONE * math.sin(TONE * t))
        return [x[1], (-FRICTION - spring) / MASS]

    first = truth.events[0][0]
    t = TIMES[: np.searchsorted(TIMES, first)]
    found = solve_ivp(rates, (0.0, first), [0.0, 0.0], "DOP853", [*t, first], rtol=1e-12, atol=1e-16)
    assert truth.all()[: len(t), 0] * 1e-4 == pytest.approx(found.y[0][:-1], abs=1e-12)
    # There it moves as the housing does.
    assert found.y[1][-1] == pytest.approx(-AMPLITUDE * TONE * math.sin(TONE * first), abs=1e-7)
