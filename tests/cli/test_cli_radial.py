"""Radial seals from the command line: run, check, show, plot, go on, the study, and what takes face seals only."""

import copy
import re

import numpy as np
import pytest
from command import SCENARIOS, said, sealdyn
from PIL import Image

import sealdyn as package
from sealdyn import ScenarioError, open_archive
from sealdyn.dynamics.intervals import largest_value
from sealdyn.radial_seals.followers import followers_of, largest_eccentricity, needed_preload
from sealdyn.radial_seals.observers import _warnings
from sealdyn.report.summary import run_answer
from sealdyn.report.text import line_words
from sealdyn.scenario.errors import CIRCUMFERENTIAL_RULES, LIP_RULES
from sealdyn.scenario.reader import parse_scenario, read_scenario
from sealdyn.simulation.simulate import simulate

LIP, SEGMENTS = (SCENARIOS / "radial" / f"{name}_reference.toml" for name in ("lip", "circumferential"))
SHORT = ("--set", "run.turns=2")
LOST = ("--set", "shaft.eccentricity=0.3 mm")


@pytest.fixture(scope="module")
def folder(tmp_path_factory):
    folder = tmp_path_factory.mktemp("radial")
    done = sealdyn("run", SEGMENTS, *SHORT, *LOST, "--out", "x.h5", "--json", cwd=folder)
    assert done.code == 0
    return folder, done.found


@pytest.mark.parametrize("path", [LIP, SEGMENTS], ids=["lip", "segments"])
def test_the_shipped_seals_ride_all_the_way_round(path, tmp_path):
    done = sealdyn("run", path, *SHORT, cwd=tmp_path)
    assert done.code == 0 and "WARNING" not in done.out
    assert (tmp_path / "outputs" / f"{path.stem}.png").exists()
    checked = sealdyn("check", path, cwd=tmp_path)
    assert checked.code == 0
    assert "fail" not in checked.out.split("design rules")[1].splitlines()[0]


def test_what_is_expected_of_them():
    """The numbers at the head of the files."""
    scenes = [read_scenario(path).scene for path in (LIP, SEGMENTS)]
    (lip, shaft), (segments, other) = ((followers_of(scene), scene.shaft) for scene in scenes)
    speeds = [largest_value(one.speed) for one in (shaft, other)]
    assert needed_preload(lip, shaft, speeds[0]) / lip.arc == pytest.approx(3.86, abs=0.01)
    assert largest_eccentricity(lip, shaft, speeds[0]) == pytest.approx(5.28e-3, abs=1e-5)
    assert segments.friction == pytest.approx(0.275)
    assert largest_eccentricity(segments, other, speeds[1]) == pytest.approx(0.12e-3, abs=2e-6)


@pytest.mark.core
def test_a_seal_that_loses_contact_says_so(folder):
    place, found = folder
    assert found["contact"]["lift"] >= 2 * 6 - 1 and found["whole"]["largest_gap"] > 1e-5
    assert found["settled"]["contact_share"] < 1.0 and any("contact is lost" in w for w in found["warnings"])
    assert found["certificate"]["met"] and found["energy_residual"] < 1e-6
    data = open_archive(place / "x.h5").load()
    assert data.gap.dims == ("field_time", "theta") and data.gap.attrs["units"] == "m"
    # Where a follower is off the shaft nothing presses.
    assert float((data.gap * data.follower_load).max()) == 0.0
    assert float(data.largest_gap.max()) <= found["whole"]["largest_gap"] * (1 + 1e-9)


