"""Followability: up to which runout a lip or a segment follows its shaft, over the speed and one key more; in closed
form, confirmed by runs, beside what the design guide allows by experience."""

import math
from dataclasses import dataclass, replace
from functools import partial
from typing import Annotated

import numpy as np

from ..analysis import other_rules
from ..answers import CYCLE, Answer, Axis, Level, Panel, Series, Table, table_of
from ..dynamics.intervals import largest_value
from ..quantities import in_words, number, reading_in
from ..radial_seals.followers import followers_of, largest_eccentricity
from ..radial_seals.model import RadialModel, RadialRun
from ..scenario.errors import ScenarioError
from ..scenario.reader import with_values
from ..scenario.settings import Words, axis, values_in_si
from ..scene.scene import SceneError
from ..solvers.contract import Recorder, Status
from ..solvers.integrate import solve
from ..units import Speed
from . import Info

INFO = Info(
    timed=("circumferential_reference", 7),
    asks="Up to which runout is the shaft followed?",
    seals="radial",
    units={
        "speed": "rad/s", "eccentricity": "m", "radius": "m", "most": "m", "surface_speed": "m/s", "curve": "1",
        "apart": "1", "closed_form": "m", "stiffness_over_preload": "1/m", "mass_over_preload": "s^2/m",
    },
    along={"curves": "speed"},
)  # fmt: skip
# Turns of a run; its accuracy; and by how much eccentricities straddle the limit.
TURNS, ACCURACY = 3.0, 1e-6
# Largest eccentricity that counts, of the radius.
MOST = 0.2


@dataclass(frozen=True)
class Settings:
    """Speeds, curves, and how many runs confirm them."""

    speed: Annotated[str, Words(Speed.__metadata__[0])] = ""
    """Shaft speeds, "from:to:count" with a unit: a tenth to four times the scenario's."""
    vary: str = ""
    """One key more and its values, "key=a,b,c", a curve each: preload, loss factor, offset, friction."""
    runs: int = 3
    """At so many speeds of each curve the limit is found by runs, to 1e-4."""


def run(scenario, settings, tools) -> Answer:
    """The curves, the runs that confirm them, and the guide's table."""
    own = largest_value(scenario.scene.shaft.speed)
    if not own:
        raise SceneError("shaft.speed", "a shaft at rest", "a speed: nothing follows a shaft that stands")
    where = "study.followability"
    speeds = (np.linspace(0.1, 4.0, 79) * own if not settings.speed
              else np.array(values_in_si(scenario, settings.speed, "rad/s", f"{where}.speed")))  # fmt: skip
    if not speeds.all():
        raise ScenarioError(scenario.name, f"{where}.speed", "a speed of 0", "speeds other than 0")
    if not 0 <= settings.runs <= 50:
        raise ScenarioError(scenario.name, f"{where}.runs", str(settings.runs), "0 to 50")
    along = axis(settings.vary, scenario.name, f"{where}.vary") if settings.vary else None
    values = [{along["key"]: given} for given in along["given"]] if along else [{}]
    scenes = [_round(with_values(scenario, value).scene) for value in values]
    names = [f"{along['key']} = {given}" for given in along["given"]] if along else [scenario.name]
    curves = [curve(scene, speeds) for scene in scenes]
    points = [
        {"curve": k, "speed": float(speed)}
        for k in range(len(scenes))
        for speed in np.interp(np.linspace(0.1, 0.9, settings.runs), np.linspace(0, 1, len(speeds)), np.sort(speeds))
    ]
    rows = tools.map(partial(confirmed, scenes), points, "runs", ("curve", "speed"))
    numbers = {
        "names": names,
        "speed": own,
        "eccentricity": scenario.scene.shaft.eccentricity,
        "radius": scenario.scene.shaft.radius,
        "most": MOST * scenario.scene.shaft.radius,
        "curves": [{"name": name, "speed": speeds.tolist(), "eccentricity": line} for name, line in
                   zip(names, curves, strict=True)],
        "runs": rows,
        "guide": guide(scenario.scene),
    }  # fmt: skip
    with reading_in({"rad/s": "rpm"}):
        return Answer(numbers, _found(scenario, numbers), _tables(numbers), _panels(numbers), _notes(numbers))


def _round(scene):
    """The scene without lobes: a single wave."""
    return _with_shaft(scene, lobes=[])


def _with_shaft(scene, **values):
    """The scene with other values of its shaft; at another speed a lip's loss factor stays, not its damping."""
    return replace(scene, shaft=replace(scene.shaft, **values))


def _limit(scene, speed: float) -> float:
    """Largest eccentricity (m) that is followed at a constant speed (rad/s), in closed form."""
    at = _with_shaft(scene, speed=speed)
    return largest_eccentricity(followers_of(at), at.shaft, speed)


def curve(scene, speeds) -> list:
    """Largest eccentricity (m) at each speed (rad/s); None beyond a fifth of the radius."""
    limits = [_limit(scene, float(speed)) for speed in speeds]
    return [limit if limit <= MOST * scene.shaft.radius else None for limit in limits]


