"""The scenarios that come with the program (in a wheel inside the package, in a checkout beside it), and commented ones
to begin with, a file each."""

from __future__ import annotations

from importlib.resources import files
from itertools import takewhile
from pathlib import Path
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from ..reader import Scenario


def kinds() -> list[str]:
    """Names of the seals that there is one of."""
    return sorted(file.name.removesuffix(".toml") for file in files(__name__).iterdir() if file.name.endswith(".toml"))


def template(kind: str) -> str:
    """The text of one of them."""
    return (files(__name__) / f"{kind}.toml").read_text(encoding="utf-8")


PACKAGE = Path(__file__).parents[2]


def shipped_folder() -> Path:
    """Where they are."""
    inside = PACKAGE / "scenarios"
    return inside if inside.is_dir() else PACKAGE.parent / "scenarios"


def examples() -> dict[str, str]:
    """Name of each scenario that comes with the program, and the question at its head.

    >>> sealdyn.examples()["rub"]
    'What happens when the runout grows past contact onset?'
    """
    return {name: _question(path.read_text("utf-8")) for name, path in shipped_paths().items()}


def shipped_paths() -> dict[str, Path]:
    """Name and file of each; those of radial seals have a folder of their own."""
    return {path.stem: path for path in sorted(shipped_folder().rglob("*.toml"), key=lambda path: path.stem)}


def example(name: str) -> Scenario:
    """A scenario that comes with the program, by its name.  Raises ScenarioError, which names the nearest.

    >>> sealdyn.example("fms_reference").scene.shaft.speed
    1000.0
    """
    from ..errors import ScenarioError, nearest_of
    from ..reader import read_scenario

    names = shipped_paths()
    if name not in names:
        hint = nearest_of(name, names)
        raise ScenarioError(name, "", "no such scenario", f"a name of `sealdyn list`{hint}")
    return read_scenario(names[name])


def _question(text: str) -> str:
    """The comment at the head of a file as far as its first question mark."""
    lines = takewhile(lambda line: line.startswith("#"), text.splitlines())
    words, mark, _ = " ".join(line.lstrip("# ").rstrip() for line in lines).partition("?")
    return words + mark
