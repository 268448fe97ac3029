"""The answer of a study as columns: its lists, and those of its lists of rows."""

from dataclasses import dataclass

import numpy as np

# What an answer declares for those who read it, and columns that hold words where they hold anything.
NO_COLUMNS = ("left_out", "verdict", "notes", "tables", "written")
WORDS = ("failed", "reason", "message")


@dataclass(frozen=True)
class Column:
    """A list of an answer: its values (numbers with NaN, truths or words with "" for what there is not), and the path
    of the list of rows whose column it is, "" for a list that stands by itself."""

    values: np.ndarray
    rows: str = ""


def columns(answer: dict) -> dict[str, Column]:
    """Every list of an answer under its path, "curve/h_min".  Of a list of rows, "modes", each name is a column,
    "modes/frequency"; rows within rows, and lists of unequal lengths, are tables of their own ("points/let_go") with a
    column of the number of the row they belong to ("points/let_go/points", from 0).  An axis ("key", "unit", "values")
    is the column named like its key."""
    found: dict[str, Column] = {}
    _add_tree({key: held for key, held in answer.items() if key not in NO_COLUMNS}, "", found)
    return {key: column for key, column in found.items() if column.values.size}


def _add_tree(tree: dict, path: str, found) -> None:
    for name, held in tree.items():
        key = f"{path}/{name}" if path else name
        if is_axis(held):
            found[held["key"]] = Column(_array(held["values"]))
        elif isinstance(held, dict):
            _add_tree(held, key, found)
        elif _is_rows(held):
            _add_rows(held, key, found)
        elif isinstance(held, list) and held and (values := _array(held, name in WORDS)) is not None:
            found[key] = Column(values)


def _add_rows(rows: list[dict], path: str, found) -> None:
    # A row that failed has other names.
    for name in dict.fromkeys(name for row in rows for name in row):
        _add_cells([row.get(name) for row in rows], f"{path}/{name}", path, found)


def _add_cells(cells: list, path: str, rows: str, found) -> None:
    """One name of all rows: a column, the columns of tables in them, or rows in them."""
    known = [cell for cell in cells if cell is not None]
    if known and all(isinstance(cell, dict) for cell in known):
        for name in dict.fromkeys(name for cell in known for name in cell):
            _add_cells([cell and cell.get(name) for cell in cells], f"{path}/{name}", rows, found)
    elif any(map(_is_rows, known)) and all(_is_rows(cell) or cell == [] for cell in known):
        owner = rows.rpartition("/")[2]
        _add_rows([{owner: k, **row} for k, cell in enumerate(cells) for row in cell or ()], path, found)
    elif (values := _array(cells, path.rpartition("/")[2] in WORDS)) is not None:
        found[path] = Column(values, rows)
    elif all(isinstance(cell, list) for cell in known):
        _add_unequal(cells, path, rows, found)


def _add_unequal(cells: list, path: str, rows: str, found) -> None:
    """Lists of unequal lengths one below the other, those of equal lengths in one table."""
    values = _array([value for cell in cells for value in cell or ()])
    owners = np.array([float(k) for k, cell in enumerate(cells) for _ in cell or ()])
    if values is None:
        return
    parent, name = path.rpartition("/")[0], rows.rpartition("/")[2]
    wanted = path if parent == rows else parent
    like = (c.rows for key, c in found.items() if key == f"{c.rows}/{name}" and np.array_equal(c.values, owners))
    if wanted != path and f"{wanted}/{name}" not in found:
        table = wanted
    else:
        table = next((table for table in like if table.startswith(f"{parent}/") or table == parent), path)
    found[f"{table}/{name}"] = Column(owners, table)
    found[f"{table}/{path.rpartition('/')[2]}"] = Column(values, table)


def is_axis(held) -> bool:
    return isinstance(held, dict) and {"key", "unit", "values"} <= set(held) and isinstance(held["key"], str) and (
        isinstance(held["values"], list) and bool(held["values"]) and _array(held["values"]) is not None
    )  # fmt: skip


def _is_rows(held) -> bool:
    return isinstance(held, list) and bool(held) and all(isinstance(row, dict) for row in held)


def _array(cells: list, words: bool = False) -> np.ndarray | None:
    """Numbers, truths or words of any rectangular list; None of another."""
    lists = [cell for cell in cells if isinstance(cell, list)]
    if lists:
        parts = [None if cell is None else _array(cell, words) if isinstance(cell, list) else False for cell in cells]
        arrays = [part for part in parts if part is not None]
        if any(not isinstance(part, np.ndarray) for part in arrays):
            return None
        if any(cell is not None and part is None for cell, part in zip(cells, parts, strict=True)):
            return None
        kinds = {part.dtype.kind == "U" for part in arrays}
        if len({part.shape for part in arrays}) > 1 or len(kinds) > 1:
            return None
        blank = np.full(arrays[0].shape, "" if kinds == {True} else np.nan)
        return np.array([blank if part is None else part for part in parts])
    known = [cell for cell in cells if cell is not None]
    if any(not isinstance(cell, bool | int | float | str) for cell in known):
        return None
    if any(isinstance(cell, str) for cell in known) or (words and not known):
        return np.array(["" if cell is None else str(cell) for cell in cells])
    if known and all(isinstance(cell, bool) for cell in cells):
        return np.array(cells)
    return np.array([np.nan if cell is None else cell for cell in cells], float)
