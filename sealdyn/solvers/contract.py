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

from dataclasses import dataclass, field
from enum import StrEnum

import numpy as np

from ..status import Status as Status

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
