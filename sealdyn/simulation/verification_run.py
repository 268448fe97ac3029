"""How wrong a run is, measured: the run once more, sharper or by another method, and how far the two are apart in
everything that a user looks at, on the scales of `run.accuracy` (ErrorScales)."""

import base64
import math
from dataclasses import replace

import numpy as np

from ..dynamics.imposed_motion import rest_state
from ..dynamics.intervals import constant_and_slope
from ..dynamics.model import Model
from ..dynamics.run_state import RunState
from ..dynamics.signals import samples
from ..dynamics.swept_motion import splines
from ..faces.geometry import FLOW_INNER, FORCE, INNER_PRESSURE, MOMENT_X, MOMENT_Y, OUTER_PRESSURE, TORQUE
from ..numerics.piecewise_linear import initially
from ..scene.fluid import density_of, gas_of
from ..scene.scene import SceneError
from ..solvers.contract import TIGHTEST, Cause, Counts, Enough, Status, attainable, tolerance_for
from ..solvers.integrate import COMPILED, solve

# Instants at which two runs are compared: per fastest period, at least (many of a film whose loads jump: a hundredth of
# them must be some) and at most, and after each start of a stretch, where fast parts die away, and before its end,
# where a step is cut short, by decades of its length.
PER_PERIOD, FEW, MANY, MOST, AFTER, DECADES = 12, 100, 500, 3000, 12, 7
GOLDEN = 0.6180339887498949
# Points of a step, where interpolation errs most: of displacements in the middle, of their slope a fifth from the ends.
INSIDE = np.array([0.0, 0.3, 0.7])
# Instants of a radial seal.
RADIAL_INSTANTS = 1000
# By how much sharper the second run is, and at least.
SHARPER, LEAST_SHARPER = 30.0, 3.0
# The same of a method of second order, whose steps grow more slowly with a tolerance.
SHARPER_AT_SECOND = 8.0
# Of films whose cells tear and fill, each with a jump of the loads: the share of the instants of which loads are
# compared, without those that lie between the jumps of two runs.
JUMP_QUANTILE = 0.99
# The share of its film's error that the second run has, where faces touch.
SHARPER_FILM = 0.1
# Another method where the same one cannot be any sharper.
OTHER = {"adams": "bdf", "bdf": "radau", "ida": "ida", "dop853": "radau", "radau": "dop853", "trbdf2": "trbdf2"}
# Methods that crawl where decay is fast: none is tried where BDF was, or would be, chosen for that.
EXPLICIT = ("adams", "dop853")
# Evaluations that another run may take, over those of the one before, and how many compiled ones one in Python costs.
BUDGET, INTERPRETED = 10.0, 30.0
# Compiled evaluations that one may take which measures another, in any case: steps that passed over a fast motion were
# a thirtieth of those that follow it.
UNBOUNDED = 50_000


