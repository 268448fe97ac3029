"""Keys of a scenario: what each of its tables may hold, which of them a file has, and diameters in place of radii."""

import dataclasses
import types
import typing
from collections.abc import Iterator
from functools import cache, lru_cache
from typing import Any

from ..scene.scene import SceneError
from ..units import Length, QuantityError, RadiusQuantity

LENGTH = Length.__metadata__[0]


@cache
def tables(kind: type, path: str = "") -> dict[str, dict[str, Any]]:
    """Every table a scenario may have, by dotted path: {path: {key: what it holds (a type)}}, from the dataclass
    `kind`."""
    keys = {f.name: f.type for f in dataclasses.fields(kind)}
    found = {path: keys}
    for key, holds in keys.items():
        if below := table_in(holds):
            found |= tables(below, f"{path}.{key}" if path else key)
    return found


def table_in(holds: Any) -> type | None:
    """The table a key holds (alone, optional, in a list, or instead of a word), if it holds one."""
    if dataclasses.is_dataclass(holds):
        return holds
    if typing.get_origin(holds) in (list, typing.Union, types.UnionType):
        return next((t for t in map(table_in, typing.get_args(holds)) if t), None)
    return None


def is_list(holds: Any) -> bool:
    """Whether a key holds a list of tables."""
    return typing.get_origin(holds) is list and dataclasses.is_dataclass(typing.get_args(holds)[0])


def held_at(kind: type, key: str) -> Any:
    """What a dotted key of a scenario holds (a type), None if there is no such key."""
    table, _, last = without_indices(key).rpartition(".")
    return tables(kind).get(table, {}).get(last)


def is_marked(holds: Any, mark: type) -> bool:
    """Whether what a key may hold is annotated with a `mark`: RadiusQuantity, VaryingQuantity."""
    kinds = (holds, *typing.get_args(holds))
    return any(isinstance(part, mark) for kind in kinds for part in getattr(kind, "__metadata__", ()))


def without_indices(path: str) -> str:
    """A dotted path without the numbers of list entries: "housing.axial.0.frequency" is "housing.axial.frequency"."""
    return ".".join(part for part in path.split(".") if not part.isdigit())


def leaves(tree: Any, kind: type, key: str = "") -> Iterator[tuple[str, Any]]:
    """Dotted keys of a scenario's tables (`tree`), down to what is no table, and what stands there; `key` is the path
    to the tree, `kind` the scenario's dataclass."""
    for step, value in tree.items() if isinstance(tree, dict) else enumerate(tree):
        path = f"{key}.{step}" if key else str(step)
        if isinstance(value, dict | list) and without_indices(path) in tables(kind):
            yield from leaves(value, kind, path)
        else:
            yield path, value


def bare_keys(held: Any, key: str = "") -> Iterator[str]:
    """Dotted keys of what holds numbers other than 0 without a unit; of a quantity over time its own key for its
    values, and with ".time" for its times."""
    if isinstance(held, dict):
        for step, below in held.items():
            if step != "study" or key:
                yield from bare_keys(below, key if step == "value" else f"{key}.{step}".lstrip("."))
    elif isinstance(held, list) and any(isinstance(entry, dict) for entry in held):
        for step, below in enumerate(held):
            yield from bare_keys(below, f"{key}.{step}")
    elif any(isinstance(entry, int | float) and entry for entry in (held if isinstance(held, list) else [held])):
        yield key


def diameters(keys: dict[str, Any]) -> dict[str, str]:
    """{"outer_diameter": "outer_radius"} of a table's `keys` {key: what it holds (a type)}."""
    return {key.replace("radius", "diameter"): key for key, holds in keys.items() if is_marked(holds, RadiusQuantity)}


@lru_cache(4096)
def _radii(kind: type, table: str = "") -> dict[str, str]:
    """{key of a diameter: that of its radius} of a table, by its dotted path, of the dataclass `kind`."""
    return diameters(tables(kind).get(table, {}))


def radius_key(kind: type, key: str) -> str:
    """The dotted key of the radius, if `key` is that of its diameter; else `key`.  `kind`: the scenario's dataclass."""
    table, _, last = key.rpartition(".")
    twin = _radii(kind, without_indices(table)).get(last)
    return f"{table}.{twin}" if twin else key


def with_radii(tree: Any, kind: type, wrong: list[SceneError], path: str = "") -> tuple[Any, dict[str, str]]:
    """The tables `tree` of the dataclass `kind` with every diameter halved under the key of its radius, and which were:
    {dotted key of the radius: key of the diameter}.  What is wrong goes to `wrong`: diameters beside their radius and
    those that are no length, which are then any."""
    halved = {}
    if isinstance(tree, list):
        entries = [with_radii(entry, kind, wrong, f"{path}.{n}") for n, entry in enumerate(tree)]
        return [entry for entry, _ in entries], {key: twin for _, found in entries for key, twin in found.items()}
    if not isinstance(tree, dict):
        return tree, halved
    keys, tree = tables(kind)[""], tree.copy()
    for key in tree:
        if inner := table_in(keys.get(key)):
            tree[key], below = with_radii(tree[key], inner, wrong, f"{path}.{key}".strip("."))
            halved |= below
    for diameter, radius in _radii(kind).items():
        if diameter not in tree:
            continue
        written = tree.pop(diameter)
        try:
            if radius in tree:
                raise QuantityError(f"{diameter} and {radius}", "one of the two")
            tree[radius] = LENGTH.read(written) / 2
        except QuantityError as error:
            wrong.append(SceneError(f"{path}.{diameter}", error.found, error.expected))
            tree[radius] = 1.0
        halved[f"{path}.{radius}"] = diameter
    return tree, halved
