"""Shaft speeds that matter to the whirl: where it loses its damping, and where it turns with the shaft.

Both are found in the whirl's eigenvalues over the speed, given as a function `values(speeds)` of speeds (m,) (rad/s):
eigenvalues (m, k) p (1/s) of the tilt tilt_x + i tilt_y of the floating rings as exp(p t), imaginary part positive of a
whirl that goes with the shaft, and bounds (m, k) on their errors (1/s); NaN where there are fewer than k.
"""

from dataclasses import dataclass
from itertools import pairwise

import numpy as np

from ..numerics.piecewise_linear import crossing
from ..scene.scene import SceneError
from .exponents import roots, slope
from .modes import STILL

# --- Neutral speeds ------------------------------------------------------------------------------------

# Shaft speeds at which a whirl neither grows nor decays, all of them, of rings on a film whose matrices are linear in
# the speed: no range is searched.
#
# On the imaginary axis, s = i v, the characteristic function of the tilts (exponents.py) is a polynomial in the
# whirl's frequency v and the shaft speed w, complex, so that two real ones vanish together. Of one ring the imaginary
# part, the damping's, makes v linear in w, as in the formulas of Green, and the real one a quadratic. Of two rings
# both are quadratics in w; their resultant is a polynomial in v, and Newton's method mends what forming it has cost.
# **Source** derived here; one ring with its stator at rest: closed_form/tilting_ring.py.

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


# How near, as a share, a known neutral speed is looked at from both sides.
BESIDE = 1e-6
# Speeds that are looked at, in the logarithm to 10, and by how much of a step they are beside round ones.
PER_DECADE, UNEVEN = 30, 0.37
# Halvings of a step of the speed over which a mode begins or ceases to go forward: it may hide a resonance of another.
HALVINGS = 8


def one_by_one(at_speed, direction: float = 1.0):
    """The function `values` of any scene, from an eigenproblem at each speed: `at_speed(w)` gives its LinearScene, or
    raises SceneError where there is none, which is a row without a mode; `direction` -1 of a shaft that turns the other
    way, at speeds -w."""

    def tilts(w):
        try:
            return [mode for mode in at_speed(direction * w).modes() if mode.kind == "tilt"]
        except SceneError:
            return []

    def values(speeds):
        rows = [tilts(w) for w in speeds]
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


def spread(low: float, high: float, points: int | None = None) -> np.ndarray:
    """Speeds from `low` to `high` (rad/s) in even ratios: so many `points`, or both ends and those of PER_DECADE to the
    decade between, which all ranges share: of a scene whose every speed is a search of its own none is made twice."""
    if points is not None:
        return np.geomspace(low, high, points)
    # None is round, as speeds that are sought may be.
    first, last = PER_DECADE * np.log10([low, high]) - UNEVEN
    between = np.arange(np.floor(first) + 1, np.ceil(last)) + UNEVEN
    return np.array([low, *10.0 ** (between / PER_DECADE), high])


def thresholds(values, low: float, high: float, points: int | None = None, neutral=()) -> list[float]:
    """Shaft speeds (rad/s), rising, at which the largest growth rate of the tilt modes changes its sign: in [low, high]
    those that the speeds of `spread` tell apart, and any of the speeds `neutral` at which some mode is known to be
    neutral.  A growth rate whose bound contains zero has no sign."""
    neutral = np.asarray(neutral, dtype=float)
    speeds = np.concatenate([spread(low, high, points), neutral * (1.0 - BESIDE), neutral * (1.0 + BESIDE)])
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


def _signs(found, errors) -> np.ndarray:
    """Signs (m,) of the largest growth rate of each row, 0 where its bound contains zero, or without a mode."""
    grows = _largest(found.real - errors) > 0.0
    dies = _largest(found.real + errors) < 0.0
    return np.where(np.isnan(found).all(axis=1), 0, grows * 1 - dies * 1)


def _largest(rows) -> np.ndarray:
    """Largest number (m,) of each row, minus infinity of a row of NaN."""
    return np.max(np.where(np.isnan(rows), -np.inf, rows), axis=1, initial=-np.inf)


def resonance_speeds(values, low: float, high: float, whirl: Whirl | None = None) -> list[float]:
    """Shaft speeds (rad/s) where a tilt mode's frequency equals the shaft speed (once per turn); `whirl` of a scene
    whose matrices are linear in the speed, for which Newton's method mends what the points have bracketed."""

    def distances(speeds):
        # Forward modes only: an unbalance-like forcing turns with the shaft.
        found, _ = values(speeds)
        away = np.where(found.imag > STILL * np.abs(found), found.imag - np.asarray(speeds)[:, None], np.nan)
        order = np.argsort(away, axis=1)
        return np.take_along_axis(away, order, axis=1), np.take_along_axis(found.real, order, axis=1)

    def distance(speed, mode):
        # Where no film holds, and of fewer modes, there is none.
        (each,), _ = distances([speed])
        return each[mode] if mode < len(each) else np.nan

    speeds = spread(low, high)
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
            at = crossing(lambda w, mode=mode: distance(w, mode), a, b, 1e-13)
        # NaN: the mode stops oscillating inside the bracket, or no film holds there, no crossing.
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
