"""CVODE Adams against SciPy's DOP853: the same compiled right-hand side, wall time at equal achieved error.

    python tests/benchmark/against_dop853.py [figure.png]

Reference FMS seal, radial film, 400 turns.  Error: largest deviation of the tilt over the last 40 turns from a
DOP853 run at 3e-14, in units of clearance / outer radius.
"""

import math
import sys
import time
from pathlib import Path

import numpy as np
from scenes import started
from scipy.integrate import solve_ivp
from sksundae.cvode import CVODE

import sealdyn
from sealdyn.solvers.contract import absolute_tolerances

SCENARIO = Path(__file__).parents[2] / "scenarios" / "fms_reference.toml"
TURNS, REPEATS = 400, 5


def cvode(ready, tolerance, times):
    segment = ready.segment(0)

    def rhs(t, y, yp):
        segment.rhs(t, y, yp)

    solver = CVODE(rhs, method="Adams", rtol=tolerance, atol=absolute_tolerances(segment, tolerance),
                   jacfn=segment.jacobian, max_num_steps=10**7)  # fmt: skip
    return solver.solve(times, ready.y0).y


def dop853(ready, tolerance, times):
    segment = ready.segment(0)

    def rhs(t, y):
        yp = np.empty(len(y))
        segment.rhs(t, y, yp)
        return yp

    return solve_ivp(rhs, (0.0, times[-1]), ready.y0, "DOP853", t_eval=times,
                     rtol=max(tolerance, 2.3e-14), atol=absolute_tolerances(segment, tolerance)).y.T  # fmt: skip


def measure(method, tolerance, times, reference, scale):
    wall = math.inf
    for _ in range(REPEATS):
        ready = fresh()
        begun = time.perf_counter()
        y = method(ready, tolerance, times)
        wall = min(wall, time.perf_counter() - begun)
    return float(np.max(np.abs(y[1:, 1:3] - reference[1:, 1:3])) / scale), wall


def fresh():
    scene = sealdyn.read_scenario(SCENARIO).scene
    return started(scene, TURNS * 2 * math.pi / scene.shaft.speed, 1e-8)


def main():
    ready = fresh()
    turn = ready.duration / TURNS
    # The first point is the start; the few others cost nothing.
    times = np.concatenate([[0.0], ready.duration - turn * np.linspace(40, 0, 17)])
    reference = dop853(fresh(), 3e-14, times)
    scale = ready.model.clearance / ready.model.scene.film.outer_radius
    found = {}
    for name, method in (("CVODE Adams", cvode), ("SciPy DOP853", dop853)):
        found[name] = [measure(method, 10.0**-k, times, reference, scale) for k in np.arange(3, 13.1, 0.5)]
        for error, wall in found[name]:
            print(f"{name:13s} error {error:.1e}  {wall * 1e3:7.1f} ms")
    print("ratio DOP853 / Adams at equal achieved error:")
    for error in 10.0 ** -np.arange(4, 10):
        walls = [fastest_at(found[name], error) for name in found]
        print(
            f"  {error:.0e}: {walls[0] * 1e3:6.1f} ms against {walls[1] * 1e3:6.1f} ms, {walls[1] / walls[0]:.2f} times"
        )
    if len(sys.argv) > 1:
        draw(found, sys.argv[1])


def fastest_at(points, error):
    """Wall time of the fastest run that achieves the error."""
    return min((wall for e, wall in points if e <= error), default=math.nan)


def draw(found, path):
    import matplotlib

    matplotlib.use("Agg")
    from matplotlib import pyplot

    figure, axes = pyplot.subplots(figsize=(6, 4))
    for (name, points), marker in zip(found.items(), "os", strict=True):
        axes.loglog(*np.array(points).T, marker=marker, label=name)
    axes.set_xlabel("achieved error of the tilt, in C/r_o")
    axes.set_ylabel("wall time, s")
    axes.set_title(f"Reference FMS seal, radial film, {TURNS} turns")
    axes.grid(True, alpha=0.3)
    axes.legend()
    figure.savefig(path, dpi=110, bbox_inches="tight")


if __name__ == "__main__":
    main()
