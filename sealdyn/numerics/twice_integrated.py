"""Displacement from a record of acceleration: integrated twice, without the drift that this makes of noise.

The spline of fifth degree through the samples is integrated exactly; of the result `X` a slow part `p` is taken away,
the one that makes

    int (p'' - b - c t)^2 dt + W^4 int (X - p)^2 dt          W = 2 pi corner

least over p, b and c.  In the middle of a record a tone of frequency f loses at most `(corner/f)^4` of its
displacement, in phase; an offset of the record and its change at an even pace, b + c t, go exactly, and with them start
and velocity, which no record of acceleration tells.
**Source** the functional of Lee, Hong & Park (2010), J. Sound Vib. 329(23), 4928-4944 (a regularised boundary value
problem in place of integration), here with the offset among its unknowns; p by splines (Galerkin).
**Valid** motion that is faster than the corner: one of ten times its frequency loses 1e-4.  At the ends of a record it
is off by as much as half of `corner/f`, which fades over a period of the corner.
"""

import math

import numpy as np
from numpy.polynomial.polynomial import polyfit, polyval

# Pieces of the slow part to a period of the corner.
PIECES = 8


def twice_integrated(time: np.ndarray, values: np.ndarray, corner: float) -> tuple[np.ndarray, tuple[float, float]]:
    """Displacements (m,) at `time` (m,) (s, increasing) of accelerations `values` (m,), per s^2, without what is slower
    than a `corner` (Hz); and the offset at the middle of the record, and its change per s, that were taken away."""
    # Loaded only where a record is integrated.
    from scipy.interpolate import BSpline, make_interp_spline
    from scipy.sparse import csc_array, hstack, vstack
    from scipy.sparse.linalg import splu

    w, middle = 2.0 * math.pi * corner, 0.5 * (time[0] + time[-1])
    # In radians of the corner all terms are of one size.
    x, values = w * (np.asarray(time, dtype=float) - middle), np.asarray(values, dtype=float)
    # Most of a drift goes beforehand, so that its square does not drown the rest in rounding.
    line = polyfit(x, values, 1)
    moved = make_interp_spline(x, values - polyval(x, line), k=5).antiderivative(2)(x)
    cubic = polyfit(x, moved, 3)
    moved -= polyval(x, cubic)
    count = math.ceil(PIECES * (x[-1] - x[0]) / (2.0 * math.pi))
    knots = np.concatenate([np.full(5, x[0]), np.linspace(x[0], x[-1], count + 1), np.full(5, x[-1])])
    slow = BSpline.design_matrix(x, knots, 5)
    bent = BSpline.design_matrix(x, knots[2:-2], 3) @ _slopes(knots[1:-1], 4) @ _slopes(knots, 5)
    drift = csc_array(np.stack([np.ones_like(x), x], axis=1))
    share = np.sqrt(np.gradient(x))
    rows = csc_array(vstack([hstack([bent, -drift]), hstack([slow, 0.0 * drift])]).multiply(np.tile(share, 2)[:, None]))
    asked = np.concatenate([np.zeros_like(x), share * moved])
    found = splu(csc_array(rows.T @ rows)).solve(rows.T @ asked)
    offset, pace = line + found[-2:] + (2.0 * cubic[2], 6.0 * cubic[3])
    return (moved - slow @ found[:-2]) / w**2, (float(offset), float(pace * w))


def _slopes(knots: np.ndarray, degree: int):
    """Matrix, sparse, from the coefficients of splines of a degree to those of their derivatives, on the same knots
    without the outermost.  **Source** de Boor (2001), ch. X, eq. (12)."""
    from scipy.sparse import diags_array

    count = len(knots) - degree - 1
    pace = degree / (knots[degree + 1 : degree + count] - knots[1:count])
    return diags_array([-pace, pace], offsets=[0, 1], shape=(count - 1, count))
