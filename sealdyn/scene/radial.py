"""A radial seal: a shaft that runs out, and the elements that are pressed on it, as plain data.

Its equations are in radial_seals/; a scenario file holds either this or a face seal's Scene.
"""

from dataclasses import dataclass, field
from itertools import pairwise
from typing import Annotated

from ..numerics.piecewise_linear import PiecewiseLinear
from ..units import (
    Angle,
    LineForce,
    Mass,
    Quantity,
    Radius,
    Speed,
    Stress,
    Usual,
    Varying,
    Viscosity,
)
from . import Strict

# The tables that make a scenario one of a radial seal.
RADIAL = ("lip", "circumferential")

Amplitude = Annotated[float, Quantity("length", "m", '"0.1 mm"', (), 0, usual=Usual(1e-9, 1e-2, "mm"))]
LineStiffness = Annotated[
    float,
    Quantity("stiffness per length", "N/m^2", '"50 N/mm/m", "5e4 N/m^2"', (), 0, usual=Usual(1e3, 1e9, "N/mm/m")),
]
Area = Annotated[float, Quantity("area", "m^2", '"6 mm^2"', (), 0, usual=Usual(1e-9, 1e-2, "mm^2"))]
Positive = Annotated[float, Quantity("length", "m", '"2 mm"', (), 0, True, Usual(1e-6, 0.1, "mm"))]
Number = Annotated[float, Quantity("number", "1", "0.3", (), 0, usual=Usual(0.0, 3.0, "%"))]
Tension = Annotated[float, Quantity("force", "N", '"2 N"', (), 0, usual=Usual(1e-3, 1e4, "kN"))]
# A garter spring is soft.
GarterRate = Annotated[float, Quantity("stiffness", "N/m", '"50 N/m"', (), 0, usual=Usual(1.0, 1e7, "N/mm"))]
PressureDifference = Annotated[float, Quantity("pressure", "Pa", '"0.1 bar"', (), 0, usual=Usual(100.0, 1e8, "bar"))]


@dataclass(frozen=True)
class Lobes(Strict):
    """A `[[shaft.lobes]]` table: the running surface is out of round, `amplitude cos(order (theta - shaft angle) -
    phase)`."""

    order: int
    """Lobes around the shaft: 2 is oval."""
    amplitude: Amplitude
    """Of the radius."""
    phase: Angle = 0.0
    """Of the wave, against the shaft's own x axis."""


@dataclass(frozen=True)
class RadialShaft(Strict):
    """The `[shaft]` table of a radial seal."""

    radius: Radius
    """Of the running surface."""
    speed: Varying[Speed]
    """Shaft speed; negative turns the other way."""
    eccentricity: Amplitude = 0.0
    """Of the running surface on its axis of rotation: half the total indicator reading."""
    offset: Amplitude = 0.0
    """Static distance between the axis of rotation and that of the seal's housing."""
    offset_direction: Angle = 0.0
    """Of the offset, from the x axis."""
    lobes: list[Lobes] = field(default_factory=list)
    """Further waves of the running surface."""

    @property
    def waves(self) -> list[tuple[int, float, float]]:
        """Order, amplitude (m) and phase (rad) of all waves that turn with the shaft."""
        own = [(1, self.eccentricity, 0.0)] if self.eccentricity else []
        return own + [(wave.order, wave.amplitude, wave.phase) for wave in self.lobes]


@dataclass(frozen=True)
class Lip(Strict):
    """The `[lip]` table: an elastomer lip around the shaft, in `sectors` of equal length.

    Preload and stiffness per length of circumference are given, or follow from the section of the lip: hoop and garter
    spring press with `(hoop_stress hoop_area + garter_tension) / radius`, the beam of unit width with `3 E I
    interference / length^3`, I = thickness^3/12.

    **Source** Hayden & Keller, NASA CR-120997 (1974), eqs. 2.9 to 2.11: the same per section of the lip.
    """

    mass: Mass
    """Of all of the lip that moves with the contact line."""
    sectors: int = 36
    """Pieces of the circumference, each with a motion of its own."""
    preload: LineForce | None = None
    """Force per length on the concentric shaft; or give the section."""
    stiffness: LineStiffness | None = None
    """Of the beam, per length; or give the section."""
    hoop_stress: Stress | None = None
    """In the lip stretched over the shaft."""
    hoop_area: Area | None = None
    """Of the lip's section that carries it."""
    modulus: Stress | None = None
    """Young's modulus of the elastomer."""
    thickness: Positive | None = None
    """Of the lip where it bends."""
    length: Positive | None = None
    """Of the lip from its root to the contact line."""
    interference: Amplitude | None = None
    """Radial, of the free lip on the shaft."""
    garter_tension: Tension = 0.0
    """Of the garter spring around the lip; it also stiffens ovality and higher waves."""
    garter_rate: GarterRate = 0.0
    """Of the garter spring along its length: it counts where the whole lip widens."""
    loss_factor: Number = 0.0
    """Of the elastomer at the shaft speed (the largest of a table): the damping is loss factor x stiffness / speed."""
    friction_coefficient: Number = 0.0
    """Of lip and shaft: for the torque."""
    contact_width: Positive | None = None
    """Of the contact line along the shaft: for the leakage estimate."""
    viscosity: Viscosity | None = None
    """Of the sealed liquid: for the leakage estimate."""
    pressure_difference: PressureDifference = 0.0
    """Across the lip: for the leakage estimate; it does not press here."""


