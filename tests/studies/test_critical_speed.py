"""The threshold by three independent methods against printed numbers and roots written out here; the whirl beyond
it."""

import math
from functools import partial

import pytest
from command import SCENARIOS
from oracles import tilt_roots
from scenes import BARRIER, INERTIA, SUPPORT, fmr, fms

from sealdyn.analysis import whirl_in_time as time_domain
from sealdyn.analysis.rotating_wave import free_model
from sealdyn.analysis.whirl_in_time import growth_rate, tilt_in_time, tipping_disturbance
from sealdyn.scenario.reader import parse_scenario
from sealdyn.simulation.simulate import simulate_in_memory
from sealdyn.studies import critical_speed
from sealdyn.studies._runner import run_study

K_S, D_S = SUPPORT.tilt()
# Green's film coefficients of his reference seal, N m/rad and N m s/rad (Green 1989, Fig. 8).
K_F, D_F = 5791.0, 4.082
THREE = ["rotor.polar_inertia=2.6667e-4"]
LINEAR = ['film.model="linear"']


def study(scenario, tmp_path, overrides=(), **flags):
    path = SCENARIOS / f"{scenario}.toml"
    read = parse_scenario(path.read_text(), scenario, [*overrides])
    return run_study("critical-speed", read, tmp_path / "out.h5", flags=flags, workers=1)


@pytest.mark.parametrize(
    "scenario, overrides, printed", [("fms_reference", LINEAR, 5.89e3), ("fmr_reference", LINEAR + THREE, 8.684e3)]
)
def test_three_roads_to_the_printed_threshold(scenario, overrides, printed, tmp_path):
    answer = study(scenario, tmp_path, overrides)
    roads = [answer["formula"], answer["eigenvalue"], answer["time_domain"]["value"]]
    assert roads == pytest.approx([printed] * 3, rel=1e-3)
    assert max(roads) / min(roads) - 1 < 1e-7
    # The stated uncertainty covers the distance to the eigenvalues' answer, and is honest in size.
    assert abs(roads[2] - roads[1]) < 3 * answer["time_domain"]["uncertainty"] < 0.01
    assert answer["time_domain"]["numerical_damping"] < 0.1 * min(map(abs, answer["growth"]["time_domain"]))
    assert answer["nonlinear"]["tipping"] == []
    # A damper that turns with its ring drives the whirl: without it w^2 = (K/I)/(nu (nu - 1/c)) with nu = 1/2, c = 3.
    fmr, stiffness = scenario == "fmr_reference", 0.5 * 5e5 * 0.04**2 + K_F
    without = math.sqrt(stiffness / INERTIA / (0.5 * (0.5 - 1 / 3))) if fmr else None
    assert answer["rotor_damper"] == fmr and answer["undamped_rotor"] == (
        pytest.approx(without, rel=1e-4) if fmr else None
    )
    assert not fmr or answer["undamped_rotor"] > answer["eigenvalue"]


@pytest.mark.parametrize("share", [0.998, 1.002])
@pytest.mark.parametrize("kind", ["fms", "fmr"])
def test_verdict_at_two_thousandths_of_the_threshold(kind, share):
    nu = 0.5 * D_F / (D_S + D_F) if kind == "fms" else (D_S + 0.5 * D_F) / (D_S + D_F)
    speed = share * math.sqrt((K_S + K_F) / INERTIA / (nu**2 if kind == "fms" else nu * (nu - 1 / 3)))
    scene = (fms if kind == "fms" else fmr)("linear", 3.0, speed=speed)
    found = growth_rate(scene, speed, 150, "adams", 1e-7)
    flexible = {"fms": "stator", "fmr": "rotor"}[kind]
    roots = tilt_roots(speed, flexible, inertia=INERTIA, polar=INERTIA / 3, k_s=K_S, d_s=D_S, k=K_F, d=D_F)
    assert found["decided"]
    assert (found["rate"] > 0) == (share > 1)
    assert found["rate"] == pytest.approx(max(roots.real), rel=0.05)


