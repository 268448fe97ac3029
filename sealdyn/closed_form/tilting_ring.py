"""Closed forms of one flexible ring in tilt: its steady response, the forcing at which its faces touch, and where it
whirls at half the shaft's frequency.

Every transmissibility takes the same seven keywords, so that one set of numbers serves all of them, whether a formula
uses each or not: `speed` w (rad/s), `transverse_inertia` I and `polar_inertia` J (kg m^2), `support_stiffness` K_s and
`film_stiffness` K_f (N m/rad), `support_damping` D_s and `film_damping` D_f (N m s/rad), of tilt; scalars or arrays
that broadcast.  With K = K_s + K_f, D = D_s + D_f the ring obeys
    FMR: I y'' - i J w y' + D_s (y' - i w y) + K_s (y - y_i e^{iwt}) = K_f g + D_f (g' - i w/2 g)
    FMS: I y'' + D_s y' + K_s (y - y_i) = -K_f g - D_f (g' - i w/2 g)
in the fixed frame, with g = y_s - y (FMR) or y - y_r e^{iwt} (FMS).  Multiplying every term by the same number changes
nothing: dimensionless numbers with speed 1 are as good as SI.

Thresholds of the whirl follow from `lambda = i w_whirl` in the same equation; their arguments are scalar, K > 0 and
D > 0 throughout (ValueError otherwise: ask the eigenvalues).
"""

import math
from typing import Any, NamedTuple

import numpy as np

Real = float | np.ndarray


def _size(amplitude: Any) -> Real:
    # `abs` of a number or an array is an object to a type checker.
    return abs(amplitude)


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
    return _size(relative / (support_stiffness + film_stiffness - entrained))


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
    return _size(support_stiffness / (support_stiffness + film))


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
    return static + dynamic, _size(static - dynamic)


# --- Contact onset -----------------------------------------------------------------------------------


