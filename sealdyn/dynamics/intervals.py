"""Time cut into intervals, on each of which every imposed quantity is linear in time.

An interval starts at a break point (a kink or step of a function of time) or after `LONGEST` turns.  Within one the
clock `tau` starts at zero, a function of time is `value + slope tau`, and a phase is `a0 + a1 tau + a2 tau^2` with `a0`
reduced modulo one turn in exact arithmetic: a phase after a million turns is as exact as the first.
"""

import math
from bisect import bisect_right
from collections.abc import Sequence
from dataclasses import dataclass, replace
from decimal import Decimal, getcontext
from fractions import Fraction
from itertools import accumulate, pairwise

from ..numerics.piecewise_linear import PiecewiseLinear, initially

LONGEST = 2000  # turns; then the clock is set anew
FEW = 100  # intervals between two break points that stand for all

INSTANTS = 1000  # of an interval are its end
ROUNDING = 1e-13  # of a value is what a sum of two has lost
MOST_CYCLES = 64  # of the slowest motion in a common period

# 2 pi to 60 digits (mathematical constant).
TURN = Decimal("6.28318530717958647692528676655900576839433879875021164194988918")
getcontext().prec = max(getcontext().prec, 60)


@dataclass(frozen=True)
class Interval:
    """One stretch of time: exact start and span (s), and the exact angle turned before it, of the shaft and of the
    stator's carrier (rad)."""

    start: Fraction
    span: Fraction
    rotor_angle: Fraction
    stator_angle: Fraction

    @property
    def length(self) -> float:
        """Length of the interval (s)."""
        return float(self.span)

    @property
    def angles(self) -> tuple[Fraction, Fraction]:
        """Both exact angles at the start (rad)."""
        return self.rotor_angle, self.stator_angle

    @property
    def time(self) -> float:
        """Start of the interval (s)."""
        return float(self.start)

    @property
    def key(self) -> tuple[Fraction, ...]:
        """What its conditions at the start may be kept under."""
        return (self.start,)


@dataclass(frozen=True)
class Instant(Interval):
    """One instant inside an interval, or at its end: an interval without a length that begins there, on which all goes
    on as it does `within` that one.  **Valid** for values and slopes; the angles are those of the other."""

    within: Interval

    @classmethod
    def of(cls, interval: Interval, tau: float) -> "Instant":
        """The instant `tau` (s) after the interval's start."""
        return cls(interval.start + Fraction(tau), Fraction(0), *interval.angles, interval)

    @property
    def key(self) -> tuple[Fraction, ...]:
        """The same; where an interval ends the next one may begin with a step."""
        return self.start, self.within.start


def constant_and_slope(quantity, interval: Interval) -> tuple[float, float]:
    """Value at the start and slope (per s) over one interval of a number or a `PiecewiseLinear` (which has no kink
    inside the interval), in its own unit."""
    if not isinstance(quantity, PiecewiseLinear):
        return float(quantity), 0.0
    if isinstance(interval, Instant):
        value, slope = constant_and_slope(quantity, interval.within)
        now = value + slope * float(interval.start - interval.within.start)
        # Of what has come to rest rounding is left.
        return (now if abs(now) > ROUNDING * abs(value) else 0.0), slope
    t0, t1 = interval.time, interval.time + interval.length
    # Ask just inside, so that a step at either end counts on the right side.
    inside = t0 + 0.5 * (t1 - t0)
    middle, early = quantity.at(inside), quantity.at(t0 + 0.25 * (t1 - t0))
    slope = (middle - early) / (0.25 * (t1 - t0))
    return middle - slope * (inside - t0), slope


def spins(scene, interval: Interval | None = None) -> tuple[float, float]:
    """Mean spin of both faces, and rotor's less stator's (rad/s), at an interval's start, or of a scene at its own."""
    first = initially if interval is None else lambda q: constant_and_slope(q, interval)[0]
    w_r, w_s = first(scene.shaft.speed), first(scene.stator.speed)
    return 0.5 * (w_r + w_s), w_r - w_s


def modulo_turn(angle: Fraction) -> float:
    """An exact angle (rad) modulo one turn, as a float within 1e-16."""
    exact = Decimal(angle.numerator) / Decimal(angle.denominator)
    return float(exact % TURN)


def angle_turned(speed, interval: Interval, linear_over: Interval | None = None) -> Fraction:
    """Exact integral (rad) of the speed (rad/s, number or function of time) over an interval, which may begin another
    one (`linear_over`) whose slope is taken."""
    w, slope = constant_and_slope(speed, linear_over or interval)
    return Fraction(w) * interval.span + Fraction(slope) * interval.span**2 / 2