@pytest.mark.core
def test_unconditionally_stable_rotor_has_no_critical_speed(tmp_path):
    answer = study("fmr_reference", tmp_path)
    assert answer["formula"] is None and answer["eigenvalue"] is None and answer["time_domain"]["value"] is None
    assert all(rate < 0 for rate in answer["growth"]["time_domain"])


@pytest.mark.slow
def test_two_floating_rings_have_no_formula(tmp_path):
    answer = study("fmsr_both_flexible", tmp_path, beyond=False, turns=80)
    assert answer["formula"] is None and answer["formula_reason"]
    assert answer["time_domain"]["value"] == pytest.approx(answer["eigenvalue"], rel=1e-6)


@pytest.mark.slow
def test_stator_tips_below_its_threshold(tmp_path):
    """Subcritical: what tips it is found by bisection in time, and the whirl it lingers at is the family's."""
    answer = study("fms_reference", tmp_path, speeds=1, turns=20)
    found = answer["nonlinear"]
    assert found["kind"] == "subcritical"
    assert found["contact_speed"] == pytest.approx(0.958 * answer["eigenvalue"], rel=1e-3)
    row = found["tipping"][0]
    assert row["speed"] < answer["eigenvalue"]
    assert row["whirl"] == pytest.approx(row["branch"], rel=2e-4)
    assert 0.9 * row["whirl"] < row["disturbance"] < row["whirl"]
    fates = {(r["start"], r["speed"] > answer["eigenvalue"]): r["fate"] for r in found["directions"]}
    assert fates["small", False] == "decays" and fates["small", True] == "contact"
    assert [r["fate"] for r in found["directions"] if r["start"] == "large"] == ["decays", "contact", "contact"]


@pytest.mark.slow
def test_rotor_whirls_bounded_above_its_threshold(tmp_path):
    """Supercritical: small and large whirls end in the same bounded one, the family's, until it touches."""
    answer = study("fmr_reference", tmp_path, THREE, speeds=1, turns=20)
    found = answer["nonlinear"]
    assert found["kind"] == "supercritical" and found["tipping"] == []
    assert found["contact_speed"] == pytest.approx(1.0111 * answer["eigenvalue"], rel=1e-3)
    inside = [r for r in found["directions"] if answer["eigenvalue"] < r["speed"] < found["contact_speed"]]
    assert [r["start"] for r in inside] == ["small", "large"]
    for row in inside:
        assert row["fate"] == "bounded" and row["whirl"] == pytest.approx(row["branch"], rel=1e-4)
    outside = {
        (r["start"], r["speed"] > answer["eigenvalue"]): r["fate"] for r in found["directions"] if r not in inside
    }
    assert outside == {("small", False): "decays", ("large", False): "decays",
                       ("small", True): "contact", ("large", True): "contact"}  # fmt: skip


def test_runs_that_would_not_part_within_the_turns_are_not_bisected():
    """A seal whose whirl parts with a hundredth of Green's rate: twenty runs of thousands of turns decide nothing."""
    path = SCENARIOS / "fms_reference.toml"
    scene = parse_scenario(path.read_text(), "fms").scene
    row = tipping_disturbance(scene, 5560.0, 0.1)
    assert row["disturbance"] is None and row["whirl"] is None
    assert row["turns"] == pytest.approx(math.log(1e6) / 0.1 * 5560.0 / (2 * math.pi))
    assert "not bisected in time" in row["said"]


# An oil seal with a long rotor: its inertia closes the faces at 15 600 rpm, below the speed at which it would whirl.
CLOSED_BY_INERTIA = """
shaft.speed = "12000 rpm"
[rotor]
mass = 3.2
transverse_inertia = 1.1e-2
polar_inertia = 4.4e-3
support = { axial_stiffness = 4e5, axial_damping = 300, radius = 0.045 }
[film]
inner_diameter = "84 mm"
outer_diameter = "100 mm"
clearance = "14 um"
coning = "1.5 mrad"
viscosity = "8 cP"
density = 850
outer_pressure = "4 barg"
inner_pressure = "1 barg"
inertia = true
"""


