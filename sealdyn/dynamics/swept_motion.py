"""Sine sweeps of the housing in the solver's inner loop: rows of a block, looked up by compiled kernels.

`x = A E sin(phase)`: amplitude A over the frequency, ramps E over time.  All three have their derivatives in closed
form, so that displacement, velocity and acceleration are those of one motion; the phase at the start of a row is
reduced modulo one turn in 60 digits, however many turns went before.

Block layout: number of rows, then rows of SWEEP_ROW: its share of axial motion (1 or 0) and of both tilts (cos and sin
of its direction, or 0), segment time at which the row's own clock begins (s), what has gone of the sweep by then and
what is left of it (s), phase (rad), frequency (rad/s) and its pace then, whether that is logarithmic (1/s) or linear
(rad/s^2), amplitude and crossover (`level` of scene/sweep.py), ramps (s).
"""

import math
from dataclasses import dataclass
from decimal import Decimal
from fractions import Fraction
from functools import lru_cache
from itertools import pairwise

import numpy as np

from ..numerics.kernel import inner_kernel
from ..scene.excitation import Motion
from ..scene.forces import LoadSamples, samples_of_loads
from ..scene.rings import RING_NAMES
from ..scene.scene import SceneError
from ..scene.sweep import CORNER, end, level, ramps, span, tilts
from .intervals import TURN, Interval

# --- Motion by samples ---------------------------------------------------------------------------------

# Motion of a carrier given by samples: a spline of fifth degree through them, looked up by compiled kernels.
#
# Its fourth derivative is continuous, so that neither the acceleration of the carrier nor a solver of high order
# meets a kink at a sample, and no run starts anew there; and it bounds how far a step's cubic misses the motion.
# Between samples of a tone the spline is off by the sixth power of their spacing. **Source** de Boor (2001), A
# Practical Guide to Splines, ch. XIII: interpolation with the not-a-knot condition.
#
# Block layout: number of pieces, their ends in segment time (pieces + 1), then for each piece the coefficients of
# axial motion and both tilts, highest power first.

# Coefficients of a piece: of each of three motions.
TERMS = 6
# Samples of a period below which a motion is not resolved, and the share of the power of its rate there that is told.
PER_PERIOD, COARSE = 4, 0.01


@dataclass(frozen=True, eq=False)
class Sampled:
    """The spline of a Motion: ends (n + 1,) of its pieces (s), coefficients (n, 3, TERMS) in the time since a piece's
    start, `pace` (rad/s) of the fastest motion that the samples resolve, `rate` (rad/s) of the motion itself where it
    is fastest: largest acceleration over largest rate; `coarse`, the share of the power of the rate beyond `pace`."""

    ends: np.ndarray
    coefficients: np.ndarray
    pace: float
    rate: float
    coarse: float

    def block(self, begin: float, length: float) -> np.ndarray:
        """What kernels look up over a stretch of time from `begin` (s), in its own time."""
        first, last = self._pieces(begin, length)
        ends = self.ends[first : last + 1] - begin
        return np.concatenate([[last - first], ends, self.coefficients[first:last].ravel()])

    def reach(self, begin: float, length: float) -> tuple[np.ndarray, np.ndarray]:
        """Bounds over a stretch of time: of axial displacement (m) and tilt (rad), and of their fourth derivatives (per
        s^4), (2,) each.  A polynomial lies in the hull of its Bernstein coefficients."""
        first, last = self._pieces(begin, length)
        c, h = self.coefficients[first:last], np.diff(self.ends[first : last + 1])[:, None]
        rising = c[:, :, ::-1] * h[:, :, None] ** np.arange(TERMS)
        hull = np.abs(np.einsum("ij,nkj->nki", BERNSTEIN, rising)).max(axis=(0, 2))
        # Of fifth degree: the fourth derivative is linear in a piece.
        fourth = np.maximum(np.abs(24.0 * c[:, :, 1]), np.abs(24.0 * c[:, :, 1] + 120.0 * c[:, :, 0] * h)).max(axis=0)
        return tuple(np.array([part[0], math.hypot(part[1], part[2])]) for part in (hull, fourth))

    def _pieces(self, begin: float, length: float) -> tuple[int, int]:
        """First piece of a stretch of time, and the one after its last."""
        count = len(self.coefficients)
        first, last = np.searchsorted(self.ends, [begin, begin + length])
        first = min(max(int(first) - 1, 0), count - 1)
        return first, min(max(int(last), first + 1), count)


