"""Critical speed: the stability threshold of the aligned seal by three independent methods, and the whirl beyond it.

Linear: published formula with the film's own coefficients, eigenvalues, growth of a small disturbance in time.
Beyond: the family of circular whirls that leaves the threshold (analysis/rotating_wave.py), and runs in time that must
agree.
"""

from dataclasses import dataclass
from functools import partial
from typing import Literal

import numpy as np

from ..analysis.rotating_wave import branch, compared, contact_tilt_aligned, family_columns, free_model, kind_of
from ..analysis.whirl_in_time import (
    between,
    bounded_or_not,
    growth_rate,
    line_crossing,
    linear_growth,
    tipping_disturbance,
)
from ..answers import Answer, Axis, Level, Panel, Series, Table
from ..dynamics.linearisation import moves_with_speed
from ..dynamics.run_state import RunState
from ..numerics.piecewise_linear import initially
from ..quantities import in_words
from ..scene.patterns import grooves_of
from ..scene.scene import Closing, frozen_at_start, uneven_supports, with_values
from ..simulation.selection import choose_method
from ..simulation.stability import (
    FASTEST,
    by_formula,
    critical_speed,
    critical_speed_undamped,
    held_speeds,
    natural_frequency,
    speeds_held,
)
from ..status import Status
from . import Info

INFO = Info(
    timed=("fms_reference", 13),
    asks="Where does the seal start to whirl, and what becomes of it?",
    grooved=True,
    refuses=("secondary-seal",),
    units={
        **dict.fromkeys(("speed", "frequency", "bracket", "undamped_rotor"), "rad/s"),
        **dict.fromkeys(("opening", "h_min"), "m"),
        **dict.fromkeys(("eigenvalue", "growth/time_domain", "growth/uncertainty", "growth_rate", "rate"), "1/s"),
        **dict.fromkeys(("amplitude", "disturbance", "whirl", "tipping/branch", "directions/branch", "from", "apart"),
                        "rad"),
        **dict.fromkeys(("difference", "turns"), "1"),
    },
    along={"growth": ("speed",), "nonlinear/branch": ("speed",), "nonlinear/tipping": ("speed",),
           "nonlinear/directions": ("speed",)},
)  # fmt: skip
# Speeds, relative to the eigenvalues' threshold, at which a disturbance is let grow or decay.
SHARES = (0.95, 0.98, 0.998, 1.002, 1.02, 1.05)
NARROW = 2e-5
# Without a threshold: speeds, in parts of a tenth of the fastest, at which it is seen that there is none.
TRIED = (0.3, 1.0, 3.0, 10.0)
# Factor beyond the speeds that are drawn up to which the scenario's own is marked.
FAR = 2.0
# Of an eigenvalue's growth rate what the runs in time may be away from it besides their own uncertainty.
ALIKE = 1e-3
# What becomes of a whirl: its colour, and words.
FATES = {"decays": ("good", "dies out"), "bounded": ("blue", "bounded"), "contact": ("contact", "contact")}


@dataclass(frozen=True)
class Settings:
    """How growth is measured in time, and whether to go beyond linear."""

    method: Literal["adams", "bdf", "dop853", "radau"] = "adams"
    """Integrator."""
    accuracy: float = 1e-7
    """Accuracy to begin with, tightened until it cannot decide a verdict."""
    turns: int = 200
    """Length of a growth measurement, in turns of the shaft or of a whirl that turns faster."""
    speeds: int = 4
    """Points along the whirl family."""
    beyond: bool = True
    """Go beyond linear."""


