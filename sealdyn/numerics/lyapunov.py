"""Lyapunov exponents of a map, by two methods that share nothing, with their uncertainty; and how far one can see.

A map is a function of a point; a flow becomes one by integrating it over a fixed time.  Exponents are per iteration.
**Source** Benettin, Galgani, Giorgilli & Strelcyn, *Meccanica* 15 (1980) 9 and 21: two neighbours pulled back together,
and products of tangent maps made orthonormal; block averages: Flyvbjerg & Petersen, *J. Chem. Phys.* 91 (1989) 461.
**Valid** maps with a continuous derivative; the trajectory must be on its attractor when counting begins.
"""

from dataclasses import dataclass

import numpy as np
from scipy.stats import t as student

# Blocks an uncertainty is drawn from: fewer say too little, more are too short to be independent.
BLOCKS = (8, 12, 16, 24, 32)


@dataclass(frozen=True)
class Exponent:
    """Largest exponent per iteration (`value`), its uncertainty (95 % of cases, by blocks), and the spectrum (k,): as
    many exponents as directions were followed, largest first."""

    value: float
    uncertainty: float
    spectrum: np.ndarray


def two_trajectories(step, start, scales, iterations: int, settle: int = 20, distance: float = 1e-5) -> Exponent:
    """Growth of the distance of two neighbours, pulled back to `distance` (in units of `scales`) at each iteration.

    `step(x) -> x` the map on points (n,), from `start`; `scales` (n,) of its unknowns; the first `settle` iterations
    only turn the distance into the direction that grows, `iterations` more are counted.
    **Valid** `distance` far above the map's own error, and far below the size of the attractor.
    """
    x, scales = np.array(start, dtype=float), np.asarray(scales, dtype=float)
    apart = _direction(len(x)) * distance
    growths = np.empty(settle + iterations)
    for k in range(settle + iterations):
        other = step(x + apart * scales)
        x = step(x)
        apart = (other - x) / scales
        size = np.linalg.norm(apart)
        growths[k] = np.log(size / distance)
        apart *= distance / size
    growths = growths[settle:]
    return Exponent(float(growths.mean()), uncertainty(growths), growths.mean(keepdims=True))


def tangent_product(step, start, iterations: int, directions: int = 1, settle: int = 20) -> Exponent:
    """Growth of tangent vectors under the products of the map's derivative, made orthonormal at each iteration (QR).

    `step(x, q) -> (x, dq)`: the map on points (n,), from `start`, and its derivative applied to the columns of q (n,
    directions); `q` and `dq` in units in which lengths are compared.  `settle` iterations are not counted.
    """
    x = np.array(start, dtype=float)
    q = np.linalg.qr(np.column_stack([np.roll(_direction(len(x)), k) for k in range(directions)]))[0]
    growths = np.empty((settle + iterations, directions))
    for k in range(settle + iterations):
        x, moved = step(x, q)
        q, r = np.linalg.qr(moved)
        growths[k] = np.log(np.abs(np.diag(r)))
    growths = growths[settle:]
    spectrum = growths.mean(axis=0)
    return Exponent(float(spectrum[0]), uncertainty(growths[:, 0]), spectrum)


def _direction(n: int) -> np.ndarray:
    """A unit vector that no symmetry of a scene singles out."""
    v = np.cos(1.0 + 2.3 * np.arange(n))
    return v / np.linalg.norm(v)


def uncertainty(series) -> float:
    """Half-width (95 % of cases) of the mean of a correlated series (m,): spread of the means of blocks, the largest
    over several lengths of blocks, in units of the series.  Infinite for fewer than two values a block (m < 16)."""
    series = np.asarray(series, dtype=float)
    found = [0.0]
    for count in BLOCKS:
        length = len(series) // count
        if length < 2:
            break
        means = series[: count * length].reshape(count, length).mean(axis=1)
        found.append(float(means.std(ddof=1) / np.sqrt(count) * student.ppf(0.975, count - 1)))
    return max(found) if len(found) > 1 else float("inf")


def horizon(exponent: float, error: float, scale: float = 1.0) -> float:
    """Iterations after which an error has grown to `scale` (same unit): ln(scale/error)/exponent; infinite if nothing
    grows."""
    return float(np.log(scale / error) / exponent) if exponent > 0 else float("inf")
