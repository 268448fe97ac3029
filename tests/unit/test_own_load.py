"""A load from outside, a study from outside, and both as Dask sees them; types of the examples: test_typed_door.py."""

import json
import pickle
from importlib.util import find_spec

import h5py
import numpy as np
import pytest
from command import SCENARIOS

import sealdyn
from sealdyn import ScenarioError, read_scenario
from sealdyn.extensions import VARIABLE
from sealdyn.scene.scene import unforced

OWN, REFERENCE = SCENARIOS / "own", SCENARIOS / "fms_reference.toml"
PULSE = ["run.turns=4", "stator.load.model=gear_pulse", 'stator.load.gear_pulse.force="20 N"']
TONE = """from dataclasses import dataclass

import numpy as np

from sealdyn.units import Force, Frequency


@dataclass(frozen=True)
class Options:
    frequency: Frequency
    force: Force = 5.0


def load(time, options, scene):
    turned = 2.0 * np.pi * options.frequency * time
    return options.force * np.cos(turned), 0.01 * np.cos(turned), 0.0
"""


@pytest.fixture
def pulsed(monkeypatch):
    monkeypatch.setenv(VARIABLE, str(OWN))
    return read_scenario(REFERENCE, PULSE)


@pytest.fixture
def folder(tmp_path, monkeypatch):
    """A folder of loads on SEALDYN_PATH, with a tone."""
    (tmp_path / "loads").mkdir()
    (tmp_path / "loads" / "own_tone.py").write_text(TONE)
    monkeypatch.setenv(VARIABLE, str(tmp_path))
    return tmp_path / "loads"


@pytest.mark.core
def test_a_tone_of_ones_own_is_the_tone_of_the_package(folder):
    """The motion is that of [[stator.load.tone]] to the accuracy; its work is audited."""
    words = ["run.turns=4", "stator.load.model=own_tone", "stator.load.own_tone.frequency=300 Hz"]
    own = read_scenario(REFERENCE, words)
    tone = {"frequency": "300 Hz", "force": "5 N", "moment": "0.01 N*m"}
    given = read_scenario(REFERENCE, ["run.turns=4"]).with_({"stator.load.tone": [tone]})
    found, wanted = (sealdyn.simulate(scenario) for scenario in (own, given))
    for name, scale in (("stator_z", 1e-5), ("stator_tilt_x", 2.5e-4), ("stator_tilt_y", 2.5e-4)):
        assert np.abs(found.data[name] - wanted.data[name]).max() < 3e-6 * scale
    # Most of what moves along the axis is the load's doing.
    assert np.ptp(wanted.data.stator_z.values) > 1e-7 and found.summary["energy_residual"] < 1e-7
    assert unforced(own.scene, 1000.0).stator.load is None


def test_no_tone_is_too_fast_to_be_seen(folder):
    """One that has two whole periods between the first samples, 1024 over the run, and one to their middles."""
    duration = 4 * 2 * np.pi / 1000.0
    words = ["run.turns=4", "stator.load.model=own_tone", f"stator.load.own_tone.frequency={2048 / duration!r} Hz"]
    samples = read_scenario(REFERENCE, words).scene.stator.load.samples
    assert len(samples.time) > 20 * 1024 and max(samples.force) == pytest.approx(5.0, rel=1e-4)
    assert samples.time[0] <= 0.0 and samples.time[-1] >= duration


@pytest.mark.parametrize(
    "law, told",
    [
        ("np.where(time > 0.01, 5.0, 0.0), 0.0, 0.0", "smooth"),
        ("time, 0.0", "two moments"),
        ("np.nan * time, 0.0, 0.0", "finite"),
        ("time[:3], 0.0, 0.0", "ValueError"),
        ("strange(time), 0.0, 0.0", "NameError"),
    ],
)
def test_a_law_that_cannot_be_followed(folder, law, told):
    (folder / "odd.py").write_text(f"import numpy as np\n\n\ndef load(time, options, scene):\n    return {law}\n")
    with pytest.raises(ScenarioError) as refused:
        read_scenario(REFERENCE, ["run.turns=4", "stator.load.model=odd"])
    assert refused.value.key == "stator.load.model" and told in refused.value.found + refused.value.expected


