"""Imposed motion and conditions in the solver's inner loop: one block per segment, one compiled kernel; and what
another program imposes from an instant on.

Block layout: for each varying quantity its value and slope over the interval, the coning's with what follows the
shaft speed squared, then both rings' angles at its start,
then the oscillators, one row each: `ring, kind, amplitude, amplitude slope, cos and sin of the direction, a0, a1, a2`
with the phase `a0 + a1 tau + a2 tau^2`, then what moves by samples, then what is swept.

Another program gives speed, pressures, motion of the carriers and loads on rings, each as a polynomial in the time
since it was given: value and rate, of a motion also its acceleration.  The equations are those of the scene: a motion
takes the place of one by samples, a load stands beside the scene's own, and speed and pressures are functions of time
in place of the scene's."""

import math
from dataclasses import replace
from fractions import Fraction
from typing import NamedTuple

import numpy as np

from ..faces.geometry import (
    CONING_CHANGE,
    DZ,
    GAP_STATE_SIZE,
    INNER_PRESSURE,
    MEAN_SPIN,
    OUTER_PRESSURE,
    SPIN_DIFFERENCE,
    TEMPERATURE,
    VISCOSITY,
)
from ..numerics.kernel import inner_kernel, outer_kernel
from ..numerics.piecewise_linear import PiecewiseLinear, initially, points
from ..scene.excitation import MOTION_COLUMNS
from ..scene.film import aligned_gaps, coning_change
from ..scene.fluid import viscosity_of
from ..scene.forces import contact_thresholds, finish, load_of
from ..scene.rings import RING_NAMES, ROTOR, STATOR
from ..units import Displacement, Force, Moment, Pressure, Quantity, Speed, Tilt
from .intervals import Interval, constant_and_slope, modulo_turn, spins
from .swept_motion import AXIAL_SHARE, SWEEP_ROW, TERMS, Sampled, loads, motion_at, motions, piece_at, sweep_at

# Steps of differences about a state at rest, in the thinnest film: four of them reach to either side; the least, as a
# share of them.
STEP, NEAREST = 0.01, 4e-6

# --- Fluid and faces at rest ---------------------------------------------------------------------------

# The state of fluid and faces at rest: what of a scene goes into which slots of a gap state.


def fluid_conditions(film) -> dict:
    """Slots of the gap state and what they hold of a `Film` table, each a number or a function of time, SI; temperature
    0 of a liquid."""
    return {
        VISCOSITY: viscosity_of(film),
        INNER_PRESSURE: film.inner_pressure,
        OUTER_PRESSURE: film.outer_pressure,
        TEMPERATURE: 0.0 if film.temperature is None else film.temperature,
    }


def thermal_coning(scene, interval) -> tuple[float, float]:
    """Change (rad) of the coning at an interval's start and its slope (rad/s), without what follows the speed."""
    film = scene.film
    change = coning_change(scene, lambda quantity: constant_and_slope(quantity, interval)[0], speed=0.0)
    rate, warming = (constant_and_slope(quantity, interval)[1] for quantity in (film.coning, film.temperature or 0.0))
    rate += film.coning_per_kelvin * warming
    if film.coning_per_pressure:
        outer, inner = (constant_and_slope(p, interval) for p in (film.outer_pressure, film.inner_pressure))
        rate += film.coning_per_pressure * math.copysign(1.0, outer[0] - inner[0]) * (outer[1] - inner[1])
    return change, rate


def set_conditions(s, scene, value, speed=None) -> None:
    """Writes them into a gap state `s`, and how much the coning has changed; `value` takes the number of a function of
    time, `speed` (rad/s) is the shaft's in place of the scene's."""
    for slot, quantity in fluid_conditions(scene.film).items():
        s[slot] = value(quantity)
    s[CONING_CHANGE] = coning_change(scene, value, speed)