class Comparison:
    """An observer that keeps what is looked at of a run: `columns` (m, k) of ErrorScales at `times` (m,) (s).  They are
    those `asked` for, or the run's `instants` and points of its own steps, of all while they are few, then of those
    that change most: errors die away with fast parts, at whatever time of the run that is.  `failure`: how a second run
    ended that tells nothing, `dear`: that it gave up for its work, empty if none did."""

    def __init__(self, run: RunState, asked: np.ndarray | None = None, scales=None):
        self.scales, self.run = scales or ErrorScales(run), run
        # Where loads jump with cells that tear and fill what counts is how seldom two runs are apart.
        self.of_steps = asked is None and run.model.interface.film.settle is None
        self.asked = instants(run) if asked is None else asked
        # Rows: time, how much its step changes the motion (infinite of what was asked for), columns.
        self.parts, self.least = [], 0.0
        self.failure, self.dear = "", ""

    @property
    def rows(self) -> np.ndarray:
        """All rows (m, 2 + k) so far."""
        if len(self.parts) > 1:
            self.parts = [np.concatenate(self.parts)]
        return self.parts[0] if self.parts else np.empty((0, 2))

    @property
    def times(self) -> np.ndarray:
        """Times (m,) (s) so far."""
        return self.rows[:, 0]

    @property
    def columns(self) -> np.ndarray:
        """Columns (m, k) there."""
        return self.rows[:, 2:]

    def begin(self, segment, tau, y):
        """Nothing to do: instants are of the whole run."""

    def accept(self, block):
        """Take in the instants in a block's new steps, and points of these."""
        begun = block.segment.time
        until = block.t[block.end] if block.until is None else block.until
        first, last = np.searchsorted(self.asked, (begun + block.t[block.begin], begun + until))
        times, changes = self.asked[first:last], np.full(last - first, np.inf)
        if self.of_steps:
            points, moved = self._points(block, until)
            order = np.argsort(np.concatenate([times, points]), kind="stable")
            times, changes = np.concatenate([times, points])[order], np.concatenate([changes, moved])[order]
        if len(times):
            taus = times - begun
            found = self.scales.of(block.segment, taus, *block.at(taus), *block.film_at(taus))
            self.parts.append(np.column_stack([times, changes, found]))
            self._drop()

    def _points(self, block, until) -> tuple[np.ndarray, np.ndarray]:
        """Times (m,) (s) of points of a block's new steps that change the motion by more than the least that is kept,
        and by how much they do: displacements over their scales, or rates over theirs."""
        (q, rates), lengths = (part[block.begin : block.end + 1] for part in block.motion), self.scales.lengths
        speeds = rates / (lengths * self.scales.rate)
        fast = np.maximum(np.abs(speeds[1:]).max(axis=1, initial=0.0), 1.0)
        moved = np.abs(np.diff(q, axis=0) / lengths).max(axis=1, initial=0.0)
        moved = np.maximum(moved, np.abs(np.diff(speeds, axis=0)).max(axis=1, initial=0.0) / fast)
        starts = block.t[block.begin : block.end]
        widths, kept = np.append(starts[1:], until) - starts, moved > self.least
        points = starts[kept, None] + widths[kept, None] * INSIDE
        return block.segment.time + points.ravel(), np.repeat(moved[kept], len(INSIDE))

    def _drop(self):
        """Keep the half of the steps that change most, where there are too many."""
        if sum(len(part) for part in self.parts) > len(self.asked) + MOST:
            changes = self.rows[:, 1]
            self.least = float(np.median(changes[np.isfinite(changes)]))
            self.parts = [self.rows[changes > self.least]]

    def error_over_time(
        self, progress=None, stop=None, *, method: str, tolerance: float, work: float = math.inf, stiff: bool = False
    ) -> np.ndarray | None:
        """How far (m,) this run, done by `method` with `tolerance`, is from a sharper one at each instant, the largest
        over all quantities, relative to its scale; NaN where the two cannot be compared, infinite where the other has
        ended.  None if nothing can be compared; `progress(t, end)` and `stop()` as in `simulate`; Enough once `stop`
        asks for it.  `work`: compiled evaluations after which the other gives up, NaN from there on; `stiff`
        as `sharper` takes it."""
        method, tolerance = sharper(method, tolerance, self.run, stiff)
        return self._apart(self._sharper_run(), method, tolerance, progress, stop, work)

    def change_by_halving(
        self, progress=None, stop=None, *, method: str, tolerance: float, work: float = math.inf
    ) -> np.ndarray | None:
        """How far (m,) the run with half the film's cells is from this one; None of a film that has none to halve, or
        that half of them cannot describe."""
        again = self._halved_run()
        return None if again is None else self._apart(again, method, tolerance, progress, stop, work)

    def _sharper_run(self) -> RunState:
        """The run once more.  A film below its floor has a bend, of which its integrals feel more than of anything
        else."""
        model = self.run.model
        return self.run.anew(model.with_sharper_film(SHARPER_FILM) if model.scene.contact else None)

    def _halved_run(self) -> RunState | None:
        """The run with half the film's cells; None without."""
        model = self.run.model
        if model.observed[0].halved is None:
            return None
        try:
            coarse = Model(replace(model.scene, film=model.interface.halved()), model.accuracy, film=model.film)
        except SceneError:
            # The run is done: half its cells tell nothing.
            return None
        again, rings = RunState(coarse, self.run.duration), model.unknowns.n_mechanical
        again.y0[:rings] = self.run.y0[:rings]
        return again

    def _apart(self, again, method, tolerance, progress, stop, work) -> np.ndarray | None:
        """How far (m,) this run is from another one, done by `method` with `tolerance`, at each instant."""
        other = type(self)(again, self.times)
        outcome = solve(
            again, method, again.model.accuracy, ProgressSink(again, progress, stop), tolerance=tolerance, seen=other,
            work=work / price(method),
        )  # fmt: skip
        if outcome.status == Status.INTERRUPTED:
            raise Enough
        count = len(other.times)
        if not count:
            return None
        if outcome.cause == Cause.TOO_DEAR:
            self.dear = outcome.message
        both = np.flatnonzero(~np.isnan(self.columns[:count] + other.columns).any(axis=1))
        found = np.full(len(self.times), np.nan)
        if len(both):
            found[both] = self._largest(self.scales.errors(self.columns[both], other.columns[both]))
        return self._ended(outcome, again, found)

    def _largest(self, errors: np.ndarray) -> np.ndarray:
        """The largest error (m,) of all quantities, without those between the jumps of two runs."""
        return (clip_jumps(errors) if self.run.model.interface.film.settle is not None else errors).max(axis=1)

    def _ended(self, outcome, again, found: np.ndarray) -> np.ndarray:
        """What was `found`, after a second run that ended with `outcome`."""
        if outcome.status != Status.OK and outcome.cause != Cause.TOO_DEAR:
            # One run ends well, the other does not: from there on nothing is right.
            found[self.times > again.end_time(outcome.segment, outcome.tau)] = np.inf
        return found

    def state(self) -> dict:
        """What a continued run needs: the rows so far, their bytes as text."""
        rows = base64.b64encode(self.rows.tobytes()).decode()
        return {"count": len(self.rows), "rows": rows, "least": self.least}

    def restore(self, state: dict):
        """Go on from `state`."""
        if state["count"]:
            self.parts = [np.frombuffer(base64.b64decode(state["rows"])).reshape(state["count"], -1)]
        self.least = float(state["least"])


