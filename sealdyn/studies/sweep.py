"""Sweep: any scenario keys over any grid or list, any numbers of the run's summary."""

import contextlib
import itertools
import math
from collections import Counter
from dataclasses import dataclass
from functools import partial

import numpy as np

from ..answers import Answer, Axis, Panel, Series, Table
from ..numerics.parallel import Together
from ..quantities import QUANTITIES, in_words
from ..scenario.errors import ScenarioError
from ..scenario.settings import MOST, axis, with_own_unit
from ..scene.radial import RadialScene
from ..scene.scene import SceneError
from ..simulation.batch import first_ready, refuse_outputs, rows_alike, run_many
from ..simulation.result import START, common_outputs, unit_of, with_choices, without_equal_choices
from ..status import Status
from . import Info

INFO = Info(
    timed=("fms_reference --vary rotor.runout=0:1mrad:21", 2),
    asks="How do the numbers of a run follow a key?",
    seals="any",
    wavy=True,
    grooved=True,
)
# Seconds of a run at least, bytes of its row.
LEAST, ROW, GIGABYTE = 2e-3, 500, 1e9
# Changes over a grid of fewer of the accuracy's errors than this may be errors.
NEAR = 5.0
# Outputs that are drawn.
DRAWN = 9
# A power law is looked for in so many points at least, over such a ratio of the key and such a one of the output; of
# the range of its logarithm, how far it may be off.
FEW, WIDE, MOVED, OFF = 4, 1.5, 1.05, 0.03


@dataclass(frozen=True)
class Settings:
    """The grid, and what is asked at each point."""

    vary: list[str] | str = ()
    """"key=from:to:count" (":log" at its end for even ratios) or "key=a,b,c"; a number without a unit takes that of
    its neighbours, none means SI; several make a grid."""
    outputs: list[str] | str = ()
    """Dotted keys of the run's summary (`run --json` shows all); without them the usual ones of the kind of seal."""


def run(scenario, settings, tools) -> Answer:
    """One short run at every point of the grid; the first key varies slowest."""
    vary = [settings.vary] if isinstance(settings.vary, str) else list(settings.vary)
    if not vary:
        raise ScenarioError(scenario.name, "study.sweep.vary", "nothing to vary", '--vary "rotor.runout=0:1 mrad:21"')
    outputs = settings.outputs or common_outputs(scenario.scene)
    outputs = [w.strip() for w in outputs.split(",")] if isinstance(outputs, str) else list(outputs)
    axes = [axis(words, scenario.name, "study.sweep.vary") for words in vary]
    keys = [a["key"] for a in axes]
    if len(set(keys)) < len(keys):
        raise ScenarioError(scenario.name, "study.sweep.vary", f"keys {', '.join(keys)}", "each key once")
    count = math.prod(len(a["given"]) for a in axes)
    if count > MOST:
        spent = in_words("time", count * LEAST, digits=2)
        size = f"a grid of {count:.3g} runs: {spent} at least, {count * ROW / GIGABYTE:.2g} GB"
        raise ScenarioError(scenario.name, "study.sweep.vary", size, f"at most {MOST:g} runs; sweep a part at a time")
    grid = [dict(zip(keys, values, strict=True)) for values in itertools.product(*(a["given"] for a in axes))]
    # What is wrong with every point is found before any is run; a point that cannot run is a row.
    model = None
    with contextlib.suppress(SceneError):
        model = first_ready(scenario, grid).model
    refuse_outputs(scenario, grid, outputs, "study.sweep.outputs")
    asked = with_choices(scenario.scene, outputs)
    points = [{"outputs": asked, "set": values} for values in grid]
    found = rows_alike(scenario, Together(partial(run_many, scenario)), points, partial(tools.map, what="runs"))
    outputs = without_equal_choices(found, asked, outputs, keys)
    unlike = len({row[START] for row in found if row.get(START)}) > 1 and "run.start" not in keys
    places = itertools.product(*(a["values"] for a in axes))
    rows = [{**dict(zip(keys, place, strict=True)), **row} for place, row in zip(places, found, strict=True)]
    numbers = {
        "keys": keys,
        "axes": [with_own_unit(scenario.scene, a) for a in axes],
        "outputs": outputs,
        "output_units": {o: unit_of(o) for o in outputs},
    }
    if all("failed" in row for row in rows):
        numbers["status"] = Status.FAILED
    numbers["rows"] = rows
    ends = counted([_end(row) for row in rows])
    found, notes = f"{len(rows)} points over {' and '.join(keys)}: {ends}.", []
    if unlike:
        notes.append(
            f"No one start is possible for all points ({START}): extremes of the whole run do not compare, settled "
            "ones do (h_min.steady)."
        )
    if lost := unresolved(outputs, rows, model):
        names = (f"{name} ({in_words(quantity_of(name), error, digits=3)})" for name, error in lost.items())
        short = f"by little more than run.accuracy = {model.accuracy:g} lets err; a smaller one would tell"
        notes.append(f"Over the grid {', '.join(names)} change {short}.")
    return Answer(numbers, found, _tables(numbers, lost), _panels(numbers), notes)


