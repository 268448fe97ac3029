"""What the two-dimensional liquid film costs, and how exact it is.

    python tests/benchmark/cavitating_film.py [OUT.png]

Three things: solving it at rest over the number of cells, from nothing and from the solution of a clearance one per
cent away; a run of a tilted wavy seal with a cavity (12 x 64 cells, three degrees of freedom) by TR-BDF2 at several
tolerances, error against wall time; and the same by IDA, with cavities and without.
"""

import sys
import time

import matplotlib.pyplot as plt
import numpy as np

from sealdyn.dynamics.model import Model
from sealdyn.dynamics.run_state import RunState
from sealdyn.faces.geometry import DZ
from sealdyn.faces.waviness import lay_waves
from sealdyn.films.reynolds import cavitation
from sealdyn.films.reynolds import film as reynolds
from sealdyn.scenario.reader import parse_scenario
from sealdyn.scene.reynolds import Reynolds
from sealdyn.solvers.contract import Counts, SolverFailure
from sealdyn.solvers.methods import METHODS

SEAL = """# Does a tilted wavy seal at low pressure settle?
[shaft]
speed = "3000 rpm"
[film]
model = "reynolds"
inner_radius = "45 mm"
outer_radius = "50 mm"
outer_pressure = "3 bar"
inner_pressure = "1 bar"
cavitation_pressure = "0.1 bar"
viscosity = "1e-3 Pa*s"
clearance = "3 um"
coning = "0.2 mrad"
[film.reynolds]
cells_r = 12
cells_theta = 64
[[stator.waviness]]
order = 3
amplitude = "0.8 um"
[rotor]
runout = "10 urad"
[stator]
mass = "0.3 kg"
transverse_inertia = "3.5e-4 kg*m^2"
polar_inertia = "7e-4 kg*m^2"
misalignment = "10 urad"
[stator.support]
axial_stiffness = "5e4 N/m"
axial_damping = "100 N*s/m"
radius = "47.5 mm"
[run]
turns = 40
accuracy = 1e-4
"""
GRIDS = ((6, 32), (12, 64), (24, 128), (50, 250), (50, 500))
TOLERANCES = (1e-4, 1e-5, 1e-6)
TURNS, REFERENCE, REPEATS = 10.3, 1e-7, 3


def still(cells):
    """Seconds and linear systems of the film at rest, from nothing and from nearby."""
    from dataclasses import replace

    scene = parse_scenario(SEAL, "seal").scene
    film = replace(scene.film, reynolds=Reynolds(cells_r=cells[0], cells_theta=cells[1]))
    f = reynolds.parameters(film, film.clearance)
    lay_waves(f, scene.stator.waviness, [])
    s = Model(scene, 1e-3).segment().gap_state(0.0, np.zeros(50)).copy()
    found = []
    for first in (True, False):
        best, rounds = np.inf, 0
        for _ in range(REPEATS):
            u = cavitation.unknowns(f)
            if not first:
                s[DZ] = 0.0
                cavitation.solve(f, s, u)
                s[DZ] = 0.01 * film.clearance
            begun = time.perf_counter()
            rounds = cavitation.solve(f, s, u)
            best = min(best, time.perf_counter() - begun)
        found.append((best, rounds))
    return found


def run(method, tolerance, *overrides, turns=TURNS):
    """Displacements and rates at the end over their scales, seconds, steps and film solutions; None where it fails."""
    scenario = parse_scenario(SEAL, "seal", overrides)
    model = Model(scenario.scene, 1e-4)
    state = RunState(model, model.time_of(turns))
    segment, counts, steps = state.segment(0), Counts(), 0
    y = state.y0.copy()
    segment.settle_film(0.0, y)
    begun = time.perf_counter()
    try:
        for t, ys, _ in METHODS[method](segment, 0.0, y, method, tolerance, counts):
            steps, last = steps + len(t), ys[-1]
    except SolverFailure as failure:
        return None, time.perf_counter() - begun, f"{steps} steps, then: {failure}"
    many = segment.n_mechanical
    return last[:many] / segment.scales[:many], time.perf_counter() - begun, f"{steps} steps, {counts.rhs} settled"


def main(out):
    """Measure, print, draw."""
    _, (left, right) = plt.subplots(1, 2, figsize=(11, 4.4), layout="constrained")
    sizes, times = [], []
    print("cells            from nothing, ms (systems)   from 1 % away, ms (systems)")
    for cells in GRIDS:
        (cold, many), (warm, few) = still(cells)
        print(f"{cells[0]:3d} x {cells[1]:3d}  {1e3 * cold:12.3f} ({many})  {1e3 * warm:20.3f} ({few})")
        sizes.append(cells[0] * cells[1])
        times.append((cold / many, cold, warm))
    for k, words in enumerate(("one linear system", "from nothing", "from 1 % away")):
        left.loglog(sizes, [1e3 * row[k] for row in times], "o-", label=words)
    left.set(xlabel="cells", ylabel="ms", title="The film at rest")
    left.legend()

    run("trbdf2", 1e-3, turns=0.1)
    exact, _, _ = run("trbdf2", REFERENCE)
    errors, walls = [], []
    for tolerance in TOLERANCES:
        found, wall, words = run("trbdf2", tolerance)
        errors.append(np.abs(found - exact).max())
        walls.append(wall)
        print(f"TR-BDF2 {tolerance:.0e}: error {errors[-1]:.1e}, {wall:.2f} s, {words}")
    right.loglog(errors, walls, "o-", label=f"TR-BDF2, {TURNS:g} turns")
    found, wall, words = run("ida", 1e-6)
    print(f"IDA with cavities: {'no end' if found is None else np.abs(found - exact).max()}, {wall:.2f} s, {words}")
    never = ["film.reynolds.cavitation=none"]
    full, _, _ = run("trbdf2", REFERENCE, *never)
    for method, tolerances in (("ida", (1e-4, 1e-5, 1e-6)), ("trbdf2", TOLERANCES)):
        points = []
        for tolerance in tolerances:
            found, wall, words = run(method, tolerance, *never)
            points.append((np.abs(found - full).max(), wall))
            print(f"{method} without cavities {tolerance:.0e}: error {points[-1][0]:.1e}, {wall:.2f} s, {words}")
        right.loglog(*zip(*points, strict=True), "s--", label=f"{method}, film that never tears")
    right.set(xlabel="error of displacements and rates at the end", ylabel="wall time, s", title="Rings in motion")
    right.legend()
    plt.savefig(out, dpi=130)


if __name__ == "__main__":
    main(sys.argv[1] if len(sys.argv) > 1 else "cavitating_film.png")