class RadialComparison(Comparison):
    """The same of a radial seal: displacements and loads of the followers."""

    def __init__(self, run, asked: np.ndarray | None = None):
        # Kernels of radial seals are loaded for these only.
        from ..radial_seals.observers import RadialErrorScales

        evenly = np.sort(np.mod(GOLDEN * np.arange(1, RADIAL_INSTANTS + 1), 1.0)) * run.duration
        super().__init__(run, evenly if asked is None else asked, RadialErrorScales(run.model))

    def _sharper_run(self):
        """With sharper steps and sharper events: how long a step may be and what counts as contact follow from the
        accuracy."""
        return self.run.sharper(SHARPER)

    def _halved_run(self) -> None:
        """None: there is no film."""

    def _largest(self, errors):
        """A load jumps where a follower lands: beside a jump two runs differ by all of it."""
        largest = errors.max(axis=1)
        return np.minimum(largest, np.quantile(largest, JUMP_QUANTILE))

    def _ended(self, outcome, again, found):
        if outcome.status != Status.OK and outcome.cause != Cause.TOO_DEAR:
            self.failure = f"a sharper run {outcome.status} ({outcome.message})"
        return found


class ProgressSink:
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

    def log(self, events):
        """Nothing is kept."""

    def state(self, segment, tau, y):
        """Raises Enough where `stop` asks for it."""
        if self.progress:
            self.progress(segment.time + tau, self.run.duration)
        if self.stop and self.stop():
            raise Enough


def price(method: str) -> float:
    """Compiled evaluations that one of a method costs."""
    return 1.0 if method in COMPILED else INTERPRETED


