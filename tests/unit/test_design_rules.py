"""Design rules: each with a seal that keeps it and one that does not, its figure by hand, and what it cannot tell."""

import math
from functools import cache
from types import SimpleNamespace

import pytest
from hypothesis import given
from hypothesis import strategies as st

import sealdyn
from sealdyn.analysis import other_rules
from sealdyn.analysis.design_rules import OF_GAS, OF_OIL, RULES, findings
from sealdyn.analysis.seal_figures import Verdict
from sealdyn.dynamics.imposed_motion import rest_state
from sealdyn.dynamics.interface import flow_at_rest
from sealdyn.faces.geometry import CONTACT_FORCE
from sealdyn.scenario import errors
from sealdyn.scenario.keys import tables
from sealdyn.scenario.reader import parse_scenario
from sealdyn.scenario.tables import ScenarioFile
from sealdyn.scene.application import Application
from sealdyn.simulation.simulate import prepare_run

# Feet and inches, by definition; square inches and pounds force likewise.
FOOT, INCH = 0.3048, 0.0254
PSI = 0.45359237 * 9.80665 / INCH**2
PUMP = """
shaft.speed = "2950 rpm"
closing = { balance_ratio = 0.75, spring_force = "40 N" }
[film]
model = "radial"
inner_radius = "25 mm"
outer_radius = "30 mm"
coning = "0.4 mrad"
viscosity = "0.8 mPa*s"
outer_pressure = "11 bar"
inner_pressure = "1 bar"
[stator]
mass = "120 g"
transverse_inertia = "5e-5 kg*m^2"
support = { axial_stiffness = "30 N/mm", axial_damping = "50 N*s/m", radius = "27 mm" }
"""
AREA, MEAN_RADIUS = math.pi * (0.030**2 - 0.025**2), 0.0275
SPEED = 2 * math.pi * 2950 / 60
ROUGH = 'contact={{roughness="{}",compressive_strength="300 MPa"}}'
WAVY = 'stator.waviness=[{{order=2,amplitude="{}"}},{{order=3,amplitude="{}"}}]'
OWN = "film.coefficients={tilt_stiffness=1e4,tilt_damping=1,axial_stiffness=1e7,axial_damping=1e3}"
HELD = ("closing={}", 'film.clearance="1 um"')
OF_LINEAR = ("film.model=linear", OWN, *HELD)
FOLLOWING = ("rotor.axial_runout=[{order=1,amplitude=20e-6}]",)
GAS = ("film.gas=air", "film.temperature=300 K", "film.model=gas_dam", "closing={}", 'film.clearance="5 um"')
NITRILE = 'application.secondary_seal_material="nitrile"'


@cache
def rows(*changes):
    """Every rule's row, by its name."""
    scenario = parse_scenario(PUMP, "pump.toml", changes)
    return {row["rule"]: row for row in findings(scenario, prepare_run(scenario)[0].model)}


