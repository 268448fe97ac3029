"""What a summary advises."""

import math
import re

import numpy as np
import pytest
from command import SCENARIOS

import sealdyn
from sealdyn.answers import Line
from sealdyn.archive import column, read_info
from sealdyn.dynamics.signals import signals
from sealdyn.quantities import in_words
from sealdyn.report.charts import overview
from sealdyn.report.summary import _seal_lines, run_answer
from sealdyn.report.text import line_words, lines
from sealdyn.scenario.reader import parse_scenario, read_scenario
from sealdyn.scene.fluid import density_of, gas_of
from sealdyn.scene.rings import SMALL_TILT
from sealdyn.simulation.simulate import prepare_run, simulate_in_memory

SEAL = SCENARIOS / "fms_reference.toml"


def summary_of(changes, path=SEAL):
    """With critical and resonance speeds."""
    return simulate_in_memory(read_scenario(path, changes), speeds=True)


@pytest.mark.parametrize(
    "start, speed, advised", [("rest", 1000, True), ("rest", 6500, False), ("steady", 6500, False)]
)
def test_a_run_that_is_not_steady_is_told_to_start_otherwise_where_that_helps(start, speed, advised):
    """Above its threshold the reference seal's whirl grows from any start."""
    changes = ["run.turns=3", "run.accuracy=1e-8", f"shaft.speed={speed} rad/s", f"run.start='{start}'"]
    sentence = simulate_in_memory(read_scenario(SEAL, changes))["relative_misalignment"]["steady_said"]
    assert sentence.startswith("not steady") and ("run.start" in sentence) == advised


def test_a_run_that_begins_settled_has_no_transient():
    """Nonlinear motion leaves the linear start by less than the accuracy, though the printed digits differ."""
    changes = ["run.turns=12", "run.start='auto'", "run.accuracy=1e-4"]
    summary = summary_of(changes, SCENARIOS / "fmr_reference.toml")
    assert summary["model"]["start"] == "steady"
    assert summary["relative_misalignment"]["max"] != summary["relative_misalignment"]["steady_max"]
    films = numbers_of(summary, "h_min").values()
    assert summary["h_min"]["steady"] in films and summary["h_min"]["value"] not in films


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
    assert words_of(result.summary)["misalignment"].count("below 10 urad") >= 2


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


def parts_of(summary):
    """{label: parts} of all lines of a summary; those that go on join the last label."""
    found, label = {}, ""
    for line in run_answer({**summary, "archive": "x.h5", "figure": None, "wall_time": 1.0}).lines:
        label = line.label or label
        found.setdefault(label, []).extend(line.parts)
    return found


def numbers_of(summary, label):
    """{words: value} of the parts of a label that are numbers."""
    return {words: value for words, value, *_ in parts_of(summary).get(label, ()) if isinstance(value, float | int)}


def words_of(summary):
    """{label: words} of what is printed."""
    return {label: line_words(Line(label, parts)) for label, parts in parts_of(summary).items()}


@pytest.mark.parametrize("name", ["fms_reference", "run_in", "gas_dam_reference", "hang_up"])
def test_what_is_printed_first_is_at_most_fifteen_lines(name):
    summary = summary_of(["run.turns=1", "run.accuracy=1e-3"], SCENARIOS / f"{name}.toml")
    answer = run_answer(summary | {"archive": "x.h5", "figure": None, "wall_time": 1.0})
    few, all_of_it = (lines(name, answer, verbose) for verbose in (False, True))
    assert len(few) - len(answer.notes) <= 16 and set(few) <= set(all_of_it)
    assert all(any(warning in line for line in few) for warning in summary["warnings"])


def test_a_contact_that_lasts_all_the_run_is_told_as_that():
    summary = summary_of(["run.turns=1"])
    shares = "share_of_closing", "share_of_load", "max_area_fraction"
    contact = dict.fromkeys(("depth", "impulse", "wear_rate", "max_pressure", *shares), 0.1)
    contact |= {"touches": 1, "grazing": 0, "wears": True, "first": 0.0, "force": {"max": 1.0}}
    end = summary["end"]["time"]
    for longest, all_of_it in ((end, True), (0.9 * end, False)):
        told = numbers_of({**summary, "contact": contact | {"longest": longest}}, "touch")
        assert ("first at" in told) != all_of_it and told["deepest"] == 0.1