# Bernstein coefficients of degree five from powers: entry i of power j is C(i, j) / C(5, j).
BERNSTEIN = np.array([[math.comb(i, j) / math.comb(5, j) for j in range(TERMS)] for i in range(TERMS)])


def sampled(motion: Motion | LoadSamples | Sampled) -> Sampled:
    """The spline through the samples of a motion, or of forces (N, N m in place of m, rad); from outside one comes as
    the spline that it is."""
    return motion if isinstance(motion, Sampled) else _spline(motion)


@lru_cache(maxsize=8)
def _spline(motion: Motion | LoadSamples) -> Sampled:
    # Loaded only where samples are imposed.
    from scipy.interpolate import PPoly, make_interp_spline

    time, columns = np.array(motion.time), np.array(motion.columns()).T
    splines = [make_interp_spline(time, column, k=5) for column in columns.T]
    pieces = [PPoly.from_spline(spline) for spline in splines]
    # Pieces of no length stand before the first and after the last sample.
    kept = np.diff(pieces[0].x) > 0.0
    ends = np.append(pieces[0].x[:-1][kept], time[-1])
    c = np.ascontiguousarray(np.array([piece.c[:, kept] for piece in pieces]).transpose(2, 0, 1))
    rates, accelerations = ([float(np.abs(s.derivative(n)(time)).max()) for s in splines] for n in (1, 2))
    fastest = max((a / r for a, r in zip(accelerations, rates, strict=True) if r > 0.0), default=0.0)
    shortest = float(np.diff(time).min())
    return Sampled(ends, c, 2 * math.pi / (PER_PERIOD * shortest), fastest, _coarse(time, columns))


def motions(scene) -> dict[int, Sampled]:
    """The splines of a scene by the ring whose carrier they move, 0 stator, 1 rotor."""
    given = {0: scene.housing.motion, 1: scene.shaft.motion}
    return {k: sampled(motion) for k, motion in given.items() if motion is not None}


def loads(scene) -> dict[int, Sampled]:
    """The splines of the forces on the rings of a scene, 0 stator, 1 rotor."""
    return {ring: sampled(samples) for ring, samples in samples_of_loads(scene).items()}


def records(scene) -> dict[str, Motion | LoadSamples]:
    """All samples of a scene that act, by their dotted keys."""
    forces = {f"{RING_NAMES[ring]}.load.samples": samples for ring, samples in samples_of_loads(scene).items()}
    moved = {"housing.motion": scene.housing.motion, "shaft.motion": scene.shaft.motion}
    return {key: motion for key, motion in moved.items() if motion is not None} | forces


def splines(scene) -> dict[str, Sampled]:
    """Their splines."""
    return {key: sampled(record) for key, record in records(scene).items()}


def check_covers(scene, duration: float) -> None:
    """Raises SceneError where samples end before a run of `duration` (s) does."""
    for key, record in records(scene).items():
        if record.time[-1] < duration * (1 - 1e-9):
            found = f"samples until {record.time[-1]:g} s, a run of {duration:g} s"
            raise SceneError(f"{key}.time", found, "samples to the end of the run, or a shorter run")


