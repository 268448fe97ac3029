"""What tolerance a run needs, and how wrong it is.

A run of constant conditions is followed by solvers/global_error.py to its end.  Its first stretch is done on trial
with a loose tolerance: if that errs little enough the run goes on from there, else it starts again as much sharper as
that told. Any other run has the cautious tolerance of solvers/methods.py, and a stretch of it is done again thirty
times sharper; what the two differ by grows over the periods that the scene remembers.
**Valid** estimates, not bounds.
"""

from collections.abc import Iterator
from copy import copy
from dataclasses import dataclass, replace
from fractions import Fraction

import numpy as np

from ..dynamics import extrema
from ..dynamics.contact_events import no_contact
from ..dynamics.model import Model
from ..solvers.contract import TIGHTEST, Counts, SolverFailure, attainable, tolerance_for
from ..solvers.energy_audit import Audit
from ..solvers.global_error import GlobalErrorEstimate
from ..solvers.integrate import solve
from ..solvers.matrix_exponential import BETWEEN
from ..solvers.methods import METHODS
from ..solvers.recorder import Recorder
from .film_error import model_error

# The stretch (fastest periods); done twice, by how much sharper the second time.
TRIAL_PERIODS, SHARPER, PER_PERIOD = 3.0, 30.0, 32
# What a stretch shows, times this, is what a run has: of a stretch done twice (at least a third of the error,
# tests/unit), and of one that is followed (what passes ALLOWED nevertheless is sharpened).
STRETCH_SAFETY, TRIAL_SAFETY = 6.0, 8.0
# Steps grow after the stretch: what a run may err by at least, in tolerances (measured: 0.05 to 3.3 where damped).
ERROR_FLOOR = 3.0
# First try of a tolerance over the cautious one; the share of the accuracy its error may take, and what the energy
# audit may show of the stretch, in accuracies.
LOOSER, SHARE, ENERGY = 30.0, 0.5, 2.5
# The share of the accuracy beyond which a run goes on with a sharper tolerance.
ERROR_SHARE = 0.6
# A linear answer that grows by more than this power of e over the run tells nothing.
GROWN = 5.0
# Another method where the same one cannot be any sharper.
OTHER = {"adams": "bdf", "bdf": "ida", "ida": "ida", "dop853": "radau", "radau": "dop853"}


@dataclass(frozen=True)
class TrialRun:
    """A tolerance and why; the steps of the first stretch to go on from (times, unknowns; none if it was done in vain)
    and what they cost."""

    tolerance: float
    said: str
    times: np.ndarray
    unknowns: np.ndarray
    counts: Counts

    def steps(self, problem, leg, tau, y, method, tolerance, counts) -> Iterator:
        """Steps of the method over a leg, with the contract of solvers/methods.py: from the start those of the trial,
        unless a
        sharper tolerance has been found necessary."""
        if tau == 0.0 and problem.leg_index == 0 and len(self.times) and tolerance >= self.tolerance:
            counts.rhs, counts.jacobians = counts.rhs + self.counts.rhs, counts.jacobians + self.counts.jacobians
            yield self.times, self.unknowns, None
            tau, y = float(self.times[-1]), self.unknowns[-1].copy()
        if tau < leg.length:
            yield from METHODS[method](problem, leg, tau, y, method, tolerance, counts)


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


def error_estimator(problem: Model, method: str) -> GlobalErrorEstimate | None:
    """What follows the errors of a run of this problem by this method; None where its steps do not tell them: contact,
    friction, changing conditions, a massless ring, methods of long steps, a whirl that grows until it is not linear."""
    told = problem.constant and not (problem.contact is not None or problem.layout.seals or problem.massless)
    if not told or method not in ("adams", "bdf"):
        return None
    asked = problem.accuracy
    errors = GlobalErrorEstimate(problem, ERROR_SHARE * asked, tolerance_for(method, asked, problem.memory))
    if not errors.sound:
        return None
    growth = float(np.max(errors.motion.values.real))
    return errors if growth * problem.duration < GROWN else None


