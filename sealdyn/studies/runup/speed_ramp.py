"""A ramp of shaft speed and back, run and looked at: tracked order, waterfall, growth of the whirl, what touches."""

import math
from dataclasses import replace

import numpy as np
from scipy.optimize import brentq, minimize_scalar

from ...analysis.poincare_map import frozen_at_end
from ...analysis.rotating_wave import free_model, tilt_mode
from ...dynamics.model import Model
from ...dynamics.run_state import Concern
from ...faces.geometry import COLLAPSE, TOUCH, smallest_gap
from ...numerics.time_series import centres, peak, resolution, tracked, waterfall
from ...scene.excitation import Housing
from .ramp_run import RampCycle, run_cycle

# A whirl is small below this share of clearance/outer radius: the square of it is lost in the growth.
SMALL = 0.02
# Points of a tracked curve, of a growth curve, and of a waterfall each way; orders kept of it; decimals of amplitudes.
CURVE, GROWTH, FALL, LOW, HIGH = 200, 160, 48, -1.5, 2.5
# Below the threshold from where a short pass begins, as a share of it.
BELOW = 0.9
WINDOWS = (6, 32)


def touch_tilt(model) -> float:
    """Relative tilt (rad) at which the faces touch, or the film is at its floor, without axial opening; 0 if they touch
    aligned."""
    face, change = model.face, model.coning_change()
    level = max(face[TOUCH], face[COLLAPSE])
    if smallest_gap(face, 0.0, 0.0, change)[0] <= level:
        return 0.0
    # Where the aligned faces are nearest, this tilt closes them at any radius.
    beyond = smallest_gap(face, 0.0, 0.0, change)[0] / face[0]
    return float(brentq(lambda tilt: smallest_gap(face, 0.0, tilt, change)[0] - level, 0.0, beyond))


class Steady:
    """Linear steady state of a scene over the shaft speed: one order of the relative tilt (or of the axial gap)."""

    def __init__(self, scene):
        # Neither what shakes the housing nor what pulls at the rings goes with the speed.
        rings = {name: replace(ring, load=None) for name, ring in scene.rings.items()}
        scene = replace(frozen_at_end(scene), housing=Housing(), **rings)
        self.speed = 1.0
        self.model = Model(replace(scene, shaft=replace(scene.shaft, speed=self.speed)))
        self.tilting = self.model.unknowns.with_tilt
        # At a speed of one the frequency of what turns with the shaft is its order.
        own = [h for h in self.model.segment().harmonics() if h.ring == 1 or h.frequency == 0.0]
        self.orders = {}
        for h in own:
            self.orders.setdefault(round(h.frequency, 9), []).append(h)

    def main(self) -> float:
        """The order to follow: 1 where something turns with the shaft, else the first there is."""
        return 1.0 if 1.0 in self.orders or not self.orders else next(iter(self.orders))

    def at(self, speed: float, order: float) -> complex:
        """Complex amplitude of the order at a speed (rad/s): relative tilt of exp(i order angle), or axial gap."""
        linear, total = self.model.linear_scene(speed=speed), 0j
        for h in self.orders.get(order, []):
            # Unbalance pulls with the square of the speed.
            moment = h.moment if h.moment is None or not order else speed**2 * h.moment
            turning = replace(h, frequency=order * speed, moment=moment)
            z, x, y = linear.relative(turning, linear.response(turning))
            # What does not turn stands: its real part alone.
            own = 0.5 * (x + 1j * y) if order else x.real + 1j * y.real
            total += own if self.tilting else z
        return complex(total)

    def curve(self, speeds, order: float) -> np.ndarray:
        """Complex amplitudes (m,) at speeds (m,)."""
        return np.array([self.at(float(w), order) for w in speeds])

    def peak(self, low: float, high: float, order: float) -> tuple[float, float] | None:
        """Speed and height of the largest amplitude strictly inside [low, high]."""
        speeds = np.linspace(low, high, 201)
        k = int(np.argmax(np.abs(self.curve(speeds, order))))
        if k in (0, 200):
            return None
        found = minimize_scalar(lambda w: -abs(self.at(w, order)), bounds=(speeds[k - 1], speeds[k + 1]),
                                method="bounded", options={"xatol": 1e-6 * high})  # fmt: skip
        return float(found.x), float(-found.fun)


