"""Wear of real scenes over hours: flat faces by hand, a cone that runs in, two materials, a study that is killed."""

import json
import math
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from command import SCENARIOS, read
from drawn import text_trouble
from killed import COMMAND, kill_midway
from scenes import fms, ring

import sealdyn
from sealdyn.archive import read_study
from sealdyn.numerics.piecewise_linear import PiecewiseLinear
from sealdyn.report.panels import draw
from sealdyn.scenario.errors import ScenarioError
from sealdyn.scene.film import Film
from sealdyn.scene.forces import Contact
from sealdyn.scene.rings import Rotor, Stator, Support
from sealdyn.scene.scene import Closing
from sealdyn.studies._runner import run_study
from sealdyn.studies.wear.averages import ShortRunAverages
from sealdyn.studies.wear.rosenbrock import Control, HatBasis, NoAverage, WearState, advance, unevenness

R_I, R_O, SPEED, LOAD, ROUGH, PER = 0.032, 0.040, 300.0, 250.0, 1e-7, 1e-17
AREA, HOUR = math.pi * (R_O**2 - R_I**2), 3600.0
RADIUS = np.linspace(R_I, R_O, 17)


def pressed(coning=0.0, pressure=0.0, stiffness=0.0, **wears):
    """Faces under a spring load; without a sealed pressure asperities carry all of it."""
    film = Film(inner_radius=R_I, outer_radius=R_O, viscosity=1e-9, outer_pressure=pressure, inner_pressure=0.0,
                coning=coning)  # fmt: skip
    rough = Contact(roughness=ROUGH, compressive_strength=1e8, **(wears or {"stator_wear_coefficient": PER}))
    support = Support(axial_stiffness=stiffness, axial_damping=10.0, radius=0.04)
    return replace(fms(film=film, own=0.0, runout=0.0, speed=SPEED, stator=Stator(**ring(support=support))),
                   contact=rough, closing=Closing(balance_ratio=0.7, spring_force=LOAD))  # fmt: skip


def history(scene, hours, accuracy=1e-2, allowed=1.0, radius=RADIUS):
    """All profiles with their averages."""
    runs = ShortRunAverages(scene, radius, within=0.1 * accuracy)
    control = Control(ROUGH, accuracy, allowed * ROUGH)
    return runs, list(advance(runs, HatBasis(radius), WearState(0.0, np.zeros(len(radius))), hours * HOUR, control))


def test_the_closing_force_is_what_the_start_has_decided():
    """A clearance held at 4 bar with a spring of 60 N: at 2 bar the spring still is 60 N and the faces come nearer."""
    fallen = PiecewiseLinear((0.0, 0.005), (4e5, 2e5))
    scene = replace(pressed(), closing=Closing(spring_force=60.0))
    scene = replace(
        scene, film=replace(scene.film, viscosity=5e-4, clearance=1.5e-6, coning=1e-4, outer_pressure=fallen)
    )
    runs = ShortRunAverages(scene, RADIUS)
    at_first = ShortRunAverages(replace(scene, film=replace(scene.film, outer_pressure=4e5)), RADIUS).closing
    assert runs.closing.balance_ratio == at_first.balance_ratio
    seen = runs(np.zeros(len(RADIUS))).row
    assert seen["closing_force"] == pytest.approx(at_first.balance_ratio * 2e5 * AREA + 60.0, rel=1e-9)
    assert seen["h_min"] < 1.2e-6


# --- flat parallel faces under a constant load -----------------------------------------------------------


@pytest.mark.core
def test_new_flat_faces_wear_by_k_p_v():
    """Depth k p v t at every radius as long as the pressure is still that of new faces: for a few milliseconds."""
    _, found = history(pressed(), 1e-6)
    rate, exact = HatBasis(RADIUS).rates(found[0][1].nodal)
    assert exact
    assert rate == pytest.approx(PER * LOAD / AREA * SPEED * RADIUS, rel=1e-6, abs=0.0)
    worn = found[-1][0]
    assert worn.depth == pytest.approx(PER * LOAD / AREA * SPEED * RADIUS * worn.time, rel=1e-6, abs=0.0)


