"""Stribeck curve: torque, friction coefficient, load share, leakage and temperature of the aligned seal over its speed,
with unheated faces and, where `[film.heat]` says what the rings take, with those that its own heat warms at each speed.

    friction coefficient = torque/(arm x what the faces carry above the lower pressure)

**Source** Stribeck (1902) for the curve; the states are those of the study of equilibria.
**Valid** quasi-static: each speed is held until clearance and temperature have settled.
"""

from dataclasses import dataclass, replace
from functools import partial

import numpy as np

from ..answers import Answer, Axis, Panel, Series, Table
from ..dynamics.equilibrium import settle
from ..dynamics.interface import opening_law
from ..dynamics.warm_state import at_work, warming
from ..numerics.piecewise_linear import points
from ..quantities import in_words
from ..scenario.errors import ScenarioError
from ..scene.film import Coefficients
from ..scene.scene import SceneError, frozen_at_start
from ..units import Speed
from . import Info
from .equilibrium import find, root_row

# What a point tells, with its unit.
POINT = {"torque": "N m", "friction_coefficient": "1", "load_share": "1", "leakage": "m^3/s", "clearance": "m",
         "temperature": "K", "power": "W"}  # fmt: skip
INFO = Info(
    timed=("pump_seal", 3),
    asks="How does the seal rub over its speed?",
    wavy=True,
    grooved=True,
    aligned=True,
    units={"speed": "rad/s", **POINT},
    along=dict.fromkeys([*POINT, *(f"unheated/{name}" for name in POINT)], ("speed",)),
)
# Panels: quantity, key, title, further words of the axis.
DRAWN = (
    ("torque", "torque", "Friction torque", {}),
    ("1", "friction_coefficient", "Friction coefficient", {"scale": "log"}),
    ("share", "load_share", "Share of the load on the film", {}),
    ("leakage", "leakage", "Leakage", {}),
    ("clearance", "clearance", "Clearance", {}),
    ("temperature", "temperature", "Rise of the faces", {"low": 0.0}),
)


@dataclass(frozen=True)
class Settings:
    """The speeds, in even ratios."""

    speed_from: Speed | None = None
    """Lowest speed; a hundredth of the highest."""
    speed_to: Speed | None = None
    """Highest speed; that of the scenario."""
    points: int = 31
    """Speeds in all."""


def run(scenario, settings, tools) -> Answer:
    """Every speed, unheated and warm."""
    most = max(abs(speed) for speed in points(scenario.scene.shaft.speed))
    high = settings.speed_to if settings.speed_to is not None else most
    low = settings.speed_from if settings.speed_from is not None else 0.01 * high
    if not 0.0 < low < high or settings.points < 2:
        found = f"{low:g} to {high:g} rad/s, {settings.points} points"
        raise ScenarioError(scenario.name, "study.stribeck.speed_from", found, "speeds above 0 that rise, two or more")
    speeds = [float(speed) for speed in np.geomspace(low, high, settings.points)]
    # The closing force is that of the scenario's own speed.
    scene = frozen_at_start(scenario.scene)
    rows = tools.map(partial(_point, replace(scene, shaft=replace(scene.shaft, speed=high))), speeds, "speeds")
    failed = [row["failed"] for row in rows if "failed" in row]
    own = "warm" if scene.film.heat is not None else "unheated"

    def columns(kind):
        return {name: [row.get(kind, {}).get(name) for row in rows] for name in POINT}

    numbers = {"speed": speeds, **columns(own)}
    if own == "warm":
        numbers["unheated"] = columns("unheated")
    notes = [f"{len(failed)} speeds without a state, the first: {failed[0]}"] if failed else []
    return Answer(numbers, _found(numbers), [_table(numbers)], _panels(numbers), notes)


