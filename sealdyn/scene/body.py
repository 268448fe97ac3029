"""The `[stator.body]` and `[rotor.body]` tables: a ring from its drawing, whose mass and inertias follow."""

import math
from dataclasses import dataclass, replace
from typing import Literal

from ..units import Density, Length, Radius

# What a body gives its ring.
INERTIAL = ("mass", "transverse_inertia", "polar_inertia")
# kg/m^3.  Faces: data sheet of a maker of seal faces, Omegaslate (UK) Ltd, "Physical and mechanical properties of
# materials" (carbon graphite: resin impregnated; silicon carbide: sintered or reaction bonded; tungsten carbide:
# cobalt or nickel binder).  Steel: EN 1994-1-2 (2005), 3.4; stainless grades are up to 2 % heavier.
# Nothing but densities: roughness, strength, friction and wear are those of a pair of faces and of their finish.
DENSITIES = {
    "carbon graphite": 1800.0,
    "antimony carbon graphite": 2500.0,
    "silicon carbide": 3100.0,
    "tungsten carbide": 14700.0,
    "steel": 7850.0,
}
Material = Literal["carbon graphite", "antimony carbon graphite", "silicon carbide", "tungsten carbide", "steel"]


@dataclass(frozen=True)
class Body:
    """A ring as a hollow cylinder of one material: with it mass, transverse and polar inertia of the ring follow.

    **Source** integrals of the density over the cylinder, as in any table of moments of inertia.
    **Valid** a homogeneous ring of rectangular section, turning about its centre of mass.  Of a stepped ring, or one in
    a carrier that tilts with it, give mass and inertias themselves.
    """

    __pydantic_config__ = {"extra": "forbid"}  # noqa: RUF012

    inner_radius: Radius
    """Of the bore; 0 of a disk."""
    outer_radius: Radius
    """Of the circumference."""
    length: Length
    """Along the shaft axis."""
    material: Material | None = None
    """Its density: 1800 (carbon graphite), 2500 (with antimony), 3100, 14700 and 7850 kg/m^3; or give `density`."""
    density: Density | None = None
    """In place of `material`."""

    def inertia(self) -> tuple[float, float, float]:
        """Mass m = rho pi (r_o^2 - r_i^2) L (kg), transverse m (3 (r_o^2 + r_i^2) + L^2)/12 and polar inertia
        m (r_o^2 + r_i^2)/2 (kg m^2), about the centre of mass."""
        density = DENSITIES[self.material] if self.density is None else self.density
        inner, outer = self.inner_radius**2, self.outer_radius**2
        mass = density * math.pi * (outer - inner) * self.length
        return mass, mass * (3 * (outer + inner) + self.length**2) / 12, mass * (outer + inner) / 2


def with_inertia(ring):
    """The ring (Stator or Rotor) with the mass and inertias of its body; itself, if it has none or an impossible
    one."""
    if ring.body is None or body_errors(ring.body):
        return ring
    return replace(ring, **dict(zip(INERTIAL, ring.body.inertia(), strict=True)))


def body_errors(body: Body) -> list[tuple[str, str, str]]:
    """What cannot be in a `Body`: (key, found, expected)."""
    bad = []
    if body.inner_radius < 0:
        bad.append(("inner_radius", f"{body.inner_radius:g} m", "a length >= 0"))
    if body.outer_radius <= body.inner_radius:
        bad.append(("outer_radius", f"{body.outer_radius:g} m", f"more than inner_radius = {body.inner_radius:g} m"))
    if body.length <= 0:
        bad.append(("length", f"{body.length:g} m", "a length > 0"))
    if (body.material is None) == (body.density is None):
        found = "neither" if body.density is None else "both"
        bad.append(("material", found, f"one of density and material ({', '.join(DENSITIES)})"))
    return bad
