"""What goes wrong: bad input is one line and exit code 2, a closing film is a sentence and exit code 3."""

import re
from pathlib import Path

import h5py
import numpy as np
import pytest
from command import REFERENCE, sealdyn, settings

SEVERAL = '[shaft]\nsped = 1\n[film]\ninner_radius = "1 kg"\n[run]\nturns = -1\n'
LACKING = '[shaft]\nspeed = "1000 rad/s"\n'

BAD = {
    "no such file": ["run", "nothing.toml"],
    "a folder": ["run", "."],
    "no TOML": ["run", "broken.toml"],
    "an empty file": ["run", "empty.toml"],
    "tables missing": ["run", "lacking.toml"],
    "bytes": ["run", "bytes.toml"],
    "an archive that is none": ["run", "fake.h5"],
    "unknown key": ["run", REFERENCE, "--set", "rotor.runot=1"],
    "wrong dimension": ["run", REFERENCE, "--set", "film.clearance=10 kg"],
    "not a number": ["run", REFERENCE, "--set", "film.coning=nan"],
    "override without value": ["run", REFERENCE, "--set", "film.coning"],
    "radii swapped": ["run", REFERENCE, "--set", "film.inner_radius=50 mm"],
    "negative mass": ["run", REFERENCE, "--set", "rotor.mass=-1 kg"],
    "no disk": ["run", REFERENCE, "--set", "rotor.polar_inertia=1 kg*m^2"],
    "closed at the start": ["run", REFERENCE, "--set", "stator.misalignment=1 mrad"],
    "unknown film": ["run", REFERENCE, "--set", "film.model=radail"],
    "unknown solver": ["run", REFERENCE, "--set", "run.solver=euler"],
    "exact steps of a nonlinear film": ["run", REFERENCE, "--set", "run.solver=expm"],
    "no archive to start from": ["run", REFERENCE, "--set", "run.start=nothing.h5"],
    "nothing to continue": ["run", REFERENCE, "--continue"],
    "an archive in no folder": ["run", REFERENCE, "--out", "empty.toml/x.h5"],
    "an archive that is a folder": ["run", REFERENCE, "--set", "run.turns=1", "--no-plot", "--out", "."],
    "unknown option": ["run", REFERENCE, "--turns", "3"],
    "no file": ["run"],
    "unknown verb": ["rum", REFERENCE],
    "check: unknown key": ["check", REFERENCE, "--set", "film.clearence=1"],
    "show: no such file": ["show", "nothing.h5"],
    "show: no archive": ["show", "fake.h5"],
    "show: another HDF5 file": ["show", "other.h5"],
    "plot: no archive": ["plot", "fake.h5"],
    "plot: unknown kind": ["plot", "other.h5", "--kind", "orbti"],
    "validate: unknown source": ["validate", "zuk-1927"],
}
HAVE_JSON = ("run", "check", "show", "rum", "validate")


@pytest.fixture(scope="module")
def folder(tmp_path_factory):
    folder = tmp_path_factory.mktemp("bad")
    (folder / "broken.toml").write_text("[film\nclearance = ")
    (folder / "empty.toml").write_text("")
    (folder / "lacking.toml").write_text(LACKING)
    (folder / "bytes.toml").write_bytes(bytes(range(128, 256)))
    (folder / "fake.h5").write_bytes(b"\x89PNG and so on" * 100)
    h5py.File(folder / "other.h5", "w").close()
    return folder


@pytest.mark.parametrize("arguments", BAD.values(), ids=BAD)
def test_bad_input_is_one_line(arguments, folder):
    answer = sealdyn(*arguments, cwd=folder)
    assert answer.code == 2
    assert answer.out == ""
    assert answer.err.count("\n") == 1 and answer.err.strip(), answer.err


@pytest.mark.parametrize(
    "arguments",
    [a for a in BAD.values() if a[0] in HAVE_JSON],
    ids=lambda a: " ".join(Path(word).name for word in map(str, a)),
)
def test_bad_input_is_one_object(arguments, folder):
    answer = sealdyn(*arguments, "--json", cwd=folder)
    assert answer.code == 2
    assert answer.found["status"] == "invalid" and "\n" not in answer.found["message"]


