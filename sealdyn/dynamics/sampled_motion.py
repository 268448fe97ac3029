"""Motion of a carrier given by samples: a spline of fifth degree through them, looked up by compiled kernels.

Its fourth derivative is continuous, so that neither the acceleration of the carrier nor a solver of high order meets a
kink at a sample, and no run starts anew there; and it bounds how far a step's cubic misses the motion.  Between samples
of a tone the spline is off by the sixth power of their spacing.
**Source** de Boor (2001), A Practical Guide to Splines, ch. XIII: interpolation with the not-a-knot condition.

Block layout: number of pieces, their ends in segment time (pieces + 1), then for each piece the coefficients of axial
motion and both tilts, highest power first.
"""

import math
from dataclasses import dataclass
from functools import lru_cache

import numpy as np

from ..numerics.kernel import inner_kernel
from ..scene.excitation import Motion
from ..scene.scene import SceneError

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


@lru_cache(maxsize=8)
def sampled(motion: Motion) -> Sampled:
    """The spline through the samples of a motion."""
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
    return {ring: sampled(motion) for ring, motion in given.items() if motion is not None}


def check_covers(scene, duration: float) -> None:
    """Raises SceneError where the samples of a motion end before a run of `duration` (s) does."""
    for table, motion in (("housing", scene.housing.motion), ("shaft", scene.shaft.motion)):
        if motion is not None and motion.time[-1] < duration * (1 - 1e-9):
            found = f"samples until {motion.time[-1]:g} s, a run of {duration:g} s"
            raise SceneError(f"{table}.motion.time", found, "samples to the end of the run, or a shorter run")


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
