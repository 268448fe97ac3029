"""Steady aligned film between a plain and a patterned face, in the pattern's frame: Reynolds' equation on triangles.

    r^2 d(p h)/dt + d/du(-k p_u) + d/dphi(-k p_phi + w r^2 p h) = 0,    u = ln r, k = h^3 p/(12 mu)      (gas)

and without p in p h and k of a liquid.  w is the entrainment in that frame.  Pressures are
linear between nodes, each triangle has its own film; what leaves the median cell of node i through triangle t, of area
A in (u, phi), is

    K A grad N_i . grad q  +  (c h^2/2) A grad N_i . grad p  -  w r^2 h mean(p) A dN_i/dphi,    K = h^3/(12 mu)

with q = p^2/2, c = sqrt(pi R T/2) of first-order slip (a liquid: q = p, c = 0, mean(p) = 1), r and h at the middle.
Where a liquid tears, nodes have the cavitation pressure and a void v in place of a pressure, p v = 0 above it, and what
is carried over the part of a median cell's border that a triangle has is the liquid, 1 - v, of the cell it leaves.
**Source** control volumes on linear triangles (Baliga & Patankar (1980), Num. Heat Transfer 3, 393): of a constant flux
F as much as -A F . grad N_i leaves a median cell, exactly; cavities that keep their liquid: Elrod (1981), J. Lubr.
Technol. 103, 350; the equation in ln r derived here.
**Valid** isothermal, laminar; h_t at a groove's edge jumps between triangles and needs no rule there.  The
sum over the corners of a triangle is 0, so that what enters at one edge of the face leaves at the other to rounding.
"""

import math
from dataclasses import dataclass
from functools import cached_property

import numpy as np
from scipy.sparse import csc_array
from scipy.sparse.linalg import splu

from .mesh import Mesh, mesh_on, tips_of


@dataclass(frozen=True)
class Conditions:
    """What the film is at: `clearance` of the lands at the inner radius (m), `viscosity` (Pa s), pressures (Pa,
    absolute), `relative_speed` rotor less stator (rad/s), `face` that has the pattern ("rotor" or "stator"), `coning`
    (rad), `gas` or liquid, `slip` = sqrt(pi R T/2) (m/s), 0 without, `cavity` the pressure (Pa) at which a liquid
    tears, None where it never does, `floor` of the film over lands (m), below which it goes on as between rough faces
    (faces/geometry.py `regularised_thickness`)."""

    clearance: float
    viscosity: float
    inner_pressure: float
    outer_pressure: float
    relative_speed: float
    face: str = "rotor"
    coning: float = 0.0
    gas: bool = True
    slip: float = 0.0
    cavity: float | None = None
    floor: float = 0.0

    @property
    def entrainment(self) -> float:
        """In the frame of the pattern (rad/s).

        **Source** derived here: with phi = theta - W_p t, d/dt + (W_s + W_r)/2 d/dtheta becomes d/dt + w d/dphi with
        w = (W_s + W_r)/2 - W_p, which is -(W_r - W_s)/2 for a patterned rotor and the opposite for a stator."""
        return (-0.5 if self.face == "rotor" else 0.5) * self.relative_speed

    def lands(self, beyond) -> np.ndarray:
        """Film over the lands (m), so far (m) beyond the inner radius."""
        h = self.clearance + self.coning * np.asarray(beyond)
        return np.where(h >= self.floor, h, self.floor**2 / np.maximum(2.0 * self.floor - h, self.floor or 1.0))

    def follows(self, lands) -> np.ndarray:
        """By how much it changes with the gap where it is `lands` (m)."""
        return np.where(lands >= self.floor, 1.0, (lands / (self.floor or 1.0)) ** 2)


# Newton's steps, the relative change of pressures after which rounding is left, and the least share of a pressure that
# a step leaves.
MOST_STEPS, ARRIVED, LEAST = 40, 1e-10, 0.2


class NoSteadyFilm(ArithmeticError):
    """No steady pressures are found."""


