"""Means and largest values of a run: of the motion, whatever is sampled."""

import numpy as np
import pytest
from command import SCENARIOS
from scipy.integrate import simpson

import sealdyn
from sealdyn.answers import dotted
from sealdyn.numerics.hermite import points
from sealdyn.scenario.reader import read_scenario
from sealdyn.simulation.result import output

SCENES = {
    "fms_reference": ["run.turns=3"],
    "fmr_reference": ["run.turns=3", "run.accuracy=1e-4"],
    "rub": ["run.duration=0.262"],
}
# With unknowns of its own.
STORING = ["run.turns=0.3", "run.accuracy=0.01", "film.gas_reynolds.cells=[6, 12]"]
PARTS = ("leakage.", "friction.", "relative_misalignment.mean", "contact.", "film.max_cavitated")


def numbers(summary) -> dict:
    """All numbers of the summary that could come from samples."""
    return {key: found for key in dict(dotted(summary))
            if key.startswith(PARTS) and isinstance(found := output(summary, key), (int, float))}  # fmt: skip


@pytest.mark.core
@pytest.mark.parametrize("name", SCENES)
def test_numbers_do_not_depend_on_the_samples(name):
    path, accuracy = SCENARIOS / f"{name}.toml", read_scenario(SCENARIOS / f"{name}.toml", SCENES[name]).run.accuracy
    counts = (8, 200) if name == "rub" else (8, 20, 200)
    found = [numbers(sealdyn.run(path, [*SCENES[name], f"run.samples_per_turn={count}"]).summary) for count in counts]
    for other in found[1:]:
        assert found[0].keys() == other.keys()
        for key, value in found[0].items():
            assert other[key] == pytest.approx(value, rel=accuracy, abs=1e-300), key


@pytest.mark.parametrize("name", [*SCENES, "gas_reynolds_reference"])
def test_numbers_are_those_of_dense_series(name):
    """Simpson's rule over a thousand samples a turn; largest values are not below the series', and near them."""
    changes = [*SCENES.get(name, STORING), "run.samples_per_turn=1000"]
    result = sealdyn.run(SCENARIOS / f"{name}.toml", changes)
    data, accuracy = result.data, result.summary["accuracy"]
    series = {
        "relative_misalignment.mean": "relative_misalignment",
        "friction.power": "friction_power",
        "friction.torque": "friction_torque",
        "contact.force.mean": "contact_force",
        "contact.wear_rate": "wear_rate",
    }
    time = data["time"].values
    for key, name_of_series in series.items():
        if name_of_series in data:
            mean = simpson(data[name_of_series].values, x=time) / (time[-1] - time[0])
            scale = np.abs(data[name_of_series].values).max()
            assert output(result.summary, key) == pytest.approx(mean, abs=3 * accuracy * scale), key
    if contact := result.summary["contact"]:
        # The impulse is an unknown of the solver's own; measured 1e-6 of the largest force.
        mean, most = contact["force"]["mean"], contact["force"]["max"]
        assert mean == pytest.approx(contact["impulse"] / time[-1], abs=accuracy * most)
    largest = {"friction.max_power": "friction_power", "contact.force.max": "contact_force",
               "contact.max_pressure": "contact_pressure"}  # fmt: skip
    for key, name_of_series in largest.items():
        if name_of_series in data:
            highest = float(data[name_of_series].max())
            found = output(result.summary, key)
            assert highest * (1 - accuracy) <= found <= highest * (1 + 1e-3), key


def test_the_rule_is_exact_to_degree_seven_and_knows_long_short_and_cut_steps():
    random = np.random.default_rng(2)
    steps = np.cumsum(np.concatenate([[0.0], 10.0 ** random.uniform(-6, 0, 40), np.full(20, 0.1)]))
    for until in (steps[-1], steps[-1] - 0.03):
        times, weights = points(steps, 3, len(steps) - 1, until, 0.25)
        assert times[0] == steps[3] and times[-1] == until and np.all(np.diff(times) > 0) and np.all(weights > 0)
        assert np.diff(times).max() < 0.25
        assert weights @ times**7 == pytest.approx((until**8 - steps[3] ** 8) / 8, rel=1e-12)
    # Fewer points than steps where they are alike and short.
    alike = np.linspace(0.0, 1.0, 101)
    assert len(points(alike, 0, 100, 1.0, 1.0)[0]) == 69
