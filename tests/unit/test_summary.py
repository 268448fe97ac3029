"""What a summary advises."""

from pathlib import Path

import numpy as np
import pytest

import sealdyn
from sealdyn.archive import column, read_info
from sealdyn.dynamics.signals import signals
from sealdyn.report.charts import overview
from sealdyn.report.text import lines
from sealdyn.scenario.reader import read_scenario
from sealdyn.simulation.simulate import prepare_run, simulate_in_memory

SCENARIOS = Path(__file__).parents[2] / "scenarios"
SEAL = SCENARIOS / "fms_reference.toml"


@pytest.mark.parametrize("start", ["rest", "steady"])
def test_a_run_that_is_not_steady_is_not_told_to_start_as_it_did(start):
    """Above its threshold the reference seal's whirl grows from any start."""
    changes = ["run.turns=3", "run.accuracy=1e-8", "shaft.speed=6500 rad/s", f"run.start='{start}'"]
    sentence = simulate_in_memory(read_scenario(SEAL, changes))["relative_misalignment"]["steady_said"]
    assert sentence.startswith("not steady") and ("run.start" in sentence) == (start == "rest")


def test_a_run_that_begins_settled_has_no_transient():
    """Nonlinear motion leaves the linear start by less than the accuracy, though the printed digits differ."""
    scenario = read_scenario(
        SCENARIOS / "fmr_reference.toml", ["run.turns=12", "run.start='auto'", "run.accuracy=1e-4"]
    )
    summary = simulate_in_memory(scenario, speeds=True)
    assert summary["model"]["start"] == "steady"
    assert summary["relative_misalignment"]["max"] != summary["relative_misalignment"]["steady_max"]
    names = [name for name, _ in printed(scenario, summary)]
    assert "whole run" in names and "transient" not in names


@pytest.mark.parametrize(("key", "value"), [("rotor.runout", "1 nrad"), ("stator.misalignment", "0.1 urad")])
def test_the_settled_motion_is_part_of_the_run(key, value):
    """Also of tilts that are small beside the accuracy, whose extremes need not be located."""
    still = ["rotor.runout=0", "stator.misalignment=0", "run.start='steady'", "run.turns=40", "run.accuracy=1e-2"]
    summary = simulate_in_memory(read_scenario(SEAL, [*still, "rotor.runout=1 urad", f"{key}={value}"]))
    tilt, h_min = summary["relative_misalignment"], summary["h_min"]
    assert tilt["min"] <= tilt["steady_min"] <= tilt["steady_max"] <= tilt["max"]
    assert h_min["value"] <= h_min["steady"]


def test_extremes_enclose_the_samples_that_are_kept(tmp_path):
    """Also those beside which nothing better was worth locating; and the event is the summary's thinnest film."""
    still = ["stator.misalignment='0.1 urad'", "rotor.runout='1 nrad'", "run.turns=12", "run.accuracy=1e-2"]
    result = sealdyn.simulate(read_scenario(SEAL, [*still, "film.model='radial'"]), tmp_path / "still.h5")
    low, tilt = result.summary["h_min"], result.summary["relative_misalignment"]
    time, films, tilts = (column(result.archive, name) for name in ("time", "h_min", "relative_misalignment"))
    assert low["value"] <= films.min() and tilt["min"] <= tilts.min() < tilts.max() <= tilt["max"]
    # The last period is one turn.
    last = time >= time[-1] * (1 - 1 / 12 + 1e-9)
    assert low["steady"] <= films[last].min()
    assert tilt["steady_min"] <= tilts[last].min() < tilts[last].max() <= tilt["steady_max"]
    (event,) = read_info(result.archive)["events"]
    assert (event["time"], event["value"]) == (low["time"], low["value"])
    # A tilt is told where the accuracy resolves it: a hundredth of the clearance over the radius.
    low["radius"], tilt["steady_max"], tilt["max"] = 1e-2, 9e-6, 9e-6
    said = [words for name, words in printed(read_scenario(SEAL), result.summary) if "below" in words]
    assert said[0].startswith("settled: below 10 urad, less than") and said[1] == "misalignment below 10 urad"


@pytest.mark.parametrize("film", ["linear", "radial"])
def test_leakage_runs_from_high_to_low_pressure_also_where_they_turn(film):
    """Pressures that change sides halfway: as much leaks after it as before."""
    changes = [
        f"film.model='{film}'", "film.coning=0", "run.start='rest'", "run.duration='20 ms'", "run.samples=200",
        "rotor.runout=0", "stator.misalignment=0", "closing.balance_ratio=0.8",
        "film.outer_pressure={time=[0, '10 ms', '10.1 ms'], value=['3 bar', '3 bar', '1 bar']}",
        "film.inner_pressure={time=[0, '10 ms', '10.1 ms'], value=['1 bar', '1 bar', '3 bar']}",
    ]  # fmt: skip
    scenario = read_scenario(SEAL, changes)
    run, *_ = prepare_run(scenario)
    first, last = run.segment(0), run.segment(len(run.intervals) - 1)
    n = first.n
    found = [float(signals(part, np.zeros(1), *np.zeros((2, 1, n)))["leakage_inner"][0]) for part in (first, last)]
    assert found[0] > 0 and found[1] == pytest.approx(found[0], rel=0.1)