def test_the_settled_part_comes_first_and_the_transient_by_its_name():
    summary = summary_of(["run.turns=12", "run.start='rest'", "run.accuracy=1e-4"])
    low, tilt = summary["h_min"], summary["relative_misalignment"]
    # The start at rest is thinner than all that follows.
    assert low["steady"] > 1.05 * low["value"] and tilt["steady_max"] < 0.5 * tilt["max"]
    film = numbers_of(summary, "h_min")
    assert film["settled"] == low["steady"] and film["whole run"] in (low["value"], low["of_clearance"])
    assert numbers_of(summary, "misalignment")["largest of the run"] == tilt["max"]
    short = summary_of(["run.turns=1.5", "run.start='rest'"])
    assert short["h_min"]["steady"] is None and "steady state" in parts_of(short)
    assert "settled" not in numbers_of(short, "h_min")


@pytest.mark.core
def test_the_margin_ends_where_asperities_meet():
    """Linear theory of the reference seal: gap over reach at an edge; asperities of 3 rms take their height away."""
    # So light that the film is laminar up to there.
    plain = ["film.density=100", "run.turns=1", "run.accuracy=1e-4", "run.start='rest'"]
    rough = ["contact.compressive_strength='300 MPa'", *plain]
    margins = {}
    for rms in (0.1, 1.0):
        scenario = read_scenario(SEAL, [*rough, f"contact.roughness='{rms} um'"])
        margins[rms] = simulate_in_memory(scenario)["contact_margin"]
    smooth = simulate_in_memory(read_scenario(SEAL, plain))["contact_margin"]
    assert margins[0.1] == pytest.approx(smooth * (10 - 0.3) / 10, rel=1e-6)
    assert margins[1.0] == pytest.approx(smooth * (10 - 3.0) / 10, rel=1e-6)


def test_a_run_whose_speed_changes_tells_from_where_to_where():
    short = ["run.duration=0.02", "run.start='rest'", "run.accuracy=1e-3"]
    for ramp, end in ((["shaft.speed={time=[0, 1], value=[1000, 2000]}"], 1020.0), ([], 1000.0)):
        found = summary_of([*short, *ramp])
        assert found["speed"] == pytest.approx({"start": 1000.0, "end": end})
        assert ("speed" in parts_of(found)) == bool(ramp)


def test_a_margin_ends_where_tilts_are_small_no_more():
    """A stator that follows the runout: what is left between the faces would let the forcing grow without end."""
    pump = re.search(r"```toml\n(.*?)```", (SCENARIOS.parent / "README.md").read_text(), re.DOTALL)[1]
    scenario = parse_scenario(pump, "pump", ["run.turns=1"])
    found = simulate_in_memory(scenario)
    own = found["closed_form"]["relative_max"] * found["contact_margin"] * scenario.scene.film.outer_radius
    assert found["contact_margin_limit"] == "small tilts" and own < 0.1 * found["film"]["clearance"]
    # The ring tilts by as much as the rotor is out of square, and a ten-thousandth more.
    assert found["contact_margin"] * scenario.scene.rotor.runout == pytest.approx(SMALL_TILT, rel=1e-3)
    held = simulate_in_memory(read_scenario(SEAL, ["run.turns=1", "film.density=100"]))
    assert held["contact_margin_limit"] == "touch"


@pytest.mark.parametrize("reynolds, ends", [(0.8, "laminar film"), (0.2, "touch"), (1.2, "touch")])
def test_a_margin_ends_where_the_film_is_laminar_no_more(reynolds, ends):
    """An edge opens as it closes, up to rho U h = 1000 mu; a film that is beyond it at rest has a caution instead."""
    film = read_scenario(SEAL).scene.film
    shaft, edges = 1000.0, (film.inner_radius, film.outer_radius)
    gaps = [film.clearance + film.coning * (r - edges[0]) for r in edges]
    per_density = max(shaft * r * h for r, h in zip(edges, gaps, strict=True)) / film.viscosity
    density = 1000.0 * reynolds / per_density
    short = ["run.turns=1", "run.start='rest'", f"film.density={density}"]
    found = simulate_in_memory(read_scenario(SEAL, short))
    assert found["contact_margin_limit"] == ends
    if ends != "touch":
        theory, limit = found["closed_form"], 1000.0 * film.viscosity / density / shaft
        room = [(limit / r - h) / (r * theory["relative_max"] + theory["axial_closing"])
                for r, h in zip(edges, gaps, strict=True)]  # fmt: skip
        assert found["contact_margin"] == pytest.approx(min(room), rel=1e-6)


