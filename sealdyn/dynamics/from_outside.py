"""What another program imposes on a scene from an instant on: speed, pressures, motion of the carriers, loads on rings.

Each is a polynomial in the time since it was given: value and rate, of a motion also its acceleration.  The equations
are those of the scene: a motion takes the place of one by samples, a load stands beside the scene's own, and speed and
pressures are functions of time in place of the scene's.
"""

import math
from dataclasses import replace
from fractions import Fraction
from typing import NamedTuple

import numpy as np

from ..numerics.piecewise_linear import PiecewiseLinear
from ..scene.excitation import MOTION_COLUMNS
from ..scene.rings import RING_NAMES, ROTOR, STATOR
from ..units import Displacement, Force, Moment, Pressure, Quantity, Speed, Tilt
from .imposed_motion import MOMENT, PULL, ROW
from .intervals import Interval
from .swept_motion import TERMS, Sampled

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