# Rule: changes with which it is kept, changes with which it is not, and what is said then.
KEPT_AND_BROKEN = {
    "sliding_speed": ((), ("application.highest_speed=40000 rpm",), "note"),
    "runout": (("application.shaft_runout=0.5 mm TIR",), ("application.shaft_runout=0.52 mm TIR",), "fail"),
    "misalignment": (("rotor.runout=29 um TIR",), ("rotor.runout=31 um TIR",), "fail"),
    "face_pressure": (("closing.spring_force=80 N",), (), "fail"),
    "balance": ((), ("closing={balance_ratio=1.1}", 'film.clearance="1 um"'), "fail"),
    "hang_up": (FOLLOWING, (*FOLLOWING, "shaft.speed=5000 rad/s"), "fail"),
    "face_width": (("application.bore=2 in", "film.inner_radius=28.4 mm"), ("application.bore=2 in",), "note"),
    "axial_travel": (
        ("application.spring=wave_washer", "application.axial_displacement=0.75 mm"),
        ("application.spring=wave_washer", "application.axial_displacement=0.77 mm"),
        "fail",
    ),
    "flatness": ((*OF_LINEAR, WAVY.format("0.2 um", "0.2 um")), (*OF_LINEAR, WAVY.format("0.3 um", "0.3 um")), "fail"),
    "finish": ((ROUGH.format("0.14 um"),), (ROUGH.format("0.53 um"),), "fail"),
    "shaft_resonance": ((), ("shaft.speed=73 Hz",), "fail"),
    "gear_resonance": (
        ("application.gear_mesh_frequency=5400 Hz",), ('application.gear_mesh_frequency=["79 Hz", "5 kHz"]',), "fail"
    ),
    "seal_temperature": (
        (NITRILE, "application.highest_temperature=379 K"), (NITRILE, "application.highest_temperature=381 K"), "fail"
    ),
    "coking": (("application.highest_temperature=504 K",), ("application.highest_temperature=506 K",), "fail"),
    "film_thickness": (HELD, ("closing={}", 'film.clearance="1.6 um"'), "note"),
    "leakage": (("film.viscosity=100 mPa*s",), (), "fail"),
    "seal_type": ((), ("application.axial_displacement=1.3 mm",), "note"),
    "life": (("application.life=1499 h",), ("application.life=1501 h",), "note"),
    "lubricant_side": ((), (*HELD, "film.coning=-0.1 mrad", "film.inner_pressure=21 bar"), "note"),
}  # fmt: skip
# Figures without a limit.
TOLD = {"heat", "pressure_velocity"}


def test_every_rule_may_be_acknowledged():
    assert [*errors.FACE_RULES] == sorted(RULES | OF_GAS)
    assert {*errors.LIP_RULES} == {*other_rules.LIP} == {*other_rules.RIBBED_LIP}
    assert {*errors.CIRCUMFERENTIAL_RULES} == {*other_rules.CIRCUMFERENTIAL}


def test_every_rule_is_kept_here_and_broken_there():
    assert set(KEPT_AND_BROKEN) | TOLD == set(RULES)
    assert all(rows()[rule]["verdict"] == "note" and rows()[rule]["most"] is None for rule in TOLD)


@pytest.mark.core
@pytest.mark.parametrize("rule", KEPT_AND_BROKEN)
def test_a_seal_keeps_the_rule_and_another_does_not(rule):
    kept, broken, verdict = KEPT_AND_BROKEN[rule]
    assert rows(*kept)[rule]["verdict"] == "pass"
    row = rows(*broken)[rule]
    assert row["verdict"] == verdict and row["value"] is not None and row["unit"] and row["reason"] is None


# --- figures and limits by hand ------------------------------------------------------------------------


def test_limits_in_the_guides_own_units():
    """As printed in metric units, they are within the rounding of feet, inches and pounds."""
    row = rows()
    assert row["sliding_speed"]["most"] == pytest.approx(20_000 * FOOT / 60, rel=1e-15)
    assert row["face_pressure"]["least"] == pytest.approx(10 * PSI, rel=2e-3)
    assert row["face_pressure"]["most"] == pytest.approx(30 * PSI, rel=2e-3)
    assert row["balance"]["most"] == pytest.approx(1000 * PSI, rel=2e-3)
    assert rows(*KEPT_AND_BROKEN["balance"][1])["balance"]["most"] == pytest.approx(100 * PSI, rel=2e-3)
    assert rows("application.shaft_runout=1e-4")["runout"]["most"] == pytest.approx(0.020 * INCH, rel=1e-12)
    assert rows("application.bore=2 in")["face_width"]["usual"] == pytest.approx(INCH / 16, rel=6e-3)
    travel = rows(*KEPT_AND_BROKEN["axial_travel"][0])["axial_travel"]["most"]
    assert travel == pytest.approx(0.030 * INCH, rel=3e-3)
    # A light band is half a wavelength of helium's yellow line.
    assert rows(*KEPT_AND_BROKEN["flatness"][0])["flatness"]["most"] == pytest.approx(3 * 587.6e-9 / 2, rel=2e-3)
    assert rows("application.life=1 h")["life"]["most"] == 1500 * 60 * 60
    assert rows()["leakage"]["most"] == pytest.approx(5e-6 / 3600, rel=1e-15)


