"""A folder of results: what is one point and what another, who may use a row, what is no row."""

import dataclasses
import json
import os
from concurrent.futures import ThreadPoolExecutor
from functools import partial
from pathlib import Path

import numpy as np
import pytest
from command import SCENARIOS

import sealdyn
from sealdyn.numerics import parallel
from sealdyn.numerics.parallel import Checkpoint, Results, content_keys, evaluate, processes
from sealdyn.scenario.reader import parse_scenario
from sealdyn.simulation import batch
from sealdyn.studies import sweep
from sealdyn.studies._runner import StudyContext, run_study

PATH = SCENARIOS / "fms_reference.toml"
SHORT = ["run.turns=2", 'run.start="steady"', "film.model=linear"]
CALLS = []


def counted(scale, point):
    CALLS.append(point["x"])
    return {"y": scale * point["x"], "many": (1, 2)}


def failing(error, point):
    if point["x"] == 1:
        raise error("not today")
    return {"y": point["x"]}


def quiet(done, count):
    pass


def key(function, point=None):
    (found,) = content_keys(function, [point or {"x": 1}])
    return found


def scenario(*overrides, text=None, name="fms_reference"):
    return parse_scenario(text or PATH.read_text(), name, [*SHORT, *overrides])


@pytest.fixture
def ran(monkeypatch):
    """Points that were evaluated: what they set."""
    found, whole = [], batch.LoopedRun

    def noted(scenario, outputs):
        found.append(scenario.overrides[-1])
        return whole(scenario, outputs)

    monkeypatch.setattr(batch, "LoopedRun", noted)
    return found


def swept(out, vary, folder, what=None, **flags):
    flags = {"vary": vary, "outputs": "h_min.value", **flags}
    return run_study("sweep", what or scenario(), out, flags=flags, workers=1, results=folder)


def test_finished_points_are_kept_for_others(tmp_path):
    CALLS.clear()
    for count in (2, 4):
        points = [{"x": x} for x in range(count)]
        rows = evaluate(partial(counted, 3), points, Results(tmp_path), processes(1), quiet, "")
        # A row is the same whether it was evaluated or read.
        assert rows == [{"y": 3 * x, "many": [1, 2]} for x in range(count)]
    assert CALLS == [0, 1, 2, 3] and len(list(tmp_path.iterdir())) == 4
    evaluate(partial(counted, 4), [{"x": 0}], Results(tmp_path), processes(1), quiet, "")
    assert CALLS == [0, 1, 2, 3, 0]


@pytest.mark.core
def test_what_a_point_is():
    """Whatever decides the answer makes another point; where the scenario came from does not."""
    own = partial(batch.run_many, scenario())
    assert key(own) == key(partial(batch.run_many, scenario(text="# Why?\n" + PATH.read_text(), name="other")))
    written_otherwise = PATH.read_text().replace('"10 um"', '"0.01 mm"')
    assert written_otherwise != PATH.read_text()
    assert key(own) == key(partial(batch.run_many, scenario(text=written_otherwise)))
    assert key(own) == key(partial(batch.run_many, scenario("study.sweep.vary=rotor.runout=1,2")))
    assert key(partial(counted, 1), {"x": 1, "y": 2}) == key(partial(counted, 1), {"y": 2, "x": 1})
    assert key(partial(counted, np.arange(3.0))) == key(partial(counted, np.arange(3.0)))
    others = [
        partial(counted, np.arange(3.0)),
        partial(counted, np.arange(3.0)[:, None]),
        partial(counted, np.arange(3)),
        partial(batch.run_many, scenario("film.clearance=9 um")),
        partial(batch.run_many, scenario("run.accuracy=1e-7")),
        partial(batch.run_many, scenario("run.solver=bdf")),
        partial(batch.run_many, scenario('rotor.runout="20 um TIR"')),
        partial(batch.run_many, scenario().scene),
        partial(sweep.run, scenario()),
        batch.run_many,
    ]
    keys = [key(own), *map(key, others), key(own, {"x": 2}), key(own, {"x": 1.5})]
    assert len(set(keys)) == len(keys)


def test_every_field_of_a_scenario_is_told_from_others_or_tells_where_it_came_from():
    whence = {"study", "text", "bare", "gauge", "application", "name", "path", "overrides", "question", "foreign_start",
              "read"}  # fmt: skip
    assert {f.name for f in dataclasses.fields(sealdyn.scenario.reader.Scenario) if not f.compare} == whence


