"""The archive: what goes in comes out, whatever instant the writer dies at, and a stranger can read it."""

import json
import random
import re
import subprocess
import sys
import textwrap
import threading
import time

import h5py
import numpy as np
import pytest

from sealdyn import archive
from sealdyn.archive import ArchiveError, ArchiveWriter, Series, column, last_state, open_archive, read_info
from sealdyn.archive import run as archive_run

SCENARIO = '# Does it hold?  Ω = 1000\n[shaft]\nspeed = "1000 rad/s"\n'
SERIES = {"h_min": Series("m", "smallest film thickness"), "count": Series("1", "row number")}
META = {"version": "0.1.0", "overrides": [], "libraries": {"numpy": "2"}}


def writer(path, **options):
    given = {"scenario_text": SCENARIO, "resolved": {"film": {"clearance": 1e-5}}, "meta": META}
    return ArchiveWriter(path, **(given | {"series": SERIES} | options))


def rows(start, stop):
    n = np.arange(start, stop)
    return {"time": n * 1e-3, "h_min": 1e-5 / (1 + n), "count": n}


def assert_rows(path, stop):
    for name, expected in rows(0, stop).items():
        np.testing.assert_array_equal(column(path, name), expected.astype(float))


def test_what_was_looked_at_once_is_looked_at_again_when_it_has_changed(tmp_path):
    run = writer(tmp_path / "run.h5")
    run.append(rows(0, 3))
    run.finish("ok", "done", {})
    assert_rows(tmp_path / "run.h5", 3)
    with h5py.File(tmp_path / "run.h5", "r+") as file:
        file.attrs["message"] = "well done"
    with pytest.raises(ArchiveError, match="altered"):
        column(tmp_path / "run.h5", "h_min")


@pytest.mark.parametrize("expected", [0, 299, 310, 5000])
@pytest.mark.parametrize("in_place", [1 << 28, 100])
def test_whatever_room_was_kept_a_finished_file_has_its_rows_alone(tmp_path, monkeypatch, expected, in_place):
    """Shortened where it stands or written anew: no row of room is left, nor anything of a run that goes on."""
    for module in ("run_writer", "run"):
        monkeypatch.setattr(f"sealdyn.archive.{module}.MOST_IN_PLACE", in_place)
    run = writer(tmp_path / "run.h5", expected_rows=expected)
    run.append(rows(0, 300))
    run.finish("ok", "done", {})
    assert_rows(tmp_path / "run.h5", 300)
    with h5py.File(tmp_path / "run.h5") as file:
        assert {file[name].shape for name in ("time", *SERIES)} == {(300,)}
        assert (file["h_min"].chunks is None) == (in_place < 300)
        assert "record" not in file["restart"] and file["h_min"].dims[0][0].name == "/time"
    assert list(tmp_path.iterdir()) == [tmp_path / "run.h5"]


@pytest.mark.core
def test_what_goes_in_comes_out_to_the_last_bit(tmp_path):
    path = tmp_path / "run.h5"
    run = writer(path)
    for start in range(0, 300, 7):
        run.append(rows(start, min(start + 7, 300)), {"y": np.array([0.1, 1 / 3]), "turn": np.int64(start)})
    run.events([{"kind": "minimum", "time": 0.25, "value": 3e-6, "text": "smallest film µ", "theta": 0.5}])
    assert run.finish("ok", "done", {"h_min": {"value": 3e-6}, "none": None}) == path

    info = read_info(path)
    assert (info["status"], info["message"], info["rows"]) == ("ok", "done", 300)
    assert info["scenario"] == SCENARIO and info["resolved"] == {"film": {"clearance": 1e-5}}
    assert info["summary"] == {"h_min": {"value": 3e-6}, "none": None}
    assert {name: info[name] for name in META} == META
    assert info["series"]["h_min"] == SERIES["h_min"]
    (event,) = info["events"]
    assert event == {"kind": "minimum", "time": 0.25, "value": 3e-6, "text": "smallest film µ", "theta": 0.5}
    assert_rows(path, 300)
    np.testing.assert_array_equal(column(path, "count", slice(-3, None)), [297, 298, 299])
    assert last_state(path)["turn"] == 294 and last_state(path)["y"].tolist() == [0.1, 1 / 3]
    assert [file.name for file in tmp_path.iterdir()] == ["run.h5"]


def test_a_stranger_reads_it_with_h5py_and_with_xarray(tmp_path):
    xarray = pytest.importorskip("xarray")
    path = tmp_path / "run.h5"
    run = writer(path)
    run.append(rows(0, 50))
    run.events([{"kind": "touch", "time": 0.01, "value": 1.0, "text": "a"}])
    run.finish("collapsed", "closed", {})
    with h5py.File(path) as file:
        assert file["h_min"].dtype == np.float64 and file["h_min"].shape == (50,)
        assert file["h_min"].attrs["units"] == "m"
        assert file["h_min"].dims[0][0] == file["time"]
        assert file.attrs["status"] == "collapsed" and file.attrs["program"] == "sealdyn"
    with xarray.open_dataset(path, engine="h5netcdf") as dataset:
        assert dataset.h_min.dims == ("time",) and dataset.h_min.attrs["units"] == "m"
        assert dataset.time.dtype == np.float64 and dataset.time.attrs["units"] == "s"
    with xarray.open_dataset(path, engine="h5netcdf", group="events") as events:
        assert events.kind.values.tolist() == ["touch"]


