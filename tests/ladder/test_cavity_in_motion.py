"""Cavities that open, move and close in a squeezed film, against the closed form (tests/moving_front.py), and one that
travels around the circle with a turning face nearly as tilted as the film is thick."""

import moving_front
import numpy as np
import pytest
from benchmark.cavitating_film import PLAIN, TRAVELS

from sealdyn.dynamics.model import Model
from sealdyn.dynamics.run_state import RunState
from sealdyn.faces.geometry import DZ, FLOW_INNER, FLOW_OUTER, GAP_STATE_SIZE, INNER_PRESSURE, OUTER_PRESSURE, VISCOSITY
from sealdyn.films.reynolds import film as reynolds
from sealdyn.films.reynolds.mesh import ANGLE_STEP, AREA, table
from sealdyn.scenario.reader import parse_scenario
from sealdyn.scene.film import Film, Reynolds
from sealdyn.solvers.contract import Counts
from sealdyn.solvers.own_methods import D, W, trbdf2

# So far out a ring is straight; with these units p is the P of the closed form.
FAR, VISCOUS = 1e6, 1.0 / 6.0


def strip(cells):
    """Block and gap state of a strip of unit width."""
    film = Film(
        inner_radius=FAR, outer_radius=FAR + 1.0, inner_pressure=moving_front.EDGE, outer_pressure=moving_front.EDGE,
        viscosity=VISCOUS, cavitation_pressure=0.0, clearance=1.0, model="reynolds",
        reynolds=Reynolds(cells_r=cells, cells_theta=64, sectors=64),
    )  # fmt: skip
    s = np.zeros(GAP_STATE_SIZE)
    s[[VISCOSITY, INNER_PRESSURE, OUTER_PRESSURE]] = VISCOUS, moving_front.EDGE, moving_front.EDGE
    return reynolds.parameters(film, 1.0), s


def marched(cells, steps, until=0.8):
    """Times, unknowns (steps + 1, 2 cells), and what flowed in through both edges less what is there, at most, as a
    share of it, and the same of their rates at any stage."""
    f, s = strip(cells)
    x, h = np.empty(2 * cells), until / steps

    def gap(t):
        s[DZ] = moving_front.height(t) - 1.0

    gap(0.0)
    assert reynolds.start(f, s, x) == 0
    area, whole = table(f, AREA)[:cells] * f[ANGLE_STEP], []
    rate, kept, flowed, lost = np.zeros(2 * cells), [x.copy()], 0.0, 0.0
    alpha, begun = 1.0 / (D * h), float(area @ x[cells:])

    def stage(t, base):
        gap(t)
        assert reynolds.settle(f, s, alpha, base, x) == 0
        reynolds.flow(f, s, x)
        arrived = s[FLOW_INNER] - s[FLOW_OUTER]
        whole.append((64 * float(area @ (alpha * (x - base)[cells:])) - arrived, arrived))
        return alpha * (x - base), (s[FLOW_INNER] - s[FLOW_OUTER]) / 64

    first = 0.0
    for n in range(steps):
        at = x.copy()
        rate_1, in_1 = stage((n + 2.0 * D) * h, at + D * h * rate)
        rate_2, in_2 = stage((n + 1) * h, at + h * W * (rate + rate_1))
        flowed += h * (W * first + W * in_1 + D * in_2)
        rate, first = rate_2, in_2
        kept.append(x.copy())
        lost = max(lost, abs(float(area @ x[cells:]) - begun - flowed))
    missing, arrived = np.abs(whole).max(axis=0)
    return np.linspace(0.0, until, steps + 1), np.array(kept), lost / begun, missing / arrived


def front(x):
    """Where the cavity begins; the first of its cells is partly full."""
    n = len(x) // 2
    void = -np.minimum(x[:n], 0.0)
    first = int(np.argmax(void > 0.0))
    if void[first] == 0.0:
        return 0.5
    return (first + 1.0 - void[first] / void[first + 1]) / n


@pytest.mark.core
def test_the_front_moves_as_the_closed_form_has_it():
    # The faces part again at 0.75.
    times, kept, lost, whole = marched(400, 1500, 0.75)
    torn = np.flatnonzero((kept[:, :400] < 0.0).any(axis=1))
    step = times[1]
    assert moving_front.rupture() == pytest.approx(0.25008, abs=1e-5)
    assert times[torn[0]] == pytest.approx(moving_front.rupture(), abs=1.5 * step)
    places, closed = moving_front.fronts([0.4, 0.5, 0.6, 0.7])
    assert closed == pytest.approx(0.7324, abs=1e-4)
    assert times[torn[-1]] == pytest.approx(closed, abs=2.0 * step)
    assert places == pytest.approx([0.02678, 0.03909, 0.06278, 0.17694], abs=1e-5)
    found = [front(kept[round(t / step)]) for t in (0.4, 0.5, 0.6, 0.7)]
    assert found == pytest.approx(places, abs=5e-5)
    # The rates of every stage, and what has come in since the start.
    assert whole < 1e-10
    assert lost < 1e-11


def test_cells_and_steps_converge():
    places, _ = moving_front.fronts([0.5, 0.6, 0.7])
    errors = []
    for cells, steps in ((100, 700), (400, 2800)):
        times, kept, _, _ = marched(cells, steps, 0.7)
        found = [front(kept[round(t / times[1])]) for t in (0.5, 0.6, 0.7)]
        errors.append(np.max(np.abs(np.array(found) - places)))
    assert errors[0] < 5e-4
    assert errors[1] < 0.3 * errors[0]


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