@pytest.mark.parametrize("rides", [True, False], ids=["rides", "hangs"])
def test_what_is_settled_and_what_is_of_the_whole_run_says_so(folder, rides):
    """No line and no warning gives a number of one half for that of the other, or both without a word."""
    summary = {**copy.deepcopy(folder[1]), "wall_time": 1.0}
    values = {
        "contact_share": 0.31, "least_contact_share": 0.17, "held_share": 0.23, "largest_gap": 41e-6, "least_load": 1.9,
        "largest_load": 5.3, "load": 7.1, "friction_torque": 0.67, "leakage_estimate": 1.3e-9, "largest_gap_time": 0.29,
        "largest_gap_angle": 1.1, "least_load_time": 0.43,
    }  # fmt: skip
    assert set(values) == set(summary["settled"]) == set(summary["whole"])
    summary["settled"] = dict(values)
    summary["whole"] = {name: 1.0625 * value for name, value in values.items()}
    if not rides:
        summary["settled"] |= {"least_load": None, "largest_load": None}
    of = {"settled": set(summary["settled"].values()), "whole run": set(summary["whole"].values())}
    of["whole run"] |= {summary["contact"][name] for name in ("lift", "land")}
    assert not of["settled"] & of["whole run"] - {None}
    found = {"settled": set(), "whole run": set()}
    for line in run_answer(summary).lines:
        words = line_words(line)
        for part, numbers in of.items():
            if there := {value for _, value, *_ in line.parts if value is not None} & numbers:
                assert part in words, words
                found[part] |= there
    assert {0.31, 0.17, 0.23, 7.1, 0.67} <= found["settled"] and 1.0625 * 41e-6 in found["whole run"]
    assert ({1.9, 5.3} <= found["settled"]) == rides
    (warning, *_) = _warnings(summary, read_scenario(SEGMENTS).scene)
    assert f"{100 * (1 - summary['settled']['contact_share']):.3g} %" in warning


def test_show_plot_and_what_is_of_face_seals(folder):
    place, _ = folder
    shown = sealdyn("show", "x.h5", cwd=place)
    assert shown.code == 0 and "largest_gap" in shown.out and "event         lift" in shown.out
    assert sealdyn("show", "x.h5", "--csv", cwd=place).out.splitlines()[0].startswith("time [s],")
    assert sealdyn("plot", "x.h5", "--out", "y.png", cwd=place).code == 0
    assert Image.open(place / "y.png").size[0] > 1000
    refused = sealdyn("plot", "x.h5", "--kind", "orbit", cwd=place)
    assert refused.code == 2 and "radial seal" in refused.err and len(said(refused.err)) == 1, refused.err
    for study, path, words in (("campbell", LIP, "followability"), ("followability", SCENARIOS / "rub.toml", "[lip]")):
        refused = sealdyn("study", study, path, cwd=place)
        assert refused.code == 2 and words in refused.err and len(said(refused.err)) == 1, refused.err


def test_a_face_seal_is_not_compared_with_a_radial_one(folder, tmp_path):
    place, _ = folder
    words = ("run", SCENARIOS / "axial_only.toml", "--set", "run.turns=1", "--out", tmp_path / "face.h5")
    assert sealdyn(*words, cwd=tmp_path).code == 0
    refused = sealdyn("compare", tmp_path / "face.h5", place / "x.h5", cwd=tmp_path)
    assert refused.code == 2 and refused.err.count("\n") == 1
    assert "x.h5: the archive of a radial seal; expected that of a face seal" in refused.err


def test_a_sweep_and_numbers_of_runs(folder, tmp_path):
    _, found = folder
    words = ("--vary", "shaft.eccentricity=0.1,0.3 mm", *SHORT, "--json")
    swept = sealdyn("study", "sweep", SEGMENTS, *words, cwd=tmp_path)
    calm, lost = swept.found["rows"]
    assert swept.code == 0 and calm["settled.contact_share"] == 1.0 and calm["whole.largest_gap"] == 0.0
    assert lost["whole.largest_gap"] == pytest.approx(found["whole"]["largest_gap"], rel=1e-5)
    assert swept.found["output_units"]["settled.friction_torque"] == "N m"
    asked = {"run.turns": 2, "shaft.eccentricity": "0.3 mm"}
    numbers = package.evaluate(SEGMENTS, asked, ["whole.largest_gap", "closed_form.margin"])
    assert numbers["whole.largest_gap"] == pytest.approx(found["whole"]["largest_gap"], rel=1e-5)
    assert numbers["closed_form.margin"] == pytest.approx(found["closed_form"]["margin"])
    table = package.sweep(SEGMENTS, {"shaft.eccentricity": ["0.1 mm", "0.3 mm"], "run.turns": [2]}, workers=1)
    assert list(table["whole.largest_gap"]) == [0.0, numbers["whole.largest_gap"]]
    assert table.attrs["units"]["whole.largest_gap"] == "m"
    many = package.simulate_many(read_scenario(SEGMENTS), [asked, {"run.turns": 2, "shaft.speed": 0}], workers=1)
    assert [*many.status.values] == ["ok", "not possible"]
    with pytest.raises(package.ScenarioError, match=r"nearest 'whole\.largest_gap"):
        package.evaluate(SEGMENTS, asked, "largest_gap")