def _coarse(time, columns) -> float:
    """Share of the power of the rate at more than a PER_PERIODth of the samples' frequency, of the worst column."""
    window = np.hanning(len(time))[:, None]
    # Its mean and its trend are no fast motion.
    moved = columns - np.linspace(0.0, 1.0, len(time))[:, None] * (columns[-1] - columns[0]) - columns[0]
    power = np.abs(np.fft.rfft(window * (moved - moved.mean(axis=0)), axis=0)) ** 2
    frequency = np.fft.rfftfreq(len(time))[:, None]
    rate = power * frequency**2
    total = rate.sum(axis=0)
    fast = (rate * (frequency > 1.0 / PER_PERIOD)).sum(axis=0)
    return float(max((f / t for f, t in zip(fast, total, strict=True) if t > 0.0), default=0.0))


@inner_kernel()
def piece_at(tau, p, at):
    """Which piece of the block that begins at `at` in `p` holds segment time tau (s); beyond the ends the nearest."""
    low, high = 0, int(p[at])
    while high - low > 1:
        middle = (low + high) // 2
        if p[at + 1 + middle] <= tau:
            low = middle
        else:
            high = middle
    return low


@inner_kernel()
def motion_at(tau, p, at, piece, part):
    """Motion `part` (0 axial, 1 and 2 tilts) at segment time tau (s) in a `piece` of the block: value, rate and
    acceleration (m, rad)."""
    first = at + 2 + int(p[at]) + TERMS * (3 * piece + part)
    x = tau - p[at + 1 + piece]
    value, rate, half = 0.0, 0.0, 0.0
    for j in range(TERMS):
        half = half * x + rate
        rate = rate * x + value
        value = value * x + p[first + j]
    return value, rate, 2.0 * half


(AXIAL_SHARE, COS, SIN, BEGIN, GONE, LEFT, PHASE, FREQUENCY, PACE, LOGARITHMIC, AMPLITUDE, CROSSOVER, RISE,
 FALL, SWEEP_ROW) = range(15)  # fmt: skip
# Parts of an octave in each of which a sweep is bounded by its largest frequency, amplitude and pace.
PARTS_PER_OCTAVE = 8
# Largest derivatives of the ramp over its share of time, zeroth to fourth; and what those of the logarithm of the
# amplitude by that of the frequency are at most.
RAMP_SLOPES = (1.0, 630.0 / 256.0, 9.372, 78.76, 622.6)
CORNER_SLOPES = (2.0, CORNER, 0.77 * CORNER**2, 2.0 * CORNER**3)


def sweeps_of(scene) -> list[tuple[str, object]]:
    """All sweeps of a scene that move anything, with their dotted keys."""
    kinds = {"axial_sweep": scene.housing.axial_sweep, "angular_sweep": scene.housing.angular_sweep}
    found = [(f"housing.{kind}.{n}", sweep) for kind, sweeps in kinds.items() for n, sweep in enumerate(sweeps)]
    return [(key, sweep) for key, sweep in found if level(sweep)[0]]


def sweep_breaks(scene) -> list[float]:
    """Times (s) at which a sweep begins or ends; between them it has no kink."""
    return [t for _, sweep in sweeps_of(scene) for t in (sweep.start, end(sweep))]


def check_begins(scene, duration: float) -> None:
    """Raises SceneError for a sweep that begins after a run of `duration` (s) ends."""
    for key, sweep in sweeps_of(scene):
        if sweep.start >= duration:
            found = f"{sweep.start:g} s, a run of {duration:g} s"
            raise SceneError(f"{key}.start", found, "a start within the run, or a longer run")


def sweeps_of_segment(scene, interval: Interval) -> np.ndarray:
    """Rows (n, SWEEP_ROW) of the sweeps that move the housing in an interval."""
    rows = []
    for _, sweep in sweeps_of(scene):
        begin, last = Fraction(sweep.start), Fraction(end(sweep))
        base = max(begin, interval.start)
        if base >= min(last, interval.start + interval.span):
            continue
        shape = (0.0, math.cos(sweep.direction), math.sin(sweep.direction)) if tilts(sweep) else (1.0, 0.0, 0.0)
        times = float(base - interval.start), float(base - begin), float(last - base)
        clock = (*_clock(sweep, base - begin), sweep.spacing == "logarithmic")
        rows.append([*shape, *times, *clock, *level(sweep), *ramps(sweep)])
    return np.array(rows, dtype=np.float64).reshape(-1, SWEEP_ROW)


