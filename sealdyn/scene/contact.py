"""The `[contact]` table: roughness, strength, friction and wear of faces that may touch; and the waviness of the faces,
`[[stator.waviness]]` and `[[rotor.waviness]]`, and their spiral grooves and T-grooves, `[[rotor.grooves]]` and
`[[stator.grooves]]`."""

import math
from dataclasses import dataclass
from typing import Literal

from ..numerics.piecewise_linear import points
from ..units import Angle, AsperityDensity, Height, Radius, Roughness, Share, Stress, WearCoefficient

# Most waves of both faces together: kernels keep room for them.
MOST_WAVES = 16
# Finer than a hundredth of the circle a surface is rough or grooved, not wavy.
HIGHEST_ORDER = 100


@dataclass(frozen=True)
class Waviness:
    """One wave of a ring's face, `amplitude cos(order (theta - ring angle) + phase)` of its height, counted along the
    shaft: on the stator it opens the gap, on the rotor it closes it."""

    __pydantic_config__ = {"extra": "forbid"}  # noqa: RUF012

    order: int
    """Waves to the circle, 2 to 100 (order 1 is a tilt)."""
    amplitude: Height
    """Half the height from trough to crest."""
    phase: Angle = 0.0
    """Of the wave at the angle zero of its ring."""


def waves_of(scene) -> list[Waviness]:
    """Waves (Waviness) of both faces of a scene, the stator's first."""
    return [*scene.stator.waviness, *scene.rotor.waviness]


def turning_waves(scene) -> str:
    """Key of the waves of a face that ever turns, "" if all stand still."""
    for name, ring, speed in (("stator", scene.stator, scene.stator.speed), ("rotor", scene.rotor, scene.shaft.speed)):
        if any(wave.amplitude for wave in ring.waviness) and any(points(speed)):
            return f"{name}.waviness"
    return ""


def waviness_errors(scene) -> list[tuple[str, str, str]]:
    """What the wavy faces of a scene cannot have: (key, found, expected)."""
    bad = []
    for name, ring in (("stator", scene.stator), ("rotor", scene.rotor)):
        for n, wave in enumerate(ring.waviness):
            key = f"{name}.waviness.{n}"
            if not 2 <= wave.order <= HIGHEST_ORDER or wave.order != int(wave.order):
                whole = f"a whole number from 2 (1 is a tilt, 0 a clearance: give them as such) to {HIGHEST_ORDER}"
                bad.append((f"{key}.order", f"{wave.order}", whole))
            if not 0.0 <= wave.amplitude < math.inf:
                bad.append((f"{key}.amplitude", f"{wave.amplitude:g} m", "a finite length >= 0"))
            if not math.isfinite(wave.phase):
                bad.append((f"{key}.phase", f"{wave.phase:g} rad", "a finite angle"))
    waves = waves_of(scene)
    if len(waves) > MOST_WAVES:
        blame = "rotor.waviness" if scene.rotor.waviness else "stator.waviness"
        bad.append((blame, f"{len(waves)} waves in all", f"at most {MOST_WAVES}"))
    if waves and scene.contact and scene.film.model != "reynolds":
        expected = 'film.model = "reynolds", or no such table: other films end a run where wavy faces meet'
        bad.append(("contact", "a table beside wavy faces", expected))
    return bad


# What serves a scene with grooves so far.
SERVED = "studies equilibrium, load-support, stribeck and coefficients: nothing else reckons with grooves yet"


@dataclass(frozen=True)
class Grooves:
    """One row of equal grooves with sharp edges.

    Spiral: r = inner_radius exp(theta tan(angle)) along an edge, straight in (ln r, theta).  Tee: arms between the two
    radii over `share` of the pitch, and a stem outwards from their middle, with radial sides."""

    __pydantic_config__ = {"extra": "forbid"}  # noqa: RUF012

    count: int
    """Grooves to the circle."""
    depth: Height
    """By which the film is thicker in them."""
    inner_radius: Radius
    """Where they begin; that of the face where they open there."""
    outer_radius: Radius
    """Where they end, or the arms of a tee."""
    share: float
    """Share of the pitch that is groove, or arms."""
    shape: Literal["spiral", "tee"] = "spiral"
    """Spiral grooves, or arms with a stem."""
    angle: Angle | None = None
    """Of a spiral to the circle: positive where the groove's radius grows with theta, the sense of a positive shaft
    speed."""
    stem_outer_radius: Radius | None = None
    """Of a tee: where its stem ends."""
    stem_share: float | None = None
    """Of a tee: share of the pitch that is stem."""
    phase: Angle = 0.0
    """Angle of the middle of the first groove at its inner radius, at the angle zero of its ring."""


