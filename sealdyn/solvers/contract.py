"""What every method and every observer shares: tolerances, counts, how a run ends.

A method is a generator `steps(segment, tau, y, method, tolerance, counts)` over one segment: it yields blocks `(times
(m,), unknowns (m, size), derivatives or None)` of accepted steps, in the segment's time, the first after the start
`tau` (s), `y` (size,), the last at the segment's end; a SolverFailure says that it gives up.  A segment offers `n`
displacements (first in the unknowns) and the `rate_places` (n,) of their rates, `n_mechanical`, `size`, the slices
`film` and `works`, `length` (s), `rhs(tau, y, yp)`, `residual(tau, y, yp, res)`, `jacobian`, `start`, `scales` (size,),
`reference_rate` (rad/s), `longest_step()` and `shortest_period` (s), `has_residual_form` (there is no `rhs`),
`lacks_inertia` (n,), `algebraic` (places), `may_change`: whether its equations may, at any step; and, if it has
equations for C (`native`), `failure()`: a sentence if these have failed.  A linear scene of constant conditions also
has its `exact_motion()`.

An observer looks at accepted steps: `begin(segment, tau, y)` at every start, `accept(block)` for each Block, which
returns None, a Stop or a Retry; `state()` and `restore(state)` for a run that is continued.  What finds changes of the
equations sees the steps first: its `accept(block, advance)` returns None or a Transition, which its `make` turns into a
Change.
"""

from dataclasses import dataclass, field, replace
from enum import StrEnum
from functools import cached_property

import numpy as np

from ..numerics.hermite import integrals, sample, sample_doubtful
from ..status import Status as Status

# Share of a tolerance that what lies between steps of the matrix exponential may err by.
BETWEEN = 0.1
# Steps between two answers of SUNDIALS at most.
MOST_STEPS = 1_000_000


def longest_step(segment) -> float:
    """Longest step (s) of a segment as SUNDIALS wants it: 0 means any."""
    longest = segment.longest_step()
    return longest if np.isfinite(longest) else 0.0


# Measured over the shipped scenarios (tests/convergence): error relative to the scales, per solver tolerance, of a
# damped scene and per remembered period of an undamped one.  Multistep methods err by up to a tolerance a step
# and always the same way; CVODE's Adams stays at low order on an undamped oscillation (its step may only grow by
# half or more), so it takes some seventy steps a period whatever the tolerance.
SAFETY = {
    "adams": (60.0, 100.0),
    "bdf": (400.0, 400.0),
    "ida": (200.0, 400.0),
    "dop853": (60.0, 3.0),
    "radau": (30.0, 3.0),
    "expm": (1.0, 0.0),
    "trbdf2": (60.0, 30.0),
}
TIGHTEST = 3e-14
# Steps that observers get at once, at least; where the equations may change between steps.
MANY, FEW = 192, 12
# Steps that a method in Python hands over at once.
BLOCK_OF_STEPS = 64
# Orders of Adams.
MOST_ORDERS = 12


class Cause(StrEnum):
    """Why a run ended where it did; its value is the beginning of the message."""

    DONE = "done"
    FILM_COLLAPSED = "film collapsed"
    ASPERITIES_CRUSHED = "asperities crushed flat"
    METHOD_GAVE_UP = "the method gave up"
    TOO_DEAR = "too dear"
    INTERRUPTED = "interrupted by the user"


@dataclass(frozen=True)
class Stop:
    """An observer ends the run at `time` (s, of the segment)."""

    time: float
    cause: Cause
    message: str


@dataclass(frozen=True)
class Transition:
    """Where the equations are about to change: at `time` (s, of the segment), after step `step`, with the unknowns
    `y` (size,) there; `what` changes is the observer's own affair."""

    step: int
    time: float
    y: np.ndarray
    what: object


@dataclass(frozen=True)
class Change:
    """The equations have changed: unknowns `y` (size,) after it, the new `modes` of the segment, and the `event` to log
    (keys of an archive's event: kind, value, text), if it is one."""

    y: np.ndarray
    modes: dict
    event: dict | None


@dataclass(frozen=True)
class Retry:
    """The steps of this block are too inexact: again from the last good one, with this `tolerance`."""

    tolerance: float


