"""The `[film.profile]` table: read, refused in one line, resolved and read back, and the film it chooses."""

import json

import numpy as np
import pytest
from scenes import film, fmr, started

from sealdyn.report.text import resolved_lines
from sealdyn.scenario.reader import ScenarioError, parse_scenario
from sealdyn.scenario.tables import Run
from sealdyn.scene.film import Profile
from sealdyn.scene.forces import Contact
from sealdyn.scene.scene import SceneError
from sealdyn.simulation.selection import select_film
from sealdyn.studies._declared import json_schema

SCENARIO = """
[shaft]
speed = "1000 rad/s"
[film]
inner_radius = "32 mm"
outer_radius = "1.5748031496062993 in"
clearance = "10 um"
coning = "1 mrad"
viscosity = "0.5 mPa*s"
outer_pressure = "5 bar"
inner_pressure = 0
[film.profile]
radius = ["32 mm", "3.4 cm", 0.036, "40 mm"]
depth = ["3 um", "1 um", 0, "-2e-6 m"]
[rotor]
mass = "1 kg"
transverse_inertia = "8e-4 kg*m^2"
polar_inertia = "1.6e-3 kg*m^2"
misalignment = "25 urad"
[rotor.support]
axial_stiffness = "5e5 N/m"
axial_damping = "300 N*s/m"
radius = "40 mm"
"""
NO_MODEL = {"film": "", "unknowns": [], "solver": "", "reasons": [], "unused": []}
R = "film.profile.radius="
D = "film.profile.depth="


def test_read_in_si():
    profile = parse_scenario(SCENARIO, "worn.toml").scene.film.profile
    assert profile == Profile((0.032, 0.034, 0.036, 0.04), (3e-6, 1e-6, 0.0, -2e-6))


@pytest.mark.core
def test_resolved_and_read_back():
    """What `check` prints is a scenario with the same profile; the schema has the table; JSON can be made of it."""
    scenario = parse_scenario(SCENARIO, "worn.toml")
    printed = resolved_lines({"scene": scenario.resolved(), "model": NO_MODEL, "equilibria": [], "design_rules": []})
    again = parse_scenario("\n".join(printed), "again.toml")
    assert again.scene.film == scenario.scene.film and again.scene.film.profile is not None
    assert json.loads(json.dumps(scenario.resolved()))["film"]["profile"]["depth"] == [3e-6, 1e-6, 0.0, -2e-6]
    schema = json_schema()["$defs"]
    assert schema["Profile"]["required"] == ["radius", "depth"] and not schema["Profile"]["additionalProperties"]
    assert "profiled" in schema["Film"]["properties"]["model"]["enum"]
    assert scenario.unused() == []


@pytest.mark.parametrize(
    ("override", "says"),
    [
        (R + '["32 mm"]', "[film.profile] radius: found 1 radii; expected 2 to 65 radii"),
        (R + str([0.032 + 0.008 * k / 65 for k in range(66)]), "found 66 radii; expected 2 to 65 radii"),
        (R + '["32 mm", "36 mm", "40 mm"]', "[film.profile] depth: found 4 depths of 3 radii; expected as many depths"),
        (R + '["32 mm", "36 mm", "36 mm", "40 mm"]', "radius: found 0.036 m after 0.036 m; expected radii that incr"),
        (R + '["32 mm", "37 mm", "36 mm", "40 mm"]', "radius: found 0.036 m after 0.037 m; expected radii that incr"),
        (R + '["33 mm", "34 mm", "36 mm", "40 mm"]', "found 0.033 m first; expected inner_radius = 0.032 m first"),
        (R + '["32 mm", "34 mm", "36 mm", "39 mm"]', "found 0.039 m last; expected outer_radius = 0.04 m last"),
        (R + '"32 mm"', '[film.profile] radius: found "32 mm"; expected a list, each a length in m'),
        (R + '["32 mm", "34 kg", 0.036, 0.04]', 'radius: found "34 kg" (a unit of mass) as entry 2; expected a length'),
        (D + "[0, 1e-6, nan, 0]", "found nan"),
        (D + "[0, true, 0, 0]", "[film.profile.depth] 1: found true"),
        (D + '["0 um", "0 um", "-20 um", "0 um"]', "depth: found a film of -6e-06 m at r = 0.036 m; expected an open"),
        ("film.model='radial'", '[film] model: found "radial" with a profile; expected "profiled" or "auto"'),
        ("film.model='linear'", '[film] model: found "linear" with a profile; expected "profiled" or "auto"'),
        ("film.cavitation_pressure=0", "[film] cavitation_pressure: found a value with a profile; expected nothing"),
        ("film.profile.radii=[0]", "[film.profile] radii: found an unknown key"),
        ("rotor.misalignment='600 urad'", "closed at the start (faces overlap by"),
    ],
)
def test_refused_in_one_line(override, says):
    with pytest.raises(ScenarioError) as error:
        overrides = [override] if "600" not in override else [override, "initial.rotor.tilt_x=5e-4"]
        parse_scenario(SCENARIO, "worn.toml", overrides)
    assert says in str(error.value) and "\n" not in str(error.value)


def test_half_a_profile():
    for key in ("radius", "depth"):
        text = "\n".join(line for line in SCENARIO.splitlines() if not line.startswith(f"{key} = ["))
        with pytest.raises(ScenarioError, match=rf"{key}: found nothing; expected a list, each a length"):
            parse_scenario(text, "worn.toml")


def test_auto_goes_straight_to_the_profiled_film():
    worn = fmr(film=film("auto", profile=Profile((0.032, 0.036, 0.04), (0.0, 2e-6, 0.0))))
    ready, error = select_film(worn, Run(duration=0.01, accuracy=1e-3), lambda p: None)
    assert ready.model.interface.name == "profiled" and error is None


def test_scenes_built_in_python_are_refused_too():
    for bad in (
        film("radial", profile=Profile((0.032, 0.04), (0.0, 0.0))),
        film("auto", profile=Profile((0.032, 0.04), (0.0, float("nan")))),
        film("profiled", profile=Profile(np.linspace(0.032, 0.04, 66), np.zeros(66))),
    ):
        with pytest.raises(SceneError):
            started(fmr(film=bad), 0.01, 1e-6)


def test_the_aligned_faces_rest_on_their_asperities_where_they_are_highest():
    """Closed by more than the film carries, the faces of a bent profile meet at its highest radius."""
    rough = Contact(roughness=0.1e-6, compressive_strength=300e6)
    worn = film("auto", clearance=0.2e-6, coning=0.0, profile=Profile((0.032, 0.036, 0.04), (5e-6, 0.0, 5e-6)))
    ready = started(fmr(film=worn, contact=rough, own=0.0, fixed=0.0), 0.01, 1e-6)
    film_only = started(fmr(film=worn, own=0.0, fixed=0.0), 0.01, 1e-6)
    area = np.pi * (0.04**2 - 0.032**2)
    carried = (ready.model.closing.balance_ratio - film_only.model.closing.balance_ratio) * 5e5 * area
    # Of a ridge |r - r_m| < (c - h) L / (2 depth): 2 pi r_m p_m int P dr, P the share in contact.
    x = np.linspace(0.2 / 0.3, 1.0, 4001)
    share = 0.5 - 35 / 32 * (x - x**3 + 3 * x**5 / 5 - x**7 / 7)
    width = np.trapezoid(share, x) * 0.3e-6 / 5e-6 * 0.004 * 2
    assert carried == pytest.approx(2 * np.pi * 0.036 * 300e6 * width, rel=1e-5)
