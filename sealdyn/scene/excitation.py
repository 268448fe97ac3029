"""What is imposed on a scene: shaft speed and angle, misalignments, runout, whirl, vibration, tables.

Motion of a carrier comes by samples, measured or computed by a code of rotor dynamics, or as tones, sweeps and
band-limited random vibration.  The latter is a sum of tones.  The acceleration has a one-sided spectral density over
frequency, straight lines in a double logarithmic diagram as test standards draw it.  The band is cut into bins of equal
width, one tone each, anywhere in its bin: a tone has the power of its bin, whatever its frequency, so the mean square
over a long time is the integral of the density exactly, and the sum does not come back to its start as it would with
even spacing.
**Source** Shinozuka & Jan (1972), J. Sound Vib. 25(1), 111-128: sums of cosines with random phases and frequencies
jittered about those of even bins.
**Valid** over times in which the bins are told apart: below `1/(bin width)` the sum is a sample of the band, no more.
"""

import math
from dataclasses import dataclass, field
from functools import lru_cache
from itertools import pairwise
from random import Random

from ..units import (
    Acceleration,
    AccelerationDensity,
    Angle,
    AngularAcceleration,
    AngularAccelerationDensity,
    Displacement,
    Frequency,
    Listed,
    OneOrListed,
    Sample,
    Speed,
    Tilt,
    Varying,
)
from . import Strict
from .sweep import AngularSweep, AxialSweep, Sweep, remark

MOTION_COLUMNS = ("axial", "tilt_x", "tilt_y")
ACCELERATIONS = tuple(f"{name}_acceleration" for name in MOTION_COLUMNS)
# A spline of fifth degree has as many coefficients.
FEWEST_SAMPLES = 6
# Of the slowest motion that is no drift: its least periods in a record, and least samples of each.
LONGEST_DRIFT, DRIFT_SAMPLES = 2.0, 16
# Least share of the median distance of samples: a solver steps as if the motion were everywhere as fast as the nearest
# two of them can show, and a spline through two values at almost one time overshoots.
NEAREST_SAMPLES = 1e-3


@dataclass(frozen=True)
class Samples(Strict):
    """What tables of samples over time have in common."""

    file: str | None = field(default=None, compare=False)
    """CSV or HDF5 with these columns, beside the scenario; columns that are given here are not read from it."""
    titles: list[str] | None = field(default=None, compare=False)
    """Names of the columns of a CSV file that has no line of them, "time (ms)" and the like, "" for one not read."""
    time: Listed[Sample] = ()
    """Of the samples, increasing, from 0 or before to the end of the run or beyond."""


@dataclass(frozen=True)
class Motion(Samples):
    """Motion of the shaft under the rotor, or of the housing under the stator, given by samples, along the spline
    of fifth degree through them; it adds to runout, whirl and vibration."""

    axial: Listed[Displacement] | None = None
    """Displacement along the shaft axis; none without it."""
    tilt_x: Listed[Tilt] | None = None
    """Tilt about the x axis; none without it."""
    tilt_y: Listed[Tilt] | None = None
    """Tilt about the y axis; none without it."""
    axial_acceleration: Listed[Acceleration] | None = None
    """As measured, in place of `axial`: integrated twice, its drift removed (`drift_below`)."""
    tilt_x_acceleration: Listed[AngularAcceleration] | None = None
    """In place of `tilt_x`."""
    tilt_y_acceleration: Listed[AngularAcceleration] | None = None
    """In place of `tilt_y`."""
    drift_below: Frequency | None = None
    """Beside accelerations: what they have of offset, trend and motion slower than this is drift and goes.  A tone f
    keeps 1 - (drift_below/f)^4 of its displacement or more; within 1/drift_below of either end of the record it is off
    by up to half of drift_below/f."""

    def moves(self, name: str) -> bool:
        """Whether it has the motion of a name of MOTION_COLUMNS."""
        return any(getattr(self, name) or ()) or any(getattr(self, f"{name}_acceleration") or ())

    def columns(self) -> list[tuple[float, ...]]:
        """Axial displacement (m) and tilts (rad) at the times, zeros where none are given."""
        found = []
        for name, acceleration in zip(MOTION_COLUMNS, ACCELERATIONS, strict=True):
            given = getattr(self, name) or (0.0,) * len(self.time)
            if self.drift_below and (measured := getattr(self, acceleration)):
                given, _ = integrated(self.time, measured, self.drift_below)
            found.append(given)
        return found

    def remarks(self, key: str) -> list[str]:
        """A sentence for each acceleration of the motion at a dotted `key`: how it was integrated, and its drift."""
        found = []
        for name in ACCELERATIONS if self.drift_below else ():
            if measured := getattr(self, name):
                _, (offset, pace) = integrated(self.time, measured, self.drift_below)
                unit = "m/s^2" if name.startswith("axial") else "rad/s^2"
                found.append(
                    f"{key}.{name} integrated twice, without what is slower than {self.drift_below:g} Hz and a drift "
                    f"of {offset:.3g} {unit} {'+' if pace >= 0 else '-'} {abs(pace):.3g} {unit} per s"
                )
        return found