def test_a_running_archive_opens_with_its_rows_and_nothing_else(tmp_path):
    path = tmp_path / "run.h5"
    run = writer(path, interval=0.0)
    run.append(rows(0, 30))
    # Asked for by its final name, from the file that is still being written.
    with open_archive(path) as dataset:
        assert dataset.sizes == {"time": 30} and dataset.attrs["status"] == "running"
        assert dataset.attrs["scenario"] == SCENARIO
        assert json.loads(dataset.attrs["resolved"]) == {"film": {"clearance": 1e-5}}
        np.testing.assert_array_equal(dataset["count"].values, np.arange(30.0))
    run.close()


def test_rows_wait_in_memory_until_the_interval_or_the_row_limit(tmp_path):
    path = tmp_path / "run.h5"
    run = writer(path, interval=1e9, buffer_rows=100)
    run.append(rows(0, 99))
    assert not list(tmp_path.iterdir())
    run.append(rows(99, 101))
    assert read_info(path)["rows"] == 101
    # So do those that come later.
    run.append(rows(101, 200))
    assert read_info(path)["rows"] == 101
    run.append(rows(200, 201))
    assert read_info(path)["rows"] == 201
    run.close()


def test_what_an_earlier_run_left_is_not_that_of_a_new_one(tmp_path):
    path = tmp_path / "run.h5"
    run = writer(path)
    run.append(rows(0, 10))
    run.close()
    writer(path)
    # Killed before its first rows were due.
    assert writer(path, resume=True).rows == 0


@pytest.mark.parametrize("final", ["interrupted", None])
def test_a_continued_run_equals_an_unbroken_one(tmp_path, final):
    path = tmp_path / "run.h5"
    run = writer(path)
    run.append(rows(0, 5000), {"row": 5000})
    run.events([{"kind": "first", "time": 1.0}])
    if final == "interrupted":
        run.finish("interrupted", "stopped", {})
    else:
        run.close()
    created = read_info(path)["created"]

    run = writer(path, resume=True)
    assert run.rows == 5000 and run.state == {"row": 5000}
    run.events([{"kind": "second", "time": 2.0}])
    run.append(rows(5000, 20000), {"row": 20000})
    run.finish("ok", "done", {})
    assert_rows(path, 20000)
    info = read_info(path)
    assert [event["kind"] for event in info["events"]] == ["first", "second"]
    assert info["created"] == created and info["restart"] == {"row": 20000}


def test_with_nothing_to_resume_it_starts_anew(tmp_path):
    path = tmp_path / "run.h5"
    writer(path).finish("ok", "", {})
    run = writer(path, resume=True)
    assert run.rows == 0 and run.state == {}
    run.close()


def test_resuming_other_series_is_refused(tmp_path):
    path = tmp_path / "run.h5"
    writer(path).close()
    with pytest.raises(ArchiveError):
        writer(path, resume=True, series={"h_min": SERIES["h_min"]})


def test_a_complete_archive_is_replaced_only_by_a_complete_one(tmp_path):
    path = tmp_path / "run.h5"
    run = writer(path)
    run.append(rows(0, 10))
    run.finish("ok", "first", {})
    run = writer(path)
    run.append(rows(0, 20))
    assert read_info(path)["message"] == "first"
    assert run.finish("interrupted", "stopped", {}) == archive.partial_path(path)
    assert read_info(path)["message"] == "first"
    assert read_info(archive.partial_path(path))["status"] == "interrupted"
    run = writer(path, resume=True)
    assert run.rows == 20
    run.finish("ok", "second", {})
    assert read_info(path)["message"] == "second" and read_info(path)["rows"] == 20


def test_room_grows_for_rows_events_and_state(tmp_path, monkeypatch):
    monkeypatch.setattr(archive.run_writer, "SMALLEST_ROOM", 1)
    monkeypatch.setattr(archive.run_writer, "SLOT", 128)
    monkeypatch.setattr(archive.run_writer, "LOG", 16)
    path = tmp_path / "run.h5"
    run = writer(path, interval=0.0)
    for n in range(60):
        run.events([{"kind": f"event {n}", "time": float(n)}])
        run.append(rows(n, n + 1), {"row": n + 1, "much": "x" * 50 * n})
        info = read_info(path)
        assert info["rows"] == n + 1 == info["restart"]["row"] == len(info["events"])
    run.finish("ok", "", {})
    assert_rows(path, 60)
    assert [event["time"] for event in read_info(path)["events"]] == list(range(60))


