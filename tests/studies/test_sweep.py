"""A sweep's rows are single runs' numbers; broken points are rows; a killed sweep goes on and repeats nothing."""

import itertools
import re

import numpy as np
import pytest
from command import SCENARIOS
from command import sealdyn as program
from in_process import InProcess
from killed import COMMAND, kill_midway, mark_first

import sealdyn
from sealdyn.answers import dotted
from sealdyn.archive import as_dataset
from sealdyn.scenario.errors import ScenarioError
from sealdyn.scenario.reader import parse_scenario
from sealdyn.scenario.settings import axis, with_own_unit
from sealdyn.simulation.result import unit_of
from sealdyn.simulation.simulate import simulate, simulate_in_memory
from sealdyn.studies import sweep as study
from sealdyn.studies._runner import run_study

PATH = SCENARIOS / "fms_reference.toml"
SHORT = ["run.turns=6", 'run.start="steady"']


def sweep(tmp_path, vary, outputs=None, workers=1, overrides=SHORT):
    scenario = parse_scenario(PATH.read_text(), "fms_reference", list(overrides))
    flags = {"vary": vary} | ({"outputs": outputs} if outputs else {})
    return run_study("sweep", scenario, tmp_path / "sweep.h5", flags=flags, workers=workers)


@pytest.mark.parametrize(
    "words, values, unit, first",
    [
        ("rotor.runout=0:1mrad:5", [0, 0.25, 0.5, 0.75, 1], "mrad", "0.0 mrad"),
        ("rotor.runout=0:1 mrad:3", [0, 0.5, 1], "mrad", "0.0 mrad"),
        ("rotor.runout=500 urad:1 mrad:2", [0.5, 1], "mrad", "0.5 mrad"),
        ("shaft.speed=100:10000:3:log", [100, 1000, 10000], "", "100.0"),
        ("film.coning=1 mrad, 2 mrad,3 mrad", [1, 2, 3], "mrad", "1.0 mrad"),
        ("film.coning=1,2,3 mrad", [1, 2, 3], "mrad", "1.0 mrad"),
        ("film.viscosity=0.5 mPa*s:1 mPa*s:2", [0.5, 1], "mPa*s", "0.5 mPa*s"),
        ("film.model=linear,radial", ["linear", "radial"], None, "linear"),
        ("shaft.speed=-1:1:3", [-1, 0, 1], "", "-1.0"),
    ],
)
def test_what_is_varied(words, values, unit, first):
    found = axis(words, "here", "study.sweep.vary")
    assert found["key"] == words.split("=")[0]
    assert found["values"] == (pytest.approx(values) if unit is not None else values)
    assert found["unit"] == unit and found["given"][0] == first


@pytest.mark.parametrize(
    "words", ["rotor.runout", "=1,2", "rotor.runout=", "a=1:2", "a=1:2:x", "a=0:1:3:log", "a=1:2:3:odd"]
)
def test_what_cannot_be_varied(words):
    with pytest.raises(ScenarioError):
        axis(words, "here", "study.sweep.vary")


@pytest.mark.core
def test_rows_equal_single_runs(tmp_path):
    answer = sweep(tmp_path, ["rotor.runout=20,40 urad", "film.coning=2 mrad,3 mrad"])
    assert answer["keys"] == ["rotor.runout", "film.coning"]
    assert [(row["rotor.runout"], row["film.coning"]) for row in answer["rows"]] == [(20, 2), (20, 3), (40, 2), (40, 3)]
    row = answer["rows"][2]
    single = parse_scenario(PATH.read_text(), "one", [*SHORT, 'rotor.runout="40 urad"', 'film.coning="2 mrad"'])
    summary = simulate(single, tmp_path / "one.h5").summary
    assert row["status"] == summary["status"] == "ok"
    # Within the accuracy: the tolerances differ.
    accuracy, clearance = summary["accuracy"], 1e-5
    assert abs(row["h_min.value"] - summary["h_min"]["value"]) < accuracy * clearance
    steady = summary["relative_misalignment"]["steady_max"]
    assert abs(row["relative_misalignment.steady_max"] - steady) < accuracy * clearance / 0.04
    assert row["leakage.mean"] == pytest.approx(summary["leakage"]["mean"], rel=5 * accuracy)
    assert row["stability.verdict"] == "stable"


