"""How far a run is from what the machine can do: integration, whole runs, SciPy.

    python tests/benchmark/limit.py [--quick] [--repeats 7] [figure.png]

The floor is limit.c beside this file: the reference seal in C on CVODE, built here where a compiler and SUNDIALS are
there.  Ratios are of least wall times of runs that took turns in one process; errors are the largest of the tilt at 17
instants of the last tenth of the run, over clearance / outer radius, each program against itself at its tightest.
"""

import argparse
import math
import shutil
import subprocess
import sys
import tempfile
import time
from pathlib import Path

sys.path.insert(0, str(Path(__file__).parents[1]))

import numpy as np
from scenes import started
from scipy.integrate import solve_ivp

import sealdyn
from sealdyn.numerics.hermite import sample
from sealdyn.simulation.simulate import simulate, simulate_in_memory
from sealdyn.solvers import sundials_python
from sealdyn.solvers.contract import Counts, absolute_tolerances
from sealdyn.solvers.methods import METHODS

HERE = Path(__file__).parent
SCENARIO = HERE.parents[1] / "scenarios" / "fms_reference.toml"
LIBRARIES = ("cvode", "nvecserial", "sunmatrixdense", "sunlinsoldense")
TURNS, INSTANTS, ERRORS = 400, 17, (1e-3, 1e-6, 1e-9)


# The programs: each returns (wall time in s, complex tilt at the instants) --------------------------------------------


def build(folder):
    """The C program, or None with a line why."""
    target = Path(folder) / "limit"
    names = [f"-lsundials_{name}" for name in LIBRARIES]
    for compiler in filter(shutil.which, ("gcc", "clang", "cc")):
        for core in ("core", "generic"):
            command = [compiler, "-O3", "-march=native", "-ffast-math", "-o", target, HERE / "limit.c", *names]
            if subprocess.run([*command, f"-lsundials_{core}", "-lm"], capture_output=True).returncode == 0:
                return target
    print("no C compiler, or no SUNDIALS for it (Debian: libsundials-dev): nothing is compared with C")
    return None


def in_c(program, turns, tolerance):
    words = [program, "1", str(turns), f"{tolerance:.3e}"]
    line = subprocess.run(words, capture_output=True, text=True, check=True).stdout.split()
    return float(line[1]), float(line[3])


def instants(duration):
    return duration * np.linspace(0.9, 1.0, INSTANTS)


def fresh(turns):
    scene = sealdyn.read_scenario(SCENARIO).scene
    return started(scene, turns * 2 * math.pi / scene.shaft.speed, 1e-8)


def by_steps(steps):
    """A generator of steps, every step kept."""

    def integrate(ready, tolerance):
        segment, begun = ready.segment(0), time.perf_counter()
        blocks = list(steps(segment, 0.0, ready.y0, "adams", tolerance, Counts()))
        wall = time.perf_counter() - begun
        t, ys = (np.concatenate([block[i] for block in blocks]) for i in range(2))
        q, rate = np.ascontiguousarray(ys[:, 1:3]), np.ascontiguousarray(ys[:, 4:6])
        times, out, slope = instants(ready.duration), np.empty((INSTANTS, 2)), np.empty((INSTANTS, 2))
        sample(t, q, rate, len(t), 0, len(t) - 1, times, out, slope)
        return wall, out @ [1, 1j]

    return integrate


def by_scipy(rhs_of, method):
    def integrate(ready, tolerance):
        rhs, y0, absolute = rhs_of(ready, tolerance)
        begun = time.perf_counter()
        y = solve_ivp(rhs, (0.0, ready.duration), y0, method, t_eval=instants(ready.duration),
                      rtol=max(tolerance, 2.3e-14), atol=absolute).y  # fmt: skip
        return time.perf_counter() - begun, y[1] + 1j * y[2]

    return integrate