def test_run_in_flat_faces_wear_evenly():
    """p v uniform: k W F / (2 pi (r_o - r_i)) at every radius; between, the volume is the integral of its rate."""
    _, found = history(pressed(), 3000.0)
    worn, average = found[-1]
    even = PER * SPEED * LOAD / (2 * math.pi * (R_O - R_I))
    rate, _ = HatBasis(RADIUS).rates(average.nodal)
    assert unevenness(HatBasis(RADIUS).rates(found[0][1].nodal)[0]) > 0.2
    assert rate == pytest.approx(even, rel=1e-6, abs=0.0)
    for worn, _ in found[1:]:
        assert worn.volume == pytest.approx(HatBasis(RADIUS).volume(worn.depth), rel=1e-10, abs=0.0)
    # The rate of the volume is k W int p r dA: from F r_2 (r_2 the mean lever of a uniform p) to that of a uniform p r.
    lever = 2 / 3 * (R_O**3 - R_I**3) / (R_O**2 - R_I**2)
    assert found[0][1].volume_rate == pytest.approx(PER * SPEED * LOAD * lever, rel=1e-9, abs=0.0)
    assert average.volume_rate == pytest.approx(even * AREA, rel=1e-6, abs=0.0)


def test_the_springs_give_way_as_the_ring_follows():
    """The load falls by stiffness times travel: d(depth)/dt = c (F - K depth) once run in, c = k W / (2 pi width)."""
    stiffness = 2e7
    _, found = history(pressed(stiffness=stiffness), 300.0, accuracy=1e-3)
    start = next(k for k, (worn, a) in enumerate(found) if unevenness(HatBasis(RADIUS).rates(a.nodal)[0]) < 2e-3)
    (first, one), (last, other) = found[start], found[-1]
    per = PER * SPEED / (2 * math.pi * (R_O - R_I))
    assert last.time > 1.5 * first.time
    decay = math.exp(-per * stiffness * (last.time - first.time))
    # The faces rise a little out of each other as the load goes: some 20 of 9000 nm of travel.
    assert other.row["contact_force"] / one.row["contact_force"] == pytest.approx(decay, rel=5e-3, abs=0.0)
    assert decay < 0.7
    for _, average in found:
        assert average.row["contact_force"] == pytest.approx(
            LOAD + stiffness * average.row["travel"], rel=1e-9, abs=0.0
        )


def test_two_floating_rings_share_the_travel():
    """Two supports in series give as one of half their stiffness."""
    one = pressed(stiffness=1e8)
    both = replace(one, rotor=Rotor(**ring(support=one.stator.support)))
    found = [history(scene, 5.0)[1][-1] for scene in (pressed(stiffness=5e7), both)]
    assert found[1][0].depth == pytest.approx(found[0][0].depth, rel=1e-6, abs=0.0)
    carried = LOAD + 5e7 * found[1][1].row["travel"]
    assert found[1][1].row["contact_force"] == pytest.approx(carried, rel=1e-9, abs=0.0)
    assert carried < 0.99 * LOAD


def test_faces_with_a_profile_wear_on_from_it(tmp_path):
    """What one study leaves is where the next begins."""
    whole = run_study("wear", read("run_in"), tmp_path / "a.h5", flags={"duration": "8 h"}, workers=1)
    half = run_study("wear", read("run_in"), tmp_path / "b.h5", flags={"duration": "4 h"}, workers=1)
    lengths = [[f"{v!r} m" for v in column] for column in (half["radius"], _both(half))]
    text = (SCENARIOS / "run_in.toml").read_text()
    table = f"[film.profile]\nradius = {json.dumps(lengths[0])}\ndepth = {json.dumps(lengths[1])}\n[closing]"
    worn = tmp_path / "worn.toml"
    worn.write_text(text.replace("[closing]", table))
    rest = run_study("wear", sealdyn.read_scenario(worn), tmp_path / "c.h5", flags={"duration": "4 h"}, workers=1)
    # The spring is as long as new again: nothing beside the load.
    assert np.array(_both(half)) + np.array(_both(rest)) == pytest.approx(np.array(_both(whole)), abs=2e-2 * ROUGH)