@dataclass(frozen=True)
class Circumferential(Strict):
    """The `[circumferential]` table: carbon segments around the shaft, pressed on it by a garter spring and against the
    flange of the housing by axial springs, on which they slide with Coulomb friction.

    Each segment is rigid and moves along its own middle radius; it touches the shaft there.
    """

    mass: Mass
    """Of all segments together."""
    segments: int = 6
    """Around the shaft."""
    garter_tension: Tension = 0.0
    """Of the spring around them."""
    garter_rate: GarterRate = 0.0
    """Of the garter spring along its length: it counts where all segments move out."""
    axial_force: Tension = 0.0
    """Of all axial springs together, on the flange."""
    flange_friction: Number = 0.0
    """Coefficient between segments and flange."""
    friction_coefficient: Number = 0.0
    """Of segments and shaft: for the torque."""
    contact_width: Positive | None = None
    """Of the bore along the shaft: for the leakage estimate."""
    viscosity: Viscosity | None = None
    """Of the sealed fluid: for the leakage estimate."""
    pressure_difference: PressureDifference = 0.0
    """Across the seal: for the leakage estimate; it does not press here."""


@dataclass(frozen=True)
class RadialScene(Strict):
    """Everything physical that a scenario of a radial seal describes, SI: its shaft, and a lip or segments."""

    shaft: RadialShaft
    """The shaft, its speed and its runout."""
    lip: Lip | None = None
    """An elastomer lip."""
    circumferential: Circumferential | None = None
    """Segments of carbon."""

    @property
    def seal(self) -> Lip | Circumferential:
        """The one that there is."""
        return self.lip or self.circumferential


def radial_errors(scene: RadialScene) -> list[tuple[str, str, str]]:
    """What cannot be in a `RadialScene`: (dotted key, found, expected)."""
    bad = []
    if (scene.lip is None) == (scene.circumferential is None):
        found = "neither" if scene.lip is None else "both"
        return [("lip", f"{found} of [lip] and [circumferential]", "one of the two")]
    shaft, seal = scene.shaft, scene.seal
    if shaft.radius <= 0.0:
        bad.append(("shaft.radius", f"{shaft.radius:g} m", "a length > 0"))
    if isinstance(shaft.speed, PiecewiseLinear):
        bad += [
            ("shaft.speed", f"two speeds at {time:g} s", "a ramp: no seal follows a step of the speed")
            for (time, before), (then, after) in pairwise(zip(shaft.speed.time, shaft.speed.value, strict=True))
            if time == then and before != after
        ][:1]
    for n, wave in enumerate(shaft.lobes):
        if not 1 <= wave.order <= 24:
            bad.append((f"shaft.lobes.{n}.order", str(wave.order), "1 to 24"))
    table = "lip" if scene.lip else "circumferential"
    if seal.mass == 0.0:
        bad.append((f"{table}.mass", "0 kg", "a mass > 0: what has none follows everything"))
    if scene.lip:
        bad += _lip_errors(scene.lip)
        if not 4 <= seal.sectors <= 720:
            bad.append(("lip.sectors", str(seal.sectors), "4 to 720"))
        highest = max((order for order, _, _ in shaft.waves), default=1)
        if 4 <= seal.sectors < 4 * highest:
            bad.append(
                ("lip.sectors", str(seal.sectors), f"at least {4 * highest}: four for each of the shaft's waves")
            )
    elif not 2 <= seal.segments <= 60:
        bad.append(("circumferential.segments", str(seal.segments), "2 to 60"))
    return bad


def _lip_errors(lip: Lip) -> list[tuple[str, str, str]]:
    hoop, beam = ("hoop_stress", "hoop_area"), ("modulus", "thickness", "length", "interference")
    given = [key for key in (*hoop, *beam) if getattr(lip, key) is not None]
    if lip.preload is None and lip.stiffness is None:
        missing = [key for key in beam if getattr(lip, key) is None]
        if missing:
            wanted = f"preload and stiffness, or the section ({', '.join(missing)} are missing)"
            return [("lip.preload", "nothing", wanted)]
    elif lip.preload is None or lip.stiffness is None:
        key = "preload" if lip.preload is None else "stiffness"
        return [(f"lip.{key}", "nothing", "both of preload and stiffness, or neither and the section")]
    elif given:
        return [(f"lip.{given[0]}", f"{given[0]} beside preload and stiffness", "one of the two ways")]
    if (lip.hoop_stress is None) != (lip.hoop_area is None):
        return [("lip.hoop_stress", "one of hoop_stress and hoop_area", "both or neither")]
    return []