def rest_state(scene, clearance, interval=None, mean_spin=None, shift=0.0, pace=None):
    """Gap state of the aligned rings at rest at an interval's start, the gap `shift` (m) wider than the clearance, and
    steps for derivatives about it; `mean_spin` (rad/s) in place of the scene's, `pace` (1/s) of the motion that is
    tried in place of it."""
    s = np.zeros(GAP_STATE_SIZE)
    s[DZ] = shift
    clearance = clearance + shift
    first = (lambda q: constant_and_slope(q, interval)[0]) if interval else initially
    s[MEAN_SPIN], s[SPIN_DIFFERENCE] = spins(scene, interval)
    if mean_spin is not None:
        # It is the rotor that turns otherwise.
        s[SPIN_DIFFERENCE] += 2.0 * (mean_spin - s[MEAN_SPIN])
        s[MEAN_SPIN] = mean_spin
    speed = s[MEAN_SPIN] + 0.5 * s[SPIN_DIFFERENCE]
    set_conditions(s, scene, first, speed)
    floor = contact_thresholds(scene.contact)[0] if scene.contact else None
    widest, length = (STEP * gap for gap in _analytic(scene, clearance, s[CONING_CHANGE], floor))
    radius, pace = scene.film.outer_radius, max(abs(s[MEAN_SPIN]), 1.0) if pace is None else pace
    return s, (length, length / radius, widest * pace, widest / radius * pace)


def asperity_steps(scene, clearance, change):
    """Steps for derivatives of the asperities about aligned faces at rest, as those of `rest_state`; of rates, which
    do nothing to them, any."""
    length = _analytic(scene, clearance, change, contact_thresholds(scene.contact)[1])[1]
    # Few asperities reach far: how many changes by a factor over one rms.
    length = STEP * min(length, finish(scene.contact))
    tilt = length / scene.film.outer_radius
    return length, tilt, length, tilt


def _analytic(scene, clearance, coning_change, change) -> tuple[float, float]:
    """The thinnest film (m) of the aligned faces, or the floor of rough ones, and how much of it is left where a law of
    rough faces, which changes at the film thickness `change` (m), does so at an edge nearby: the four steps of
    differences do not reach half as far, unless it is so near that the rounding of the force says more than the
    change."""
    gaps = [h for _, h in aligned_gaps(scene.film, clearance, coning_change)]
    if not scene.contact:
        return min(gaps), min(gaps)
    thinnest = max(min(gaps), contact_thresholds(scene.contact)[0])
    nearest = min(abs(h - change) for h in gaps)
    return thinnest, min(thinnest, max(0.1 / STEP * nearest, NEAREST * thinnest))


# --- Block ---------------------------------------------------------------------------------------------

ROTOR_SPEED, STATOR_SPEED, VISCOSITY_AT, INNER_AT, OUTER_AT, TEMPERATURE_AT, CLOSING_AT = range(0, 14, 2)
# Change of the coning, and what it has of the shaft speed squared (rad s^2); angles (rad, modulo one turn) of both
# rings at the segment's start.
CONING_AT, CONING_PER_SPEED_SQUARED = 14, 16
ROTOR_ANGLE_AT, STATOR_ANGLE_AT, OSCILLATOR_COUNT = 17, 18, 19
# Where the sweeps of the housing stand (swept_motion.py), the sampled motion of stator's and rotor's carrier, and the
# sampled forces on both (swept_motion.py), 0 if there is none.
SWEEPS_AT, MOTION_AT, LOADS_AT, OSCILLATORS = 20, 21, 23, 25
ROW = 9

# Kinds: axial motion of the carrier; tilt of the carrier turning with the phase; tilt of the carrier about
# a fixed axis; the ring's own misalignment in its carrier, which its springs feel; a moment (N m) on the ring, and that
# of a mass off the axis, whose amplitude is mass, eccentricity and arm multiplied (kg m^2); a moment about a fixed axis
# and an axial force (N) on the ring.
AXIAL, TURNING, FIXED_AXIS, OWN, MOMENT, UNBALANCE, FIXED_MOMENT, PULL = range(8)
# Those that act on the ring itself.
ON_RING = (MOMENT, UNBALANCE, FIXED_MOMENT, PULL)

# Slots of the imposed state, per ring: carrier displacement and rate, own misalignment, carrier acceleration, force and
# moments.
Z, TILT_X, TILT_Y, Z_RATE, TILT_X_RATE, TILT_Y_RATE, OWN_X, OWN_Y, OWN_X_RATE, OWN_Y_RATE = range(10)
Z_ACCELERATION, TILT_X_ACCELERATION, TILT_Y_ACCELERATION = range(10, 13)
LOAD_Z, LOAD_X, LOAD_Y = 13, 14, 15
PER_RING = 16