class Intervals(Sequence):
    """Intervals in the order of time, each made when it is asked for: a run of 1e9 turns has half a million of them.
    `few`: those that stand for all where numbers are gathered over the run, the first and last between two break points
    and up to FEW in all, for in between everything goes on linearly."""

    def __init__(self, wholes: list[Interval], pieces: list[int], speeds: tuple):
        self._wholes, self._pieces, self._speeds = wholes, pieces, speeds
        self._first = [0, *accumulate(pieces)]

    def __len__(self) -> int:
        return self._first[-1]

    def __getitem__(self, index):
        places = range(len(self))[index]
        return [self._made(k) for k in places] if isinstance(index, slice) else self._made(places)

    def _made(self, index: int) -> Interval:
        place = bisect_right(self._first, index) - 1
        each = self._wholes[place].span / self._pieces[place]
        return self._part(self._wholes[place], each * (index - self._first[place]), each)

    def _part(self, whole: Interval, gone: Fraction, span: Fraction) -> Interval:
        """A stretch of `span` (s) of an interval, `gone` (s) after its start."""
        before = replace(whole, span=gone)
        angles = (a + angle_turned(w, before, whole) for a, w in zip(whole.angles, self._speeds, strict=True))
        return Interval(whole.start + gone, span, *angles)

    @property
    def end(self) -> Interval:
        """The last instants: where what is imposed has come to by then."""
        last = self[-1]
        return self._part(last, last.span - last.span / INSTANTS, last.span / INSTANTS)

    @property
    def few(self) -> list[Interval]:
        """See above."""
        places = []
        for first, count in zip(self._first, self._pieces, strict=False):
            every = range(count) if count <= FEW else (round(k * (count - 1) / (FEW - 1)) for k in range(FEW))
            places += [first + k for k in every]
        return [self._made(k) for k in places]


def split_at_breaks(duration: float, rotor_speed, stator_speed, quantities, times=()) -> Intervals:
    """Intervals from 0 to `duration` (s) of shaft and stator speeds (rad/s).  `quantities` are all imposed numbers and
    functions of time, speeds included; `times` (s) others at which one ends."""
    breaks = {0.0, duration, *(t for t in times if 0.0 < t < duration)}
    for quantity in quantities:
        if isinstance(quantity, PiecewiseLinear):
            breaks |= {t for t in quantity.time if 0.0 < t < duration}
    wholes, pieces, angles = [], [], (Fraction(0), Fraction(0))
    for begin, end in pairwise(sorted(breaks)):
        whole = Interval(Fraction(begin), Fraction(end) - Fraction(begin), *angles)
        wholes.append(whole)
        fastest = max(_fastest(rotor_speed, whole), _fastest(stator_speed, whole))
        pieces.append(max(1, math.ceil(fastest * whole.length / (2 * math.pi * LONGEST))))
        angles = [a + angle_turned(w, whole) for a, w in zip(angles, (rotor_speed, stator_speed), strict=True)]
    return Intervals(wholes, pieces, (rotor_speed, stator_speed))


def first_interval(quantities, times=()) -> Interval:
    """From time zero to the first break of any function of time among `quantities`, the first of `times` (s), or 1 s:
    where a scene starts, whatever the run."""
    breaks = [t for q in quantities if isinstance(q, PiecewiseLinear) for t in q.time if t > 0.0]
    breaks += [t for t in times if t > 0.0]
    return Interval(Fraction(0), Fraction(min(breaks, default=1.0)), Fraction(0), Fraction(0))


def largest_value(quantity) -> float:
    """Largest absolute value that a number or function of time takes."""
    return max(map(abs, quantity.value)) if isinstance(quantity, PiecewiseLinear) else abs(float(quantity))


def _fastest(speed, interval: Interval) -> float:
    w, slope = constant_and_slope(speed, interval)
    return max(abs(w), abs(w + slope * interval.length))


def time_of_angle(speed, angle: float) -> float:
    """Time (s) at which the shaft has turned through `angle` (rad, either way), `speed` (rad/s) a number or function of
    time.
    Raises ValueError if it never does."""
    if not isinstance(speed, PiecewiseLinear):
        if speed == 0.0:
            raise ValueError("the shaft does not turn")
        return angle / abs(speed)
    t, remaining = 0.0, angle
    for end in [b for b in _with_reversals(speed) if b > 0.0] + [math.inf]:
        w0 = abs(speed.at(t))
        if end == math.inf:
            if w0 == 0.0:
                raise ValueError("the shaft stops before it has turned so far")
            return t + remaining / w0
        middle = abs(speed.at(0.5 * (t + end)))
        turned_here, slope = middle * (end - t), 2 * (middle - w0) / (end - t)
        if turned_here >= remaining:
            # w0 x + slope x^2 / 2 = remaining, in the form that does not cancel.
            return t + 2 * remaining / (w0 + math.sqrt(max(w0 * w0 + 2 * slope * remaining, 0.0)))
        t, remaining = end, remaining - turned_here
    raise AssertionError


def _with_reversals(speed: PiecewiseLinear) -> list[float]:
    """Break points of a speed table, and the times in between at which the shaft reverses."""
    times = set(speed.breaks())
    for (t0, w0), (t1, w1) in pairwise(zip(speed.time, speed.value, strict=True)):
        if w0 * w1 < 0.0 and t1 > t0:
            times.add(t0 + (t1 - t0) * w0 / (w0 - w1))
    return sorted(times)


def common_period(frequencies) -> float | None:
    """Shortest common period (s) of angular frequencies (rad/s), None if they are incommensurate (no ratio of
    whole numbers up to MOST_CYCLES within 1e-9)."""
    moving = sorted({abs(w) for w in frequencies if w != 0.0})
    if not moving:
        return None
    base, multiple = moving[0], 1
    for w in moving[1:]:
        ratio = Fraction(w / base).limit_denominator(MOST_CYCLES)
        if abs(ratio - Fraction(w / base)) > 1e-9 * ratio:
            return None
        multiple = math.lcm(multiple, ratio.denominator)
    return 2 * math.pi / base * multiple
