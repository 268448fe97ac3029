"""The O-ring under a floating ring, and other places that rub along the shaft: friction, and what gives before it."""

import math
from dataclasses import dataclass, field
from typing import Literal, NamedTuple

from ..units import Force, LineForce, Radius, Stiffness, Velocity
from . import Strict


@dataclass(frozen=True)
class FrictionElement(Strict):
    """One entry of `[[stator.secondary_seal.elements]]` or `[[rotor.secondary_seal.elements]]`: stiffness and friction
    in series, beside those of the O-ring itself."""

    stiffness: Stiffness
    """Of the element along the shaft, all around."""
    friction_force: Force
    """Axial force at which it slides."""
    radius: Radius | None = None
    """Of the circle on which it acts, that of anti-rotation pins for instance; without it the O-ring's."""


class Circle(NamedTuple):
    """An element around its circle: radius (m), friction (N) and stiffness (N/m) along the shaft."""

    radius: float
    friction: float
    stiffness: float


@dataclass(frozen=True)
class SecondarySeal(Strict):
    """The `[stator.secondary_seal]` or `[rotor.secondary_seal]` table: `radius` (m) of the circle, and `line_friction`
    (F', N/m) or `friction_force` (axial breakaway force, 2 pi R F', N).  `law = "regularised"` takes the
    force and moment of Coulomb's law times s/sqrt(s^2 + width^2), where s^2 = v^2 + (R |q|)^2 of the axial speed v and
    the tilt rate q: it creeps where a real seal sticks.  With a `stiffness` it gives before it slides."""

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
    stiffness: Stiffness | None = None
    """Of the O-ring along the shaft, in series with its friction: it gives by friction over stiffness before it slides,
    each place of the circle by itself, and small motion meets a spring.  Left out are damping and creep of the rubber,
    and what its stiffness has of frequency and amplitude beside sliding.  Without it a ring sticks rigidly."""
    elements: list[FrictionElement] = field(default_factory=list)
    """Further ones in parallel, which slide one after the other (Iwan), or on a circle of their own (pins)."""

    def line(self) -> float:
        """Friction per length F' (N/m) of the O-ring's circle."""
        if self.line_friction is not None:
            return self.line_friction
        return self.friction_force / (2 * math.pi * self.radius)

    def _radius_of(self, element: FrictionElement) -> float:
        return self.radius if element.radius is None else element.radius

    def circles(self) -> list[Circle]:
        """All that rubs; the O-ring first, of stiffness infinite if it does not give."""
        stiffness = math.inf if self.stiffness is None else self.stiffness
        others = [Circle(self._radius_of(one), one.friction_force, one.stiffness) for one in self.elements]
        return [Circle(self.radius, 2 * math.pi * self.radius * self.line(), stiffness), *others]

    def breakaway(self) -> tuple[float, float]:
        """Axial force `2 pi R F'` (N) and moment `4 R^2 F'` (N m) that make a stuck ring slide, each alone, all circles
        together.

        **Source** Ludwig & Allen, NASA TN D-8102 (1976); circle integral of -F' sign(v).
        """
        force, moment = 2 * math.pi * self.radius * self.line(), 4 * self.radius**2 * self.line()
        for one in self.elements:
            force += one.friction_force
            moment += 2.0 / math.pi * self._radius_of(one) * one.friction_force
        return force, moment

    def springs(self) -> tuple[float, float]:
        """Stiffness along the shaft (N/m) and about a diameter (N m/rad), `sum of k R^2 / 2`, while nothing slides; 0
        of a seal that does not give."""
        given = self.circles() if self.stiffness is not None else []
        return sum(one.stiffness for one in given), sum(0.5 * one.stiffness * one.radius**2 for one in given)

    def reach(self) -> float:
        """Displacement (m) at which the first of its elements slides, at rest in the middle; 0 of a rigid one."""
        return min(one.friction / one.stiffness for one in self.circles())


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
    if seal.stiffness is not None and seal.law == "regularised":
        out.append(("stiffness", "one beside the regularised law", 'no stiffness, or law = "coulomb"'))
    if seal.elements and seal.stiffness is None:
        out.append(("stiffness", "nothing beside elements", "that of the O-ring: the elements give, too"))
    if out or seal.stiffness is None:
        return out
    keys = ["", *(f"elements.{n}." for n in range(len(seal.elements)))]
    for key, one in zip(keys, seal.circles(), strict=True):
        for name, value, unit in zip(("radius", "friction_force", "stiffness"), one, ("m", "N", "N/m"), strict=True):
            if not 0.0 < value < math.inf:
                out.append((key + name, f"{value:g} {unit}", "a value > 0, of what gives before it slides"))
    return out
