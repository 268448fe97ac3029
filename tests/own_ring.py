"""A heated ring by biquadratic finite elements over radius and depth; nothing of the package is used.

A ring has the attributes that its test gives it: inner_radius, outer_radius, length, face_inner_radius,
face_outer_radius, density, modulus, poisson, expansion, conductivity, specific_heat, convection, wetted_length, wet.
Nodes count with the radius fastest; depth x runs from the face into the ring.
"""

from itertools import pairwise
from types import SimpleNamespace

import numpy as np
from scipy.sparse import coo_matrix, csc_matrix
from scipy.sparse.linalg import splu

GAUSS, WEIGHTS = np.polynomial.legendre.leggauss(4)
GAUSS, WEIGHTS = (GAUSS + 1) / 2, WEIGHTS / 2
# Quadratic shapes (node, point) on [0, 1] and their slopes.
SHAPES = np.array([(1 - GAUSS) * (1 - 2 * GAUSS), 4 * GAUSS * (1 - GAUSS), GAUSS * (2 * GAUSS - 1)])
SLOPES = np.array([4 * GAUSS - 3, 4 - 8 * GAUSS, 4 * GAUSS - 1])


class Elements:
    """Rectangles between lines of `radii` and `depths` (m)."""

    def __init__(self, radii, depths):
        self.radii, self.depths = np.asarray(radii), np.asarray(depths)
        self.across, self.size = 2 * len(radii) - 1, (2 * len(radii) - 1) * (2 * len(depths) - 1)
        starts = 2 * self.across * np.arange(len(depths) - 1)[:, None] + 2 * np.arange(len(radii) - 1)
        own = self.across * np.arange(3)[:, None] + np.arange(3)
        self.nodes = (starts.ravel()[:, None] + own.ravel()).astype(int)
        dx, dr = (d.ravel() for d in np.meshgrid(np.diff(depths), np.diff(radii), indexing="ij"))
        first = np.tile(self.radii[:-1], len(depths) - 1)
        # Points of an element: depth slow, radius fast.
        self.r = np.tile(first[:, None] + dr[:, None] * GAUSS, (1, 4))
        self.weight = 2 * np.pi * self.r * np.outer(WEIGHTS, WEIGHTS).ravel() * (dx * dr)[:, None]
        self.values = np.einsum("ap,bq->abpq", SHAPES, SHAPES).reshape(9, 16)
        by_x = np.einsum("ap,bq->abpq", SLOPES, SHAPES).reshape(9, 16)
        by_r = np.einsum("ap,bq->abpq", SHAPES, SLOPES).reshape(9, 16)
        self.by_r, self.by_x = by_r / dr[:, None, None], by_x / dx[:, None, None]

    def matrix(self, element, dofs, size):
        """A sparse matrix from those of the elements (elements, n, n) and their unknowns (elements, n)."""
        rows = np.repeat(dofs[:, :, None], dofs.shape[1], axis=2)
        return csc_matrix(coo_matrix((element.ravel(), (rows.ravel(), rows.swapaxes(1, 2).ravel())), (size, size)))

    def edge(self, side, start, end):
        """Pieces of a side ("face", "back", "bore", "outer") between two coordinates: their nodes (pieces, 3),
        coordinates (pieces, 4) and weights 2 pi r ds (pieces, 4) of their points."""
        along = self.radii if side in ("face", "back") else self.depths
        kept = (along[:-1] >= start - 1e-9) & (along[1:] <= end + 1e-9)
        places = 2 * np.flatnonzero(kept)[:, None] + np.arange(3)
        points = along[:-1][kept][:, None] + np.diff(along)[kept][:, None] * GAUSS
        lines = np.diff(along)[kept][:, None] * WEIGHTS
        if side in ("face", "back"):
            nodes = places + (0 if side == "face" else self.size - self.across)
            return nodes, points, 2 * np.pi * points * lines
        nodes, radius = (0, self.radii[0]) if side == "bore" else (self.across - 1, self.radii[-1])
        return nodes + self.across * places, points, 2 * np.pi * radius * lines