def test_speeds_at_which_no_film_holds_the_seal_are_none_without_whirl(tmp_path):
    """It was said that a disturbance dies out up to 1000 m/s, where there is no film from 82 m/s on."""
    scenario = parse_scenario(CLOSED_BY_INERTIA, "closed")
    answer = run_study("critical-speed", scenario, tmp_path / "out.h5", flags={"turns": 20}, workers=1)
    assert answer["eigenvalue"] is None and answer["speeds_held"][1] == pytest.approx(1636.5, abs=0.1)
    assert max(answer["growth"]["speed"]) <= 1.001 * answer["speeds_held"][1]


# A slow shaft in a stator that runs the other way: the whirl turns twenty times as fast as the shaft at the threshold.
COUNTER = ["stator.speed=-5000"]


def test_growth_is_measured_over_turns_of_the_whirl_where_it_is_faster():
    path = SCENARIOS / "fmsr_both_flexible.toml"
    scene = parse_scenario(path.read_text(), "fmsr", COUNTER).scene
    run = tilt_in_time(scene, 72.0, 20, "adams", 1e-7, 1e-7)[3]
    whirl = max(run.model.linear_scene().modes(), key=lambda m: m.value.real).value.imag
    assert run.duration == pytest.approx(20 * 2 * math.pi / abs(whirl), rel=1e-6) and abs(whirl) > 1400
    # A shaft at rest has a whirl, too.
    assert tilt_in_time(scene, 0.0, 2, "adams", 1e-7, 1e-7)[1][-1] < 0.01


@pytest.mark.slow
def test_a_counter_rotating_seal_has_its_answer(tmp_path):
    answer = study("fmsr_both_flexible", tmp_path, COUNTER, beyond=False, turns=40)
    value, uncertainty = answer["time_domain"]["value"], answer["time_domain"]["uncertainty"]
    assert abs(value - answer["eigenvalue"]) < 3 * uncertainty < 1e-3 * value


def test_a_whirl_that_takes_too_many_steps_is_given_up(tmp_path, monkeypatch):
    monkeypatch.setattr(time_domain, "MOST_BLOCKS", 1)
    answer = study("fmsr_both_flexible", tmp_path, COUNTER, beyond=False)
    assert answer["eigenvalue"] == pytest.approx(73.5325, rel=1e-4) and answer["time_domain"]["value"] is None
    assert all("too many steps" in words for words in answer["growth"]["failed"])


def growing_above(least, scene, speed, **how):
    decided = {"rate": 1.0 if speed > least else -1.0, "decided": True}
    return {**decided, "eigenvalue": 1.0, "uncertainty": 0.1, "accuracy": 1e-7, "numerical_damping": 0.0}


def test_none_is_an_answer_only_where_all_agree(tmp_path, monkeypatch):
    """No eigenvalue crosses: growth in time at every speed confirms it, growth at some speeds only does not."""

    for least, status in ((0.0, "ok"), (1000.0, "failed")):
        monkeypatch.setattr(critical_speed, "growth_rate", partial(growing_above, least))
        assert study("fmr_reference", tmp_path)["status"] == status


def test_speeds_of_no_seal_are_not_run(tmp_path, monkeypatch):
    """Beyond the speed of any face a threshold is told by the eigenvalues alone; that there is none is run up to it."""
    monkeypatch.setattr(critical_speed, "FASTEST", 100.0)
    monkeypatch.setattr(critical_speed, "growth_rate", partial(growing_above, 0.0))
    fastest = critical_speed.FASTEST / 0.040
    answer = study("fms_reference", tmp_path)
    assert answer["eigenvalue"] > fastest and answer["status"] == "ok"
    growth = answer["growth"]
    assert answer["time_domain"]["value"] is None and growth["time_domain"] == len(growth["speed"]) * [None]
    assert min(growth["eigenvalue"]) < 0 < max(growth["eigenvalue"])
    # It grows above the threshold alone.
    grows = zip(growth["speed"], growth["eigenvalue"], strict=True)
    assert all((rate > 0) == (speed > answer["eigenvalue"]) for speed, rate in grows)
    assert answer["nonlinear"]["tipping"] == [] and "branch" not in answer["nonlinear"]
    assert max(study("fmr_reference", tmp_path)["growth"]["speed"]) == pytest.approx(fastest)