def test_sliding_speed_counts_a_stator_that_turns_and_the_fastest_of_a_table():
    both = rows("stator.speed=-2950 rpm")["sliding_speed"]["value"]
    assert both == pytest.approx(2 * SPEED * MEAN_RADIUS, rel=1e-12)
    table = 'shaft.speed={time=[0,1,1,2],value=["100 rpm","5900 rpm","100 rpm","200 rpm"]}'
    assert rows(table)["sliding_speed"]["value"] == pytest.approx(2 * SPEED * MEAN_RADIUS, rel=1e-9)


def test_figures_by_hand():
    row = rows()
    assert row["face_pressure"]["value"] == pytest.approx(40 / AREA, rel=1e-12)
    assert row["balance"]["value"] == pytest.approx(1e6, rel=1e-12) and row["balance"]["balance"] == 0.75
    load = 0.75 * 1e6 * AREA + 40
    assert row["pressure_velocity"]["value"] == pytest.approx(load / AREA * SPEED * MEAN_RADIUS, rel=1e-12)
    dry = [f * load * math.pi * 0.055 * 2950 / 60 for f in (0.1, 0.25)]
    assert row["heat"]["dry"] == pytest.approx(dry, rel=1e-12)
    held = rows(*HELD)
    film = 1e-6 + 0.4e-3 * (MEAN_RADIUS - 0.025)
    assert held["film_thickness"]["value"] == pytest.approx(film, rel=1e-12)
    assert held["heat"]["value"] == pytest.approx(0.8e-3 * AREA * (SPEED * MEAN_RADIUS) ** 2 / film, rel=1e-12)
    assert rows("application.highest_pressure=31 bar")["balance"]["value"] == pytest.approx(30e5, rel=1e-12)
    assert rows("application.face_runout=30 um TIR")["misalignment"]["value"] == pytest.approx(30e-6 / 0.06, rel=1e-12)


def test_leakage_is_that_of_poiseuille():
    """Between parallel faces pi h^3 dp/(6 mu ln(r_o/r_i)); a cone of 1e-3 of the clearance opens them by that much."""
    cone = 1e-9 / 0.005
    row = rows("closing={}", 'film.clearance="1 um"', f"film.coning={cone}")["leakage"]
    assert row["value"] == pytest.approx(math.pi * 1e-18 * 1e6 / (6 * 0.8e-3 * math.log(30 / 25)), rel=4e-3)


def test_leakage_between_goal_and_limit_is_a_note_and_a_seal_may_have_its_own_limit():
    viscosity = "film.viscosity=10 mPa*s"
    assert rows(viscosity)["leakage"]["verdict"] == "note"
    assert rows(viscosity, "application.leakage_limit=2 cc/h")["leakage"]["verdict"] == "fail"
    assert rows(viscosity, "application.leakage_limit=2 ml/h")["leakage"]["most"] == pytest.approx(2e-6 / 3600)


def test_a_gas_seal_is_held_to_its_own_limit_of_leakage_alone():
    """What the guide allows is of a liquid."""
    assert rows(*GAS)["leakage"]["verdict"] == "not applicable"
    leaks = rows(*GAS, "application.leakage_limit=1 m^3/h")["leakage"]
    assert leaks["verdict"] == "pass" and leaks["most"] == pytest.approx(1 / 3600)
    less = rows(*GAS, f"application.leakage_limit={3.6e9 * 0.5 * leaks['value']} ml/h")["leakage"]
    assert less["verdict"] == "fail" and less["value"] == leaks["value"]


