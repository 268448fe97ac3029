"""Work and precision of every shipped scenario, small multiples on one page.

    python tests/benchmark/all_scenarios.py [page.png] [--fresh]

Runs `sealdyn study work-precision` on every scenario, some shortened so that the slowest method ends, five tolerances
each; archives in outputs/work_precision/ are used again unless --fresh.  Who won goes into a JSON file beside the page,
from which gallery.py makes the table of the gallery's page.
"""

import json
import math
import sys
import time
from dataclasses import replace
from pathlib import Path
from textwrap import shorten

import sealdyn
from sealdyn.answers import Panel, Series
from sealdyn.archive import read_study
from sealdyn.report.charts import study_work_precision as chart
from sealdyn.report.charts.page import look, save, sheet
from sealdyn.report.panels import draw_panel
from sealdyn.studies._runner import run_study
from sealdyn.studies.work_precision import rank_methods

ROOT = Path(__file__).parents[2]
KEPT = ROOT / "outputs" / "work_precision"
# What would take too long in full; the first turns tell the methods apart as well.
SHORTENED = {
    "housing_vibration": ["run.turns=4"], "gear_mesh": ["run.turns=4"], "runup_through_critical": [],
    "rub_chaotic": ["run.turns=15"],
    "hang_up": ["run.turns=3"], "rub": ["run.turns=50"], "fms_reference": ["run.turns=30"],
    "fmr_reference": ["run.turns=30"], "fmsr_both_flexible": ["run.turns=30"], "free_precession": ["run.turns=30"],
    "turning_pads": ["run.turns=1"], "dry_gas_seal": ["run.turns=1"],
    "dry_gas_start": ["run.turns=3", "run.accuracy=1e-3"], "upstream_pumping": ["run.turns=0.5", "run.accuracy=1e-3"],
    # Where they leave the shaft: who rides on it moves as it does.
    "lip_reference": ["run.turns=2", "shaft.speed=6000 rpm", "lip.preload=2", "lip.garter_tension=0"],
    "circumferential_reference": ["run.turns=2", "shaft.speed=12000 rpm"],
}  # fmt: skip
FLAGS = {"tolerances": 5, "loosest": 1e-2, "tightest": 1e-12, "repeats": 2, "longest": 2.0, "samples": 200,
         "judging": 30.0, "models": False}  # fmt: skip
# Contact all the way: fewer tolerances.  Films with unknowns of their own: as tight as their judges can tell apart.
LEBECK = ("lebeck_driven", "lebeck_elastic", "lebeck_n3", "lebeck_n6", "lebeck_plateaus")
GROOVED = ("turning_pads", "dry_gas_seal", "dry_gas_start", "upstream_pumping")
RADIAL = ("lip_reference", "circumferential_reference")
OTHERS = {
    "rub": {"tolerances": 4}, "rub_chaotic": {"tolerances": 4, "longest": 3.0, "judging": 25.0},
    "gas_reynolds_reference": {"tightest": 1e-7}, "rayleigh_pads": {"tightest": 1e-6},
    **{name: {"tightest": 1e-4} for name in LEBECK},
    **{name: {"tightest": 1e-6, "longest": 8.0, "judging": 60.0} for name in GROOVED},
    **{name: {"tightest": 1e-10, "longest": 1.0, "judging": 10.0} for name in RADIAL},
}  # fmt: skip
# Errors at which the page says who is fastest.
ERRORS = (1e-2, 1e-4, 1e-6)


def archives(fresh: bool) -> list[Path]:
    found = []
    for path in [*sorted((ROOT / "scenarios").glob("*.toml")), *sorted((ROOT / "scenarios/radial").glob("*.toml"))]:
        out, begun = KEPT / f"{path.stem}.h5", time.perf_counter()
        if fresh or not out.exists():
            scenario = sealdyn.read_scenario(path, SHORTENED.get(path.stem, []))
            answer = run_study("work-precision", scenario, out, flags=FLAGS | OTHERS.get(path.stem, {}), workers=1)
            print(f"{path.stem} ({time.perf_counter() - begun:.0f} s)")
            for line in answer["verdict"]:
                print(f"  {line}")
        found.append(out)
    return found


