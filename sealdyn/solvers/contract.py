"""What every method shares: tolerances, counts, and how one gives up.

A method is a generator over one leg of a problem: it yields blocks `(times (m,), unknowns (m, size), derivatives or
None)` of accepted steps, in leg time, the first after the start, the last at the leg's end.
"""

from dataclasses import dataclass

import numpy as np

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
}
TIGHTEST = 3e-14


class SolverFailure(RuntimeError):
    """A solver gave up: the sentence says why and what to try."""


@dataclass
class Counts:
    """Own counts; a solver's own omit finite-difference Jacobians."""

    rhs: int = 0
    steps: int = 0
    jacobians: int = 0
    restarts: int = 0


def tolerance_for(method: str, accuracy: float, memory: float) -> float:
    """Solver tolerance that keeps the asked accuracy with this method.

    `memory` is for how many of its fastest periods the scene remembers an error: one or so when it is well damped,
    the whole run when it is not.  Never below TIGHTEST, where rounding takes over.
    """
    damped, per_period = SAFETY[method]
    return max(accuracy / max(damped, per_period * memory), TIGHTEST)


def attainable(method: str, memory: float) -> float:
    """Best accuracy this method can keep on a scene of that memory."""
    damped, per_period = SAFETY[method]
    return TIGHTEST * max(damped, per_period * memory)


def absolute_tolerances(problem, tolerance) -> np.ndarray:
    """Absolute tolerances (size,) of the unknowns: the tolerance times their scales."""
    absolute = tolerance * problem.scales
    # The sum of absolute powers has kinks and only normalises the audit: no error control on it.
    absolute[-1] = 1e30
    return absolute


def failure_message(method, message, tau) -> str:
    """Why and where a method gave up, and what to try."""
    return (
        f"{method} gave up {tau:.6g} s into this leg: {message}  "
        "Try a looser run.accuracy, another run.solver, or look whether the film is closing there."
    )
