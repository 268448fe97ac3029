"""Studies reckon with contact and secondary seals, or refuse them until they are asked to leave them out."""

import pytest
from command import SCENARIOS

from sealdyn.scenario.reader import ScenarioError, parse_scenario
from sealdyn.scenario.settings import without
from sealdyn.scene.scene import SceneError
from sealdyn.studies._runner import run_study

TEXT = (SCENARIOS / "fms_reference.toml").read_text()
CONTACT = '[contact]\nroughness = "0.1 um"\ncompressive_strength = "300 MPa"\n'
SEAL = '[stator.secondary_seal]\nradius = "45 mm"\nline_friction = "20 N/m"\n'


@pytest.mark.core
def test_tables_are_left_out_and_the_rest_stays():
    whole = parse_scenario(TEXT + CONTACT + SEAL, "x", ["contact.roughness=0.2 um", "shaft.speed=1100 rad/s"])
    film, names = without(whole, ["contact"])
    assert names == ["contact", "stator.secondary_seal"]
    assert film.scene == parse_scenario(TEXT, "x", ["shaft.speed=1100 rad/s"]).scene
    assert without(film, ["contact"]) == (film, [])
    rough, names = without(whole, ["secondary-seal"])
    assert names == ["stator.secondary_seal"] and rough.scene.contact == whole.scene.contact
    assert without(whole, []) == (whole, [])


def test_however_the_tables_are_written():
    dotted = 'contact.roughness = "0.1 um"\ncontact.compressive_strength = 3e8\n'
    film, names = without(parse_scenario(dotted + TEXT, "x"), ["contact"])
    assert names == ["contact"] and film.scene == parse_scenario(TEXT, "x").scene


def test_another_name_is_refused():
    with pytest.raises(ScenarioError, match="contact or secondary-seal"):
        without(parse_scenario(TEXT, "x"), ["friction"])


def test_faces_that_touch_at_the_start_are_none_without_contact():
    """10 um less 0.322 mrad times 32 mm: closed by 0.3 um, which rough faces (2 um) carry and a film alone does not."""
    contact = '[contact]\nroughness = "2 um"\ncompressive_strength = "300 MPa"\n'
    touching = parse_scenario(TEXT + contact, "x", ["stator.misalignment=0", "rotor.runout=0.322 mrad"])
    with pytest.raises(ScenarioError, match="film closed at the start"):
        without(touching, ["contact"])


def test_what_was_left_out_is_said(tmp_path):
    scenario = parse_scenario(TEXT + CONTACT, "x")
    answer = run_study("equilibrium", scenario, tmp_path / "a.h5", leave_out=["contact"])
    assert answer["left_out"] == ["contact"] and "[contact]" in answer["verdict"][-1]
    alone = run_study("equilibrium", parse_scenario(TEXT, "x"), tmp_path / "b.h5")
    assert answer["roots"] == alone["roots"] and alone["left_out"] == []


@pytest.mark.parametrize("study", ["campbell", "critical-speed", "stability", "transmissibility", "contact-onset"])
def test_a_ring_that_its_seal_holds_has_no_small_motion(study, tmp_path):
    with pytest.raises(SceneError, match="without secondary-seal") as refusal:
        run_study(study, parse_scenario(TEXT + SEAL, "x"), tmp_path / "a.h5")
    assert refusal.value.key == "stator.secondary_seal"
    assert list(tmp_path.iterdir()) == []


def test_a_study_of_the_linear_film_refuses_contact(tmp_path):
    with pytest.raises(SceneError, match="without contact") as refusal:
        run_study("neutral-stability", parse_scenario(TEXT + CONTACT, "x"), tmp_path / "a.h5")
    assert refusal.value.key == "contact"
