"""The `[film]` table: faces, fluid and pressures; and the profile of faces that are not plain cones: worn ones, or any
other shape that is the same all around."""

import math
from dataclasses import dataclass
from itertools import pairwise
from typing import Annotated, Any, Literal

from ..units import (
    Angle,
    AxialFilmDamping,
    AxialFilmStiffness,
    Density,
    Length,
    Pressure,
    Quantity,
    QuantityError,
    SignedTiltDamping,
    SignedTiltStiffness,
    SpecificHeat,
    Varying,
    Viscosity,
    quoted,
)

# Most radii of a profile: kernels keep room for them.
MOST_NODES = 65
LENGTH = Length.__metadata__[0]


class Lengths(Quantity):
    """A list of lengths."""

    def expected(self) -> str:
        return 'a list of lengths, ["32 mm", "36 mm", ...]'

    def read(self, value: Any) -> tuple[float, ...]:
        """Floats in m.  Raises `QuantityError`."""
        if not isinstance(value, (list, tuple)):
            raise QuantityError(quoted(value), self.expected())
        found = []
        for n, entry in enumerate(value):
            try:
                found.append(LENGTH.read(entry))
            except QuantityError as error:
                raise QuantityError(f"{error.found} as entry {n + 1}", error.expected) from None
        return tuple(found)

    def __get_pydantic_json_schema__(self, schema, handler) -> dict:
        entry = LENGTH.__get_pydantic_json_schema__(None, None)
        return {"description": self.expected(), "type": "array", "minItems": 2, "maxItems": MOST_NODES, "items": entry}


Column = Annotated[tuple[float, ...], Lengths("list of lengths", "m", "")]


@dataclass(frozen=True)
class Profile:
    """The `[film.profile]` table: the gap between the faces is wider by `depth` (m) at `radius` (m), linear between,
    on top of clearance and coning.  The first radius is the inner one of the face, the last the outer."""

    __pydantic_config__ = {"extra": "forbid"}  # noqa: RUF012

    radius: Column
    depth: Column


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


def profile_errors(film) -> list[tuple[str, str, str]]:
    """What cannot be in a `[film]` with a profile: (key below film, found, expected)."""
    profile = film.profile
    if profile is None:
        return []
    bad, radius, depth = [], profile.radius, profile.depth
    if not 2 <= len(radius) <= MOST_NODES:
        bad.append(("profile.radius", f"{len(radius)} radii", f"2 to {MOST_NODES} radii"))
    if len(depth) != len(radius):
        bad.append(("profile.depth", f"{len(depth)} depths of {len(radius)} radii", "as many depths as radii"))
    for key, column in (("radius", radius), ("depth", depth)):
        odd = [value for value in column if not math.isfinite(value)]
        if odd:
            bad.append((f"profile.{key}", f"{odd[0]}", "finite lengths"))
    for before, after in pairwise(radius):
        if not before < after:
            bad.append(("profile.radius", f"{after:g} m after {before:g} m", "radii that increase"))
    for found, key in zip((radius[:1], radius[-1:]), ("inner_radius", "outer_radius"), strict=True):
        edge = getattr(film, key)
        if not found or abs(found[0] - edge) > 1e-12 * edge:
            words = "first" if key == "inner_radius" else "last"
            bad.append(("profile.radius", f"{found[0] if found else 0:g} m {words}", f"{key} = {edge:g} m {words}"))
    if film.cavitation_pressure is not None:
        bad.append(("cavitation_pressure", "a value with a profile", "nothing: a film with a profile has no floor"))
    return bad


def aligned_gaps(film, clearance: float) -> list[tuple[float, float]]:
    """(radius, film thickness) in m at the edges of the aligned faces and at the radii of the profile."""
    radii, depths = (film.inner_radius, film.outer_radius), (0.0, 0.0)
    if film.profile is not None:
        radii, depths = film.profile.radius, film.profile.depth
    return [
        (r, clearance + film.coning * (r - film.inner_radius) + depth) for r, depth in zip(radii, depths, strict=True)
    ]
