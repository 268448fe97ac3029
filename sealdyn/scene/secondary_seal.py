"""The secondary-seal tables: friction of the O-ring on which a ring slides."""

import math
from dataclasses import dataclass
from typing import Literal

from ..units import Force, LineForce, Radius, Velocity


@dataclass(frozen=True)
class SecondarySeal:
    """The `[stator.secondary_seal]` or `[rotor.secondary_seal]` table: `radius` (m) of the circle, and `line_friction`
    (F', N/m) or `friction_force` (axial breakaway force, 2 pi R F', N).  `law = "regularised"` takes the
    force and moment of Coulomb's law times s/sqrt(s^2 + width^2), where s^2 = v^2 + (R |q|)^2 of the axial speed v and
    the tilt rate q: it creeps where a real seal sticks."""

    __pydantic_config__ = {"extra": "forbid"}  # noqa: RUF012

    radius: Radius
    """Radius of the circle on which the O-ring slides."""
    line_friction: LineForce | None = None
    """Friction per length of that circle; or give `friction_force`."""
    friction_force: Force | None = None
    """Axial breakaway force, in place of `line_friction`."""
    law: Literal["coulomb", "regularised"] = "coulomb"
    """Real sticking, or friction that fades with the sliding speed and creeps."""
    width: Velocity | None = None
    """Sliding speed below which friction fades, for "regularised"."""

    def line(self) -> float:
        """Friction per length F' (N/m)."""
        if self.line_friction is not None:
            return self.line_friction
        return self.friction_force / (2 * math.pi * self.radius)

    def breakaway(self) -> tuple[float, float]:
        """Axial force `2 pi R F'` (N) and moment `4 R^2 F'` (N m) that make a stuck ring slide, each alone.

        **Source** Ludwig & Allen, NASA TN D-8102 (1976); circle integral of -F' sign(v).
        """
        return 2 * math.pi * self.radius * self.line(), 4 * self.radius**2 * self.line()


def secondary_seal_errors(seal) -> list[tuple[str, str, str]]:
    """What is wrong with a `SecondarySeal`: (key, found, expected)."""
    out = []
    if seal.radius <= 0:
        out.append(("radius", f"{seal.radius:g} m", "a length > 0"))
    given = [x is not None for x in (seal.line_friction, seal.friction_force)]
    if sum(given) != 1:
        found = "both" if all(given) else "neither"
        out.append(("line_friction", found, "exactly one of line_friction and friction_force"))
    elif (seal.line_friction if given[0] else seal.friction_force) < 0:
        out.append(("friction_force", "a negative friction", "a friction >= 0"))
    if seal.law == "regularised" and not (seal.width and seal.width > 0):
        out.append(("width", "nothing", "a sliding speed > 0, over which the regularised law turns"))
    if seal.law == "coulomb" and seal.width is not None:
        out.append(("width", f"{seal.width:g} m/s", 'no width, or law = "regularised"'))
    return out