def compiled(ready, tolerance):
    segment = ready.segment(0)

    def rhs(t, y):
        yp = np.empty(len(y))
        segment.rhs(t, y, yp)
        return yp

    return rhs, ready.y0, absolute_tolerances(segment, tolerance)


def in_numpy(ready, tolerance):
    """The same seal as arrays over 24 angles and 10 radii, as one would write it in NumPy."""
    scene = ready.model.scene
    film, ring, w, c = scene.film, scene.stator, scene.shaft.speed, ready.model.clearance
    r_i, r_o, mu, p = film.inner_radius, film.outer_radius, film.viscosity, film.outer_pressure
    x, weight = np.polynomial.legendre.leggauss(10)
    r, weight = 0.5 * (r_i + r_o) + 0.5 * (r_o - r_i) * x, 0.5 * (r_o - r_i) * weight
    theta = 2 * np.pi * np.arange(24) / 24
    cos, sin, each = np.cos(theta), np.sin(theta), 2 * np.pi / 24
    square, cube, cone = 0.5 * (r**2 - r_i**2), (r**3 - r_i**3) / 3, c + film.coning * (r - r_i)
    powers = np.array([np.ones_like(r), r**2, r**3]).T

    def load(z, g, z_rate, g_rate):
        slope, around = g.real * sin - g.imag * cos, g.real * cos + g.imag * sin
        rate = g_rate.real * sin - g_rate.imag * cos + 0.5 * w * around
        each_r = weight / (r * (cone + z + np.outer(slope, r)) ** 3)
        f = 12 * mu * (z_rate * square + np.outer(rate, cube))
        (a, b, d), (af, bf, df) = (each_r @ powers).T, ((each_r * f) @ powers).T
        k = (p - af) / a
        arm = (p * r_o**3 - df - k * d) / 3
        return each * np.sum(0.5 * (p * r_o**2 - bf - k * b)), each * np.sum(arm * (sin - 1j * cos))

    closing, _ = load(0.0, 0j, 0.0, 0j)
    support, own, runout = ring.support, ring.misalignment, scene.rotor.runout
    k_t, d_t = support.tilt()

    def rhs(t, y):
        turning = runout * np.exp(1j * w * t)
        g, g_rate = y[1] + 1j * y[2], y[4] + 1j * y[5]
        force, moment = load(y[0], g - turning, y[3], g_rate - 1j * w * turning)
        axial = (force - closing - support.axial_stiffness * y[0] - support.axial_damping * y[3]) / ring.mass
        turned = (moment - k_t * (g - own) - d_t * g_rate) / ring.transverse_inertia
        return np.array([y[3], y[4], y[5], axial, turned.real, turned.imag])

    scales = np.concatenate([ready.model.scales[:3], ready.model.scales[:3] * w])
    return rhs, np.zeros(6), tolerance * scales


PROGRAMS = {
    "compiled loop": by_steps(METHODS["adams"]),
    "scikit-sundae": by_steps(sundials_python.cvode),
    "SciPy DOP853, compiled right-hand side": by_scipy(compiled, "DOP853"),
    "SciPy DOP853, NumPy right-hand side": by_scipy(in_numpy, "DOP853"),
}
SLOW = {"SciPy DOP853, NumPy right-hand side": 0.1}


# Measurements ---------------------------------------------------------------------------------------------------------


def curves(program, turns, repeats, tolerances):
    """{program: [(error, wall time)]}; programs take turns at each tolerance.  A slow one runs a share of the turns,
    its time in proportion."""
    exact = {}
    for name, integrate in PROGRAMS.items():
        ready = fresh(turns * SLOW.get(name, 1.0))
        exact[name] = integrate(ready, 3e-13)[1]
        scale = ready.model.clearance / ready.model.scene.film.outer_radius
    found = {name: [] for name in (["C"] if program else []) + list(PROGRAMS)}
    for tolerance in tolerances:
        best = {name: [math.inf, 0.0] for name in found}
        for _ in range(repeats):
            if program:
                wall, error = in_c(program, turns, tolerance)
                best["C"] = [min(best["C"][0], wall), error]
            for name, integrate in PROGRAMS.items():
                share = SLOW.get(name, 1.0)
                if share < 1.0 and best[name][0] < math.inf:
                    continue
                wall, tilt = integrate(fresh(turns * share), tolerance)
                best[name] = [min(best[name][0], wall / share), float(np.max(np.abs(tilt - exact[name]))) / scale]
        for name, (wall, error) in best.items():
            found[name].append((error, wall))
    return found