def printed(scenario, summary):
    """[name, words] of the lines for a person; a line that goes on has no name."""
    whole = {**summary, "archive": "x.h5", "figure": None}
    return [[line[:16].strip(), line[16:]] for line in lines(scenario, whole)[1:]]


def test_a_contact_that_lasts_all_the_run_is_told_as_that():
    scenario = read_scenario(SEAL, ["run.turns=1"])
    summary = simulate_in_memory(scenario, speeds=True)
    numbers = ("depth", "impulse", "share_of_closing", "wear_rate", "max_pressure", "max_area_fraction", "gap_error")
    contact = dict.fromkeys(numbers, 0.1) | {"touches": 1, "grazing": 0, "first": 0.0, "force": {"max": 1.0}}
    end = summary["end"]["time"]
    for longest, words in ((end, "in contact all the time, deepest"), (0.9 * end, "1 contact, first at t = 0 s")):
        rows = dict(printed(scenario, {**summary, "contact": contact | {"longest": longest}}))
        assert rows["touch"].startswith(words)


def test_the_settled_part_comes_first_and_the_transient_by_its_name():
    scenario = read_scenario(SEAL, ["run.turns=12", "run.start='rest'", "run.accuracy=1e-4"])
    summary = simulate_in_memory(scenario, speeds=True)
    low, tilt = summary["h_min"], summary["relative_misalignment"]
    # The start at rest is thinner than all that follows.
    assert low["steady"] > 1.05 * low["value"] and tilt["steady_max"] < 0.5 * tilt["max"]
    rows = printed(scenario, summary)
    names = [name for name, _ in rows]
    assert names.index("h_min") < names.index("misalignment") < names.index("transient")
    said = dict(row for row in rows if row[0])
    assert f"{low['steady'] * 1e6:.4g} um" in said["h_min"] and f"{low['value'] * 1e6:.4g} um" in said["transient"]
    assert f"max {tilt['steady_max'] * 1e6:.4g}" in said["misalignment"]
    assert "O-ring" not in said["misalignment"]
    held = dict(printed(scenario, {**summary, "secondary_seal": {"rings": {}, "sticks": None}}))
    assert held["misalignment"] == said["misalignment"].removesuffix(")") + ", without the O-ring)"
    short = simulate_in_memory(read_scenario(SEAL, ["run.turns=1.5", "run.start='rest'"]), speeds=True)
    assert short["h_min"]["steady"] is None
    names = [name for name, _ in printed(scenario, short)]
    assert names.index("steady state") < names.index("h_min") and "transient" not in names


@pytest.mark.core
def test_the_margin_ends_where_asperities_meet():
    """Linear theory of the reference seal: gap over reach at an edge; asperities of 3 rms take their height away."""
    rough = ["contact.compressive_strength='300 MPa'", "run.turns=1", "run.accuracy=1e-4", "run.start='rest'"]
    margins = {}
    for rms in (0.1, 1.0):
        scenario = read_scenario(SEAL, [*rough, f"contact.roughness='{rms} um'"])
        margins[rms] = simulate_in_memory(scenario)["contact_margin"]
    smooth = simulate_in_memory(read_scenario(SEAL, rough[1:]))["contact_margin"]
    assert margins[0.1] == pytest.approx(smooth * (10 - 0.3) / 10, rel=1e-6)
    assert margins[1.0] == pytest.approx(smooth * (10 - 3.0) / 10, rel=1e-6)


def test_asperities_that_touch_without_forcing_leave_no_margin():
    scenario = read_scenario(SCENARIOS / "run_in.toml", ["run.turns=0.5", "run.accuracy=1e-3"])
    summary = simulate_in_memory(scenario, speeds=True)
    assert summary["contact"]["share_of_closing"] > 0.05 and summary["contact_margin"] == 0.0
    (said,) = [words for name, words in printed(scenario, summary) if name == "contact"]
    assert "times" not in said
    # Both shares: of the closing force, and of it above the lower pressure.
    low, contact = scenario.scene.film.inner_pressure, summary["contact"]
    above = summary["closing"]["force"] - low * summary["closing"]["face_area"]
    assert contact["share_of_load"] == pytest.approx(contact["force"]["mean"] / above, rel=1e-9)
    assert contact["share_of_load"] > contact["share_of_closing"]
    told = " ".join(words for _, words in printed(scenario, summary))
    assert f"{100 * contact['share_of_closing']:.4g} % of the absolute closing force" in told
    assert f"{100 * contact['share_of_load']:.4g} % of what" in told and "asperities included" in told
    assert {"film and asperities"} == {"film and asperities", "film stiffness"} & set(
        dict(overview._numbers(summary, ("rad/s", 1.0)))
    )


