"""Whirl of the unforced seal in the time domain: growth of a small one, fate of a large one, what tips it, and where it
settles above its threshold, contact included: limit cycle, rub, collapse."""

import math
from itertools import pairwise

import numpy as np

from ..dynamics.model import Model
from ..dynamics.run_state import RunState
from ..scene.scene import Scene
from ..simulation.selection import choose_method
from ..solvers.contract import Enough, Recorder, attainable
from ..solvers.integrate import solve
from ..status import Status
from .poincare_map import PIECE, PeriodMap
from .rotating_wave import RotatingWave, contact_tilt_aligned, free_model, least_damped

# Amplitude of a small disturbance over the tilt of contact: its square is lost in the growth rate.
SMALL = 3e-4
PER_TURN = 8
TIGHTER = 1 / 30
# Nearest runs that a bisection tells apart, over the disturbance; turns that it may take them to part.
NEAREST, PATIENCE = 1e-6, 2000
# Blocks of a few hundred steps that one run may take: a hundred times what a healthy one does.
MOST_BLOCKS = 2000
# How many times what a run may last its whirl may take to go anywhere, in a stiff scene, where a run takes a minute;
# and the fate of a whirl that takes longer.
SHOWS, TOO_SLOW = 10, "too slow"
# Where a whirl that settles starts, as a share of the tilt of contact; amplitudes that change less from piece to piece
# have settled.
START, STEADY = 0.02, 1e-3
# Accuracy of runs of which the fate is asked alone, and turns after which each is left: of a bisection, of a whirl
# that may stay, and of one that may rub.
FATE, TIPS, STAYS, RUBS = 1e-7, 4000, 8000, 3000


class TooLong(ValueError):
    """A whirl takes more steps than it may: the film is too stiff for the method at this speed."""


class Until(Recorder):
    """Records displacements every `interval` (s), and ends the run once the relative tilt falls below `least` (rad)."""

    def __init__(self, wave, interval, least=0.0):
        super().__init__(interval)
        self.wave, self.least, self.left = wave, least, MOST_BLOCKS

    def state(self, segment, tau, y):
        """Raises Enough where the tilt of the unknowns `y` (size,) is below the least, and TooLong."""
        self.left -= 1
        if self.left < 0:
            raise TooLong(f"too many steps: given up {tau:.3g} s into a run of {segment.length:.3g} s")
        if abs(self.wave.relative(y[: self.wave.n])) < self.least:
            raise Enough


def pace(model: Model, speed: float) -> float:
    """What turns are counted of (rad/s): the shaft at its speed (rad/s), or the least damped whirl where that turns
    faster, as on a slow shaft in a stator that runs the other way."""
    return max(abs(speed), abs(least_damped(model, speed)[0]))


def tilt_in_time(
    scene: Scene, speed: float, turns: float, method: str, accuracy: float, start, least: float = 0.0, interval=math.inf
) -> tuple:
    """Relative tilt in time over `turns` (as `pace` counts them) at a shaft speed (rad/s), from a start `(q (n,),
    frequency (rad/s))`, or the least damped mode at relative tilt `start` (rad); ends when it falls below `least`
    (rad), kept at least every `interval` (s).
    Returns (outcome, times (m,) (s), relative tilt (m,) (rad, complex), run)."""
    model = free_model(scene, speed, accuracy)
    turn = 2 * math.pi / pace(model, speed)
    run = RunState(model, turns * turn)
    wave = RotatingWave(model)
    if isinstance(start, float):
        frequency, shape = least_damped(model, speed)
        start = (start * shape, frequency)
    run.y0 = wave.state(*start)
    sink = Until(wave, min(turn / PER_TURN, interval), least)
    outcome = solve(run, method, accuracy, sink)
    t, q, _ = sink.arrays()
    return outcome, t, wave.relative(q.T), run


def _method(model) -> str:
    """Of runs of which the fate is asked, not a rate: film and springs may be stiff."""
    return choose_method(RunState(model, 1.0))[0]


