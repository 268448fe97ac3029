"""Design rules at the command line: verdicts in words and JSON, reasons, and a table that changes no number."""

import json
import re
import tomllib

import pytest
from command import REFERENCE, SCENARIOS, sealdyn

from sealdyn.analysis import other_rules
from sealdyn.analysis.design_rules import RULES
from sealdyn.scenario.reader import parse_scenario, read_scenario
from sealdyn.studies._runner import study_module

SHEET = """
[application]
shaft_diameter = "2 in"
bore = "50.8 mm"
shaft_runout = "0.6 mm TIR"
eccentricity = "0.2 mm"
spring = "coil"
lowest_speed = "3 Hz"
highest_speed = "9550 rpm"
rotation = "both"
fluid = "MIL-L-23699"
lowest_temperature = "-40 degC"
highest_temperature = "120 degC"
highest_pressure = "6 bar"
secondary_seal_material = "fluoroelastomer"
gear_mesh_frequency = ["2.1 kHz", "5.4 kHz"]
leakage_limit = "5 cc/h"
life = "1500 h"
[application.acknowledge]
leakage = "a printed example, not a gearbox"
coking = "not needed"
"""


@pytest.fixture
def described(tmp_path):
    """The reference seal with its data sheet, a file."""
    path = tmp_path / "described.toml"
    path.write_text(REFERENCE.read_text() + SHEET)
    return path


def verdicts(answer):
    return {row["rule"]: row for row in answer.found["design_rules"]}


def test_check_gives_every_rule_in_json_and_words(described, tmp_path):
    answer = sealdyn("check", described, "--json", cwd=tmp_path)
    rows = verdicts(answer)
    assert answer.code == 0 and sorted(rows) == sorted(RULES)
    assert rows["runout"]["verdict"] == "fail" and rows["runout"]["most"] == 0.38e-3
    assert rows["coking"]["verdict"] == "pass" and rows["coking"]["value"] == pytest.approx(393.15, rel=1e-12)
    words = sealdyn("check", described, cwd=tmp_path).out
    printed = re.findall(r"^#   (fail|acknowledged|note|pass|not applicable) +(\w+): ", words, re.MULTILINE)
    assert {rule: verdict for verdict, rule in printed} == {rule: row["verdict"] for rule, row in rows.items()}


def test_what_check_prints_is_the_same_scenario(described, tmp_path):
    again = parse_scenario(sealdyn("check", described, cwd=tmp_path).out, "again.toml")
    assert again.application == read_scenario(described).application
    assert tomllib.loads(SHEET)["application"]["acknowledge"] == again.application.acknowledge


def test_a_reason_acknowledges_what_is_broken_and_nothing_else(described, tmp_path):
    rows = verdicts(sealdyn("check", described, "--json", cwd=tmp_path))
    assert rows["leakage"]["verdict"] == "acknowledged" and rows["leakage"]["reason"].startswith("a printed")
    assert rows["leakage"]["value"] > rows["leakage"]["most"]
    assert rows["coking"]["verdict"] == "pass" and rows["coking"]["reason"] == "not needed"
    assert rows["runout"]["reason"] is None


@pytest.mark.parametrize("verb", ["check", "run"])
def test_an_unknown_rule_is_refused_in_one_line(described, tmp_path, verb):
    answer = sealdyn(verb, described, "--set", 'application.acknowledge.runnout="new shaft"', cwd=tmp_path)
    assert answer.code == 2 and len(answer.err.splitlines()) == 1 and answer.out == ""
    assert "described.toml: [application.acknowledge] runnout: " in answer.err
    assert answer.err.rstrip().endswith("nearest 'runout'")


