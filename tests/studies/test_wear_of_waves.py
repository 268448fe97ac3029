"""Wavy faces that wear: life of a lapped wave against a march of its own, volume, travelling waves, what is refused."""

from dataclasses import replace

import numpy as np
import pytest
from command import SCENARIOS
from own_wavy_wear import WavyFaces, touching

from sealdyn import read_scenario, run_study
from sealdyn.scenario.errors import ScenarioError
from sealdyn.scene.scene import SceneError
from sealdyn.studies.wear.rosenbrock import NoAverage
from sealdyn.studies.wear.waves import BalancesOfWaves

FILE = SCENARIOS / "lebeck_n3.toml"
HALF, STRENGTH, SPEED, OUTER, COEFFICIENT = 0.50001e-6, 286.7e6, 188.0, 0.05, 1e-17
WEARS = ["contact.stator_wear_coefficient=1e-17 1/Pa", "film.reynolds.cells_r=6", "film.reynolds.cells_theta=144"]


def worn(tmp_path, *overrides, **flags):
    flags = {"duration": "50 min", "nodes": 3} | flags
    return run_study("wear", read_scenario(FILE, [*WEARS, *overrides]), tmp_path / "s.h5", flags=flags, workers=1)


@pytest.mark.slow
def test_a_lapped_wave_lives_as_long_as_in_a_march_of_its_own(tmp_path):
    answer = worn(tmp_path, harmonics=12)
    unit = HALF / (COEFFICIENT * SPEED * OUTER * STRENGTH / 0.5)
    own = WavyFaces(3, (6, 48)).life(0.6, 0.5)
    assert answer["life"] == pytest.approx(own * unit, rel=0.01)
    assert answer["volume"]["residual"] < 1e-9
    history = answer["history"]
    assert np.all(np.diff(history["waviness"]) < 0.0) and np.all(np.diff(history["load_support"]) < 0.0)


def test_both_faces_wear_and_their_volume_is_that_of_the_rates(tmp_path):
    answer = worn(tmp_path, "contact.rotor_wear_coefficient=3e-17 1/Pa", harmonics=4, duration="5 min")
    assert answer["volume"]["residual"] < 1e-9
    stator, rotor = (answer["history"][f"{face}_volume"][-1] for face in ("stator", "rotor"))
    assert rotor == pytest.approx(3.0 * stator, rel=1e-12)
    # Mean wear rate of both times time, by the balances themselves.
    history, area = answer["history"], np.pi * (0.05**2 - 0.045**2)
    mean = np.trapezoid(history["wear_rate"], history["time"]) * area
    assert stator + rotor == pytest.approx(mean, rel=0.01)
    # A ring that turns does not lower the wave: only the stator's own share does.
    alone = worn(tmp_path, harmonics=4, duration="5 min")
    assert answer["history"]["waviness"][-1] == pytest.approx(alone["history"]["waviness"][-1], rel=2e-3)


def test_a_travelling_wave_wears_as_the_mean_over_its_phase(tmp_path):
    """Twice around in a day, six passes of three waves: the pressure at one place over that time."""
    scene = read_scenario(FILE, WEARS).scene
    radius = np.linspace(0.045, 0.05, 5)
    travelling = BalancesOfWaves(scene, radius, 4, True)
    here = travelling(np.zeros(5))
    rate = travelling.basis.rates(here.nodal)[0]
    turned = np.linspace(0.0, 2 * 2.0 * np.pi, 4001)
    gap = here.row["clearance"] + 0.3e-6 * np.cos(3 * (0.7 - turned))
    at_a_place = np.trapezoid(touching(gap / HALF), turned) / turned[-1]
    assert rate == pytest.approx(COEFFICIENT * SPEED * radius * STRENGTH * at_a_place, rel=1e-3)
    answer = worn(tmp_path, travelling=True, duration="10 min")
    assert answer["life"] is None and answer["history"]["waviness"][-1] == answer["history"]["waviness"][0] == 0.3e-6
    assert answer["history"]["stator_volume"][-1] > 0.0 and answer["volume"]["residual"] < 1e-9


def test_rates_fall_with_depth_as_their_slopes_say():
    """Of the asperities alone: a film that is the same everywhere is not in the slopes."""
    scene = read_scenario(FILE, [*WEARS, "contact.rotor_wear_coefficient=2e-17 1/Pa"]).scene
    balances = BalancesOfWaves(scene, np.linspace(0.045, 0.05, 3), 3, False)
    # The ring follows an even depth: nothing changes.
    found = balances(np.zeros(6))
    assert np.abs(found.slope[:, :3].sum(axis=1)).max() < 1e-9 * np.abs(found.slope).max()
    deeper = balances(np.array([1e-8, 1e-8, 1e-8, 0.0, 0.0, 0.0]), found.motion)
    assert deeper.nodal == pytest.approx(found.nodal, rel=1e-6)
    with pytest.raises(NoAverage):
        balances(np.array([0.0, 0.0, 0.0, 3e-4, 0.0, 0.0]))


@pytest.mark.parametrize(
    ("overrides", "key"),
    [
        (['stator.waviness=[{order=3, amplitude="0.3 um"}, {order=6, amplitude="0.1 um"}]'], "stator.waviness"),
        (["contact.stator_wear_coefficient=0"], "contact.stator_wear_coefficient"),
        (["film.clearance=1 um", "closing={}"], "closing.balance_ratio"),
    ],
)
def test_what_does_not_wear_so(overrides, key, tmp_path):
    with pytest.raises((SceneError, ScenarioError)) as error:
        worn(tmp_path, *overrides)
    assert error.value.key == key


def test_an_elastic_ring_is_refused():
    scene = read_scenario(FILE.with_name("lebeck_elastic.toml")).scene
    with pytest.raises(SceneError, match=r"stator\.elastic"):
        BalancesOfWaves(replace(scene), np.linspace(0.045, 0.05, 3), 3, False)
