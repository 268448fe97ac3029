"""Shaft speeds that matter to the whirl: where it loses its damping, and where it turns with the shaft.

Both are searched in the whirl's eigenvalues over the speed, given as a function `values(speeds)` (m, k) of speeds (m,)
(rad/s): eigenvalues p (1/s) of the tilt tilt_x + i tilt_y of the floating rings as exp(p t), imaginary part positive of
a forward whirl, NaN where there are fewer than k.
"""

from itertools import pairwise

import numpy as np

from ..numerics.crossing import crossing
from .modes import NEUTRAL

# An eigenvalue whose imaginary part is below this share of it does not oscillate.
STILL = 1e-9
# Of massless rings: the size (1/s) from which an eigenvalue stands for an infinite one; and how far from isotropic in
# tilt, as a share, the matrices may be by rounding.
INFINITE, ISOTROPIC = 1e12, 1e-8


def one_by_one(at_speed):
    """The function `values` of any scene, from an eigenproblem at each speed: `at_speed(w)` gives its LinearScene."""

    def values(speeds):
        rows = [
            [mode.value.conjugate() if mode.direction == "backward" else mode.value for mode in at_speed(w).modes()
             if mode.kind == "tilt"]
            for w in speeds
        ]  # fmt: skip
        found = np.full((len(rows), max(map(len, rows))), np.nan, dtype=complex)
        for row, here in zip(found, rows, strict=True):
            row[: len(here)] = here
        return found

    return values


def all_at_once(at_speed, fastest: float):
    """The function `values` of a scene whose matrices are linear in the speed, as those of a film that does not store
    are: `at_speed(w)` gives its LinearScene at rest and at the `fastest` speed (rad/s), between them it is known.

    About an aligned film all is isotropic in tilt, so one complex unknown stands for both tilts of a ring; the tilt of
    a ring without inertia is eliminated.  None where this does not hold, or a massless ring has no damping.
    """
    still, fast = at_speed(0.0), at_speed(fastest)
    pairs = [(_complex(a), _complex(b)) for a, b in ((still.stiffness, fast.stiffness), (still.damping, fast.damping))]
    if any(part is None for pair in pairs for part in pair):
        return None
    (k, k_slope), (d, d_slope) = ((a, (b - a) / fastest) for a, b in pairs)
    inertia = np.diag(still.mass)[1::3]
    heavy, light = np.flatnonzero(inertia), np.flatnonzero(inertia == 0.0)
    n = len(inertia)

    def values(speeds):
        w = np.asarray(speeds, dtype=float)[:, None, None]
        stiffness, damping = k + w * k_slope, d + w * d_slope
        # State: the tilts, then the rates of those with inertia.  What stands in `left` on the state gives the rates.
        rates = np.zeros((len(w), n, n + len(heavy)), dtype=complex)
        rates[:, heavy, n + np.arange(len(heavy))] = 1.0
        if len(light):
            known = stiffness[:, light] @ np.eye(n, n + len(heavy)) + damping[:, light][:, :, heavy] @ rates[:, heavy]
            rates[:, light] = -np.linalg.solve(damping[:, light][:, :, light], known)
        left = np.zeros((len(w), n + len(heavy), n + len(heavy)), dtype=complex)
        left[:, :n] = rates
        left[:, n:] = -(damping[:, heavy] @ rates)
        left[:, n:, :n] -= stiffness[:, heavy]
        left[:, n:] /= inertia[heavy, None]
        found = np.linalg.eigvals(left)
        if len(light):
            found[np.abs(found) >= INFINITE] = np.nan
        return found

    try:
        values([0.0, fastest])
    except np.linalg.LinAlgError:
        return None
    return values


def _complex(matrix) -> np.ndarray | None:
    """The tilts' part of a real matrix on (z, tilt_x, tilt_y) of each ring, as complex numbers on tilt_x + i tilt_y;
    None if it is not isotropic."""
    xx, xy, yx, yy = matrix[1::3, 1::3], matrix[1::3, 2::3], matrix[2::3, 1::3], matrix[2::3, 2::3]
    found, odd = 0.5 * (xx + yy) + 0.5j * (yx - xy), np.abs(xx - yy) + np.abs(xy + yx)
    return found if np.max(odd) <= ISOTROPIC * np.max(np.abs(found)) else None


def critical_speed(values, low: float, high: float, points: int = 160) -> float | None:
    """Lowest shaft speed (rad/s) in [low, high] where the largest growth rate of a tilt mode changes sign; None if it
    does not, or only within rounding."""
    speeds = np.geomspace(low, high, points)
    found = values(speeds)
    rates = _largest(found.real)
    # A speed at the threshold itself, within rounding, hides no change of sign, nor does one without a tilt mode.
    rates[~np.isfinite(rates) | (np.abs(rates) <= NEUTRAL * _largest(np.abs(found)))] = 0.0
    for a, b in pairwise(np.flatnonzero(rates)):
        if rates[a] * rates[b] < 0:
            return crossing(lambda w: _largest(values([w]).real)[0], speeds[a], speeds[b], 1e-13)
    return None


def _largest(rows) -> np.ndarray:
    """Largest number (m,) of each row, minus infinity of a row of NaN."""
    return np.max(np.where(np.isnan(rows), -np.inf, rows), axis=1)


def resonance_speeds(values, low: float, high: float, points: int = 120) -> list[float]:
    """Shaft speeds (rad/s) where a tilt mode's frequency equals the shaft speed (once per turn)."""

    def distances(speeds):
        # Forward modes only: an unbalance-like forcing turns with the shaft.
        found = values(speeds)
        forward = found.imag > STILL * np.abs(found)
        return np.sort(np.where(forward, found.imag - np.asarray(speeds)[:, None], np.nan), axis=1)

    speeds = np.geomspace(low, high, points)
    each, found = distances(speeds), []
    counts = np.sum(np.isfinite(each), axis=1)
    # As many forward modes at both ends: the same ones.
    brackets = (each[:-1] * each[1:] < 0) & (counts[:-1] == counts[1:])[:, None]
    for k, mode in zip(*np.nonzero(brackets), strict=True):
        at = crossing(lambda w, mode=mode: distances([w])[0][mode], speeds[k], speeds[k + 1], 1e-13)
        # NaN: the mode stops oscillating inside the bracket, no crossing.
        found += [at] if np.isfinite(at) else []
    return found
