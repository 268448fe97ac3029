"""Warm-up: temperature, coning, clearance, leakage and friction of the aligned seal over start, hold and stop.

The equations are those of dynamics/warm_course.py.
**Valid** aligned faces without inertia: speeds, pressures and temperatures that change slower than the rings move.
"""

from dataclasses import dataclass, replace

import numpy as np

from ..answers import Answer, Axis, Panel, Series, Table, columns
from ..dynamics.warm_course import breaks, course
from ..dynamics.warm_state import warming
from ..numerics.piecewise_linear import PiecewiseLinear
from ..quantities import in_words
from ..scenario.errors import ScenarioError
from ..scene.scene import frozen_at
from ..simulation.heat import limits_of, limits_said
from ..units import Time
from . import Info

INFO = Info(
    timed=("pump_seal", 3),
    asks="How does the seal warm up?",
    wavy=True,
    aligned=True,
    units={
        "time": "s", "rise": "K", "coning": "rad", "clearance": "m", "power": "W", "contact_power": "W",
        "leakage": "m^3/s", "torque": "N m", "speed": "rad/s", "energy_residual": "1",
        "heat": "J", "collapsed": "s", "period": "s", "fold": "rad/s",
    },
    along=dict.fromkeys(
        ("rise", "coning", "clearance", "power", "contact_power", "leakage", "torque", "speed"), ("time",)
    ),
)  # fmt: skip
# Share of the highest rise that may be missing where the faces count as warm.
NEARLY = 0.05
# What is kept of every moment.
COLUMNS = ("rise", "coning", "clearance", "power", "contact_power", "leakage", "torque")


@dataclass(frozen=True)
class Settings:
    """What is added to the tables of the scenario: start and stop of a constant `shaft.speed`, and how long all is
    held."""

    start: Time | None = None
    """From rest to the speed; without it 1 s, where loads have tables none: it turns at that speed from the start."""
    hold: Time | None = None
    """After start and tables; without it 60 s, after tables 0."""
    stop: Time = 0.0
    """To rest again; without it the seal runs on."""
    rest: Time = 0.0
    """At rest after that."""
    begin: str = "cold"
    """"cold": faces of the sealed liquid's temperature; "warm": the warm state of the first speed."""


def run(scenario, settings, tools) -> Answer:
    """The course of the warm-up, the rise and the clearance as unknowns."""
    scene = scenario.scene
    if scene.film.heat is None:
        found = "nothing: a seal that takes no heat does not warm up"
        raise ScenarioError(scenario.name, "film.heat", found, "stator or rotor, each { resistance, ... }")
    if settings.begin not in ("cold", "warm"):
        raise ScenarioError(scenario.name, "study.warm_up.begin", repr(settings.begin), '"cold" or "warm"')
    scene, times = _course(scene, settings, scenario.name)
    found = warming(scene).under(frozen_at(scene, times[0]))
    if found.capacity is None:
        bare = next(name for name, ring in found.rings.items() if ring.time_constant is None)
        raise ScenarioError(scenario.name, f"film.heat.{bare}.time_constant", "nothing", "a time, to warm up in")
    start = found.cold_state if settings.begin == "cold" else found.working()
    if start is None and settings.begin == "warm":
        raise ScenarioError(scenario.name, "study.warm_up.begin", found.why_none(), '"cold"')
    if start is None:
        raise ScenarioError(scenario.name, "film", "no film at the start", 'a film that holds, or begin = "warm"')
    # Under the loads that there are when it turns fastest.
    highest = max(times, key=lambda t: abs(scene.shaft.speed.at(t)))
    limits = limits_of(found.under(frozen_at(scene, highest)), float(scene.shaft.speed.at(highest)))
    numbers = _numbers(scene, course(scene, times, start, tools.say)) | limits
    return Answer(numbers, _found(numbers), [_table(numbers)], _panels(numbers))


