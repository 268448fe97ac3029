"""The names of the package: runs with and without an archive, single numbers, tables, figures."""

import inspect
import io
import math
from dataclasses import replace

import numpy as np
import pytest
import xarray
from command import SCENARIOS

import sealdyn

# Tilts and turns, in a moment.
TILTED, SHORT = SCENARIOS / "fms_reference.toml", {"run.turns": 4}
CHARTS = ("overview", "orbit", "film", "spectrum", "poincare")


@pytest.mark.core
def test_all_names_are_listed():
    assert set(sealdyn.__all__) < set(dir(sealdyn)) and "__version__" in dir(sealdyn)
    with pytest.raises(AttributeError, match="no attribute 'simulat'"):
        sealdyn.simulat  # noqa: B018


def test_all_arguments_and_answers_have_types():
    functions = [function for name in sealdyn.__all__ if inspect.isfunction(function := getattr(sealdyn, name))]
    methods = ("from_dict", "to_dict", "to_toml", "with_", "resolved", "unused")
    functions += [getattr(sealdyn.Scenario, name) for name in methods]
    assert len(functions) > 12
    for function in functions:
        signature = inspect.signature(function)
        assert signature.return_annotation is not inspect.Signature.empty, function
        for argument in signature.parameters.values():
            assert argument.annotation is not inspect.Parameter.empty or argument.name == "self", (function, argument)


@pytest.fixture(scope="module")
def results(tmp_path_factory):
    """The same run in memory and in an archive."""
    folder = tmp_path_factory.mktemp("runs")
    with pytest.MonkeyPatch.context() as here:
        here.chdir(folder)
        here.setattr("tempfile.tempdir", str(folder))
        in_memory = sealdyn.run(TILTED, SHORT)
        assert in_memory.data.attrs["status"] == "ok" and in_memory.plot.poincare()
        assert not list(folder.iterdir())
    return in_memory, sealdyn.run(sealdyn.read_scenario(TILTED), ["run.turns=4"], folder / "mine.h5")


def test_a_run_in_memory_is_that_of_an_archive(results):
    in_memory, kept = results
    assert in_memory.archive is None and in_memory.summary["archive"] is None
    assert kept.archive.name == "mine.h5" and kept.archive.is_file()
    assert in_memory.status == kept.status == "ok" and in_memory.message == kept.message
    own = ("archive", "wall_time")
    assert all(value == kept.summary[name] for name, value in in_memory.summary.items() if name not in own)
    xarray.testing.assert_identical(in_memory.data.drop_attrs(), kept.data.drop_attrs())
    assert in_memory.data.h_min.attrs["units"] == "m" and in_memory.data.h_min.size == 4 * 64 + 1
    assert isinstance(in_memory.data.h_min.data, np.ndarray)


def test_an_archive_is_run_again(results, tmp_path):
    """Its own overrides are kept, more are taken; of a study the scenario is the one that it was asked about."""
    kept = results[1]
    again, more = sealdyn.run(kept.archive), sealdyn.run(kept.archive, {"rotor.runout": "50 urad"})
    xarray.testing.assert_identical(again.data.drop_attrs(), kept.data.drop_attrs())
    assert more.data.h_min.size == kept.data.h_min.size and more.data.h_min.min() < kept.data.h_min.min()
    asked = sealdyn.read_scenario(TILTED, ["film.clearance=9 um"])
    study = sealdyn.study("equilibrium", asked, out=tmp_path / "e.h5", workers=1, points=5)
    assert sealdyn.read_scenario(study.archive) == asked != sealdyn.read_scenario(TILTED)
    with pytest.raises(sealdyn.ArchiveError, match="no such file"):
        sealdyn.run(tmp_path / "nothing.h5")


def test_an_unknown_rule_is_refused_however_a_scenario_is_made():
    tables = sealdyn.read_scenario(TILTED).to_dict()
    tables["application"] = {"bore": "50 mm", "acknowledge": {"leakage": "drained"}}
    scenario = sealdyn.Scenario.from_dict(tables)
    with pytest.raises(sealdyn.ScenarioError) as refused:
        scenario.with_({"application.acknowledge": {"leakege": "drained"}})
    assert refused.value.key == "application.acknowledge.leakege" and "nearest 'leakage'" in str(refused.value)
    tables["application"]["acknowledge"] = {"runnout": "new shaft"}
    for make in (lambda: sealdyn.Scenario.from_dict(tables), lambda: sealdyn.read_scenario(
            TILTED, ['application.acknowledge.runnout="new"'])):  # fmt: skip
        with pytest.raises(sealdyn.ScenarioError, match=r"\[application.acknowledge\] runnout: found an unknown"):
            make()
    # What the seal is for stays where other values are set.
    assert scenario.with_({"rotor.runout": 1e-5}).application == scenario.application


@pytest.mark.parametrize("chart", CHARTS)
def test_figures_of_a_run_are_written_as_lines_or_pixels(results, chart):
    figure = getattr(results[0].plot, chart)()
    lines = [len(ax.lines) + len(ax.collections) for ax in figure.axes]
    assert sum(lines) > 0
    forms = {"svg": b"<?xml", "png": b"\x89PNG", "pdf": b"%PDF"}
    # Of one chart in all forms: how a figure is written does not depend on what is on it.
    for form, begin in list(forms.items())[: None if chart == "overview" else 1]:
        figure.savefig(file := io.BytesIO(), format=form)
        assert file.getvalue().startswith(begin)


