"""The `[stator.elastic]` table: a wavy ring that bends under what presses on its face."""

import math
from dataclasses import dataclass

from ..units import BendingStiffness, Radius


@dataclass(frozen=True)
class ElasticRing:
    """The `[stator.elastic]` table: with it `[[stator.waviness]]` is the wave that the ring was made with, and less is
    left under load.

    **Source** Lebeck, Teale & Pierce, ONR ME-95(79)ONR-414-1 (1979), eqs. 3-1 to 3-12; re-derived from the strain
    energy of bending and torsion.
    **Valid** a ring of uniform section, thin in its radius, waves of order 2 and more, small deflections.
    """

    __pydantic_config__ = {"extra": "forbid"}  # noqa: RUF012

    bending_stiffness: BendingStiffness
    """E J against bending out of the ring's plane."""
    radius: Radius
    """Radius of the centroid of the ring's section."""
    torsion_ratio: float = 1.3
    """Bending stiffness over torsional stiffness, A = E J/(G J_t); 1.3 for a round bar of steel, 1.5 to 6 for slender
    sections."""

    def compliance(self, order: int) -> float:
        """Deflection (m) of the wave `order` per N of its harmonic of the load int p r dr (N), m/N:
        (n^2 + A) r^3/(E J n^2 (n^2 - 1)^2)."""
        bends = order**2 * (order**2 - 1) ** 2
        return (order**2 + self.torsion_ratio) * self.radius**3 / (self.bending_stiffness * bends)

    def largest_waviness(self, order: int, pressure: float, length: float) -> float:
        """Largest waviness (m) that a pressure (Pa) between two O-rings `length` (m) apart can give the ring, by a
        couple that follows cos(n theta): eq. 3-12, length^2 (1 + A) r^3 pressure/(8 E J (n^2 - 1)^2)."""
        couple = 0.125 * length**2 * pressure * self.radius**3 / self.bending_stiffness
        return couple * (1.0 + self.torsion_ratio) / (order**2 - 1) ** 2


def elastic_errors(scene) -> list[tuple[str, str, str]]:
    """What a scene with such a ring cannot have: (key, found, expected)."""
    ring, bad = scene.stator.elastic, []
    if ring is None:
        return bad
    for key in ("bending_stiffness", "radius"):
        if not 0.0 < getattr(ring, key) < math.inf:
            bad.append((f"stator.elastic.{key}", f"{getattr(ring, key):g}", "a value > 0"))
    if not 0.0 <= ring.torsion_ratio < math.inf:
        bad.append(("stator.elastic.torsion_ratio", f"{ring.torsion_ratio:g}", "a ratio >= 0"))
    if len(scene.stator.waviness) != 1 or scene.rotor.waviness:
        found = f"{len(scene.stator.waviness)} waves of the stator, {len(scene.rotor.waviness)} of the rotor"
        bad.append(("stator.elastic", found, "one [[stator.waviness]], which the load levels, and none of the rotor"))
    if scene.film.model != "reynolds":
        bad.append(
            ("stator.elastic", f'film.model = "{scene.film.model}"', '"reynolds", whose pressure bends the ring')
        )
    return bad