def harmonics_of_segment(shaft, housing, rotor, stator, interval: Interval) -> np.ndarray:
    """All harmonic motions imposed during an interval by Shaft, Housing, Rotor and Stator, shape (n, ROW).

    A flexible ring's own misalignment acts on its springs; a rigid ring is its carrier, so its runout or misalignment
    is the carrier's tilt.  Phases are reduced modulo one turn in exact arithmetic.
    """
    turning = {ROTOR: (interval.rotor_angle, shaft.speed), STATOR: (interval.stator_angle, stator.speed)}
    rows = []

    def add(ring, kind, amplitude, phase, order=0.0, frequency=0.0, direction=0.0):
        value, slope = constant_and_slope(amplitude, interval)
        if value == 0.0 and slope == 0.0:
            return
        angle, speed = turning[ring]
        w, w_slope = constant_and_slope(speed, interval)
        cycles = Fraction(frequency) * interval.start if frequency else 0
        a0 = modulo_turn(Fraction(order) * angle) + 2 * math.pi * float(cycles % 1) + phase
        a1, a2 = order * w + 2 * math.pi * frequency, 0.5 * order * w_slope
        rows.append([ring, kind, value, slope, math.cos(direction), math.sin(direction), a0, a1, a2])

    own = OWN if rotor.support else TURNING
    angle = rotor.misalignment if rotor.support else rotor.runout
    add(ROTOR, own, angle, rotor.misalignment_phase if rotor.support else rotor.runout_phase, order=1.0)
    add(
        STATOR,
        OWN if stator.support else TURNING,
        stator.misalignment,
        stator.misalignment_direction,
        order=1.0,
    )
    for k, ring, speed in ((STATOR, stator, stator.speed), (ROTOR, rotor, shaft.speed)):
        if ring.support and ring.mass_centre:
            centre = ring.mass_centre
            arm = ring.mass * centre.axial
            # The moment of a force across the shaft is a quarter turn ahead of it.
            add(k, MOMENT, arm * housing.gravity, housing.gravity_direction + 0.5 * math.pi)
            if any(points(speed)):
                add(k, UNBALANCE, arm * centre.eccentricity, centre.phase, order=1.0)
        if load := load_of(ring):
            order = float(load.turns)
            add(k, PULL, load.force, 0.0)
            add(k, MOMENT, load.moment_x, 0.0, order=order)
            add(k, MOMENT, load.moment_y, 0.5 * math.pi, order=order)
            for tone in load.tone:
                add(k, PULL, tone.force, tone.phase, frequency=tone.frequency)
                add(k, FIXED_MOMENT, tone.moment, tone.phase, frequency=tone.frequency, direction=tone.direction)
    for whirl in shaft.whirl:
        add(ROTOR, TURNING, whirl.angle, whirl.phase, order=whirl.ratio)
    for runout in rotor.axial_runout:
        add(ROTOR, AXIAL, runout.amplitude, runout.phase, order=runout.order)
    tones = [(tone, AXIAL, 0.0) for tone in housing.axial_tones]
    tones += [(tone, FIXED_AXIS, tone.direction) for tone in housing.angular_tones]
    for source, kind, direction in tones:
        amplitude = source.displacement
        if amplitude is None:
            amplitude = -source.acceleration / (2 * math.pi * source.frequency) ** 2
        add(STATOR, kind, amplitude, source.phase, frequency=source.frequency, direction=direction)
    return np.array(rows, dtype=np.float64).reshape(-1, ROW)


def imposed_block(head, rows, sweeps, scene, interval: Interval) -> np.ndarray:
    """The block over an interval: `head` the slots before SWEEPS_AT, the harmonics `rows`, the scene's sampled motion
    and forces, and the rows of its `sweeps`."""
    places, blocks, at = [0.0, 0.0, 0.0, 0.0], [], OSCILLATORS + rows.size
    by_place = {**motions(scene), **{2 + ring: sampled for ring, sampled in loads(scene).items()}}
    for place, sampled in by_place.items():
        blocks.append(sampled.block(interval.time, interval.length))
        places[place], at = at, at + len(blocks[-1])
    if len(sweeps):
        blocks.append([len(sweeps), *sweeps.ravel()])
    return np.concatenate([head, [at if len(sweeps) else 0.0, *places], rows.ravel(), *blocks])


