"""Coulomb friction: a ring that rubs itself to rest; a smoothed sign of the sliding speed lets it creep away."""

import math
from dataclasses import replace

from ....analysis.sources.green_1989 import reference_scene
from ....scene.rings import RING_NAMES, Rotor, SecondarySeal
from ._common import ZERO_FILM, integrated, row, run_from

ITEM = 4
FRICTION, START, CYCLES, ACCURACY = 0.31, 5e-6, 12, 1e-6
# Width of the smoothed sign (m/s); the largest sliding speed is 3.5 mm/s.
WIDTH = 1e-4


def off_rest(seal) -> tuple[float, int]:
    """How far (clearances) from where friction stops it the ring stands in the end, and right-hand sides."""
    scene = reference_scene("FMS")
    support = replace(scene.stator.support, axial_damping=0.0)
    stator = replace(scene.stator, support=support, secondary_seal=seal)
    film = replace(scene.film, model="linear", coefficients=ZERO_FILM)
    scene = replace(scene, film=film, stator=stator, rotor=Rotor())
    natural = math.sqrt(support.axial_stiffness / stator.mass)
    run = run_from(scene, CYCLES * 2 * math.pi / natural, ACCURACY, stator_z=START)
    outcome, _ = integrated(run, "adams", ACCURACY)
    # Amplitude falls by 2 F/k each half cycle, until the spring is weaker than friction.
    rest, dead = START, FRICTION / support.axial_stiffness
    while abs(rest) > dead:
        rest = -math.copysign(abs(rest) - 2 * dead, rest)
    return abs(outcome.y[0] - rest) / run.model.clearance, outcome.counts.rhs


def meets(scene, run) -> str:
    """A ring on an O-ring."""
    held = [RING_NAMES[k] for k in run.model.unknowns.seals]
    return f"[{held[0]}.secondary_seal]: the ring sticks and slips" if held else ""


def show() -> list[dict]:
    """Error of the resting place after twelve periods."""
    smooth, calls = off_rest(SecondarySeal(radius=0.045, friction_force=FRICTION, law="regularised", width=WIDTH))
    real, fewer = off_rest(SecondarySeal(radius=0.045, friction_force=FRICTION))
    return [
        row(
            ITEM, "Coulomb friction", (f"sign smoothed over 0.1 mm/s creeps ({calls} right-hand sides)", smooth),
            (f"real sticking stands ({fewer})", real), "resting place, of clearance",
            'sticks at exactly zero speed and slips when the load exceeds friction (law = "coulomb")',
        )
    ]  # fmt: skip
