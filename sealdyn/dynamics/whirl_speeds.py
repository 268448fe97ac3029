"""Shaft speeds that matter to the whirl: where it loses its damping, and where it turns with the shaft.

Both are found in the whirl's eigenvalues over the speed, given as a function `values(speeds)` of speeds (m,) (rad/s):
eigenvalues (m, k) p (1/s) of the tilt tilt_x + i tilt_y of the floating rings as exp(p t), imaginary part positive of a
whirl that goes with the shaft, and bounds (m, k) on their errors (1/s); NaN where there are fewer than k.
"""

from itertools import pairwise

import numpy as np

from ..numerics.crossing import crossing
from .characteristic import roots
from .neutral_speeds import Whirl, mended

# An eigenvalue whose imaginary part is below this share of it does not oscillate.
STILL = 1e-9
# How near, as a share, a known neutral speed is looked at from both sides.
BESIDE = 1e-6
# Halvings of a step of the speed over which a mode begins or ceases to go forward: it may hide a resonance of another.
HALVINGS = 8


def one_by_one(at_speed, direction: float = 1.0):
    """The function `values` of any scene, from an eigenproblem at each speed: `at_speed(w)` gives its LinearScene;
    `direction` -1 of a shaft that turns the other way, at speeds -w."""

    def values(speeds):
        rows = [[mode for mode in at_speed(direction * w).modes() if mode.kind == "tilt"] for w in speeds]
        found = np.full((len(rows), max(map(len, rows), default=0)), np.nan, dtype=complex)
        errors = np.full(found.shape, np.nan)
        against = "backward" if direction > 0.0 else "forward"
        for row, error, here in zip(found, errors, rows, strict=True):
            row[: len(here)] = [m.value.conjugate() if m.direction == against else m.value for m in here]
            error[: len(here)] = [m.error for m in here]
        return found, errors

    return values


def all_at_once(whirl: Whirl):
    """The function `values` of a scene whose matrices are linear in the speed."""
    return lambda speeds: roots(*whirl.at(np.asarray(speeds, dtype=float)))


def thresholds(values, low: float, high: float, points: int, neutral=()) -> list[float]:
    """Shaft speeds (rad/s), rising, at which the largest growth rate of the tilt modes changes its sign: in [low, high]
    those that so many `points` tell apart, and any of the speeds `neutral` at which some mode is known to be neutral.
    A growth rate whose bound contains zero has no sign."""
    neutral = np.asarray(neutral, dtype=float)
    speeds = np.concatenate([np.geomspace(low, high, points), neutral * (1.0 - BESIDE), neutral * (1.0 + BESIDE)])
    speeds = np.unique(speeds)
    signs = _signs(*values(speeds))
    found = []
    for a, b in pairwise(np.flatnonzero(signs)):
        if signs[a] * signs[b] < 0:
            between = neutral[(neutral > speeds[a]) & (neutral < speeds[b])]
            at = between[0] if len(between) == 1 else crossing(
                lambda w: _largest(values([w])[0].real)[0], speeds[a], speeds[b], 1e-13)  # fmt: skip
            found += [float(at)] if np.isfinite(at) else []
    return found


def critical_speed(values, low: float, high: float, points: int = 160) -> float | None:
    """Lowest of the `thresholds` in [low, high] (rad/s); None without one."""
    return min(thresholds(values, low, high, points), default=None)


def _signs(found, errors) -> np.ndarray:
    """Signs (m,) of the largest growth rate of each row, 0 where its bound contains zero, or without a mode."""
    grows = _largest(found.real - errors) > 0.0
    dies = _largest(found.real + errors) < 0.0
    return np.where(np.isnan(found).all(axis=1), 0, grows * 1 - dies * 1)


def _largest(rows) -> np.ndarray:
    """Largest number (m,) of each row, minus infinity of a row of NaN."""
    return np.max(np.where(np.isnan(rows), -np.inf, rows), axis=1, initial=-np.inf)


def resonance_speeds(values, low: float, high: float, points: int = 120, whirl: Whirl | None = None) -> list[float]:
    """Shaft speeds (rad/s) where a tilt mode's frequency equals the shaft speed (once per turn); `whirl` of a scene
    whose matrices are linear in the speed, for which Newton's method mends what the points have bracketed."""

    def distances(speeds):
        # Forward modes only: an unbalance-like forcing turns with the shaft.
        found, _ = values(speeds)
        away = np.where(found.imag > STILL * np.abs(found), found.imag - np.asarray(speeds)[:, None], np.nan)
        order = np.argsort(away, axis=1)
        return np.take_along_axis(away, order, axis=1), np.take_along_axis(found.real, order, axis=1)

    speeds = np.geomspace(low, high, points)
    each, rates = distances(speeds)
    for _ in range(HALVINGS):
        at = 1 + np.flatnonzero(np.diff(np.sum(np.isfinite(each), axis=1)))
        if not len(at):
            break
        between = np.sqrt(speeds[at - 1] * speeds[at])
        each, rates = (_with_rows(rows, at, more) for rows, more in zip((each, rates), distances(between), strict=True))
        speeds = np.insert(speeds, at, between)
    counts = np.sum(np.isfinite(each), axis=1)
    # As many forward modes at both ends: the same ones.
    brackets = (each[:-1] * each[1:] < 0) & (counts[:-1] == counts[1:])[:, None]
    found = []
    for k, mode in zip(*np.nonzero(brackets), strict=True):
        a, b = speeds[k], speeds[k + 1]
        at = _mended(whirl, rates[k, mode], a, b, each[k, mode] / (each[k, mode] - each[k + 1, mode]))
        if at is None:
            at = crossing(lambda w, mode=mode: distances([w])[0][0, mode], a, b, 1e-13)
        # NaN: the mode stops oscillating inside the bracket, no crossing.
        found += [at] if np.isfinite(at) else []
    return found


def _with_rows(rows, at, more) -> np.ndarray:
    """`rows` with `more` before the places `at`, NaN where either is narrower."""
    width = max(rows.shape[1], more.shape[1])
    rows, more = (np.pad(a, ((0, 0), (0, width - a.shape[1])), constant_values=np.nan) for a in (rows, more))
    return np.insert(rows, at, more, axis=0)


def _mended(whirl, rate, a, b, share) -> float | None:
    """The resonance speed (rad/s) in [a, b] that Newton's method finds from a growth rate (1/s) and a share of the way;
    None if it finds none there."""
    if whirl is None:
        return None
    with np.errstate(all="ignore"):
        _, at = mended(whirl, [rate], [a + share * (b - a)], 1.0, 1j)
    return float(at[0]) if len(at) and a <= at[0] <= b else None
