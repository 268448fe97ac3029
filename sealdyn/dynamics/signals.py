"""What is looked at: one table of all that the archive keeps, and its values from the motion at given times."""

from collections.abc import Callable
from dataclasses import dataclass
from functools import cache, cached_property, partial

import numpy as np

from ..faces.film_thickness import wave_parts_along
from ..faces.geometry import (
    CAVITATED,
    CONING,
    CONING_CHANGE,
    CONTACT_AREA,
    CONTACT_FORCE,
    CONTACT_PRESSURE,
    CONTACT_TORQUE,
    CONTACT_X,
    CONTACT_Y,
    DZ,
    FLOW_INNER,
    FLOW_OUTER,
    FORCE,
    GAP_STATE_SIZE,
    GX,
    GY,
    INNER_PRESSURE,
    MOMENT_X,
    MOMENT_Y,
    ORDER_LIST,
    ORDERS,
    OUTER_PRESSURE,
    ROTOR_ANGLE,
    SPIN_DIFFERENCE,
    STATOR_ANGLE,
    TORQUE,
    WEAR,
    wide_ring,
)
from ..quantities import everyday
from ..scene.film import coning_varies
from ..scene.fluid import density_of
from ..scene.rings import RING_NAMES
from . import equations
from .imposed_motion import OWN_X, OWN_Y, PER_RING, TILT_X, TILT_X_RATE, TILT_Y, TILT_Y_RATE, Z_RATE, Z
from .intervals import constant_and_slope, modulo_turn
from .native import Value, load_value, states_along, thinnest_value


@dataclass(frozen=True)
class Samples:
    """Instants `taus` (m,) (s) of a segment, and there the states `gap` (m, GAP_STATE_SIZE), `scratch` of the equations
    (m, SCRATCH), and `low` (m, 3): the thinnest film (m), its angle (rad) and its radius (m)."""

    segment: object
    taus: np.ndarray
    gap: np.ndarray
    scratch: np.ndarray
    low: np.ndarray

    @cached_property
    def waves(self) -> np.ndarray:
        """Cosine and sine parts (m), shape (m, orders, 2), of the gap's waves."""
        return wave_parts_along(self.segment.model.face, self.gap)

    @cached_property
    def shaft(self) -> tuple[float, float]:
        """Shaft speed (rad/s) at the start of the interval, and its slope (rad/s^2)."""
        return constant_and_slope(self.segment.model.scene.shaft.speed, self.segment.interval)

    @cached_property
    def tilt(self) -> np.ndarray:
        """Complex relative tilt (m,), in rad."""
        return self.gap[:, GX] + 1j * self.gap[:, GY]

    @cached_property
    def torque(self) -> np.ndarray:
        """Friction torque (m,), in N m, of film and contact on the rotor."""
        return self.gap[:, TORQUE] + self.gap[:, CONTACT_TORQUE]

    @cached_property
    def closing_force(self) -> np.ndarray:
        """Closing force (m,), in N."""
        model = self.segment.model
        closing = model.closing.over(self.segment.interval, model.scene.film)
        return closing[0] + closing[1] * self.taus

    @cached_property
    def reactions(self) -> dict[str, np.ndarray]:
        """What the seal does to shaft and housing: force (N) along z and moments (N m) about x and y, each (m,), of the
        ring that each carries, by its springs, dampers and secondary seal, or of the film itself on a rigid ring:

            on a carrier of a floating ring   K (z - z_c) + D (z' - z_c') - friction,  and of the tilts the same
            on a rigid one                    +-(film + contact - closing force),  +-(moments of film and contact)

        **Source** the supports of equations.py, seen from their other end.
        **Valid** beside the steady thrust of closing force and film, which balance each other at rest; inertia and
        weight of a rigid ring are the carrier's own."""
        found = {}
        for k, carrier in enumerate(CARRIERS):
            parts = _through_support(self, k) if self.segment.model.unknowns.floats[k] else _of_film(self, k)
            found |= {f"{carrier}_{name}": part for name, part in zip(REACTION_PARTS, parts, strict=True)}
        return found


@dataclass(frozen=True)
class Signal:
    """A series of the archive: SI unit, what it is, how to read it off `Samples`, the quantity by which people read
    it (without one its unit), and whether a run keeps its mean and maximum."""

    name: str
    unit: str
    long_name: str
    values: Callable[[Samples], np.ndarray]
    quantity: str = ""
    tallied: bool = False

    @property
    def display(self) -> tuple[str, float]:
        """Unit for people, and how many of it make one SI unit."""
        return everyday(self.quantity or self.unit)


