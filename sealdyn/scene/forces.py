"""What acts on a ring beside film and support: asperities of faces that may touch, the `[contact]` table of roughness,
strength, friction and wear; loads from outside, constant or over time, as tones, and by samples of a record; the O-ring
under the ring and other places that rub along the shaft, friction and what gives before it.

Loads act on the ring beside film, support and closing force and do work on it.  The axial force points along z, from
the rotor to the stator: positive it opens the gap of a floating stator and closes that of a floating rotor."""

import math
from dataclasses import dataclass, field
from typing import Literal, NamedTuple

from ..numerics.piecewise_linear import points
from ..quantities import in_words
from ..units import (
    Angle,
    AsperityDensity,
    Force,
    Frequency,
    Height,
    LineForce,
    Listed,
    Moment,
    Radius,
    Roughness,
    Share,
    Stiffness,
    Stress,
    Varying,
    Velocity,
    WearCoefficient,
)
from . import Strict
from .excitation import Samples

# Half height of Christensen's surface, and the reach of a Gaussian one, in rms roughnesses.
HALF_HEIGHT, REACH = 3.0, 5.0


@dataclass(frozen=True)
class Contact(Strict):
    """The `[contact]` table.  `roughness` (m) is the composite rms of both faces, `compressive_strength` (Pa) that of
    the softer one; shear of the touching area is `shear_strength` (Pa), or `friction_coefficient` (0.1 when neither is
    given) times the contact pressure; `asperity_...` and the composite `modulus` belong to Greenwood and Williamson."""

    roughness: Roughness
    """Composite rms roughness of both faces; they meet at 3 rms, Gaussian heights at 5 (finish of each face about 0.1
    um, NASA CR-120997)."""
    law: Literal["christensen", "greenwood-williamson", "plateaus"] = "christensen"
    """Christensen's bounded height distribution, Greenwood and Williamson's Gaussian one, or Gaussian heights that are
    worn to plateaus."""
    compressive_strength: Stress | None = None
    """Of the softer face, for "christensen" and "plateaus"."""
    friction_coefficient: Share | None = None
    """Friction over contact load; 0.1 without it and without `shear_strength` (carbon graphite that runs dry: 0.1 to
    0.25, NASA CR-120997)."""
    shear_strength: Stress | None = None
    """Friction over touching area, in place of `friction_coefficient`."""
    stator_wear_coefficient: WearCoefficient = 0.0
    """Archard: wear depth over contact pressure and sliding distance."""
    rotor_wear_coefficient: WearCoefficient = 0.0
    """The same, of the rotor's face."""
    asperity_density: AsperityDensity | None = None
    """Peaks per area, for "greenwood-williamson"."""
    asperity_radius: Height | None = None
    """Radius of the peaks, for "greenwood-williamson"."""
    modulus: Stress | None = None
    """Composite elastic modulus, for "greenwood-williamson"."""
    truncation: float | None = None
    """Height at which each face is worn flat, over its mean plane and in its own rms heights, for "plateaus"."""
    plateau_roughness: Roughness | None = None
    """Composite rms roughness of the plateaus themselves, which meet at 3 of it, for "plateaus"."""


LAW_KEYS = {
    "christensen": ("compressive_strength",),
    "greenwood-williamson": ("asperity_density", "asperity_radius", "modulus"),
    "plateaus": ("compressive_strength", "truncation", "plateau_roughness"),
}


def contact_errors(contact: Contact) -> list[tuple[str, str, str]]:
    """What cannot be in a `[contact]` table: (key, found, expected), in the order of the table."""
    bad = []
    wanted = ("roughness", *LAW_KEYS[contact.law])
    for key in dict.fromkeys(key for keys in LAW_KEYS.values() for key in keys):
        if key not in wanted and getattr(contact, key) is not None:
            laws = " or ".join(f'"{law}"' for law, keys in LAW_KEYS.items() if key in keys)
            bad.append((key, f"a value, with law = {contact.law!r}", f"nothing, or law = {laws}"))
    for key in wanted:
        value = getattr(contact, key)
        if value is None:
            bad.append((key, "nothing", f'a value > 0: law = "{contact.law}" needs it'))
        elif not 0.0 < value < math.inf:
            bad.append((key, f"{value:g}", "a value > 0"))
    if contact.law == "plateaus" and not bad:
        if contact.truncation > REACH:
            bad.append(("truncation", f"{contact.truncation:g}", f"at most {REACH:g}: beyond it nothing is worn flat"))
        elif plateau_height(contact) <= HALF_HEIGHT * contact.plateau_roughness:
            most = f"less than {plateau_height(contact) / HALF_HEIGHT:g} m: plateaus are smoother than they are high"
            bad.append(("plateau_roughness", f"{contact.plateau_roughness:g} m", most))
    if contact.friction_coefficient is not None and contact.shear_strength is not None:
        bad.append(("shear_strength", "a value beside friction_coefficient", "one of the two"))
    for key in ("friction_coefficient", "shear_strength", "stator_wear_coefficient", "rotor_wear_coefficient"):
        value = getattr(contact, key)
        if value is not None and not 0.0 <= value < math.inf:
            bad.append((key, f"{value:g}", "a value >= 0"))
    return bad


def plateau_height(contact: Contact) -> float:
    """Mean film h (m) at which the plateaus of both faces meet, each with its share 1/sqrt(2) of the rms roughness; 0
    of another law."""
    return math.sqrt(2.0) * contact.truncation * contact.roughness if contact.law == "plateaus" else 0.0


