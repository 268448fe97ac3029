"""The steady-state study through its front door, and against roots and formulas written out here."""

import numpy as np
import pytest
from command import SCENARIOS
from in_process import InProcess
from oracles import tilt_roots
from scenes import started

import sealdyn
from sealdyn.analysis.harmonic_balance import FilmBalance
from sealdyn.analysis.shooting import Shooter
from sealdyn.archive import read_study
from sealdyn.dynamics.model import Model
from sealdyn.scenario.reader import parse_scenario
from sealdyn.simulation.margin import steady_extremes
from sealdyn.solvers.contract import Recorder
from sealdyn.solvers.integrate import solve
from sealdyn.studies import steady_state
from sealdyn.studies._runner import run_study


def test_answer_archive_and_figure(tmp_path):
    scenario = sealdyn.read_scenario(SCENARIOS / "fms_reference.toml")
    flags = {"approach": [0.9, 0.98]}
    answer = run_study("steady-state", scenario, tmp_path / "s.h5", flags=flags, workers=1)
    assert answer["stable"] and len(answer["multipliers"]) == 6
    low, high = answer["near_threshold"]
    # Waiting takes ever longer, shooting does not.
    assert high["transient"] > 3 * low["transient"] and high["shooting"] <= 60
    for row in (low, high):
        assert row["speed"] == pytest.approx(row["part"] * answer["critical_speed"])
        assert row["multiplier"] == pytest.approx(slowest_root(row["speed"], *RADIAL), rel=2e-3)
        # From rest, 0.03 to 1 of the scales away, down to the accuracy at the pace of the slowest multiplier.
        at_most, at_least = np.log(np.array([1.0, 0.03]) / 1e-6) / -np.log(row["multiplier"])
        assert at_least < row["transient"] < at_most
    kept = read_study(tmp_path / "s.h5")
    assert kept["answer"]["h_min"] == answer["h_min"] and kept["scenario"] == scenario.text
    film, waits = kept["panels"][2:]
    assert film["series"][0]["y"] == answer["orbit"]["h_min"]
    assert waits["series"][0]["y"] == [low["shooting"], high["shooting"]]
    assert not list(tmp_path.glob("*.jsonl"))


# Film stiffness and damping in tilt of the reference seal, N m/rad and N m s/rad: of Green (1989), Fig. 8, and of the
# cylindrical radial film.  Ring and support of the paper.
GREEN, RADIAL = (5791.0, 4.082), (5099.5, 3.649)
INERTIA, K_S, D_S = 8e-4, 400.0, 0.24


def stator_roots(speed, k, d):
    """Eigenvalues (1/s) of a flexible stator in tilt."""
    return tilt_roots(speed, "stator", inertia=INERTIA, polar=0.0, k_s=K_S, d_s=D_S, k=k, d=d)


def slowest_root(speed, k, d):
    return np.exp(max(stator_roots(speed, k, d).real) * 2 * np.pi / speed)


@pytest.mark.core
def test_a_linear_scene_answers_with_roots_and_formulas(tmp_path):
    speed = 5000.0
    overrides = ["film.model=linear", f"shaft.speed={speed}"]
    scenario = sealdyn.read_scenario(SCENARIOS / "fms_reference.toml", overrides)
    answer = run_study("steady-state", scenario, tmp_path / "s.h5", flags={"approach": []}, workers=1)
    assert answer["period"] == pytest.approx(2 * np.pi / speed)
    k, d = GREEN
    multipliers = [complex(*pair) for pair in answer["multipliers"]]
    for root in stator_roots(speed, k, d):
        for wanted in (np.exp(root * answer["period"]), np.exp(root.conjugate() * answer["period"])):
            assert min(abs(wanted - m) for m in multipliers) < 2e-3 * abs(wanted) + 1e-7
    behind = K_S + k - 0.5j * d * speed
    ring = K_S - INERTIA * speed**2 + 1j * D_S * speed
    static, dynamic = 25e-6 * abs(K_S / behind), 25e-6 * abs(ring / (ring + k + 0.5j * d * speed))
    for found in (
        [answer["linear"]["relative_max"], answer["linear"]["relative_min"]],
        [answer["relative_misalignment"]["max"], answer["relative_misalignment"]["min"]],
        [max(answer["orbit"]["relative_misalignment"]), min(answer["orbit"]["relative_misalignment"])],
    ):
        assert found == pytest.approx([static + dynamic, abs(static - dynamic)], rel=1e-3)
    assert min(answer["orbit"]["h_min"]) == pytest.approx(answer["h_min"]["value"], rel=1e-3)


