"""The equations of a radial seal, over one stretch of time with the contract of solvers/contract.py, and what a run of
them changes."""

import copy
import math
from fractions import Fraction
from functools import cached_property
from typing import NamedTuple

import numpy as np

from ..dynamics.intervals import (
    Interval,
    constant_and_slope,
    largest_value,
    modulo_turn,
    split_at_breaks,
    time_of_angle,
)
from ..dynamics.native import ARRAYS, BLOCK, Native
from ..scene.radial import RadialScene
from ..scene.scene import SceneError
from . import equations
from .equations import RIDING, Contacts
from .followers import followers_of
from .observers import Watch

# Share of the accuracy that a cubic between two steps may err by: where a solver has begun anew nothing better lies
# between its steps.
BETWEEN = 0.1
# Sharpest accuracy that a run is measured with.
SHARPEST = 1e-13


class RadialUnknowns(NamedTuple):
    """Names of the displacements; the equations change wherever a follower lands (not `constant`)."""

    names: list[str]
    constant: bool = False


class RadialModel:
    """The equations of one radial seal, constant once made: `scene`, `followers`, `accuracy`, `scales` (size,) of the
    unknowns, `length` (m) the scale of displacements, `shortest_period` (s), `reference_rate` (rad/s)."""

    def __init__(self, scene: RadialScene, accuracy: float):
        self.scene, self.accuracy, self.followers = scene, accuracy, followers_of(scene)
        found, waves = self.followers, scene.shaft.waves
        swings = sum(amplitude for _, amplitude, _ in waves) + scene.shaft.offset
        softest = max(float(np.max(found.modal_stiffness)), 0.0)
        self.length = swings or (found.preload / softest if softest else scene.shaft.radius * 1e-3)
        fastest = max((abs(order) for order, _, _ in waves), default=1)
        speed = largest_value(scene.shaft.speed)
        natural = math.sqrt(softest / found.mass)
        self.reference_rate = max(fastest * speed, natural) or 1.0
        self.shortest_period = 2.0 * math.pi / self.reference_rate
        energy = max(found.preload * self.length, found.mass * (self.length * self.reference_rate) ** 2)
        n = found.count
        self.unknowns = RadialUnknowns([f"u{j}" for j in range(n)])
        self.scales = np.array([self.length] * n + [self.length * self.reference_rate] * n
                               + [n * energy] * (equations.WORKS + 1))  # fmt: skip

    def intervals(self, duration: float):
        """Stretches of time on which the shaft's speed is linear."""
        return split_at_breaks(duration, self.scene.shaft.speed, 0.0, [self.scene.shaft.speed])

    def time_of(self, turns: float) -> float:
        """Time (s) in which the shaft turns so often.  Raises SceneError if it never does."""
        try:
            return time_of_angle(self.scene.shaft.speed, 2.0 * math.pi * turns)
        except ValueError as error:
            raise SceneError("run.turns", f"{turns:g} turns ({error})", "fewer turns, or a duration") from None

    def vector(self, q, rate) -> np.ndarray:
        """Unknowns (size,) of displacements and rates (n,)."""
        return np.concatenate([q, rate, np.zeros(equations.WORKS + 1)])


