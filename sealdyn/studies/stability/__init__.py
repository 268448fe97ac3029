"""Stability map: growth rate over two scenario values, from eigenvalues; margins; points confirmed in time."""

import math
from dataclasses import dataclass, replace
from functools import partial

import numpy as np
from pydantic import TypeAdapter, ValidationError
from scipy.ndimage import distance_transform_cdt

from ... import closed_form as cf
from ...analysis.rotating_wave import free_model
from ...analysis.whirl_in_time import growth_rate, pace
from ...answers import Answer, Axis, Level, Panel, Series, Table, table_of
from ...dynamics import modes
from ...dynamics.linearisation import moves_with_speed
from ...dynamics.model import Model
from ...dynamics.run_state import RunState
from ...quantities import in_words
from ...scenario.errors import ScenarioError, nearest_of
from ...scenario.keys import tables as keys_of_tables
from ...scenario.reader import with_values
from ...scenario.settings import axis
from ...scenario.tables import kind_of_scene
from ...scene.excitation import Housing, Shaft
from ...scene.patterns import grooves_of
from ...scene.scene import SceneError, arrangement, frozen_at_start, part
from ...simulation.selection import choose_method
from ...simulation.stability import critical_speed, speeds_held, whirl_ratio
from ...units import quantity_of
from .. import Info
from .grid import INERTIA_RATIO, Grid

INFO = Info(
    timed=("fmr_reference", 4),
    asks="Where does the seal whirl by itself?",
    grooved=True,
    refuses=("secondary-seal",),
    units={**dict.fromkeys(("growth_rate", "tilt_growth_rate", "time_domain", "uncertainty"), "1/s"), "turns": "1"},
    along=dict.fromkeys(("growth_rate", "tilt_growth_rate"), ("axes/y", "axes/x")),
)
# A run in time lasts until a small disturbance has grown by this much (e-folds), or decayed; turns as `pace` counts.
GROWN, DECAYED, FEWEST, MOST = 1.5, 4.0, 4.0, 600.0
# Values to an axis over grooves.
FEW = 9
# Accuracy of those runs, and the share of the eigenvalues' growth rate by which theirs may differ beside their doubt.
ACCURACY, SHARE = 1e-7, 0.01


@dataclass(frozen=True)
class Settings:
    """The map."""

    x: str | None = None
    """"key=from:to:count" with any scenario key (SI or with units) or `inertia_ratio` (transverse over polar,
    transverse kept), ":log" at its end for even ratios, or "key=a,b,c"; without it the shaft speed."""
    y: str | None = None
    """As `x`; without it the inertia ratio where a ring spins, else the damping of the support."""
    confirm: int = 4
    """How many points beside the threshold are confirmed in the time domain."""


def run(scenario, settings, tools) -> Answer:
    """Map, margins at the scenario's own values, and confirmed points."""
    scene = frozen_at_start(scenario.scene)
    grooved = bool(grooves_of(scene)[1])
    wanted = (settings.x or _default_x(scene), settings.y or _default_y(scene, FEW if grooved else 141))
    axes = [si_axis(scenario, words, name) for name, words in zip("xy", wanted, strict=True)]
    if axes[0]["key"] == axes[1]["key"]:
        raise ScenarioError(scenario.name, "study.stability.y", axes[1]["key"], "another key than x has")
    try:
        if grooved:
            total, tilt = _over_grooves(scenario, axes, tools)
        else:
            grid = Grid(scenario, {a["key"]: np.array(a["values"]) for a in axes})
            total, tilt = _one_by_one(scenario, axes, tools) if grid.model.interface.stores else grid.rates()
    except SceneError as error:
        raise ScenarioError(scenario.name, error.key, error.found, error.expected) from None
    tools.say(0.3)
    for a in axes:
        a["here"] = _here(scene, a["key"])
    numbers = {
        "axes": dict(zip("xy", axes, strict=True)),
        "growth_rate": _listed(total),
        "tilt_growth_rate": _listed(tilt),
        "margins": margins(scene, tools),
        "unconditional": unconditional(scene),
        # A turn over grooves takes its time.
        "confirmed": _confirmed(scenario, axes, tilt, 0 if grooved else settings.confirm, tools),
        "units": {f"confirmed/{name}": a["unit"] for name, a in zip("xy", axes, strict=True)},
    }
    found = _found(numbers["margins"], scenario.name)
    return Answer(numbers, found, _tables(numbers, total), [_panel(numbers)], _notes(scenario, axes, total))


