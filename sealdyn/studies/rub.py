"""Rub: the seal driven past contact onset; bifurcation diagram, exponent, sections, spectra; what can be foretold.

Each point of the diagram starts from the last one's end.  Where the motion is chaotic, averages replace trajectories:
two methods that share neither integrator nor differencing must agree on them.
"""

import time as clock
from dataclasses import dataclass
from functools import partial

import numpy as np

from ..analysis.poincare_map import (
    SAMPLES,
    FilmCollapsed,
    PeriodMap,
    frozen_at_end,
    neighbours,
    share_below,
    sweep_branch,
)
from ..analysis.rotating_wave import free_model
from ..analysis.whirl_in_time import whirl_fate
from ..answers import CYCLE, Answer, Axis, Level, Panel, Series, Table, table_of
from ..numerics import time_series
from ..numerics.piecewise_linear import initially
from ..numerics.time_series import horizon, tangent_product
from ..quantities import in_words
from ..scenario.errors import ScenarioError
from ..scenario.settings import si_unit, values_in_si
from ..scene.forces import contact_thresholds
from ..scene.scene import part, with_values
from ..simulation.stability import critical_speed
from ..status import Status
from ..units import Speed
from . import Info
from .critical_speed import at_point

# Speeds, relative to the critical one, at which a whirl is let go.
ABOVE = (1.02, 1.1, 1.3)
INFO = Info(
    timed=("rub_chaotic", 82),
    asks="How does the seal rub?",
    warm="The temperature is that of the aligned film, whatever heat the rub makes.",
    units={
        "apart": "of clearance/outer radius", "h_min": "m", "impulse": "N*s", "wall_time": "s", "speed": "rad/s",
        "end": "SI", "rows/lines/between": "1",
        **dict.fromkeys(("section", "amplitude", "amplitudes", "from"), "rad"),
        **dict.fromkeys((f"rows/lines/{order}" for order in ("0.5", "1", "1.5", "2", "3", "4")), "rad"),
        **dict.fromkeys(("contact_power", "friction_power"), "W"),
        **{f"{name}/{what}": unit for what in ("values", "uncertainties") for name, unit in (
            *((f"h_min_{n}", "m") for n in ("mean", "std", "median", "q05", "q95")),
            *((f"section_{n}", "rad") for n in ("x_mean", "y_mean", "x_std", "y_std")), ("impulse", "N*s"))},
        **dict.fromkeys(("period", "distinct", "contacts", "contact_share", "contact_force", "exponent", "uncertainty",
                         "multiplier", "orders", "evaluations", "first_contact", "turns", "whirl_ratio", "values",
                         "uncertainties", "spectrum", "accuracies"), "1"),
    },
    along={
        "rows": ("value",), "rows/section": ("rows/kept",), "rows/h_min": ("rows/kept",),
        "rows/orders": ("rows/line",), "rows/amplitude": ("rows/line",), "separation/apart": ("separation/period",),
        "whirl/rows": ("speed",), "whirl/rows/amplitudes": ("whirl/rows/turn",),
    },
)  # fmt: skip

# Names of keys on the axis.
NAMES = {"rotor.runout": "runout of the rotor", "stator.misalignment": "misalignment of the stator",
         "rotor.misalignment": "misalignment of the rotor", "shaft.speed": "shaft speed"}  # fmt: skip
CLASSES = {"chaotic": "second", "quasi-periodic": "fourth", "no contact": "grey", "settling": "sixth",
           "undecided": "fifth"}  # fmt: skip
DIRECTION = {"up": ("first", "growing"), "down": ("fifth", "falling")}
# Values of the key up to which the diagram has large points, and points of it shown one by one.
FEW, MOST = 30, 3


