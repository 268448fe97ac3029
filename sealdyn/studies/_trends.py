"""How the numbers of a sweep over one key follow it: a sentence each."""

import math

import numpy as np

from ._words import plain

# Of the range of an output: what goes the other way by less is no turn.  Of the range of its logarithm: how far a power
# law may be off.
WIGGLE, OFF = 0.01, 0.03
# A power law is looked for in so many points at least, over such a ratio of the key and such a one of the output.
FEW, WIDE, MOVED = 4, 1.5, 1.05
# From how many times as much on no per cent are told.  What changes by less than STILL of itself hardly does, by less
# than SAME it is rounding.
MANY, STILL, SAME = 2.0, 1e-3, 1e-9


def trend(name: str, key: str, unit: str, points, shown=("", 1.0)) -> str:
    """In a sentence how output `name` follows the `key` (in its `unit`) over `points` [(value of the key, number)]:
    from what to what, or where it turns, and by what power where that fits; `shown` the output's unit and factor.
    Empty for fewer than two points."""
    points = sorted((x, shown[1] * y) for x, y in points)
    if len(points) < 2:
        return ""
    x, y = (np.array(part, float) for part in zip(*points, strict=True))
    own = f" {shown[0]}" if shown[0] not in ("", "1") else ""
    reach, size = np.ptp(y), np.max(np.abs(y))
    if reach <= SAME * size:
        return f"{name} stays at {plain(y[0], 4)}{own}."
    if reach <= STILL * size:
        return f"{name} hardly changes: {plain(y[0], 4)}{own}, within {100 * reach / size:.2g} %."
    steps = np.diff(y) * np.sign(y[-1] - y[0])
    if -np.sum(steps[steps < 0.0]) > WIGGLE * reach or y[0] == y[-1]:
        ends = [f"{plain(y[k], 4)}{own}, at {x[k]:.4g} {unit or ''}".rstrip() for k in (np.argmin(y), np.argmax(y))]
        return f"{name} turns over {key}: least, {ends[0]}; largest, {ends[1]}."
    goes = "grows" if y[-1] > y[0] else "falls"
    power = power_law(x, y)
    law = f", about as {key}^{power:.2g}" if power is not None else ""
    return f"{name} {goes}{_by(*y[[0, -1]])} from {plain(y[0], 4)} to {plain(y[-1], 4)}{own}{law}."


def power_law(x, y) -> float | None:
    """The power with which y (m,) follows x (m,), None where it follows none."""
    if len(x) < FEW or np.min(x) <= 0.0 or np.min(y) * np.max(y) <= 0.0:
        return None
    far, high = np.log(x), np.log(np.abs(y))
    if np.ptp(far) < math.log(WIDE) or np.ptp(high) < math.log(MOVED):
        return None
    power, start = np.polyfit(far, high, 1)
    fits = np.max(np.abs(power * far + start - high)) <= OFF * np.ptp(high)
    return float(power) if fits else None


def _by(first, last) -> str:
    """How much more or less, as a factor or in per cent; nothing from zero on or through it."""
    if first * last <= 0.0:
        return ""
    times = max(first / last, last / first)
    return f" by a factor of {plain(times, 3)}," if times >= MANY else f" by {100 * abs(last / first - 1.0):.2g} %,"