class Enough(Exception):
    """A sink has seen enough: it ends the run.  A KeyboardInterrupt is another matter, and passes through."""


class SolverFailure(RuntimeError):
    """A solver gave up: the sentence says why and what to try."""

    cause = Cause.METHOD_GAVE_UP


class TooDear(SolverFailure):
    """A run took more evaluations than it may."""

    cause = Cause.TOO_DEAR


@dataclass
class Counts:
    """Counts of a run: evaluations of the right-hand side (those for Jacobians among them), accepted steps, Jacobians,
    and starts of a solver; of a compiled loop also the steps that its error test (`rejected`) or its nonlinear solver
    (`unsolved`) refused, and how many steps were taken at which order (`orders`, from order 1 on).  `back_end`: who
    made the steps, `slow` why not the compiled loop, a sentence."""

    rhs: int = 0
    steps: int = 0
    jacobians: int = 0
    restarts: int = 0
    rejected: int = 0
    unsolved: int = 0
    orders: list[int] = field(default_factory=lambda: [0] * MOST_ORDERS)
    back_end: str = ""
    slow: str = ""

    def add_work(self, other: "Counts"):
        """Add what another's steps cost; they are counted, like starts, where they are taken in."""
        for name in ("rhs", "jacobians", "rejected", "unsolved"):
            setattr(self, name, getattr(self, name) + getattr(other, name))
        self.orders = [a + b for a, b in zip(self.orders, other.orders, strict=True)]
        self.back_end, self.slow = self.back_end or other.back_end, self.slow or other.slow


def tolerance_for(method: str, accuracy: float, memory: float) -> float:
    """Solver tolerance, relative to the scales, that keeps the asked `accuracy` with this method (a key of SAFETY).

    `memory` is for how many of its fastest periods the scene remembers an error: one or so when it is well damped, the
    whole run when it is not.  Never below TIGHTEST, where rounding takes over.
    """
    damped, per_period = SAFETY[method]
    return max(accuracy / max(damped, per_period * memory), TIGHTEST)


def attainable(method: str, memory: float) -> float:
    """Best accuracy, relative to the scales, that this method can keep on a scene of that memory (fastest periods)."""
    damped, per_period = SAFETY[method]
    return TIGHTEST * max(damped, per_period * memory)


def absolute_tolerances(segment, tolerance) -> np.ndarray:
    """Absolute tolerances (size,) of the unknowns: the tolerance times their scales."""
    absolute = tolerance * segment.scales
    # The sum of absolute powers has kinks and only normalises the audit: no error control on it.
    absolute[-1] = 1e30
    return absolute


def failure_message(method, message, tau) -> str:
    """Sentence why and where (`tau`, s) a method gave up, and what to try."""
    return (
        f"{method} gave up {tau:.6g} s into this segment: {message}  "
        "Try a looser run.accuracy, another run.solver, or look whether the film is closing there."
    )


# --- Blocks -------------------------------------------------------------------------------------------

# Accepted steps as observers see them, and what lies between them.

# Steps kept to the left of what is worked on, and left for later on the right: neighbours for dense output.
OVERLAP = 4