def finish(contact: Contact) -> float:
    """Rms roughness (m) of what touches: of the plateaus of faces that are worn to them."""
    return contact.plateau_roughness if contact.law == "plateaus" else contact.roughness


def contact_thresholds(contact: Contact) -> tuple[float, float, float]:
    """Mean films h (m), with c = 3 rms roughnesses: (film_floor, touch, collapse).

    film_floor  0.6 c: below it the film at an edge of the face is continued (`geometry.regularised_thickness`, floor/2
                at h = 0), as rough faces do: E(H^3)^(1/3) at h = 0 is 0.30 c (Christensen), 0.31 c (Gaussian); between
                the edges it stays linear in r, so where one of them is below, places above it are thicker, too.
    touch       where the first asperities meet: c; 5 rms for Gaussian heights, whose load there is 1e-7 of that at 0.
    collapse    -c: all asperities are flattened, and the law has nothing more to say.

    Plateaus: (where they meet, where their own asperities do, 0: they have worn through to the mean planes).
    """
    c, plateau = HALF_HEIGHT * contact.roughness, plateau_height(contact)
    if plateau:
        return plateau, plateau + HALF_HEIGHT * contact.plateau_roughness, 0.0
    return 0.6 * c, c if contact.law == "christensen" else REACH * contact.roughness, -c


def film_in_words(thickness: float) -> str:
    """A film thickness (m); below none the faces, as their mean planes lie, overlap."""
    thickest = in_words("h_min", abs(thickness))
    return f"thinnest {thickest}" if thickness >= 0.0 else f"faces overlap by {thickest}"


def limit_in_words(lowest: float) -> str:
    """The film (m) at which a run ends: a floor above 0, or where rough faces overlap until their asperities are
    flat."""
    if lowest >= 0.0:
        return f"the floor, {in_words('h_min', lowest, 3)}"
    return f"all asperities flat, which overlap by {in_words('h_min', -lowest, 3)} then"


def touch_height(scene) -> float:
    """Film thickness h (m) at which the first asperities of a scene's faces meet; 0 for smooth faces."""
    return contact_thresholds(scene.contact)[1] if scene.contact else 0.0


LOAD_COLUMNS = ("force", "moment_x", "moment_y")


@dataclass(frozen=True)
class LoadTone(Strict):
    """A force along the shaft axis and a moment about a fixed axis, cos(2 pi frequency t + phase)."""

    frequency: Frequency
    """Of both."""
    force: Force = 0.0
    """Amplitude along the shaft axis."""
    moment: Moment = 0.0
    """Amplitude about the axis at `direction`."""
    direction: Angle = 0.0
    """Of the axis of the moment, from the x axis."""
    phase: Angle = 0.0
    """Of the cosine, at the start."""


@dataclass(frozen=True)
class LoadSamples(Samples):
    """Force and moments of a record, along the spline of fifth degree through its samples."""

    force: Listed[Force] | None = None
    """Along the shaft axis; none without it."""
    moment_x: Listed[Moment] | None = None
    """About the x axis; none without it."""
    moment_y: Listed[Moment] | None = None
    """About the y axis; none without it."""

    def columns(self) -> list[tuple[float, ...]]:
        """Force (N) and moments (N m) at the times, zeros where none are given."""
        return [getattr(self, name) or (0.0,) * len(self.time) for name in LOAD_COLUMNS]


@dataclass(frozen=True)
class Load(Strict):
    """The `[stator.load]` or `[rotor.load]` table: what pulls at a floating ring from outside, in the axes of the
    housing."""

    force: Varying[Force] = 0.0
    """Along the shaft axis, from rotor to stator where positive."""
    moment_x: Varying[Moment] = 0.0
    """About the x axis."""
    moment_y: Varying[Moment] = 0.0
    """About the y axis."""
    turns: bool = False
    """Whether the axes of `moment_x` and `moment_y` turn with the ring's carrier."""
    tone: list[LoadTone] = field(default_factory=list)
    """Tones of force and moment, in the axes of the housing."""
    samples: LoadSamples | None = None
    """Force and moments of a record, in the axes of the housing."""
    model: str | None = None
    """A load from outside by its name, smooth functions of time, which become `samples`; its options in a table of that
    name."""

    def varying(self) -> tuple:
        """What may be a function of time."""
        return self.force, self.moment_x, self.moment_y


def load_of(ring) -> Load | None:
    """The load on a Stator or Rotor that floats; None without."""
    return ring.load if ring.support else None


def standing(load: Load | None) -> Load | None:
    """What is left of a load of constant numbers where nothing is imposed: the force that moves the aligned rest."""
    return Load(force=load.force) if load is not None and load.force else None


def samples_of_loads(scene) -> dict[int, LoadSamples]:
    """Records of force by the ring that they pull at, 0 stator, 1 rotor."""
    loads = {0: load_of(scene.stator), 1: load_of(scene.rotor)}
    return {ring: load.samples for ring, load in loads.items() if load is not None and load.samples is not None}


def pulls(load: Load | None) -> bool:
    """Whether it has an axial force at any time."""
    if load is None:
        return False
    sampled = load.samples is not None and any(load.samples.force or ())
    return sampled or any(points(load.force)) or any(tone.force for tone in load.tone)


def turns_over(load: Load | None) -> bool:
    """Whether it has a moment at any time."""
    if load is None:
        return False
    moments = () if load.samples is None else (*(load.samples.moment_x or ()), *(load.samples.moment_y or ()))
    steady = any(points(load.moment_x)) or any(points(load.moment_y))
    return steady or any(moments) or any(tone.moment for tone in load.tone)


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