def fit_growth(t: np.ndarray, tilt: np.ndarray) -> tuple[float, float]:
    """Growth rate (1/s) of |tilt| (m,) over the last three quarters of the times `t` (m,) (s), and how far its two
    halves differ from it."""
    late = t > 0.25 * t[-1]
    t, size = t[late], np.log(np.abs(tilt[late]))
    half = len(t) // 2
    parts = (slice(None), slice(half), slice(half, None))
    whole, first, second = (float(np.polyfit(t[part], size[part], 1)[0]) for part in parts)
    return whole, max(abs(first - whole), abs(second - whole))


def linear_growth(model: Model) -> float:
    """Growth rate (1/s) of the least damped tilt mode, by eigenvalues."""
    return float(max(mode.value.real for mode in model.linear_scene().modes() if mode.kind == "tilt"))


def growth_rate(scene: Scene, speed: float, turns: int, method: str, accuracy: float) -> dict:
    """Growth rate (1/s) of a small whirl at a speed (rad/s), the accuracy tightened until its uncertainty is a tenth of
    it or the method can do no better.

    `rate`; `numerical_damping` (1/s) bounds the method's own share: the change on tightening by thirty, or what the
    asked accuracy lets pass, whichever is more; `uncertainty` (1/s) adds the fit's spread; `decided` whether the rate
    is three times that; `eigenvalue` (1/s) the linear rate, for comparison only; `accuracy` reached.
    """
    model = free_model(scene, speed)
    linear = linear_growth(model)
    start = SMALL * contact_tilt_aligned(model)
    # Some forty samples of a disturbance that dies within a turn.
    interval = 0.2 / max(abs(linear), 1e-300)

    def rate_at(accuracy):
        _, t, tilt, run = tilt_in_time(scene, speed, turns, method, accuracy, start, 1e-4 * start, interval)
        # A disturbance that sinks into the tolerance, or is no longer small, says nothing more.
        fit = (np.abs(tilt) > 1e-3 * start) & (np.abs(tilt) < 10 * start)
        upto = len(t) if fit.all() else max(int(np.argmin(fit)), 16)
        t, tilt = t[:upto], tilt[:upto]
        scale = run.model.clearance / run.model.face[1]
        allowed = accuracy * scale / np.min(np.abs(tilt)) / (0.75 * t[-1])
        return *fit_growth(t, tilt), allowed, attainable(method, run.memory)

    rate, *_ = rate_at(accuracy)
    while True:
        finer, spread, allowed, best = rate_at(accuracy * TIGHTER)
        # What tightening changed, or what the asked accuracy would let pass, whichever is more.
        own = float(max(abs(finer - rate), allowed))
        if own + spread < 0.1 * abs(finer) or accuracy * TIGHTER**2 < best:
            break
        rate, accuracy = finer, accuracy * TIGHTER
    uncertainty = own + spread
    return {
        "rate": finer,
        "uncertainty": uncertainty,
        "numerical_damping": own,
        "decided": bool(abs(finer) > 3 * uncertainty),
        "eigenvalue": linear,
        "accuracy": accuracy * TIGHTER,
    }


