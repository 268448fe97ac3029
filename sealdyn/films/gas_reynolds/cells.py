"""Cells over the face: the gas Reynolds film's parameter block, and the film thickness at the cells' nodes.

Every cell has a node, and both edges of the face are nodes too.  A cell reaches from halfway to the node before to
halfway to the next, where the difference of two nodes is the slope; the first and the last cell reach to the edge of
the face, and what flows over that edge is what flows at the half of the way, with the cell's own rate in between.
Towards the edges the cells get narrower: gas that is squeezed fast escapes from a thin layer there, and a gas that
expands falls in pressure most before its outlet.
"""

import math
from itertools import pairwise

import numpy as np

from ...faces.film_thickness import film_thickness, waves, waves_rate
from ...faces.geometry import (
    CLEARANCE,
    CONING_CHANGE,
    CONING_RATE,
    DZ,
    DZ_RATE,
    FACE_SIZE,
    FLOOR,
    GAP_STATE_SIZE,
    GX,
    GX_RATE,
    GY,
    GY_RATE,
    TILT_AT_MEAN,
    face_parameters,
    regularised_thickness,
)
from ...numerics.kernel import inner_kernel
from ...numerics.piecewise_linear import points
from ...scene.film import depth_of
from ...scene.fluid import GasReynolds, gas_of

# Block after the faces: cells over the radius, angles, scale of an unknown (Pa m), what slip adds to the flow at a
# temperature of 1 K (m/s, 0 without), and the steps of differences around the circle: 2 sin(d_theta) of a slope,
# (2 sin(d_theta/2))^2 of a curvature, exact for tilt; whether there are pads.
CELLS, ANGLES, SCALE, SLIP, SLOPE_STEP, CURVATURE_STEP, PADDED, TABLES = range(FACE_SIZE, FACE_SIZE + 8)
# Tables, each with room for all nodes: radius (m), rise of the aligned film from the clearance (m), arm of the tilt (m)
# at each node; ln of the ratio of radii from a node to the next; of each cell int r dr (m^2), without what is between
# its node and the edge of the face, and with it; int dr/r over the latter (1/m^2), int r^3 dr (m^4); what force (m^2)
# and moment (m^3) have of the pressure of each node, per rad.  Then sines and cosines of the angles, and of pads their
# depth (m) at each node, angle by angle.
RADIUS, RISE, ARM, APART, CORE, AREA, AROUND, DRAG, PRESSED, TURNED, ROWS = range(11)
# How much narrower the cells at the edges are: 0 all alike, 1 as the cosines of equal angles.
GRADING = 0.8
# Exact for what `weights` integrates.
POINTS, WEIGHTS = np.polynomial.legendre.leggauss(4)


def radii(inner_radius: float, outer_radius: float, cells: int, grading: float) -> np.ndarray:
    """Radii (m) of the nodes, (cells + 2,)."""
    even = np.concatenate([[0.0], (np.arange(cells) + 0.5) / cells, [1.0]])
    share = (1.0 - grading) * even + grading * 0.5 * (1.0 - np.cos(np.pi * even))
    return inner_radius + (outer_radius - inner_radius) * share


def weights(r: np.ndarray, between: np.ndarray, power: int) -> np.ndarray:
    """What the integral of p r^power dr over the face has of p at the nodes `r` (m), (nodes,): parabolas through three
    nodes each from one of the radii `between` (m), (nodes - 1,), to the next; those at the ends reach to the edges."""
    found, limits = np.zeros(len(r)), np.concatenate([r[:1], between[1:-1], r[-1:]])
    for n, (a, b) in enumerate(pairwise(limits)):
        # Counted from the middle node, in half widths.
        middle, half = r[n + 1], 0.5 * (r[n + 2] - r[n])
        x = (0.5 * (a + b) - middle + 0.5 * (b - a) * POINTS) / half
        moments = [0.5 * (b - a) * np.sum(WEIGHTS * x**k * (middle + half * x) ** power) for k in range(3)]
        at = (r[n : n + 3] - middle) / half
        found[n : n + 3] += np.linalg.solve(np.vander(at, increasing=True).T, moments)
    return found


