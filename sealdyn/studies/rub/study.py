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
from ...dynamics import modes
from ...dynamics.equilibrium import initially
from ...numerics import time_series
from ...numerics.lyapunov import horizon
from ...scenario.errors import ScenarioError
from ...scenario.settings import axis
from ...scene.variants import part
from ...status import Status
from ...unit_names import dimension_and_factor
from ...units import Speed
from .statistics import evaluate_point, touch_level

WITH_CONTACT = True
# Speeds, relative to the critical one, at which a whirl is let go.
ABOVE = (1.02, 1.1, 1.3)
UNITS = {"rotor.runout": "rad", "rotor.misalignment": "rad", "stator.misalignment": "rad", "shaft.speed": "rad/s"}
units = {"rows/h_min": "m", "rows/section": "rad", "separation/apart": "of clearance/outer radius"}


@dataclass(frozen=True)
class Settings:
    """`key` grows over `values` ("from:to:count", any unit; default 0.6 to 1.2 times the scenario's): rotor.runout of a
    seal with a flexible stator, else stator.misalignment; `down`: also back again.  At each point `ramp` periods lead
    to it, `drop` pass and `keep` count; `exponent_turns` for its exponent.  `judge`: value at which two methods compare
    over `judge_turns` (default: where the exponent is largest; 0 turns: nowhere).  `whirl`: also where a small whirl of
    the unforced seal settles, at `whirl_speeds` (default 1.02, 1.1 and 1.3 of the critical speed)."""

    __pydantic_config__ = {"extra": "forbid"}  # noqa: RUF012

    key: str | None = None
    values: str | None = None
    down: bool = False
    ramp: int = 15
    drop: int = 80
    keep: int = 96
    exponent_turns: int = 200
    judge: float | str | None = None
    judge_turns: int = 600
    accuracy: float = 1e-6
    whirl: bool = False
    whirl_speeds: tuple[Speed, ...] = ()


def run(scenario, settings, tools) -> dict:
    """Diagram, judgement where it is needed, and the fate of whirl if asked."""
    if scenario.scene.contact is None:
        raise ScenarioError(scenario.name, "contact", "nothing", "a [contact] table: there is no rub without")
    key = settings.key or ("rotor.runout" if scenario.scene.stator.support else "stator.misalignment")
    values = _values(scenario, key, settings)
    base = {"key": key} | {n: getattr(settings, n) for n in ("ramp", "drop", "keep", "exponent_turns", "accuracy")}
    chains = [{**base, "direction": "up", "values": values}]
    if settings.down:
        chains.append({**base, "direction": "down", "values": values[::-1]})
    found = tools.map(partial(sweep_branch, scenario.scene), chains, "chain")
    failed = [row["failed"] for row in found if "failed" in row]
    rows = [row for part in found for row in part.get("rows", [])]
    answer = {"key": key, "touch": touch_level(scenario.scene), "rows": rows, "reason": failed}
    answer |= _judged(base, rows, settings, scenario, tools)
    answer["whirl"] = _whirled(base, scenario, settings, tools) if settings.whirl else None
    if not any(row["status"] == Status.OK for row in rows):
        answer["status"] = Status.FAILED
    return {**answer, "verdict": sentences(answer)}


def _values(scenario, key, settings) -> list[float]:
    """The points in SI."""
    where = "study.rub.values"
    if settings.values is None:
        own = float(part(frozen_at_end(scenario.scene), key))
        if own == 0.0:
            raise ScenarioError(scenario.name, where, "nothing", f'"from:to:count", since {key} is zero')
        return [float(f"{v:.6g}") for v in np.linspace(0.6 * own, 1.2 * own, 13)]
    return _in_si(scenario, key, settings.values, where)


def _in_si(scenario, key, words, where) -> list[float]:
    """Numbers of an axis in SI.  Not by way of a scenario: its start need not be possible, a ramp leads there."""
    given = axis(f"{key}={words}", scenario.name, where)
    if given["unit"] is None:
        raise ScenarioError(scenario.name, where, repr(words), "numbers")
    factor = float(dimension_and_factor(given["unit"])[1]) if given["unit"] else 1.0
    return [float(f"{factor * v:.12g}") for v in given["values"]]


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
        (wanted,) = _in_si(scenario, base["key"], str(settings.judge), "study.rub.judge")
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
    pace = max((abs(mode.value) for mode in model.linear_scene().modes() if mode.kind == "tilt"), default=1.0)
    critical = modes.critical_speed(lambda w: model.linear_scene(speed=w), 1e-3 * pace, 1e3 * pace)
    if critical is None and not settings.whirl_speeds:
        return {"critical_speed": None, "rows": []}
    speeds = list(settings.whirl_speeds) or [float(f"{f * critical:.6g}") for f in ABOVE]
    rows = tools.map(partial(whirl, scenario.scene), [{**base, "speed": w} for w in speeds], "whirl")
    return {"critical_speed": critical, "rows": [{"speed": w, **row} for w, row in zip(speeds, rows, strict=True)]}


def whirl(scene, point: dict) -> dict:
    """Fate of a small whirl at one speed."""
    return settles(frozen_at_end(scene), point["speed"], point["accuracy"])


# --- in words ---------------------------------------------------------------------------------------------


