"""A quantity that goes from one value to another at a rate and back, and the run of a scenario over such a trip; of a
pressure, a viscosity, a spring or a misalignment what the film does, against the answer it would give if all went
infinitely slowly.

A passing of the stability threshold is followed as two runs: one that meets a small whirl of the least damped mode
where the threshold is crossed, and the same without; what they differ by is the free whirl, exactly so with a linear
film, and up to the square of the tilt over the clearance with another.
"""

import math
from dataclasses import dataclass

import numpy as np

from ...analysis.rotating_wave import modal_disturbance
from ...dynamics.extrema import H_LEG, H_TAU, MOST, MOST_LEG, MOST_TAU, H
from ...dynamics.imposed_motion import set_conditions
from ...dynamics.intervals import constant_and_slope, spins
from ...dynamics.model import Model
from ...dynamics.run_state import RunState
from ...faces.geometry import (
    COLLAPSE,
    CONING_CHANGE,
    DZ,
    FLOW_INNER,
    FLOW_OUTER,
    GAP_STATE_SIZE,
    GX,
    GY,
    INNER_PRESSURE,
    MEAN_SPIN,
    OUTER_PRESSURE,
    SPIN_DIFFERENCE,
    TOUCH,
    edge_gaps,
)
from ...numerics.piecewise_linear import PiecewiseLinear
from ...scenario.reader import with_values
from ...scene import scene as scenes
from ...simulation.margin import steady_extremes
from ...simulation.selection import prepare_run
from ...solvers.contract import Recorder, Status
from ...solvers.integrate import solve
from ..work_precision.observation import Sampler


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

    def on(self, scenario):
        """The scenario on this trip, begun from its linear steady state.  Raises ScenarioError."""
        start = {} if scenario.run.start.endswith(".h5") else {"run.start": "steady"}
        # Few samples: what is looked at is sampled by sinks of its own.
        changed = {self.key: self.table(), "run.duration": self.duration, "run.samples": 16}
        return with_values(scenario, changed | start)


class EvenAngleSink(Recorder):
    """A sink that keeps the relative tilt and the axial gap evenly over the shaft's angle: sample k at k/`per_turn` of
    a turn.  Of a shaft at rest nothing."""

    def __init__(self, per_turn: int):
        super().__init__()
        self.per_turn = per_turn

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
    """A trip as it was run: run, how it ended, samples evenly over the angle (see EvenAngleSink.arrays), the free whirl
    as (times, relative tilt) or None, thinnest film (m) and its time (s), largest relative misalignment (rad) and its
    time, whether the faces touched."""

    state: RunState
    status: str
    message: str
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
    method, accuracy = plan.method, run.model.accuracy
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

    def found(value, leg, tau):
        """Extremes and their times (s), of the parts that have one."""
        return [(float(r[value]), own.end_time(int(r[leg]), float(r[tau]))) for own, r in records
                if math.isfinite(r[value])]  # fmt: skip

    low, most = found(H, H_LEG, H_TAU), found(MOST, MOST_LEG, MOST_TAU)
    lowest, largest = min(low, default=(math.nan, 0.0)), max(most, default=(0.0, 0.0))
    level = max(run.model.face[TOUCH], run.model.face[COLLAPSE])
    touched = outcome.status == Status.COLLAPSED or lowest[0] <= level
    return Passed(run, str(outcome.status), outcome.message, samples, free, lowest, largest, touched)


# Values between both ends at which the quasi-static answer is found; samples of a stage of a trip.
VALUES, SAMPLES = 25, 150
# Of a film: a range of less is none.
FLAT = 1e-3


def quasi_static(scenario, key: str, begin: float, end: float) -> dict:
    """What the seal settles at, value by value (m,): relative misalignment (rad, largest over a period, linear about
    the aligned film there), film thickness (m) and leakage of the aligned film there (m^3/s); None where no gap
    balances the loads.
    """
    values = np.linspace(begin, end, VALUES)
    run, starts = _visited(scenario, key, values)
    rows = [_settled(run.segment(k)) for k in starts]
    names = ("relative_misalignment", "h_min", "leakage")
    return {"value": values.tolist(), **{n: [row[i] for row in rows] for i, n in enumerate(names)}}