def _course(scene, settings, name):
    """The scene with its speed over time, and the times (s) between which everything is linear."""
    speed, tabled = scene.shaft.speed, breaks(scene)[-1]
    start = (0.0 if tabled else 1.0) if settings.start is None else settings.start
    hold = (0.0 if tabled else 60.0) if settings.hold is None else settings.hold
    rest = settings.rest if settings.stop else 0.0
    for key, given in (("start", settings.start), ("stop", settings.stop)):
        if given and isinstance(speed, PiecewiseLinear):
            raise ScenarioError(name, f"study.warm_up.{key}", f"{given:g} s", "a shaft.speed without table")
    if min(start, hold, settings.stop, rest) < 0.0 or max(start, tabled) + hold + settings.stop <= 0.0:
        raise ScenarioError(name, "study.warm_up.hold", f"{hold:g} s", "times >= 0, not all of them 0")
    held = max(start, tabled) + hold
    if isinstance(speed, PiecewiseLinear):
        return scene, sorted({*breaks(scene), held})
    course = [(0.0, 0.0 if start else speed), (start, speed), (held, speed)]
    course += [(held + settings.stop, 0.0), (held + settings.stop + rest, 0.0)] if settings.stop else []
    course = [point for k, point in enumerate(course) if k == 0 or point[0] > course[k - 1][0]]
    table = PiecewiseLinear(tuple(t for t, _ in course), tuple(w for _, w in course))
    scene = replace(scene, shaft=replace(scene.shaft, speed=table))
    return scene, breaks(scene)


def _numbers(scene, found) -> dict:
    """The numbers of the answer of a Course."""
    return {
        "time": found.time,
        **columns(found.states, COLUMNS),
        "speed": [float(scene.shaft.speed.at(t)) for t in found.time],
        "heat": found.heat,
        "energy_residual": found.residual,
        "collapsed": found.collapsed,
    }


def _found(numbers) -> str:
    """How warm, how far open, and when; whether it hunts."""
    beyond = limits_said(numbers)
    if numbers["collapsed"] is not None:
        return f"The film collapses by heat after {in_words('time', numbers['collapsed'])}. {beyond}".rstrip()
    hot = int(np.argmax(numbers["rise"]))
    words = f"The faces get {in_words('temperature', numbers['rise'][hot])} warmer than the sealed liquid"
    first = next(k for k, rise in enumerate(numbers["rise"]) if rise >= (1.0 - NEARLY) * numbers["rise"][hot])
    when = f"{in_words('share', 1.0 - NEARLY)} of it after {in_words('time', numbers['time'][first])}"
    begin, then = (in_words("clearance", numbers["clearance"][k]) for k in (0, hot))
    return f"{words}, {when}; the clearance goes from {begin} to {then}. {beyond}".rstrip()


def _table(numbers) -> Table:
    """A dozen moments between the first and the last."""
    keys = (("time", "time"), ("speed", "speed"), ("temperature", "rise"), ("tilt", "coning"),
            ("clearance", "clearance"), ("power", "power"), ("torque", "torque"), ("leakage", "leakage"))  # fmt: skip
    rise = np.array(numbers["rise"])
    # Moments at which as much has happened as from any to the next.
    way = np.concatenate([[0.0], np.cumsum(np.abs(np.diff(rise)) + 1e-3 * np.ptp(rise) / len(rise))])
    at = np.unique(np.searchsorted(way, np.linspace(0.0, way[-1], 12)))
    rows = [[numbers[key][min(k, len(rise) - 1)] for _, key in keys] for k in at]
    return Table("course", [(held, {"power": "heat"}.get(key, key)) for held, key in keys], rows)


def _panels(numbers) -> list[Panel]:
    """Temperature and coning, clearance and leakage, heat and torque over time; the speed below."""
    over = Axis("time")

    def panel(title, key, held, style, **more):
        lines = [Series("line", numbers["time"], numbers[key], style=style)]
        return Panel(title, over, Axis(held, **more), lines)

    heat = [Series("line", numbers["time"], numbers["power"], label="all", style="film thick")]
    if any(numbers["contact_power"]):
        rubbed = Series(
            "line", numbers["time"], numbers["contact_power"], label="of asperities", style="contact dotted"
        )
        heat.append(rubbed)
    return [
        panel("Rise of the faces", "rise", "temperature", "bad", low=0.0, label="rise"),
        panel("Coning", "coning", "tilt", "tilt", label="coning"),
        panel("Clearance", "clearance", "clearance", "film"),
        replace(panel("Leakage", "leakage", "leakage", "blue"), first=True),
        Panel("Heat", over, Axis("power", "heat", low=0.0), heat),
        panel("Shaft speed", "speed", "speed", "black"),
    ]
