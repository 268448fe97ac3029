"""Points per second of the stability map on one core: `python tests/benchmark/stability_map.py`.

Linear film and radial film, one ring (closed-form roots) and two (batched eigenvalues), axes that need the film
anew at every point, and one that rebuilds the scene along an axis.
"""

import time
from pathlib import Path

import numpy as np

from sealdyn import read_scenario
from sealdyn.studies.stability.grid import Grid

SCENARIOS = Path(__file__).parents[2] / "scenarios"
CASES = (
    ("FMR linear, speed x c", "fmr_reference", "linear", ("shaft.speed", 100, 15000), ("inertia_ratio", 0.5, 4)),
    ("FMS linear, speed x damping", "fms_reference", "linear", ("shaft.speed", 100, 15000),
     ("stator.support.axial_damping", 0, 1200)),
    ("FMR linear, coning x pressure", "fmr_reference", "linear", ("film.coning", 1e-4, 6e-3),
     ("film.outer_pressure", 0, 2e6)),
    ("FMSR linear, speed x c", "fmsr_both_flexible", "linear", ("shaft.speed", 100, 15000), ("inertia_ratio", 0.5, 4)),
    ("FMR radial, coning x pressure", "fmr_reference", "radial", ("film.coning", 1e-4, 6e-3),
     ("film.outer_pressure", 0, 2e6)),
    ("FMR linear, speed x spring force (rebuilt)", "balanced", "linear", ("shaft.speed", 100, 15000),
     ("closing.spring_force", 10, 100)),
)  # fmt: skip


def measure(name, model, x, y, count=500) -> float:
    """Points per second, best of three."""
    more = []
    if name == "balanced":
        # The clearance follows from the balance: every spring force is another equilibrium.
        from sealdyn.scenario.reader import parse_scenario

        text = (SCENARIOS / "fmr_reference.toml").read_text().replace('clearance = "10 um"', "")
        scenario = parse_scenario(text + "[closing]\nbalance_ratio = 0.75\nspring_force = 50\n", name,
                                  [f"film.model={model}"])  # fmt: skip
    else:
        scenario = read_scenario(SCENARIOS / f"{name}.toml", [f"film.model={model}", *more])
    best = np.inf
    for _ in range(3):
        begun = time.perf_counter()
        rates, _ = Grid(scenario, {x[0]: np.linspace(*x[1:], count), y[0]: np.linspace(*y[1:], count)}).rates()
        best = min(best, time.perf_counter() - begun)
    return rates.size / best


if __name__ == "__main__":
    for title, *case in CASES:
        print(f"{title:45s} {measure(*case):12.3g} points/s")
