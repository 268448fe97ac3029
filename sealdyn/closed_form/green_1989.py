"""The reference seal of Green (1989) and what his Table 1 prints, as data.

**Source** Green, I., "Gyroscopic and Support Effects on the Steady-State Response of a Noncontacting Flexibly
Mounted Rotor Mechanical Face Seal", J. Tribology 111 (1989), Table 1 and the example before it.
"""

from typing import Literal, NamedTuple

import numpy as np

# --- Groups --------------------------------------------------------------------------------------

# The dimensionless groups of Green (1989): one seal at one speed as a handful of numbers.
#
# Stiffness is told in S r_o^4 / C, damping in S r_o^4 / (C w), inertia in S r_o^4 / (C w^2), with the seal parameter
# S = 6 mu w (r_o / C)^2 (1 - R)^2 (a pressure), R = r_i / r_o, C the clearance at the inner radius. Seals with equal
# groups answer alike: tilts in C / r_o, time in 1 / w.

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


def axial_groups(*, speed: Real, viscosity: Real, inner_radius: Real, outer_radius: Real, clearance: Real,
                 mass: Real | None = None, stiffness: Real, damping: Real) -> dict[str, Real]:  # fmt: skip
    """Groups of axial motion, 1 each: `stiffness` (N/m) and `damping` (N s/m) of a film or a support, and the `mass`
    (kg) of a ring where it is one.

    **Source** Green (1989), `m = m* w^2 C / (S r_o^2)`, and so stiffness in S r_o^2 / C.  **Valid** as `film_groups`.
    """
    unit = seal_parameter(speed, viscosity, inner_radius, outer_radius, clearance) * outer_radius**2 / clearance
    found = {"stiffness": stiffness / unit, "damping": damping * speed / unit}
    return found if mass is None else found | {"mass": mass * speed**2 / unit}


SOURCE = "Green (1989), Table 1"


class Published(NamedTuple):
    """One printed number: `value` (None: the table says that there is none) of a `quantity` for an `arrangement` and
    `inertia_ratio` c = I/J (None where it does not matter); `last_digit` is one unit of its last printed digit.  Units:
    GREEN_1989."""

    source: str
    quantity: str
    value: float | None  # None: the table says that there is none
    arrangement: Literal["FMR", "FMS"]
    inertia_ratio: float | None  # c = I/J; None where the quantity does not depend on it
    last_digit: float | None


# Transmissibilities are per unit forcing, the maximum for both forcings 1, critical misalignments in units of
# C/r_o with unit own misalignment (of the stator for FMR, runout for FMS), critical speeds in rad/s.
GREEN_1989 = (
    Published(SOURCE, "static_transmissibility", 0.071, "FMR", None, 0.001),
    Published(SOURCE, "dynamic_transmissibility", 0.055, "FMR", 0.5, 0.001),
    Published(SOURCE, "dynamic_transmissibility", 0.066, "FMR", 3.0, 0.001),
    Published(SOURCE, "maximum_relative_misalignment", 0.126, "FMR", 0.5, 0.001),
    Published(SOURCE, "maximum_relative_misalignment", 0.137, "FMR", 3.0, 0.001),
    Published(SOURCE, "critical_misalignment", 16.86, "FMR", 0.5, 0.01),
    Published(SOURCE, "critical_misalignment", 16.76, "FMR", 3.0, 0.01),
    Published(SOURCE, "critical_speed", None, "FMR", 0.5, None),
    Published(SOURCE, "critical_speed", 8.4e3, "FMR", 3.0, 100.0),
    Published(SOURCE, "static_transmissibility", 0.061, "FMS", None, 0.001),
    Published(SOURCE, "dynamic_transmissibility", 0.080, "FMS", None, 0.001),
    Published(SOURCE, "maximum_relative_misalignment", 0.141, "FMS", None, 0.001),
    Published(SOURCE, "critical_misalignment", 14.8, "FMS", None, 0.1),
    Published(SOURCE, "critical_speed", 5.9e3, "FMS", None, 100.0),
)

# SI.  The transverse inertia (m r_o^2 / 2) stays when the inertia ratio changes: polar = transverse / ratio.
GREEN_1989_SEAL = {
    "inner_radius": 0.032,
    "outer_radius": 0.040,
    "clearance": 10e-6,
    "coning": 25e-6 / 8e-3,
    "viscosity": 0.5e-3,
    "pressure_drop": 0.5e6,
    "speed": 1000.0,
    "mass": 1.0,
    "transverse_inertia": 8e-4,
    "axial_support_stiffness": 5e5,
    "axial_support_damping": 300.0,
    "support_radius": 0.040,
}

# The same seal as printed: dimensionless, rounded to the digits given.  Speed 1 stands for 1000 rad/s, so a
# critical speed computed from these comes out in thousands of rad/s.
GREEN_1989_ROUNDED = {
    "speed": 1.0,
    "transverse_inertia": 1.63e-3,
    "support_stiffness": 8.14e-4,
    "support_damping": 4.88e-4,
    "film_stiffness": 0.0118,
    "film_damping": 8.3e-3,
}


def green_1989_tilt(film_stiffness: float, film_damping: float, inertia_ratio: float = 0.5) -> dict[str, float]:
    """The seven keywords of the tilt formulas (tilting_ring.py; SI) for the reference seal on a film of the caller's
    tilt stiffness (N m/rad) and tilt damping (N m s/rad); `inertia_ratio` c = I/J.  Scalar.

    **Source** Green (1989), eqs. 1-2: support at radius r_s, `K_s = K_z r_s^2 / 2`, the same for damping.
    """
    seal = GREEN_1989_SEAL
    half = seal["support_radius"] ** 2 / 2
    return {
        "speed": seal["speed"],
        "transverse_inertia": seal["transverse_inertia"],
        "polar_inertia": seal["transverse_inertia"] / inertia_ratio,
        "support_stiffness": seal["axial_support_stiffness"] * half,
        "support_damping": seal["axial_support_damping"] * half,
        "film_stiffness": film_stiffness,
        "film_damping": film_damping,
    }