def tipping_disturbance(scene: Scene, speed: float, parting: float) -> dict:
    """Smallest circular whirl in the shape of the least damped mode (gap not opened) that grows to contact, by
    bisection between decay and contact; and the whirl both last runs linger at before they part.  `speed` in rad/s,
    `parting` the growth rate (1/s) with which runs leave that whirl.

    `disturbance`, `whirl`: relative tilts (rad); `frequency` of that whirl (rad/s); `apart` its uncertainty (rad).
    Where none or any tips it, or runs part too slowly to be told apart, both are None, and `said` tells which.
    """
    model = free_model(scene, speed)
    turns = math.log(1.0 / NEAREST) / max(parting, 1e-300) * pace(model, speed) / (2 * math.pi)
    if turns > PATIENCE:
        said = f"not bisected in time: runs leave the whirl with {parting:.2g} 1/s, and part after {turns:.2g} turns"
        return {"disturbance": None, "whirl": None, "said": said, "turns": turns}
    unit, method = contact_tilt_aligned(model), _method(model)
    low, high, runs = 0.0, 0.985 * unit, {}

    def tips(amplitude):
        outcome, t, tilt, _ = tilt_in_time(scene, speed, TIPS, method, FATE, amplitude, 0.3 * amplitude)
        runs[amplitude] = (t, tilt)
        return outcome.status == Status.COLLAPSED

    if not tips(high):
        return {"disturbance": None, "whirl": None, "said": "no whirl short of contact tips it"}
    while high - low > NEAREST * high:
        middle = 0.5 * (low + high)
        low, high = (low, middle) if tips(middle) else (middle, high)
        runs = {a: run for a, run in runs.items() if a in (low, high)}
    if low == 0.0:
        return {"disturbance": None, "whirl": None, "said": "any whirl tips it"}
    t, a = runs[low]
    b = runs[high][1][: len(a)]
    t, a = t[: len(b)], a[: len(b)]
    apart = np.abs(np.abs(a) - np.abs(b))
    # The runs stay together until they leave the whirl for good, one way each.
    last = int(np.argmax(apart > 1e-4 * unit)) - 1
    window = slice(max(0, last - 4 * PER_TURN), last + 1)
    frequency = float(np.polyfit(t[window], np.unwrap(np.angle(a[window])), 1)[0])
    whirl = 0.5 * float(abs(a[last]) + abs(b[last]))
    return {"disturbance": 0.5 * (low + high), "whirl": whirl, "frequency": frequency, "apart": float(apart[last])}


def bounded_or_not(scene: Scene, speed: float, start: str, shape, frequency) -> dict:
    """What becomes of a whirl at a speed (rad/s): `fate` "decays", "bounded" (with its amplitude `whirl` and `drift`,
    rad), "grows" or "contact"; the relative tilt `from` (rad) which it starts, and `turns` run (as `pace` counts them).
    TOO_SLOW: not run, as a small one with its growth `rate` (1/s) goes nowhere in these `turns`, which is `said`.

    `start` "small" (a tenth of contact) or "large" (displacements `shape` (n,), turning at `frequency`, rad/s).
    """
    model = free_model(scene, speed)
    unit, linear = contact_tilt_aligned(model), linear_growth(model)
    frequency_of_turns = pace(model, speed) / (2 * math.pi)
    method, whole = _method(model), int(9 / abs(linear) * frequency_of_turns) + 50
    if method != "adams" and whole > SHOWS * STAYS:
        said = f"a whirl that grows or decays by {abs(linear):.2g} 1/s takes {whole:.2g} turns to go anywhere"
        return {"fate": TOO_SLOW, "from": None, "whirl": None, "turns": float(whole), "rate": linear, "said": said}
    turns = min(STAYS, whole)
    begin = 0.1 * unit if start == "small" else (np.array(shape), frequency)
    least = 0.03 * unit
    outcome, t, tilt, _ = tilt_in_time(scene, speed, turns, method, FATE, begin, least)
    size = np.abs(tilt)
    row = {"from": float(size[0]), "whirl": None, "turns": float(t[-1] * frequency_of_turns)}
    if outcome.status == Status.COLLAPSED:
        return {"fate": "contact", **row}
    if outcome.status == Status.INTERRUPTED:
        return {"fate": "decays", **row}
    late = size[t > 0.9 * t[-1]]
    if np.ptp(late) < 1e-3 * late[-1]:
        return {"fate": "bounded", **row, "whirl": float(late[-1]), "drift": float(np.ptp(late))}
    return {"fate": "decays" if late[-1] < late[0] else "grows", **row}


