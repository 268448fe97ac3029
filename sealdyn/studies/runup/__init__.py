"""Run-up: speed (or a pressure, ...) ramps up and down at several rates; what lags, what grows, what touches.

Shaft speed: the order that the scene drives, tracked over the shaft's exact angle, beside linear steady theory at each
speed; past the stability threshold the growth of a small whirl against the integral of its linear growth rate, and
how fast one must pass to stay below touch.  Anything else: film, misalignment and leakage against the quasi-static.
"""

import math
from dataclasses import dataclass
from functools import partial
from typing import Annotated

import numpy as np
from pydantic import Field

from ...answers import Answer, Table, table_of
from ...numerics.piecewise_linear import PiecewiseLinear
from ...numerics.time_series import FOLDED
from ...quantities import in_words
from ...scenario.settings import si_unit
from ...scene.scene import part, with_values
from ...status import Status
from ...units import Angle, Time
from .. import Info
from .plan import SPEED, checked, jumps, planned, rate_unit, rates_of, tables_end, value_of, wrong
from .ramp_run import load_trip, memory, overshoot, quasi_static
from .speed_ramp import passage, short_pass

# Rates of the curve, over the rate at which linear theory just touches; how closely the touching rate is located.
CURVE, CLOSE, MOST_CUTS = (0.4, 0.65, 0.85, 1.0, 1.2, 1.6, 2.5, 6.0), 0.01, 14
# Ramps of a load take so many decay times, from a slow one to a fast one; a step besides.
RAMPS = (100.0, 10.0, 1.0)
LISTS = ("time", "value", "film", "tilt", "flow")
WAYS = ("up", "down")
# Up to this share of the tilt that touches, a seal is near its aligned film; of the power that may be folded.
NEAR = 0.5
INFO = Info(
    timed=("runup_past_threshold", 6),
    warm="In time, temperature and coning are those of the first speed: study warm-up follows them.",
    # What follows the shaft's speed; of another key, of its rate and of an amplitude the answer knows the unit.
    units={
        **dict.fromkeys(("speed", "frequency", "h_min_speed", "relative_misalignment_speed", "speed_in_window",
                         "resonances"), "rad/s"),
        **dict.fromkeys(("h_min_time", "time", "until", "time_above", "stages"), "s"), "growth_rate": "1/s",
        **dict.fromkeys(("h_min", "film"), "m"), **dict.fromkeys(("leakage", "leakage_least", "flow"), "m^3/s"),
        **dict.fromkeys(("phase", "relative_misalignment", "tilt", "growth/from"), "rad"),
        **dict.fromkeys(("turns", "window", "resolution", "folding", "orders", "driven", "departure", "rows/up/rows",
                         "rows/down/rows", "rows/time/rows", "foretold", "measured", "integral", "with_factor",
                         "error", "error_with_factor", "whole"), "1"),
        **{f"overshoot/{name}": "1" for name in ("h_min", "relative_misalignment", "leakage")},
    },
    along={
        "linear": ("speed",), "curve": ("rate",), "whirl": ("speed",), "quasi_static": ("value",), "rows": ("rate",),
        "rows/growth/curve": ("instant",), "waterfall/up": ("speed", "orders"),
        "waterfall/down": ("speed", "orders"), **{f"rows/{name}": ("rows/instant",) for name in LISTS},
    },
)  # fmt: skip


