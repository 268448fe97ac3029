"""The answer of a study as columns: its lists, and those of its lists of rows, with their units and the dimensions
along which they lie; and tables of them."""

import itertools
import json
import math
from dataclasses import dataclass, replace

import numpy as np

# Elements of a row that are columns of its table.
WIDEST = 16
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
    known = [cell for cell in cells if cell is not None]
    if any(isinstance(cell, list) for cell in known):
        arrays = [_array(cell, words) if isinstance(cell, list) else None for cell in known]
        if any(part is None for part in arrays):
            return None
        kinds = {part.dtype.kind == "U" for part in arrays}
        if len({part.shape for part in arrays}) > 1 or len(kinds) > 1:
            return None
        blank = np.full(arrays[0].shape, "" if kinds == {True} else np.nan)
        held = iter(arrays)
        return np.array([blank if cell is None else next(held) for cell in cells])
    if any(not isinstance(cell, bool | int | float | str) for cell in known):
        return None
    if any(isinstance(cell, str) for cell in known) or (words and not known):
        return np.array(["" if cell is None else str(cell) for cell in cells])
    if known and all(isinstance(cell, bool) for cell in cells):
        return np.array(cells)
    return np.array([np.nan if cell is None else cell for cell in cells], float)


# --- columns with their dimensions -----------------------------------------------------------------------


@dataclass(frozen=True)
class Variable:
    """A column with its place: name ("curve.h_min"), name of its table ("" at the top), names of its dimensions, those
    that are `shared` with others, and its unit.  A coordinate is what others lie along."""

    name: str
    table: str
    dimensions: tuple[str, ...]
    shared: tuple[str, ...]
    values: np.ndarray
    units: str
    coordinate: bool


def unit_of(key: str, units: dict) -> str:
    """Unit of a column: that of the longest end of its path which `units` knows ("h_min" is the unit of
    "curve/h_min"), or that of "*", "" without; of elements with units of their own a list as JSON."""
    names = key.split("/")
    ends = ["/".join(names[k:]) for k in range(len(names))]
    unit = next((units[end] for end in [*ends, "*"] if end in units), "")
    return unit if isinstance(unit, str) else json.dumps(unit)


def variables(answer: dict, units: dict, along: dict[str, list[str] | tuple[str, ...]]) -> list[Variable]:
    """The columns of an answer with their dimensions.

    `units` {path or its end, or "*" for all others: unit}; `along` {table, or path of a column: names of what it lies
    along, in the order of its axes}: columns of the same table, paths of columns or axes of the answer, or else a new
    name for the axis; a name that ends in "?" counts only where there is such a column.  Of rows the first dimension is
    that of the rows; a column of theirs that `along` names is a coordinate of it.  Axes that are not named have
    dimensions of their own.
    """
    found, units = columns(answer), units_of(answer, units)
    told = {table: [path for name in names if (path := _path(answer, table, name.rstrip("?"), found)) in found
                    or not name.endswith("?")] for table, names in along.items()}  # fmt: skip
    axes = {key for keys in told.values() for key in keys if key in found and found[key].values.ndim == 1}
    named = {key for key in axes if not found[key].rows}
    out, sizes = [], {}
    for key, column in found.items():
        # Words at the top are no columns unless something lies along them.
        if column.values.dtype.kind == "U" and not (column.rows or "/" in key or key in axes):
            continue
        table, name, shape = column.rows or key.rpartition("/")[0], key.replace("/", "."), column.values.shape
        names = told.get(key, told.get(key.rpartition("/")[0], told.get(column.rows, ())))
        names = [other for other in names if not (other in found and found[other].rows)]
        dimensions, shared = [name] if key in named else [f"{name}.{axis}" for axis in range(len(shape))], []
        for axis, other in enumerate([*([column.rows] if column.rows else []), *names][: len(shape)]):
            shown = other.replace("/", ".")
            fits = (axis == 0 and bool(column.rows)) or (
                found[other].values.shape == shape[axis : axis + 1]
                if other in found
                else sizes.setdefault(shown, shape[axis]) == shape[axis]
            )
            if key not in named and fits and shown not in dimensions and (other not in found or other in named):
                dimensions[axis] = shown
                shared.append(shown)
        shared = [name] if key in named else shared
        unit = "" if column.values.dtype.kind in "Ub" else unit_of(key, units)
        place = (table.replace("/", "."), tuple(dimensions), tuple(shared))
        out.append(Variable(name, *place, column.values, unit, key in axes))
    return out


