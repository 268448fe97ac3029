"""What a run leaves: how it ended, its archive, on disk or in memory, and its numbers by their dotted keys."""

from __future__ import annotations

import math
import platform
from collections.abc import Iterator
from contextlib import AbstractContextManager, contextmanager
from dataclasses import dataclass, field
from enum import StrEnum
from functools import cache, cached_property
from importlib.metadata import version
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import TYPE_CHECKING, Any

import numpy as np

from .. import __version__
from ..answers import dotted
from ..archive.files import mark_sound
from ..extensions import digest
from ..kernel_cache import solvers_digest
from ..scenario.errors import nearest_of
from ..scenario.tables import outside_of
from ..scene.radial import RadialScene

if TYPE_CHECKING:
    import xarray

    from ..report.in_python import Plot


@cache
def libraries() -> dict[str, str]:
    """Versions of what decides the numbers; looked up once, since each costs milliseconds."""
    names = ("numpy", "scipy", "scikit-sundae", "h5py", "numba")
    return {name: version(name) for name in names} | {"python": platform.python_version()}


def provenance(scenario) -> dict[str, Any]:
    """What every archive says of how it was made: versions, of the scenario name, question and overrides, and today's
    digests of the sources of what its scene has from outside, by "films/NAME"."""
    outside = {place: digest(*place.split("/")) for place, _ in outside_of(scenario.scene)}
    return {"version": __version__, "solvers": solvers_digest(), "libraries": libraries(), "name": scenario.name,
            "question": scenario.question, "overrides": list(scenario.overrides),
            **({"outside": outside} if outside else {})}  # fmt: skip


@dataclass(frozen=True, repr=False)
class Result:
    """What a run leaves: `status` (a value of Status), a sentence, the summary as a dict (as `run --json` prints it,
    SI), and the path of the archive, or None and its `content` where it was kept in memory only.

    >>> result = sealdyn.run("fms.toml")
    >>> result.status, float(result.data.h_min[0])
    ('ok', 9.2e-06)
    >>> result.plot.orbit().savefig("orbit.pdf")
    """

    status: str
    message: str
    summary: dict[str, Any] = field(repr=False)
    archive: Path | None
    content: bytes | None = field(default=None, repr=False)

    @cached_property
    def data(self) -> xarray.Dataset:
        """All of the archive as an `xarray.Dataset` in memory, as `open_archive` has it: series over `time` with units,
        fields over `field_time` and their grid."""
        from ..archive import open_archive

        with self._at_hand() as path, open_archive(path) as lazy:
            return lazy.load()

    @property
    def plot(self) -> Plot:
        """Its figures: `overview()`, `orbit()`, `film()`, `spectrum()`, `poincare()`."""
        from ..report.in_python import Plot

        return Plot(self._at_hand)

    def __repr__(self) -> str:
        from ..report.in_python import run_repr

        return run_repr(self.summary)

    def _repr_html_(self) -> str:
        from ..report.in_python import run_html

        return run_html(self.summary)

    def _at_hand(self) -> AbstractContextManager[Path]:
        return at_hand(self.archive, self.content)


@contextmanager
def at_hand(archive: Path | None, content: bytes | None) -> Iterator[Path]:
    """The path of an archive, of one that is in memory only (`content`) for as long as the block lasts."""
    if content is None:
        yield archive
        return
    with TemporaryDirectory() as folder:
        path = Path(folder) / "archive.h5"
        path.write_bytes(content)
        mark_sound(path)
        yield path


# What of the stability is found only where it is asked for.
SPEEDS = ("critical_speed", "thresholds", "resonance_speeds")
UNITS = {
    "h_min.value": "m", "h_min.time": "s", "h_min.theta": "rad", "h_min.radius": "m", "h_min.steady": "m",
    "relative_misalignment": "rad", "leakage.mean": "m^3/s", "leakage.max": "m^3/s", "leakage.mean_ml_per_h": "ml/h",
    "leakage.mean_kg_per_h": "kg/h", "leakage.conditions.temperature": "K", "leakage.conditions.pressure": "Pa",
    "friction.torque": "N m", "friction.power": "W", "friction.max_power": "W", "friction.temperature_rise": "K",
    "film.clearance": "m", "film.leakage": "m^3/s", "film.friction_power": "W", "film.axial_stiffness": "N/m",
    "film.tilt_stiffness": "N m/rad", "film.axial_damping": "N s/m", "film.tilt_damping": "N m s/rad",
    "film.cross_stiffness": "N m/rad", "closing.force": "N", "closing.spring_force": "N", "closing.duty": "Pa",
    "closing.face_area": "m^2", "contact.gap_error": "m", "contact.touch_at": "m", "contact.first": "s",
    "contact.lowest": "m", "contact.depth": "m", "contact.longest": "s", "contact.impulse": "N s",
    "contact.force": "N", "contact.torque": "N m", "contact.max_pressure": "Pa", "contact.wear_rate": "m/s",
    "contact.first_lift": "s", "contact.energy_lost": "J", "stability.critical_speed": "rad/s",
    "stability.fastest": "rad/s", "speed": "rad/s",
    "stability.growth_rate": "1/s", "stability.growth_rate_uncertainty": "1/s", "stability.speed": "rad/s",
    "stability.stator_speed": "rad/s", "closed_form.relative_max": "rad", "closed_form.relative_min": "rad",
    "closed_form.axial_closing": "m", "closed_form.formula_max": "rad", "closed_form.formula_min": "rad",
    "closed_form.speed": "rad/s", "closed_form.needed_preload": "N", "closed_form.largest_eccentricity": "m",
    "end.time": "s", "end.asked": "s", "follower.mass": "kg", "follower.stiffness": "N/m", "follower.damping": "N s/m",
    "follower.preload": "N", "follower.friction": "N", "follower.arc": "m",
}  # fmt: skip
# Of the whole run of a radial seal, and of its second half.
UNITS |= {
    f"{part}.{name}": unit
    for part in ("whole", "settled")
    for name, unit in {
        "largest_gap": "m", "largest_gap_time": "s", "largest_gap_angle": "rad", "least_load": "N",
        "least_load_time": "s", "largest_load": "N", "load": "N", "friction_torque": "N m",
        "leakage_estimate": "m^3/s",
    }.items()
}  # fmt: skip