def quantity_of(output: str) -> str:
    """The quantity, or SI unit, of an output of a run's summary."""
    last = output.split(".")[-1]
    return last if last in QUANTITIES and QUANTITIES[last].unit == unit_of(output) else unit_of(output) or "1"


def quantity_along(axis: dict) -> str:
    """The unit in which the values of a key are: as written, or SI; "1" of words and pure numbers."""
    unit = axis["unit"] or axis["si"]
    return "1" if axis["unit"] is None or unit == "SI" else unit


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


def _tables(numbers, lost) -> list[Table]:
    """A row a point; over one key, how each output follows it; over several, the range of each output."""
    rows, axes, outputs = numbers["rows"], numbers["axes"], numbers["outputs"]
    columns = [(quantity_along(axis), axis["key"]) for axis in axes]
    columns += [(quantity_of(output), output) for output in outputs] + [("1", "status")]
    cells = [[*(row[a["key"]] for a in axes), *(row.get(o) for o in outputs), _end(row)] for row in rows]
    tables = [Table("points", columns, cells)]
    followed = [output for output in outputs if any(_is_number(row.get(output)) for row in rows)]
    if not followed or len(rows) == 1:
        return tables
    at = (quantity_along(axes[0]), f"at {axes[0]['key']}")
    names = [("1", "output"), ("row", "least"), at, ("row", "largest"), at, ("1", "power of the key")]
    ranges = [_range(numbers, output, output in lost) for output in followed]
    return [*tables, Table("ranges", names, ranges, of_rows=[quantity_of(output) for output in followed])]


def _range(numbers, output: str, lost: bool) -> list:
    """Least and largest value of an output, where along the first key they are, and the power with which it follows the
    only key, unless that is `lost` in the errors."""
    key = numbers["axes"][0]["key"]
    rows = [row for row in numbers["rows"] if _is_number(row.get(output))]
    low, high = (end(rows, key=lambda row: row[output]) for end in (min, max))
    power, points = None, [(row[key], row[output]) for row in rows if _is_number(row[key])]
    if points and len(numbers["keys"]) == 1 and not lost:
        power = power_law(*np.array(points, float).T)
    return [output, low[output], low[key], high[output], high[key], power]


def power_law(x, y) -> float | None:
    """The power with which y (m,) follows x (m,), None where it follows none."""
    if len(x) < FEW or np.min(x) <= 0.0 or np.min(y) * np.max(y) <= 0.0:
        return None
    far, high = np.log(x), np.log(np.abs(y))
    if np.ptp(far) < math.log(WIDE) or np.ptp(high) < math.log(MOVED):
        return None
    power, start = np.polyfit(far, high, 1)
    fits = np.max(np.abs(power * far + start - high)) <= OFF * np.ptp(high)
    return float(power) if fits else None


# --- panels ----------------------------------------------------------------------------------------------


def along(axis: dict) -> tuple[Axis, list]:
    """The axis of a key, and the places of its values on it: words are counted."""
    if axis["unit"] is None:
        return Axis("1", axis["key"], words=[str(value) for value in axis["values"]]), list(range(len(axis["values"])))
    return Axis(quantity_along(axis), axis["key"]), list(axis["values"])


def _panels(numbers) -> list[Panel]:
    """A panel an output: a line over one key, a map over two."""
    axes, keys, outputs = numbers["axes"], numbers["keys"], list(dict.fromkeys(numbers["outputs"]))[:DRAWN]
    panels = []
    for output in outputs:
        raw = [row.get(output) for row in numbers["rows"]]
        words = list(dict.fromkeys(value for value in raw if isinstance(value, str)))
        values = [words.index(value) if isinstance(value, str) else value for value in raw]
        if len(keys) > 2 or all(value is None for value in values):
            why = "more than two keys: see the table in the archive" if len(keys) > 2 else "no value at any point"
            panels.append(Panel(output, note=why))
            continue
        scale = Axis("1", " ", words=words) if words else Axis(quantity_of(output), " ")
        x, places = along(axes[0])
        if len(keys) == 1:
            lost = [at for at, value in zip(places, values, strict=True) if value is None]
            series = [
                Series("marks" if words or axes[0]["unit"] is None else "line", places, values, style="blue circle")
            ]
            foot = min((v for v in values if v is not None), default=0.0)
            if lost:
                series.append(Series("marks", lost, [foot] * len(lost), label="no value", style="contact cross"))
            panels.append(Panel(output, x, scale, series))
        else:
            y, heights = along(axes[1])
            cells = np.array(values, dtype=object).reshape(len(places), len(heights)).T.tolist()
            panels.append(Panel(output, x, y, [Series("map", places, heights, cells)], colour=scale))
    return panels


def _end(row) -> str:
    """How a point ended."""
    return row.get("status", "not possible")


def _is_number(value) -> bool:
    return isinstance(value, int | float) and not isinstance(value, bool)


def counted(words) -> str:
    """How often each word is there: "20 ok, 1 collapsed"."""
    return ", ".join(f"{count} {word}" for word, count in Counter(words).items())
