"""Many runs in one compiled loop: to the bit what each is by itself at the same tolerance, and what cannot be in it."""

import signal
from threading import Timer

import numpy as np
import pytest
from command import SCENARIOS

import sealdyn
from sealdyn.answers import dotted
from sealdyn.dynamics.tally import Tally
from sealdyn.scenario.errors import ScenarioError
from sealdyn.scenario.reader import read_scenario, with_values
from sealdyn.simulation import batch
from sealdyn.simulation.batch import TALLIED, LoopedRun, NotTallied, integrate, run_many
from sealdyn.simulation.result import output, plain
from sealdyn.simulation.simulate import in_memory, prepare_run, simulate_in_memory
from sealdyn.simulation.summary import parts
from sealdyn.simulation.verification_run import ProgressSink
from sealdyn.solvers.contract import Status, tolerance_for
from sealdyn.solvers.integrate import solve
from sealdyn.solvers.methods import why_slow

pytestmark = pytest.mark.skipif(bool(why_slow()), reason="no compiled loop here")

RAMP = ['shaft.speed={time=[0, 0.01, 0.02], value=["3000 rpm", "9000 rpm", "9000 rpm"]}', "run.duration=0.03"]
SCENES = {
    "one ring": ("fms_reference", ["run.turns=6"], {"rotor.runout": [1e-5, 3e-5, 2e-5]}),
    "a turning ring": ("fmr_reference", ["run.turns=6"], {"film.viscosity": [1e-3, 5e-4]}),
    "both rings": ("fmsr_both_flexible", ["run.turns=6"], {"rotor.misalignment": ["50 urad", "80 urad"]}),
    "shaken": ("housing_vibration", ["run.turns=6"], {"rotor.runout": ["50 urad", "0 urad"]}),
    "stiff": ("squeeze", ["run.duration=2 ms"], {"film.viscosity": [1e-3, 2e-3]}),
    "starting": ("fms_reference", RAMP, {"rotor.runout": [1e-5, 3e-5]}),
    "pulsing": ("fms_reference", ["run.turns=4", "stator.speed=20 rad/s"], {"rotor.runout": [1e-5, 3e-5]}),
    "floored": (
        "fms_reference",
        ["run.turns=4", "film.cavitation_pressure=0", "film.outer_pressure=1e4"],
        {"rotor.runout": [1e-5, 2e-5]},
    ),
    "touching": ("rub", ["run.duration=0.27"], {"stator.misalignment": ["1 mrad", "0.8 mrad"]}),
}


def scenarios_of(name):
    file, overrides, varied = SCENES[name]
    ((key, values),) = varied.items()
    base = read_scenario(SCENARIOS / f"{file}.toml", overrides)
    return [with_values(base, {key: value}) for value in values]


def alone(scenario):
    """The run by itself, at the tolerance of the loop: run, tally, outcome."""
    run, plan = prepare_run(scenario)
    method, sink, tally = plan.method, ProgressSink(run), Tally(run.model)
    outcome = solve(run, method, run.model.accuracy, sink, tally=tally,
                    tolerance=tolerance_for(method, run.model.accuracy, run.memory))  # fmt: skip
    run.contacts.tell(sink.log, end=(run.end_time(outcome.segment, outcome.tau), outcome.y))
    return plain(parts(scenario, run, plan, outcome, tally))


@pytest.mark.parametrize("name", SCENES)
def test_a_run_of_the_loop_is_the_run_by_itself(name):
    scenarios = scenarios_of(name)
    looped = [LoopedRun(scenario, ["leakage.mean", "h_min.value"]) for scenario in scenarios]
    assert len({run.structure for run in looped}) == 1 and looped[0].structure
    integrate(looped)
    for scenario, run in zip(scenarios, looped, strict=True):
        expected, found = alone(scenario), plain(run.parts())
        assert (run.outcome is None) == (expected["status"] != Status.OK)
        if run.outcome is None:
            continue
        assert {**found["counts"], "restarts": 0} == {**expected["counts"], "restarts": 0, "back_end": ""}
        for part in ("h_min", "relative_misalignment", "contact", "end", "film", "closing", "warnings"):
            assert_same(found[part], expected[part], part)
        for part in ("leakage", "friction"):
            assert found[part].pop("conditions", None) is expected[part].pop("conditions", None) is None
            assert_same(found[part], expected[part], part)


def assert_same(found, expected, name):
    """Equal to the bit, but for means."""
    if isinstance(expected, dict):
        assert found.keys() == expected.keys(), name
        for key in expected:
            assert_same(found[key], expected[key], f"{name}.{key}")
    elif name.rpartition(".")[2] in ("mean", "share_of_closing", "share_of_load", "torque", "wear_rate"):
        assert found == pytest.approx(expected, rel=1e-12), name
    else:
        assert found == expected, name