def _both(answer) -> list[float]:
    return (np.array(answer["profile"]["stator"][-1]) + np.array(answer["profile"]["rotor"][-1])).tolist()


def test_slope_of_faces_at_rest_is_that_of_their_averages():
    """Against differences of whole short runs, ring and film going along."""
    runs = ShortRunAverages(pressed(coning=2e-5, pressure=3e5, stiffness=1e5), RADIUS)
    depth = 2e-8 * np.cos(300 * RADIUS)
    start = runs(depth)
    for k in (0, 7, 16):
        step = 1e-10 * (np.arange(17) == k)
        difference = (runs(depth + step, start.motion).nodal - runs(depth - step, start.motion).nodal) / 2e-10
        assert difference == pytest.approx(start.slope[:, k], abs=2e-3 * np.max(np.abs(start.slope)))


# --- a cone runs in -------------------------------------------------------------------------------------


@pytest.fixture
def calls(monkeypatch):
    """Counts short runs."""
    counted, whole = [], ShortRunAverages.__call__
    monkeypatch.setattr(ShortRunAverages, "__call__", lambda self, d, m=None: counted.append(1) or whole(self, d, m))
    return counted


@pytest.fixture(scope="module")
def run_in(tmp_path_factory):
    out = tmp_path_factory.mktemp("wear") / "run_in.h5"
    return run_study("wear", read("run_in"), out, workers=1), out


def test_a_coned_face_runs_in_to_a_uniform_p_v(run_in):
    answer, out = run_in
    assert (answer["status"], answer["end"]["kind"]) == ("ok", "run-in")
    start, end = np.array(answer["pv"][0]), np.array(answer["pv"][-1])
    assert start[8:].max() == 0.0 < start[0]
    assert np.ptp(end) < 1e-2 * end.mean()
    share = answer["history"]["contact_share"]
    # int p_c v dA over the face = pv area: the load that asperities carry then, film and contact all of the closing.
    speed = read("run_in").scene.shaft.speed
    force = end.mean() / speed * 2 * math.pi * (R_O - R_I)
    assert answer["history"]["contact_force"][-1] == pytest.approx(force, rel=2e-3, abs=0.0)
    both = answer["history"]["contact_force"][-1] + answer["history"]["film_force"][-1]
    assert both == pytest.approx(answer["history"]["closing_force"][-1], rel=1e-2, abs=0.0)
    assert share[-1] > 3 * share[0]
    assert answer["history"]["leakage"][-1] < 0.5 * answer["history"]["leakage"][0]
    assert abs(answer["history"]["coning"][-1]) < 0.02 * answer["history"]["coning"][0]
    json.dumps(answer, allow_nan=False)
    assert read_study(out)["answer"]["end"]["kind"] == "run-in"


def test_volume_is_conserved(run_in):
    answer, _ = run_in
    assert answer["volume"]["residual"] < 1e-10
    assert answer["volume"]["profiles"] > 0.0
    worn = sum(answer["history"][f"{face}_volume"][-1] for face in ("stator", "rotor"))
    assert worn == pytest.approx(answer["volume"]["integral"], rel=1e-10, abs=0.0)


def test_two_materials_wear_in_the_ratio_of_their_coefficients(run_in):
    answer, _ = run_in
    stator, rotor = (np.array(answer["profile"][face]) for face in ("stator", "rotor"))
    assert 20 * rotor == pytest.approx(stator, rel=1e-12, abs=0.0)
    hard = read("run_in", "contact.stator_wear_coefficient=0 1/Pa")
    other = run_study("wear", hard, Path(run_in[1]).parent / "o.h5", flags={"duration": "1 h"}, workers=1)
    assert not np.any(other["profile"]["stator"])
    assert np.max(other["profile"]["rotor"]) > 0.0


