"""Everything that is wrong with a file, at once: each key once, the most telling first."""

import pytest
from command import SCENARIOS
from hypothesis import given, settings
from hypothesis import strategies as st

from sealdyn.scenario.errors import MOST
from sealdyn.scenario.reader import ScenarioError, parse_scenario

FMR = (SCENARIOS / "fmr_reference.toml").read_text()


def errors(text: str, *overrides) -> list[ScenarioError]:
    with pytest.raises(ScenarioError) as caught:
        parse_scenario(text, "seal.toml", overrides)
    found = [caught.value, *caught.value.others]
    assert all(str(error).startswith("seal.toml") and str(error).isprintable() for error in found)
    return found


def keys(text: str, *overrides) -> list[str]:
    return [error.key for error in errors(text, *overrides)]


# What a key may be set to, so that it is wrong by itself and nothing else is.
SLIPS = {
    "film.clearance": '"10 kg"', "film.viscosty": '"1 cP"', "film.outer_pressure": '"5 Bar"',
    "film.outer_diameter": '"80 rpm"', "rotor.mass": "nan", "rotor.support.axial_damping": "true",
    "run.solver": '"admas"', "shaft.speed": "[1]", "stator.waviness": "[{ order = 2, amplitud = 1 }]",
}  # fmt: skip


@settings(deadline=None)
@given(st.sets(st.sampled_from(sorted(SLIPS)), min_size=1))
def test_slips_are_reported_together(slips):
    """Overrides replace the right values by wrong ones: each is found, and nothing else."""
    expected = {"stator.waviness.0.amplitud" if slip == "stator.waviness" else slip for slip in slips}
    assert set(keys(FMR, *(f"{slip}={SLIPS[slip]}" for slip in slips))) == expected


@pytest.mark.core
def test_the_first_is_an_unknown_key_then_a_wrong_value_then_a_missing_one():
    text = FMR.replace('viscosity = "0.5 mPa*s"', "").replace('"5 bar"', '"5 rpm"').replace("[stator]", "[statr]")
    found = keys(text.replace("inner_pressure = ", "inner_presure = "))
    assert found[:2] == ["film.inner_presure", "statr"] or found[:2] == ["statr", "film.inner_presure"]
    assert found[2] == "film.outer_pressure"
    # Those misspelt are not missing, too.
    assert not {"stator", "film.inner_pressure"} & set(found)


def test_a_misspelt_diameter_is_no_missing_radius():
    assert keys(FMR.replace('outer_radius = "40 mm"', 'outer_diametre = "80 mm"')) == ["film.outer_diametre"]


@pytest.mark.parametrize(
    ("written", "meant"),
    [("face", "film"), ("fluid", "film"), ("flim", "film"), ("rotor.springs", "support"), ("rotor.suport", "support")],
)
def test_a_table_of_another_name_is_known_by_its_spelling_or_its_keys(written, meant):
    """And is one thing wrong: what it was meant for is not missing besides, where it is wrong alone."""
    place = ".".join([*written.split(".")[:-1], meant])
    first, *others = errors(FMR.replace(f"[{place}]", f"[{written}]"))
    assert first.key == written and f"nearest '{meant}'" in first.expected and not others


def test_what_no_scene_can_have_together_of_every_part():
    wrong = ["film.cavitation_pressure=1 bar", "closing.balance_ratio=-1", "rotor.polar_inertia=1", "run.duration=-1"]
    expected = ["film.cavitation_pressure", "closing.balance_ratio", "rotor.polar_inertia", "run.duration"]
    assert keys(FMR, *wrong, "film.floor=1") == ["film.floor", *expected]


@pytest.mark.parametrize(
    ("wrong", "blamed"),
    [("film.inner_radius=41 mm", "film.inner_radius"), ("film.outer_radius=-1 mm", "film.outer_radius")],
)
def test_radii_of_the_face_are_to_blame_before_those_of_its_pads(wrong, blamed):
    pads = "film.pads=[{count=3, depth=1e-6, angle=1.0, inner_radius=0.034, outer_radius=0.040}]"
    assert keys(FMR, pads, wrong)[0] == blamed


def test_of_thousands_so_many_lines():
    text = "".join(f"[[housing.axial]]\nfrequency = 0\nx{k} = 1\n" for k in range(2000))
    found = errors(f"{FMR}\n{text}")
    assert len(found) == MOST and "more" in found[-1].found


def test_one_problem_is_one_line():
    assert keys(FMR, "film.clearance=10 kg") == ["film.clearance"]