# What is chosen for a run, and can differ from one to another, with the key that says it beforehand.
START = "model.start"
CHOICES = {START: "run.start", "model.film": "film.model", "model.solver": "run.solver"}
# What every summary of a face seal has.
COMMON = (
    "h_min.value",
    "h_min.steady",
    "h_min.of_clearance",
    "film.clearance",
    "relative_misalignment.max",
    "relative_misalignment.steady_max",
    "leakage.mean",
    "friction.power",
    "contact_margin",
    "stability.verdict",
    START,
)
# What every summary of a radial seal has.
RADIAL = (
    "settled.contact_share",
    "whole.largest_gap",
    "whole.least_load",
    "settled.friction_torque",
    "settled.leakage_estimate",
    "closed_form.margin",
)


def with_choices(scene, outputs) -> list[str]:
    """Outputs, and what is chosen for a run of a seal of this kind."""
    choices = ("model.solver",) if isinstance(scene, RadialScene) else CHOICES
    return list(dict.fromkeys([*outputs, *choices]))


def without_equal_choices(rows: list[dict], outputs, asked, keys) -> list[str]:
    """Of the outputs of the rows those `asked` for, and what was chosen differently, other than by the `keys` that say
    it: no comparison is told without it."""
    chosen = {name: {row[name] for row in rows if name in row} for name in CHOICES if CHOICES[name] not in keys}
    return [name for name in outputs if name in asked or len(chosen.get(name, ())) > 1]


def common_outputs(scene) -> tuple[str, ...]:
    """What every summary of a seal of this kind has."""
    return RADIAL if isinstance(scene, RadialScene) else COMMON


def output(parts: dict, key: str):
    """The value at a dotted key of a summary, or of its `parts` (summary.py).  Raises ValueError, which names the
    nearest key there is."""
    place = parts
    for name in key.split("."):
        place = place() if callable(place) else place
        if not isinstance(place, dict) or name not in place:
            known = [*dict(dotted(plain(parts))), *(f"stability.{speeds}" for speeds in SPEEDS)]
            raise ValueError(f"the run's summary has no {key}{nearest_of(key, known, 0.3)}")
        place = place[name]
    place = plain(place)
    if isinstance(place, dict):
        raise ValueError(f"{key} holds several numbers: one of {', '.join(f'{key}.{k}' for k in place)}")
    return place


def missing_outputs(parts: dict, keys) -> dict[str, str]:
    """The dotted keys that a summary, or its `parts` (summary.py), has no value of, each with the sentence why."""
    found = {}
    for key in keys:
        try:
            output(parts, key)
        except ValueError as error:
            found[key] = str(error)
    return found


def asks_speeds(keys) -> bool:
    """Whether one of the keys asks for critical or resonance speeds."""
    return any(name in key for key in keys for name in SPEEDS)


def unit_of(key: str) -> str:
    """SI unit of the value at a dotted key, or of all below the one above it; empty without one."""
    return UNITS.get(key) or UNITS.get(key.rpartition(".")[0]) or ""


def plain(value):
    """JSON-ready: what a function finds, numpy scalars as Python's, words of an enumeration as words, NaN and infinity
    as null."""
    if callable(value):
        value = value()
    if isinstance(value, dict):
        return {key: plain(item) for key, item in value.items()}
    if isinstance(value, list | tuple):
        return [plain(item) for item in value]
    if isinstance(value, np.generic):
        value = value.item()
    if isinstance(value, StrEnum):
        return str(value)
    if isinstance(value, float) and not math.isfinite(value):
        return None
    return value
