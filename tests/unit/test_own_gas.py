"""Scenes with gas that stores against their equations in other words (tests/own_gas.py): residual and what the
certificate looks at, at any state, the steady start, and whole runs by another method than IDA."""

from functools import cache

import numpy as np
import pytest
from families import gas_reynolds
from judge import by_steps
from own_words import OwnSeal, own
from scenes import prepared
from scipy.integrate import Radau

from sealdyn.simulation.verification_run import ErrorScales

SEED = 78
SCENES = tuple(range(12))


@cache
def scene_of(number):
    """What is drawn, a run, its scales, and the seal in own words."""
    drawn = gas_reynolds(np.random.default_rng([SEED, number]), other_faces=False)
    run = prepared(drawn.scene, drawn.duration, 1e-10)
    return drawn, run, ErrorScales(run), OwnSeal(drawn.scene, drawn.duration)


def state_at(random, seal, t):
    """Displacements and rates of some tenths of their scales, and pressures of any size beside them."""
    scale = seal.scale()
    while True:
        y = scale * random.uniform(-0.4, 0.4, len(scale))
        y[2 * seal.n :] = scale[2 * seal.n :] * random.uniform(0.1, 1.2, seal.gas.size)
        if seal.thinnest(t, y) > 0.1 * seal.scene.film.clearance:
            return y


@pytest.mark.core
def test_scenes_have_everything():
    drawn = [scene_of(number)[0] for number in SCENES]
    words = {word for one in drawn for word in one.words}
    assert words >= {"fms", "fmr", "fmsr", "cone", "negative cone", "slip", "equal pressures", "undamped"}
    sides = [np.sign(seal.pieces[0]["p_o"][0] - seal.pieces[0]["p_i"][0]) for *_, seal in map(scene_of, SCENES)]
    assert set(sides) == {-1.0, 0.0, 1.0}


@pytest.mark.parametrize("number", SCENES)
def test_rates_and_loads(number):
    """Own rates leave nothing of the program's residual, and loads are the same, but for rounding."""
    drawn, run, scales, seal = scene_of(number)
    random, n = np.random.default_rng([SEED, number, 1]), seal.n
    assert run.model.unknowns.names == seal.names
    for t in random.uniform(0.0, drawn.duration, 4):
        y = state_at(random, seal, t)
        segment = run.segment(max(k for k in range(len(run.intervals)) if run.intervals[k].time <= t))
        tau, full, rates = t - segment.time, np.zeros(segment.size), np.zeros(segment.size)
        full[: len(y)], rates[: len(y)] = y, seal.rates(t, y)
        left = np.empty(segment.size)
        segment.residual(tau, full, rates, left)
        size = np.abs(rates[: len(y)])
        # Forces on the rings nearly cancel.
        for part, least in ((slice(0, n), 1e-13), (slice(n, 2 * n), 1e-9), (slice(2 * n, len(y)), 1e-12)):
            assert np.max(np.abs(left[: len(y)][part])) <= least * np.max(size[part])
        motion = segment.motion(full[None, :], rates[None, :])
        columns = scales.of(segment, np.array([tau]), *motion, full[None, segment.film])[0]
        others = seal.columns(t, y)
        np.testing.assert_allclose(columns[: 2 * n], others[: 2 * n], rtol=1e-12, atol=1e-13)
        force, outer = abs(others[2 * n]), drawn.scene.film.outer_radius
        apart = np.abs(columns - others)[2 * n :] / [force, force * outer, force * outer, *np.abs(others[-2:])]
        assert apart.max() <= 1e-9


@pytest.mark.parametrize("number", SCENES)
def test_starts(number):
    """The steady film, squeezed and sheared."""
    _, run, _, seal = scene_of(number)
    random, segment = np.random.default_rng([SEED, number, 3]), run.segment(0)
    y = state_at(random, seal, 0.0)[: 2 * seal.n]
    y[seal.n :] *= 0.02
    full = np.zeros(segment.size)
    full[: 2 * seal.n] = y
    segment.settle_film(0.0, full)
    others = seal.begun(y)[2 * seal.n :]
    np.testing.assert_allclose(full[segment.film], others, rtol=0.0, atol=1e-9 * others.max())


@pytest.mark.slow
def test_runs():
    """A whole run by IDA, and by Radau in own words, both far sharper than the accuracy by which they are compared.
    Two more: test_promises.py::test_gas_that_stores; any number: `python tests/benchmark/own_judgement.py --kind
    gas_waves`."""
    drawn, _, scales, seal = scene_of(0)
    times = np.linspace(0.0, drawn.duration, 20, endpoint=False)
    columns, _ = by_steps(prepared(drawn.scene, drawn.duration, 1e-8, drawn.start), scales, times, "ida", 1e-9)
    begun = prepared(drawn.scene, drawn.duration, 1e-8, drawn.start)
    others = own(drawn.scene, drawn.duration, begun.y0[: 2 * seal.n], times, 1e-8, Radau)
    rows = min(len(columns), len(others))
    assert rows > 2 and scales.errors(columns[:rows], others[:rows]).max() < 1e-5