@pytest.mark.parametrize(
    ("change", "says"),
    [
        ('application.bor="2 in"', "[application] bor: found an unknown key; expected a key of [application]; nearest"),
        ('application.bore="0 mm"', '[application] bore: found "0 mm"; expected a length > 0 in m'),
        ('application.bore="2 s"', '[application] bore: found "2 s" (a unit of time); expected a length > 0 in m'),
        ('application.leakage_limit="5 cc"', '[application] leakage_limit: found "5 cc"'),
        ('application.spring="coils"', "nearest 'coil'"),
        ('application.highest_speed="2 Hz"', "[application] lowest_speed: found 18.8496 rad/s; expected at most high"),
        (
            'application.gear_mesh_frequency=["2 kHz", "2 kg"]',
            'gear_mesh_frequency: found "2 kg" (a unit of mass) as e',
        ),
        ("application.acknowledge.leakage=true", "[application] acknowledge: found true as the reason of"),
        ('application.acknowledge.leakage=" "', '[application] acknowledge: found " " as the reason of "leakage"'),
        ("application.acknowledge=1", "[application] acknowledge: found 1; expected a table of rules"),
        ("application.eccentricity=true", "[application] eccentricity: found true"),
    ],
)
def test_a_wrong_sheet_is_told_in_one_line(described, tmp_path, change, says):
    answer = sealdyn("check", described, "--set", change, cwd=tmp_path)
    assert answer.code == 2 and len(answer.err.splitlines()) == 1 and says in answer.err


@pytest.mark.core
def test_the_table_changes_no_number_of_a_run(described, tmp_path):
    assert read_scenario(described) == read_scenario(REFERENCE)
    assert read_scenario(described).unused() == []
    found = []
    for path in (REFERENCE, described):
        answer = sealdyn("run", path, "--set", "run.turns=3", "--no-plot", "--json", cwd=tmp_path)
        found.append({key: held for key, held in answer.found.items() if key not in ("archive", "wall_time")})
    assert json.dumps(found[0], sort_keys=True) == json.dumps(found[1], sort_keys=True)
    shown = sealdyn("show", tmp_path / "outputs" / "described.h5", "--json", cwd=tmp_path).found
    assert "MIL-L-23699" in shown["scenario"]


def test_every_command_that_a_rule_names_is_one(tmp_path):
    tables = RULES, other_rules.LIP, other_rules.RIBBED_LIP, other_rules.CIRCUMFERENTIAL
    named = {rule.command for table in tables for rule in table.values()}
    for program, verb, *rest in map(str.split, named - {""}):
        assert program == "sealdyn" and verb in ("run", "study") and "FILE" in " ".join(rest)
        assert verb == "run" or study_module(rest[0].replace("-", "_"))


def test_check_prints_the_lines_of_the_readme(tmp_path):
    page = (SCENARIOS / "README.md").read_text()
    (seal,) = re.findall(r"```toml\n(.*?)```", (SCENARIOS.parent / "README.md").read_text(), re.DOTALL)
    application = re.findall(r"```toml\n(.*?)```", page, re.DOTALL)[0]
    (tmp_path / "pump.toml").write_text(seal + application)
    printed = sealdyn("check", "pump.toml", cwd=tmp_path).out.splitlines()
    said = re.search(r"```text\n(# design rules.*?)```", page, re.DOTALL)[1].splitlines()
    assert set(said) - {"..."} <= set(printed)


def test_numbers_of_rules_and_warnings_are_in_the_units_of_the_scenario(tmp_path):
    # At this speed the inertia of the film counts, which a pressure says.
    seal = (REFERENCE, "--set", "film.outer_pressure=70 psig", "--set", "closing.spring_force=40 N",
            "--set", "shaft.speed=30000 rpm")  # fmt: skip
    done = sealdyn("check", *seal, "--json", cwd=tmp_path)
    assert done.code == 0
    sentences = [verdicts(done)[rule]["said"] for rule in ("balance", "face_pressure")]
    for sentence in [*sentences, " ".join(done.found["warnings"])]:
        assert re.search(r"\d psi\b", sentence) and not re.search(r"\d bar\b", sentence)
