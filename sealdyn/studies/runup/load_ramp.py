"""A ramp or a step of a pressure, a viscosity, a spring or a misalignment and back: what the film does, against the
answer it would give if everything went infinitely slowly."""

import math
from dataclasses import replace

import numpy as np

from ...dynamics.imposed_motion import set_conditions
from ...dynamics.intervals import constant_and_slope, spins
from ...dynamics.model import Model
from ...dynamics.modes import steady_extremes
from ...dynamics.run_state import RunState
from ...faces.geometry import (
    CONING_CHANGE,
    DZ,
    FLOW_INNER,
    FLOW_OUTER,
    GAP_STATE_SIZE,
    INNER_PRESSURE,
    MEAN_SPIN,
    OUTER_PRESSURE,
    SPIN_DIFFERENCE,
    edge_gaps,
)
from ...numerics.piecewise_linear import PiecewiseLinear
from ...scene.variants import with_values
from ...simulation.selection import prepare_run
from ...solvers.integrate import solve
from ..work_precision.observation import Sampler
from .plan import tables_end
from .ramp_run import RampCycle, told

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
    there:
    the closing force stays the law that the scene's start decides, as it does on a trip."""
    first = tables_end(with_values(scenario.scene, {key: float(values[0])}))
    times = [first + n for n in range(len(values))]
    points = [(0.0, values[0])] * (first > 0.0) + list(zip(times, values, strict=True))
    stairs = PiecewiseLinear(*(tuple(map(float, column)) for column in zip(*points, strict=True)))
    run = RunState(Model(with_values(scenario.scene, {key: stairs})), times[-1] + 1e-3)
    return run, [next(k for k, part in enumerate(run.intervals) if part.time >= t - 1e-6) for t in times]


def _settled(segment) -> tuple[float | None, float | None, float | None]:
    """Largest tilt, thinnest film and leakage at the loads of a segment's start."""
    model, interval = segment.model, segment.interval
    if not model.loads_are_balanced(interval):
        return None, None, None
    shift, linear = model.axial_shift(interval), model.linear_scene(interval)
    harmonics = [replace(h) for h in segment.harmonics()]
    period = _period(harmonics)
    most, _, closing = steady_extremes(linear, [(h, linear.response(h)) for h in harmonics], period)
    source, f = model.observed
    s = np.zeros(GAP_STATE_SIZE)
    s[DZ] = shift
    set_conditions(s, model.scene, lambda quantity: constant_and_slope(quantity, interval)[0])
    s[MEAN_SPIN], s[SPIN_DIFFERENCE] = spins(model.scene, interval)
    source.flow(f, s, *([model.interface.steady(f, s)] if model.interface.unknowns is not None else []))
    leakage = -s[FLOW_INNER] if s[OUTER_PRESSURE] >= s[INNER_PRESSURE] else s[FLOW_OUTER]
    return float(most), float(min(edge_gaps(model.face, shift - closing, most, s[CONING_CHANGE]))), float(leakage)


def _period(harmonics):
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
    names = ("key", "begin", "end", "rate", "settle", "hold", "rest")
    trip = RampCycle(**{n: point[n] for n in names})
    run, plan = prepare_run(trip.on(scenario))
    method = plan.method
    sink = GivenTimesSink(instants(trip))
    outcome = solve(run, method, run.model.accuracy, sink)
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
