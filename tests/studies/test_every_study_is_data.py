"""Archives of every study as datasets and as tables for other programs, from small runs of each."""

import csv
import io
import math

import numpy as np
import pytest
import xarray
from command import sealdyn as program

import sealdyn
from sealdyn.archive import answer_as_dataset, answer_tables, read_study, write_study
from sealdyn.archive.tables import columns
from sealdyn.report.panels import draw
from sealdyn.studies import study_names

# Scenario, what is set in it, settings: seconds each.
SMALL = {
    "campbell": ("fms_reference", {}, {"points": 11}),
    "coefficients": ("fmr_reference", {}, {"points": 5, "frequency": "0:2kHz:3"}),
    "contact-onset": ("fms_reference", {"stator.misalignment": 0},
                      {"margin": 0.6, "over": "film.coning", "values": "2 mrad"}),
    "critical-speed": ("fms_reference", {}, {"turns": 20, "speeds": 1}),
    "elastic-ring": ("lebeck_elastic", {"film.reynolds.cells_r": 4, "film.reynolds.cells_theta": 72}, {}),
    "equilibrium": ("run_in", {}, {"points": 21}),
    "failures": ("fms_reference", {}, {"items": 3}),
    "followability": ("circumferential_reference", {}, {"runs": 1, "speed": "9000,12000 rpm"}),
    "load-support": ("lebeck_n3", {}, {"vary": "contact.roughness=0.1:0.4um:3"}),
    "neutral-stability": ("fms_reference", {}, {"turns": 5, "accuracies": "1e-2", "long": 0}),
    "pressure": ("fms_reference", {}, {"at": "tilt=0.1mrad", "beside": "9 um"}),
    "rub": ("rub", {}, {"ramp": 5, "drop": 2, "keep": 8, "exponent_turns": 4, "judge_turns": 0, "values": "4.8 mrad"}),
    "runup": ("runup_past_threshold", {"film.model": "linear"},
              {"touch": False, "begin": 5600, "end": 6185, "rates": "60000, 80000"}),
    "sealing-number": ("ludwig_allen", {}, {"force_ratios": 2.0, "starts": "closed form", "turns": 2, "last": 1}),
    "shaft-impedance": ("fmr_reference", {}, {"frequency": "10, 50 Hz"}),
    "stability": ("fmr_reference", {}, {"x": "shaft.speed=500:9000 rad/s:5", "y": "inertia_ratio=0.5:4:4",
                                        "confirm": 1}),
    "steady-state": ("fms_reference", {}, {"approach": []}),
    "stribeck": ("pump_seal", {}, {"points": 5}),
    "sweep": ("fms_reference", {"run.turns": 4}, {"vary": "rotor.runout=10:30 urad:3"}),
    "tolerance": ("tolerance", {"run.turns": 2}, {"samples": 16}),
    "transmissibility": ("fmr_reference", {}, {"points": 31, "time_points": 2}),
    "vibration": ("housing_vibration", {}, {"points": 31, "runs": 1}),
    "warm-up": ("pump_seal", {}, {"hold": "2 s"}),
    "wave-design": ("lebeck_driven", {"film.reynolds.cells_r": 4, "film.reynolds.cells_theta": 180},
                    {"orders": [9], "rings": 5, "points": 7}),
    "wear": ("run_in", {}, {"duration": "30 min"}),
    "work-precision": ("fmr_reference", {"run.turns": 1}, {"tolerances": 2, "tightest": 1e-4, "repeats": 1,
                                                           "samples": 20}),
}  # fmt: skip
# Axes that are longer have a name.
SHORT = 9


@pytest.mark.parametrize(
    "name", [pytest.param(name, marks=pytest.mark.slow if name == "elastic-ring" else ()) for name in study_names()]
)
def test_an_archive_of_any_study_is_a_dataset_and_tables(name, tmp_path):
    scenario, values, settings = SMALL[name]
    found = sealdyn.study(name, sealdyn.example(scenario).with_(values), out=tmp_path / "s.h5", workers=1, **settings)
    with sealdyn.open_archive(tmp_path / "s.h5") as data:
        xarray.testing.assert_identical(data.drop_attrs(), found.data.drop_attrs())
        assert data.attrs["name"] == scenario and data.attrs["study"] == name.replace("-", "_")
        # Any netCDF reader takes it on, and reads the archive without this program.
        data.to_netcdf(tmp_path / "data.nc", engine="h5netcdf")
        with xarray.open_dataset(tmp_path / "s.h5") as plain:
            xarray.testing.assert_identical(plain.drop_attrs(), data.drop_attrs())
            assert {n: v.attrs.get("units") for n, v in plain.variables.items()} == {
                n: v.attrs.get("units") for n, v in data.variables.items()
            }
        for variable in data.variables:
            column = data[variable]
            assert column.dtype.kind in "fbU" and column.size
            assert column.attrs.get("units") or column.dtype.kind in "bU", variable
            for axis, dimension in enumerate(column.dims):
                assert dimension != f"{variable}.{axis}" or column.shape[axis] <= SHORT, (variable, column.shape)
    kept = read_study(tmp_path / "s.h5")
    # An answer has a sentence, a table, and panels unless its chart has a file of its own; the archive draws itself.
    assert kept["answer"]["found"] and kept["answer"]["tables"] and bool(kept["panels"]) == bool(kept["asks"])
    assert draw(tmp_path / "s.h5").axes
    if name == "elastic-ring":
        _has_three_wavinesses_by_two_roads(kept)
    tables = answer_tables(kept)
    assert tables and all(len({len(column) for column in table.values()}) == 1 for table in tables.values())
    _is_printed(tables, tmp_path)


