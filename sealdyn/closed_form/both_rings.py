"""Steady response in tilt of a seal whose rings both float (FMSR), the case that Green's formulas leave open.

The rings, tilts s of the stator and r of the rotor in the fixed frame, s_i and r_i their own misalignments, obey
    I_s s'' + D_s s' + K_s (s - s_i) = -M
    I_r r'' - i J w r' + D_r (r' - i w r) + K_r (r - r_i e^{iwt}) = M
    M = K_f g + D_f (g' - i w/2 g),  g = s - r
At a frequency v each is a spring of complex stiffness, Z_s = K_s - I_s v^2 + i v D_s, Z_r = K_r - I_r v^2 + J w v
+ i (v - w) D_r, Z_f = K_f + i (v - w/2) D_f, and the three stand in a row:
    g = (K_s s_i / Z_s - K_r r_i / Z_r) / (1 + Z_f / Z_s + Z_f / Z_r)
the stator's part at v = 0, the rotor's at v = w.
"""

from typing import NamedTuple

import numpy as np

Real = float | np.ndarray


class TiltingRing(NamedTuple):
    """A ring on its support, in tilt: `transverse_inertia` and `polar_inertia` (kg m^2), `support_stiffness` (N m/rad),
    `support_damping` (N m s/rad)."""

    transverse_inertia: float
    polar_inertia: float
    support_stiffness: float
    support_damping: float


def fmsr_relative_tilts(speed: Real, film_stiffness: Real, film_damping: Real, rotor: TiltingRing,
                        stator: TiltingRing) -> tuple[np.ndarray, np.ndarray]:  # fmt: skip
    """Relative tilt, stator less rotor (rad/rad, complex), of two floating rings: static, per unit own misalignment of
    the stator, and dynamic, per unit own misalignment of the rotor in the frame of the shaft.

    `speed` (rad/s), film stiffness (N m/rad) and damping (N m s/rad) of tilt: scalars or arrays that broadcast.
    Multiplying every term by the same number changes nothing.
    **Source** derived here from the rings of Green (1989), eq. 2, and Green and Etsion (1985); one support infinitely
    stiff leaves their formulas (response.py).
    **Valid** linear film and supports, a stator that stands, steady and stable.
    """
    w = np.asarray(speed, dtype=float)

    def stiffness(ring, spin, frequency):
        gyroscopic = (ring.polar_inertia * spin - ring.transverse_inertia * frequency) * frequency
        return ring.support_stiffness + gyroscopic + 1j * (frequency - spin) * ring.support_damping

    def parts(frequency):
        of_stator, of_rotor = stiffness(stator, 0.0, frequency), stiffness(rotor, w, frequency)
        film = film_stiffness + 1j * (frequency - w / 2) * film_damping
        return of_stator, of_rotor, of_stator * of_rotor + film * (of_stator + of_rotor)

    # Multiplied out: a ring in resonance on its own support has no stiffness to divide by.
    _, behind, whole = parts(0.0 * w)
    static = stator.support_stiffness * behind / whole
    behind, _, whole = parts(w)
    return static, -rotor.support_stiffness * behind / whole
