"""A seal ring on its support: what a scenario says of it, and the numbers its equation of motion needs; its body from a
drawing, a ring that bends."""

import math
from dataclasses import dataclass, field, fields, replace
from typing import Annotated, Literal, NamedTuple

from ..units import (
    Angle,
    BendingStiffness,
    Damping,
    Density,
    Displacement,
    Height,
    Inertia,
    Length,
    Mass,
    OneOrListed,
    Quantity,
    Radius,
    SpecificHeat,
    Speed,
    Stiffness,
    Stress,
    Tilt,
    TiltDamping,
    TiltStiffness,
    Usual,
    Varying,
)
from . import Strict
from .fluid import ThermalConductivity
from .forces import Load, SecondarySeal
from .patterns import Grooves, Waviness

Expansion = Annotated[float, Quantity("thermal expansion", "1/K", '"4.5e-6 1/K"', (), 0, True,
    usual=Usual(1e-7, 1e-3, "um/(m*K)"))]  # fmt: skip
# Tilt (rad) up to which the equations hold, which are linear in tilts: gap and pressure are then off by 2e-4, half its
# square, and no seal runs so far off.
SMALL_TILT = 0.02
# What a body gives its ring.
INERTIAL = ("mass", "transverse_inertia", "polar_inertia")


class Solid(NamedTuple):
    """Numbers of a material: `density` kg/m^3, Young's `modulus` Pa, `poisson` its ratio, `expansion` 1/K,
    `conductivity` W/(m K), `specific_heat` J/(kg K)."""

    density: float
    modulus: float
    poisson: float
    expansion: float
    conductivity: float
    specific_heat: float


# Faces, alumina, bronze and steel 431 (density, E, conductivity, expansion): data sheet of a maker of seal faces,
# Omegaslate (UK) Ltd, "Physical and mechanical properties of materials" (carbon graphite: resin impregnated; silicon
# carbide: sintered; tungsten carbide: cobalt binder).  Steel 316: a tube maker's sheet.  Plain steel: EN 1994-1-2
# (2005), 3.3.1 and 3.4, at 20 degC.  Poisson's ratios and specific heats: typical values, which hardly matter.
# Other sheets have silicon carbide at 120 to 170 W/(m K) and 4.0 to 4.5e-6 1/K, carbon at 9 to 12 W/(m K): coning by
# heat goes with expansion over conductivity and is so known to 30 %.
# No roughness, strength, friction or wear: those are of a pair of faces and of their finish.
MATERIALS = {
    "carbon graphite": Solid(1800.0, 23e9, 0.2, 3.0e-6, 11.0, 750.0),
    "antimony carbon graphite": Solid(2500.0, 33e9, 0.2, 3.5e-6, 13.5, 750.0),
    "silicon carbide": Solid(3100.0, 390e9, 0.16, 4.8e-6, 100.0, 670.0),
    "reaction bonded silicon carbide": Solid(3100.0, 413e9, 0.16, 4.3e-6, 200.0, 670.0),
    "tungsten carbide": Solid(14700.0, 630e9, 0.22, 5.1e-6, 88.0, 210.0),
    "nickel bonded tungsten carbide": Solid(14700.0, 600e9, 0.22, 4.8e-6, 73.0, 210.0),
    "alumina": Solid(3870.0, 365e9, 0.22, 6.9e-6, 30.0, 880.0),
    "steel": Solid(7850.0, 210e9, 0.3, 12.2e-6, 53.3, 440.0),
    "steel 431": Solid(7720.0, 210e9, 0.3, 11.1e-6, 18.8, 460.0),
    "steel 316": Solid(8027.0, 200e9, 0.3, 16.5e-6, 14.6, 470.0),
    "lead bronze": Solid(9000.0, 68e9, 0.34, 18.4e-6, 71.0, 380.0),
}
Material = Literal[
    "carbon graphite", "antimony carbon graphite", "silicon carbide", "reaction bonded silicon carbide",
    "tungsten carbide", "nickel bonded tungsten carbide", "alumina", "steel", "steel 431", "steel 316", "lead bronze",
]  # fmt: skip