def units_of(answer: dict, units: dict) -> dict:
    """`units` with those that an answer tells itself: of its axes, and in a table `units` of its own."""
    told, trees = {}, [answer]
    while trees:
        tree = trees.pop()
        if is_axis(tree):
            told[tree["key"]] = str(tree["unit"] or "1")
        trees += [held for held in tree.values() if isinstance(held, dict)]
    own = answer.get("units")
    return {**told, **units, **(own if isinstance(own, dict) else {})}


def _path(answer: dict, table: str, name: str, found) -> str:
    """What a table calls `name`: a column of its own or of the answer, the key of an axis, or a new dimension."""
    own = f"{table}/{name}" if table else name
    if own in found or name in found:
        return own if own in found else name
    held = answer
    for step in name.split("/"):
        held = held.get(step) if isinstance(held, dict) else None
    return held["key"] if is_axis(held) else name if "/" in name else own


def answer_variables(answer: dict, units: dict, along: dict) -> list[Variable]:
    """The variables of any answer; of one over a grid those over the grid, and of rows within its rows."""
    if not {"axes", "rows", "outputs"} <= set(answer) or _points(answer) != len(answer["rows"]):
        return variables(answer, units, along)
    within = variables({"rows": answer["rows"]}, units, along)
    return grid_variables(answer) + [v for v in within if v.table.startswith("rows.")]


def _points(answer: dict) -> int:
    """Points of the grid over the keys that a sweep varied."""
    return math.prod(len(axis["values"]) for axis in answer["axes"])


def grid_variables(answer: dict) -> list[Variable]:
    """The keys that a sweep varied, its outputs, and `status` and `message` of each run."""
    axes, keys = answer["axes"], tuple(answer["keys"])
    shape = tuple(len(axis["values"]) for axis in axes)
    found = []
    for axis in axes:
        # Words have no unit.
        unit = "" if axis["unit"] is None else axis["unit"] or axis.get("si", "SI")
        found.append(Variable(axis["key"], "", (axis["key"],), (axis["key"],), np.array(axis["values"]), unit, True))
    # A key that is varied and asked for is the coordinate already.
    outputs = [output for output in answer["outputs"] if output not in keys]
    for name, values in columns_of(answer["rows"], outputs).items():
        unit = "" if values.dtype.kind == "U" else answer["output_units"].get(name) or "1"
        found.append(Variable(name, "", keys, keys, values.reshape(shape), unit, False))
    return found


def columns_of(rows: list[dict], outputs: list[str]) -> dict[str, np.ndarray]:
    """{name: (n,)} of the outputs, and `status` and `message`, of rows (n) of runs: numbers with NaN for what there is
    not, or words with none for it; a point that failed is "not possible", the message its reason."""
    columns = {output: _values([row.get(output) for row in rows]) for output in outputs}
    columns["status"] = _values([str(row.get("status", "not possible")) for row in rows])
    columns["message"] = _values([row.get("failed", row.get("message", "")) for row in rows])
    return columns


def _values(column: list) -> np.ndarray:
    """Numbers (n,) with NaN for what there is not, or words with none for it."""
    if all(value is None or isinstance(value, int | float) for value in column):
        return np.array([np.nan if value is None else value for value in column], float)
    return np.array(["" if value is None else str(value) for value in column])


# --- tables ----------------------------------------------------------------------------------------------


