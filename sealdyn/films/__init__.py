"""Films: one file per rung of the ladder, found by file name.

What every film module offers (the contract):

`RUNG`            int, its place on the ladder (1 linear, 2 radial, ...); "auto" climbs it.
`UNKNOWNS`        number of unknowns the film owns; 0 for an algebraic law.
`parameters(film, clearance)`
                  float64 array: the film's block of the parameter array, for a `Film` table and the
                  design clearance (m).  The kernels below get this block.
`opening_force(film, clearance, inner_pressure, outer_pressure)`
                  force (N) of the aligned film at rest, for the equilibrium.
`wrench(f, s)`    compiled kernel: film block `f`, gap state `s` (slots named in gap.py) -> writes
                  force and moments on the stator into `s`.
`flow(f, s)`      compiled kernel: as `wrench`, and also leakage, friction torque into `s`.

A film never asks which ring floats, and imports no other film.
"""

from dataclasses import dataclass
from typing import Literal

from ..units import (
    Angle,
    AxialFilmDamping,
    AxialFilmStiffness,
    Density,
    Length,
    Pressure,
    SignedTiltDamping,
    SignedTiltStiffness,
    SpecificHeat,
    Varying,
    Viscosity,
)
from ._profile import Profile, aligned_gaps, faults

__all__ = ["Coefficients", "Film", "Profile", "aligned_gaps", "faults"]


@dataclass(frozen=True)
class Coefficients:
    """A linear film in the user's own numbers (a vendor's, a test's): forces fall by `stiffness` times
    displacement and `damping` times rate.  `cross` terms follow from the wedge, mean spin times damping."""

    __pydantic_config__ = {"extra": "forbid"}  # noqa: RUF012

    tilt_stiffness: SignedTiltStiffness
    tilt_damping: SignedTiltDamping
    axial_stiffness: AxialFilmStiffness
    axial_damping: AxialFilmDamping


@dataclass(frozen=True)
class Film:
    """The `[film]` table: faces, fluid, pressures and the rung of the ladder."""

    __pydantic_config__ = {"extra": "forbid"}  # noqa: RUF012

    inner_radius: Length
    outer_radius: Length
    viscosity: Varying[Viscosity]
    outer_pressure: Varying[Pressure]
    inner_pressure: Varying[Pressure]
    model: str = "auto"
    geometry: Literal["cylindrical", "planar"] = "cylindrical"
    tilt_radius: Literal["local", "mean"] = "local"
    clearance: Length | None = None
    coning: Angle = 0.0
    density: Density = 1000.0
    specific_heat: SpecificHeat = 4180.0
    cavitation_pressure: Pressure | None = None
    coefficients: Literal["green", "radial"] | Coefficients = "green"
    floor: float = 1e-3
    profile: Profile | None = None
