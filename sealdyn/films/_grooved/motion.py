"""Small motion of faces about the steady aligned film, in the frame of the pattern and in the inertial one.

Small dz, g' ~ e^{st} in the pattern's frame (g = g' e^{i psi_p} the tilt of the stator less the rotor's) change the
film by dz + r Im(conj(g') e^{i phi}).  The harmonic m of the gap is answered in m + k count only: of 3 pitches and more

    F = -Z_z(s) dz,    M' = -Z'(s) g',    M' = -i int p r^2 e^{i phi} dr dphi

and axial and tilting motion do not couple.  One pitch is enough: axial motion repeats on it, tilt comes back with the
Bloch factor e^{-i pitch}, for the part of the film that goes with g' is (i/2) r e^{-i phi} g'.  In the inertial frame
Z(s) = Z'(s - i W_p), W_p the speed of the patterned face, and of Z(w) = Z(s = i w)

    Kxx + i w Dxx = (Z(w) + conj Z(-w))/2,    Kxy + i w Dxy = i (Z(w) - conj Z(-w))/2,    yy = xx, yx = -xy

**Source** derived here: the balances of balance.py, differentiated as they stand.  With x_i = p_i H_i held by node i,
s (H_i dp_i + p_i dH_i) + d(leaving)/dp dp + d(leaving)/dh dh = 0.  The conjugate part of the film, with g'*, has the
factor e^{+i pitch} and presses with no moment that goes around unless the count is 1 or 2.
With 1 or 2 pitches M' = -A(s) g' - B(s) g'*, of the whole circle, and with 1 axial motion and tilt couple.  In the
frame of the pattern all is constant; in the inertial one a tilt at w is answered at w by A, the mean over a turn of the
pattern, and at 2 W_p - w by B.
**Valid** amplitudes small against the film.
"""

import cmath
import math
from dataclasses import dataclass
from functools import cached_property

import numpy as np
from scipy.sparse.linalg import splu

from ...scene.patterns import EVEN
from .balance import PERMUTATION, Assembly, Steady
from .mesh import whole_circle

# (dz, g_x, g_y) to (dz, g, g*), of force and moments alike, and back.
TO_TURNS = np.array([[1.0, 0.0, 0.0], [0.0, 1.0, 1j], [0.0, 1.0, -1j]])
FROM_TURNS = np.linalg.inv(TO_TURNS)
AXIAL, TILT = "axial", "tilt"


class LinearFilm:
    """What a steady film makes of small changes `shapes` of the film thickness (nodes, n) and (triangles, n), whose
    factor from a sector to the next is `turn`; `weights` (n, nodes) of its pressures in the answers, (n, n)."""

    def __init__(self, steady: Steady, shapes, weights: np.ndarray, turn: complex = 1.0):
        film, mesh, p = steady.film, steady.film.mesh, steady.p
        self.assembly, self.free = Assembly(mesh, turn), mesh.free
        self.stiff = self.assembly.data(film.slopes(p, steady.torn))
        # A void presses with nothing.
        self.weights = (weights if steady.torn is None else np.where(steady.torn, 0.0, weights))[:, mesh.free]
        at_nodes, at_middles = (shape * moved[:, None] for shape, moved in zip(shapes, film.follows, strict=True))
        at_corners = at_nodes[mesh.corners] * self.assembly.ahead[:, :, None]
        # What a thicker film carries more, and what it holds more.
        corners, gas = mesh.corners, film.conditions.gas
        rate = 3.0 * film.viscous / film.h
        more = rate[:, None] * np.matmul(film.diffusion, film.potential(p)[corners][:, :, None])[:, :, 0]
        if film.conditions.slip:
            more += (2.0 * film.slippery / film.h)[:, None] * np.matmul(film.diffusion, p[corners][:, :, None])[:, :, 0]
        if gas:
            more -= film.carried * p[corners].mean(axis=1)[:, None]
        else:
            more += film.dragged(steady.void) / film.h[:, None]
        filled = p if gas else np.ones(len(p)) if steady.void is None else 1.0 - steady.void
        part = (mesh.area * film.r**2 / 3.0)[:, None] * filled[corners]
        self.by_film = self._gathered(mesh, more[:, :, None] * at_middles[:, None, :])
        self.by_rate = self._gathered(mesh, part[:, :, None] * at_corners)
        held = film.held if gas else np.zeros(len(p)) if steady.torn is None else np.where(steady.torn, -film.held, 0.0)
        self.held = held[mesh.free]

    def _gathered(self, mesh, leaving: np.ndarray) -> np.ndarray:
        """Sums (free nodes, n) of what leaves the corners, (triangles, 3, n), each seen from its own sector."""
        seen, nodes, size = leaving * np.conj(self.assembly.ahead)[:, :, None], mesh.corners.ravel(), len(mesh.u)
        columns = []
        for k in range(leaving.shape[2]):
            flat = seen[:, :, k].ravel()
            total = np.bincount(nodes, flat.real, size)
            columns.append(total + 1j * np.bincount(nodes, flat.imag, size) if np.iscomplexobj(flat) else total)
        return np.stack(columns, axis=1)[mesh.free]

    def __call__(self, s: complex) -> np.ndarray:
        """Answers (n, n) to motions e^{st} of unit size."""
        data = self.stiff.astype(complex)
        data[self.assembly.diagonal] += s * self.held
        factors = splu(self.assembly.matrix(data), permc_spec=PERMUTATION)
        return self.weights @ factors.solve(-(self.by_film + s * self.by_rate).astype(complex))


