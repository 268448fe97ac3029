"""sealdyn/studies/_asked.pyi: `sealdyn.study` as a type checker sees it, with the settings of each study.

python tests/benchmark/typed_settings.py
"""

import dataclasses
import typing
from pathlib import Path

import sealdyn
from sealdyn.studies import study_names
from sealdyn.studies._runner import study_module

PAGE = Path(sealdyn.__file__).parent / "studies" / "_asked.pyi"
HEAD = """# Written by `python tests/benchmark/typed_settings.py` from the settings of the studies.
import os
from collections.abc import Callable, Iterable
from typing import Any, Literal, TypedDict, Unpack, overload

from ..scenario.reader import Scenario
from ._runner import Answer

Source = Scenario | str | os.PathLike[str]

class How(TypedDict, total=False):
    out: str | os.PathLike[str] | None
    workers: int | None
    scheduler: Any
    results: str | os.PathLike[str] | None
    progress: Callable[[float, float, str], None] | None
    without: Iterable[str]
""".replace("type Source = ", "Source = ")
WIDTH = 120
# What is as plain in Python as in a file; all else may be a quantity, words or an array.
PLAIN = {bool: "bool", int: "int", int | None: "int | None"}


def page() -> str:
    """The text of the file."""
    kinds, doors = [], []
    for name in study_names():
        settings = study_module(name.replace("-", "_")).Settings
        kind = name.title().replace("-", "")
        held = typing.get_type_hints(settings)
        fields = [f"    {one.name}: {PLAIN.get(held[one.name], 'Any')}" for one in dataclasses.fields(settings)]
        kinds.append("\n".join([f"class {kind}(How, total=False):", *(fields or ["    pass"])]))
        spellings = ", ".join(f'"{spelling}"' for spelling in dict.fromkeys([name, name.replace("-", "_")]))
        given = f"name: Literal[{spellings}], source: Source, **settings: Unpack[{kind}]"
        line = f"def study({given}) -> Answer: ..."
        line = line if len(line) <= WIDTH else f"def study(\n    {given}\n) -> Answer: ..."
        doors.append(f"@overload\n{line}")
    return "\n".join([HEAD, "\n\n".join(kinds), "", "\n".join(doors)]) + "\n"


if __name__ == "__main__":
    PAGE.write_text(page())
