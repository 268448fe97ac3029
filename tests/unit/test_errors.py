"""Errors come back from another process as they went."""

import pickle

import pytest

from sealdyn.analysis.poincare_map import FilmCollapsed
from sealdyn.dynamics.run_state import FilmClosed
from sealdyn.scenario.errors import ScenarioError, refuse, scene_errors_of, set_by
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


def test_the_name_of_a_scenario_is_placed_at_its_door():
    """And the override behind it; what else is wrong has both, here and in another process."""
    with pytest.raises(ScenarioError) as caught, scene_errors_of("outer"), scene_errors_of("seal.toml"), set_by("a=1"):
        refuse([SceneError("a", "0", "more"), SceneError("a", "1", "less"), SceneError("b", "2", "fewer")])
    name = 'seal.toml (--set "a=1")'
    for error in (caught.value, pickle.loads(pickle.dumps(caught.value))):
        whole = [(e.name, e.key, e.found, e.expected) for e in (error, *error.others)]
        assert whole == [(name, "a", "0", "more"), (name, "b", "2", "fewer")]
