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
from .mesh import MOST_NODES, Mesh, mesh_of

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
    level = pattern.level(np.exp(radial), around)
    moved, places = np.full(level.shape, np.inf), np.stack([radial, around])
    rows = np.arange(len(radial))[:, None] * np.ones(radial.shape[1], dtype=int)
    for axis, ahead in ((0, 1), (1, 1)):
        after = np.roll(np.stack([radial, around]), -ahead, axis=axis + 1)
        if axis == 1:
            after[1, :, -1] += pitch
        other = np.roll(level, -ahead, axis=axis)
        crossed = level * other < 0.0
        if axis == 0:
            crossed[-1] = False
        here = np.argwhere(crossed)
        begin, end = np.stack([radial, around])[:, crossed], after[:, crossed]
        share = _crossing(pattern, begin, end, level[crossed])
        near = share <= 0.5
        if axis == 0:
            # Nodes on the edges of the face stay there.
            near = np.where(rows[crossed] == 0, False, np.where(rows[crossed] == len(radial) - 2, True, near))
        for (i, j), t, first, a, b in zip(here, share, near, begin.T, end.T, strict=True):
            place, way = a + t * (b - a), t if first else 1.0 - t
            k, m = (i, j) if first else ((i + 1, j) if axis == 0 else (i, (j + 1) % level.shape[1]))
            if not first and axis == 1 and j + 1 == level.shape[1]:
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
    rows, n = radial.shape
    node, shift = np.arange(rows * n).reshape(rows, n), np.zeros((rows, n), dtype=int)
    shift[:, -1] = 1

    def ahead(part):
        return np.roll(part, -1, axis=1)

    a, b, c, d = node[:-1].ravel(), ahead(node)[:-1].ravel(), node[1:].ravel(), ahead(node)[1:].ravel()
    after = ahead(around) + pitch * shift
    up = np.hypot(after[1:] - around[:-1], ahead(radial)[1:] - radial[:-1])
    down = np.hypot(around[1:] - after[:-1], radial[1:] - ahead(radial)[:-1])
    passes_up, passes_down = side[:-1] * ahead(side)[1:] < 0.0, ahead(side)[:-1] * side[1:] < 0.0
    forward = (passes_down | (~passes_up & (up < down))).ravel()[:, None]
    s, zero = shift[:-1].ravel(), np.zeros(len(a), dtype=int)
    first = np.where(forward, np.stack([a, d, b], 1), np.stack([a, c, b], 1))
    second = np.where(forward, np.stack([a, c, d], 1), np.stack([b, c, d], 1))
    first_shift = np.where(forward, np.stack([zero, s, s], 1), np.stack([zero, zero, s], 1))
    second_shift = np.where(forward, np.stack([zero, zero, s], 1), np.stack([s, zero, s], 1))
    return np.concatenate([first, second]), np.concatenate([first_shift, second_shift])
