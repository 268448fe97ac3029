"""A run that goes on after it was stopped is the run: to the bit, whatever its scene and method."""

import h5py
import numpy as np
import pytest
from continued import SCENARIOS, differences, often, stopped
from hard_families import one_of

from sealdyn.archive import ArchiveError, last_state
from sealdyn.archive.files import seal
from sealdyn.archive.run import to_json
from sealdyn.scenario.reader import Scenario, read_scenario
from sealdyn.scenario.tables import Run
from sealdyn.simulation.simulate import simulate

SEALED = ("stator.secondary_seal.radius=45 mm", "stator.secondary_seal.line_friction=40 N/m")
# Followers leave the shaft and come back, also at the instants where it is stopped.
THROWN = ("run.turns=3", "shaft.eccentricity=0.3 mm")
# A scene each: one method's history, changes of the equations, fields, a film of unknowns, tries, a radial seal.
CASES = {
    "adams": ("fms_reference", ("run.solver=adams", "run.turns=30"), [2, 3]),
    "bdf": ("fms_reference", ("run.solver=bdf", "run.turns=30"), [2, 3]),
    "ida": ("massless_ring", ("run.turns=30",), [3, 2]),
    "dop853": ("fms_reference", ("run.solver=dop853", "run.turns=20"), [2, 1]),
    "radau": ("fms_reference", ("run.solver=radau", "run.turns=6"), [1, 1]),
    "expm": ("free_precession", (), [2, 1]),
    "a film with unknowns": ("rayleigh_pads", (), [2]),
    "contacts": ("rub_chaotic", ("run.turns=12",), [2, 9]),
    "an O-ring that sticks": ("rub", (*SEALED, "run.turns=45"), [2, 9]),
    "a sweep": ("housing_sweep", ("run.duration=0.1",), [1, 1]),
    "conditions that change": ("runup_through_critical", (), [5, 8]),
    "done again, sharper": ("squeeze", (), [1, 8, 12]),
    "a seal around the shaft": ("radial/circumferential_reference", THROWN, [20, 80]),
}


@pytest.mark.parametrize("name", CASES)
def test_to_the_bit(name, tmp_path, monkeypatch):
    """Series, fields, events, certificate, counts: all that the archive of the unbroken run holds."""
    often(monkeypatch.setattr)
    scene, words, after = CASES[name]
    scenario = read_scenario(SCENARIOS / f"{scene}.toml", words)
    whole = simulate(scenario, tmp_path / "whole.h5")
    times, again = stopped(scenario, tmp_path / "part.h5", after)
    assert times == len(after) and again.status == whole.status
    assert differences(whole.archive, again.archive) == []


@pytest.mark.parametrize("family, number", [("rubbing", 1), ("tilted_faces", 4)])
def test_a_start_serves_more_than_once(family, number, tmp_path, monkeypatch):
    """Drawn films that tear, stopped three times with few starts between: what is gone on from stays what it was."""
    often(monkeypatch.setattr)
    drawn = one_of(family, np.random.default_rng([7777, number]))
    scenario = Scenario(drawn.scene, Run(duration=drawn.duration, accuracy=drawn.accuracy))
    whole = simulate(scenario, tmp_path / "whole.h5")
    times, again = stopped(scenario, tmp_path / "part.h5", [2, 3, 5])
    assert times > 1 and differences(whole.archive, again.archive) == []


def test_a_method_starts_anew_whoever_looks(tmp_path, monkeypatch):
    """A run of few steps is one stretch; a longer one is several, and within its accuracy the same."""
    scenario = read_scenario(SCENARIOS / "fms_reference.toml", ("run.solver=adams", "run.turns=30"))
    one = simulate(scenario, tmp_path / "one.h5").summary
    often(monkeypatch.setattr)
    many = simulate(scenario, tmp_path / "many.h5").summary
    assert one["counts"]["restarts"] == 1 < many["counts"]["restarts"]
    assert abs(one["h_min"]["value"] / many["h_min"]["value"] - 1.0) < 3.0 * scenario.run.accuracy
    # Two hundred steps or so each time.
    extra = many["counts"]["rhs"] - one["counts"]["rhs"]
    assert extra < 600 * many["counts"]["restarts"]


@pytest.mark.parametrize("wrong", ["written", "account", "y", "records"])
def test_a_start_that_is_none_is_refused(wrong, tmp_path, monkeypatch):
    """Not gone on with: one line."""
    often(monkeypatch.setattr)
    scenario = read_scenario(SCENARIOS / "fms_reference.toml", ("run.solver=adams", "run.turns=30"))
    calls = iter(range(3))
    simulate(scenario, tmp_path / "x.h5", stop=lambda: next(calls, None) is None)
    state = last_state(tmp_path / "x.h5")
    state["point"][wrong] = {"written": [10**9, 0, 0], "account": {"tolerance": -1.0}, "y": [1.0], "records": "x"}[
        wrong
    ]
    with h5py.File(tmp_path / "x.h5", "r+") as file:
        file["restart"].attrs["state"] = to_json(state)
        seal(file)
    with pytest.raises(ArchiveError, match="none of this run"):
        simulate(scenario, tmp_path / "x.h5", resume=True)
