"""The README's numbers are those of the studies: its passages are computed from the data kept beside the figures."""

import re
from pathlib import Path

import pytest
from benchmark import readme_claims as claims

README = claims.README.read_text()
HONEST = {"scenes": 100, "honest": 99, "linear": 41, "asked": [1e-7, 1e-2], "median_cost": 1.94,
          "median_cost_running": 1.31, "seed": 7}  # fmt: skip
WINNER = {"method": "adams", "wall": 0.004, "next": "bdf", "factor_next": 1.7, "factor_dop853": 5.9, "not_asked": []}
NOBODY = {"error": 1e-9, "method": None, "why": "the judges differ by 4.1e-08"}
MACHINE = {"processor": "Abacus", "cores": 3, "busy": 1.0}


def study():
    """What a study's archive holds, made up."""
    rungs = [("harmonic balance, given coefficients", 2e-3, 4e-4), ("linear film, as given", 3e-5, 0.02),
             ("radial film", 1e-8, 0.03)]  # fmt: skip
    answer = {
        "where": "over_time",
        "machine": dict(MACHINE),
        "fastest": [{"error": 1e-3, **WINNER}, {"error": 1e-6, **WINNER, "factor_next": 1.05}, NOBODY],
        "methods": {"adams": {"status": ["ok"], "reason": [""]},
                    "newmark": {"status": ["ok", "stopped"], "reason": ["", "more than 50 times the fastest"]}},
        "models": [{"label": label, "error": {"steady": error}, "wall": wall} for label, error, wall in rungs],
        "judges": {"exact": "Gauss", "second": "DOP853"},
        "judge_error": {"over_time": 4.1e-8},
    }  # fmt: skip
    return {"name": "made_up", "settings": {"slowest": 50.0}, "answer": answer}


def page():
    """What the page of all scenarios leaves, made up."""
    ida = {"method": "ida", "wall": 0.01, "next": None, "factor_next": None, "factor_dop853": None, "not_asked": []}
    fastest = {
        "a": [{"error": 1e-3, **WINNER}, {"error": 1e-6, **WINNER}],
        "b": [{"error": 1e-3, **WINNER, "factor_next": 1.2, "factor_dop853": 262.0},
              {"error": 1e-6, **WINNER, "method": "bdf", "factor_dop853": 44.0}],
        "c": [{"error": 1e-3, **ida}, {**NOBODY, "error": 1e-6}],
    }  # fmt: skip
    scenes = [{"name": name, "busy": 2.04 if name == "b" else None, "fastest": rows} for name, rows in fastest.items()]
    return {"command": "abacus", "machine": MACHINE, "scenes": scenes}


@pytest.mark.parametrize("name", list(claims.CLAIMS))
def test_the_readme_says_what_is_computed(name):
    """`python tests/benchmark/readme_claims.py` writes it."""
    assert claims.standing(README, name) is not None, f"no passage {name} in the README"
    found = claims.data(name)
    if found is None:
        pytest.skip(f"{claims.CLAIMS[name][0].name} is not there")
    assert claims.standing(README, name) == claims.passage(name, found)


@pytest.mark.parametrize("name", ["work-precision", "all-scenarios"])
def test_data_that_is_kept_is_there_and_small(name):
    path = claims.CLAIMS[name][0]
    assert path.exists() and path.stat().st_size < 500_000


def test_every_figure_of_a_claim_is_in_the_readme():
    for name, (path, _) in claims.CLAIMS.items():
        after = README[README.index(f"<!-- claims: {name} -->") :]
        figure = re.search(r"!\[.*?\]\((.*?)\)", after)[1]
        if name != "honesty":
            assert Path(figure).name == path.with_suffix(".png").name


def test_work_precision_in_words():
    said = claims.work_precision(study())
    for part in (
        "`sealdyn study work-precision scenarios/made_up.toml` charts both, on Abacus with 3 cores: at an error of 1e-3"
        " at any time CVODE Adams is fastest, 4 ms, 1.7 times faster than CVODE BDF, 5.9 times faster than SciPy"
        " DOP853; at 1e-6 CVODE Adams is fastest, 4 ms, hardly ahead of CVODE BDF, 5.9 times",
        "; at 1e-9 nobody wins (the judges differ by 4.1e-08).",
        "Newmark leaves the chart as crosses, more than 50 times slower",
        "for 1e-2 harmonic balance with given coefficients (error 0.002, 0.4 ms), for 1e-4 linear film, as given"
        " (error 3.0e-5, 20 ms)",
        "; the best linear film is wrong by 3.0e-5 whatever the solver.",
        "; the judge is Gauss, from which DOP853 differs by 4.1e-8.",
    ):
        assert part in said, (part, said)


