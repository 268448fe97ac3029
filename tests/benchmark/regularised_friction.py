"""What smoothing the sign of the sliding speed costs: error and work over the width, beside real sticking.

    python tests/benchmark/regularised_friction.py [figure.png]

A ring on an undamped spring rubs itself to rest on its secondary seal (amplitude falls by 4 F/k a cycle, known to the
last digit), then waits there.  Real sticking stops it; a regularised law lets it creep back towards the middle.
"""

import math
import sys
from dataclasses import replace
from pathlib import Path

sys.path.insert(0, str(Path(__file__).parents[1]))

import numpy as np
from scenes import started

import sealdyn
from sealdyn.report.charts import page as palette
from sealdyn.scene.film import Coefficients
from sealdyn.scene.rings import Rotor, SecondarySeal
from sealdyn.scene.scene import Initial, RingStart
from sealdyn.solvers.contract import Recorder
from sealdyn.solvers.integrate import solve

SCENARIO = Path(__file__).parents[2] / "scenarios" / "fms_reference.toml"
NOTHING = Coefficients(tilt_stiffness=0.0, tilt_damping=0.0, axial_stiffness=0.0, axial_damping=0.0)
FRICTION, START, CYCLES, ACCURACY = 0.31, 5e-6, 12, 1e-6
WIDTHS = 10.0 ** np.arange(-8, -1.9, 0.5)


def problem_with(seal):
    scene = sealdyn.read_scenario(SCENARIO).scene
    support = replace(scene.stator.support, axial_damping=0.0)
    stator = replace(scene.stator, misalignment=0.0, support=support, secondary_seal=seal)
    film = replace(scene.film, model="linear", coefficients=NOTHING)
    scene = replace(scene, film=film, stator=stator, rotor=Rotor(), initial=Initial(stator=RingStart(z=START)))
    period = 2 * math.pi / math.sqrt(support.axial_stiffness / stator.mass)
    ready = started(scene, CYCLES * period, ACCURACY)
    ready.y0[ready.model.unknowns.names.index("stator_z")] = START
    return ready, support.axial_stiffness


def rest(stiffness):
    """Where Coulomb friction stops the ring (m)."""
    x, dead = START, FRICTION / stiffness
    while abs(x) > dead:
        x = -math.copysign(abs(x) - 2 * dead, x)
    return x


def run(seal, method):
    ready, stiffness = problem_with(seal)
    outcome = solve(ready, method, ACCURACY, Recorder())
    error = abs(outcome.y[0] - rest(stiffness)) / ready.model.clearance
    return error, outcome.counts.rhs, outcome.wall_time, outcome.status


def main():
    found = {"real sticking": {}, "regularised": {}}
    for method in ("adams", "bdf"):
        found["real sticking"][method] = run(SecondarySeal(radius=0.045, friction_force=FRICTION), method)
        rows = []
        for width in WIDTHS:
            seal = SecondarySeal(radius=0.045, friction_force=FRICTION, law="regularised", width=float(width))
            rows.append((width, *run(seal, method)))
        found["regularised"][method] = rows
        error, calls, wall, status = found["real sticking"][method]
        print(
            f"{method:5s} real sticking       error {error:.1e} C  {calls:6d} evaluations {wall * 1e3:6.0f} ms {status}"
        )
        for width, error, calls, wall, status in rows:
            print(f"{method:5s} width {width:7.1e} m/s   error {error:.1e} C  {calls:6d} evaluations "
                  f"{wall * 1e3:6.0f} ms {status}")  # fmt: skip
    if len(sys.argv) > 1:
        draw(found, sys.argv[1])


def draw(found, path):
    import matplotlib

    matplotlib.use("Agg")
    from matplotlib import pyplot

    figure, (above, below) = pyplot.subplots(2, 1, figsize=(6.4, 6.4), sharex=True, layout="constrained")
    for (method, rows), colour, marker in zip(found["regularised"].items(), (palette.BLUE, palette.VERMILLION), "os",
                                              strict=True):  # fmt: skip
        table = np.array([row[:3] for row in rows], dtype=float)
        name = {"adams": "CVODE Adams", "bdf": "CVODE BDF"}[method]
        above.loglog(
            table[:, 0],
            table[:, 1],
            marker + "-",
            ms=9 if marker == "o" else 5,
            color=colour,
            label=f"regularised, {name}",
        )
        below.loglog(table[:, 0], table[:, 2], marker + "-", color=colour, label=f"regularised, {name}")
        error, calls, *_ = found["real sticking"][method]
        above.axhline(error, color=colour, ls="--", lw=1.2, label=f"real sticking, {name}")
        below.axhline(calls, color=colour, ls="--", lw=1.2, label=f"real sticking, {name}")
    above.axhline(ACCURACY, color=palette.GREY, lw=0.8)
    above.annotate("accuracy asked", (WIDTHS[-1], ACCURACY), textcoords="offset points", xytext=(0, 3), ha="right",
                   color=palette.GREY, fontsize=8)  # fmt: skip
    above.set(ylabel="error of the resting place,\nin clearances",
              title=f"Smoothing Coulomb friction: {CYCLES} periods, most of them at rest")  # fmt: skip
    below.set(xlabel="width of the regularised law, m/s (largest sliding speed 3.5 mm/s)", ylabel="right-hand sides")
    for axes in (above, below):
        axes.grid(True, alpha=0.3)
    above.legend(fontsize=8)
    figure.savefig(path, dpi=120)


if __name__ == "__main__":
    main()