def confirmed(scenes, point) -> dict:
    """The largest eccentricity (m) that runs from the following orbit keep to at one speed, by halving between ones
    that do and do not, to 1e-4; `apart` from the closed form (relative), which is None beyond the radius."""
    scene, speed = scenes[point["curve"]], point["speed"]
    limit = _limit(scene, speed)
    if not 0.0 < limit <= MOST * scene.shaft.radius:
        return {"eccentricity": None, "closed_form": limit if limit < scene.shaft.radius else None, "apart": None}
    low, high = 0.9 * limit, 1.1 * limit
    for wanted, rides in ((low, True), (high, False)):
        if follows(_with_shaft(scene, speed=speed, eccentricity=wanted)) != rides:
            found = f"at {in_words('speed', speed)} the runs do not lose contact within 10 % of the closed form"
            return {"eccentricity": None, "closed_form": limit, "apart": None, "failed": found}
    while high - low > 5e-5 * limit:
        middle = 0.5 * (low + high)
        rides = follows(_with_shaft(scene, speed=speed, eccentricity=middle))
        low, high = (middle, high) if rides else (low, middle)
    found = 0.5 * (low + high)
    return {"eccentricity": found, "closed_form": limit, "apart": found / limit - 1.0}


def follows(scene) -> bool:
    """Whether a run from the following orbit never leaves the shaft.  Raises SceneError where it fails."""
    model = RadialModel(scene, ACCURACY)
    state = RadialRun(model, TURNS * 2.0 * math.pi / abs(scene.shaft.speed))
    outcome = solve(state, "dop853", ACCURACY, Recorder())
    if outcome.status == Status.FAILED:
        raise SceneError("shaft.speed", outcome.message, "a run that ends")
    return state.stick_slip.counts["lift"] == 0 and bool((state.stick_slip.modes == 2.0).all())


def guide(scene) -> dict:
    """Rows of the guide's table: `speed` (m/s) over `eccentricity` (m), and what they are; with the fit of 1/e = a + b
    v^2 and what stiffness over preload it would mean."""
    if scene.lip:
        amounts, speeds, words = other_rules.LIP_ECCENTRICITY, other_rules.LIP_SPEED, "table 3.2, offset + runout"
    else:
        amounts, speeds, words = 0.5 * other_rules.SEGMENT_RUNOUT, other_rules.SEGMENT_SPEED, "table 3.4, half of TIR"
    slope, start = np.polyfit(speeds**2, 1.0 / amounts, 1)
    return {
        "eccentricity": amounts.tolist(), "surface_speed": speeds.tolist(), "words": words,
        "stiffness_over_preload": float(-start), "mass_over_preload": float(slope * scene.shaft.radius**2),
    }  # fmt: skip


# --- what is shown --------------------------------------------------------------------------------------


def _found(scenario, numbers) -> str:
    """The largest eccentricity at the scenario's speed."""
    own, speed = _round(scenario.scene), numbers["speed"]
    limit = _limit(own, speed)
    at = f"At {in_words('speed', speed, digits=5)}"
    if limit == 0.0:
        return f"{at} nothing is followed: friction and offset take all of the preload."
    if limit >= own.shaft.radius:
        return f"{at} any eccentricity is followed."
    this = in_words("m", numbers["eccentricity"])
    return f"{at} the shaft is followed up to an eccentricity of {in_words('m', limit)}; this one has {this}."


def _notes(numbers) -> list[str]:
    """What the guide's experience is not."""
    stiffness = numbers["guide"]["stiffness_over_preload"]
    impossible = ", which is negative: inertia is not what limits these seals" if stiffness < 0 else ""
    return [f"The guide's {numbers['guide']['words']}, is experience: a mass on a spring that fits it would have "
            f"{number(stiffness, digits=3)} per m of stiffness over preload{impossible}."]  # fmt: skip


def _tables(numbers) -> list[Table]:
    """The runs beside the closed form."""
    columns = [("1", "curve", "curve"), ("speed", "speed", "speed"), ("m", "by runs", "eccentricity"),
               ("m", "closed form", "closed_form"), ("1", "apart", "apart")]  # fmt: skip
    rows = [row | {"curve": numbers["names"][row["curve"]]} for row in numbers["runs"]]
    return [table_of("runs", columns, rows)]


def _panels(numbers) -> list[Panel]:
    """Limits over the speed: below a curve the element rides all the way round.  Where a limit is beyond what was
    looked for the curve runs along that bound."""
    most, series, levels = numbers["most"], [], []
    if any(e is None for line in numbers["curves"] for e in line["eccentricity"]):
        levels = [Level(most, "a fifth of the shaft's radius: no limit is looked for beyond")]
    for k, line in enumerate(numbers["curves"]):
        limit, colour = [most if e is None else e for e in line["eccentricity"]], CYCLE[k % len(CYCLE)]
        held = "" if any(limit) else ": nothing is followed"
        # A logarithmic axis has no place for nothing.
        series.append(
            Series("line", line["speed"], [e or None for e in limit], label=line["name"] + held, style=colour)
        )
        points = [row for row in numbers["runs"] if row["curve"] == k and row.get("eccentricity")]
        if points:
            at = ([row[name] for row in points] for name in ("speed", "eccentricity"))
            series.append(Series("marks", *at, label="limit found by runs", style=f"{colour} circle open"))
    guide = numbers["guide"]
    speeds = [speed / numbers["radius"] for speed in guide["surface_speed"]]
    series.append(Series("line", speeds, guide["eccentricity"], label=f"guide, {guide['words']}",
                         style="grey dashed square"))  # fmt: skip
    if numbers["eccentricity"] > 0:
        series.append(Series("marks", [numbers["speed"]], [numbers["eccentricity"]], label="this scenario",
                             style="bad star large front"))  # fmt: skip
    return [Panel("Contact is lost above the curve", Axis("speed"),
                  Axis("m", "largest eccentricity followed", scale="log"), series, levels)]  # fmt: skip
