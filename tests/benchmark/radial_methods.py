"""Methods on the shipped radial seals, and on both where followers leave the shaft: error against processor time.

    python tests/benchmark/radial_methods.py [figure.png]

Each method integrates two turns of each scenario at accuracies from 1e-2 to 1e-5, as a user would ask for it (a step is
bounded by the accuracy, too, since landings are looked for between steps).  Error: the largest of the largest gap, the
least load and the friction torque at 200 even times, over the motion's length, the largest load and the largest torque,
from SciPy's Radau at 1e-7; a change of contact moves a load by all of it, so that of the last two the 99th percentile
counts.  Processor time inside the method, the least of two runs.  A table on standard output.
"""

import math
import sys
from pathlib import Path

import numpy as np

import sealdyn
from sealdyn.answers import Axis, Panel, Series
from sealdyn.radial_seals.observers import columns
from sealdyn.report.charts.page import look, save, sheet
from sealdyn.report.charts.study_work_precision import LOOKS, SHORT
from sealdyn.report.panels import draw_panel
from sealdyn.simulation.selection import prepare_run
from sealdyn.solvers.contract import Recorder
from sealdyn.solvers.fixed_step import REFERENCE_METHODS
from sealdyn.solvers.integrate import solve
from sealdyn.status import Status
from sealdyn.studies.work_precision.observation import _Stopwatch

ROOT = Path(__file__).parents[2]
METHODS = ("adams", "bdf", "dop853", "radau", "rk45", "lsoda")
ACCURACIES = (1e-2, 1e-3, 1e-4, 1e-5)
# A run gives its method a sixtieth of the accuracy as tolerance.
SHARP, SAMPLES, LIMIT, QUANTILE, SHARPER = 1e-7, 200, 8.0, 0.99, 60.0
# Panels: scenario and what is changed.
CASES = {
    "lip": ("lip_reference", {}),
    "lip, leaves the shaft": (
        "lip_reference",
        {"lip.preload": 2.0, "lip.garter_tension": 0.0, "shaft.speed": "6000 rpm"},
    ),
    "segments": ("circumferential_reference", {}),
    "segments, leave the shaft": ("circumferential_reference", {"shaft.speed": "12000 rpm"}),
}


class Looked(Recorder):
    """Keeps what is looked at."""

    def take(self, segment, taus, q, q_rate, x=None):
        found, _ = columns(segment, taus, q, q_rate)
        self.parts.append([found[name] for name in ("time", "largest_gap", "least_load", "friction_torque")])


def looked_at(scenario, method, accuracy, limit=LIMIT):
    """Series (3, m) of one run, or None, and the seconds inside the method."""
    run, _ = prepare_run(scenario.with_({"run.accuracy": accuracy}))
    watch, sink = _Stopwatch(REFERENCE_METHODS[method], limit), Looked(run.duration / SAMPLES)
    outcome = solve(run, method, accuracy, sink, steps=watch, tolerance=accuracy / SHARPER)
    series = np.concatenate([np.array(part) for part in sink.parts], axis=1)[1:] if sink.parts else None
    return (series if outcome.status == Status.OK else None), watch.spent, run.model.length


def curve(scenario, method, exact, scales):
    """(error, seconds) over the accuracies; None in place of an error where a run did not end."""
    found = []
    for accuracy in ACCURACIES:
        series, spent, _ = looked_at(scenario, method, accuracy)
        if series is None:
            found.append((None, spent))
            break
        away = np.abs(series - exact) / scales[:, None]
        error = max(away[0].max(), *np.quantile(away[1:], QUANTILE, axis=1))
        found.append((max(float(error), 1e-12), min(spent, looked_at(scenario, method, accuracy)[1])))
    return found


def main():
    out = sys.argv[1] if len(sys.argv) > 1 else ROOT / "outputs" / "gallery" / "radial_methods.png"
    across, down = 3, 2
    with look():
        figure = sheet(14.0, 0.8 + 3.3 * down)
        title = "Radial seals: error (1e-12: none) against processor time"
        figure.text(0.03, 1 - 0.3 / figure.get_figheight(), title, fontsize=14, weight="bold", va="center")
        grid = figure.add_gridspec(down, across, left=0.06, right=0.985, bottom=0.5 / figure.get_figheight(),
                                   top=1 - 0.9 / figure.get_figheight(), wspace=0.25, hspace=0.45)  # fmt: skip
        print("| seal | chosen | fastest at 1e-03 | at 1e-04 |\n|---|---|---|---|")
        for k, (title, case) in enumerate(CASES.items()):
            panel, line = judged(title, *case)
            ax = figure.add_subplot(grid[k // across, k % across])
            draw_panel(ax, panel)
            if k % across:
                ax.set_ylabel("")
            print(line, flush=True)
        key = figure.add_subplot(grid[len(CASES) // across, len(CASES) % across])
        key.axis("off")
        names = [Series("line", [], [], label=SHORT[m], style=LOOKS[m]) for m in METHODS]
        draw_panel(key, Panel(series=[*names, Series("marks", [], [], label="did not end", style="black cross large")]))
        key.legend(loc="center left", fontsize=9)
        print(save(figure, out))


def judged(title, name, changes):
    """Panel of one case, and its line of the table."""
    scenario = sealdyn.read_scenario(ROOT / "scenarios" / "radial" / f"{name}.toml").with_({"run.turns": 2} | changes)
    _, plan = prepare_run(scenario)
    exact, _, length = looked_at(scenario, "radau", SHARP, math.inf)
    scales = np.array([length, *(np.max(np.abs(exact[1:]), axis=1) + 1e-300)])
    curves = {method: curve(scenario, method, exact, scales) for method in METHODS}
    series = []
    for method, pairs in curves.items():
        good = [(error, 1e3 * spent) for error, spent in pairs if error is not None]
        if good:
            series.append(Series("line", *zip(*good, strict=True), style=f"{LOOKS[method]} small thin"))
        lost = [1e3 * spent for error, spent in pairs if error is None]
        if lost:
            style = f"{LOOKS[method].split()[0]} cross large front"
            series.append(Series("marks", [1.0] * len(lost), lost, style=style))
    errors = [error for pairs in curves.values() for error, _ in pairs if error]
    along = Axis("1", "error", scale="log", low=2.0, high=0.5 * min(errors, default=1e-8))
    panel = Panel(title, along, Axis("1", "processor time, ms", scale="log"), series)
    fastest = [first(curves, error) for error in (1e-3, 1e-4)]
    return panel, f"| {title} | {SHORT[plan.method]} | {' | '.join(fastest)} |"


def first(curves, error) -> str:
    """Who has a run of at most this error in the least time, and the next."""
    times = {m: min((s for e, s in pairs if e is not None and e <= error), default=None) for m, pairs in curves.items()}
    order = sorted((spent, method) for method, spent in times.items() if spent is not None)
    if not order:
        return "-"
    more = f", {order[1][0] / order[0][0]:.2g} times before {SHORT[order[1][1]]}" if len(order) > 1 else ""
    return f"{SHORT[order[0][1]]}{more}"


if __name__ == "__main__":
    main()