def _clock(sweep, gone: Fraction) -> tuple[float, float, float]:
    """Phase (rad, modulo one turn), frequency (rad/s) and pace a time `gone` (s) after a sweep's start."""
    first, last, length = map(Decimal, (*sweep.frequency, span(sweep)))
    past = Decimal(gone.numerator) / Decimal(gone.denominator)
    if sweep.spacing == "linear":
        pace = (last - first) / length
        cycles, frequency, pace = past * (first + pace * past / 2), first + pace * past, TURN * pace
    else:
        pace = (last / first).ln() / length
        frequency = first * (pace * past).exp()
        cycles = (frequency - first) / pace
    return float(cycles % 1 * TURN), float(frequency * TURN), float(pace)


def fastest_sweep(rows: np.ndarray, length: float) -> float:
    """Highest frequency (rad/s) of the rows over a segment of `length` (s)."""
    return max((w for row in rows for w in _ends(row, length)), default=0.0)


def _ends(row, length: float) -> tuple[float, float]:
    """Frequency (rad/s) of a row where it begins and where it, or its segment, ends."""
    s = min(length - row[BEGIN], row[LEFT])
    last = row[FREQUENCY] * math.exp(row[PACE] * s) if row[LOGARITHMIC] else row[FREQUENCY] + row[PACE] * s
    return row[FREQUENCY], last


def largest_sweep(rows: np.ndarray, length: float) -> tuple[np.ndarray, np.ndarray]:
    """Bounds over a segment of `length` (s): of axial displacement (m) and tilt (rad), and of their fourth derivatives
    (per s^4), (2,) each.  The frequencies are cut into parts; in each the Taylor coefficients of amplitude, ramp and
    phasor are bounded by what they are at most there, and those of their product by the product of the bounds."""
    reach, fourth = np.zeros(2), np.zeros(2)
    for row in rows:
        low, high = sorted(_ends(row, length))
        count = max(1, math.ceil(PARTS_PER_OCTAVE * math.log2(high / low)))
        edges, part = np.geomspace(low, high, count + 1), int(row[AXIAL_SHARE] == 0.0)
        bounds = np.array([_bounds(row, *pair) for pair in pairwise(edges)])
        reach[part] += bounds[:, 0].max()
        fourth[part] += bounds[:, 1].max()
    return reach, fourth


def _bounds(row, low, high) -> tuple[float, float]:
    """Bounds of a row's motion and its fourth derivative while its frequency is between two (rad/s)."""
    # Logarithm of the frequency, and phase.
    pace = abs(row[PACE]) if row[LOGARITHMIC] else abs(row[PACE]) / low
    grown = np.array([0.0, pace, *((0.0 if row[LOGARITHMIC] else pace**j / j) for j in range(2, 5))])
    w = high * _exponential(grown) if row[LOGARITHMIC] else np.array([high, abs(row[PACE]), 0.0, 0.0, 0.0])
    phase = np.array([0.0, *(w[j] / (j + 1) for j in range(4))])
    if math.isinf(row[CROSSOVER]):
        slopes = np.zeros(4)
    elif row[CROSSOVER] == 0.0:
        slopes = np.array([2.0, 0.0, 0.0, 0.0])
    else:
        slopes = np.array(CORNER_SLOPES)
    power, bent = np.array([1.0, 0.0, 0.0, 0.0, 0.0]), np.zeros(5)
    for j in range(4):
        power = _product(power, grown)
        bent += slopes[j] / math.factorial(j + 1) * power
    size = amplitude(row[AMPLITUDE], row[CROSSOVER], low)[0]
    shortest = min(row[RISE], row[FALL])
    ramp = np.array([slope / shortest**j / math.factorial(j) for j, slope in enumerate(RAMP_SLOPES)])
    series = _product(_product(size * _exponential(bent), ramp), _exponential(phase))
    return size, 24.0 * series[4]