@pytest.mark.parametrize(
    ("law", "power"),
    [(lambda x: 2e-6 * x**-2.5, -2.5), (lambda x: 1e-6 * (4 + x), None), (lambda x: 1e-6 * (x - 2) ** 2, None),
     (lambda x: 1e-6 + 0 * x, None), (lambda x: -3.0 * x, 1.0)],
)  # fmt: skip
def test_the_power_with_which_an_output_follows_a_key(law, power):
    x = np.linspace(1.0, 4.0, 7)
    found = study.power_law(x[::-1], law(x)[::-1])
    assert found == power if power is None else found == pytest.approx(power, rel=1e-9)


def test_tables_have_every_point_and_the_range_of_every_output(tmp_path):
    answer = sweep(tmp_path, "rotor.runout=20,40,-1 urad", "h_min.value,stability.verdict")
    points, ranges = answer["tables"]
    assert [column["name"] for column in points["columns"]] == ["rotor.runout", *answer["outputs"], "status"]
    assert [row[1] for row in points["rows"]] == [row.get("h_min.value") for row in answer["rows"]]
    (row,) = ranges["rows"]
    films = [value["h_min.value"] for value in answer["rows"] if "h_min.value" in value]
    assert row[1] == min(films) and row[3] == max(films) and ranges["of_rows"][0]["unit"] == "m"


def test_outputs_have_units():
    summary = simulate_in_memory(parse_scenario(PATH.read_text(), "one", SHORT), speeds=True)
    flat = {key: summary for key in dict(dotted(summary))}
    for key in flat:
        for name in key.split("."):
            flat[key] = flat[key][name]
    bare = [key for key, value in flat.items() if isinstance(value, float) and not unit_of(key)]
    pure = ("h_min.of_", "film.max_", "closing.balance", "contact_margin", "closed_form.", "stability.whirl",
            "energy_res", "tolerance", "accuracy", "end.state", "wall_time")  # fmt: skip
    assert [key for key in bare if not key.startswith(pure)] == []
    of_contact = {"wear_rate": "m/s", "force.mean": "N", "impulse": "N s", "max_pressure": "Pa"}
    assert {key: unit_of(f"contact.{key}") for key in of_contact} == of_contact
    assert unit_of("friction.temperature_rise") == "K" and unit_of("contact.touches") == ""


def test_critical_and_resonance_speeds_are_found_where_they_are_asked_for(tmp_path):
    scenario, speeds = parse_scenario(PATH.read_text(), "one", SHORT), {"critical_speed", "resonance_speeds"}
    assert not speeds & set(simulate_in_memory(scenario)["stability"])
    whole = simulate(scenario, tmp_path / "one.h5").summary["stability"]
    assert speeds <= set(whole) and whole["critical_speed"] > 0
    # Runout has no part in it.
    for row in sweep(tmp_path, "rotor.runout=10,20 urad", "stability.critical_speed")["rows"]:
        assert row["stability.critical_speed"] == whole["critical_speed"]
    with pytest.raises(ScenarioError, match=r"nearest 'stability\.critical_speed"):
        sweep(tmp_path, "rotor.runout=10,20 urad", "stability.critical_sped")


def test_an_unknown_key_or_output_is_named(tmp_path):
    for vary, key in (("rotor.runuot=1,2", "runuot"), ([], "vary")):
        with pytest.raises(ScenarioError) as refused:
            sweep(tmp_path, vary)
        assert key in refused.value.key
    with pytest.raises(ScenarioError, match=r"nearest 'h_min\.value"):
        sweep(tmp_path, "rotor.runout=10,20 urad", "h_min.vlaue")