def critical_forcing(contact_tilt: Real, own_response: Real, transmissibility: Real) -> Real:
    """Forcing (rad) at which the relative misalignment reaches the contact tilt (rad).

    `own_response` (rad) is what the ring's own initial misalignment already takes, `transmissibility` (rad/rad) that of
    the forcing; the result is zero or negative when the own response alone touches, and infinite when nothing is
    transmitted.
    **Source** Green (1989), `(1/R - T_own) / T` in units of C/r_o.  **Valid** rings held at the aligned clearance: the
    real seal opens axially as it tilts and touches later.
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


def _together(support: float, film: float, name: str) -> float:
    """K or D, checked."""
    if not support + film > 0:
        raise ValueError(f"support_{name} + film_{name} must be positive for a closed-form threshold")
    return support + film


def fms_whirl_ratio(*, support_damping: float, film_damping: float) -> float:
    """Whirl frequency over shaft speed of a flexible stator at its threshold.  Keywords as the module.

    **Source** Green and Etsion (1985): `(D_f / 2) / (D_s + D_f)`; at most one half.  **Valid** D > 0.
    **Raises** ValueError otherwise.
    """
    return film_damping / 2 / _together(support_damping, film_damping, "damping")


def fmr_whirl_ratio(*, support_damping: float, film_damping: float) -> float:
    """Whirl frequency over shaft speed of a flexible rotor at its threshold, in the fixed frame.  Keywords as the
    module.

    **Source** Green (1989): `(D_s + D_f / 2) / (D_s + D_f)`; at least one half, because the support turns.
    **Valid** D > 0.  **Raises** ValueError otherwise.
    """
    return (support_damping + film_damping / 2) / _together(support_damping, film_damping, "damping")


def unconditional_inertia_ratio(*, support_damping: float, film_damping: float) -> float:
    """Largest c = I/J (transverse over polar inertia) for which a flexible rotor is stable at every speed.  Keywords as
    the module.

    **Source** Green (1989): `c <= 1/nu` with nu the whirl ratio.  **Valid** K > 0, D > 0 (ValueError), nu > 0.
    """
    return 1 / fmr_whirl_ratio(support_damping=support_damping, film_damping=film_damping)


def fms_critical_speed(
    *,
    transverse_inertia: float,
    polar_inertia: float = 0.0,
    support_stiffness: float,
    support_damping: float,
    film_stiffness: float,
    film_damping: float,
) -> float | None:
    """Shaft speed (rad/s) above which a flexible stator whirls; None if it never does: no inertia, or no film damping.

    **Source** Green and Etsion (1985): `2 (1 + D_s/D_f) sqrt(K/I)`.  A stator does not spin: `polar_inertia` is taken
    so that one set of numbers serves both seals, and not used.  Keywords as the module.
    **Valid** K > 0, D > 0 (ValueError), linear film whose coefficients do not change with speed.
    """
    stiffness = _together(support_stiffness, film_stiffness, "stiffness")
    whirl_ratio = fms_whirl_ratio(support_damping=support_damping, film_damping=film_damping)
    if transverse_inertia == 0 or whirl_ratio == 0:
        return None
    return math.sqrt(stiffness / transverse_inertia) / abs(whirl_ratio)


def fmr_critical_speed(
    *,
    transverse_inertia: float,
    polar_inertia: float,
    support_stiffness: float,
    support_damping: float,
    film_stiffness: float,
    film_damping: float,
) -> float | None:
    """Shaft speed (rad/s) above which a flexible rotor whirls; None if it is stable at every speed.  Keywords as the
    module.

    **Source** Green (1989): `sqrt((K/I) / (nu (nu - 1/c)))`, c = I/J.  His Table 1 prints 8.4e3 for c = 3 where this
    formula and the eigenvalues give 8.684e3; K_f in place of K would give 8.399e3.
    **Valid** K > 0, D > 0 (ValueError), linear film whose coefficients do not change with speed.
    """
    stiffness = _together(support_stiffness, film_stiffness, "stiffness")
    whirl_ratio = fmr_whirl_ratio(support_damping=support_damping, film_damping=film_damping)
    # The gyroscopic moment stiffens forward whirl; a short disk outruns its own inertia for good.
    inertial = whirl_ratio * (whirl_ratio * transverse_inertia - polar_inertia)
    return math.sqrt(stiffness / inertial) if inertial > 0 else None


# --- Flow regime --------------------------------------------------------------------------------------

# When a film is no longer laminar, and what its inertia does to it: numbers to hold a run's assumptions against.


def couette_reynolds(density, viscosity, sliding_speed, thickness):
    """Couette Reynolds number rho U h / mu of a film of this `thickness` (m) between faces that slide at
    `sliding_speed` (m/s).
    **Valid** the flow stays laminar below some 1000 and is turbulent beyond some 2000.
    **Source** Constantinescu (1959), Trans. ASME J. Basic Eng. 81, 449.
    """
    return density * abs(sliding_speed) * thickness / viscosity


def poiseuille_reynolds(density, viscosity, flow_per_width):
    """Poiseuille Reynolds number rho q / mu of a `flow_per_width` (m^2/s, mean velocity times film thickness).
    **Valid** the flow stays laminar below some 1000.
    """
    return density * abs(flow_per_width) / viscosity


def centrifugal_pressure(density, stator_speed, rotor_speed, inner_radius, outer_radius):
    """Pressure (Pa) that the spin of a film's fluid builds up from the inner to the outer radius, without flow:
    `rho (3 W_s^2 + 4 W_s W_r + 3 W_r^2)/20 (r_o^2 - r_i^2)`, speeds of both faces in rad/s.
    **Source** the radial momentum of Couette flow, weighed with the profile of the flow it drives.
    """
    spins = 3.0 * stator_speed**2 + 4.0 * stator_speed * rotor_speed + 3.0 * rotor_speed**2
    return density * spins / 20.0 * (outer_radius**2 - inner_radius**2)
