"""Diameters, as drawings have them: where a table has a radius, its diameter may stand instead; scenes hold radii."""

import dataclasses
from typing import Any

from ..units import Length, QuantityError
from .errors import ScenarioError, diameters, table_in, tables, without_indices

LENGTH = Length.__metadata__[0]


def radius_key(kind: type, key: str) -> str:
    """The dotted key of the radius, if `key` is that of its diameter; else `key`.  `kind`: the scenario's dataclass."""
    table, _, last = key.rpartition(".")
    twin = diameters(tables(kind).get(without_indices(table), {})).get(last)
    return f"{table}.{twin}" if twin else key


def with_radii(tree: Any, kind: type, name: str, wrong: list, path: str = "") -> tuple[Any, dict[str, str]]:
    """The tables `tree` of the dataclass `kind` with every diameter halved under the key of its radius, and which were:
    {dotted key of the radius: key of the diameter}.  To `wrong` are appended ScenarioErrors, of the scenario `name`,
    for diameters beside their radius and for those that are no length, which are then any."""
    halved = {}
    if isinstance(tree, list):
        entries = [with_radii(entry, kind, name, wrong, f"{path}.{n}") for n, entry in enumerate(tree)]
        return [entry for entry, _ in entries], {key: twin for _, found in entries for key, twin in found.items()}
    if not isinstance(tree, dict):
        return tree, halved
    keys, tree = {f.name: f.type for f in dataclasses.fields(kind)}, tree.copy()
    for key in tree:
        if inner := table_in(keys.get(key)):
            tree[key], below = with_radii(tree[key], inner, name, wrong, f"{path}.{key}".strip("."))
            halved |= below
    for diameter, radius in diameters(keys).items():
        if diameter in tree:
            try:
                tree[radius] = _half(tree, diameter, radius, f"{path}.{diameter}", name)
            except ScenarioError as error:
                wrong.append(error)
                tree[radius] = 1.0
            del tree[diameter]
            halved[f"{path}.{radius}"] = diameter
    return tree, halved


def _half(table: dict, diameter: str, radius: str, key: str, name: str) -> float:
    if radius in table:
        raise ScenarioError(name, key, f"{diameter} and {radius}", "one of the two")
    try:
        return LENGTH.read(table[diameter]) / 2
    except QuantityError as error:
        raise ScenarioError(name, key, error.found, error.expected) from None
