"""Near the threshold the verdict of a loosely held BDF is the method's, not the seal's; the study's survives.

Green's FMR seal, c = 3, linear film, threshold 8684.05 rad/s (formula and eigenvalues).  CVODE's BDF climbs to orders
that pump a whirl at 1e-4, and damps it at 5e-6: both signs of a false verdict from one method.
"""

import math

import numpy as np
import pytest
from oracles import tilt_roots
from scenes import INERTIA, SUPPORT, fmr

from sealdyn.analysis.rotating_wave import RotatingWave, contact_tilt_aligned, free_model, least_damped
from sealdyn.analysis.whirl_in_time import growth_rate
from sealdyn.closed_form import film_coefficients, fmr_critical_speed
from sealdyn.dynamics.run_state import RunState
from sealdyn.solvers.contract import Counts
from sealdyn.solvers.methods import METHODS

FILM = film_coefficients(0.032, 0.04, 1e-5, 3.125e-3, 0.5e-3, 5e5)
K_S, D_S = SUPPORT.tilt()
THRESHOLD = fmr_critical_speed(
    transverse_inertia=INERTIA, polar_inertia=INERTIA / 3, support_stiffness=K_S, support_damping=D_S,
    film_stiffness=FILM.tilt_stiffness, film_damping=FILM.tilt_damping,
)  # fmt: skip
TURNS = 200


def exact(speed):
    """Largest real part of the roots of the ring's complex equation (1/s)."""
    film = dict(k=FILM.tilt_stiffness, d=FILM.tilt_damping)
    return max(tilt_roots(speed, "rotor", inertia=INERTIA, polar=INERTIA / 3, k_s=K_S, d_s=D_S, **film).real)


def rate_by_bdf(speed, tolerance):
    """Growth rate (1/s) of a tenth of the contact tilt over 200 turns of CVODE BDF at a bare solver tolerance."""
    model = free_model(fmr("linear", 3.0), speed)
    ready, whirling = RunState(model, TURNS * 2 * math.pi / speed), RotatingWave(model)
    frequency, shape = least_damped(model, speed)
    start = whirling.state(0.1 * contact_tilt_aligned(model) * shape, frequency)
    blocks = list(METHODS["bdf"](ready.segment(0), 0.0, start, "bdf", tolerance, Counts()))
    t = np.concatenate([block[0] for block in blocks])
    size = np.abs(np.concatenate([whirling.relative(block[1][:, : ready.model.unknowns.n].T) for block in blocks]))
    late = t > 0.25 * t[-1]
    return np.polyfit(t[late], np.log(size[late]), 1)[0]


@pytest.mark.core
def test_loose_bdf_calls_an_unstable_seal_stable():
    speed = 1.0002 * THRESHOLD
    # Measured: +0.60, -0.21 and -0.02 1/s, where the seal grows at +0.24; restarted now and then -0.50 at 1e-5.
    assert exact(speed) > 0.2
    assert min(rate_by_bdf(speed, tolerance) for tolerance in (1e-5, 5e-6, 3e-6)) < 0


@pytest.mark.parametrize("tolerance", [1e-4, 3e-4])
def test_looser_bdf_calls_a_stable_seal_unstable(tolerance):
    speed = 0.998 * THRESHOLD
    # Measured: +0.70 1/s at 1e-4 and +3.4 at 3e-4, where the seal decays at -2.44.
    assert exact(speed) < -2
    assert rate_by_bdf(speed, tolerance) > 0


@pytest.mark.parametrize("share", [0.9998, 1.0002])
@pytest.mark.parametrize("method", ["adams", "bdf"])
def test_the_study_tightens_until_the_method_cannot_decide(share, method):
    """Even BDF, begun at an accuracy of 1e-2, is right once its own damping is measured and made small."""
    speed = share * THRESHOLD
    found = growth_rate(fmr("linear", 3.0), speed, TURNS, method, 1e-2)
    # Measured: within 1.1e-3 1/s, the method's own share stated as at most 0.1 of the rate.
    assert found["decided"] and (found["rate"] > 0) == (share > 1)
    assert found["rate"] == pytest.approx(exact(speed), abs=max(2 * found["uncertainty"], 1e-4))
