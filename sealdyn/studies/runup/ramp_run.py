"""A quantity that goes from one value to another at a rate and back, and the run of a scenario over such a trip.

A passing of the stability threshold is followed as two runs: one that meets a small whirl of the least damped mode
where the threshold is crossed, and the same without; what they differ by is the free whirl, exactly so with a linear
film, and up to the square of the tilt over the clearance with another.
"""

import math
from dataclasses import dataclass

import numpy as np

from ...analysis.whirl.mode_over_speed import modal_disturbance
from ...dynamics.extrema import H_LEG, H_TAU, MOST, MOST_LEG, MOST_TAU, H
from ...dynamics.intervals import constant_and_slope
from ...dynamics.run_state import RunState
from ...faces.geometry import COLLAPSE, DZ, GX, GY, TOUCH
from ...numerics.piecewise_linear import PiecewiseLinear
from ...scenario.reader import with_values
from ...simulation.selection import prepare_run
from ...solvers.contract import Status
from ...solvers.integrate import solve


@dataclass(frozen=True)
class RampCycle:
    """`key` from `begin` to `end` and back (SI): after `settle` seconds at the rate `rate` (per second; None: at once),
    `hold` seconds there, back likewise, `rest` seconds.  `crossing`: a value on the way at which something is to
    happen."""

    key: str
    begin: float
    end: float
    rate: float | None
    settle: float
    hold: float = 0.0
    rest: float = 0.0
    crossing: float | None = None

    @property
    def span(self) -> float:
        """Duration (s) of one way."""
        return 0.0 if self.rate is None else abs(self.end - self.begin) / self.rate

    @property
    def top(self) -> float:
        """When (s) the end is reached."""
        return self.settle + self.span

    @property
    def back(self) -> float:
        """When (s) the way back begins."""
        return self.top + self.hold

    @property
    def home(self) -> float:
        """When (s) the begin is reached again."""
        return self.back + self.span

    @property
    def duration(self) -> float:
        """All of it (s)."""
        return self.home + self.rest

    def crossed(self) -> tuple[float, float]:
        """When (s) the crossing is met on the way there and on the way back."""
        part = self.span * (self.crossing - self.begin) / (self.end - self.begin)
        return self.settle + part, self.home - part

    def table(self) -> PiecewiseLinear:
        """The quantity over time."""
        points = [(0.0, self.begin), (self.settle, self.begin), (self.top, self.end), (self.back, self.end),
                  (self.home, self.begin), (self.duration, self.begin)]  # fmt: skip
        if self.crossing is not None:
            points += [(t, self.crossing) for t in self.crossed()]
            points.sort(key=lambda point: point[0])
        points = [p for k, p in enumerate(points) if k == 0 or p != points[k - 1]]
        return PiecewiseLinear(*(tuple(map(float, column)) for column in zip(*points, strict=True)))

    def on(self, scenario, **overrides):
        """The scenario on this trip, begun from its linear steady state.  Raises ScenarioError."""
        start = {} if scenario.run.start.endswith(".h5") else {"run.start": "steady"}
        # Few samples: what is looked at is sampled by sinks of its own.
        return with_values(
            scenario, {self.key: self.table(), "run.duration": self.duration, "run.samples": 16} | start | overrides
        )


class EvenAngleSink:
    """A sink that keeps the relative tilt and the axial gap evenly over the shaft's angle: sample k at k/`per_turn` of
    a turn.  Of a shaft at rest nothing."""

    def __init__(self, per_turn: int):
        self.per_turn, self.parts = per_turn, []

    def due(self, segment):
        leg = segment.interval
        speed, slope = constant_and_slope(segment.model.scene.shaft.speed, leg)
        step, begun = 2 * math.pi / self.per_turn, float(leg.rotor_angle)
        turned = leg.length * (speed + 0.5 * slope * leg.length)
        if turned <= 0.0:
            self.first = 0
            return np.empty(0)
        self.first = math.ceil(begun / step - 1e-9)
        count = math.floor((begun + turned) / step + (1e-9 if segment.last else -1e-9)) - self.first + 1
        ahead = np.maximum((self.first + np.arange(max(count, 0))) * step - begun, 0.0)
        # speed tau + slope tau^2 / 2 = ahead, in the form that does not cancel.
        root = np.sqrt(np.maximum(speed * speed + 2 * slope * ahead, 0.0))
        return np.clip(2 * ahead / np.maximum(speed + root, 1e-300), 0.0, leg.length)

    def take(self, segment, taus, q, q_rate, x=None):
        gap, y = np.empty((len(taus), 3)), np.zeros(segment.size)
        for i, tau in enumerate(taus):
            y[: segment.n] = q[i]
            s = segment.gap_state(tau, y)
            gap[i] = s[DZ], s[GX], s[GY]
        speed, slope = constant_and_slope(segment.model.scene.shaft.speed, segment.interval)
        turned = float(segment.interval.rotor_angle) + taus * (speed + 0.5 * slope * taus)
        number = np.rint(turned * self.per_turn / (2 * math.pi)).astype(int)
        tilt = gap[:, 1] + 1j * gap[:, 2]
        self.parts.append((number, segment.time + taus, speed + slope * taus, tilt, gap[:, 0]))

    def state(self, segment, tau, y):
        pass

    def event(self, segment, tau, event):
        pass

    def log(self, events):
        pass

    def arrays(self, before=()):
        """Number of each sample, times (s), shaft speeds (rad/s), relative tilt (rad, complex), axial gap change (m),
        each (m,); those of the sinks `before` come first."""
        parts = [part for sink in before for part in sink.parts] + self.parts
        columns = [np.concatenate([part[i] for part in parts]) for i in range(5)]
        # A collapse is shown between two samples.
        _, kept = np.unique(columns[0], return_index=True)
        return [column[kept] for column in columns]