def run(scenario, settings, tools) -> Answer:
    """The threshold by three independent methods, and the whirl beyond it."""
    scene = scenario.scene
    if grooves_of(scene)[1]:
        answer = over_grooves(scene, tools)
        low, high = (in_words("speed", answer["growth"]["speed"][k]) for k in (0, -1))
        notes = [*_notes(answer), f"Roots were counted from {low} to {high}, on the film of one pitch."]
        return Answer(answer, _found(answer), _tables(answer), [_growth_panel(answer)], notes)
    model = free_model(scene, initially(scene.shaft.speed))
    if moves_with_speed(scene):
        # At every speed the same closing force, wherever it then puts the gap.
        force = Closing(balance_ratio=model.closing.balance_ratio, spring_force=initially(model.closing.spring))
        scene = with_values(scene, {"closing": force, "film.clearance": model.clearance})
    pace = natural_frequency(model) or 1.0
    eigenvalue = critical_speed(model)
    formula, why = by_formula(model)
    method = "ida" if model.unknowns.has_residual_form else settings.method
    how = {"method": method, "accuracy": settings.accuracy, "turns": settings.turns}
    answer = {"formula": formula, "formula_reason": why, "eigenvalue": eigenvalue, "unit": "rad/s"}
    answer["rotor_damper"], answer["undamped_rotor"] = critical_speed_undamped(model)
    answer["speeds_held"], answer["own_speed"] = speeds_held(model), abs(scene.shaft.speed)
    answer |= in_time(scene, model, eigenvalue, how, tools, pace)
    answer["nonlinear"] = beyond(model, scene, eigenvalue, settings, tools)
    found, panels = _found(answer), [_growth_panel(answer), *_whirl_panel(answer)]
    return Answer(answer, found, _tables(answer), panels, _notes(answer))


def over_grooves(scene, tools) -> dict:
    """The same of faces with grooves, by the roots of the rings on the film of one pitch alone."""
    from ._grooved_roots import RootsOverSpeed, thresholds

    rates, found = thresholds(RootsOverSpeed(frozen_at_start(scene)), tools)
    return {
        "formula": None, "formula_reason": "none is published over grooves", "unit": "rad/s",
        "eigenvalue": min(found, default=None), "thresholds": found, "speeds_held": None,
        "rotor_damper": None, "undamped_rotor": None,
        "own_speed": abs(initially(scene.shaft.speed)),
        "time_domain": {"value": None, "uncertainty": None, "reason": "not run over grooves"},
        "growth": columns([{"eigenvalue": rate} for _, rate in rates], [speed for speed, _ in rates]),
        "nonlinear": _not_followed("whirls of a film with unknowns of its own are not followed"),
    }  # fmt: skip


def at_point(function, scene, point: dict) -> dict:
    """The row of a function of a scene whose other arguments a point names."""
    return function(scene, **point)


def in_time(scene, model, eigenvalue, how, tools, pace) -> dict:
    """Bracketing of the threshold by growth and decay; without a threshold, decay at a few speeds."""
    fastest, found = FASTEST / scene.film.outer_radius, {"value": None, "uncertainty": None}
    growth = partial(at_point, growth_rate, scene)
    if eigenvalue is None:
        tried = [factor * min(pace, fastest / 10.0) for factor in TRIED]
        # Slow shafts on stiff films: nothing here is as close to its threshold as Adams' small damping would matter.
        if how["method"] == "adams":
            how = {**how, "method": choose_method(RunState(free_model(scene, tried[0]), 1.0))[0]}
        speeds = _within_held(model, tried)
        rows = tools.map(growth, [{**how, "speed": w} for w in speeds], "growth")
        signs = {row["rate"] > 0 for row in rows if "failed" not in row and row["decided"]}
        said = "a disturbance grows at some of the speeds tried"
        if len(signs) == 1:
            said = f"a disturbance {'grows' if True in signs else 'dies out'} at every speed tried"
        elif not signs:
            said = _unmeasured(rows) or "neither growth nor decay beyond the method's own"
        if speeds == tried and pace > fastest / 10.0:
            said += f", up to {FASTEST:g} m/s at the outer radius"
        found["reason"] = said
        # That there is none is not confirmed: growth here and decay there, or neither.
        undecided = {} if len(signs) == 1 else {"status": Status.FAILED}
        return {"time_domain": found, "growth": columns(rows, speeds), **undecided}
    speeds = [share * eigenvalue for share in SHARES]
    if eigenvalue > fastest:
        edge = in_words("m/s", eigenvalue * scene.film.outer_radius)
        found["reason"] = f"not run, {edge} at the outer radius are of no seal"
        rows = [{"eigenvalue": linear_growth(free_model(scene, w))} for w in speeds]
        return {"time_domain": found, "growth": columns(rows, speeds)}
    rows = tools.map(growth, [{**how, "speed": w} for w in speeds], "growth")
    around = between(rows, speeds)
    if around is None:
        found["reason"] = _unmeasured(rows) or "growth does not change sign within 5 % of the eigenvalues' threshold"
        return {"time_domain": found, "growth": columns(rows, speeds)}
    # Two more on either side of where the line between them crosses zero: a bracket of a few hundred-thousandths.
    crossing, _ = line_crossing(*around)
    near = [crossing * (1 - NARROW), crossing * (1 + NARROW)]
    closer = tools.map(growth, [{**how, "speed": w} for w in near], "growth")
    last = between(closer, near) or around
    value, uncertainty = line_crossing(*last)
    order = np.argsort([*speeds, *near])
    speeds, rows = [[*speeds, *near][i] for i in order], [[*rows, *closer][i] for i in order]
    bracket, ends = zip(*last, strict=True)
    found = {
        "value": value, "uncertainty": uncertainty, "bracket": list(bracket), "method": how["method"],
        "accuracy": min(row["accuracy"] for row in ends),
        "numerical_damping": max(row["numerical_damping"] for row in ends),
        "against_eigenvalue": max(abs(row["rate"] - row["eigenvalue"]) for row in ends),
    }  # fmt: skip
    return {"time_domain": found, "growth": columns(rows, speeds)}