@dataclass(frozen=True)
class Body(Strict):
    """A ring as a hollow cylinder of one material: with it mass, transverse and polar inertia of the ring follow.

    **Source** integrals of the density over the cylinder, as in any table of moments of inertia.
    **Valid** a homogeneous ring of rectangular section, turning about its centre of mass.  Of a stepped ring, or one in
    a carrier that tilts with it, give mass and inertias themselves.
    """

    inner_radius: Radius
    """Of the bore; 0 of a disk."""
    outer_radius: Radius
    """Of the circumference."""
    length: Length
    """Along the shaft axis."""
    material: Material | None = None
    """Its density: 1800 (carbon graphite), 2500 (with antimony), 3100 (both silicon carbides), 14700 (both tungsten
    carbides), 3870, 7850 (steel), 7720, 8027 and 9000 kg/m^3; or give `density`."""
    density: Density | None = None
    """In place of `material`."""
    conductivity: ThermalConductivity | None = None
    """In place of the material's, as those below: for `film.heat` only."""
    expansion: Expansion | None = None
    """Coefficient of linear thermal expansion."""
    modulus: Stress | None = None
    """Young's modulus."""
    poisson: float | None = None
    """Poisson's ratio."""
    specific_heat: SpecificHeat | None = None
    """Of the ring."""

    def solid(self) -> dict[str, float | None]:
        """The numbers of its material by the names of `Solid`, its own first; None of what nobody gives."""
        known = MATERIALS[self.material]._asdict() if self.material is not None else {}
        own = {name: getattr(self, name) for name in Solid._fields}
        return {name: known.get(name) if value is None else value for name, value in own.items()}

    def inertia(self) -> tuple[float, float, float]:
        """Mass m = rho pi (r_o^2 - r_i^2) L (kg), transverse m (3 (r_o^2 + r_i^2) + L^2)/12 and polar inertia
        m (r_o^2 + r_i^2)/2 (kg m^2), about the centre of mass."""
        density = MATERIALS[self.material].density if self.density is None else self.density
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
    if body.poisson is not None and not 0.0 <= body.poisson < 0.5:
        bad.append(("poisson", f"{body.poisson:g}", "a ratio from 0 to 0.5"))
    if (body.material is None) == (body.density is None):
        found = "neither" if body.density is None else "both"
        bad.append(("material", found, f"one of density and material ({', '.join(MATERIALS)})"))
    return bad


@dataclass(frozen=True)
class ElasticRing(Strict):
    """The `[stator.elastic]` table: with it `[[stator.waviness]]` is the wave that the ring was made with, and less is
    left under load.

    **Source** Lebeck, Teale & Pierce, ONR ME-95(79)ONR-414-1 (1979), eqs. 3-1 to 3-12; re-derived from the strain
    energy of bending and torsion.
    **Valid** a ring of uniform section, thin in its radius, waves of order 2 and more, small deflections.
    """

    bending_stiffness: BendingStiffness
    """E J against bending out of the ring's plane."""
    radius: Radius
    """Radius of the centroid of the ring's section."""
    torsion_ratio: float = 1.3
    """Bending stiffness over torsional stiffness, A = E J/(G J_t); 1.3 for a round bar of steel, 1.5 to 6 for slender
    sections."""
    drive_pressure: Stress | None = None
    """Above that around it, between two O-rings on it, in sectors that follow its waves; what it bends the ring to
    is added to `[[stator.waviness]]`."""
    drive_length: Length | None = None
    """Between those O-rings, beside `drive_pressure`."""

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

    def driven(self, order: int) -> float:
        """Waviness (m) that its own drive gives the ring, 0 without one."""
        if self.drive_pressure is None or self.drive_length is None:
            return 0.0
        return self.largest_waviness(order, self.drive_pressure, self.drive_length)


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
    drive = {"drive_pressure": ring.drive_pressure, "drive_length": ring.drive_length}
    for key, value in drive.items():
        if value is None and any(drive.values()):
            bad.append((f"stator.elastic.{key}", "nothing", "a value > 0: a drive has pressure and length"))
        if value is not None and not 0.0 < value < math.inf:
            bad.append((f"stator.elastic.{key}", f"{value:g}", "a value > 0"))
    if len(scene.stator.waviness) != 1 or scene.rotor.waviness:
        found = f"{len(scene.stator.waviness)} waves of the stator, {len(scene.rotor.waviness)} of the rotor"
        bad.append(("stator.elastic", found, "one [[stator.waviness]], which the load levels, and none of the rotor"))
    if scene.contact and scene.contact.law != "christensen":
        bad.append(("contact.law", f'"{scene.contact.law}"', '"christensen" beside a ring that bends'))
    if scene.film.model != "reynolds":
        bad.append(
            ("stator.elastic", f'film.model = "{scene.film.model}"', '"reynolds", whose pressure bends the ring')
        )
    return bad


