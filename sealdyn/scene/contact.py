"""The `[contact]` table: roughness, strength, friction and wear of faces that may touch."""

import math
from dataclasses import dataclass
from typing import Literal

from ..units import AsperityDensity, Height, Roughness, Share, Stress, WearCoefficient
from . import Strict

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
