"""Rub: the seal driven past contact onset; bifurcation diagram, exponent, sections, spectra; what can be foretold.

Each point of the diagram starts from the last one's end.  Where the motion is chaotic, averages replace trajectories:
two methods that share neither integrator nor differencing must agree on them.
"""

from dataclasses import dataclass
from functools import partial

import numpy as np

from ...analysis.continuation import frozen_at_end, sweep_branch
from ...analysis.whirl import free_model
from ...analysis.whirl.rubbing import settles
from ...numerics import time_series
from ...numerics.lyapunov import horizon
from ...numerics.piecewise_linear import initially
from ...scenario.errors import ScenarioError
from ...scenario.settings import si_unit, values_in_si
from ...scene.variants import part
from ...simulation.stability import critical_speed
from ...status import Status
from ...units import Speed
from .._words import RPM, plain, quantity, shown_in, speed
from .statistics import evaluate_point, touch_level

# Speeds, relative to the critical one, at which a whirl is let go.
ABOVE = (1.02, 1.1, 1.3)
ALONG = {
    "rows": ("value",), "rows/section": ("rows/kept",), "rows/h_min": ("rows/kept",),
    "rows/orders": ("rows/line",), "rows/amplitude": ("rows/line",), "separation/apart": ("separation/period",),
    "whirl/rows": ("speed",), "whirl/rows/amplitudes": ("whirl/rows/turn",),
}  # fmt: skip
units = {"apart": "of clearance/outer radius", "h_min": "m", "impulse": "N*s", "wall_time": "s", "speed": "rad/s",
         "end": "SI", "rows/lines/between": "1"}  # fmt: skip
units |= dict.fromkeys(("section", "amplitude", "amplitudes", "from"), "rad")
units |= dict.fromkeys((f"rows/lines/{order}" for order in ("0.5", "1", "1.5", "2", "3", "4")), "rad")
units |= dict.fromkeys(("contact_power", "friction_power"), "W")
units |= {f"{name}/{what}": unit for what in ("values", "uncertainties") for name, unit in (
    *((f"h_min_{n}", "m") for n in ("mean", "std", "median", "q05", "q95")),
    *((f"section_{n}", "rad") for n in ("x_mean", "y_mean", "x_std", "y_std")), ("impulse", "N*s"))}  # fmt: skip
units |= dict.fromkeys(("period", "distinct", "contacts", "contact_share", "contact_force", "exponent", "uncertainty",
                        "multiplier", "orders", "evaluations", "first_contact", "turns", "whirl_ratio", "values",
                        "uncertainties", "spectrum", "accuracies"), "1")  # fmt: skip


# A scenario (and flags) with which the default settings take so much processor time (s) on one core.
TIMED = ("rub_chaotic", 82)


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


def run(scenario, settings, tools) -> dict:
    """Diagram, judgement where it is needed, and the fate of whirl if asked."""
    if scenario.scene.contact is None:
        raise ScenarioError(scenario.name, "contact", "nothing", "a [contact] table: there is no rub without")
    key = settings.key or ("rotor.runout" if scenario.scene.stator.support else "stator.misalignment")
    try:
        unit = si_unit(scenario.scene, key)
    except (AttributeError, KeyError):
        raise ScenarioError(scenario.name, "study.rub.key", f'"{key}"', "a quantity of the scene") from None
    values = _values(scenario, key, unit, settings)
    base = {"key": key} | {n: getattr(settings, n) for n in ("ramp", "drop", "keep", "exponent_turns", "accuracy")}
    chains = [{**base, "direction": "up", "values": values}]
    if settings.down:
        chains.append({**base, "direction": "down", "values": values[::-1]})
    found = tools.map(partial(sweep_branch, scenario.scene), chains, "chain")
    failed = [row["failed"] for row in found if "failed" in row]
    rows = [row for part in found for row in part.get("rows", [])]
    answer = {"key": key, "touch": touch_level(scenario.scene), "rows": rows, "reason": failed}
    answer["units"] = {"rows/value": unit}
    answer |= _judged(base, rows, settings, scenario, tools)
    answer["whirl"] = _whirled(base, scenario, settings, tools) if settings.whirl else None
    if not any(row["status"] == Status.OK for row in rows):
        answer["status"] = Status.FAILED
    return {**answer, "verdict": sentences(answer)}


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


