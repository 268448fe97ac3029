"""A run with the motion of its shaft in a file, and again from its archive alone."""

import numpy as np
import pytest
from command import REFERENCE, sealdyn, settings

from sealdyn.archive import column, read_info


def write_motion(path, amplitude=1e-6):
    """A tilt that turns at 300 Hz, in a file."""
    time = np.arange(4001) / 8000.0
    phase = 2 * np.pi * 300.0 * time
    columns = np.column_stack([1e3 * time, 1e6 * amplitude * np.cos(phase), 1e6 * amplitude * np.sin(phase)])
    np.savetxt(path, columns, delimiter=",", header="time (ms), tilt_x (urad), tilt_y (urad)", comments="")


@pytest.mark.core
def test_archive_holds_the_motion_of_a_file(tmp_path):
    write_motion(tmp_path / "shaft.csv")
    (tmp_path / "seal.toml").write_text(REFERENCE.read_text() + '\n[shaft.motion]\nfile = "shaft.csv"\n')
    short = settings({"run.duration": 0.02, "run.samples": 100})
    first = sealdyn("run", "seal.toml", *short, "--out", "one.h5", "--no-plot", "--json", cwd=tmp_path)
    assert first.code == 0, first.err
    assert first.found["energy_residual"] < 1e-6
    # A study refuses what needs harmonics, in a line.
    refused = sealdyn("study", "contact-onset", "seal.toml", "--no-plot", cwd=tmp_path)
    assert refused.code == 4 and "shaft.motion" in refused.out, refused.err
    (tmp_path / "shaft.csv").unlink()
    second = sealdyn("run", "one.h5", "--out", "two.h5", "--no-plot", "--json", cwd=tmp_path)
    assert second.code == 0, second.err
    one, two = (column(tmp_path / name, "h_min") for name in ("one.h5", "two.h5"))
    assert np.array_equal(one, two) and np.ptp(one) > 0.0
    assert read_info(tmp_path / "two.h5")["resolved"]["shaft"]["motion"]["file"] == "shaft.csv"
    gone = sealdyn("check", "seal.toml", *short, cwd=tmp_path)
    assert gone.code == 2 and len(gone.err.strip().splitlines()) == 1 and "shaft.csv" in gone.err
