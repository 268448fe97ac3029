"""Linearised scene: matrices, eigenvalues, stability, harmonic balance, and what the shaft feels of it.

Assembled in numpy from the ring and film coefficients alone, sharing no code with the compiled equations
of motion, so that the two check each other.  Unknowns: (z, tilt_x, tilt_y) of every floating ring.
"""

from dataclasses import dataclass
from functools import cached_property

import numpy as np

from ..scene.rings import RING_NAMES, ROTOR, STATOR
from ..scene.scene import SceneError
from .exponents import roots

# Rotation by 90 degrees in the tilt plane: multiplication by i of tilt_x + i tilt_y.
QUARTER_TURN = np.array([[0.0, 0.0, 0.0], [0.0, 0.0, -1.0], [0.0, 1.0, 0.0]])
# An eigenvalue whose imaginary part is below this share of it does not oscillate; how far from the same in all
# directions, as a share, the matrices may be by rounding; how well a film that stores knows its eigenvalues, likewise.
STILL, ISOTROPIC = 1e-9, 1e-8
MOTIONS = ("axial", "tilt")


@dataclass(frozen=True)
class RingNumbers:
    """One ring: sign (+1 stator, -1 rotor), whether it floats, inertia, support and spin (SI); of two tilt stiffnesses
    `tilt_stiffness` is the mean, `uneven` half the difference, and `axis` (rad) where the first one's axis stands."""

    sign: float
    floats: bool
    mass: float
    inertia: float
    polar: float
    axial_stiffness: float
    axial_damping: float
    tilt_stiffness: float
    tilt_damping: float
    spin: float
    uneven: float = 0.0
    axis: float = 0.0

    @property
    def turns_uneven(self) -> bool:
        """Whether its support is another one at every angle of the shaft."""
        return bool(self.floats and self.uneven and self.spin)

    def support_damping(self) -> np.ndarray:
        """Damping matrix (3, 3) of the support, in N s/m and N m s/rad."""
        return diagonal(self.axial_damping, self.tilt_damping)

    def support_stiffness(self) -> np.ndarray:
        """Stiffness matrix (3, 3) of the support, in N/m and N m/rad; the mean of one that turns uneven."""
        stiffness = diagonal(self.axial_stiffness, self.tilt_stiffness)
        if self.uneven and not self.turns_uneven:
            stiffness += 2.0 * self.twice_a_turn().real
        return stiffness

    def alone(self) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        """Mass, damping and stiffness (3, 3) of the ring on its support, whose damper turns with it."""
        damping = self.support_damping()
        stiffness = self.support_stiffness() - self.spin * damping @ QUARTER_TURN
        return diagonal(self.mass, self.inertia), damping - self.polar * self.spin * QUARTER_TURN, stiffness

    def support_at(self, w: float) -> np.ndarray:
        """Dynamic stiffness (3, 3) of the support at a frequency (rad/s): what a carrier that moves alone meets."""
        return self.alone()[2] + 1j * w * self.support_damping()

    def twice_a_turn(self) -> np.ndarray:
        """Complex matrix C (3, 3) of an uneven support: beside its mean it is C exp(2 i W t) and the conjugate."""
        matrix = np.zeros((3, 3), dtype=complex)
        matrix[1:, 1:] = 0.5 * self.uneven * np.exp(2j * self.axis) * np.array([[1.0, -1j], [-1j, -1.0]])
        return matrix


def diagonal(axial: float, tilt: float) -> np.ndarray:
    """Matrix (3, 3) that is isotropic in tilt."""
    return np.array([[axial, 0.0, 0.0], [0.0, tilt, 0.0], [0.0, 0.0, tilt]])


@dataclass(frozen=True)
class Harmonic:
    """One imposed harmonic, Re(amplitude exp(i frequency t)): carrier and own misalignment of one ring, force and
    moments on it (None: none), complex arrays (3,) in the order (z, tilt_x, tilt_y)."""

    frequency: float
    ring: int
    carrier: np.ndarray
    own: np.ndarray
    moment: np.ndarray | None = None


