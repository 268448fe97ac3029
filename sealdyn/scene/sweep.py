"""Sine sweep of the housing: a tone whose frequency runs from one to another, as vibration tests have it.

The displacement is `A sin(phase)`: the phase is the integral of the frequency, `A` follows the frequency so that either
the displacement or the acceleration keeps its amplitude, or up to a `crossover` the one and above it the other.  A kink
there would be a blow; the corner is rounded, and the amplitude at the crossover itself 4 % less.  It begins and ends
with a ramp that shows no step in its first four derivatives.
**Source** the quantities by which tests are specified: IEC 60068-2-6, sinusoidal vibration (sweep in octaves a minute,
crossover from displacement to acceleration); the rounded corner and the ramp are ours.
**Valid** amplitude of the acceleration: `A w^2`, without what the changing frequency adds, which is less by the share
of itself that the frequency changes in a radian.
"""

import math
from dataclasses import dataclass
from typing import Literal

from ..quantities import in_words
from ..units import Acceleration, Angle, AngularAcceleration, Displacement, Frequency, Listed, Tilt, Time
from . import Strict

# Ramps if none are given: so many periods of the frequency there, at most this share of the sweep.
RAMP_PERIODS, RAMP_SHARE = 10.0, 0.1
# How sharp the corner at the crossover is: A = d (1 + r^CORNER)^(-1/CORNER), r the square of the frequency over it.
CORNER = 16


@dataclass(frozen=True)
class Sweep(Strict):
    """What sweeps along the shaft axis and of tilt have in common; amplitudes in m or rad and their like per s^2."""

    frequency: Listed[Frequency]
    """From and to: two of them, upwards or downwards."""
    displacement: float | None = None
    """Amplitude that is kept (below `crossover`); or give `acceleration`."""
    acceleration: float | None = None
    """Amplitude that is kept (above `crossover`), in place of `displacement`."""
    crossover: Frequency | None = None
    """Below it the displacement keeps its amplitude, above it the acceleration; without it one does throughout."""
    start: Time = 0.0
    """When the sweep begins."""
    duration: Time | None = None
    """How long the sweep takes; or give `octaves_per_minute`."""
    octaves_per_minute: float | None = None
    """Rate of a logarithmic sweep, in place of `duration`."""
    spacing: Literal["logarithmic", "linear"] = "logarithmic"
    """Equal times for equal ratios of frequency, or for equal differences."""
    ramp: Time | None = None
    """In which the amplitude rises at the start of the sweep and falls at its end; without it ten periods of the
    frequency there, at most a tenth of the sweep."""


@dataclass(frozen=True)
class AxialSweep(Sweep):
    """Sine sweep of the housing along the shaft axis."""

    displacement: Displacement | None = None
    acceleration: Acceleration | None = None


@dataclass(frozen=True)
class AngularSweep(Sweep):
    """Sine sweep of the housing about a fixed axis at `direction` (rad) from the x axis."""

    displacement: Tilt | None = None
    acceleration: AngularAcceleration | None = None
    direction: Angle = 0.0
    """Of the axis about which the housing rocks, from the x axis."""


def sweep_errors(sweep: Sweep) -> list[tuple[str, str, str]]:
    """(key, found, expected) of what a sweep cannot be."""
    if len(sweep.frequency) != 2:
        return [("frequency", f"{len(sweep.frequency)} of them", "two, from and to")]
    found = []
    if sweep.frequency[0] == sweep.frequency[1]:
        same = f"{sweep.frequency[0]:g} Hz to {sweep.frequency[1]:g} Hz"
        found.append(("frequency", same, "two that differ; a tone is one of housing.axial or housing.angular"))
    if (sweep.displacement is None) == (sweep.acceleration is None):
        which = "neither" if sweep.displacement is None else "both"
        expected = "exactly one of displacement and acceleration; the other follows from crossover"
        found.append(("displacement", which, expected))
    for key in ("displacement", "acceleration"):
        if (getattr(sweep, key) or 0.0) < 0.0:
            found.append((key, f"{getattr(sweep, key):g}", "an amplitude >= 0"))
    if sweep.start < 0.0:
        found.append(("start", f"{sweep.start:g} s", "a time >= 0"))
    rate = sweep.octaves_per_minute
    if (sweep.duration is None) == (rate is None):
        which = "neither" if rate is None else "both"
        found.append(("duration", which, "exactly one of duration and octaves_per_minute"))
    elif rate is not None and sweep.spacing == "linear":
        found.append(("octaves_per_minute", f"{rate:g} of a linear sweep", "duration, or a logarithmic sweep"))
    elif rate is not None and not 0.0 < rate < math.inf:
        found.append(("octaves_per_minute", f"{rate:g}", "a number > 0; frequency tells whether up or down"))
    elif sweep.duration is not None and not sweep.duration > 0.0:
        found.append(("duration", f"{sweep.duration:g} s", "a time > 0"))
    if not found and sweep.ramp is not None and not 0.0 < sweep.ramp <= 0.5 * span(sweep):
        found.append(("ramp", f"{sweep.ramp:g} s", f"a time > 0, at most half of the sweep's {span(sweep):g} s"))
    return found


