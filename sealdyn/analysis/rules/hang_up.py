"""Hang-up: the spring against secondary-seal friction and the inertia of following axial runout."""

import math

import numpy as np

from ...dynamics.intervals import constant_and_slope
from ...scene.rings import RING_NAMES
from ._finding import missing, other_seals, within

SOURCE = "spring load against friction and inertia"
COMMAND = "sealdyn run FILE"

# Looks at one turn of the runout, and turns looked at when an order is no integer.
POINTS, TURNS = 2000, 20


def finding(seal):
    """Pass if the spring beats what the ring needs to follow the rotor."""
    scene = seal.scene
    if scene.rotor.support or not scene.stator.support:
        return other_seals("the rotor floats, which carries its axial runout itself")
    if not scene.rotor.axial_runout:
        return missing("rotor.axial_runout")
    if scene.closing.spring_force is None:
        return missing("closing.spring_force")
    (found,) = followability(seal.model)
    numbers = {key: found[key] for key in ("ring", "available", "needed", "friction", "inertia", "holds")}
    # To be equal is not enough.
    least = math.nextafter(found["needed"], math.inf)
    return within(found["said"], found["available"], "N", least=least, **numbers)


def followability(model) -> list[dict]:
    """Whether the spring keeps a flexible stator on a rotor that runs out axially (hang-up).

    The ring follows z_r = sum of a_n cos(n phi + e_n) if what closes it beats the friction of its secondary seal, its
    inertia and the change of its support springs at every angle: F > -m z_r'' - k z_r + F_f where it moves away.
    **Source** Hayden & Keller (1974): the spring load must exceed secondary-seal friction plus the inertia of following
    the runout.  **Valid** balanced or absent pressures, no film force, constant speed, only the stator floats.
    Returns one dict, or none where there is nothing to follow: `rule`, `ring`, `available` (spring, N), `needed` (N),
    `friction`, `inertia` (N), `holds`, `said`.
    """
    scene = model.scene
    floating = [k for k, floats in model.unknowns.floats.items() if floats]
    if len(floating) != 1 or not scene.rotor.axial_runout or scene.closing.spring_force is None:
        return []
    k = floating[0]
    ring = (scene.stator, scene.rotor)[k]
    spring = constant_and_slope(scene.closing.spring_force, model.start)[0]
    speed = constant_and_slope(scene.shaft.speed, model.start)[0]
    friction = ring.secondary_seal.breakaway()[0] if ring.secondary_seal else 0.0
    whole = all(float(r.order).is_integer() for r in scene.rotor.axial_runout)
    phi = np.linspace(0, 2 * math.pi * (1 if whole else TURNS), POINTS * (1 if whole else TURNS))
    z, rate, acceleration = (np.zeros_like(phi) for _ in range(3))
    for runout in scene.rotor.axial_runout:
        w = runout.order * speed
        angle = runout.order * phi + runout.phase
        z += runout.amplitude * np.cos(angle)
        rate -= runout.amplitude * w * np.sin(angle)
        acceleration -= runout.amplitude * w * w * np.cos(angle)
    # A rotor that carries the runout itself has nothing to follow.
    if k != 0:
        return []
    pull = -ring.mass * acceleration - ring.support.axial_stiffness * z
    needed = float(np.max(np.where(rate <= 0, pull + friction, pull - friction)))
    inertia = float(np.max(ring.mass * np.abs(acceleration)))
    holds = spring > needed
    text = (
        f"spring {spring:.4g} N {'exceeds' if holds else 'does not exceed'} the {needed:.4g} N that the "
        f"{RING_NAMES[k]} needs to follow the axial runout (secondary-seal friction {friction:.4g} N, inertia "
        f"{inertia:.4g} N, support springs): " + ("the faces stay together" if holds else "the faces part (hang-up)")
    )
    return [{"rule": "hang-up", "ring": RING_NAMES[k], "available": spring, "needed": needed, "friction": friction,
             "inertia": inertia, "holds": holds, "said": text}]  # fmt: skip