@dataclass(frozen=True)
class Settings:
    """The ramps."""

    key: str = SPEED
    """What goes from `begin` to `end` and back."""
    begin: float | str | None = None
    """With its unit, or SI; without it half the first resonance, of another key than the speed its first value."""
    end: float | str | None = None
    """With its unit, or SI; without it 1.05 of the threshold or 1.5 of the last resonance, of another key than
    the speed the farthest of its table."""
    rates: float | str | None = None
    """Rates per second, "1000, 5000" or "from:to:count[:log]"; for anything but the speed also "step"."""
    hold: Annotated[Time, Field(ge=0)] | None = None
    """How long the end is held."""
    disturbance: Annotated[Angle, Field(ge=0)] | None = None
    """Relative tilt of the whirl that is met at the threshold; without it a thousandth of clearance over outer
    radius."""
    touch: bool = True
    """Look for the rate that just touches."""
    order: float | None = None
    """Order that is followed; without it 1 where something turns with the shaft."""
    window: Annotated[int, Field(ge=2)] | None = None
    """Turns of the window in which it is tracked."""
    samples_per_turn: Annotated[int, Field(ge=8)] | None = None
    """Samples of a turn."""


def run(scenario, settings, tools) -> Answer:
    """Ramps of the shaft speed, or of anything else that may change in time."""
    checked(scenario, settings)
    return speed_ramps(scenario, settings, tools) if settings.key == SPEED else load_ramps(scenario, settings, tools)


# --- shaft speed ------------------------------------------------------------------------------------------


def speed_ramps(scenario, settings, tools) -> Answer:
    """Up and down in speed at every rate, and the rate that just touches."""
    plan = planned(scenario, settings)
    base, mode, crossing = plan["base"], plan["mode"], plan["crossing"]
    begin, end, order = base["begin"], base["end"], base["order"]
    points = [{**base, "rate": rate} for rate in plan["rates"]]
    rows = tools.map(partial(passage, plan["scenario"]), points, "passage", ("rate",))
    speeds = np.linspace(begin, end, 161)
    linear = plan["steady"].curve(speeds, order)
    answer = {
        "key": SPEED, "begin": begin, "end": end, "chosen": plan["chosen"], "order": order,
        "tilting": plan["steady"].tilting, "driven": sorted(plan["steady"].orders), "touch_tilt": plan["touch_tilt"],
        "linear_verdict": plan["linear_verdict"],
        "threshold": plan["threshold"], "crossing": crossing, "resonances": plan["resonances"],
        "disturbance": base["disturbance"], "tilt_scale": plan["tilt_scale"], "samples_per_turn": base["per_turn"],
        "linear": {"speed": speeds.tolist(), "amplitude": np.abs(linear).tolist(),
                   "phase": np.angle(linear).tolist(), "peak": plan["steady"].peak(begin, end, order)},
        "whirl": _whirl(mode, begin, end), "forced_tilt": plan["forced"],
        "warnings": plan["warnings"], "rate_foretold": plan["rate_foretold"],
    }  # fmt: skip
    size = "rad" if answer["tilting"] else "m"
    answer["units"] = {"amplitude": size, "peak": ["rad/s", size], "rate": "rad/s^2", "bracket": "rad/s^2"}
    shown = next((r for r in rows if r.get("status") == Status.OK), next((r for r in rows if "waterfall" in r), None))
    answer["waterfall"] = {"rate": shown["rate"], "window": shown["window"], **shown["waterfall"]} if shown else None
    answer["rows"] = [{k: v for k, v in row.items() if k != "waterfall"} for row in rows]
    answer |= touching(plan, answer["rows"], settings, tools)
    unknown = answer["touch_rate"] is not None and answer["touch_rate"].get("failed")
    if unknown or not any("status" in row for row in rows):
        answer["status"] = Status.FAILED
    tables = [_speed_table(answer), *_growth_tables(answer)]
    return Answer(answer, _passing(answer), tables, notes=_speed_notes(answer))


def _whirl(mode, begin, end) -> dict | None:
    """The whirl's frequency and growth rate over the speed; None without a threshold on the way."""
    if mode is None:
        return None
    speeds = np.linspace(mode.speeds[0], mode.speeds[-1], 61)
    kept = speeds[(speeds >= begin) & (speeds <= end)]
    return {"speed": kept.tolist(), "frequency": mode.frequency(kept).tolist(),
            "growth_rate": mode.growth(kept).tolist()}  # fmt: skip


