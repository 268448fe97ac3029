"""Patterns of a face that repeat around it: spiral grooves, boxes (T-grooves, pads), inclined elliptic dimples.

A pattern is described in the frame of its own face: phi is counted from the x axis of that face, and what is `depth`
deep widens the film whichever of the two faces has it.  Everything is drawn in (ln r, phi), where Reynolds' equation is
Cartesian, angles are true, and the edge of a spiral is a straight line:

    xi = phi - cot(angle) ln(r / inner_radius)      stays the same along the edge of a spiral

**Source** logarithmic spirals: Muijderman (1964), Spiral Groove Bearings.  Derived here: along r = r_g e^{phi tan a}
the path is inclined to the circle by a, tan a = d(ln r)/d phi, and the share of the pitch is the same on every circle.
**Valid** sharp edges, flat bottoms, `count` equal pitches.
"""

import math
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np


class Edges(NamedTuple):
    """Where the edges of one pitch lie, for a mesh with nodes on all of them.

    `radii` (m) at which edges along a circle lie; `angles` (rad), rising within one pitch, at which xi = phi - slope
    ln(r/reference) has the other edges between the radii of `twisted` (m) and stays as at these below and above;
    `slope` (1) is the cotangent of the edges' angle to the circle; `reference` in m."""

    radii: tuple[float, ...]
    angles: tuple[float, ...]
    slope: float
    twisted: tuple[float, float]

    @property
    def reference(self) -> float:
        """Radius (m) at which phi = xi."""
        return self.twisted[0]


def _off_middle(angle, count: int):
    """How far (rad) an angle (rad) is from the nearest of so many middles around the circle, the first at 0."""
    pitch = 2.0 * math.pi / count
    return np.mod(angle + 0.5 * pitch, pitch) - 0.5 * pitch


@dataclass(frozen=True)
class Spiral:
    """Logarithmic spiral grooves.

    `count` to the circle between two radii (m); `angle` (rad) to the circle, positive where the groove's radius grows
    with phi, below a right angle; `share` of the pitch that is groove; `depth` (m); `phase` (rad) the angle of the
    middle of the first groove at the inner radius."""

    count: int
    inner_radius: float
    outer_radius: float
    angle: float
    share: float
    depth: float
    phase: float = 0.0

    def depth_at(self, r, phi) -> np.ndarray:
        """Depth (m) at radii r (m) and angles phi (rad), which broadcast."""
        xi = phi - np.log(np.divide(r, self.inner_radius)) / math.tan(self.angle) - self.phase
        off, half = np.abs(_off_middle(xi, self.count)), math.pi * self.share / self.count
        inside = (r >= self.inner_radius) & (r <= self.outer_radius) & (off <= half)
        return np.where(inside, self.depth, 0.0)

    @property
    def edges(self) -> Edges:
        """Of one pitch."""
        half = math.pi * self.share / self.count
        angles = self.phase - half, self.phase + half
        radii = self.inner_radius, self.outer_radius
        return Edges(radii, angles, 1.0 / math.tan(self.angle), radii)


class Box(NamedTuple):
    """Between two radii (m) over a share of the pitch, its middle on the middle of the pitch."""

    inner_radius: float
    outer_radius: float
    share: float


@dataclass(frozen=True)
class Boxes:
    """Pads, or T-grooves of stem and arms: boxes in r and phi, all of one `depth` (m), `count` of each to the circle;
    `phase` (rad) the angle of the middle of the first."""

    count: int
    depth: float
    boxes: tuple[Box, ...]
    phase: float = 0.0

    def depth_at(self, r, phi) -> np.ndarray:
        """Depth (m) at radii r (m) and angles phi (rad), which broadcast; boxes that overlap are not deeper there."""
        off, half = np.abs(_off_middle(phi - self.phase, self.count)), math.pi / self.count
        inside = [(r >= box.inner_radius) & (r <= box.outer_radius) & (off <= half * box.share) for box in self.boxes]
        return np.where(np.any(inside, axis=0), self.depth, 0.0)

    @property
    def edges(self) -> Edges:
        """Of one pitch; nothing is twisted."""
        radii = sorted({radius for box in self.boxes for radius in box[:2]})
        halves = sorted({math.pi * box.share / self.count for box in self.boxes if box.share < 1.0})
        angles = [self.phase - half for half in reversed(halves)] + [self.phase + half for half in halves]
        return Edges(tuple(radii), tuple(angles) or (self.phase,), 0.0, (radii[0], radii[-1]))


@dataclass(frozen=True)
class Dimples:
    """Elliptic dimples with their centres at a `radius` (m), `length` and `width` their whole axes (m), the long one at
    an `angle` (rad) to the circle, positive where its radius grows with phi; `phase` (rad) of the first centre."""

    count: int
    radius: float
    length: float
    width: float
    angle: float
    depth: float
    phase: float = 0.0

    def level(self, r, phi) -> np.ndarray:
        """Below 0 in a dimple, 0 on its edge and above 0 on the lands, at radii r (m) and angles phi (rad), which
        broadcast."""
        pitch = 2.0 * math.pi / self.count
        across = self.radius * np.log(np.divide(r, self.radius))
        cos, sin = math.cos(self.angle), math.sin(self.angle)
        off, least = _off_middle(phi - self.phase, self.count), np.inf
        for turned in (-pitch, 0.0, pitch):
            along = self.radius * (off + turned)
            x, y = along * cos + across * sin, across * cos - along * sin
            least = np.minimum(least, np.hypot(2.0 * x / self.length, 2.0 * y / self.width))
        return least - 1.0

    def depth_at(self, r, phi) -> np.ndarray:
        """Depth (m) at radii r (m) and angles phi (rad), which broadcast; neighbours that overlap are not deeper."""
        return np.where(self.level(r, phi) < 0.0, self.depth, 0.0)

    @property
    def reach(self) -> tuple[float, float]:
        """Radii (m) between which the dimples lie."""
        sides = self.length * math.sin(self.angle), self.width * math.cos(self.angle)
        half = 0.5 * math.hypot(*sides) / self.radius
        return self.radius * math.exp(-half), self.radius * math.exp(half)

    @property
    def half_angle(self) -> float:
        """Half the angle (rad) that a dimple takes around the circle."""
        sides = self.length * math.cos(self.angle), self.width * math.sin(self.angle)
        return 0.5 * math.hypot(*sides) / self.radius


Pattern = Spiral | Boxes | Dimples


def pumps(angle: float, entrainment: float) -> str:
    """Which way spiral grooves at an `angle` (rad) pump under an entrainment (rad/s) in their frame: "outwards",
    "inwards" or "nowhere".

    **Source** derived here: grooves along e = (cos a, sin a) in (phi, ln r) drag along e the share wp cos a of the
    entrainment, whose radial part has the sign of wp sin a cos a."""
    sign = np.sign(math.tan(angle) * entrainment)
    return {1.0: "outwards", -1.0: "inwards", 0.0: "nowhere"}[float(sign)]
