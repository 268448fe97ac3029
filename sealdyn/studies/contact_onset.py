"""Contact onset: the forcing at which the steady film first touches, by continuation of the periodic orbit; of a film
that stores by ramps in time, and of faces that touch at rest the forcing that their contact allows."""

from dataclasses import dataclass, replace
from functools import partial
from typing import Annotated, Literal

import numpy as np
from pydantic import Field
from scipy.optimize import brentq

from ..analysis.orbit_path import Follower
from ..analysis.shooting import NoOrbit
from ..answers import Answer, Axis, Level, Panel, Series, Table
from ..dynamics.model import Model
from ..dynamics.warm_state import at_work
from ..numerics.piecewise_linear import points
from ..quantities import in_words
from ..scenario.errors import ScenarioError
from ..scenario.reader import with_values
from ..scenario.settings import must_be_number, si_unit
from ..scene import scene as scenes
from ..scene.checks import unused
from ..scene.forces import touch_height
from ..scene.rings import SMALL_TILT
from ..scene.scene import SceneError
from ..simulation.margin import NoOnset, limit_of_forcing, linear_films, linear_onset, times_own, touching_when_aligned
from ..simulation.simulate import simulate_in_memory
from ..status import Status
from . import Info
from .wear.averages import ShortRunAverages
from .wear.rosenbrock import NoAverage

INFO = Info(
    timed=("fms_reference --set stator.misalignment=0", 2),
    asks="When do the faces first touch?",
    refuses=("secondary-seal",),
    # Of the key itself the answer knows the unit.
    units={
        **dict.fromkeys(("h_min", "axial", "clearance", "radius", "linear_radius", "touch"), "m"), "tilt": "rad",
        **dict.fromkeys(("contact_force", "closing_force"), "N"),
        "cavitation_pressure": "Pa", "start": "SI", "beyond_tilt": "rad", "h_min_there": "m",
        **dict.fromkeys(("allowed/share", "rise"), "1"),
        **dict.fromkeys(("margin", "times_own", "ratio", "axial_opening", "multiplier", "curve/path/curve"), "1"),
    },
    along={"allowed/path": ("tried",), "path": ("forcing",), "linear": ("forcing",), "curve": ("value",)},
)  # fmt: skip
# What may rise, by its name among the means of a short run, and in words.
LIMITS = {"pressure": "contact_pressure", "load": "contact_force", "wear": "wear_rate", "friction": "friction_power"}
AT_REST = {"pressure": "Pa", "load": "N", "wear": "m/s", "friction": "W"}
WORDS = {"pressure": "contact pressure", "load": "load on the asperities", "wear": "wear", "friction": "friction"}
# Largest value (SI) of a key that is no tilt, first share of the largest, steps up from there, a rise that counts as
# any, how well means settle, how near the share the value found comes; a ramp's end, in linear onsets, and turns.
LARGEST_RUNOUT, FIRST, STEP, CRUSHED, SETTLED, NEAR = 1e-3, 5e-6, 4.0, 10.0, 1e-3, 0.05
RAMP_TO, RAMPS = 2.5, (12, 24)
# What ends linear theory.
ENDS = {
    "touch": "where it touches",
    "small tilts": f"where tilts reach {SMALL_TILT:g} rad",
    "laminar film": "where the film is laminar no more at the edge that opens",
    "slow gas": "where the gas is slow no more at the edge that opens",
}
# Onsets further apart than this are seen on a logarithmic axis only.
APART = 20.0


