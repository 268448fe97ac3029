"""What faces have around the shaft: waves, `[[stator.waviness]]` and `[[rotor.waviness]]`, and spiral and T-grooves,
`[[rotor.grooves]]` and `[[stator.grooves]]`; and how often a scene repeats itself there, and with that whether aligned
rings stay so.

Whatever differs around the circle has an order, how often it repeats itself there: a wave the number of its waves, pads
their count, a tilt one.  Pressure is no linear function of the film thickness, so that parts of orders n and m press
with n - m, too (cos 2a cos 3a holds cos a): all of them together repeat themselves as often as their orders have in
common, the greatest common divisor, and a moment is what repeats itself once.
**Source** Curie (1894), J. Phys. Theor. Appl. 3, 393: effects have at least the symmetry of their causes.
**Valid** the motion that keeps the symmetry; whether a tilt beside it dies out is a question for the modes.
"""

import math
from dataclasses import dataclass
from itertools import pairwise
from typing import Literal

from ..numerics.piecewise_linear import points
from ..units import Angle, Height, Length, Radius
from . import Strict
from .forces import contact_errors, contact_thresholds, load_of, turns_over

# Most waves of both faces together: kernels keep room for them.
MOST_WAVES = 16
# Most columns of triangles to a pitch: a run takes minutes with half of them.
MOST_COLUMNS = 48
# Bands of one share of land each, over dimples.
BANDS = 16
# Keys that a row of grooves has, by its shape, and no other one.
PARTS = {
    **dict.fromkeys(("inner_radius", "outer_radius", "share"), ("spiral", "tee", "pad")),
    **dict.fromkeys(("radius", "length", "width"), ("dimples",)),
    **dict.fromkeys(("stem_outer_radius", "stem_share"), ("tee",)),
}
# Fewest grooves with which tilts about all axes are answered alike.
EVEN = 3
# Finer than a hundredth of the circle a surface is rough or grooved, not wavy.
HIGHEST_ORDER = 100


@dataclass(frozen=True)
class Waviness(Strict):
    """One wave of a ring's face, `amplitude cos(order (theta - ring angle) + phase)` of its height, counted along the
    shaft: on the stator it opens the gap, on the rotor it closes it."""

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


@dataclass(frozen=True)
class Grooves(Strict):
    """One row of equal grooves with sharp edges.

    Spiral: r = inner_radius exp(theta tan(angle)) along an edge, straight in (ln r, theta).  Tee: arms between the two
    radii over `share` of the pitch, and a stem outwards from their middle, with radial sides.  Pad: a pocket between
    the two radii over `share` of the pitch, with radial sides (Rayleigh steps, hydropads).  Dimples: ellipses around
    the radius of their centres."""

    count: int
    """Grooves to the circle."""
    depth: Height
    """By which the film is thicker in them; `h_min` and touch take them for land."""
    inner_radius: Radius | None = None
    """Where they begin; that of the face where they open there.  Not of dimples."""
    outer_radius: Radius | None = None
    """Where they end, or the arms of a tee.  Not of dimples."""
    share: float | None = None
    """Share of the pitch that is groove, arms or pad.  Not of dimples."""
    shape: Literal["spiral", "tee", "pad", "dimples"] = "spiral"
    """Spiral grooves, arms with a stem, pads (radial sides), or elliptic dimples."""
    angle: Angle | None = None
    """Of a spiral, or of the length of a dimple (0), to the circle: positive where the radius grows with theta, the
    sense of a positive shaft speed."""
    stem_outer_radius: Radius | None = None
    """Of a tee: where its stem ends."""
    stem_share: float | None = None
    """Of a tee: share of the pitch that is stem."""
    radius: Radius | None = None
    """Of dimples: that of their centres."""
    length: Length | None = None
    """Of dimples: whole axis at the `angle` to the circle."""
    width: Length | None = None
    """Of dimples: whole axis across."""
    phase: Angle = 0.0
    """Angle of the middle of the first groove at its inner radius, at the angle zero of its ring."""

    @property
    def ellipse(self) -> tuple[float, float, float]:
        """Of dimples a, b and c (1/m^2) of a x^2 + 2 b x y + c y^2 = 1 on their edge, x along the circle, y across."""
        cos, sin = math.cos(self.angle or 0.0), math.sin(self.angle or 0.0)
        along, across = (2.0 / self.length) ** 2, (2.0 / self.width) ** 2
        return (along * cos**2 + across * sin**2, (along - across) * cos * sin, along * sin**2 + across * cos**2)

    @property
    def reach(self) -> tuple[float, float]:
        """Radii (m) between which they lie, a tee's without its stem."""
        if self.shape != "dimples":
            return self.inner_radius, self.outer_radius
        a, b, c = self.ellipse
        half = math.sqrt(a / (a * c - b * b)) / self.radius
        return self.radius * math.exp(-half), self.radius * math.exp(half)


