"""What the two-dimensional liquid film costs, and how exact it is.

    python tests/benchmark/cavitating_film.py [OUT.png]

Four things: solving it at rest over the number of cells, from nothing and from the solution of a clearance one per
cent away, its linear system by the program's band and by SuperLU; a run of a tilted wavy seal with a cavity (12 x 64
cells, three degrees of freedom) by TR-BDF2 at several tolerances, error against wall time; the same by IDA, with
cavities and without; and what a cavity costs that travels with a turning face.
"""

import sys
import time
from dataclasses import replace

import matplotlib.pyplot as plt
import numpy as np
from scipy.sparse import csc_array
from scipy.sparse.linalg import splu

from sealdyn.dynamics.model import Model
from sealdyn.dynamics.run_state import RunState
from sealdyn.faces.film_thickness import lay_waves
from sealdyn.faces.geometry import DZ
from sealdyn.films._cells_around import place, room
from sealdyn.films.reynolds import film as reynolds
from sealdyn.films.reynolds import pressure
from sealdyn.films.reynolds.mesh import ANGLES, CELLS, films
from sealdyn.films.reynolds.pressure import lay_out
from sealdyn.scenario.reader import parse_scenario
from sealdyn.scene.film import Reynolds
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
PLAIN = SEAL.replace(SEAL[SEAL.index("[[stator.waviness]]") : SEAL.index("[rotor]")], "")
GRIDS = ((6, 32), (12, 64), (24, 128), (50, 250), (50, 500))
TOLERANCES = (1e-4, 1e-5, 1e-6)
# The same cavity fixed in space and turning with the face: what tilts, waves only where they stand still.
FIXED = ("rotor.runout=0 rad", "stator.misalignment=60 urad")
TRAVELS = ("rotor.runout=60 urad", "stator.misalignment=0 rad")
TURNS, REFERENCE, REPEATS = 10.3, 1e-7, 3


def still(cells):
    """Seconds and linear systems of the film at rest, from nothing and from nearby."""
    scene = parse_scenario(SEAL, "seal").scene
    film = replace(scene.film, reynolds=Reynolds(cells_r=cells[0], cells_theta=cells[1]))
    f = reynolds.parameters(film, film.clearance)
    lay_waves(f, scene.stator.waviness, [])
    s = Model(scene, 1e-3).segment().gap_state(0.0, np.zeros(50)).copy()
    found = [sparse(f, s)]
    for first in (True, False):
        best, rounds = np.inf, 0
        for _ in range(REPEATS):
            u = np.ones((int(f[ANGLES]), int(f[CELLS])))
            if not first:
                s[DZ] = 0.0
                pressure.solve(f, s, u)
                s[DZ] = 0.01 * film.clearance
            begun = time.perf_counter()
            rounds = pressure.solve(f, s, u)
            best = min(best, time.perf_counter() - begun)
        found.append((best, rounds))
    return found


def sparse(f, s):
    """Seconds of the last linear system by SuperLU, its unknowns in the order of the circle; those of the program's."""
    _, carried, ways, around = films(f, s)
    nothing, u = np.zeros_like(carried), np.ones((int(f[ANGLES]), int(f[CELLS])))
    pressure.solve(f, s, u)
    angles, cells = u.shape
    band, y = room(angles, cells)
    lay_out(f, s, carried, ways, around, u > 0.0, nothing, nothing, band, y)
    n, width = len(y), band.shape[1] // 2
    rows, columns = np.indices(band.shape)
    columns += rows - width
    inside = (band != 0.0) & (columns >= 0) & (columns < n)
    order = np.concatenate([np.arange(cells) + at * cells for at in (place(k, angles) for k in range(angles))])
    matrix = csc_array((band[inside], (rows[inside], columns[inside])), shape=(n, n))[order][:, order]
    y, best = y[order], np.inf
    for _ in range(REPEATS):
        begun = time.perf_counter()
        found = splu(matrix, "MMD_AT_PLUS_A", 0.0, options={"SymmetricMode": True}).solve(y)
        best = min(best, time.perf_counter() - begun)
    assert np.abs(found.reshape(angles, cells) - u).max() < 1e-8 * np.abs(u).max()
    return best


def run(method, tolerance, *overrides, turns=TURNS, text=SEAL):
    """Displacements and rates at the end over their scales, seconds, steps and film solutions; None where it fails."""
    scenario = parse_scenario(text, "seal", overrides)
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
    print("cells      one linear system, ms   by SuperLU   from nothing (systems)   from 1 % away (systems)")
    for cells in GRIDS:
        by_library, (cold, many), (warm, few) = still(cells)
        print(f"{cells[0]:3d} x {cells[1]:3d}  {1e3 * cold / many:12.3f} {1e3 * by_library:20.3f} "
              f"{1e3 * cold:12.3f} ({many}) {1e3 * warm:20.3f} ({few})")  # fmt: skip
        sizes.append(cells[0] * cells[1])
        times.append((cold / many, by_library, cold, warm))
    lines = "one linear system, band", "one linear system, SuperLU", "from nothing", "from 1 % away"
    for k, words in enumerate(lines):
        left.loglog(sizes, [1e3 * row[k] for row in times], "s--" if k == 1 else "o-", label=words)
    slopes = [np.log(times[-1][k] / times[1][k]) / np.log(sizes[-1] / sizes[1]) for k in (0, 1)]
    print(f"grows with the cells to the {slopes[0]:.2f}, by SuperLU to the {slopes[1]:.2f}")
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
    for words, set_ in (("fixed in space", FIXED), ("travelling", TRAVELS)):
        _, wall, steps = run("trbdf2", 1e-4, *set_, text=PLAIN)
        print(f"cavity {words}, {TURNS:g} turns: {wall:.2f} s, {steps}")
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
