"""Room on the disk is made sure of before an archive is written: no file outgrows what was asked for."""

from contextlib import contextmanager

import numpy as np
import pytest

from sealdyn import archive
from sealdyn.archive import ArchiveWriter, Fields, Series, files, run_writer, study, write_study

ANGLES = np.linspace(0.0, 6.0, 50)
FIELDS = Fields({"pressure": Series("Pa", "pressure")}, {"theta": (Series("rad", "angle"), ANGLES)}, 200)
FEW = {"kind": "a", "time": 0.5}


@pytest.fixture
def shares(monkeypatch):
    """Of every file as it is closed: how much of the room that was asked for it takes."""
    found = []

    @contextmanager
    def measured(target, size, *more, **how):
        with files.hdf5_in_place_of(target, size, *more, **how) as file:
            yield file
            file.flush()
            found.append(file.id.get_filesize() / size)

    monkeypatch.setattr(run_writer, "hdf5_in_place_of", measured)
    monkeypatch.setattr(study, "hdf5_in_place_of", measured)
    return found


RUNS = {
    "many rows": {"steps": 200},
    "many series": {"series": 300},
    "many events": {"events": 20_000},
    "fields": {"fields": FIELDS},
    "a long state": {"state": {"y": "1" * 2_000_000}},
    "long words": {"words": "x" * 2_000_000},
}


@pytest.mark.parametrize("interval", [0.0, 1e9])
@pytest.mark.parametrize("name", RUNS)
def test_no_run_outgrows_its_room(tmp_path, shares, name, interval):
    given = {"steps": 4, "series": 1, "events": 0, "fields": None, "state": {}, "words": ""} | RUNS[name]
    series = {f"s{k}": Series("m", "film") for k in range(given["series"])}
    run = ArchiveWriter(
        tmp_path / "run.h5", scenario_text=given["words"], resolved={}, meta={}, series=series,
        fields=given["fields"], interval=interval, expected_rows=5000,
    )  # fmt: skip
    for step in range(given["steps"]):
        time = step + np.arange(100) / 100
        kept = {"field_time": time[:1], "pressure": np.ones((1, len(ANGLES)))} if given["fields"] else None
        run.events([FEW] * (given["events"] // given["steps"]))
        run.append(dict.fromkeys(["time", *series], time), given["state"], kept)
    run.finish("ok", given["words"], {})
    assert shares and min(shares) > 0.0 and max(shares) <= 1.0
    assert archive.read_info(tmp_path / "run.h5")["rows"] == 100 * given["steps"]


ANSWERS = {
    "little": {"margin": [1.0, 2.0]},
    "many columns": {f"c{k}": [1.0, 2.0] for k in range(300)},
    "many rows": {"curve": [{"speed": float(k), "word": "stable"} for k in range(5000)]},
    "many numbers": {f"c{k}": list(map(float, range(50_000))) for k in range(4)},
    "rows of lists": {"points": [{"at": [float(k), 2.0, 3.0], "modes": [{"f": 1.0}] * 3} for k in range(500)]},
    "long words": {"kept": ["x" * 100_000] * 10},
}


@pytest.mark.parametrize("name", ANSWERS)
def test_no_study_outgrows_its_room(tmp_path, shares, name):
    write_study(tmp_path / "study.h5", "", {}, {"study": "sweep"}, ANSWERS[name], {})
    assert len(shares) == 1 and 0.0 < shares[0] <= 1.0