@dataclass(frozen=True)
class Settings:
    """What grows until the film touches, and what the onset is followed over."""

    key: str | None = None
    """Key that grows until the film touches; without it the tilt that the seal has: of an FMS rotor.runout before
    stator.misalignment, of an FMR stator.misalignment, of an FMSR rotor.misalignment, each before the other."""
    margin: float = 1e-3
    """Touch is a film of so much of the clearance; of rough faces where their asperities meet."""
    over: str | None = None
    """Another key, over which the onset is a curve."""
    values: tuple[float | str, ...] = ()
    """Values of that key."""
    floor: bool = False
    """Also with the pressure floored at the lower boundary pressure, along the curve too (slower)."""
    tolerance: float = 1e-6
    """Relative error of the onset."""
    most: float = 1000.0
    """An onset that linear theory sees beyond so many times the scenario's own value of the key is not followed;
    nor is one beyond any small tilt."""
    share: Annotated[float, Field(ge=0)] = 0.1
    """Of faces that touch at rest: by how much `limit` may rise until the key is what they allow; 0: not asked."""
    limit: Literal["pressure", "load", "wear", "friction"] = "pressure"
    """Largest contact pressure, mean load on the asperities, mean depth rate of wear, mean friction power."""


def run(scenario, settings, tools) -> Answer:
    """Linear and nonlinear onset of the key, the path of orbits to it, and a curve over another key."""
    key = settings.key or acting(scenario.scene)[0]
    must_be_number(scenario, key, "study.contact_onset.key")
    if unused(scenario.scene, {key}):
        found, expected = f"{key}, which this seal does not use", " or ".join(acting(scenario.scene))
        raise ScenarioError(scenario.name, "study.contact_onset.key", found, expected)
    base = {"key": key, "margin": settings.margin, "tolerance": settings.tolerance, "most": settings.most,
            "share": settings.share, "limit": settings.limit}  # fmt: skip
    # Plain and floored are separate points: the floored film may fail, or be interrupted, where the plain one holds.
    floors = [False, True] if settings.floor else [False]
    sets = [{}, *({settings.over: value} for value in settings.values if settings.over)]
    points = [{**base, "set": s, "floor": f} for s in sets for f in floors]
    rows = tools.map(partial(onset, scenario), points, "onset")
    plain, floored = rows[:: len(floors)], rows[1::2] if settings.floor else [None] * len(sets)
    curve = [
        {"value": value, **row} | ({"floored": brief(below)} if below else {})
        for value, row, below in zip(settings.values, plain[1:], floored[1:], strict=False)
    ]
    numbers = {"key": key, "formula": None, "nonlinear": None, "radius": None, "margin": settings.margin,
              **plain[0], "floored": floored[0], "over": settings.over, "curve": curve}  # fmt: skip
    unit = si_unit(scenario.scene, key)
    numbers["units"] = dict.fromkeys(
        ("forcing", "formula", "nonlinear", "not_before", "ramps", "allowed/value", "linear_limit/value"), unit
    )
    numbers["units"]["allowed/at_rest"] = AT_REST[settings.limit]
    numbers["units"]["value"] = si_unit(scenario.scene, settings.over) if curve else "SI"
    if "failed" in numbers:
        numbers["status"] = Status.FAILED
    return Answer(numbers, _found(numbers, unit), _tables(numbers), _panels(numbers), _notes(numbers))


def acting(scene) -> list[str]:
    """Keys (dotted) of the tilts that may be imposed on the gap of a scene: those that it has first."""
    keys = ["rotor.misalignment" if scene.rotor.support else "rotor.runout", "stator.misalignment"]
    if not scene.stator.support:
        keys.reverse()
    return sorted(keys, key=lambda key: not any(points(scenes.part(scene, key))))


def brief(row: dict) -> dict:
    """What a point of the floored curve says: the rest is its plain neighbour's."""
    return {k: row[k] for k in ("nonlinear", "ratio", "cavitation_pressure", "failed") if k in row}


