"""Scenario files: what is read, and the one line that says what is wrong."""

import json
import math
import time

import pytest
from command import SCENARIOS

from sealdyn.numerics.piecewise_linear import PiecewiseLinear
from sealdyn.scenario.reader import ScenarioError, parse_scenario, read_scenario
from sealdyn.studies._declared import json_schema

FMR = (SCENARIOS / "fmr_reference.toml").read_text()
FMS = (SCENARIOS / "fms_reference.toml").read_text()
SHIPPED = sorted(SCENARIOS.glob("*.toml"))


def parse(text, *overrides):
    return parse_scenario(text, "seal.toml", overrides)


def refusal(text, *overrides) -> str:
    with pytest.raises(ScenarioError) as caught:
        parse(text, *overrides)
    line = str(caught.value)
    assert line.startswith("seal.toml") and line.isprintable() and "found" in line and "expected" in line
    return line


@pytest.mark.core
def test_reference_in_si():
    scenario = parse(FMR)
    film, rotor = scenario.scene.film, scenario.scene.rotor
    assert (film.inner_radius, film.outer_radius, film.clearance) == (0.032, 0.04, 1e-5)
    assert (film.coning, film.viscosity) == (3.125e-3, 5e-4)
    assert (film.outer_pressure, film.inner_pressure) == (5e5, 0.0)
    assert (rotor.mass, rotor.transverse_inertia, rotor.polar_inertia) == (1.0, 8e-4, 16e-4)
    assert rotor.support.tilt() == pytest.approx((400.0, 0.24), rel=1e-15)
    assert scenario.scene.stator.support is None
    assert scenario.scene.shaft.speed == 1000.0
    assert (scenario.run.turns, scenario.run.accuracy, scenario.run.samples_per_turn) == (60, 1e-6, 64)
    assert (scenario.run.solver, scenario.run.start) == ("auto", "rest")
    assert scenario.text == FMR and scenario.name == "seal"
    assert scenario.question.startswith("Does a flexibly mounted rotor")
    assert "rotor.support.radius" in scenario.given and "film.floor" not in scenario.given
    assert scenario.unused() == []


def test_defaults_of_the_run():
    text = FMR.split("[run]")[0]
    run = parse(text).run
    assert (run.turns, run.duration, run.samples_per_turn, run.samples) == (60, None, None, None)
    run = parse(text + '[run]\nduration = "1 s"\nsamples = 10').run
    assert (run.turns, run.duration, run.samples_per_turn, run.samples) == (None, 1.0, None, 10)


@pytest.mark.parametrize("path", SHIPPED, ids=lambda p: p.stem)
def test_shipped_scenarios_use_every_key_and_tell_their_question(path):
    scenario = read_scenario(path)
    assert scenario.unused() == []
    assert "?" in scenario.question and "Expected:" in scenario.question
    assert json.loads(json.dumps(scenario.resolved(), allow_nan=False))["shaft"]


def change(old, new, text=FMR):
    assert old in text
    return text.replace(old, new, 1)