@dataclass(frozen=True)
class Settings:
    """The path, and what is looked at along it."""

    key: str | None = None
    """Key that grows; without it rotor.runout of a seal with a flexible stator, else stator.misalignment."""
    values: str | None = None
    """Its values, "from:to:count" in any unit; without them 0.6 to 1.2 times the scenario's."""
    down: bool = False
    """Also back again."""
    ramp: int = 15
    """Periods that lead to each value."""
    drop: int = 80
    """Periods that pass before any counts."""
    keep: int = 96
    """Periods that count."""
    exponent_turns: int = 200
    """Periods for the exponent."""
    judge: float | str | None = None
    """Value at which two methods are compared; without it where the exponent is largest."""
    judge_turns: int = 600
    """Periods of that comparison (0: none)."""
    accuracy: float = 1e-6
    """Accuracy of the runs."""
    whirl: bool = False
    """Also where a small whirl of the unforced seal settles."""
    whirl_speeds: tuple[Speed, ...] = ()
    """Speeds of that; empty: 1.02, 1.1 and 1.3 of the critical speed."""


def run(scenario, settings, tools) -> Answer:
    """Diagram, judgement where it is needed, and the fate of whirl if asked."""
    if scenario.scene.contact is None:
        raise ScenarioError(scenario.name, "contact", "nothing", "a [contact] table: there is no rub without")
    key = settings.key or ("rotor.runout" if scenario.scene.stator.support else "stator.misalignment")
    try:
        unit = si_unit(scenario.scene, key)
    except (AttributeError, KeyError):
        raise ScenarioError(scenario.name, "study.rub.key", f'"{key}"', "a quantity of the scene") from None
    values = _values(scenario, key, unit, settings)
    base = {"key": key, "ramp": settings.ramp, "drop": settings.drop, "keep": settings.keep,
            "exponent_turns": settings.exponent_turns, "accuracy": settings.accuracy}  # fmt: skip
    chains = [{**base, "direction": "up", "values": values}]
    if settings.down:
        chains.append({**base, "direction": "down", "values": values[::-1]})
    found = tools.map(partial(sweep_branch, scenario.scene), chains, "chain")
    failed = [row["failed"] for row in found if "failed" in row]
    rows = [row for part in found for row in part.get("rows", [])]
    numbers = {"key": key, "touch": touch_level(scenario.scene), "rows": rows, "reason": failed}
    numbers["units"] = {"rows/value": unit}
    numbers |= _judged(base, rows, settings, scenario, tools)
    numbers["whirl"] = _whirled(scenario, settings, tools) if settings.whirl else None
    if not any(row["status"] == Status.OK for row in rows):
        numbers["status"] = Status.FAILED
    return Answer(numbers, _found(numbers), _tables(numbers), _panels(numbers), failed)


def _values(scenario, key, unit, settings) -> list[float]:
    """The points in SI."""
    where = "study.rub.values"
    if settings.values is None:
        own = float(part(frozen_at_end(scenario.scene), key))
        if own == 0.0:
            raise ScenarioError(scenario.name, where, "nothing", f'"from:to:count", since {key} is zero')
        return [float(f"{v:.6g}") for v in np.linspace(0.6 * own, 1.2 * own, 13)]
    # Not by way of a scenario: its start need not be possible, a ramp leads there.
    return values_in_si(scenario, settings.values, unit, where)


# --- what can be foretold ---------------------------------------------------------------------------------


def _judged(base, rows, settings, scenario, tools) -> dict:
    """Two methods' averages, and how two correct runs part, at one point of the diagram."""
    good = [row for row in rows if row["status"] == Status.OK and row["contact_share"] > 0]
    nothing = {"judge": None, "methods": None, "separation": None}
    if not good or not settings.judge_turns:
        return nothing
    if settings.judge is None:
        row = max(good, key=lambda row: row["exponent"] - row["uncertainty"])
    else:
        unit = si_unit(scenario.scene, base["key"])
        (wanted,) = values_in_si(scenario, str(settings.judge), unit, "study.rub.judge")
        row = min(good, key=lambda row: abs(row["value"] - wanted))
    point = {**base, "value": row["value"], "start": row["end"], "turns": settings.judge_turns}
    methods = [{**point, "method": m} for m in ("adams", "dop853", "both")]
    found = tools.map(partial(evaluate_point, scenario.scene), methods, "judge")
    if any("failed" in part for part in found):
        return {**nothing, "judge": {"value": row["value"], "failed": [p["failed"] for p in found if "failed" in p]}}
    one, other, separation = found
    compared = time_series.compared(one["averages"], other["averages"], one["floors"])
    return {
        "judge": {"value": row["value"], "class": row["class"], "turns": settings.judge_turns,
                  "agree": all(entry["agree"] for entry in compared.values())},
        "methods": {"names": ["adams", "dop853"], "invariants": compared, "spectrum": other["spectrum"],
                    "wall_time": [one["wall_time"], other["wall_time"]]},
        "separation": separation,
    }  # fmt: skip


