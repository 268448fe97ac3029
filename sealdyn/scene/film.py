"""The `[film]` table: faces, fluid and pressures; and the profile of faces that are not plain cones: worn ones, or any
other shape that is the same all around."""

import math
from dataclasses import dataclass, field
from itertools import pairwise
from typing import Annotated, Any, Literal

from ..numerics.piecewise_linear import initially
from ..units import (
    Angle,
    AxialFilmDamping,
    AxialFilmStiffness,
    ConingPerKelvin,
    ConingPerSpeedSquared,
    Density,
    Length,
    Pressure,
    Quantity,
    QuantityError,
    Radius,
    SignedTiltDamping,
    SignedTiltStiffness,
    SpecificHeat,
    Temperature,
    Varying,
    Viscosity,
    quoted,
)
from .gas import Gas, GasDam, GasName, GasReynolds
from .pads import Pads
from .reynolds import Reynolds

# Most radii of a profile: kernels keep room for them.
MOST_NODES = 65
LENGTH = Length.__metadata__[0]


class Lengths(Quantity):
    """A list of lengths (m), as a profile has."""

    def expected(self) -> str:
        """What the key expects, in words, for a message."""
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
        about = {"description": self.expected(), "quantity": self.name, "unit": self.unit}
        return about | {"type": "array", "minItems": 2, "maxItems": MOST_NODES, "items": entry}


Column = Annotated[tuple[float, ...], Lengths("list of lengths", "m", "")]


@dataclass(frozen=True)
class Profile:
    """The `[film.profile]` table: the gap between the faces is wider by `depth` (m) at `radius` (m), linear between,
    on top of clearance and coning.  The first radius is the inner one of the face, the last the outer."""

    __pydantic_config__ = {"extra": "forbid"}  # noqa: RUF012

    radius: Column
    """From the inner to the outer radius of the face, increasing."""
    depth: Column
    """By which the film is thicker there, on top of clearance and coning; linear between."""


@dataclass(frozen=True)
class Coefficients:
    """A linear film in the user's own numbers (a vendor's, a test's), SI: forces fall by stiffness times displacement
    and damping times rate.  The cross stiffness follows from the wedge, mean spin times tilt damping."""

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
    """The `[film]` table: faces, fluid, pressures and the film model."""

    __pydantic_config__ = {"extra": "forbid"}  # noqa: RUF012

    inner_radius: Radius
    """Inner radius of the narrower face."""
    outer_radius: Radius
    """Outer radius of the narrower face."""
    outer_pressure: Varying[Pressure]
    """Absolute, at the outer radius."""
    inner_pressure: Varying[Pressure]
    """Absolute, at the inner radius."""
    viscosity: Varying[Viscosity] | None = None
    """Dynamic viscosity, the same over the face; of a gas by Sutherland's law at its temperature where not given."""
    gas: GasName | Gas | None = None
    """A gas, by name or as a table of its numbers; without it the film is a liquid."""
    temperature: Varying[Temperature] | None = None
    """Of a gas: total temperature of the reservoir.  Of a liquid only what `coning_per_kelvin` follows."""
    model: str = "auto"
    """"auto": the linear film where its estimated error is within the accuracy, else the radial or profiled one; of a
    gas "gas_reynolds"."""
    geometry: Literal["cylindrical", "planar"] = "cylindrical"
    """Radial flow on the ring, or the narrow-seal limit without curvature."""
    tilt_radius: Literal["local", "mean"] = "local"
    """Arm of the tilt in film thickness and contact moment: the local radius, or everywhere the mean radius."""
    clearance: Length | None = None
    """Film thickness of the aligned faces at the inner radius; without it [closing] decides."""
    coning: Varying[Angle] = 0.0
    """Slope of the faces: the film is thicker outwards where positive."""
    coning_per_speed_squared: ConingPerSpeedSquared = 0.0
    """Centrifugal coning: what the shaft speed squared adds to it."""
    coning_per_kelvin: ConingPerKelvin = 0.0
    """Thermal coning: what each kelvin of `temperature` above `coning_reference_temperature` adds to it."""
    coning_reference_temperature: Temperature | None = None
    """Temperature at which the coning is that of `coning`."""
    density: Density = 1000.0
    """Of a liquid: for mass flow, heating of the leakage, Reynolds numbers and inertia."""
    inertia: bool = False
    """Centrifugal inertia of the film: its pressure rises outwards by density times radius times speed squared."""
    specific_heat: SpecificHeat = 4180.0
    """For heating of the leakage only."""
    cavitation_pressure: Pressure | None = None
    """Floor of the film pressure, absolute; none without it.  Conserves mass in "reynolds" only."""
    vapour_pressure: Pressure | None = None
    """At the temperature of the film, absolute: a run that falls below it says so."""
    coefficients: Literal["green", "radial"] | Coefficients = "green"
    """Of model = "linear": Green's narrow-seal ones, those of the radial film, or the numbers of a table."""
    floor: float = 1e-3
    """Share of the clearance below which the film counts as collapsed; with [contact] the asperities decide."""
    profile: Profile | None = None
    """Faces that are no plain cones."""
    pads: list[Pads] = field(default_factory=list)
    """Rayleigh-step pads in the face that stands still; of "gas_reynolds"."""
    gas_dam: GasDam | None = None
    """Options of model = "gas_dam"."""
    gas_reynolds: GasReynolds | None = None
    """Options of model = "gas_reynolds"."""
    reynolds: Reynolds | None = None
    """Options of model = "reynolds"."""


def profile_errors(film) -> list[tuple[str, str, str]]:
    """What cannot be in a `Film` with a profile: (key below film, found, expected), empty without one."""
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


def aligned_gaps(film, clearance: float, coning_change: float = 0.0) -> list[tuple[float, float]]:
    """(radius, film thickness) in m at the edges of the aligned faces, or at the radii of the profile of a `Film`, for
    a `clearance` (m); `coning_change` (rad) since time zero."""
    coning = initially(film.coning) + coning_change
    radii, depths = (film.inner_radius, film.outer_radius), (0.0, 0.0)
    if film.profile is not None:
        radii, depths = film.profile.radius, film.profile.depth
    return [(r, clearance + coning * (r - film.inner_radius) + depth) for r, depth in zip(radii, depths, strict=True)]