def test_natural_frequencies_of_the_ring_on_its_springs():
    axial, tilt = rows()["shaft_resonance"]["modes"]
    assert axial["frequency"] == pytest.approx(math.sqrt(30e3 / 0.12) / (2 * math.pi), rel=1e-12)
    assert tilt["frequency"] == pytest.approx(math.sqrt(30e3 * 0.027**2 / 2 / 5e-5) / (2 * math.pi), rel=1e-12)
    assert axial["damping_ratio"] == pytest.approx(50 / (2 * math.sqrt(30e3 * 0.12)), rel=1e-12)


def test_resonance_in_between_damped_away_and_undamped():
    """A speed range holds what lies within it; from 0.71 of critical damping on there is none; without damping a
    distant mode is a note."""
    service = ("application.lowest_speed=50 rpm", "application.highest_speed=30000 rpm")
    assert rows(*service)["shaft_resonance"]["verdict"] == "fail"
    assert rows(*service, "stator.support.axial_damping=95")["shaft_resonance"]["verdict"] == "pass"
    assert rows("stator.support.axial_damping=0")["shaft_resonance"]["verdict"] == "note"
    tone = "housing.angular=[{frequency=75.0,displacement=1e-7}]"
    assert rows(tone)["gear_resonance"]["verdict"] == "fail"


def test_finish_adds_two_faces():
    row = rows(ROUGH.format("0.14 um"))["finish"]
    assert row["most"] ** 2 == pytest.approx(2 * 0.1e-6**2, rel=1e-12)


def test_flatness_is_from_trough_to_crest():
    """cos(2 t) + cos(3 t) has its trough at -1.87 (by calculus: 4 sin(t) cos(t) + 3 sin(3 t) = 0), its crest at 2."""
    row = rows(*KEPT_AND_BROKEN["flatness"][0])["flatness"]
    trough = min(math.cos(2 * t) + math.cos(3 * t) for t in (k * math.pi / 1e5 for k in range(100_000)))
    assert row["value"] == pytest.approx(0.2e-6 * (2 - trough), rel=1e-3)


@pytest.mark.parametrize(("material", "most"), [("nitrile", 380), ("silicone", 450), ("fluoroelastomer", 477)])
def test_secondary_seals_bear_what_table_3_7_has(material, most):
    for kelvin, verdict in ((most - 1, "pass"), (most + 1, "fail")):
        asked = (f'application.secondary_seal_material="{material}"', f"application.highest_temperature={kelvin} K")
        assert rows(*asked)["seal_temperature"]["verdict"] == verdict


@pytest.mark.parametrize(("roughness", "verdict"), [("0.14 um", "pass"), ("0.5 um", "note"), ("0.53 um", "fail")])
def test_a_carbon_nose_is_rougher_than_a_hard_face(roughness, verdict):
    assert rows(ROUGH.format(roughness))["finish"]["verdict"] == verdict


# --- rules as functions --------------------------------------------------------------------------------


def found(name, application, **figures):
    """What a rule finds of a seal of which only some figures are given."""
    return RULES[name].judge(SimpleNamespace(application=application, **figures), RULES[name].limit)


SPEEDS = st.floats(0.0, 200.0)


@given(SPEEDS, SPEEDS, st.floats(0.0, 1e-3))
def test_no_faster_shaft_may_run_out_more(one, other, reading):
    """The verdict never gets better with speed; beyond the table nothing passes but a shaft without runout."""
    order = ("pass", "note", "fail")
    found_at = (found("runout", Application(shaft_runout=reading), sliding_speed=s) for s in sorted((one, other)))
    verdicts = [order.index(held.verdict) for held in found_at]
    assert verdicts == sorted(verdicts)
    if max(one, other) > 6090 / 60 and reading > 0.0:
        assert verdicts[1] > 0