def test_every_problem_of_a_file_at_once(folder):
    """A line each, and in JSON a list; the message is the first of them."""
    (folder / "several.toml").write_text(SEVERAL)
    answer = sealdyn("check", "several.toml", cwd=folder)
    lines = answer.err.splitlines()
    assert answer.code == 2 and answer.out == "" and all(line.startswith("several.toml: [") for line in lines)
    found = sealdyn("run", "several.toml", "--json", cwd=folder).found
    assert found["status"] == "invalid" and found["message"] == lines[0]
    assert [error["message"] for error in found["errors"]] == lines
    keys = [error["key"] for error in found["errors"]]
    assert keys[0] == "shaft.sped" and {"film.inner_radius", "film.outer_radius", "run.turns"} < set(keys)
    # The speed is not missing: it is there misspelt.
    assert "shaft.speed" not in keys and len(keys) == len(set(keys))
    assert set(found["errors"][0]) == {"message", "key", "found", "expected"}


def test_bad_input_leaves_nothing_behind(tmp_path):
    """Nor the folder that would have been written to."""
    for arguments in (BAD["closed at the start"], BAD["unknown film"], BAD["no archive to start from"]):
        sealdyn(*arguments, cwd=tmp_path)
    assert list(tmp_path.iterdir()) == []


# A film that widens inwards: the faces are drawn together and close at the outer radius.
DIVERGING = {"film.coning": '"-0.5 mrad"'}


@pytest.fixture(scope="module")
def collapse(tmp_path_factory):
    folder = tmp_path_factory.mktemp("collapse")
    return folder, sealdyn("run", REFERENCE, *settings(DIVERGING), "--json", cwd=folder)


@pytest.mark.core
def test_collapse_says_when_where_and_what_to_try(collapse):
    _, answer = collapse
    assert answer.code == 3
    found = answer.found
    assert found["status"] == "collapsed"
    said = re.search(r"t = ([\d.]+) s.*40 mm.*theta = (-?[\d.]+) deg.*coning.*clearance", found["message"])
    assert said, found["message"]
    assert float(said[1]) == pytest.approx(found["h_min"]["time"], rel=1e-5)
    assert float(said[2]) == pytest.approx(np.degrees(found["h_min"]["theta"]), abs=0.06)
    assert found["h_min"]["value"] == pytest.approx(1e-3 * 1e-5, rel=1e-6)
    assert found["stability"]["verdict"] == "unstable"
    # The linear steady state of an unstable film is never approached.
    assert found["relative_misalignment"]["steady_max"] is found["contact_margin"] is None
    assert found["energy_residual"] < 10 * found["accuracy"]


def test_archive_of_a_collapse_is_complete_to_that_instant(collapse):
    folder, answer = collapse
    found = answer.found
    with h5py.File(folder / found["archive"]) as file:
        assert file.attrs["status"] == "collapsed" and file.attrs["message"] == found["message"]
        time, h_min = file["time"][:], file["h_min"][:]
        assert time[-1] == pytest.approx(found["h_min"]["time"], rel=1e-12)
        assert h_min[-1] == pytest.approx(1e-8, rel=1e-6) and (h_min[:-1] > 1e-8).all()
        # Every sample that was due, 64 a turn of 2 pi ms, and the instant itself.
        assert len(time) == int(time[-1] / (2e-3 * np.pi / 64)) + 2
        assert list(file["events/kind"].asstr()) == ["collapse"]
        assert file["events/time"][0] == time[-1]
        assert found["relative_misalignment"]["max"] >= file["relative_misalignment"][:].max() * (1 - 1e-9)


def test_a_shaft_at_rest_is_a_scene(tmp_path):
    """No turns to count samples by: 1000 in all."""
    lines = REFERENCE.read_text().splitlines()
    (tmp_path / "still.toml").write_text("\n".join(x for x in lines if not x.startswith("samples_per_turn")))
    still = settings({"shaft.speed": 0, "run.duration": '"20 ms"'})
    answer = sealdyn("run", "still.toml", *still, "--json", "--no-plot", cwd=tmp_path)
    assert answer.code == 0, answer.out
    with h5py.File(tmp_path / answer.found["archive"]) as file:
        assert len(file["time"]) == 1001
    form = answer.found["closed_form"]
    # Nothing turns: both tilts stand, so the largest relative misalignment is also the smallest.
    assert form["relative_min"] == pytest.approx(form["relative_max"])