class RadialSegment:
    """What a solver integrates: `modes` (n,) of the followers (equations.FREE, HELD, RIDING) and `signs` (n,) of the
    sliding of the free ones; the rest as dynamics/segments.py."""

    has_residual_form, algebraic, film, may_change, rows = False, (), slice(0, 0), True, ()

    def __init__(self, model: RadialModel, interval: Interval, index: int, last: bool, modes: dict):
        followers, n = model.followers, model.followers.count
        self.model, self.interval, self.index, self.last = model, interval, index, last
        self.time, self.length = interval.time, interval.length
        self.n, self.n_mechanical, self.size = n, 2 * n, equations.unknowns(n)
        self.works, self.rate_places = slice(2 * n, self.size - 1), np.arange(n, 2 * n)
        self.lacks_inertia, self.scales = np.zeros(n, dtype=bool), model.scales
        self.reference_rate, self.shortest_period = model.reference_rate, model.shortest_period
        self.modes, self.signs = np.asarray(modes["modes"], float), np.asarray(modes["signs"], float)
        shaft = model.scene.shaft
        waves = _waves(shaft, interval)
        head = [n, followers.mass, followers.damping, followers.preload, followers.friction, shaft.offset,
                shaft.offset_direction, len(waves)]  # fmt: skip
        parts = (head, followers.angles, self.modes, self.signs, followers.row, np.ravel(waves))
        self.p = np.concatenate([np.asarray(part, float) for part in parts])
        self.pace = self.imposed_pace = max(
            (abs(w) + 2.0 * abs(bend) * self.length for *_, w, bend in waves), default=0.0
        )

    def rhs(self, tau, y, yp):
        """Right-hand side `yp` at segment time `tau` (s)."""
        equations.rates(tau, y, self.p, yp)

    def jacobian(self, tau, y, yp, jac):
        """d y'/d y (size, size); works feed nothing back."""
        base, column, moved = np.empty(self.size), np.empty(self.size), np.array(y)
        self.rhs(tau, moved, base)
        jac[:, :] = 0.0
        for j in range(self.n_mechanical):
            step = 1e-7 * max(abs(y[j]), self.scales[j])
            moved[j] = y[j] + step
            self.rhs(tau, moved, column)
            jac[:, j] = (column - base) / step
            moved[j] = y[j]

    @property
    def differences(self) -> np.ndarray:
        """Scales (size,) of the steps by which a Jacobian is differenced."""
        return self.scales

    @cached_property
    def native(self) -> Native:
        """These equations for C."""
        block = np.zeros(BLOCK, dtype=np.int64)
        block[0], block[ARRAYS], block[ARRAYS + 1] = self.size, self.p.ctypes.data, len(self.p)
        return Native(equations.rates_at.address, block, (self.p,))

    def failure(self) -> str:
        """Nothing in these equations fails."""
        return ""

    def until(self, tau: float) -> "RadialSegment":
        """The same segment, ending at tau (s)."""
        short = copy.copy(self)
        short.length = float(tau)
        return short

    def settle_film(self, tau, y):
        """There is no film."""

    def start(self, tau, y):
        """Unknowns and derivatives to go on from `y` with."""
        yp = np.empty(self.size)
        self.rhs(tau, y, yp)
        return y, yp

    def longest_step(self) -> float:
        """Longest step (s): a cubic through both ends of a step of h radians of the fastest motion errs by h^4/384."""
        return (384.0 * BETWEEN * self.model.accuracy) ** 0.25 / max(self.reference_rate, self.pace)

    def motion(self, ys, yps):
        """Displacements and rates, each (m, n), of stored steps."""
        return np.ascontiguousarray(ys[:, : self.n]), np.ascontiguousarray(ys[:, self.n : 2 * self.n])

    def derivatives(self, taus, ys) -> np.ndarray:
        """The right-hand side (m, size) at stored steps."""
        out = np.empty((len(taus), self.size))
        equations.rates_along(np.ascontiguousarray(taus), np.ascontiguousarray(ys), self.p, out)
        return out

    def energies(self, taus, ys) -> np.ndarray:
        """Energy (J) of motion, springs and preload at stored steps."""
        out = np.empty(len(taus))
        equations.energies_along(np.ascontiguousarray(ys), self.p, out)
        return out

    def state(self, taus, us, vs):
        """Gaps (m), their rates (m/s) and loads (N) as `equations.state_along`, each (m, n)."""
        out = np.empty((3, len(taus), self.n))
        equations.state_along(np.ascontiguousarray(taus), np.ascontiguousarray(us), np.ascontiguousarray(vs), self.p,
                              *out)  # fmt: skip
        return out

    def surface(self, tau: float) -> np.ndarray:
        """The shaft's surface under every follower (n, 3): m, m/s, m/s^2."""
        out = np.empty((self.n, 3))
        equations.surface_at(tau, self.p, out)
        return out


def _waves(shaft, interval: Interval) -> list[list[float]]:
    speed, slope = constant_and_slope(shaft.speed, interval)
    turned = interval.rotor_angle
    return [
        [order, amplitude, modulo_turn(Fraction(order) * turned) + phase, order * speed, 0.5 * order * slope]
        for order, amplitude, phase in shaft.waves
    ]


class RadialRun:
    """A model over `duration` (s), as dynamics/run_state.py: `intervals`, start `y0` (size,), `last`, and the observers
    `stick_slip` (which finds the changes of contact), `extrema` and `contacts` (which watch); `start` where it begins
    and why (simulation/selection.py), None if nobody chose.

    It begins with all followers on the shaft, wherever that pulls nowhere: the following orbit."""

    def __init__(self, model: RadialModel, duration: float):
        self.model, self.duration, self.intervals = model, duration, model.intervals(duration)
        self.stick_slip, self.extrema, self.contacts = Contacts(model), Watch(model), SecondHalf(model, 0.5 * duration)
        n = model.followers.count
        riding = {"modes": np.full(n, RIDING), "signs": np.zeros(n)}
        here = RadialSegment(model, self.intervals[0], 0, len(self.intervals) == 1, riding).surface(0.0)
        self.y0 = model.vector(here[:, 0], here[:, 1])
        self.last, self.start = (0, 0.0, self.y0), None

    def segment(self, index: int = 0, modes=None) -> RadialSegment:
        """The equations over the interval `index`, in the modes of now or in `modes`."""
        index %= len(self.intervals)
        modes = modes or self.stick_slip.held()
        return RadialSegment(self.model, self.intervals[index], index, index + 1 == len(self.intervals), modes)

    def sharper(self, times: float) -> "RadialRun":
        """The same run before its start, so many times more accurate."""
        return RadialRun(RadialModel(self.model.scene, max(self.model.accuracy / times, SHARPEST)), self.duration)

    @property
    def memory(self) -> float:
        """For how many shortest periods an error is remembered: who rides forgets, who is free is damped, or not."""
        found = self.model.followers
        decay = 0.5 * found.damping / found.mass
        longest = self.duration if decay * self.duration < 1.0 else 1.0 / decay
        return longest / self.model.shortest_period

    def end_time(self, index: int, tau: float) -> float:
        """Time (s) since the start of the run at time tau of a segment."""
        return self.intervals[index].time + tau

    def modes(self) -> dict:
        """What a continued run needs beside the unknowns."""
        return {
            "sticking": self.stick_slip.state(),
            "late": self.contacts.state(),
        }

    def restore_modes(self, modes: dict):
        """Go on from `modes`."""
        self.stick_slip.restore(modes["sticking"])
        self.contacts.restore(modes["late"])


class SecondHalf(Watch):
    """The second half of a run: what is settled."""

    def tell(self, log, end=None):
        """Events are told as they happen."""
