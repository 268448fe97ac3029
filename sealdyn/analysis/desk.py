"""What the program's verbs beside `run` and `study` say, in Python: `sealdyn.check`, `design_rules`, `validate`,
`compare`, `review`.

A scenario is a Scenario, or the path of a TOML file or an archive, with `overrides` as of `sealdyn.run`."""

import os
from collections.abc import Iterable, Mapping
from pathlib import Path
from typing import Any

from ..report.comparison import comparison
from ..report.review import review as page_of
from ..scenario.errors import scene_errors_of
from ..scenario.reader import Scenario, read_scenario, scenario_of
from .check import checked, rules_of
from .sources import checks, source_names, sources_of_film

Source = Scenario | str | os.PathLike
Overrides = Mapping[str, Any] | Iterable[str]


def check(source: Source, overrides: Overrides = ()) -> dict[str, Any]:
    """What `sealdyn check --json` prints, SI: the `scene` resolved, `model`, `equilibria`, `warnings`, `design_rules`.
    **Raises** ScenarioError for what cannot be run.

    >>> str(sealdyn.check("fms.toml")["status"])
    'ok'
    """
    scenario = scenario_of(source, overrides)
    with scene_errors_of(scenario.name):
        return checked(scenario)


def design_rules(source: Source, overrides: Overrides = ()) -> list[dict[str, Any]]:
    """What the design rules find, broken ones first: `rule`, `verdict` ("fail", "note", "pass" ...), value, limit and
    source of each.  **Raises** ScenarioError for what cannot be run.

    >>> sealdyn.design_rules("fms.toml")[0]["verdict"]
    'fail'
    """
    scenario = scenario_of(source, overrides)
    with scene_errors_of(scenario.name):
        return rules_of(scenario)


def validate(source: str | None = None) -> list[dict[str, Any]]:
    """Published numbers beside computed ones, of one source ("zuk-1972") or of all, a row each with its `verdict`.
    **Raises** ValueError for no such source.

    >>> "FAILED" in {row["verdict"] for row in sealdyn.validate("green-1989")}
    False
    """
    names = source_names()
    wanted = names if source is None else [source.replace("_", "-")]
    if not set(wanted) <= set(names):
        raise ValueError(f'source: found "{source}"; expected one of {", ".join(names)}')
    return [row for rows in checks(wanted).values() for row in rows]


def compare(one: str | os.PathLike, other: str | os.PathLike) -> dict[str, Any]:
    """What the archives of two runs have different, as `sealdyn compare --json` prints it.  **Raises** ArchiveError.

    >>> files = [sealdyn.run("fms.toml", {"film.clearance": gap}, out=f"{gap}.h5").archive for gap in (8e-6, 9e-6)]
    >>> [row["key"] for row in sealdyn.compare(*files)["scene"]]
    ['film.clearance']
    """
    return comparison(one, other)


def review(archives: Iterable[str | os.PathLike], out: str | os.PathLike = "report.html", title: str = "") -> Path:
    """Write one page of the archives of runs and studies for a design review, and return its path.  **Raises**
    ArchiveError, and ScenarioError for a run whose scenario cannot be read again.

    >>> kept = sealdyn.run("fms.toml", out="kept.h5").archive
    >>> sealdyn.review([kept], "page.html").name
    'page.html'
    """
    return page_of(list(archives), out, title, lambda path, _: rules_of(read_scenario(path)), sources_of_film)
