"""Files of samples as other programs leave them: what is read is what their conventions say, or the file is refused."""

import h5py
import numpy as np
import pytest

from sealdyn.scenario.motion_files import MOTION, file_columns
from sealdyn.units import QuantityError

TIME = np.arange(8) * 1e-3
# Multiples of the smallest step of packed ones.
AXIAL = np.array([0.0, 1.5, 4.5, -3.0, -5.0, 2.5, 0.5, 1.0])
ROW = h5py.string_dtype()


def read_motion(path):
    return {name: values for name, (values, _) in file_columns(path, MOTION).items()}


def hdf5(path, stored, **attributes):
    """A file with `stored` as axial, micrometres unless told, and these attributes."""
    with h5py.File(path, "w") as file:
        file["time"] = TIME
        file["time"].attrs["units"] = "s"
        file["axial"] = stored
        for key, value in {"units": "um", **attributes}.items():
            if value is not None:
                file["axial"].attrs[key] = value
    return path


@pytest.mark.parametrize(
    ("stored", "attributes"),
    [
        ((AXIAL * 2).astype("i2"), {"scale_factor": 0.5}),
        ((AXIAL * 2 + 100).astype("u1"), {"scale_factor": np.float32(0.5), "add_offset": -50.0}),
        (AXIAL + 3.0, {"add_offset": np.array([-3.0])}),
        ((AXIAL * 2 + 140).astype("u1").view("i1"), {"scale_factor": 0.5, "add_offset": -70.0, "_Unsigned": "true"}),
        ((AXIAL * 2 + 100).astype("u1"), {"scale_factor": 0.5, "add_offset": -50.0, "valid_min": -1000}),
        (AXIAL.astype(">f4"), {}), (AXIAL, {"units": np.array(["um"], dtype=ROW)}),
        (AXIAL, {"units": None, "unit": "um"}), (AXIAL, {"units": None, "Units": b"um"}),
        (AXIAL, {"units": None, "UNITS": np.array([b"um"])}), (AXIAL * 1e-6, {"units": None}),
        (AXIAL, {"units": np.bytes_("um\0"), "_FillValue": -999.0, "missing_value": [1e20, -7.0]}),
        (AXIAL, {"valid_min": -5.0, "valid_max": 5.0}), (AXIAL * 1e-3, {"units": "mm", "unit": "mm"}),
    ],
)  # fmt: skip
def test_numbers_are_what_their_attributes_say(tmp_path, stored, attributes):
    found = read_motion(hdf5(tmp_path / "m.h5", stored, **attributes))
    assert found["axial"] == pytest.approx(AXIAL * 1e-6, rel=1e-6, abs=1e-20)


@pytest.mark.parametrize(
    ("stored", "attributes"),
    [
        (AXIAL, {"_FillValue": 4.5}), (AXIAL, {"missing_value": [7.0, -3.0]}), (AXIAL, {"valid_range": [-4.0, 4.0]}),
        (AXIAL, {"valid_max": 4.0}), (AXIAL, {"scale_factor": "2"}), (AXIAL, {"scale_factor": [1.0, 2.0]}),
        (AXIAL, {"scale_factor": np.nan}), (AXIAL, {"add_offset": h5py.Empty("f8")}), (AXIAL, {"unit": "mm"}),
        (AXIAL, {"units": ["um", "mm"]}), (AXIAL, {"units": 1.0}), (AXIAL, {"units": "um", "Units": "mm"}),
        ((AXIAL + 100).astype("u1"), {"valid_max": -1000}),
        ((AXIAL + 9).astype("i1"), {"_Unsigned": "true", "valid_max": -1000}),
        (AXIAL.reshape(2, 4), {}), (AXIAL * 1j, {}), (AXIAL, {"units": "seconds since 2020-01-01"}),
    ],
)  # fmt: skip
def test_what_says_no_numbers_is_refused(tmp_path, stored, attributes):
    with pytest.raises(QuantityError) as error:
        read_motion(hdf5(tmp_path / "m.h5", stored, **attributes))
    assert "axial" in error.value.found and "\n" not in str(error.value)


def test_samples_that_were_never_written_are_missing(tmp_path):
    with h5py.File(tmp_path / "m.h5", "w") as file:
        file["time"] = TIME
        file.create_dataset("axial", (8,), "i2", fillvalue=-32767)[:5] = 1
    with pytest.raises(QuantityError):
        read_motion(tmp_path / "m.h5")


def test_numbers_of_another_file_are_none_of_this_one(tmp_path):
    hdf5(tmp_path / "other.h5", AXIAL)
    with h5py.File(tmp_path / "m.h5", "w") as file:
        file["time"], file["axial"] = TIME, h5py.ExternalLink("other.h5", "/axial")
    with pytest.raises(QuantityError):
        read_motion(tmp_path / "m.h5")


ROWS = "\n".join(f"{t},{1e3 * t}" for t in TIME)


@pytest.mark.parametrize(
    "text",
    [
        f'"time\n(s)","axial\n(mm)"\n{ROWS}\n', f"time (s),axial (mm)\r\n# a remark\r\n\r\n{ROWS}\r\n",
        f"Time [s],AXIAL [mm]\n{ROWS}", f"time,axial (mm),\n{ROWS.replace(chr(10), ',' + chr(10))},\n",
        f'time,axial (mm),remark\n{ROWS.replace(chr(10), ",x" + chr(10))},"two\nlines"',
        "time (s);axial (mm)\n" + ROWS.replace(",", ";"),
    ],
)  # fmt: skip
def test_rows_are_cells_below_their_names(tmp_path, text):
    (tmp_path / "m.csv").write_text(text, newline="")
    found = read_motion(tmp_path / "m.csv")
    assert found["time"] == pytest.approx(TIME) and found["axial"] == pytest.approx(TIME)


@pytest.mark.parametrize(
    ("text", "words"),
    [
        # 0.001 s and 1.5 um, read as 0 s and 1 um if cells beyond the names did not count.
        ("time (s),axial (um)\n0,001,1,5\n", "line 2"), ("time;axial\n0,001;1,5\n", "comma"),
        ("time,axial um,tilt_x\n0,1,2\n", "axial um"), ("time,axial\n0,1_000\n", "1_000"),
        ('time,axial,"a\nb"\n0,1\n1,x\n', "line 4"),
    ],
)  # fmt: skip
def test_cells_that_are_no_numbers_are_named(tmp_path, text, words):
    (tmp_path / "m.csv").write_text(text)
    with pytest.raises(QuantityError) as error:
        read_motion(tmp_path / "m.csv")
    assert words in error.value.found
