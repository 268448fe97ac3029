"""Sweep: any scenario keys over any grid or list, any numbers of the run's summary."""

import contextlib
import itertools
import math
from dataclasses import dataclass
from functools import partial

import numpy as np

from ..numerics.parallel import Together
from ..scenario.errors import ScenarioError
from ..scenario.settings import MOST, axis, with_own_unit
from ..scene.radial import RadialScene
from ..scene.scene import SceneError
from ..simulation.batch import first_ready, refuse_outputs, run_many
from ..simulation.result import common, unit_of
from ..status import Status
from ._trends import trend
from ._words import WEAR, plain, quantity, shown_in

WITH_WAVES = True
# Of radial seals as of face seals.
ANY_SEAL = True
# Seconds of a run at least, bytes of its row.
LEAST, ROW = 2e-3, 500
# Changes over a grid of fewer of the accuracy's errors than this may be errors.
NEAR = 5.0
# Values of the key in the table.
COLUMNS = 10


# A scenario (and flags) with which the default settings take so much processor time (s) on one core.
TIMED = ("fms_reference --vary rotor.runout=0:1mrad:21", 2)


@dataclass(frozen=True)
class Settings:
    """The grid, and what is asked at each point."""

    vary: list[str] | str = ()
    """"key=from:to:count" (":log" at its end for even ratios) or "key=a,b,c"; a number without a unit takes that of
    its neighbours, none means SI; several make a grid."""
    outputs: list[str] | str = ()
    """Dotted keys of the run's summary (`run --json` shows all); without them the usual ones of the kind of seal."""


def run(scenario, settings, tools) -> dict:
    """One short run at every point of the grid; the first key varies slowest."""
    vary = [settings.vary] if isinstance(settings.vary, str) else list(settings.vary)
    if not vary:
        raise ScenarioError(scenario.name, "study.sweep.vary", "nothing to vary", '--vary "rotor.runout=0:1 mrad:21"')
    outputs = settings.outputs or common(scenario.scene)
    outputs = [w.strip() for w in outputs.split(",")] if isinstance(outputs, str) else list(outputs)
    axes = [axis(words, scenario.name, "study.sweep.vary") for words in vary]
    keys = [a["key"] for a in axes]
    if len(set(keys)) < len(keys):
        raise ScenarioError(scenario.name, "study.sweep.vary", f"keys {', '.join(keys)}", "each key once")
    count = math.prod(len(a["given"]) for a in axes)
    if count > MOST:
        size = f"a grid of {count:.3g} runs: {count * LEAST / 3600:.2g} h at least, {count * ROW / 1e9:.2g} GB"
        raise ScenarioError(scenario.name, "study.sweep.vary", size, f"at most {MOST:g} runs; sweep a part at a time")
    grid = [dict(zip(keys, values, strict=True)) for values in itertools.product(*(a["given"] for a in axes))]
    # What is wrong with every point is found before any is run; a point that cannot run is a row.
    model = None
    with contextlib.suppress(SceneError):
        model = first_ready(scenario, grid).model
    refuse_outputs(scenario, grid, outputs, "study.sweep.outputs")
    found = tools.map(
        Together(partial(run_many, scenario)), [{"outputs": outputs, "set": values} for values in grid], "runs"
    )
    places = itertools.product(*(a["values"] for a in axes))
    rows = [{**dict(zip(keys, place, strict=True)), **row} for place, row in zip(places, found, strict=True)]
    answer = {
        "keys": keys,
        "axes": [with_own_unit(scenario.scene, a) for a in axes],
        "outputs": outputs,
        "output_units": {o: unit_of(o) for o in outputs},
    }
    if all("failed" in row for row in rows):
        answer["status"] = Status.FAILED
    answer["rows"] = rows
    return {**answer, "verdict": sentences(answer, unresolved(outputs, rows, model), model and model.accuracy)}


