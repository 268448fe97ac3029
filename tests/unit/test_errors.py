"""Errors come back from another process as they went."""

import pickle

import pytest

from sealdyn.analysis.poincare_map import FilmCollapsed
from sealdyn.dynamics.run_state import FilmClosed
from sealdyn.scenario.errors import ScenarioError
from sealdyn.scene.scene import SceneError
from sealdyn.solvers.contract import Cause, Status
from sealdyn.studies.wear.rosenbrock import NoAverage
from sealdyn.units import QuantityError


@pytest.mark.core
@pytest.mark.parametrize(
    "error",
    [
        SceneError("film", "none", "a film"), FilmClosed("film.clearance", "0", "more"),
        ScenarioError("seal.toml", "film.clearance", "0", "more"), QuantityError("0", "more"),
        NoAverage(Status.FAILED, "it ended early"), FilmCollapsed("the film is gone", Cause.INTERRUPTED),
    ],
    ids=lambda error: type(error).__name__,
)  # fmt: skip
def test_an_error_comes_back_whole_from_another_process(error):
    again = pickle.loads(pickle.dumps(error))
    assert type(again) is type(error)
    assert str(again) == str(error)
    assert vars(again) == vars(error)