def _has_three_wavinesses_by_two_roads(kept):
    """By the slope of the balance and by letting go, of which the outer two are stable."""
    for road in ("stable", "comes_back"):
        assert [point[road] for point in kept["answer"]["points"]] == [True, False, True]
    assert len(kept["panels"][2]["series"]) == 6


def _is_printed(tables, folder):
    """Each table by its name, and without a name what there is to choose from."""
    for table, held in tables.items():
        rows = list(csv.DictReader(io.StringIO(program("show", "s.h5", "--table", table, cwd=folder).out)))
        assert len(rows) == len(next(iter(held.values())))
        for heading, values in held.items():
            if values.dtype.kind == "f":
                printed = [float(row[heading] or "nan") for row in rows]
                assert np.array_equal(printed, values, equal_nan=True), heading
            else:
                words = values.tolist() if values.dtype.kind == "U" else [str(v).lower() for v in values.tolist()]
                assert [row[heading] for row in rows] == words
    answer = program("show", "s.h5", "--csv", cwd=folder)
    meant = isinstance(read_study(folder / "s.h5")["answer"].get("table"), dict)
    if meant or len(tables) == 1:
        assert answer.code == 0 and answer.out
    else:
        assert answer.code == 2 and answer.err.count("\n") == 1 and all(name in answer.err for name in tables)
    shown = program("show", "s.h5", cwd=folder).out
    assert all(f"{name} ({len(next(iter(held.values())))} rows)" in shown for name, held in tables.items())


def test_a_map_lies_along_its_keys(tmp_path):
    scenario, _, settings = SMALL["stability"]
    found = sealdyn.study("stability", sealdyn.example(scenario), workers=1, **settings)
    assert found.data.growth_rate.dims == ("inertia_ratio", "shaft.speed")
    assert found.data["shaft.speed"].attrs["units"] == "rad/s"
    there = found.data.growth_rate.sel({"shaft.speed": 500.0, "inertia_ratio": 4.0})
    assert float(there) == found.answer["growth_rate"][-1][0]


# --- answers of any kind -----------------------------------------------------------------------------------


@pytest.mark.core
def test_rows_within_rows_are_a_table_that_knows_its_rows():
    rows = [
        {"net": 1.0, "ways": [{"to": 2.0}, {"to": 3.0}]},
        {"net": 4.0, "ways": []},
        {"net": 5.0, "ways": [{"to": 6.0}]},
    ]
    data = answer_as_dataset({"points": rows}, {"to": "m"}, {})
    assert data["points.ways.to"].values.tolist() == [2.0, 3.0, 6.0] and data["points.ways.to"].attrs["units"] == "m"
    assert data["points.ways.points"].values.tolist() == [0.0, 0.0, 2.0]


@pytest.mark.core
def test_a_stranger_reads_any_answer_with_plain_xarray(tmp_path):
    """Columns, words, truths, rows of unequal length, and a matrix whose elements have units of their own."""
    rows = [{"film": [1.0, 2.0], "fate": "decays", "on": True}, {"film": [3.0], "fate": ""}, {"failed": "no film"}]
    answer = {
        "study": "some",
        "speed": [1.0, 2.0],
        "k": [[1.0, None], [3.0, 4.0]],
        "rows": rows,
        "sound": [True, False],
    }
    units, along = {"speed": "rad/s", "k": ["N", "N*m"], "film": "m"}, {"k": ["speed"]}
    meta = {"study": "some", "name": "any", "version": "0"}
    path = write_study(tmp_path / "s.h5", "[shaft]", {"a": [1]}, meta, answer, units, along, [{"title": "K"}])
    with xarray.open_dataset(path) as plain:
        assert plain.k.dims[0] == "speed" and plain.speed.attrs == {"units": "rad/s", "long_name": "shaft speed"}
        assert plain.sound.dtype == bool and plain["rows.fate"].values.tolist() == ["decays", "", ""]
        assert plain.attrs["scenario"] == "[shaft]" and np.isnan(plain.k.values[0, 1])
        with sealdyn.open_archive(path) as data:
            xarray.testing.assert_identical(plain.drop_attrs(), data.drop_attrs())
    kept = read_study(path)
    assert kept["answer"] == answer and kept["panels"] == [{"title": "K"}] and kept["resolved"] == {"a": [1]}