@given(st.floats(1e-3, 0.2), st.floats(1e-4, 1e-2))
def test_face_width_is_interpolated_between_the_bores_of_the_table_only(bore, width):
    one = found("face_width", Application(bore=bore), face_width=width)
    usual = one.numbers["usual"]
    if 0.0254 <= bore <= 0.1016:
        assert 1.58e-3 <= usual <= 2.39e-3
        assert (one.verdict == Verdict.PASS) == (one.least <= width <= one.most)
    else:
        assert usual is None and one.verdict == Verdict.NOTE
    between = found("face_width", Application(bore=0.0889), face_width=width)
    assert between.numbers["usual"] == pytest.approx((1.98e-3 + 2.39e-3) / 2, rel=1e-12)


@given(st.floats(0.0, 3e-3))
def test_travel_without_a_kind_of_spring_is_told_where_all_kinds_agree(travel):
    one = found("axial_travel", Application(axial_displacement=travel))
    asked = (Application(axial_displacement=travel, spring=kind) for kind in RULES["axial_travel"].limit)
    kinds = {found("axial_travel", application).verdict for application in asked}
    assert one.verdict == (kinds.pop() if len(kinds) == 1 else Verdict.NOT_APPLICABLE)


# --- what cannot be told -------------------------------------------------------------------------------


def test_a_rule_without_its_data_names_keys_that_there_are():
    """A seal of which little is said passes none of the rules that would need more."""
    bare = rows("closing={}", 'film.clearance="1 um"', "film.outer_pressure=1 bar", "film.cavitation_pressure=1 bar")
    every = {f"{table}.{key}" for table, keys in tables(ScenarioFile).items() for key in keys}
    untold = {rule: row for rule, row in bare.items() if row["verdict"] == "not applicable"}
    assert set(untold) == set(RULES) - TOLD - {"sliding_speed", "film_thickness", "seal_type", "shaft_resonance"}
    for row in untold.values():
        assert row["value"] is None and row["needs"] and set(row["needs"]) <= every


def test_rules_of_oil_are_not_for_gases():
    assert set(rows(*GAS)) == set(RULES) - set(OF_OIL) | set(OF_GAS)


# Main-shaft seal of Zuk, NASA TM X-68022, table 1, on a support of which little is known.
ZUK = (
    "film.gas=air", "film.model=gas_dam", "closing={}", "shaft.speed=1", "film.temperature=800 degF", "film.coning=0",
    'film.inner_radius="3.265 in"', 'film.outer_radius="3.315 in"', 'film.inner_pressure="215 psi"',
    'film.outer_pressure="15 psi"', "film.viscosity=3.331e-5",
)  # fmt: skip


def test_a_gas_film_holds_its_clearance_and_is_choked_as_in_zuk_s_tables():
    soft, stiff = 'stator.support.axial_stiffness="1 N/mm"', 'stator.support.axial_stiffness="30 N/um"'
    row = rows(*ZUK, 'film.clearance="0.2 mil"', soft)
    # Opening forces of 133.4, 134.8 and 137.8 lbf at 0.1, 0.2 and 0.3 mil, computed there: a parallel dam pushes open.
    softens = (137.8 - 133.4) * 4.448222 / (0.2e-3 * INCH)
    assert row["film_stiffness"]["value"] == pytest.approx(-softens, rel=0.2)
    assert row["film_stiffness"]["verdict"] == "fail" and row["choking"]["verdict"] == "pass"
    assert row["choking"]["value"] == pytest.approx(0.907, rel=1e-2)
    held = rows(*ZUK, 'film.clearance="0.3 mil"', stiff)
    assert held["film_stiffness"]["verdict"] == "note" and held["choking"]["verdict"] == "note"
    # A dam that narrows from the inner, high pressure outwards.
    assert rows(*ZUK, 'film.clearance="0.2 mil"', "film.coning=-2 mrad", soft)["film_stiffness"]["verdict"] == "pass"
    assert rows(*ZUK, 'film.clearance="0.3 mil"', "film.coning=2 mrad", soft)["film_stiffness"]["verdict"] == "fail"