@pytest.mark.parametrize(
    "key, value, found",
    [
        ("stator.load.model", "gear_puls", "gear_puls"),
        ("stator.load.gear_pulse.forse", 3.0, "unknown"),
        ("stator.load.gear_pulse.teeth", 0, "0"),
        ("stator.load.samples.time", [0.0, 1.0], "samples and a model"),
    ],
)
def test_what_is_wrong_with_a_load(pulsed, key, value, found):
    with pytest.raises(ScenarioError) as refused:
        pulsed.with_({key: value})
    assert refused.value.key.startswith("stator.load") and found in refused.value.found


@pytest.mark.core
def test_a_load_is_kept_and_runs_again(pulsed, tmp_path, monkeypatch):
    assert pickle.loads(pickle.dumps(pulsed)) == pulsed == sealdyn.Scenario.from_dict(pulsed.to_dict())
    assert pulsed.resolved()["stator"]["load"]["samples"] is None
    changed = pulsed.with_({"stator.load.gear_pulse.narrowness": 0.0})
    assert set(changed.scene.stator.load.samples.force) == {20.0} and len(pulsed.scene.stator.load.samples.time) > 2000
    path = tmp_path / "a.h5"
    found = sealdyn.run(pulsed, out=path).summary
    with h5py.File(path) as file:
        made = json.loads(file.attrs["outside"])
    assert list(made) == ["loads/gear_pulse"] and read_scenario(path) == pulsed
    assert sealdyn.run(path, out=tmp_path / "b.h5").summary["h_min"] == found["h_min"]
    rows = sealdyn.simulate_many(pulsed, [{}, {"stator.load.gear_pulse.force": 40.0}], ["h_min.value"], workers=2)
    assert rows["h_min.value"].values[0] == pytest.approx(found["h_min"]["value"], rel=1e-5)
    assert list(rows.status.values) == ["ok", "ok"]
    monkeypatch.setenv(VARIABLE, "")
    with pytest.raises(ScenarioError) as refused:
        read_scenario(path)
    assert refused.value.key == "stator.load.model" and made["loads/gear_pulse"] in refused.value.expected


def test_a_film_that_knows_no_leakage_under_a_load_is_certified(pulsed):
    """By a second run: what the film does not know has no error."""
    film = pulsed.with_film(OWN / "films" / "fed_film.py", supply_pressure="12 bar")
    found = sealdyn.simulate(film).summary
    assert found["status"] == "ok" and 0.0 < found["certificate"]["estimated"] <= 1e-6
    assert found["leakage"]["mean"] is None and found["friction"]["power"] > 0.0


def test_a_study_of_ones_own_keeps_its_points(pulsed, tmp_path):
    flags = {"key": "stator.load.gear_pulse.force", "values": [10.0, 40.0]}
    kept = {"flags": flags, "results": tmp_path / "kept"}
    answers = [sealdyn.run_study("least-film", pulsed, tmp_path / f"{n}.h5", workers=n, **kept) for n in (2, 1)]
    assert answers[0]["h_min"] == answers[1]["h_min"] and len([*(tmp_path / "kept").iterdir()]) == 2
    assert "least-film" in sealdyn.list_studies()


@pytest.mark.slow
@pytest.mark.skipif(find_spec("distributed") is None, reason="an extra: sealdyn[dask]")
def test_workers_of_dask(pulsed, tmp_path, monkeypatch):
    """With the folder they do the points, without it they say what is missing; none is lost."""
    from distributed import Client, LocalCluster

    film = pulsed.with_film(OWN / "films" / "fed_film.py", supply_pressure="12 bar")
    flags = {"key": "stator.load.gear_pulse.force", "values": [10.0, 40.0]}
    for there in (str(OWN), ""):
        monkeypatch.setenv(VARIABLE, there)
        with (
            LocalCluster(n_workers=1, threads_per_worker=1, dashboard_address=None) as cluster,
            Client(cluster) as client,
        ):
            client.wait_for_workers(1)
            monkeypatch.setenv(VARIABLE, str(OWN))
            answer = sealdyn.run_study("sweep", film, tmp_path / "a.h5", flags={"vary": [f"{flags['key']}=10,40 N"]},
                                       scheduler=client)  # fmt: skip
        told = [row.get("failed", "") for row in answer["rows"]]
        assert [("fed_film" in words or "gear_pulse" in words) for words in told] == [not there, not there]
