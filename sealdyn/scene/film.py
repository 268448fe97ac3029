"""The `[film]` table: faces, fluid and pressures, its pads and the options of the Reynolds film; the profile of faces
that are not plain cones; and coning that follows time, the speed of the shaft, which turns a ring inside out, the
temperature of the film and the sealed pressure,

    coning = film.coning(t) + coning_per_speed_squared w^2 + coning_per_kelvin (T - coning_reference_temperature)
             + coning_per_pressure (|p_o - p_i| - coning_reference_pressure)

**Source** of the coning: Zuk, NASA TM X-68022 (1972), Figs. 2 and 3: sketches of centrifugal and thermal coning,
without numbers; in linear elasticity the first goes with the square of the speed, the second with the temperature.
**Valid** rings that deform far slower than they vibrate; the numbers are the user's.
"""

import math
from dataclasses import dataclass, field, replace
from itertools import pairwise
from typing import Annotated, Literal

import numpy as np

from ..numerics.piecewise_linear import PiecewiseLinear, initially
from ..units import (
    Angle,
    AxialFilmDamping,
    AxialFilmStiffness,
    ConingPerKelvin,
    ConingPerSpeedSquared,
    Density,
    Height,
    Length,
    Listed,
    Pressure,
    Quantity,
    Radius,
    SignedTiltDamping,
    SignedTiltStiffness,
    SpecificHeat,
    Temperature,
    Tilt,
    Usual,
    Varying,
    Viscosity,
)
from . import Strict
from .fluid import Gas, GasDam, GasName, GasReynolds, Heat, Liquid, LiquidName
from .tabulated import Tabulated

PressureDifference = Annotated[float, Quantity("pressure difference", "Pa", '"10 bar"', (), 0,
    usual=Usual(1e3, 1e9, "bar"))]  # fmt: skip
ConingPerPressure = Annotated[float, Quantity("coning per pressure", "rad/Pa", '"-20 urad/bar"',
    usual=Usual(0.0, 1e-8, "urad/bar"))]  # fmt: skip


def follows_speed(film) -> bool:
    """Whether the coning of a `Film` follows the shaft speed."""
    return film.coning_per_speed_squared != 0.0


def coning_varies(film) -> bool:
    """Whether the coning of a `Film` may be another than the number of its key."""
    follows = film.coning_per_kelvin != 0.0 or film.coning_per_pressure != 0.0
    return isinstance(film.coning, PiecewiseLinear) or follows_speed(film) or follows


def coning_change(scene, value=initially, speed=None) -> float:
    """By how much (rad) the coning of a scene differs from what `film.coning` is at time zero; `value` takes the number
    of a function of time, `speed` (rad/s) is the shaft's in place of the scene's."""
    film = scene.film
    if not coning_varies(film):
        return 0.0
    speed = value(scene.shaft.speed) if speed is None else speed
    change = value(film.coning) - initially(film.coning) + film.coning_per_speed_squared * speed**2
    if film.coning_per_kelvin:
        change += film.coning_per_kelvin * (value(film.temperature) - film.coning_reference_temperature)
    if film.coning_per_pressure:
        sealed = abs(value(film.outer_pressure) - value(film.inner_pressure))
        change += film.coning_per_pressure * (sealed - film.coning_reference_pressure)
    return change


def coned(scene, value=initially, speed=None):
    """The `Film` table of a scene with its coning as a number: arguments as of `coning_change`."""
    film = scene.film
    if not coning_varies(film):
        return film
    coning = initially(film.coning) + coning_change(scene, value, speed)
    none = dict.fromkeys(("coning_per_speed_squared", "coning_per_kelvin", "coning_per_pressure"), 0.0)
    return replace(film, coning=coning, **none, coning_reference_temperature=None, coning_reference_pressure=None)


# Edge of a pad's flank where it is not given, as a share of the pad's shorter side.
SHARP = 0.05


@dataclass(frozen=True)
class Pads(Strict):
    """One row of equal pads around the face: the film is thicker by `depth` over the angle of each pad and between its
    radii, with smooth flanks,

        depth/2 [tanh((x - a)/edge) - tanh((x - b)/edge)] over the radius, and the same around the circle

    A pad that reaches to a radius of the face is open there.  **Valid** pads far wider than `edge`, which cells must
    resolve."""

    count: int
    """Pads to the circle."""
    depth: Height
    """By which the film is thicker in the pads; `h_min`, touch and contact take them for land."""
    angle: Angle
    """Of one pad, between the middles of its flanks."""
    inner_radius: Radius
    """Where a pad begins."""
    outer_radius: Radius
    """Where it ends."""
    edge: Length | None = None
    """Width of its flanks, from an eighth to seven eighths of the depth over twice it; 5 % of its shorter side."""
    phase: Angle = 0.0
    """Angle of the middle of the first pad, from the x axis."""


