"""Extremes of a steady motion made of a few harmonics, and the period after which they meet again."""

import numpy as np

from .modes import LinearScene


def steady_extremes(linear: LinearScene, answers, period: float | None) -> tuple[float, float, float]:
    """Largest and smallest relative misalignment (rad) and largest axial closing (m) of a linear steady state.

    `answers` pairs each Harmonic with its response.  With a common `period` (s) the motion is followed over it;
    without one the amplitudes are added: an upper bound, and 0 for the smallest.
    """
    relative = [(h.frequency, linear.relative(h, a)) for h, a in answers]
    if not relative:
        return 0.0, 0.0, 0.0
    if period is None:
        tilt = sum(0.5 * (abs(r[1] + 1j * r[2]) + abs(r[1] - 1j * r[2])) for _, r in relative)
        return float(tilt), 0.0, float(sum(abs(r[0]) for _, r in relative))

    frequencies, amplitudes = np.array([w for w, _ in relative]), np.array([r for _, r in relative])

    def measures(t):
        """Minus the squared tilt, the squared tilt and the axial motion at times (m,): what is made small."""
        x = (np.exp(1j * np.multiply.outer(t, frequencies)) @ amplitudes).real
        tilt = x[:, 1] ** 2 + x[:, 2] ** 2
        return np.array([-tilt, tilt, x[:, 0]])

    turns = np.max(np.abs(frequencies)) * period / (2 * np.pi)
    t = np.linspace(0.0, period, 256 * max(1, round(turns)) + 1)
    at, step, each, grid = t[np.argmin(measures(t), axis=1)], t[1] - t[0], np.arange(3), np.linspace(-1, 1, 41)
    # Smooth extrema: close in by ever finer grids.
    for _ in range(6):
        near = at[:, None] + step * grid
        found = measures(near.ravel()).reshape(3, 3, 41)[each, each]
        at = near[each, np.argmin(found, axis=1)]
        step /= 15
    most, least, axial = measures(at)[each, each]
    return float(np.sqrt(-most)), float(np.sqrt(least)), max(0.0, -float(axial))


def common_period(frequencies, most: int = 64) -> float | None:
    """Shortest common period (s) of angular frequencies (rad/s), None if they are incommensurate (no ratio of
    whole numbers up to `most` within 1e-9)."""
    from fractions import Fraction
    from math import lcm

    moving = sorted({abs(w) for w in frequencies if w != 0.0})
    if not moving:
        return None
    base, multiple = moving[0], 1
    for w in moving[1:]:
        ratio = Fraction(w / base).limit_denominator(most)
        if abs(ratio - Fraction(w / base)) > 1e-9 * ratio:
            return None
        multiple = lcm(multiple, ratio.denominator)
    return 2 * np.pi / base * multiple