CHILD = """
    import sys, numpy as np
    from sealdyn import archive
    archive.run_writer.SMALLEST_ROOM = 2
    series = {"h_min": archive.Series("m", "film"), "count": archive.Series("1", "row")}
    print("go", flush=True)
    while True:
        run = archive.ArchiveWriter(
            sys.argv[1], scenario_text="#", resolved={}, meta={}, series=series, interval=0
        )
        for n in range(0, 900, 3):
            i = np.arange(n, n + 3)
            if n % 60 == 0:
                run.events([{"kind": "mark", "time": float(n)}])
            run.append({"time": i * 1e-3, "h_min": 1e-5 / (1 + i), "count": i}, {"row": n + 3})
        run.finish("ok", "", {})
"""


@pytest.mark.slow
def test_a_run_killed_at_any_instant_is_readable_to_its_last_row(tmp_path):
    pick = random.Random(2)
    broken_off = 0
    for kill in range(8):
        path = tmp_path / f"{kill}.h5"
        line = [sys.executable, "-c", textwrap.dedent(CHILD), path]
        child = subprocess.Popen(line, stdout=subprocess.PIPE, text=True)
        child.stdout.readline()
        while not path.exists() and not archive.partial_path(path).exists():
            time.sleep(1e-3)
        time.sleep(pick.uniform(0, 0.15))
        child.kill()
        child.wait()
        child.stdout.close()
        for file in (archive.partial_path(path), path):
            if file.exists():
                info = read_info(file)
                assert_rows(file, info["rows"])
                assert info["restart"] == ({"row": info["rows"]} if info["rows"] else {})
                assert len(info["events"]) >= info["rows"] // 60
                broken_off += 0 < info["rows"] < 900
    assert broken_off >= 2  # else the kills came too late to say anything


def test_reading_while_a_run_writes(tmp_path):
    path = tmp_path / "run.h5"
    run = writer(path, interval=0.0)
    run.append(rows(0, 0), {"row": 0})
    stop, seen, errors = threading.Event(), [], []

    def watch():
        while not stop.is_set():
            try:
                info = read_info(path)
                seen.append(info["rows"])
                assert info["rows"] == info["restart"].get("row", 0)
                np.testing.assert_array_equal(column(path, "count", slice(0, info["rows"])), np.arange(seen[-1]))
            except Exception as error:
                errors.append(error)

    watcher = threading.Thread(target=watch)
    watcher.start()
    try:
        for n in range(0, 20000, 40):
            run.append(rows(n, n + 40), {"row": n + 40})
            # On a busy machine the watcher may not have had its turn.
            end = time.monotonic() + 20
            while n % 4000 == 0 and n and len(set(seen)) < n // 4000 and time.monotonic() < end:
                time.sleep(0.001)
        run.finish("ok", "", {})
    finally:
        stop.set()
        watcher.join()
    assert not errors and seen == sorted(seen) and len(set(seen)) > 3


@pytest.mark.parametrize("read", [lambda path: read_info(path)["rows"], lambda path: open_archive(path).sizes["time"]])
def test_a_run_that_ends_between_two_looks_is_read(tmp_path, monkeypatch, read):
    path = tmp_path / "run.h5"
    writer(path, interval=0.0).append(rows(0, 40), {"row": 40})
    looked = archive_run._read_record

    def ends(file):
        if archive.partial_path(path).exists():
            archive.partial_path(path).rename(path)
        return looked(file)

    monkeypatch.setattr(archive_run, "_read_record", ends)
    assert read(path) == 40


def test_bad_files_are_refused_in_one_line(tmp_path):
    good, bad = tmp_path / "good.h5", tmp_path / "bad.h5"
    run = writer(good)
    run.append(rows(0, 5000))
    run.finish("ok", "", {})
    data = good.read_bytes()
    with h5py.File(tmp_path / "other.h5", "w") as file:
        file["x"] = 1.0
    cases = {"text": b"speed = 3", "empty": b"", "cut": data[: len(data) // 2], "head": data[:600]}
    for name, content in cases.items():
        bad.write_bytes(content)
        with pytest.raises(ArchiveError) as caught:
            read_info(bad)
        assert "\n" not in str(caught.value) and "bad.h5" in str(caught.value), name
    for path in ("other.h5", "none.h5", "."):
        for read in (read_info, last_state, open_archive):
            with pytest.raises(ArchiveError, match=re.escape(str(tmp_path / path))):
                read(tmp_path / path)
    with pytest.raises(ArchiveError, match="'tilt'"):
        column(good, "tilt")


def test_wrong_use_is_refused(tmp_path):
    run = writer(tmp_path / "run.h5")
    with pytest.raises(ValueError, match="columns differ"):
        run.append({"time": [0.0]})
    with pytest.raises(ValueError, match="unequal"):
        run.append({"time": [0.0, 1.0], "h_min": [0.0], "count": [0.0]})
    with pytest.raises(ValueError, match="status"):
        run.finish("fine", "", {})
    run.close()