def edge_of(pads: Pads) -> float:
    """Width (m) of the flanks."""
    return SHARP * _shorter_side(pads) if pads.edge is None else pads.edge


def _shorter_side(pads: Pads) -> float:
    return min(pads.outer_radius - pads.inner_radius, pads.angle * 0.5 * (pads.inner_radius + pads.outer_radius))


def depth_of(film, r, theta) -> np.ndarray:
    """By how much (m) the pads of a `Film` table widen the film at radii `r` (m) and angles `theta` (rad), which
    broadcast."""
    total = np.zeros(np.broadcast_shapes(np.shape(r), np.shape(theta)))
    for pads in film.pads:
        edge, pitch = edge_of(pads), 2.0 * math.pi / pads.count
        # A side at the edge of the face has no flank.
        inner = 1.0 if pads.inner_radius <= film.inner_radius else np.tanh((r - pads.inner_radius) / edge)
        outer = -1.0 if pads.outer_radius >= film.outer_radius else np.tanh((r - pads.outer_radius) / edge)
        # From the middle of the nearest pad and of its neighbours, along the mean circle of the pads.
        way, around = 0.5 * (pads.inner_radius + pads.outer_radius) / edge, 0.0
        off = np.mod(theta - pads.phase + 0.5 * pitch, pitch) - 0.5 * pitch
        for turned in (-pitch, 0.0, pitch):
            x = off + turned
            around = around + 0.5 * (np.tanh(way * (x + 0.5 * pads.angle)) - np.tanh(way * (x - 0.5 * pads.angle)))
        total = total + 0.5 * pads.depth * (inner - outer) * around
    return total


def pads_errors(film) -> list[tuple[str, str, str]]:
    """What the pads of a `Film` cannot have: (key below film, found, expected)."""
    bad = []
    for n, pads in enumerate(film.pads):
        key, turn = f"pads.{n}", 2.0 * math.pi
        if pads.count < 1:
            bad.append((f"{key}.count", f"{pads.count}", "a whole number from 1"))
            continue
        if not 0.0 <= pads.depth < math.inf:
            bad.append((f"{key}.depth", f"{pads.depth:g} m", "a finite depth >= 0"))
        if not 0.0 < pads.angle < turn / pads.count:
            expected = f"an angle above 0 and below {turn / pads.count:.4g} rad, a pitch of {pads.count} pads"
            bad.append((f"{key}.angle", f"{pads.angle:g} rad", expected))
            continue
        if not film.inner_radius <= pads.inner_radius < pads.outer_radius <= film.outer_radius:
            found = f"{pads.inner_radius:g} to {pads.outer_radius:g} m"
            expected = f"radii that increase, between {film.inner_radius:g} and {film.outer_radius:g} m"
            bad.append((f"{key}.inner_radius", found, expected))
            continue
        widest = 0.25 * _shorter_side(pads)
        if pads.edge is not None and not 0.0 < pads.edge < widest:
            expected = f"a width above 0 and below {widest:.4g} m, a quarter of the pad's shorter side"
            bad.append((f"{key}.edge", f"{pads.edge:g} m", expected))
    return bad


# Cells where the table does not say, before they are doubled: over the radius, around the shortest wave, and at least
# around the circle.
RADIAL, PER_WAVE, AROUND = 6, 24, 32
# Most of them.
MOST_RADIAL, MOST_AROUND = 400, 20000


@dataclass(frozen=True)
class Reynolds(Strict):
    """The `[film.reynolds]` table: options of the film "reynolds"."""

    grid_accuracy: float = 0.01
    """Relative error that the cells may have beside a run's accuracy; decides how many there are if none are given."""
    cells_r: int | None = None
    """Cells over the radius."""
    cells_theta: int | None = None
    """Cells around the circle."""
    cavitation: Literal["mass-conserving", "none"] = "mass-conserving"
    """Where the film tears at `cavitation_pressure`, with its liquid kept (over grooves: where aligned); or never."""
    roughness: Literal["christensen", "patir-cheng", "none"] = "christensen"
    """How the film flows between the asperities of [contact]: by the mean cube of Christensen's heights (over plateaus
    their own), the same but pressed by Patir and Cheng's factor of isotropic roughness, or not at all."""
    columns: int = 8
    """Over grooves, in place of cells: columns of triangles to a pitch."""
    sectors: int | None = None
    """Alike sectors of the circle, one of which is computed; without it what waves have in common if nothing tilts."""