# Two heavy rings that turn against each other on a thin, stiff film that hardly damps their whirl.
STIFF_PAIR = """
[shaft]
speed = "9000 rpm"
[film]
inner_radius = "40 mm"
outer_radius = "46 mm"
coning = "0.3 mrad"
viscosity = "5 mPa*s"
outer_pressure = "2 bar"
inner_pressure = "1 bar"
[closing]
balance_ratio = 0.76
spring_force = "20 N"
[rotor]
mass = "350 g"
transverse_inertia = "3e-4 kg*m^2"
polar_inertia = "5.5e-4 kg*m^2"
support = { axial_stiffness = "40 N/mm", axial_damping = "3 N*s/m", radius = "42 mm" }
[stator]
mass = "300 g"
transverse_inertia = "2.6e-4 kg*m^2"
polar_inertia = "5e-4 kg*m^2"
speed = "-7000 rpm"
support = { axial_stiffness = "40 N/mm", axial_damping = "3 N*s/m", radius = "42 mm" }
"""


def test_whirls_that_take_a_million_turns_to_go_anywhere_are_not_run():
    """It took six minutes, each of twelve runs given up after 36 s of Adams' small steps."""
    scene = parse_scenario(STIFF_PAIR, "pair").scene
    assert time_domain._method(free_model(scene, 18796.0)) == "bdf"
    row = {"speed": 18760.0, "start": "small", **time_domain.bounded_or_not(scene, 18760.0, "small", None, None)}
    assert row["turns"] > time_domain.SHOWS * 8000 and row["whirl"] is None
    # Nothing has failed, and where it goes the eigenvalues tell.
    assert "failed" not in row and row["rate"] != 0.0


def test_growth_in_time_is_that_of_the_gap_at_its_speed(tmp_path):
    """The runs began at the gap of the scenario's own speed, and had nineteen times the decay while it closed."""
    scenario = parse_scenario(BARRIER, "barrier")
    answer = run_study("critical-speed", scenario, tmp_path / "out.h5", flags={"turns": 20}, workers=1)
    growth = answer["growth"]
    assert growth["speed"][-1] == pytest.approx(1655.1, abs=0.1) and len(set(growth["speed"])) == 4
    assert growth["time_domain"] == pytest.approx(growth["eigenvalue"], rel=1e-3)
    assert not any(critical_speed.disagreements(growth)) and answer["status"] == "ok"


def test_roads_that_disagree_are_told():
    growth = {"speed": [600.0, 1655.0, 1700.0], "eigenvalue": [-3.0, -0.0887, -1.0]}
    growth |= {"time_domain": [-2.9, -1.69, None], "uncertainty": [0.3, 0.24, None]}
    assert critical_speed.disagreements(growth) == [False, True, False]
    assert not any(critical_speed.disagreements({**growth, "time_domain": [-2.9, -0.08, None]}))


def test_a_run_near_the_last_speed_that_holds_is_a_result():
    """It was refused after its end, for a speed of the search that the seal was never asked to turn at."""
    summary = simulate_in_memory(parse_scenario(BARRIER.replace("12000", "15000"), "barrier"), speeds=True)
    low, high = summary["stability"]["speeds_held"]
    assert summary["status"] == "ok" and summary["stability"]["critical_speed"] is None
    assert low < summary["stability"]["speed"] < high == pytest.approx(1655.1, abs=0.1)
