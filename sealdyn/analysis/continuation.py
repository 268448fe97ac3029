"""A rubbing seal followed over a key: each point from the last one's end, and what its motion is like there."""

import math

import numpy as np

from ..dynamics.interface import Interface
from ..dynamics.model import Model
from ..dynamics.run_state import RunState
from ..dynamics.warm_state import at_work
from ..numerics import time_series
from ..numerics.piecewise_linear import PiecewiseLinear
from ..numerics.time_series import two_trajectories
from ..scene.scene import Closing
from ..scene.variants import part, tables_at_end, with_values
from ..solvers.contract import Cause, Recorder, Status
from ..solvers.integrate import solve
from .poincare_map import SAMPLES, PeriodMap

# What is ramped to its new value in time; anything else changes between two turns.
RAMPED = ("rotor.runout", "rotor.misalignment", "stator.misalignment", "shaft.speed")
# Highest order kept of a spectrum.
ORDERS = 5.0
# Distance of two neighbours, in units of the scales, and how much finer they are integrated.
FINER, APART = 100.0, 1e-4


def frozen_at_end(scene):
    """The scene with every function of time at its last value: what it drives to, closed by the law that its start
    decides."""
    film = scene.film
    if film.clearance is not None and any(
        isinstance(p, PiecewiseLinear) for p in (film.inner_pressure, film.outer_pressure)
    ):
        law = Interface(at_work(scene)[0], 1e-6).closing
        scene = with_values(scene, {"closing": Closing(law.balance_ratio, law.spring)})
    return tables_at_end(scene)


class FilmCollapsed(RuntimeError):
    """The film did not survive the way to a point: the sentence, and the cause where it is known."""

    def __init__(self, message: str, cause: Cause | None = None):
        super().__init__(message)
        self.cause = cause


def ramp_to(scene, key, last, x, point):
    """Unknowns (n,) after the ramp to the scene from the value `last` of `key` and its end `x` (n,), or from a seal
    without any misalignment (x None).  `point` {"accuracy", "ramp" (periods)}.  Raises FilmCollapsed."""
    starts = {key: last} if x is not None and key in RAMPED else {}
    if x is None:
        starts = {k: 0.0 for k in RAMPED[:3] if part(scene, k)}
    period_map = PeriodMap(scene, point["accuracy"])
    if not starts:
        return np.zeros(period_map.size) if x is None else x
    span, moving = point["ramp"] * period_map.period, scene
    if key == "shaft.speed" and x is not None:
        # Whole turns, so that the phases meet.
        span *= 2 * scene.shaft.speed / (scene.shaft.speed + last)
    for k, start in starts.items():
        moving = with_values(moving, {k: PiecewiseLinear((0.0, span), (start, part(scene, k)))})
    run = RunState(Model(moving, point["accuracy"]), span)
    if x is not None:
        run.y0[: period_map.size] = x
    outcome = solve(run, period_map.method, point["accuracy"], Recorder())
    if outcome.status != Status.OK:
        raise FilmCollapsed(outcome.message, outcome.cause)
    return outcome.y[: period_map.size]


def sweep_branch(scene, point: dict) -> dict:
    """{"rows": the points of one direction, each from the end of the one before}.

    `point` {"key", "values", "direction", and what `characterise` and `ramp_to` take}.  A row has `value`, `direction`,
    `start` ("continued" or "aligned"), `status`, and the keys of `characterise`, or `message` and `class` "collapse".
    """
    scene, x, last, rows = frozen_at_end(scene), None, None, []
    for value in point["values"]:
        here = with_values(scene, {point["key"]: value})
        row = {"value": value, "direction": point["direction"], "start": "continued" if x is not None else "aligned"}
        try:
            x, more = characterise(here, ramp_to(here, point["key"], last, x, point), point)
            rows.append(row | {"status": Status.OK, **more})
        except FilmCollapsed as lost:
            x = None
            rows.append(row | {"status": Status.COLLAPSED, "message": str(lost), "class": "collapse"})
        last = value
    return {"rows": rows}


def neighbours(scene, x, turns, accuracy, method=None):
    """Exponent per period by two trajectories over `turns` periods from `x` (n,), integrated FINER than the rest: their
    distance must be far above the integrator's error even after a period that draws them together."""
    fine = PeriodMap(scene, accuracy / FINER, method)
    return two_trajectories(fine.step, x, fine.scales, turns, distance=APART)


def characterise(scene, x, point) -> tuple[np.ndarray, dict]:
    """Where the motion ends up at one point: its last unknowns (n,), and what it is like.  Raises FilmCollapsed.

    `x` (n,) to start from; `point` {"accuracy", "drop" and "keep" (periods left out and kept), "exponent_turns"}.
    Returns `class`, `period` (returns), `distinct`, `contacts` per period, `contact_share`, `contact_force` over the
    closing force, `impulse` (N s), `contact_power` (W), `exponent`, `uncertainty`, `multiplier`, `section` [m][2]
    (rad), `h_min` [m] (m), `lines`, `orders`, `amplitude` (rad), `end` [n], `evaluations` and `wall_time` (s) per
    period.
    """
    period_map = PeriodMap(scene, point["accuracy"])
    for periods in (point["drop"], point["keep"]):
        turns = period_map.run(x, periods)
        x = turns.last
        if turns.status != Status.OK:
            raise FilmCollapsed(turns.message)
    model = period_map.model
    scale = model.clearance / model.face[1]
    exponent = neighbours(scene, x, point["exponent_turns"], point["accuracy"])
    size = max(scale, float(np.ptp(turns.section.real)), float(np.ptp(turns.section.imag)))
    period = time_series.period_of(turns.section[len(turns.section) // 2 :], size)
    points, still = time_series.distinct_points(turns.section, size), time_series.shrinking(turns.section)
    kind = time_series.classify(period, exponent.value, exponent.uncertainty, still, points)
    orders, amplitude = time_series.spectrum(turns.ring.ravel(), SAMPLES / period_map.turns_per_period)
    kept = orders <= ORDERS
    return x, {
        "class": "no contact" if not turns.touching.any() and period == 1 else kind,
        "period": period,
        "distinct": points,
        "contacts": turns.contacts / point["keep"],
        "contact_share": float(turns.touching.mean()),
        "contact_force": float(turns.contact_force.mean() / model.closing_force()),
        "impulse": turns.impulse,
        "contact_power": float(turns.contact_power.mean()),
        "exponent": exponent.value,
        "uncertainty": exponent.uncertainty,
        "multiplier": math.exp(exponent.value * period) if period else None,
        "section": [[float(s.real), float(s.imag)] for s in turns.section],
        "h_min": turns.lowest.tolist(),
        "lines": time_series.lines(orders, amplitude),
        "orders": orders[kept].tolist(),
        "amplitude": amplitude[kept].tolist(),
        "end": [float(v) for v in x],
        "evaluations": turns.evaluations,
        "wall_time": turns.wall_time,
    }