def axial_film(steady: Steady) -> LinearFilm:
    """Force over a sector per dz, of any count of pitches."""
    film, mesh = steady.film, steady.film.mesh
    shapes = np.ones((len(mesh.u), 1)), np.ones((len(mesh.corners), 1))
    return LinearFilm(steady, shapes, film.weights(1)[None])


@dataclass(frozen=True, eq=False)
class Motion:
    """Small motion about a steady film whose pattern turns at `frame` (rad/s); of 1 or 2 pitches the mean over a turn
    of the pattern, and `coupled` has all."""

    steady: Steady
    frame: float = 0.0

    @property
    def uneven(self) -> bool:
        """Whether tilts about different axes of the pattern are answered differently."""
        return self.steady.film.mesh.count < EVEN

    @cached_property
    def circle(self) -> LinearFilm:
        """Of the whole circle."""
        return circle_impedance(self.steady)

    def coupled(self, s: complex) -> np.ndarray:
        """Dynamic stiffness (3, 3) at s (1/s) on (dz, g', g'*) in the frame of the pattern; rows (F, M', M'*)."""
        return TO_TURNS @ self.circle(s) @ FROM_TURNS

    @cached_property
    def axial(self) -> LinearFilm:
        """Force per dz over a sector."""
        return axial_film(self.steady)

    @cached_property
    def tilt(self) -> LinearFilm:
        """int p r^2 e^{i phi} over a sector per g'."""
        film, mesh = self.steady.film, self.steady.film.mesh
        at_nodes = 0.5j * np.exp(mesh.u - 1j * mesh.phi)
        at_middles = 0.5j * film.r * np.exp(-1j * film.phi)
        shapes = at_nodes[:, None], at_middles[:, None]
        return LinearFilm(self.steady, shapes, film.weights(2, 1)[None], cmath.exp(-1j * mesh.pitch))

    def axial_impedance(self, s: complex) -> complex:
        """Z_z (N/m) at s (1/s): F = -Z_z dz, in any frame."""
        return -self.steady.film.mesh.count * complex(self.axial(s)[0, 0])

    def frame_impedance(self, s: complex) -> complex:
        """Z' (N m/rad) at s (1/s) in the frame of the pattern: M' = -Z' g'."""
        if self.uneven:
            return complex(self.coupled(s)[1, 1])
        return 1j * self.steady.film.mesh.count * complex(self.tilt(s)[0, 0])

    def tilt_impedance(self, s: complex) -> complex:
        """Z (N m/rad) at s (1/s) in the inertial frame: M = -Z g."""
        return self.frame_impedance(s - 1j * self.frame)

    def beside_impedance(self, s: complex) -> complex:
        """B (N m/rad) of a tilt e^{st} (1/s) of the inertial frame, answered at twice the pattern's speed less its own;
        0 of 3 pitches and more."""
        return complex(self.coupled(s - 1j * self.frame)[2, 1]).conjugate() if self.uneven else 0j

    def matrices(self, frequency: float) -> tuple[np.ndarray, np.ndarray]:
        """Stiffness (N/m, N m/rad) and damping (N s/m, N m s/rad), (3, 3) each, on (dz, g_x, g_y) in the inertial frame
        at a frequency (rad/s) above 0."""
        if not frequency > 0.0:
            raise ValueError(f"frequency: {frequency:g} rad/s; damping is known above 0 only")
        axial = self.axial_impedance(1j * frequency)
        ahead, behind = self.tilt_impedance(1j * frequency), self.tilt_impedance(-1j * frequency).conjugate()
        direct, cross = 0.5 * (ahead + behind), 0.5j * (ahead - behind)
        z = np.array([[axial, 0.0, 0.0], [0.0, direct, cross], [0.0, -cross, direct]])
        return z.real, z.imag / frequency


