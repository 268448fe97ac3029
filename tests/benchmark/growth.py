"""How cost grows: turns, samples, quadrature points, unknowns, scenes, cores.

    python tests/benchmark/growth.py [figure.png] [--quick]

The reference FMS seal but where unknowns are counted: that is its film as finite volumes (tests/radial_cells.py).  Each
number is the least of several runs in turn; read how it grows, not how large it is.
"""

import argparse
import math
import os
import sys
import tempfile
from functools import partial
from pathlib import Path

sys.path.insert(0, str(Path(__file__).parents[1]))

import numpy as np
from radial_cells import film_of
from right_hand_side import best
from scenes import SPEED, fms, prepared

import sealdyn
from sealdyn.dynamics.model import Model
from sealdyn.dynamics.native import Value, at_each
from sealdyn.films._radial_quadrature import RADIAL_POINTS, points_for
from sealdyn.films.radial import film as radial
from sealdyn.simulation.simulate import simulate, simulate_in_memory
from sealdyn.solvers.contract import Counts, tolerance_for
from sealdyn.solvers.methods import METHODS

SCENARIO = Path(__file__).parents[2] / "scenarios" / "fms_reference.toml"
CORES = os.cpu_count() or 1


def least(function, repeats):
    """Least wall time (s) of several calls, after one that is not counted."""
    function()
    return best(function, repeats)


def scenario(**run):
    return sealdyn.read_scenario(SCENARIO, [f"run.{key}={value}" for key, value in run.items()])


def turns(repeats, quick):
    """Wall time over turns: with archive, 64 samples a turn, and in memory."""
    counts = [10, 40, 160] if quick else [10, 40, 160, 640, 2560]
    with tempfile.TemporaryDirectory() as folder:
        out = Path(folder) / "run.h5"
        whole = [least(lambda n=n: simulate(scenario(turns=n), out), repeats) for n in counts]
    lean = [least(lambda n=n: simulate_in_memory(scenario(turns=n, samples=4)), repeats) for n in counts]
    return "turns", {"archive, 64 samples a turn": (counts, whole), "in memory, 4 samples": (counts, lean)}


def samples(repeats, quick):
    """Wall time of 40 turns over the samples kept."""
    counts = [10, 1000, 10_000] if quick else [10, 100, 1000, 10_000, 100_000]
    with tempfile.TemporaryDirectory() as folder:
        out = Path(folder) / "run.h5"
        walls = [least(lambda n=n: simulate(scenario(turns=40, samples=n), out), repeats) for n in counts]
    return "samples of 40 turns", {"with archive": (counts, walls)}


