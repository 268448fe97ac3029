"""What tolerance a run needs, and how wrong it is.

A run of constant conditions is followed by solvers/run_error.py to its end.  Its first stretch is done on trial with
a loose tolerance: if that errs little enough the run goes on from there, else it starts again with a tolerance sharper
in proportion.  Any other run has the cautious tolerance of solvers/contract.py, and is done once more, sharper
(verification_run.py); where the two differ by too much it starts again.
**Valid** estimates, not bounds.
"""

import math
from collections.abc import Iterator
from dataclasses import dataclass, replace

import numpy as np

from ..dynamics.run_state import RunState
from ..scene.radial import RadialScene
from ..solvers.contract import BETWEEN, TIGHTEST, Block, Cause, Counts, Enough, SolverFailure, Status, tolerance_for
from ..solvers.integrate import COMPILED, Advance, Outcome
from ..solvers.methods import METHODS
from ..solvers.run_error import EnergyAudit, GlobalErrorEstimate, missing_energy
from .film_error import cell_error, model_error
from .selection import Plan, choose_method
from .verification_run import EXPLICIT, LEAST_SHARPER, OTHER, UNBOUNDED, Comparison, ErrorScales, budget

# The stretch (fastest periods), and what it shows, times this, is what a run has (what passes ERROR_SHARE nevertheless
# is sharpened).
TRIAL_PERIODS, TRIAL_SAFETY = 3.0, 8.0
# Steps of a trial beyond which the method crawls there: the run itself tells how far it gets.
TRIAL_STEPS = 20_000
# How far a run is from a sharper one, times this, is its error.
MEASURED = 2.0
# What an estimate leaves out, between steps and between the instants that are compared, over the accuracy: nothing
# below is promised (tests/benchmark/honesty.py: 2 of 200 random scenes erred by 0.02 and 0.15 of the accuracy and were
# estimated twenty and more times lower).
LEFT_OUT = 0.05
# First try of a tolerance over the cautious one; the share of the accuracy its error may take, and what the energy
# audit may show of the stretch, in accuracies.
LOOSER, SHARE, ENERGY = 30.0, 0.5, 2.5
# The share of the accuracy beyond which a run goes on with a sharper tolerance.
ERROR_SHARE = 0.6
# Motion so many times faster than all that turns or shakes, and damped by less than this share of its frequency, rings
# after every error of a step that passes over it, which the steps do not show: a gas dam's, which damps nothing.
RINGS, DEAD = 10.0, 0.05
# A linear answer that grows by more than this power of e over the run tells nothing.
GROWN = 5.0
# What to try where the solver errs too much: of a stiff scene, which BDF is chosen for, no explicit method.
CURE = {"adams": 'run.solver = "dop853" or a sharper run.accuracy',
        "bdf": 'run.solver = "radau" or a sharper run.accuracy'}  # fmt: skip


@dataclass(frozen=True)
class TrialRun:
    """A tolerance and a sentence why; the steps of the first stretch to go on from (`times` (m,) (s), `unknowns` (m,
    size); none if it was done in vain) and what they cost."""

    tolerance: float
    said: str
    times: np.ndarray
    unknowns: np.ndarray
    counts: Counts

    @classmethod
    def without_steps(cls, tolerance: float, said: str) -> "TrialRun":
        """Of a tolerance that needs no trial."""
        return cls(tolerance, said, np.empty(0), np.empty(0), Counts())

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
    """Estimated errors of all that is looked at (ErrorScales), relative to the scales of `accuracy`: of the solver, of
    the film against the next higher film model (each None where it cannot be estimated, or there is no higher one),
    both together, and a sentence; `horizon` (s): the time up to which a run that is measured is as exact as asked, None
    where it is to its end.  `cells`: error of cells that stand beside, with what is asked of them, `grid`."""

    asked: float
    solver: float | None
    model: float | None
    said: str
    horizon: float | None = None
    cells: float | None = None
    grid: float | None = None

    @property
    def met(self) -> bool | None:
        """Whether all is as exact as asked; None if that is not known: what the film errs by tells nothing of the
        solver."""
        if self.estimated is None:
            return None
        if self.estimated > self.asked or (self.grid is not None and not self.cells <= self.grid):
            return False
        return None if self.solver is None else True

    @property
    def estimated(self) -> float | None:
        """Both errors together; None if neither is known."""
        known = [error for error in (self.solver, self.model) if error is not None]
        return sum(known) if known else None

    @property
    def solved(self) -> bool:
        """Whether the solver's error is within what was asked, as far as it is known."""
        return self.solver is None or self.solver <= self.asked