def circle_impedance(steady: Steady) -> LinearFilm:
    """Of any count of pitches, on the whole circle: -(force, M'_x, M'_y) per (dz, g'_x, g'_y) in the frame of the
    pattern, (3, 3) complex at each s.  Its cost is that of all pitches at once."""
    sector = steady.film
    mesh = whole_circle(sector.mesh)
    film = type(sector)(mesh, sector.conditions)
    void = None if steady.void is None else np.tile(steady.void, sector.mesh.count)
    circle = Steady(film, np.tile(steady.p, sector.mesh.count), steady.steps, void)
    r, phi = np.exp(mesh.u), mesh.phi
    at_nodes = np.stack([np.ones(len(r)), r * np.sin(phi), -r * np.cos(phi)], axis=1)
    at_middles = np.stack([np.ones(len(film.r)), film.r * np.sin(film.phi), -film.r * np.cos(film.phi)], axis=1)
    turned = film.weights(2, 1)
    weights = -np.stack([film.weights(1), turned.imag, -turned.real])
    return LinearFilm(circle, (at_nodes, at_middles), weights)


@dataclass(frozen=True)
class Ring:
    """A ring on its support: `mass` (kg), `transverse_inertia`, `polar_inertia` (kg m^2), axial stiffness and damping
    (N/m, N s/m), angular ones (N m/rad, N m s/rad), its own `spin` (rad/s)."""

    mass: float
    transverse_inertia: float
    axial_stiffness: float
    axial_damping: float
    angular_stiffness: float
    angular_damping: float
    polar_inertia: float = 0.0
    spin: float = 0.0


# Steps of the secant, and the relative change after which a root is found.
SECANTS, FOUND = 60, 1e-11


def root_near(law, start: complex) -> complex:
    """Zero of an analytic function near a start (1/s), by Muller's parabolas.  Raises ArithmeticError.

    **Source** Muller (1956), Math. Tables Aids Comput. 10, 208-215."""
    size = max(abs(start), 1.0)
    at = [start * (1.0 + 1e-2) + 1e-3 * size, start * (1.0 - 1e-2), complex(start)]
    value = [law(x) for x in at]
    for _ in range(SECANTS):
        d0, d1 = (value[1] - value[0]) / (at[1] - at[0]), (value[2] - value[1]) / (at[2] - at[1])
        bend = (d1 - d0) / (at[2] - at[0])
        slope = d1 + bend * (at[2] - at[1])
        root = cmath.sqrt(slope * slope - 4.0 * bend * value[2])
        step = -2.0 * value[2] / max(slope + root, slope - root, key=abs)
        at, value = [*at[1:], at[2] + step], [*value[1:], law(at[2] + step)]
        if abs(step) <= FOUND * abs(at[2]) or value[2] == 0.0:
            return at[2]
    raise ArithmeticError(f"no root is found near {start:g}")


def _joined(parts: list[complex]) -> tuple[complex, complex]:
    """Of the dynamic stiffness of one or both rings alone: their product, and what of it stands beside the film."""
    return (parts[0], 1.0) if len(parts) == 1 else (parts[0] * parts[1], parts[0] + parts[1])


def axial_support_law(ring: Ring, s: complex) -> complex:
    """m s^2 + d s + k (N/m) of a ring on its support alone."""
    return ring.mass * s * s + ring.axial_damping * s + ring.axial_stiffness


def support_law(ring: Ring, s: complex) -> complex:
    """I s^2 + (D - i J W) s + K - i W D_r (N m/rad) of a ring on its support alone that tilts e^{st} in the inertial
    frame; D_r is the damping of a support that turns with the ring, all of it where the ring spins."""
    whirl = 1j * ring.spin
    support = ring.angular_damping * (s - whirl) + ring.angular_stiffness
    return ring.transverse_inertia * s * s - whirl * ring.polar_inertia * s + support