def onset(scenario, point: dict) -> dict:
    """Linear and nonlinear onset of one scenario; `path` the orbits on the way.  Without a nonlinear onset it says why:
    `failed`; an onset beyond any small tilt, of linear theory or of the orbits, is `beyond_tilt` (rad) and no failure.
    `linear_limit`: the `value` of the key up to which linear theory stands, and what ends it (`by`)."""
    scenario = with_values(scenario, point["set"])
    floor = min(scenario.scene.film.floor, point["margin"] / 4)
    key, rough = point["key"], touch_height(scenario.scene)
    aligned = touching_when_aligned(scenario.scene, rough)
    if aligned:
        allows = {"allowed": allowed(scenario, point)} if point["share"] > 0.0 else {}
        return {"key": key, "formula": 0.0, "nonlinear": 0.0, "margin": point["margin"], **aligned, **allows}

    def scene(value):
        # Until asperities meet the film is alone.
        given = with_values(scenario, {key: value, "film.floor": floor, "run.start": "steady"}).scene
        return scenes.with_values(given, {"contact": None})

    try:
        formula, touching = linear_onset(scene, key, rough)
    except NoOnset as reason:
        return {"key": key, "margin": point["margin"], "touch": rough, "failed": str(reason),
                **linear_films(scene, key, rough, scenario.scene)}  # fmt: skip
    rest = Model(scene(0.0), 1e-6)
    result = {"key": key, "formula": formula, "linear_radius": touching, "margin": point["margin"], "touch": rough,
              "times_own": times_own(scenario.scene, key, formula), "clearance": rest.clearance}  # fmt: skip
    limit = SMALL_TILT if si_unit(scenario.scene, key) == "rad" else np.inf

    def stands():
        return {"linear_limit": limit_of_forcing(lambda value: Model(scene(value), 1e-6), formula)}

    beyond = {"beyond_tilt": SMALL_TILT}
    if formula > limit:
        return {**result, **beyond, **stands()}
    if (result["times_own"] or 0.0) > point["most"]:
        why = f"beyond {point['most']:g} times the scenario's own nothing is followed"
        return {**result, "failed": why, **stands()}
    if rest.interface.stores:
        found = ramped(scenario, key, formula, point["margin"], rough / rest.clearance)
        return {**result, **found, **(stands() if "nonlinear" not in found else {})}
    follower = Follower(scene, point["margin"], min(scenario.run.accuracy, 1e-7), touch=rough)
    try:
        value = follower.follow(formula, point["tolerance"], limit)
    except NoOrbit as reason:
        # Orbits open the gap as they tilt it: what linear theory sees touch may not, at any small tilt.
        ended = follower.path and follower.path[-1]["forcing"] == limit
        return {**result, **follower.told(), **({**beyond, **stands()} if ended else {"failed": str(reason)})}
    clearance = follower.path[-1]["clearance"]
    result |= {
        "nonlinear": value,
        "ratio": value / formula,
        "radius": follower.path[-1]["radius"],
        "start": [float(x) for x in follower.start],
        "axial_opening": follower.path[-1]["axial"] / clearance,
        "multiplier": follower.multiplier(),
        **follower.told(),
    }
    if point["floor"]:
        film = scenario.scene.film
        lowest = min(float(film.inner_pressure), float(film.outer_pressure))

        def floored(value):
            return scenes.with_values(scene(value), {"film.cavitation_pressure": lowest})

        with_floor = Follower(floored, point["margin"], 1e-4, follower.monodromy, follower.start, rough)
        result["nonlinear"] = with_floor.close(value, 1e-4)
        result["ratio"] = result["nonlinear"] / formula
        result["cavitation_pressure"] = lowest
    return result


def ramped(scenario, key: str, formula: float, margin: float, rough: float) -> dict:
    """Onset of a film that stores, whose orbits have no period map of the rings alone: the key grows from nothing to
    beyond its linear onset `formula` in time, twice as slowly the second time; touch is the larger of `margin` and the
    height `rough` where asperities meet, of the clearance.  `ramps`: both onsets, the slower one counts; without a
    touch `not_before`, the value reached."""
    end, values = RAMP_TO * formula, []
    if si_unit(scenario.scene, key) == "rad":
        end = min(end, SMALL_TILT)
    plain = {"contact": None} if scenario.scene.contact else {}
    for turns in RAMPS:
        period = 2.0 * np.pi / abs(scenario.scene.shaft.speed)
        growing = {"time": [0.0, turns * period], "value": [0.0, end]}
        values_set = {key: growing, "film.floor": max(margin, rough), "run.turns": turns, "run.start": "steady"}
        try:
            found = simulate_in_memory(with_values(scenario, {**plain, **values_set}))
        except (ScenarioError, SceneError) as reason:
            return {"failed": f"a film that stores is run in time with a ramp of the key: {reason}"}
        if found["status"] == Status.OK:
            return {"not_before": end, "h_min_there": found["h_min"]["value"]}
        if found["status"] != Status.COLLAPSED:
            return {"failed": f"a ramp in time ends: {found['message']}"}
        values.append(end * found["h_min"]["time"] / (turns * period))
    return {"nonlinear": values[-1], "ratio": values[-1] / formula, "ramps": values}