def lines(marks, first, growth):
    """Lines between `marks` (m), narrow at every one of them: `first` (m) beside a mark, growing away from it."""
    found = [marks[0]]
    for start, end in pairwise(marks):
        if end - start < 1e-9:
            continue
        count = 1
        while first * (growth**count - 1) / (growth - 1) < (end - start) / 2:
            count += 1
        half = np.cumsum(growth ** np.arange(count))
        half = half / half[-1] * (end - start) / 2
        found += [*(start + half), *(end - half[:-1][::-1]), end]
    return np.unique(np.round(found, 12))


class Ring:
    """Its mesh, with lines where the band and the O-ring end; `first` (m) is the size of the smallest element."""

    def __init__(self, ring, first=None, growth=1.45):
        self.ring = ring
        first = (ring.outer_radius - ring.inner_radius) / 60 if first is None else first
        marks = [ring.inner_radius, ring.face_inner_radius, ring.face_outer_radius, ring.outer_radius]
        deep = [0.0, *([ring.wetted_length] if ring.wetted_length < ring.length else []), ring.length]
        self.mesh = Elements(lines(marks, first, growth), lines(deep, first, growth))

    def heated(self):
        """One watt even over the band: resistance (K/W), time_constant (s), hottest (K/W), at_o_ring (K/W, where the
        wetted side ends), coning (rad/W) and crown (m/W)."""
        ring, mesh = self.ring, self.mesh
        store = np.einsum("ap,bp,ep->eab", mesh.values, mesh.values, mesh.weight)
        store = mesh.matrix(ring.density * ring.specific_heat * store, mesh.nodes, mesh.size)
        flux = self.push("face", ring.face_inner_radius, ring.face_outer_radius, lambda r: 1.0 + 0 * r)
        flux /= np.sum(flux)
        steady = self._cooled().solve(flux)
        resistance = flux @ steady
        coning, crown = self._shape(self._displaced(self._thermal_load(steady)))
        return SimpleNamespace(
            resistance=resistance, time_constant=steady @ (store @ steady) / resistance, coning=coning, crown=crown,
            hottest=np.max(steady[: mesh.across][self.band()]),
            at_o_ring=steady[self.mesh.edge(*self._wetted()[0])[0][-1, -1]],
        )  # fmt: skip

    def answers(self):
        """What heat (W) at each node of the band does to the band: rises (K/W) and displacements into the ring (m/W),
        both (nodes, nodes of the heat), and the nodes' radii (m)."""
        at = np.flatnonzero(self.band())
        rises = self._cooled().solve(np.eye(self.mesh.size)[:, at])
        moved = self._displaced(np.stack([self._thermal_load(rise) for rise in rises.T], axis=1))
        return rises[at], moved[2 * at + 1], self._face_radii()[at]

    def _cooled(self):
        """The factors of the matrix (W/K) of conduction and convection."""
        ring, mesh = self.ring, self.mesh
        slope = np.einsum("eap,ebp,ep->eab", mesh.by_r, mesh.by_r, mesh.weight)
        slope += np.einsum("eap,ebp,ep->eab", mesh.by_x, mesh.by_x, mesh.weight)
        matrix = mesh.matrix(ring.conductivity * slope, mesh.nodes, mesh.size)
        for side, start, end in self._wetted():
            nodes, _, weights = mesh.edge(side, start, end)
            element = ring.convection * np.einsum("ap,bp,ep->eab", SHAPES, SHAPES, weights)
            matrix = matrix + mesh.matrix(element, nodes, mesh.size)
        return splu(matrix)

    def _wetted(self):
        ring, found = self.ring, []
        if ring.wet in ("outer", "both"):
            found += [("outer", 0.0, ring.wetted_length), ("face", ring.face_outer_radius, ring.outer_radius)]
        if ring.wet in ("bore", "both"):
            found += [("bore", 0.0, ring.wetted_length), ("face", ring.inner_radius, ring.face_inner_radius)]
        return found

    def push(self, side, start, end, value):
        """Loads (nodes,) of a value per area on a side."""
        nodes, points, weights = self.mesh.edge(side, start, end)
        load = np.zeros(self.mesh.size)
        np.add.at(load, nodes, np.einsum("ap,ep->ea", SHAPES, weights * value(points)))
        return load

    def _strains(self):
        """Strains (radial, hoop, axial, shear) by the displacements of an element: (elements, 4, 18, points)."""
        mesh = self.mesh
        of = np.zeros((len(mesh.nodes), 4, 18, 16))
        of[:, 0, 0::2], of[:, 1, 0::2] = mesh.by_r, mesh.values / mesh.r[:, None]
        of[:, 2, 1::2] = mesh.by_x
        of[:, 3, 0::2], of[:, 3, 1::2] = mesh.by_x, mesh.by_r
        return of

    def _law(self):
        e, nu = self.ring.modulus, self.ring.poisson
        law = np.full((4, 4), nu)
        np.fill_diagonal(law, 1 - nu)
        law[3], law[:, 3] = 0.0, 0.0
        law[3, 3] = (1 - 2 * nu) / 2
        return e / ((1 + nu) * (1 - 2 * nu)) * law

    def _thermal_load(self, temperature):
        """Loads (2 nodes,) of the free strain by temperatures (nodes,)."""
        strain = np.einsum("ap,ea->ep", self.mesh.values, temperature[self.mesh.nodes]) * self.ring.expansion
        stress = self._law() @ np.array([1.0, 1.0, 1.0, 0.0])
        element = np.einsum("eidp,i,ep->ed", self._strains(), stress, strain * self.mesh.weight)
        load = np.zeros(2 * self.mesh.size)
        np.add.at(load, self._dofs(), element)
        return load

    def _dofs(self):
        nodes = self.mesh.nodes
        return np.stack([2 * nodes, 2 * nodes + 1], axis=2).reshape(len(nodes), 18)

    def _face_radii(self):
        radii = self.mesh.radii
        return np.interp(np.arange(self.mesh.across) / 2, np.arange(len(radii)), radii)

    def band(self):
        """Of the nodes of the face, those of the band."""
        at = self._face_radii()
        return (at > self.ring.face_inner_radius - 1e-9) & (at < self.ring.face_outer_radius + 1e-9)

    def _displaced(self, loads):
        """Displacements (2 nodes, ...) under loads; one node stays where it is along the shaft."""
        mesh, strains = self.mesh, self._strains()
        element = np.einsum("eidp,ij,ejcp,ep->edc", strains, self._law(), strains, mesh.weight, optimize=True)
        matrix = mesh.matrix(element, self._dofs(), 2 * mesh.size)
        free = np.delete(np.arange(2 * mesh.size), 2 * (mesh.size - 1) + 1)
        moved = np.zeros(loads.shape)
        moved[free] = splu(matrix[free][:, free]).solve(loads[free])
        return moved

    def _shape(self, moved):
        """Slope (rad) of the line through the band that deviates least, and how far (m) its edges are beyond it."""
        mesh, ring = self.mesh, self.ring
        nodes, points, around = mesh.edge("face", ring.face_inner_radius, ring.face_outer_radius)
        height, weights = np.einsum("ap,ea->ep", SHAPES, moved[2 * nodes + 1]), around / points
        middle, mean = np.average(points, weights=weights), np.average(height, weights=weights)
        slope = np.sum(weights * (points - middle) * height) / np.sum(weights * (points - middle) ** 2)
        edges = (moved[2 * nodes[0, 0] + 1] + moved[2 * nodes[-1, -1] + 1]) / 2
        centre = (ring.face_outer_radius + ring.face_inner_radius) / 2
        return slope, edges - mean - slope * (centre - middle)