def test_a_run_that_fails_is_a_result_and_one_that_cannot_be_is_an_error():
    collapsed = sealdyn.run(TILTED, {"film.coning": "-0.5 mrad", **SHORT})
    assert collapsed.status == "collapsed" and collapsed.data.attrs["status"] == "collapsed"
    # Refused by the scenario, and by the scene once it is made ready.
    for values in ({"film.clerance": 1}, {"rotor.runout": "1 mrad", "stator.misalignment": "1 mrad"}):
        with pytest.raises(sealdyn.ScenarioError) as refused:
            sealdyn.run(TILTED, values)
        assert str(refused.value).startswith("fms_reference") and "\n" not in str(refused.value)


# --- numbers -------------------------------------------------------------------------------------------


@pytest.mark.core
def test_numbers_are_those_of_the_run(results):
    keys = ["h_min.value", "leakage.mean", "stability.verdict"]
    found = sealdyn.evaluate(TILTED, {"film.clearance": "10 um", **SHORT}, keys)
    summary = results[0].summary
    assert list(found) == keys and found["stability.verdict"] == summary["stability"]["verdict"]
    assert found["h_min.value"] == pytest.approx(summary["h_min"]["value"], rel=1e-6)
    assert found["leakage.mean"] == pytest.approx(summary["leakage"]["mean"], rel=1e-6)


def test_numbers_of_a_run_that_collapses_are_not_handed_out_unasked():
    values = {"film.coning": "-0.5 mrad", **SHORT}
    with pytest.raises(sealdyn.RunEnded) as ended:
        sealdyn.evaluate(TILTED, values, ["h_min.value"])
    assert ended.value.status == "collapsed" and "collapsed" in str(ended.value)
    found = sealdyn.evaluate(TILTED, values, ["status", "relative_misalignment.steady_max"])
    assert found["status"] == "collapsed" and math.isnan(found["relative_misalignment.steady_max"])


@pytest.mark.parametrize(
    "values, outputs, told",
    [
        ({"film.clerance": 1e-5}, "h_min.value", "nearest 'clearance'"),
        ({"rotor.runout": "1 mrad", "stator.misalignment": "1 mrad"}, "h_min.value", "fms_reference"),
        (SHORT, "h_min.valeu", "nearest 'h_min.value'"),
    ],
)
def test_what_cannot_be_evaluated_is_told_in_one_line(values, outputs, told):
    with pytest.raises(sealdyn.ScenarioError) as refused:
        sealdyn.evaluate(TILTED, values, outputs)
    assert told in str(refused.value) and "\n" not in str(refused.value)


@pytest.mark.parametrize("output", ["leakage.maen", "stability.critical_sped", "h_min"])
def test_outputs_are_looked_for_before_the_run(output, monkeypatch):
    monkeypatch.setattr("sealdyn.simulation.run.run_many", lambda *_: pytest.fail("the run has begun"))
    with pytest.raises(sealdyn.ScenarioError, match=output):
        sealdyn.evaluate(TILTED, SHORT, output)


def test_a_sweep_is_a_table_of_its_keys():
    scenario, outputs = sealdyn.read_scenario(TILTED).with_(SHORT), ["h_min.value", "stability.verdict"]
    grid = {"film.clearance": ["10 kg", "10 um"], "rotor.runout": np.array([1e-5, 2e-5, 3e-5])}
    table = sealdyn.sweep(scenario, grid, outputs, workers=1)
    assert table.index.names == list(grid) and list(table.columns) == [*outputs, "status", "message"]
    assert table.attrs["units"] == {"h_min.value": "m"}
    good, bad = table.loc["10 um"], table.loc["10 kg"]
    assert (good["status"] == "ok").all() and good["h_min.value"].is_monotonic_decreasing
    assert good.loc[2e-5, "h_min.value"] == sealdyn.evaluate(scenario, {"rotor.runout": 2e-5}, outputs)["h_min.value"]
    assert (bad["status"] == "not possible").all() and bad["h_min.value"].isna().all()
    assert bad["message"].str.contains("a length").all()


def test_a_sweep_of_one_key_has_its_values_as_index():
    scenario = sealdyn.read_scenario(TILTED).with_(SHORT)
    table = sealdyn.sweep(scenario, {"rotor.runout": ["10 urad", "20 urad"]}, "h_min.value", workers=1)
    assert list(table.index) == ["10 urad", "20 urad"] and table.index.name == "rotor.runout"
    with pytest.raises(sealdyn.ScenarioError, match="no values"):
        sealdyn.sweep(scenario, {"rotor.runout": []})


def test_another_scene_beside_the_text_is_refused():
    """Its archive would hold the text's seal, not the one that ran."""
    scenario = sealdyn.read_scenario(TILTED)
    scene = replace(scenario.scene, film=replace(scenario.scene.film, clearance=8e-6))
    with pytest.raises(sealdyn.ScenarioError) as refused:
        replace(scenario, scene=scene)
    assert refused.value.key == "scene" and "with_" in refused.value.expected
    with pytest.raises(sealdyn.ScenarioError):
        replace(scenario, run=replace(scenario.run, accuracy=1e-3))
    assert replace(scenario, name="other").with_(film__clearance=8e-6).scene == scene
