"""The radial films' parameter block and their Gauss rules over the radius."""

import math
from functools import lru_cache

import numpy as np

from ..faces.geometry import (
    FACE_SIZE,
    GAP_STATE_SIZE,
    MEAN_SPIN,
    SPIN_DIFFERENCE,
    VISCOSITY,
    face_parameters,
)
from ..numerics.kernel import inner_kernel
from ._opening import opening_force

# Gauss rules offered.
RADIAL_POINTS = (4, 8, 12, 16, 24, 32)
# Angle counts offered are divisors of the longest table.
MOST_ANGLES = 3072
ANGLES = (8, 12, 16, 24, 32, 48, 64, 96, 128, 192, 256, 384, 512, 768, 1536, 3072)

# Cosines and sines of the half circle, and how often each of its angles is met on the whole one.
HALF_CIRCLE = tuple(
    function(2 * np.pi * np.arange(MOST_ANGLES // 2 + 1) / MOST_ANGLES) for function in (np.cos, np.sin)
)
TWICE = np.array([1.0, *(MOST_ANGLES // 2 - 1) * [2.0], 1.0])

# At the floor the film's law has a bend of second order, of which the trapezoid leaves LOW/N^3 of the load; and by how
# many powers of e each Gauss point of a panel between two bends gains (radial/bent_angles.py).
LOW, PANEL_GAIN = 10.0, 2.88

# Block layout after the faces; INERTIA is the density (kg/m^3) of a film with inertia, else 0.
CAVITATION, HAS_CAVITATION, INERTIA, LOG_ERROR, LOW_ANGLES, PANEL_RULE, ERROR, RULES = range(FACE_SIZE, FACE_SIZE + 8)
RULE_SIZE = 2 + 2 * RADIAL_POINTS[-1]
ANGLE_COUNTS = RULES + RULE_SIZE * len(RADIAL_POINTS)
COSINES = ANGLE_COUNTS + len(ANGLES)
SINES = COSINES + MOST_ANGLES // 2 + 1
WEIGHTS = SINES + MOST_ANGLES // 2 + 1
BLOCK_SIZE = WEIGHTS + MOST_ANGLES // 2 + 1


@lru_cache(maxsize=16)
def gauss(points: int) -> tuple[np.ndarray, np.ndarray]:
    """Gauss-Legendre points and weights, each (points,), on [-1, 1]."""
    return np.polynomial.legendre.leggauss(points)


# ln of the film ratios at which the rules are tried.
TRIED = np.linspace(0.0, 12.0, 241)


@lru_cache(maxsize=64)
def _rule_errors(radius_ratio: float) -> np.ndarray:
    """Worst relative error of the radial integrals, (rules, film ratios tried), of a film ratio or its inverse and of
    anything flatter."""
    q = np.exp(0.25 * np.concatenate([TRIED, -TRIED]))[:, None]
    t = (q - 1) / (q + 1)

    def moments(n):
        x, w = gauss(n)
        u = (1 + t * x) / (1 - t * x)
        y = 0.5 * (1 + x) * (1 - t) / (1 - t * x) * (u + 1 / q) / (q + 1 / q)
        dy = u * (1 - t * t) / (1 - t * x) ** 2 / (q + 1 / q)
        r = radius_ratio + (1 - radius_ratio) * y
        weight = w * dy / u**6
        powers = [r**k * y**j for k in (-1, 1, 2) for j in (0, 1, 2, 3)]
        return np.stack([np.sum(weight * power, axis=1) for power in powers])

    exact = moments(64)
    worst = [np.max(np.abs(moments(n) / exact - 1), axis=0).reshape(2, -1).max(axis=0) for n in RADIAL_POINTS]
    return np.maximum.accumulate(np.array(worst), axis=1)


@lru_cache(maxsize=64)
def _rules(radius_ratio: float, error: float) -> np.ndarray:
    """The block's Gauss rules: for each, its count, the largest film ratio (or its inverse) it may serve at
    this error, points and weights.  The limit is found by trying, so no error constant is guessed."""
    rows = []
    for points, errors in zip(RADIAL_POINTS, _rule_errors(radius_ratio), strict=True):
        # Force and moments are differences of these integrals: measured up to 100 times worse.
        serves = int(np.searchsorted(errors, max(error / 200, 3e-15)))
        x, w = gauss(points)
        row = np.zeros(RULE_SIZE)
        # A rule that cannot even serve flat faces gets a limit below one.
        row[:2] = points, math.exp(TRIED[serves - 1]) if serves else math.exp(-1.0)
        row[2 : 2 + points] = x
        row[2 + RADIAL_POINTS[-1] : 2 + RADIAL_POINTS[-1] + points] = w
        rows.append(row)
    return np.concatenate(rows)


def parameters(film, clearance: float, error: float = 1e-8) -> np.ndarray:
    """The film's block of the parameter array, shape (BLOCK_SIZE,).

    `film` a Film table, `clearance` design clearance at the inner radius (m), `error` relative error allowed to the
    quadrature of force and moments; points and angles follow it and the gap.
    """
    f = np.zeros(BLOCK_SIZE)
    f[:FACE_SIZE] = face_parameters(film, clearance)
    if film.cavitation_pressure is not None:
        f[CAVITATION], f[HAS_CAVITATION] = film.cavitation_pressure, 1.0
    f[INERTIA] = film.density if film.inertia else 0.0
    f[ERROR] = error = min(max(error, 1e-14), 1e-2)
    f[LOG_ERROR] = math.log(1e4 / error)
    f[LOW_ANGLES] = (LOW / (10.0 * error)) ** (1.0 / 3.0)
    wanted = int(np.searchsorted(RADIAL_POINTS, f[LOG_ERROR] / PANEL_GAIN))
    f[PANEL_RULE] = RULES + RULE_SIZE * min(wanted, len(RADIAL_POINTS) - 1)
    # Of a floored line a small part may be left: a tenth of the error is asked of its radial integrals.
    share = 0.1 if f[HAS_CAVITATION] else 1.0
    f[RULES:ANGLE_COUNTS] = _rules(film.inner_radius / film.outer_radius, share * error)
    f[ANGLE_COUNTS:COSINES] = ANGLES
    (f[COSINES:SINES], f[SINES:WEIGHTS]), f[WEIGHTS:BLOCK_SIZE] = HALF_CIRCLE, TWICE
    return f


def opening_law(film, parameters, wrench, mean_spin, spin_difference):
    """The function `opening_law` of a radial film's contract (N, m, Pa, rad/s), from the film's `parameters` and kernel
    `wrench`."""
    s = np.zeros(GAP_STATE_SIZE)
    s[VISCOSITY], s[MEAN_SPIN], s[SPIN_DIFFERENCE] = 1.0, mean_spin, spin_difference
    return opening_force(film, parameters(film, 1.0, 1e-13), s, wrench)


@inner_kernel()
def centrifugal(f, s):
    """Slope over r^2/2 (Pa/m^2) of the pressure that turns the fluid: p' of a film without inertia gains g r.

    **Source** the radial momentum of Couette flow, u = r (W_s + (W_r - W_s) y) at y = z/h, pushes outwards as a flow of
    6 int y (1 - y) rho u^2/r dy = rho r (3 W_s^2 + 4 W_s W_r + 3 W_r^2)/10 = rho r (wm^2 + (W_r - W_s)^2/20) would.
    **Valid** laminar, small h^2 rho W / mu: squeeze and the flow's own radial momentum are left out.
    """
    if f[INERTIA] == 0.0:
        return 0.0
    return f[INERTIA] * (s[MEAN_SPIN] * s[MEAN_SPIN] + 0.05 * s[SPIN_DIFFERENCE] * s[SPIN_DIFFERENCE])


@inner_kernel()
def points_for(f, h_i, h_o):
    """Index of the Gauss rule that serves the film ratio between h_i and h_o (m, or any unit); `f` the film's block."""
    ratio = h_o / h_i if h_o > h_i else h_i / h_o
    for rule in range(len(RADIAL_POINTS) - 1):
        if ratio <= f[RULES + rule * RULE_SIZE + 1]:
            return rule
    return len(RADIAL_POINTS) - 1


@inner_kernel()
def relative_clearance(h, swing):
    """Mean film `h` over its `swing` around the circle, in one unit: 1 where the faces meet, 0 for a film closed
    somewhere, 1e9 without a swing."""
    if h <= swing:
        return 0.0
    return h / swing if swing > 0.0 else 1e9


@inner_kernel()
def angle_count(f, ratio, bent):
    """Number of angles for a `ratio` of mean film to swing, `bent` where the film meets its floor somewhere; `f` the
    film's block.  The trapezoid's error falls as exp(-N eta), cosh(eta) = ratio.
    **Source** Trefethen & Weideman (2014), SIAM Review 56, 385: trapezoidal rule of periodic analytic functions."""
    wanted = f[LOG_ERROR] / math.acosh(ratio if ratio < 1e9 else 1e9) if ratio > 1.0 else MOST_ANGLES / 8
    if bent and wanted < f[LOW_ANGLES]:
        wanted = f[LOW_ANGLES]
    for i in range(len(ANGLES)):
        if f[ANGLE_COUNTS + i] >= wanted:
            return int(f[ANGLE_COUNTS + i])
    return MOST_ANGLES