def whirl_fate(scene: Scene, speed: float, accuracy: float = 1e-6) -> dict:
    """Fate of a small whirl at a shaft speed (rad/s): "decays", "limit cycle" (no touch), "rub", "collapse", "failed",
    or "unsettled" after RUBS turns.

    Returns `speed`, `fate` (`message` if the run ended early), `from` (rad) it starts, `first_contact` and `turns`
    (turns of the shaft), `amplitudes` (largest relative tilt of each turn, rad), and over the last turns `amplitude`
    (least and largest relative tilt, rad), `whirl_ratio`, `contact_share` of the time, `contact_force` over the closing
    force, `contact_power` and `friction_power` (W), `h_min` (m).
    """
    model = free_model(scene, speed)
    unit, wave = contact_tilt_aligned(model), RotatingWave(model)
    frequency, shape = least_damped(model, speed)
    period_map = PeriodMap(model.scene, accuracy)
    x = wave.state(START * unit * shape, frequency)[: period_map.size]
    row = {"speed": float(speed), "fate": "unsettled", "first_contact": None, "from": START * unit}
    done, before, sizes = 0, None, []
    while done < RUBS:
        turns = period_map.run(x, PIECE)
        x, size = turns.last, np.abs(turns.tilt)
        if len(size):
            sizes += np.max(size, axis=1).tolist()
        touched = np.flatnonzero(turns.touching > 0)
        if row["first_contact"] is None and len(touched):
            row["first_contact"] = int(done + touched[0])
        done += len(turns.section)
        if turns.status != Status.OK:
            row["fate"], row["message"] = (
                "collapse" if turns.status == Status.COLLAPSED else turns.status,
                turns.message,
            )
            break
        # The late half of a piece, so that one piece can settle.
        late = size[len(size) // 2 :]
        now = np.array([late.min(), late.max(), late.mean()])
        if now[1] < 0.2 * START * unit:
            row["fate"] = "decays"
            break
        if before is not None and np.all(np.abs(now - before) < STEADY * now[1]):
            row["fate"] = "rub" if turns.touching[-PIECE // 2 :].any() else "limit cycle"
            break
        before = now
    # A chaotic or modulated rub never repeats: it has settled if it neither left nor died.
    if row["fate"] == "unsettled" and turns.touching.any():
        row["fate"] = "rub"
    return row | {"turns": done, "amplitudes": sizes} | _late(turns, period_map, speed)


def _late(turns, period_map, speed) -> dict:
    """Averages over the late half of the last piece."""
    half = slice(len(turns.section) // 2, None)
    tilt = turns.tilt[half].ravel()
    if len(tilt) < 4:
        return {}
    angle = np.unwrap(np.angle(tilt))
    per_sample = np.polyfit(np.arange(len(angle)), angle, 1)[0] * turns.tilt.shape[1] / (2 * math.pi)
    return {
        "amplitude": [float(np.abs(tilt).min()), float(np.abs(tilt).max())],
        "whirl_ratio": float(per_sample / period_map.turns_per_period * np.sign(speed)),
        "contact_share": float(turns.touching[half].mean()),
        "contact_force": float(turns.contact_force[half].mean() / period_map.model.closing_force()),
        "contact_power": float(turns.contact_power[half].mean()),
        "friction_power": float(turns.friction_power[half].mean()),
        "h_min": float(turns.lowest[half].min()),
    }


def between(rows, speeds):
    """The neighbouring ((speed, row), (speed, row)) between which decay turns into growth, both decided; or None."""
    good = [(w, row) for w, row in zip(speeds, rows, strict=True) if "failed" not in row and row["decided"]]
    for a, b in pairwise(good):
        if a[1]["rate"] < 0 < b[1]["rate"]:
            return a, b
    return None


def line_crossing(a, b) -> tuple[float, float]:
    """Speed (rad/s) where the line between two rates crosses zero, and its uncertainty: theirs over the slope."""
    (low, p), (high, q) = a, b
    slope = (q["rate"] - p["rate"]) / (high - low)
    return float(low - p["rate"] / slope), float(max(p["uncertainty"], q["uncertainty"]) / slope)