def touching(plan, rows, settings, tools) -> dict:
    """Largest misalignment and thinnest film over the ramp rate, and the rate that just touches."""
    done = [{k: row[k] for k in ("rate", "status", "touched", "relative_misalignment", "h_min")}
            for row in rows if row.get("status") in (Status.OK, Status.COLLAPSED)]  # fmt: skip
    said = None
    if plan["crossing"] is not None and settings.touch:
        middle = plan["rate_foretold"]
        rates = [float(f"{middle * share:.4g}") for share in CURVE] if middle else []
        points = [{**plan["base"], "rate": rate} for rate in rates]
        found = tools.map(partial(short_pass, plan["scenario"]), points, "short passes")
        done += [row for row in found if row.get("status") in (Status.OK, Status.COLLAPSED)]
        done, said = _closer(plan, done, tools)
    done.sort(key=lambda row: row["rate"])
    names = ("rate", "relative_misalignment", "h_min", "touched")
    return {"curve": {n: [row[n] for row in done] for n in names}, "touch_rate": said}


def _closer(plan, done, tools):
    """The touching rate between the fastest that touches and the slowest that does not, by halving."""
    for _ in range(MOST_CUTS):
        touch = [row["rate"] for row in done if row["touched"]]
        free = [row["rate"] for row in done if not row["touched"]]
        if not (touch and free):
            return done, {"value": None, "bracket": [max(touch, default=None), min(free, default=None)],
                          "said": "every rate tried touches" if touch else "no rate tried touches"}  # fmt: skip
        low = max(touch)
        above = [rate for rate in free if rate > low]
        if not above:
            return done, {"value": None, "bracket": [low, None], "said": "the fastest rate tried touches"}
        high = min(above)
        if high < (1 + CLOSE) * low:
            break
        rate = float(f"{math.sqrt(low * high):.5g}")
        (row,) = tools.map(partial(short_pass, plan["scenario"]), [{**plan["base"], "rate": rate}], "touching rate")
        if row.get("status") not in (Status.OK, Status.COLLAPSED):
            why = row.get("failed") or row["message"]
            return done, {"value": None, "bracket": [low, high], "said": why, "failed": True}
        done.append(row)
    return done, {"value": math.sqrt(low * high), "bracket": [low, high], "said": ""}


# --- anything else ----------------------------------------------------------------------------------------


def load_ramps(scenario, settings, tools) -> Answer:
    """There and back at every rate, against the quasi-static answer."""
    key, now = settings.key, part(scenario.scene, settings.key)
    begin, end = value_of(scenario, settings, "begin"), value_of(scenario, settings, "end")
    if begin is None:
        begin = float(now.value[0]) if isinstance(now, PiecewiseLinear) else float(now)
    if end is None and isinstance(now, PiecewiseLinear):
        end = max(now.value, key=lambda v: abs(v - begin))
    if end is None or end == begin:
        raise wrong(scenario, "end", "nothing" if end is None else f"{end:g}, as begin", f"another value of {key}")
    unit = si_unit(scenario.scene, key)
    slowest, decay, wait = memory(scenario, key, begin, end)
    rates = rates_of(scenario, settings)
    if rates is None:
        rates = [float(f"{abs(end - begin) / (times * decay):.4g}") for times in RAMPS]
        rates += [] if jumps(scenario.scene, key) else [None]
    settle = wait + tables_end(with_values(scenario.scene, {key: begin}))
    hold = wait if settings.hold is None else settings.hold
    if None in rates and not hold:
        raise wrong(scenario, "hold", "0 s with a step", "a time above zero: a step there and back at once is none")
    base = {"key": key, "begin": begin, "end": end, "settle": settle, "hold": hold, "rest": wait}
    slow = quasi_static(scenario, key, begin, end)
    rows = tools.map(partial(load_trip, scenario), [{**base, "rate": rate} for rate in rates], "ramps", ("rate",))
    for row in rows:
        row["overshoot"] = overshoot(row, slow) if "failed" not in row else None
    answer = {"key": key, "begin": begin, "end": end, "unit": unit, "rate_unit": rate_unit(unit), "decay": decay,
              "slowest": slowest, "quasi_static": slow, "rows": rows,
              "units": {"value": unit, "rate": rate_unit(unit)}}  # fmt: skip
    if not any("status" in row for row in rows):
        answer["status"] = Status.FAILED
    return Answer(answer, _load_found(answer), _load_tables(answer), notes=_load_notes(answer))