def points(key, values, outputs):
    return [{"set": {key: value}, "outputs": outputs} for value in values]


def rows(file, key, values, outputs, *overrides):
    return run_many(read_scenario(SCENARIOS / f"{file}.toml", overrides), points(key, values, outputs))


@pytest.fixture
def by_itself(monkeypatch):
    """What went by itself: overrides of the scenarios."""
    seen, whole = [], batch.in_memory

    def noted(scenario, *asked, **more):
        seen.append(scenario.overrides[-1])
        return whole(scenario, *asked, **more)

    monkeypatch.setattr(batch, "in_memory", noted)
    return seen


@pytest.mark.core
@pytest.mark.parametrize("accuracy", [1e-3, 1e-6])
def test_rows_are_single_runs_within_the_accuracy(by_itself, accuracy):
    runout, outputs = ["10 urad", "30 urad"], ["h_min.value", "relative_misalignment.max", "end.state.stator_tilt_x"]
    overrides = "run.turns=8", f"run.accuracy={accuracy}"
    found = rows("fms_reference", "rotor.runout", runout, outputs, *overrides)
    assert by_itself == []
    for row, value in zip(found, runout, strict=True):
        changes = [*overrides, f'rotor.runout="{value}"']
        single = simulate_in_memory(read_scenario(SCENARIOS / "fms_reference.toml", changes))
        assert row["status"] == "ok" and "message" not in row
        assert abs(row["h_min.value"] - single["h_min"]["value"]) < accuracy * 1e-5
        assert abs(row["relative_misalignment.max"] - single["relative_misalignment"]["max"]) < accuracy * 1e-5 / 0.04
        state = single["end"]["state"]["stator_tilt_x"]
        assert abs(row["end.state.stator_tilt_x"] - state) < accuracy * 1e-5 / 0.04


def test_means_are_taken_only_where_they_are_asked_for():
    lean = LoopedRun(read_scenario(SCENARIOS / "fms_reference.toml", ["run.turns=2"]), ["h_min.value"])
    integrate([lean])
    with pytest.raises(NotTallied):
        output(lean.parts(), "leakage.mean")
    assert output(lean.parts(), "stability.verdict") == "stable"
    for key in dict(dotted(plain(in_memory(lean.scenario)))):
        try:
            output(lean.parts(), key)
        except NotTallied:
            assert key.startswith(TALLIED)


@pytest.mark.parametrize("name", SCENES)
def test_end_states_alone_are_those_of_a_watched_run(name):
    scenarios = scenarios_of(name)
    lean, watched = ([LoopedRun(s, outputs) for s in scenarios] for outputs in (["end.time"], ["h_min.value"]))
    assert lean[0].structure != watched[0].structure
    integrate(lean)
    integrate(watched)
    for one, other in zip(lean, watched, strict=True):
        assert (one.outcome is None) == (other.outcome is None)
        if one.outcome is None:
            continue
        found, expected = one.parts(), other.parts()
        for part in ("status", "end", "counts"):
            assert plain(found[part]) == plain(expected[part])
        if one.run.model.contact is not None:
            assert_same(output(found, "contact.touches"), output(expected, "contact.touches"), "contact")
        for asked in ("h_min.value", "relative_misalignment.max", "relative_misalignment.steady_max"):
            output(expected, asked)
            with pytest.raises(NotTallied):
                output(found, asked)


def test_a_collapse_is_told_where_only_the_end_is_asked_for(by_itself):
    falls = '{ time = ["0 s", "0.02 s"], value = ["10 urad", "20 mrad"] }'
    good, fallen = rows("fms_reference", "rotor.runout", ["20 urad", falls], ["end.state.stator_z"], "run.turns=8")
    assert good["status"] == "ok" and fallen["status"] == "collapsed" and len(by_itself) == 1


def test_what_there_is_not_is_named(by_itself):
    (row,) = rows("fms_reference", "rotor.runout", ["10 urad"], ["h_min.vlaue"], "run.turns=2")
    assert "nearest 'h_min.value'" in str(row)


@pytest.mark.parametrize(
    "file, key, values",
    [
        ("massless_ring", "rotor.runout", ["20 urad", "30 urad"]),
        ("hang_up", "shaft.speed", ["2900 rpm", "3000 rpm"]),
        ("fms_reference", "run.solver", ["expm", "expm"]),
    ],
)
def test_what_the_loop_cannot_goes_by_itself(by_itself, file, key, values):
    linear = ["film.model=linear"] if "expm" in values else []
    found = rows(file, key, values, ["h_min.value"], "run.turns=2", *linear)
    assert len(by_itself) == 2 and all(row["h_min.value"] > 0 for row in found)


SMALL = "run.accuracy=1e-4", "rotor.runout=1e-8", "stator.misalignment=0", "run.turns=6"