BROKEN = [
    # misspelt, misplaced and missing
    (("clearance", "clearence"), ["[film] clearence", "nearest 'clearance'"]),
    (("misalignment =", "runout = 1\nwhirl ="), ["[rotor] whirl", "the table is [[shaft.whirl]]"]),
    (("[rotor.support]", "[rotor.suport]"), ["[rotor] suport", "nearest 'support'"]),
    (("[run]", "[runs]"), ["[runs]", "nearest 'run'"]),
    (("turns = 60", "speed = 1"), ["[run] speed", "belongs to [shaft]"]),
    (("turns = 60", "clearanse = 1"), ["[run] clearanse", "nearest 'clearance' in [film]"]),
    (("[shaft]", "x = 1\n[shaft]"), ["[x]", "unknown"]),
    (('speed = "1000 rad/s"', ""), ["[shaft]", "speed", "nothing"]),
    (("[shaft]", "[run.shaft]"), ["shaft"]),
    (('outer_radius = "40 mm"', ""), ["[film] outer_radius", "nothing", "a length"]),
    # wrong kinds
    (('"1000 rad/s"', '"10 um"'), ["[shaft] speed", '"10 um"', "a unit of length", "rad/s"]),
    (('"5 bar"', '"-5 bar gauge"'), ["[film] outer_pressure", "absolute"]),
    (('"10 um"', '"10 um TIR"'), ["[film] clearance", "rotor.runout only"]),
    (('mass = "1 kg"', "mass = true"), ["[rotor] mass", "true"]),
    (('mass = "1 kg"', "mass = nan"), ["[rotor] mass", "nan", "finite"]),
    (("[run]", "[closing]\nbalance_ratio = true\n[run]"), ["[closing] balance_ratio", "true"]),
    (("[run]", "[[shaft.whirl]]\nratio = nan\nangle = 0\n[run]"), ["[shaft.whirl.0] ratio", "nan", "finite"]),
    (("[run]", "[[rotor.axial_runout]]\norder = -inf\namplitude = 0\n[run]"), ["[rotor.axial_runout.0] order"]),
    (('mass = "1 kg"', "mass = 1979-05-27"), ["[rotor] mass", "1979-05-27"]),
    (("[stator]", "[[stator]]"), ["[stator]", "a list", "one table [stator]"]),
    (("[run]", "[housing.axial]\nfrequency = 1\n[run]"), ["[housing] axial", "double brackets"]),
    (("[run]", "[housing]\naxial = [1]\n[run]"), ["[housing.axial] 0", "[[housing.axial]]"]),
    (("[run]", '[[housing.axial]]\nfrequency = "1 g"\n[run]'), ["[housing.axial.0] frequency", "a unit of mass"]),
    (("[run]", "[study]\nsweep = 1\n[run]"), ["[study] sweep", "a table"]),
    (("turns = 60", "turns = -1"), ["[run] turns", "> 0"]),
    (("samples_per_turn = 64", "samples_per_turn = 1.5"), ["[run] samples_per_turn", "whole number"]),
    (("accuracy = 1e-6", "accuracy = 1"), ["[run] accuracy", "<= 0.1"]),
    (("accuracy = 1e-6", "accuracy = 1e-13"), ["[run] accuracy", "> 1e-13"]),
    (("accuracy = 1e-6", 'solver = "admas"'), ["[run] solver", "nearest 'adams'"]),
    (('start = "rest"', 'start = "stedy"'), ["[run] start", '"steady"']),
    (('"cylindrical"', '"cylinder"'), ["[film] geometry", "nearest 'cylindrical'"]),
    (('"radial"', '"radail"'), ["[film] model", "nearest 'radial'"]),
    (('"radial"', '"_cavity"'), ["[film] model"]),
    (("model =", 'coefficients = "gren"\nmodel ='), ["[film] coefficients", "nearest 'green'"]),
    (("model =", "coefficients = { tilt_stiffness = 1 }\nmodel ="), ["[film.coefficients] tilt_damping", "nothing"]),
    # words of the trade, notations of the field
    (('axial_stiffness', "stiffness"), ["[rotor.support] stiffness", "nearest 'axial_stiffness'"]),
    (('axial_damping', "damping"), ["[rotor.support] damping", "nearest 'axial_damping'"]),
    (("[run]", '[closing]\nbalance_ratio = "75 %"\n[run]'), ["[closing] balance_ratio", "a number, e.g. 0.75"]),
    (("[run]", "[contact]\nhardness = 1\n[run]"), ["[contact] hardness", "nearest 'compressive_strength'"]),
    (("[run]", "[contact]\nfriction = 1\n[run]"), ["[contact] friction", "nearest 'friction_coefficient'"]),
    (("[run]", "[rotor.secondary_seal]\nfriction = 1\n[run]"), ["seal] friction", "nearest 'friction_force'"]),
    (("[stator]", "[stator]\nwaves = 3"), ["[stator] waves", "nearest 'waviness'"]),
    (("misalignment =", 'runout = "20 um"\nmisalignment ='), ["[rotor] runout", '"20 um TIR"']),
    (('"1000 rad/s"', '"36 m/s"'), ["[shaft] speed", '"9549.3 rpm"', "mean radius"]),
    (("[stator]", '[stator]\nspeed = "36 m/s"'), ["[stator] speed", '"9549.3 rpm"']),
    (('"0.5 mPa*s"', '"18 cSt"'), ["[film] viscosity", "a kinematic one times the density", '"18 mPa*s"']),
    (('"0.5 mPa*s"', '"18 cSt"\ndensity = "0.85 g/cm^3"'), ["[film] viscosity", '850 kg/m^3 is "15.3 mPa*s"']),
    (('"radial"', '"gas"'), ["[film] model", "nearest 'gas_dam' and 'gas_reynolds'"]),
    (("[stator]", '[stator.body]\nmaterial = "carbon"\n[stator]'), ["[stator.body] mat", "nearest 'carbon graphite'"]),
    (("model =", 'temperature = "300 K"\nmodel ='), ["[film] temperature", "liquid", "coning_per_kelvin"]),
    # impossible
    (("misalignment =", "misalignment = { time = [0, 1, 1], value = [0, 0, 1e-6] } #"), ["[rotor] misal", "a step"]),
    (('"32 mm"', '"40 mm"'), ["[film] inner_radius", "less than outer_radius"]),
    (('"32 mm"', "0"), ["[film] inner_radius", "> 0"]),
    (('"10 um"', "0"), ["[film] clearance", "> 0"]),
    (('mass = "1 kg"', 'mass = "-1 kg"'), ["[rotor] mass", ">= 0"]),
    (("16e-4", "16.1e-4"), ["[rotor] polar_inertia", "unphysical_inertia"]),
    (('"8e-4 kg*m^2"', "0"), ["[rotor]", "inertia"]),
    (('radius = "40 mm"            #', "tilt_damping = 1 #"), ["[rotor.support] radius", "nothing", "tilt_stiffness"]),
    (("[rotor.support]", "[rotor.support]\ntilt_stiffness = 4"), ["[rotor.support] radius", "one or the other"]),
    (("model =", "floor = 0.5\nmodel ="), ["[film] floor", "0.5"]),
    (("model =", "floor = 0\nmodel ="), ["[film] floor"]),
    (('"3.125 mrad"', '"-1.25 mrad"'), ["[film] coning", "open film"]),
    (("[stator]\nmisalignment = ", '[stator]\nmisalignment = "1 mrad" #'), ["[stator] misalignment", "closed at the"]),
    (("[run]", "[initial]\nrotor.z = 10e-6\n[run]"), ["initial", "closed at the start"]),
    (("model =", "cavitation_pressure = 1e4\nmodel ="), ["[film] cavitation_pressure", "inner_pressure"]),
    (('clearance = "10 um"', ""), ["[film] clearance", "nothing", "balance_ratio"]),
    (("[run]", "[closing]\nbalance_ratio = 1\nspring_force = 1\n[run]"), ["[film] clearance", "two of the three"]),
    (("[run]", "[closing]\nbalance_ratio = -1\n[run]"), ["[closing] balance_ratio", ">= 0"]),
    (("turns = 60", "turns = 60\nduration = 1"), ["[run] turns", "one of the two"]),
    (("turns = 60", "samples = 60"), ["[run] samples_per_turn", "one of the two"]),
    (('"1000 rad/s"', "0"), ["[run] turns", "duration"]),
    (('"1000 rad/s"', "{ time = [0, 1], value = [1, 0] }"), ["[run] turns", "0.0795775", "duration"]),
    (("[run]", "[[housing.axial]]\nfrequency = 1\n[run]"), ["[housing.axial.0] displacement", "neither"]),
    (("[run]", "[[housing.angular]]\nfrequency = 1\ndisplacement = 1e-6\nacceleration = 1\n[run]"), ["both"]),
    # no TOML at all
    (("= 60", "60"), ["at line 26"]),
    (("[run]", "[rotor]"), ["TOML"]),
    (("[run]", "a = " + "[" * 5000 + "\n[run]"), ["expected"]),
    (("turns = 60", "turns = " + "9" * 5000), ["expected"]),
]  # fmt: skip