@pytest.mark.parametrize("speed, ends", [(0.2, "slow gas"), (0.06, "touch"), (0.4, "touch")])
def test_a_margin_ends_where_the_gas_is_slow_no_more(speed, ends):
    """Mach number of the aligned leakage, which grows with the square of what an edge opens to; one beyond 0.3 at rest
    is a caution, a slow one ends nothing."""
    short = ["run.turns=0.05", "run.accuracy=0.1", "stator.misalignment=0"]
    path = SCENARIOS / "gas_reynolds_reference.toml"
    whole = read_scenario(path, short)
    film, gas = whole.scene.film, gas_of(whole.scene.film)

    def mach(found):
        low = min(film.inner_pressure, film.outer_pressure)
        radius = film.inner_radius if film.outer_pressure > film.inner_pressure else film.outer_radius
        sound = math.sqrt(gas.heat_ratio * gas.gas_constant * film.temperature)
        flow = found["film"]["leakage"] * density_of(film) / (2.0 * math.pi * radius)
        return flow * gas.gas_constant * film.temperature / low / found["film"]["clearance"] / sound

    # Of faces alike in shape.
    grown = math.sqrt(speed / mach(simulate_in_memory(whole)))
    thick, coning = grown * film.clearance, grown * film.coning
    found = simulate_in_memory(read_scenario(path, [*short, f"film.clearance={thick}", f"film.coning={coning}"]))
    assert mach(found) == pytest.approx(speed, rel=0.02) and found["contact_margin_limit"] == ends
    if ends != "touch":
        theory = found["closed_form"]
        reach = film.inner_radius * theory["relative_max"] + theory["axial_closing"]
        opened = thick * (math.sqrt(0.3 / mach(found)) - 1.0) / reach
        assert found["contact_margin"] == pytest.approx(opened, rel=1e-6)


@pytest.mark.parametrize("film, met", [("radial", True), ("linear", False)])
def test_what_is_said_of_the_accuracy_is_printed_once(film, met, tmp_path):
    """As a line, or where it is not met as a warning: it was both."""
    result = sealdyn.run(SEAL, [f"film.model={film}", "run.turns=1", "run.accuracy=1e-4"], out=tmp_path / "a.h5")
    found = result.summary["certificate"]
    assert found["met"] is met
    assert "\n".join(lines("a", run_answer(result.summary))).count(found["said"]) == 1


def test_asperities_that_touch_without_forcing_leave_no_margin():
    scenario = read_scenario(SCENARIOS / "run_in.toml", ["run.turns=0.5", "run.accuracy=1e-3"])
    summary = simulate_in_memory(scenario, speeds=True)
    assert summary["contact"]["share_of_closing"] > 0.05 and summary["contact_margin"] == 0.0
    assert not numbers_of(summary, "margin")
    # Both shares: of the closing force, and of it above the lower pressure.
    low, contact = scenario.scene.film.inner_pressure, summary["contact"]
    above = summary["closing"]["force"] - low * summary["closing"]["face_area"]
    assert contact["share_of_load"] == pytest.approx(contact["force"]["mean"] / above, rel=1e-9)
    assert contact["share_of_load"] > contact["share_of_closing"]
    assert contact["share_of_load"] in numbers_of(summary, "touch").values()
    assert {"film and asperities"} == {"film and asperities", "film stiffness"} & set(dict(overview._numbers(summary)))


def test_faces_without_a_wear_coefficient_have_no_rate_of_wear():
    plain = ["run.turns=0.5", "run.accuracy=1e-3"]
    bare = [*plain, "contact.stator_wear_coefficient=0", "contact.rotor_wear_coefficient=0"]
    for changes, wears in ((bare, False), (plain, True)):
        scenario = read_scenario(SCENARIOS / "run_in.toml", changes)
        assert ("wear" in parts_of(simulate_in_memory(scenario, speeds=True))) == wears


