"""Where a run starts whose scenario leaves it open."""

import re
from pathlib import Path

import numpy as np
import pytest
from radial_cells import film_of
from scenes import fms

import sealdyn
from sealdyn.dynamics.model import Model
from sealdyn.dynamics.run_state import RunState
from sealdyn.scenario.reader import parse_scenario, read_scenario
from sealdyn.simulation import selection
from sealdyn.simulation.batch import run_many
from sealdyn.simulation.selection import Start, choose_start
from sealdyn.simulation.simulate import prepare_run, simulate, simulate_in_memory
from sealdyn.studies import work_precision as study
from sealdyn.studies.work_precision import film_ladder

ROOT = Path(__file__).parents[2]
SEAL = ROOT / "scenarios" / "fms_reference.toml"
# 333 urad of runout under 0.8 um of film.
# README's seal, isothermal.
PUMP = re.search(r"```toml\n(.*?)```", (ROOT / "README.md").read_text(), re.DOTALL)[1]
PUMP = re.sub(r"(?m)^heat\..*\n", "", PUMP)


def seal(*overrides):
    """The reference seal, its start left open."""
    return read_scenario(SEAL, ["run.start=auto", *overrides])


def begun(*overrides):
    """What a run has at the start if left open, at rest, and on the linear steady response."""
    found = [prepare_run(seal(*overrides, f"run.start={start}"))[0] for start in ("auto", "rest", "steady")]
    return [run.y0 for run in found], found[0].start


@pytest.mark.core
def test_a_stable_seal_starts_on_its_steady_response():
    (auto, rest, steady), start = begun()
    assert np.array_equal(auto, steady) and not np.array_equal(auto, rest)
    assert start.taken == "steady" and start.why


def test_auto_is_the_default_and_needs_no_word_for_an_ordinary_runout():
    """At rest the film of this seal is closed."""
    with pytest.raises(ValueError, match="closed at the start"):
        prepare_run(parse_scenario(PUMP, "pump", ["run.start=rest"]))
    left_open, steady = (prepare_run(parse_scenario(PUMP, "pump", o))[0] for o in ([], ["run.start=steady"]))
    assert np.array_equal(left_open.y0, steady.y0) and np.any(steady.y0)


# What else makes the response doubtful.
CONTACT = ["contact.roughness='0.1 um'", "contact.compressive_strength='1 GPa'"]
SEALED = ["stator.secondary_seal.friction_force=5 N", "stator.secondary_seal.radius=45 mm"]
AT_REST = {
    "not stable": ["shaft.speed=6500 rad/s"], "initial": ["initial.stator.tilt_x=1 urad"], "secondary seal": SEALED,
    "contact": CONTACT, "speed": ["shaft.speed={time=[0, 1], value=[900, 1000]}"],
    "pressure": ["film.outer_pressure={time=[0, 1], value=['5 bar', '6 bar']}"],
}  # fmt: skip


@pytest.mark.parametrize("overrides", AT_REST.values(), ids=AT_REST)
def test_else_it_starts_at_rest(overrides):
    (auto, rest, steady), start = begun(*overrides)
    assert np.array_equal(auto, rest) and not np.array_equal(auto, steady)
    assert start.taken == "rest" and start.why


@pytest.mark.parametrize(
    "overrides", [CONTACT, SEALED, ["film.outer_pressure={time=[0, 1], value=['11 bar', '12 bar']}"]]
)
def test_faces_that_would_overlap_at_rest_start_on_the_response(overrides):
    """Wherever there is one; what is doubtful about it stands beside it."""
    with pytest.raises(ValueError, match="closed at the start"):
        prepare_run(parse_scenario(PUMP, "pump", ["run.start=rest", *overrides]))
    starts = ([], ["run.start=steady"])
    left_open, steady = (prepare_run(parse_scenario(PUMP, "pump", [*o, *overrides]))[0] for o in starts)
    assert left_open.start.taken == "steady" and np.array_equal(left_open.y0, steady.y0) and np.any(steady.y0)
    doubt = begun(*overrides)[1].why.removeprefix("at rest: ")
    assert "overlap" in left_open.start.why and left_open.start.why.endswith(doubt)


@pytest.mark.parametrize("overrides", [["initial.stator.z='1 nm'"], ["shaft.speed='2e6 rpm'"]])
def test_where_there_is_no_response_overlapping_faces_are_refused(overrides):
    """The start was given; the seal is unstable."""
    with pytest.raises(ValueError, match="closed at the start") as told:
        prepare_run(parse_scenario(PUMP, "pump", [*CONTACT, *overrides]))
    # No number of it is a negative thickness, and no start is advised that is none.
    assert not re.search(r"-\d", str(told.value)) and "run.start" not in str(told.value)


def test_a_response_that_closes_the_film_is_no_start():
    """A stator so far out of square that linear theory closes the film, open as long as it stands straight."""
    run, *_ = prepare_run(seal("stator.misalignment=6 mrad"))
    assert run.start.taken == "rest" and not np.any(run.y0)


