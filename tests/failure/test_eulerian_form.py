"""The FMR equations in nutation and precession (Green 1989, eq. 3): the same trajectory, until the tilt is zero.

Division by the nutation is what fails; tilt_x and tilt_y, which the package integrates, do not know of it.
"""

import numpy as np
import pytest
from scenes import INERTIA, MISALIGNMENT, SPEED, SUPPORT, TILT_SCALE, fmr, run
from scipy.integrate import solve_ivp

from sealdyn.closed_form import film_coefficients
from sealdyn.scene.scene import Initial, RingStart

W = SPEED
FILM = film_coefficients(0.032, 0.04, 1e-5, 3.125e-3, 0.5e-3, 5e5)
K_F, D_F = FILM.tilt_stiffness, FILM.tilt_damping
K_S, D_S = SUPPORT.axial_stiffness * SUPPORT.radius**2 / 2, SUPPORT.axial_damping * SUPPORT.radius**2 / 2
OWN = 10e-6
RATES = TILT_SCALE * W


def eulerian(c, fixed=MISALIGNMENT, own=OWN):
    """(nutation, precession, their rates)': eq. 3, the stator's misalignment along xi."""
    j, k, d = INERTIA / c, K_S + K_F, D_S + D_F

    def slopes(t, y):
        nutation, precession, rate, turning = y
        psi = precession - W * t
        inner = -k * nutation - d * rate + K_S * own * np.cos(psi)
        inner += fixed * (K_F * np.cos(precession) - W / 2 * D_F * np.sin(precession)) - j * W * turning * nutation
        across = -d * (turning - W) * nutation - W / 2 * D_F * nutation - K_S * own * np.sin(psi)
        across += -fixed * (K_F * np.sin(precession) + W / 2 * D_F * np.cos(precession)) + j * W * rate
        return [
            rate, turning, inner / INERTIA + turning**2 * nutation,
            (across / INERTIA - 2 * turning * rate) / nutation,
        ]  # fmt: skip

    return slopes


def cartesian(c, fixed=MISALIGNMENT, own=OWN):
    """The same equation on (tilt_x, tilt_y, their rates)."""

    def slopes(t, y):
        g, v = complex(*y[:2]), complex(*y[2:])
        push = K_F * (fixed - g) - D_F * (v + 0.5j * W * (fixed - g))
        push -= D_S * (v - 1j * W * g) + K_S * (g - own * np.exp(1j * W * t))
        a = (push + 1j * INERTIA / c * W * v) / INERTIA
        return [v.real, v.imag, a.real, a.imag]

    return slopes


def in_nutation(g, v):
    """Nutation, precession and their rates of a tilt."""
    turn = v / g
    return [abs(g), np.angle(g), turn.real * abs(g), turn.imag]


@pytest.mark.core
@pytest.mark.parametrize("c", [0.5, 3.0])
def test_eulerian_form_gives_the_same_trajectory(c):
    """Ten turns whose nutation stays above 22 urad: 7e-13 of the tilt scale apart (measured), DOP853 on both."""
    g, v = 30e-6 + 5e-6j, 2e-3j
    start = RingStart(tilt_x=g.real, tilt_y=g.imag, tilt_y_rate=v.imag)
    found = run(fmr("linear", c, own=OWN, initial=Initial(rotor=start)), turns=10, accuracy=1e-9, method="dop853")
    told = solve_ivp(
        eulerian(c), (0, found.times[-1]), in_nutation(g, v), "DOP853", t_eval=found.times, rtol=1e-12, atol=1e-17
    )
    nutation, precession = told.y[:2]
    assert told.status == 0 and nutation.min() > 20e-6
    assert np.max(np.abs(nutation * np.exp(1j * precession) - found.tilt("rotor"))) < 1e-7 * TILT_SCALE
    # The nutation is not just there: it moves by more than half of its start.
    assert np.ptp(nutation) > 4e-6


def passing(miss):
    """Start (complex tilt and rate) of a ring that passes zero tilt at a distance `miss` (rad) after 0.3 ms."""
    back = solve_ivp(cartesian(3.0), (3e-4, 0), [0.0, miss, 0.03, 0.08], "DOP853", rtol=1e-13, atol=1e-20).y[:, -1]
    return complex(*back[:2]), complex(*back[2:])


END = 2e-3


def reference(g, v):
    y = solve_ivp(cartesian(3.0), (0, END), [g.real, g.imag, v.real, v.imag], "DOP853", rtol=1e-13, atol=1e-20).y
    return complex(*y[:2, -1])


def test_a_path_past_zero_costs_an_adaptive_method_twenty_times_as_much():
    """Step control saves the Eulerian form, at 1970 evaluations against 86 (rtol 1e-6); the package does not notice."""
    g, v = passing(0.0)
    scales = [TILT_SCALE, 1.0, RATES, W], [TILT_SCALE, TILT_SCALE, RATES, RATES]
    starts = in_nutation(g, v), [g.real, g.imag, v.real, v.imag]
    told, sound = (
        solve_ivp(form(3.0), (0, END), start, "DOP853", rtol=1e-6, atol=1e-6 * np.array(scale))
        for form, start, scale in zip((eulerian, cartesian), starts, scales, strict=True)
    )
    assert told.nfev > 20 * sound.nfev
    start = RingStart(tilt_x=g.real, tilt_y=g.imag, tilt_x_rate=v.real, tilt_y_rate=v.imag)
    found = run(fmr("linear", 3.0, own=OWN, initial=Initial(rotor=start)), duration=END, accuracy=1e-8, method="dop853")
    assert abs(found.tilt("rotor")[-1] - reference(g, v)) < 1e-8 * TILT_SCALE