STATOR, ROTOR = 0, 1
RING_NAMES = ("stator", "rotor")


@dataclass(frozen=True)
class Support(Strict):
    """Springs and dampers between a ring and its carrier (housing or shaft), SI.

    A ring of springs at `radius` r_s gives `tilt_stiffness = axial_stiffness r_s**2 / 2`, and the same for damping; or
    give the two tilt coefficients themselves.
    **Source** Green (1989), eq. 1-2 (sum over the circle of spring elements).
    """

    axial_stiffness: Stiffness
    """All springs together, along the shaft axis."""
    axial_damping: Damping = 0.0
    """All dampers together, along the shaft axis."""
    radius: Radius | None = None
    """Radius of the circle of springs: tilt coefficient = axial coefficient * radius^2 / 2."""
    tilt_stiffness: OneOrListed[TiltStiffness] | None = None
    """About a diameter, in place of `radius`; two, about the axis at `tilt_axis` and about the one across it, of a
    support that is not the same in all directions (two drive pins)."""
    tilt_axis: Angle = 0.0
    """Of the first of two tilt stiffnesses, from the x axis; turns with the ring's carrier."""
    tilt_damping: TiltDamping | None = None
    """About a diameter, beside `tilt_stiffness`; none without it."""

    def tilt(self) -> tuple[float, float]:
        """Tilt stiffness (N m/rad), the mean of two, and tilt damping (N m s/rad)."""
        if self.radius is not None:
            half = self.radius**2 / 2
            return self.axial_stiffness * half, self.axial_damping * half
        stiffness = self.tilt_stiffness or 0.0
        if isinstance(stiffness, tuple):
            stiffness = sum(stiffness) / len(stiffness)
        return stiffness, self.tilt_damping or 0.0

    def tilt_difference(self) -> float:
        """Half the difference of two tilt stiffnesses (N m/rad): the moment is -(mean e + difference exp(2 i axis)
        conj(e)) for a tilt e = e_x + i e_y off rest; 0 of a support that is the same in all directions."""
        both = self.tilt_stiffness
        return 0.5 * (both[0] - both[-1]) if isinstance(both, tuple) and both else 0.0

    def beside(self, axial: float, tilt: float) -> "Support":
        """The support with springs beside its own, of `axial` (N/m) and `tilt` stiffness (N m/rad)."""
        own, (_, damping) = self.tilt_stiffness, self.tilt()
        both = tuple(k + tilt for k in own) if isinstance(own, tuple) else self.tilt()[0] + tilt
        stiffness = {"axial_stiffness": self.axial_stiffness + axial, "tilt_stiffness": both}
        return replace(self, radius=None, tilt_damping=damping, **stiffness)


def stuck_support(ring) -> Support | None:
    """The support of a Stator or Rotor as small motion meets it: what gives of its secondary seal is a spring."""
    seal = ring.secondary_seal
    if ring.support is None or seal is None or seal.stiffness is None:
        return ring.support
    return ring.support.beside(*seal.springs())


@dataclass(frozen=True)
class MassCentre(Strict):
    """The `[rotor.mass_centre]` or `[stator.mass_centre]` table: where a floating ring's centre of mass lies from the
    point about which it tilts, which its support holds on the shaft axis.

    Turning, it pulls sideways on the arm `axial`, a moment m e a W^2 that turns with the ring (unbalance); with
    `housing.gravity` across the shaft its weight does, a moment m a g that stands.
    **Source** Lee & Green (1994), J. Vibration and Acoustics 116, who name both for a flexibly mounted rotor;
    re-derived: moment of the force -m r'' and of the weight about the point.
    **Valid** inertias about that point; eccentricities far below the radii, of which m e z'' is left out.
    """

    axial: Displacement
    """Along the shaft, positive from rotor to stator."""
    eccentricity: Displacement = 0.0
    """From the shaft axis."""
    phase: Angle = 0.0
    """Of the eccentricity, at the start, from the x axis; turns with the ring's carrier."""


