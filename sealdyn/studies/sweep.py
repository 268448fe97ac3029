"""Sweep: any scenario keys over any grid or list, any numbers of the run's summary."""

import contextlib
import itertools
import math
from dataclasses import dataclass
from functools import partial

from ..numerics.parallel import Together
from ..scenario.errors import ScenarioError
from ..scenario.settings import MOST, axis, with_own_unit
from ..scene.radial import RadialScene
from ..scene.scene import SceneError
from ..simulation.batch import first_ready, refuse_outputs, run_many
from ..simulation.outputs import common, unit_of
from ..status import Status
from ._words import quantity, shown_in

WITH_WAVES = True
# Of radial seals as of face seals.
ANY_SEAL = True
# Seconds of a run at least, bytes of its row.
LEAST, ROW = 2e-3, 500
# Changes over a grid of fewer of the accuracy's errors than this may be errors.
NEAR = 5.0


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
    return {**answer, "rows": rows, "verdict": [*sentences(keys, rows), *unresolved(outputs, rows, model)]}


def sentences(keys, rows) -> list[str]:
    """The verdict: how many points ended how."""
    ends = counted([row.get("status", "not possible") for row in rows])
    return [f"{len(rows)} points over {' and '.join(keys)}: {ends}."]


def unresolved(outputs, rows, model) -> list[str]:
    """Outputs that change over the grid by so little that the asked accuracy of the runs may be all of it."""
    if model is None or isinstance(model.scene, RadialScene):
        return []
    tilt = model.clearance / model.scene.film.outer_radius
    scales = {"h_min.value": model.clearance, "h_min.of_clearance": 1.0}
    scales |= {f"relative_misalignment.{name}": tilt for name in ("max", "min", "mean", "steady_max", "steady_min")}
    lost = []
    for output in (name for name in outputs if name in scales):
        values, error = [row[output] for row in rows if row.get(output) is not None], model.accuracy * scales[output]
        if values and 0.0 < max(values) - min(values) < NEAR * error:
            lost.append(f"{output} ({quantity(error, unit_of(output), 3)})")
    short = f"by little more than run.accuracy = {model.accuracy:g} lets err; a smaller one would tell"
    return [f"Over the grid {', '.join(lost)} change {short}."] if lost else []


def tables(answer) -> list:
    """The range of each output, or how often it has which word."""
    ranges = []
    for output in answer["outputs"]:
        values = [row[output] for row in answer["rows"] if row.get(output) is not None]
        numbers = bool(values) and all(isinstance(v, int | float) for v in values)
        unit, factor = shown_in(unit_of(output), values) if numbers else ("", 1.0)
        ends = {"least": counted(values) or "none"}
        ends = {"least": factor * min(values), "largest": factor * max(values)} if numbers else ends
        ranges.append({"output": output, **ends, "unit": unit})
    return [(ranges, tuple((name, name) for name in ("output", "least", "largest", "unit")))]


def counted(words) -> str:
    """How often each word is there: "20 ok, 1 collapsed"."""
    return ", ".join(f"{words.count(word)} {word}" for word in dict.fromkeys(words))
