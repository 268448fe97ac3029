"""Panels of any answer: plain data that keeps every number, drawn in the units of the table."""

import json
from pathlib import Path

import numpy as np
import pytest

from sealdyn import quantities, units
from sealdyn.answers import Answer, Axis, Level, Panel, Series, Table, as_json, panels_of, plain
from sealdyn.report import panels
from sealdyn.report.panels import sheet_of
from sealdyn.report.text import table_lines, written_units
from sealdyn.units import Angle, Length, Pressure

SPEED, GAP = Axis("speed"), Axis("clearance")
# A panel of every kind, zeros and gaps among its numbers.
EVERY = [
    Panel("line", SPEED, GAP, [Series("line", [0.0, 100.0], [0.0, None], label="a", error=[0.0, 1e-6]),
                               Series("line", [0.0, 100.0], [1.0, 2.0], right=True, style="grey dashed")],
          [Level(0.0, "zero"), Level(50.0, "own", upright=True, number=True), Level(10.0, "b", upright=True, to=20.0)],
          right=Axis("N")),
    Panel("marks", SPEED, Axis("growth_rate", scale="asinh", width=0.1), [
        Series("marks", np.array([1.0, 2.0]), np.array([-100.0, np.nan]), names=["a", "b"], style="bad open cross")],
          below=True),
    Panel("bars", Axis("share"), Axis("1", words=["x", "y"]), [Series("bars", [0.5, 0.2], [0, 1], names=["50", ""])]),
    Panel("map", SPEED, Axis("rad", "coning"), [
        Series("map", [1.0, 2.0], [0.0, 1e-3], [[-1.0, None], [3.0, 400.0]]),
        Series("contour", [1.0, 2.0], [0.0, 1e-3], [[-1.0, 2.0], [3.0, 400.0]], label="zero"),
        Series("words", [1.5], [5e-4], names=["inside"])], colour=Axis("growth_rate", scale="asinh")),
    Panel("words map", SPEED, GAP, [Series("map", [1.0, 2.0], [1e-6, 2e-6], [[0, 1], [1, None]])],
          colour=Axis("1", words=["stable", "unstable"])),
    Panel("shade", Axis("time", scale="log"), Axis("force"), [Series("shade", [0.1, 1.0], [1.0, 2.0], [0.0, 1.0])]),
    Panel("polar", Axis("angle"), Axis("radius"), [
        Series("map", [0.0, 1.0, 6.28], [0.03, 0.04], [[1e5] * 3, [2e5] * 3])], polar=True, colour=Axis("pressure")),
    Panel("nothing", note="why there is nothing"),
]  # fmt: skip


@pytest.mark.core
def test_panels_survive_an_archive_to_the_bit():
    held = json.loads(json.dumps(plain(EVERY)))
    back = panels_of(held)
    assert plain(back) == held
    for one, other in zip(EVERY, back, strict=True):
        for mine, there in zip(one.series, other.series, strict=True):
            y = [None if v is None or not np.isfinite(v) else v for v in np.array(mine.y, float).tolist()]
            assert there.y == y and there.kind == mine.kind and there.style == mine.style
        assert [level.value for level in other.levels] == [level.value for level in one.levels]


def test_every_kind_is_drawn_in_the_units_of_the_table():
    with quantities.reading_in({"rad/s": "rad/s"}):
        figure = sheet_of(EVERY, "title", "below", "found")
    figure.canvas.draw()
    axes = {ax.get_title("left"): ax for ax in figure.axes if ax.get_title("left")}
    assert set(axes) == {panel.title for panel in EVERY if not panel.polar}
    assert axes["shade"].get_xlabel() == "time, s" and axes["map"].get_ylabel() == "coning, mrad"
    assert axes["marks"].get_xlabel() == "shaft speed, rad/s"
    line = axes["line"].lines[0]
    assert line.get_xdata().tolist() == [0.0, 100.0]
    assert [text.get_text() for text in axes["nothing"].texts] == ["why there is nothing"]


def test_a_style_that_is_none_is_refused():
    with pytest.raises(ValueError, match="crimson"):
        sheet_of([Panel("p", series=[Series("line", [0], [0], style="crimson")])], "", "", "")


# --- quantities and tables -------------------------------------------------------------------------------


def test_factors_of_the_table_are_those_of_the_parser():
    """Display factors stand in quantities.py, parse factors in units.py: one times the other is one."""
    pairs = [(held.unit, held.shown, held.factor) for held in quantities.QUANTITIES.values() if held.shown]
    pairs += [(unit, shown, factor) for unit, sizes in quantities.SIZES.items() for _, shown, factor in sizes]
    for unit, shown, factor in pairs:
        if shown in ("%", "g", "") or unit == "B" or (unit, shown) == ("deg", "deg"):
            continue
        dimension, per = units.dimension_and_factor(shown.replace("N m/rad", "N*m/rad").replace(" ", "*"))
        own, one = units.dimension_and_factor(unit.replace(" ", "*"))
        assert float(per / one) * factor == pytest.approx(1.0, rel=1e-12), (unit, shown)
        assert dimension == own, (unit, shown)