def tilts(sweep: Sweep) -> bool:
    """Whether a sweep tilts the housing, or moves it along the shaft axis."""
    return isinstance(sweep, AngularSweep)


def span(sweep: Sweep) -> float:
    """How long (s) a sweep takes."""
    if sweep.duration is not None:
        return sweep.duration
    return 60.0 * abs(octaves(sweep)) / sweep.octaves_per_minute


def end(sweep: Sweep) -> float:
    """When (s) a sweep ends."""
    return sweep.start + span(sweep)


def octaves(sweep: Sweep) -> float:
    """Octaves from the first to the last frequency, negative downwards."""
    return math.log2(sweep.frequency[1] / sweep.frequency[0])


def cycles_an_octave(sweep: Sweep) -> float:
    """Cycles while the frequency doubles, or halves, at the slow end of a sweep."""
    slow, fast = sorted(sweep.frequency)
    if sweep.spacing == "linear":
        # From slow to twice that, at the mean of both.
        return 1.5 * slow * slow * span(sweep) / (fast - slow)
    return slow * span(sweep) / (math.log(2.0) * abs(octaves(sweep)))


def ramps(sweep: Sweep) -> tuple[float, float]:
    """How long (s) the amplitude rises and falls."""
    if sweep.ramp is not None:
        return sweep.ramp, sweep.ramp
    rise, fall = (min(RAMP_PERIODS / f, RAMP_SHARE * span(sweep)) for f in sweep.frequency)
    return rise, fall


def frequency_at(sweep: Sweep, time: float) -> float:
    """Frequency (Hz) at a time (s) of a run, before the sweep its first and after it its last."""
    first, last = sweep.frequency
    share = min(max((time - sweep.start) / span(sweep), 0.0), 1.0)
    return first + (last - first) * share if sweep.spacing == "linear" else first * (last / first) ** share


def level(sweep: Sweep) -> tuple[float, float]:
    """Amplitude and crossover (rad/s) as kernels have them: of displacement below it (m or rad); where the acceleration
    is kept throughout the crossover is 0, and the amplitude that of acceleration; where the displacement is, it is
    infinite."""
    if sweep.crossover is None:
        return (sweep.displacement, math.inf) if sweep.acceleration is None else (sweep.acceleration, 0.0)
    crossover = 2 * math.pi * sweep.crossover
    return sweep.acceleration / crossover**2 if sweep.displacement is None else sweep.displacement, crossover


def amplitude_at(sweep: Sweep, frequency: float) -> float:
    """Amplitude (m or rad) of the displacement at a frequency (Hz), without the ramps."""
    size, crossover = level(sweep)
    if math.isinf(crossover):
        return size
    w = 2 * math.pi * frequency
    if crossover == 0.0:
        return size / w**2
    r = (w / crossover) ** 2
    # Neither overflows.
    return size * min(1.0, 1.0 / r) * (1.0 + min(r, 1.0 / r) ** CORNER) ** (-1.0 / CORNER)


def largest_amplitude(sweep: Sweep) -> float:
    """Largest amplitude (m or rad) of the displacement."""
    return max(amplitude_at(sweep, f) for f in sweep.frequency)


def remark(sweep: Sweep, duration: float) -> str:
    """A sentence of what a sweep is, and how far a run of `duration` (s) has it."""
    how, unit, per = ("angularly", "rad", "rad/s^2") if tilts(sweep) else ("axially", "m", "m/s^2")
    first, last = sweep.frequency
    minutes = span(sweep) / 60.0
    pace = f"{abs(octaves(sweep)) / minutes:.4g} octaves a minute"
    if sweep.spacing == "linear":
        pace = f"{abs(last - first) / span(sweep):.4g} Hz/s"
    size, crossover = level(sweep)
    if crossover == 0.0:
        kept = f"{size:.4g} {per}"
    elif math.isinf(crossover):
        kept = in_words(unit, size)
    else:
        corner = f"{crossover / (2 * math.pi):.4g} Hz"
        kept = f"{in_words(unit, size)} below {corner} and {size * crossover**2:.4g} {per} above"
    said = (
        f"housing swept {how}: {first:g} to {last:g} Hz at {pace}, {kept}, from {sweep.start:.4g} to {end(sweep):.4g} s"
    )
    slow = min(sweep.frequency)
    if cycles_an_octave(sweep) < 1.0:
        said += f"; too fast for a sine at {slow:g} Hz: {cycles_an_octave(sweep):.2g} cycles an octave there"
    if end(sweep) > duration * (1 + 1e-9):
        said += f"; the run ends at {frequency_at(sweep, duration):.4g} Hz"
    return said
