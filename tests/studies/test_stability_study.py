"""Stability map: against eigenvalues of the rebuilt scene, Green's thresholds, and the time domain."""

import numpy as np
import pytest
from command import SCENARIOS
from in_process import InProcess

from sealdyn import read_scenario
from sealdyn.dynamics.model import Model
from sealdyn.scenario.errors import ScenarioError
from sealdyn.scenario.reader import parse_scenario, with_values
from sealdyn.scene.scene import frozen_at_start
from sealdyn.studies import stability
from sealdyn.studies.stability import Settings
from sealdyn.studies.stability.grid import Grid, growth_rates

FMR, FMS, FMSR = (SCENARIOS / f"{n}.toml" for n in ("fmr_reference", "fms_reference", "fmsr_both_flexible"))


def one_by_one(scenario, values) -> tuple[float, float]:
    """Growth rates of all modes and of the tilts from the 3 x 3 matrices of the scene rebuilt with these values."""
    c = values.pop("inertia_ratio", None)
    if c is not None:
        for ring in ("rotor", "stator"):
            if getattr(scenario.scene, ring).support:
                values[f"{ring}.polar_inertia"] = getattr(scenario.scene, ring).transverse_inertia / c
    changed = with_values(scenario, {**values, "run.start": "steady"})
    modes = Model(frozen_at_start(changed.scene)).linear_scene().modes()
    return modes[0].value.real, max(m.value.real for m in modes if m.kind == "tilt")


@pytest.mark.parametrize(
    "path, overrides, axes",
    [
        (FMR, ["film.model=linear"], {"shaft.speed": (100, 12000), "inertia_ratio": (0.5, 4)}),
        (FMR, [], {"shaft.speed": (100, 12000), "rotor.polar_inertia": (0, 16e-4)}),
        (FMR, ["film.geometry=planar"], {"film.coning": (-1e-4, 5e-3), "film.outer_pressure": (0, 1e6)}),
        (FMR, ["film.tilt_radius=mean"], {"film.coning": (1e-3, 5e-3), "shaft.speed": (100, 9000)}),
        (FMR, ["film.model=linear", "film.coefficients=radial"], {"film.viscosity": (1e-4, 1e-3),
                                                                "film.clearance": (5e-6, 2e-5)}),
        (FMS, [], {"stator.support.tilt_stiffness": (0, 1e3), "stator.transverse_inertia": (8e-4, 2e-3)}),
        (FMS, [], {"stator.support.radius": (0.02, 0.05), "stator.mass": (0, 2)}),
        (FMSR, [], {"shaft.speed": (100, 9000), "inertia_ratio": (0.5, 4)}),
        (FMSR, ["stator.speed=-300"], {"rotor.support.axial_damping": (0, 600),
                                       "stator.transverse_inertia": (8e-4, 2e-3)}),
        (SCENARIOS / "massless_ring.toml", [], {"shaft.speed": (100, 9000), "film.coning": (1e-3, 5e-3)}),
    ],
    ids=str,
)  # fmt: skip
def test_map_equals_the_scene_rebuilt_point_by_point(path, overrides, axes):
    scenario = read_scenario(path, overrides)
    values = {key: np.linspace(*ends, 4) for key, ends in axes.items()}
    total, tilt = Grid(scenario, values).rates()
    (x_key, x), (y_key, y) = values.items()
    for j, i in ((0, 0), (1, 2), (3, 3), (2, 0)):
        try:
            wanted = one_by_one(scenario, {x_key: float(x[i]), y_key: float(y[j])})
        except ScenarioError:
            assert np.isnan(total[j, i])
            continue
        assert (total[j, i], tilt[j, i]) == pytest.approx(wanted, rel=1e-6, abs=1e-6)


def test_impossible_scenes_are_blank():
    scenario = read_scenario(FMR)
    total, _ = Grid(
        scenario, {"rotor.polar_inertia": np.array([8e-4, 17e-4]), "film.coning": np.array([-2e-3, 3e-3])}
    ).rates()
    assert np.isfinite(total).tolist() == [[False, False], [True, False]]
    for c, possible in ((0.5, True), (0.49, False)):
        total, _ = Grid(scenario, {"shaft.speed": np.array([1e3, 2e3]), "inertia_ratio": np.array([c, 1.0])}).rates()
        assert np.isfinite(total[0, 0]) == possible


