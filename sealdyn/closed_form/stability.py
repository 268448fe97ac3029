"""Thresholds of half-frequency whirl of one flexible ring, from `lambda = i w_whirl` in its tilt equation.

Keywords: inertias I, J (kg m^2), tilt stiffness K_s, K_f (N m/rad), tilt damping D_s, D_f (N m s/rad); all scalar.
K = K_s + K_f > 0 and D = D_s + D_f > 0 throughout (ValueError otherwise: ask the eigenvalues).
"""

import math


def _totals(support_stiffness, support_damping, film_stiffness, film_damping) -> tuple[float, float]:
    """K and D, both checked."""
    stiffness, damping = support_stiffness + film_stiffness, support_damping + film_damping
    if not stiffness > 0:
        raise ValueError("support_stiffness + film_stiffness must be positive for a closed-form threshold")
    if not damping > 0:
        raise ValueError("support_damping + film_damping must be positive for a closed-form threshold")
    return stiffness, damping


def fms_whirl_ratio(*, support_damping: float, film_damping: float) -> float:
    """Whirl frequency over shaft speed of a flexible stator at its threshold.  Keywords as the module.

    **Source** Green and Etsion (1985): `(D_f / 2) / (D_s + D_f)`; at most one half.  **Valid** D > 0.
    **Raises** ValueError otherwise.
    """
    return film_damping / 2 / _totals(1.0, support_damping, 0.0, film_damping)[1]


def fmr_whirl_ratio(*, support_damping: float, film_damping: float) -> float:
    """Whirl frequency over shaft speed of a flexible rotor at its threshold, in the fixed frame.  Keywords as the
    module.

    **Source** Green (1989): `(D_s + D_f / 2) / (D_s + D_f)`; at least one half, because the support turns.
    **Valid** D > 0.  **Raises** ValueError otherwise.
    """
    return (support_damping + film_damping / 2) / _totals(1.0, support_damping, 0.0, film_damping)[1]


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
    stiffness, _ = _totals(support_stiffness, support_damping, film_stiffness, film_damping)
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
    stiffness, _ = _totals(support_stiffness, support_damping, film_stiffness, film_damping)
    whirl_ratio = fmr_whirl_ratio(support_damping=support_damping, film_damping=film_damping)
    # The gyroscopic moment stiffens forward whirl; a short disk outruns its own inertia for good.
    inertial = whirl_ratio * (whirl_ratio * transverse_inertia - polar_inertia)
    return math.sqrt(stiffness / inertial) if inertial > 0 else None


def axial_mode_stable(*, support_stiffness: float, film_stiffness: float) -> bool:
    """Whether the aligned ring returns axially: `K_z + K_fz > 0`, both in N/m.  **Valid** linear, damped."""
    return support_stiffness + film_stiffness > 0


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
