"""The page for a design review as its reader sees it: units of print, speeds as they were written, nothing twice."""

import re
from html import unescape

import pytest

import sealdyn
from sealdyn.report.review import letters, review, told
from sealdyn.report.text import question_of


def words_of(path):
    return " ".join(unescape(re.sub(r"<style>.*?</style>|<[^>]*>", " ", path.read_text("utf-8"), flags=re.S)).split())


def page(folder, changes, rules=None):
    scenario = sealdyn.example("fms_reference")
    sealdyn.run(scenario, {"run.turns": 3, **changes}, out=folder / "seal.h5")
    return words_of(review([folder / "seal.h5"], folder / "page.html", rules=rules)), folder / "page.html"


def test_speeds_of_a_page_are_those_of_its_scenario(tmp_path):
    words, _ = page(tmp_path, {"shaft.speed": "9600 rpm"})
    assert "at 9600 rpm" in words and "critical speed 53370 rpm" in words
    assert "rad/s" not in words[words.index("stability") : words.index("energy audit")]
    words, _ = page(tmp_path, {"shaft.speed": "1000 rad/s"})
    assert "at 1000 rad/s" in words


def test_numbers_and_units_of_a_page_are_those_of_print(tmp_path):
    assert told("leaks 6.686e+04 cc/h, 1.02e+07 N/m, 2.398 N/cm^2, 1e-9 m^3/s") == (
        "leaks 66860 cc/h, 1.02e+07 N/m, 2.398 N/cm², 1e-9 m³/s"
    )
    rule = {
        "rule": "leakage",
        "verdict": "fail",
        "said": "4.322e+04 cc/h",
        "source": "limit 5 N/cm^2",
        "command": "run",
    }
    words, _ = page(tmp_path, {}, rules=lambda path, info: [{**rule, "reason": ""}])
    body = words[: words.index("Scene in SI units")]
    assert "43220 cc/h" in body and "limit 5 N/cm²" in body and " um" not in body and not re.search(r"e\+0[1-6]", body)


@pytest.mark.parametrize("runout, orbits", [("25 urad", True), (0.0, False)])
def test_aligned_faces_have_no_figure_of_orbits(tmp_path, runout, orbits):
    words, _ = page(tmp_path, {"rotor.runout": runout, "stator.misalignment": 0.0})
    assert ("Orbits" in words) == orbits and "Overview of the run" in words


def test_a_page_says_the_answer_of_a_study_once(tmp_path):
    scenario = sealdyn.example("fms_reference")
    answer = sealdyn.run_study("equilibrium", scenario, str(tmp_path / "s.h5"), flags={"points": 5}, workers=1)
    seen = []
    words = words_of(review([tmp_path / "s.h5"], tmp_path / "page.html", progress=lambda *now: seen.append(now)))
    assert seen == [(0, 1, "s.h5 (1 of 1)"), (1, 1, "writing the page")]
    assert words.count(told(answer["verdict"][0])) == 1


def test_a_page_of_one_scene_says_once_what_its_parts_share(tmp_path):
    scenario = sealdyn.example("fms_reference")
    quick = {"run.turns": 1, "run.samples_per_turn": 16}
    for name, changes in (("a", {}), ("b", {}), ("c", {"film.clearance": "9 um"})):
        sealdyn.run(scenario, {**quick, **changes}, out=tmp_path / f"{name}.h5")
    sealdyn.run_study("equilibrium", scenario, str(tmp_path / "s.h5"), flags={"points": 5}, workers=1)
    rules = [{"rule": "heat", "verdict": "pass", "said": "cold", "source": "-", "reason": "", "command": "run"}]
    page = review([tmp_path / f"{n}.h5" for n in "abcs"], tmp_path / "page.html", rules=lambda path, info: rules)
    html, words = page.read_text("utf-8"), words_of(page)
    assert html.count('class="sketch"') == 2 and html.count("<summary>Scenario as written") == 3
    assert words.count("What the line accuracy") == 1 and words.count("Validation of the film") == 3
    assert words.count("No published numbers were held") == 1 and html.count("<td>cold</td>") == 1
    assert html.count(f"<h2>{question_of(scenario.question)}</h2>") == 1 and "equilibrium (s.h5)</h2>" in html
    assert html.count('All as in <a href="#part1">fms_reference, run</a>.') == 5


@pytest.mark.parametrize("longest, size", [(80, 12.5), (200, 8.5), (600, 7.4)])
def test_a_wide_table_of_a_study_is_set_smaller_in_place_of_wrapped(longest, size):
    assert letters(["rate", "x" * longest]) == pytest.approx(size, abs=0.06)
