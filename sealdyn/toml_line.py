"""Values written as TOML: on one line for overrides and for scenarios printed as they were resolved, or as a file."""

from typing import Any

import tomlkit


def toml_line(value: Any) -> str:
    """A dict, list, number, string or truth value on one line of TOML.  TOML has no null: keys of None are left out."""
    return _item(value).as_string()


def toml_text(tables: dict[str, Any]) -> str:
    """Tables as the text of a TOML file.  Raises TypeError or ValueError for what TOML cannot hold."""
    return tomlkit.dumps(tables)


def _item(value: Any):
    if isinstance(value, dict):
        table = tomlkit.inline_table()
        for key, held in value.items():
            if held is not None:
                table.append(key, _item(held))
        return table
    if isinstance(value, list | tuple):
        array = tomlkit.array()
        array.extend(map(_item, value))
        return array
    return tomlkit.item(value)
