"""What an archive keeps of the seal's force and moments on shaft and housing, against Newton's law of its ring."""

import numpy as np
import pytest

import sealdyn


@pytest.mark.parametrize(
    "name, ring, carrier, sign", [("fmr_reference", "rotor", "shaft", -1), ("fms_reference", "stator", "housing", 1)]
)
def test_a_ring_moves_as_film_and_reactions_push_it(name, ring, carrier, sign):
    scenario = sealdyn.example(name).with_({"run.turns": 1, "run.samples_per_turn": 4000, "run.start": "rest"})
    data = sealdyn.run(scenario).data
    mass = getattr(scenario.scene, ring).mass
    push = sign * (data.film_force - data.closing_force) - data[f"{carrier}_force"]
    time = data.time.values
    moved = mass * np.gradient(data[f"{ring}_z_rate"].values, time, edge_order=2)
    inside = slice(20, -20)
    assert np.abs(moved).max() > 0.1
    np.testing.assert_allclose(push.values[inside], moved[inside], atol=2e-4 * np.abs(moved).max())
    # The other carrier holds the ring that is rigid with it: what the film does there, thrust beside.
    other = {"shaft": "housing", "housing": "shaft"}[carrier]
    np.testing.assert_array_equal(data[f"{other}_moment_x"], -sign * data.film_moment_x)
    np.testing.assert_array_equal(data[f"{other}_force"], -sign * (data.film_force - data.closing_force))
