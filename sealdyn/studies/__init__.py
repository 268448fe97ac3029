"""Studies: one file per question, found by file name (hyphens on the command line, underscores in files); one of
several files is a folder, whose `__init__` it is.

What every study module offers (the contract):

`Settings`  frozen dataclass: the keys of `[study.NAME]` with their defaults and units (types of units.py), a docstring
            below each field; flags `--key value` on the command line override.
`INFO`      an `Info`.
`run(scenario, settings, tools) -> Answer`
            (answers.py): numbers with the keys of `study --json`, what was found in one sentence, tables, panels.
            `tools.map(function, points, what, keep)` evaluates a module-level function of one JSON-able point on all
            cores or on other machines, remembers finished points across interruptions, and returns a list of rows: the
            function's dict, or `{"failed": reason}`, behind what the point has of the names `keep`.  A row hangs on
            nothing but the function, what it is bound to (a scenario, a scene), and the point: whoever asks the same
            again may get it from a folder of results.
            `tools.alone()` does so one point after the other, here, for rows that measure time.
            `tools.say(fraction)` reports progress of anything else, `tools.tell(words)` says a line before a long wait.

The few charts that panels cannot draw stand in report/charts/study_NAME.py and draw from the study's archive only.
A study knows scenarios, models and solvers; it never opens a file or draws.
"""

import pkgutil
from collections.abc import Mapping
from dataclasses import dataclass, field

from ..extensions import folders, installed

_OWN = tuple(__path__)
__path__ = [*_OWN, *folders("studies")]


@dataclass(frozen=True)
class Info:
    """What a study declares of itself.

    `timed`: a scenario (and flags) with which the default settings take so much processor time (s) on one core.
    `asks`: the question it answers, the title of its figure.
    `seals`: "face", "radial" or "any".  `wavy`: it reckons with wavy faces, or does not ask how thin the film is; else
    it refuses them.  `grooved`: it reckons with grooves.  `aligned`: its numbers are of aligned faces, and say so where
    faces press with a moment there.  `refuses`: of "contact", "secondary-seal" and such a "moment" what it cannot
    reckon with; --without leaves the first two out.
    `warm`: what is said where rings take heat, of a temperature that does not follow what the study changes.
    `units` {key of the answer (joined by "/"), or its end, or "*" for all others: SI unit}, of elements with units of
    their own a list; what hangs on the scenario is in a table `units` of the answer.  `along` {table of the answer, or
    path of a column: names of what it lies along, in the order of its axes}: the dimensions in the archive.
    """

    timed: tuple[str, float]
    asks: str = ""
    seals: str = "face"
    wavy: bool = False
    grooved: bool = False
    aligned: bool = False
    warm: str = ""
    refuses: tuple[str, ...] = ()
    units: Mapping[str, str | list] = field(default_factory=dict)
    along: Mapping[str, tuple[str, ...]] = field(default_factory=dict)


def study_names() -> list[str]:
    """Names of the studies there are, those from outside too (extensions.py), hyphenated."""
    here = {name for name in _in_folders() if name[0] != "_"}
    return sorted(name.replace("_", "-") for name in here | set(installed("studies")))


def study_module(name: str) -> str:
    """Import path of a study called `name` (underscores)."""
    return f"{__name__}.{name}" if name in _in_folders() else installed("studies")[name]


def _in_folders() -> set[str]:
    """Names of the package's own files and of those on today's SEALDYN_PATH."""
    __path__[:] = [*_OWN, *folders("studies")]
    return {m.name for m in pkgutil.iter_modules(__path__)}
