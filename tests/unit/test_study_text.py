"""A study's printed answer: verdict, and tables whose numbers are those of the answer."""

import importlib.util
import math

import pytest

from sealdyn.report.text import archive_lines, question_of
from sealdyn.studies import study_names
from sealdyn.studies._runner import study_info, study_module


@pytest.mark.parametrize("name", study_names())
def test_every_study_has_a_chart(name):
    study = study_module(name.replace("-", "_"))
    assert study.run.__doc__ and study.Settings.__doc__
    own = importlib.util.find_spec(f"sealdyn.report.charts.study_{name.replace('-', '_')}")
    assert bool(own) != bool(study_info(name.replace("-", "_")).asks)


@pytest.mark.parametrize(
    ("comment", "question"),
    [("Does it ride?  Expected: yes.", "Does it ride?"), ("A pump seal. With a cone.", "A pump seal"), ("", "")],
)
def test_a_comment_without_a_question_gets_no_mark(comment, question):
    assert question_of(comment) == question


def test_a_contact_is_listed_with_how_long_it_lasts():
    touches = [(0.0, 0.25), (0.5, math.nan)]
    events = [{"kind": "contact", "time": touched, "lift_off": lifted} for touched, lifted in touches]
    events.append({"kind": "film_minimum", "time": 0.75})
    info = {"created": "", "rows": 1, "status": "ok", "message": "", "events": events, "series": {}, "fields": {}}
    said = [line.split(maxsplit=1)[1] for line in archive_lines("a.h5", info) if line.strip().startswith("event")]
    assert said == [
        "contact at t = 0 ms, for 250 ms",
        "contact at t = 500 ms, to the end",
        "film_minimum at t = 750 ms",
    ]