def grooves_of(scene) -> tuple[str, tuple[Grooves, ...]]:
    """The ring that has grooves, "rotor" or "stator", and them; "" and none where neither has any."""
    for name in ("rotor", "stator"):
        if getattr(scene, name).grooves:
            return name, tuple(getattr(scene, name).grooves)
    return "", ()


def grooves_errors(scene) -> list[tuple[str, str, str]]:
    """What a scene with grooves cannot have: (key, found, expected)."""
    name, grooves = grooves_of(scene)
    if not grooves:
        return []
    key = f"{name}.grooves"
    if len(grooves) > 1 or (name == "rotor" and scene.stator.grooves):
        return [(key, "more than one row of grooves", "one row, in one of the faces")]
    return [(f"{key}.0.{part}", *words) for part, *words in _shape_errors(grooves[0], scene.film)] or [
        (part, found, f"{wanted} beside {key}") for part, found, wanted in _beside_errors(scene)
    ]


def _shape_errors(one: Grooves, film) -> list[tuple[str, str, str]]:
    bad, tee = [], one.shape == "tee"
    if one.count < 1:
        bad.append(("count", f"{one.count}", "a whole number from 1"))
    if not 0.0 <= one.depth < math.inf:
        bad.append(("depth", f"{one.depth:g} m", "a finite depth >= 0, by which the film is thicker in a groove"))
    if not film.inner_radius <= one.inner_radius < one.outer_radius <= film.outer_radius:
        found = f"{one.inner_radius:g} to {one.outer_radius:g} m"
        expected = f"radii that increase, between {film.inner_radius:g} and {film.outer_radius:g} m, those of the face"
        bad.append(("inner_radius", found, expected))
    if not 0.0 < one.share < 1.0:
        bad.append(("share", f"{one.share:g}", "a share of the pitch above 0 and below 1"))
    for part in ("stem_outer_radius", "stem_share"):
        if (getattr(one, part) is not None) != tee:
            bad.append((part, "nothing" if tee else "a value", "a value" if tee else 'nothing, or shape = "tee"'))
    if tee and not bad:
        if not one.outer_radius < one.stem_outer_radius <= film.outer_radius:
            expected = f"more than outer_radius = {one.outer_radius:g} m, at most that of the face"
            bad.append(("stem_outer_radius", f"{one.stem_outer_radius:g} m", expected))
        if not 0.0 < one.stem_share < one.share:
            bad.append(("stem_share", f"{one.stem_share:g}", f"above 0 and below share = {one.share:g}, the arms"))
    if tee and one.angle is not None:
        bad.append(("angle", "a value", 'nothing: the sides of shape = "tee" are radial'))
    if not tee and not (one.angle is not None and 0.0 < abs(one.angle) < 0.5 * math.pi):
        found = "nothing" if one.angle is None else f"{one.angle:g} rad"
        expected = (
            "the groove's angle to the circle, between 0 and 90 deg, positive where its radius grows with theta, "
            "negative the other way round (papers that say 165 deg mean -15 deg, others count from the radius)"
        )
        bad.append(("angle", found, expected))
    return bad


def _beside_errors(scene) -> list[tuple[str, str, str]]:
    """What no film over grooves reckons with yet."""
    film, gas = scene.film, scene.film.gas is not None
    models = ("auto", "gas_reynolds" if gas else "reynolds")
    has = {
        "film.profile": film.profile, "film.pads": film.pads, "film.inertia": film.inertia, "film.heat": film.heat,
        "film.cavitation_pressure": film.cavitation_pressure, "contact": scene.contact,
        "stator.elastic": scene.stator.elastic, "stator.secondary_seal": scene.stator.secondary_seal,
        "rotor.secondary_seal": scene.rotor.secondary_seal, "stator.waviness": waves_of(scene),
    }  # fmt: skip
    bad = [
        (key, "a value", "nothing")
        for key, value in has.items()
        if not (value is None or value is False or value == [])
    ]
    if film.model not in models:
        bad.append(("film.model", f'"{film.model}"', f'"{models[0]}" or "{models[1]}"'))
    for key, only in (("geometry", "cylindrical"), ("tilt_radius", "local")):
        if getattr(film, key) != only:
            bad.append((f"film.{key}", f'"{getattr(film, key)}"', f'"{only}"'))
    return bad