@dataclass(frozen=True)
class Mode:
    """An eigenvalue (1/s), what it moves ("axial" or "tilt"), its whirl direction, and a bound on its error (1/s)."""

    value: complex
    kind: str
    direction: str
    error: float = 0.0


@dataclass(frozen=True)
class FilmDoubt:
    """Bounds on the errors of a film's stiffness and damping: `axial` (N/m, N s/m), `tilt` (N m/rad, N m s/rad); the
    wedge in the stiffness errs with the damping, mean `spin` (rad/s) times it, or, at spin 0, is in the first bound."""

    axial: tuple[float, float] = (0.0, 0.0)
    tilt: tuple[float, float] = (0.0, 0.0)
    spin: float = 0.0


def film_matrices(tilt_stiffness, tilt_damping, axial_stiffness, axial_damping, mean_spin):
    """Stiffness and damping matrices (3, 3) of an isotropic linear film on (dz, g_x, g_y).
    **Source** M = -[K g + D (g' - i wm g)], Green (1989), eq. 2."""
    stiffness = diagonal(axial_stiffness, tilt_stiffness) - mean_spin * tilt_damping * QUARTER_TURN
    return stiffness, diagonal(axial_damping, tilt_damping)


class LinearScene:
    """Mass, damping and stiffness matrices of the floating rings and what drives them.

    `film_k`, `film_d` (3, 3) of the film's slow motion, of which the matrices are made; `film` a LinearFilm
    (condensation.py) if they hang on the frequency, which responses and eigenvalues then reckon with; `gap` (3, n):
    (dz, g_x, g_y) of the displacements; `doubt` how well the film's matrices are known; `rest` displacements (n,) of a
    tilted rest about which they are, None where they are about aligned faces.
    """

    def __init__(self, rings: list[RingNumbers], film_stiffness, film_damping, film=None, doubt=None, rest=None):
        self.rest = rest
        self.rings, self.film_k, self.film_d, self.film = rings, film_stiffness, film_damping, film
        self.doubt = doubt or FilmDoubt()
        self.floating = [k for k, ring in enumerate(rings) if ring.floats]
        self.turning = [rings[k] for k in self.floating if rings[k].turns_uneven]
        self.gap = np.hstack([rings[k].sign * np.eye(3) for k in self.floating])
        n = 3 * len(self.floating)
        self.mass, self.damping, self.stiffness = np.zeros((3, n, n))
        for a, k in enumerate(self.floating):
            ring, at = rings[k], slice(3 * a, 3 * a + 3)
            for whole, part in zip((self.mass, self.damping, self.stiffness), ring.alone(), strict=True):
                whole[at, at] += part
            for b, j in enumerate(self.floating):
                to = slice(3 * b, 3 * b + 3)
                self.damping[at, to] += ring.sign * rings[j].sign * film_damping
                self.stiffness[at, to] += ring.sign * rings[j].sign * film_stiffness

    def eigen(self) -> tuple[np.ndarray, np.ndarray]:
        """Finite eigenvalues (m,) and displacement shapes (n, m), not to be changed; massless unknowns are allowed.
        Of a film that stores those of its own modes too, as far as film_modes.py looks."""
        if self.turning:
            from .exponents import exponents

            return exponents(self)
        return self._eigen if self.film is None else self._coupled[:2]

    @cached_property
    def _eigen(self):
        n = len(self.mass)
        if np.all(np.diag(self.mass) != 0.0):
            values, vectors = np.linalg.eig(self.state_matrix())
            return values, vectors[:n]
        # Loaded only for a pencil, here and below.
        from scipy.linalg import eig

        values, vectors = eig(*self.pencil())
        finite = np.isfinite(values) & (np.abs(values) < 1e12)
        return values[finite], vectors[:n, finite]

    @cached_property
    def _coupled(self):
        from .film_modes import coupled_modes

        return coupled_modes(self, self.reach)

    @cached_property
    def reach(self) -> float:
        """Largest size (1/s) of an eigenvalue that `eigen` looks for."""
        if self.film is None:
            return np.inf
        from .film_modes import reach_of

        return reach_of(self)

    def at_frequency(self, omega: float) -> "LinearScene":
        """The scene with the film's stiffness and damping at one frequency (rad/s), whatever moves."""
        if self.film is None:
            return self
        (k, d), (slow_k, slow_d) = self.film.matrices(omega), self.film.slow
        return LinearScene(self.rings, self.film_k + (k - slow_k), self.film_d + (d - slow_d))

    def pencil(self) -> tuple[np.ndarray, ...]:
        """Matrices (m, m) of `left y = p right y`, y the displacements, the rates and what stands for a film that
        stores; of such a film also (m, N) `right` and (N, m) y on its unknowns, the same ones at any speed."""
        self._constant("pencil")
        n = len(self.mass)
        if self.film is None:
            left = np.block([[np.zeros((n, n)), np.eye(n)], [-self.stiffness, -self.damping]])
            return left, np.block([[np.eye(n), np.zeros((n, n))], [np.zeros((n, n)), self.mass]])
        from scipy.linalg import block_diag

        reduced = self._coupled[2]
        left, right, rows, columns = reduced.pencil(self)
        stored, basis, turned = reduced.stored_by_unknowns(), reduced.basis, self.film.combinations
        if turned is not None:
            stored, basis = stored @ turned.T, turned @ basis
        whole, lift = block_diag(np.eye(n), self.mass, stored), block_diag(np.eye(2 * n), basis)
        rows = rows[:, None]
        return rows * left * columns, rows * right * columns, rows * whole, lift * columns

    def modes(self) -> list[Mode]:
        """Modes with non-negative frequency, least damped first."""
        return list(self._modes)

    @cached_property
    def _modes(self):
        motions = self.motions()
        if motions is None:
            return sorted(self._modes_of_matrices(), key=lambda mode: -mode.value.real)
        found = []
        for kind, values, errors in zip(MOTIONS, *(part.tolist() for part in roots(*motions)), strict=True):
            for value, error in zip(values, errors, strict=True):
                turning = abs(value.imag) > STILL * abs(value)
                # The axial roots are those of a real polynomial: each that swings has its conjugate.
                if value != value or (kind == "axial" and turning and value.imag < 0.0):
                    continue
                direction = "none"
                if turning:
                    direction = "axial" if kind == "axial" else "forward" if value.imag > 0.0 else "backward"
                found.append(Mode(complex(value.real, abs(value.imag) if turning else 0.0), kind, direction, error))
        return sorted(found, key=lambda mode: -mode.value.real)

    def motions(self) -> tuple | None:
        """Arguments of characteristic.roots, each of shape (2,): for the axial motion, and for the tilts as
        tilt_x + i tilt_y; None where they hang together, the film is not the same in all directions, or it stores."""
        uneven = any(self.rings[k].uneven for k in self.floating)
        if uneven or self.film is not None or not (_isotropic(self.film_k) and _isotropic(self.film_d)):
            return None
        k, d, doubt, rings = self.film_k, self.film_d, self.doubt, []
        for r in (self.rings[i] for i in self.floating):
            tilt = r.inertia, r.tilt_damping - 1j * r.polar * r.spin, r.tilt_stiffness - 1j * r.spin * r.tilt_damping
            rings.append(tuple(np.array([(r.mass, r.axial_damping, r.axial_stiffness), tilt]).T))
        film_d, film_k = (0.5 * (m[1, 1] + m[2, 2]) - 0.5j * (m[1, 2] - m[2, 1]) for m in (d, k))
        film = np.array([(d[0, 0], k[0, 0]), (film_d, film_k)]).T
        return rings, tuple(film), tuple(np.array([(*doubt.axial, 0.0), (*doubt.tilt, doubt.spin)]).T)

    def _modes_of_matrices(self) -> list[Mode]:
        """Modes with non-negative frequency from the eigenvectors of all unknowns together."""
        values, shapes = self.eigen()
        axial, x, y = shapes[0::3], shapes[1::3], shapes[2::3]
        parts = shapes, axial, x + 1j * y, x - 1j * y
        sizes = [np.sqrt(np.sum(np.abs(part) ** 2, axis=0)).tolist() for part in parts]
        errors = self._errors(values).tolist()
        found = []
        for value, error, whole, along, forward, backward in zip(values.tolist(), errors, *sizes, strict=True):
            if value.imag < -STILL * abs(value):
                continue
            # About the aligned film axial and angular motion decouple: a shape is one or the other.
            kind = "axial" if along > 0.02 * whole else "tilt"
            if value.imag <= STILL * abs(value):
                direction = "none"
            elif kind == "axial":
                direction = "axial"
            else:
                direction = "forward" if forward > backward else "backward"
            found.append(Mode(complex(value), kind, direction, error))
        return found

    def _errors(self, values) -> np.ndarray:
        """Bounds (m,) on the errors of `eigen`'s values (m,) (1/s): rounding of the matrix as a whole, times how much
        each eigenvalue minds (backward error times condition number); of a film that stores, or supports that turn
        uneven, its answers' own.
        **Source** Stewart & Sun (1990), Matrix Perturbation Theory, IV.2."""
        if self.film is not None or self.turning:
            from .film_modes import errors_of

            return errors_of(values)
        from scipy.linalg import eig

        from .film_modes import even

        left, right = self.pencil()
        rows, columns = even(np.abs(left) + np.abs(right))
        left, right = (rows[:, None] * matrix * columns for matrix in (left, right))
        own, from_left, vectors = eig(left, right, left=True, right=True)
        minds = np.linalg.norm(from_left, axis=0) * np.linalg.norm(vectors, axis=0)
        minds = minds / np.maximum(np.abs(np.einsum("nm,nm->m", from_left.conj(), right @ vectors)), 1e-300)
        # Each value is the nearest one's, of those that are finite.
        nearest = np.argmin(np.abs(np.where(np.isfinite(own), own, np.inf)[None, :] - values[:, None]), axis=1)
        backward = len(left) * np.finfo(float).eps * (np.linalg.norm(left) + np.abs(values) * np.linalg.norm(right))
        return backward * minds[nearest] + np.abs(own[nearest] - values)

    def state_matrix(self, places=None) -> np.ndarray:
        """First-order matrix (2n, 2n) on (displacements, rates), of the displacements at these `places` alone if they
        are given.  Raises ValueError for a film that stores, whose state is more, and if a mass is zero."""
        self._constant("state matrix")
        if self.film is not None:
            raise ValueError("a film that stores has more to its state than displacements and rates")
        places = np.arange(len(self.mass)) if places is None else np.asarray(places)
        kept = np.ix_(places, places)
        mass = np.diag(self.mass)[places]
        if not np.all(mass):
            raise ValueError("a mass is zero")
        n, inverse = len(mass), 1.0 / mass[:, None]
        matrix = np.zeros((2 * n, 2 * n))
        matrix[:n, n:] = np.eye(n)
        matrix[n:, :n], matrix[n:, n:] = -inverse * self.stiffness[kept], -inverse * self.damping[kept]
        return matrix

    def response(self, harmonic: Harmonic) -> np.ndarray:
        """Complex displacement amplitudes (n,) answering one imposed harmonic.  Raises SceneError where supports turn
        uneven: of these ask `answers`."""
        self._constant("response at one frequency")
        at = self.at_frequency(harmonic.frequency)
        return np.linalg.solve(at.dynamic(harmonic.frequency), at.load(harmonic))

    def answers(self, harmonics) -> list[tuple[Harmonic, np.ndarray]]:
        """Each imposed harmonic with its response (n,); where supports turn uneven also the frequencies that they add,
        as harmonics without a cause."""
        if self.turning:
            from .exponents import sidebands

            found, none = [], np.zeros(3, dtype=complex)
            for harmonic in harmonics:
                (_, own), *beside = sidebands(self, harmonic)
                found += [(harmonic, own), *((Harmonic(w, harmonic.ring, none, none), q) for w, q in beside)]
            return found
        return [(harmonic, self.response(harmonic)) for harmonic in harmonics]

    def _constant(self, what: str) -> None:
        if self.turning:
            key = f"{RING_NAMES[self.turning[0].sign < 0.0]}.support.tilt_stiffness"
            raise SceneError(key, f"two that turn with their ring, of which there is no {what}", "one")

    def dynamic(self, w: float) -> np.ndarray:
        """Dynamic stiffness (n, n) at a frequency (rad/s)."""
        return self.stiffness + 1j * w * self.damping - w * w * self.mass

    def load(self, harmonic: Harmonic) -> np.ndarray:
        """Complex forces and moments (n,) of one imposed harmonic on rings at rest."""
        w, force = harmonic.frequency, np.zeros(len(self.mass), dtype=complex)
        ring = self.rings[harmonic.ring]
        if ring.floats:
            at = 3 * self.floating.index(harmonic.ring)
            force[at : at + 3] = ring.support_at(w) @ harmonic.carrier + ring.support_stiffness() @ harmonic.own
            if harmonic.moment is not None:
                force[at : at + 3] += harmonic.moment
        else:
            film = self.film_k + 1j * w * self.film_d
            for a, k in enumerate(self.floating):
                force[3 * a : 3 * a + 3] = -self.rings[k].sign * ring.sign * film @ harmonic.carrier
        return force

    def relative(self, harmonic: Harmonic, answer: np.ndarray) -> np.ndarray:
        """Complex amplitude (3,) of (dz, g_x, g_y), stator minus rotor, for a response."""
        total = np.zeros(3, dtype=complex)
        for k, ring in enumerate(self.rings):
            if ring.floats:
                a = 3 * self.floating.index(k)
                total += ring.sign * answer[a : a + 3]
            elif k == harmonic.ring:
                total += ring.sign * harmonic.carrier
        return total