# --- whirl above the critical speed -----------------------------------------------------------------------


def _whirled(scenario, settings, tools) -> dict:
    """Where a small whirl of the unforced seal settles."""
    model = free_model(frozen_at_end(scenario.scene), initially(scenario.scene.shaft.speed))
    critical = critical_speed(model)
    if critical is None and not settings.whirl_speeds:
        return {"critical_speed": None, "rows": []}
    speeds = list(settings.whirl_speeds) or [float(f"{f * critical:.6g}") for f in ABOVE]
    points = [{"speed": w, "accuracy": settings.accuracy} for w in speeds]
    fate = partial(at_point, whirl_fate, frozen_at_end(scenario.scene))
    return {"critical_speed": critical, "rows": tools.map(fate, points, "whirl", ("speed",))}


# --- what is shown ------------------------------------------------------------------------------------------


def _found(numbers) -> str:
    """The motion along the path: where its kind changes."""
    rows, unit = [row for row in numbers["rows"] if row["direction"] == "up"], _unit(numbers)
    if not rows:
        return "No point of the diagram was reached."
    last = [k + 1 == len(rows) or rows[k + 1]["class"] != row["class"] for k, row in enumerate(rows)]
    ends = [f"{row['class']} to {in_words(unit, row['value'])}" for row, end in zip(rows, last, strict=True) if end]
    return f"As {numbers['key']} grows: {', '.join(ends)}."


def _unit(numbers) -> str:
    """SI unit of the key, "1" of a pure number."""
    unit = numbers["units"]["rows/value"]
    return "1" if unit == "SI" else unit


def _tables(numbers) -> list[Table]:
    """Points of the diagram, two methods at one of them, and the whirls let go."""
    names = (("1", "going", "direction"), (_unit(numbers), numbers["key"], "value"), ("1", "motion", "class"),
             ("share", "contact, of time", "contact_share"), ("share", "of closing force", "contact_force"),
             ("1", "exponent per period", "exponent"), ("1", "+-", "uncertainty"),
             ("1", "evaluations per turn", "evaluations"))  # fmt: skip
    tables = [table_of("diagram", names, numbers["rows"])]
    if numbers["methods"]:
        entries, (one, other) = numbers["methods"]["invariants"], numbers["methods"]["names"]
        columns = [("1", "average"), ("1", one), ("1", "+-"), ("1", other), ("1", "+-"), ("1", "agree")]
        rows = [[name, e["values"][0], e["uncertainties"][0], e["values"][1], e["uncertainties"][1], e["agree"]]
                for name, e in entries.items()]  # fmt: skip
        tables.append(Table("two methods", columns, rows))
        exponent, apart = entries["exponent"], numbers["separation"]
        if min(v - u for v, u in zip(exponent["values"], exponent["uncertainties"], strict=True)) > 0:
            ends = max(*apart["apart"][1:6], 1e-16), max(apart["spread"], 1e-16)
            far = horizon(0.5 * sum(exponent["values"]), *ends)
            tables.append(Table("chaos", [("1", "periods that can be foretold")], [[far]]))
    if numbers["whirl"]:
        names = (
            ("speed", "speed", "speed"),
            ("1", "whirl", "fate"),
            ("1", "turns", "turns"),
            ("1", "first touch, turns", "first_contact"),
            ("1", "whirl ratio", "whirl_ratio"),
            ("share", "contact, of time", "contact_share"),
            ("share", "of closing force", "contact_force"),
        )
        tables.append(table_of("whirl", names, numbers["whirl"]["rows"]))
    return tables


