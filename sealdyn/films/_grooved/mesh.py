"""Triangles on one pitch of a pattern, with nodes on all its edges, in (ln r, phi).

Reynolds' equation is Cartesian there.  Rows lie at constant r, columns at constant xi (faces/pattern.py), so that they
follow the edges of a spiral; every quad is cut along its shorter diagonal.  Rows are so high that an edge moves 0.75
columns from one to the next: one of the diagonals is then nearly radial.  The pitch closes in itself: a corner of a
triangle is a node and by how many pitches it lies ahead of it.

At a tip of a groove, and where one opens on an edge of given pressure, p^2 goes with a power lambda < 1 of the
distance, and the error of the mesh with its width to the 2 lambda.  With kappa = (groove film/land film)^3 and the
groove filling the angle b there

    tip         kappa tan(lambda b/2) + tan(lambda (pi - b/2)) = 0,  or the same with cot
    open end    kappa cot(lambda b) + cot(lambda (pi - b)) = 0

and the longest edges of the triangles that touch one are bisected several times.

Of dimples the nodes of a plain grid that the edge of an ellipse passes nearby move onto it, along the line of the grid
that crosses it; every quad is then cut so that no triangle lies on both sides.
**Source** derived here: harmonic functions cos (or sin) of lambda theta from the bisector on both sides, of equal value
and equal kappa d/dtheta at the edges; at an open end sin(lambda theta) from the given edge.  Of each edge of the grid
between a node inside a dimple and one outside the nearer moves, so that no edge of the grid crosses any more, nor both
diagonals of a quad.
**Valid** one pattern that reaches at most to both edges of the face; dimples between the edges, several nodes across;
they may overlap from pitch to pitch.
"""

import math
from dataclasses import dataclass, replace
from functools import cached_property, lru_cache
from itertools import pairwise

import numpy as np
from scipy.optimize import brentq

from ...faces.pattern import Boxes, Dimples, Edges, Pattern, Spiral

# Columns an edge may move in a row, and the height of rows over the width of columns where no edge is inclined.
MOVES, PLAIN = 0.75, 0.25
MOST_NODES = 100_000
# Two radii, two angles that are the same.
SAME = 1e-9
# Angles (rad) by which a pattern's edge may bend and be straight.
STRAIGHT = 1e-6


@dataclass(frozen=True, eq=False)
class Mesh:
    """Triangles on a sector that closes in itself.

    `u` = ln r and `phi` (rad) of the nodes, (nodes,); `corners` and `shifts` (triangles, 3): the node at each corner,
    counter-clockwise in (u, phi), and by how many sectors it lies ahead; `depth` (triangles,) of the pattern (m);
    `inner`, `outer` (nodes,) bool: on an edge of the face; `count` of sectors to the circle; `bends`: where the
    pattern's edge bends there is a tip, not a curve."""

    u: np.ndarray
    phi: np.ndarray
    corners: np.ndarray
    shifts: np.ndarray
    depth: np.ndarray
    inner: np.ndarray
    outer: np.ndarray
    count: int
    bends: bool = True

    @property
    def pitch(self) -> float:
        """Angle (rad) of the sector."""
        return 2.0 * math.pi / self.count

    @cached_property
    def corner_u(self) -> np.ndarray:
        """(triangles, 3)."""
        return self.u[self.corners]

    @cached_property
    def corner_phi(self) -> np.ndarray:
        """(triangles, 3), rad."""
        return self.phi[self.corners] + self.pitch * self.shifts

    @cached_property
    def area(self) -> np.ndarray:
        """(triangles,), in (u, phi)."""
        u, phi = self.corner_u, self.corner_phi
        across = (u[:, 1] - u[:, 0]) * (phi[:, 2] - phi[:, 0])
        return 0.5 * (across - (u[:, 2] - u[:, 0]) * (phi[:, 1] - phi[:, 0]))

    @cached_property
    def gradients(self) -> tuple[np.ndarray, np.ndarray]:
        """d/du and d/dphi of the function that is 1 at a corner and 0 at the others, (triangles, 3) each."""
        u, phi, twice = self.corner_u, self.corner_phi, 2.0 * self.area[:, None]
        ahead, behind = [1, 2, 0], [2, 0, 1]
        return (phi[:, ahead] - phi[:, behind]) / twice, (u[:, behind] - u[:, ahead]) / twice

    @cached_property
    def free(self) -> np.ndarray:
        """Nodes whose pressure is not given."""
        return np.flatnonzero(~(self.inner | self.outer))