# --- what is shown -----------------------------------------------------------------------------------------

ENDS = (("h_min", "thinnest film", "h_min"), ("misalignment", "largest misalignment", "relative_misalignment"),
        ("1", "touch", "touched"), ("1", "ended", "status"))  # fmt: skip


def _passing(answer) -> str:
    """How fast the threshold must be passed; without one how near the faces come."""
    threshold, touch = answer["threshold"], answer["touch_rate"]
    if answer["crossing"] is None:
        films = [(row["h_min"], row["rate"]) for row in answer["rows"] if row.get("h_min") is not None]
        near = f"; thinnest film {in_words('h_min', min(films)[0])}" if films else ""
        if threshold is not None:
            return f"The stability threshold {in_words('speed', threshold)} is not on the way{near}."
        if not answer["tilting"]:
            return f"Nothing tilts the rings here, and no whirl is followed{near}."
        if answer["linear_verdict"] != "stable":
            return f"No stability threshold: the seal is {answer['linear_verdict']} at every speed{near}."
        return f"No stability threshold: whirl dies out at every speed{near}."
    where = f"the threshold {in_words('speed', threshold)}"
    if touch is None or touch["value"] is None:
        why = "not looked for" if touch is None else touch["said"]
        return f"How fast {where} must be passed to stay below touch: {why}."
    return f"To stay below touch {where} must be passed faster than {in_words('rad/s^2', touch['value'])}."


def _speed_table(answer) -> Table:
    """Every ramp of the speed with what it met."""
    names = (("rad/s^2", "rate", "rate"), ("1", "turns each way", "turns"), ("speed", "peak going up", "up"),
             ("speed", "down", "down"), ("speed", "read to", "read"), ("share", "from linear", "departure"),
             ("speed", "closest at", "h_min_speed"), ("1", "going", "h_min_way"), *ENDS,
             ("1", "failed", "failed"))  # fmt: skip
    rows = [dict(row) for row in answer["rows"]]
    for row, told in zip(answer["rows"], rows, strict=True):
        if "failed" not in row:
            far = [row[way]["departure"] for way in WAYS if row[way]["departure"] is not None]
            told |= {way: row[way]["peak"][0] if row[way]["peak"] else None for way in WAYS}
            told |= {"departure": max(far, default=None)}
            told |= {"read": row["speed_in_window"] / 4 if any(row[way]["peak"] for way in WAYS) else None}
    return table_of("ramps", names, rows)


def _growth_tables(answer) -> list[Table]:
    """The peak of linear theory; growth of the whirl beside the integral of its linear growth rate."""
    peak, size = answer["linear"]["peak"], "tilt" if answer["tilting"] else "clearance"
    first = [("1", "order"), ("speed", "from"), ("speed", "to"), ("speed", "linear peak at"), (size, "height"),
             ("rad/s^2", "linear rate that touches")]  # fmt: skip
    row = [answer["order"], answer["begin"], answer["end"], *(peak or (None, None)), answer["rate_foretold"]]
    tables = [Table("linear theory", first, [row])]
    grown = [row for row in answer["rows"] if row.get("growth")]
    if answer["crossing"] is not None and grown:
        columns = [("rad/s^2", "rate"), ("1", "ln of growth"), ("1", "linear"), ("share", "off")]
        rows = [[row["rate"], *(row["growth"][key] for key in ("measured", "with_factor", "error_with_factor"))]
                for row in grown]  # fmt: skip
        tables.append(Table("growth of the whirl", columns, rows))
    return tables


