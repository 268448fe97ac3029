"""Runs of scenes drawn at random, by equations in the tests' own words, of which the program
has none (tests/own_films.py, own_torn.py, own_words.py): within what each run promises."""

import numpy as np
import own_judged as judged
import pytest

SEED = 2029


def errors(kind, number, seed=SEED):
    """Errors by name over what is promised."""
    found, promised, *_ = getattr(judged, kind)(np.random.default_rng([seed, number]))
    return {name: error / promised for name, error in found.items()}


@pytest.mark.parametrize(
    ("kind", "number"),
    [
        pytest.param("rub", 15, marks=pytest.mark.core),
        pytest.param("gas_rub", 5, marks=pytest.mark.slow),
        ("gas_pads", 3),
        ("liquid_waves", 2),
        pytest.param("gas_continued", 4, marks=pytest.mark.core),
        pytest.param("torn_continued", 3, marks=pytest.mark.slow),
    ],
)
def test_a_drawn_scene_is_what_was_promised(kind, number):
    found = errors(kind, number)
    assert max(found.values()) <= 1.0, found
