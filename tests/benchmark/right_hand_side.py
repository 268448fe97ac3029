"""What one right-hand side costs, and where: film kernel, rings and forcing, SUNDIALS, gap watching.

    python tests/benchmark/right_hand_side.py

Reference FMS seal, radial film, 400 turns.  Times are minima of several runs in this process; read the ratios.
"""

import math
import sys
import time
from pathlib import Path

sys.path.insert(0, str(Path(__file__).parents[1]))

import numpy as np
from scenes import started

import sealdyn
from sealdyn.dynamics.native import Value, at_each
from sealdyn.films.radial import film as radial
from sealdyn.solvers.contract import Counts, Recorder, tolerance_for
from sealdyn.solvers.integrate import solve
from sealdyn.solvers.methods import METHODS

SCENARIO = Path(__file__).parents[2] / "scenarios" / "fms_reference.toml"
TURNS = 400


def best(function, repeats=5):
    found = math.inf
    for _ in range(repeats):
        begun = time.perf_counter()
        function()
        found = min(found, time.perf_counter() - begun)
    return found


def per_call(function, calls=20_000):
    function()
    return best(lambda: [function() for _ in range(calls)]) / calls * 1e6


def film_kernel(scene):
    print("film kernel (us a call, dispatch from Python included), by film accuracy and tilt")
    for error in (1e-5, 1e-7, 1e-9, 1e-11):
        f = radial.parameters(scene.film, scene.film.clearance, error)
        ready = started(scene, 1.0)
        segment = ready.segment(0)
        s = segment.s
        row = []
        for tilt in (0.01, 0.3, 0.8, 1.1, 1.2):
            segment.rhs(0.0, ready.y0, np.empty(segment.size))
            s[1] = tilt * scene.film.clearance / scene.film.outer_radius
            row.append(f"|g|r_o/C {tilt}: {per_call(lambda f=f, s=s: radial.wrench(f, s), 5000):.2f}")
        print(f"  {error:.0e}:  " + ",  ".join(row))


def shares(scene):
    duration = TURNS * 2 * math.pi / scene.shaft.speed
    ready = started(scene, duration, 1e-6)
    segment = ready.segment(0)
    calls = 20_000
    taus, ys = np.linspace(0.0, duration, calls), np.tile(ready.y0, (calls, 1))
    gaps, (f, wrench) = np.tile(segment.s, (calls, 1)), (ready.model.f, Value(ready.model.interface.film.wrench))
    film = best(lambda: at_each(wrench, f, gaps)) / calls * 1e6
    rhs = best(lambda: segment.derivatives(taus, ys)) / calls * 1e6
    tolerance, counts = tolerance_for("adams", 1e-6, ready.memory), [0]

    def bare():
        counted = Counts()
        for _ in METHODS["adams"](segment, 0.0, ready.y0, "adams", tolerance, counted):
            pass
        counts[0] = counted.rhs

    alone = best(bare) / counts[0] * 1e6
    outcome = [None]

    def whole():
        run = started(scene, duration, 1e-6)
        outcome[0] = solve(run, "adams", 1e-6, Recorder())

    whole()
    best(whole, 4)
    total = min(_wall(scene, duration) for _ in range(5))
    rhs_calls = outcome[0].counts.rhs
    total = total / rhs_calls * 1e6
    print(f"\n{TURNS} turns at accuracy 1e-6: {rhs_calls} right-hand sides, {outcome[0].counts.steps} steps")
    print(f"  film kernel                              {film:6.2f} us per right-hand side")
    print(f"  rings, forcing, works                    {rhs - film:6.2f}")
    print(f"  CVODE, steps returned                    {alone - rhs:6.2f}")
    print(f"  gap watching, energy audit, blocks       {total - alone:6.2f}")
    print(f"  all                                      {total:6.2f}")


def _wall(scene, duration):
    ready = started(scene, duration, 1e-6)
    return solve(ready, "adams", 1e-6, Recorder()).wall_time


if __name__ == "__main__":
    scene = sealdyn.read_scenario(SCENARIO).scene
    film_kernel(scene)
    shares(scene)
