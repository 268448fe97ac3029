"""Accuracy holds for rates, loads, leakage and torque too, also between the steps of stiff scenes."""

import math

import numpy as np
import pytest
from judge import Instants, instants, landed
from scenes import prepared
from scipy.integrate import Radau

from sealdyn.numerics.piecewise_linear import PiecewiseLinear
from sealdyn.scene.excitation import Shaft
from sealdyn.scene.film import Film
from sealdyn.scene.rings import AxialRunout, Rotor, Stator, Support
from sealdyn.scene.scene import Scene
from sealdyn.simulation.certificate import choose_tolerance
from sealdyn.simulation.selection import choose_method
from sealdyn.simulation.verification_run import ErrorScales
from sealdyn.solvers.integrate import solve

SPEED = 787.0
RING = dict(mass=0.1, transverse_inertia=1.2e-4, polar_inertia=1.5e-4, misalignment=3e-5,
            support=Support(axial_stiffness=5e4, axial_damping=2.0, radius=36.2e-3))  # fmt: skip


def thin_film(outer=1.5e5, stator=0.0, runout=()):
    """A light rotor on a flat film of 2 um: its squeeze mode decays ten thousand times faster than it turns."""
    film = Film(model="radial", inner_radius=25.6e-3, outer_radius=36.2e-3, clearance=2e-6, viscosity=1.15e-3,
                outer_pressure=outer, inner_pressure=1.57e6)  # fmt: skip
    return Scene(shaft=Shaft(speed=SPEED), film=film, rotor=Rotor(**RING, axial_runout=list(runout)),
                 stator=Stator(misalignment=8.6e-6, speed=stator))  # fmt: skip


SCENES = {
    "constant": thin_film(),
    "pressure ramp": thin_film(outer=PiecewiseLinear((0.0, 0.005, 0.01), (1.5e5, 1.5e5, 4e5))),
    "axial runout": thin_film(runout=[AxialRunout(order=2.0, amplitude=1e-7)]),
    "stator speed table": thin_film(stator=PiecewiseLinear((0.0, 0.01), (0.0, -400.0))),
}


@pytest.mark.core
@pytest.mark.parametrize("accuracy", [1e-2, 1e-4])
@pytest.mark.parametrize("name", SCENES)
def test_rates_and_loads_between_steps(name, accuracy):
    run, other = (prepared(SCENES[name], 4 * 2 * math.pi / SPEED, accuracy, "rest") for _ in range(2))
    scales, times = ErrorScales(run), instants(np.random.default_rng(1), run, 120)
    truth = landed(other, scales, times, Radau, min(1e-8, accuracy * 1e-4))
    method, _ = choose_method(run)
    trial, errors = choose_tolerance(run, method)
    sink = Instants(scales, times)
    given = {"tolerance": trial.tolerance, "steps": trial.steps} if trial else {}
    solve(run, method, accuracy, sink, errors=errors, **given)
    worst = scales.errors(sink.all(), truth).max(axis=0)
    assert method == "bdf" and np.all(worst < accuracy), worst / accuracy