def error_estimator(run: RunState, method: str) -> GlobalErrorEstimate | None:
    """What follows the errors of a run by this method; None where its steps cannot show them: contact, friction,
    changing conditions, supports that turn uneven, a massless ring, other methods than Adams and BDF, a whirl that
    grows until it is not linear, fast motion that nothing damps.
    """
    model, unknowns = run.model, run.model.unknowns
    follows = unknowns.constant and not (model.contact is not None or unknowns.seals or unknowns.has_residual_form)
    follows = follows and not unknowns.turning_supports
    if not follows or method not in ("adams", "bdf"):
        return None
    asked = model.accuracy
    segment, least = run.segment(0), tolerance_for(method, asked, run.memory)
    scales = ErrorScales(run)
    errors = GlobalErrorEstimate(segment, ERROR_SHARE * asked, least, scales)
    if not errors.sound:
        return None
    modes = errors.motion.values
    if np.any((np.abs(modes.imag) > RINGS * scales.rate) & (np.abs(modes.real) < DEAD * np.abs(modes.imag))):
        return None
    growth = float(np.max(errors.motion.values.real))
    return errors if growth * run.duration < GROWN else None


def choose_tolerance(run: RunState, method: str) -> tuple[TrialRun | None, GlobalErrorEstimate | None]:
    """The loosest tolerance whose estimated error stays within its share of the accuracy, no looser than LOOSER times
    the cautious one, and what follows the run's errors.  No trial where the start does not represent the run: where
    errors cannot be followed, an unstable scene, errors that add up over the whole run; and where the method fails on
    trial, or crawls."""
    errors = error_estimator(run, method)
    if errors is None or run.memory * run.model.shortest_period > 0.5 * run.duration:
        return None, errors
    before = errors.state()
    trial = _trial(run, method, errors)
    errors.restore(before)
    return trial, errors


def first_steps(run, plan: Plan) -> tuple[TrialRun | None, GlobalErrorEstimate | None]:
    """What a plan begins with, as `choose_tolerance`: its own tolerance where it has one, since what has been estimated
    before, and too large, is measured now."""
    if plan.tolerance is None:
        return choose_tolerance(run, plan.method)
    return TrialRun.without_steps(plan.tolerance, f"tolerance {plan.tolerance:.1e}"), None


def _trial(run: RunState, method: str, errors: GlobalErrorEstimate) -> TrialRun | None:
    model = run.model
    asked, cautious = model.accuracy, tolerance_for(method, model.accuracy, run.memory)
    tolerance, counts = min(LOOSER * cautious, asked), Counts()
    if tolerance <= cautious:
        return None
    segment = run.segment(0)
    length = min(TRIAL_PERIODS * model.shortest_period, segment.length)
    short, y, parts = segment.until(length), run.y0.copy(), []
    advance, steps = Advance(length, model.shortest_period), 0
    try:
        for t, ys, _ in METHODS[method](short, 0.0, y, method, tolerance, counts):
            parts.append((t, ys))
            steps += len(t)
            advance.see(float(t[-1]), steps)
            if steps > TRIAL_STEPS:
                return None
    except SolverFailure:
        return None
    t, ys = (np.concatenate([part[i] for part in parts]) for i in range(2))
    whole = np.vstack([y, ys])
    block = Block(segment, np.concatenate([[0.0], t]), whole, np.zeros_like(whole), 0, len(t))
    audit = EnergyAudit(solved=False)
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


def solver_error(method: str, tolerance: float, apart: np.ndarray | None) -> float | None:
    """Estimated error of a run that is not followed, by this method with this `tolerance`, from how far it is `apart`
    (m,) from a sharper one (verification_run.py); None if there is none."""
    if method == "expm":
        # Exact at the steps, and between them as good as the tolerance wants it (tests/convergence).
        return BETWEEN * tolerance
    return None if apart is None else max(MEASURED * float(np.nanmax(apart)), tolerance)


