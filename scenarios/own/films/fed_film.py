"""Film by two Python functions: a hydrostatic film that a capillary feeds from a supply.

The pressure over the face is that of the supply behind the resistance of the capillary, and falls as the film opens:

    p = p_i + (p_s - p_i) / (1 + (h / h_c)^3),      w = p b,      d = mu b^3 / h^3

with h_c the film whose resistance is that of the capillary, b the width of the face.
**Source** Rowe (2012), Hydrostatic, Aerostatic and Hybrid Bearing Design, capillary control; the squeeze film of a
narrow land.
**Valid** a laminar liquid; a recess that is wide beside its lands.

    SEALDYN_PATH=scenarios/own sealdyn run scenarios/fms_reference.toml --set film.model=fed_film \
        --set "film.fed_film.supply_pressure=12 bar"
"""

from dataclasses import dataclass
from typing import Any

import numpy as np

from sealdyn.films._line_laws import line_film
from sealdyn.units import Height, Pressure


@dataclass(frozen=True)
class Options:
    """The `[film.fed_film]` table."""

    supply_pressure: Pressure
    """Of the pump, absolute."""
    capillary_film: Height = 12e-6
    """Film thickness whose resistance is that of the capillary."""

    def errors(self) -> list[tuple[str, str, str]]:
        """What the options cannot be: (key, found, expected)."""
        bad = self.capillary_film <= 0.0
        return [("capillary_film", f"{self.capillary_film:g} m", "a length > 0")] if bad else []


def opening(h: Any, options: Options, table: Any) -> Any:
    """Opening force (N/m) per length of the mean circle, at film thicknesses `h` (m)."""
    gauge = options.supply_pressure - table.inner_pressure
    pressure = table.inner_pressure + gauge / (1.0 + (np.asarray(h) / options.capillary_film) ** 3)
    return pressure * (table.outer_radius - table.inner_radius)


def damping(h: Any, options: Options, table: Any) -> Any:
    """Damping (N s/m^2) per length of the mean circle, at film thicknesses `h` (m)."""
    return table.viscosity * ((table.outer_radius - table.inner_radius) / np.asarray(h)) ** 3


FILM = line_film("fed_film", opening, damping)