@pytest.mark.parametrize("swap, says", BROKEN, ids=[" ".join(s)[:40] for _, s in BROKEN])
def test_refused_in_one_line(swap, says):
    line = refusal(change(*swap))
    assert all(word in line for word in says), line


def test_a_key_into_a_list_says_its_entry():
    waves = "[[stator.waviness]]\norder = 2\namplitude = 1e-7\n"
    for text, entry in ((FMR + waves, "stator.waviness.0.amplitude"), (FMR + 2 * waves, "stator.waviness.1.amplitude")):
        assert entry in refusal(text, "stator.waviness.amplitude=1 um")


def test_no_support_anywhere():
    text = FMR.split("[rotor.support]")[0] + "[run]"
    assert "no support on either ring" in refusal(text)


def test_turning_shaft_with_a_table_makes_its_turns():
    table = "{ time = [0, 2, 2, 4], value = [0, 100, 100, 0] }"
    # 100 rad/s at the peak over 4 s: 200 rad in all, 31.83 turns.
    assert parse(change('"1000 rad/s"', table), "run.turns=31").run.turns == 31
    assert "31.831" in refusal(change('"1000 rad/s"', table), "run.turns=32")


def test_duration_at_rest_needs_no_turns():
    assert parse(FMR, "shaft.speed=0", "run.duration=1", "run.samples=10").run.duration == 1.0
    assert "a shaft at rest" in refusal(FMR, "shaft.speed=0", "run.duration=1", "run.samples_per_turn=10")