def _within_held(model, tried: list[float]) -> list[float]:
    """The speeds `tried` (rad/s, rising) where a film holds the closing force at each; else such a row up to the last
    speed at which one does, none of them twice."""
    low, high = held_speeds(model, model.start, tried[0], tried[-1])
    if (low, high) == (tried[0], tried[-1]):
        return tried
    tried = [factor * high / TRIED[-1] for factor in TRIED]
    low, high = held_speeds(model, model.start, tried[0], high)
    return sorted({min(max(speed, low), high) for speed in tried})


def _unmeasured(rows) -> str:
    """Why no row has a growth rate; "" if one has."""
    return rows[0]["failed"] if all("failed" in row for row in rows) else ""


def disagreements(growth) -> list[bool]:
    """Whether growth in time is another than the eigenvalues have it, by more than three times its uncertainty, at
    each speed."""
    rows = zip(*(growth[name] for name in ("eigenvalue", "time_domain", "uncertainty")), strict=True)
    return [None not in row and abs(row[1] - row[0]) > 3.0 * row[2] + ALIKE * abs(row[0]) for row in rows]


def columns(rows, speeds) -> dict:
    names = {"eigenvalue": "eigenvalue", "time_domain": "rate", "uncertainty": "uncertainty"}
    return {
        "speed": list(speeds),
        **{column: [row.get(name) for row in rows] for column, name in names.items()},
        "decided": [row.get("decided", False) for row in rows],
        "failed": [row.get("failed") for row in rows],
    }


# --- beyond linear ------------------------------------------------------------------------------------