def grooves_of(scene) -> tuple[str, tuple[Grooves, ...]]:
    """The ring that has grooves, "rotor" or "stator", and them; "" and none where neither has any."""
    for name, ring in (("rotor", scene.rotor), ("stator", scene.stator)):
        if ring.grooves:
            return name, tuple(ring.grooves)
    return "", ()


def land_shares(scene) -> tuple[list[float], list[float]] | None:
    """Radii (m) of a scene's face at which the share of land on a circle changes, from edge to edge of the face, and
    that share between each and the next; None without grooves."""
    for one in grooves_of(scene)[1]:
        if one.shape == "dimples":
            return _land_of_dimples(scene.film, one)
        ends = [scene.film.inner_radius, one.inner_radius, one.outer_radius, scene.film.outer_radius]
        shares = [1.0, 1.0 - one.share, 1.0]
        if one.shape == "tee":
            ends.insert(3, one.stem_outer_radius)
            shares.insert(2, 1.0 - one.stem_share)
        wide = [n for n in range(len(shares)) if ends[n + 1] > ends[n]]
        return [ends[wide[0]], *(ends[n + 1] for n in wide)], [shares[n] for n in wide]
    return None


def _land_of_dimples(film, one: Grooves) -> tuple[list[float], list[float]]:
    (low, high), (a, b, c) = one.reach, one.ellipse
    radii = [low + (high - low) * k / BANDS for k in range(BANDS + 1)]
    lands = []
    for inner, outer in pairwise(radii):
        y = one.radius * math.log(0.5 * (inner + outer) / one.radius)
        chord = 2.0 * math.sqrt(max((b * y) ** 2 - a * (c * y * y - 1.0), 0.0)) / a
        lands.append(max(1.0 - chord * one.count / (2.0 * math.pi * one.radius), 0.0))
    return [film.inner_radius, *radii, film.outer_radius], [1.0, *lands, 1.0]


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
    for part, shapes in PARTS.items():
        if (getattr(one, part) is not None) != (one.shape in shapes):
            others = " or ".join(f'"{shape}"' for shape in shapes)
            given = one.shape not in shapes
            bad.append(
                (part, "a value" if given else "nothing", f"nothing, or shape = {others}" if given else "a value")
            )
    if bad:
        return bad
    if one.shape == "dimples":
        return _dimple_errors(one, film)
    if not film.inner_radius <= one.inner_radius < one.outer_radius <= film.outer_radius:
        found = f"{one.inner_radius:g} to {one.outer_radius:g} m"
        expected = f"radii that increase, between {film.inner_radius:g} and {film.outer_radius:g} m, those of the face"
        bad.append(("inner_radius", found, expected))
    if not 0.0 < one.share < 1.0:
        bad.append(("share", f"{one.share:g}", "a share of the pitch above 0 and below 1"))
    if tee and not bad:
        if not one.outer_radius < one.stem_outer_radius <= film.outer_radius:
            expected = f"more than outer_radius = {one.outer_radius:g} m, at most that of the face"
            bad.append(("stem_outer_radius", f"{one.stem_outer_radius:g} m", expected))
        if not 0.0 < one.stem_share < one.share:
            bad.append(("stem_share", f"{one.stem_share:g}", f"above 0 and below share = {one.share:g}, the arms"))
    spiral = one.shape == "spiral"
    if not spiral and one.angle is not None:
        bad.append(("angle", "a value", f'nothing: the sides of shape = "{one.shape}" are radial'))
    if spiral and not (one.angle is not None and 0.0 < abs(one.angle) < 0.5 * math.pi):
        found = "nothing" if one.angle is None else f"{one.angle:g} rad"
        expected = (
            "the groove's angle to the circle, between 0 and 90 deg, positive where its radius grows with theta, "
            "negative the other way round (papers that say 165 deg mean -15 deg, others count from the radius)"
        )
        bad.append(("angle", found, expected))
    return bad


def _dimple_errors(one: Grooves, film) -> list[tuple[str, str, str]]:
    bad = [(part, f"{getattr(one, part):g} m", "a length above 0") for part in ("length", "width")
           if not getattr(one, part) > 0.0]  # fmt: skip
    if bad:
        return bad
    low, high = one.reach
    if not film.inner_radius < low < high < film.outer_radius:
        expected = f"dimples between the edges of the face, {film.inner_radius:g} and {film.outer_radius:g} m"
        bad.append(("radius", f"{one.radius:g} m, with dimples from {low:.5g} to {high:.5g} m", expected))
    return bad