@dataclass(frozen=True)
class Block:
    """Accepted steps of a segment: times `t` (m,) (s, of the segment), unknowns `ys` (m, size), derivatives `yps` (m,
    size; zero where the segment has a right-hand side).  New are the intervals between the steps `begin` and `end`, up
    to `until` (s) if the run ends before the last of them does; the other steps are neighbours.  `stiff`: by a method
    whose rates are only as exact as its tolerance where the scene's fastest decay magnifies that."""

    segment: object
    t: np.ndarray
    ys: np.ndarray
    yps: np.ndarray
    begin: int
    end: int
    until: float | None = None
    stiff: bool = False

    @cached_property
    def motion(self) -> tuple[np.ndarray, np.ndarray]:
        """Displacements and rates, each (m, n), at the steps."""
        return self.segment.motion(self.ys, self.yps)

    @cached_property
    def slopes(self) -> np.ndarray | None:
        """The right-hand side (m, size) at the steps; None where a ring has no mass."""
        return None if np.any(self.segment.lacks_inertia) else self.segment.derivatives(self.t, self.ys)

    @cached_property
    def accelerations(self) -> np.ndarray | None:
        """Second derivatives (m, n) of the displacements at the steps; None where a ring has no mass."""
        slopes = self.slopes
        return None if slopes is None else np.ascontiguousarray(slopes[:, self.segment.rate_places])

    @cached_property
    def increments(self) -> np.ndarray:
        """Integrals (end - begin, size) of the right-hand side over each new step; every ring has mass."""
        return integrals(self.t, self.slopes, self.begin, self.end)

    @property
    def whole(self) -> int:
        """The last step up to which whole intervals belong to the run."""
        return self.end if self.until is None else self.end - 1

    def cut(self, until: float) -> "Block":
        """The block of a run that ends at `until` (s, of the segment)."""
        return self._with(end=int(np.searchsorted(self.t, until)), until=until)

    def only(self, step: int) -> "Block":
        """The block with one step new."""
        return self._with(begin=step, end=step + 1)

    def _with(self, **other) -> "Block":
        found = replace(self, **other)
        # What has been worked out stays.
        for name in ("motion", "slopes", "accelerations"):
            if name in self.__dict__:
                found.__dict__[name] = self.__dict__[name]
        return found

    def at(self, times) -> tuple[np.ndarray, np.ndarray]:
        """Displacements and rates, each (k, n), at `times` (k,) (s, of the segment) inside the new steps.

        Rates are interpolated with the accelerations at the steps, as far as these can be trusted: the slope of the
        displacements' interpolant would magnify their error by one over the step.
        """
        first, last = max(0, self.begin - OVERLAP), min(len(self.t), self.end + OVERLAP + 1)
        begin, end, count, t = self.begin - first, self.end - first, last - first, self.t[first:last]
        (values, slopes), more = self.motion, self.accelerations
        out, slope = np.empty((2, len(times), values.shape[1]))
        sample(t, values[first:last], slopes[first:last], count, begin, end, times, out, slope)
        if more is not None and self.stiff:
            sample_doubtful(t, slopes[first:last], more[first:last], count, begin, end, times, slope)
        elif more is not None:
            sample(t, slopes[first:last], more[first:last], count, begin, end, times, slope, np.empty_like(slope))
        return out, slope

    def film_at(self, times) -> tuple:
        """The film's unknowns (k, n) at `times` (k,) (s), in a tuple; an empty one where it has none."""
        film = self.segment.film
        if film.start == film.stop:
            return ()
        first, last = max(0, self.begin - OVERLAP), min(len(self.t), self.end + OVERLAP + 1)
        x, x_rate = (np.ascontiguousarray(part[first:last, film]) for part in (self.ys, self.yps))
        out, slope = np.empty((len(times), x.shape[1])), np.empty((len(times), x.shape[1]))
        sample(self.t[first:last], x, x_rate, last - first, self.begin - first, self.end - first, times, out, slope)
        return (self.segment.film_between(times, *self.at(times), out),)


class Recorder:
    """A sink that keeps displacements in memory, every `interval` seconds; none without an interval."""

    def __init__(self, interval: float | None = None):
        self.interval, self.parts = interval, []

    def due(self, segment):
        """Segment times (m,) (s) of output: whole multiples of the interval since the start of the run."""
        if self.interval is None:
            return np.empty(0)
        first, length = max(0, int(np.ceil(segment.time / self.interval - 1e-9))), segment.length
        taus = (first + np.arange(int(length / self.interval) + 2)) * self.interval - segment.time
        inside = (taus >= 0) & ((taus < length * (1 - 1e-12)) | segment.last) & (taus <= length * (1 + 1e-12))
        return np.clip(taus[inside], 0, length)

    def take(self, segment, taus, q, q_rate, x=None):
        """Keep displacements and rates (m, n) at segment times (m,) (s); the film's unknowns `x` are not kept."""
        self.parts.append((segment.time + taus, q, q_rate))

    def state(self, segment, tau, y):
        """The state reached: not kept."""

    def event(self, segment, tau, event):
        """A change of the equations: not kept."""

    def arrays(self):
        """Times (m,) (s, of the run), displacements (m, n), rates (m, n)."""
        return tuple(np.concatenate([part[i] for part in self.parts]) for i in range(3))