def allowed(scenario, point: dict) -> dict:
    """Of faces that touch at rest: the `value` of the key at which the limit is up by the share, `at_rest` (SI) the
    limit without it, `path` what was tried; `value` None where it stays below for any small tilt, or `failed`."""
    key, name = point["key"], LIMITS[point["limit"]]
    path, ended = {"forcing": [], "rise": []}, []
    told = {"limit": point["limit"], "share": point["share"], "value": None, "path": path}
    contact = scenario.scene.contact
    if point["limit"] == "wear" and not (contact.stator_wear_coefficient or contact.rotor_wear_coefficient):
        return {**told, "failed": "no wear coefficient in [contact]"}

    def seen(value):
        scene = at_work(with_values(scenario, {key: value}).scene)[0]
        film = scene.film
        radii = film.profile.radius if film.profile else (film.inner_radius, film.outer_radius)
        means = ShortRunAverages(scene, radii, min(scenario.run.accuracy, 1e-5), SETTLED)
        return means(np.zeros(len(radii))).row[name]

    def excess(value):
        try:
            rise = seen(value) / told["at_rest"] - 1.0
        except NoAverage as stop:
            # Crushed asperities, or a run that ends: looked for below.
            ended.append(str(stop))
            rise = CRUSHED
        path["forcing"].append(float(value))
        path["rise"].append(float(rise))
        return rise - point["share"]

    try:
        told["at_rest"] = float(seen(0.0))
        if told["at_rest"] <= 0.0:
            return {**told, "failed": f"nothing touches without any {key}"}
        most = SMALL_TILT if si_unit(scenario.scene, key) == "rad" else LARGEST_RUNOUT
        low, high = 0.0, FIRST * most
        while excess(high) < 0.0:
            if high >= most:
                return told
            low, high = high, min(STEP * high, most)
        found = float(brentq(excess, low, high, rtol=SETTLED))
        if abs(excess(found)) > NEAR * point["share"]:
            return {**told, "failed": f"runs beyond {found:.4g} end: {ended[-1]}" if ended else "no such rise"}
        told["value"] = found
    except (NoAverage, SceneError) as reason:
        told["failed"] = str(reason)
    return told


# --- what is shown -----------------------------------------------------------------------------------------


def _found(numbers, unit: str) -> str:
    """The onset, or what linear theory says and why the nonlinear film does not."""
    key, formula = numbers["key"], numbers["formula"]
    if "failed" not in numbers and not numbers.get("beyond_tilt"):
        if numbers["nonlinear"] == 0.0:
            return f"The asperities touch without any {key}{_allows(numbers, unit)}."
        if numbers.get("not_before"):
            return (f"Linear theory touches at {key} = {in_words(unit, formula)}; in time the faces do not touch up to "
                    f"{in_words(unit, numbers['not_before'])}{_stands(numbers, unit)}.")  # fmt: skip
        return f"The faces first touch at {key} = {in_words(unit, numbers['nonlinear'], digits=6)}."
    if formula is None:
        return numbers["failed"]
    touches = f"inear theory touches at {key} = {in_words(unit, formula)}"
    if numbers.get("beyond_tilt"):
        return f"The faces touch at no small tilt: l{touches}{_stands(numbers, unit)}."
    return f"L{touches}; undecided beyond: {numbers['failed']}{_stands(numbers, unit)}."


def _stands(numbers, unit: str) -> str:
    """Up to which forcing linear theory stands, and what ends it."""
    found = numbers.get("linear_limit")
    return f"; linear theory stands up to {in_words(unit, found['value'])}, {ENDS[found['by']]}" if found else ""