def si_axis(scenario, words: str, name: str) -> dict:
    """An axis of the map with its values in SI and its key known to hold numbers."""
    where = f"study.stability.{name}"
    found = axis(words, scenario.name, where)
    key, written = found["key"], found["values"]
    holds, unit = _held_by(scenario, where, key)
    in_order = sorted(written) in (written, written[::-1])
    if not 2 <= len(written) <= 100_000 or len(set(written)) < len(written) or not in_order:
        raise ScenarioError(scenario.name, where, f'"{words}"', "2 to 100000 different values, rising or falling")
    ends = [_value(scenario, where, key, holds, text) for text in (found["given"][0], found["given"][-1])]
    if key == INERTIA_RATIO and min(ends) <= 0:
        raise ScenarioError(scenario.name, where, f'"{words}"', "values above zero")
    # The unit is one for all: what turns the ends into SI turns every value.
    shares = (np.array(written) - written[0]) / (written[-1] - written[0])
    values = ends[0] + (ends[1] - ends[0]) * shares
    return {"key": key, "unit": unit, "values": values.tolist()}


def _held_by(scenario, where, key):
    """What a key holds, as a type, and its SI unit; refuses keys that are none."""
    if key == INERTIA_RATIO:
        return float, "1"
    table, _, leaf = key.rpartition(".")
    tables = keys_of_tables(kind_of_scene(scenario.scene))
    holds = tables.get(table, {}).get(leaf)
    if holds is None or table in ("run", "study", ""):
        known = [f"{t}.{k}" for t, keys in tables.items() for k in keys if t not in ("run", "")]
        hint = nearest_of(key, [*known, INERTIA_RATIO])
        raise ScenarioError(scenario.name, where, f'"{key}"', f"a scenario key or {INERTIA_RATIO}{hint}")
    if ".body." in key:
        raise ScenarioError(scenario.name, where, f'"{key}"', "mass or an inertia, which follow from the body")
    held = quantity_of(holds)
    return holds, held.unit if held else "1"


def _value(scenario, where, key, holds, text) -> float:
    try:
        return float(TypeAdapter(holds).validate_python(_number(text)))
    except (ValidationError, TypeError, ValueError) as error:
        said = error.errors()[0].get("ctx", {}).get("error") if isinstance(error, ValidationError) else None
        expected = getattr(said, "expected", f"a value of {key}")
        raise ScenarioError(scenario.name, where, f'"{text}"', expected) from None


def _number(text: str):
    try:
        return float(text)
    except ValueError:
        return text


def _default_x(scene) -> str:
    """From a tenth to fifteen times the scene's speed, or as far as the threshold where that is above; to three times
    the speed where there is none and no ring spins, whose inertia ratio would bring one."""
    speed = abs(scene.shaft.speed) or 1000.0
    if grooves_of(scene)[1]:
        return f"shaft.speed={0.3 * speed}:{3 * speed}:{FEW}"
    critical = critical_speed(Model(scene))
    if critical and critical > 14 * speed:
        return f"shaft.speed={speed / 10}:{2 * critical}:240:log"
    return f"shaft.speed={speed / 10}:{(15 if critical or _spins(scene) else 3) * speed}:240"


def _spins(scene) -> bool:
    """Whether a ring that floats turns."""
    return bool(scene.rotor.support and scene.rotor.transverse_inertia > 0)


def _default_y(scene, count: int) -> str:
    """The inertia ratio where a ring spins; a stator's ratio does nothing, its support's damping does."""
    if _spins(scene):
        return f"{INERTIA_RATIO}=0.5:4:{count}"
    ring, support = ("rotor", scene.rotor.support) if scene.rotor.support else ("stator", scene.stator.support)
    name = "axial_damping" if support.radius is not None else "tilt_damping"
    present = getattr(support, name) or 0.0
    return f"{ring}.support.{name}=0:{4 * present or 1.0}:{count}"


def _here(scene, key: str) -> float | None:
    """The scenario's own value of an axis."""
    if key == INERTIA_RATIO:
        ring = scene.rotor if scene.rotor.support else scene.stator
        return ring.transverse_inertia / ring.polar_inertia if ring.polar_inertia else None
    try:
        value = part(scene, key)
    except (AttributeError, IndexError, ValueError):
        return None
    return float(value) if isinstance(value, int | float) else None


def _listed(rates) -> list:
    return [[float(v) if np.isfinite(v) else None for v in row] for row in rates]


