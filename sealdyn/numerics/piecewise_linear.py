"""Piecewise linear functions of time."""

from bisect import bisect_right
from dataclasses import dataclass


@dataclass(frozen=True)
class PiecewiseLinear:
    """A function of time given by values at points in time (s), of equal number: linear between, held before the first
    and after the last.

    The same time twice is a step; from that time on the second value holds.
    """

    time: tuple[float, ...]
    value: tuple[float, ...]

    def at(self, t: float) -> float:
        """Value at time t (s), in the unit of the values."""
        k = bisect_right(self.time, t)
        if k == 0:
            return self.value[0]
        if k == len(self.time):
            return self.value[-1]
        t0, t1 = self.time[k - 1], self.time[k]
        v0, v1 = self.value[k - 1], self.value[k]
        return v0 + (v1 - v0) * ((t - t0) / (t1 - t0))

    def breaks(self) -> tuple[float, ...]:
        """Times (s) of the kinks and steps, increasing."""
        return tuple(sorted(set(self.time)))


def initially(quantity) -> float:
    """Value at time zero of a number or a function of time, in its own unit."""
    return quantity.at(0.0) if isinstance(quantity, PiecewiseLinear) else float(quantity)


def points(quantity) -> tuple[float, ...]:
    """All values of a function of time, or the number itself, in its own unit."""
    return quantity.value if isinstance(quantity, PiecewiseLinear) else (quantity,)