def beyond(model, scene, threshold, settings, tools) -> dict | None:
    """Family of whirls from the threshold to contact, tipping disturbances, and runs up and down in speed."""
    if not settings.beyond:
        return None
    if model.unknowns.linear:
        return _not_followed("of a linear film nothing bounds the whirl and nothing tips it")
    if uneven_supports(scene):
        return _not_followed("no circular whirl stays one on a support with two tilt stiffnesses")
    if threshold is not None and threshold > FASTEST / scene.film.outer_radius:
        return _not_followed("not followed at such a speed")
    if threshold is None:
        return _not_followed("no threshold, so no whirl branches off")
    if scene.contact:
        return _not_followed("asperities bound the whirl (study rub); without contact the film's own whirls")
    if model.unknowns.film_unknowns:
        return _not_followed("whirls of a film with unknowns of its own are not followed")
    at_threshold = free_model(scene, threshold)
    family = branch(at_threshold, threshold)
    if not family:
        return _not_followed("no family of circular whirls was found at the threshold")
    touches = family[-1].speed if family[-1].h_min < 2 * at_threshold.face[4] else None
    found = {"kind": kind_of(family, threshold), "branch": family_columns(family),
             "contact_tilt": contact_tilt_aligned(at_threshold), "contact_speed": touches}  # fmt: skip
    low, high = min(w.speed for w in family), max(w.speed for w in family)
    inner = ((np.arange(settings.speeds) + 0.5) / settings.speeds).tolist()
    below = [threshold - (threshold - low) * x for x in inner] if low < 0.9995 * threshold else []
    near = [min(family, key=lambda whirl: abs(whirl.speed - w)) for w in below]
    points = [{"speed": w, "parting": whirl.growth} for w, whirl in zip(below, near, strict=True)]
    rows = tools.map(partial(at_point, tipping_disturbance, scene), points, "tipping", ("speed",))
    found["tipping"] = [compared(row, family, False) for row in rows]
    above = [threshold + (high - threshold) * x for x in inner] if high > 1.0005 * threshold else []
    outside = [min(low - 0.005 * threshold, 0.998 * threshold), max(high + 0.005 * threshold, 1.002 * threshold)]
    points = []
    for w in sorted([*below, *above, *outside]):
        points += [{"speed": w, "start": "small", "shape": None, "frequency": None},
                   {"speed": w, "start": "large", "shape": (0.97 * family[-1].q).tolist(),
                    "frequency": family[-1].frequency}]  # fmt: skip
    rows = tools.map(partial(at_point, bounded_or_not, scene), points, "fate", ("speed", "start"))
    found["directions"] = [compared(row, family, True) for row in rows]
    return {"verdict": whirl_verdict(found), **found}


def _not_followed(why: str) -> dict:
    return {"verdict": f"Beyond linear: {why}.", "tipping": []}


# --- what is told ---------------------------------------------------------------------------------------


def whirl_verdict(nonlinear) -> str:
    """What bounds or tips the whirl, by the kind of its family."""
    kind, touches = nonlinear["kind"], nonlinear["contact_speed"]
    last = in_words("speed", touches or min(nonlinear["branch"]["speed"]))
    if kind == "subcritical":
        beside = "between rest and contact" if touches else "beside rest, as far as it was followed"
        return f"Nothing bounds the whirl above it; below, down to {last}, an unstable whirl stands {beside}."
    ends = f"touches at {last}" if touches else "touches at no speed followed"
    if kind == "supercritical":
        return f"Above it the film bounds the whirl, which {ends}; no hysteresis."
    return f"The family of whirls turns back on its way to contact, and {ends}: hysteresis between the turns."


def _found(numbers) -> str:
    eigen, time, nonlinear = numbers["eigenvalue"], numbers["time_domain"], numbers["nonlinear"] or {}
    if eigen is None:
        reach = ""
        if held := numbers["speeds_held"]:
            reach = f" up to {in_words('speed', held[1], 5)}, beyond which no film holds the closing force"
        return f"No critical speed{reach}: eigenvalues cross at no speed; in time {time['reason']}."
    then = f": {nonlinear['verdict'][0].lower()}{nonlinear['verdict'][1:]}" if "branch" in nonlinear else "."
    return f"Critical speed {in_words('speed', eigen, 6)}{then}"


def _notes(numbers) -> list[str]:
    found, nonlinear = [], numbers["nonlinear"] or {}
    if numbers["eigenvalue"] is not None and numbers["time_domain"]["value"] is None:
        found.append(f"In time: {numbers['time_domain']['reason']}.")
    if numbers["formula_reason"]:
        found.append(f"No formula: {numbers['formula_reason']}.")
    bare, eigenvalue = numbers["undamped_rotor"], numbers["eigenvalue"]
    if numbers["rotor_damper"] and eigenvalue and (bare is None or bare > eigenvalue):
        words = f"it is {in_words('speed', bare)} without it" if bare else "without it there is none"
        found.append(f"The rotor's damper turns with it and costs critical speed: {words}.")
    growth = numbers["growth"]
    if apart := sum(disagreements(growth)):
        found.append(f"Eigenvalues and runs in time disagree at {apart} of {len(growth['speed'])} speeds.")
    if nonlinear and "branch" not in nonlinear:
        found.append(nonlinear["verdict"])
    if any(row.get("turns") and row["branch"] for row in nonlinear.get("tipping", ())):
        found.append("What tips the seal is known by the family alone where runs beside it part too slowly.")
    return found