def _one_by_one(scenario, axes, tools) -> tuple[np.ndarray, np.ndarray]:
    """Growth rates (y, x) of all degrees of freedom and of the tilts, each scene made anew: a film that stores has no
    one stiffness and damping for the formulas of the grid."""
    x, y = axes
    points = [{"values": {x["key"]: a, y["key"]: b}} for b in y["values"] for a in x["values"]]
    rows = tools.map(partial(rates_of, scenario), points, "map")
    found = np.array([[row.get(name, np.nan) for row in rows] for name in ("total", "tilt")])
    return tuple(found.reshape(2, len(y["values"]), len(x["values"])))


def _over_grooves(scenario, axes, tools) -> tuple[np.ndarray, np.ndarray]:
    """The same by the roots of the rings on the film of one pitch, a column of the map at a time: what one film has."""
    x, y = axes
    points = [{"x": (x["key"], a), "y": (y["key"], y["values"])} for a in x["values"]]
    rows = tools.map(partial(_column_over_grooves, scenario), points, "map")
    nothing = [math.nan] * len(y["values"])
    return tuple(np.array([row.get(name, nothing) for row in rows], float).T for name in ("total", "tilt"))


def _column_over_grooves(scenario, point: dict) -> dict:
    from .._grooved_roots import growth_rates

    (x, a), (y, values) = point["x"], point["y"]
    scenes = [
        frozen_at_start(with_values(scenario, _scenario_keys(scenario.scene, {x: a, y: b})).scene) for b in values
    ]
    total, tilt = zip(*growth_rates(scenes), strict=True)
    return {"total": list(total), "tilt": list(tilt)}


def rates_of(scenario, point: dict) -> dict:
    """Growth rates (1/s) of one point of the map: `total` of all modes, `tilt` of the tilt modes."""
    found = Model(_scene_at(scenario, point["values"])).linear_scene().modes()
    return {"total": modes.growth(found), "tilt": modes.growth([mode for mode in found if mode.kind == "tilt"])}


# --- at the scenario's own values ---------------------------------------------------------------------


def margins(scene, tools) -> dict:
    """Growth rate, whirl ratio and critical speed at the scenario's own values, and how far off the threshold is."""
    if grooves_of(scene)[1]:
        from .._grooved_roots import margins_over_grooves

        return margins_over_grooves(scene, tools)
    model = Model(scene)
    found, speed = model.linear_scene().modes(), scene.shaft.speed
    critical = critical_speed(model)
    return {
        "verdict": modes.verdict(found),
        "growth_rate": found[0].value.real,
        "least_damped": found[0].kind,
        "growth_rate_uncertainty": modes.uncertainty(found),
        "whirl_ratio": whirl_ratio(found, speed),
        "critical_speed": critical,
        "speeds_held": speeds_held(model),
        "speed_margin": critical / abs(speed) if critical and speed else None,
    }


def unconditional(scene) -> dict:
    """The inertia ratio up to which a flexible rotor is stable at every speed, `c <= 1/nu`; None for other seals, and
    for a film that stores or changes with the speed, of which there is no such formula."""
    nothing = {"limit": None, "inertia_ratio": None, "holds": None}
    if grooves_of(scene)[1]:
        return nothing
    model = Model(scene)
    if arrangement(scene) != "FMR" or model.interface.stores or moves_with_speed(scene):
        return nothing
    damping = scene.rotor.support.tilt()[1]
    stiffness, film_damping = model.film_matrices()
    if damping + film_damping[1, 1] <= 0 or scene.rotor.support.tilt()[0] + stiffness[1, 1] <= 0:
        return nothing
    limit = cf.unconditional_inertia_ratio(support_damping=damping, film_damping=film_damping[1, 1])
    ratio = _here(scene, INERTIA_RATIO)
    return {"limit": float(limit), "inertia_ratio": ratio, "holds": bool(ratio is not None and ratio <= limit)}


# --- in the time domain -------------------------------------------------------------------------------


def _confirmed(scenario, axes, tilt, count, tools) -> list[dict]:
    """Points on both sides of the threshold (of the least damped, if there is none), run in time."""
    chosen = _beside_threshold(tilt, count)
    x, y = axes
    points = [{"x": x["values"][i], "y": y["values"][j], "growth_rate": float(tilt[j, i])} for j, i in chosen]
    points = [{**point, "values": {x["key"]: point["x"], y["key"]: point["y"]}} for point in points]
    return tools.map(partial(confirmed, scenario), points, "confirm", ("x", "y", "growth_rate"))