def test_a_broken_rule_is_acknowledged_by_its_name(tmp_path):
    reason = ("--set", "application.acknowledge.segment_runout='kept at the bearing, 2024 survey'")
    found = sealdyn("check", SEGMENTS, *reason, "--json", cwd=tmp_path).found["design_rules"]
    (row,) = (row for row in found if row["rule"] == "segment_runout")
    assert row["verdict"] == "acknowledged" and row["reason"] == "kept at the bearing, 2024 survey"
    for name in ("segmnt_runout", "lip_speed"):
        refused = sealdyn("check", SEGMENTS, "--set", f"application.acknowledge.{name}='why'", cwd=tmp_path)
        assert (
            refused.code == 2 and f"acknowledge.{name}" in refused.err.replace("] ", ".") and "nearest" in refused.err
        )
    assert {row["rule"] for row in found} == set(CIRCUMFERENTIAL_RULES)


def lip_rules(tmp_path, *values):
    given = [word for value in values for word in ("--set", value)]
    return {row["rule"]: row for row in sealdyn("check", LIP, *given, "--json", cwd=tmp_path).found["design_rules"]}


def test_hydrodynamic_lips_have_tables_of_their_own(tmp_path):
    """Each rule passes and fails: load, pressure over speed, eccentricity."""
    ribbed = "application.hydrodynamic_lip=true"
    usual = lip_rules(tmp_path)
    found = lip_rules(tmp_path, ribbed, "lip.preload='40 N/m'", "shaft.eccentricity='0.02 mm'")
    assert set(found) == set(LIP_RULES) == set(usual)
    load = found["lip_load"]
    assert load["verdict"] == "pass" and (load["least"], load["most"]) == (52.5, 70)
    assert lip_rules(tmp_path, "lip.preload='40 N/m'")["lip_load"]["verdict"] == "note"
    assert found["lip_speed"]["verdict"] == "not applicable" and usual["lip_speed"]["source"] == "table 3.2"
    assert found["lip_eccentricity"]["verdict"] == "pass" and usual["lip_eccentricity"]["verdict"] == "not applicable"
    assert lip_rules(tmp_path, ribbed, "shaft.eccentricity='0.028 mm'")["lip_eccentricity"]["verdict"] == "fail"
    # Between two rows: 1 and 3 psi allow 1830 and 1220 m/min, and 3000 and 2000 ft/min of conventional lips.
    speed = "shaft.speed='9600 rpm'"
    for pressure, ends in (("0.1 bar", "pass"), ("0.25 bar", "fail"), ("0.4 bar", "fail")):
        row = lip_rules(tmp_path, ribbed, "shaft.radius='20 mm'", f"lip.pressure_difference='{pressure}'", speed)
        assert row["lip_pressure"]["verdict"] == ends and row["lip_pressure"]["source"] == "table 3.3"


def test_a_run_that_ends_before_anything_settles(tmp_path):
    """Its lines, its warnings and its figure say so; no number is none."""
    scenario, looks = read_scenario(SEGMENTS, ["run.turns=3", "shaft.eccentricity='0.3 mm'"]), iter(range(10_000))
    found = simulate(scenario, tmp_path / "x.h5", stop=lambda: next(looks) >= 3)
    assert found.status == "interrupted" and found.summary["settled"]["contact_share"] is None
    assert found.plot.overview().axes

    def rows_of(summary):
        return [line_words(line) for line in run_answer(summary).lines]

    rows = rows_of(found.summary)
    assert any("whole run, in all" in words for words in rows)
    # Nor of one that ended before its first step.
    nothing = {name: 0.0 if name == "largest_gap" else None for name in found.summary["whole"]}
    for words in rows, rows_of(found.summary | {"whole": nothing}):
        assert any("nothing has settled" in line for line in words)
        assert not re.search(r"\b(nan|None)\b", " ".join(words))


