"""What IDA costs with a film of 400 unknowns (tests/radial_cells.py), by where its derivatives come from.

    PYTHONPATH=tests python tests/benchmark/film_with_unknowns.py

Four turns of the FMS seal of tests/scenes.py, the same steps each time; the minimum of five runs in turn (machines are
noisy).  On a two-core x86-64 machine 0.33 s by known derivatives in sparse form, which is taken, and
0.49 s in dense form; by differences 1.4 s dense and 2.1 s sparse (the rings' rows are dense: a colour a column).
"""

import math
import time
from functools import partial

import numpy as np
from radial_cells import film_of
from scenes import SPEED, fms, prepared

from sealdyn.dynamics.model import Model
from sealdyn.solvers import sundials_python as sundials
from sealdyn.solvers.contract import Counts, tolerance_for

TURNS, CELLS, ANGLES, ACCURACY = 4, 25, 16, 1e-6
KNOWN = sundials._film_options


def dense_and_known(segment, counts):
    data, pattern = np.empty(segment.pattern.nnz), segment.pattern
    places = pattern.indices, np.repeat(np.arange(segment.size), np.diff(pattern.indptr))

    def jacobian(t, y, yp, res, cj, matrix):
        counts.jacobians += 1
        segment.residual_derivatives(t, y, yp, cj, data)
        matrix[places] = data

    return {"jacfn": jacobian}


WAYS = {
    "sparse, derivatives known": KNOWN,
    "dense, derivatives known": dense_and_known,
    "sparse, the pattern alone": lambda segment, counts: {"linsolver": "sparse", "sparsity": segment.pattern},
    "dense, differences": lambda segment, counts: {},
}


def seconds(ready, way):
    sundials._film_options = way
    segment, y, counts = ready.segment(0), ready.y0.copy(), Counts()
    segment.settle_film(0.0, y)
    tolerance, begun = tolerance_for("ida", ACCURACY, ready.memory), time.perf_counter()
    steps = sum(len(t) for t, *_ in sundials.ida(segment, 0.0, y, "ida", tolerance, counts))
    return time.perf_counter() - begun, steps, counts.rhs


if __name__ == "__main__":
    model = partial(Model, film=film_of(CELLS, ANGLES))
    ready = prepared(fms(), TURNS * 2 * math.pi / SPEED, ACCURACY, model_class=model)
    seconds(ready, KNOWN)
    rounds = [{name: seconds(ready, way) for name, way in WAYS.items()} for _ in range(5)]
    for name in WAYS:
        best = min((found[name] for found in rounds), key=lambda one: one[0])
        print(f"{name:28s} {best[0] * 1e3:6.0f} ms, {best[1]} steps, {best[2]} residuals")