def _allows(numbers, unit: str) -> str:
    """What faces that touch at rest allow."""
    found = numbers.get("allowed")
    if not found or "failed" in found:
        return f"; what they allow is not known: {found['failed']}" if found else ""
    rise = f"{in_words('share', found['share'])} more {WORDS[found['limit']]}"
    if found["value"] is None:
        return f"; no small tilt brings {rise}"
    return f"; {rise} come at {in_words(unit, found['value'])}"


def _tables(numbers) -> list[Table]:
    """The onset beside linear theory; with a floored pressure; over another key."""
    unit, floored = numbers["units"]["forcing"], numbers["floored"] or {}
    names = (
        (unit, "onset", "nonlinear"), (unit, "linear theory", "formula"), ("1", "ratio", "ratio"),
        ("radius", "at radius", "radius"), ("share", "axial opening", "axial_opening"),
        ("1", "largest multiplier", "multiplier"), ("1", "linear over own", "times_own"),
        ("force", "contact at rest", "contact_force"), ("force", "closing force", "closing_force"),
    )  # fmt: skip
    columns, row = [name[:2] for name in names], [numbers.get(key) for *_, key in names]
    if numbers.get("allowed"):
        columns += [(unit, "allowed"), ("share", "more"), ("1", "of")]
        row += [numbers["allowed"][key] for key in ("value", "share", "limit")]
    if numbers.get("not_before"):
        columns, row = [*columns, (unit, "not before")], [*row, numbers["not_before"]]
    if floored:
        columns += [(unit, "with a floor"), ("pressure", "floored at"), ("1", "floored failed")]
        row += [floored.get(key) for key in ("nonlinear", "cavitation_pressure", "failed")]
    tables = [Table("onset", columns, [row])]
    if numbers["curve"]:
        columns = [(numbers["units"]["value"], numbers["over"]), (unit, "linear"), (unit, "nonlinear"),
                   (unit, "with a floor"), ("1", "failed")]  # fmt: skip
        rows = [[row["value"], row.get("formula"), row.get("nonlinear"), row.get("floored", {}).get("nonlinear"),
                 row.get("failed") or row.get("floored", {}).get("failed")] for row in numbers["curve"]]  # fmt: skip
        tables.append(Table("over another key", columns, rows))
    return tables


def _notes(numbers) -> list[str]:
    """Whether the orbit at the onset is one that the seal keeps, and how far orbits were followed."""
    if numbers["nonlinear"] and numbers.get("multiplier") is None:
        return ["Whether the seal keeps the orbit at the onset is not known: the film stores."]
    if (numbers.get("multiplier") or 0.0) > 1.0:
        return ["The orbit at the onset is unstable: the seal leaves it before it touches."]
    if numbers["nonlinear"] is None and numbers.get("path"):
        reached = in_words(numbers["units"]["forcing"], max(numbers["path"]["forcing"]))
        return [f"Orbits were followed to {reached}."]
    return []


def _panels(numbers) -> list[Panel]:
    """The film over the forcing, how the seal lifts, and the onset over another key: those that there are."""
    unit, path, linear = numbers["units"]["forcing"], numbers.get("path"), numbers.get("linear")
    forcing, panels = Axis(unit, numbers["key"]), []
    if numbers["nonlinear"] == 0.0 and numbers.get("closing_force"):
        shares = [numbers["clearance"] / numbers["touch"], numbers["contact_force"] / numbers["closing_force"]]
        words = ["film, of where asperities meet", "asperities, of the closing force"]
        bars = Series("bars", shares, [0, 1], names=[in_words("share", share) for share in shares], style="contact")
        panels.append(Panel("At rest, nothing out of square", Axis("share"), Axis("1", " ", words=words), [bars]))
    if path or linear or (numbers["formula"] and numbers.get("clearance")):
        panels.append(_film_panel(numbers, forcing))
    if path and any(path["axial"]):
        x, opening = _from_rest(numbers, "axial", 0.0)
        levels = [Level(numbers["formula"], "linear onset", True, "theory dashed")]
        if numbers["nonlinear"] is not None:
            levels.append(Level(numbers["nonlinear"], "onset", True, "contact"))
        share = [value / numbers["clearance"] for value in opening]
        panels.append(Panel("The seal lifts: axial opening", forcing, Axis("share", "opening, of the clearance"),
                            [Series("line", x, share, style="blue circle small")], levels))  # fmt: skip
    if numbers["curve"]:
        panels.append(_curve_panel(numbers))
    why = "touching when aligned" if numbers["nonlinear"] == 0.0 else numbers.get("failed") or "at no small tilt"
    return panels or [Panel("Smallest film thickness", note=why)]


