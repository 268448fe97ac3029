"""Whether a scene and its run are plausible: cautions where a run leaves what its film is valid for, numbers without a
unit that no seal has, and the size of a run, reckoned before it hurts."""

import math
from collections.abc import Iterator
from dataclasses import dataclass
from itertools import pairwise, product
from typing import get_args

import numpy as np

from ..closed_form import centrifugal_pressure, couette_reynolds, poiseuille_reynolds
from ..dynamics.intervals import largest_value
from ..dynamics.model import Model
from ..dynamics.run_state import Caution, Concern
from ..dynamics.signals import fields, fields_of, samples
from ..faces.roughness import mean_film_cubed
from ..numerics.piecewise_linear import initially, points
from ..quantities import in_words
from ..scenario.keys import held_at, radius_key, without_indices
from ..scenario.reader import Scenario
from ..scenario.tables import kind_of_scene
from ..scene.film import Coefficients
from ..scene.fluid import GasDam, density_of, gas_of, highest_density, viscosity_of
from ..scene.forces import HALF_HEIGHT
from ..scene.radial import RadialScene
from ..scene.scene import SceneError, part
from ..units import SECONDS, Quantity, SampleTime, Usual, quantity_of
from .film_error import TORN, reynolds_comparison

# Reynolds number from which laminar flow is in doubt; rise (K) at which a liquid's viscosity is another.
LAMINAR, WARM = 1000.0, 10.0
# Rise beyond which no leakage carries the heat: it would boil, or be no lubricant.
CARRIED = 100.0
# Rate of wear (m/s) of a millimetre an hour.
GONE = 1e-3 / 3600
# Films (m) that are thinner than lapped faces are rough, and than a liquid is a continuum; widest clearance (m) of a
# seal's faces.
SMOOTH, CONTINUUM, WIDE = 1e-7, 1e-8, 1e-3
# Share of the leakage that roughness adds, from which it is said.
LETS_THROUGH = 0.05
# Mach number from which the inertia of a gas changes its pressure by some 5 %.
FAST = 0.3
# Share of the sealed pressure from which the fluid's inertia matters; of a dam's gauge force by which it may be off.
HEAVY, OFF = 0.05, 0.01


def cautions(scenario, run, outcome, leakage, heat, h_min, wear=0.0) -> list[Caution]:
    """Cautions of a run that ended with `outcome`: mean `leakage` (m^3/s), `heat`: its rise (K) if all friction heats
    it, and that friction over the face (W/m^2), thinnest film `h_min` (m), rate of `wear` (m/s)."""
    scene, model = scenario.scene, run.model
    found = [
        *_units(scenario, model),
        *_thin_film(scene, h_min),
        *_roughness_leakage(model, h_min),
        *_contact_arm(scene),
        *(_heat(scene.film, *heat) if model.heat is None else ()),
        *_wear(wear),
    ]
    found += _flash(run, outcome)
    if scene.film.gas is not None:
        found += _gas_flow(model, leakage)
    elif _is_liquid(model):
        found += [*_turbulence(model, leakage), *_inertia(scene), *_pressure_floor(run)]
    return found


def scene_cautions(scenario: Scenario, model: Model) -> list[Caution]:
    """The cautions that need no run: bare numbers, the film's inertia, turbulence of the sliding, edges that boil."""
    found, scene = [*_units(scenario, model), *_contact_arm(model.scene)], model.scene
    if _is_liquid(model):
        found += [*_turbulence(model, math.nan), *_inertia(scene)]
    return [*found, *_boiling(scene.film, _least_edge(scene.film))]


def _is_liquid(model) -> bool:
    """Whether the film is a liquid, and not coefficients of one's own."""
    film = model.scene.film
    if model.interface.film.as_given:
        return False
    return film.gas is None and not (isinstance(film.coefficients, Coefficients) and model.interface.film.constant)


def _pressure_floor(run):
    """A floor of the pressure where cavities that keep their liquid would push, tilt or leak otherwise."""
    beside = reynolds_comparison(run) if run.model.scene.film.cavitation_pressure is not None else None
    if beside is None or beside["cavitated"][0] <= TORN:
        return
    off = [abs(beside[part]) for part in ("force", "moment", "leakage") if beside[part] is not None]
    if not off or max(off) > run.model.accuracy:
        yield Caution(Concern.FLOOR, beside["said"])


