"""The dimensionless groups of Green (1989): one seal at one speed as a handful of numbers.

Stiffness is told in S r_o^4 / C, damping in S r_o^4 / (C w), inertia in S r_o^4 / (C w^2), with the seal parameter
S = 6 mu w (r_o / C)^2 (1 - R)^2 (a pressure), R = r_i / r_o, C the clearance at the inner radius.  Seals with equal
groups answer alike: tilts in C / r_o, time in 1 / w.
"""

import numpy as np

Real = float | np.ndarray


def seal_parameter(speed: Real, viscosity: Real, inner_radius: Real, outer_radius: Real, clearance: Real) -> Real:
    """Seal parameter S (Pa), `6 mu w (r_o/C)^2 (1 - R)^2`: the pressure that the others are told in.  Speed in rad/s,
    viscosity in Pa s, lengths in m.

    **Source** Green (1989), nomenclature.  **Valid** w > 0.
    """
    return 6 * viscosity * speed * ((outer_radius - inner_radius) / clearance) ** 2


def film_groups(*, speed: Real, viscosity: Real, inner_radius: Real, outer_radius: Real, clearance: Real, coning: Real,
                pressure_drop: Real, film_stiffness: Real, film_damping: Real) -> dict[str, Real]:  # fmt: skip
    """Groups of faces and film: `radius_ratio` R, `coning` b = coning r_o / C, `pressure_drop` over S, tilt stiffness
    `film_stiffness` and tilt damping `film_damping`; 1 each, and `seal_parameter` S in Pa.

    **Source**, **Valid** as the module, w > 0.  SI, coefficients of tilt.
    """
    s = seal_parameter(speed, viscosity, inner_radius, outer_radius, clearance)
    unit = s * outer_radius**4 / clearance
    return {
        "seal_parameter": s,
        "radius_ratio": inner_radius / outer_radius,
        "coning": coning * outer_radius / clearance,
        "pressure_drop": pressure_drop / s,
        "film_stiffness": film_stiffness / unit,
        "film_damping": film_damping * speed / unit,
    }


def ring_groups(*, speed: Real, viscosity: Real, inner_radius: Real, outer_radius: Real, clearance: Real,
                transverse_inertia: Real, polar_inertia: Real, support_stiffness: Real, support_damping: Real,
                ) -> dict[str, Real]:  # fmt: skip
    """Groups of a ring on its support, 1 each: `transverse_inertia`, `inertia_ratio` c = I / J (inf without polar
    inertia), `support_stiffness` and `support_damping` of tilt.

    **Source**, **Valid** as `film_groups`.
    """
    s = seal_parameter(speed, viscosity, inner_radius, outer_radius, clearance)
    unit = s * outer_radius**4 / clearance
    return {
        "transverse_inertia": transverse_inertia * speed**2 / unit,
        "inertia_ratio": transverse_inertia / polar_inertia if polar_inertia else np.inf,
        "support_stiffness": support_stiffness / unit,
        "support_damping": support_damping * speed / unit,
    }
