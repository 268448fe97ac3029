"""What `sealdyn check` says beyond the scene."""

from command import SCENARIOS, sealdyn


def test_check_says_what_the_floor_of_a_pressure_costs(tmp_path):
    answer = sealdyn("check", SCENARIOS / "ludwig_allen.toml", cwd=tmp_path)
    assert answer.code == 0 and "# floor of the pressure, on 50 % of the face" in answer.out
    answer = sealdyn("check", SCENARIOS / "ludwig_allen.toml", "--json", cwd=tmp_path)
    assert "starve" in answer.found["beside_reynolds"]["said"]


def test_check_says_which_waves_are_left_of_an_elastic_ring(tmp_path):
    answer = sealdyn("check", SCENARIOS / "lebeck_elastic.toml", cwd=tmp_path)
    assert answer.code == 0 and "of its 17.5 um of waves are left at rest" in answer.out
