"""Files of a quantity over time, records longer than a run, and moments that stand in a file twice."""

import numpy as np
import pytest

import sealdyn
from sealdyn.scenario import motion_files
from sealdyn.scenario.errors import ScenarioError
from sealdyn.scenario.reader import text_of

SPEEDS = "time (ms), speed (rpm)\n0, 3000\n20, 3600\n20, 4000\n50, 4000\n"
AS_WRITTEN = {"time": [0, 0.02, 0.02, 0.05], "value": ["3000 rpm", "3600 rpm", "4000 rpm", "4000 rpm"]}


def scenario_in(folder, **tables):
    """A file of the reference scene, 10 ms of it, with other keys."""
    held = sealdyn.example("fms_reference").to_dict() | {"run": {"duration": 0.01, "samples": 20}}
    held["film"]["model"] = "linear"
    for table, keys in tables.items():
        held[table] = held.get(table, {}) | keys
    path = folder / "scene.toml"
    path.write_text(text_of(held))
    return path


@pytest.mark.parametrize("column", ["speed", "value"])
def test_a_file_stands_for_a_table_of_times(tmp_path, column):
    (tmp_path / "speed.csv").write_text(SPEEDS.replace("speed", column))
    read = sealdyn.read_scenario(scenario_in(tmp_path, shaft={"speed": {"file": "speed.csv"}}))
    written = sealdyn.example("fms_reference").with_({"shaft.speed": AS_WRITTEN})
    assert read.scene.shaft.speed == written.scene.shaft.speed
    # Whole without the file.
    (tmp_path / "speed.csv").unlink()
    assert sealdyn.Scenario.from_dict(read.to_dict()) == read
    (tmp_path / "written.toml").write_text(read.to_toml())
    assert sealdyn.read_scenario(tmp_path / "written.toml") == read


def test_its_titles_may_be_given(tmp_path):
    (tmp_path / "p.csv").write_text("0,5\n10,6\n")
    path = scenario_in(tmp_path, film={"outer_pressure": {"file": "p.csv", "titles": ["time (ms)", "value (bar)"]}})
    assert sealdyn.read_scenario(path).scene.film.outer_pressure.value == (5e5, 6e5)


def test_an_archive_holds_the_numbers(tmp_path):
    (tmp_path / "p.csv").write_text("time (ms), outer_pressure (bar)\n0,5\n10,6\n")
    path = scenario_in(tmp_path, film={"outer_pressure": {"file": "p.csv"}})
    ran = sealdyn.run(path, out=tmp_path / "first.h5")
    (tmp_path / "p.csv").unlink()
    again = sealdyn.run(tmp_path / "first.h5", out=tmp_path / "second.h5")
    assert ran.summary["h_min"]["value"] == again.summary["h_min"]["value"]
    other = sealdyn.read_scenario(tmp_path / "first.h5", ['film.outer_pressure="7 bar"'])
    assert other.scene.film.outer_pressure == 7e5
    (tmp_path / "q.csv").write_text("time (ms), value (bar)\n0,3\n10,4\n")
    other = sealdyn.read_scenario(tmp_path / "first.h5", [f'film.outer_pressure={{ file = "{tmp_path}/q.csv" }}'])
    assert other.scene.film.outer_pressure.value == (3e5, 4e5)


@pytest.mark.parametrize("held, key", [
    ("time, speed (rpm)\n0, fast\n1, 2\n", "shaft.speed.file"),
    ("time, tilt (rpm)\n0, 1\n1, 2\n", "shaft.speed.file"),
    ("time, speed (rpm), value (rpm)\n0, 1, 3\n1, 2, 4\n", "shaft.speed.file"),
    (None, "shaft.speed.file"),
    ("time, speed (rpm)\n1, 1\n0, 2\n", "shaft.speed"),
])  # fmt: skip
def test_what_is_wrong_with_it_is_one_line(tmp_path, held, key):
    if held is not None:
        (tmp_path / "speed.csv").write_text(held)
    with pytest.raises(ScenarioError) as refused:
        sealdyn.read_scenario(scenario_in(tmp_path, shaft={"speed": {"file": "speed.csv"}}))
    assert refused.value.key == key and not refused.value.others


def record(path, times, values):
    rows = "".join(f"{t!r},{v!r}\n" for t, v in zip(times, values, strict=True))
    path.write_text("time (s),axial (um)\n" + rows)


def test_a_long_record_is_cut_to_the_run(tmp_path, monkeypatch):
    monkeypatch.setattr(motion_files, "MOST_LISTED", 300)
    times = [n * 1e-4 for n in range(-500, 1000)]
    values = [float(np.sin(300 * t)) for t in times]
    record(tmp_path / "x.csv", times, values)
    path = scenario_in(tmp_path, housing={"motion": {"file": "x.csv"}})
    long = sealdyn.read_scenario(path).scene.housing.motion
    assert len(long.time) == 300 and long.time[0] < -50e-4 and long.time[-1] > 150e-4
    monkeypatch.undo()
    whole = sealdyn.read_scenario(path).scene.housing.motion
    assert len(whole.time) == 1500
    cut = whole.time.index(long.time[0])
    assert whole.axial[cut : cut + 300] == long.axial
    monkeypatch.setattr(motion_files, "MOST_LISTED", 150)
    with pytest.raises(ScenarioError) as refused:
        sealdyn.read_scenario(path)
    assert refused.value.key == "housing.motion.file"


def test_a_moment_twice_is_one_where_nothing_jumps(tmp_path):
    path = scenario_in(tmp_path, housing={"motion": {"file": "x.csv"}})
    times, values = [0.0, 0.002, 0.004, 0.004, 0.006, 0.008, 0.01], [0.0, 1.0, 2.0, 2.0, 3.0, 2.0, 1.0]
    record(tmp_path / "x.csv", times, values)
    assert sealdyn.read_scenario(path).scene.housing.motion.time == (0.0, 0.002, 0.004, 0.006, 0.008, 0.01)
    values[3] = 2.5
    record(tmp_path / "x.csv", times, values)
    with pytest.raises(ScenarioError) as refused:
        sealdyn.read_scenario(path)
    assert refused.value.key == "housing.motion.file" and "axial" in refused.value.found
