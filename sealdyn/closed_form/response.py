"""Steady response of one flexible ring in tilt, and the forcing at which its faces touch.

Every transmissibility takes the same seven keywords, so that one set of numbers serves all of them, whether a formula
uses each or not: `speed` w (rad/s), `transverse_inertia` I and `polar_inertia` J (kg m^2), `support_stiffness` K_s and
`film_stiffness` K_f (N m/rad), `support_damping` D_s and `film_damping` D_f (N m s/rad), of tilt; scalars or arrays
that broadcast.  With K = K_s + K_f, D = D_s + D_f the ring obeys
    FMR: I y'' - i J w y' + D_s (y' - i w y) + K_s (y - y_i e^{iwt}) = K_f g + D_f (g' - i w/2 g)
    FMS: I y'' + D_s y' + K_s (y - y_i) = -K_f g - D_f (g' - i w/2 g)
in the fixed frame, with g = y_s - y (FMR) or y - y_r e^{iwt} (FMS).  Multiplying every term by the same number changes
nothing: dimensionless numbers with speed 1 are as good as SI.
"""

from typing import NamedTuple

import numpy as np

Real = float | np.ndarray


def fmr_static(
    *,
    speed: Real,
    transverse_inertia: Real,
    polar_inertia: Real,
    support_stiffness: Real,
    support_damping: Real,
    film_stiffness: Real,
    film_damping: Real,
) -> Real:
    """Relative misalignment of a flexible rotor per unit fixed stator misalignment, rad/rad.  Keywords as the module.

    **Source** Green (1989), steady response to the stator: `|K_s - i D_s w| / |K - i (D_s + D_f/2) w|`.
    **Valid** linear film and support, steady and stable.
    """
    relative = support_stiffness - 1j * support_damping * speed
    entrained = 1j * (support_damping + film_damping / 2) * speed
    return abs(relative / (support_stiffness + film_stiffness - entrained))


def fmr_absolute_static(
    *,
    speed: Real,
    transverse_inertia: Real,
    polar_inertia: Real,
    support_stiffness: Real,
    support_damping: Real,
    film_stiffness: Real,
    film_damping: Real,
) -> Real:
    """Absolute tilt of a flexible rotor per unit fixed stator misalignment, rad/rad; 1 is perfect tracking.  Keywords
    as the module.

    **Source** Green (1989): `|K_f - i w D_f/2| / |K - i (D_s + D_f/2) w|`.  **Valid** as `fmr_static`.
    """
    drive = film_stiffness - 0.5j * film_damping * speed
    entrained = 1j * (support_damping + film_damping / 2) * speed
    return abs(drive / (support_stiffness + film_stiffness - entrained))


def fmr_dynamic(
    *,
    speed: Real,
    transverse_inertia: Real,
    polar_inertia: Real,
    support_stiffness: Real,
    support_damping: Real,
    film_stiffness: Real,
    film_damping: Real,
) -> Real:
    """Relative misalignment of a flexible rotor per unit own initial misalignment, rad/rad; it turns with the shaft.
    Keywords as the module.

    **Source** Green (1989): `K_s / |(J - I) w^2 + K + i w D_f/2|`; support damping drops out because the response
    stands still in the shaft.  **Valid** as `fmr_static`.
    """
    inertial = (polar_inertia - transverse_inertia) * speed**2
    film = film_stiffness + 0.5j * film_damping * speed
    return abs(support_stiffness / (inertial + support_stiffness + film))


def fms_static(
    *,
    speed: Real,
    transverse_inertia: Real,
    polar_inertia: Real,
    support_stiffness: Real,
    support_damping: Real,
    film_stiffness: Real,
    film_damping: Real,
) -> Real:
    """Relative misalignment of a flexible stator per unit own initial misalignment, rad/rad; it stands still.  Keywords
    as the module.

    **Source** Green and Etsion (1985), Green (1989): `K_s / |K - i w D_f/2|`.  **Valid** as `fmr_static`.
    """
    film = film_stiffness - 0.5j * film_damping * speed
    return abs(support_stiffness / (support_stiffness + film))


