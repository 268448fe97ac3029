"""Load support: how much of the closing force the film carries where the seal rests, over any key: pressure, width of
the face, roughness, number and amplitude of waves, depth and angle of grooves; with friction, leakage, clearance,
cavities, stiffness, and the stiffness over the leakage, by which gas seals are laid out."""

from dataclasses import dataclass
from functools import partial

from ..answers import Answer, Axis, Panel, Series, Table, table_of
from ..quantities import in_words
from ..scenario.errors import ScenarioError
from ..scenario.reader import with_values
from ..scenario.settings import axis, with_own_unit
from ..scene.scene import frozen_at_start
from . import Info
from .equilibrium import find, resting, root_row
from .sweep import along, quantity_along

OUTPUTS = {"clearance": "m", "load_support": "1", "friction_coefficient": "1", "leakage": "m^3/s",
           "cavitated_fraction": "1", "film_force": "N", "contact_force": "N", "stiffness": "N/m",
           "stiffness_over_leakage": "N*s/m^4"}  # fmt: skip
INFO = Info(
    timed=("lebeck_n3 --vary contact.roughness=0.1:0.4um:7", 3),
    asks="How much of the load does the film carry?",
    wavy=True,
    grooved=True,
    aligned=True,
    units={
        **OUTPUTS,
        # Of the balances within the rows.
        "torque": "N*m", "mass_flow": "kg/s", "held": "m", "rows": "1",
        **dict.fromkeys(("wear_rate", "standing", "travelling"), "m/s"),
    },
)  # fmt: skip
# Outputs that are drawn: name, quantity, words, style.
DRAWN = (
    ("load_support", "share", "load support above low pressure", "film"),
    ("friction_coefficient", "1", "friction coefficient", "contact"),
    ("leakage", "leakage", "leakage", "blue"),
    ("clearance", "clearance", "clearance", "good"),
)
STIFFNESS = ("stiffness", "axial_stiffness", "axial stiffness", "film")


@dataclass(frozen=True)
class Settings:
    """What is varied, faces aligned."""

    vary: str = ""
    """One key and its values: "key=from:to:count" (":log" at its end for even ratios) or "key=a,b,c", as in a sweep."""


def run(scenario, settings, tools) -> Answer:
    """All balances at every value of the key."""
    where = "study.load_support.vary"
    if not settings.vary:
        raise ScenarioError(scenario.name, where, "nothing to vary", '--vary "contact.roughness=0.1:0.5 um:9"')
    key = axis(settings.vary, scenario.name, where)
    values = [{key["key"]: given} for given in key["given"]]
    # A key that there is not is found out before any point.
    with_values(scenario, values[0])
    found = tools.map(partial(balances, scenario), values, "balances")
    rows = [{key["key"]: value, **row} for value, row in zip(key["values"], found, strict=True)]
    numbers = {
        "keys": [key["key"]],
        "axes": [with_own_unit(scenario.scene, key)],
        "outputs": list(OUTPUTS),
        "output_units": OUTPUTS,
        "rows": rows,
    }
    return Answer(numbers, _found(numbers), [_table(numbers)], _panels(numbers), _notes(numbers))


def balances(scenario, values) -> dict:
    """OUTPUTS of a scenario with other `values`, {dotted key: as written}, where it rests: at the widest stable of its
    `roots`, which are those of the study equilibrium.  Raises ScenarioError or SceneError."""
    given = frozen_at_start(with_values(scenario, values).scene)
    scene = resting(given)
    found = find(scene)
    roots = [_with_ratio(root_row(scene, root, found)) for root in found.roots]
    stable = [root for root in roots if root["stable"]]
    rest = stable[-1] if stable else dict.fromkeys(OUTPUTS)
    said = {"status": "ok"} if stable else {"status": "no balance", "message": "nothing holds the faces apart"}
    # What is given decides what a balance is.
    held = {"closing_said": found.said} if given.film.clearance is not None else {}
    return {**said, **held, **{output: rest[output] for output in OUTPUTS}, "roots": roots}


def _with_ratio(root: dict) -> dict:
    """A balance with its stiffness over the leakage, None without either."""
    leaks = root["leakage"] and root["stiffness"] is not None
    return root | {"stiffness_over_leakage": root["stiffness"] / abs(root["leakage"]) if leaks else None}