@lru_cache(maxsize=16)
def integrated(time, values, corner: float) -> tuple[tuple[float, ...], tuple[float, float]]:
    """The displacements of an acceleration, and its drift, as of numerics/twice_integrated.py."""
    from ..numerics.twice_integrated import twice_integrated

    moved, drift = twice_integrated(time, values, corner)
    return tuple(moved.tolist()), drift


def acceleration_errors(motion: Motion) -> list[tuple[str, str, str]]:
    """(key, found, expected) of what accelerations of a motion cannot be."""
    given, corner = [name for name in ACCELERATIONS if getattr(motion, name)], motion.drift_below
    for name in given:
        if getattr(motion, name.removesuffix("_acceleration")):
            return [(name, "both displacement and acceleration", "one of them")]
    if not given:
        return (
            [] if corner is None else [("drift_below", f"{corner:g} Hz", f"nothing, or {' or '.join(ACCELERATIONS)}")]
        )
    if corner is None:
        return [("drift_below", "nothing", "a frequency, below which what accelerations have is drift")]
    apart = max(after - before for before, after in pairwise(motion.time))
    least, most = LONGEST_DRIFT / (motion.time[-1] - motion.time[0]), 1.0 / (DRIFT_SAMPLES * apart)
    if not least <= corner <= most:
        expected = f"{least:.3g} to {most:.3g} Hz: {LONGEST_DRIFT:g} periods in the record, of {DRIFT_SAMPLES} samples"
        return [("drift_below", f"{corner:g} Hz", expected)]
    return []


