"""Tables of any answer in lines of a terminal, with units from `quantities`."""

from collections.abc import Mapping

from ..quantities import in_words, number, shown_in

# Rows that are printed: of more, so many evenly spread ones.
MOST_ROWS = 24


def table_lines(table: Mapping, written: Mapping[str, str]) -> list[str]:
    """A table of an answer as JSON has it (answers.as_json), units as `written` in its scenario: headings, then rows,
    numbers to the right, words to the left; no column without a value but the first."""
    rows = table["rows"]
    if not rows:
        return []
    step = -(-len(rows) // MOST_ROWS)
    printed = [*rows[:-1:step], rows[-1]]
    held = [one["quantity"] for one in table.get("of_rows", ())]
    held = [*held[:-1:step], *held[-1:]]
    units, columns = {**written, **table.get("written", {})}, []
    for k, column in enumerate(table["columns"]):
        values = [row[k] for row in rows]
        if k == 0 or any(value is not None for value in values):
            columns.append(_column(column, values, [row[k] for row in printed], units, held))
    lines = ["  ".join(cells).rstrip() for cells in zip(*columns, strict=True)]
    return lines + ([f"({len(rows)} rows in the archive)"] if step > 1 else [])


def _column(column, values, printed, written, of_rows) -> list[str]:
    """Heading and cells of equal width; `of_rows` the quantity of each row."""
    words = any(isinstance(value, str) for value in values)
    if column["quantity"] == "row":
        cells = [column["name"], *(_of_row(*pair, written) for pair in zip(of_rows, printed, strict=True))]
    else:
        unit, factor = shown_in(column["quantity"], values, written)
        cells = [", ".join(filter(None, (column["name"], "" if words else unit))), *(_cell(v, factor) for v in printed)]
    width = max(map(len, cells))
    return [cell.ljust(width) if words else cell.rjust(width) for cell in cells]


def _of_row(held: str, value, written) -> str:
    return value if isinstance(value, str) else in_words(held, value, written) if value is not None else "-"


def _cell(value, factor: float) -> str:
    if isinstance(value, bool):
        return "yes" if value else "no"
    return value if isinstance(value, str) else number(value, factor)
