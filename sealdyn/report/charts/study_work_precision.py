"""Work and precision: error against processor time and right-hand sides by method, and by rung of the models."""

import math

import numpy as np

from ...answers import Axis, Level, Panel, Series
from ...archive import read_study
from ...status import Status
from ..panels import study_sheet
from ..text import solvers_words
from .page import save
from .record import MILLISECONDS

# Of a cost: what its axis says, and how many of its unit make one.
COSTS = {"processor": ("processor time, ms", MILLISECONDS), "rhs": ("right-hand sides", 1.0)}
# Errors beyond so many clearances are all as bad; the least that a float can show, and that of models.
MOST, LEAST, LEAST_OF_MODELS = 1e3, 1e-16, 1e-12
TITLES = {"end": "error at the end", "over_time": "largest error", "steady": "steady error"}
SHORT = {"adams": "Adams", "bdf": "BDF", "bdf2": "BDF 2", "ida": "IDA", "dop853": "DOP853", "rk45": "RK45",
         "lsoda": "LSODA", "radau": "Radau", "newmark": "Newmark", "generalised_alpha": "gen.-α",
         "midpoint": "midpoint", "expm": "expm", "trbdf2": "TR-BDF2", "scipy_bdf": "SciPy BDF", "ida2": "IDA 2",
         "ida1": "implicit Euler (IDA)", "segregated": "segregated",
         "quasi_static": "quasi-static"}  # fmt: skip
# Every method: the house's own in full lines, SciPy's and others dashed, fixed steps dotted.
LOOKS = {
    "adams": "first circle", "bdf": "third square", "bdf2": "third dashed diamond", "ida": "fourth triangle",
    "expm": "black star", "dop853": "second down", "rk45": "second dashed triangle", "lsoda": "sixth diamond",
    "radau": "fifth circle", "newmark": "grey dashed plus", "generalised_alpha": "grey dotted square",
    "midpoint": "black dotted diamond", "trbdf2": "first dashed down",
    "scipy_bdf": "third dashed square", "ida2": "fourth dashed diamond", "ida1": "fourth dotted down",
    "segregated": "grey dotted triangle", "quasi_static": "black dotted plus",
}  # fmt: skip
MARKS = ("circle", "square", "triangle", "down", "diamond")
RUNGS = ("fifth", "second", "sixth", "first", "third", "fourth")


def draw(path, out):
    """Error against time and right-hand sides, models beside solvers, and how it was measured."""
    study = read_study(path)
    answer = study["answer"]
    panels = [precision(answer, where, "processor") for where in TITLES]
    panels += [precision(answer, answer["where"], "rhs", labels=True), models(answer)]
    title = f"How much solver, how much model: {study['name'].replace('_', ' ')}"
    return save(study_sheet(study, panels, title, caption(study), " ".join(answer["verdict"][:2])), out)


def precision(answer, where: str, cost: str, labels: bool = False, title: str = "") -> Panel:
    """Error, which falls to the right, and cost upwards; crosses are runs that did not end well, at the left edge or
    where their error was to be expected, or that were too slow.  With `labels` the legend names the methods."""
    words, factor = COSTS[cost]
    title = title or f"{TITLES[where]}, by {words.partition(',')[0]}"
    known = [error for row in answer["methods"].values() for error in _errors(row, where) if np.isfinite(error)]
    along, series = _error_axis(known or [1.0, 1e-12]), []
    for name, row in answer["methods"].items():
        error, spent, style = _errors(row, where), factor * np.array(row[cost], float), LOOKS.get(name, "grey circle")
        good = [
            status in (Status.OK, "slow") and np.isfinite(e) for status, e in zip(row["status"], error, strict=True)
        ]
        if any(good):
            label = SHORT[name] if labels else ""
            series.append(Series("line", error[good], spent[good], label=label, style=f"{style} small thin"))
        expected = zip(row["status"], error, row["expected"], strict=True)
        places = [e if status == "slow" else there if status == "stopped" and there else along.low
                  for status, e, there in expected if status != Status.OK]  # fmt: skip
        lost = [min(max(place, along.high), along.low) for place in places]
        if lost:
            at = spent[[status != Status.OK for status in row["status"]]]
            series.append(Series("marks", lost, at, style=f"{style.split()[0]} cross large front"))
    if where == "steady" and not known:
        series = []
    band = (answer["judge_error"] or {}).get(where) or 0.0
    levels = [Level(along.high, upright=True, to=band, style="grey")] if band > along.high else []
    note = f"judge's own error {band:.0e}" if band and series else "" if series else "nothing to compare"
    return Panel(title, along, Axis("1", words, scale="log"), series, levels, note=note, first=cost == "rhs")