def _whirled(base, scenario, settings, tools) -> dict:
    """Where a small whirl of the unforced seal settles."""
    model = free_model(frozen_at_end(scenario.scene), initially(scenario.scene.shaft.speed))
    critical = critical_speed(model)
    if critical is None and not settings.whirl_speeds:
        return {"critical_speed": None, "rows": []}
    speeds = list(settings.whirl_speeds) or [float(f"{f * critical:.6g}") for f in ABOVE]
    rows = tools.map(partial(whirl, scenario.scene), [{**base, "speed": w} for w in speeds], "whirl")
    return {"critical_speed": critical, "rows": [{"speed": w, **row} for w, row in zip(speeds, rows, strict=True)]}


def whirl(scene, point: dict) -> dict:
    """Fate of a small whirl at one speed."""
    return settles(frozen_at_end(scene), point["speed"], point["accuracy"])


# --- in words ---------------------------------------------------------------------------------------------


def tables(answer) -> list:
    """Points of the diagram, and the whirls let go."""
    unit, factor = _shown(answer)
    value = (f"{answer['key']}, {unit}" if unit else answer["key"], "value", factor)
    share = (("contact, % of time", "contact_share", 100), ("% of closing force", "contact_force", 100))
    points = (("going", "direction"), value, ("motion", "class"), *share, ("exponent per period", "exponent"),
              ("+-", "uncertainty"), ("evaluations per turn", "evaluations"))  # fmt: skip
    whirls = (("speed, rpm", "speed", RPM), ("whirl", "fate"), ("turns", "turns"),
              ("first touch, turns", "first_contact"), ("whirl ratio", "whirl_ratio"), *share)  # fmt: skip
    return [(answer["rows"], points), ((answer["whirl"] or {}).get("rows"), whirls)]


def sentences(answer) -> list[str]:
    """The verdict: motion along the path, what can be foretold, what becomes of whirl."""
    unit, factor = _shown(answer)
    ways = {w: _classes([row for row in answer["rows"] if row["direction"] == w], factor) for w in ("up", "down")}
    paths = "; ".join(f"going {way}: {path}" for way, path in ways.items() if path)
    key = f"{answer['key']} ({unit})" if unit else answer["key"]
    lines = [f"{key} {paths}." if paths else "No point of the diagram was reached."]
    if answer["judge"]:
        lines.append(_foretold(answer, quantity(answer["judge"]["value"], _unit(answer))))
    if answer["whirl"]:
        critical, rows = answer["whirl"]["critical_speed"], answer["whirl"]["rows"]
        fates = ", ".join(f"{row['fate']} at {speed(row['speed'])}" for row in rows if "failed" not in row)
        where = f"critical speed {speed(critical)}" if critical else "no critical speed"
        lines.append(f"Small whirls of the unforced seal, {where}: {fates or 'none'}.")
    return lines


def _unit(answer) -> str:
    """SI unit of the key, none of a pure number."""
    unit = answer.get("units", {}).get("rows/value", "")
    return "" if unit in ("SI", "1") else unit


def _shown(answer) -> tuple[str, float]:
    """The unit in which values of the key are shown, and its factor."""
    return shown_in(_unit(answer), [row["value"] for row in answer["rows"]])


def _classes(rows, factor) -> str:
    """Classes along a path: "no contact to 0.2, period 1 to 0.3, ..."."""
    last = [k + 1 == len(rows) or rows[k + 1]["class"] != row["class"] for k, row in enumerate(rows)]
    return ", ".join(
        f"{row['class']} to {plain(factor * row['value'], 4)}" for row, ends in zip(rows, last, strict=True) if ends
    )


def _foretold(answer, where) -> str:
    """Exponent by two methods, the averages that agree, and the horizon of a chaotic motion."""
    judged, separation = answer["judge"], answer["separation"]
    if "failed" in judged:
        return f"Two methods could not be compared at {where}."
    entries = answer["methods"]["invariants"]
    values, bounds = entries["exponent"]["values"], entries["exponent"]["uncertainties"]
    told = " and ".join(f"{v:.3f} +- {u:.3f}" for v, u in zip(values, bounds, strict=True))
    wrong = [name for name, entry in entries.items() if not entry["agree"]]
    line = (f"At {where} the exponent is {told} a period by Adams and DOP853, "
            f"{len(entries) - len(wrong)} of {len(entries)} averages agree")  # fmt: skip
    line += f" (not {', '.join(wrong)})" if wrong else ""
    if min(v - u for v, u in zip(values, bounds, strict=True)) > 0:
        far = horizon(0.5 * sum(values), max(*separation["apart"][1:6], 1e-16), max(separation["spread"], 1e-16))
        line += f"; chaos: beyond about {far:.0f} periods only averages mean something"
    return line + "."