def sentences(answer, lost, accuracy) -> list[str]:
    """The verdict: how many points ended how, what over one key follows it and how, and what of the changes is `lost`
    {output: error of the runs' `accuracy`}."""
    keys, rows, units = answer["keys"], answer["rows"], answer["output_units"]
    ends = counted([_end(row) for row in rows])
    said = [f"{len(rows)} points over {' and '.join(keys)}: {ends}."]
    for output in (name for name in answer["outputs"] if name not in lost and len(keys) == 1):
        (along,) = answer["axes"]
        points = [(row[keys[0]], row[output]) for row in rows if all(map(_is_number, (row[keys[0]], row.get(output))))]
        said.append(trend(output, keys[0], along["unit"], points, shown_of(output, units, [y for _, y in points])))
    if lost:
        short = f"by little more than run.accuracy = {accuracy:g} lets err; a smaller one would tell"
        names = (f"{output} ({quantity(error, units[output], 3)})" for output, error in lost.items())
        said.append(f"Over the grid {', '.join(names)} change {short}.")
    return [words for words in said if words]


def shown_of(output, units, values) -> tuple[str, float]:
    """The unit in which people read the `values` (SI) of an output, and its factor."""
    return WEAR if output.endswith("wear_rate") else shown_in(units.get(output, ""), values)


def unresolved(outputs, rows, model) -> dict[str, float]:
    """Outputs that change over the grid by so little that the asked accuracy of the runs may be all of it, and what it
    lets err of them (SI)."""
    if model is None or isinstance(model.scene, RadialScene):
        return {}
    tilt = model.clearance / model.scene.film.outer_radius
    scales = {"h_min.value": model.clearance, "h_min.of_clearance": 1.0}
    scales |= {f"relative_misalignment.{name}": tilt for name in ("max", "min", "mean", "steady_max", "steady_min")}
    lost = {}
    for output in (name for name in outputs if name in scales):
        values, error = [row[output] for row in rows if row.get(output) is not None], model.accuracy * scales[output]
        if values and 0.0 < max(values) - min(values) < NEAR * error:
            lost[output] = error
    return lost


def tables(answer) -> list:
    """Over one key a line for each output, with at most COLUMNS of its values; over several the range of each output,
    or how often it has which word."""
    rows = answer["rows"]
    if len(answer["keys"]) > 1 or all("failed" in row for row in rows):
        return [_ranges(answer)]
    (along,) = answer["axes"]
    few = sorted({round(k) for k in np.linspace(0, len(rows) - 1, min(COLUMNS, len(rows)))})
    names = [*answer["outputs"], *(["status"] if any(_end(row) != Status.OK for row in rows) else [])]
    lines = [_line(answer, name, [rows[k] for k in few]) for name in names]
    unit, part = along["unit"], f" ({len(few)} of {len(rows)})" if len(few) < len(rows) else ""
    values = [value if isinstance(value, str) else plain(value, 4) for value in (rows[k][along["key"]] for k in few)]
    heading = f"{along['key']}{f', {unit}' if unit else ''}{part}"
    columns = [(value, str(k)) for k, value in enumerate(values)]
    return [(lines, ((heading, "output"), ("unit", "unit"), *columns))]


def _line(answer, name, rows) -> dict:
    """An output in its unit at some rows, counted."""
    if name == "status":
        return {"output": name, **{str(k): _end(row) for k, row in enumerate(rows)}}
    found = [row.get(name) for row in answer["rows"]]
    unit, factor = shown_of(name, answer["output_units"], [value for value in found if _is_number(value)])
    values = [row.get(name) for row in rows]
    told = {str(k): factor * value if _is_number(value) else value for k, value in enumerate(values)}
    return {"output": name, "unit": unit if any(map(_is_number, found)) else "", **told}


def _ranges(answer):
    ranges = []
    for output in answer["outputs"]:
        values = [row[output] for row in answer["rows"] if row.get(output) is not None]
        numbers = bool(values) and all(map(_is_number, values))
        unit, factor = shown_of(output, answer["output_units"], values) if numbers else ("", 1.0)
        ends = {"least": counted(values) or "none"}
        ends = {"least": factor * min(values), "largest": factor * max(values)} if numbers else ends
        ranges.append({"output": output, **ends, "unit": unit})
    return ranges, tuple((name, name) for name in ("output", "least", "largest", "unit"))


def _end(row) -> str:
    """How a point ended."""
    return row.get("status", "not possible")


def _is_number(value) -> bool:
    return isinstance(value, int | float) and not isinstance(value, bool)


def counted(words) -> str:
    """How often each word is there: "20 ok, 1 collapsed"."""
    return ", ".join(f"{words.count(word)} {word}" for word in dict.fromkeys(words))