def reynolds_errors(film) -> list[tuple[str, str, str]]:
    """What a `Film` table that asks for this film cannot have: (key below film, found, expected)."""
    options, bad = film.reynolds or Reynolds(), []
    limits = (("cells_r", 2, MOST_RADIAL), ("cells_theta", 8, MOST_AROUND), ("sectors", 1, MOST_AROUND))
    for key, least, most in limits:
        value = getattr(options, key)
        if value is not None and not least <= value <= most:
            bad.append((f"reynolds.{key}", f"{value}", f"{least} to {most}"))
    if not 0.0 < options.grid_accuracy <= 1.0:
        bad.append(("reynolds.grid_accuracy", f"{options.grid_accuracy:g}", "above 0, at most 1"))
    if options.cavitation == "mass-conserving" and film.cavitation_pressure is None:
        expected = 'a pressure, or film.reynolds.cavitation = "none"'
        bad.append(("cavitation_pressure", 'nothing, with model = "reynolds"', expected))
    return bad


def cells_of(film, orders=()) -> tuple[int, int, int]:
    """Cells over the radius and around one sector, and sectors, of a `Film` table between faces with waves of these
    orders."""
    options = film.reynolds or Reynolds()
    sectors = options.sectors or 1
    around = options.cells_theta or max(AROUND, PER_WAVE * max(orders, default=0))
    return options.cells_r or RADIAL, -(-around // sectors), sectors


# Most radii of a profile: kernels keep room for them.
MOST_NODES = 65
LENGTH = Length.__metadata__[0]


@dataclass(frozen=True)
class Profile(Strict):
    """The `[film.profile]` table: the gap between the faces is wider by `depth` (m) at `radius` (m), linear between,
    on top of clearance and coning.  The first radius is the inner one of the face, the last the outer."""

    radius: Listed[Length]
    """From the inner to the outer radius of the face, increasing."""
    depth: Listed[Height]
    """By which the film is thicker there, on top of clearance and coning; linear between."""


@dataclass(frozen=True)
class Coefficients(Strict):
    """A linear film in the user's own numbers (a vendor's, a test's), SI: forces fall by stiffness times displacement
    and damping times rate.  The cross stiffness follows from the wedge, mean spin times tilt damping."""

    tilt_stiffness: SignedTiltStiffness
    """Restoring moment per relative tilt."""
    tilt_damping: SignedTiltDamping
    """Moment per relative tilt rate."""
    axial_stiffness: AxialFilmStiffness
    """Force per change of film thickness."""
    axial_damping: AxialFilmDamping
    """Force per rate of film thickness."""


@dataclass(frozen=True)
class Film(Strict):
    """The `[film]` table: faces, fluid, pressures and the film model."""

    inner_radius: Radius
    """Inner radius of the narrower face."""
    outer_radius: Radius
    """Outer radius of the narrower face."""
    outer_pressure: Varying[Pressure]
    """Absolute, at the outer radius."""
    inner_pressure: Varying[Pressure]
    """Absolute, at the inner radius."""
    viscosity: Varying[Viscosity] | None = None
    """Dynamic viscosity, the same over the face; of a gas by Sutherland's law at its temperature where not given."""
    gas: GasName | Gas | None = None
    """A gas, by name or as a table of its numbers; without it the film is a liquid."""
    liquid: LiquidName | Liquid | None = None
    """A liquid over its temperature, in place of `viscosity`, `density`, `specific_heat` and `vapour_pressure`."""
    temperature: Varying[Temperature] | None = None
    """Of a gas: total temperature of the reservoir.  Of a liquid: of the sealed one, which `liquid` and
    `coning_per_kelvin` follow."""
    heat: Heat | None = None
    """What the rings take of the film's heat, and how it cones them."""
    model: str = "auto"
    """"auto": the linear film where its estimated error is within the accuracy, else the radial or profiled one; of a
    gas "gas_reynolds"."""
    geometry: Literal["cylindrical", "planar"] = "cylindrical"
    """Radial flow on the ring, or the narrow-seal limit without curvature."""
    tilt_radius: Literal["local", "mean"] = "local"
    """Arm of the tilt in film thickness and contact moment: the local radius, or everywhere the mean radius."""
    clearance: Height | None = None
    """Film thickness of the aligned faces at the inner radius, with `heat` of the unheated ones; without it [closing]
    decides."""
    coning: Varying[Tilt] = 0.0
    """Slope of the faces: the film is thicker outwards where positive; with `heat` of the unheated faces."""
    coning_per_speed_squared: ConingPerSpeedSquared = 0.0
    """Centrifugal coning: what the shaft speed squared adds to it."""
    coning_per_kelvin: ConingPerKelvin = 0.0
    """Thermal coning: what each kelvin of `temperature` above `coning_reference_temperature` adds to it."""
    coning_reference_temperature: Temperature | None = None
    """Temperature at which the coning is that of `coning`."""
    coning_per_pressure: ConingPerPressure = 0.0
    """What each pascal of the sealed pressure above `coning_reference_pressure` adds to it."""
    coning_reference_pressure: PressureDifference | None = None
    """Difference of the pressures at which the coning is that of `coning`."""
    density: Density = 1000.0
    """Of a liquid: for mass flow, heating of the leakage, Reynolds numbers and inertia."""
    inertia: bool = False
    """Centrifugal inertia of the film: its pressure rises outwards by density times radius times speed squared."""
    specific_heat: SpecificHeat = 4180.0
    """For heating of the leakage only."""
    cavitation_pressure: Pressure | None = None
    """Floor of the film pressure, absolute; none without it.  Conserves mass in "reynolds" only."""
    vapour_pressure: Pressure | None = None
    """At the temperature of the film, absolute: a run that falls below it says so."""
    coefficients: Literal["green", "radial"] | Coefficients = "green"
    """Of model = "linear": Green's narrow-seal ones, those of the radial film, or the numbers of a table."""
    floor: float = 1e-3
    """Share of the clearance below which the film counts as collapsed; with [contact] the asperities decide."""
    narrow_face: Literal["stator", "rotor"] = "stator"
    """Ring whose narrower face has these radii; counts with an `offset`."""
    offset: Length = 0.0
    """Of the narrower face's centre from the shaft's axis: the other face pumps across it, and is pressed off its
    centre."""
    offset_direction: Angle = 0.0
    """Of the offset, from the x axis; it turns with its ring."""
    profile: Profile | None = None
    """Faces that are no plain cones."""
    pads: list[Pads] = field(default_factory=list)
    """Rayleigh-step pads in the face that stands still; of "gas_reynolds"."""
    gas_dam: GasDam | None = None
    """Options of model = "gas_dam"."""
    gas_reynolds: GasReynolds | None = None
    """Options of model = "gas_reynolds"."""
    reynolds: Reynolds | None = None
    """Options of model = "reynolds"."""
    tabulated: Tabulated | None = None
    """Numbers of model = "tabulated"."""


def profile_errors(film) -> list[tuple[str, str, str]]:
    """What cannot be in a `Film` with a profile: (key below film, found, expected), empty without one."""
    profile = film.profile
    if profile is None:
        return []
    bad, radius, depth = [], profile.radius, profile.depth
    if not 2 <= len(radius) <= MOST_NODES:
        bad.append(("profile.radius", f"{len(radius)} radii", f"2 to {MOST_NODES} radii"))
    if len(depth) != len(radius):
        bad.append(("profile.depth", f"{len(depth)} depths of {len(radius)} radii", "as many depths as radii"))
    for key, column in (("radius", radius), ("depth", depth)):
        odd = [value for value in column if not math.isfinite(value)]
        if odd:
            bad.append((f"profile.{key}", f"{odd[0]}", "finite lengths"))
    for before, after in pairwise(radius):
        if not before < after:
            bad.append(("profile.radius", f"{after:g} m after {before:g} m", "radii that increase"))
    for found, key in zip((radius[:1], radius[-1:]), ("inner_radius", "outer_radius"), strict=True):
        edge = getattr(film, key)
        if not found or abs(found[0] - edge) > 1e-12 * edge:
            words = "first" if key == "inner_radius" else "last"
            bad.append(("profile.radius", f"{found[0] if found else 0:g} m {words}", f"{key} = {edge:g} m {words}"))
    if film.cavitation_pressure is not None and film.model != "reynolds":
        expected = 'nothing: a film with a profile has no floor, or model = "reynolds"'
        bad.append(("cavitation_pressure", "a value with a profile", expected))
    return bad


def aligned_gaps(film, clearance: float, coning_change: float = 0.0) -> list[tuple[float, float]]:
    """(radius, film thickness) in m at the edges of the aligned faces, or at the radii of the profile of a `Film`, for
    a `clearance` (m); `coning_change` (rad) since time zero."""
    coning = initially(film.coning) + coning_change
    radii, depths = (film.inner_radius, film.outer_radius), (0.0, 0.0)
    if film.profile is not None:
        radii, depths = film.profile.radius, film.profile.depth
    return [(r, clearance + coning * (r - film.inner_radius) + depth) for r, depth in zip(radii, depths, strict=True)]
