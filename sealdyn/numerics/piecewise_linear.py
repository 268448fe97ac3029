"""Piecewise linear functions of time; and the zero of a function in a bracket, without SciPy's optimisers, which take
longer to load."""

import math
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


def value_at(quantity, time: float) -> float:
    """Value at a time (s) of a number or a function of time, in its own unit."""
    return quantity.at(time) if isinstance(quantity, PiecewiseLinear) else float(quantity)


def initially(quantity) -> float:
    """Value at time zero of a number or a function of time, in its own unit."""
    return value_at(quantity, 0.0)


def points(quantity) -> tuple[float, ...]:
    """All values of a function of time, or the number itself, in its own unit."""
    return quantity.value if isinstance(quantity, PiecewiseLinear) else (quantity,)


def shifted(quantity, change: float):
    """A number or function of time with a `change`."""
    if isinstance(quantity, PiecewiseLinear):
        return PiecewiseLinear(quantity.time, tuple(value + change for value in quantity.value))
    return quantity + change


def crossing(function, a: float, b: float, relative: float, most: int = 100) -> float:
    """Where a continuous function changes sign between a and b, to `relative` of the place; NaN where it meets a value
    that is not finite.

    Inverse quadratic interpolation where that is safe, else bisection.
    **Source** Chandrupatla (1997), Advances in Engineering Software 28, 145-149.
    Raises ValueError if it has one sign.
    """
    f_a, f_b = function(a), function(b)
    if f_a * f_b > 0:
        raise ValueError("no change of sign")
    c, f_c, share = a, f_a, 0.5
    for _ in range(most):
        x = a + share * (b - a)
        f_x = function(x)
        if not math.isfinite(f_x):
            return math.nan
        if (f_x > 0) == (f_a > 0):
            c, f_c = a, f_a
        else:
            c, b, f_c, f_b = b, a, f_b, f_a
        a, f_a = x, f_x
        best, least = (a, f_a) if abs(f_a) < abs(f_b) else (b, f_b)
        tolerance = 0.5 * relative * abs(best) / abs(b - a) if b != a else 1.0
        if least == 0.0 or tolerance > 0.5:
            return float(best)
        xi, phi = (a - b) / (c - b), (f_a - f_b) / (f_c - f_b)
        share = 0.5
        if phi * phi < xi and (1.0 - phi) ** 2 < 1.0 - xi:
            share = f_a / (f_b - f_a) * f_c / (f_b - f_c) + (c - a) / (b - a) * f_a / (f_c - f_a) * f_b / (f_c - f_b)
        share = min(max(share, tolerance), 1.0 - tolerance)
    return float(best)