def horizon(times, apart, asked: float) -> float | None:
    """The time (s) up to which a run is within what was `asked`, from the times (m,) (s) and how far (m,) it is apart
    from a sharper one; None if it always is."""
    over = np.flatnonzero(MEASURED * apart > asked)
    return float(times[over[0]]) if len(over) else None


def no_certificate(asked: float, why: str) -> dict:
    """The certificate of a run that has none, and why, as part of its summary."""
    none = dict.fromkeys(("estimated", "solver", "model", "met", "horizon"))
    return {"asked": asked, **none, "said": f"no certificate: {why}"}


def _so_many(error: float | None, wanted: float, order: float) -> str:
    """How many times the cells there are bring their error, of an order, to what is wanted, in words."""
    known = error and math.isfinite(error)
    return f", some {(error / wanted) ** (1.0 / order):.2g} times as many each way" if known else ""


def _by_film(run: RunState, by_model: float | None, cells) -> tuple[float | None, float | None, str]:
    """Errors of a film against the next higher model and of its cells, and a sentence."""
    interface = run.model.interface
    if by_model is None and interface.film.constant:
        by_model = model_error(run)
    by_cells = cell_error(run, None if cells is None else float(np.nanmax(cells, initial=0.0)))
    if by_cells is None and run.model.observed[0].halved is not None:
        by_cells = math.inf
    if interface.grid_accuracy is not None:
        asked = f"of {interface.grid_accuracy:.0e} asked, by half of them"
        return by_model, by_cells, f"beside it cells {by_cells:.1e} {asked}"
    if by_cells is not None:
        return by_cells, by_cells, f"cells {by_cells:.1e}, by half of them"
    if by_model is not None:
        return by_model, None, f"model {by_model:.1e} against the radial film"
    if interface.film.constant:
        return None, None, "the linear film's own error not estimated here"
    return None, None, f"the {interface.name} film has no higher model"


def certify(
    run: RunState,
    method: str,
    tolerance: float,
    errors: GlobalErrorEstimate | None = None,
    by_model: float | None = None,
    measured: tuple[np.ndarray, np.ndarray] | None = None,
    cells: np.ndarray | None = None,
) -> Certificate:
    """Certificate of a finished run by this method with this `tolerance`, with the errors of its steps (`errors`) and
    of its film (`by_model`, relative) as far as they have been followed; `measured`: instants (m,) (s) and how
    far (m,) it is from a sharper run there; `cells`: how far half the film's cells are at some instants."""
    by_solver = errors.worst if errors else solver_error(method, tolerance, measured and measured[1])
    if by_solver is not None and method != "expm":
        by_solver = max(by_solver, LEFT_OUT * run.model.accuracy)
    said = ", against a sharper run" if measured else ""
    parts = [f"solver {by_solver:.1e}{said}" if by_solver is not None else "solver not estimated"]
    by_cells = grid = None
    if not (radial := isinstance(run.model.scene, RadialScene)):
        interface = run.model.interface
        by_model, by_cells, sentence = _by_film(run, by_model, cells)
        grid = interface.grid_accuracy
        parts.append(sentence)
    known = [error for error in (by_solver, by_model) if error is not None]
    asked = run.model.accuracy
    sentence = f"asked {asked:.0e}, estimated {sum(known):.1e} ({', '.join(parts)})" if known else ", ".join(parts)
    # Between landings a radial seal forgets: it has no horizon.
    until = horizon(*measured, asked) if measured and not radial else None
    if known and sum(known) > asked:
        coarse = by_model and by_model > 0.5 * sum(known)
        since = f" from {until:.4g} s on" if until is not None else ""
        cure = CURE.get(method, "a sharper run.accuracy")
        if coarse:
            key = "cells" if interface.film.frame is None else "columns"
            more = f"more film.{interface.name}.{key}{_so_many(by_cells, 0.5 * asked, interface.cell_order)}"
            cure = "a higher film rung" if by_cells is None else more
        sentence += f"; NOT met{since}: try {cure}"
    if grid is not None and not by_cells <= grid:
        more = f"more cells_r and cells_theta{_so_many(by_cells, grid, 2.0)}"
        sentence += f"; cells NOT as fine as asked: try {more}, or a looser grid_accuracy"
    return Certificate(asked, by_solver, by_model, sentence, until, by_cells if grid is not None else None, grid)


