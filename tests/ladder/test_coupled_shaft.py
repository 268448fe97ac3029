"""A seal and a shaft that two programs step in turn, beside both written down at once and integrated by SciPy."""

import runpy

import numpy as np
import pytest
from command import SCENARIOS
from scipy.integrate import solve_ivp

import sealdyn

# Of the film, and of the seal of Green's stator, SI.
K, D, AXIAL_K, AXIAL_D = 3000.0, 1.5, 4e6, 2000.0
INERTIA, RADIUS, SPRING, DAMPER = 8e-4, 0.04, 5e5, 300.0
END, W = 0.02, 1000.0


def at_once(shaft, end):
    """Tilts (rad) of shaft and stator at the end, complex, of one system of equations.

    Springs around a circle of radius R have the tilt stiffness k R^2/2; the film turns at half the shaft speed."""
    k_s, d_s = 0.5 * SPRING * RADIUS**2, 0.5 * DAMPER * RADIUS**2

    def rates(t, y):
        g, v, s, u = y
        film = K * (s - g) + D * ((u - v) - 0.5j * W * (s - g))
        own = shaft.couple * np.exp(1j * W * t) + 1j * shaft.polar_inertia * W * v
        return [v, (own + film - shaft.damping * v - shaft.stiffness * g) / shaft.inertia,
                u, (-film - d_s * u - k_s * s) / INERTIA]  # fmt: skip

    found = solve_ivp(rates, (0.0, end), np.zeros(4, complex), method="DOP853", rtol=1e-11, atol=1e-18)
    return found.y[0, -1], found.y[2, -1]


@pytest.mark.core
def test_both_in_turn_come_to_what_they_are_at_once():
    """By the square of the step; and the seal is felt."""
    example = runpy.run_path(str(SCENARIOS / "coupled_shaft.py"))
    film = {"tilt_stiffness": K, "tilt_damping": D, "axial_stiffness": AXIAL_K, "axial_damping": AXIAL_D}
    scenario = sealdyn.example("fms_reference").with_({
        "film.model": "linear", "film.coefficients": film, "rotor.runout": 0.0, "stator.misalignment": 0.0,
        "run.accuracy": 1e-8,
    })  # fmt: skip
    shaft, stator = at_once(example["Shaft"](), END)
    misses = []
    for step in (1e-4, 5e-5):
        seal = sealdyn.Simulation(scenario)
        time, tilt, _ = example["coupled"](seal, example["Shaft"](), END, step)
        assert time[-1].real == pytest.approx(END, rel=1e-12)
        own = complex(seal.state["stator_tilt_x"], seal.state["stator_tilt_y"])
        misses.append([abs(tilt[-1] / shaft - 1.0), abs(own / stator - 1.0)])
    assert np.all(np.array(misses[1]) < 2e-3)
    assert np.all((np.divide(*misses) > 3.0) & (np.divide(*misses) < 5.0))
    alone = example["Shaft"]()
    alone.step(0.0, END, lambda past: 0j)
    assert abs(alone.y[0] / shaft - 1.0) > 0.03