def points(repeats, quick):
    """Wall time of one film over its quadrature points: films of other accuracy and tilt."""
    film, found = scenario(turns=1).scene.film, []
    clearance = film.clearance
    for error in (1e-3, 1e-6, 1e-9, 1e-12):
        f = radial.parameters(film, clearance, error)
        for share in (0.05, 0.4, 0.8):
            states = np.tile(prepared(fms(), 1.0, 1e-6).segment(0).gap_state(0.0, np.zeros(12)), (4000, 1))
            states[:, 1] = share * clearance / film.outer_radius
            edges = [clearance, clearance + film.coning * (film.outer_radius - film.inner_radius)]
            swings = [share * clearance * film.inner_radius / film.outer_radius, share * clearance]
            angles = radial.angles_for(f, *edges, *swings)
            thin, thick = ([h + sign * s for h, s in zip(edges, swings, strict=True)] for sign in (-1, 1))
            rule = max(points_for(f, *thin), points_for(f, *thick))
            wall = least(partial(at_each, Value(radial.wrench), f, states), repeats) / len(states)
            found.append(((angles // 2 + 1) * RADIAL_POINTS[rule], wall))
    found.sort()
    return "quadrature points of half the circle", {"film, one call": tuple(zip(*found, strict=True))}


def unknowns(repeats, quick):
    """Wall time of a step of IDA over the unknowns of a film, cells over the radius times angles."""
    sizes, steps_taken, found = (
        [(5, 8), (10, 16)] if quick else [(5, 8), (10, 16), (20, 24), (30, 32), (50, 48)],
        {},
        [],
    )
    for cells, angles in sizes:
        model = partial(Model, film=film_of(cells, angles))
        ready = prepared(fms(), 2 * 2 * math.pi / SPEED, 1e-6, model_class=model)
        tolerance = tolerance_for("ida", 1e-4, ready.memory)

        def run(ready=ready, tolerance=tolerance, size=cells * angles):
            segment, y = ready.segment(0), ready.y0.copy()
            segment.settle_film(0.0, y)
            steps_taken[size] = sum(len(t) for t, *_ in METHODS["ida"](segment, 0.0, y, "ida", tolerance, Counts()))

        wall = least(run, repeats)
        found.append((cells * angles, wall / steps_taken[cells * angles]))
    return "unknowns of a film", {"a step of IDA": tuple(zip(*found, strict=True))}


def many(count, workers):
    draw = np.random.default_rng(1).uniform(5e-6, 5e-5, count)
    sealdyn.simulate_many(scenario(turns=40), [{"rotor.runout": float(x)} for x in draw], workers=workers)


def scenes(repeats, quick):
    """Wall time of many runs of 40 turns over their number."""
    counts = [1, 16, 128] if quick else [1, 4, 16, 64, 256, 1024]
    curves = {}
    for workers in sorted({1, CORES}):
        curves[f"{workers} process{'es' if workers > 1 else ''}"] = (
            counts,
            [least(lambda n=n, w=workers: many(n, w), max(1, repeats if n < 300 else 1)) for n in counts],
        )
    return "runs of 40 turns", curves


def cores(repeats, quick):
    """Runs a second over the processes."""
    count = 64 if quick else 1000
    workers = sorted({1, 2, CORES})
    rates = [count / least(lambda w=w: many(count, w), repeats) for w in workers]
    return "processes", {"runs of 40 turns a second": (workers, rates)}


def draw(found, path):
    import matplotlib

    matplotlib.use("Agg")
    from matplotlib import pyplot

    figure, axes = pyplot.subplots(2, 3, figsize=(11, 6.5), layout="constrained")
    for place, (label, curves) in zip(axes.flat, found, strict=True):
        first = next(iter(curves.values()))[0]
        # Over less than a decade and a half powers of ten say little.
        plot = place.loglog if first[-1] > 30 * first[0] else place.plot
        for (name, (x, y)), marker in zip(curves.items(), "osv", strict=False):
            plot(x, y, marker=marker, label=name)
        x, y = (np.array(part, dtype=float) for part in next(iter(curves.values())))
        plot(x, y[-1] * x / x[-1], ":", color="grey", label="in proportion")
        place.set_xlabel(label)
        place.set_ylabel("runs a second" if label == "processes" else "wall time, s")
        place.grid(True, alpha=0.3)
        place.legend(fontsize=8)
    figure.suptitle("What a run costs, and how that grows")
    figure.savefig(path, dpi=110)


def main():
    words = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    words.add_argument("figure", nargs="?")
    words.add_argument("--quick", action="store_true")
    words.add_argument("--repeats", type=int, default=3)
    asked = words.parse_args()
    found = []
    for measure in (turns, samples, points, unknowns, scenes, cores):
        label, curves = measure(asked.repeats, asked.quick)
        print(measure.__doc__)
        for name, (x, y) in curves.items():
            print(f"  {name}: " + ", ".join(f"{a:g}: {b:.3g}" for a, b in zip(x, y, strict=True)), flush=True)
        found.append((label, curves))
    rate = max(found[-1][1]["runs of 40 turns a second"][1])
    print(
        f"A million runs of 40 turns: {1e6 / rate / 3600:.1f} h here; with 100 such machines {1e4 / rate / 60:.0f} min"
    )
    if asked.figure:
        draw(found, asked.figure)


if __name__ == "__main__":
    main()
