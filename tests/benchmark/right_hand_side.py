"""What one right-hand side costs, and where: film kernel, rings and forcing, scikit-sundae, gap watching.

    python tests/benchmark/right_hand_side.py

Reference FMS seal, radial film, 400 turns.  Times are minima of several runs in this process; read the ratios.
"""

import math
import time
from pathlib import Path

import numpy as np
from scenes import started
from sksundae.cvode import CVODE

import sealdyn
from sealdyn.films.radial import film as radial
from sealdyn.solvers.contract import absolute_tolerances, tolerance_for
from sealdyn.solvers.integrate import solve
from sealdyn.solvers.recorder import Recorder

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
    y, yp = ready.y0.copy(), np.empty(segment.size)
    film = per_call(lambda: ready.model.interface.film.wrench(ready.model.f, segment.s))
    rhs = per_call(lambda: segment.rhs(0.1, y, yp))
    tolerance = tolerance_for("adams", 1e-6, ready.memory)
    calls = [0]

    def counted(t, y, yp):
        calls[0] += 1
        segment.rhs(t, y, yp)

    def bare():
        calls[0] = 0
        solver = CVODE(counted, method="Adams", rtol=tolerance, atol=absolute_tolerances(segment, tolerance),
                       jacfn=segment.jacobian, max_num_steps=10**7)  # fmt: skip
        return solver.solve(np.array([0.0, duration]), ready.y0)

    alone = best(bare) / calls[0] * 1e6
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
    print(f"  rings, forcing, works, counting          {rhs - film:6.2f}")
    print(f"  scikit-sundae and CVODE, steps returned  {alone - rhs:6.2f}")
    print(f"  gap watching, energy audit, blocks       {total - alone:6.2f}")
    print(f"  all                                      {total:6.2f}")


def _wall(scene, duration):
    ready = started(scene, duration, 1e-6)
    return solve(ready, "adams", 1e-6, Recorder()).wall_time


def floor():
    """What scikit-sundae costs with nothing to compute: the floor under any right-hand side."""
    calls = [0]

    def nothing(t, y, yp):
        calls[0] += 1
        yp[0], yp[1] = y[1], -y[0]

    def run():
        calls[0] = 0
        solver = CVODE(nothing, method="Adams", rtol=1e-8, atol=1e-10, max_num_steps=10**7)
        solver.solve(np.array([0.0, 2 * math.pi * TURNS]), np.array([1.0, 0.0]))

    wall = best(run)
    print(f"  scikit-sundae on y'' = -y (two unknowns, nothing to compute): {wall / calls[0] * 1e6:.2f} us per call")


if __name__ == "__main__":
    scene = sealdyn.read_scenario(SCENARIO).scene
    film_kernel(scene)
    shares(scene)
    floor()