def test_a_balance_that_finds_the_clearance_is_solved_along_its_axis():
    text = FMR.read_text().replace('clearance = "10 um"', "") + "[closing]\nbalance_ratio = 0.75\nspring_force = 50\n"
    scenario = parse_scenario(text, "balanced")
    spring = np.array([20.0, 60.0, 1e5])
    total, _ = Grid(scenario, {"shaft.speed": np.array([500.0, 7000.0]), "closing.spring_force": spring}).rates()
    assert np.isnan(total[2]).all()
    wanted = one_by_one(scenario, {"shaft.speed": 7000.0, "closing.spring_force": 60.0})[0]
    assert total[1, 1] == pytest.approx(wanted, rel=1e-6)


@pytest.mark.core
def test_thresholds_of_green_lie_on_the_maps_zero():
    """FMR, c = 3: 8.684e3 rad/s; FMS: 2 (1 + D_s/D_f) sqrt(K/I) = 5.89e3 rad/s, written out here."""
    k, d, k_s, d_s, inertia = 5791.0375, 4.0815, 400.0, 0.24, 8e-4
    nu = (d_s + d / 2) / (d_s + d)
    for path, critical, c in (
        (FMR, np.sqrt((k_s + k) / inertia / (nu * (nu - 1 / 3))), 3.0),
        (FMS, 2 * (1 + d_s / d) * np.sqrt((k_s + k) / inertia), 0.5),
    ):
        speeds = critical * np.array([0.998, 1.002])
        total, _ = Grid(read_scenario(path, ["film.model=linear"]),
                        {"shaft.speed": speeds, "inertia_ratio": np.array([c, 2 * c])}).rates()  # fmt: skip
        assert total[0, 0] < 0 < total[0, 1]


def test_quadratic_keeps_its_digits_and_takes_no_mass():
    # A small root beside a fast one: the plain formula loses the small one, and with it the other's real part.
    small, fast = -np.e, -np.sqrt(2) + 1e7j * np.pi
    assert growth_rates([1.0], [-(small + fast)], [small * fast], 0.0, 0.0) == pytest.approx(fast.real, rel=1e-6)
    assert growth_rates([0.0], [2.0], [6.0], 0.0, 0.0) == pytest.approx(-3.0)


def answer(path, overrides=(), **settings):
    return stability.run(read_scenario(path, overrides), Settings(**settings), InProcess())


def test_answer_states_limit_margin_and_confirms_in_time():
    found = answer(FMR, ["film.model=linear", "rotor.polar_inertia=2.6666666667e-4"],
                   x="shaft.speed=8000 rad/s:9400 rad/s:8", y="inertia_ratio=2.9:3.1:3", confirm=2)  # fmt: skip
    d, d_s = 4.0815, 0.24
    assert found["unconditional"]["limit"] == pytest.approx((d_s + d) / (d_s + d / 2), rel=1e-4)
    assert not found["unconditional"]["holds"]
    assert found["margins"]["critical_speed"] == pytest.approx(8.684e3, rel=1e-3)
    assert np.shape(found["growth_rate"]) == (3, 8)
    assert [p["agrees"] for p in found["confirmed"]] == [True, True]
    for point in found["confirmed"]:
        assert point["time_domain"] == pytest.approx(point["growth_rate"], rel=1e-3)


@pytest.mark.slow
def test_twin_sided_confirmation_of_a_nonlinear_film_and_two_rings():
    found = answer(FMSR, x="shaft.speed=4500:5700:7", y="inertia_ratio=0.5:0.6:2", confirm=2)
    assert [p["agrees"] for p in found["confirmed"]] == [True, True]


@pytest.mark.parametrize(
    "words", ["shaft.speed", "shaft.speeed=1:2:3", "shaft.speed=1 mm:2 mm:5", "shaft.speed=1:1:5", "film.model=0:1:3",
              "inertia_ratio=0:1:5"],
)  # fmt: skip
def test_axes_that_cannot_be_are_refused_in_one_line(words):
    with pytest.raises(ScenarioError) as refused:
        answer(FMR, x=words)
    assert "[study.stability] x" in str(refused.value) and "\n" not in str(refused.value)


@pytest.mark.parametrize(
    "words, values",
    [
        ("film.coning=1:5 mrad:3", [1e-3, 3e-3, 5e-3]),
        ("film.coning=1 mrad,2 mrad,5 mrad", [1e-3, 2e-3, 5e-3]),
        ("film.coning=500 urad:2 mrad:3:log", [5e-4, 1e-3, 2e-3]),
        ("shaft.speed=300:100:3", [300, 200, 100]),
        ("inertia_ratio=0.5:2:3:log", [0.5, 1, 2]),
    ],
)
def test_axes_are_read_as_a_sweep_reads_them(words, values):
    found = stability.si_axis(read_scenario(FMR), words, "x")
    assert found["values"] == pytest.approx(values, rel=1e-12)