def test_all_scenarios_in_words():
    said = claims.all_scenarios(page())
    for part in (
        "3 of them (`abacus`), on Abacus with 3 cores, a busy machine (wall times up to 2 times the processor's): at",
        "at 1e-3 the fastest is Adams on 2 and IDA on 1; at 1e-6 the fastest is Adams on 1 and BDF on 1.  In 1 of",
        "In 1 of these 5 cases the next is within 1.5 times, a tie; the largest",
        "lead over DOP853 is that of Adams on `b`, 260 times at 1e-3, 44 times at least.",
        "`c` ends with IDA alone; ",
        "no winner is named where the judges differ by too much (at 1e-6 `c`).",
    ):
        assert part in said, (part, said)


def test_honesty_in_words():
    said = claims.honesty(HONEST)
    assert "(seed 7): of 100 random seals with asked accuracies from 1e-7 to 1e-2, 99 were run within" in said
    assert (
        "41 of all on the linear film" in said
        and "cost 1.9 times (median)" in said
        and "; the run alone 1.3 times." in said
    )


@pytest.mark.parametrize("name, made", [("work-precision", study()), ("all-scenarios", page())])
def test_a_chart_is_told_in_three_sentences(name, made):
    for found in (made, claims.data(name)):
        assert len(re.findall(r"\.(?:  |$)", claims.CLAIMS[name][1](found))) == 3


def enlarged(tree, by=1.08):
    """The same data with every number larger, by so little that the same sentences are said."""
    if isinstance(tree, dict):
        return {key: enlarged(below, by) for key, below in tree.items()}
    if isinstance(tree, list):
        return [enlarged(below, by) for below in tree]
    if isinstance(tree, int) and not isinstance(tree, bool):
        return tree + 1
    return tree * by if isinstance(tree, float) else tree


# What is typed: questions asked of the data, and names.
TYPED = {"work-precision": ["for 1e-2 ", "for 1e-4 ", "(the judges differ by 4.1e-08)", "DOP853"],
         "all-scenarios": ["within 1.5 times", "DOP853"], "honesty": []}  # fmt: skip


@pytest.mark.parametrize("name, made", [("work-precision", study()), ("all-scenarios", page()), ("honesty", HONEST)])
def test_other_data_other_numbers(name, made):
    """Every number in the words is another when the data is: none is typed."""
    other = enlarged(made)
    if name == "all-scenarios":
        other["scenes"] += [{**scene, "name": scene["name"] * 2} for scene in other["scenes"][::-1]]
    told = []
    for found in (made, other):
        said = claims.CLAIMS[name][1](found)
        for words in TYPED[name]:
            assert words in said
            said = said.replace(words, "")
        told.append(re.findall(r"\d[\d.]*(?:e-?\d+)?", said))
    assert len(told[0]) == len(told[1]) >= 8
    assert all(a != b for a, b in zip(*told, strict=True)), list(zip(*told, strict=True))


def test_a_passage_is_written_between_its_markers_only():
    text = "one\n<!-- claims: a -->\nold\n<!-- end -->\ntwo\n<!-- claims: b -->\nkept\n<!-- end -->\n"
    fresh = claims.written(text, "a", r"new \1 words")
    assert claims.standing(fresh, "a") == r"new \1 words" and claims.standing(fresh, "b") == "kept"
    assert fresh.startswith("one\n<!--") and claims.standing(text, "c") is None


def test_numbers_in_words():
    assert [claims.number(x, 2) for x in (262.0, 4.364e-3, 3.1e-5, 1.0, 2.04, 1e-12)] == [
        "260", "0.0044", "3.1e-5", "1", "2", "1.0e-12"
    ]  # fmt: skip
    assert [claims.power(x) for x in (1e-2, 2.5e-3, 1e-6, 1e-10)] == ["1e-2", "2.5e-3", "1e-6", "1e-10"]