def test_a_run_up_passes_the_limit(tmp_path):
    """From 6000 to 12000 rpm in 12 turns: contact is first lost where the closed form says, a turn or so later."""
    table = "{ time = ['0 s', '0.08 s'], value = ['6000 rpm', '12000 rpm'] }"
    found = simulate(read_scenario(SEGMENTS, [f"shaft.speed={table}", "run.turns=11"]), tmp_path / "x.h5").summary
    limit = np.sqrt((0.7 - 0.275) / (0.004 * 1e-4))
    at = found["contact"]["first_lift"]
    speed = np.pi / 30 * (6000 + 6000 * at / 0.08)
    assert limit * 0.99 < speed < limit * 1.1


WRONG = {
    "[lip]\nmass='3 g'": "[shaft]",
    "[shaft]\nradius='25 mm'\nspeed='3000 rpm'\n[lip]\nmass='3 g'\npreload='8 N'": "[lip] preload: found",
    "[shaft]\nradius=1\nspeed=3\n[lip]\nmass=1\nmodulus=1e7": "thickness, length, interference are missing",
    "[shaft]\nradius='25 mm'\nspeed=3\n[lip]\nmass=0\npreload=8\nstiffness=9": "a mass > 0",
    "[shaft]\nradius='25 mm'\nspeed=3\n[lip]\nmass=1\npreload=8\nstiffness=9\nsectors=2": "4 to 720",
    "[shaft]\nradius='25 mm'\nspeed=0\n[lip]\nmass=1\npreload=8\nstiffness=9": "a shaft at rest",
    "[shaft]\nradius='25 mm'\nspeed=3\n[circumferential]\nmass=1\n[lip]\nmass=1": "one of the two",
    "[shaft]\nradius='25 mm'\nspeed=3\n[circumferential]\nmass=1\nsegmnts=3": "nearest 'segments'",
    "[shaft]\nradius='25 mm'\nspeed=3\n[circumferential]\nmass=1\ngarter_tension='-1 N'": "a force >= 0",
    "[shaft]\nradius=1\nspeed=3\n[circumferential]\nmass=1\npressure_difference='1 barg'": "unknown unit 'barg'",
    "[shaft]\nradius=1\nspeed={time=[0,1,1],value=[3,3,4]}\n[circumferential]\nmass=1": "two speeds at 1 s",
    "[shaft]\nradius='25 mm'\nspeed=3\n[circumferential]\nmass=1\n[film]\nviscosity=1": "an unknown",
}


@pytest.mark.parametrize("text", WRONG, ids=range(len(WRONG)))
def test_what_is_wrong_is_one_line(text):
    with pytest.raises(ScenarioError) as refused:
        parse_scenario(text, "x")
    assert WRONG[text] in str(refused.value) and "\n" not in str(refused.value)


def test_values_are_set_as_of_face_seals():
    scenario = read_scenario(LIP).with_(lip__preload="60 N/m", shaft__eccentricity=2e-4)
    assert scenario.scene.lip.preload == 60.0 and scenario.scene.shaft.eccentricity == 2e-4
    assert parse_scenario(scenario.to_toml(), "again").scene == scenario.scene


def test_a_preload_is_read_per_length(tmp_path):
    done = sealdyn("run", LIP, *SHORT, "--verbose", "--no-plot", cwd=tmp_path)
    line = next(line for line in done.out.splitlines() if line.split()[:1] == ["follower"])
    # 80 N/m of the lip's own and 0.5 N of its garter on 25 mm.
    assert re.search(r"\b100 N/m,", line)