def _panels(answer) -> list[Panel]:
    """Bifurcation diagram over the key, the exponent below it, sections and spectra at chosen points, and what two
    correct runs make of the same start."""
    rows = [row for row in answer["rows"] if row["status"] == Status.OK]
    along = Axis(_unit(answer), NAMES.get(answer["key"], answer["key"]))
    panels = [_diagram(along, answer, rows), _exponents(along, answer, rows)]
    for k, row in enumerate(_chosen(rows, answer)):
        value = in_words(along.quantity, row["value"])
        panels += [_section(row, f"{value}: {row['class']}", first=k == 0), _spectrum(row)]
    panels += [_separation(answer)] if answer["separation"] else []
    panels += [_averages(answer)] if answer["methods"] else []
    return panels + ([_whirl(answer)] if (answer["whirl"] or {}).get("rows") else [])


def _style(row) -> str:
    return CLASSES.get(row["class"], "good")


def _aside(answer) -> dict:
    """How far the two directions are drawn beside their value, so that neither hides the other."""
    values = np.unique([row["value"] for row in answer["rows"]])
    both = len({row["direction"] for row in answer["rows"]}) > 1 and len(values) > 1
    step = 0.1 * float(np.min(np.diff(values))) if both else 0.0
    return {"up": -step, "down": step}


def _diagram(along, answer, rows) -> Panel:
    """Smallest film of every turn kept, over the key."""
    aside, series = _aside(answer), []
    sides = {"up": " (left of its value)", "down": " (right)"} if aside["down"] else {"up": "", "down": ""}
    for direction, (colour, label) in DIRECTION.items():
        mine = [row for row in rows if row["direction"] == direction]
        if mine:
            x = np.concatenate([np.full(len(r["h_min"]), r["value"] + aside[direction]) for r in mine])
            style = f"{colour} point{' small' if len(mine) > FEW else ''}"
            films = np.concatenate([r["h_min"] for r in mine])
            series.append(Series("marks", x, films, label=label + sides[direction], style=style))
    lost = [row["value"] for row in answer["rows"] if row["status"] != Status.OK]
    if lost:
        series.append(Series("marks", lost, [0.0] * len(lost), label="crushed: no motion", style="black cross front"))
    level = Level(answer["touch"], "asperities meet", style="contact dashed", number=True)
    return Panel("Smallest film of each turn", along, Axis("h_min", "smallest film"), series, [level])


def _exponents(along, answer, rows) -> Panel:
    aside, series = _aside(answer), []
    for row in rows:
        mark = "circle" if row["direction"] == "up" else "square open"
        label = row["class"] if row["class"] in CLASSES else "period n"
        series.append(Series("marks", [row["value"] + aside[row["direction"]]], [row["exponent"]], label=label,
                             style=f"{_style(row)} {mark} small", error=[row["uncertainty"]]))  # fmt: skip
    axis, zero = Axis("1", "exponent a period"), Level(0.0, style="black")
    return Panel("Largest Lyapunov exponent", along, axis, series, [zero], below=True, tall=0.7)


def _separation(answer) -> Panel:
    apart, size = np.maximum(answer["separation"]["apart"], 1e-12), answer["separation"]["spread"]
    levels = [Level(size, "size of the attractor", legend=True)] if size > 1e-3 else []
    lost = answer["separation"]["lost"]
    if lost is not None:
        levels.append(Level(lost, upright=True, to=len(apart), style="contact"))
    title = "Two correct runs" + (" part" if lost is not None else "")
    y = Axis("1", "apart, tilt scales", scale="log", high=100 * max(size, apart.max()))
    line = Series("line", np.arange(len(apart)), apart, style="first thin")
    return Panel(title, Axis("1", "periods", low=0, high=len(apart)), y, [line], levels, first=True)