def _errors(row, where) -> np.ndarray:
    """Errors, above what a float can show, and no more than MOST."""
    return np.clip(np.array(row["error"][where], dtype=float), LEAST, MOST)


def _error_axis(errors) -> Axis:
    """From above the largest of the errors, or 1e-3, down to below the least: precision grows to the right."""
    most = 10 ** math.ceil(math.log10(max(*errors, 1e-3)) + 0.15)
    label = "error, of the clearance or the shaft's swing (others: relative)"
    return Axis("1", label, "log", most, max(min(errors) / 40, LEAST))


def models(answer) -> Panel:
    """One point per rung: the model's error against what a run with it costs, over the edge of all solvers."""
    where = "steady" if any(row["error"]["steady"] is not None for row in answer["models"]) else answer["where"]
    rows = [row for row in answer["models"] if row["error"][where] is not None]
    title = f"models: {TITLES[where]}, by processor time"
    if not rows:
        return Panel(title, note="no rung to compare")
    edge = sorted(
        (e, MILLISECONDS * w)
        for row in answer["methods"].values()
        for e, w, s in zip(_errors(row, where), row["processor"], row["status"], strict=True)
        if s == Status.OK and np.isfinite(e)
    )
    series = []
    if edge:
        best = np.minimum.accumulate([w for _, w in edge])
        series.append(Series("line", [e for e, _ in edge], best, label="fastest solver of this scene", style="grey"))
    for k, row in enumerate(rows):
        words = f"{row['label']}: {row['error'][where]:.1e}, {MILLISECONDS * row['processor']:.2g} ms"
        at = [max(row["error"][where], LEAST_OF_MODELS)], [MILLISECONDS * row["processor"]]
        style = f"{RUNGS[k % len(RUNGS)]} {MARKS[k % len(MARKS)]} large front"
        series.append(Series("marks", *at, label=words, style=style))
    along = _error_axis([e for one in series for e in one.x])
    return Panel(title, along, Axis("1", COSTS["processor"][0], scale="log"), series)


def caption(info) -> str:
    """Machine, versions, scenario, and how it was measured."""
    answer, settings = info["answer"], info["settings"]
    m = answer["machine"]
    libraries = ", ".join(f"{k} {m[k]}" for k in ("python", "numpy", "scipy", "scikit-sundae", "numba"))
    libraries += f"; CVODE and IDA: {m['back_end']}" if "back_end" in m else ""
    overrides = f" with {', '.join(info['overrides'])}" if info["overrides"] else ""
    return (
        f"Scenario {info['name']}{overrides}, {answer['scene']['turns']:.3g} turns; sealdyn {info['version']}, solvers "
        f"{solvers_words(info)}. {m['processor']}, {m['cores']} cores; {libraries}.\n"
        f"Processor time: least of {settings['repeats']} runs after warm-up, inside the method only.  Error: largest "
        "of h_min, relative misalignment, leakage, contact impulse (radial: gap, load, torque), between steps by the "
        "program's own interpolation.\n"
        f"{settings['tolerances']} tolerances, {settings['loosest']:.0e} to {settings['tightest']:.0e}; of fixed steps "
        "(step / fastest period)².  Crosses: did not end well, or too slow; at the left edge if the error is not known."
    )