def budget(method: str, counts: Counts) -> float:
    """Compiled evaluations that a run may take beside one by a method that took these `counts`."""
    return BUDGET * counts.rhs * price(method)


def sharper(method: str, tolerance: float, run, stiff: bool = False) -> tuple[str, float]:
    """A method and a tolerance sharper than these, or another method where this one has no more to give; `stiff`: of a
    scene whose decay is fast."""
    if tolerance >= LEAST_SHARPER * TIGHTEST:
        return method, max(tolerance / (SHARPER_AT_SECOND if method == "trbdf2" else SHARPER), TIGHTEST)
    other = OTHER[method]
    if other in EXPLICIT and stiff:
        other = "bdf"
    return other, tolerance_for(other, max(run.model.accuracy / SHARPER, 2 * attainable(other, run.memory)), run.memory)


def clip_jumps(errors: np.ndarray) -> np.ndarray:
    """Errors of ErrorScales (m, 6) with those of loads and flows that so few instants have cut to what the rest has."""
    if not len(errors):
        return errors
    return np.column_stack(
        [errors[:, :2], np.minimum(errors[:, 2:], np.quantile(errors[:, 2:], JUMP_QUANTILE, axis=0))]
    )


def instants(run) -> np.ndarray:
    """Times (m,) (s) at which runs are compared: evenly over the run, but in step with nothing, and closer after the
    starts of its stretches and before their ends."""
    least = MANY if run.model.interface.film.settle is not None else FEW
    count = int(min(max(PER_PERIOD * run.duration / run.model.shortest_period, least), MOST))
    evenly = np.mod(GOLDEN * np.arange(1, count + 1), 1.0) * run.duration
    stretches = run.intervals[:: max(1, len(run.intervals) // 30)]
    decades = 10.0 ** -np.linspace(0.3, DECADES, AFTER)
    after = [interval.time + interval.length * decades for interval in stretches]
    before = [interval.time + interval.length * (1.0 - decades) for interval in stretches]
    return np.unique(np.concatenate([evenly, *after, *before]))


# Share of what the clearance holds below which nothing flows through.
NOTHING = 1e-9
QUANTITIES = ("displacement", "rate", "force", "moment", "leakage", "torque")


class ErrorScales:
    """What a user looks at, and the scales by which its errors are told: what `run.accuracy` is about.

    Displacements: the clearance C, of tilts C over the outer radius r_o.  Rates: these times the reference rate, the
    largest of shaft speed, relative spin and housing frequencies, or the rate itself at that instant where it is larger
    (a squeezed film lets go a million times faster than anything turns).  Film force: F, the largest closing force over
    the run less the lower pressure on the face (if there is none, the largest film force less the same).  Film moment:
    F r_o.  Leakage: the larger of its peak and that of the aligned film at C under the largest pressure difference;
    between equal pressures, where nothing flows through, the volume that the clearance holds, times the reference rate.
    Torque: the larger of its peak and that of the aligned film at C.

    Of a run (RunState): `lengths` (n,) of displacements, reference `rate` (rad/s), `force` (N) and, of the aligned film
    at the clearance, `leakage` (m^3/s) and `torque` (N m).
    """

    def __init__(self, run):
        model = run.model
        self.n, self.rate = model.unknowns.n, reference_rate(run)
        self.lengths, self.outer_radius = model.scales[: self.n], model.scene.film.outer_radius
        ends = [end for interval in run.intervals.few for end in self._ends(model, interval)]
        self.force, self.leakage, self.torque = (max(one[k] for one in ends) for k in range(3))
        swept = self._gap_volume(model) * self.rate
        # Of what a film does not know there is no error.
        self.unknown = np.flatnonzero(np.isnan([self.leakage, self.torque])) - 2
        self.leakage, self.torque = np.nan_to_num([self.leakage, self.torque])
        self.leakage = swept if self.leakage < NOTHING * swept else self.leakage

    def _ends(self, model, interval):
        """Closing force less the lower pressure (N), aligned leakage and torque at both ends of an interval."""
        film, (observed, f) = model.scene.film, model.observed
        area = math.pi * (film.outer_radius**2 - film.inner_radius**2)
        closing = model.closing.over(interval, film)
        pressures = np.array([constant_and_slope(p, interval) for p in (film.inner_pressure, film.outer_pressure)])
        s, _ = rest_state(model.scene, model.clearance, interval)
        for tau in (0.0, interval.length):
            at = pressures @ [1.0, tau]
            s[INNER_PRESSURE], s[OUTER_PRESSURE] = at
            try:
                own = () if model.interface.unknowns is None else (model.interface.steady(f, s),)
                observed.flow(f, s, *own)
            except SceneError:
                # No film so thin over grooves that turn so fast: the peaks alone.
                s[FLOW_INNER] = s[TORQUE] = 0.0
            yield closing[0] + closing[1] * tau - min(at) * area, abs(s[FLOW_INNER]), abs(s[TORQUE])

    def _gap_volume(self, model) -> float:
        """Volume (m^3, of a gas at normal conditions) between the faces."""
        film, gas = model.scene.film, gas_of(model.scene.film)
        volume = math.pi * (film.outer_radius**2 - film.inner_radius**2) * model.clearance
        if gas is None:
            return volume
        density = initially(film.inner_pressure) / (gas.gas_constant * initially(film.temperature))
        return volume * density / density_of(film)

    def of(self, segment, taus, q, q_rate, x=None) -> np.ndarray:
        """Columns (m, 2 n + 5) at segment times (m,) (s), SI where they have no scale of their own: displacements and
        rates over theirs, film force, moments about x and y, leakage, torque."""
        at = samples(segment, taus, q, q_rate, x)
        loads = at.gap[:, [FORCE, MOMENT_X, MOMENT_Y, FLOW_INNER]]
        columns = np.column_stack([q / self.lengths, q_rate / (self.lengths * self.rate), loads, at.torque])
        columns[:, self.unknown] = 0.0
        return columns

    def errors(self, one: np.ndarray, other: np.ndarray) -> np.ndarray:
        """How far (m, len(QUANTITIES)) the columns of two runs at the same times are apart, over the scales of the
        second."""
        n, gap, peaks = self.n, np.abs(one - other), np.max(np.abs(other), axis=0, initial=0.0)
        force, leakage, torque = self.force, max(self.leakage, peaks[-2]), max(self.torque, peaks[-1])
        force = force if force > 0.0 else peaks[2 * n]
        moment = np.hypot(gap[:, 2 * n + 1], gap[:, 2 * n + 2])
        fast = np.maximum(np.abs(other[:, n : 2 * n]).max(axis=1), 1.0)
        # What is nothing throughout has no scale, and no error.
        force, leakage, torque = (scale or 1.0 for scale in (force, leakage, torque))
        over = [gap[:, 2 * n] / force, moment / (force * self.outer_radius), gap[:, -2] / leakage, gap[:, -1] / torque]
        return np.column_stack([gap[:, :n].max(axis=1), gap[:, n : 2 * n].max(axis=1) / fast, *over])


def reference_rate(run) -> float:
    """The largest (rad/s) of shaft speed, relative spin and housing frequencies over a run; where nothing turns or
    shakes that of the model."""
    scene, found = run.model.scene, [0.0]
    for interval in run.intervals.few:
        (shaft, faster), (stator, turning) = (
            constant_and_slope(speed, interval) for speed in (scene.shaft.speed, scene.stator.speed)
        )
        for tau in (0.0, interval.length):
            w = shaft + faster * tau
            found += [abs(w), abs(w - stator - turning * tau)]
    found += [2 * math.pi * tone.frequency for tone in scene.housing.tones]
    found += [2 * math.pi * max(sweep.frequency) for sweep in scene.housing.sweeps]
    found += [sampled.rate for sampled in splines(scene).values()]
    return max(found) or run.model.reference_rate