def _averages(answer) -> Panel:
    """Difference of the two methods over the uncertainty of it."""
    marks, names = {"good": [], "bad": []}, list(answer["methods"]["invariants"])
    for k, entry in enumerate(answer["methods"]["invariants"].values()):
        a, b = entry["values"]
        size = entry["allowed"] if entry["allowed"] > 0 else np.inf
        marks["good" if entry["agree"] else "bad"].append((float(np.clip((b - a) / size, -1.9, 1.9)), k))
    series = [Series("marks", *zip(*held, strict=True), style=f"{c} circle small") for c, held in marks.items() if held]
    levels = [Level(-1, upright=True, to=1, style="good"), Level(0, upright=True, style="black")]
    words = Axis("1", " ", words=[name.replace("_", " ") for name in names])
    along = Axis("1", "DOP853 − Adams, in uncertainties", low=-2, high=2)
    title = "Averages agree" if answer["judge"]["agree"] else "Averages"
    return Panel(title, along, words, series, levels, down=True, first=not answer["separation"])


def _whirl(answer) -> Panel:
    series = []
    for k, row in enumerate(row for row in answer["whirl"]["rows"] if "amplitudes" in row):
        words, colour = f"{in_words('speed', row['speed'], 5)}: {row['fate']}", CYCLE[k % len(CYCLE)]
        turns = np.arange(len(row["amplitudes"]))
        series.append(Series("line", turns, row["amplitudes"], label=words, style=f"{colour} thin"))
    axis, first = Axis("misalignment", "relative tilt", scale="log"), not (answer["separation"] or answer["methods"])
    return Panel("A small whirl", Axis("1", "turns"), axis, series, first=first)


def _chosen(rows, answer) -> list[dict]:
    """Up to three points: the first that rubs, the last of another class before the judged one, and that one."""
    rubs = [row for row in rows if row["contact_share"] > 0 and row["direction"] == "up"] or rows
    if len(rubs) <= MOST:
        return rubs
    wanted = answer["judge"]["value"] if answer["judge"] else rubs[-1]["value"]
    last = min(range(len(rubs)), key=lambda k: abs(rubs[k]["value"] - wanted))
    other = [k for k in range(last) if rubs[k]["class"] != rubs[last]["class"]]
    middle = other[-1] if other else len(rubs) // 2
    picks = sorted({0, middle, last})
    return [rubs[k] for k in ([*picks, len(rubs) - 1] if len(picks) < 3 and len(rubs) - 1 not in picks else picks)]


def _section(row, title, first: bool) -> Panel:
    """Tilt of one point, once per turn."""
    x, y = np.array(row["section"]).T
    half = 0.6 * max(np.ptp(x), np.ptp(y), 0.5 * np.abs(x).max(), 0.5 * np.abs(y).max())
    across, up = (
        Axis("misalignment", f"γ about {axis}", low=middle - half, high=middle + half)
        for axis, middle in zip("xy", (0.5 * (values.min() + values.max()) for values in (x, y)), strict=True)
    )
    return Panel(title, across, up, [Series("marks", x, y, style=f"{_style(row)} point")], equal=True,
                 first=first, tall=0.8)  # fmt: skip


def _spectrum(row) -> Panel:
    orders, size = np.array(row["orders"][1:]), np.array(row["amplitude"])
    top = size.max()
    line = Series("line", orders, np.maximum(size[1:], 1e-9 * top), style=f"{_style(row)} thin")
    along = Axis("1", "order of the shaft speed", low=0, high=orders[-1])
    axis = Axis("misalignment", "tilt", scale="log", low=1e-5 * top, high=3 * top)
    return Panel("Spectrum of the ring", along, axis, [line], below=True, tall=0.7)


# Separation that makes a forecast worthless, in units of the attractor's spread; the tighter of two correct runs.
LOST, TIGHTER = 0.3, 100.0


