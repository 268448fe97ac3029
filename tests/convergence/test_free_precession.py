"""An undamped gyroscopic ring keeps amplitude, energy and angular momentum, by every method, as it was asked to.

    I gamma'' - i J W gamma' + K_s gamma = 0,  gamma = a exp(i w+ t) + b exp(i w- t),  -I w^2 + J W w + K_s = 0
    E = I |gamma'|^2 / 2 + K_s |gamma|^2 / 2,  L = I Im(conj(gamma) gamma') - J W |gamma|^2 / 2
Nothing forgives an error here: what a step adds, the next turns keep.
"""

import math

import numpy as np
import pytest
from command import SCENARIOS
from scenes import INERTIA, SPEED, SUPPORT, TILT_SCALE, free_ring, run

from sealdyn import read_scenario
from sealdyn.simulation.simulate import prepare_run

SCENARIO = SCENARIOS / "free_precession.toml"
K_S = SUPPORT.axial_stiffness * SUPPORT.radius**2 / 2
J = 2 * INERTIA
TURNS = 60
FORWARD, BACKWARD = (
    (J * SPEED + sign * math.sqrt((J * SPEED) ** 2 + 4 * INERTIA * K_S)) / (2 * INERTIA) for sign in (1, -1)
)
# Half the clearance at the outer edge, shared between a forward and a backward circle.
A, B = 40e-6, 90e-6


def invariants(gamma, rate):
    energy = 0.5 * INERTIA * abs(rate) ** 2 + 0.5 * K_S * abs(gamma) ** 2
    return energy, INERTIA * (np.conj(gamma) * rate).imag - 0.5 * J * SPEED * abs(gamma) ** 2


def precession(method, accuracy):
    """Times, tilt and rate of 60 turns from the start of two circles."""
    scene = free_ring(0.5, A + B, A * FORWARD + B * BACKWARD)
    found = run(scene, turns=TURNS, accuracy=accuracy, method=method, per_turn=16)
    assert found.outcome.status == "ok" and found.ready.model.unknowns.n == 2
    return found.times, found.tilt("rotor"), found.rates[:, 0] + 1j * found.rates[:, 1]


# Drift over 60 turns, measured as max |E/E0 - 1| (it grows with the turns; L drifts 0.3 to 0.5 of it):
#            1e-4      1e-6      1e-8
#   adams    6.1e-5    3.9e-6    7.9e-9
#   bdf      7.5e-5    2.5e-6    1.7e-8
#   ida      7.1e-6    9.3e-7    1.2e-8
#   dop853   7.5e-5    4.2e-7    2.3e-9
#   radau    5.6e-6    1.8e-8    -
#   expm     1.0e-13   1.0e-13   1.0e-13
METHODS = ["adams", "bdf", "ida", "dop853", "expm"]


@pytest.mark.parametrize("method", [*METHODS, pytest.param("radau", marks=pytest.mark.slow)])
@pytest.mark.parametrize("accuracy", [1e-4, 1e-6])
def test_energy_and_angular_momentum_are_kept(method, accuracy):
    check_invariants(method, accuracy)


@pytest.mark.slow
@pytest.mark.parametrize("method", METHODS)
def test_energy_and_angular_momentum_are_kept_sharply(method):
    check_invariants(method, 1e-8)


def check_invariants(method, accuracy):
    times, gamma, rate = precession(method, accuracy)
    exact = A * np.exp(1j * FORWARD * times) + B * np.exp(1j * BACKWARD * times)
    assert np.max(np.abs(gamma - exact)) < accuracy * TILT_SCALE
    # What an error of the asked size, in tilt and in rate, may do to the two quadratic forms.
    off, off_rate = accuracy * TILT_SCALE, accuracy * TILT_SCALE * SPEED
    largest, fastest = A + B, A * FORWARD - B * BACKWARD
    allowed = (
        INERTIA * fastest * off_rate + K_S * largest * off,
        INERTIA * (largest * off_rate + fastest * off) + J * SPEED * largest * off,
    )
    for values, most in zip(invariants(gamma, rate), allowed, strict=True):
        assert np.max(np.abs(values - values[0])) < most
    # And both are what the start says.
    start = invariants(A + B, 1j * (A * FORWARD + B * BACKWARD))
    assert [values[0] for values in invariants(gamma, rate)] == pytest.approx(start, rel=1e-12)


@pytest.mark.core
def test_a_short_disk_precesses_at_2224_and_minus_225_rad_per_s():
    assert pytest.approx(1000 + math.sqrt(1.5e6), rel=1e-14) == FORWARD
    assert pytest.approx(1000 - math.sqrt(1.5e6), rel=1e-13) == BACKWARD


def warnings(*overrides):
    return [caution.sentence for caution in prepare_run(read_scenario(SCENARIO, overrides))[0].cautions]


def test_an_accuracy_that_cannot_be_kept_is_warned_of():
    """1e5 undamped turns: errors of 3e-14 a step add up to more than 1e-8; the matrix exponential does not mind."""
    (said,) = warnings("run.turns=100000", "run.samples_per_turn=32", 'run.solver="adams"')
    assert "2.22e+05" in said and "6.7e-07" in said
    assert warnings("run.turns=100000", "run.samples_per_turn=32") == []
    assert warnings("run.turns=100000", "run.samples_per_turn=32", "run.accuracy=1e-6", 'run.solver="adams"') == []
    assert warnings('run.solver="adams"') == []
    # A damper forgets: nothing to warn of.
    damped = "rotor.support.axial_damping=300"
    assert warnings("run.turns=100000", "run.samples_per_turn=32", damped, 'run.solver="adams"') == []