def tables(found: list[Variable], name: str) -> dict[str, list[Variable]]:
    """Variables that can stand beside each other in columns, since they lie along the same dimensions; words and
    coordinates of what lies along fewer of them join.  Named by what their names begin with alike, or else `name` (the
    study's), and by the dimensions that a table has more than another of that name.  A list of many elements in a row
    is a table by itself; lists that share no dimension are in none."""
    groups: dict[tuple[str, ...], list[Variable]] = {}
    wide = {}
    for variable in found:
        if variable.shared and math.prod(variable.values.shape) > WIDEST * max(1, _shared_size(variable)):
            wide[variable.name] = [replace(variable, shared=variable.dimensions)]
        elif variable.shared:
            groups.setdefault(variable.shared, []).append(variable)
    joined: dict[tuple[str, ...], list[Variable]] = {}
    for own, some in groups.items():
        of = {variable.table for variable in some}
        fewer = (v for other, more in groups.items() if set(other) < set(own) for v in more)
        labels = (v for v in fewer if v.coordinate or v.values.dtype.kind == "U")
        joined[own] = [v for v in labels if v.table in of and v.name not in own]
    told = {own: some for own, some in groups.items() if not _all_told(own, some, joined)}
    names = {own: _common([v for v in some if not v.coordinate]) or name for own, some in told.items()}
    out = {}
    for own, some in sorted(told.items(), key=lambda group: len(group[0])):
        like = [other for other in told if names[other] == names[own]]
        first = next((other for other in like if set(other) < set(own)), ())
        more = "-".join(dimension.rpartition(".")[2] for dimension in own if dimension not in first)
        plain = all(set(own) <= set(other) for other in like)
        out[names[own] if plain else f"{names[own]}.{more}"] = some + joined[own]
    return out | wide


def _all_told(own, some, joined) -> bool:
    """Whether all of a group stands in wider tables, or is what others lie along."""
    elsewhere = {v.name for other, more in joined.items() if set(own) < set(other) for v in more}
    return all(v.coordinate or v.name in elsewhere for v in some)


def _common(some: list[Variable]) -> str:
    """The words, parted by points, with which the tables of all variables begin; of one at the top its name."""
    if len(some) == 1 and not some[0].table:
        return some[0].name
    words = zip(*(variable.table.split(".") for variable in some), strict=False)
    return ".".join(alike[0] for alike in itertools.takewhile(lambda words: len(set(words)) == 1, words))


def _shared_size(variable: Variable) -> int:
    sizes = dict(zip(variable.dimensions, variable.values.shape, strict=True))
    return math.prod(sizes[dimension] for dimension in variable.shared)


def long_columns(members: list[Variable], found: list[Variable], table: str) -> dict[str, np.ndarray]:
    """A table of `tables` as columns of equal length: coordinates first, the last dimension fastest, under their names
    without that of the table and with their units, "speed [rad/s]"; an element of what has more axes is a column,
    "stiffness.0.1".  Where there is more than one dimension, one without values is counted from 0."""
    widest = max(members, key=lambda variable: len(variable.shared))
    sizes = dict(zip(widest.dimensions, widest.values.shape, strict=True))
    order = [(dimension, sizes[dimension]) for dimension in widest.shared]
    coordinates = {variable.name: variable for variable in found if variable.coordinate}
    first = []
    for dimension, size in order:
        if dimension in coordinates:
            first.append(coordinates[dimension])
        elif len(order) > 1:
            first.append(Variable(dimension, "", (dimension,), (dimension,), np.arange(size), "", True))
    of_rows = [variable for variable in members if variable.coordinate and variable not in first]
    rest = [variable for variable in members if not variable.coordinate]
    out = {}
    for variable in (*first, *of_rows, *rest):
        short = variable.name.removeprefix(f"{table}.")
        for place, units, values in _spread(variable, order):
            heading = ".".join([short, *map(str, place)])
            heading = ".".join([variable.name, *map(str, place)]) if heading in out else heading
            out[heading] = (values, units)
    return {f"{heading} [{units}]" if units else heading: values for heading, (values, units) in out.items()}


def _spread(variable: Variable, order: list[tuple[str, int]]):
    """Place among its own axes, unit and values over all dimensions `order`, of each element of a variable."""
    shared = [dimension for dimension, _ in order if dimension in variable.shared]
    own = [axis for axis, dimension in enumerate(variable.dimensions) if dimension not in variable.shared]
    values = np.transpose(variable.values, [*(variable.dimensions.index(dimension) for dimension in shared), *own])
    shape = [size if dimension in shared else 1 for dimension, size in order]
    for place in itertools.product(*(range(variable.values.shape[axis]) for axis in own)):
        units = json.loads(variable.units) if variable.units.startswith("[") else variable.units
        for k in place if isinstance(units, list) else ():
            units = units[k]
        part = values[(Ellipsis, *place)].reshape(shape)
        yield place, units, np.broadcast_to(part, [size for _, size in order]).ravel()