# Films at many clearances and speeds have one mesh.
@lru_cache(maxsize=16)
def mesh_of(
    pattern: Spiral | Boxes,
    inner_radius: float,
    outer_radius: float,
    columns: float,
    times: int = 1,
    bisections: int = 8,
    least: int = 2,
) -> Mesh:
    """One pitch of a pattern between the radii (m) of a face: `columns` to the pitch, rows to suit, both so many
    `times` over, at `least` so many between neighbouring edges of the pattern, times that, and so many bisections at
    tips.  Raises ValueError for more than MOST_NODES."""
    edges = pattern.edges
    pitch = 2.0 * math.pi / pattern.count
    width = pitch / columns
    height = width * (min(MOVES / abs(edges.slope), 2.0 * PLAIN) if edges.slope else PLAIN)
    # Of few wide pitches as many rows as columns.
    height = min(height, math.log(outer_radius / inner_radius) / columns)
    if (nodes := columns * times**2 * math.log(outer_radius / inner_radius) / height) > MOST_NODES:
        raise ValueError(f"{nodes:.3g} nodes to a pitch, more than {MOST_NODES}: grooves so many and so flat")
    u = _divided([math.log(r) for r in _breaks(edges, inner_radius, outer_radius)], height, times, least)
    xi = _divided([*edges.angles, edges.angles[0] + pitch], width, times, least)[:-1]
    low, high = np.log(edges.twisted)
    phi = xi + edges.slope * (np.clip(u, low, high) - math.log(edges.reference))[:, None]

    rows, n = len(u), len(xi)
    after = ahead(phi, pitch)
    forward, backward = np.abs(after[1:] - phi[:-1]), np.abs(phi[1:] - after[:-1])
    # Of two that are as long, so that meshes of mirrored patterns are mirror images.
    up = forward < backward * (1.0 - SAME) if edges.slope > 0.0 else forward <= backward * (1.0 + SAME)
    corners, shifts = cut_quads(up)

    radial, around = np.repeat(u, n), phi.ravel()
    middle_u = radial[corners].mean(axis=1)
    depth = pattern.depth_at(np.exp(middle_u), (around[corners] + pitch * shifts).mean(axis=1))
    inner, outer = np.repeat(np.arange(rows) == 0, n), np.repeat(np.arange(rows) == rows - 1, n)
    mesh = Mesh(radial, around, corners, shifts, depth, inner, outer, pattern.count)
    tips = [tip.node for tip in tips_of(mesh)]
    for _ in range(bisections):
        mesh = _bisected(mesh, tips)
    return mesh


def ahead(values: np.ndarray, more: float = 0) -> np.ndarray:
    """Values (rows, n) of a sector at the next column; beyond the last one the first, and so much `more`."""
    found = np.roll(values, -1, axis=1)
    found[:, -1] += more
    return found