def _tables(numbers) -> list[Table]:
    """The threshold by each method, growth over speed, and whirls beyond it by continuation and in time."""
    eigen, time, growth = numbers["eigenvalue"], numbers["time_domain"], numbers["growth"]
    methods = [("formula", numbers["formula"], None), ("eigenvalues", eigen, None),
               ("in time", time["value"], time["uncertainty"])]  # fmt: skip
    rows = [[name, speed, doubt, speed / eigen - 1.0 if eigen else None] for name, speed, doubt in methods if speed]
    columns = [("1", "method"), ("speed", "critical speed"), ("speed", "uncertainty"), ("1", "over eigenvalues'")]
    tables = [Table("threshold", columns, rows)]
    columns = [("speed", "speed"), ("1", "over threshold"), ("growth_rate", "growth by eigenvalues"),
               ("growth_rate", "in time"), ("growth_rate", "uncertainty"), ("1", "apart"), ("1", "failed")]  # fmt: skip
    parts = [growth[name] for name in ("eigenvalue", "time_domain", "uncertainty")]
    over = [speed / eigen - 1.0 if eigen else None for speed in growth["speed"]]
    # Of speeds that were not run nothing is known.
    apart = [apart if rate is not None else None for apart, rate in zip(disagreements(growth), parts[1], strict=True)]
    rows = [*zip(growth["speed"], over, *parts, apart, growth["failed"], strict=True)]
    tables.append(Table("growth", columns, rows))
    if time.get("numerical_damping") is not None:
        columns = [("1", "method"), ("1", "accuracy"), ("growth_rate", "damping of its own"),
                   ("growth_rate", "from eigenvalues"), ("growth_rate", "smallest growth that decides")]  # fmt: skip
        closest = min(abs(rate) for rate in growth["time_domain"] if rate is not None)
        row = [*(time[name] for name in ("method", "accuracy", "numerical_damping", "against_eigenvalue")), closest]
        tables.append(Table("method in time", columns, [row]))
    found = numbers["nonlinear"] or {}
    if "branch" not in found:
        return tables
    touch, closed, last = found["contact_speed"], found["contact_tilt"], found["branch"]["amplitude"][-1]
    columns = [("1", "whirl"), ("speed", "touches at"), ("1", "of the threshold"), ("tilt", "followed to a tilt of"),
               ("1", "of that which closes the gap")]  # fmt: skip
    row = [found["kind"], touch, touch / eigen if touch else None, last, last / closed]
    tables.append(Table("whirl", columns, [row]))
    columns = [("speed", "speed"), ("1", "of the threshold"), ("tilt", "tilt that tips"), ("tilt", "whirl in time"),
               ("tilt", "whirl by continuation"), ("1", "difference"), ("1", "turns it would take")]  # fmt: skip
    rows = [[row["speed"], row["speed"] / eigen, *map(row.get, ("disturbance", "whirl", "branch", "difference",
                                                                "turns"))] for row in found["tipping"]]  # fmt: skip
    tables.append(Table("tipping", columns, rows))
    columns = [("speed", "speed"), ("1", "whirl begun"), ("1", "in time"), ("tilt", "settles at"),
               ("tilt", "by continuation"), ("1", "difference"), ("growth_rate", "growth by eigenvalues")]  # fmt: skip
    rows = [[row["speed"], row["start"], row.get("fate") or row["failed"],
             *map(row.get, ("whirl", "branch", "difference", "rate"))] for row in found["directions"]]  # fmt: skip
    tables.append(Table("small and large whirls", columns, rows))
    return tables


