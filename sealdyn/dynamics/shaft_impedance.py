"""What a shaft feels of a seal: film, floating rings and supports in series, as one dynamic stiffness at the shaft.

With H(w) of the film, A of a floating ring alone and S of the support between shaft and rotor, all (3, 3) on (z,
tilt_x, tilt_y) that move as e^{i w t}:

    what the film shows of the stator      H_s = H - H (A_s + H)^-1 H,    H of a rigid one
    at the shaft                           Z = S - S (A_r + H_s)^-1 S,    H_s of a rigid rotor
    A = -w^2 M + i w (D - J W Q) + K - W D Q,    S = i w D + K - W D Q

W the ring's spin, Q a quarter turn of the tilts; the damper of a support turns with its ring.
**Source** derived here: condensation of the rings' equations of modes.py onto the shaft, which moves the base of the
rotor's support; the force is what the shaft has to supply.
**Valid** small motion about aligned faces, supports that are the same about all axes, or stand; the inertia of a rigid
rotor is the shaft's own."""

import numpy as np

from ..scene.rings import ROTOR, STATOR
from .modes import LinearScene, RingNumbers


def at_shaft(linear: LinearScene, frequency: float) -> np.ndarray:
    """Dynamic stiffness (3, 3), complex, at a frequency (rad/s): force (N) and moments (N m) per displacement (m) and
    tilts (rad) of the shaft.  Raises ValueError for a support that turns and is not the same about all axes."""
    if linear.turning:
        raise ValueError("a support that turns with two tilt stiffnesses: no one stiffness at the shaft")
    at = linear.at_frequency(frequency)
    film = at.film_k + 1j * frequency * at.film_d
    stator, rotor = linear.rings[STATOR], linear.rings[ROTOR]
    if stator.floats:
        film = film - film @ np.linalg.solve(_alone(stator, frequency) + film, film)
    if not rotor.floats:
        return film
    support = rotor.support_at(frequency)
    return support - support @ np.linalg.solve(_alone(rotor, frequency) + film, support)


def _alone(ring: RingNumbers, w: float) -> np.ndarray:
    mass, damping, stiffness = ring.alone()
    return stiffness + 1j * w * damping - w**2 * mass
