"""Warm states of random seals beside a dense scan of the rise in the tests' own words (own_warm_states.py): water and
oil, sealed outside and inside, smooth and rough."""

import numpy as np
import pytest
from own_warm_states import as_changes, drawn
from warm_seals import scene_of

from sealdyn.dynamics.warm_state import warming

SEED, FEW, MANY, IN_TIME = 41, 20, 40, 7
# Of rises and clearances; those of rough faces have a kink where the asperities of a part of the face begin to touch.
SAME, ROUGH = 1e-5, 2e-4


def seals(count):
    rng = np.random.default_rng(SEED)
    return [drawn(rng) for _ in range(count)]


def is_found(seal, points):
    """That program and scan find the same states, with the same loop gains; the program's."""
    states, expected = warming(scene_of(as_changes(seal))).states, seal.states(points)
    assert len(states) == len(expected), (states, expected)
    for state, (rise, clearance) in zip(states, expected, strict=True):
        same = ROUGH if seal.rough else SAME
        assert (state.rise, state.clearance) == pytest.approx((rise, clearance), rel=same), seal
        gain = seal.loop_gain(rise)
        assert state.loop_gain == pytest.approx(gain, abs=1e-3 * (1.0 + abs(gain))), seal
    return states


@pytest.mark.core
def test_every_state_is_found_and_no_other():
    found = [is_found(seal, 120) for seal in seals(FEW)]
    # Seals with one state, with two and with none are among them.
    assert {len(states) for states in found} == {0, 1, 2}


@pytest.mark.slow
def test_so_it_is_of_many():
    for seal in seals(MANY)[FEW:]:
        is_found(seal, 300)


def test_a_slow_eigenvalue_is_the_growth_in_time():
    checked = []
    for seal in seals(MANY):
        for state in warming(scene_of(as_changes(seal))).states:
            growth = seal.growth(state.rise, state.clearance, 1.0 / abs(state.slow))
            assert state.slow.real == pytest.approx(growth, rel=0.02), seal
            assert state.stable == (growth < 0.0)
            checked.append(growth)
        if len(checked) >= IN_TIME:
            break
    assert min(checked) < 0.0


def test_an_unstable_state_grows_as_its_eigenvalue_says():
    """The thin film of a seal that is pressurised inside."""
    rng = np.random.default_rng(SEED)
    for _ in range(MANY):
        seal = drawn(rng, contact=False, inside=True)
        states = warming(scene_of(as_changes(seal))).states
        if len(states) == 2:
            break
    thin = states[1]
    assert not thin.stable
    assert thin.slow.real == pytest.approx(seal.growth(thin.rise, thin.clearance, 1.0 / abs(thin.slow)), rel=0.02)