def test_a_sweep_is_a_dataset_over_its_keys(tmp_path):
    """Dimensions and coordinates are the keys, variables the outputs; where a point failed there is no number."""
    vary = ["rotor.runout=10:30 urad:3", "film.clearance=9,-9,10 um", "film.model=linear,radial"]
    outputs = ["h_min.value", "stability.verdict", "contact_margin", "film.clearance"]
    answer = sweep(tmp_path, vary, outputs)
    with sealdyn.open_archive(answer["archive"]) as data:
        assert dict(data.sizes) == {"rotor.runout": 3, "film.clearance": 3, "film.model": 2}
        # The two models are integrated by one method, which is no column then.
        assert set(data.data_vars) == {"h_min.value", "stability.verdict", "contact_margin", "status", "message"}
        assert data["rotor.runout"].values == pytest.approx([10, 20, 30]) and list(data["film.clearance"]) == [
            9,
            -9,
            10,
        ]
        assert list(data["film.model"]) == ["linear", "radial"] and "units" not in data["film.model"].attrs
        units = {name: data[name].attrs.get("units") for name in ("rotor.runout", "h_min.value", "contact_margin")}
        assert units == {"rotor.runout": "urad", "h_min.value": "m", "contact_margin": "1"}
        for row, place in zip(answer["rows"], itertools.product(range(3), range(3), range(2)), strict=True):
            at = {name: data[name][place].item() for name in data.data_vars}
            assert row["rotor.runout"] == data["rotor.runout"][place[0]]
            assert row["film.model"] == data["film.model"][place[2]]
            if place[1] == 1:
                assert np.isnan(at["h_min.value"]) and np.isnan(at["contact_margin"]) and at["stability.verdict"] == ""
                assert at["status"] == "not possible" and at["message"] == row["failed"]
            else:
                assert at == {name: row.get(name, "") for name in at} and at["status"] == "ok"
        assert data.attrs["study"] == "sweep" and data.attrs["scenario"] == PATH.read_text()
        assert as_dataset(answer).equals(data)
        # Any netCDF reader takes it on.
        data.to_netcdf(tmp_path / "data.nc", engine="h5netcdf")


@pytest.mark.slow
def test_a_killed_sweep_goes_on_without_repeating(tmp_path):
    """Killed by SIGKILL half-way: what was finished is kept as it was, the rest is done, the numbers are the same."""
    command = [
        *COMMAND, "sweep", str(PATH), "--vary", "rotor.runout=10:60 urad:8", "--set", "run.turns=10",
        "--out", str(tmp_path / "s.h5"), "--workers", "1", "--no-plot", "--json",
    ]  # fmt: skip
    journal = tmp_path / "s.partial.jsonl"
    assert len(kill_midway(command, journal, 2)[1:]) == 3
    mark_first(journal, "h_min.of_clearance", 0.123456)
    again = program(*command[command.index("study") :], cwd=tmp_path).found
    assert not journal.exists()
    marks = [row["h_min.of_clearance"] == 0.123456 for row in again["rows"]]
    assert sum(marks) == 1
    whole = sweep(tmp_path, "rotor.runout=10:60 urad:8", overrides=["run.turns=10"])
    for a, b, mark in zip(again["rows"], whole["rows"], marks, strict=True):
        assert {k: v for k, v in a.items() if not mark or k != "h_min.of_clearance"}.items() <= b.items()
    assert np.all(np.diff([row["h_min.value"] for row in whole["rows"]]) < 0)


def test_outputs_that_no_run_has_are_refused_before_the_first(tmp_path, monkeypatch):
    from sealdyn.simulation import batch

    monkeypatch.setattr(batch, "integrate", lambda runs: pytest.fail("a run of the sweep"))
    with pytest.raises(ScenarioError) as refused:
        sweep(tmp_path, "rotor.runout=20,40 urad", "h_min.value,leakage,h_min.valeu")
    assert refused.value.key == "study.sweep.outputs" and refused.value.found == "leakage, h_min.valeu"
    assert "leakage.mean" in refused.value.expected and "nearest 'h_min.value'" in refused.value.expected
    with pytest.raises(ScenarioError):
        sealdyn.sweep(PATH, {"rotor.runout": [2e-5]}, ["leakage"], workers=1)
    assert not list(tmp_path.iterdir())