def _isotropic(matrix) -> bool:
    """Whether a matrix (3, 3) on (dz, g_x, g_y) is the same in all directions and leaves dz alone."""
    tilts = matrix[1:, 1:]
    odd = abs(tilts[0, 0] - tilts[1, 1]) + abs(tilts[0, 1] + tilts[1, 0])
    across = np.max(np.abs(matrix[0, 1:] * matrix[1:, 0]))
    return odd <= ISOTROPIC * np.max(np.abs(tilts)) and across <= ISOTROPIC**2 * abs(matrix[0, 0] * tilts[0, 0])


def growth(modes: list[Mode]) -> float:
    """Growth rate (1/s) of the least damped of some modes; 0 where their verdict is neutral, NaN of none."""
    largest = max((mode.value.real for mode in modes), default=np.nan)
    return 0.0 if modes and verdict(modes) == "neutral" else largest


def uncertainty(modes: list[Mode]) -> float:
    """By how much (1/s) the growth rate of the least damped of some modes may be wrong, another one being it among
    what is possible; NaN of none."""
    rate = max((mode.value.real for mode in modes), default=np.nan)
    most, least = (max((m.value.real + s * m.error for m in modes), default=np.nan) for s in (1.0, -1.0))
    return max(most - rate, rate - least)


def verdict(modes: list[Mode]) -> str:
    """stable or unstable, from all modes; neutral where the bound on the error of one that decides contains zero.  A
    scene without any mode (massless, undamped) just stands: stable."""
    if any(mode.value.real - mode.error > 0.0 for mode in modes):
        return "unstable"
    return "stable" if all(mode.value.real + mode.error < 0.0 for mode in modes) else "neutral"


def at_shaft(linear: LinearScene, frequency: float) -> np.ndarray:
    """Dynamic stiffness (3, 3), complex, at a frequency (rad/s): force (N) and moments (N m) per displacement (m) and
    tilts (rad) of the shaft.  Raises ValueError for a support that turns and is not the same about all axes."""
    if linear.turning:
        raise ValueError("a support that turns with two tilt stiffnesses: no one stiffness at the shaft")
    at = linear.at_frequency(frequency)
    film = at.film_k + 1j * frequency * at.film_d
    stator, rotor = linear.rings[STATOR], linear.rings[ROTOR]
    if stator.floats:
        film = film - film @ np.linalg.solve(_alone(stator, frequency) + film, film)
    if not rotor.floats:
        return film
    support = rotor.support_at(frequency)
    return support - support @ np.linalg.solve(_alone(rotor, frequency) + film, support)


def _alone(ring: RingNumbers, w: float) -> np.ndarray:
    mass, damping, stiffness = ring.alone()
    return stiffness + 1j * w * damping - w**2 * mass
