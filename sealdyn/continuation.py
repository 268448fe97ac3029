"""A rubbing seal followed over a key: each point from the last one's end, and what its motion is like there."""

import math
from dataclasses import replace

import numpy as np

from . import attractor
from .faces import Faces
from .lyapunov import two_trajectories
from .piecewise_linear import PiecewiseLinear
from .problem import Problem
from .recorder import Recorder
from .scenario import parse_scenario
from .scene import Closing
from .solve import solve
from .stroboscope import SAMPLES, Stroboscope

# What is led to its new value in time; anything else changes between two turns.
LED = ("rotor.runout", "rotor.misalignment", "stator.misalignment", "shaft.speed")
# Highest order kept of a spectrum.
ORDERS = 5.0
# Distance of two neighbours, in units of the scales, and how much finer they are integrated.
FINER, APART = 100.0, 1e-4


def part(thing, key: str):
    """The value of a scene at a dotted key."""
    for name in key.split("."):
        thing = getattr(thing, name)
    return thing


def with_part(thing, key: str, value):
    """The scene with another value at a dotted key."""
    name, _, rest = key.partition(".")
    return replace(thing, **{name: with_part(getattr(thing, name), rest, value) if rest else value})


def lasting(scene):
    """The scene with every table at its last value: what it drives to, closed by the law that its start decides."""
    film = scene.film
    if film.clearance is not None and any(
        isinstance(p, PiecewiseLinear) for p in (film.inner_pressure, film.outer_pressure)
    ):
        law = Faces(scene, 1e-6).closing
        scene = replace(scene, closing=Closing(law.balance_ratio, law.spring))
    for table in ("shaft", "film", "rotor", "stator", "closing"):
        owner = getattr(scene, table)
        ends = {n: float(v.value[-1]) for n, v in vars(owner).items() if isinstance(v, PiecewiseLinear)}
        scene = replace(scene, **{table: replace(owner, **ends)})
    return scene


class Lost(RuntimeError):
    """The film did not survive the way to a point."""


def led(scene, key, last, x, point):
    """Unknowns (n,) after the ramp to the scene from the value `last` and its end `x`, or from a seal without any
    misalignment (x None).  Raises Lost."""
    starts = {key: last} if x is not None and key in LED else {}
    if x is None:
        starts = {k: 0.0 for k in LED[:3] if part(scene, k)}
    stroboscope = Stroboscope(scene, point["accuracy"])
    if not starts:
        return np.zeros(stroboscope.size) if x is None else x
    span, moving = point["ramp"] * stroboscope.period, scene
    if key == "shaft.speed" and x is not None:
        # Whole turns, so that the phases meet.
        span *= 2 * scene.shaft.speed / (scene.shaft.speed + last)
    for k, start in starts.items():
        moving = with_part(moving, k, PiecewiseLinear((0.0, span), (start, part(scene, k))))
    problem = Problem(moving, span, point["accuracy"])
    if x is not None:
        problem.y0[: stroboscope.size] = x
    outcome = solve(problem, stroboscope.method, point["accuracy"], Recorder(problem))
    if outcome.status != "ok":
        raise Lost(outcome.message)
    return outcome.y[: stroboscope.size]


def chain(point: dict) -> dict:
    """The points of one direction, each from the end of the one before."""
    scenario = parse_scenario(point["text"], point["name"], point["overrides"])
    scene, x, last, rows = lasting(scenario.scene), None, None, []
    for value in point["values"]:
        here = with_part(scene, point["key"], value)
        row = {"value": value, "direction": point["direction"], "start": "continued" if x is not None else "aligned"}
        try:
            x, more = settled(here, led(here, point["key"], last, x, point), point)
            rows.append(row | {"status": "ok", **more})
        except Lost as lost:
            x = None
            rows.append(row | {"status": "collapsed", "message": str(lost), "class": "collapse"})
        last = value
    return {"rows": rows}


def neighbours(scene, x, turns, accuracy, method=None):
    """Exponent by two trajectories, integrated FINER than the rest: their distance must be far above the integrator's
    error even after a turn that draws them together."""
    fine = Stroboscope(scene, accuracy / FINER, method)
    return two_trajectories(fine.step, x, fine.scales, turns, distance=APART)


def settled(scene, x, point) -> tuple[np.ndarray, dict]:
    """Where the motion ends up at one point: its last unknowns, and what it is like.  Raises Lost."""
    stroboscope = Stroboscope(scene, point["accuracy"])
    for periods in (point["drop"], point["keep"]):
        turns = stroboscope.run(x, periods)
        x = turns.last
        if turns.status != "ok":
            raise Lost(turns.message)
    problem = stroboscope.problem
    scale = problem.clearance / problem.face[1]
    exponent = neighbours(scene, x, point["exponent_turns"], point["accuracy"])
    size = max(scale, float(np.ptp(turns.section.real)), float(np.ptp(turns.section.imag)))
    period = attractor.period_of(turns.section[len(turns.section) // 2 :], size)
    points, still = attractor.distinct(turns.section, size), attractor.shrinking(turns.section)
    kind = attractor.kind(period, exponent.value, exponent.uncertainty, still, points)
    orders, amplitude = attractor.spectrum(turns.ring.ravel(), SAMPLES / stroboscope.turns_per_period)
    kept = orders <= ORDERS
    return x, {
        "class": "no contact" if not turns.touching.any() and period == 1 else kind,
        "period": period,
        "distinct": points,
        "contacts": turns.contacts / point["keep"],
        "contact_share": float(turns.touching.mean()),
        "contact_force": float(turns.contact_force.mean() / problem.closing_force()),
        "impulse": turns.impulse,
        "contact_power": float(turns.contact_power.mean()),
        "exponent": exponent.value,
        "uncertainty": exponent.uncertainty,
        "multiplier": math.exp(exponent.value * period) if period else None,
        "section": [[float(s.real), float(s.imag)] for s in turns.section],
        "h_min": turns.lowest.tolist(),
        "lines": attractor.lines(orders, amplitude),
        "orders": orders[kept].tolist(),
        "amplitude": amplitude[kept].tolist(),
        "end": [float(v) for v in x],
        "evaluations": turns.evaluations,
        "wall_time": turns.wall_time,
    }