def followed_mode(scene, low: float, high: float, crossing: float | None):
    """The whirl mode that loses its damping at `crossing`, over the speeds of a trip; None without."""
    if crossing is None:
        return None
    free = free_model(frozen_at_end(scene), crossing)
    return tilt_mode(free, min(low, BELOW * crossing), high, crossing)


def predicted_growth(mode, trip: RampCycle, times):
    """Logarithm of the growth since the crossing at `times` (m,) of a trip: integral of the growth rate over time, and
    the part that depends on speed alone."""
    times, w = np.asarray(times), trip.crossing
    speed = np.interp(times, *_speeds(trip))
    up = mode.between(w, np.where(times < trip.top, speed, trip.end)) / trip.rate
    held = mode.growth(trip.end) * (np.clip(times, trip.top, trip.back) - trip.top)
    down = np.where(times > trip.back, mode.between(speed, trip.end), 0.0) / trip.rate
    return up + held + down, mode.gained(w, speed)


def measured_growth(mode, trip: RampCycle, free, tilt_scale: float) -> dict:
    """Growth of the free whirl against what is foretold, while it is small; and both over time."""
    times, tilt = free
    size = np.log(np.abs(tilt))
    large = np.abs(tilt) > SMALL * tilt_scale
    upto = len(times) if not large.any() else max(int(np.argmax(large)), 1)
    integral, factor = predicted_growth(mode, trip, times)
    k = int(np.argmax(size[:upto]))
    measured, said, gained = float(size[k] - size[0]), float(integral[k] - integral[0]), float(factor[k] - factor[0])
    few = np.unique(np.linspace(0, len(times) - 1, GROWTH).astype(int))
    largest = float(np.max(mode.between(trip.crossing, trip.end)) * 2 / trip.rate + mode.growth(trip.end) * trip.hold)
    return {
        "measured": measured,
        "integral": said,
        "with_factor": said + gained,
        "error": measured / said - 1 if said else None,
        "error_with_factor": measured / (said + gained) - 1 if said + gained else None,
        "until": float(times[k]),
        "speed": float(np.interp(times[k], *_speeds(trip))),
        "whole": largest,
        "from": float(np.abs(tilt[0])),
        "left_small": bool(large.any()),
        "curve": {
            "time": _rounded(times[few] - times[0], 6),
            "measured": _rounded(size[few] - size[0], 6),
            "foretold": _rounded(integral[few] + factor[few] - integral[0] - factor[0], 6),
        },
    }


def _speeds(trip: RampCycle):
    """Times (s) at which the rate changes, and the speeds (rad/s) then."""
    return [trip.settle, trip.top, trip.back, trip.home], [trip.begin, trip.end, trip.end, trip.begin]


def _rounded(values, digits: int = 5) -> list[float]:
    return [float(f"{v:.{digits}g}") for v in values]


def trip_of(point: dict) -> RampCycle:
    """The trip of a point: the whole one, or with `short` only around the crossing."""
    begin, rate = point["begin"], point["rate"]
    settle, crossing = point["settle"], point["crossing"]
    if point.get("short"):
        begin = max(begin, BELOW * crossing)
    # Past its way back the shaft turns on a little: a last sample behind the ramp.
    return RampCycle("shaft.speed", begin, point["end"], rate, settle, point["hold"], 0.5 * settle, crossing)


def short_pass(scenario, point: dict) -> dict:
    """Only past the threshold and back at one rate: what the whirl comes to."""
    trip = trip_of({**point, "short": True})
    mode = followed_mode(scenario.scene, trip.begin, trip.end, trip.crossing)
    run = run_cycle(scenario, trip, point["per_turn"], mode, point["disturbance"], twin=False)
    return {"rate": trip.rate, **extremes(run)}


def extremes(run) -> dict:
    """Status, extremes, and the shaft speeds at which they were met."""
    _, times, speeds, *_ = run.samples
    (low, low_at), (most, most_at) = run.lowest, run.largest

    def speed(t):
        return float(np.interp(t, times, speeds)) if len(times) else None

    return {
        "status": run.status,
        "message": run.message,
        "touched": bool(run.touched),
        "h_min": low if math.isfinite(low) else None,
        "h_min_time": low_at,
        "h_min_speed": speed(low_at),
        "relative_misalignment": most,
        "relative_misalignment_speed": speed(most_at),
    }