def _beside_threshold(tilt, count) -> list[tuple[int, int]]:
    """Grid places (row, column) next to a change of sign, in pairs spread over the map."""
    signs = np.sign(np.nan_to_num(tilt))
    rows, columns = np.nonzero(signs[:, 1:] * signs[:, :-1] < 0)
    if len(rows) == 0:
        if not np.isfinite(tilt).any():
            return []
        order = np.argsort(np.where(np.isfinite(tilt), np.abs(tilt), np.inf), axis=None)[: min(1, count)]
        return [tuple(int(k) for k in np.unravel_index(at, tilt.shape)) for at in order]
    picked = np.unique(np.linspace(0, len(rows) - 1, max(1, count // 2) + 2).astype(int)[1:-1])
    return [(int(rows[k]), int(columns[k]) + side) for k in picked for side in (0, 1)][:count]


def confirmed(scenario, point: dict) -> dict:
    """Growth rate of the least damped tilt mode in the time domain at one point of the map, nothing imposed; it
    `agrees` with that of the eigenvalues if the sign is the same and the difference within what either may err."""
    scene = _scene_at(scenario, point["values"])
    scene = replace(
        scene,
        shaft=Shaft(scene.shaft.speed),
        housing=Housing(),
        rotor=replace(scene.rotor, misalignment=0.0, runout=0.0, axial_runout=[]),
        stator=replace(scene.stator, misalignment=0.0),
    )
    model, speed, rate = Model(scene), scene.shaft.speed, point["growth_rate"]
    scene = frozen_at_start(model.scene, clearance=model.clearance)
    if rate == 0.0 or speed == 0.0:
        raise ValueError("neutral, or a shaft at rest: nothing to measure")
    length = (GROWN if rate > 0 else DECAYED) / abs(rate)
    turns = min(max(length * pace(free_model(scene, speed), speed) / (2 * math.pi), FEWEST), MOST)
    if rate > 0 and turns == FEWEST:
        raise ValueError("grows too fast to be followed")
    found = growth_rate(scene, speed, turns, choose_method(RunState(model, 1.0))[0], ACCURACY)
    measured, doubt = found["rate"], found["uncertainty"]
    agrees = measured * rate > 0 and abs(measured - rate) <= 3 * doubt + SHARE * abs(rate)
    return {"time_domain": measured, "uncertainty": doubt, "turns": turns, "agrees": bool(agrees)}


def _scene_at(scenario, values: dict):
    """The scene with values of both axes."""
    keys = _scenario_keys(scenario.scene, values)
    return frozen_at_start(with_values(scenario, {**keys, "run.start": "steady"}).scene)


def _scenario_keys(scene, values: dict) -> dict:
    """Axis values as keys of a scenario."""
    found = {key: value for key, value in values.items() if key != INERTIA_RATIO}
    for ring, body in (("stator", scene.stator), ("rotor", scene.rotor)):
        if INERTIA_RATIO in values and body.support:
            inertia = values.get(f"{ring}.transverse_inertia", body.transverse_inertia)
            found[f"{ring}.polar_inertia"] = min(inertia / values[INERTIA_RATIO], 2 * inertia)
    return found


# --- what is shown -----------------------------------------------------------------------------------------


def _found(margin, name: str) -> str:
    """Whether the seal itself is stable, and how far off its threshold is."""
    known = f" +- {margin['growth_rate_uncertainty']:.1g}" if margin["verdict"] == "neutral" else ""
    itself = f"{name} is {margin['verdict']}, growth rate {margin['growth_rate']:.5g}{known} 1/s"
    if not margin["critical_speed"]:
        held = margin["speeds_held"]
        ends = f" up to {in_words('speed', held[1])}, beyond which no film holds the closing force" if held else ""
        return f"{itself}; no critical speed{ends}."
    times = f", {margin['speed_margin']:.3g} times its own" if margin["speed_margin"] else ""
    return f"{itself}; critical speed {in_words('speed', margin['critical_speed'], digits=5)}{times}."


def _tables(numbers, total) -> list[Table]:
    """Margins at the scenario's own values, shares of the map, and the points run in time."""
    margin, limit, (x, y) = numbers["margins"], numbers["unconditional"], numbers["axes"].values()
    possible = np.isfinite(total)
    share = (
        [float(np.mean(total[possible] < 0)), float(np.mean(total[possible] == 0))] if possible.any() else [None] * 2
    )
    own = [margin["verdict"], margin["growth_rate"], margin["least_damped"], margin["whirl_ratio"],
           margin["critical_speed"], limit["limit"], limit["inertia_ratio"], *share]  # fmt: skip
    names = [("1", "verdict"), ("growth_rate", "growth rate"), ("1", "of the motion"), ("1", "whirl ratio"),
             ("speed", "critical speed"), ("1", "stable at every speed to inertia ratio"), ("1", "its own"),
             ("share", "map stable"), ("share", "neutral")]  # fmt: skip
    columns = [(x["unit"], x["key"], "x"), (y["unit"], y["key"], "y"), ("growth_rate", "eigenvalues", "growth_rate"),
               ("growth_rate", "in time", "time_domain"), ("growth_rate", "+-", "uncertainty"),
               ("1", "agrees", "agrees"), ("1", "not confirmed", "failed")]  # fmt: skip
    return [Table("margins", names, [own]), table_of("confirmed in time", columns, numbers["confirmed"])]


def _notes(scenario, axes, total) -> list[str]:
    """What the map keeps, and which of its points cannot be."""
    notes, possible = [], np.isfinite(total)
    if moves_with_speed(scenario.scene) and scenario.scene.film.clearance is not None:
        notes.append(
            "The critical speed keeps the closing force, and the gap follows the speed; the map keeps the gap."
        )
    if not possible.all():
        notes.append(f"{np.sum(~possible)} points cannot be scenes{_reason(scenario, axes, possible)}")
    return notes


def _panel(numbers) -> Panel:
    """The map of growth rates, the threshold, the scenario itself, and points confirmed in time."""
    x, y = numbers["axes"].values()
    tilt, every = numbers["tilt_growth_rate"], numbers["growth_rate"]
    rates, total = np.array(tilt, float), np.array(every, float)
    if not np.isfinite(rates).any():
        return Panel("Growth rate", note="no possible scene on this map")
    series = [
        Series("map", x["values"], y["values"], tilt),
        Series("contour", x["values"], y["values"], every, label="threshold (eigenvalues)", style="black thick"),
    ]
    axial = (total > 0) & (rates <= 0)
    if axial.any():
        j, i = (int(np.median(at)) for at in np.nonzero(axial))
        series.append(Series("words", [x["values"][i]], [y["values"][j]], names=["axially unstable"], style="black"))
    for word, region in (("stable", total < 0), ("unstable", total > 0)):
        if np.mean(region) >= 0.03:
            # Steps from each cell to the edge of its region; the map's edge counts.
            depth = distance_transform_cdt(np.pad(region, 1), "taxicab")[1:-1, 1:-1]
            inner = np.argwhere(depth == depth.max())
            j, i = inner[len(inner) // 2]
            series.append(Series("words", [x["values"][i]], [y["values"][j]], names=[word], style="black"))
    here = [a["here"] for a in (x, y)]
    if all(at is not None and min(a["values"]) <= at <= max(a["values"]) for at, a in zip(here, (x, y), strict=True)):
        series.append(Series("marks", here[:1], here[1:], label="this scenario", style="fifth star large front"))
    for words, style, kind in (
        ("grows in the time domain", "black open triangle front", True),
        ("decays in the time domain", "black open down front", False),
        ("not confirmed", "bad cross front", None),
    ):
        points = [p for p in numbers["confirmed"] if (None if "failed" in p else p["time_domain"] > 0) is kind]
        if points:
            at = [[p[name] for p in points] for name in ("x", "y")]
            series.append(Series("marks", *at, label=words, style=style))
    limit, levels = numbers["unconditional"]["limit"], []
    for a, upright in ((x, True), (y, False)):
        if a["key"] == INERTIA_RATIO and limit and min(a["values"]) < limit < max(a["values"]):
            levels.append(Level(limit, "stable at every speed up to 1/nu =", upright, "bad dashed", number=True))
    colour = Axis("growth_rate", "growth rate of the least damped tilt mode", "asinh")
    return Panel("Growth rate over the map", _axis(x), _axis(y), series, levels, colour=colour, tall=1.2)


def _axis(a: dict) -> Axis:
    """An axis of the map: logarithmic where its values are spread evenly in ratio."""
    values = np.array(a["values"])
    even = len(values) < 3 or np.any(values <= 0) or np.allclose(np.diff(values), values[1] - values[0])
    label = "inertia ratio c = I/J (transverse over polar)" if a["key"] == INERTIA_RATIO else a["key"]
    return Axis(a["unit"], label, "linear" if even else "log")


def _reason(scenario, axes, possible) -> str:
    """Why the first impossible point is."""
    j, i = np.argwhere(~possible)[0]
    values = {axes[0]["key"]: axes[0]["values"][i], axes[1]["key"]: axes[1]["values"][j]}
    try:
        Model(_scene_at(scenario, values), 1.0)
    except (ScenarioError, SceneError) as error:
        return f", for instance: {error}"
    return "."
