"""Motion of a carrier given by samples: measured, or computed by a code of rotor dynamics."""

import math
from dataclasses import dataclass, field
from itertools import pairwise

from ..units import Angle, Length, Listed, Time

COLUMNS = ("axial", "tilt_x", "tilt_y")
# A spline of fifth degree has as many coefficients.
FEWEST = 6
# Least share of the median distance of samples: a solver steps as if the motion were everywhere as fast as the nearest
# two of them can show, and a spline through two values at almost one time overshoots.
NEAREST = 1e-3


@dataclass(frozen=True)
class Motion:
    """Motion of the shaft under the rotor, or of the housing under the stator, given by samples, with a smooth curve
    through them; it adds to runout, whirl and vibration."""

    __pydantic_config__ = {"extra": "forbid"}  # noqa: RUF012

    file: str | None = field(default=None, compare=False)
    """CSV or HDF5 with these columns, beside the scenario; columns that are given here are not read from it."""
    time: Listed[Time] = ()
    """Of the samples, increasing, from 0 or before to the end of the run or beyond."""
    axial: Listed[Length] | None = None
    """Displacement along the shaft axis; none without it."""
    tilt_x: Listed[Angle] | None = None
    """Tilt about the x axis; none without it."""
    tilt_y: Listed[Angle] | None = None
    """Tilt about the y axis; none without it."""

    def columns(self) -> list[tuple[float, ...]]:
        """Axial displacement (m) and tilts (rad) at the times, zeros where none are given."""
        return [getattr(self, name) or (0.0,) * len(self.time) for name in COLUMNS]


def motion_errors(motion: Motion) -> list[tuple[str, str, str]]:
    """(key, found, expected) of what samples cannot be."""
    times = motion.time
    if not times:
        return [("time", "nothing", "a list of times and axial, tilt_x or tilt_y, or a file with such columns")]
    if len(times) < FEWEST:
        return [("time", f"{len(times)} samples", f"at least {FEWEST}")]
    if not any(getattr(motion, name) for name in COLUMNS):
        return [("axial", "times without a motion", "axial, tilt_x or tilt_y")]
    for name in COLUMNS:
        column = getattr(motion, name)
        if column is not None and len(column) != len(times):
            return [(name, f"{len(column)} values for {len(times)} times", "one for each time")]
    for n, (before, after) in enumerate(pairwise(times)):
        if not after > before:
            return [("time", f"{after:g} s after {before:g} s, sample {n + 2}", "times that increase")]
    apart = [after - before for before, after in pairwise(times)]
    usual, least = sorted(apart)[len(apart) // 2], min(apart)
    if least < NEAREST * usual:
        n = apart.index(least) + 1
        found = f"{least:g} s between samples {n} and {n + 1}, {usual:g} s between most"
        return [("time", found, "no two of them as near as that: leave one out, or give the motion evenly")]
    for name in COLUMNS:
        # A slip of units, or no number at all.
        if not all(map(math.isfinite, getattr(motion, name) or ())):
            return [(name, "a value that is no finite number", "finite numbers")]
    if times[0] > 0.0:
        return [("time", f"a first sample at {times[0]:g} s", "samples from the start of the run, 0 s or before")]
    return []
