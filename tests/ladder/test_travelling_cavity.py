"""A cavity that travels around the circle with a turning face nearly as tilted as the film is thick."""

import numpy as np
import pytest
from benchmark.cavitating_film import PLAIN, TRAVELS

from sealdyn.dynamics.model import Model
from sealdyn.dynamics.run_state import RunState
from sealdyn.scenario.reader import parse_scenario
from sealdyn.solvers.contract import Counts
from sealdyn.solvers.trbdf2 import trbdf2

# Where Newton's steps pass kinks, behind which the way leads back, they are taken in part.
FEW_CELLS = "film.reynolds.cells_r=6", "film.reynolds.cells_theta=48"


@pytest.mark.core
def test_steps_pass_cells_that_tear_and_fill_all_the_time():
    ends = []
    for tolerance in (1e-3, 1e-4):
        model = Model(parse_scenario(PLAIN, "seal", [*TRAVELS, *FEW_CELLS]).scene, 1e-2)
        state, counts = RunState(model, model.time_of(1.5)), Counts()
        segment, y = state.segment(0), state.y0.copy()
        segment.settle_film(0.0, y)
        most = 4000 if tolerance == 1e-3 else 20000
        for _, ys, _ in trbdf2(segment, 0.0, y, "trbdf2", tolerance, counts):
            y = ys[-1]
            assert segment.settled < most
        assert counts.unsolved < 0.1 * sum(counts.orders)
        ends.append(y[: segment.n] / segment.scales[: segment.n])
    assert np.abs(ends[0] - ends[1]).max() < 1e-2
    # The film is thin somewhere: the faces follow each other badly.
    assert np.hypot(*ends[1][1:]) > 0.3