def _gap(slot):
    return lambda at: at.gap[:, slot]


def _scratch(slot):
    return lambda at: at.scratch[:, slot]


def _low(place):
    return lambda at: at.low[:, place]


def _shaft_angle(at):
    speed, slope = at.shaft
    turned = modulo_turn(at.segment.interval.rotor_angle)
    return np.mod(turned + at.taus * (speed + 0.5 * slope * at.taus), 2 * np.pi)


def _leakage(slot):
    # Flow in +r runs from high to low pressure while the pressure inside is the higher one.
    return lambda at: np.where(at.gap[:, OUTER_PRESSURE] >= at.gap[:, INNER_PRESSURE], -1.0, 1.0) * at.gap[:, slot]


def _mass_flow(slot):
    return lambda at: density_of(at.segment.model.scene.film) * at.gap[:, slot]


SHAFT_AND_FILM = (
    Signal("shaft_angle", "rad", "shaft angle, modulo one turn", _shaft_angle, "angle"),
    Signal("shaft_speed", "rad/s", "shaft speed", lambda at: at.shaft[0] + at.shaft[1] * at.taus, tallied=True),
    Signal("relative_tilt_x", "rad", "relative tilt about the x axis, stator minus rotor", _gap(GX)),
    Signal("relative_tilt_y", "rad", "relative tilt about the y axis, stator minus rotor", _gap(GY)),
    Signal("relative_misalignment", "rad", "relative misalignment of the faces", lambda at: np.abs(at.tilt),
           tallied=True),
    Signal("relative_precession", "rad", "direction of the relative tilt, from the x axis",
           lambda at: np.angle(at.tilt), "angle"),
    Signal("axial_gap_change", "m", "change of the axial gap from the design clearance", _gap(DZ), tallied=True),
    Signal("h_min", "m", "smallest film thickness over the face", _low(0)),
    Signal("h_min_angle", "rad", "angle of the smallest film thickness, from the x axis", _low(1), "angle"),
    Signal("h_min_radius", "m", "radius of the smallest film thickness", _low(2), "radius"),
    Signal("film_force", "N", "opening force of the film", _gap(FORCE), tallied=True),
    Signal("film_moment_x", "N m", "film moment on the stator about the x axis", _gap(MOMENT_X)),
    Signal("film_moment_y", "N m", "film moment on the stator about the y axis", _gap(MOMENT_Y)),
    Signal("closing_force", "N", "closing force", lambda at: at.closing_force, tallied=True),
    Signal("leakage_inner", "m^3/s", "leakage at the inner radius, from high to low pressure", _leakage(FLOW_INNER),
           tallied=True),
    Signal("leakage_outer", "m^3/s", "leakage at the outer radius, from high to low pressure", _leakage(FLOW_OUTER),
           tallied=True),
    Signal("mass_flow_inner", "kg/s", "mass flow at the inner radius, outwards", _mass_flow(FLOW_INNER)),
    Signal("mass_flow_outer", "kg/s", "mass flow at the outer radius, outwards", _mass_flow(FLOW_OUTER)),
    Signal("friction_torque", "N m", "friction torque on the rotor", lambda at: at.torque, tallied=True),
    Signal("friction_power", "W", "friction power", lambda at: at.torque * at.gap[:, SPIN_DIFFERENCE], tallied=True),
    Signal("cavitated_fraction", "1", "share of the face at the cavitation pressure", _gap(CAVITATED), tallied=True),
)  # fmt: skip
CONTACT = (
    Signal("contact_force", "N", "contact force, opening", _gap(CONTACT_FORCE), tallied=True),
    Signal("contact_moment_x", "N m", "contact moment on the stator about the x axis", _gap(CONTACT_X)),
    Signal("contact_moment_y", "N m", "contact moment on the stator about the y axis", _gap(CONTACT_Y)),
    Signal("contact_torque", "N m", "friction torque of contact on the rotor", _gap(CONTACT_TORQUE), tallied=True),
    Signal("contact_area_fraction", "1", "share of the face that touches", _gap(CONTACT_AREA), tallied=True),
    Signal("contact_pressure", "Pa", "largest contact pressure", _gap(CONTACT_PRESSURE), tallied=True),
    Signal("wear_rate", "m/s", "wear depth rate of both faces, mean over the face", _gap(WEAR), "wear_rate",
           tallied=True),
)  # fmt: skip
# What carries each ring.
CARRIERS = ("housing", "shaft")
REACTION_PARTS = {
    "force": ("N", "axial force"),
    "moment_x": ("N m", "moment about the x axis"),
    "moment_y": ("N m", "moment about the y axis"),
}
REACTIONS = tuple(
    Signal(f"{carrier}_{part}", unit, f"{what} of the seal on the {carrier}",
           lambda at, name=f"{carrier}_{part}": at.reactions[name])
    for carrier in CARRIERS
    for part, (unit, what) in REACTION_PARTS.items()
)  # fmt: skip
# Of faces whose coning changes.
CONED = (
    Signal("coning", "rad", "coning of the gap, positive where it is thicker outwards",
           lambda at: at.segment.model.face[CONING] + at.gap[:, CONING_CHANGE]),
)  # fmt: skip
TALLIED = tuple(signal.name for signal in SHAFT_AND_FILM + CONTACT if signal.tallied)
# A ring's motion and its secondary seal, in the order of their slots: unit, what it is.
PARTS = {
    "z": ("m", "axial displacement of the {}"),
    "tilt_x": ("rad", "tilt of the {} about the x axis"),
    "tilt_y": ("rad", "tilt of the {} about the y axis"),
    "z_rate": ("m/s", "axial velocity of the {}"),
    "tilt_x_rate": ("rad/s", "tilt rate of the {} about the x axis"),
    "tilt_y_rate": ("rad/s", "tilt rate of the {} about the y axis"),
}
SEAL = {
    "seal_friction": ("N", "axial friction of the secondary seal on the {}"),
    "seal_moment_x": ("N m", "friction moment of the secondary seal on the {} about the x axis"),
    "seal_moment_y": ("N m", "friction moment of the secondary seal on the {} about the y axis"),
    "seal_sliding_speed": ("m/s", "sliding speed of the {} on its secondary seal"),
}