class Failing(InProcess):
    """Runs of which the first `count` cannot be."""

    def __init__(self, count):
        self.count = count

    def map(self, function, points, what="points"):
        return [{"failed": "no"} if k < self.count else {"status": "ok"} for k in range(len(points))]


ROUGH = ["contact.roughness='0.1 um'", "contact.compressive_strength='1 GPa'"]
RUNOUT, SPEED = "rotor.runout=1,333 urad", "shaft.speed=3e3,2e6 rpm"


@pytest.mark.parametrize(
    "overrides, vary, common",
    [
        # At rest one would overlap; of the other, which starts at rest by itself, a response is only doubtful.
        (ROUGH, [RUNOUT], "steady"),
        # One is unstable: there is no response.
        ([], [SPEED], "rest"),
        # One of these here, one of those there.
        ([], [RUNOUT, SPEED], None),
    ],
)
def test_all_points_begin_alike_where_they_can(tmp_path, overrides, vary, common):
    pump = re.search(r"```toml\n(.*?)```", (PATH.parents[1] / "README.md").read_text(), re.DOTALL)[1]
    # Isothermal: of the highest speed there is no warm state.
    pump = re.sub(r"(?m)^heat\..*\n", "", pump)
    scenario = parse_scenario(pump, "pump", ["run.turns=1", "run.accuracy=1e-2", "rotor.runout=1 urad", *overrides])
    flags = {"vary": vary, "outputs": "h_min.value"}
    answer = run_study("sweep", scenario, tmp_path / "sweep.h5", flags=flags, workers=1)
    rows = [row for row in answer["rows"] if "failed" not in row]
    assert len(rows) == len(answer["rows"]) - (common is None)
    starts = {row["model.start"] for row in rows}
    assert starts == ({common} if common else {"rest", "steady"})
    # A difference is a column.
    assert ("model.start" in answer["outputs"]) == (common is None)
    assert any("model.start" in sentence for sentence in answer["verdict"]) == (common is None)


@pytest.mark.parametrize("count, status", [(2, "failed"), (1, "ok")])
def test_a_sweep_of_which_no_run_is_possible_has_failed(count, status):
    scenario = parse_scenario(PATH.read_text(), "fms_reference", list(SHORT))
    answer = study.run(scenario, study.Settings(vary="rotor.runout=20,40 urad"), Failing(count))
    assert answer.numbers.get("status", "ok") == status


def test_changes_as_small_as_the_accuracy_are_not_shown_as_an_answer(tmp_path):
    """A ring that follows to a thousandth of a microradian: a coarse accuracy draws a zigzag of its own errors."""
    vary, rough = "closing.spring_force=100:104 N:3", ["run.turns=1", "run.accuracy=1e-2"]
    path = SCENARIOS / "pump_seal.toml"
    scenario = parse_scenario(path.read_text(), "pump", rough)
    answer = study.run(scenario, study.Settings(vary=vary, outputs=["h_min.value", "friction.power"]), InProcess())
    # Its trend would be that of the errors.
    (note,) = answer.notes
    assert "h_min.value" in note and "friction" not in note
    (_, ranges) = answer.tables
    assert {row[0]: row[-1] for row in ranges.rows}["h_min.value"] is None
    fine = parse_scenario(path.read_text(), "pump", ["run.turns=1", "run.accuracy=1e-6"])
    wide = study.Settings(vary="closing.spring_force=100:200 N:3", outputs=["h_min.value"])
    assert study.run(fine, wide, InProcess()).notes == []


def test_an_axis_tells_the_unit_of_bare_numbers(tmp_path):
    scene = sealdyn.example("fms_reference").scene
    axes = [{"key": key, "unit": ""} for key in ("film.coning", "closing.balance_ratio", "stator.body.length")]
    assert [with_own_unit(scene, a)["si"] for a in axes] == ["rad", "1", "SI"]