def certificate(
    run, plan: Plan, outcome: Outcome, errors, seen: Comparison | None, progress=None, stop=None
) -> tuple[dict, Outcome]:
    """How wrong a run by this `plan` is estimated to be, as part of the summary: `asked`, `estimated`,
    `solver`, `model` (relative errors, None where not estimated), `met`, `horizon` (s) and `said`, a sentence; and the
    outcome, interrupted if the measuring was."""
    asked = run.model.accuracy
    if outcome.status != Status.OK:
        was = "was " if outcome.status == Status.INTERRUPTED else ""
        return no_certificate(asked, f"the run {was}{outcome.status}"), outcome
    measured = cells = None
    if seen:
        try:
            work = max(UNBOUNDED, budget(plan.method, outcome.counts))
            how = {"method": plan.method, "tolerance": outcome.tolerance, "work": work}
            stiff = plan.method == "radau" and _would_take_bdf(run)
            apart = seen.error_over_time(progress, stop, **how, stiff=stiff)
            cells = seen.change_by_halving(progress, stop, **how)
        except Enough:
            ended = replace(outcome, status=Status.INTERRUPTED, cause=Cause.INTERRUPTED, message=str(Cause.INTERRUPTED))
            return no_certificate(asked, "interrupted while the run was done once more"), ended
        if seen.failure:
            why = f"no certificate: {seen.failure}"
            failed = replace(outcome, status=Status.INACCURATE, cause=Cause.DONE, message=why)
            return no_certificate(asked, seen.failure) | {"met": False}, failed
        # Of a run that is seen in part what is wrong is known, not that nothing is.
        unknown = apart is None or (seen.dear and horizon(seen.times, apart, asked) is None)
        measured = None if unknown else (seen.times, apart)
    found = certify(run, plan.method, outcome.tolerance, errors, plan.film_error, measured, cells)
    beside = {} if found.grid is None else {"cells": found.cells, "grid_asked": found.grid}
    found = replace(found, said=f"{found.said}; the sharper run is {seen.dear}") if seen and seen.dear else found
    return {"asked": found.asked, "estimated": found.estimated, "solver": found.solver, "model": found.model,
            "met": found.met, "horizon": found.horizon, **beside, "said": found.said}, outcome  # fmt: skip


def _would_take_bdf(run) -> bool:
    """Whether decay is so fast in a run that BDF would be chosen for it."""
    return not isinstance(run.model.scene, RadialScene) and choose_method(run)[0] == "bdf"


# Tries in all; the share of the accuracy aimed at, and by how much a tolerance is sharpened at least and at most.
MOST, AIM, LEAST, SHARPEST = 4, 0.3, 0.1, 1e-3
# A sharper try that leaves more than this of the error has not helped.
HELPED = 0.5
# An error of the size of the motion itself that sharper tolerances do not touch: chaos, and no method helps.
WHOLE = 0.1
# Steps of a run beyond which it is not done again, and beyond which not by a method that is not compiled.
LONG, SLOW = 1_000_000, 1_000


def next_plan(run, solver: str, plan: Plan, outcome, found: dict, tries: list) -> Plan | None:
    """What to try after `plan`, whose certificate is `found`; None where it is exact enough, did not end well, or
    nothing more is to be hoped for.  `solver` as the scenario asks for it; `tries`: (Plan, tolerance, certificate) of
    those before.  Where a sharper one gives up, what those before have is not lost."""
    again = _again(run, solver, plan, outcome, found, tries)
    if again is None or again.last or plan.work < math.inf:
        return again
    # Only the first run has no bound: what it took is known now.
    return replace(again, work=budget(plan.method, outcome.counts))