def test_heat_that_no_leakage_carries_is_told_per_area():
    changes = ["film.clearance=1 um", "film.coning=0.3 mrad", "run.turns=1", "run.accuracy=1e-3"]
    for speed, hot in ((80, False), (250, True)):
        summary = summary_of([*changes, f"shaft.speed={speed} rad/s"])
        told = numbers_of(summary, "friction")
        assert (summary["friction"]["temperature_rise"] > 100) == hot == ("of face" in told)
        assert ("would heat the leakage by" in told) != hot


def test_a_gas_dam_says_whether_it_chokes_and_how_fast_the_gas_leaves():
    """Zuk (1972): parallel faces at a high pressure choke, at a low one the gas is slow."""
    for pressure, chokes in (("60 bar", True), ("1.5 bar", False)):
        changes = [f"film.inner_pressure={pressure}", "run.turns=0.2", "run.accuracy=1e-2"]
        summary = summary_of(changes, SCENARIOS / "gas_dam_reference.toml")
        mach = summary["film"]["exit_mach"]
        assert (mach == pytest.approx(1.0, rel=1e-6)) if chokes else 0.0 < mach < 0.95
        assert mach in numbers_of(summary, "leakage").values()
        # The figure has the leakage of a gas as the text has it.
        told = in_words("leakage", summary["leakage"]["mean"])
        assert dict(overview._numbers(summary))["mean leakage"].startswith(f"{told} (")
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
    film = result.summary["film"]
    for key, signal in (("leakage", "leakage_outer"), ("friction_power", "friction_power")):
        assert film[key] == pytest.approx(float(result.data[signal][-1]), rel=1e-3)
    assert any("aligned, at the end" in numbers_of(result.summary, label) for label in ("leakage", "friction"))
    if film["exit_mach"] is not None:
        before = sealdyn.evaluate(scenario, {"film.inner_pressure": "14 bar"}, "film.exit_mach")["film.exit_mach"]
        assert film["exit_mach"] < 0.9 * before


def test_a_critical_speed_of_no_seal_is_none():
    """Stiff films of a fraction of a micrometre had theirs at millions of rpm."""
    summary = summary_of(["run.turns=2", "shaft.speed='9000 rpm'"]) | {"wall_time": 1.0}
    found = summary["stability"]
    assert found["fastest"] == pytest.approx(1000.0 / 0.040)

    def words(**changes):
        told = {**summary, "stability": {**found, **changes}}
        return numbers_of(told, "stability"), dict(overview._numbers(told))

    here, sheet = words(resonance_speeds=[100.0, 1e6])
    assert here["critical speed"] == found["critical_speed"] and "critical speed" in sheet
    assert here["resonance of a tilt at"] == 100.0 and 1e6 not in here.values()
    here, sheet = words(critical_speed=7e5, thresholds=[7e5, 8e5])
    assert here["no critical speed up to"] == found["fastest"] and not {7e5, 8e5} & set(here.values())
    assert "critical speed" not in sheet


def test_the_sheet_tells_no_misalignment_below_the_accuracy():
    """Text and figure of one run: 98 nrad of a seal of which 500 are resolved."""
    summary = {"accuracy": 2e-3, "film": {"clearance": 1e-5}, "h_min": {"radius": 0.04},
               "relative_misalignment": {"max": 9.78e-8, "min": 0.0, "mean": 2e-6}}  # fmt: skip
    assert dict(overview._numbers(summary))["tilt max / min / mean"] == "<0.5 / 0 / 2 µrad"


@pytest.mark.parametrize("held", [[], ["axial"]])
def test_parts_of_a_line_are_apart_or_go_on(held):
    """Counts of a secondary seal and what it does at the end are three parts, two of a range one."""
    ring = {"law": "coulomb", "breakaway_force": 22.0, "breakaway_moment": 0.8}
    *_, line = _seal_lines({"rings": {"stator": ring}, "sticks": 0, "slips": 0, "stuck_at_end": held})
    assert len(line_words(line).split(", ")) == 3
    both = [("", 11.5, "temperature"), ("and", 10.0, "temperature")]
    assert line_words(Line("", both)) == "11.5 K and 10 K"
