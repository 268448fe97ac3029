"""A run that is not as exact as asked is done again, sharper or by another method, as long as that helps."""

from dataclasses import dataclass, replace

import numpy as np

from ..solvers.contract import TIGHTEST, Cause, Status, tolerance_for
from ..solvers.energy_audit import missing_energy
from .certificate import TrialRun, choose_tolerance
from .second_run import LEAST_SHARPER, OTHER

# Tries in all; the share of the accuracy aimed at, and by how much a tolerance is sharpened at least and at most.
MOST, AIM, LEAST, SHARPEST = 4, 0.3, 0.1, 1e-3
# A sharper try that leaves more than this of the error has not helped.
HELPED = 0.5
# An error of the size of the motion itself that sharper tolerances do not touch: chaos, and no method helps.
WHOLE = 0.1
# Steps of a run beyond which it is not done again, and beyond which not by a method that is not compiled.
LONG, SLOW, COMPILED = 1_000_000, 1_000, ("adams", "bdf", "ida")


@dataclass(frozen=True)
class Try:
    """A method, its tolerance (None: what the run's own choice is) and a sentence why; `last`: nothing is tried after
    it."""

    method: str
    tolerance: float | None
    why: str
    last: bool = False

    def start(self, run):
        """What `choose_tolerance` returns: a TrialRun or None, and what follows the run's errors or None."""
        if self.tolerance is None:
            return choose_tolerance(run, self.method)
        # What has been estimated before, and too large, is measured now.
        return TrialRun.without_steps(self.tolerance, f"tolerance {self.tolerance:.1e}"), None


def next_try(run, solver: str, one: Try, outcome, found: dict, tries: list) -> Try | None:
    """What to try after `one`, whose certificate is `found`; None where it is exact enough, did not end well, or
    nothing more is to be hoped for.  `solver` as the scenario asks for it; `tries`: (Try, tolerance, certificate) of
    those before.  Where a sharper one gives up, what those before have is not lost."""
    if outcome.status == Status.FAILED and tries and not one.last:
        return _instead(run, solver, one, outcome, tries)
    if outcome.status != Status.OK or found["solver"] is None or found["solver"] <= found["asked"]:
        return None
    if one.method == "expm" or one.last or outcome.counts.steps > LONG:
        return None
    measured = _measured(tries)
    stuck = bool(measured) and found["solver"] > HELPED * measured[-1][2]["solver"]
    # A power of ten: a run that was interrupted, and measured in part, is done again as the whole one would be.
    share = 10.0 ** np.floor(np.log10(np.clip(AIM * found["asked"] / found["solver"], SHARPEST, LEAST)))
    sharp = max(outcome.tolerance * share, LEAST_SHARPER * TIGHTEST)
    why = f"{one.why}; again, sharper: at tolerance {outcome.tolerance:.1e} the run erred by {found['solver']:.1e}"
    if len(tries) + 1 < MOST and not stuck and sharp < HELPED * outcome.tolerance:
        return Try(one.method, sharp, why)
    other, tried = OTHER[one.method], {before[0].method for before in tries}
    lost = (stuck and found["solver"] > WHOLE) or outcome.counts.steps > SLOW
    free = (
        solver == "auto" and not lost and not run.model.unknowns.has_residual_form and other not in (one.method, *tried)
    )
    if len(tries) + 1 < MOST and free:
        return Try(other, tolerance_for(other, run.model.accuracy, run.memory), f"{why}; by {other}")
    best = min(measured, key=lambda before: before[2]["solver"], default=None)
    if best and best[2]["solver"] < HELPED * found["solver"]:
        return Try(best[0].method, best[1], f"{why}; back to the best of these", last=True)
    return None


def _measured(tries: list) -> list:
    """Those of `tries` that did not give up."""
    return [before for before in tries if before[2]["solver"] is not None]


def _instead(run, solver: str, one: Try, outcome, tries: list) -> Try | None:
    """What to try where a sharper try `one` gave up: the other method, else the best of those before."""
    other, tried = OTHER[one.method], {before[0].method for before in tries}
    why = f"{one.why}; at tolerance {outcome.tolerance:.1e} {one.method} gave up"
    free = solver == "auto" and not run.model.unknowns.has_residual_form and other not in (one.method, *tried)
    if len(tries) + 1 < MOST and free and (other in COMPILED or outcome.counts.steps <= SLOW):
        return Try(other, tolerance_for(other, run.model.accuracy, run.memory), f"{why}; by {other}")
    best = min(_measured(tries), key=lambda before: before[2]["solver"], default=None)
    return best and Try(best[0].method, best[1], f"{why}; back to the best of these", last=True)


def judged(found: dict, outcome, tries: list):
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
    if before and found["horizon"] and before["horizon"] and found["solver"] > HELPED * before["solver"]:
        said = (
            f"{found['said'].split('; NOT met')[0]}; within it up to the horizon of predictability, "
            f"{found['horizon']:.4g} s: later the run stands for its statistics only"
        )
        return {**found, "said": said}, outcome
    message = f"not as exact as asked: estimated {found['solver']:.1e}, asked {found['asked']:.0e}"
    return found, replace(outcome, status=Status.INACCURATE, cause=Cause.DONE, message=message)
