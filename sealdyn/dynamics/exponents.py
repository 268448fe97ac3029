"""Characteristic exponents of small motion: as roots of the characteristic function, and by Hill's method where
supports of two tilt stiffnesses turn.

About the aligned equilibrium the axial motion and the tilts obey equations of their own, the tilts as complex numbers
tilt_x + i tilt_y.  With exp(s t), a ring and the film are dynamic stiffnesses, the film between the two rings:

    P(s) = a2 s^2 + a1 s + a0,    F(s) = f1 s + f0
    chi(s) = P + F  of one ring,   F (P_1 + P_2) + P_1 P_2  of two

(the determinant of the rings' equations, without the square of F that cancels in it).  Evaluated as it stands chi loses
no digits to a film that is stiffer than all else, so a slow root is right to the rounding of its own size, however fast
the squeeze of the film dies out.  The arguments of `roots` and `slope` broadcast: `rings` a list of one or two
(a2, a1, a0), `film` (f1, f0), complex arrays.

Beside its mean a turning support is C exp(2 i W t) and the conjugate, W its spin, so that a motion of frequency f
drives those of f + 2 k W: the amplitudes Q_k of exp((s + 2 i k W) t) obey

    [M s_k^2 + D s_k + K] Q_k + C Q_{k-1} + conj(C) Q_{k+1} = load_k,   s_k = s + 2 i k W

cut at a |k| beyond which nothing changes.  s are the characteristic exponents (Floquet), each family s + 2 i m W
standing for one motion: that member is taken whose amplitudes lie about k = 0, so that its imaginary part is the
frequency seen from outside.  Where nothing but one ring is uneven, the frame that turns with it knows constants alone,
pairs of k are all there is, and there the exponents are roots of P(s) conj(P)(s) = dK^2, P that of the ring in that
frame: a motion locked to the shaft grows where dK > |P(0)|.
**Source** Hill (1886), Acta Mathematica 8; Genta (2005), Dynamics of Rotating Systems, chapter 6 (unsymmetrical
rotors); Green (1989) for the ring.
**Valid** all supports that turn uneven turn alike; a film with one stiffness and damping at any frequency.
"""

from itertools import pairwise

import numpy as np

from ..scene.scene import SceneError

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


# Harmonics of twice the turn to either side: more of them until a share so small changes.
REACHES, SETTLED = (2, 4, 8, 16), 1e-10
# Members of one family are told apart by where their amplitudes lie, in k; those of a motion that turns with the ring
# lie half a step to either side, within this.
TIE = 1e-3
# Exponents nearer than this share of the fastest are one.
SAME = 1e-7


def exponents(linear) -> tuple[np.ndarray, np.ndarray]:
    """Characteristic exponents (m,) (1/s) and shapes (n, m) of a LinearScene, each with its conjugate; a motion that
    turns with the support once more with its mirror image."""
    found = None
    for reach in REACHES:
        before, found = found, _exponents(linear, reach)
        if before is not None and len(before[0]) == len(found[0]):
            scale = max(np.max(np.abs(found[0])), 1e-300)
            if np.max(np.abs(np.sort_complex(before[0]) - np.sort_complex(found[0]))) <= SETTLED * scale:
                break
    return found


def _exponents(linear, reach: int):
    from scipy.linalg import eig

    n, orders, spin = len(linear.mass), np.arange(-reach, reach + 1), _spin(linear)
    size, k = n * len(orders), _coupling(linear, reach)
    d, mass = (np.kron(np.eye(len(orders)), part).astype(complex) for part in (linear.damping, linear.mass))
    shift = np.repeat(2j * orders * spin, n)
    # Unknowns Q_k and their rates s_k Q_k.
    left = np.block([[-np.diag(shift), np.eye(size)], [-k, -d - mass * shift[None, :]]])
    right = np.block([[np.eye(size), np.zeros((size, size))], [np.zeros((size, size)), mass]])
    if np.all(np.diag(linear.mass)):
        # Half the time of the pencil, of 60 rows and more.
        left[size:] /= np.tile(np.diag(linear.mass), len(orders))[:, None]
        values, vectors = np.linalg.eig(left)
    else:
        values, vectors = eig(left, right)
    finite = np.isfinite(values) & (np.abs(values) < 1e12)
    values, parts = values[finite], vectors[:size, finite].reshape(len(orders), n, -1)
    weights = np.sum(np.abs(parts) ** 2, axis=1)
    centre = (orders @ weights) / np.sum(weights, axis=0)
    kept = np.flatnonzero(np.abs(centre) <= 0.5 + TIE)
    values, shapes = values[kept], _main(parts[:, :, kept])
    return _apart(values, shapes)