def signal_table(model) -> tuple[Signal, ...]:
    """Every series that a run of this model keeps, beside the time."""
    orders = model.face[ORDER_LIST : ORDER_LIST + int(model.face[ORDERS])]
    unknowns = model.unknowns
    return _table(
        tuple(unknowns.floats[k] for k in range(len(RING_NAMES))),
        tuple(orders),
        model.contact is not None,
        coning_varies(model.scene.film),
        tuple(unknowns.seals),
    )


@cache
def _table(floats, orders, touching, coned, seals):
    table = []
    for k, ring in enumerate(RING_NAMES):
        at = equations.OWN_STATE + 6 * k
        table += _of_ring(ring, dict(list(PARTS.items())[: 6 if floats[k] else 3]), at)
    for j, order in enumerate(orders):
        for i, (short, part) in enumerate((("cos", "cosine"), ("sin", "sine"))):
            words = f"{part} part of the gap's wave of order {order:.0f}, from the x axis"
            table.append(Signal(f"gap_{short}_{order:.0f}", "m", words, lambda at, j=j, i=i: at.waves[:, j, i]))
    table += CONTACT if touching else ()
    table += CONED if coned else ()
    for k in seals:
        table += _of_ring(RING_NAMES[k], SEAL, equations.SEALS + equations.PER_SEAL * k)
        words = f"1 while the {RING_NAMES[k]} sticks on its secondary seal, or the share of its friction that does"
        table.append(Signal(f"{RING_NAMES[k]}_seal_stuck", "1", words, partial(_stuck, k)))
    return (*table, *REACTIONS, *SHAFT_AND_FILM)


def _stuck(k, at):
    ring = at.segment.p[equations.RING * k : equations.RING * (k + 1)]
    if ring[equations.SEAL_AT]:
        return 1.0 - at.scratch[:, equations.SEALS + equations.PER_SEAL * k + equations.SEAL_EXCESS]
    return np.full(len(at.taus), ring[equations.STUCK])


def _of_film(at, k):
    """Force and moments on a ring that is rigid with its carrier."""
    sign, gap = 1.0 if k == 0 else -1.0, at.gap
    opening = gap[:, FORCE] + gap[:, CONTACT_FORCE]
    moment_x, moment_y = gap[:, MOMENT_X] + gap[:, CONTACT_X], gap[:, MOMENT_Y] + gap[:, CONTACT_Y]
    if k == wide_ring(at.segment.p[equations.OFFSET :]):
        x, y = at.scratch[:, equations.CENTRE], at.scratch[:, equations.CENTRE + 1]
        moment_x, moment_y = moment_x + y * opening, moment_y - x * opening
    return sign * (opening - at.closing_force), sign * moment_x, sign * moment_y