def test_an_archive_to_start_from_counts_by_its_content(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    point, found = {"set": {"run.start": "a.h5"}}, set()
    for content in (None, b"one", b"two"):
        if content:
            Path("a.h5").write_bytes(content)
        found.add(key(counted, point))
    assert len(found) == 3
    Path("b.h5").write_bytes(b"two")
    assert key(counted, {"set": {"run.start": "b.h5"}}) in found


def test_what_is_no_data_is_refused():
    for bound in (object(), [1].append):
        with pytest.raises(TypeError):
            key(partial(counted, bound))


def test_a_row_of_another_version_is_not_used(tmp_path, monkeypatch):
    CALLS.clear()
    for version in ("1", "2", "2"):
        monkeypatch.setattr(parallel, "__version__", version)
        evaluate(partial(counted, 3), [{"x": 1}], Results(tmp_path), processes(1), quiet, "")
    assert CALLS == [1, 1]


@pytest.mark.parametrize(
    "content", [b"", b'{"key": "', b"[1, 2]", b"\xff\xfe", b'{"key": "another", "row": {"y": 9}}', b'{"row": {"y": 9}}']
)
def test_what_is_no_whole_row_is_done_again(tmp_path, content):
    function, point = partial(counted, 3), {"x": 1}
    torn = tmp_path / f"{key(function, point)}.json"
    torn.write_bytes(content)
    (tmp_path / "notes.txt").write_text("mine")
    (tmp_path / f"{key(function, point)}-0.new").write_text('{"key"')
    rows = evaluate(function, [point], Results(tmp_path), processes(1), quiet, "")
    assert rows == [{"y": 3, "many": [1, 2]}] and json.loads(torn.read_text())["row"] == rows[0]
    assert len(list(tmp_path.iterdir())) == 3


def test_many_may_write_the_same_row_at_once(tmp_path):
    """Readers beside them see the whole row at any time."""
    store, row = Results(tmp_path), {"y": list(range(5000))}
    store.add("a" * 64, row)

    def write_or_read(k):
        return (store.add("a" * 64, row) or row) if k % 2 else store.get("a" * 64)

    with ThreadPoolExecutor(8) as pool:
        assert all(found == row for found in pool.map(write_or_read, range(200)))
    assert os.listdir(tmp_path) == [f"{'a' * 64}.json"]


def test_a_finer_sweep_reuses_the_points_it_shares(tmp_path, ran):
    coarse = swept(tmp_path / "a.h5", "rotor.runout=10:30 urad:3", tmp_path / "kept")
    assert len(ran) == 3 and not list(tmp_path.glob("*.partial.jsonl"))
    fine = swept(tmp_path / "b.h5", "rotor.runout=10:30 urad:5", tmp_path / "kept")
    assert ran[3:] == ["rotor.runout=15.0 urad", "rotor.runout=25.0 urad"]
    assert fine["rows"][::2] == coarse["rows"] and len(list((tmp_path / "kept").iterdir())) == 5
    # Another scene shares nothing.
    swept(tmp_path / "c.h5", "rotor.runout=10:30 urad:3", tmp_path / "kept", scenario("film.clearance=9 um"))
    assert len(ran) == 8


def test_a_failed_point_is_kept_with_its_reason(tmp_path):
    for _ in range(2):
        answer = swept(tmp_path / "a.h5", "film.coning=3,-9 mrad", tmp_path / "kept")
        assert "[film] coning" in answer["rows"][1]["failed"]
        # The verdict says so too, once.
        assert answer["message"].count(answer["rows"][1]["failed"]) == 1
    assert len(list((tmp_path / "kept").iterdir())) == 2


@pytest.mark.parametrize("error", [OSError, MemoryError, ImportError])
@pytest.mark.parametrize("workers", [1, 2])
def test_what_the_machine_could_not_do_is_tried_again(tmp_path, error, workers):
    function = partial(failing, error)
    for _ in range(2):
        rows = evaluate(function, [{"x": 1}, {"x": 2}], Results(tmp_path), processes(workers), quiet, "")
        assert rows == [{"failed": f"{error.__name__}: not today"}, {"y": 2}]
        assert len(list(tmp_path.iterdir())) == 1


def test_with_and_without_a_folder_the_rows_are_equal(tmp_path):
    vary = "rotor.runout=10,20 urad"
    kept = swept(tmp_path / "a.h5", vary, tmp_path / "kept")
    assert swept(tmp_path / "b.h5", vary, None)["rows"] == kept["rows"]
    assert swept(tmp_path / "c.h5", vary, tmp_path / "kept")["rows"] == kept["rows"]


def test_points_that_measure_time_are_done_here_and_not_for_others(tmp_path):
    def elsewhere(function, todo, what):
        raise AssertionError("on another machine")

    journal = Checkpoint(tmp_path / "j", "a")
    tools = StudyContext(journal, elsewhere, quiet, Results(tmp_path / "kept"))
    assert tools.alone().map(partial(counted, 3), [{"x": 1}]) == [{"y": 3, "many": [1, 2]}]
    assert len(journal.rows) == 1 and not (tmp_path / "kept").exists()
