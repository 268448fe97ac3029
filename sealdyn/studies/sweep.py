"""Sweep: any scenario keys over any grid or list, any numbers of the run's summary."""

import contextlib
import difflib
import itertools
from dataclasses import dataclass
from functools import partial

from ..scenario.errors import ScenarioError
from ..scenario.settings import axis, with_values
from ..scene.scene import SceneError
from ..simulation.simulate import prepare_run, simulate_in_memory
from ..status import Status

WITH_CONTACT = WITH_WAVES = True
OUTPUTS = (
    "h_min.value",
    "h_min.of_clearance",
    "relative_misalignment.max",
    "relative_misalignment.steady_max",
    "leakage.mean",
    "friction.power",
    "contact_margin",
    "stability.verdict",
)
# What of the summary is found only if it is among the outputs.
SPEEDS = ("critical_speed", "resonance_speeds")
UNITS = {
    "h_min.value": "m", "h_min.time": "s", "h_min.theta": "rad", "h_min.radius": "m", "relative_misalignment": "rad",
    "leakage.mean": "m^3/s", "leakage.max": "m^3/s", "leakage.mean_ml_per_h": "ml/h", "friction.torque": "N m",
    "friction.power": "W", "friction.max_power": "W", "stability.critical_speed": "rad/s", "film.clearance": "m",
    "stability.growth_rate": "1/s", "film.axial_stiffness": "N/m", "film.tilt_stiffness": "N m/rad",
    "film.axial_damping": "N s/m", "film.tilt_damping": "N m s/rad", "closing.force": "N",
}  # fmt: skip


@dataclass(frozen=True)
class Settings:
    """`vary`: "key=from:to:count" (":log" at its end for even ratios) or "key=a,b,c"; a number without a unit takes
    that of its neighbours, none means SI; several make a grid.  `outputs`: dotted keys of the run's summary."""

    vary: list[str] | str = ()
    outputs: list[str] | str = OUTPUTS


def run(scenario, settings, tools) -> dict:
    """One short run at every point of the grid; the first key varies slowest."""
    vary = [settings.vary] if isinstance(settings.vary, str) else list(settings.vary)
    if not vary:
        raise ScenarioError(scenario.name, "study.sweep.vary", "nothing to vary", '--vary "rotor.runout=0:1 mrad:21"')
    outputs = settings.outputs
    outputs = [w.strip() for w in outputs.split(",")] if isinstance(outputs, str) else list(outputs)
    axes = [axis(words, scenario.name, "study.sweep.vary") for words in vary]
    keys = [a["key"] for a in axes]
    if len(set(keys)) < len(keys):
        raise ScenarioError(scenario.name, "study.sweep.vary", f"keys {', '.join(keys)}", "each key once")
    grid = [dict(zip(keys, values, strict=True)) for values in itertools.product(*(a["given"] for a in axes))]
    make_ready(scenario, grid)
    found = tools.map(partial(one_run, scenario), [{"outputs": outputs, "set": values} for values in grid], "runs")
    places = itertools.product(*(a["values"] for a in axes))
    rows = [{**dict(zip(keys, place, strict=True)), **row} for place, row in zip(places, found, strict=True)]
    answer = {"keys": keys, "axes": axes, "outputs": outputs, "output_units": {o: unit_of(o) for o in outputs}}
    return {**answer, "rows": rows, "verdict": sentences(keys, rows)}


def one_run(scenario, point: dict) -> dict:
    """The outputs of one point's run, its status, and its message when it did not end well."""
    speeds = any(name in key for key in point["outputs"] for name in SPEEDS)
    summary = simulate_in_memory(with_values(scenario, point["set"]), speeds)
    row = {"status": summary["status"], **{key: looked_up(summary, key) for key in point["outputs"]}}
    return row if summary["status"] == Status.OK else {**row, "message": summary["message"]}


def looked_up(summary: dict, key: str):
    """The value at a dotted key of the summary; ValueError names the nearest key there is."""
    place = summary
    for part in key.split("."):
        if not isinstance(place, dict) or part not in place:
            known = [*leaves(summary), *(f"stability.{name}" for name in SPEEDS)]
            near = difflib.get_close_matches(key, known, 1, 0.3)
            raise ValueError(f"the run's summary has no {key}" + (f"; nearest {near[0]}" if near else ""))
        place = place[part]
    if isinstance(place, dict):
        raise ValueError(f"{key} holds several numbers: one of {', '.join(f'{key}.{k}' for k in place)}")
    return place


def leaves(tree: dict, key: str = "") -> list[str]:
    """Dotted keys of all values."""
    found = []
    for name, below in tree.items():
        found += leaves(below, f"{key}{name}.") if isinstance(below, dict) else [f"{key}{name}"]
    return found


def make_ready(scenario, grid):
    """Find what is wrong with every point before any is run, and have the kernels loaded once for all processes.
    Raises the first point's error if no point can be read."""
    first = None
    for values in grid:
        try:
            ready = with_values(scenario, values)
        except ScenarioError as error:
            first = first or error
            continue
        with contextlib.suppress(SceneError):
            prepare_run(ready)
        return
    raise first


def unit_of(output: str) -> str:
    return UNITS.get(output) or UNITS.get(output.partition(".")[0]) or ""


def sentences(keys, rows) -> list[str]:
    """The verdict: how many points ended how."""
    ends = counted([row.get("status", "not possible") for row in rows])
    return [f"{len(rows)} points over {' and '.join(keys)}: {ends}."]


def tables(answer) -> list:
    """The range of each output, or how often it has which word."""
    ranges = []
    for output in answer["outputs"]:
        values = [row[output] for row in answer["rows"] if row.get(output) is not None]
        numbers = bool(values) and all(isinstance(v, int | float) for v in values)
        ends = {"least": min(values), "largest": max(values)} if numbers else {"least": counted(values) or "none"}
        ranges.append({"output": output, **ends, "unit": unit_of(output)})
    return [(ranges, tuple((name, name) for name in ("output", "least", "largest", "unit")))]


def counted(words) -> str:
    """How often each word is there: "20 ok, 1 collapsed"."""
    return ", ".join(f"{words.count(word)} {word}" for word in dict.fromkeys(words))