def couette_number(model, radius: float, thickness: float) -> float:
    """Couette Reynolds number of a film `thickness` (m) at a radius (m), at the fastest sliding, the least viscosity
    and, of a gas, the highest pressure of the scene; NaN where coefficients of one's own stand for the film.  The film
    counts as laminar up to LAMINAR."""
    film, scene = model.scene.film, model.scene
    if film.gas is None and not _is_liquid(model):
        return math.nan
    sliding = max(abs(r - s) for r, s in product(points(scene.shaft.speed), points(scene.stator.speed)))
    return couette_reynolds(highest_density(film), min(points(viscosity_of(film))), sliding * radius, thickness)


def leakage_numbers(model, leakage: float) -> tuple[float, float]:
    """Reynolds number of a leakage (m^3/s, of a gas at normal conditions) between the aligned faces, and Mach number
    with which a gas leaves them at the low pressure; NaN of coefficients of one's own and of a film that knows the
    gas's inertia, and the latter of a liquid."""
    film = model.scene.film
    if film.gas is None:
        flow = leakage / (2.0 * math.pi * film.inner_radius)
        known = _is_liquid(model)
        return poiseuille_reynolds(film.density, min(points(film.viscosity)), flow) if known else math.nan, math.nan
    gas, temperature = gas_of(film), min(points(film.temperature))
    sound = math.sqrt(gas.heat_ratio * gas.gas_constant * temperature)
    density = min(*points(film.inner_pressure), *points(film.outer_pressure)) / (gas.gas_constant * temperature)
    outer_is_high = initially(film.outer_pressure) >= initially(film.inner_pressure)
    radius, h = model.aligned_gaps()[0 if outer_is_high else -1]
    flow = density_of(film) * abs(leakage) / (2.0 * math.pi * radius)
    if model.interface.name == "gas_dam" or h <= 0.0:
        return math.nan, math.nan
    return 2.0 * flow / min(points(viscosity_of(film))), flow / (density * h * sound)


def room_to_open(model, leakage: float, radius: float, thickness: float) -> Iterator[tuple[float, str]]:
    """By how much (m) a film `thickness` (m) at a radius (m) may open until it is no "laminar film" or no "slow gas"
    any more, its aligned `leakage` (m^3/s) growing with the cube; nothing of what it is not before it opens."""
    through, mach = leakage_numbers(model, leakage)
    sliding = couette_number(model, radius, thickness)
    grown = (sliding, 1, LAMINAR, "laminar film"), (through, 3, LAMINAR, "laminar film"), (mach, 2, FAST, "slow gas")
    for number, power, most, name in grown:
        if 0.0 < number <= most:
            yield thickness * ((most / number) ** (1.0 / power) - 1.0), name


def _units(scenario, model):
    """Bare numbers that no seal has, faces a millimetre apart."""
    yield from (Caution(Concern.UNITS, said) for said in unit_warnings(scenario))
    if model.clearance > WIDE and "film.clearance" not in scenario.bare:
        apart = f"the faces are {in_words('m', model.clearance)} apart"
        yield Caution(Concern.UNITS, f"{apart}: is that possible?  No film seals at this distance")


def _wear(rate):
    """Faces that are gone within hours."""
    if math.isfinite(rate) and rate > GONE:
        how = "is the unit of the wear coefficient right, 1/Pa or mm^3/(N*m)?"
        yield Caution(Concern.WEAR, f"the faces wear {in_words('wear_rate', rate)}, and are gone in hours: {how}")


def _thin_film(scene, h_min):
    """Films thinner than the roughness, and of nanometres."""
    rough = SMOOTH if scene.contact is None else scene.contact.roughness
    if not math.isfinite(h_min) or h_min >= max(rough, CONTINUUM):
        return
    if h_min < CONTINUUM:
        why = "it is no continuum there"
    elif scene.contact is None:
        why = "lapped faces are rougher, which a table [contact] counts"
    else:
        why = f"below the roughness of {in_words('m', rough)} its pressure is that of smooth faces"
    yield Caution(Concern.THIN_FILM, f"the film thins to {in_words('m', h_min)}: {why}")