@inner_kernel()
def coning_at(tau, p):
    """By how much the coning differs at segment time tau (s) from the face block's (rad), and its rate (rad/s)."""
    speed, share = p[ROTOR_SPEED] + p[ROTOR_SPEED + 1] * tau, p[CONING_PER_SPEED_SQUARED]
    change = p[CONING_AT] + p[CONING_AT + 1] * tau + share * speed * speed
    return change, p[CONING_AT + 1] + 2.0 * share * speed * p[ROTOR_SPEED + 1]


@outer_kernel()
def imposed_state(tau, p, c):
    """Fill the imposed state `c` (2 x PER_RING: stator, rotor; m, rad, their rates and accelerations) at segment time
    tau (s) from the block `p` (the layout above)."""
    for i in range(len(c)):
        c[i] = 0.0
    for ring in range(2):
        at = int(p[MOTION_AT + ring])
        if at > 0:
            piece, base = piece_at(tau, p, at), PER_RING * ring
            for part in range(3):
                x, x_rate, x_acceleration = motion_at(tau, p, at, piece, part)
                c[base + Z + part] += x
                c[base + Z_RATE + part] += x_rate
                c[base + Z_ACCELERATION + part] += x_acceleration
        at = int(p[LOADS_AT + ring])
        if at > 0:
            piece = piece_at(tau, p, at)
            for part in range(3):
                c[PER_RING * ring + LOAD_Z + part] += motion_at(tau, p, at, piece, part)[0]
    at = int(p[SWEEPS_AT])
    for k in range(int(p[at]) if at > 0 else 0):
        row = at + 1 + SWEEP_ROW * k
        x, x_rate, x_acceleration = sweep_at(tau, p, row)
        for part in range(3):
            share = p[row + AXIAL_SHARE + part]
            c[Z + part] += share * x
            c[Z_RATE + part] += share * x_rate
            c[Z_ACCELERATION + part] += share * x_acceleration
    for k in range(int(p[OSCILLATOR_COUNT])):
        row = OSCILLATORS + ROW * k
        base = PER_RING * int(p[row])
        kind = int(p[row + 1])
        a, a_rate = p[row + 2] + p[row + 3] * tau, p[row + 3]
        phase = p[row + 6] + tau * (p[row + 7] + tau * p[row + 8])
        w = p[row + 7] + 2.0 * tau * p[row + 8]
        cos, sin = math.cos(phase), math.sin(phase)
        # Second derivative of a exp(i phase): (a'' = 0, phase'' = 2 a2) along and across.
        along, across = -a * w * w, 2.0 * (a_rate * w + a * p[row + 8])
        x, x_rate, x_acceleration = a * cos, a_rate * cos - a * w * sin, along * cos - across * sin
        if kind == AXIAL:
            c[base + Z] += x
            c[base + Z_RATE] += x_rate
            c[base + Z_ACCELERATION] += x_acceleration
            continue
        if kind == PULL:
            c[base + LOAD_Z] += x
            continue
        if kind in (FIXED_AXIS, FIXED_MOMENT):
            y, y_rate, y_acceleration = x * p[row + 5], x_rate * p[row + 5], x_acceleration * p[row + 5]
            x, x_rate, x_acceleration = x * p[row + 4], x_rate * p[row + 4], x_acceleration * p[row + 4]
        else:
            y, y_rate, y_acceleration = a * sin, a_rate * sin + a * w * cos, along * sin + across * cos
        if kind in (MOMENT, FIXED_MOMENT):
            c[base + LOAD_X] += x
            c[base + LOAD_Y] += y
        elif kind == UNBALANCE:
            # -m r'' on its arm.
            c[base + LOAD_X] += y_acceleration
            c[base + LOAD_Y] -= x_acceleration
        elif kind == OWN:
            c[base + OWN_X] += x
            c[base + OWN_Y] += y
            c[base + OWN_X_RATE] += x_rate
            c[base + OWN_Y_RATE] += y_rate
        else:
            c[base + TILT_X] += x
            c[base + TILT_Y] += y
            c[base + TILT_X_RATE] += x_rate
            c[base + TILT_Y_RATE] += y_rate
            c[base + TILT_X_ACCELERATION] += x_acceleration
            c[base + TILT_Y_ACCELERATION] += y_acceleration


