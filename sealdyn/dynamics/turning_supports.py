"""Small motion of rings on supports of two tilt stiffnesses that turn: Hill's method.

Beside its mean such a support is C exp(2 i W t) and the conjugate, W its spin, so that a motion of frequency f drives
those of f + 2 k W: the amplitudes Q_k of exp((s + 2 i k W) t) obey

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

# Harmonics of twice the turn to either side: doubled until a share so small changes, or no more.
FEWEST, MOST, SETTLED = 2, 16, 1e-10
# Members of one family are told apart by where their amplitudes lie, in k; those of a motion that turns with the ring
# lie half a step to either side, within this.
TIE = 1e-3
# Exponents nearer than this share of the fastest are one.
SAME = 1e-7


def exponents(linear) -> tuple[np.ndarray, np.ndarray]:
    """Characteristic exponents (m,) (1/s) and shapes (n, m) of a LinearScene, each with its conjugate; a motion that
    turns with the support once more with its mirror image."""
    found = None
    for reach in _reaches():
        before, found = found, _exponents(linear, reach)
        if before is not None and len(before[0]) == len(found[0]):
            scale = max(np.max(np.abs(found[0])), 1e-300)
            if np.max(np.abs(np.sort_complex(before[0]) - np.sort_complex(found[0]))) <= SETTLED * scale:
                break
    return found


def _reaches():
    reach = FEWEST
    while reach <= MOST:
        yield reach
        reach *= 2


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
    for reach in _reaches():
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
