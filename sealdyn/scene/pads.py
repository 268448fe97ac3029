"""The `[[film.pads]]` tables: Rayleigh-step pads, shallow recesses in the face that stands still, which lift it where
the other face drags gas into them."""

import math
from dataclasses import dataclass

import numpy as np

from ..units import Angle, Length, Radius

# Edge of a pad's flank where it is not given, as a share of the pad's shorter side.
SHARP = 0.05


@dataclass(frozen=True)
class Pads:
    """One row of equal pads around the face: the film is thicker by `depth` over the angle of each pad and between its
    radii, with smooth flanks,

        depth/2 [tanh((x - a)/edge) - tanh((x - b)/edge)] over the radius, and the same around the circle

    A pad that reaches to a radius of the face is open there.  **Valid** pads far wider than `edge`, which cells must
    resolve."""

    __pydantic_config__ = {"extra": "forbid"}  # noqa: RUF012

    count: int
    """Pads to the circle."""
    depth: Length
    """By which the film is thicker in the pads."""
    angle: Angle
    """Of one pad, between the middles of its flanks."""
    inner_radius: Radius
    """Where a pad begins."""
    outer_radius: Radius
    """Where it ends."""
    edge: Length | None = None
    """Width of its flanks, from an eighth to seven eighths of the depth over twice it; 5 % of its shorter side."""
    phase: Angle = 0.0
    """Angle of the middle of the first pad, from the x axis."""


def edge_of(pads: Pads) -> float:
    """Width (m) of the flanks."""
    sides = pads.outer_radius - pads.inner_radius, pads.angle * 0.5 * (pads.inner_radius + pads.outer_radius)
    return SHARP * min(sides) if pads.edge is None else pads.edge


def depth_of(film, r, theta) -> np.ndarray:
    """By how much (m) the pads of a `Film` table widen the film at radii `r` (m) and angles `theta` (rad), which
    broadcast."""
    total = np.zeros(np.broadcast_shapes(np.shape(r), np.shape(theta)))
    for pads in film.pads:
        edge, pitch = edge_of(pads), 2.0 * math.pi / pads.count
        # A side at the edge of the face has no flank.
        inner = 1.0 if pads.inner_radius <= film.inner_radius else np.tanh((r - pads.inner_radius) / edge)
        outer = -1.0 if pads.outer_radius >= film.outer_radius else np.tanh((r - pads.outer_radius) / edge)
        # From the middle of the nearest pad and of its neighbours, along the mean circle of the pads.
        way, around = 0.5 * (pads.inner_radius + pads.outer_radius) / edge, 0.0
        off = np.mod(theta - pads.phase + 0.5 * pitch, pitch) - 0.5 * pitch
        for turned in (-pitch, 0.0, pitch):
            x = off + turned
            around = around + 0.5 * (np.tanh(way * (x + 0.5 * pads.angle)) - np.tanh(way * (x - 0.5 * pads.angle)))
        total = total + 0.5 * pads.depth * (inner - outer) * around
    return total


def pads_errors(film) -> list[tuple[str, str, str]]:
    """What the pads of a `Film` cannot have: (key below film, found, expected)."""
    bad = []
    for n, pads in enumerate(film.pads):
        key, turn = f"pads.{n}", 2.0 * math.pi
        if pads.count < 1:
            bad.append((f"{key}.count", f"{pads.count}", "a whole number from 1"))
            continue
        if not 0.0 <= pads.depth < math.inf:
            bad.append((f"{key}.depth", f"{pads.depth:g} m", "a finite depth >= 0"))
        if not 0.0 < pads.angle < turn / pads.count:
            expected = f"an angle above 0 and below {turn / pads.count:.4g} rad, a pitch of {pads.count} pads"
            bad.append((f"{key}.angle", f"{pads.angle:g} rad", expected))
            continue
        if not film.inner_radius <= pads.inner_radius < pads.outer_radius <= film.outer_radius:
            found = f"{pads.inner_radius:g} to {pads.outer_radius:g} m"
            expected = f"radii that increase, between {film.inner_radius:g} and {film.outer_radius:g} m"
            bad.append((f"{key}.inner_radius", found, expected))
            continue
        sides = pads.outer_radius - pads.inner_radius, pads.angle * 0.5 * (pads.inner_radius + pads.outer_radius)
        if pads.edge is not None and not 0.0 < pads.edge < 0.25 * min(sides):
            expected = f"a width above 0 and below {0.25 * min(sides):.4g} m, a quarter of the pad's shorter side"
            bad.append((f"{key}.edge", f"{pads.edge:g} m", expected))
    return bad