def test_incommensurate_forcing_falls_back_on_time(tmp_path):
    text = (SCENARIOS / "fmr_reference.toml").read_text() + "[[shaft.whirl]]\nratio = 0.41421356\nangle = 2e-6\n"
    answer = run_study("steady-state", parse_scenario(text, "x.toml"), tmp_path / "s.h5", workers=1)
    assert answer["period"] is None
    # 0.076 of the stator's tilt and 0.058 of its own, 25 urad each, and at most the whirl's 2 urad more or less.
    tilt = answer["relative_misalignment"]
    assert 3.35e-6 < tilt["max"] < 5.4e-6 and 0 <= tilt["min"] < tilt["max"]
    assert 0.97 < answer["h_min"]["of_clearance"] < 0.999
    # What is drawn are the last turns of that run.
    shown = answer["orbit"]["relative_misalignment"]
    assert 0.9 * tilt["min"] < min(shown) < max(shown) < 1.001 * tilt["max"]
    assert len(read_study(tmp_path / "s.h5")["panels"]) == 2


@pytest.mark.parametrize("runout", ["0", "1e-9"])
def test_where_next_to_nothing_moves_the_rest_state_is_the_orbit(tmp_path, runout):
    """Rounding alone is not integrated below itself."""
    values = [f"rotor.runout={runout}", "stator.misalignment=0"]
    scenario = sealdyn.read_scenario(SCENARIOS / "fms_reference.toml", values)
    answer = run_study("steady-state", scenario, tmp_path / "s.h5", flags={"approach": []}, workers=1)
    assert answer["status"] == "ok" and answer["stable"]
    assert answer["h_min"]["of_clearance"] == pytest.approx(1.0, abs=1e-5)
    assert answer["relative_misalignment"]["max"] < 2e-9


def test_without_an_orbit_the_answer_says_so_and_is_drawn(tmp_path):
    """Runout beyond touch: no orbit without contact, though the aligned seal is stable at this speed."""
    values = ["rotor.runout=6 mrad", "run.start=steady"]
    scenario = sealdyn.read_scenario(SCENARIOS / "fms_reference.toml", values)
    answer = run_study("steady-state", scenario, tmp_path / "s.h5", workers=1)
    assert answer["status"] == "failed" and answer["period"] == pytest.approx(2 * np.pi / 1000)
    nothing = ("multipliers", "stable", "h_min", "relative_misalignment", "orbit")
    assert [answer[name] for name in nothing] == [None] * 5 and answer["near_threshold"] == []
    assert answer["critical_speed"] > 1000
    # What linear theory foretells is drawn in place of the orbit's multipliers.
    foretold = [abs(complex(*m)) for m in answer["linear"]["multipliers"]]
    assert answer["linear"]["verdict"] == "stable" and len(foretold) == 6 and max(foretold) < 1.0
    # And that its film would cut into the faces.
    assert min(answer["linear"]["h_min"]) < 0.0
    panels = read_study(tmp_path / "s.h5")["panels"]
    assert any(len(one["x"]) == 6 for panel in panels for one in panel["series"])


@pytest.mark.parametrize("key, value", [("samples", 0), ("turns", 0), ("longest", -1)])
def test_counts_of_nothing_are_refused(key, value):
    """Without a sample the linear film had no columns: a KeyError came through."""
    with pytest.raises(sealdyn.ScenarioError) as refused:
        sealdyn.study("steady-state", SCENARIOS / "fms_reference.toml", **{key: value})
    assert refused.value.key == f"study.steady_state.{key}"


