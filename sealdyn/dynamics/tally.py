"""Means and largest values of a run's series: integrals over the solver's steps, and peaks located between them.

Whatever is sampled for an archive, these are of the motion itself.  Lobatto's rule (numerics/hermite.py) on panels
of a few steps, at most so long that an oscillation of TIMES the fastest motion of interest keeps the accuracy; a peak
is sought where a parabola through three points rises above the largest value so far, and looked at there.
"""

import math
from functools import partial

import numpy as np

from ..numerics.hermite import LOBATTO_ERROR, LOBATTO_ORDER, points, sample
from .signals import TALLIED, signals

# Harmonics of the fastest motion that are resolved, and the longest panel (rad of it).
TIMES, LONGEST = 2.0, 1.0
# Series whose peaks are looked for.
PEAKED = ("leakage_inner", "leakage_outer", "friction_power", "contact_force", "contact_area_fraction",
          "contact_pressure", "cavitated_fraction")  # fmt: skip
# Looks at peaks, each nearer; and an improvement not worth one, over the accuracy.
LOOKS, SLACK = 3, 0.02
# Points looked at in one call: bounds the memory that a film with unknowns of its own takes.
AT_ONCE = 512


def longest_panel(segment) -> float:
    """Longest panel (s) of the quadrature in a segment."""
    asked = (segment.model.accuracy / LOBATTO_ERROR) ** (1 / LOBATTO_ORDER) / TIMES
    return min(asked, LONGEST) / max(2 * math.pi / segment.shortest_period, segment.pace)


class Tally:
    """An observer: integrals `sums` {series: SI s} and `largest` values {series: SI} of the series that are tallied,
    over `time` (s).

    Of a film whose unknowns settle at each step, which is where it is known best, the points are the steps: the
    trapezoidal rule, of the second order that its method has."""

    def __init__(self, model):
        self.time, self.sums, self.largest = 0.0, {}, {}
        self.slack = SLACK * model.accuracy
        self.at_steps = model.interface.film.settle is not None

    def begin(self, segment, tau, y):
        """Nothing to do."""

    def accept(self, block):
        """Take in a block's new steps."""
        begin, end, t = block.begin, block.end, block.t
        until = t[end] if block.until is None else block.until
        if self.at_steps:
            times = np.append(t[begin:end], until)
            halves = 0.5 * np.diff(times)
            weights = np.append(halves, 0.0) + np.append(0.0, halves)
        else:
            times, weights = points(t, begin, end, until, longest_panel(block.segment))
        if block.segment.film.start == block.segment.film.stop:
            self.take_motion(block.segment, times, weights, *block.at(times))
        else:
            whole = partial(_columns, block.segment, lambda some: (*block.at(some), *block.film_at(some)))
            self._take(times, weights, whole(times), whole)

    def take_motion(self, segment, times, weights, q, q_rate):
        """Take in points of a segment without unknowns of the film: increasing `times` (m,) (s, of the segment),
        `weights` (m,) (s), and the motion there, displacements and rates (m, n)."""

        def between(wanted):
            out, slope = np.empty((2, len(wanted), q.shape[1]))
            sample(times, q, q_rate, len(times), 0, len(times) - 1, wanted, out, slope)
            return out, slope

        columns = _columns(segment, lambda some: (q, q_rate), times, len(times))
        self._take(times, weights, columns, partial(_columns, segment, between))

    def _take(self, times, weights, columns, between):
        """Take in `columns` {series: (m,)} at points, and what is `between` them."""
        self.time += float(weights.sum())
        for name, values in columns.items():
            self.sums[name] = self.sums.get(name, 0.0) + float(weights @ values)
            self.largest[name] = max(self.largest.get(name, -math.inf), float(values.max()))
        if not self.at_steps:
            self._locate(times, {name: columns[name] for name in PEAKED if name in columns}, between)

    def _locate(self, times, columns, between):
        """Look at the peaks between the points."""
        for _ in range(LOOKS):
            peaks = [_peaks(times, values, self.largest[name], self.slack) for name, values in columns.items()]
            wanted = np.setdiff1d(np.concatenate(peaks), times)
            if not len(wanted):
                return
            found = between(wanted)
            at = np.searchsorted(times, wanted)
            times = np.insert(times, at, wanted)
            for name, values in columns.items():
                self.largest[name] = max(self.largest[name], float(found[name].max()))
                columns[name] = np.insert(values, at, found[name])

    def mean(self, name: str) -> float:
        """Mean (SI) of a series so far; NaN without one."""
        return self.sums[name] / self.time if self.time and name in self.sums else math.nan

    def most(self, name: str) -> float:
        """Largest value (SI) of a series so far; NaN without one."""
        return self.largest.get(name, math.nan)

    def state(self) -> dict:
        """What a continued run needs."""
        return {"time": self.time, "sums": self.sums, "largest": self.largest}

    def restore(self, state: dict):
        """Go on from `state`."""
        self.time, self.sums, self.largest = float(state["time"]), dict(state["sums"]), dict(state["largest"])


def _columns(segment, motion, times, at_once=AT_ONCE) -> dict[str, np.ndarray]:
    """Series (m,) that are tallied, at segment times (m,) (s), of displacements, rates and the film's unknowns that
    `motion` has there."""
    pieces = [times[first : first + at_once] for first in range(0, len(times), at_once)]
    parts = [signals(segment, some, *motion(some), tallied=True) for some in pieces]
    return {name: np.concatenate([part[name] for part in parts]) for name in TALLIED if name in parts[0]}


def _peaks(t, values, record: float, slack: float) -> np.ndarray:
    """Times (s) at which `values` (m,) at `t` (m,) may be larger than the `record`, by the parabolas through three
    neighbours, each over the middle half of them, the outermost to the ends.  `slack`: an improvement not worth a look,
    over the record."""
    if len(t) < 3:
        return np.empty(0)
    slopes = np.diff(values) / np.diff(t)
    bend = np.diff(slopes) / (t[2:] - t[:-2])
    bent = np.flatnonzero(bend < 0.0)
    here, left = t[bent + 1], t[bent]
    slope = slopes[bent] + bend[bent] * (here - left)
    at = here - 0.5 * slope / bend[bent]
    low, high = 0.5 * (left + here), 0.5 * (here + t[bent + 2])
    low, high = np.where(bent == 0, left, low), np.where(bent == len(t) - 3, t[bent + 2], high)
    known = np.maximum(np.maximum(values[bent], values[bent + 1]), values[bent + 2])
    gain = values[bent + 1] - 0.25 * slope**2 / bend[bent] - known
    margin = slack * abs(record)
    return at[(low < at) & (at < high) & (gain > margin) & (known + 1.5 * gain > record + margin)]