def evaluate_point(scene, point: dict) -> dict:
    """Exponent and averages at one point by one method; "both": how two correct runs part."""
    scene, x = with_values(frozen_at_end(scene), {point["key"]: point["value"]}), np.array(point["start"])
    if point["method"] == "both":
        return divergence(scene, x, point)
    begun, turns = clock.perf_counter(), point["turns"]
    stroboscope = PeriodMap(scene, point["accuracy"], point["method"])
    if point["method"] == "adams":
        seen = stroboscope.run(x, turns)
        if seen.status != Status.OK:
            raise FilmCollapsed(seen.message)
        exponent = neighbours(scene, x, turns, point["accuracy"], "adams")
        series = {"h_min": seen.lowest, "section": seen.section, "force": seen.contact_force, "share": seen.touching}
    else:
        samples: list = []
        exponent = tangent_product(lambda x, q: stroboscope.tangents(x, q, samples), x, turns, directions=2)
        kept = [np.concatenate(parts) for parts in zip(*samples, strict=True)]
        times = stroboscope.period * np.tile(np.arange(SAMPLES) / SAMPLES, len(kept[0]) // SAMPLES)
        seen = stroboscope.looked_at(times, *kept)
        series = {"h_min": seen["lowest"], "section": seen["section"], "force": seen["contact_force"],
                  "share": share_below(seen["h_min"], touch_level(scene))}  # fmt: skip
    return {
        "averages": averages(series, exponent, stroboscope.period),
        "floors": noise_floors(stroboscope),
        "spectrum": exponent.spectrum.tolist(),
        "wall_time": (clock.perf_counter() - begun) / turns,
    }


def averages(series, exponent, period) -> dict:
    """What must not depend on the method: exponent, film, section, share of contact, impulse per period."""
    x, y = series["section"].real, series["section"].imag
    return {
        "exponent": {"value": exponent.value, "uncertainty": exponent.uncertainty},
        **time_series.statistics(series["h_min"], "h_min"),
        "section_x_mean": time_series.average(x),
        "section_y_mean": time_series.average(y),
        "section_x_std": time_series.average(x, np.std),
        "section_y_std": time_series.average(y, np.std),
        "contact_share": time_series.average(series["share"]),
        "impulse": time_series.average(series["force"].mean(axis=1) * period),
    }


def noise_floors(stroboscope) -> dict:
    """What a run of finite accuracy and sampling cannot tell apart even on a periodic motion."""
    model, error = stroboscope.model, 100 * stroboscope.accuracy
    film, tilt = error * model.clearance, error * model.clearance / model.face[1]
    return (
        {f"h_min_{n}": film for n in ("mean", "std", "median", "q05", "q95")}
        | {f"section_{n}": tilt for n in ("x_mean", "y_mean", "x_std", "y_std")}
        | {"contact_share": 1e-3, "impulse": error * model.closing_force() * stroboscope.period, "exponent": 1e-3}
    )


def divergence(scene, x, point) -> dict:
    """Two correct runs from one start, one a hundred times tighter: how far apart (in units of clearance over outer
    radius) each turn, and after how many they have nothing in common."""
    runs = [PeriodMap(scene, point["accuracy"] / f, "adams") for f in (1.0, TIGHTER)]
    sections = [s.run(x, min(point["turns"], 200)).section for s in runs]
    scale = runs[0].model.clearance / runs[0].model.face[1]
    m = min(map(len, sections))
    apart = np.abs(sections[0][:m] - sections[1][:m]) / scale
    spread = time_series.spread(sections[1]) / scale
    beyond = np.flatnonzero(apart > LOST * spread) if spread > 100 * point["accuracy"] else []
    return {"apart": apart.tolist(), "spread": spread, "lost": int(beyond[0]) if len(beyond) else None,
            "accuracies": [point["accuracy"], point["accuracy"] / TIGHTER]}  # fmt: skip


def touch_level(scene) -> float:
    """Film thickness (m) at which the asperities meet."""
    return contact_thresholds(scene.contact)[1]
