"""Closed forms that a run must confirm: film coefficients, steady response, contact onset, stability.

Dimensional (SI).  Radii, clearances and films in m, angles and coning in rad, pressures in Pa, viscosity in Pa s, axial
stiffness in N/m, axial damping in N s/m, tilt stiffness in N m/rad, tilt damping in N m s/rad, mass in kg, inertia in
kg m^2, speeds in rad/s.  Arguments broadcast over numpy arrays unless a function says scalar.  The clearance is the
film thickness at the inner radius of the aligned seal, `h = clearance + coning (r - inner_radius)`; the pressure drop
is outer minus inner pressure.
"""

from .film import (
    FilmCoefficients,
    film_coefficients,
    narrow_seal_opening_force,
    optimum_coning,
    radial_film_coefficients,
)
from .tilting_ring import (
    TiltingRing,
    centrifugal_pressure,
    couette_reynolds,
    critical_forcing,
    fmr_critical_speed,
    fmr_dynamic,
    fmr_static,
    fmr_whirl_ratio,
    fms_critical_speed,
    fms_dynamic,
    fms_static,
    fms_whirl_ratio,
    fmsr_relative_tilts,
    poiseuille_reynolds,
    superposed,
    unconditional_inertia_ratio,
)

__all__ = [
    "FilmCoefficients",
    "TiltingRing",
    "centrifugal_pressure",
    "couette_reynolds",
    "critical_forcing",
    "film_coefficients",
    "fmr_critical_speed",
    "fmr_dynamic",
    "fmr_static",
    "fmr_whirl_ratio",
    "fms_critical_speed",
    "fms_dynamic",
    "fms_static",
    "fms_whirl_ratio",
    "fmsr_relative_tilts",
    "narrow_seal_opening_force",
    "optimum_coning",
    "poiseuille_reynolds",
    "radial_film_coefficients",
    "superposed",
    "unconditional_inertia_ratio",
]