def cut_quads(up: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Corners and shifts (triangles, 3) of a sector's grid whose quads (rows - 1, n) are cut from here to the next
    column above (`up`), or from the next column to above here."""
    rows, n = up.shape[0] + 1, up.shape[1]
    node, shift = np.arange(rows * n).reshape(rows, n), np.zeros((rows, n), dtype=int)
    shift[:, -1] = 1
    # Of each quad: here and ahead in its row, and the same in the row above.
    a, b, c, d = node[:-1].ravel(), ahead(node)[:-1].ravel(), node[1:].ravel(), ahead(node)[1:].ravel()
    s, zero, up = shift[:-1].ravel(), np.zeros(len(a), dtype=int), up.ravel()[:, None]
    first = np.where(up, np.stack([a, d, b], 1), np.stack([a, c, b], 1))
    second = np.where(up, np.stack([a, c, d], 1), np.stack([b, c, d], 1))
    first_shift = np.where(up, np.stack([zero, s, s], 1), np.stack([zero, zero, s], 1))
    second_shift = np.where(up, np.stack([zero, zero, s], 1), np.stack([s, zero, s], 1))
    return np.concatenate([first, second]), np.concatenate([first_shift, second_shift])


def _breaks(edges: Edges, inner_radius: float, outer_radius: float) -> list[float]:
    """Radii (m) between which rows lie, those of the face's edges among them."""
    between = [r for r in edges.radii if inner_radius * (1.0 + SAME) < r < outer_radius * (1.0 - SAME)]
    return [inner_radius, *between, outer_radius]


def _divided(breaks, steps, times: int, least: int) -> np.ndarray:
    """Values from the first break to the last, evenly between neighbours, about a step of each (one for all, or as many
    as there are) over so many times apart, at `least` so many steps between two breaks."""
    parts = [np.array(breaks[:1])]
    for (a, b), step in zip(pairwise(breaks), np.broadcast_to(steps, len(breaks) - 1).tolist(), strict=True):
        parts.append(np.linspace(a, b, max(round((b - a) / step), least) * times + 1)[1:])
    return np.concatenate(parts)


def whole_circle(mesh: Mesh) -> Mesh:
    """All sectors in one that closes in itself after a turn."""
    nodes, sector = len(mesh.u), np.arange(mesh.count)
    place = sector[:, None, None] + mesh.shifts
    corners = (mesh.corners + nodes * (place % mesh.count)).reshape(-1, 3)
    phi = (mesh.phi + mesh.pitch * sector[:, None]).ravel()
    u, depth, inner, outer = (np.tile(part, mesh.count) for part in (mesh.u, mesh.depth, mesh.inner, mesh.outer))
    return Mesh(u, phi, corners, (place // mesh.count).reshape(-1, 3), depth, inner, outer, 1, mesh.bends)


def _bisected(mesh: Mesh, tips: list[int]) -> Mesh:
    """The mesh with the longest edges of all triangles at the tips bisected, longest first, on both sides of each."""
    touching = np.flatnonzero(np.isin(mesh.corners, tips).any(axis=1))
    u, phi = mesh.corner_u[touching], mesh.corner_phi[touching]
    length = np.hypot(np.roll(u, -1, 1) - u, np.roll(phi, -1, 1) - phi)
    longest = np.argmax(length, axis=1)
    edges = {}
    for triangle, k, size in zip(touching, longest, length[np.arange(len(touching)), longest], strict=True):
        edges[_edge(mesh, triangle, k)] = size
    for edge in sorted(edges, key=lambda edge: (-edges[edge], edge)):
        mesh = _split(mesh, edge)
    return mesh


def _edge(mesh: Mesh, triangle: int, k: int) -> tuple[int, int, int]:
    """An edge, from corner k of a triangle on: its nodes, and how many sectors the second lies ahead of the first."""
    ends = [(int(mesh.corners[triangle, j]), int(mesh.shifts[triangle, j])) for j in (k, (k + 1) % 3)]
    (a, ahead_a), (b, ahead_b) = sorted(ends)
    return a, b, ahead_b - ahead_a


def _split(mesh: Mesh, edge: tuple[int, int, int]) -> Mesh:
    """The mesh with one more node, in the middle of an edge."""
    a, b, ahead = edge
    node = len(mesh.u)
    at_a, at_b = mesh.corners == a, mesh.corners == b
    corners, shifts, depth = [mesh.corners], [mesh.shifts], [mesh.depth]
    for triangle in np.flatnonzero(at_a.any(axis=1) & at_b.any(axis=1)):
        for k in range(3):
            if _edge(mesh, triangle, k) == edge:
                here, there = k, (k + 1) % 3
                placed = int(mesh.shifts[triangle, here if mesh.corners[triangle, here] == a else there])
                # The half with the first end stays where the triangle was, the other one comes last.
                old, moved = mesh.corners[triangle].copy(), mesh.shifts[triangle].copy()
                old[here], moved[here] = node, placed
                corners.append(old[None])
                shifts.append(moved[None])
                depth.append(mesh.depth[triangle][None])
                kept, stays = corners[0].copy(), shifts[0].copy()
                kept[triangle, there], stays[triangle, there] = node, placed
                corners[0], shifts[0] = kept, stays
                break
    return replace(
        mesh,
        u=np.append(mesh.u, 0.5 * (mesh.u[a] + mesh.u[b])),
        phi=np.append(mesh.phi, 0.5 * (mesh.phi[a] + mesh.phi[b] + ahead * mesh.pitch)),
        inner=np.append(mesh.inner, mesh.inner[a] and mesh.inner[b]),
        outer=np.append(mesh.outer, mesh.outer[a] and mesh.outer[b]),
        corners=np.concatenate(corners),
        shifts=np.concatenate(shifts),
        depth=np.concatenate(depth),
    )


@dataclass(frozen=True)
class Tip:
    """A node where an edge of the pattern bends, or ends on an edge of the face (`open`): the angle (rad) that the
    groove fills there."""

    node: int
    filled: float
    open: bool

    def exponent(self, kappa: float) -> float:
        """The smallest lambda, for kappa = (groove film/land film)^3 there."""
        if kappa == 1.0:
            return 1.0
        half, rest = (self.filled, math.pi - self.filled) if self.open else (self.filled / 2, math.pi - self.filled / 2)

        # Without poles; the least root of either lies between 1/2 and 1, one of a wide or a shallow groove beyond.
        def odd(power):
            a, b = power * half, power * rest
            return kappa * math.cos(a) * math.sin(b) + math.sin(a) * math.cos(b)

        def even(power):
            a, b = power * half, power * rest
            return kappa * math.sin(a) * math.cos(b) + math.cos(a) * math.sin(b)

        found, scan = [1.0], np.linspace(0.3, 1.0 - 1e-6, 100)
        for law in (odd,) if self.open else (odd, even):
            values = [law(power) for power in scan]
            for n in range(len(scan) - 1):
                if values[n] * values[n + 1] < 0.0:
                    found.append(brentq(law, scan[n], scan[n + 1]))
                    break
        return min(found)


def tips_of(mesh: Mesh) -> list[Tip]:
    """Where the pattern's edges bend or end."""
    if not mesh.bends:
        return []
    u, phi, nodes = mesh.corner_u, mesh.corner_phi, len(mesh.u)
    after = np.stack([np.roll(u, -1, 1) - u, np.roll(phi, -1, 1) - phi])
    before = np.stack([np.roll(u, 1, 1) - u, np.roll(phi, 1, 1) - phi])
    angle = np.arccos(np.sum(after * before, 0) / np.sqrt(np.sum(after**2, 0) * np.sum(before**2, 0)))
    deep = np.broadcast_to(mesh.depth[:, None] > 0.5 * mesh.depth.max(), angle.shape)
    filled = np.bincount(mesh.corners.ravel(), (angle * deep).ravel(), nodes)
    whole = np.bincount(mesh.corners.ravel(), angle.ravel(), nodes)
    both = (filled > STRAIGHT) & (filled < whole - STRAIGHT) & (np.abs(filled - 0.5 * whole) > STRAIGHT)
    edge = mesh.inner | mesh.outer
    return [Tip(int(i), float(filled[i]), bool(edge[i])) for i in np.flatnonzero(both)]


# Halvings after which a crossing is found; level within which a node lies on the edge.
HALVINGS, ON = 50, 1e-12
# Steps across a dimple, of the columns to the pitch and at least, and between it and what is next; share of the pitch
# between neighbours below which they are close.
ACROSS, LEAST, BESIDE, CLOSE = 0.5, 4, 2, 0.1


def mesh_on(
    pattern: Pattern, inner_radius: float, outer_radius: float, columns: float, times: int = 1, least=2
) -> Mesh:
    """One pitch of any pattern, arguments as of `mesh_of`."""
    if isinstance(pattern, Dimples):
        return dimpled_mesh(pattern, inner_radius, outer_radius, columns, times)
    return mesh_of(pattern, inner_radius, outer_radius, columns, times, least=least)


@lru_cache(maxsize=16)
def dimpled_mesh(pattern: Dimples, inner_radius: float, outer_radius: float, columns: float, times: int) -> Mesh:
    """One pitch of dimples between the radii (m) of a face: `columns` to the pitch, half as many over a dimple, both so
    many `times` over.  Raises ValueError for more than MOST_NODES, and for dimples that reach an edge of the face."""
    low, high = pattern.reach
    if not inner_radius < low < high < outer_radius:
        raise ValueError(f"dimples from {low:.6g} to {high:.6g} m, which reach an edge of the face")
    pitch, across = 2.0 * math.pi / pattern.count, max(ACROSS * columns, LEAST)
    half, fine = pattern.half_angle, min(pitch / columns, min(pattern.length, pattern.width) / pattern.radius / across)
    # Coarser where no dimple is.
    coarse = min(pitch / columns, 2.0 * fine)
    u = _divided([math.log(r) for r in (inner_radius, low, high, outer_radius)], (coarse, fine, coarse), times, BESIDE)
    apart = 2.0 * half < (1.0 - CLOSE) * pitch
    ends = (-half, half, pitch - half) if apart else (-0.5 * pitch, 0.5 * pitch)
    phi = pattern.phase + _divided(ends, (fine, coarse) if apart else fine, times, BESIDE)[:-1]
    rows, n = len(u), len(phi)
    if rows * n > MOST_NODES:
        raise ValueError(f"{rows * n:.3g} nodes to a pitch, more than {MOST_NODES}: dimples so small")
    radial = np.repeat(u[:, None], n, axis=1)
    around = np.repeat(phi[None], rows, axis=0)
    radial, around, side = _on_the_edge(pattern, radial, around, pitch)
    corners, shifts = _cut(radial, around, side, pitch)
    at = radial.ravel()[corners], around.ravel()[corners] + pitch * shifts
    signs = side.ravel()[corners]
    middle = pattern.level(np.exp(at[0].mean(axis=1)), at[1].mean(axis=1))
    inside = np.where(signs.any(axis=1), signs.sum(axis=1) < 0, middle < 0.0)
    flat = np.arange(rows * n) // n
    return Mesh(radial.ravel(), around.ravel(), corners, shifts, np.where(inside, pattern.depth, 0.0), flat == 0,
                flat == rows - 1, pattern.count, bends=False)  # fmt: skip


def _on_the_edge(pattern, radial, around, pitch: float):
    """Nodes of the grid (rows, n) with those moved that an edge passes nearby, and on which side each now lies: -1
    inside, 0 on the edge, 1 outside."""
    level, grid = pattern.level(np.exp(radial), around), np.stack([radial, around])
    moved, places, last = np.full(level.shape, np.inf), grid.copy(), len(radial) - 2
    above = np.roll(grid, -1, axis=1), np.roll(level, -1, axis=0)
    beside = np.stack([ahead(radial), ahead(around, pitch)]), ahead(level)
    for upwards, (after, other) in ((True, above), (False, beside)):
        crossed = level * other < 0.0
        crossed[-1] &= not upwards
        here, begin, end = np.argwhere(crossed), grid[:, crossed], after[:, crossed]
        share = _crossing(pattern, begin, end, level[crossed])
        near = share <= 0.5
        if upwards:
            # Nodes on the edges of the face stay there.
            near = (near | (here[:, 0] == last)) & (here[:, 0] > 0)
        for (i, j), t, first, a, b in zip(here, share, near, begin.T, end.T, strict=True):
            place, way, (k, m) = a + t * (b - a), t if first else 1.0 - t, (i, j)
            if not first:
                k, m = (i + 1, j) if upwards else (i, (j + 1) % level.shape[1])
                if m < j:
                    place = place - [0.0, pitch]
            if way < moved[k, m]:
                moved[k, m], places[:, k, m] = way, place
    side = np.where(np.isfinite(moved) | (np.abs(level) < ON), 0.0, np.sign(level))
    return places[0], places[1], side


def _crossing(pattern, begin, end, first) -> np.ndarray:
    """Share of the way from `begin` (2, m) to `end` at which the level passes zero, `first` (m,) that at the begin."""
    low, high = np.zeros(begin.shape[1]), np.ones(begin.shape[1])
    for _ in range(HALVINGS):
        middle = 0.5 * (low + high)
        u, phi = begin + middle * (end - begin)
        same = pattern.level(np.exp(u), phi) * first > 0.0
        low, high = np.where(same, middle, low), np.where(same, high, middle)
    return 0.5 * (low + high)


def _cut(radial, around, side, pitch: float) -> tuple[np.ndarray, np.ndarray]:
    """Corners and shifts of the triangles: every quad cut along the shorter diagonal that does not pass an edge."""
    after = ahead(around, pitch)
    up = np.hypot(after[1:] - around[:-1], ahead(radial)[1:] - radial[:-1])
    down = np.hypot(around[1:] - after[:-1], radial[1:] - ahead(radial)[:-1])
    passes_up, passes_down = side[:-1] * ahead(side)[1:] < 0.0, ahead(side)[:-1] * side[1:] < 0.0
    return cut_quads(passes_down | (~passes_up & (up < down)))