CARRIERS = {"housing": STATOR, "shaft": ROTOR}


class Imposed(NamedTuple):
    """What may be imposed: its quantity, and how many numbers it takes (value, rate, acceleration)."""

    quantity: Quantity
    terms: int


def _kinds() -> dict[str, Imposed]:
    kinds = {"shaft_speed": (Speed, 2), "inner_pressure": (Pressure, 2), "outer_pressure": (Pressure, 2)}
    for carrier in CARRIERS:
        kinds |= {f"{carrier}_z": (Displacement, 3), f"{carrier}_tilt_x": (Tilt, 3), f"{carrier}_tilt_y": (Tilt, 3)}
    for ring in RING_NAMES:
        kinds |= {f"{ring}_force": (Force, 2), f"{ring}_moment_x": (Moment, 2), f"{ring}_moment_y": (Moment, 2)}
    return {name: Imposed(kind.__metadata__[0], terms) for name, (kind, terms) in kinds.items()}


KINDS = _kinds()


class Held(NamedTuple):
    """What holds `since` an instant (s): value, rate, ..., SI."""

    since: Fraction
    terms: tuple[float, ...]

    def at(self, time: Fraction) -> tuple[float, ...]:
        """The same numbers at a later time (s)."""
        past, (value, rate, *more) = float(time - self.since), self.terms
        half = 0.5 * more[0] if more else 0.0
        return (value + past * (rate + half * past), rate + 2.0 * half * past, *more)

    @property
    def moves(self) -> bool:
        """Whether it goes on changing."""
        return any(self.terms[1:])


def imposed_on(model, held: dict[str, Held], interval: Interval):
    """The model whose segment over an interval has what is `held`, by the names of KINDS, in place of the scene's."""
    if not held:
        return model
    now = {name: given.at(interval.start) for name, given in held.items()}
    scene = model.scene
    shaft, housing, film = scene.shaft, scene.housing, scene.film
    if "shaft_speed" in now:
        shaft = replace(shaft, speed=_over(now["shaft_speed"], interval))
    pressures = {name: _over(now[name], interval) for name in ("inner_pressure", "outer_pressure") if name in now}
    if (motion := _motion("shaft", now, interval)) is not None:
        shaft = replace(shaft, motion=motion)
    if (motion := _motion("housing", now, interval)) is not None:
        housing = replace(housing, motion=motion)
    return model.under(replace(scene, shaft=shaft, housing=housing, film=replace(film, **pressures)), _loads(now))


def _over(terms, interval: Interval) -> float | PiecewiseLinear:
    """A number, or a function of time, over an interval."""
    value, rate = terms
    begin, length = interval.time, interval.length
    return PiecewiseLinear((begin, begin + length), (value, value + rate * length)) if rate else value


def _motion(carrier: str, now, interval: Interval) -> Sampled | None:
    """Motion of a carrier over an interval, one piece of a spline."""
    parts = [now.get(f"{carrier}_{'z' if name == 'axial' else name}") for name in MOTION_COLUMNS]
    if not any(parts):
        return None
    coefficients = np.zeros((1, 3, TERMS))
    for part, (value, rate, acceleration) in enumerate(given or (0.0, 0.0, 0.0) for given in parts):
        coefficients[0, part, TERMS - 3 :] = 0.5 * acceleration, rate, value
    return Sampled(np.array([interval.time, interval.time + interval.length]), coefficients, 0.0, 0.0, 0.0)


def _loads(now) -> np.ndarray:
    """Loads on the rings as harmonics (n, ROW) of imposed_motion.py that stand or grow."""
    kinds = {"force": (PULL, 0.0), "moment_x": (MOMENT, 0.0), "moment_y": (MOMENT, 0.5 * math.pi)}
    rows = [[k, kind, *now[name], 1.0, 0.0, phase, 0.0, 0.0] for k, ring in enumerate(RING_NAMES)
            for part, (kind, phase) in kinds.items() if (name := f"{ring}_{part}") in now]  # fmt: skip
    return np.array(rows, dtype=np.float64).reshape(-1, ROW)
