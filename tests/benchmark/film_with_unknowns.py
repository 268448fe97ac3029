"""What IDA costs with a film of 400 unknowns (tests/radial_cells.py): by the compiled loop, through scikit-sundae, and
there by where its derivatives come from.

    python tests/benchmark/film_with_unknowns.py

Four turns of the FMS seal of tests/scenes.py, each way in turn in one process on one thread; the minimum of fifteen
rounds (machines are noisy), the slow ways in three of them.  On a two-core x86-64 machine, busy:
30 ms by the compiled loop, 1.4 times that through scikit-sundae by known derivatives in sparse form, 12 times in dense
form; by differences 33 times dense and 36 times sparse (the rings' rows are dense: a colour a column).  Of the 30 ms
SuperLU_MT takes half and the film's residual a quarter.
"""

import math
import sys
import time
from functools import partial
from pathlib import Path

sys.path.insert(0, str(Path(__file__).parents[1]))

import numpy as np
from radial_cells import film_of
from scenes import SPEED, fms, prepared

from sealdyn.dynamics.model import Model
from sealdyn.numerics.interruption import one_thread
from sealdyn.solvers import sundials_python
from sealdyn.solvers.contract import Counts, tolerance_for
from sealdyn.solvers.methods import why_slow

TURNS, CELLS, ANGLES, ACCURACY = 4, 25, 16, 1e-6
KNOWN = sundials_python._film_options


def dense_and_known(segment, counts):
    data, pattern = np.empty(segment.pattern.nnz), segment.pattern
    places = pattern.indices, np.repeat(np.arange(segment.size), np.diff(pattern.indptr))

    def jacobian(t, y, yp, res, cj, matrix):
        counts.jacobians += 1
        segment.residual_derivatives(t, y, yp, cj, data)
        matrix[places] = data

    return {"jacfn": jacobian}


WAYS = {
    "compiled loop": None,
    "sparse, derivatives known": KNOWN,
    "dense, derivatives known": dense_and_known,
    "sparse, the pattern alone": lambda segment, counts: {"linsolver": "sparse", "sparsity": segment.pattern},
    "dense, differences": lambda segment, counts: {},
}
ROUNDS, FAST, FEW = 15, 2, 3


def seconds(ready, way):
    """Wall time (s) of the steps alone, how many, and evaluations; a `way` of scikit-sundae, None the compiled loop."""
    sundials_python._film_options = way
    segment, y, counts = ready.segment(0), ready.y0.copy(), Counts()
    segment.settle_film(0.0, y)
    begun_with = segment.start(0.0, y)
    segment.start = lambda tau, y: [part.copy() for part in begun_with]
    back_end = sundials_python if way else sundials_direct
    tolerance, begun = tolerance_for("ida", ACCURACY, ready.memory), time.perf_counter()
    steps = sum(len(t) for t, *_ in back_end.ida(segment, 0.0, y, "ida", tolerance, counts))
    return time.perf_counter() - begun, steps, counts.rhs


if __name__ == "__main__":
    one_thread()
    if why := why_slow(sparse=True):
        raise SystemExit(why)
    from sealdyn.solvers import sundials_direct

    model = partial(Model, film=film_of(CELLS, ANGLES))
    ready = prepared(fms(), TURNS * 2 * math.pi / SPEED, ACCURACY, model_class=model)
    best = {name: (math.inf,) for name in WAYS}
    for turn in range(ROUNDS):
        for name, way in list(WAYS.items())[: None if turn < FEW else FAST]:
            best[name] = min(best[name], seconds(ready, way))
    first, *_ = best["compiled loop"]
    for name, (wall, steps, calls) in best.items():
        print(f"{name:28s} {wall * 1e3:6.0f} ms, {wall / first:5.2f} times, {steps} steps, {calls} residuals")