def _again(run, solver: str, plan: Plan, outcome, found: dict, tries: list) -> Plan | None:
    """What to try after `plan`, before its work is bounded."""
    if outcome.status == Status.FAILED and tries and not plan.last:
        return _plan_after_failure(run, solver, plan, outcome, tries)
    if outcome.status != Status.OK or found["solver"] is None:
        return None
    # A gentle motion's work is known to fewer digits than its place: the audit wants a sharper run, too.
    lost = missing_energy(outcome.energy_residual, found["asked"])
    if found["solver"] <= found["asked"] and not lost:
        return None
    if plan.method == "expm" or plan.last or outcome.counts.steps > LONG:
        return None
    measured = [before for before in tries if before[2]["solver"] is not None]
    # One sharper run may err as much as the one before by chance, in one step of it; a second does not.
    most = 1 if found["solver"] > WHOLE else 2
    stuck = len(measured) >= most and found["solver"] > HELPED * measured[-most][2]["solver"]
    share = 10.0 ** np.floor(np.log10(np.clip(AIM * found["asked"] / found["solver"], SHARPEST, LEAST)))
    sharp = max(outcome.tolerance * share, LEAST_SHARPER * TIGHTEST)
    missed = f", and missed {outcome.energy_residual:.1e} of its work" if lost else ""
    erred = f"at tolerance {outcome.tolerance:.1e} the run erred by {found['solver']:.1e}{missed}"
    why = f"{plan.why}; again, sharper: {erred}"
    if len(tries) + 1 < MOST and not stuck and sharp < HELPED * outcome.tolerance:
        return replace(plan, tolerance=sharp, why=why)
    hopeless = (stuck and found["solver"] > WHOLE) or outcome.counts.steps > SLOW
    other = _other_method(run, solver, plan, tries)
    if other and not hopeless:
        return _by_other(run, plan, other, why)
    best = _best_of(tries)
    return _again_as(best, why) if best and _helped(best[2], found) else None


def _helped(found: dict, before: dict) -> bool:
    """Whether a certificate is clearly better than another: of errors of the motion's own size neither is."""
    return min(found["solver"], WHOLE) < HELPED * min(before["solver"], WHOLE)


def _other_method(run, solver: str, plan: Plan, tries: list) -> str | None:
    """The method to try in place of `plan`'s; None where there is none that is free, or that has not been tried."""
    other, tried = OTHER[plan.method], [*(before.method for before, *_ in tries), plan.method]
    free = solver == "auto" and not run.model.unknowns.has_residual_form and len(tries) + 1 < MOST
    crawls = tried[0] == "bdf" and other in EXPLICIT
    return other if free and other not in tried and not crawls else None


def _by_other(run, plan: Plan, method: str, why: str) -> Plan:
    """The plan by another method, with its cautious tolerance."""
    tolerance = tolerance_for(method, run.model.accuracy, run.memory)
    return replace(plan, method=method, tolerance=tolerance, why=f"{why}; by {method}")


def _plan_after_failure(run, solver: str, plan: Plan, outcome, tries: list) -> Plan | None:
    """What to try where a sharper `plan` gave up: the other method, else the best of those before."""
    why = f"{plan.why}; at tolerance {outcome.tolerance:.1e} {plan.method} gave up"
    other = _other_method(run, solver, plan, tries)
    if other and (other in COMPILED or outcome.counts.steps <= SLOW):
        return _by_other(run, plan, other, why)
    best = _best_of(tries)
    return best and _again_as(best, why)


def _best_of(tries: list) -> tuple | None:
    """That of `tries` that erred least; None if all gave up."""
    return min((t for t in tries if t[2]["solver"] is not None), key=lambda before: before[2]["solver"], default=None)


def _again_as(best: tuple, why: str) -> Plan:
    """The best of those before, for good."""
    return replace(best[0], tolerance=best[1], why=f"{why}; back to the best of these", last=True)


def judgement(found: dict, outcome, tries: list):
    """Certificate and outcome of the last try: "inaccurate" where energy is missing, or where the solver erred by
    more than was asked, unless errors grow so fast that sharper tries only put off when they show (chaos): then the
    certificate has a horizon."""
    if outcome.status != Status.OK:
        return found, outcome
    lost = missing_energy(outcome.energy_residual, found["asked"])
    if lost:
        return found, replace(outcome, status=Status.INACCURATE, cause=Cause.DONE, message=lost)
    if found["solver"] is None or found["solver"] <= found["asked"]:
        return found, outcome
    before = tries[-1][2] if tries else None
    if before and found["horizon"] and before["horizon"] and not _helped(found, before):
        said = (
            f"{found['said'].split('; NOT met')[0]}; within it up to the horizon of predictability, "
            f"{found['horizon']:.4g} s: later the run stands for its statistics only"
        )
        return {**found, "said": said}, outcome
    message = f"not as exact as asked: estimated {found['solver']:.1e}, asked {found['asked']:.0e}"
    return found, replace(outcome, status=Status.INACCURATE, cause=Cause.DONE, message=message)
