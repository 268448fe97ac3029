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
    """Restoring moment per relative tilt."""
    tilt_damping: SignedTiltDamping
    """Moment per relative tilt rate."""
    axial_stiffness: AxialFilmStiffness
    """Force per change of film thickness."""
    axial_damping: AxialFilmDamping
    """Force per rate of film thickness."""


@dataclass(frozen=True)
class Film:
    """The `[film]` table: faces, fluid, pressures and the rung of the ladder."""

    __pydantic_config__ = {"extra": "forbid"}  # noqa: RUF012

    inner_radius: Length
    """Inner radius of the narrower face."""
    outer_radius: Length
    """Outer radius of the narrower face."""
    viscosity: Varying[Viscosity]
    """Dynamic viscosity, the same over the face."""
    outer_pressure: Varying[Pressure]
    """Absolute, at the outer radius."""
    inner_pressure: Varying[Pressure]
    """Absolute, at the inner radius."""
    model: str = "auto"
    """"auto": the linear film where its estimated error is within the accuracy, else the radial or profiled one."""
    geometry: Literal["cylindrical", "planar"] = "cylindrical"
    """Radial flow on the ring, or the narrow-seal limit without curvature."""
    tilt_radius: Literal["local", "mean"] = "local"
    """Tilt moves the film by local radius times tilt, or everywhere as at the mean radius."""
    clearance: Length | None = None
    """Film thickness of the aligned faces at the inner radius; without it [closing] decides."""
    coning: Angle = 0.0
    """Slope of the faces: the film is thicker outwards where positive."""
    density: Density = 1000.0
    """For mass flow and heating of the leakage only."""
    specific_heat: SpecificHeat = 4180.0
    """For heating of the leakage only."""
    cavitation_pressure: Pressure | None = None
    """Floor of the film pressure, absolute; none without it.  Does not conserve mass."""
    coefficients: Literal["green", "radial"] | Coefficients = "green"
    """Of model = "linear": Green's narrow-seal ones, those of the radial film, or the numbers of a table."""
    floor: float = 1e-3
    """Share of the clearance below which the film counts as collapsed."""
    profile: Profile | None = None
    """Faces that are no plain cones."""