def test_a_gas_film_without_an_answer_says_why():
    grooved = prepare_run(sealdyn.example("dry_gas_seal"))[0].model
    found = {row["rule"]: row for row in findings(sealdyn.example("dry_gas_seal"), grooved)}
    assert {found[rule]["verdict"] for rule in OF_GAS} == {"not applicable"}


def test_travel_between_the_kinds_of_spring_asks_for_the_kind():
    assert rows("application.axial_displacement=1 mm")["axial_travel"]["needs"] == ["application.spring"]
    assert rows("application.axial_displacement=2 mm")["axial_travel"]["verdict"] == "fail"


def test_a_ring_without_inertia_has_no_resonance():
    row = rows("stator.mass=0", "stator.transverse_inertia=0")["shaft_resonance"]
    assert row["verdict"] == "not applicable" and "stator.mass" in row["needs"]


def test_faces_that_ride_on_their_asperities_have_no_full_film():
    """Worn so that their mean planes cross at the mean radius, within the height of the asperities."""
    worn = 'film.profile={radius=["25 mm","30 mm"],depth=["0 um","-3 um"]}'
    row = rows(worn, "film.model=profiled", "film.coning=0", ROUGH.format("0.8 um"), *HELD)
    assert row["film_thickness"]["value"] == pytest.approx(-0.5e-6, rel=1e-9)
    assert row["heat"]["verdict"] == "not applicable" and row["heat"]["value"] is None


def test_asperities_heat_besides_the_film():
    """What they carry at the start rubs with their coefficient of friction, at the radius of a ring on which parallel
    faces press evenly; the rule told of the film alone, a third of what such a pump's faces make."""
    held = (ROUGH.format("0.8 um"), "contact.friction_coefficient=0.2", "film.coning=0", *HELD)
    scenario = parse_scenario(PUMP, "pump.toml", held)
    model = prepare_run(scenario)[0].model
    s = rest_state(model.scene, model.clearance)[0]
    flow_at_rest(model.interface, s)
    arm = 2 / 3 * (0.030**3 - 0.025**3) / (0.030**2 - 0.025**2)
    row = rows(*held)["heat"]
    assert row["asperities"] == pytest.approx(0.2 * s[CONTACT_FORCE] * SPEED * arm, rel=1e-9) and row["asperities"] > 1
    assert f"{row['asperities']:.4g} W of the asperities" in row["said"]
    assert rows(*HELD)["heat"]["asperities"] == 0.0 and "asperities" not in rows(*HELD)["heat"]["said"]


def test_a_film_that_heats_more_than_dry_faces_spares_them_nothing():
    """Dry at friction 0.25: 0.25 F w r; an oil of a hundred times the viscosity makes more."""
    row = rows("film.viscosity=100 mPa*s", *HELD)["heat"]
    assert row["verdict"] == "fail" and row["value"] > row["most"] == row["dry"][1]
    assert f"{1e-4 * row['value'] / AREA:.4g} W/cm^2" in row["said"]
    assert rows(*HELD)["heat"]["verdict"] == "note"


def test_a_runout_that_grows_is_followed_where_it_is_largest():
    """From nothing at the start."""
    grows = rows("rotor.runout={time=[0, 0.01], value=[0, 2e-4]}")["hang_up"]
    assert grows == rows("rotor.runout=2e-4")["hang_up"] and grows["value"] == pytest.approx(40.0)


def test_a_stator_that_turns_shakes_as_the_shaft_does():
    """The pump's ring has its resonance at 73 Hz; the shaft at 49 Hz is apart from it, the stator's carrier is not."""
    assert rows("stator.speed=-20 Hz")["shaft_resonance"]["verdict"] == "pass"
    row = rows("stator.speed=-73 Hz")["shaft_resonance"]
    assert row["verdict"] == "fail" and "carrier" in row["said"]
    assert row["shaken"][1] == pytest.approx([73, 73], rel=1e-9)
