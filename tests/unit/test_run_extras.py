"""What a summary has beside the integration: it may fail alone, and is of the conditions at the end of the run."""

import numpy as np
import pytest
from command import SCENARIOS

import sealdyn
from sealdyn.scenario.reader import read_scenario
from sealdyn.scene.scene import SceneError
from sealdyn.simulation import stability, summary
from sealdyn.simulation.simulate import simulate, simulate_in_memory
from sealdyn.solvers import sundials_direct


def summary_of(name, *overrides):
    return simulate_in_memory(read_scenario(SCENARIOS / f"{name}.toml", overrides), speeds=True)


# --- what may fail ------------------------------------------------------------------------------------

THINNED = ["film.inertia=true", "film.coning=-0.1 mrad", "shaft.speed=3000 rpm", "run.turns=0.5", "rotor.runout=1e-6"]
FOLLOWS = ["film.coning=-0.1 mrad", "shaft.speed=3000 rpm", "run.turns=0.5", "rotor.runout=1e-6",
           "film.coning_per_speed_squared=-1e-10"]  # fmt: skip


@pytest.mark.core
@pytest.mark.parametrize("changes", [THINNED, FOLLOWS], ids=["inertia", "coning"])
def test_a_speed_without_a_film_ends_no_run(changes):
    found = summary_of("fms_reference", *changes)
    assert found["status"] == "ok"
    low, high = found["stability"]["speeds_held"]
    assert low < found["stability"]["speed"] < high
    for speeds in (found["stability"]["thresholds"], found["stability"]["resonance_speeds"]):
        assert all(low <= speed <= high for speed in speeds)


@pytest.mark.parametrize("error", [SceneError("shaft.speed", "1 rad/s", "2"), ZeroDivisionError("division by zero"),
                                   np.linalg.LinAlgError("singular")], ids=lambda e: type(e).__name__)  # fmt: skip
@pytest.mark.parametrize("where, what", [
    (stability, "thresholds"), (stability, "resonance_speeds"), (summary, "contact_margin"), (summary, "_closed_form"),
    (summary, "aligned_flow"), (summary, "stability"),
])  # fmt: skip
def test_an_extra_that_fails_is_null_with_a_sentence(monkeypatch, where, what, error):
    def fails(*given):
        raise error

    whole = summary_of("fms_reference", "run.turns=0.2")
    monkeypatch.setattr(where, what, fails)
    found = summary_of("fms_reference", "run.turns=0.2")
    assert found["status"] == "ok" and found.keys() == whole.keys()
    (said,) = set(found["warnings"]) - set(whole["warnings"])
    assert str(error) in said
    gone = {"thresholds": found["stability"]["thresholds"], "resonance_speeds": found["stability"]["resonance_speeds"],
            "contact_margin": found["contact_margin"], "_closed_form": found["closed_form"].get("relative_max"),
            "aligned_flow": found["film"]["leakage"], "stability": found["stability"]["verdict"]}  # fmt: skip
    both = ["thresholds", "resonance_speeds", "stability"] if what == "stability" else [what]
    assert [name for name, value in gone.items() if value is None] == both
    assert found["film"].keys() == whole["film"].keys() and found["h_min"] == whole["h_min"]


def test_a_film_without_a_solution_at_the_end_leaves_the_rest(tmp_path):
    """Pressure rises on a dam that opens outwards, held open, until its entrance chokes."""
    changes = ["film.coning=22 mrad", "film.clearance=9 um", "stator.support.axial_stiffness=1e10",
               'film.inner_pressure={time=[0, 0.01], value=["2 bar", "80 bar"]}', "run.duration=0.01"]  # fmt: skip
    result = sealdyn.run(SCENARIOS / "gas_dam_reference.toml", changes, out=tmp_path / "a.h5")
    assert result.status == "failed" and 0.0 < result.summary["end"]["time"] < 0.01
    found = result.summary
    assert found["stability"]["verdict"] is None or found["stability"]["modes"]
    assert found["leakage"]["mean"] > 0.0 and found["h_min"]["value"] > 0.0


# --- at the end ---------------------------------------------------------------------------------------


@pytest.mark.core
def test_aligned_numbers_are_of_the_speed_at_the_end():
    """Of a ramp that outlasts the run."""
    ramp = 'shaft.speed={time=[0, 1], value=["0 rpm", "72000 rpm"]}'
    found = summary_of("fms_reference", ramp, "run.duration=0.01")
    still = summary_of("fms_reference", "shaft.speed=720 rpm", "run.turns=0.1")
    assert found["stability"]["speed"] == pytest.approx(still["stability"]["speed"], rel=1e-12)
    assert found["stability"]["modes"] == [pytest.approx(mode) for mode in still["stability"]["modes"]]
    for key in ("friction_power", "leakage", "tilt_stiffness", "tilt_damping", "cross_stiffness"):
        assert found["film"][key] == pytest.approx(still["film"][key], rel=1e-9), key
    # The shaft has not been at rest at any frequency.
    assert "relative_max" not in found["closed_form"] and found["contact_margin"] is None


@pytest.mark.parametrize("key, ends", [
    ("film.outer_pressure", (5e5, 7e5)), ("film.viscosity", (5e-4, 8e-4)), ("film.coning", (3e-3, 2.5e-3)),
])  # fmt: skip
def test_other_conditions_are_those_of_the_end_too(key, ends):
    """Half way through a table, and where the same number has stood for a while."""
    middle, end = 0.5 * sum(ends), "run.duration=0.005"
    found = summary_of("fms_reference", f"{key}={{time=[0, 0.01], value={list(ends)}}}", end)
    still = summary_of("fms_reference", f"{key}={{time=[0, 0.001], value={[ends[0], middle]}}}", end)
    for name in ("clearance", "leakage", "friction_power", "axial_stiffness", "tilt_damping"):
        assert found["film"][name] == pytest.approx(still["film"][name], rel=1e-6), name
    assert found["closing"] == pytest.approx(still["closing"], rel=1e-9)
    assert found["stability"]["growth_rate"] == pytest.approx(still["stability"]["growth_rate"], rel=1e-6)


def test_an_interrupted_run_knows_of_the_contact_that_goes_on(tmp_path, monkeypatch):
    """And counts it once when it has gone on to its end."""
    # Often enough asked whether to stop.
    monkeypatch.setattr(sundials_direct, "BLOCK", 200)
    scenario = read_scenario(SCENARIOS / "run_in.toml", ["rotor.runout=0.5 urad", "run.turns=10"])
    seen, whole = [], simulate(scenario, tmp_path / "whole.h5").summary
    contact, end = whole["contact"], whole["end"]["time"]
    assert contact["touches"] == 1 and contact["longest"] == pytest.approx(end)
    found = simulate(scenario, tmp_path / "a.h5", progress=lambda *at: seen.append(at), stop=lambda: bool(seen)).summary
    assert found["status"] == "interrupted" and found["end"]["time"] < 0.9 * end
    assert found["contact"]["touches"] == 1 and found["contact"]["longest"] == pytest.approx(found["end"]["time"])
    assert found["contact"]["depth"] > 0.0 and 0.0 < found["contact"]["impulse"] < contact["impulse"]
    again = simulate(scenario, tmp_path / "a.h5", resume=True).summary
    assert again["status"] == "ok"
    for key in ("touches", "longest", "lowest", "impulse"):
        assert again["contact"][key] == pytest.approx(contact[key], rel=1e-4), key