@pytest.mark.core
def test_names_that_stand_in_each_others_way_are_written(tmp_path):
    """A dimension of the name of another list, and rows that lack points of their grid."""
    clash = {"x": [[1.0, 2.0], [3.0, 4.0]], "y": [1.0, 2.0, 3.0]}
    axis = {"key": "a", "unit": "m", "values": [1.0, 2.0]}
    sweep = {"axes": [axis], "keys": ["a"], "outputs": ["b"], "output_units": {}, "rows": [{"a": 1.0, "b": 2.0}]}
    for number, answer in enumerate((clash, sweep)):
        meta = {"study": "some"}
        path = write_study(tmp_path / f"{number}.h5", "", {}, meta, answer, {}, {"y": ["x"]} if answer is clash else {})
        with xarray.open_dataset(path) as plain:
            assert plain.data_vars and read_study(path)["answer"] == answer


def test_lists_of_unequal_lengths_stand_one_below_the_other():
    rows = [{"time": [0.0, 1.0], "film": [5.0, 6.0], "odd": [1.0]}, {"time": [2.0], "film": [7.0], "odd": [2.0, 3.0]}]
    found = columns({"rows": rows})
    assert found["rows/time/time"].values.tolist() == [0.0, 1.0, 2.0]
    assert found["rows/time/film"].values.tolist() == [5.0, 6.0, 7.0]
    assert found["rows/time/rows"].values.tolist() == [0.0, 0.0, 1.0]
    assert found["rows/odd/odd"].values.tolist() == [1.0, 2.0, 3.0]
    within = columns({"rows": [{"path": {"x": [1.0], "y": [2.0]}}, {"path": {"x": [3.0, 4.0], "y": [5.0, 6.0]}}]})
    assert within["rows/path/y"].values.tolist() == [2.0, 5.0, 6.0]
    assert within["rows/path/rows"].values.tolist() == [0.0, 1.0, 1.0]


def test_what_a_failed_row_lacks_is_empty():
    rows = [{"k": [[1.0, 2.0]], "class": "rub", "stable": True}, {"failed": "collapsed"}]
    found = {key.partition("/")[2]: column.values for key, column in columns({"rows": rows}).items()}
    assert found["k"].shape == (2, 1, 2) and np.isnan(found["k"][1]).all()
    assert found["class"].tolist() == ["rub", ""] and found["failed"].tolist() == ["", "collapsed"]
    assert found["stable"][0] == 1.0 and math.isnan(found["stable"][1])


def test_elements_of_a_matrix_are_columns_with_units_of_their_own():
    answer = {"speed": [1.0, 2.0], "k": [[1.0, 2.0], [3.0, 4.0]], "p": [[5.0, 6.0]] * 2, "theta": [0.5, 0.6]}
    units = {"speed": "rad/s", "k": ["N", "N*m"], "p": "Pa", "theta": "rad"}
    study = {"answer": answer, "study": "some_study", "units": units,
             "along": {"k": ["speed"], "p": ["speed", "theta"]}}  # fmt: skip
    one, other = answer_tables(study).values()
    assert {name: values.tolist() for name, values in one.items()} == {
        "speed [rad/s]": [1.0, 2.0], "k.0 [N]": [1.0, 3.0], "k.1 [N*m]": [2.0, 4.0]
    }  # fmt: skip
    assert {name: values.tolist() for name, values in other.items()} == {
        "speed [rad/s]": [1.0, 1.0, 2.0, 2.0], "theta [rad]": [0.5, 0.6, 0.5, 0.6], "p [Pa]": [5.0, 6.0, 5.0, 6.0]
    }  # fmt: skip


def test_words_with_commas_survive(tmp_path):
    from sealdyn.report.text import csv_lines

    held = {'a, "b"': np.array(['x,"y"', "", "two\nlines"]), "n [m]": np.array([1.5, math.nan, 1e-300])}
    header, *rows = csv.reader(io.StringIO("\n".join(csv_lines(held)), newline=""))
    assert header == list(held) and [row[0] for row in rows] == held['a, "b"'].tolist()
    assert [row[1] for row in rows] == ["1.5", "", "1e-300"]
