"""The page for a design review as its reader sees it: units of print, speeds as they were written, nothing twice."""

import re
from html import unescape
from pathlib import Path

import sealdyn
from sealdyn.archive import read_study
from sealdyn.kernel_cache import solvers_digest
from sealdyn.report.charts.study_work_precision import caption
from sealdyn.report.review import review, told
from sealdyn.report.text import question_of

GALLERY = Path(__file__).parents[2] / "outputs" / "gallery"


def words_of(path):
    return " ".join(unescape(re.sub(r"<style>.*?</style>|<[^>]*>", " ", path.read_text("utf-8"), flags=re.S)).split())


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


def test_pages_and_charts_of_other_solvers_say_that_they_are_older(tmp_path, monkeypatch):
    quick = {"run.turns": 1, "run.samples_per_turn": 16}
    sealdyn.run(sealdyn.example("fms_reference"), quick, out=tmp_path / "run.h5")
    study = read_study(GALLERY / "work_precision_fmr.h5") | {"solvers": solvers_digest()}
    for today, older in ((solvers_digest(), False), ("another", True)):
        monkeypatch.setattr("sealdyn.report.text.solvers_digest", lambda today=today: today)
        page = words_of(review([tmp_path / "run.h5"], tmp_path / "page.html"))
        for words in (page, " ".join(caption(study).split())):
            assert f"solvers {solvers_digest()}" in words
            assert (f"{solvers_digest()}, older than another" in words) == older