def test_files_that_are_none(tmp_path):
    def line(path):
        with pytest.raises(ScenarioError) as caught:
            read_scenario(path)
        assert str(caught.value).isprintable()
        return str(caught.value)

    (tmp_path / "seal_a.toml").write_text(FMR)
    assert "nearest seal_a.toml" in line(tmp_path / "seal_b.toml")
    assert "a folder" in line(tmp_path)
    (tmp_path / "latin.toml").write_bytes(b"# \xb5\xff\n")
    assert "UTF-8" in line(tmp_path / "latin.toml")
    (tmp_path / "empty.toml").write_text("# nothing\n")
    assert "empty" in line(tmp_path / "empty.toml")
    assert "found" in line(tmp_path / ("n" * 5000))
    (tmp_path / "bom.toml").write_bytes(b"\xef\xbb\xbf" + FMR.encode())
    assert read_scenario(tmp_path / "bom.toml").question == read_scenario(tmp_path / "seal_a.toml").question


def test_overrides():
    scenario = parse(FMS, 'rotor.runout="0.2 mrad"', "film.clearance=20 um", "run.turns=3", "stator.mass = 2 ")
    assert scenario.scene.rotor.runout == 2e-4
    assert scenario.scene.film.clearance == 2e-5
    assert (scenario.run.turns, scenario.scene.stator.mass) == (3, 2.0)
    assert scenario.overrides[1] == "film.clearance=20 um" and scenario.text == FMS
    table = parse(FMS, "shaft.speed={time=[0,1],value=[1,'60 rpm']}").scene.shaft.speed
    assert table == PiecewiseLinear((0.0, 1.0), (1.0, pytest.approx(2 * math.pi)))
    shaken = read_scenario(SCENARIOS / "housing_vibration.toml", ["housing.axial.1.frequency=70 Hz"]).scene.housing
    assert [v.frequency for v in shaken.axial] == [400.0, 70.0]


