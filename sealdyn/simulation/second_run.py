"""How wrong a run is, measured: the run once more, sharper or by another method, and how far the two are apart in
everything that is looked at."""

from dataclasses import replace

import numpy as np

from ..dynamics.model import Model
from ..dynamics.run_state import RunState
from ..scene.scene import SceneError
from ..solvers.contract import TIGHTEST, Enough, Status, attainable, tolerance_for
from ..solvers.integrate import solve
from .looked_at import LookedAt

# Instants at which two runs are compared: per fastest period, at least (many of a film whose loads jump: a hundredth of
# them must be some) and at most, and after each start of a stretch, where fast parts die away, and before its end,
# where a step is cut short, by decades of its length.
PER_PERIOD, FEW, MANY, MOST, AFTER, DECADES = 12, 100, 500, 3000, 12, 7
GOLDEN = 0.6180339887498949
# By how much sharper the second run is, and at least.
SHARPER, LEAST_SHARPER = 30.0, 3.0
# The same of a method of second order, whose steps grow more slowly with a tolerance.
SHARPER_AT_SECOND = 8.0
# Of films whose cells tear and fill, each with a jump of the loads: the share of the instants of which loads are
# compared, without those that lie between the jumps of two runs.
BESIDE_JUMPS = 0.99
# The share of its film's error that the second run has, where faces touch.
SHARPER_FILM = 0.1
# Share of what halving the cells changes that counts as their error: a third of it is, of cells small enough.
CELLS = 0.5
# Another method where the same one cannot be any sharper.
OTHER = {"adams": "bdf", "bdf": "radau", "ida": "ida", "dop853": "radau", "radau": "dop853", "trbdf2": "trbdf2"}


class Comparison:
    """An observer that keeps what is looked at of a run at instants `times` (m,) (s): columns of LookedAt, NaN where
    the run has not been."""

    def __init__(self, run: RunState):
        self.scales, self.run, self.times = LookedAt(run), run, instants(run)
        self.columns = None

    def begin(self, segment, tau, y):
        """Nothing to do: instants are of the whole run."""

    def accept(self, block):
        """Take in the instants in a block's new steps."""
        begun = block.segment.time
        until = block.t[block.end] if block.until is None else block.until
        first, last = np.searchsorted(self.times, (begun + block.t[block.begin], begun + until))
        if last > first:
            taus = self.times[first:last] - begun
            found = self.scales.of(block.segment, taus, *block.at(taus), *block.film_at(taus))
            if self.columns is None:
                self.columns = np.full((len(self.times), found.shape[1]), np.nan)
            self.columns[first:last] = found

    def error_over_time(self, progress=None, stop=None, *, method: str, tolerance: float) -> np.ndarray | None:
        """How far (m,) this run, done by `method` with `tolerance`, is from a sharper one at each instant, the largest
        over all quantities, relative to its scale; NaN where the two cannot be compared, infinite where the other has
        ended.  None if nothing can be compared; `progress(t, end)` and `stop()` as in `simulate`; Enough once `stop`
        asks for it."""
        model = self.run.model
        # A film below its floor has a bend, of which its integrals feel more than of anything else.
        again = self.run.anew(model.with_sharper_film(SHARPER_FILM) if model.scene.contact else None)
        return self._apart(again, *sharper(method, tolerance, self.run), progress, stop)

    def error_of_cells(self, progress=None, stop=None, *, method: str, tolerance: float) -> np.ndarray | None:
        """The same of the film's cells, from the run with half of them; None of a film that has none to halve, or that
        half of them cannot describe."""
        model = self.run.model
        film = model.observed[0]
        if not hasattr(film, "halved"):
            return None
        try:
            coarse = Model(replace(model.scene, film=model.interface.halved()), model.accuracy, film=model.film)
        except SceneError:
            # The run is done: half its cells tell nothing.
            return None
        again, rings = RunState(coarse, self.run.duration), model.unknowns.n_mechanical
        again.y0[:rings] = self.run.y0[:rings]
        apart = self._apart(again, method, tolerance, progress, stop)
        return None if apart is None else CELLS * apart

    def _apart(self, again, method, tolerance, progress, stop) -> np.ndarray | None:
        """How far (m,) this run is from another one, done by `method` with `tolerance`, at each instant."""
        other = Comparison(again)
        other.times = self.times
        outcome = solve(
            again, method, self.run.model.accuracy, Nothing(again, progress, stop), tolerance=tolerance, seen=other
        )
        if outcome.status == Status.INTERRUPTED:
            raise Enough
        if self.columns is None or other.columns is None:
            return None
        both = ~(np.isnan(self.columns) | np.isnan(other.columns)).any(axis=1)
        found = np.full(len(self.times), np.nan)
        if both.any():
            errors = self.scales.errors(self.columns[both], other.columns[both])
            if hasattr(self.run.model.interface.film, "settle"):
                errors = beside_jumps(errors)
            found[both] = errors.max(axis=1)
        if outcome.status != Status.OK:
            # One run ends well, the other does not: from there on nothing is right.
            found[self.times > again.end_time(outcome.segment, outcome.tau)] = np.inf
        return found


class Nothing:
    """A sink that keeps nothing, tells how far it is, and can be stopped."""

    def __init__(self, run, progress=None, stop=None):
        self.run, self.progress, self.stop = run, progress, stop

    def due(self, segment):
        """No output."""
        return np.empty(0)

    def take(self, *anything):
        """Nothing is kept."""

    def event(self, *anything):
        """Nothing is kept."""

    def state(self, segment, tau, y):
        """Raises Enough where `stop` asks for it."""
        if self.progress:
            self.progress(segment.time + tau, self.run.duration)
        if self.stop and self.stop():
            raise Enough


def sharper(method: str, tolerance: float, run) -> tuple[str, float]:
    """A method and a tolerance sharper than these, or another method where this one has no more to give."""
    if tolerance >= LEAST_SHARPER * TIGHTEST:
        return method, max(tolerance / (SHARPER_AT_SECOND if method == "trbdf2" else SHARPER), TIGHTEST)
    other = OTHER[method]
    return other, tolerance_for(other, max(run.model.accuracy / SHARPER, 2 * attainable(other, run.memory)), run.memory)


def beside_jumps(errors: np.ndarray) -> np.ndarray:
    """Errors of LookedAt (m, 6) with those of loads and flows that so few instants have cut to what the rest has."""
    if not len(errors):
        return errors
    return np.column_stack([errors[:, :2], np.minimum(errors[:, 2:], np.quantile(errors[:, 2:], BESIDE_JUMPS, axis=0))])


def instants(run) -> np.ndarray:
    """Times (m,) (s) at which runs are compared: evenly over the run, but in step with nothing, and closer after the
    starts of its stretches and before their ends."""
    least = MANY if hasattr(run.model.interface.film, "settle") else FEW
    count = int(min(max(PER_PERIOD * run.duration / run.model.shortest_period, least), MOST))
    evenly = np.mod(GOLDEN * np.arange(1, count + 1), 1.0) * run.duration
    stretches = run.intervals[:: max(1, len(run.intervals) // 30)]
    decades = 10.0 ** -np.linspace(0.3, DECADES, AFTER)
    after = [interval.time + interval.length * decades for interval in stretches]
    before = [interval.time + interval.length * (1.0 - decades) for interval in stretches]
    return np.unique(np.concatenate([evenly, *after, *before]))