@pytest.mark.core
@pytest.mark.parametrize("film", ["auto", "linear"])
@pytest.mark.parametrize("file", ["fms_reference", "fmsr_both_flexible"])
def test_no_film_goes_by_itself_that_costs_less_in_the_loop(by_itself, file, film):
    """Single runs of these choose the linear film and its exact motion."""
    overrides = *SMALL, f"film.model={film}", "rotor.misalignment=0" if "both" in file else "run.turns=7"
    single = simulate_in_memory(read_scenario(SCENARIOS / f"{file}.toml", [*overrides, "film.viscosity=1e-3"]))
    assert single["model"]["film"] == "linear" and single["model"]["solver"] == "expm"
    (row,) = rows(file, "film.viscosity", [1e-3], ["h_min.value", "relative_misalignment.max"], *overrides)
    assert by_itself == []
    assert abs(row["h_min.value"] - single["h_min"]["value"]) < 1e-4 * 1e-5
    assert abs(row["relative_misalignment.max"] - single["relative_misalignment"]["max"]) < 1e-4 * 1e-5 / 0.04


def test_a_failing_run_costs_one_row(by_itself):
    falls = '{ time = ["0 s", "0.02 s"], value = ["10 urad", "20 mrad"] }'
    values = ["20 urad", "-nonsense", falls, "30 urad", "2 mrad"]
    good, unread, fallen, other, closed = rows("fms_reference", "rotor.runout", values, ["h_min.value"], "run.turns=8")
    assert good["status"] == other["status"] == "ok" and good["h_min.value"] > other["h_min.value"]
    assert isinstance(unread, ScenarioError) and "closed at the start" in str(closed)
    assert fallen["status"] == "collapsed" and "film collapsed at t =" in fallen["message"]
    assert len(by_itself) == 1


def test_more_contacts_than_a_loop_keeps(by_itself, monkeypatch):
    monkeypatch.setattr(batch, "MOST_CONTACTS", 4)
    (row,) = rows("rub", "stator.misalignment", ["1 mrad"], ["contact.touches"], "run.duration=0.27")
    assert len(by_itself) == 1 and row["contact.touches"] > 4


def test_more_samples_than_a_loop_hands_over(by_itself, monkeypatch):
    monkeypatch.setattr(batch, "MOST_OUTPUT", 300)
    for outputs, alone in ((["leakage.mean"], 1), (["h_min.value"], 0)):
        by_itself.clear()
        rows("fms_reference", "rotor.runout", ["10 urad"], outputs, "run.turns=2")
        assert len(by_itself) == alone


def test_runs_of_other_structure_beside_each_other(by_itself):
    found = rows("fms_reference", "film.model", ["linear", "radial", "auto"], ["h_min.value"], "run.turns=3")
    assert [row["status"] for row in found] == ["ok"] * 3
    assert found[0]["h_min.value"] == pytest.approx(found[1]["h_min.value"], rel=1e-3)


def test_a_dataset_of_many_runs():
    scenario, told = read_scenario(SCENARIOS / "fms_reference.toml", ["run.turns=3"]), []
    sets = [{"rotor.runout": value} for value in (1e-5, 2e-5, -1.0, 3e-5)]
    data = sealdyn.simulate_many(scenario, sets, ["leakage.mean"], workers=2, progress=lambda n, m: told.append((n, m)))
    assert list(data["status"].values) == ["ok", "ok", "not possible", "ok"] and told[-1] == (4, 4)
    assert "[rotor] runout" in str(data["message"].values[2]) and np.isnan(data["leakage.mean"][2])
    assert data["leakage.mean"].attrs["units"] == "m^3/s"
    assert {"end.state.stator_z", "end.state.stator_tilt_y_rate"} <= set(data.data_vars)
    again = sealdyn.simulate_many(scenario, sets, ["leakage.mean"], workers=1)
    assert again.equals(data)
    with pytest.raises(ScenarioError, match="runuot"):
        sealdyn.simulate_many(scenario, [{"rotor.runuot": 1.0}])
    with pytest.raises(ScenarioError, match="none"):
        sealdyn.simulate_many(scenario, [])


def test_a_loop_stops_when_it_is_told_to():
    """In the middle of a run that would take seconds."""
    # What is to be compiled is compiled before.
    integrate([LoopedRun(read_scenario(SCENARIOS / "fms_reference.toml", ["run.turns=2"]), ["h_min.value"])])
    run = LoopedRun(read_scenario(SCENARIOS / "fms_reference.toml", ["run.turns=20000"]), ["h_min.value"])
    # Where tests run in the background it may be ignored.
    before = signal.signal(signal.SIGINT, signal.default_int_handler)
    stopped = Timer(0.3, lambda: signal.raise_signal(signal.SIGINT))
    stopped.start()
    try:
        with pytest.raises(KeyboardInterrupt):
            integrate([run, run])
    finally:
        signal.signal(signal.SIGINT, before)
    assert run.outcome is None
