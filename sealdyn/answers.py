"""An answer declares what it is: numbers, one sentence, tables and panels, all plain data in SI.

Whoever shows it (terminal, figure, page, file) takes names and units from `quantities`; nobody formats by hand.
`plain` and `panels_of` carry panels through an archive; `toml_line` and `toml_text` write plain data as TOML.
"""

import math
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field, fields, is_dataclass
from typing import Any

from .quantities import quantity, units_read

# Styles of series that have no role, in order.
CYCLE = ("first", "second", "third", "fourth", "fifth", "sixth", "seventh")


@dataclass(frozen=True)
class Table:
    """Rows of numbers (SI), words, truths or None below `columns`, pairs of a quantity (or SI unit) and a heading.
    Columns of the quantity "row" hold numbers of the quantity (or SI unit) that `of_rows` names for each row."""

    name: str
    columns: Sequence[tuple[str, str]]
    rows: Sequence[Sequence[Any]]
    of_rows: Sequence[str] = ()


def dotted(
    tree: Mapping[str, Any], ends: Callable[[Mapping], bool] = lambda table: False, name: str = ""
) -> Iterator[tuple[str, Any]]:
    """Dotted keys and values of tables within tables; a table that `ends` the way is a value itself."""
    for key, value in tree.items():
        where = f"{name}.{key}" if name else key
        if isinstance(value, Mapping) and not ends(value):
            yield from dotted(value, ends, where)
        else:
            yield where, value


def columns(records: Sequence[Any], names: Sequence[str]) -> dict[str, list]:
    """What each of the records (None: nothing) has by these names, {name: of all records}."""
    return {name: [None if record is None else getattr(record, name) for record in records] for name in names}


def table_of(name: str, columns: Sequence[tuple[str, str, str]], rows: Sequence[Mapping[str, Any]]) -> Table:
    """A table of rows that are dicts: `columns` of a quantity, a heading, and the key in a row."""
    return Table(name, [column[:2] for column in columns], [[row.get(key) for *_, key in columns] for row in rows])


@dataclass(frozen=True)
class Axis:
    """A quantity (or SI unit) along an axis, and its name, by default that of the quantity.

    `scale` "linear", "log" or "asinh" (linear below `width`, SI); `low`, `high` (SI) where the axis is not to fit what
    is drawn; `words` names places 0, 1, 2 ... of an axis of words."""

    quantity: str = "1"
    label: str = ""
    scale: str = "linear"
    low: float | None = None
    high: float | None = None
    width: float | None = None
    words: Sequence[str] = ()


@dataclass(frozen=True)
class Series:
    """What is drawn over x and y (SI; None leaves a gap).

    `kind`: "line"; "marks"; "shade" between y and `z` over x; "bars" at x as high as y, from `z` on (lying, at y as
    long as x, where the y axis has words); "map" of `z` [y][x] in colours; "contour" of `z` [y][x] at zero; "words":
    `names` at x, y.
    `style`: words in any order: a role that has a colour of its own (film, tilt, leakage, contact, theory, stator,
    rotor, good, bad, warn, black, grey, pale; first, second ... seventh of a cycle; a number from 0 to 1, early to
    late), dashes (dashed, dotted, dashdot), a mark (circle, square, diamond, triangle, down, cross, plus, star, tick,
    point), open, thin, thick, faint, small, large, front (above all else), wide (bars that touch).  `error`: bars of
    error on y.  `names`: a word at each mark or bar.  `right`: belongs to the axis on the right."""

    kind: str
    x: Sequence = ()
    y: Sequence = ()
    z: Sequence | None = None
    label: str = ""
    style: str = ""
    error: Sequence | None = None
    names: Sequence[str] = ()
    right: bool = False


@dataclass(frozen=True)
class Level:
    """A value (SI) of the y axis, or of the x axis (`upright`), drawn through the panel, its meaning and, with
    `number`, the value itself as its label; `to`: a band up to there.  `legend`: named in the legend instead."""

    value: float
    meaning: str = ""
    upright: bool = False
    style: str = "grey dashed"
    number: bool = False
    to: float | None = None
    legend: bool = False


@dataclass(frozen=True)
class Panel:
    """One pair of axes.  `below`: stands under the panel before it and shares its x axis; others stand side by side.
    `wide`, `tall`: shares of the figure's width and height.  `right`: the axis on the right.  `colour`: of a map.
    `polar`: x an angle, y a radius.  `equal`: both axes in one scale.  `down`: y grows downwards.
    `first`: begins a row.  `note`: words in a corner; a panel without series says them in its middle."""

    title: str = ""
    x: Axis = Axis()
    y: Axis = Axis()
    series: Sequence[Series] = ()
    levels: Sequence[Level] = ()
    right: Axis | None = None
    colour: Axis | None = None
    note: str = ""
    below: bool = False
    wide: float = 1.0
    tall: float = 1.0
    polar: bool = False
    equal: bool = False
    down: bool = False
    first: bool = False