def _visited(scenario, key, values) -> tuple[RunState, list[int]]:
    """The scene with its own tables and behind them a staircase of values of the key, and the segments that begin
    there: the closing force stays the law that the scene's start decides, as it does on a trip."""
    first = tables_end(scenes.with_values(scenario.scene, {key: float(values[0])}))
    times = [first + n for n in range(len(values))]
    points = [(0.0, values[0])] * (first > 0.0) + list(zip(times, values, strict=True))
    stairs = PiecewiseLinear(*(tuple(map(float, column)) for column in zip(*points, strict=True)))
    run = RunState(Model(scenes.with_values(scenario.scene, {key: stairs})), times[-1] + 1e-3)
    return run, [next(k for k, part in enumerate(run.intervals) if part.time >= t - 1e-6) for t in times]


def _settled(segment) -> tuple[float | None, float | None, float | None]:
    """Largest tilt, thinnest film and leakage at the loads of a segment's start."""
    model, interval = segment.model, segment.interval
    if not model.loads_are_balanced(interval):
        return None, None, None
    shift, linear = model.axial_shift(interval), model.linear_scene(interval)
    harmonics = segment.harmonics()
    most, _, closing = steady_extremes(linear, linear.answers(harmonics), _period(harmonics))
    source, f = model.observed
    s = np.zeros(GAP_STATE_SIZE)
    s[DZ] = shift
    set_conditions(s, model.scene, lambda quantity: constant_and_slope(quantity, interval)[0])
    s[MEAN_SPIN], s[SPIN_DIFFERENCE] = spins(model.scene, interval)
    source.flow(f, s, *([model.interface.steady(f, s)] if model.interface.unknowns is not None else []))
    leakage = -s[FLOW_INNER] if s[OUTER_PRESSURE] >= s[INNER_PRESSURE] else s[FLOW_OUTER]
    return float(most), float(min(edge_gaps(model.face, shift - closing, most, s[CONING_CHANGE]))), float(leakage)


def _period(harmonics) -> float | None:
    """Period (s) of harmonics that turn at one frequency."""
    turning = {abs(h.frequency) for h in harmonics if h.frequency}
    return 2 * math.pi / turning.pop() if len(turning) == 1 else None


def memory(scenario, key: str, begin: float, end: float) -> tuple[float, float, float]:
    """Growth rate (1/s) of the slowest disturbance of the scene linearised where it begins and where it ends; the time
    (s) it takes to decay, at most 25 turns; and how long to wait until it settles: eight of these, at least ten turns,
    at most two hundred."""
    run, starts = _visited(scenario, key, [begin, end, end])
    slowest = max(
        (v.real for k in starts[:2] for v in run.model.linear_scene(run.intervals[k]).eigen()[0]), default=-1e6
    )
    speed = abs(run.model.speed_at(run.intervals[starts[0]]))
    turn = 2 * math.pi / speed if speed else 1e-3
    decay = min(-1.0 / slowest, 25 * turn) if slowest < 0 else 25 * turn
    return float(slowest), decay, float(np.clip(8.0 * decay, 10 * turn, 200 * turn))


class GivenTimesSink(Sampler):
    """A sampler at given times (s)."""

    def __init__(self, times):
        super().__init__(1.0)
        self.times = times

    def due(self, segment):
        taus, length = self.times - segment.time, segment.length
        inside = (taus < length * (1 - 1e-12)) | (segment.last & (taus <= length * (1 + 1e-12)))
        return np.clip(taus[(taus >= 0) & inside], 0, length)