def _beside_errors(scene) -> list[tuple[str, str, str]]:
    """What no film over grooves reckons with yet."""
    film, gas = scene.film, scene.film.gas is not None
    models = ("auto", "gas_reynolds" if gas else "reynolds")
    has = {
        "film.profile": film.profile, "film.pads": film.pads, "film.inertia": film.inertia, "film.heat": film.heat,
        "contact": None if gas else scene.contact,
        "stator.elastic": scene.stator.elastic, "stator.secondary_seal": scene.stator.secondary_seal,
        "rotor.secondary_seal": scene.rotor.secondary_seal, "stator.waviness": waves_of(scene),
    }  # fmt: skip
    bad = [(key, "a value", "nothing") for key, value in has.items() if value]
    if gas and scene.contact and not contact_errors(scene.contact):
        _, touch, flat = contact_thresholds(scene.contact)
        name, (one,) = grooves_of(scene)
        if one.depth < touch - flat:
            expected = f"at least {touch - flat:.4g} m, into which no asperity of [contact] reaches,"
            bad.append((f"{name}.grooves.0.depth", f"{one.depth:g} m", expected))
    for name in ("gas_reynolds", "reynolds"):
        options = getattr(film, name)
        if options is not None and not 2 <= options.columns <= MOST_COLUMNS:
            bad.append((f"film.{name}.columns", f"{options.columns}", f"2 to {MOST_COLUMNS}"))
    if film.model not in models:
        bad.append(("film.model", f'"{film.model}"', f'"{models[0]}" or "{models[1]}"'))
    for key, only in (("geometry", "cylindrical"), ("tilt_radius", "local")):
        if getattr(film, key) != only:
            bad.append((f"film.{key}", f'"{getattr(film, key)}"', f'"{only}"'))
    return bad


# --- symmetry ----------------------------------------------------------------------------------------------


def alike_sectors(scene, faces_press: bool = True) -> int:
    """Into how many sectors that are alike at any time a scene falls: 1 where a ring tilts, 0 (any number) where
    nothing differs around the circle; `faces_press`: whether the pressure feels waves and pads."""
    tilt = (1,) if tilt_is_imposed(scene) or tilt_is_given(scene) else ()
    return math.gcd(*(face_orders(scene) if faces_press else ()), *tilt)


def face_orders(scene) -> list[int]:
    """Orders of what the faces of a scene have around the circle: waves, pads and grooves."""
    waves = {wave.order for wave in waves_of(scene) if wave.amplitude}
    return sorted(waves | {row.count for row in (*scene.film.pads, *grooves_of(scene)[1]) if row.depth})


def faces_tilt(scene) -> bool:
    """Whether the faces of a scene, aligned, press with a moment by their waves and pads."""
    return math.gcd(*face_orders(scene)) == 1


def tilt_is_imposed(scene) -> bool:
    """Whether anything but its own start and its faces ever tilts a ring."""
    rotor, stator = scene.rotor, scene.stator
    tilts = [rotor.misalignment if rotor.support else rotor.runout, stator.misalignment]
    tilts += [whirl.angle for whirl in scene.shaft.whirl]
    # The film's force on an arm.
    tilts += [scene.film.offset]
    for ring, speed in ((rotor, scene.shaft.speed), (stator, stator.speed)):
        if ring.support and ring.mass_centre and ring.mass_centre.axial:
            tilts += [scene.housing.gravity] + ([speed] if ring.mass_centre.eccentricity else [])
    vibrations = (*scene.housing.angular_tones, *scene.housing.angular_sweep)
    shaken = any(vibration.displacement or vibration.acceleration for vibration in vibrations)
    sampled = (m for m in (scene.housing.motion, scene.shaft.motion) if m)
    shaken = shaken or any(m.moves("tilt_x") or m.moves("tilt_y") for m in sampled)
    shaken = shaken or any(turns_over(load_of(ring)) for ring in (rotor, stator))
    return shaken or any(any(points(tilt)) for tilt in tilts)


def tilt_is_given(scene) -> bool:
    """Whether a floating ring starts with a tilt, or with a rate of it, by [initial]."""
    starts = ((scene.rotor, scene.initial.rotor), (scene.stator, scene.initial.stator))
    moved = [start for ring, start in starts if ring.support is not None]
    return any(v for s in moved for v in (s.tilt_x, s.tilt_y, s.tilt_x_rate, s.tilt_y_rate))
