"""The README's own seal prints what the README says, and its table has every study."""

import re
from pathlib import Path

import pytest
from command import SCENARIOS

import sealdyn
from sealdyn.analysis.design_rules import OF_GAS, RULES
from sealdyn.quantities import reading_in
from sealdyn.report.summary import run_answer
from sealdyn.report.text import lines, written_units
from sealdyn.scenario.reader import parse_scenario
from sealdyn.studies import study_names
from sealdyn.studies._runner import study_info

README = (SCENARIOS.parent / "README.md").read_text()


def test_seal_of_the_readme_gives_the_printed_answer(tmp_path):
    scenario = parse_scenario(re.search(r"```toml\n(.*?)```", README, re.DOTALL)[1], "pump.toml")
    found = sealdyn.simulate(scenario, tmp_path / "pump.h5").summary
    for printed, value in {
        r"h_min +settled ([\d.]+) um": found["h_min"]["steady"] * 1e6,
        r"misalignment +settled [\d.]+ nrad to ([\d.]+)": found["relative_misalignment"]["steady_max"] * 1e9,
        r"margin .* ([\d.]+) times": found["contact_margin"],
        r"mean ([\d.]+) ml/h": found["leakage"]["mean_ml_per_h"],
        r"friction +([\d.]+) W": found["friction"]["power"],
        r"by heat ([\d.]+) K": found["heat"]["rise"],
        r"of it by heat ([\d.]+) urad": found["heat"]["coning_by_heat"] * 1e6,
        r"unheated: clearance ([\d.]+) um": found["heat"]["cold"]["clearance"] * 1e6,
    }.items():
        assert value == pytest.approx(float(re.search(printed, README)[1]), rel=1e-3), printed
    # Words as they stand there, whatever the last digits; the files are others.
    with reading_in(written_units({"scenario": scenario.text, "overrides": ()})):
        told = lines("pump", run_answer({**found, "archive": "x.h5"}))
    shown = re.search(r"```text\n(.*?)\n```", README, re.DOTALL)[1].splitlines()
    assert [re.sub(r"[\d.]+", "#", line) for line in told[:-1]] == [re.sub(r"[\d.]+", "#", line) for line in shown[:-1]]
    # A run that may have the linear film has leakage and friction of the radial one, and so has the seal at its end.
    assert found["model"]["film"] == "linear"
    assert found["film"]["leakage"] == pytest.approx(found["leakage"]["mean"], rel=1e-3)
    assert found["film"]["friction_power"] == pytest.approx(found["friction"]["power"], rel=1e-3)


def test_program_of_the_readme_runs_and_prints_what_it_says(tmp_path, monkeypatch, capsys):
    monkeypatch.chdir(tmp_path)
    monkeypatch.setenv("MPLBACKEND", "agg")
    Path("pump.toml").write_text(re.search(r"```toml\n(.*?)```", README, re.DOTALL)[1])
    program = re.search(r"```python\n(.*?)```", README, re.DOTALL)[1]
    # Four of the thousand runs.
    few = program.replace("1000", "4")
    assert few != program
    left = {}
    exec(compile(few, "README.md", "exec"), left)
    printed = capsys.readouterr().out
    assert printed.startswith("ok ") and 'outer_radius = "29 mm"' in printed and "rides at" in printed
    (spring,) = re.findall(r"^(\d+\.\d+)$", printed, re.MULTILINE)
    assert float(spring) == pytest.approx(float(re.search(r"# ([\d.]+) N$", program, re.MULTILINE)[1]), abs=0.06)
    assert (left["table"]["status"] == "ok").all() and left["data"].sizes["run"] == 4
    assert sorted(path.name for path in tmp_path.iterdir()) == ["orbit.svg", "pump.toml"]


@pytest.mark.parametrize("name", study_names())
def test_times_in_the_readme_are_those_beside_the_studies(name):
    words, seconds = study_info(name.replace("-", "_")).timed
    rows = re.findall(r"^\|.* \| `([\w-]+)`, (\w+).*\| (\d+) \|$", README, re.MULTILINE)
    assert (name, words.split()[0], str(seconds)) in rows


def test_every_rule_is_in_the_table_of_the_readme():
    page = (SCENARIOS / "README.md").read_text()
    section = page.split("## Design rules")[1].split("\n## ")[0]
    assert re.findall(r"^\| `(\w+)`", section, re.MULTILINE) == [*sorted(RULES), *sorted(OF_GAS)]
