"""The `[film.heat]` table: what each ring takes of the heat that film and asperities make, and how that cones its face.

**Source** linear conduction and elasticity: a ring's mean face temperature and its coning are proportional to the heat
that enters it.
**Valid** numbers of one ring at a time, its other surfaces at the temperature of the sealed liquid.
"""

import math
from dataclasses import dataclass
from typing import Annotated, Literal

from ..units import Length, Quantity, Time, Usual

ThermalResistance = Annotated[float, Quantity("thermal resistance", "K/W", '"0.4 K/W"', (), 0, True,
    usual=Usual(1e-5, 1e4, "K/kW"))]  # fmt: skip
ConingPerWatt = Annotated[float, Quantity("coning per heat", "rad/W", '"2.5 urad/W"',
    usual=Usual(0.0, 1e-3, "urad/W"))]  # fmt: skip
HeatTransfer = Annotated[float, Quantity("heat transfer coefficient", "W/(m^2*K)", '"12 kW/(m^2*K)"', (), 0, True,
    usual=Usual(50.0, 1e6, "kW/(m^2*K)"))]  # fmt: skip
# Keys of a ring given by two numbers, and of one given by its body.
BY_NUMBERS, BY_BODY = ("resistance", "coning_per_watt", "time_constant"), ("convection", "wetted_length", "wet")


@dataclass(frozen=True)
class HeatedRing:
    """One ring of `[film.heat]`: by numbers of its maker, finite elements or a test; or by its `body` and the
    convection on it."""

    __pydantic_config__ = {"extra": "forbid"}  # noqa: RUF012

    resistance: ThermalResistance | None = None
    """Rise of the face over the heat that enters it."""
    coning_per_watt: ConingPerWatt = 0.0
    """Coning over that heat, positive where the film gets thicker outwards."""
    time_constant: Time | None = None
    """Time in which the rise settles."""
    convection: Literal["becker"] | HeatTransfer | None = None
    """In place of the numbers, with the ring's `body`: heat transfer coefficient of the wetted surface; "becker" by a
    cylinder that turns in the liquid."""
    wetted_length: Length | None = None
    """From the face to the O-ring; the whole length."""
    wet: Literal["outer", "bore", "both"] | None = None
    """Which surface the liquid wets; that of the higher pressure."""


@dataclass(frozen=True)
class Heat:
    """The `[film.heat]` table; a ring that is not named takes no heat."""

    __pydantic_config__ = {"extra": "forbid"}  # noqa: RUF012

    stator: HeatedRing | None = None
    """The ring that stands."""
    rotor: HeatedRing | None = None
    """The ring that turns."""
    friction: float = 1.0
    """Friction that heats over that of the aligned film: of rings that rub or run tilted, as a run tells it."""

    @property
    def rings(self) -> dict[str, HeatedRing]:
        """The rings that take heat, by their names."""
        both = {"stator": self.stator, "rotor": self.rotor}
        return {name: ring for name, ring in both.items() if ring is not None}


def _body_errors(scene, name: str, ring) -> list[tuple[str, str, str]]:
    """What a ring of a Scene lacks to be reckoned from its body."""
    body, film = getattr(scene, name).body, scene.film
    if body is None:
        found = f"nothing, with film.heat.{name}.convection"
        return [(f"{name}.body", found, "the ring: inner_radius, outer_radius, length, material")]
    bad = [(f"{name}.body.{key}", "nothing, with film.heat", "a number, or a material that has it")
           for key, value in body.solid().items() if value is None]  # fmt: skip
    if not body.inner_radius <= film.inner_radius < film.outer_radius <= body.outer_radius:
        found = f"{body.inner_radius:g} to {body.outer_radius:g} m"
        bad.append((f"{name}.body.inner_radius", found, "a ring that the face of the film lies on"))
    if body.inner_radius == 0.0:
        bad.append((f"{name}.body.inner_radius", "0 m, a disk", "a ring with a bore, or film.heat by numbers"))
    if ring.wetted_length is not None and not 0.0 < ring.wetted_length <= body.length:
        found = f"{ring.wetted_length:g} m"
        bad.append((f"film.heat.{name}.wetted_length", found, f"a length above 0, at most {body.length:g} m"))
    return bad


def heat_errors(scene) -> list[tuple[str, str, str]]:
    """What cannot be in `[film.heat]` of a Scene: (key, found, expected)."""
    film, heat, bad = scene.film, scene.film.heat, []
    if film.gas is not None:
        return [("film.heat", "heat of a film of gas", "a liquid: across a film of gas the faces differ")]
    if film.model == "linear" and not isinstance(film.coefficients, str):
        return [("film.heat", "heat beside coefficients of one's own", "a film whose friction is known")]
    if scene.stator.elastic is not None:
        return [("film.heat", "heat beside an elastic ring", "one of them: its waves are those of one viscosity")]
    if not 0.0 < heat.friction < math.inf:
        bad.append(("film.heat.friction", f"{heat.friction:g}", "a number above 0"))
    if not heat.rings:
        bad.append(("film.heat", "an empty table", "stator or rotor, each { resistance, coning_per_watt }"))
    if film.liquid is None:
        found = "nothing, with film.heat"
        bad.append(("film.liquid", found, '"water", or a table: viscosity over temperature'))
    for name, ring in heat.rings.items():
        key = f"film.heat.{name}"
        if scene.stator.elastic is not None:
            bad.append((key, "heat beside stator.elastic", "one of them: waves that heat moves are not reckoned"))
        numbers = [k for k in BY_NUMBERS if getattr(ring, k) not in (None, 0.0)]
        drawn = [k for k in BY_BODY if getattr(ring, k) is not None]
        if numbers and drawn:
            bad.append((f"{key}.{drawn[0]}", f"{drawn[0]} beside {numbers[0]}", "a ring by numbers, or by its body"))
        elif ring.resistance is None and ring.convection is None:
            bad.append((f"{key}.resistance", "nothing", "a resistance, or convection and the ring's body"))
        elif ring.convection is not None:
            bad += _body_errors(scene, name, ring)
    return bad
