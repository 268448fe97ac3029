"""Points on all cores: order, failures as rows, and a journal that survives a killed study."""

import json
import os
import time
from multiprocessing import active_children
from types import SimpleNamespace

import pytest
from threadpoolctl import threadpool_info

from sealdyn.numerics import parallel
from sealdyn.numerics.parallel import Checkpoint, Together, evaluate, processes, row_of
from sealdyn.scenario.errors import ScenarioError

CALLS = "SEALDYN_TEST_CALLS"


def square(point):
    with open(os.environ[CALLS], "a") as file:
        file.write(f"{point['x']}\n")
    time.sleep(0.01 * (5 - point["x"]))
    if point["x"] == 2:
        raise ValueError("two is not for squaring")
    return {"y": point["x"] ** 2}


def cube(point):
    return {"y": "cube"}


def threads(point):
    import scipy.linalg  # noqa: F401  loads its own BLAS

    return {"threads": [library["num_threads"] for library in threadpool_info()]}


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


@pytest.mark.core
@pytest.mark.parametrize("workers", [1, 2])
def test_rows_come_in_the_order_of_the_points(calls, tmp_path, workers):
    rows = evaluate(square, points(5), Checkpoint(tmp_path / "j", "a"), processes(workers), quiet, "squares")
    assert [row.get("y") for row in rows] == [0, 1, None, 9, 16]
    assert rows[2] == {"failed": "two is not for squaring"}
    assert calls() == ["0", "1", "2", "3", "4"]


@pytest.mark.parametrize("workers", [1, 2])
def test_finished_points_are_not_repeated(calls, tmp_path, workers):
    evaluate(square, points(3), Checkpoint(tmp_path / "j", "a"), processes(workers), quiet, "squares")
    told = []
    say = lambda n, m: told.append((n, m))  # noqa: E731
    rows = evaluate(square, points(5), Checkpoint(tmp_path / "j", "a"), processes(workers), say, "squares")
    assert [row.get("y") for row in rows] == [0, 1, None, 9, 16]
    assert calls() == ["0", "1", "2", "3", "4"]
    assert told[0] == (3, 5) and told[-1] == (5, 5)


def test_a_line_torn_by_the_kill_is_done_again(calls, tmp_path):
    evaluate(square, points(3), Checkpoint(tmp_path / "j", "a"), processes(1), quiet, "squares")
    text = (tmp_path / "j").read_text()
    (tmp_path / "j").write_text(text[:-9])
    rows = evaluate(square, points(3), Checkpoint(tmp_path / "j", "a"), processes(1), quiet, "squares")
    assert [row.get("y") for row in rows] == [0, 1, None]
    assert calls() == ["0", "1", "2", "2"]
    # The mended journal is whole again: every line reads.
    assert len([json.loads(line) for line in (tmp_path / "j").read_text().splitlines()]) == 4


def test_another_study_does_not_use_the_journal(calls, tmp_path):
    evaluate(square, points(2), Checkpoint(tmp_path / "j", "a"), processes(1), quiet, "squares")
    evaluate(square, points(2), Checkpoint(tmp_path / "j", "b"), processes(1), quiet, "squares")
    assert calls() == ["0", "0", "1", "1"]


def test_the_same_point_of_another_question_is_another(calls, tmp_path):
    journal = Checkpoint(tmp_path / "j", "a")
    evaluate(square, points(1), journal, processes(1), quiet, "squares")
    assert evaluate(cube, points(1), journal, processes(1), quiet, "cubes") == [{"y": "cube"}]
    assert calls() == ["0"]


def test_equal_points_are_one(calls, tmp_path):
    twice = [*points(2), *points(2)]
    rows = evaluate(square, twice, Checkpoint(tmp_path / "j", "a"), processes(2), quiet, "squares")
    assert [row["y"] for row in rows] == [0, 1, 0, 1]
    assert calls() == ["0", "1"]


def test_workers_keep_to_one_thread(tmp_path):
    crew = processes(2)
    for row in evaluate(threads, points(2), Checkpoint(tmp_path / "j", "a"), crew, quiet, "threads"):
        assert set(row["threads"]) == {1}


def test_no_journal_before_the_first_point(tmp_path):
    journal = Checkpoint(tmp_path / "deep" / "j", "a")
    assert not journal.path.parent.exists()
    journal.add("x", {"y": 1})
    assert Checkpoint(journal.path, "a").rows == {"x": {"y": 1}}


# --- points that cost less together ---------------------------------------------------------------------


# Seconds that points took, in each process: on a busy machine those of a clock are more.
SPENT = [0.0]


def squares(points):
    with open(os.environ[CALLS], "a") as file:
        file.write(f"{len(points)}\n")
    SPENT[0] += 0.01 * len(points)
    if len(points) > 1 and any(point["x"] == 40 for point in points):
        raise RuntimeError("spoilt for all")
    return [ValueError("not for squaring") if point["x"] == 2 else {"y": point["x"] ** 2} for point in points]


@pytest.mark.parametrize("workers", [1, 2])
def test_points_that_cost_less_together(calls, tmp_path, monkeypatch, workers):
    """In pieces that take about as long as they may, the last ones small; one that fails fails alone."""
    monkeypatch.setattr(parallel, "PIECE", 0.08)
    monkeypatch.setattr(parallel, "time", SimpleNamespace(perf_counter=lambda: SPENT[0]))
    told = []
    rows = evaluate(Together(squares), points(60), Checkpoint(tmp_path / "j", "a"), processes(workers),
                    lambda n, m: told.append((n, m)), "squares")  # fmt: skip
    expected = [{"y": x**2} for x in range(60)]
    expected[2] = {"failed": "not for squaring"}
    assert rows == expected
    sizes = sorted(map(int, calls()))
    assert 4 <= sizes[-1] <= 20 and sizes[0] == 1 and len(sizes) < 40
    assert [n for n, _ in told] == list(range(61))


def test_a_row_is_the_same_alone_and_together(calls):
    assert Together(squares)({"x": 3}) == {"y": 9}
    with pytest.raises(ValueError, match="not for squaring"):
        Together(squares)({"x": 2})
    assert parallel.content_keys(Together(squares), points(1)) != parallel.content_keys(Together(cube), points(1))


def test_a_row_that_failed_tells_why_in_the_words_of_a_user():
    def refuses(_):
        raise ScenarioError("seal", "rotor.runout", "a film closed at the start", "a smaller one")

    def breaks(_):
        raise ZeroDivisionError("division by zero")

    assert row_of(refuses, {})[0]["failed"].startswith("seal: [rotor] runout: found a film closed")
    assert row_of(breaks, {})[0]["failed"] == "ZeroDivisionError: division by zero"


def long_for_the_second(point):
    time.sleep(60.0 if point["x"] == 1 else 0.0)
    return {"y": 0}


def test_nobody_waits_for_what_is_being_done_when_interrupted(tmp_path):
    """What is finished is kept, and the processes are gone."""

    def interrupt(done, count):
        if done == 1:
            raise KeyboardInterrupt

    begun, journal = time.monotonic(), Checkpoint(tmp_path / "j", "a")
    with pytest.raises(KeyboardInterrupt):
        evaluate(long_for_the_second, points(4), journal, processes(2), interrupt, "naps")
    assert time.monotonic() - begun < 20.0 and not active_children()
    assert len(Checkpoint(tmp_path / "j", "a").rows) == 1