def test_its_figure_is_drawn(run_in):
    assert text_trouble(draw(run_in[1])) == ([], [])


def test_halving_the_step_changes_less_than_the_accuracy():
    """Profiles, at the same hour on the way, of steps half as long."""
    scene = pressed(coning=3e-5, pressure=2e5)
    ends = [history(scene, 4.0, 1e-3, step)[1][-1][0].depth for step in (0.05, 0.025)]
    assert 0.0 < np.max(np.abs(ends[0] - ends[1])) < 1e-3 * ROUGH
    assert np.max(ends[0]) > ROUGH


def test_extrapolation_only_when_asked(run_in, tmp_path):
    answer, _ = run_in
    assert answer["extrapolated"] is None
    # What the asked hours come to is said all the same, of both faces.
    rates = np.sum(answer["coefficients"]) * np.array(answer["pv"][-1])
    worn = np.sum([answer["profile"][face][-1] for face in ("stator", "rotor")], axis=0)
    total = np.max(worn) + np.mean(rates) * (100 * HOUR - answer["history"]["time"][-1])
    *_, both = answer["tables"][0]["rows"]
    assert both[0] == "both together" and both[-1] == pytest.approx(total, rel=0.02)
    told = run_study("wear", read("run_in"), tmp_path / "x.h5", flags={"run_in": "extrapolate"}, workers=1)
    far = told["extrapolated"]
    hours = (far["time"] - far["from"]) / HOUR
    assert far["time"] == 100 * HOUR
    last = {row[0]: row[-1] for row in told["tables"][0]["rows"]}
    assert last == {face: max(far[face]) for face in ("stator", "rotor")}
    gained = np.array(far["stator"]) - np.array(told["profile"]["stator"][-1])
    rate = np.array(told["pv"][-1]) * told["coefficients"][0] * HOUR
    assert gained == pytest.approx(rate * hours, rel=1e-9, abs=0.0)


def test_asked_to_go_on_it_wears_to_the_end_in_few_steps(run_in, tmp_path):
    flags = {"duration": "300 h", "run_in": "go on"}
    answer = run_study("wear", read("run_in"), tmp_path / "o.h5", flags=flags, workers=1)
    assert (answer["end"]["kind"], answer["end"]["time"]) == ("duration", 300 * HOUR)
    assert answer["steps"] < run_in[0]["steps"] + 40
    assert np.ptp(answer["pv"][-1]) < 1e-3 * np.max(answer["pv"][-1])


# --- a scene that moves ----------------------------------------------------------------------------------


@pytest.mark.slow
def test_a_misaligned_seal_wears_by_averages_over_turns(tmp_path):
    """The rubbing reference seal: its thin edge wears; the average is that of a long run of the same scene."""
    flags = {"duration": "0.15 h", "nodes": 5}
    scenario = read("rub", "contact.stator_wear_coefficient=1e-17 1/Pa")
    answer = run_study("wear", scenario, tmp_path / "rub.h5", flags=flags, workers=1)
    assert (answer["status"], answer["end"]["kind"]) == ("ok", "duration")
    assert answer["not_settled"] == 0
    assert answer["volume"]["residual"] < 1e-10
    depth = np.array(answer["profile"]["stator"][-1])
    assert depth[0] > 1e-8 and depth[3:].max() < 1e-3 * depth[0]
    run = sealdyn.simulate(scenario, tmp_path / "run.h5")
    assert answer["history"]["wear_rate"][0] == pytest.approx(_late(run.archive, "wear_rate"), rel=1e-2, abs=0.0)


@pytest.mark.slow
def test_halving_the_step_of_a_scene_that_moves_changes_less_than_the_accuracy():
    scene = read("rub", "contact.stator_wear_coefficient=1e-17 1/Pa").scene
    radius = np.linspace(R_I, R_O, 4)
    ends = [history(scene, 0.1, 1e-2, step, radius)[1][-1][0].depth for step in (0.05, 0.025)]
    assert 0.0 < np.max(np.abs(ends[0] - ends[1])) < 1e-3 * ROUGH
    assert np.max(ends[0]) > 0.05 * ROUGH


