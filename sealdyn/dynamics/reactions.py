"""What a seal does to shaft and housing: force and moments of the ring that each carries, by its springs, dampers and
secondary seal, or of the film itself on a ring that is rigid with it.

    on a carrier of a floating ring   K (z - z_c) + D (z' - z_c') - friction,  and of the tilts the same
    on a rigid one                    +-(film + contact - closing force),  +-(moments of film and contact)

**Source** the supports of equations.py, seen from their other end.
**Valid** beside the steady thrust of closing force and film, which balance each other at rest; inertia and weight of a
rigid ring are the carrier's own.
"""

import numpy as np

from ..faces.geometry import CONTACT_FORCE, CONTACT_X, CONTACT_Y, FORCE, MOMENT_X, MOMENT_Y, ROTOR_ANGLE, STATOR_ANGLE
from . import equations
from .imposed_motion import OWN_X, OWN_Y, PER_RING, TILT_X, TILT_X_RATE, TILT_Y, TILT_Y_RATE, Z_RATE, Z
from .intervals import constant_and_slope

# In the order of the rings.
CARRIERS = ("housing", "shaft")
# Unit, what it is.
PARTS = {
    "force": ("N", "axial force"),
    "moment_x": ("N m", "moment about the x axis"),
    "moment_y": ("N m", "moment about the y axis"),
}


def reactions(at) -> dict[str, np.ndarray]:
    """Force (N) along z and moments (N m) about x and y, each (m,), on "shaft" and "housing" at the Samples of
    signals.py."""
    found = {}
    for k, carrier in enumerate(CARRIERS):
        parts = _through_support(at, k) if at.segment.model.unknowns.floats[k] else _of_film(at, k)
        found |= {f"{carrier}_{name}": part for name, part in zip(PARTS, parts, strict=True)}
    return found


def _of_film(at, k):
    """Force and moments on a ring that is rigid with its carrier."""
    sign, gap = 1.0 if k == 0 else -1.0, at.gap
    force = gap[:, FORCE] + gap[:, CONTACT_FORCE] - at.closing_force
    return sign * force, sign * (gap[:, MOMENT_X] + gap[:, CONTACT_X]), sign * (gap[:, MOMENT_Y] + gap[:, CONTACT_Y])


def _through_support(at, k):
    """Force and moments through the support and the secondary seal of ring k."""
    ring = at.segment.p[equations.RING * k : equations.RING * (k + 1)]
    own, carrier, seal = equations.OWN_STATE + 6 * k, PER_RING * k, equations.SEALS + equations.PER_SEAL * k
    scene, w = at.segment.model.scene, at.scratch
    speed, slope = constant_and_slope((scene.stator, scene.shaft)[k].speed, at.segment.interval)
    spin = speed + slope * at.taus

    def apart(part):
        return w[:, own + part] - w[:, carrier + part]

    d_x, d_y = apart(TILT_X), apart(TILT_Y)
    e_x, e_y = d_x - w[:, carrier + OWN_X], d_y - w[:, carrier + OWN_Y]
    twice = 2.0 * (at.gap[:, STATOR_ANGLE if k == 0 else ROTOR_ANGLE] + ring[equations.AXIS])
    uneven, cos, sin = ring[equations.UNEVEN_K], np.cos(twice), np.sin(twice)
    stiffness, damping = ring[equations.TILT_K], ring[equations.TILT_D]
    force = ring[equations.AXIAL_K] * apart(Z) + ring[equations.AXIAL_D] * apart(Z_RATE)
    moment_x = stiffness * e_x + uneven * (cos * e_x + sin * e_y) + damping * (apart(TILT_X_RATE) + spin * d_y)
    moment_y = stiffness * e_y + uneven * (sin * e_x - cos * e_y) + damping * (apart(TILT_Y_RATE) - spin * d_x)
    if ring[equations.SEAL_LINE] == 0.0:
        return force, moment_x, moment_y
    return force - w[:, seal], moment_x - w[:, seal + 1], moment_y - w[:, seal + 2]
