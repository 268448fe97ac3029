"""Shaft speeds at which a whirl neither grows nor decays, all of them, of rings on a film whose matrices are linear in
the speed: no range is searched.

On the imaginary axis, s = i v, the characteristic function of the tilts (characteristic.py) is a polynomial in the
whirl's frequency v and the shaft speed w, complex, so that two real ones vanish together.  Of one ring the imaginary
part, the damping's, makes v linear in w, as in the formulas of Green, and the real one a quadratic.  Of two rings both
are quadratics in w; their resultant is a polynomial in v, and Newton's method mends what forming it has cost.
**Source** derived here; one ring with its stator at rest: closed_form/stability.py.
"""

from dataclasses import dataclass

import numpy as np

from .characteristic import roots, slope

# A pair that Newton's method does not hold to this many times the rounding of chi is none; speeds nearer one another
# than this share are one.
HELD, SAME = 100.0, 1e-9
CORRECTIONS = 8
# How far from real, as a share, an eigenvalue that stands for a speed may be by rounding: Newton's method decides.
LOOSE = 0.1
# How far from the axis, as a share, a root may be there; shifts of the eigenproblem, in natural frequencies: each sees
# the speeds around it best.
NEAR, SHIFTS = 0.3, (0.0, 10j)


@dataclass(frozen=True)
class Whirl:
    """The tilts of one or two rings on a film, over the shaft speed (SI): `rings` a list of (inertia, polar, tilt
    stiffness, tilt damping, whether it spins with the shaft), `stiffness` and `damping` of the film with their bounds
    `doubt`, `stator_speed`."""

    rings: list[tuple[float, float, float, float, bool]]
    stiffness: float
    damping: float
    doubt: tuple[float, float]
    stator_speed: float

    def at(self, speeds) -> tuple[list, tuple, tuple]:
        """Arguments of characteristic.roots at shaft speeds (m,) (rad/s)."""
        w = np.asarray(speeds, dtype=float)
        rings = []
        for inertia, polar, k, d, turning in self.rings:
            spin = w if turning else self.stator_speed
            rings.append((inertia, d - 1j * polar * spin, k - 1j * d * spin))
        mean = 0.5 * (w + self.stator_speed)
        return rings, (self.damping, self.stiffness - 1j * self.damping * mean), (*self.doubt, mean)

    def mirrored(self) -> "Whirl":
        """The same seal seen from the other end of the shaft: all speeds have the other sign."""
        return Whirl(self.rings, self.stiffness, self.damping, self.doubt, -self.stator_speed)


def neutral_speeds(whirl: Whirl) -> np.ndarray:
    """Shaft speeds (rad/s) above zero, rising, at which some root of the tilts is imaginary."""
    with np.errstate(all="ignore"):
        v, w = _of_one(whirl) if len(whirl.rings) == 1 else _of_two(whirl)
        v, w = mended(whirl, v, w, 1j, 0.0) if len(w) else (v, w)
    return _apart(w)


def _apart(w) -> np.ndarray:
    """Positive finite numbers, rising, without those that are the same."""
    w = np.sort(w[np.isfinite(w) & (w > 0.0)])
    return w[np.diff(w, prepend=-1.0) > SAME * w]


def _of_one(whirl):
    """Frequencies and speeds of one ring."""
    (inertia, polar, k, d, turning), still = whirl.rings[0], whirl.stator_speed
    stiffness, damping = k + whirl.stiffness, d + whirl.damping
    if damping == 0.0 or inertia == 0.0:
        return np.empty((2, 0))
    # Damping: D_s (v - W) + D_f (v - wm) = 0, so v = a + b w; stiffness: -I v^2 + J W v + K = 0.
    b = (0.5 * whirl.damping + (d if turning else 0.0)) / damping
    a = (0.5 * whirl.damping + (0.0 if turning else d)) * still / damping
    spin = np.array([1.0, 0.0]) if turning else np.array([0.0, still])
    line = np.array([b, a])
    w = np.roots(-inertia * np.convolve(line, line) + polar * np.convolve(spin, line) + [0.0, 0.0, stiffness])
    w = w[np.abs(w.imag) <= 1e-6 * np.abs(w)].real
    return a + b * w, w


def _of_two(whirl):
    """Frequencies and speeds of two rings, as good as the eigenvalues of the sum of Kronecker."""
    still, slope_w = _state_matrices(whirl)
    if still is None:
        return np.empty((2, 0))
    n = len(still)
    both = [np.kron(a, np.eye(n)) + np.kron(np.eye(n), a.conj()) for a in (still, slope_w)]
    w = [np.empty(0)]
    for shift in _unit(whirl) * np.array(SHIFTS):
        try:
            found = np.linalg.eigvals(-np.linalg.solve(both[0] + shift * both[1], both[1]))
        except np.linalg.LinAlgError:
            # Neutral at the shift itself.
            continue
        w.append(shift + 1.0 / found[found != 0.0])
    w = np.concatenate(w)
    w = _apart(w[np.abs(w.imag) <= LOOSE * np.abs(w)].real)
    if not len(w):
        return np.empty((2, 0))
    # Two roots that mirror one another across the axis pass here too, but none of them is near it.
    s, _ = roots(*whirl.at(w))
    nearest = np.argsort(np.where(np.isnan(s), np.inf, np.abs(s.real)), axis=1)[:, :2]
    s = np.take_along_axis(s, nearest, axis=1)
    near = np.abs(s.real) <= NEAR * np.abs(s)
    return s.imag[near], np.broadcast_to(w[:, None], s.shape)[near]