def _through_support(at, k):
    """Force and moments through the support and the secondary seal of ring k."""
    ring = at.segment.p[equations.RING * k : equations.RING * (k + 1)]
    own, carrier, seal = equations.OWN_STATE + 6 * k, PER_RING * k, equations.SEALS + equations.PER_SEAL * k
    scene, w = at.segment.model.scene, at.scratch
    speed, slope = constant_and_slope((scene.stator, scene.shaft)[k].speed, at.segment.interval)
    spin = speed + slope * at.taus

    def apart(part):
        return w[:, own + part] - w[:, carrier + part]

    d_x, d_y = apart(TILT_X), apart(TILT_Y)
    e_x, e_y = d_x - w[:, carrier + OWN_X], d_y - w[:, carrier + OWN_Y]
    twice = 2.0 * (at.gap[:, STATOR_ANGLE if k == 0 else ROTOR_ANGLE] + ring[equations.AXIS])
    uneven, cos, sin = ring[equations.UNEVEN_K], np.cos(twice), np.sin(twice)
    stiffness, damping = ring[equations.TILT_K], ring[equations.TILT_D]
    force = ring[equations.AXIAL_K] * apart(Z) + ring[equations.AXIAL_D] * apart(Z_RATE)
    moment_x = stiffness * e_x + uneven * (cos * e_x + sin * e_y) + damping * (apart(TILT_X_RATE) + spin * d_y)
    moment_y = stiffness * e_y + uneven * (sin * e_x - cos * e_y) + damping * (apart(TILT_Y_RATE) - spin * d_x)
    if ring[equations.SEAL_LINE] == 0.0:
        return force, moment_x, moment_y
    return force - w[:, seal], moment_x - w[:, seal + 1], moment_y - w[:, seal + 2]


def _of_ring(ring, parts, first):
    return [
        Signal(f"{ring}_{part}", unit, words.format(ring), _scratch(first + i))
        for i, (part, (unit, words)) in enumerate(parts.items())
    ]


def samples(segment, taus, q, q_rate, x=None) -> Samples:
    """States at times (m,) of a segment; `q`, `q_rate` (m, n) displacements and rates, `x` (m, n) the film's."""
    m, taus = len(taus), np.ascontiguousarray(taus, dtype=float)
    gap, scratch, low = np.empty((m, GAP_STATE_SIZE)), np.empty((m, equations.SCRATCH)), np.empty((m, 3))
    model = segment.model
    ys, yps = np.zeros((m, segment.size)), np.zeros((m, segment.size))
    massive = segment.rate_places >= 0
    ys[:, : segment.n], yps[:, : segment.n] = q, q_rate
    ys[:, segment.rate_places[massive]] = q_rate[:, massive]
    if x is None:
        film, f = model.observed
        states_along(
            Value(film.flow), f, *load_value(model.contact, complete=True), bool(model.unknowns.seals), segment.p,
            segment.w, segment.s, taus, ys, yps, thinnest_value(model.face), model.face, gap, scratch, low,
        )  # fmt: skip
    else:
        ys[:, segment.film] = x
        segment.states(taus, ys, yps, gap, scratch, low)
    return Samples(segment, taus, gap, scratch, low)


def signals(segment, taus, q, q_rate, x=None, tallied=False) -> dict[str, np.ndarray]:
    """Named series (m,) at times of a segment, given as to `samples`, or those only of which a run keeps its mean and
    maximum (`tallied`); SI, leakage counts from high to low pressure."""
    return series_of(samples(segment, taus, q, q_rate, x), tallied)


def series_of(at: Samples, tallied=False) -> dict[str, np.ndarray]:
    """The same of Samples."""
    table = [signal for signal in signal_table(at.segment.model) if signal.tallied or not tallied]
    columns = {"time": at.segment.interval.time + at.taus} | {signal.name: signal.values(at) for signal in table}
    return {name: np.ascontiguousarray(values) for name, values in columns.items()}


# What the film shows over its faces: pressure and the like.


def fields_of(model) -> tuple:
    """Fields (films/_contract.py) of the film that is reported."""
    return model.observed[0].quantities


def field_grid(model) -> tuple[np.ndarray, np.ndarray]:
    """Radii (m) and angles (rad, from the x axis) at which they are given."""
    film, f = model.observed
    return film.grid(f)


def fields(at: Samples, places, x=None) -> dict[str, np.ndarray]:
    """Fields (m, radii, angles) at `places` (m,) of Samples, with the film's unknowns `x` there as to `samples`; SI."""
    table, (film, f) = fields_of(at.segment.model), at.segment.model.observed
    out = np.empty((len(places), len(table), *map(len, field_grid(at.segment.model))))
    for i, place in enumerate(places):
        own = () if x is None else (x[place],)
        film.fields(f, at.gap[place], *own, out[i])
    return {field.name: out[:, k] for k, field in enumerate(table)}
