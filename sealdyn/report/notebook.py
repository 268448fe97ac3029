"""Scenarios, results and answers as a notebook shows them: tables in HTML; and as a prompt does: a few lines."""

from collections.abc import Iterable, Mapping, Sequence
from html import escape
from typing import Any

from .summary import run_answer
from .text import line_words, lines, study_lines, table_columns

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
    return html_table(_rows(tables), ("key", "value"), caption)


def _rows(tables: Mapping[str, Any], path: str = "") -> Iterable[tuple[str, str]]:
    for key, value in tables.items():
        if isinstance(value, Mapping) and value:
            yield from _rows(value, f"{path}{key}.")
        else:
            yield f"{path}{key}", str(value)
