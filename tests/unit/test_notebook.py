"""What a prompt and a notebook show of scenarios, results and answers; and the outputs that a run has."""

import re
from html.parser import HTMLParser

import pytest
from command import SCENARIOS

import sealdyn

SHORT = {"run.turns": 2}
# As much as a prompt shows.
MOST = 10


class Cells(HTMLParser):
    """Cells of all tables of a page, and the tags left open."""

    def __init__(self, page):
        super().__init__()
        self.cells, self.open = [], []
        self.feed(page)

    def handle_starttag(self, tag, attrs):
        self.open.append(tag)

    def handle_endtag(self, tag):
        assert self.open.pop() == tag

    def handle_data(self, data):
        self.cells.append(data)


@pytest.fixture(scope="module")
def shown():
    scenario = sealdyn.read_scenario(SCENARIOS / "fms_reference.toml").with_(SHORT)
    return {
        "scenario": scenario,
        "result": sealdyn.run(scenario),
        "answer": sealdyn.study("equilibrium", scenario, points=11),
        "simulation": sealdyn.Simulation(scenario),
    }


@pytest.mark.parametrize("name", ["scenario", "result", "answer", "simulation"])
def test_a_prompt_shows_ten_lines_and_a_notebook_tables(shown, name):
    lines = repr(shown[name]).splitlines()
    assert 1 <= len(lines) <= MOST and all(line.strip() for line in lines)
    page = Cells(shown[name]._repr_html_())
    assert not page.open and len(page.cells) > 8


def test_they_show_what_is_there(shown):
    assert "outer_pressure" in " ".join(Cells(shown["scenario"]._repr_html_()).cells)
    assert f"{len(shown['scenario'].to_dict())}" and "fms_reference" in repr(shown["scenario"])
    assert Cells(shown["result"]._repr_html_()).cells[:2] == ["status", "ok"]
    assert shown["answer"].answer["found"] in repr(shown["answer"])
    heads = [column["name"] for column in shown["answer"].answer["tables"][0]["columns"]]
    cells = Cells(shown["answer"]._repr_html_()).cells
    assert any(cell.startswith(heads[0]) for cell in cells)
    assert re.search(r"h_min = \S+ m", repr(shown["simulation"]))


def test_no_words_of_a_scenario_are_tags(shown):
    tables = shown["scenario"].to_dict()
    page = sealdyn.Scenario.from_dict(tables, "a<b>", "Is 1 < 2 & 3?")._repr_html_()
    assert not Cells(page).open and "<b>" not in page


def test_a_run_that_collapses_is_shown():
    values = {"shaft.speed": 9000, "run.turns": 60, "rotor.runout": 1e-4}
    result = sealdyn.run(SCENARIOS / "fms_reference.toml", values)
    assert result.status == "collapsed" and "collapsed" in repr(result) and "collapsed" in result._repr_html_()


@pytest.mark.parametrize("name", ["fms_reference", "rub", "radial/lip_reference"])
def test_every_output_that_is_listed_can_be_asked_for(name):
    scenario = sealdyn.read_scenario(SCENARIOS / f"{name}.toml").with_({"run.duration": 1e-4})
    listed = sealdyn.list_outputs(scenario)
    assert len(listed) > 30 and not any(key.endswith("said") and unit for key, unit in listed.items())
    found = sealdyn.evaluate(scenario, {}, [*listed, "status"])
    assert set(listed) <= set(found)
    assert not any(isinstance(value, list | dict) for value in found.values())
