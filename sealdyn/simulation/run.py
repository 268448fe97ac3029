"""One run asked for in Python: of a file, with other values, into an archive or memory; or a few of its numbers."""

from __future__ import annotations

import os
from collections.abc import Callable, Iterable, Mapping
from dataclasses import replace
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any

from ..answers import dotted
from ..scenario.errors import scene_errors_of
from ..scenario.reader import Scenario, scenario_of, with_values
from ..scene.radial import RadialScene
from ..status import Status
from .batch import MOMENT, refuse_outputs, run_many
from .result import Result, plain, unit_of
from .simulate import in_memory, simulate

# Tables of a summary that not every run has.
TABLES = ("heat", "contact", "secondary_seal", "leakage.conditions")
# Scene, keys and outputs of runs whose outputs are known to be there: what an optimiser asks again; at most so many.
_known: set[tuple] = set()
REMEMBERED = 64


class RunEnded(Exception):
    """A run that did not end well, of which numbers were asked; `status` and `message` as in a Result.

    >>> try:  # beyond the threshold of its stability
    ...     sealdyn.evaluate("fms.toml", {"shaft.speed": 9000, "run.turns": 60, "rotor.runout": 1e-4}, "h_min.value")
    ... except sealdyn.RunEnded as ended:
    ...     print(ended.status)
    collapsed
    """

    def __init__(self, name: str, status: str, message: str):
        super().__init__(name, status, message)
        self.name, self.status, self.message = name, status, message

    def __str__(self):
        return f"{self.name}: {self.status}: {self.message}"


def run(
    source: Scenario | str | os.PathLike,
    overrides: Mapping[str, Any] | Iterable[str] = (),
    out: str | os.PathLike | None = None,
    *,
    progress: Callable[[float, float], None] | None = None,
    stop: Callable[[], bool] | None = None,
    allow_large: bool = False,
) -> Result:
    """Run a scenario, or that of a TOML file or of an archive; without `out` nothing is left on disk.

    `overrides`: {dotted key: value}, or strings "key=value".  `out`: the archive to write.  `progress`, `stop`,
    `allow_large` as in `simulate`.  The result has `status`, `message`, `summary`, `data` (xarray) and `plot`; a run
    that fails is a result with its status.
    Raises ScenarioError for what cannot be run, ArchiveError for an archive that cannot be read or written.

    >>> result = sealdyn.run("fms.toml", {"rotor.runout": "20 urad"}, out="kept.h5")
    >>> result.archive.name, round(1e6 * result.summary["h_min"]["value"], 2)
    ('kept.h5', 9.36)
    """
    scenario = scenario_of(source, overrides)
    how = {"progress": progress, "stop": stop, "allow_large": allow_large}
    with scene_errors_of(scenario.name):
        if out is not None:
            return simulate(scenario, out, **how)
        with TemporaryDirectory() as folder:
            result = simulate(scenario, Path(folder) / "run.h5", **how)
            summary = {**result.summary, "archive": None}
            return replace(result, summary=summary, archive=None, content=result.archive.read_bytes())


def list_outputs(
    source: Scenario | str | os.PathLike, overrides: Mapping[str, Any] | Iterable[str] = ()
) -> dict[str, str]:
    """Dotted keys of the numbers and words that a run of this scenario has, as `outputs` of `evaluate`, `sweep` and
    `simulate_many`, each with its SI unit, "" without one; found by a moment of the run.
    Raises ScenarioError for what cannot be run.

    >>> sealdyn.list_outputs("fms.toml")["h_min.value"]
    'm'
    """
    scenario = scenario_of(source, overrides)
    with scene_errors_of(scenario.name):
        summary = plain(in_memory(with_values(scenario, {"run.duration": MOMENT}), lowest=False))
    found = dict(dotted(summary))
    if not isinstance(scenario.scene, RadialScene):
        # Only found where it is asked for.
        found["stability.critical_speed"] = None
    # Lists are no outputs, nor tables that this run does not have.
    there = {key: value for key, value in found.items() if not (isinstance(value, list) or key in TABLES)}
    return {key: "" if isinstance(value, str) or key.endswith("said") else unit_of(key) for key, value in there.items()}


def evaluate(
    source: Scenario | str | os.PathLike, values: Mapping[str, Any], outputs: Iterable[str] | str
) -> dict[str, Any]:
    """Numbers {output: value} (SI) of a run of the scenario with other `values` at dotted keys, without an archive and
    without a certificate: what an optimiser calls.

    `values` {key: SI number, or "5 um"}; `outputs` dotted keys of the summary, "h_min.value".  What a run does not have
    (the steady extremes of one that does not settle) is NaN.
    Raises ScenarioError for what cannot be run and, before it is, for an output that there is not, and RunEnded if the
    run did not end well, unless its "status" is among the outputs.

    >>> sealdyn.evaluate("fms.toml", {"film.clearance": "9 um"}, ["h_min.value", "status"])
    {'h_min.value': 8.2...e-06, 'status': 'ok'}
    """
    scenario, outputs = scenario_of(source), [outputs] if isinstance(outputs, str) else list(outputs)
    asked = repr(scenario.scene), tuple(values), tuple(outputs)
    if asked not in _known:
        refuse_outputs(scenario, [dict(values)], outputs, "outputs")
        if len(_known) >= REMEMBERED:
            _known.clear()
        _known.add(asked)
    (row,) = run_many(scenario, [{"set": dict(values), "outputs": outputs}])
    if isinstance(row, Exception):
        with scene_errors_of(scenario.name):
            raise row
    if row["status"] != Status.OK and "status" not in outputs:
        raise RunEnded(scenario.name, str(row["status"]), row["message"])
    return {output: float("nan") if row[output] is None else row[output] for output in outputs}
