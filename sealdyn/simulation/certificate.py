"""What tolerance a run needs, and how wrong it is.

A run of constant conditions is followed by solvers/global_error.py to its end.  Its first stretch is done on trial with
a loose tolerance: if that errs little enough the run goes on from there, else it starts again with a tolerance sharper
in proportion.  Any other run has the cautious tolerance of solvers/contract.py, and a stretch of it is done again
thirty times sharper; what the two differ by grows over the periods that the scene remembers.
**Valid** estimates, not bounds.
"""

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np

from ..dynamics.run_state import RunState
from ..solvers.block import Block
from ..solvers.contract import TIGHTEST, Counts, SolverFailure, Status, attainable, tolerance_for
from ..solvers.energy_audit import EnergyAudit
from ..solvers.global_error import GlobalErrorEstimate
from ..solvers.integrate import solve
from ..solvers.matrix_exponential import BETWEEN
from ..solvers.methods import METHODS
from ..solvers.recorder import Recorder
from .film_error import model_error

# The stretch (fastest periods); done twice, by how much sharper the second time.
TRIAL_PERIODS, SHARPER, PER_PERIOD = 3.0, 30.0, 32
# What a stretch shows, times this, is what a run has: of a stretch done twice (at least a third of the error,
# tests/unit), and of one that is followed (what passes ERROR_SHARE nevertheless is sharpened).
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
# What to try where the solver errs too much: of a stiff scene, which BDF is chosen for, no explicit method.
CURE = {"adams": 'run.solver = "dop853" or a sharper run.accuracy',
        "bdf": 'run.solver = "radau" or a sharper run.accuracy'}  # fmt: skip
# Another method where the same one cannot be any sharper.
OTHER = {"adams": "bdf", "bdf": "ida", "ida": "ida", "dop853": "radau", "radau": "dop853"}


@dataclass(frozen=True)
class TrialRun:
    """A tolerance and a sentence why; the steps of the first stretch to go on from (`times` (m,) (s), `unknowns` (m,
    size); none if it was done in vain) and what they cost."""

    tolerance: float
    said: str
    times: np.ndarray
    unknowns: np.ndarray
    counts: Counts

    def steps(self, segment, tau, y, method, tolerance, counts) -> Iterator:
        """Steps of the method over a segment, with the contract of solvers/contract.py: from the start those of the
        trial, unless a sharper tolerance has been found necessary."""
        if tau == 0.0 and segment.index == 0 and len(self.times) and tolerance >= self.tolerance:
            counts.add_work(self.counts)
            yield self.times, self.unknowns, None
            tau, y = float(self.times[-1]), self.unknowns[-1].copy()
        if tau < segment.length:
            yield from METHODS[method](segment, tau, y, method, tolerance, counts)


@dataclass(frozen=True)
class Certificate:
    """Estimated errors relative to the scales of `accuracy`: of the solver, of the film against the next higher film
    model (each None where it cannot be estimated, or there is no higher one), both together, and a sentence."""

    asked: float
    solver: float | None
    model: float | None
    said: str

    @property
    def estimated(self) -> float | None:
        """Both errors together; None if neither is known."""
        known = [error for error in (self.solver, self.model) if error is not None]
        return sum(known) if known else None


def error_estimator(run: RunState, method: str) -> GlobalErrorEstimate | None:
    """What follows the errors of a run by this method; None where its steps cannot show them: contact, friction,
    changing conditions, a massless ring, other methods than Adams and BDF, a whirl that grows until it is not linear.
    """
    model, unknowns = run.model, run.model.unknowns
    follows = unknowns.constant and not (model.contact is not None or unknowns.seals or unknowns.has_residual_form)
    if not follows or method not in ("adams", "bdf"):
        return None
    asked = model.accuracy
    segment, least = run.segment(0), tolerance_for(method, asked, run.memory)
    errors = GlobalErrorEstimate(segment, ERROR_SHARE * asked, least)
    if not errors.sound:
        return None
    growth = float(np.max(errors.motion.values.real))
    return errors if growth * run.duration < GROWN else None


def choose_tolerance(run: RunState, method: str) -> tuple[TrialRun | None, GlobalErrorEstimate | None]:
    """The loosest tolerance whose estimated error stays within its share of the accuracy, no looser than LOOSER times
    the cautious one, and what follows the run's errors.  No trial where the start does not represent the run: where
    errors cannot be followed, an unstable scene, errors that add up over the whole run; and where the method fails on
    trial."""
    errors = error_estimator(run, method)
    if errors is None or run.memory * run.model.shortest_period > 0.5 * run.duration:
        return None, errors
    before = errors.state()
    trial = _tried(run, method, errors)
    errors.restore(before)
    return trial, errors