def axial_law(motion: Motion, *rings: Ring):
    """A(s) + Z_z(s) (N/m) of an axial motion e^{st}, a function of s (1/s), A that of the ring alone; of two rings
    A B + (A + B) Z_z, which is zero where they and the film between them move by themselves."""

    def law(s: complex) -> complex:
        alone, beside = _joined([axial_support_law(ring, s) for ring in rings])
        return alone + beside * motion.axial_impedance(complex(s))

    return law


def tilt_law(motion: Motion, *rings: Ring):
    """Likewise A(s) + Z(s) (N m/rad) of a tilt e^{st} in the inertial frame."""

    def law(s: complex) -> complex:
        alone, beside = _joined([support_law(ring, s) for ring in rings])
        return alone + beside * motion.tilt_impedance(complex(s))

    return law


def coupled_law(motion: Motion, *rings: Ring):
    """Likewise (3, 3) on (dz, g', g'*) in the frame of the pattern, of any count of pitches: the roots of its
    determinant are all that rings and film have."""

    def law(s: complex) -> np.ndarray:
        around = 1j * motion.frame
        alone, beside = np.array([
            _joined([axial_support_law(ring, s) for ring in rings]),
            _joined([support_law(ring, s + around) for ring in rings]),
            _joined([support_law(ring, (s - around).conjugate()).conjugate() for ring in rings]),
        ]).T  # fmt: skip
        return np.diag(alone) + beside[:, None] * motion.coupled(s)

    return law


def relative_tilt(
    motion: Motion, rings: tuple[Ring, ...], moment: complex, frequency: float
) -> tuple[complex, complex]:
    """Amplitudes of the gap's tilt (rad, inertial) that a moment e^{i frequency t} (N m) on the first of the rings
    makes: at its own frequency (rad/s), and at twice the speed of the pattern less it, 0 of 3 pitches and more.

    The moment of a standing misalignment g_i of the support is K g_i at frequency 0; of a partner that is rigid and has
    a tilt g_r at w it is (ring alone at w) g_r, against it where the partner is the rotor."""
    s = 1j * frequency
    drive = moment * math.prod(support_law(ring, s) for ring in rings[1:])
    if not motion.uneven:
        return drive / tilt_law(motion, *rings)(s), 0j
    answer = np.linalg.solve(coupled_law(motion, *rings)(s - 1j * motion.frame), [0.0, drive, 0.0])
    return complex(answer[1]), complex(answer[2]).conjugate()


def own_tilt(motion: Motion, ring: Ring) -> complex:
    """Tilt of the gap (rad, in the frame of the pattern, where it stays) that the aligned film of one pitch makes by
    pressing askew; 0 of more."""
    steady = motion.steady
    if steady.film.mesh.count > 1:
        return 0j
    moment = -1j * complex(steady.film.weights(2, 1) @ steady.p)
    return complex(np.linalg.solve(coupled_law(motion, ring)(0.0), [0.0, moment, moment.conjugate()])[1])


# Frequencies of the count to a decade, decades below and above the pace of the ring, and the largest turn (rad) of the
# law from one to the next.
PER_DECADE, BELOW, ABOVE, TURN = 8, 4, 3, 1.0


def unstable_roots(law, inertia: float, degree: int = 2) -> int:
    """How many zeros an analytic `law` of `axial_law`, `tilt_law` has with a growing real part; likewise a determinant
    of `coupled_law`, of three times their degree, 2 a ring.

    **Source** argument principle: along the imaginary axis upwards a law that goes with inertia s^degree turns by 2 pi
    less for each zero on its right, which adds to the pi degree of none.
    **Valid** a film whose own motion between faces that stand still decays: it has no poles on the right."""
    stiffness = max(abs(law(0.0)), abs(law(1j)))
    pace = max((stiffness / inertia) ** (1.0 / degree), 1.0)
    half = pace * 10.0 ** np.linspace(-BELOW, ABOVE, (BELOW + ABOVE) * PER_DECADE + 1)
    at = [*(-half[::-1]), *half]
    values = [law(1j * w) for w in at]
    turned, k = 0.0, 0
    while k < len(at) - 1:
        turn = cmath.phase(values[k + 1] / values[k])
        # Finer where it turns fast, but not for ever where it passes zero.
        if abs(turn) > TURN and at[k + 1] - at[k] > 1e-6 * pace:
            middle = 0.5 * (at[k] + at[k + 1])
            at.insert(k + 1, middle)
            values.insert(k + 1, law(1j * middle))
            continue
        turned, k = turned + turn, k + 1
    return round(0.5 * degree - turned / (2.0 * cmath.pi))
