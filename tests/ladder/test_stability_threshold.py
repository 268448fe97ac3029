"""Just below and above the critical speed: growth or decay in time, at the rate the eigenvalues say."""

from dataclasses import replace

import numpy as np
import pytest
from oracles import tilt_roots
from scenes import INERTIA, SUPPORT, fmr, fms, run

from sealdyn.closed_form import film_coefficients, fmr_critical_speed, fms_critical_speed
from sealdyn.dynamics.model import Model
from sealdyn.dynamics.modes import verdict
from sealdyn.scene.scene import Initial, RingStart
from sealdyn.simulation import stability

FILM = film_coefficients(0.032, 0.04, 1e-5, 3.125e-3, 0.5e-3, 5e5)
K_S, D_S = SUPPORT.tilt()
NUMBERS = dict(
    transverse_inertia=INERTIA, polar_inertia=INERTIA / 3, support_stiffness=K_S, support_damping=D_S,
    film_stiffness=FILM.tilt_stiffness, film_damping=FILM.tilt_damping,
)  # fmt: skip
CRITICAL = {"fms": fms_critical_speed(**NUMBERS), "fmr": fmr_critical_speed(**NUMBERS)}
# An aligned seal, nudged by a thousandth of the clearance.
NUDGE = RingStart(tilt_x=2.5e-7)


def scene(kind, speed):
    if kind == "fms":
        return fms("linear", 3.0, speed=speed, own=0.0, runout=0.0, initial=Initial(stator=NUDGE))
    return fmr("linear", 3.0, speed=speed, own=0.0, fixed=0.0, initial=Initial(rotor=NUDGE))


def eigenvalues(kind, speed):
    """Roots of the ring's complex equation."""
    film, flexible = dict(k=FILM.tilt_stiffness, d=FILM.tilt_damping), {"fms": "stator", "fmr": "rotor"}[kind]
    return tilt_roots(speed, flexible, inertia=INERTIA, polar=INERTIA / 3, k_s=K_S, d_s=D_S, **film)


@pytest.mark.parametrize("method", ["adams", "bdf", "ida", "dop853"])
@pytest.mark.parametrize("share", [0.99, 1.01])
@pytest.mark.parametrize("kind", ["fms", "fmr"])
def test_verdict_and_rate_either_side(kind, share, method):
    speed = share * CRITICAL[kind]
    found = run(scene(kind, speed), turns=120, accuracy=1e-8, method=method, per_turn=8)
    slowest = max(eigenvalues(kind, speed), key=lambda value: value.real)
    modes = found.ready.model.linear_scene().modes()
    assert modes[0].value == pytest.approx(slowest, rel=1e-8)
    assert verdict(modes) == ("stable" if share < 1 else "unstable")
    # After twenty turns the damped root is gone: one exponential is left.
    late = found.times > found.times[-1] / 6
    tilt = found.tilt("stator" if kind == "fms" else "rotor")[late]
    rate = np.polyfit(found.times[late], np.log(np.abs(tilt)), 1)[0]
    turning = np.polyfit(found.times[late], np.unwrap(np.angle(tilt)), 1)[0]
    # An undamped circular whirl costs the error of one radian: rates to 1e-6 of the whirl's frequency.
    assert rate == pytest.approx(slowest.real, abs=1e-6 * abs(slowest.imag))
    assert turning == pytest.approx(slowest.imag, rel=1e-6)
    assert (rate > 0) == (share > 1)


@pytest.mark.core
@pytest.mark.parametrize("lighter", [1e-8, 1e-6, 1e-3, 1.0, 1e3])
@pytest.mark.parametrize("speed", [1.0, 1000.0, 1e5])
def test_critical_speed_is_found_however_overdamped_the_ring(lighter, speed):
    """A ring 1e8 times lighter decays at rates from 1.4e3 to 5e11 1/s: a thousandth of the fastest lies beyond the
    threshold, 6e7 rad/s."""
    seal = NUMBERS | {name: lighter * NUMBERS[name] for name in ("transverse_inertia", "polar_inertia")}
    made = scene("fms", speed)
    light = replace(made.stator, transverse_inertia=seal["transverse_inertia"], polar_inertia=seal["polar_inertia"])
    found = stability.critical_speed(Model(replace(made, stator=light)))
    assert found == pytest.approx(fms_critical_speed(**seal), rel=1e-6)