def test_the_orbit_shown_is_closer_than_the_run_was_asked(tmp_path):
    text = (SCENARIOS / "fms_reference.toml").read_text()
    scenario = parse_scenario(text, "loose", ["run.accuracy=1e-4"])
    found = run_study("steady-state", scenario, tmp_path / "s.h5", flags={"approach": []}, workers=1)
    # The same film, a period as exact as can be.
    shooter = Shooter(scenario.scene, 1e-4)
    sharp = shooter.extremes(shooter.find().start, accuracy=1e-10)
    assert found["relative_misalignment"] == pytest.approx(sharp["relative_misalignment"], rel=1e-5)
    # It closes.
    for name in ("relative_tilt_x", "relative_tilt_y"):
        waves = np.array(found["orbit"][name])
        assert abs(waves[-1] - waves[0]) < 1e-5 * np.ptp(waves)


def test_a_period_of_many_cycles_has_samples_of_each(tmp_path):
    text = (SCENARIOS / "fms_reference.toml").read_text()
    text += "[[housing.axial]]\nfrequency = '225 Hz'\ndisplacement = '1 um'\n"
    scenario = parse_scenario(text, "shaken").with_({"shaft.speed": "5000 rpm"})
    found = run_study("steady-state", scenario, tmp_path / "s.h5", flags={"approach": []}, workers=1)
    cycles = 225.0 * found["period"]
    assert cycles > 20 and len(found["orbit"]["time"]) >= 24 * cycles


def test_a_film_that_stores_turns_with_its_forcing():
    """Of one forcing alone no run in time is needed; its tilt is the linear response at the forcing's frequency."""
    values = ["stator.misalignment=0", "film.gas_reynolds.cells=[4, 24]"]
    scenario = sealdyn.read_scenario(SCENARIOS / "gas_reynolds_reference.toml", values)
    found = steady_state.run(scenario, steady_state.Settings(), InProcess())
    model = Model(scenario.scene)
    linear = model.linear_scene()
    answers = [(h, linear.response(h)) for h in model.segment().harmonics()]
    most, least, _ = steady_extremes(linear, answers, found["period"])
    orbit = found["orbit"]
    # Cells that stand, and cells that turn: as far apart as second order in 24 angles leaves them.
    assert orbit["relative_misalignment"] == pytest.approx([most] * 256, rel=0.02)
    assert least == pytest.approx(most) and 0.0 < found["h_min"]["value"] < model.clearance
    assert orbit["relative_tilt_x"][-1] == pytest.approx(orbit["relative_tilt_x"][0])
    assert found["stable"] is None and found.notes


@pytest.mark.parametrize("name, turns, forced", [
    ("gas_reynolds_reference", 15, ["rotor.runout=1 mrad", "film.gas_reynolds.cells=[4, 24]"]),
    ("dry_gas_seal", 4, ["stator.misalignment=0.1 mrad"]),
])  # fmt: skip
def test_a_film_that_stores_under_two_forcings_is_where_a_run_in_time_ends(name, turns, forced):
    scenario = sealdyn.read_scenario(SCENARIOS / f"{name}.toml", forced)
    found = steady_state.run(scenario, steady_state.Settings(samples=32), InProcess())
    assert found["multipliers"] is None and found["stable"] is None and found.notes
    ready = started(scenario.scene, turns * found["period"], 1e-5)
    scales, recorder = ready.model.scales[: ready.model.unknowns.n], Recorder(found["period"])
    start = FilmBalance(scenario.scene).find().start
    ready.y0[: len(start)] = start
    ready.y0[: len(scales)] += 0.01 * scales
    ready.segment(0).settle_film(0.0, ready.y0)
    solve(ready, "ida", 1e-5, recorder)
    away = np.max(np.abs(recorder.arrays()[1] - start[: len(scales)]) / scales, axis=1)
    assert [found["start"][key] for key in ready.model.unknowns.names] == pytest.approx(list(start[: len(scales)]))
    assert away[0] == pytest.approx(0.01) and away[-1] < 1e-4
