"""What tolerance a run needs, and how wrong it is: from a short stretch of it done twice.

The stretch is integrated again by the same method thirty times sharper; what the two differ by grows over the
periods that the scene remembers.  A scene whose stretch tells of the whole run is given the loosest tolerance that
this allows; any other the cautious one of methods.py.
**Valid** estimates, not bounds.
"""

from copy import copy
from dataclasses import dataclass, replace
from fractions import Fraction

import numpy as np

from . import watch
from .methods import TIGHTEST, attainable, tolerance_for
from .model_error import model_error
from .problem import Problem
from .recorder import Recorder
from .solve import solve
from .touches import fresh_state

# The stretch integrated twice (fastest periods), and by how much sharper the second time.
STRETCH, SHARPER, PER_PERIOD = 3.0, 30.0, 32
# What a stretch shows, times this, is what a run has (measured: up to a third of its largest error, tests/unit).
SHOWN = 4.0
# Steps grow after the stretch: what a run may err by at least, in tolerances (measured: 0.05 to 3.3 where damped).
LATER = 3.0
# First try of a tolerance over the cautious one, and the share of the accuracy its estimated error may take.
LOOSER, SHARE = 10.0, 0.4
# The energy of a motion a times smaller than its scale is known a times less well (measured: with more than 1.6 the
# audit of the FMS reference, a tenth of a scale, passes ten times the accuracy); what gain is worth a trial.
LARGE, WORTH = 1.6, 2.0
# Another method where the same one cannot be any sharper.
OTHER = {"adams": "bdf", "bdf": "ida", "ida": "ida", "dop853": "radau", "radau": "dop853", "expm": "dop853"}


@dataclass(frozen=True)
class Trial:
    """A tolerance, the solver's estimated error with it (relative to the scales; None: not known), and why."""

    tolerance: float
    error: float | None
    said: str


@dataclass(frozen=True)
class Certificate:
    """Estimated errors relative to the scales of `accuracy`: of the solver, of the film against the next rung (None
    where there is no higher one, or it cannot be estimated), both together, and a sentence."""

    asked: float
    solver: float | None
    model: float | None
    said: str

    @property
    def estimated(self) -> float | None:
        """Both errors together; None if neither is known."""
        known = [error for error in (self.solver, self.model) if error is not None]
        return sum(known) if known else None


def try_tolerance(problem: Problem, method: str) -> Trial | None:
    """The loosest tolerance whose estimated error stays within its share of the accuracy, no looser than LOOSER times
    the cautious one.  None where a stretch at the start does not tell of the run: contact, friction, changing
    conditions, a massless ring, an unstable scene, errors that add up over the whole run, `expm`; and where the
    motion is so small that its energy needs the cautious one."""
    told = problem.constant and not (problem.contact is not None or problem.layout.seals or problem.massless)
    if not told or method == "expm" or problem.memory * problem.fast_time > 0.5 * problem.duration:
        return None
    cautious, large = tolerance_for(method, problem.accuracy, problem.memory), min(1.0, LARGE * _motion(problem))
    tolerance, allowed = min(LOOSER * large * cautious, problem.accuracy), SHARE * large * problem.accuracy
    if tolerance < WORTH * cautious:
        return None
    error = _shown(problem, method, tolerance)
    if error is None:
        return None
    if error > allowed:
        # Errors are proportional to tolerances, as far as they are at all: what is gained is not counted on in full.
        sharper = max(cautious, tolerance * allowed / error)
        tolerance, error = sharper, error * (sharper / tolerance) ** 0.9
    return Trial(
        tolerance,
        max(error, LATER * tolerance),
        f"tolerance {tolerance:.1e} by a trial over {STRETCH:.0f} fastest periods",
    )


def _motion(problem: Problem) -> float:
    """Largest displacement to be expected, of its scale: the start and the linear steady state."""
    _, answers, _ = problem.steady_motion()
    steady = sum(np.abs(answer[problem.kept()]) for _, answer in answers)
    return float(np.max((np.abs(problem.y0[: problem.n]) + steady) / problem.scales[: problem.n]))


def solver_error(problem: Problem, method: str, tolerance: float | None = None) -> float | None:
    """Estimated error of displacements over the run relative to their scales, from a stretch of it done twice.
    None if the stretch does not end well.  `tolerance` of the run, if not the cautious one."""
    tolerance = tolerance or tolerance_for(method, problem.accuracy, problem.memory)
    shown = _shown(problem, method, tolerance)
    return shown if shown is None or method == "expm" else max(shown, LATER * tolerance)


def _shown(problem: Problem, method: str, tolerance: float) -> float | None:
    """What the stretch alone shows of the run's error, or None."""
    stretch = min(problem.legs[0].length, STRETCH * problem.fast_time)
    pairs = [(method, tolerance), (method, tolerance / SHARPER)]
    if method == "expm" or tolerance < SHARPER * TIGHTEST:
        other = OTHER[method]
        pairs[1] = other, tolerance_for(other, max(problem.accuracy / SHARPER, 2 * attainable(other, problem.memory)),
                                        problem.memory)  # fmt: skip
    short, parts = _shortened(problem, stretch), []
    for name, sharp in pairs:
        if short.sticking:
            short = _shortened(problem, stretch)
        sink = Recorder(short, stretch / max(8, round(STRETCH * PER_PERIOD)))
        if solve(short, name, problem.accuracy, sink, tolerance=sharp).status != "ok":
            return None
        parts.append(sink.arrays()[1])
    count = min(len(part) for part in parts)
    difference = np.abs(parts[0][:count] - parts[1][:count]) / problem.scales[: problem.n]
    remembered = min(problem.memory, problem.duration / problem.fast_time)
    return SHOWN * float(difference.max()) * max(1.0, remembered * problem.fast_time / stretch)


def _shortened(problem: Problem, stretch: float) -> Problem:
    """The problem over its first `stretch` seconds, with the tolerances of the whole run."""
    if problem.sticking:
        short = Problem(problem.scene, stretch, problem.accuracy)
        short.y0, short.memory = problem.y0.copy(), problem.memory
        return short
    short = copy(problem)
    short.legs = [replace(problem.legs[0], span=Fraction(stretch))]
    short.records, short.touching, short.contacts = watch.fresh_records(), fresh_state(), []
    return short


def certify(problem: Problem, method: str, trial: Trial | None = None, by_model: float | None = None) -> Certificate:
    """Certificate of a finished run of this problem by this method, with the errors known from choosing its tolerance
    (`trial`) and its film (`by_model`)."""
    by_solver = trial.error if trial else solver_error(problem, method)
    if by_model is None and problem.film_name == "linear":
        by_model = model_error(problem)
    parts = [f"solver {by_solver:.1e}" if by_solver is not None else "solver not estimated"]
    if by_model is not None:
        parts.append(f"model {by_model:.1e} against the radial film")
    elif problem.film_name == "linear":
        parts.append("the linear film's own error not estimated here")
    else:
        parts.append(f"the {problem.film_name} film is the highest rung")
    known = [error for error in (by_solver, by_model) if error is not None]
    asked = problem.accuracy
    said = f"asked {asked:.0e}, estimated {sum(known):.1e} ({', '.join(parts)})" if known else ", ".join(parts)
    if known and sum(known) > asked:
        cure = (
            "a higher film rung"
            if by_model and by_model > 0.5 * sum(known)
            else 'run.solver = "dop853" or a shorter run'
        )
        said += f"; NOT met: try {cure}"
    return Certificate(asked, by_solver, by_model, said)
