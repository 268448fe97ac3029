"""Triangles on one pitch of dimples, with nodes on the edges of their ellipses, in (ln r, phi).

The nodes of a plain grid that an edge passes nearby move onto it, along the line of the grid that crosses it; every
quad is then cut so that no triangle lies on both sides.
**Source** derived here: of each edge of the grid between a node inside and one outside the nearer moves, so that no
edge of the grid crosses any more, nor both diagonals of a quad.
**Valid** dimples between the edges of the face, several nodes across; they may overlap from pitch to pitch.
"""

import math
from functools import lru_cache
from itertools import pairwise

import numpy as np

from ...faces.pattern import Dimples, Pattern
from .mesh import MOST_NODES, Mesh, ahead, cut_quads, mesh_of

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
    u = _spread([math.log(r) for r in (inner_radius, low, high, outer_radius)], (coarse, fine, coarse), times)
    apart = 2.0 * half < (1.0 - CLOSE) * pitch
    ends = (-half, half, pitch - half) if apart else (-0.5 * pitch, 0.5 * pitch)
    phi = pattern.phase + _spread(ends, (fine, coarse) if apart else (fine,), times)[:-1]
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


def _spread(ends, steps, times: int) -> np.ndarray:
    """Values from the first end to the last, evenly between neighbours, about a step over so many times apart."""
    parts = [np.array(ends[:1])]
    for (a, b), step in zip(pairwise(ends), steps, strict=True):
        parts.append(np.linspace(a, b, times * max(round((b - a) / step), BESIDE) + 1)[1:])
    return np.concatenate(parts)


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