def test_an_override_replaces_its_alternative():
    scenario = parse(FMS, "run.duration=1 s", "stator.support.tilt_stiffness=400 N*m")
    assert scenario.run.turns is None and scenario.scene.stator.support.radius is None
    assert parse(FMS, "run.samples=5").run.samples_per_turn is None


@pytest.mark.parametrize(
    "override, says",
    [
        ("rotor.runnout=1", "nearest 'runout'"), ("rotor.runout", "no key=value"), ("=1", "no key=value"),
        ("shaft.speed.x=1", "a table there"), ("film.clearance=1\nrotor.mass=1", "[film] clearance"),
        ("a.b.c.d=1", "unknown"), ("..=1", "unknown"),
    ],
)  # fmt: skip
def test_bad_overrides(override, says):
    assert says in refusal(FMS, override)


def test_an_override_beyond_the_list():
    with pytest.raises(ScenarioError, match="0 to 1"):
        read_scenario(SCENARIOS / "housing_vibration.toml", ["housing.axial.2.frequency=1"])


def test_total_indicator_reading_is_across_the_face():
    # 20 um across the diameter of 80 mm is a tilt of 0.25 mrad.
    assert parse(FMS, "film.clearance=50 um", "rotor.runout=20 um TIR").scene.rotor.runout == pytest.approx(2.5e-4)
    table = "rotor.runout={time=[0,1],value=['8 um TIR','0.2 mrad']}"
    assert parse(FMS, table).scene.rotor.runout.value == pytest.approx((1e-4, 2e-4))
    assert "TIR" in refusal(FMS, "stator.misalignment=20 um TIR")
    assert "outer_radius" in refusal(FMS, "rotor.runout=20 um TIR", "film.outer_radius=-1")


def test_unused_keys():
    more = ["stator.mass=1", "rotor.runout=1e-6", 'film.coefficients="green"', "initial.stator.z=0"]
    expected = ["film.coefficients", "initial.stator.z", "rotor.runout", "stator.mass"]
    assert parse(FMR, *more).unused() == expected
    assert parse(FMS, "rotor.misalignment=1e-6").unused() == ["rotor.misalignment"]
    linear = parse(FMS, "film.model=linear", "film.coefficients=green", "film.geometry=planar")
    assert linear.unused() == ["film.geometry"]


def test_resolved_has_defaults_and_tables():
    resolved = parse(FMR, "shaft.speed={time=[0,1],value=[1,2]}", "study.sweep.keys=['a']").resolved()
    assert resolved["shaft"]["speed"] == {"time": [0.0, 1.0], "value": [1.0, 2.0]}
    assert resolved["film"]["floor"] == 1e-3 and resolved["run"]["solver"] == "auto"
    assert resolved["study"] == {"sweep": {"keys": ["a"]}}


def test_schema_knows_every_table_and_forbids_others():
    schema = json_schema()
    assert "2020-12" in schema["$schema"]
    assert set(schema["properties"]) >= {"shaft", "film", "rotor", "stator", "run", "study", "housing", "closing"}
    assert schema["additionalProperties"] is False
    assert all(table["additionalProperties"] is False for table in schema["$defs"].values())
    assert "radial" in schema["$defs"]["Film"]["properties"]["model"]["enum"]
    clearance = schema["$defs"]["Film"]["properties"]["clearance"]
    assert " m " in clearance["description"] and [kind["type"] for kind in clearance["anyOf"]] == ["number", "string"]
    assert "null" not in json.dumps(schema)


def test_reading_is_fast():
    start = time.perf_counter()
    for _ in range(20):
        parse(FMR)
    assert (time.perf_counter() - start) / 20 < 0.05
