"""Chaos: two correct runs of a rubbing ring part exponentially; their averages agree."""

import math
from dataclasses import replace

import numpy as np

from ....analysis.sources.green_1989 import reference_scene
from ....dynamics.modes import verdict
from ....dynamics.signals import signals
from ....numerics.piecewise_linear import PiecewiseLinear
from ....scene.contact import Contact
from ....solvers.contract import Status
from ._common import integrated, row, run_from

ITEM = 9
RAMP, TURNS, SETTLED, PER_TURN, ACCURACIES = 0.05, 130, 40, 16, (1e-5, 1e-7)


def rubbing():
    """Green's ring as a misaligned stator at 2.6 times its resonance, in a thin fluid between rough hard faces, under a
    runout of 0.55 mrad (the scene of scenarios/rub_chaotic.toml)."""
    scene = reference_scene("FMS", 0.5, speed=2442.0)
    support = replace(scene.stator.support, axial_damping=150.0)
    film = replace(scene.film, model="radial", viscosity=0.04e-3, outer_pressure=0.3e5)
    return replace(
        scene,
        film=film,
        stator=replace(scene.stator, support=support, misalignment=PiecewiseLinear((0.0, RAMP), (0.0, 3e-3))),
        rotor=replace(scene.rotor, runout=PiecewiseLinear((0.0, RAMP), (0.0, 0.55e-3))),
        contact=Contact(roughness=1e-6, compressive_strength=1e9, friction_coefficient=0.1),
    )


def followed(accuracy: float):
    """Tilt over its scale once a turn, and film over the clearance, after the ramp."""
    scene = rubbing()
    turn = 2 * math.pi / scene.shaft.speed
    run = run_from(scene, TURNS * turn, accuracy)
    outcome, recorder = integrated(run, "adams", accuracy, turn / PER_TURN)
    if outcome.status != Status.OK:
        raise RuntimeError(outcome.message)
    t, q, rate = recorder.arrays()
    late = t > t[-1] - (TURNS - SETTLED) * turn
    last = run.segment(-1)
    h_min = signals(last, t[late] - last.time, q[late], rate[late])["h_min"] / run.model.clearance
    x = run.model.unknowns.names.index("stator_tilt_x")
    return (q[late, x] + 1j * q[late, x + 1])[::PER_TURN] * run.model.face[1] / run.model.clearance, h_min


def meets(scene, run) -> str:
    """Asperities on which an unstable ring lands."""
    if run.model.contact is None or verdict(run.model.linear_scene().modes()) != "unstable":
        return ""
    return "an unstable ring with [contact]: it may hit its asperities without end"


def show() -> list[dict]:
    """How far apart once a turn in the end, and in the mean film thickness."""
    (one, film), (other, film_other) = (followed(accuracy) for accuracy in ACCURACIES)
    spread = np.std(other)
    apart = np.abs(one[: len(other)] - other[: len(one)])[-50:].max() / spread
    averages = abs(film.mean() - film_other.mean()) / film_other.std()
    return [
        row(
            ITEM, "Chaos", ("single runs, accuracies 1e-5 and 1e-7", apart),
            (f"their mean film over {TURNS - SETTLED} turns", averages), "apart, in standard deviations of the motion",
            "measures the exponent in study rub, says where forecasts end, and compares averages beyond",
        )
    ]  # fmt: skip
