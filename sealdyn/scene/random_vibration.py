"""Band-limited random vibration of the housing, as a sum of tones.

The acceleration has a one-sided spectral density over frequency, straight lines in a double logarithmic diagram as test
standards draw it.  The band is cut into bins of equal width, one tone each, anywhere in its bin: a tone has the power
of its bin, whatever its frequency, so the mean square over a long time is the integral of the density exactly, and the
sum does not come back to its start as it would with even spacing.
**Source** Shinozuka & Jan (1972), J. Sound Vib. 25(1), 111-128: sums of cosines with random phases and frequencies
jittered about those of even bins.
**Valid** over times in which the bins are told apart: below `1/(bin width)` the sum is a sample of the band, no more.
"""

import math
from dataclasses import dataclass
from functools import lru_cache
from itertools import pairwise
from random import Random

from ..units import AccelerationDensity, Angle, AngularAccelerationDensity, Frequency, Listed, OneOrListed

# Each tone costs a sine and a cosine whenever the solver looks.
MOST_TONES = 5000


@dataclass(frozen=True)
class AxialRandom:
    """Random vibration of the housing along the shaft axis."""

    __pydantic_config__ = {"extra": "forbid"}  # noqa: RUF012

    frequency: Listed[Frequency]
    """Corners of the spectrum, increasing, the first and last those of the band."""
    density: OneOrListed[AccelerationDensity]
    """One-sided power spectral density of the acceleration at each corner, log-log straight between; or one for all."""
    tones: int = 200
    """Number of tones of which it is made."""
    seed: int = 0
    """Of phases and frequencies: the same seed gives the same vibration."""


@dataclass(frozen=True)
class AngularRandom:
    """Random vibration of the housing about a fixed axis at `direction` (rad) from the x axis."""

    __pydantic_config__ = {"extra": "forbid"}  # noqa: RUF012

    frequency: Listed[Frequency]
    """Corners of the spectrum, increasing, the first and last those of the band."""
    density: OneOrListed[AngularAccelerationDensity]
    """One-sided power spectral density of the acceleration at each corner, log-log straight between; or one for all."""
    direction: Angle = 0.0
    """Of the axis about which the housing rocks, from the x axis."""
    tones: int = 200
    """Number of tones of which it is made."""
    seed: int = 0
    """Of phases and frequencies: the same seed gives the same vibration."""


def random_errors(vibration: AxialRandom | AngularRandom) -> list[tuple[str, str, str]]:
    """(key, found, expected) of what a random vibration cannot be."""
    corners, density = vibration.frequency, vibration.density
    found = []
    if len(corners) < 2:
        found.append(("frequency", f"{len(corners)} of them", "the lowest and the highest frequency, or more corners"))
    for low, high in pairwise(corners):
        if not high > low:
            found.append(("frequency", f"{high:g} Hz after {low:g} Hz", "frequencies that increase"))
    if isinstance(density, tuple) and len(density) != len(corners):
        found.append(("density", f"{len(density)} for {len(corners)} frequencies", "one for each, or one for all"))
    if not 1 <= vibration.tones <= MOST_TONES:
        found.append(("tones", f"{vibration.tones}", f"1 to {MOST_TONES}"))
    if vibration.seed < 0:
        found.append(("seed", f"{vibration.seed}", "a whole number >= 0"))
    return found


def mean_square(vibration: AxialRandom | AngularRandom, low: float | None = None, high: float | None = None) -> float:
    """Integral of the density from `low` to `high` (Hz), without them over the whole band: the mean square of the
    acceleration, (m/s^2)^2 or (rad/s^2)^2."""
    low = vibration.frequency[0] if low is None else low
    high = vibration.frequency[-1] if high is None else high
    total = 0.0
    for (f0, f1), (s0, s1) in zip(pairwise(vibration.frequency), pairwise(_densities(vibration)), strict=True):
        begin, end = max(low, f0), min(high, f1)
        if end > begin:
            # Of s0 (f/f0)^slope, without the cancellation at a slope of -1.
            slope = math.log(s1 / s0) / math.log(f1 / f0)
            power, octaves = (slope + 1.0), math.log(end / begin)
            grown = math.expm1(power * octaves) / power if power else octaves
            total += s0 * (begin / f0) ** slope * begin * grown
    return total


@lru_cache(maxsize=64)
def tones_of(vibration: AxialRandom | AngularRandom, place: str) -> tuple[tuple[float, float, float], ...]:
    """The tones, (frequency (Hz), amplitude of the acceleration, phase (rad)) each.  `place`: which of the housing's
    random vibrations it is; two with the same numbers and seed are still independent."""
    drawn = Random(f"{place} {vibration.seed}")
    low, high = vibration.frequency[0], vibration.frequency[-1]
    edges = [low + (high - low) * n / vibration.tones for n in range(vibration.tones)] + [high]
    found = []
    for begin, end in pairwise(edges):
        frequency, phase = begin + (end - begin) * drawn.random(), 2 * math.pi * drawn.random()
        found.append((frequency, math.sqrt(2.0 * mean_square(vibration, begin, end)), phase))
    return tuple(found)


def _densities(vibration) -> tuple[float, ...]:
    """The density at each corner."""
    density = vibration.density
    return density if isinstance(density, tuple) else (density,) * len(vibration.frequency)
