"""Studies of the film alone leave contact and secondary seals out, and say so."""

from pathlib import Path

import pytest

from sealdyn.scenario.reader import ScenarioError, parse_scenario
from sealdyn.scenario.settings import without_contact
from sealdyn.studies._runner import run_study

TEXT = (Path(__file__).parents[2] / "scenarios" / "fms_reference.toml").read_text()
CONTACT = '[contact]\nroughness = "0.1 um"\ncompressive_strength = "300 MPa"\n'
SEAL = '[stator.secondary_seal]\nradius = "45 mm"\nline_friction = "20 N/m"\n'


def test_tables_are_left_out_and_the_rest_stays():
    whole = parse_scenario(TEXT + CONTACT + SEAL, "x", ["contact.roughness=0.2 um", "shaft.speed=1100 rad/s"])
    film, names = without_contact(whole)
    assert names == ["contact", "stator.secondary_seal"]
    assert film.scene == parse_scenario(TEXT, "x", ["shaft.speed=1100 rad/s"]).scene
    assert without_contact(film) == (film, [])


def test_however_the_tables_are_written():
    dotted = 'contact.roughness = "0.1 um"\ncontact.compressive_strength = 3e8\n'
    film, names = without_contact(parse_scenario(dotted + TEXT, "x"))
    assert names == ["contact"] and film.scene == parse_scenario(TEXT, "x").scene


def test_faces_that_touch_at_the_start_are_none_without_contact():
    """10 um less 0.322 mrad times 32 mm: closed by 0.3 um, which rough faces (2 um) carry and a film alone does not."""
    contact = '[contact]\nroughness = "2 um"\ncompressive_strength = "300 MPa"\n'
    touching = parse_scenario(TEXT + contact, "x", ["stator.misalignment=0", "rotor.runout=0.322 mrad"])
    with pytest.raises(ScenarioError, match="film closed at the start"):
        without_contact(touching)


def test_the_verdict_says_what_was_left_out(tmp_path):
    scenario = parse_scenario(TEXT + CONTACT, "x")
    answer = run_study("equilibrium", scenario, tmp_path / "a.h5")
    assert "[contact]" in answer["verdict"][-1]
    alone = run_study("equilibrium", parse_scenario(TEXT, "x"), tmp_path / "b.h5")
    assert answer["roots"] == alone["roots"]