def choose_tolerance(problem: Model, method: str) -> TrialRun | None:
    """The loosest tolerance whose estimated error stays within its share of the accuracy, no looser than LOOSER times
    the cautious one.  None where the start does not tell of the run: where errors cannot be followed, an unstable
    scene, errors that add up over the whole run."""
    if problem.memory * problem.fast_time > 0.5 * problem.duration:
        return None
    errors = error_estimator(problem, method)
    if errors is None:
        return None
    cautious = tolerance_for(method, problem.accuracy, problem.memory)
    tolerance, counts = min(LOOSER * cautious, problem.accuracy), Counts()
    if tolerance <= cautious:
        return None
    length = min(TRIAL_PERIODS * problem.fast_time, problem.legs[0].length)
    leg, y, parts = replace(problem.begin(0), span=Fraction(length)), problem.y0.copy(), []
    try:
        for t, ys, _ in METHODS[method](problem, leg, 0.0, y, method, tolerance, counts):
            parts.append((t, ys))
    except SolverFailure:
        return None
    t, ys = (np.concatenate([part[i] for part in parts]) for i in range(2))
    all_t, all_ys = np.concatenate([[0.0], t]), np.vstack([y, ys])
    slopes = problem.derivatives(all_t, all_ys)
    errors.take(all_t, all_ys, np.ascontiguousarray(slopes[:, problem.rate_places]), 0, len(t))
    audit = Audit(problem)
    audit.begin(0.0, y)
    audit.take(all_t, all_ys, 0, len(t), slopes[:, problem.works])
    remembered = min(problem.memory, problem.duration / problem.fast_time)
    error = TRIAL_SAFETY * errors.worst * max(1.0, remembered * problem.fast_time / length)
    asked = problem.accuracy
    most = max(error / (SHARE * asked), audit.residual() / (ENERGY * asked))
    said = f"tolerance {{:.1e}} by a trial over {TRIAL_PERIODS:.0f} fastest periods"
    if most <= 1.0:
        return TrialRun(tolerance, said.format(tolerance), t, ys, counts)
    # Errors are proportional to tolerances, as far as they are at all.
    tolerance = max(cautious, tolerance / most)
    return TrialRun(tolerance, said.format(tolerance), t[:0], ys[:0], counts)


def solver_error(problem: Model, method: str) -> float | None:
    """Estimated error of displacements over a run with the cautious tolerance, relative to their scales, from a stretch
    of it done twice.  None if the stretch does not end well."""
    tolerance = tolerance_for(method, problem.accuracy, problem.memory)
    if method == "expm":
        # Exact at the steps, and between them as good as the tolerance wants it (tests/convergence).
        return BETWEEN * tolerance
    stretch = min(problem.legs[0].length, TRIAL_PERIODS * problem.fast_time)
    pairs = [(method, tolerance), (method, tolerance / SHARPER)]
    if tolerance < SHARPER * TIGHTEST:
        other = OTHER[method]
        pairs[1] = other, tolerance_for(other, max(problem.accuracy / SHARPER, 2 * attainable(other, problem.memory)),
                                        problem.memory)  # fmt: skip
    short, parts = _shortened(problem, stretch), []
    for name, sharp in pairs:
        if short.sticking:
            short = _shortened(problem, stretch)
        sink = Recorder(short, stretch / max(8, round(TRIAL_PERIODS * PER_PERIOD)))
        if solve(short, name, problem.accuracy, sink, tolerance=sharp).status != "ok":
            return None
        parts.append(sink.arrays()[1])
    count = min(len(part) for part in parts)
    difference = np.abs(parts[0][:count] - parts[1][:count]) / problem.scales[: problem.n]
    remembered = min(problem.memory, problem.duration / problem.fast_time)
    shown = STRETCH_SAFETY * float(difference.max()) * max(1.0, remembered * problem.fast_time / stretch)
    return max(shown, ERROR_FLOOR * tolerance)


def _shortened(problem: Model, stretch: float) -> Model:
    """The problem over its first `stretch` seconds, with the tolerances of the whole run."""
    if problem.sticking:
        short = Model(problem.scene, stretch, problem.accuracy)
        short.y0, short.memory = problem.y0.copy(), problem.memory
        return short
    short = copy(problem)
    short.legs = [replace(problem.legs[0], span=Fraction(stretch))]
    short.records, short.touching, short.contacts = extrema.empty_records(), no_contact(), []
    return short


def certify(
    problem: Model, method: str, errors: GlobalErrorEstimate | None = None, by_model: float | None = None
) -> Certificate:
    """Certificate of a finished run of this problem by this method, with the errors of its steps (`errors`) and of its
    film (`by_model`) as far as they have been followed."""
    by_solver = errors.worst if errors else solver_error(problem, method)
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