def instants(trip: RampCycle) -> np.ndarray:
    """When to look: along the ramps, and after them ever less often."""
    later = np.linspace(0.0, 1.0, SAMPLES) ** 2
    # Just before either change too.
    early = [trip.settle * (1 - 1e-9), trip.back * (1 - 1e-9)]
    ramps = [np.linspace(a, b, SAMPLES) for a, b in ((trip.settle, trip.top), (trip.back, trip.home))]
    parts = [early, *ramps, trip.top + later * trip.hold, trip.home + later * trip.rest]
    return np.unique(np.concatenate(parts))


def load_trip(scenario, point: dict) -> dict:
    """A ramp (or with `rate` None a step) there and back: extremes, what it settles at, and the series."""
    trip = RampCycle(**point)
    run, plan = prepare_run(trip.on(scenario))
    sink = GivenTimesSink(instants(trip))
    outcome = solve(run, plan.method, run.model.accuracy, sink)
    times, film, tilt, leakage = (np.concatenate([p[i] for p in sink.parts]) for i in range(4))
    passed = told(run, outcome, [np.zeros(1)] * 5, None, [(run, run.extrema.records[0])])
    table = trip.table()
    return {
        "rate": trip.rate,
        "stages": [trip.settle, trip.top, trip.back, trip.home],
        "status": passed.status,
        "message": passed.message,
        "touched": bool(passed.touched),
        "h_min": passed.lowest[0] if math.isfinite(passed.lowest[0]) else None,
        "h_min_time": passed.lowest[1],
        "relative_misalignment": passed.largest[0],
        "settled": {
            "end": _over(times, film, tilt, leakage, trip.back - 0.1 * trip.hold, trip.back),
            "begin": _over(times, film, tilt, leakage, trip.duration - 0.1 * trip.rest, trip.duration),
        },
        "leakage": float(np.max(leakage)),
        "leakage_least": float(np.min(leakage)),
        "time": [float(f"{t:.8g}") for t in times],
        "value": [float(f"{table.at(t):.6g}") for t in times],
        "film": [float(f"{v:.5g}") for v in film],
        "tilt": [float(f"{v:.5g}") for v in tilt],
        "flow": [float(f"{v:.5g}") for v in leakage],
    }


def _over(times, film, tilt, leakage, begin, end) -> dict | None:
    """Thinnest film, largest tilt and mean leakage over a stretch of time; None if the run did not get there."""
    # Not the end itself: there a step has already been taken.
    kept = (times >= begin) & (times < end * (1 - 5e-10))
    if not kept.any() or times[-1] < end * (1 - 1e-6):
        return None
    return {"h_min": float(film[kept].min()), "relative_misalignment": float(tilt[kept].max()),
            "leakage": float(leakage[kept].mean())}  # fmt: skip


def overshoot(row: dict, slow: dict) -> dict:
    """How far the trip went beyond the range of the quasi-static answer, as a share of that range; None without one."""
    if None in slow["h_min"]:
        return dict.fromkeys(("h_min", "relative_misalignment", "leakage"))
    low, high = min(slow["h_min"]), max(slow["h_min"])
    tilt = max(slow["relative_misalignment"])
    flow_low, flow_high = min(slow["leakage"]), max(slow["leakage"])
    # A film that hardly changes has no range to go beyond.
    film = (low - row["h_min"]) / (high - low) if row["h_min"] is not None and high - low > FLAT * high else None
    flow = max(row["leakage"] - flow_high, flow_low - row["leakage_least"])
    return {
        "h_min": film,
        "relative_misalignment": row["relative_misalignment"] / tilt - 1 if tilt else None,
        "leakage": flow / (flow_high - flow_low) if flow_high - flow_low > 1e-9 * abs(flow_high) else None,
    }


def tables_end(scene) -> float:
    """When (s) the scene's own tables have ended: then the ramp begins."""
    tables = [v for owner in (scene.shaft, scene.film, scene.rotor, scene.stator, scene.closing)
              for v in vars(owner).values() if isinstance(v, PiecewiseLinear)]  # fmt: skip
    return max((table.time[-1] for table in tables), default=0.0)