def test_faces_without_a_wear_coefficient_have_no_rate_of_wear():
    bare = [
        "run.turns=0.5",
        "run.accuracy=1e-3",
        "contact.stator_wear_coefficient=0",
        "contact.rotor_wear_coefficient=0",
    ]
    for changes, words in ((bare, "no wear coefficient"), (bare[:2], "um/h")):
        scenario = read_scenario(SCENARIOS / "run_in.toml", changes)
        told = printed(scenario, simulate_in_memory(scenario, speeds=True))
        assert sum(words in line for _, line in told) == 1


def test_heat_that_no_leakage_carries_is_told_per_area():
    changes = ["film.clearance=1 um", "film.coning=0.3 mrad", "run.turns=1", "run.accuracy=1e-3"]
    for speed, hot in ((80, False), (250, True)):
        scenario = read_scenario(SEAL, [*changes, f"shaft.speed={speed} rad/s"])
        summary = simulate_in_memory(scenario, speeds=True)
        said = dict(printed(scenario, summary))["friction"]
        flux = f"{1e-4 * summary['friction']['power'] / summary['closing']['face_area']:.4g} W/cm^2"
        assert (summary["friction"]["temperature_rise"] > 100) == hot == (flux in said) == ("heat the" not in said)


def test_a_gas_dam_says_whether_it_chokes_and_how_fast_the_gas_leaves():
    """Zuk (1972): parallel faces at a high pressure choke, at a low one the gas is slow."""
    for pressure, chokes in (("60 bar", True), ("1.5 bar", False)):
        changes = [f"film.inner_pressure={pressure}", "run.turns=0.2", "run.accuracy=1e-2"]
        scenario = read_scenario(SCENARIOS / "gas_dam_reference.toml", changes)
        summary = simulate_in_memory(scenario, speeds=True)
        mach = summary["film"]["exit_mach"]
        assert (mach == pytest.approx(1.0, rel=1e-6)) if chokes else 0.0 < mach < 0.95
        (told,) = [words for _, words in printed(scenario, summary) if "Mach" in words]
        assert ("not choked" in told) != chokes and f"{mach:.4g}" in told
        # The figure has the leakage of a gas as the text has it.
        litres = 1e3 * 60 * summary["leakage"]["mean"]
        assert dict(overview._numbers(summary, ("rad/s", 1.0)))["mean leakage"].startswith(f"{litres:.4g} l/min (0 °C")
    assert simulate_in_memory(read_scenario(SEAL, ["run.turns=1"]))["film"]["exit_mach"] is None


IN_A_DAM = [
    "film.inner_pressure={time=[0, '15 ms', '20 ms'], value=['14 bar', '14 bar', '8 bar']}", "run.duration='60 ms'",
    "rotor.runout=0", "stator.misalignment=0", "run.accuracy=1e-4",
]  # fmt: skip


@pytest.mark.parametrize("name, changes", [("axial_only", []), ("gas_dam_reference", IN_A_DAM)])
def test_beside_the_means_of_a_run_stands_the_aligned_seal_at_its_end(name, changes):
    """Means over a step of the pressure are numbers of neither side of it."""
    scenario = read_scenario(SCENARIOS / f"{name}.toml", changes)
    result = sealdyn.run(scenario)
    film, said = result.summary["film"], "\n".join(words for _, words in printed(scenario, result.summary))
    for key, signal in (("leakage", "leakage_outer"), ("friction_power", "friction_power")):
        assert film[key] == pytest.approx(float(result.data[signal][-1]), rel=1e-3)
    assert "aligned, at the end of the run" in said
    if film["exit_mach"] is not None:
        before = sealdyn.evaluate(scenario, {"film.inner_pressure": "14 bar"}, "film.exit_mach")["film.exit_mach"]
        assert film["exit_mach"] < 0.9 * before


def test_a_critical_speed_of_no_seal_is_none():
    """Stiff films of a fraction of a micrometre had theirs at millions of rpm."""
    scenario = read_scenario(SEAL, ["run.turns=2", "shaft.speed='9000 rpm'"])
    summary = simulate_in_memory(scenario, speeds=True) | {"wall_time": 1.0}
    found = summary["stability"]
    assert found["fastest"] == pytest.approx(1000.0 / 0.040)

    def words(**changes):
        told = {**summary, "stability": {**found, **changes}}
        return dict(printed(scenario, told))["stability"], dict(overview._numbers(told, ("rpm", 9.549)))

    here, sheet = words(resonance_speeds=[100.0, 1e6])
    assert "critical speed 53370 rpm (stable below)" in here and "critical speed" in sheet
    assert here.endswith("resonance of a tilt at 954.9 rpm (all modes: study campbell)")
    here, sheet = words(critical_speed=7e5, thresholds=[7e5, 8e5])
    assert "no critical speed up to 238700 rpm, faster than any such face turns" in here and "again" not in here
    assert "critical speed" not in sheet