def fastest_at(points, error):
    """Wall time (s) of the fastest run that achieves the error; NaN if none does."""
    return min((wall for e, wall in points if e <= error), default=math.nan)


def tell_curves(found):
    names = list(found)
    print(f"integration alone, {TURNS} turns: ms at equal achieved error, and how many times the first")
    for error in ERRORS:
        walls = [fastest_at(found[name], error) for name in names]
        print(f"  error {error:.0e}")
        for name, wall in zip(names, walls, strict=True):
            print(f"    {name:40s} {wall * 1e3:10.2f}  {wall / walls[0]:7.2f}")


def whole_runs(program, repeats):
    """`simulate` with archive and certificate, and a short run in memory, against C at error 1e-6."""
    with tempfile.TemporaryDirectory() as folder:
        for turns, way, limit in (
            (TURNS, "archive of 64 samples a turn", "6 times"),
            (40, "in memory", "3 times + 2 ms"),
        ):
            scenario = sealdyn.read_scenario(SCENARIO, [f"run.turns={turns}"])
            if way == "in memory":
                few = sealdyn.read_scenario(SCENARIO, [f"run.turns={turns}", "run.samples=4"])
                run = lambda few=few: simulate_in_memory(few)  # noqa: E731
            else:
                run = lambda scenario=scenario: simulate(scenario, Path(folder) / "run.h5")  # noqa: E731
            run()
            ours, floor = math.inf, math.inf
            for _ in range(repeats):
                begun = time.perf_counter()
                run()
                ours = min(ours, time.perf_counter() - begun)
                if program:
                    floor = min(
                        [floor, *(w for w, e in (in_c(program, turns, 10.0**-k) for k in (5, 6, 7, 8)) if e <= 1e-6)]
                    )
            walls = f"{ours * 1e3:.1f} ms, C {floor * 1e3:.1f} ms"
            print(f"{turns} turns, {way}: {walls}: {ours / floor:.2f} times (asked {limit})")


def main():
    words = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    words.add_argument("--quick", action="store_true", help="two repeats of three tolerances")
    words.add_argument("--repeats", type=int, default=7, help="of every run; the least time counts")
    words.add_argument("figure", nargs="?")
    asked = words.parse_args()
    repeats, tolerances = (
        (2, [1e-4, 1e-7, 1e-10]) if asked.quick else (asked.repeats, [10.0**-k for k in np.arange(3, 12.1, 0.5)])
    )
    with tempfile.TemporaryDirectory() as folder:
        program = build(folder)
        found = curves(program, TURNS, repeats, tolerances)
        tell_curves(found)
        whole_runs(program, 3 * repeats)
    if asked.figure:
        draw(found, asked.figure)


def draw(found, path):
    import matplotlib

    matplotlib.use("Agg")
    from matplotlib import pyplot

    figure, axes = pyplot.subplots(figsize=(7, 4.5), layout="constrained")
    for (name, points), marker in zip(found.items(), "osv^D", strict=False):
        axes.loglog(*np.array(points).T, marker=marker, label=name)
    axes.set_xlabel("achieved error of the tilt, in C/r_o")
    axes.set_ylabel("wall time, s")
    axes.set_title(f"Reference FMS seal, radial film, {TURNS} turns: integration alone")
    axes.grid(True, alpha=0.3)
    figure.legend(loc="outside lower center", ncols=2, fontsize=8)
    figure.savefig(path, dpi=110)


if __name__ == "__main__":
    main()
