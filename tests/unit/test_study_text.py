"""A study's printed answer: verdict, and tables whose numbers are those of the answer."""

import importlib.util
import math
import re

import pytest

from sealdyn.report.text import MOST_ROWS, archive_lines, question_of, study_lines
from sealdyn.studies import study_names
from sealdyn.studies._runner import study_info, study_module

COLUMNS = (("motion", "class"), ("film, um", "film.least", 1e6), ("touch", "touch"), ("of no row", "period"))


def row(least, **more):
    return {"class": "period 1", "film": {"least": least}, "touch": False} | more


def test_numbers_words_and_what_is_not_there():
    rows = [row(2.5e-6), row(None, touch=True), {"class": "chaotic"}]
    verdict, heading, *lines = study_lines({"verdict": ["It rubs."]}, [(rows, COLUMNS), ([], COLUMNS), (None, COLUMNS)])
    assert verdict.strip() == "It rubs."
    assert [re.split(" {2,}", line.strip()) for line in (heading, *lines)] == [
        ["motion", "film, um", "touch"], ["period 1", "2.5", "no"], ["period 1", "-", "yes"], ["chaotic", "-", "-"]
    ]  # fmt: skip
    # Each number ends below the end of its heading.
    end = heading.index("film, um") + len("film, um")
    assert all(len(line[:end].rstrip()) == end for line in lines)


def test_a_failed_row_says_why():
    _, line = study_lines({"verdict": []}, [([{"failed": "no orbit"}], COLUMNS)])
    assert line.endswith("no orbit")


@pytest.mark.parametrize("count", [1, MOST_ROWS, MOST_ROWS + 1, 1000])
def test_a_long_table_is_thinned_but_keeps_both_ends(count):
    lines = study_lines({"verdict": []}, [([{"n": k} for k in range(count)], (("n", "n"),))])
    numbers = [int(word) for word in map(str.strip, lines[1:]) if word.isdecimal()]
    assert numbers[0] == 0 and numbers[-1] == count - 1
    assert len(numbers) == count if count <= MOST_ROWS else MOST_ROWS / 2 < len(numbers) <= MOST_ROWS + 1
    assert any(f"{count} rows" in line for line in lines) == (count > MOST_ROWS)


@pytest.mark.parametrize("name", study_names())
def test_every_study_has_a_chart(name):
    study = study_module(name.replace("-", "_"))
    assert study.run.__doc__ and study.Settings.__doc__
    own = importlib.util.find_spec(f"sealdyn.report.charts.study_{name.replace('-', '_')}")
    assert own or study_info(name.replace("-", "_")).asks


@pytest.mark.parametrize(
    ("comment", "question"),
    [
        ("Does it ride?  Expected: yes.", "Does it ride?"),
        ("A pump seal. With a cone.", "A pump seal"),
        ("", ""),
    ],
)
def test_a_comment_without_a_question_gets_no_mark(comment, question):
    assert question_of(comment) == question


def test_a_contact_is_listed_with_how_long_it_lasts():
    touches = [(0.0, 0.25), (0.5, math.nan)]
    events = [{"kind": "contact", "time": touched, "lift_off": lifted} for touched, lifted in touches]
    events.append({"kind": "film_minimum", "time": 0.75})
    info = {"created": "", "rows": 1, "status": "ok", "message": "", "events": events, "series": {}, "fields": {}}
    said = [line.split(maxsplit=1)[1] for line in archive_lines("a.h5", info) if line.strip().startswith("event")]
    assert said == ["contact at t = 0 s, for 0.25 s", "contact at t = 0.5 s, to the end", "film_minimum at t = 0.75 s"]