def _point(scene, speed: float) -> dict:
    """Both states at a shaft speed (rad/s)."""
    found = {}
    turned = replace(scene, shaft=replace(scene.shaft, speed=speed))
    try:
        if scene.film.heat is None:
            return {"unheated": _row(_held(at_work(scene)[0], turned), 0.0)}
        warm = warming(scene).at_speed(speed)
        if (cold := warm.cold_state) is not None:
            found["unheated"] = _row(warm.at(0.0, cold.clearance), 0.0)
        state = warm.working()
        if state is None:
            return {**found, "failed": warm.why_none()}
        return {**found, "warm": _row(warm.at(state.rise, state.clearance), state.rise)}
    except SceneError as error:
        return {**found, "failed": str(error)}


def _held(scene, turned):
    """The scene at the speed of another one, under its own closing force, where that holds it."""
    own, law, *_ = settle(scene, opening_law(scene))
    closing = replace(scene.closing, balance_ratio=law.balance_ratio, spring_force=law.spring)
    free = replace(scene, shaft=turned.shaft, closing=closing, film=replace(scene.film, clearance=None))
    try:
        return replace(free, film=replace(free.film, clearance=settle(free, opening_law(free))[0]))
    except SceneError:
        if not (free.film.model == "linear" and isinstance(free.film.coefficients, Coefficients)):
            raise
        # Coefficients that know no other clearance.
        return replace(free, film=replace(free.film, clearance=own))


def _row(plain, rise: float) -> dict:
    """What a scene without heat does at its clearance."""
    (root,) = settle(plain, opening_law(plain))[2]
    film, found = plain.film, find(plain)
    row = root_row(plain, root, found)
    carried = found.closing - min(found.pressures) * found.law.area
    arm = 0.5 * (film.inner_radius + film.outer_radius)
    torque = row["friction_coefficient"] * carried * arm if row["friction_coefficient"] is not None else None
    return {"torque": torque, "friction_coefficient": row["friction_coefficient"], "load_share": row["load_support"],
            "leakage": row["leakage"], "clearance": root.clearance, "temperature": rise,
            "power": torque and torque * abs(plain.shaft.speed - plain.stator.speed)}  # fmt: skip


def _found(numbers) -> str:
    """The least friction coefficient, and where it is."""
    known = [(f, w) for f, w in zip(numbers["friction_coefficient"], numbers["speed"], strict=True) if f is not None]
    if not known:
        return "At none of these speeds the seal has a state."
    (least, at), (first, _), (last, _) = min(known), known[0], known[-1]
    where = "" if known[0][1] < at < known[-1][1] else ", an end of the speeds"
    return (
        f"The friction coefficient is least, {least:.3g}, at {in_words('speed', at)}{where}; it is {first:.3g} at the "
        f"lowest speed and {last:.3g} at the highest."
    )


def _table(numbers) -> Table:
    names = (("speed", "speed"), ("torque", "torque"), ("1", "friction_coefficient"), ("share", "load_share"),
             ("leakage", "leakage"), ("clearance", "clearance"), ("temperature", "temperature"))  # fmt: skip
    at = np.unique(np.linspace(0, len(numbers["speed"]) - 1, 9).astype(int))
    words = {"friction_coefficient": "friction coefficient", "load_share": "load on the film", "temperature": "rise"}
    return Table("speeds", [(held, words.get(key, key)) for held, key in names],
                 [[numbers[key][k] for _, key in names] for k in at])  # fmt: skip


def _panels(numbers) -> list[Panel]:
    """A panel a quantity, warm over unheated."""
    cold, out = numbers.get("unheated"), []
    for n, (held, key, title, more) in enumerate(DRAWN):
        if key == "temperature" and cold is None:
            continue
        lines = [Series("line", numbers["speed"], numbers[key], label="warm" if cold else "", style="bad thick")]
        if cold is not None and key != "temperature":
            lines.append(Series("line", numbers["speed"], cold[key], label="unheated", style="film dashed"))
        out.append(Panel(title, Axis("speed", scale="log"), Axis(held, **more), lines, first=n == 3))
    return out
