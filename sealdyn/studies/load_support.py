"""Load support: how much of the closing force the film carries where the seal rests, over any key: pressure, width of
the face, roughness, number and amplitude of waves; with friction, leakage, clearance and cavities."""

from dataclasses import dataclass
from functools import partial

from ..scenario.errors import ScenarioError
from ..scenario.settings import axis, with_own_unit, with_values
from ..scene.scene import SceneError
from ..scene.variants import frozen_at_start
from ._words import shown_in
from .equilibrium import ABOVE, find, kept_waves, root_row

WITH_WAVES = True
OUTPUTS = {"clearance": "m", "load_support": "1", "friction_coefficient": "1", "leakage": "m^3/s",
           "cavitated_fraction": "1", "film_force": "N", "contact_force": "N"}  # fmt: skip
# Of the balances within the rows.
units = OUTPUTS | {"stiffness": "N/m", "mass_flow": "kg/s", "held": "m", "rows": "1"}
units |= dict.fromkeys(("wear_rate", "standing", "travelling"), "m/s")
SAID = (("load_support", f"Load support (share {ABOVE})", 100.0, " %"),
        ("friction_coefficient", "Friction coefficient (of that load)", 1.0, ""),
        ("leakage", "Leakage", None, ""))  # fmt: skip
# A film this much of whose face cavitates has a cavity, and what changes by less over the key stays.
TORN, STEADY = 1e-9, 0.02


# A scenario (and flags) with which the default settings take so much processor time (s) on one core.
TIMED = ("lebeck_n3 --vary contact.roughness=0.1:0.4um:7", 3)


@dataclass(frozen=True)
class Settings:
    """What is varied, faces aligned."""

    vary: str = ""
    """One key and its values: "key=from:to:count" (":log" at its end for even ratios) or "key=a,b,c", as in a sweep."""


def run(scenario, settings, tools) -> dict:
    """All balances at every value of the key."""
    where = "study.load_support.vary"
    if not settings.vary:
        raise ScenarioError(scenario.name, where, "nothing to vary", '--vary "contact.roughness=0.1:0.5 um:9"')
    along = axis(settings.vary, scenario.name, where)
    values = [{along["key"]: given} for given in along["given"]]
    # A key that there is not is found out before any point.
    with_values(scenario, values[0])
    found = tools.map(partial(balances, scenario), values, "balances")
    rows = [{along["key"]: value, **row} for value, row in zip(along["values"], found, strict=True)]
    answer = {
        "keys": [along["key"]],
        "axes": [with_own_unit(scenario.scene, along)],
        "outputs": list(OUTPUTS),
        "output_units": OUTPUTS,
        "rows": rows,
    }
    return answer | {"verdict": sentences(answer)}


def balances(scenario, values) -> dict:
    """OUTPUTS of a scenario with other `values`, {dotted key: as written}, where it rests: at the widest stable of its
    `roots`, which are those of the study equilibrium."""
    try:
        scene = kept_waves(frozen_at_start(with_values(scenario, values).scene))
        found = find(scene)
    except (ScenarioError, SceneError) as error:
        return {"failed": str(error)}
    roots = [root_row(scene, root, found) for root in found.roots]
    stable = [root for root in roots if root["stable"]]
    rest = stable[-1] if stable else dict.fromkeys(OUTPUTS)
    said = {"status": "ok"} if stable else {"status": "no balance", "message": "nothing holds the faces apart"}
    # What is given decides what a balance is.
    held = {"closing_said": found.said} if scene.film.clearance is not None else {}
    return {**said, **held, **{output: rest[output] for output in OUTPUTS}, "roots": roots}


def tables(answer) -> list:
    """A line for every balance."""
    (along,), unit = answer["axes"], answer["axes"][0]["unit"]
    rows = [{"value": row[along["key"]], **root} for row in answer["rows"] for root in row.get("roots", ())]
    flow, factor = shown_in("m^3/s", [row["leakage"] for row in rows])
    columns = ((along["key"] + (f", {unit}" if unit else ""), "value"), ("clearance, um", "clearance", 1e6),
               ("stable", "stable"), ("load support, % above low pressure", "load_support", 100),
               ("by contact, N", "contact_force"), ("friction coefficient", "friction_coefficient"),
               (f"leakage, {flow}", "leakage", factor), ("cavity, %", "cavitated_fraction", 100))  # fmt: skip
    return [(rows, columns)]


def sentences(answer) -> list[str]:
    """The verdict: the course of each output along the key, and where films cavitate or nothing holds the faces."""
    (along,), rows = answer["axes"], answer["rows"]
    said = [_course(answer, *line) for line in SAID]
    held = [row["closing_said"] for row in rows if row.get("closing_said")]
    said += [f"At each value the {held[0]}."] if held else []
    values, torn = along["values"], [(row.get("cavitated_fraction") or 0.0) > TORN for row in rows]
    if any(torn):
        where = [value for value, is_torn in zip(values, torn, strict=True) if is_torn]
        said.append(f"The film cavitates at {_listed(along, where)}.")
    several = [row[along["key"]] for row in rows if sum(root["stable"] for root in row.get("roots", ())) > 1]
    if several:
        said.append(f"More than one stable balance at {_listed(along, several)}: the widest is counted.")
    loose = [row[along["key"]] for row in rows if row.get("status") == "no balance"]
    if loose:
        said.append(f"Nothing holds the faces apart at {_listed(along, loose)}.")
    return [sentence for sentence in said if sentence]


def _course(answer, output, words, factor, unit) -> str:
    """From which to which value an output goes, where it turns, and whether it hardly changes."""
    (along,) = answer["axes"]
    rows = [row for row in answer["rows"] if row.get(output) is not None]
    if not rows:
        return ""
    if factor is None:
        unit, factor = shown_in(OUTPUTS[output], [row[output] for row in rows])
        unit = f" {unit}"
    known = [(row[along["key"]], factor * row[output]) for row in rows]
    (first, start), (last, end) = known[0], known[-1]
    (low_at, low), (high_at, high) = min(known, key=lambda at: at[1]), max(known, key=lambda at: at[1])
    said = f"{words} {start:.4g}{unit} at {_one(along, first)}, {end:.4g}{unit} at {_one(along, last)}"
    if high > max(start, end):
        said += f"; most, {high:.4g}{unit}, at {_one(along, high_at)}"
    if low < min(start, end):
        said += f"; least, {low:.4g}{unit}, at {_one(along, low_at)}"
    return said + (" (nearly constant)." if high - low <= STEADY * abs(high) else ".")


def _one(along, value) -> str:
    """A value of the key with its unit."""
    words = value if isinstance(value, str) else f"{value:.4g}"
    return f"{words} {along['unit'] or ''}".strip()


def _listed(along, values) -> str:
    """Values of the key: all of a few, or their range."""
    if len(values) > 3:
        return f"{len(values)} values from {_one(along, values[0])} to {_one(along, values[-1])}"
    return " and ".join(_one(along, value) for value in values)
