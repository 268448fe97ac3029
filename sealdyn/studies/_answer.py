"""A study asked for in Python: its answer in memory, with or without an archive."""

from __future__ import annotations

import os
from collections.abc import Callable, Iterable
from dataclasses import dataclass, field
from functools import cached_property
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import TYPE_CHECKING, Any

from ..archive import answer_as_dataset
from ..scenario.errors import ScenarioError, nearest_of, scene_errors_of
from ..scenario.overrides import without_arrays
from ..scenario.reader import Scenario, scenario_of
from ..simulation.result import at_hand
from . import study_names
from ._runner import run_study, study_info

if TYPE_CHECKING:
    import xarray

    from ..report.charts.page import Figure


@dataclass(frozen=True)
class Answer:
    """What a study leaves: its name, `status` (a value of Status), a sentence, the `verdict` in sentences, the `answer`
    as a dict (as `study --json` prints it, SI), and the path of the archive, or None and its `content` where it was
    kept in memory only.

    >>> answer = sealdyn.study("equilibrium", "fms.toml", points=11)
    >>> answer.verdict[0]
    'The seal rides at 10 um: the film carries the closing force there, stably.'
    >>> answer.data.coords["curve.clearance"].attrs["units"]
    'm'
    >>> answer.plot().savefig("equilibrium.svg")
    """

    study: str
    status: str
    message: str
    verdict: list[str]
    answer: dict[str, Any] = field(repr=False)
    archive: Path | None
    content: bytes | None = field(default=None, repr=False)

    @cached_property
    def data(self) -> xarray.Dataset:
        """Its numbers as an `xarray.Dataset` with units.  Of a study over keys the dimensions are the keys, the
        variables its outputs and the `status` and `message` of each point; of others every list of numbers of the
        answer, "curve.h_min", along the columns that its study names."""
        info = study_info(self.study)
        return answer_as_dataset(self.answer, info.units, info.along)

    def plot(self) -> Figure:
        """Its figure, of matplotlib; `figure.savefig("map.svg")` writes it."""
        from ..report.panels import draw

        with at_hand(self.archive, self.content) as path:
            return draw(path)


def study(
    name: str,
    source: Scenario | str | os.PathLike,
    *,
    out: str | os.PathLike | None = None,
    workers: int | None = None,
    scheduler: Any = None,
    results: str | os.PathLike | None = None,
    progress: Callable[[float, float, str], None] | None = None,
    without: Iterable[str] = (),
    **settings: Any,
) -> Answer:
    """Answer a question about a scenario, or that of a TOML file or an archive: `sealdyn.study("sweep", scenario,
    vary="rotor.runout=0:1 mrad:21")`.  Without `out` nothing is left on disk.

    `name` with hyphens or underscores; `settings` those of `[study.NAME]`; `without` "contact" or "secondary-seal";
    the others as in `run_study`.
    Raises ScenarioError for what cannot be studied, ClusterError, ArchiveError.

    >>> answer = sealdyn.study("sweep", "fms.toml", vary="rotor.runout=10,20 urad", outputs="h_min.value")
    >>> 1e6 * answer.data["h_min.value"].values.round(8)
    array([9.68, 9.36])
    """
    scenario, name = scenario_of(source), name.replace("_", "-")
    names = study_names()
    if name not in names:
        hint = nearest_of(name, names)
        raise ScenarioError(scenario.name, "study", f'"{name}"', f"one of {', '.join(names)}{hint}")
    how = {"workers": workers, "scheduler": scheduler, "results": results, "progress": progress}
    how |= {"leave_out": [without] if isinstance(without, str) else list(without), "flags": without_arrays(settings)}
    with scene_errors_of(scenario.name):
        if out is not None:
            answer = run_study(name, scenario, out, **how)
            return _answer(answer, Path(answer["archive"]))
        with TemporaryDirectory() as folder:
            answer = run_study(name, scenario, Path(folder) / "study.h5", **how)
            return _answer({**answer, "archive": None}, None, Path(answer["archive"]).read_bytes())


def _answer(answer: dict, archive: Path | None, content: bytes | None = None) -> Answer:
    told = {"status": str(answer["status"]), "message": answer["message"], "verdict": answer["verdict"]}
    return Answer(answer["study"], **told, answer=answer, archive=archive, content=content)