def _state_matrices(whirl):
    """Matrices (n, n) of the state's rate at rest and per shaft speed, the state the tilts and the rates of rings with
    inertia; None, None where a ring has neither inertia nor damping."""
    inertia, polar, k, d = np.array([ring[:4] for ring in whirl.rings]).T
    turning = np.array([ring[4] for ring in whirl.rings])
    apart = np.array([[1.0, -1.0], [-1.0, 1.0]])
    damping = np.diag(d) + whirl.damping * apart
    heavy, light = np.flatnonzero(inertia), np.flatnonzero(inertia == 0.0)
    if np.linalg.matrix_rank(damping[np.ix_(light, light)]) < len(light):
        return None, None
    found = []
    # Spins and their half sum at rest, then what a unit of speed adds; stiffness and damping go along.
    for spins, mean, share in ((np.where(turning, 0.0, whirl.stator_speed), 0.5 * whirl.stator_speed, 1.0),
                               (np.where(turning, 1.0, 0.0), 0.5, 0.0)):  # fmt: skip
        stiff = share * (np.diag(k) + whirl.stiffness * apart) - 1j * (
            np.diag(d * spins) + whirl.damping * mean * apart
        )
        damp = share * damping - 1j * np.diag(polar * spins)
        rates = np.zeros((2, 2 + len(heavy)), dtype=complex)
        rates[heavy, 2 + np.arange(len(heavy))] = share
        if len(light):
            pushed = stiff[light] @ np.eye(2, 2 + len(heavy)) + share * damping[np.ix_(light, heavy)] @ rates[heavy]
            rates[light] = -np.linalg.solve(damping[np.ix_(light, light)], pushed)
        left = np.zeros((2 + len(heavy), 2 + len(heavy)), dtype=complex)
        left[:2] = rates
        left[2:, :2] = -stiff[heavy]
        left[2:, 2:] -= damp[np.ix_(heavy, heavy)]
        left[2:] -= damping[np.ix_(heavy, light)] @ rates[light]
        left[2:] /= inertia[heavy, None]
        found.append(left)
    return tuple(found)


def _unit(whirl) -> float:
    """Frequency (rad/s) of the rings on their springs and the film."""
    inertia = sum(ring[0] for ring in whirl.rings)
    stiffness = sum(ring[2] for ring in whirl.rings) + abs(whirl.stiffness)
    return float(np.sqrt(stiffness / inertia)) if inertia > 0.0 and stiffness > 0.0 else 1.0


def mended(whirl, x, w, by_x, by_w):
    """Newton's method for chi(by_x x + by_w w; w) = 0 on pairs (m,) of a real number (1/s) and a shaft speed (rad/s):
    those that it holds.  A neutral whirl has s = i x; one that goes round with the shaft has s = x + i w."""
    x, w = np.asarray(x, dtype=float), np.asarray(w, dtype=float)
    for _ in range(CORRECTIONS):
        value, slope_x, slope_w, rounding = _along(whirl, x, w, by_x, by_w)
        held = np.abs(value) <= HELD * rounding
        det = slope_x.real * slope_w.imag - slope_x.imag * slope_w.real
        dx = (value.real * slope_w.imag - value.imag * slope_w.real) / det
        dw = (slope_x.real * value.imag - slope_x.imag * value.real) / det
        dx, dw = (np.where(np.isfinite(step), step, 0.0) for step in (dx, dw))
        # A step may not throw a pair out of its neighbourhood.
        size = np.maximum(np.abs(x), np.abs(w))
        share = np.minimum(1.0, 0.5 * size / np.maximum(np.hypot(dx, dw), 1e-300))
        x, w = x - share * dx, w - share * dw
        if np.all(np.abs(value) <= rounding):
            break
    return x[held], w[held]


def _along(whirl, x, w, by_x, by_w):
    """chi(s; w) at s = by_x x + by_w w, its derivatives by x and w, and its rounding."""
    rings, film, _ = whirl.at(w)
    s = by_x * x + by_w * w
    value, by_s, rounding = slope(rings, film, s)
    rings_w = [-1j * (polar * s + d) if turning else 0.0 for _, polar, _, d, turning in whirl.rings]
    film_w = -0.5j * whirl.damping
    if len(rings) == 1:
        at_rest = rings_w[0] + film_w
    else:
        p, q = ((a2 * s + a1) * s + a0 for a2, a1, a0 in rings)
        whole = film[0] * s + film[1]
        at_rest = film_w * (p + q) + whole * (rings_w[0] + rings_w[1]) + rings_w[0] * q + p * rings_w[1]
    return value, by_x * by_s, by_w * by_s + at_rest, rounding