@dataclass
class Passed:
    """A trip as it was run: run, how it ended, time reached (s), samples evenly over the angle (see
    EvenAngleSink.arrays), the free whirl as (times, relative tilt) or None, thinnest film (m) and its time (s), largest
    relative misalignment (rad) and its time, whether the faces touched."""

    state: RunState
    status: str
    message: str
    until: float
    samples: list
    free: tuple | None
    lowest: tuple[float, float]
    largest: tuple[float, float]
    touched: bool


def run_cycle(
    scenario, trip: RampCycle, per_turn: int, mode=None, disturbance: float = 0.0, twin: bool = True
) -> Passed:
    """Run a trip.  With a `mode` (ModeOverSpeed) a whirl of it of relative tilt `disturbance` (rad) is added at the
    trip's crossing, and unless `twin` is false the same run without it gives the free whirl."""
    run, plan = prepare_run(trip.on(scenario))
    method = plan.method
    accuracy = run.model.accuracy
    if mode is None:
        sink = EvenAngleSink(per_turn)
        outcome = solve(run, method, accuracy, sink)
        return told(run, outcome, sink.arrays(), None, [(run, run.extrema.records[0])])
    there, back = trip.crossed()
    first = RunState(run.model, there)
    first.y0 = run.y0.copy()
    early = EvenAngleSink(per_turn)
    before = solve(first, method, accuracy, early)
    if before.status != Status.OK:
        return told(first, before, early.arrays(), None, [(first, first.extrema.records[0])])
    leg = next(k for k, leg in enumerate(run.intervals) if abs(leg.time - there) <= 1e-12 * trip.duration)
    without = None
    if twin:
        plain, without = RunState(run.model, back), EvenAngleSink(per_turn)
        plain.restore_modes(first.modes())
        solve(plain, method, accuracy, without, resume=(leg, 0.0, before.y))
    run.restore_modes(first.modes())
    late = EvenAngleSink(per_turn)
    disturbed = before.y + modal_disturbance(run.model, mode, trip.crossing, disturbance)
    outcome = solve(run, method, accuracy, late, resume=(leg, 0.0, disturbed))
    free = _difference(late, without) if without else None
    both = [(first, first.extrema.records[0]), (run, run.extrema.records[0])]
    return told(run, outcome, late.arrays([early]), free, both)


def _difference(one: EvenAngleSink, other: EvenAngleSink):
    """Times and relative tilts that two runs over the same angles differ by."""
    if not (one.parts and other.parts):
        return None
    a, b = one.arrays(), other.arrays()
    common = np.intersect1d(a[0], b[0])
    at, to = np.searchsorted(a[0], common), np.searchsorted(b[0], common)
    same = np.abs(a[1][at] - b[1][to]) < 1e-9 * a[1][-1]
    return a[1][at][same], a[3][at][same] - b[3][to][same]


def told(run, outcome, samples, free, records) -> Passed:
    """What a trip leaves; `records` (run, record) of its parts are put together."""
    low, most = [], []
    for own, r in records:
        if math.isfinite(r[H]):
            low.append((float(r[H]), own.end_time(int(r[H_LEG]), float(r[H_TAU]))))
        if math.isfinite(r[MOST]):
            most.append((float(r[MOST]), own.end_time(int(r[MOST_LEG]), float(r[MOST_TAU]))))
    lowest, largest = min(low, default=(math.nan, 0.0)), max(most, default=(0.0, 0.0))
    level = max(run.model.face[TOUCH], run.model.face[COLLAPSE])
    until = run.end_time(outcome.segment, outcome.tau)
    touched = outcome.status == Status.COLLAPSED or lowest[0] <= level
    return Passed(run, str(outcome.status), outcome.message, until, samples, free, lowest, largest, touched)
