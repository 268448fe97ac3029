"""Diameters in place of radii: the same scenes, whichever way they come in."""

import json

import pytest
from command import SCENARIOS

import sealdyn
from sealdyn.scenario.reader import ScenarioError, parse_scenario, with_values
from sealdyn.studies._declared import json_schema
from sealdyn.studies.tolerance.scatter import read_scatter

FMR = (SCENARIOS / "fmr_reference.toml").read_text()
DRAWN = FMR.replace('inner_radius = "32 mm"', 'inner_diameter = "64 mm"').replace(
    'outer_radius = "40 mm"', 'outer_diameter = "80 mm"'
).replace('radius = "40 mm" ', 'diameter = "80 mm" ')  # fmt: skip


def parse(text, *overrides):
    return parse_scenario(text, "seal.toml", overrides)


@pytest.mark.core
def test_a_scene_from_its_drawing_is_the_scene_of_its_radii():
    assert DRAWN.count("_diameter =") == 2 and "\ndiameter =" in DRAWN
    assert parse(DRAWN).scene == parse(FMR).scene and parse(DRAWN) == parse(FMR)


@pytest.mark.parametrize("text", [FMR, DRAWN], ids=["radii", "diameters"])
def test_what_is_set_later_replaces_either(text):
    for override in ("film.outer_diameter=76 mm", "film.outer_radius=38 mm", "film.outer_diameter=0.076"):
        assert parse(text, override).scene.film.outer_radius == 0.038
        key, _, value = override.partition("=")
        assert with_values(parse(text), {key: value}).scene.film.outer_radius == 0.038
    assert with_values(parse(text), {"rotor.support.diameter": 0.07}).scene.rotor.support.radius == 0.035
    assert parse(text, "rotor.support.tilt_stiffness=400 N*m").scene.rotor.support.radius is None


def test_tir_is_read_at_the_outer_diameter():
    tir = 'support.radius = "40 mm"\nsupport.axial_stiffness = 1e5\nmass = 1\ntransverse_inertia = 1e-3'
    text = DRAWN.replace("[stator]", f"[stator]\n{tir}").replace("misalignment = ", "misalignment = 0 #", 1)
    scenario = parse(text.split("[rotor]")[0] + '[rotor]\nrunout = "20 um TIR"\n[stator]\n' + tir)
    assert scenario.scene.rotor.runout == pytest.approx(20e-6 / 0.08, rel=1e-15)
    assert with_values(scenario, {"film.outer_diameter": "100 mm"}).scene.rotor.runout == pytest.approx(2e-4, rel=1e-15)


@pytest.mark.parametrize(
    "old, new, key, says",
    [
        ("[film]", "[film]\nouter_radius = 1", "film.outer_diameter", "one of the two"),
        ('outer_diameter = "80 mm"', 'outer_diameter = "80 rpm"', "film.outer_diameter", "a unit of speed"),
        ('outer_diameter = "80 mm"', "outer_diameter = [1]", "film.outer_diameter", "a list"),
        ('outer_diameter = "80 mm"', 'outer_diametre = "80 mm"', "film.outer_diametre", "nearest 'outer_diameter'"),
        ('outer_diameter = "80 mm"', "", "film.outer_radius", "nothing"),
        ('inner_diameter = "64 mm"', 'inner_diameter = "84 mm"', "film.inner_radius", "half of inner_diameter"),
        ('geometry = "cyl', 'diameter = 1\ngeometry = "cyl', "film.diameter", "belongs to"),
    ],
)
def test_refused_in_one_line_that_names_the_key(old, new, key, says):
    assert old in DRAWN
    with pytest.raises(ScenarioError) as caught:
        parse(DRAWN.replace(old, new))
    assert caught.value.key == key and says in str(caught.value)


def test_the_schema_takes_one_of_the_two():
    film, support = (json_schema()["$defs"][kind] for kind in ("Film", "Support"))
    ways = [[way["required"] for way in rule["oneOf"]] for rule in film["allOf"]]
    assert ways == [[["inner_radius"], ["inner_diameter"]], [["outer_radius"], ["outer_diameter"]]]
    assert not {"inner_radius", "outer_radius"} & set(film["required"]) and "outer_pressure" in film["required"]
    assert support["allOf"] == [{"not": {"required": ["radius", "diameter"]}}]
    assert list(film["properties"])[:4] == ["inner_radius", "inner_diameter", "outer_radius", "outer_diameter"]
    assert film["properties"]["outer_diameter"]["quantity"] == "length"
    assert "asperity_diameter" not in json.dumps(json_schema())


def test_a_tolerance_of_the_drawing_is_one_of_the_diameter():
    (scatter,) = read_scatter(parse(DRAWN), ["film.outer_diameter = normal(+- 0.3 mm)"])
    assert scatter.key == "film.outer_diameter" and scatter.centre == 0.08
    assert scatter.law.std() == pytest.approx(1e-4, rel=1e-12)


def test_a_sweep_over_a_diameter_is_the_sweep_over_its_radius(tmp_path):
    scenario, found = parse(DRAWN, "run.turns=2"), []
    for vary in ("film.inner_diameter=64:66 mm:2", "film.inner_radius=32:33 mm:2"):
        answer = sealdyn.run_study("sweep", scenario, tmp_path / "sweep.h5", flags={"vary": vary}, workers=1)
        found.append([row["h_min.value"] for row in answer["rows"]])
    assert found[0] == found[1] and found[0][0] != found[0][1]