def _product(one, other):
    """Product of two power series, to the fourth power."""
    return np.convolve(one, other)[:5]


def _exponential(series):
    """Exponential of a power series without a constant, to the fourth power."""
    out = np.array([1.0, 0.0, 0.0, 0.0, 0.0])
    for j in range(1, 5):
        out[j] = sum(k * series[k] * out[j - k] for k in range(1, j + 1)) / j
    return out


@inner_kernel()
def amplitude(size, crossover, w):
    """Amplitude at a frequency w (rad/s), of `size` and `crossover` as `level` has them; and which share of the corner
    has been passed: 0 where the displacement is kept, 1 where the acceleration is."""
    if crossover == 0.0:
        return size / (w * w), 1.0
    r = (w / crossover) * (w / crossover)
    if r < 1.0:
        small = r**CORNER
        return size * (1.0 + small) ** (-1.0 / CORNER), small / (1.0 + small)
    small = (1.0 / r) ** CORNER
    return size / r * (1.0 + small) ** (-1.0 / CORNER), 1.0 / (1.0 + small)


@inner_kernel()
def ramp(share):
    """Polynomial of ninth degree from 0 to 1 with four derivatives that vanish at both ends; its first two as well."""
    if share >= 1.0:
        return 1.0, 0.0, 0.0
    rest, both = 1.0 - share, share * (1.0 - share)
    cube = share * share * share
    value = cube * share * share * (126.0 + share * (-420.0 + share * (540.0 + share * (-315.0 + 70.0 * share))))
    return value, 630.0 * both**4, 2520.0 * both**3 * (rest - share)


@inner_kernel()
def sweep_at(tau, p, at):
    """Motion of the row that begins at `at` in `p`, at segment time tau (s): value, rate, acceleration (m or rad)."""
    s = tau - p[at + BEGIN]
    gone, left = p[at + GONE] + s, p[at + LEFT] - s
    if gone <= 0.0 or left <= 0.0:
        return 0.0, 0.0, 0.0
    pace = p[at + PACE]
    if p[at + LOGARITHMIC] != 0.0:
        grown = math.expm1(pace * s)
        phase, w = p[at + PHASE] + p[at + FREQUENCY] * grown / pace, p[at + FREQUENCY] * (1.0 + grown)
        rate, bend = pace, 0.0
    else:
        phase, w = p[at + PHASE] + s * (p[at + FREQUENCY] + 0.5 * pace * s), p[at + FREQUENCY] + pace * s
        rate = pace / w
        bend = -rate * rate
    # Amplitude a, its logarithm's first two derivatives, and ramp e; one ramp is over before the other begins.
    a, share = amplitude(p[at + AMPLITUDE], p[at + CROSSOVER], w)
    steep = 0.0 if p[at + CROSSOVER] == 0.0 else 2.0 * CORNER * share * (1.0 - share)
    g, g_rate = -2.0 * share * rate, -2.0 * (steep * rate * rate + share * bend)
    e, e_rate, e_second = ramp(gone / p[at + RISE])
    e_rate, e_second = e_rate / p[at + RISE], e_second / (p[at + RISE] * p[at + RISE])
    if left < p[at + FALL]:
        e, e_rate, e_second = ramp(left / p[at + FALL])
        e_rate, e_second = -e_rate / p[at + FALL], e_second / (p[at + FALL] * p[at + FALL])
    b, b_rate = a * e, a * (g * e + e_rate)
    b_second = a * ((g * g + g_rate) * e + 2.0 * g * e_rate + e_second)
    cos, sin = math.cos(phase), math.sin(phase)
    acceleration = (b_second - b * w * w) * sin + (2.0 * b_rate * w + b * w * rate) * cos
    return b * sin, b_rate * sin + b * w * cos, acceleration