def test_the_values_of_an_axis_come_in_order():
    with pytest.raises(ScenarioError) as refused:
        stability.si_axis(read_scenario(FMR), "film.coning=1 mrad,5 mrad,2 mrad", "x")
    assert refused.value.key.endswith("x")


def test_the_map_reaches_as_far_as_the_threshold():
    near, far = (read_scenario(FMS, [f"shaft.speed={speed}"]) for speed in (1000.0, 100.0))
    ends = [stability.si_axis(s, stability._default_x(s.scene), "x")["values"][-1] for s in (near, far)]
    critical = stability.critical_speed(Model(far.scene))
    assert ends[0] == pytest.approx(15e3) and critical > 15 * 100.0 and ends[1] == pytest.approx(2 * critical)


COUNTER = """
shaft.speed = "6000 rpm"
film = { inner_radius = "30 mm", outer_radius = "36 mm", coning = "1 mrad", viscosity = "0.8 mPa*s", \
outer_pressure = "11 bar", inner_pressure = "1 bar" }
closing = { balance_ratio = 0.75, spring_force = "60 N" }
[rotor]
mass = "150 g"
transverse_inertia = "7e-5 kg*m^2"
polar_inertia = "1.3e-4 kg*m^2"
misalignment = "50 urad"
support = { axial_stiffness = "30 N/mm", axial_damping = "50 N*s/m", radius = "33 mm" }
[stator]
speed = "-8000 rpm"
mass = "150 g"
transverse_inertia = "7e-5 kg*m^2"
polar_inertia = "1.3e-4 kg*m^2"
misalignment = "50 urad"
support = { axial_stiffness = "30 N/mm", axial_damping = "50 N*s/m", radius = "33 mm" }
"""


def test_modes_that_decay_alike_are_told_apart_in_time():
    """Counter-rotating rings, three tilt modes within a few per cent, no threshold, least damped along the axis."""
    scenario = parse_scenario(COUNTER, "counter")
    settings = Settings(x="shaft.speed=24000 rpm:28000 rpm:2", y="stator.speed=-40000 rpm:-36000 rpm:2", confirm=1)
    found = stability.run(scenario, settings, InProcess())
    (point,) = found["confirmed"]
    assert point["agrees"] and point["time_domain"] == pytest.approx(point["growth_rate"], rel=3e-3)
    modes = Model(scenario.scene).linear_scene().modes()
    tilt = next(mode for mode in modes if mode.kind == "tilt")
    assert tilt.direction == "backward" and found["margins"]["least_damped"] == modes[0].kind == "axial"
    assert found["margins"]["whirl_ratio"] == pytest.approx(-tilt.value.imag / scenario.scene.shaft.speed, rel=1e-9)


@pytest.mark.parametrize("rate, agrees", [(-100.0, True), (-80.0, False), (100.0, False)])
def test_a_growth_rate_that_is_another_one_does_not_agree(rate, agrees, monkeypatch):
    monkeypatch.setattr(stability, "growth_rate", lambda *given: {"rate": rate, "uncertainty": 0.5})
    point = {"values": {"shaft.speed": 1000.0}, "growth_rate": -100.5}
    assert stability.confirmed(read_scenario(FMS), point)["agrees"] is agrees


def test_a_gap_that_follows_the_speed_has_no_formula_and_its_map_says_what_it_keeps(tmp_path):
    """The map keeps the clearance and is unstable where the critical speed, of the closing force kept, is none."""
    changes = ["film.inertia=true", "film.clearance=14 um", "rotor.polar_inertia=3e-4", "shaft.speed=700"]
    scenario = parse_scenario(FMR.read_text(), "inert", changes)
    answer = stability.run(scenario, Settings(x="shaft.speed=100:9000:20", confirm=0), InProcess())
    assert answer["unconditional"]["limit"] is None
    assert any("the map keeps the gap" in note for note in answer.notes)


def test_a_seal_without_a_threshold_has_a_map_of_speeds_it_may_reach():
    # A dam of gas damps nothing: the support does, at any speed.
    scenario = read_scenario(FMR.parent / "gas_dam_reference.toml")
    speed = scenario.scene.shaft.speed
    found = stability.si_axis(scenario, stability._default_x(scenario.scene), "x")
    assert found["values"][-1] == pytest.approx(3 * speed)