@dataclass(frozen=True)
class AxialRunout(Strict):
    """One harmonic of the rotor's axial runout (m), `amplitude cos(order * shaft angle + phase)`."""

    order: float
    """Waves per turn of the shaft."""
    amplitude: Height
    """Half of the peak-to-peak axial motion of the whole face."""
    phase: Angle = 0.0
    """Of the wave, at the start."""


@dataclass(frozen=True)
class RingInertia(Strict):
    """What both rings have of mass."""

    mass: Mass = 0.0
    """Mass of the ring, if it floats; or a table `body`."""
    transverse_inertia: Inertia = 0.0
    """Moment of inertia about a diameter; with mass 0 and inertias 0 the ring has no inertia."""
    polar_inertia: Inertia = 0.0
    """Moment of inertia about the shaft axis, at most twice the transverse one."""
    body: Body | None = None
    """The ring from its drawing, in place of mass and inertias."""
    mass_centre: MassCentre | None = None
    """Centre of mass off the point about which the ring tilts: unbalance and weight."""
    unphysical_inertia: bool = False
    """Allow a polar inertia beyond twice the transverse one, for comparison with published numbers."""


OF_MASS = tuple(f.name for f in fields(RingInertia))


@dataclass(frozen=True)
class Stator(RingInertia):
    """The ring that does not turn (unless `speed` says so).  With a support it floats."""

    misalignment: Varying[Tilt] = 0.0
    """Tilt of the seat of a rigid stator, or of the unloaded face in its springs if it floats."""
    misalignment_direction: Angle = 0.0
    """Of the axis of that tilt, from the x axis; fixed in space, or in the carrier of a stator with a `speed`."""
    speed: Varying[Speed] = 0.0
    """Of a stator that turns with a carrier of its own (counter-rotation: negative)."""
    waviness: list[Waviness] = field(default_factory=list)
    """Waves around its face, which turn with it."""
    grooves: list[Grooves] = field(default_factory=list)
    """Grooves in its face, which turn with it."""
    elastic: ElasticRing | None = None
    """A ring that bends: its waviness is what it was made with, and less is left under load."""
    support: Support | None = None
    """Springs and dampers to the housing: the stator floats."""
    secondary_seal: SecondarySeal | None = None
    """Friction of the O-ring under a floating stator."""
    load: Load | None = None
    """Force and moments from outside on a floating stator."""


@dataclass(frozen=True)
class Rotor(RingInertia):
    """The ring that turns with the shaft.  With a support it floats and has its own `misalignment`;
    rigid it has a `runout`.  Both turn with the shaft."""

    misalignment: Varying[Tilt] = 0.0
    """Tilt of the unloaded face of a floating rotor in its springs; turns with the shaft."""
    misalignment_phase: Angle = 0.0
    """Of the axis of that tilt, at the start, from the x axis."""
    runout: Varying[Tilt] = 0.0
    """Tilt of the face of a rigid rotor, turning with the shaft; also "20 um TIR", read at the outer radius."""
    runout_phase: Angle = 0.0
    """Of the axis of that tilt, at the start, from the x axis."""
    axial_runout: list[AxialRunout] = field(default_factory=list)
    """Harmonics of the axial motion of the rotor's carrier."""
    waviness: list[Waviness] = field(default_factory=list)
    """Waves around its face, which turn with it."""
    grooves: list[Grooves] = field(default_factory=list)
    """Grooves in its face, which turn with it."""
    support: Support | None = None
    """Springs and dampers to the shaft: the rotor floats."""
    secondary_seal: SecondarySeal | None = None
    """Friction of the O-ring under a floating rotor."""
    load: Load | None = None
    """Force and moments from outside on a floating rotor."""