def _roughness_leakage(model, h_min):
    """Roughness that lets more through than a film between smooth faces does."""
    scene = model.scene
    if scene.contact is None or model.interface.name == "reynolds" or not h_min > 0.0:
        return
    x = h_min / (HALF_HEIGHT * scene.contact.roughness)
    more = float(mean_film_cubed(x)) / x**3 - 1.0
    if more > LETS_THROUGH:
        how = f"where the film is thinnest rough ones let {in_words('share', more, 2)} more through"
        # That of a liquid.
        counts = "" if scene.film.gas else '; film.model = "reynolds" counts them'
        yield Caution(Concern.ROUGH_FILM, f"leakage is that of smooth faces: {how}, after Christensen{counts}")


def _contact_arm(scene):
    film = scene.film
    if scene.contact is not None and film.tilt_radius == "mean":
        off = (film.outer_radius - film.inner_radius) / (film.outer_radius + film.inner_radius)
        why = f"at an edge its moment is wrong by {in_words('share', off, 3)}"
        sentence = f'film.tilt_radius = "mean" puts the contact force at the mean radius: {why}'
        yield Caution(Concern.CONTACT_ARM, sentence)


def _heat(film, rise, flux):
    if math.isfinite(rise) and rise > WARM:
        heat = f"friction would heat the leakage by {rise:.4g} K"
        if rise > CARRIED:
            heat = f"the leakage cannot carry the friction's {in_words('heat_flux', flux)} of face"
        counted = "; film.heat with film.liquid counts what the rings take" if film.gas is None else ""
        yield Caution(Concern.HEATING, f"not isothermal: {heat}, and the film has one viscosity{counted}")


def _turbulence(model, leakage):
    """Reynolds numbers of the aligned film at the fastest sliding and the least viscosity."""
    gaps = [gap for gap in model.aligned_gaps() if gap[1] > 0.0]
    numbers = [(couette_number(model, r, h), r) for r, h in gaps]
    (first, inner), (most, radius) = numbers[0], max(numbers)
    doubt = f"the film counts as laminar, which it is below some {LAMINAR:.0f}"
    if most > LAMINAR:
        found = f"Couette Reynolds number {first:.0f} at r = {in_words('radius', inner)}"
        found += f", {most:.0f} at {in_words('radius', radius)}" if radius != inner else ""
        yield Caution(Concern.TURBULENCE, f"perhaps turbulent: {found}; {doubt}")
    through, _ = leakage_numbers(model, leakage)
    if math.isfinite(through) and through > LAMINAR:
        found = f"Poiseuille Reynolds number {through:.0f} of the leakage"
        yield Caution(Concern.TURBULENCE, f"perhaps turbulent: {found}; {doubt}")


def _gas_flow(model, leakage):
    """A gas film that is isothermal and without inertia where the gas is fast: Mach number of the aligned film at the
    low pressure, with the mass flow of the mean leakage (m^3/s at normal conditions)."""
    through, mach = leakage_numbers(model, leakage)
    if mach > FAST:
        why = 'this film has no inertia of the gas and no choking; film.model = "gas_dam" has both'
        yield Caution(Concern.CHOKING, f"the gas would leave the faces at a Mach number of {mach:.3g}: {why}")
    if through > LAMINAR:
        found = f"Reynolds number {through:.0f} of the leakage"
        yield Caution(Concern.TURBULENCE, f"perhaps turbulent: {found}; the film counts as laminar")
    if model.interface.name == "gas_dam":
        yield from _wide_dam(model.scene.film)
    thickest, at = max((h, r) for r, h in model.aligned_gaps())
    most = couette_number(model, at, thickest)
    if most > LAMINAR:
        found = f"Couette Reynolds number {most:.0f} at r = {in_words('radius', at)}"
        yield Caution(Concern.TURBULENCE, f"perhaps turbulent: {found}, below {LAMINAR:.0f} it is laminar")