def passage(scenario, point: dict) -> dict:
    """A ramp to the end and back at one rate: the order tracked both ways, waterfall, growth, extremes."""
    trip, steady = trip_of(point), Steady(scenario.scene)
    mode = followed_mode(scenario.scene, trip.begin, trip.end, trip.crossing)
    run = run_cycle(scenario, trip, point["per_turn"], mode, point["disturbance"])
    row = {"rate": trip.rate, **extremes(run), **_followed(run, trip, steady, point)}
    row["warnings"] = [c.sentence for c in run.state.cautions if c.concern != Concern.ALIASING]
    row["h_min_way"] = "up" if row["h_min_time"] < 0.5 * (trip.top + trip.back) else "down"
    scale = run.state.model.clearance / run.state.model.face[1]
    row["growth"] = (
        measured_growth(mode, trip, run.free, scale) if run.free is not None and len(run.free[0]) > 2 else None
    )
    row["time_above"] = trip.crossed()[1] - trip.crossed()[0] if trip.crossing else None
    return row


def _followed(run, trip, steady, point) -> dict:
    """Tracked order both ways and the waterfall, with the windows they rest on."""
    number, times, speed, tilt, axial = run.samples
    signal, per_turn, order = tilt if steady.tilting else axial, point["per_turn"], point["order"]
    ways = {"up": (trip.settle, trip.top), "down": (trip.back, trip.home)}
    way_turns = {w: (np.searchsorted(times, a), np.searchsorted(times, b)) for w, (a, b) in ways.items()}
    turns = (way_turns["up"][1] - way_turns["up"][0]) / per_turn
    window = point["window"] or int(np.clip(turns / 25, *WINDOWS))
    out = {"turns": turns, "window": window, "resolution": resolution(window), "folding": 0.0, "waterfall": {}}
    out["speed_in_window"] = trip.rate * window * 2 * math.pi / (0.5 * (trip.begin + trip.end))
    linear_peak = steady.peak(trip.begin, trip.end, order)
    still = 1e-9 * (run.state.model.clearance / (run.state.model.face[1] if steady.tilting else 1.0))
    highest = max((abs(c) for c in steady.curve(np.linspace(trip.begin, trip.end, 61), order)), default=0.0)
    for way, (first, last) in way_turns.items():
        at = centres(first, last, window * per_turn, speed, CURVE)
        middle = at + window * per_turn // 2
        found = tracked(signal, number, per_turn, window, order, at)
        out[way] = {"speed": _rounded(speed[middle]), "amplitude": _rounded(np.abs(found)),
                    "phase": _rounded(np.angle(found))}  # fmt: skip
        out[way]["peak"] = _peak(speed[middle], np.abs(found), linear_peak, trip.crossing)
        out[way]["departure"] = _departure(found, speed[middle], steady, order, highest, trip.crossing)
        at = centres(first, last, window * per_turn, speed, FALL)
        rows, orders, share = waterfall(signal, per_turn, window, at, LOW, HIGH, still)
        out["waterfall"][way] = {"speed": _rounded(speed[at + window * per_turn // 2]), "orders": _rounded(orders),
                                 "amplitude": [_rounded(r, 3) for r in rows]}  # fmt: skip
        out["folding"] = max(out["folding"], share)
    return out


def _peak(speed, amplitude, linear_peak, crossing):
    """Peak of a tracked order where linear theory has one; None on a way that ended before it.  Where the whirl grows
    it may drown the order."""
    if not linear_peak or not len(speed) or not speed.min() < linear_peak[0] < speed.max():
        return None
    kept = speed < crossing if crossing and linear_peak[0] < crossing else np.ones(len(speed), bool)
    return peak(speed[kept], amplitude[kept])


def _departure(found, speed, steady, order, highest, crossing) -> float | None:
    """Largest distance from linear steady theory below the threshold, over the largest amplitude in the range."""
    kept = speed < 0.95 * crossing if crossing else np.ones(len(speed), bool)
    if not (kept.any() and highest):
        return None
    return float(np.max(np.abs(found[kept] - steady.curve(speed[kept], order))) / highest)
