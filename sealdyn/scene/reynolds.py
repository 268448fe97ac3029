"""The `[film.reynolds]` table: options of the two-dimensional film of a liquid."""

from dataclasses import dataclass
from typing import Literal

# Cells where the table does not say, before they are doubled: over the radius, around the shortest wave, and at least
# around the circle.
RADIAL, PER_WAVE, AROUND = 6, 24, 32
# Most of them.
MOST_RADIAL, MOST_AROUND = 400, 20000


@dataclass(frozen=True)
class Reynolds:
    """The `[film.reynolds]` table: options of the film "reynolds"."""

    __pydantic_config__ = {"extra": "forbid"}  # noqa: RUF012

    grid_accuracy: float = 0.01
    """Relative error that the cells may have beside a run's accuracy; decides how many there are if none are given."""
    cells_r: int | None = None
    """Cells over the radius."""
    cells_theta: int | None = None
    """Cells around the circle."""
    cavitation: Literal["mass-conserving", "none"] = "mass-conserving"
    """Where the film tears at `cavitation_pressure`, with its liquid kept; or never."""
    roughness: Literal["christensen", "none"] = "christensen"
    """Whether the film flows between the asperities of [contact]."""
    sectors: int | None = None
    """Alike sectors of the circle, one of which is computed; without it what waves have in common if nothing tilts."""


def reynolds_errors(film) -> list[tuple[str, str, str]]:
    """What a `Film` table that asks for this film cannot have: (key below film, found, expected)."""
    options, bad = film.reynolds or Reynolds(), []
    limits = (("cells_r", 2, MOST_RADIAL), ("cells_theta", 8, MOST_AROUND), ("sectors", 1, MOST_AROUND))
    for key, least, most in limits:
        value = getattr(options, key)
        if value is not None and not least <= value <= most:
            bad.append((f"reynolds.{key}", f"{value}", f"{least} to {most}"))
    if not 0.0 < options.grid_accuracy <= 1.0:
        bad.append(("reynolds.grid_accuracy", f"{options.grid_accuracy:g}", "above 0, at most 1"))
    if options.cavitation == "mass-conserving" and film.cavitation_pressure is None:
        expected = 'a pressure, or film.reynolds.cavitation = "none"'
        bad.append(("cavitation_pressure", 'nothing, with model = "reynolds"', expected))
    return bad


def cells_of(film, orders=()) -> tuple[int, int, int]:
    """Cells over the radius and around one sector, and sectors, of a `Film` table between faces with waves of these
    orders."""
    options = film.reynolds or Reynolds()
    sectors = options.sectors or 1
    around = options.cells_theta or max(AROUND, PER_WAVE * max(orders, default=0))
    return options.cells_r or RADIAL, -(-around // sectors), sectors