def _rubs(numbers) -> bool:
    """Whether asperities carry anything anywhere."""
    return any(root["contact_force"] for row in numbers["rows"] for root in row.get("roots", ()))


def _found(numbers) -> str:
    """From which to which share of the load the film carries; where it carries all, how stiff it is."""
    (key,), rows = numbers["axes"], numbers["rows"]
    known = [(row[key["key"]], row["load_support"]) for row in rows if row.get("load_support") is not None]
    if not known:
        return f"Nothing holds the faces apart at any value of {key['key']}."
    if not _rubs(numbers):
        stiff = [row for row in rows if row.get("stiffness_over_leakage") is not None]
        if not stiff:
            return "The film carries all of the closing force above the lower pressure."
        most, best = (max(stiff, key=lambda row: row[name]) for name in ("stiffness", "stiffness_over_leakage"))
        return (
            f"The film carries the closing force alone, stiffest, {in_words('axial_stiffness', most['stiffness'])}, at "
            f"{_value(key, most[key['key']])}, and stiffest for what leaks at {_value(key, best[key['key']])}."
        )
    ends = (min(known, key=lambda pair: pair[1]), max(known, key=lambda pair: pair[1]))
    least, most = (f"{in_words('share', share)} at {_value(key, at)}" for at, share in ends)
    return f"Of the closing force above the lower pressure the film carries {least} to {most}."


def _value(key, value) -> str:
    """A value of the key with its unit."""
    return value if isinstance(value, str) else f"{value:.4g} {key['unit'] or ''}".strip()


def _table(numbers) -> Table:
    """A row for every balance; the seal rides at the widest stable one.  Contact and cavities where there are any."""
    (key,), rubs = numbers["axes"], _rubs(numbers)
    torn = any(root["cavitated_fraction"] for row in numbers["rows"] for root in row.get("roots", ()))
    columns = (
        (quantity_along(key), key["key"], "value"), ("clearance", "clearance", "clearance"), ("1", "stable", "stable"),
        *([("share", "load support", "load_support"), ("force", "by contact", "contact_force")] if rubs else []),
        ("1", "friction coefficient", "friction_coefficient"), ("leakage", "leakage", "leakage"),
        ("axial_stiffness", "stiffness", "stiffness"),
        *([("cavitated_fraction", "cavity", "cavitated_fraction")] if torn else []),
        ("1", "without a balance", "lost"),
    )  # fmt: skip
    rows = [
        {**root, "value": row[key["key"]], "lost": row.get("failed") or row.get("message")}
        for row in numbers["rows"]
        for root in row.get("roots") or [{}]
    ]
    return table_of("balances", columns, rows)


def _notes(numbers) -> list[str]:
    """What is held at each value, and what is counted of several balances."""
    rows = numbers["rows"]
    notes = [f"At each value the {row['closing_said']}." for row in rows if row.get("closing_said")][:1]
    if any(sum(root["stable"] for root in row.get("roots", ())) > 1 for row in rows):
        notes.append("Where several balances are stable, the widest is counted.")
    return notes


def _panels(numbers) -> list[Panel]:
    """Four panels over the key: where the seal rides joined, other balances as marks, cavities below the load."""
    (key,), rows = numbers["axes"], numbers["rows"]
    (x, places), panels = along(key), []
    torn = [row.get("cavitated_fraction") for row in rows]
    for output, quantity, words, colour in (*(DRAWN[:1] if _rubs(numbers) else [STIFFNESS]), *DRAWN[1:]):
        rest = [row.get(output) for row in rows]
        if all(value is None for value in rest):
            panels.append(Panel(words, note="no balance at any value"))
            continue
        series = [Series("line", places, rest, label="where it rides", style=f"{colour} circle")]
        if output == "load_support" and any(torn):
            series.append(Series("shade", places, torn, label="of the face cavitates", style="leakage"))
        for stable, label, style in ((True, "another stable balance", "fourth circle"),
                                     (False, "unstable balance", "black cross")):  # fmt: skip
            more = [(at, root[output]) for at, row in zip(places, rows, strict=True) for root in row.get("roots", ())
                    if root["stable"] == stable and root[output] not in (None, row[output])]  # fmt: skip
            if more:
                series.append(Series("marks", *zip(*more, strict=True), label=label, style=style))
        panels.append(Panel(words, x, Axis(quantity, words, low=0.0), series))
    return panels
