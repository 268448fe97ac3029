"""Points on all cores: order, failures as rows, and a journal that survives a killed study."""

import json
import os
import time

import pytest

from sealdyn.numerics.parallel import Checkpoint, evaluate

CALLS = "SEALDYN_TEST_CALLS"


def square(point):
    with open(os.environ[CALLS], "a") as file:
        file.write(f"{point['x']}\n")
    time.sleep(0.01 * (5 - point["x"]))
    if point["x"] == 2:
        raise ValueError("two is not for squaring")
    return {"y": point["x"] ** 2}


@pytest.fixture
def calls(tmp_path, monkeypatch):
    path = tmp_path / "calls"
    path.touch()
    monkeypatch.setenv(CALLS, str(path))
    return lambda: sorted(path.read_text().split())


def points(count):
    return [{"x": x} for x in range(count)]


def quiet(done, count):
    pass


@pytest.mark.parametrize("workers", [1, 2])
def test_rows_come_in_the_order_of_the_points(calls, tmp_path, workers):
    rows = evaluate(square, points(5), Checkpoint(tmp_path / "j", "a"), workers, quiet, "squares")
    assert [row.get("y") for row in rows] == [0, 1, None, 9, 16]
    assert rows[2] == {"failed": "ValueError: two is not for squaring"}
    assert calls() == ["0", "1", "2", "3", "4"]


@pytest.mark.parametrize("workers", [1, 2])
def test_finished_points_are_not_repeated(calls, tmp_path, workers):
    evaluate(square, points(3), Checkpoint(tmp_path / "j", "a"), workers, quiet, "squares")
    told = []
    rows = evaluate(
        square, points(5), Checkpoint(tmp_path / "j", "a"), workers, lambda n, m: told.append((n, m)), "squares"
    )
    assert [row.get("y") for row in rows] == [0, 1, None, 9, 16]
    assert calls() == ["0", "1", "2", "3", "4"]
    assert told[0] == (3, 5) and told[-1] == (5, 5)


def test_a_line_torn_by_the_kill_is_done_again(calls, tmp_path):
    evaluate(square, points(3), Checkpoint(tmp_path / "j", "a"), 1, quiet, "squares")
    text = (tmp_path / "j").read_text()
    (tmp_path / "j").write_text(text[:-9])
    rows = evaluate(square, points(3), Checkpoint(tmp_path / "j", "a"), 1, quiet, "squares")
    assert [row.get("y") for row in rows] == [0, 1, None]
    assert calls() == ["0", "1", "2", "2"]
    # The mended journal is whole again: every line reads.
    assert len([json.loads(line) for line in (tmp_path / "j").read_text().splitlines()]) == 4


def test_another_study_does_not_use_the_journal(calls, tmp_path):
    evaluate(square, points(2), Checkpoint(tmp_path / "j", "a"), 1, quiet, "squares")
    evaluate(square, points(2), Checkpoint(tmp_path / "j", "b"), 1, quiet, "squares")
    assert calls() == ["0", "0", "1", "1"]


def test_the_same_point_of_another_question_is_another(calls, tmp_path):
    journal = Checkpoint(tmp_path / "j", "a")
    evaluate(square, points(1), journal, 1, quiet, "squares")
    evaluate(square, points(1), journal, 1, quiet, "cubes")
    assert calls() == ["0", "0"]


def test_no_journal_before_the_first_point(tmp_path):
    journal = Checkpoint(tmp_path / "deep" / "j", "a")
    assert not journal.path.parent.exists()
    journal.add("x", {"y": 1})
    assert Checkpoint(journal.path, "a").rows == {"x": {"y": 1}}