def _from_rest(numbers, name: str, start: float) -> tuple[list, list]:
    """Forcing and a column of the path, in the order of the forcing, from where nothing forces."""
    pairs = sorted(zip(numbers["path"]["forcing"], numbers["path"][name], strict=True))
    return [0.0, *(at for at, _ in pairs)], [start, *(value for _, value in pairs)]


def _film_panel(numbers, forcing: Axis) -> Panel:
    """Thinnest film of the nonlinear orbit and of linear theory over the forcing."""
    path, linear, touch = numbers.get("path"), numbers.get("linear"), numbers.get("touch") or 0.0
    formula, clearance, series, levels = numbers["formula"], numbers["clearance"], [], []
    own = linear["own"] if linear else numbers.get("times_own") and formula / numbers["times_own"]
    if path:
        at, films = _from_rest(numbers, "h_min", clearance)
        series.append(Series("line", at, films, label="nonlinear orbit", style="film circle small"))
    if linear:
        x, films = linear["forcing"], linear["h_min"]
    else:
        share = np.r_[0.0, np.geomspace(1e-6, 1.0, 241)]
        x, films = formula * share, clearance * (1.0 - share) + touch * share
    if not linear and not path:
        first = own or 1e-3 * numbers.get("beyond_tilt", formula)
        if formula > APART * first:
            forcing = replace(forcing, scale="log", low=0.3 * first, high=2.0 * formula)
            x, films = x[1:], films[1:]
            if numbers.get("beyond_tilt"):
                levels.append(Level(numbers["beyond_tilt"], "no small tilt", True, "grey", to=2.0 * formula))
    series.append(Series("line", x, films, label="linear theory", style="theory dashed"))
    levels.append(Level(touch, "asperities meet" if touch else "touch", style="contact"))
    levels += [Level(own, "the scenario's own", True, "blue dotted", number=True)] if own else []
    return Panel("Smallest film thickness", forcing, Axis("h_min", "h_min"), series, levels)


def _curve_panel(numbers) -> Panel:
    """The onset over another key; where it was not found a cross on the axis."""
    rows, unit = numbers["curve"], numbers["units"]
    words = any(isinstance(row["value"], str) for row in rows)
    x = Axis("1" if unit["value"] == "SI" else unit["value"], numbers["over"])
    x = replace(x, quantity="1", words=[str(row["value"]) for row in rows]) if words else x
    at = list(range(len(rows))) if words else [row["value"] for row in rows]
    series = []
    for label, style, values in (
        ("nonlinear", "tilt circle", [row.get("nonlinear") for row in rows]),
        ("pressure floored", "fourth open square", [row.get("floored", {}).get("nonlinear") for row in rows]),
        ("linear theory", "theory dashed", [row.get("formula") for row in rows]),
    ):
        if any(value is not None for value in values):
            series.append(Series("line", at, values, label=label, style=style))
    seen = [value for one in series for value in one.y if value]
    lost = [place for place, row in zip(at, rows, strict=True) if "failed" in row or "failed" in row.get("floored", {})]
    if lost:
        foot = [min(seen, default=0.0)] * len(lost)
        series.append(Series("marks", lost, foot, label="an onset was not found", style="contact cross"))
    apart = len(seen) > 1 and max(seen) > APART * min(seen)
    y = Axis(unit["forcing"], f"{numbers['key']} at touch")
    y = replace(y, scale="log") if apart else replace(y, low=0.0)
    return Panel(f"Onset over {numbers['over']}", x, y, series)
