"""The profile of faces that are not plain cones: worn ones, or any other shape that is the same all around."""

import math
from dataclasses import dataclass
from itertools import pairwise
from typing import Annotated, Any

from ..gap import MOST_NODES
from ..units import Length, Quantity, QuantityError, shown

LENGTH = Length.__metadata__[0]


class Lengths(Quantity):
    """A list of lengths."""

    def expected(self) -> str:
        return 'a list of lengths, ["32 mm", "36 mm", ...]'

    def read(self, value: Any) -> tuple[float, ...]:
        """Floats in m.  Raises `QuantityError`."""
        if not isinstance(value, (list, tuple)):
            raise QuantityError(shown(value), self.expected())
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


# Films that know a coned face only.
CONES_ONLY = ("linear", "radial")


def faults(film) -> list[tuple[str, str, str]]:
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
    if film.model in CONES_ONLY:
        bad.append(("model", f'"{film.model}" with a profile', '"profiled" or "auto": the faces are no plain cones'))
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