def _late(path, name) -> float:
    """Mean of a series over the last five of eighty turns."""
    import h5py

    with h5py.File(path) as file:
        return float(file[name][-5 * len(file[name]) // 80 - 1 : -1].mean())


# --- how it ends ----------------------------------------------------------------------------------------


def test_nothing_grows_back_and_the_bar_is_full_at_the_end(tmp_path):
    seen = []
    answer = run_study("wear", read("run_in", "film.coning=-40 urad"), tmp_path / "s.h5", workers=1,
                       flags={"duration": "5 min", "nodes": 9}, progress=lambda *now: seen.append(now))  # fmt: skip
    assert answer["tables"][0]["rows"][0][:2] == ["stator", 0.0]
    assert seen[-1] == (1.0, 1.0, "300 s of 300 s")
    seen.clear()
    lifted = read("run_in", "film.coning=2 mrad")
    run_study("wear", lifted, tmp_path / "l.h5", workers=1, progress=lambda *now: seen.append(now))
    assert seen[-1] == (1.0, 1.0, "0 ms of 100 h")


def test_a_film_that_carries_everything_does_not_wear(tmp_path):
    answer = run_study("wear", read("run_in", "closing.balance_ratio=0.6", "closing.spring_force=5 N"),
                         tmp_path / "o.h5", workers=1)  # fmt: skip
    assert (answer["end"]["kind"], answer["end"]["time"], answer["steps"]) == ("lift-off", 0.0, 0)


def test_springs_that_give_way_let_the_film_lift_off(tmp_path):
    """A stiff support loses its load as the ring follows, until film and hydraulics alone balance."""
    scenario = read("run_in", "stator.support.axial_stiffness=1e9 N/m", "contact.stator_wear_coefficient=1e-15 1/Pa")
    answer = run_study("wear", scenario, tmp_path / "o.h5", flags={"duration": "2000 h", "run_in": "go on"},
                         workers=1)  # fmt: skip
    assert answer["end"]["kind"] == "lift-off"
    assert 0 < answer["end"]["time"] < 2000 * HOUR
    assert answer["history"]["contact_share"][-1] < 1e-3 * answer["history"]["contact_share"][0]


def test_crushed_asperities_are_a_result(tmp_path):
    """Asperities too soft to carry their share of the load."""
    answer = run_study("wear", read("run_in", "contact.compressive_strength=0.03 MPa"), tmp_path / "o.h5", workers=1)
    assert (answer["status"], answer["end"]["kind"], answer["steps"]) == ("collapsed", "collapsed", 0)
    assert text_trouble(draw(tmp_path / "o.h5")) == ([], [])


def test_a_short_run_that_fails_on_the_way_leaves_what_came_before(run_in, tmp_path, monkeypatch):
    whole, answer = ShortRunAverages.__call__, run_in[0]

    def broken(self, depth, motion=None):
        if depth.max() > 2e-7:
            raise NoAverage("failed", "the solver gave up")
        return whole(self, depth, motion)

    monkeypatch.setattr(ShortRunAverages, "__call__", broken)
    found = run_study("wear", read("run_in"), tmp_path / "o.h5", workers=1)
    assert (found["status"], found["end"]["kind"]) == ("failed", "failed")
    assert "gave up" in found["verdict"][0]
    last = 1.05 * np.array(found["profile"]["stator"][-1]).max()
    assert 1.5e-7 < last < 2e-7
    # As far as it came it is the other's history, give or take the last steps.
    common = 0.8 * found["history"]["time"][-1]
    at = [np.interp(common, a["history"]["time"], a["history"]["leakage"]) for a in (answer, found)]
    assert at[0] == pytest.approx(at[1], rel=1e-2, abs=0.0)


@pytest.mark.parametrize(
    ("name", "overrides", "flags", "key", "found"),
    [
        ("run_in", [f"contact.{face}_wear_coefficient=0 1/Pa" for face in ("stator", "rotor")], {},
         "wear_coefficient", ""),
        ("run_in", [], {"nodes": 80}, "nodes", "80"),
        ("run_in", [], {"duration": "0 h"}, "duration", "0"),
        ("run_in", [], {"turns": 0}, "turns", "0"),
        ("run_in", ["film.cavitation_pressure=0.1 bar"], {}, "cavitation_pressure", ""),
        ("fms_reference", [], {}, "contact", ""),
    ],
)  # fmt: skip
def test_what_cannot_be_asked_is_refused_by_its_key(name, overrides, flags, key, found, tmp_path):
    with pytest.raises(ScenarioError) as refused:
        run_study("wear", read(name, *overrides), tmp_path / "o.h5", flags=flags, workers=1)
    assert refused.value.key.endswith(key) and found in refused.value.found


def test_a_contact_on_one_side_is_said(tmp_path):
    """Faces tilted by hundreds of roughnesses rub at a patch: the profile spreads its wear over the circle."""
    scenario = read("rub", "contact.stator_wear_coefficient=1e-17 1/Pa", "run.accuracy=1e-4")
    flags = {"duration": "10 s", "nodes": 3, "patience": 2}
    answer = run_study("wear", scenario, tmp_path / "o.h5", flags=flags, workers=1)
    tilt = answer["tilt_over_roughness"]
    assert tilt == pytest.approx(max(answer["history"]["relative_misalignment"]) * 0.04 / 1e-7, rel=1e-12)
    assert tilt > 100


# --- interrupted and killed -----------------------------------------------------------------------------


def steps_of(journal):
    return [json.loads(line)["key"] for line in journal.read_text().splitlines()[1:]]


@pytest.mark.slow
def test_a_killed_study_goes_on_where_it_was(run_in, tmp_path, calls):
    """kill -9 in the middle: no finished step is taken again, and the answer is the same to the last digit."""
    out = tmp_path / "run_in.h5"
    journal = out.with_suffix(".partial.jsonl")
    words = [*COMMAND, "wear", str(SCENARIOS / "run_in.toml"), "--out", str(out), "--workers", "1", "--no-plot"]
    kill_midway(words, journal, 6)
    done = len(steps_of(journal))
    assert done == 7 and not out.exists()

    answer = run_study("wear", read("run_in"), out, workers=1)
    rest = len(calls)
    expected, _ = run_in
    assert answer["history"] == expected["history"]
    assert answer["profile"] == expected["profile"]
    # Each finished step took four short runs or more: none of them again.
    run_study("wear", read("run_in"), tmp_path / "whole.h5", workers=1)
    assert rest <= len(calls) - rest - 4 * (done - 1)
    assert not journal.exists()


def test_an_interruption_keeps_the_steps(run_in, tmp_path, monkeypatch):
    out = tmp_path / "run_in.h5"
    calls, whole = [], ShortRunAverages.__call__

    def interrupted(self, depth, motion=None):
        calls.append(1)
        if len(calls) == 30:
            raise KeyboardInterrupt
        return whole(self, depth, motion)

    with monkeypatch.context() as patch:
        patch.setattr(ShortRunAverages, "__call__", interrupted)
        with pytest.raises(KeyboardInterrupt):
            run_study("wear", read("run_in"), out, workers=1)
    done = steps_of(out.with_suffix(".partial.jsonl"))
    assert done == [f"step:{k}" for k in range(len(done))] and len(done) > 4
    assert run_study("wear", read("run_in"), out, workers=1)["profile"] == run_in[0]["profile"]


def test_pads_do_not_wear():
    rough = {"roughness": "0.1 um", "compressive_strength": "300 MPa", "stator_wear_coefficient": 1e-16}
    seal = sealdyn.example("rayleigh_pads").with_({"contact": rough})
    with pytest.raises(sealdyn.ScenarioError) as error:
        sealdyn.study("wear", seal)
    assert error.value.key == "film.pads"
