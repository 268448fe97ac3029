"""Fields in the archive: what goes in comes out, through a kill and a continuation, and a stranger can read it."""

import h5py
import numpy as np
import pytest

from sealdyn import archive
from sealdyn.archive import ArchiveError, ArchiveWriter, Fields, Series, column, field, open_archive, read_info

R, THETA = np.array([0.03, 0.035, 0.04]), np.linspace(0, 6, 4)
PRESSURE = Series("Pa", "film pressure", "MPa", 1e-6)
FIELDS = Fields({"pressure": PRESSURE}, {"r": (Series("m", "radius"), R), "theta": (Series("rad", "angle"), THETA)}, 9)
EVERY = 10


def writer(path, fields=FIELDS, **options):
    given = {"scenario_text": "#", "resolved": {}, "meta": {}, "series": {"h_min": Series("m", "film")}}
    return ArchiveWriter(path, fields=fields, **(given | options))


def rows(start, stop):
    n = np.arange(start, stop)
    return {"time": n * 1e-3, "h_min": 1e-5 / (1 + n)}


def kept(start, stop):
    """Fields at every tenth row."""
    n = np.arange(start, stop)
    n = n[n % EVERY == 0]
    return {"field_time": n * 1e-3, "pressure": n[:, None, None] + R[:, None] * np.cos(THETA)}


def assert_fields(path, stop):
    for name, expected in kept(0, stop).items():
        np.testing.assert_array_equal(field(path, name), expected)
    np.testing.assert_array_equal(field(path, "r"), R)
    np.testing.assert_array_equal(field(path, "theta"), THETA)


def written(path, stop, step=7, **options):
    run = writer(path, **options)
    for start in range(0, stop, step):
        run.append(rows(start, min(start + step, stop)), {"row": start}, kept(start, min(start + step, stop)))
    return run


@pytest.mark.core
def test_what_goes_in_comes_out_to_the_last_bit(tmp_path):
    path = written(tmp_path / "run.h5", 75).finish("ok", "", {})
    assert_fields(path, 75)
    info = read_info(path)
    assert list(info["series"]) == ["h_min", "time"] and info["fields"] == {"pressure": PRESSURE}
    assert info["grid"] == {"field_time": 8, "r": 3, "theta": 4} and info["instants"] == 8
    with pytest.raises(ArchiveError, match="'pressure'"):
        column(path, "pressure")
    for name in ("h_min", "void", "events"):
        with pytest.raises(ArchiveError, match=name):
            field(path, name)


def test_a_file_written_once_is_one_written_bit_by_bit(tmp_path):
    contents = []
    for name, interval in (("often", 0.0), ("once", 1e9)):
        run = written(tmp_path / name / "run.h5", 75, interval=interval)
        run.events([{"kind": "touch", "time": 0.01, "value": 1.0, "text": "there"}])
        assert archive.partial_path(tmp_path / name / "run.h5").exists() == (name == "often")
        with h5py.File(run.finish("ok", "done", {"a": 1}), "r") as file:
            # The seal is of the instant, too.
            found = {".": dict(file.attrs) | {"created": "", "seal": ""}}
            file.visititems(lambda name, item, found=found: found.update({name: (item[()], dict(item.attrs))})
                            if isinstance(item, h5py.Dataset) else found.update({name: dict(item.attrs)}))  # fmt: skip
        contents.append(found)
    assert list(contents[0]) == list(contents[1]) and repr(contents[0]) == repr(contents[1])
    assert len(contents[0]["h_min"][0]) == 75


def test_a_stranger_reads_them_with_h5py_and_with_xarray(tmp_path):
    path = written(tmp_path / "run.h5", 75).finish("ok", "", {})
    with h5py.File(path) as file:
        item = file["pressure"]
        assert item.shape == (8, 3, 4) and item.attrs["units"] == "Pa"
        assert [dimension[0].name for dimension in item.dims] == ["/field_time", "/r", "/theta"]
    with open_archive(path) as data:
        assert data.pressure.dims == ("field_time", "r", "theta") and data.h_min.dims == ("time",)
        assert data.pressure.attrs["units"] == "Pa" and data.r.attrs["units"] == "m"
        assert float(data.pressure.sel(field_time=0.03, r=0.035, theta=2.0)) == 30 + 0.035 * np.cos(2.0)


def test_a_running_archive_opens_with_its_instants_and_nothing_else(tmp_path):
    path = tmp_path / "run.h5"
    run = written(path, 25, interval=0.0)
    assert_fields(path, 25)
    assert read_info(path)["grid"]["field_time"] == 3
    with open_archive(path) as data:
        assert data.sizes == {"time": 25, "field_time": 3, "r": 3, "theta": 4}
        assert not np.isnan(data.pressure.values).any()
    run.close()


def test_a_record_broken_off_half_way_leaves_the_one_before(tmp_path):
    """What a kill amid the last write leaves: a record whose end never came."""
    path = tmp_path / "run.h5"
    run = written(path, 30, step=15, interval=0.0)
    with h5py.File(archive.partial_path(path), "r+") as file:
        newest = max((0, 1), key=lambda slot: b'"rows": 30' in file["restart/record"][slot].tobytes())
        file["restart/record"][newest, 40:] = 0
    assert read_info(path)["rows"] == 15 and archive.last_state(path) == {"row": 0}
    assert_fields(path, 15)
    run.close()


@pytest.mark.parametrize("final", ["interrupted", None])
def test_a_continued_run_equals_an_unbroken_one(tmp_path, final):
    path = tmp_path / "run.h5"
    run = written(path, 33)
    if final:
        run.finish(final, "", {})
    else:
        run.close()
    run = writer(path, resume=True)
    assert (run.rows, run.instants) == (33, 4)
    run.append(rows(33, 88), {}, kept(33, 88))
    run.finish("ok", "", {})
    assert_fields(path, 88)


def test_room_that_grows_for_rows_keeps_the_fields(tmp_path, monkeypatch):
    monkeypatch.setattr(archive.run_writer, "SMALLEST_ROOM", 1)
    path = tmp_path / "run.h5"
    run = written(path, 90, step=1, interval=0.0)
    assert_fields(path, 90)
    run.finish("ok", "", {})
    assert_fields(path, 90)


def test_resuming_other_fields_is_refused(tmp_path):
    path = tmp_path / "run.h5"
    written(path, 20).close()
    r, theta = FIELDS.grid["r"], FIELDS.grid["theta"]
    others = (
        None,
        FIELDS._replace(series={"void": PRESSURE}),
        FIELDS._replace(grid={"r": (r[0], 1.1 * R), "theta": theta}),
        FIELDS._replace(grid={"r": (r[0], R[:2]), "theta": theta}),
    )
    for other in others:
        with pytest.raises(ArchiveError, match="fields"):
            writer(path, other, resume=True)
    assert_fields(path, 20)


def test_wrong_use_is_refused(tmp_path):
    run = writer(tmp_path / "run.h5")
    with pytest.raises(ValueError, match="shape"):
        run.append(rows(0, 1), {}, {"field_time": [0.0], "pressure": np.zeros((1, 4, 3))})
    with pytest.raises(ValueError, match="more than 9"):
        run.append(rows(0, 100), {}, kept(0, 100))
    run.close()


# --- formats ----------------------------------------------------------------------------------------