def _main(parts) -> np.ndarray:
    """Shapes (n, m) of the largest of the amplitudes (orders, n, m), of equal ones that which turns forward."""
    x, y = parts[:, 1::3], parts[:, 2::3]
    sizes = np.sum(np.abs(parts) ** 2, axis=1) + 1e-6 * np.sum(np.abs(x + 1j * y) ** 2, axis=1)
    return np.take_along_axis(parts, np.argmax(sizes, axis=0)[None, None, :], axis=0)[0]


def _apart(values, shapes):
    """The exponents without what is there twice."""
    order, near = np.lexsort((values.imag, values.real)), SAME * max(np.max(np.abs(values), initial=0.0), 1e-300)
    kept = []
    for i in order:
        twin = [j for j in kept if abs(values[i] - values[j]) <= near]
        # Two motions may share an exponent: their shapes differ.
        if not any(_alike(shapes[:, i], shapes[:, j]) for j in twin):
            kept.append(i)
    return values[kept], shapes[:, kept]


def _alike(a, b) -> bool:
    return abs(np.vdot(a, b)) > (1.0 - 1e-6) * np.linalg.norm(a) * np.linalg.norm(b)


def _spin(linear) -> float:
    spins = {ring.spin for ring in linear.turning}
    if len(spins) > 1:
        raise SceneError("stator.support.tilt_stiffness", "two supports of two, turning at two speeds", "one of them")
    return spins.pop()


def _coupling(linear, reach: int) -> np.ndarray:
    """Stiffness (size, size) of all amplitudes, k from -reach on."""
    n, count = len(linear.mass), 2 * reach + 1
    k = np.kron(np.eye(count), linear.stiffness).astype(complex)
    uneven = _twice(linear)
    for low, high in pairwise(range(count)):
        k[high * n : high * n + n, low * n : low * n + n] += uneven
        k[low * n : low * n + n, high * n : high * n + n] += uneven.conj()
    return k


def _twice(linear) -> np.ndarray:
    """What turns twice a turn (n, n), of all rings."""
    uneven = np.zeros_like(linear.mass, dtype=complex)
    for a, k in enumerate(linear.floating):
        if linear.rings[k].turns_uneven:
            uneven[3 * a : 3 * a + 3, 3 * a : 3 * a + 3] = linear.rings[k].twice_a_turn()
    return uneven


def sidebands(linear, harmonic) -> list[tuple[float, np.ndarray]]:
    """What answers one harmonic: frequencies f + 2 k W (rad/s), its own first, and complex amplitudes (n,) of each."""
    found = None
    for reach in REACHES:
        before, found = found, _sidebands(linear, harmonic, reach)
        if before is not None:
            middle = found[reach - reach // 2 : reach + reach // 2 + 1]
            if np.max(np.abs(middle - before)) <= SETTLED * max(np.max(np.abs(found)), 1e-300):
                break
    spin, reach = _spin(linear), len(found) // 2
    orders = [0, *(k for k in range(-reach, reach + 1) if k and np.any(found[reach + k]))]
    return [(harmonic.frequency + 2 * k * spin, found[reach + k]) for k in orders]


def _sidebands(linear, harmonic, reach: int) -> np.ndarray:
    n, spin = len(linear.mass), _spin(linear)
    matrix, load = _coupling(linear, reach), np.zeros((2 * reach + 1, n), dtype=complex)
    for k in range(-reach, reach + 1):
        at, w = slice((reach + k) * n, (reach + k + 1) * n), harmonic.frequency + 2 * k * spin
        matrix[at, at] = linear.dynamic(w)
    load[reach] = linear.load(harmonic)
    ring = linear.rings[harmonic.ring]
    if ring.turns_uneven:
        at = 3 * linear.floating.index(harmonic.ring)
        pushed = harmonic.carrier + harmonic.own
        load[reach + 1, at : at + 3] += ring.twice_a_turn() @ pushed
        load[reach - 1, at : at + 3] += ring.twice_a_turn().conj() @ pushed
    return np.linalg.solve(matrix, load.ravel()).reshape(-1, n)
