"""Characteristic function of one or two rings on one film: its roots, each with a bound on its error.

About the aligned equilibrium the axial motion and the tilts obey equations of their own, the tilts as complex numbers
tilt_x + i tilt_y.  With exp(s t), a ring and the film are dynamic stiffnesses, the film between the two rings:

    P(s) = a2 s^2 + a1 s + a0,    F(s) = f1 s + f0
    chi(s) = P + F  of one ring,   F (P_1 + P_2) + P_1 P_2  of two

(the determinant of the rings' equations, without the square of F that cancels in it).  Evaluated as it stands chi loses
no digits to a film that is stiffer than all else, so a slow root is right to the rounding of its own size, however fast
the squeeze of the film dies out.

The arguments of all functions broadcast: `rings` a list of one or two (a2, a1, a0), `film` (f1, f0), complex arrays.
"""

import numpy as np

# Rounding of one dynamic stiffness, as a share of the sum of its terms' sizes: of its coefficients and its evaluation.
ROUNDING = 8 * np.finfo(float).eps
MOST_CORRECTIONS = 12


def roots(rings, film, doubt=(0.0, 0.0, 0.0)) -> tuple[np.ndarray, np.ndarray]:
    """Roots s (..., m) and bounds (..., m) on their errors, both in 1/s; NaN where a row has fewer roots than others.

    `doubt`: bounds on the errors of the film's stiffness and damping, and the spin at which the film goes with the
    whirl: F is wrong by up to `doubt[0] + |s - i doubt[2]| doubt[1]`.  A bound is the residual that rounding and doubt
    may leave, over the slope of chi, which is what left and right eigenvector say of an eigenvalue's condition; near a
    double root, where that slope goes, over the curvature.
    **Source** Tisseur (2000), Linear Algebra and its Applications 309, 339-361: backward error and condition of
    polynomial eigenvalue problems; Aberth (1973), Mathematics of Computation 27, 339-344.
    """
    arrays = np.broadcast_arrays(*(x for ring in rings for x in ring), *film, *doubt)
    shape = arrays[0].shape
    flat = [np.array(a, dtype=complex).reshape(-1, 1) for a in arrays]
    whole = np.array(_product_form(flat[: 3 * len(rings)], flat[-5:-3]))[..., 0].T
    degrees = _degrees(whole)
    found = np.full((len(whole), max(degrees, default=0)), np.nan, dtype=complex)
    errors = np.full(found.shape, np.nan)
    # Rings without inertia have fewer roots: those of one degree together.
    for degree in set(degrees.tolist()) - {0}:
        rows = degrees == degree
        part = [a[rows] for a in flat]
        guess = _guesses(whole[rows, whole.shape[1] - 1 - degree :])
        found[rows, :degree], errors[rows, :degree] = _corrected(part, guess)
    return tuple(part.reshape(*shape, part.shape[1]) for part in (found, errors))


def slope(rings, film, s) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """chi (of the shape of s), its derivative by s, and bounds on the rounding in chi."""
    value, by_s, _, rounding = _evaluated([*(x for ring in rings for x in ring), *film, 0.0, 0.0, 0.0], s)
    return value, by_s, rounding


def _product_form(rings, film) -> list:
    """Coefficients of chi, highest power first."""
    f1, f0 = film
    a2, a1, a0 = rings[:3]
    if len(rings) == 3:
        return [a2, a1 + f1, a0 + f0]
    b2, b1, b0 = rings[3:]
    c2, c1, c0 = a2 + b2, a1 + b1, a0 + b0
    return [
        a2 * b2,
        f1 * c2 + (a2 * b1 + a1 * b2),
        f1 * c1 + f0 * c2 + (a2 * b0 + a1 * b1 + a0 * b2),
        f1 * c0 + f0 * c1 + (a1 * b0 + a0 * b1),
        f0 * c0 + a0 * b0,
    ]


def _degrees(whole) -> np.ndarray:
    """Degree of each row of coefficients; 0 of a row that is not finite."""
    present = (whole != 0.0) & np.isfinite(whole).all(axis=1, keepdims=True)
    return np.where(present.any(axis=1), whole.shape[1] - 1 - np.argmax(present, axis=1), 0)


def _guesses(coefficients) -> np.ndarray:
    """Roots (rows, degree) of polynomials (rows, degree + 1), good to the rounding of the largest."""
    degree = coefficients.shape[1] - 1
    monic = coefficients[:, 1:] / coefficients[:, :1]
    if degree == 1:
        return -monic
    if degree == 2:
        half = -0.5 * monic[:, 0]
        root = np.sqrt(half * half - monic[:, 1])
        root = np.where((half.conj() * root).real < 0.0, -root, root)
        large = half + root
        safe = np.where(large == 0.0, 1.0, large)
        return np.stack([large, np.where(large == 0.0, 0.0, monic[:, 1] / safe)], axis=1)
    companion = np.zeros((len(monic), degree, degree), dtype=complex)
    companion[:, 0] = -monic
    companion[:, np.arange(1, degree), np.arange(degree - 1)] = 1.0
    return np.linalg.eigvals(companion)


def _corrected(parts, s) -> tuple[np.ndarray, np.ndarray]:
    """All roots of a row together (Ehrlich-Aberth), from guesses `s` (rows, m), with their bounds."""
    own = np.eye(s.shape[1], dtype=bool)
    with np.errstate(divide="ignore", invalid="ignore", over="ignore"):
        for _ in range(MOST_CORRECTIONS):
            value, by_s, twice, left = _evaluated(parts, s)
            newton = value / by_s
            others = np.where(own, 0.0, 1.0 / (s[:, :, None] - s[:, None, :])).sum(axis=2)
            step = newton / (1.0 - newton * others)
            step = np.where(np.isfinite(step), step, 0.0)
            s = s - step
            bound = left / (np.abs(by_s) + np.sqrt(0.5 * np.abs(twice) * left))
            bound = np.where(left == 0.0, 0.0, 2.0 * bound)
            if np.all(np.abs(step) <= bound + np.finfo(float).eps * np.abs(s)):
                break
    # A root that is known to be no better than its last correction says so.
    return s, np.where(np.isfinite(bound), bound + np.abs(step.real), np.inf)


def _evaluated(parts, s):
    """chi, its first and second derivative by s, and what rounding and doubt may add to it."""
    *rings, f1, f0, off, damping_off, spin = parts
    film, size_f = f1 * s + f0, np.abs(f1 * s) + np.abs(f0)
    left_f = ROUNDING * size_f + np.abs(off) + np.abs(s - 1j * spin) * np.abs(damping_off)
    p, dp, left_p = _ring(rings[:3], s)
    if len(rings) == 3:
        return p + film, dp + f1, 2.0 * rings[0], left_p + left_f
    q, dq, left_q = _ring(rings[3:], s)
    both, d_both = p + q, dp + dq
    twice = 2.0 * (f1 * d_both + film * (rings[0] + rings[3]) + rings[0] * q + dp * dq + p * rings[3])
    left = np.abs(both) * left_f + np.abs(film + q) * left_p + np.abs(film + p) * left_q
    return film * both + p * q, f1 * both + film * d_both + dp * q + p * dq, twice, left


def _ring(ring, s):
    """P, its derivative by s, and its rounding."""
    a2, a1, a0 = ring
    whole = (a2 * s + a1) * s + a0
    return whole, 2.0 * a2 * s + a1, ROUNDING * ((np.abs(a2 * s) + np.abs(a1)) * np.abs(s) + np.abs(a0))
