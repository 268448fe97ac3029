"""How results look to those who work in Python: figures of a run, drawn from its archive only; scenarios, results and
answers as a notebook shows them, tables in HTML, and as a prompt does, a few lines.
"""

from __future__ import annotations

import importlib
from collections.abc import Callable, Iterable, Mapping, Sequence
from contextlib import AbstractContextManager
from html import escape
from pathlib import Path
from typing import TYPE_CHECKING, Any

from ..answers import dotted
from .summary import run_answer
from .text import line_words, lines, study_lines, table_columns

if TYPE_CHECKING:
    from .charts.page import Figure


class Plot:
    """The charts of one archive, each a matplotlib Figure; `figure.savefig("orbit.svg")` writes it.

    `at_hand()` a context that gives the archive's path."""

    def __init__(self, at_hand: Callable[[], AbstractContextManager[Path]]):
        self._at_hand = at_hand

    def overview(self, turns: float = 4.0) -> Figure:
        """Everything on one sheet; the enlarged panels show the last `turns` turns of the shaft."""
        return self._drawn("overview", turns=turns)

    def orbit(self, turns: float = 8.0) -> Figure:
        """Path of the relative tilt and of each ring's own, of the last `turns` turns."""
        return self._drawn("orbit", turns=turns)

    def film(self, turns: float = 6.0) -> Figure:
        """Film thickness around the circle over the last `turns` turns, and over the face where it is thinnest."""
        return self._drawn("film", turns=turns)

    def spectrum(self, turns: float | None = None) -> Figure:
        """Relative tilt, axial motion and film thickness in orders of the shaft speed, of the last `turns` turns (None:
        the last half of the run)."""
        return self._drawn("spectrum", turns=turns)

    def poincare(self) -> Figure:
        """Relative tilt and film thickness once a turn."""
        return self._drawn("poincare")

    def _drawn(self, chart: str, **settings) -> Figure:
        draw = importlib.import_module(f"{__package__}.charts.{chart}").draw
        with self._at_hand() as path:
            return draw(path, None, **settings)


# Lines of a repr.
MOST_LINES = 10


def shortened(told: Sequence[str]) -> str:
    """Lines for a prompt; of more than ten the first, and how many others there are."""
    if len(told) <= MOST_LINES:
        return "\n".join(told)
    return "\n".join([*told[: MOST_LINES - 1], f"  ... {len(told) - MOST_LINES + 1} more lines"])


def html_table(rows: Iterable[Sequence[str]], headings: Sequence[str] = (), caption: str = "") -> str:
    """A table of words."""
    head = "".join(f"<th>{escape(word)}</th>" for word in headings)
    body = "".join(f"<tr>{''.join(f'<td>{escape(word)}</td>' for word in row)}</tr>" for row in rows)
    top = f"<caption>{escape(caption)}</caption>" if caption else ""
    return f"<table>{top}{f'<thead><tr>{head}</tr></thead>' if head else ''}<tbody>{body}</tbody></table>"


def run_repr(summary: dict[str, Any]) -> str:
    """The first lines of a run's summary."""
    return shortened(lines("run", run_answer(summary)))


def run_html(summary: dict[str, Any]) -> str:
    """A run's summary as a table."""
    answer = run_answer(summary)
    rows = [("status", summary["status"])] + ([("", answer.found)] if answer.found else [])
    rows += [(line.label, words) for line in answer.lines if not line.detail and (words := line_words(line))]
    return html_table([*rows, *(("WARNING", note) for note in answer.notes)])


def study_repr(name: str, answer: dict[str, Any]) -> str:
    """The first lines of what a study found."""
    return shortened([f"{name}: {answer['status']}", *study_lines(answer)])


def study_html(answer: dict[str, Any]) -> str:
    """What a study found, its tables and its notes."""
    parts = [f"<p>{escape(answer['found'])}</p>"]
    for table in answer["tables"]:
        columns = table_columns(table)
        if columns:
            heads, *rows = zip(*([cell.strip() for cell in column] for column in columns), strict=True)
            parts.append(html_table(rows, heads, table["name"]))
    return "".join([*parts, *(f"<p>{escape(note)}</p>" for note in answer["notes"])])


def keys_html(tables: Mapping[str, Any], caption: str) -> str:
    """Tables of a scenario as they were written, a row for each key."""
    rows = [(key, str(value)) for key, value in dotted(tables, lambda table: not table)]
    return html_table(rows, ("key", "value"), caption)