@pytest.mark.parametrize("overrides", [[], CONTACT])
def test_where_both_are_closed_no_other_start_is_advised(overrides):
    with pytest.raises(ValueError, match="closed at the start") as told:
        prepare_run(seal("stator.misalignment=6 mrad", "rotor.runout=6 mrad", *overrides))
    assert "run.start" not in str(told.value)


def test_a_neutral_scene_starts_at_rest():
    """Without any damping nothing that is left of a start dies out."""
    film = "{axial_stiffness=1e7, tilt_stiffness=1e4, axial_damping=0, tilt_damping=0}"
    dry = ["film.model=linear", f"film.coefficients={film}", "stator.support.axial_damping=0"]
    run, *_ = prepare_run(seal(*dry))
    assert run.start.taken == "rest" and "neutral" in run.start.why


def test_a_film_with_unknowns_of_its_own_starts_at_rest():
    run = RunState(Model(fms(), film=film_of(6, 8, 1e-9)), 0.01)
    assert choose_start(run, "auto").taken == "rest" and choose_start(run, "steady").taken == "steady"


def test_all_films_tried_for_a_scene_start_alike(monkeypatch):
    """A film that is not asked for is not asked where to start."""
    asked = []
    monkeypatch.setattr(selection, "choose_start", lambda run, start: asked.append(run) or Start("steady", "so"))
    run, *_ = prepare_run(seal("film.model=auto", "run.accuracy=1e-3"))
    assert run.model.interface.name == "linear" and asked[0].model.interface.name == "radial"
    assert len(asked) == 1 and run.start.taken == "steady" and np.any(run.y0)


def test_the_summary_says_which_start_was_taken_and_why():
    for speed, taken in ((1000, "steady"), (6500, "rest")):
        scenario = seal("run.turns=2", f"shaft.speed={speed}")
        model = simulate_in_memory(scenario)["model"]
        assert model["start"] == taken
        assert prepare_run(scenario)[0].start.why in " ".join(model["reasons"])
    asked = simulate_in_memory(seal("run.turns=2", "run.start=rest"))["model"]
    assert asked["start"] == "rest" and not any(reason.startswith("start") for reason in asked["reasons"])


def test_a_continued_run_keeps_the_start_it_was_begun_with(tmp_path, monkeypatch):
    scenario = seal("run.turns=200", "film.model=radial")
    whole = simulate(scenario, tmp_path / "whole.h5")
    part = simulate(scenario, tmp_path / "part.h5", stop=lambda: True)
    assert part.status == "interrupted" and part.summary["model"]["start"] == "steady"
    # Whatever would be chosen now.
    monkeypatch.setattr(selection, "choose_start", lambda run, asked: Start("rest", "another"))
    again = simulate(scenario, tmp_path / "part.h5", resume=True)
    assert again.status == "ok" and again.summary["model"]["start"] == "steady"
    assert "another" not in " ".join(again.summary["model"]["reasons"])
    ours, theirs = (sealdyn.open_archive(found.archive)["stator_tilt_x"].values for found in (again, whole))
    assert np.max(np.abs(ours - theirs)) < 1e-6 * 1e-5 / 0.04


def test_each_of_many_runs_has_its_own_start():
    """The start hangs on what is varied: a larger runout on a larger response, a speed beyond the threshold on none."""
    outputs = ["model.start", "h_min.value", "end.state.stator_tilt_x"]
    sets = [{"rotor.runout": 1e-5}, {"rotor.runout": 3e-5}, {"shaft.speed": 6500.0}]
    rows = run_many(seal("run.turns=3"), [{"set": one, "outputs": outputs} for one in sets])
    assert [row["model.start"] for row in rows] == ["steady", "steady", "rest"]
    for row, one in zip(rows, sets, strict=True):
        (key, value), asked = next(iter(one.items())), row["model.start"]
        single = simulate_in_memory(seal("run.turns=3", f"{key}={value}", f"run.start={asked}"))
        assert row["h_min.value"] == pytest.approx(single["h_min"]["value"], abs=1e-6 * 1e-5)


def test_films_are_compared_from_one_kind_of_start(monkeypatch):
    """One whose start would be another does not begin elsewhere than its judge."""
    seen = []
    monkeypatch.setattr(film_ladder, "compare", lambda scenario, *_: seen.append(scenario.run.start) or ([], None))
    given = study.Settings(tolerances=1, loosest=1e-4, tightest=1e-4, repeats=1, methods=["adams"], samples=20)

    class Tools:
        def say(self, share):
            pass

        def alone(self):
            return self

        def map(self, work, points, name, **how):
            return [work(point) for point in points]

    study.run(seal("run.turns=1", "film.model=linear"), given, Tools())
    assert seen == ["steady"]


def test_advice_of_a_closed_film_knows_where_the_run_began(tmp_path):
    """Nobody is told to begin where he has begun."""
    grown = 'rotor.runout={time=["0 s", "0.05 s"], value=["25 urad", "8 mrad"]}'
    for start, advised in (("rest", True), ("steady", False)):
        found = simulate(read_scenario(SEAL, [grown, f"run.start={start}"]), tmp_path / "a.h5")
        assert found.status == "collapsed" and ("run.start" in found.message) is advised