@pytest.mark.parametrize(
    ("text", "overrides", "units"),
    [
        ('outer_pressure = "5 bar"\nclearance = "10 um"\n[shaft]\nspeed = "1000 rad/s"\n', [], {"rad/s": "rad/s"}),
        ('outer_pressure = "70 psig"\nclearance = "0.4 mil"\n', ['shaft.speed="9000 rpm"'],
         {"pressure": "psi", "clearance": "mil", "h_min": "mil", "rad/s": "rpm"}),
        ('speed = { time = [0, 1], value = ["1 rpm", "2 rpm"] }\nrunout = "20 um TIR"\nouter_diameter = "3 in"\n',
         ['rotor.runout="0.01 deg"'], {"rad/s": "rpm", "tilt": "deg", "radius": "in"}),
        # Times with a unit stand before the values.
        ('speed = { time = ["0 s", "1 s"], value = ["1 rpm", "2 rpm"] }\n', [], {"rad/s": "rpm"}),
        ("", ["film.outer_pressure=70 psig", "shaft.speed=9000 rpm"], {"Pa": "psi", "rad/s": "rpm"}),
        ('pressure_difference = "3 psi"\n', [], {"Pa": "psi", "rad/s": "rad/s"}),
        ('# speed = "100 rpm", clearance = "1 mil"\nclearance = 1e-5\n', [], {"rad/s": "rad/s"}),
    ],
)  # fmt: skip
def test_what_a_scenario_has_in_other_units_is_read_in_them(text, overrides, units):
    found = written_units({"scenario": text, "overrides": overrides})
    assert {name: found.get(name) for name in units} == units
    assert set(found.values()) == set(units.values())
    for name, unit in units.items():
        with quantities.reading_in(found):
            assert quantities.shown_in(name, [1.0])[0] == unit


def test_units_that_are_written_are_those_of_the_reader():
    for unit, others in quantities.WRITTEN.items():
        quantity = {"m": Length, "rad": Angle, "Pa": Pressure}[unit].__metadata__[0]
        for name, factor in others.items():
            assert quantity.read(f"{factor!r} {name}") == pytest.approx(1.0, rel=1e-12)


@pytest.mark.parametrize(
    ("name", "values", "written", "unit"),
    [
        ("clearance", [5e-6], {}, "um"), ("clearance", [0.0], {}, "um"), ("clearance", [2e-3], {}, "mm"),
        ("speed", [100.0], {}, "rpm"), ("speed", [100.0], {"rad/s": "rad/s"}, "rad/s"),
        ("frequency", [100.0], {"rad/s": "rpm"}, "Hz"), ("leakage", [1e-4], {}, "l/min"), ("N", [1.0], {}, "N"),
        ("1", [1.0], {}, ""), ("m", [None, float("nan")], {}, "um"), ("tilt", [2e-3, 1e-5], {}, "mrad"),
    ],
)  # fmt: skip
def test_the_unit_in_which_a_quantity_is_read(name, values, written, unit):
    with quantities.reading_in(written):
        assert quantities.shown_in(name, values)[0] == unit


def test_tables_of_an_answer_are_json_and_lines():
    table = Table("modes", [("1", "mode"), ("speed", "critical"), ("1", "never"), ("1", "stable")],
                  [[1, 100.0, None, True], [2, None, None, False]])  # fmt: skip
    found = json.loads(json.dumps(as_json(Answer({"own": 1.0}, "It whirls.", [table], notes=["Mind this."]))))
    assert found["verdict"] == ["It whirls.", "Mind this."] and found["own"] == 1.0
    assert found["tables"][0]["columns"][1] == {"name": "critical", "unit": "rad/s", "quantity": "speed"}
    head, one, other = table_lines(found["tables"][0])
    assert head.split("  ") == ["mode", "critical, rpm", "stable"] and one.split() == ["1", "954.9", "yes"]
    assert other.split() == ["2", "-", "no"]
    with pytest.raises(ValueError, match="tables"):
        as_json(Answer({"tables": []}, ""))


def test_a_long_table_is_thinned_but_keeps_both_ends():
    for count in (1, 24, 25, 1000):
        table = as_json(Answer({}, "", [Table("t", [("1", "n")], [[k] for k in range(count)])]))["tables"][0]
        numbers = [int(word) for word in map(str.strip, table_lines(table)[1:]) if word.isdecimal()]
        assert numbers[0] == 0 and numbers[-1] == count - 1 and len(numbers) <= 25


def test_few_charts_of_studies_have_a_file_of_their_own():
    charts = Path(panels.__file__).with_name("charts").glob("study_*.py")
    assert sorted(path.stem for path in charts) == [f"study_{n}" for n in ("runup", "tolerance", "work_precision")]