def _speed_notes(answer) -> list[str]:
    """Limits of the comparison, and warnings of the runs."""
    good, notes = [row for row in answer["rows"] if "failed" not in row], []
    if answer["crossing"] is not None and answer["forced_tilt"] > NEAR * answer["touch_tilt"]:
        forced, closing = (in_words("tilt", answer[name]) for name in ("forced_tilt", "touch_tilt"))
        notes.append(f"Forced tilt {forced} of {closing} that close the gap: the growth rate tells nothing here.")
    if answer["chosen"]:
        notes.append(f"Chosen here: {', '.join(answer['chosen'])}.")
    warnings = [*answer["warnings"], *(words for row in good for words in row["warnings"])]
    folded = max((row["folding"] for row in good), default=0.0)
    if folded > FOLDED:
        warnings.append(f"aliasing: {in_words('share', folded, digits=2)} of the power: raise samples_per_turn")
    return [*notes, *dict.fromkeys(warnings)]


def _load_found(answer) -> str:
    """The thinnest film of all ramps."""
    films = [(row["h_min"], row["rate"]) for row in answer["rows"] if row.get("h_min") is not None]
    least, rate = min(films, key=lambda film: film[0], default=(None, None))
    begin, end = (in_words(answer["unit"], answer[name], digits=5) for name in ("begin", "end"))
    how = "in a step" if rate is None else f"at {in_words(answer['unit'], rate)}/s"
    film = "no film" if least is None else f"thinnest film {in_words('h_min', least)}, {how}"
    return f"{answer['key']} from {begin} to {end} and back: {film}."


def _load_tables(answer) -> list[Table]:
    """Every ramp beyond the quasi-static answer, and that answer at both ends."""
    names = ((answer["rate_unit"], "rate", "rate"), ("share", "film beyond slow", "h_min"),
             ("share", "misalignment", "relative_misalignment"), ("leakage", "leakage from", "leakage_least"),
             ("leakage", "to", "leakage"), *ENDS, ("1", "failed", "failed"))  # fmt: skip
    rows = []
    for row in answer["rows"]:
        over = row["overshoot"] or {}
        beyond = [over.get(key) for key in ("h_min", "relative_misalignment")]
        rows.append([row["rate"], *beyond, *(row.get(key) for *_, key in names[3:])])
    slow = answer["quasi_static"]
    ends = [[answer[where], *(slow[key][k] for key in ("h_min", "relative_misalignment", "leakage"))]
            for where, k in (("begin", 0), ("end", -1))]  # fmt: skip
    columns = [(answer["unit"], answer["key"]), ("h_min", "film"), ("misalignment", "misalignment"),
               ("leakage", "leakage")]  # fmt: skip
    return [Table("ramps", [name[:2] for name in names], rows), Table("infinitely slowly", columns, ends)]


def _load_notes(answer) -> list[str]:
    """How fast the linear seal forgets, values without a balance, and how runs ended."""
    slowest, slow, notes = answer["slowest"], answer["quasi_static"], []
    if slowest < 0:
        notes.append(f"Disturbances of the linear seal fall to 1/e within {in_words('time', -1 / slowest, digits=3)}.")
    else:
        notes.append(f"The linear seal is unstable there: its disturbances grow by {slowest:.3g} 1/s.")
    if None in slow["h_min"]:
        notes.append("At some values no gap balances the loads.")
    if any(row["rate"] is None for row in answer["rows"]):
        notes.append("The ramp without a rate is a step.")
    return [*notes, *dict.fromkeys(r["message"] for r in answer["rows"] if r.get("status", Status.OK) != Status.OK)]