def sentences(answer) -> list[str]:
    """The verdict."""
    rows, key, unit = answer["rows"], answer["key"], UNITS.get(answer["key"], "SI")
    lines = [*answer["reason"]]
    good = [row for row in rows if row["status"] == Status.OK]
    for direction in ("up", "down"):
        told = _runs([row for row in rows if row["direction"] == direction])
        lines += [f"{key} going {direction}: {told} ({unit})"] if told else []
    rubs = [row for row in good if row["contact_share"] > 0]
    if rubs:
        dear = max(rubs, key=lambda row: row["wall_time"])
        lines.append(
            f"rubbing: contact for {_range(rubs, 'contact_share', 100)} % of the time, carrying "
            f"{_range(rubs, 'contact_force', 100)} % of the closing force; a turn costs "
            f"{np.median([r['evaluations'] for r in rubs]):.0f} evaluations, "
            f"{1e3 * np.median([r['wall_time'] for r in rubs]):.2g} ms (at most {1e3 * dear['wall_time']:.2g} ms)"
        )
        steady = [row for row in rubs if row["class"] == "period 1"]
        if steady:
            last = steady[-1]
            first = max(last["lines"]["1"], 1e-300)
            shares = ", ".join(f"{n}x {100 * last['lines'][n] / first:.2g} %" for n in "234")
            lines.append(
                f"where it rubs with period 1 the spectrum has integer harmonics only ({shares} of 1x at "
                f"{key} = {last['value']:.4g} {unit}; off them {last['lines']['between']:.1g} of the power)"
            )
    lines += _two_answers(good, unit)
    chaotic = [row for row in good if row["class"] == "chaotic"]
    if rubs and not chaotic:
        most = max(rubs, key=lambda row: row["exponent"])
        lines.append(
            f"no chaos on this path: the largest exponent is {_exponent(most)} (at {most['value']:.4g} {unit})"
        )
    return [*lines, *_foretold(answer), *_fates(answer)]


def _two_answers(rows, unit) -> list[str]:
    """Values at which the motion depends on where it came from."""
    down = {row["value"]: row for row in rows if row["direction"] == "down"}
    pairs = [(row, down[row["value"]]) for row in rows if row["direction"] == "up" and row["value"] in down]
    differ = [(a, b) for a, b in pairs if a["class"] != b["class"]]
    if not differ:
        return ["up and down find the same motion at every value"] if pairs else []
    told = ", ".join(f"{a['value']:.4g} ({a['class']} going up, {b['class']} going down)" for a, b in differ[:4])
    return [f"several answers, or transients longer than study.rub.drop, in {unit}: {told}"]


def _runs(rows) -> str:
    """Classes along a path: "no contact to 0.2, period 1 to 0.3, ..."."""
    words = []
    for k, row in enumerate(rows):
        if k + 1 == len(rows) or rows[k + 1]["class"] != row["class"]:
            words.append(f"{row['class']} to {row['value']:.4g}")
    return ", ".join(words)


def _range(rows, name, factor) -> str:
    values = [factor * row[name] for row in rows]
    return f"{min(values):.3g} to {max(values):.3g}"


def _exponent(row) -> str:
    return f"{row['exponent']:+.3f} +- {row['uncertainty']:.3f} a period"


def _foretold(answer) -> list[str]:
    """Exponent by two methods, the horizon, and what holds beyond it."""
    judged, methods, separation = answer["judge"], answer["methods"], answer["separation"]
    if not judged:
        return []
    if "failed" in judged:
        return [f"two methods could not be compared at {judged['value']:.4g}: {judged['failed'][0]}"]
    unit = UNITS.get(answer["key"], "SI")
    one, other = methods["invariants"]["exponent"]["values"]
    u_one, u_other = methods["invariants"]["exponent"]["uncertainties"]
    lines = [
        f"at {answer['key']} = {judged['value']:.4g} {unit} the exponent is {one:.3f} +- {u_one:.3f} a period by two "
        f"Adams trajectories, {other:.3f} +- {u_other:.3f} by DOP853 tangents, over {judged['turns']} periods"
    ]
    if min(one - u_one, other - u_other) > 0:
        apart = max(separation["apart"][1:6])
        far = horizon(0.5 * (one + other), max(apart, 1e-16), max(separation["spread"], 1e-16))
        seen = "not within the run" if separation["lost"] is None else f"after {separation['lost']} periods"
        lines.append(
            f"chaos: an error of {apart:.1g} of the tilt scale fills the attractor in about {far:.0f} periods; two "
            f"correct runs, one {separation['accuracies'][0] / separation['accuracies'][1]:.0f} times tighter, part "
            f"{seen}; beyond, single trajectories mean nothing and averages are compared instead"
        )
    entries = methods["invariants"]
    wrong = [name for name, entry in entries.items() if not entry["agree"]]
    lines.append(f"{len(entries) - len(wrong)} of {len(entries)} averages agree between the methods within their "
                 "uncertainty" + (f"; not {', '.join(wrong)}" if wrong else ""))  # fmt: skip
    return lines


def _fates(answer) -> list[str]:
    told = answer["whirl"]
    if not told:
        return []
    if told["critical_speed"] is None and not told["rows"]:
        return ["no critical speed: the unforced seal does not whirl by itself"]
    lines = []
    for row in told["rows"]:
        if "failed" in row:
            lines.append(f"whirl at {row['speed']:.5g} rad/s: {row['failed']}")
            continue
        touch = "" if row["first_contact"] is None else f", first touch after {row['first_contact']} turns"
        rub = ""
        if row["fate"] == "rub":
            rub = (
                f" (whirl ratio {row['whirl_ratio']:.3f}, contact {100 * row['contact_share']:.3g} % of the time and "
                f"{100 * row['contact_force']:.3g} % of the closing force, {row['contact_power']:.3g} W)"
            )
        lines.append(f"a small whirl at {row['speed']:.5g} rad/s (critical {told['critical_speed'] or 0:.5g}): "
                     f"{row['fate']}{rub} in {row['turns']} turns{touch}")  # fmt: skip
    return lines