def fms_dynamic(
    *,
    speed: Real,
    transverse_inertia: Real,
    polar_inertia: Real,
    support_stiffness: Real,
    support_damping: Real,
    film_stiffness: Real,
    film_damping: Real,
) -> Real:
    """Relative misalignment of a flexible stator per unit rotor runout, rad/rad; it turns with the shaft.  Keywords as
    the module.

    **Source** Green and Etsion (1985), Green (1989): `|K_s - I w^2 + i w D_s| / |K - I w^2 + i w (D_s + D_f/2)|`.
    **Valid** as `fmr_static`.
    """
    ring = support_stiffness - transverse_inertia * speed**2 + 1j * support_damping * speed
    return abs(ring / (ring + film_stiffness + 0.5j * film_damping * speed))


def superposed(static: Real, dynamic: Real) -> tuple[Real, Real]:
    """Largest and smallest relative misalignment of a constant vector (`static`) plus a turning one (`dynamic`), once a
    turn each; in the unit of the two (rad).

    **Source** Green (1989); triangle inequality.  **Valid** linear response to both forcings at once.
    """
    return static + dynamic, abs(static - dynamic)


# --- Contact onset -----------------------------------------------------------------------------------


def critical_tilt_inner(clearance: Real, inner_radius: Real) -> Real:
    """Relative tilt (rad) at which the inner edges touch; arguments in m.  **Valid** rings held at the aligned
    clearance."""
    return clearance / inner_radius


def critical_tilt_outer(inner_radius: Real, outer_radius: Real, clearance: Real, coning: Real) -> Real:
    """Relative tilt (rad) at which the outer edges touch; arguments in m, coning in rad.  **Valid** as
    `critical_tilt_inner`."""
    return (clearance + coning * (outer_radius - inner_radius)) / outer_radius


def critical_coning(clearance: Real, inner_radius: Real) -> Real:
    """Coning (rad) at which both edges touch at once; above it the inner edge touches first, and the narrow film is
    stiff against tilt.  Arguments in m.

    **Source** Green and Etsion (1985), `b = 1/R` with `b = coning r_o / C`.  **Valid** flat cones.
    """
    return clearance / inner_radius


def contact_tilt(inner_radius: Real, outer_radius: Real, clearance: Real, coning: Real) -> Real:
    """Relative tilt (rad) at which the faces first touch, at whichever edge; arguments in m, coning in rad.

    **Source** Green (1989): inner edge above the critical coning, outer edge below.  The film is linear in the radius,
    so an edge is always the thinnest place.
    **Valid** small perturbation: the real seal opens axially as it tilts and touches later.
    """
    return np.minimum(
        critical_tilt_inner(clearance, inner_radius),
        critical_tilt_outer(inner_radius, outer_radius, clearance, coning),
    )


def critical_forcing(contact_tilt: Real, own_response: Real, transmissibility: Real) -> Real:
    """Forcing (rad) at which the relative misalignment reaches the contact tilt (rad).

    `own_response` (rad) is what the ring's own initial misalignment already takes, `transmissibility` (rad/rad) that of
    the forcing; the result is zero or negative when the own response alone touches, and infinite when nothing is
    transmitted.
    **Source** Green (1989), `(1/R - T_own) / T` in units of C/r_o.  **Valid** as `contact_tilt`.
    """
    with np.errstate(divide="ignore", invalid="ignore"):
        return np.divide(np.subtract(contact_tilt, own_response), transmissibility)


# --- Both rings ----------------------------------------------------------------------------------------

# A seal whose rings both float (FMSR), the case that Green's formulas leave open: tilts s of the stator and r of the
# rotor in the fixed frame, s_i and r_i their own misalignments, obey
#     I_s s'' + D_s s' + K_s (s - s_i) = -M
#     I_r r'' - i J w r' + D_r (r' - i w r) + K_r (r - r_i e^{iwt}) = M
#     M = K_f g + D_f (g' - i w/2 g),  g = s - r
# At a frequency v each is a spring of complex stiffness, Z_s = K_s - I_s v^2 + i v D_s, Z_r = K_r - I_r v^2 + J w v
# + i (v - w) D_r, Z_f = K_f + i (v - w/2) D_f, and the three stand in a row:
#     g = (K_s s_i / Z_s - K_r r_i / Z_r) / (1 + Z_f / Z_s + Z_f / Z_r)
# the stator's part at v = 0, the rotor's at v = w.


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
    stiff leaves their formulas.
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