def _growth_panel(numbers) -> Panel:
    """Growth rate of a small disturbance over speed."""
    growth, title, eigen = numbers["growth"], "Growth of a small disturbance", numbers["eigenvalue"]
    speed, own, time = growth["speed"], numbers["own_speed"], numbers["time_domain"]["value"]
    sizes = [abs(rate) for rate in growth["eigenvalue"] if rate]
    if not sizes:
        return Panel(title, note=next(filter(None, growth["failed"]), "no growth rate was found"))
    # Speeds tried far apart are no curve.
    kind, style = ("marks", "warn diamond small front") if eigen is None else ("line", "warn")
    series = [Series(kind, speed, growth["eigenvalue"], label="eigenvalues", style=style)]
    if any(rate is not None for rate in growth["time_domain"]):
        series.append(Series("marks", speed, growth["time_domain"], label="in time",
                             style="blue open circle", error=growth["uncertainty"]))  # fmt: skip
    for label, value, style in (("formula", numbers["formula"], "grey plus"), ("in time", time, "black cross")):
        if value:
            series.append(Series("marks", [value], [0.0], label=f"threshold {label}", style=f"{style} front large"))
    levels = [Level(0.0, style="black")]
    levels += [Level(eigen, "threshold", upright=True, style="bad dashed", number=True)] if eigen else []
    if min(speed) / FAR <= own <= FAR * max(speed):
        levels.append(Level(own, "this scenario", upright=True, style="black dotted"))
    far = eigen is None and 0.0 < 10 * min(speed) < max(speed)
    wide = far and max(sizes) > 30 * min(sizes)
    rate = Axis("growth_rate", scale="asinh" if wide else "linear", width=min(sizes))
    return Panel(title, Axis("speed", scale="log" if far else "linear"), rate, series, levels)


def _whirl_panel(numbers) -> list[Panel]:
    """Tilt of the whirl over speed: its family, stable or not, and what became of runs in time; none where it was not
    followed."""
    found = numbers["nonlinear"] or {}
    if "branch" not in found:
        return []
    family, closed = found["branch"], found["contact_tilt"]
    speed = [numbers["eigenvalue"], *family["speed"]]
    size = [0.0, *(amplitude / closed for amplitude in family["amplitude"])]
    stable = [rate < 0.0 for rate in (family["growth_rate"][0], *family["growth_rate"])]
    series = []
    for held, style, label in ((True, "black thick", "whirl, stable"), (False, "black dashed", "whirl, unstable")):
        if held in stable:
            part = [value if same == held else None for value, same in zip(size, stable, strict=True)]
            series.append(Series("line", speed, part, label=label, style=style))
    touches = found["contact_speed"] is not None
    series.append(Series("marks", speed[-1:], size[-1:], label="touches" if touches else "followed to here",
                         style=f"{'contact' if touches else 'grey'} square front"))  # fmt: skip

    def marks(rows, name, label, style):
        at, tilt = [row["speed"] for row in rows], [row[name] / closed for row in rows]
        return [Series("marks", at, tilt, label=label, style=style)] if rows else []

    tips = [row for row in found["tipping"] if row.get("disturbance")]
    series += marks(tips, "whirl", "at the edge, in time", "warn cross")
    series += marks(tips, "disturbance", "tips unopened gap", "warn tick large")
    for fate, (colour, words) in FATES.items():
        rows = [row for row in found["directions"] if row.get("fate") == fate]
        for start, mark in (("small", "triangle"), ("large", "down")):
            begun = [row for row in rows if row["start"] == start]
            series += marks(begun, "from", words, f"{colour} {mark}")
            words = words if not begun else ""
        series += marks([row for row in rows if row["whirl"]], "whirl", "settles at", f"{colour} open circle")
    ends = [row["speed"] for row in found["directions"]]
    room = 0.08 * (max(ends) - min(ends)) or 0.01 * max(ends)
    over = Axis("speed", low=min(ends) - room, high=max(ends) + room)
    tilt = Axis("1", "whirl tilt / tilt that closes the gap", low=-0.02 * max(size), high=1.15 * max(size))
    threshold = [Level(numbers["eigenvalue"], "threshold", upright=True, style="bad dashed")]
    return [Panel("Whirl beyond the threshold (▲ begun small, ▼ large)", over, tilt, series, threshold)]