@dataclass(frozen=True)
class Line:
    """A labelled line of a summary: `parts` (words, value, quantity or SI unit[, digits]) in their order, words alone
    where the value is None; a `detail` is printed only where all is asked for."""

    label: str
    parts: Sequence[tuple]
    detail: bool = False


@dataclass(frozen=True)
class Answer:
    """`numbers` (SI, nested: what `--json` prints), what was `found` in one sentence, `tables`, `panels`, `notes` (what
    a number cannot say: limits, failed points), `written` {quantity or SI unit: unit}, in which it is read (those of
    `reading_in` where it is made), and the `lines` of a run's summary."""

    numbers: dict[str, Any]
    found: str
    tables: Sequence[Table] = ()
    panels: Sequence[Panel] = ()
    notes: Sequence[str] = ()
    written: Mapping[str, str] = field(default_factory=units_read)
    lines: Sequence[Line] = ()

    def __getitem__(self, key: str) -> Any:
        return self.numbers[key]


def as_json(answer: Answer) -> dict[str, Any]:
    """What `--json` prints of an answer: its numbers, `found`, `notes`, `tables`, units as `written`, and `verdict`,
    the sentences of both.  **Raises** ValueError where a number has one of these names."""
    words = {"found": answer.found, "notes": list(answer.notes), "verdict": [answer.found, *answer.notes]}
    words |= {"tables": [_table(table) for table in answer.tables], "written": dict(answer.written)}
    if twice := words.keys() & answer.numbers.keys():
        raise ValueError(f"numbers named {sorted(twice)}")
    return {**answer.numbers, **words}


def _table(table: Table) -> dict:
    """A table as JSON has it; its columns keep their quantity, from which names and units follow."""
    columns = [{"name": name, "unit": quantity(held).unit, "quantity": held} for held, name in table.columns]
    of_rows = [{"unit": quantity(held).unit, "quantity": held} for held in table.of_rows]
    more = {"of_rows": of_rows} if of_rows else {}
    return {"name": table.name, "columns": columns, "rows": _data(table.rows), **more}


def plain(panels: Sequence[Panel]) -> list[dict]:
    """Panels as JSON has them: lists for arrays, null for what is no number, fields at their defaults left out."""
    return [_data(panel) for panel in panels]


def panels_of(held: Sequence[dict]) -> list[Panel]:
    """Panels of what `plain` returned.  **Raises** TypeError for anything else."""
    out = []
    for row in held:
        axes = {name: Axis(**row[name]) for name in ("x", "y", "right", "colour") if name in row}
        parts = {"series": [Series(**one) for one in row.get("series", ())]}
        parts["levels"] = [Level(**one) for one in row.get("levels", ())]
        out.append(Panel(**{**row, **axes, **parts}))
    return out


def _data(value):
    """JSON-ready data of a value of any panel."""
    if is_dataclass(value):
        held = ((part, getattr(value, part.name)) for part in fields(value))
        return {part.name: _data(one) for part, one in held if one is not part.default and not _is_blank(one)}
    if hasattr(value, "tolist"):
        value = value.tolist()
    if isinstance(value, list | tuple):
        return [_data(one) for one in value]
    return None if isinstance(value, float) and not math.isfinite(value) else value


def _is_blank(value) -> bool:
    return value is None or (isinstance(value, str | list | tuple) and not value)


def toml_line(value: Any) -> str:
    """A dict, list, number, string or truth value on one line of TOML.  TOML has no null: keys of None are left out."""
    return _item(value).as_string()


def toml_text(tables: dict[str, Any]) -> str:
    """Tables as the text of a TOML file.  Raises TypeError or ValueError for what TOML cannot hold."""
    import tomlkit

    return tomlkit.dumps(_with_arrays(tables))


def _with_arrays(tables: Any) -> Any:
    """Tables whose lists of numbers are TOML already."""
    if isinstance(tables, dict):
        return {key: _with_arrays(held) for key, held in tables.items()}
    return _item(tables) if _are_numbers(tables) else tables


def _are_numbers(value: Any) -> bool:
    return isinstance(value, list | tuple) and len(value) > 0 and all(type(entry) in (int, float) for entry in value)


def _item(value: Any):
    import tomlkit

    if isinstance(value, dict):
        table = tomlkit.inline_table()
        for key, held in value.items():
            if held is not None:
                table.append(key, _item(held))
        return table
    if isinstance(value, list | tuple):
        if _are_numbers(value):
            # To append them one by one takes the square of their count.
            return tomlkit.array(f"[{', '.join(map(repr, value))}]")
        array = tomlkit.array()
        array.extend(map(_item, value))
        return array
    return tomlkit.item(value)