def _wide_dam(film):
    """A dam so wide that the friction of its mean radius is not that of its edges: gauge forces of slow flow between
    parallel faces, p^2 linear in 1/r as the film has it beside ln r."""
    if (film.gas_dam or GasDam()).width != "zuk":
        return
    r = np.linspace(film.inner_radius, film.outer_radius, 201)
    ends = initially(film.inner_pressure) ** 2, initially(film.outer_pressure) ** 2
    low = min(ends) ** 0.5
    forces = []
    for way in (1.0 / r, np.log(r)):
        p = np.sqrt(ends[0] + (ends[1] - ends[0]) * (way - way[0]) / (way[-1] - way[0]))
        forces.append(float(np.trapezoid(p - low, r)))
    off = forces[0] / forces[1] - 1.0 if forces[1] else 0.0
    if abs(off) > OFF:
        sentence = "the friction is that of the dam's mean radius: the gauge force of so wide a dam is "
        yield Caution(Concern.WIDE_DAM, f"{sentence}{in_words('share', off, 2, '+')} off where the flow is slow")


def _inertia(scene):
    """Centrifugal inertia that is left out and matters."""
    film = scene.film
    if film.inertia:
        return
    drop = max(abs(o - i) for o, i in product(points(film.outer_pressure), points(film.inner_pressure)))
    speeds = product(points(scene.stator.speed), points(scene.shaft.speed))
    most = max(centrifugal_pressure(film.density, s, r, film.inner_radius, film.outer_radius) for s, r in speeds)
    if most > HEAVY * drop:
        share = f", {in_words('share', most / drop, 3)} of the sealed pressure" if drop else ""
        cure = f"{film.model} has none" if film.model == "reynolds" else "film.inertia = true adds it"
        sentence = f"centrifugal inertia of the film is left out: {in_words('Pa', most, 3)}{share}; {cure}"
        yield Caution(Concern.INERTIA, sentence)


def _flash(run, outcome):
    """Pressures below the vapour pressure: at the edges at any time, and in the film as the run ended."""
    film = run.model.scene.film
    if film.vapour_pressure is None:
        return
    least = _least_edge(film)
    if fields_of(run.model):
        least = min(least, _least_pressure(run.segment(outcome.segment), outcome.tau, outcome.y))
    yield from _boiling(film, least)


def _boiling(film, least):
    """A pressure (Pa) below the vapour pressure."""
    if film.vapour_pressure is not None and least < film.vapour_pressure:
        vapour = f"below the vapour pressure of {in_words('Pa', film.vapour_pressure)}"
        sentence = f"the film falls to {in_words('Pa', least)}, {vapour}: it boils there, which no film here knows"
        yield Caution(Concern.FLASHING, sentence)


def _least_edge(film) -> float:
    """Least pressure (Pa) at an edge at any time."""
    return min(*points(film.outer_pressure), *points(film.inner_pressure))


def _least_pressure(segment, tau, y) -> float:
    """Least pressure (Pa) of the film at segment time `tau` (s)."""
    rates = np.where(segment.rate_places >= 0, y[segment.rate_places], 0.0)
    x = y[None, segment.film] if segment.model.unknowns.film_unknowns is not None else None
    at = samples(segment, np.array([tau]), y[None, : segment.n], rates[None, :], x)
    return float(np.min(fields(at, [0], x)["pressure"]))


def unit_warnings(scenario: Scenario) -> list[str]:
    """Sentences on the bare numbers of a Scenario that are of another size than seals have, or of which no size tells
    the unit: one rule for every key, by what is `usual` of its quantity."""
    kind, said = kind_of_scene(scenario.scene), []
    for key in sorted(scenario.bare):
        own = radius_key(kind, key)
        known = declared(kind, own)
        # A diameter is twice the radius that it became.
        values = [(2.0 if own != key else 1.0) * value for value in _values_at(scenario, own, known[0])]
        said += unusual(key, values, known)
    return said


def unusual(key: str, values: list[float], known: tuple[Quantity | None, Usual | None]) -> list[str]:
    """The sentence on the numbers at a key of which one is not usual; else none."""
    quantity, usual = known
    odd = [value for value in values if usual and not usual.takes(value)]
    if not odd or usual is None:
        return []
    value = max(odd, key=lambda value: abs(math.log(abs(value))))
    pure = quantity is None or usual.meant == "%"
    unit = "" if pure else f"{quantity.unit}{' between samples' * isinstance(quantity, SampleTime)}"
    meant = in_words("share", value, 6) if pure else quantity.as_meant(value)
    return [f"{key} without a unit is read as {f'{value:.6g} {unit}'.strip()}, which is {meant}: write its unit"]


