"""Elastic ring: what the study cannot be asked, runs with the waves that are left; its three wavinesses are held in
test_every_study_is_data.py."""

import pytest
from command import SCENARIOS

from sealdyn import read_scenario, run_study, simulate
from sealdyn.archive import read_study
from sealdyn.scenario.errors import ScenarioError
from sealdyn.scene.scene import SceneError

FILE = SCENARIOS / "lebeck_elastic.toml"
COARSE = ["film.reynolds.cells_r=6", "film.reynolds.cells_theta=108"]


def test_no_point_in_the_range_is_said(tmp_path):
    flags = {"net_from": "7 um", "net_to": "9 um", "points": 3}
    answer = run_study("elastic-ring", read_scenario(FILE, COARSE), tmp_path / "s.h5", flags=flags, workers=1)
    assert not answer["points"] and not answer["tables"][0]["rows"]
    assert "series" not in read_study(answer["archive"])["panels"][2]


def test_a_ring_that_the_load_levels_is_told_and_turning_back_rubs_no_less(tmp_path):
    flags = {"net_from": "10 um", "net_to": "20 um", "points": 3}
    low = [*COARSE, 'stator.waviness=[{order=2, amplitude="1 um"}]', 'shaft.speed="-188 rad/s"']
    answer = run_study("elastic-ring", read_scenario(FILE, low), tmp_path / "s.h5", flags=flags, workers=1)
    assert not answer["points"] and answer["initial"] < min(answer["curve"]["initial"])
    assert all(rubs > 0.0 for rubs in answer["curve"]["friction_coefficient"])


def test_a_run_has_the_waves_that_are_left(tmp_path):
    coarse = ["film.reynolds.cells_r=4", "film.reynolds.cells_theta=72", "run.turns=0.2", "run.accuracy=0.1"]
    result = simulate(read_scenario(FILE, coarse), tmp_path / "r.h5")
    assert any("of its 17.5 um of waves are left" in reason for reason in result.summary["model"]["reasons"])
    assert result.summary["film"]["clearance"] < 8e-6


@pytest.mark.core
@pytest.mark.parametrize(
    ("override", "key"),
    [
        ("stator.elastic.radius=0", "stator.elastic.radius"),
        ("stator.elastic.torsion_ratio=-1", "stator.elastic.torsion_ratio"),
        ("stator.waviness=[]", "stator.elastic"),
        ("film.model=auto", "contact"),
        ("stator.speed=3", "stator"),
    ],
)
def test_what_cannot_be(override, key):
    with pytest.raises(ScenarioError) as error:
        read_scenario(FILE, [override])
    assert key in error.value.key or key == error.value.key


def test_a_ring_that_does_not_bend_is_said(tmp_path):
    scenario = read_scenario(FILE.with_name("lebeck_n3.toml"))
    with pytest.raises(SceneError, match=r"stator\.elastic"):
        run_study("elastic-ring", scenario, tmp_path / "s.h5")