# Half height of Christensen's surface, and the reach of a Gaussian one, in rms roughnesses.
HALF_HEIGHT, REACH = 3.0, 5.0


@dataclass(frozen=True)
class Contact:
    """The `[contact]` table.  `roughness` (m) is the composite rms of both faces, `compressive_strength` (Pa) that of
    the softer one; shear of the touching area is `shear_strength` (Pa), or `friction_coefficient` (0.1 when neither is
    given) times the contact pressure; `asperity_...` and the composite `modulus` belong to Greenwood and Williamson."""

    __pydantic_config__ = {"extra": "forbid"}  # noqa: RUF012

    roughness: Roughness
    """Composite rms roughness of both faces; they meet at 3 rms, Gaussian heights at 5 (finish of each face about 0.1
    um, NASA CR-120997)."""
    law: Literal["christensen", "greenwood-williamson"] = "christensen"
    """Christensen's bounded height distribution, or Greenwood and Williamson's Gaussian one."""
    compressive_strength: Stress | None = None
    """Of the softer face, for "christensen"."""
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


LAW_KEYS = {
    "christensen": ("compressive_strength",),
    "greenwood-williamson": ("asperity_density", "asperity_radius", "modulus"),
}


def contact_errors(contact: Contact) -> list[tuple[str, str, str]]:
    """What cannot be in a `[contact]` table: (key, found, expected), in the order of the table."""
    bad = []
    wanted = ("roughness", *LAW_KEYS[contact.law])
    for law, keys in LAW_KEYS.items():
        if law != contact.law:
            bad += [
                (key, f"a value, with law = {contact.law!r}", f'nothing, or law = "{law}"')
                for key in keys
                if getattr(contact, key) is not None
            ]
    for key in wanted:
        value = getattr(contact, key)
        if value is None:
            bad.append((key, "nothing", f'a value > 0: law = "{contact.law}" needs it'))
        elif not 0.0 < value < math.inf:
            bad.append((key, f"{value:g}", "a value > 0"))
    if contact.friction_coefficient is not None and contact.shear_strength is not None:
        bad.append(("shear_strength", "a value beside friction_coefficient", "one of the two"))
    for key in ("friction_coefficient", "shear_strength", "stator_wear_coefficient", "rotor_wear_coefficient"):
        value = getattr(contact, key)
        if value is not None and not 0.0 <= value < math.inf:
            bad.append((key, f"{value:g}", "a value >= 0"))
    return bad


def contact_thresholds(contact: Contact) -> tuple[float, float, float]:
    """Mean films h (m), with c = 3 rms roughnesses: (film_floor, touch, collapse).

    film_floor  0.6 c: below it the film at an edge of the face is continued (`geometry.regularised_thickness`, floor/2
                at h = 0), as rough faces do: E(H^3)^(1/3) at h = 0 is 0.30 c (Christensen), 0.31 c (Gaussian); between
                the edges it stays linear in r, so where one of them is below, places above it are thicker, too.
    touch       where the first asperities meet: c; 5 rms for Gaussian heights, whose load there is 1e-7 of that at 0.
    collapse    -c: all asperities are flattened, and the law has nothing more to say.
    """
    c = HALF_HEIGHT * contact.roughness
    return 0.6 * c, c if contact.law == "christensen" else REACH * contact.roughness, -c


def film_in_words(thickness: float) -> str:
    """A film thickness (m); below none the faces, as their mean planes lie, overlap."""
    return f"thinnest {thickness * 1e6:.4g} um" if thickness >= 0.0 else f"faces overlap by {-thickness * 1e6:.4g} um"


def limit_in_words(lowest: float) -> str:
    """The film (m) at which a run ends: a floor above 0, or where rough faces overlap until their asperities are
    flat."""
    if lowest >= 0.0:
        return f"the floor, {lowest * 1e6:.3g} um"
    return f"all asperities flat, which overlap by {-lowest * 1e6:.3g} um then"


def touch_height(scene) -> float:
    """Film thickness h (m) at which the first asperities of a scene's faces meet; 0 for smooth faces."""
    return contact_thresholds(scene.contact)[1] if scene.contact else 0.0