def declared(kind: type, key: str) -> tuple[Quantity | None, Usual | None]:
    """The quantity at a dotted key of the dataclass `kind`, None of a pure number; and what is usual of it."""
    holds = held_at(kind, key)
    if holds is None and without_indices(key).rpartition(".")[2] == "time":
        # Of a quantity that is a function of time.
        return SECONDS, SECONDS.usual
    return usual_of(holds)


def usual_of(holds) -> tuple[Quantity | None, Usual | None]:
    """The quantity of what a key holds, None of a pure number; and what is usual of it."""
    quantity = quantity_of(holds)
    parts = [part for kind in (holds, *get_args(holds)) for part in getattr(kind, "__metadata__", ())]
    return quantity, quantity.usual if quantity else next((part for part in parts if isinstance(part, Usual)), None)


def _values_at(scenario: Scenario, key: str, quantity: Quantity | None) -> list[float]:
    """Numbers (SI) at a dotted key of a scenario: of a table all values, of times of samples what is between them; none
    where there are none (any more)."""
    place = scenario if key.partition(".")[0] in ("run", "application") else scenario.scene
    try:
        held = part(place, key)
    except (AttributeError, IndexError, ValueError):
        return []
    if isinstance(quantity, SampleTime):
        return [after - before for before, after in pairwise(held)]
    found = held if isinstance(held, tuple) else points(held)
    return [value for value in found if isinstance(value, int | float)]


# Samples of a turn, unless told or the forcing is fast.
PER_TURN = 64
# Bytes of a row of an archive; seconds of a turn that nothing undercuts (the reference seal at a loose accuracy).
ROW, TURN = 300, 2e-4
# Above these a run asks first: bytes of the archive, seconds.
LARGE, LONG = 10e9, 86400.0
# Beyond these there is no machine: turns, rows.
MOST = 1e12


@dataclass(frozen=True)
class Size:
    """Turns of the faster ring and rows of a run; bytes of its archive and seconds that it takes at least."""

    turns: float
    rows: float

    @property
    def bytes(self) -> float:
        """Of the archive, about."""
        return ROW * self.rows

    @property
    def seconds(self) -> float:
        """At least."""
        return TURN * self.turns

    @property
    def possible(self) -> bool:
        """On any machine."""
        return max(self.turns, self.rows) <= MOST

    def __str__(self):
        """In words."""
        kept, lasts = in_words("B", self.bytes, 3), in_words("time", self.seconds, 2)
        return f"{self.turns:.3g} turns, {self.rows:.3g} rows: an archive of {kept}, at least {lasts}"


def size_of(scenario: Scenario, rows: int | None = None) -> Size:
    """What a run of a scenario takes, of so many `rows` where they are known; instant, whatever its numbers."""
    shaft = largest_value(scenario.scene.shaft.speed)
    # A radial seal has no ring that turns beside the shaft.
    stator = largest_value(scenario.scene.stator.speed) if not isinstance(scenario.scene, RadialScene) else 0.0
    settings = scenario.run
    turns = settings.turns
    if turns is None:
        turns = settings.duration * max(shaft, stator) / (2 * math.pi)
    rows = rows or settings.samples
    if rows is None:
        rows = 1000 if shaft == 0.0 else turns * (settings.samples_per_turn or PER_TURN)
    # Integers of any length.
    return Size(float(turns), float(min(rows, 10**300)))


def refuse_large(scenario: Scenario, allowed: bool = False, rows: int | None = None) -> None:
    """Raises SceneError for a run beyond any machine, and for a large one that is not `allowed`; `rows` as of
    `size_of`."""
    size, settings = size_of(scenario, rows), scenario.run
    if size.possible and (allowed or (size.bytes <= LARGE and size.seconds <= LONG)):
        return
    if size.rows > size.turns and (not size.possible or size.bytes > LARGE):
        key = "run.samples" if settings.samples is not None else "run.samples_per_turn"
    else:
        key = "run.turns" if settings.turns is not None else "run.duration"
    less = f"fewer: at most {LARGE / ROW:.2g} rows and {LONG / TURN:.2g} turns"
    raise SceneError(key, str(size), f"{less}; or --yes (allow_large=True)" if size.possible else less)
