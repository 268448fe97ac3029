"""Closed forms that a run must confirm: film coefficients, steady response, contact onset, stability.

Dimensional (SI).  Radii, clearances and films in m, angles and coning in rad, pressures in Pa, viscosity in Pa s, axial
stiffness in N/m, axial damping in N s/m, tilt stiffness in N m/rad, tilt damping in N m s/rad, mass in kg, inertia in
kg m^2, speeds in rad/s.  Arguments broadcast over numpy arrays unless a function says scalar.  The clearance is the
film thickness at the inner radius of the aligned seal, `h = clearance + coning (r - inner_radius)`; the pressure drop
is outer minus inner pressure.
"""

from typing import TYPE_CHECKING

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

if TYPE_CHECKING:
    from .green_1989 import (
        GREEN_1989,
        GREEN_1989_ROUNDED,
        GREEN_1989_SEAL,
        Published,
        axial_groups,
        film_groups,
        green_1989_tilt,
        ring_groups,
        seal_parameter,
    )

__all__ = [
    "GREEN_1989",
    "GREEN_1989_ROUNDED",
    "GREEN_1989_SEAL",
    "FilmCoefficients",
    "Published",
    "TiltingRing",
    "axial_groups",
    "centrifugal_pressure",
    "couette_reynolds",
    "critical_forcing",
    "film_coefficients",
    "film_groups",
    "fmr_critical_speed",
    "fmr_dynamic",
    "fmr_static",
    "fmr_whirl_ratio",
    "fms_critical_speed",
    "fms_dynamic",
    "fms_static",
    "fms_whirl_ratio",
    "fmsr_relative_tilts",
    "green_1989_tilt",
    "narrow_seal_opening_force",
    "optimum_coning",
    "poiseuille_reynolds",
    "radial_film_coefficients",
    "ring_groups",
    "seal_parameter",
    "superposed",
    "unconditional_inertia_ratio",
]


def __getattr__(name: str):
    """Green's groups and numbers, of which a run needs none."""
    if name not in __all__:
        raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
    from . import green_1989

    return getattr(green_1989, name)