class Assembly:
    """Where the entries of triangles go in a sparse matrix of the free nodes, and how they turn with the sector.

    `turn` is the factor (complex, of modulus 1) of a field from a sector to the next; 1 of one that repeats."""

    def __init__(self, mesh: Mesh, turn: complex = 1.0):
        place = np.full(len(mesh.u), -1)
        place[mesh.free] = np.arange(len(mesh.free))
        at = place[mesh.corners]
        rows, columns = np.repeat(at, 3, axis=1).ravel(), np.tile(at, (1, 3)).ravel()
        self.free, self.taken = len(mesh.free), (rows >= 0) & (columns >= 0)
        keys, self.entry = np.unique(columns[self.taken] * self.free + rows[self.taken], return_inverse=True)
        self.indices, self.indptr = keys % self.free, np.searchsorted(keys // self.free, np.arange(self.free + 1))
        self.diagonal = np.searchsorted(keys, np.arange(self.free) * (self.free + 1))
        self.real = turn == 1.0
        # Of a corner, which lies some sectors ahead of its node.
        self.ahead = np.ones(mesh.shifts.shape) if self.real else turn**mesh.shifts
        between = self.ahead[:, None, :] * np.conj(self.ahead)[:, :, None]
        self.between = between.ravel()[self.taken]

    def data(self, local: np.ndarray) -> np.ndarray:
        """Values of the matrix, from those (triangles, 3, 3) of row and column corners."""
        values = local.ravel()[self.taken]
        size = len(self.indices)
        if self.real:
            return np.bincount(self.entry, values, size)
        values = values * self.between
        return np.bincount(self.entry, values.real, size) + 1j * np.bincount(self.entry, values.imag, size)

    def matrix(self, data: np.ndarray) -> csc_array:
        """(free, free) of `data`."""
        return csc_array((data, self.indices, self.indptr), shape=(self.free, self.free))


class Film:
    """Mesh and conditions, and what of the balances does not hang on the pressure."""

    def __init__(self, mesh: Mesh, conditions: Conditions):
        self.mesh, self.conditions = mesh, conditions
        u, phi = mesh.corner_u, mesh.corner_phi
        self.u, self.phi = u.mean(axis=1), phi.mean(axis=1)
        self.r = np.exp(self.u)
        self.inner_radius = math.exp(mesh.u.min())
        c = conditions
        middles, self.lands = c.lands(self.r - self.inner_radius), c.lands(np.exp(mesh.u) - self.inner_radius)
        self.h, self.follows = middles + mesh.depth, (c.follows(self.lands), c.follows(middles))
        if not (self.h.min() > 0.0 and self.lands.min() > 0.0):
            raise ValueError(f"clearance: the faces meet at {c.clearance:g} m with a coning of {c.coning:g} rad")
        by_u, by_phi = mesh.gradients
        self.diffusion = mesh.area[:, None, None] * (
            by_u[:, :, None] * by_u[:, None, :] + by_phi[:, :, None] * by_phi[:, None, :]
        )
        self.carried = (c.entrainment * self.r**2 * mesh.area)[:, None] * by_phi
        self.viscous = self.h**3 / (12.0 * c.viscosity)
        self.slippery = 0.5 * c.slip * self.h**2

    @cached_property
    def held(self) -> np.ndarray:
        """Mean film of each node times its area (r^2 du dphi), (nodes,), m^3."""
        mesh = self.mesh
        part = (mesh.area * self.r**2 / 3.0)[:, None] * (self.lands[mesh.corners] + mesh.depth[:, None])
        return np.bincount(mesh.corners.ravel(), part.ravel(), len(mesh.u))

    def weights(self, power: int, order: int = 0) -> np.ndarray:
        """What the integral of p r^power e^{i order phi} dr dphi over a sector has of p at each node, (nodes,): three
        midpoints to a triangle."""
        mesh, found = self.mesh, 0.0
        for a in range(3):
            b = (a + 1) % 3
            at = np.exp((power + 1) * 0.5 * (mesh.corner_u[:, a] + mesh.corner_u[:, b])) * mesh.area / 6.0
            if order:
                at = at * np.exp(0.5j * order * (mesh.corner_phi[:, a] + mesh.corner_phi[:, b]))
            for corner in (a, b):
                turned = at * np.exp(-1j * order * mesh.pitch * mesh.shifts[:, corner]) if order else at
                nodes, size = mesh.corners[:, corner], len(mesh.u)
                found = found + np.bincount(nodes, turned.real, size)
                if order:
                    found = found + 1j * np.bincount(nodes, turned.imag, size)
        return found

    def potential(self, p: np.ndarray) -> np.ndarray:
        """q."""
        return 0.5 * p * p if self.conditions.gas else p

    @cached_property
    def passing(self) -> np.ndarray:
        """What a full film carries over the border of the cells of corners a and a + 1, from a on, (triangles, 3)."""
        middles = 0.5 * (self.mesh.corner_u + np.roll(self.mesh.corner_u, -1, 1))
        return -(self.conditions.entrainment * self.r**2 * self.h)[:, None] * (self.u[:, None] - middles)

    def dragged(self, void: np.ndarray | None) -> np.ndarray:
        """Of a liquid, what of `leaving` is carried along; `void` (nodes,), None of a full film."""
        if void is None:
            return -self.carried * self.h[:, None]
        filled = 1.0 - void[self.mesh.corners]
        passed = self.passing * np.where(self.passing > 0.0, filled, np.roll(filled, -1, 1))
        return passed - np.roll(passed, 1, 1)

    def leaving(self, p: np.ndarray, void: np.ndarray | None = None) -> np.ndarray:
        """What leaves each corner's share of its cell through its triangle, (triangles, 3), at pressures and voids
        (nodes,)."""
        corners = self.mesh.corners
        out = self.viscous[:, None] * _times(self.diffusion, self.potential(p)[corners])
        if not self.conditions.gas:
            return out + self.dragged(void)
        if self.conditions.slip:
            out += self.slippery[:, None] * _times(self.diffusion, p[corners])
        return out - self.carried * (self.h * p[corners].mean(axis=1))[:, None]

    def slopes(self, p: np.ndarray, torn: np.ndarray | None = None) -> np.ndarray:
        """Derivatives of `leaving` by the pressures at the corners, (triangles, 3, 3), or by the voids of those that
        are `torn` (nodes,)."""
        local = self.viscous[:, None, None] * self.diffusion
        if torn is not None:
            here, ahead = np.maximum(self.passing, 0.0), np.minimum(self.passing, 0.0)
            by_void = -here[:, :, None] * np.eye(3) - ahead[:, :, None] * np.roll(np.eye(3), 1, 1)
            return np.where(torn[self.mesh.corners][:, None, :], by_void - np.roll(by_void, 1, 1), local)
        if not self.conditions.gas:
            return local
        local = local * p[self.mesh.corners][:, None, :] + self.slippery[:, None, None] * self.diffusion
        return local - (self.carried * self.h[:, None] / 3.0)[:, :, None]

    def gathered(self, leaving: np.ndarray) -> np.ndarray:
        """Sums (nodes,) of what leaves the corners."""
        return np.bincount(self.mesh.corners.ravel(), leaving.ravel(), len(self.mesh.u))


def _times(local: np.ndarray, values: np.ndarray) -> np.ndarray:
    """Local matrices (triangles, 3, 3) times values (triangles, 3)."""
    return np.matmul(local, values[:, :, None])[:, :, 0]


@dataclass(frozen=True, eq=False)
class Steady:
    """The steady aligned film: pressures `p` (Pa) at the nodes, Newton's `steps`, and the share `void` (nodes,) of the
    cells that is not filled, None of a film that cannot tear."""

    film: Film
    p: np.ndarray
    steps: int
    void: np.ndarray | None = None

    @cached_property
    def torn(self) -> np.ndarray | None:
        """Nodes at the cavitation pressure, (nodes,) bool."""
        return None if self.void is None else self.void > 0.0

    @cached_property
    def cavitated(self) -> float:
        """Share of the face that the cells of torn nodes have."""
        if self.torn is None:
            return 0.0
        cells = self.film.gathered(np.repeat((self.film.mesh.area * self.film.r**2 / 3.0)[:, None], 3, 1))
        return float(cells[self.torn].sum() / cells.sum())

    @cached_property
    def force(self) -> float:
        """Opening force of absolute pressures (N)."""
        return float(self.film.mesh.count * (self.film.weights(1) @ self.p))

    @cached_property
    def flows(self) -> tuple[float, float]:
        """Flow outwards at the inner and at the outer edge: of a liquid m^3/s, of a gas p V in Pa m^3/s."""
        mesh = self.film.mesh
        left = mesh.count * self.film.gathered(self.film.leaving(self.p, self.void))
        return float(left[mesh.inner].sum()), float(-left[mesh.outer].sum())

    @cached_property
    def torque(self) -> float:
        """What the shaft supplies (N m): int [mu (W_r - W_s) r^3/h -+ (h/2) r p_phi] dr dphi, the minus of a patterned
        rotor: the shear on the plain face, whose pressures push nothing around.  At seven points to a triangle."""
        film, mesh, c = self.film, self.film.mesh, self.film.conditions
        sheared = 0.0
        for at, weight in SEVEN:
            r = np.exp(mesh.corner_u @ at)
            h = c.lands(r - film.inner_radius) + mesh.depth
            sheared += weight * float(np.sum(mesh.area * r**4 / h))
        p_phi = np.sum(mesh.gradients[1] * self.p[mesh.corners], axis=1)
        pushed = float(np.sum(0.5 * mesh.area * film.h * film.r**2 * p_phi))
        sign = -1.0 if c.face == "rotor" else 1.0
        return mesh.count * (c.viscosity * c.relative_speed * sheared + sign * pushed)


def _seven_points():
    """Points (corner shares) and weights of the rule of Radon (1948), exact to the fifth degree."""
    root = math.sqrt(15.0)
    points = [(np.full(3, 1.0 / 3.0), 9.0 / 40.0)]
    for sign in (-1.0, 1.0):
        a, weight = (6.0 + sign * root) / 21.0, (155.0 + sign * root) / 1200.0
        points += [(np.roll([1.0 - 2.0 * a, a, a], k), weight) for k in range(3)]
    return points


SEVEN = _seven_points()


def steady(mesh: Mesh, conditions: Conditions, p: np.ndarray | None = None) -> Steady:
    """The steady film, by Newton's steps from pressures `p` near by or from those of a plain face.  Raises
    NoSteadyFilm: differences wiggle where 12 mu w r^2 dphi/(h^2 p) is some hundreds, and beyond none is found."""
    film, assembly = Film(mesh, conditions), Assembly(mesh)
    share = (mesh.u - mesh.u.min()) / np.ptp(mesh.u)
    ends = [film.potential(np.asarray(edge)) for edge in (conditions.inner_pressure, conditions.outer_pressure)]
    plain = ends[0] + share * (ends[1] - ends[0])
    plain = np.sqrt(2.0 * plain) if conditions.gas else plain
    solve = _newton if conditions.cavity is None else _torn
    found = None if p is None else solve(film, assembly, np.where(mesh.inner | mesh.outer, plain, p))
    found = found or solve(film, assembly, plain)
    if found is None:
        raise NoSteadyFilm("no steady film is found: what is dragged along outweighs what these columns let through")
    return Steady(film, *found)


def _newton(film: Film, assembly: Assembly, p: np.ndarray) -> tuple[np.ndarray, int] | None:
    """Pressures (nodes,) and the steps taken, None where they do not settle."""
    free, gas = film.mesh.free, film.conditions.gas
    p = p.copy()
    for step in range(1, MOST_STEPS + 1):
        left = film.gathered(film.leaving(p))[free]
        factors = splu(assembly.matrix(assembly.data(film.slopes(p))), permc_spec=PERMUTATION)
        change = factors.solve(-left)
        was = p[free]
        p[free] = np.maximum(was + change, LEAST * was) if gas else was + change
        # Of the whole step: one that only the least share held back is no end.
        moved = np.abs(change).max()
        if not moved < np.inf:
            return None
        if not gas or moved <= ARRIVED * p.max():
            return p, step
    return None


def _torn(film: Film, assembly: Assembly, p: np.ndarray) -> tuple[np.ndarray, int, np.ndarray] | None:
    """Pressures (nodes,), steps, and voids (nodes,) of a liquid that may tear: which nodes do is guessed again until
    no pressure is below that of cavitation and no void below 0.  None where the guesses do not settle."""
    free, cavity = film.mesh.free, film.conditions.cavity
    p, void, torn = p.copy(), np.zeros(len(p)), np.zeros(len(p), dtype=bool)
    for step in range(1, MOST_STEPS + 1):
        left = film.gathered(film.leaving(p, void))[free]
        factors = splu(assembly.matrix(assembly.data(film.slopes(p, torn))), permc_spec=PERMUTATION)
        change, was = np.zeros(len(p)), torn
        change[free] = factors.solve(-left)
        p, void = np.where(was, cavity, p + change), np.where(was, void + change, 0.0)
        torn = np.where(was, void > 0.0, p < cavity)
        if np.array_equal(torn, was):
            return p, step, void
        p, void = np.maximum(p, cavity), np.maximum(void, 0.0)
    return None


PERMUTATION = "MMD_AT_PLUS_A"
# The least exponent that tips have in all cases of use; columns of the coarser mesh.
COLUMNS = 16


def order(film: Film) -> float:
    """Order of the mesh's error in the width of its columns: twice the least exponent of a tip, at most 2."""
    mesh, exponents = film.mesh, [1.0]
    for tip in tips_of(mesh):
        touching = film.h[(mesh.corners == tip.node).any(axis=1)]
        exponents.append(tip.exponent(float(touching.max() / touching.min()) ** 3))
    return 2.0 * min(exponents)


def extrapolated(coarse, fine, power: float):
    """Richardson's value of a number on two meshes, the fine one with twice the columns, for an error of that order,
    and its difference from the fine one, which is the estimate of the fine one's error."""
    better = fine + (fine - coarse) / (2.0**power - 1.0)
    return better, abs(better - fine)


def steady_pair(pattern, inner_radius: float, outer_radius: float, conditions: Conditions, columns: int = COLUMNS):
    """The steady film with so many columns to the pitch and with twice as many, and the order of their error."""
    meshes = [mesh_on(pattern, inner_radius, outer_radius, columns, times) for times in (1, 2)]
    coarse, fine = (steady(mesh, conditions) for mesh in meshes)
    return coarse, fine, order(fine.film)