def parameters(film, clearance: float, error: float = 1e-8, grading: float = GRADING) -> np.ndarray:
    """The film's block of the parameter array: a Film table and the design clearance at the inner radius (m).  `error`
    is not needed: the cells are as many as the scene says.  `grading` from 0, all alike, to 1."""
    options = film.gas_reynolds or GasReynolds()
    cells, angles = options.cells
    nodes = cells + 2
    f = np.zeros(TABLES + ROWS * nodes + 2 * angles + (angles * nodes if film.pads else 0))
    f[:FACE_SIZE] = face_parameters(film, clearance)
    f[CELLS], f[ANGLES] = cells, angles
    f[SCALE] = max(*points(film.inner_pressure), *points(film.outer_pressure)) * clearance
    # Mean free path viscosity/pressure sqrt(pi R T/2).
    f[SLIP] = 0.5 * math.sqrt(0.5 * math.pi * gas_of(film).gas_constant) if options.slip else 0.0
    step = 2.0 * math.pi / angles
    f[SLOPE_STEP], f[CURVATURE_STEP] = 2.0 * math.sin(step), 4.0 * math.sin(0.5 * step) ** 2

    r = radii(film.inner_radius, film.outer_radius, cells, grading)
    between = 0.5 * (r[:-1] + r[1:])
    edges = np.concatenate([r[:1], between[1:-1], r[-1:]])
    a, b = edges[:-1], edges[1:]
    mean, still = 0.5 * (film.inner_radius + film.outer_radius), np.zeros(GAP_STATE_SIZE)
    tables = f[TABLES : TABLES + ROWS * nodes].reshape(ROWS, nodes)
    tables[RADIUS], tables[ARM] = r, mean if f[TILT_AT_MEAN] else r
    # Waves are laid later.
    tables[RISE] = [film_thickness(f, still, radius, 0.0) - f[CLEARANCE] for radius in r]
    tables[APART, : cells + 1] = np.log(r[1:] / r[:-1])
    tables[CORE, :cells] = 0.5 * np.diff(between**2)
    tables[AREA, :cells], tables[AROUND, :cells] = 0.5 * (b * b - a * a), np.log(b / a)
    tables[AROUND, :cells] /= tables[AREA, :cells]
    tables[DRAG, :cells] = 0.25 * (b**4 - a**4)
    tables[PRESSED] = weights(r, between, 1)
    tables[TURNED] = mean * tables[PRESSED] if f[TILT_AT_MEAN] else weights(r, between, 2)
    theta = step * np.arange(angles)
    last = TABLES + ROWS * nodes + 2 * angles
    f[TABLES + ROWS * nodes : last] = np.concatenate([np.sin(theta), np.cos(theta)])
    if film.pads:
        f[PADDED], f[last:] = 1.0, depth_of(film, r, theta[:, None]).ravel()
    return f


@inner_kernel()
def table(f, which):
    """One of the tables of a block, (cells + 2,)."""
    nodes = int(f[CELLS]) + 2
    return f[TABLES + which * nodes : TABLES + (which + 1) * nodes]


@inner_kernel()
def sines(f):
    """Sines and cosines of the angles of a block, both (angles,)."""
    first, angles = TABLES + ROWS * (int(f[CELLS]) + 2), int(f[ANGLES])
    return f[first : first + angles], f[first + angles : first + 2 * angles]


@inner_kernel()
def pads(f):
    """Depth of the pads (angles, cells + 2) (m) of a block that has them."""
    angles, nodes = int(f[ANGLES]), int(f[CELLS]) + 2
    first = TABLES + ROWS * nodes + 2 * angles
    return f[first : first + angles * nodes].reshape(angles, nodes)


@inner_kernel()
def thicknesses(f, s, h, bumps):
    """Film thickness `h` (angles, cells + 2) at the nodes (m), as the film's flow sees it, and what the waves have of
    it, `bumps` (angles,) (m)."""
    rise, arm, radius = table(f, RISE), table(f, ARM), table(f, RADIUS)
    sin, cos = sines(f)
    deeper = TABLES + ROWS * h.shape[1] + 2 * h.shape[0]
    for k in range(h.shape[0]):
        bumps[k] = waves(f, s, 2.0 * math.pi * k / h.shape[0])
        aligned, tilt = f[CLEARANCE] + s[DZ] + bumps[k], s[GX] * sin[k] - s[GY] * cos[k]
        for n in range(h.shape[1]):
            coned = rise[n] + s[CONING_CHANGE] * (radius[n] - radius[0])
            if f[PADDED] != 0.0:
                coned += f[deeper + k * h.shape[1] + n]
            h[k, n] = regularised_thickness(aligned + coned + arm[n] * tilt, f[FLOOR])


@inner_kernel()
def thickness_rates(f, s, h, rates):
    """Rates `rates` (angles, cells) of the film thickness `h` of `thicknesses` in the cells (m/s), of the gap state's
    own rates."""
    arm, radius, floor = table(f, ARM), table(f, RADIUS), f[FLOOR]
    sin, cos = sines(f)
    for k in range(rates.shape[0]):
        aligned = s[DZ_RATE] + waves_rate(f, s, 2.0 * math.pi * k / rates.shape[0])
        tilting = s[GX_RATE] * sin[k] - s[GY_RATE] * cos[k]
        for j in range(rates.shape[1]):
            # Below the floor its continuation moves less.
            slope = 1.0 if h[k, j + 1] >= floor else (h[k, j + 1] / floor) ** 2
            coned = s[CONING_RATE] * (radius[j + 1] - radius[0])
            rates[k, j] = slope * (aligned + coned + arm[j + 1] * tilting)