def _tried(run: RunState, method: str, errors: GlobalErrorEstimate) -> TrialRun | None:
    model = run.model
    asked, cautious = model.accuracy, tolerance_for(method, model.accuracy, run.memory)
    tolerance, counts = min(LOOSER * cautious, asked), Counts()
    if tolerance <= cautious:
        return None
    segment = run.segment(0)
    length = min(TRIAL_PERIODS * model.shortest_period, segment.length)
    short, y, parts = segment.until(length), run.y0.copy(), []
    try:
        for t, ys, _ in METHODS[method](short, 0.0, y, method, tolerance, counts):
            parts.append((t, ys))
    except SolverFailure:
        return None
    t, ys = (np.concatenate([part[i] for part in parts]) for i in range(2))
    whole = np.vstack([y, ys])
    block, audit = Block(segment, np.concatenate([[0.0], t]), whole, np.zeros_like(whole), 0, len(t)), EnergyAudit(True)
    audit.begin(segment, 0.0, y)
    for observer in (errors, audit):
        observer.accept(block)
    remembered = min(run.memory, run.duration / model.shortest_period)
    error = TRIAL_SAFETY * errors.worst * max(1.0, remembered * model.shortest_period / length)
    most = max(error / (SHARE * asked), audit.residual() / (ENERGY * asked))
    reason = f"tolerance {{:.1e}} by a trial over {TRIAL_PERIODS:.0f} fastest periods"
    if most <= 1.0:
        return TrialRun(tolerance, reason.format(tolerance), t, ys, counts)
    # Errors are proportional to tolerances, as far as they are at all.
    tolerance = max(cautious, tolerance / most)
    return TrialRun(tolerance, reason.format(tolerance), t[:0], ys[:0], counts)


def solver_error(run: RunState, method: str) -> float | None:
    """Estimated error of displacements over a run with the cautious tolerance, relative to their scales, from a stretch
    of it done twice.  None if the stretch does not end well.
    **Valid** as the module; of the matrix exponential the interpolation error, which the tolerance bounds."""
    model, memory = run.model, run.memory
    tolerance = tolerance_for(method, model.accuracy, memory)
    if method == "expm":
        # Exact at the steps, and between them as good as the tolerance wants it (tests/convergence).
        return BETWEEN * tolerance
    stretch = min(run.intervals[0].length, TRIAL_PERIODS * model.shortest_period)
    pairs = [(method, tolerance), (method, tolerance / SHARPER)]
    if tolerance < SHARPER * TIGHTEST:
        other = OTHER[method]
        sharp = max(model.accuracy / SHARPER, 2 * attainable(other, memory))
        pairs[1] = other, tolerance_for(other, sharp, memory)
    parts = []
    for name, sharp in pairs:
        short = RunState(model, stretch)
        short.y0, sink = run.y0.copy(), Recorder(stretch / max(8, round(TRIAL_PERIODS * PER_PERIOD)))
        if solve(short, name, model.accuracy, sink, tolerance=sharp).status != Status.OK:
            return None
        parts.append(sink.arrays()[1])
    count = min(len(part) for part in parts)
    difference = np.abs(parts[0][:count] - parts[1][:count]) / model.scales[: model.unknowns.n]
    remembered = min(memory, run.duration / model.shortest_period)
    estimate = STRETCH_SAFETY * float(difference.max()) * max(1.0, remembered * model.shortest_period / stretch)
    return max(estimate, ERROR_FLOOR * tolerance)


def certify(
    run: RunState, method: str, errors: GlobalErrorEstimate | None = None, by_model: float | None = None
) -> Certificate:
    """Certificate of a finished run by this method, with the errors of its steps (`errors`) and of its film
    (`by_model`, relative) as far as they have been followed."""
    by_solver = errors.worst if errors else solver_error(run, method)
    if by_model is None and run.model.interface.name == "linear":
        by_model = model_error(run)
    parts = [f"solver {by_solver:.1e}" if by_solver is not None else "solver not estimated"]
    if by_model is not None:
        parts.append(f"model {by_model:.1e} against the radial film")
    elif run.model.interface.name == "linear":
        parts.append("the linear film's own error not estimated here")
    else:
        parts.append(f"the {run.model.interface.name} film is the highest rung")
    known = [error for error in (by_solver, by_model) if error is not None]
    asked = run.model.accuracy
    sentence = f"asked {asked:.0e}, estimated {sum(known):.1e} ({', '.join(parts)})" if known else ", ".join(parts)
    if known and sum(known) > asked:
        coarse = by_model and by_model > 0.5 * sum(known)
        sentence += f"; NOT met: try {'a higher film rung' if coarse else CURE.get(method, 'a sharper run.accuracy')}"
    return Certificate(asked, by_solver, by_model, sentence)