def sample_errors(motion, names=MOTION_COLUMNS) -> list[tuple[str, str, str]]:
    """(key, found, expected) of what samples of a Motion, or others with columns of these `names`, cannot be."""
    times, columns = motion.time, f"{', '.join(names[:-1])} or {names[-1]}"
    if not times:
        return [("time", "nothing", f"a list of times and {columns}, or a file with such columns")]
    if len(times) < FEWEST_SAMPLES:
        return [("time", f"{len(times)} samples", f"at least {FEWEST_SAMPLES}")]
    if not any(getattr(motion, name) for name in names):
        return [(names[0], "times and nothing else", columns)]
    for name in names:
        column = getattr(motion, name)
        if column is not None and len(column) != len(times):
            return [(name, f"{len(column)} values for {len(times)} times", "one for each time")]
    for n, (before, after) in enumerate(pairwise(times)):
        if not after > before:
            return [("time", f"{after:g} s after {before:g} s, sample {n + 2}", "times that increase")]
    apart = [after - before for before, after in pairwise(times)]
    usual, least = sorted(apart)[len(apart) // 2], min(apart)
    if least < NEAREST_SAMPLES * usual:
        n = apart.index(least) + 1
        found = f"{least:g} s between samples {n} and {n + 1}, {usual:g} s between most"
        return [("time", found, "no two of them as near as that: leave one out, or give them evenly")]
    for name in names:
        # A slip of units, or no number at all.
        if not all(map(math.isfinite, getattr(motion, name) or ())):
            return [(name, "a value that is no finite number", "finite numbers")]
    if times[0] > 0.0:
        return [("time", f"a first sample at {times[0]:g} s", "samples from the start of the run, 0 s or before")]
    return []


# Each tone costs a sine and a cosine whenever the solver looks.
MOST_TONES = 5000


@dataclass(frozen=True)
class AxialRandom(Strict):
    """Random vibration of the housing along the shaft axis."""

    frequency: Listed[Frequency]
    """Corners of the spectrum, increasing, the first and last those of the band."""
    density: OneOrListed[AccelerationDensity]
    """One-sided power spectral density of the acceleration at each corner, log-log straight between; or one for all."""
    tones: int = 200
    """Number of tones of which it is made."""
    seed: int = 0
    """Of phases and frequencies: the same seed gives the same vibration."""


@dataclass(frozen=True)
class AngularRandom(Strict):
    """Random vibration of the housing about a fixed axis at `direction` (rad) from the x axis."""

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


@dataclass(frozen=True)
class Whirl(Strict):
    """Non-synchronous angular whirl of the shaft, `angle exp(i (ratio * shaft angle + phase))`, in rad."""

    ratio: float
    """Whirl speed over shaft speed; negative against the shaft."""
    angle: Tilt
    """Tilt of the shaft."""
    phase: Angle = 0.0
    """Of the tilt, at the start."""


@dataclass(frozen=True)
class Shaft(Strict):
    """The `[shaft]` table: speed (rad/s) and whirls."""

    speed: Varying[Speed]
    """Shaft speed; negative turns the other way."""
    whirl: list[Whirl] = field(default_factory=list)
    """Whirling motions of the shaft."""
    motion: Motion | None = None
    """Motion of the shaft under the rotor by samples."""


@dataclass(frozen=True)
class AxialVibration(Strict):
    """Axial vibration of the housing, cos(2 pi frequency t + phase), frequency in Hz, as displacement (m) or
    acceleration (m/s^2)."""

    frequency: Frequency
    """Of this tone."""
    displacement: Displacement | None = None
    """Amplitude; or give `acceleration`."""
    acceleration: Acceleration | None = None
    """Amplitude, in place of `displacement`."""
    phase: Angle = 0.0
    """Of the cosine, at the start."""


@dataclass(frozen=True)
class AngularVibration(Strict):
    """Angular vibration of the housing about a fixed axis at `direction` (rad) from the x axis, cos(2 pi frequency t +
    phase)."""

    frequency: Frequency
    """Of this tone."""
    displacement: Tilt | None = None
    """Amplitude; or give `acceleration`."""
    acceleration: AngularAcceleration | None = None
    """Amplitude, in place of `displacement`."""
    direction: Angle = 0.0
    """Of the axis about which the housing rocks, from the x axis."""
    phase: Angle = 0.0
    """Of the cosine, at the start."""


@dataclass(frozen=True)
class Housing(Strict):
    """The `[[housing.axial]]` and `[[housing.angular]]` tables, those of random vibration and of sweeps,
    `[housing.motion]`, and gravity."""

    axial: list[AxialVibration] = field(default_factory=list)
    """Tones along the shaft axis."""
    angular: list[AngularVibration] = field(default_factory=list)
    """Tones of tilt."""
    axial_random: list[AxialRandom] = field(default_factory=list)
    """Random vibrations along the shaft axis."""
    angular_random: list[AngularRandom] = field(default_factory=list)
    """Random vibrations of tilt."""
    axial_sweep: list[AxialSweep] = field(default_factory=list)
    """Sine sweeps along the shaft axis."""
    angular_sweep: list[AngularSweep] = field(default_factory=list)
    """Sine sweeps of tilt."""
    motion: Motion | None = None
    """Motion of the housing by samples."""
    gravity: Acceleration = 0.0
    """Across the shaft, so that of a horizontal one; of rings with a `mass_centre`."""
    gravity_direction: Angle = -0.5 * math.pi
    """Towards which it pulls, from the x axis."""

    @property
    def axial_tones(self) -> list[AxialVibration]:
        """All tones along the shaft axis, those of random vibration among them."""
        drawn = [tones_of(random, f"axial {n}") for n, random in enumerate(self.axial_random)]
        return [*self.axial, *(AxialVibration(f, acceleration=a, phase=p) for tones in drawn for f, a, p in tones)]

    @property
    def angular_tones(self) -> list[AngularVibration]:
        """All tones of tilt, those of random vibration among them."""
        found = list(self.angular)
        for n, random in enumerate(self.angular_random):
            found += [
                AngularVibration(f, acceleration=a, direction=random.direction, phase=p)
                for f, a, p in tones_of(random, f"angular {n}")
            ]
        return found

    @property
    def tones(self) -> list[AxialVibration | AngularVibration]:
        """All tones."""
        return [*self.axial_tones, *self.angular_tones]

    @property
    def sweeps(self) -> list[Sweep]:
        """All sweeps."""
        return [*self.axial_sweep, *self.angular_sweep]

    def remarks(self, duration: float) -> list[str]:
        """A sentence for each random vibration: how strong it is, over which band, of how many tones; and for each
        sweep, of which a run of `duration` (s) may have a part."""
        kinds = [("axially", "m/s^2", random) for random in self.axial_random]
        kinds += [("angularly", "rad/s^2", random) for random in self.angular_random]
        shaken = [
            f"housing shaken {how} at random: {mean_square(random) ** 0.5:.4g} {unit} rms from {random.frequency[0]:g} "
            f"to {random.frequency[-1]:g} Hz, {random.tones} tones, seed {random.seed}"
            for how, unit, random in kinds
        ]
        return shaken + [remark(sweep, duration) for sweep in self.sweeps]