def draw(paths, out):
    """One panel per scenario: largest error over time against processor time."""
    across = 4
    down = math.ceil((len(paths) + 1) / across)
    with look():
        figure = sheet(16.5, 1.2 + 3.35 * down)
        height = figure.get_figheight()
        figure.text(0.03, 1 - 0.3 / height, "Who is fastest at which error: every shipped scenario", fontsize=14,
                    weight="bold", va="center")  # fmt: skip
        machine = read_study(paths[0])["answer"]["machine"]
        words = ", ".join(f"{k} {machine[k]}" for k in ("python", "numpy", "scipy", "scikit-sundae", "numba"))
        words += f"; solvers {', '.join(solvers(paths))}"
        figure.text(
            0.03,
            1 - 0.56 / height,
            f"{machine['processor']}, {machine['cores']} cores; {words}; largest error over time"
            " of h_min, leakage, relative misalignment, contact impulse",
            fontsize=9,
            va="center",
        )
        grid = figure.add_gridspec(down, across, left=0.045, right=0.985, bottom=0.5 / height, top=1 - 1.05 / height,
                                   wspace=0.24, hspace=0.5)  # fmt: skip
        for k, path in enumerate(paths):
            info = read_study(path)
            ax = figure.add_subplot(grid[k // across, k % across])
            answer = info["answer"]
            title = f"{info['name'].replace('_', ' ')}, {answer['scene']['turns']:.4g} turns"
            panel = chart.precision(answer, "over_time", "processor", title=title)
            draw_panel(ax, replace(panel, x=replace(panel.x, label="error")))
            rows = fastest(answer)
            winners = [f"{row['error']:.0e} {chart.SHORT[row['method']]}" for row in rows if row["method"]]
            note = "fastest: " + ", ".join(winners) if winners else rows[0].get("why", "")
            ax.set_title(f"{title}\n", loc="left")
            ax.text(0, 1.025, shorten(note, 62, placeholder=" …"), transform=ax.transAxes, fontsize=8)
            if k % across:
                ax.set_ylabel("")
        key = figure.add_subplot(grid[len(paths) // across, len(paths) % across])
        key.axis("off")
        looks = {chart.SHORT[name]: style for name, style in chart.LOOKS.items()}
        looks["did not end well, or too slow"] = "black cross large"
        draw_panel(
            key, Panel(series=[Series("line", [], [], label=name, style=style) for name, style in looks.items()])
        )
        key.legend(loc="center left", ncols=2, fontsize=9)
        return save(figure, out)


def solvers(paths) -> list[str]:
    """Digests of the solvers that the archives are of."""
    return sorted({read_study(path).get("solvers", "of no name") for path in paths})


def fastest(answer: dict) -> list[dict]:
    return [rank_methods(answer, error) for error in ERRORS]


def winners(paths) -> dict:
    """Who is fastest at which error on every scenario, as the studies' archives have it."""
    scenes, machine = [], {}
    for path in paths:
        info = read_study(path)
        answer = info["answer"]
        machine = machine or answer["machine"]
        scenes.append({"name": info["name"], "overrides": info["overrides"], "turns": answer["scene"]["turns"],
                       "where": answer["where"],
                       "judge_error": (answer["judge_error"] or {}).get(answer["where"]),
                       "fastest": fastest(answer)})  # fmt: skip
    return {"command": "python tests/benchmark/all_scenarios.py", "machine": machine, "solvers": solvers(paths),
            "scenes": scenes}  # fmt: skip


def main():
    given = [word for word in sys.argv[1:] if not word.startswith("--")]
    out = given[0] if given else ROOT / "outputs" / "gallery" / "work_precision_all.png"
    paths = archives("--fresh" in sys.argv)
    print(draw(paths, out))
    Path(out).with_suffix(".json").write_text(json.dumps(winners(paths), indent=1) + "\n")


if __name__ == "__main__":
    main()
