"""Cells of a film over a pattern around the whole circle, in the frame of the patterned face: the table and the block
of the film, where its Jacobian has entries, film thickness and pressures.

Nodes, triangles and what hangs on them are those of one pitch (mesh.py), pitch by pitch alike; a floor of the film
thickness is one of lands, to which the depth of a triangle is added.  In the frame, which has turned by psi, the tilt
of the gap state is g' = g e^{-i psi}, and its rate (dg/dt - i W_p g) e^{-i psi}.
"""

import math
from dataclasses import dataclass, replace
from functools import lru_cache

import numpy as np
from scipy.sparse import csc_array

from ...faces.geometry import (
    CLEARANCE,
    CONING,
    CONING_CHANGE,
    CONING_RATE,
    DZ,
    DZ_RATE,
    FACE_SIZE,
    FLOOR,
    GX,
    GX_RATE,
    GY,
    GY_RATE,
    INNER_PRESSURE,
    INNER_RADIUS,
    MEAN_SPIN,
    OUTER_PRESSURE,
    ROTOR_ANGLE,
    SPIN_DIFFERENCE,
    STATOR_ANGLE,
    face_parameters,
    regularised_thickness,
)
from ...numerics.kernel import inner_kernel
from ...numerics.piecewise_linear import points
from ...scene.film import Film as Table
from ...scene.film import Reynolds
from ...scene.fluid import GasReynolds, gas_of
from ...scene.patterns import Grooves, alike_sectors, grooves_of
from ...scene.scene import SceneError
from .._contract import FilmUnknowns
from .aligned import cavity_of, mesh_of_row
from .balance import Conditions as Aligned
from .balance import Film as Balance
from .balance import order as order_of_tips

# Block after the faces: nodes, free ones and triangles of a pitch, pitches that are computed, pitches of the circle, 1
# of a patterned rotor and -1 of a stator, whether a gas, what slip adds to K at a temperature of 1 K over h^2 (m/s),
# scale of an unknown, entries of the Jacobian's columns of a pitch.
NODES, FREE, TRIANGLES, SECTORS, COUNT, FACE, GAS, SLIP, SCALE, ENTRIES = range(FACE_SIZE, FACE_SIZE + 10)
TABLES = FACE_SIZE + 10
# Of nodes, a row each: radius (m), angle, its sine and cosine, place among the free ones (-1 and -2: at the inner and
# at the outer edge), area of the median cell (r^2 du dphi), by how much its mean film is deeper than the lands (m),
# weights of the pressure in the force and, real and imaginary, in int p r^2 e^{i phi}.
RADIUS, PHI, SIN, COS, PLACE, CELL, DEEPER, PRESSED, TURNED, TURNED_TOO, NODE_ROWS = range(11)
# Of triangles, a column each: radius (m) and sine and cosine of the angle of the middle, depth (m), area, gradients of
# the corners' functions by u and by phi, the corners' nodes and how many pitches they lie ahead; then where the
# derivative of what leaves a corner by the pressure of another stands among the columns of that one's pitch, for the
# first pitch, those between, and the last.
MIDDLE, MIDDLE_SIN, MIDDLE_COS, DEPTH, AREA, BY_U, BY_PHI, CORNERS, SHIFTS, LINKS = 0, 1, 2, 3, 4, 5, 8, 11, 14, 17
TRIANGLE_SIZE = LINKS + 27


@dataclass(frozen=True)
class GroovedTable(Table):
    """A `Film` table with the grooves of the scene and the ring whose face has them; `alike`: nothing tilts, and one
    pitch is computed for all; so many `times` the mesh of half the columns."""

    face: str = "rotor"
    grooves: Grooves | None = None
    alike: bool = False
    times: int = 2


def prepared(scene) -> GroovedTable:
    """The `Film` table of a scene with its grooves.  Raises SceneError where its liquid may tear: cavities are found in
    steady films only."""
    face, (one,) = grooves_of(scene)
    if (cavity := cavity_of(scene.film)) is not None:
        expected = "nothing where rings move: over grooves cavities are found in aligned films only, as of equilibrium"
        raise SceneError("film.cavitation_pressure", f"{cavity:g} Pa", expected)
    given = {name: value for name, value in vars(scene.film).items() if name not in ("face", "grooves", "alike")}
    return GroovedTable(**given, face=face, grooves=one, alike=alike_sectors(scene) != 1)


def whole(table) -> GroovedTable:
    """The table with all pitches of the circle."""
    return replace(table, alike=False)


def options_of(table):
    """Options of the film that `table` asks for."""
    return (table.reynolds or Reynolds()) if table.gas is None else (table.gas_reynolds or GasReynolds())


def halved(table):
    """The table with half the columns to a pitch, and half the rows: every second node of the mesh."""
    return replace(table, times=1)


def finer(table):
    """The table of aligned faces with four times the columns to a pitch, and four times the rows."""
    return replace(table, times=8, alike=True)


def cell_order(table) -> float:
    """Order of the error in the width of the columns, that of the tips, at the clearance of the table or, without one,
    at a film as thick as the grooves are deep."""
    clearance = table.clearance or max(table.grooves.depth, 1e-6)
    return order_of_tips(Balance(_mesh(table), Aligned(clearance, 1.0, 1.0, 1.0, 0.0, coning=0.0)))


def _mesh(table):
    """One pitch.  Raises SceneError where it has no mesh."""
    # Twice a mesh of half the columns, which is that of `halved`.
    return mesh_of_row(table.face, table.grooves, table, 0.5 * options_of(table).columns, table.times, least=1)


def parameters(table, clearance: float, error: float = 1e-8) -> np.ndarray:
    """The film's block, of a GroovedTable and the design clearance at the inner radius (m); `error` is not needed."""
    mesh, gas = _mesh(table), gas_of(table)
    nodes, triangles, r = len(mesh.u), len(mesh.corners), np.exp(mesh.u)
    f = np.zeros(TABLES + NODE_ROWS * nodes + TRIANGLE_SIZE * triangles)
    f[:FACE_SIZE] = face_parameters(table, clearance)
    pressure = max(*points(table.inner_pressure), *points(table.outer_pressure))
    slips = gas is not None and options_of(table).slip
    f[NODES:SCALE] = (
        nodes, len(mesh.free), triangles, 1.0 if table.alike else mesh.count, mesh.count,
        1.0 if table.face == "rotor" else -1.0, gas is not None,
        0.5 * math.sqrt(0.5 * math.pi * gas.gas_constant) if slips else 0.0,
    )  # fmt: skip
    f[SCALE] = pressure * clearance if gas else pressure
    # Weights and areas hang on the mesh alone.
    still = Balance(mesh, Aligned(1.0, 1.0, 1.0, 1.0, 0.0))
    part = mesh.area * still.r**2 / 3.0
    cells = np.bincount(mesh.corners.ravel(), np.repeat(part, 3), nodes)
    deeper = np.bincount(mesh.corners.ravel(), np.repeat(part * mesh.depth, 3), nodes)
    place = np.where(mesh.inner, -1.0, -2.0)
    place[mesh.free] = np.arange(len(mesh.free))
    turned = still.weights(2, 1)
    node_table(f)[:] = (
        r, mesh.phi, np.sin(mesh.phi), np.cos(mesh.phi), place, cells, deeper / cells, still.weights(1),
        turned.real, turned.imag,
    )  # fmt: skip
    rows = triangle_table(f)
    rows[:, :BY_U] = np.stack([still.r, np.sin(still.phi), np.cos(still.phi), mesh.depth, mesh.area], axis=1)
    rows[:, BY_U:LINKS] = np.hstack([*mesh.gradients, mesh.corners, mesh.shifts])
    return _linked(f)


def _linked(f) -> np.ndarray:
    """The block with what hangs on the pitches that are computed."""
    keys, _, places = links(f)
    f[ENTRIES] = keys.shape[1]
    triangle_table(f)[:, LINKS:] = np.concatenate([found.reshape(-1, 9) for found in places], axis=1)
    return f


def of_one_pitch(f) -> np.ndarray:
    """The block of one pitch that stands for all."""
    one = f.copy()
    one[SECTORS] = 1.0
    return _linked(one)


def links(f):
    """Entries of the Jacobian in the columns of one pitch: `keys` (2, entries) of column and row among the free nodes
    and `offsets` (entries,) of the row's pitch from the column's (-1, 0, 1), and of each triangle, row corner and
    column corner the place of its entry (triangles, 3, 3), 0 where a corner is not free: for columns of the first
    pitch, of those between and of the last, whose rows rise each in their own order."""
    return _links(*_pitches(f))


def _pitches(f) -> tuple[bytes, bytes, int, int]:
    """What links hang on: places of the nodes among the free ones, corners and shifts of the triangles, numbers of free
    nodes and of pitches.  A film is asked for often with one mesh."""
    return node_table(f)[PLACE].tobytes(), triangle_table(f)[:, CORNERS:LINKS].tobytes(), int(f[FREE]), int(f[SECTORS])


@lru_cache(maxsize=16)
def _links(nodes, triangles, free, sectors):
    corners, ahead = np.split(np.frombuffer(triangles).reshape(-1, LINKS - CORNERS).astype(int), 2, axis=1)
    place = np.frombuffer(nodes)[corners].astype(int)
    row, column = (np.broadcast_to(part, (len(corners), 3, 3)) for part in (place[:, :, None], place[:, None, :]))
    offset = np.broadcast_to(ahead[:, :, None] - ahead[:, None, :], row.shape)
    # One pitch has itself to both sides, two have each other.
    if sectors < 3:
        offset = offset % sectors
    taken = (row >= 0) & (column >= 0)
    places, codes = [], []
    for order in ((0, 1, -1), (-1, 0, 1), (1, -1, 0)):
        ranks = np.array([order.index(k) for k in (-1, 0, 1)])[offset[taken] + 1]
        code, found = np.unique((column[taken] * 3 + ranks) * free + row[taken], return_inverse=True)
        codes.append(code)
        places.append(np.zeros(row.shape))
        places[-1][taken] = found
    between = codes[1]
    return np.stack([between // (3 * free), between % free]), between // free % 3 - 1, places


def pattern_of_rows(f) -> csc_array:
    """Where the residual's derivative may differ from zero, (n, n)."""
    return _pattern(*_pitches(f))


@lru_cache(maxsize=16)
def _pattern(nodes, triangles, free, sectors) -> csc_array:
    keys, offsets, _ = _links(nodes, triangles, free, sectors)
    sector = np.arange(sectors)[:, None]
    columns = (sector * free + keys[0]).ravel()
    rows = ((sector + offsets) % sectors * free + keys[1]).ravel()
    found = csc_array((np.ones(len(rows)), (rows, columns)), shape=(sectors * free, sectors * free))
    found.sort_indices()
    return found


def unknowns(f) -> FilmUnknowns:
    """Products p H (Pa m) or pressures (Pa) of the free nodes, pitch by pitch."""
    free, sectors = int(f[FREE]), int(f[SECTORS])
    n, gas = free * sectors, f[GAS] != 0.0
    names = tuple(f"{'gas' if gas else 'film'}_{k}_{i}" for k in range(sectors) for i in range(free))
    return FilmUnknowns(names, np.full(n, f[SCALE]), np.full(n, gas), pattern_of_rows(f), (sectors, free))


@inner_kernel()
def node_table(f):
    """(NODE_ROWS, nodes)."""
    nodes = int(f[NODES])
    return f[TABLES : TABLES + NODE_ROWS * nodes].reshape(NODE_ROWS, nodes)


@inner_kernel()
def triangle_table(f):
    """(triangles, TRIANGLE_SIZE)."""
    return f[TABLES + NODE_ROWS * int(f[NODES]) :].reshape(int(f[TRIANGLES]), TRIANGLE_SIZE)


@inner_kernel()
def turned(f, s):
    """Angle (rad) and speed (rad/s) of the pattern's frame, and the entrainment in it (rad/s)."""
    half = 0.5 * s[SPIN_DIFFERENCE]
    if f[FACE] > 0.0:
        return s[ROTOR_ANGLE], s[MEAN_SPIN] + half, -half
    return s[STATOR_ANGLE], s[MEAN_SPIN] - half, half


@inner_kernel()
def tilt_of_sector(f, x, y, angle, k):
    """A vector in the plane of the face, seen from pitch k of a frame that has turned by an angle (rad)."""
    angle += 2.0 * math.pi * k / f[COUNT]
    cos, sin = math.cos(angle), math.sin(angle)
    return x * cos + y * sin, y * cos - x * sin


@inner_kernel()
def lands(f, s, land):
    """Film thickness over the lands `land` (pitches, nodes) (m)."""
    table, angle = node_table(f), turned(f, s)[0]
    aligned, coning = f[CLEARANCE] + s[DZ], f[CONING] + s[CONING_CHANGE]
    for k in range(land.shape[0]):
        x, y = tilt_of_sector(f, s[GX], s[GY], angle, k)
        for i in range(land.shape[1]):
            r = table[RADIUS, i]
            h = aligned + coning * (r - f[INNER_RADIUS]) + r * (x * table[SIN, i] - y * table[COS, i])
            land[k, i] = regularised_thickness(h, f[FLOOR])


@inner_kernel()
def land_rates(f, s, land, rates):
    """Their rates `rates` (pitches, nodes) in the pattern's frame (m/s)."""
    table, (angle, spin, _) = node_table(f), turned(f, s)
    x_rate, y_rate = s[GX_RATE] + spin * s[GY], s[GY_RATE] - spin * s[GX]
    for k in range(land.shape[0]):
        x, y = tilt_of_sector(f, x_rate, y_rate, angle, k)
        for i in range(land.shape[1]):
            r = table[RADIUS, i]
            rate = s[DZ_RATE] + s[CONING_RATE] * (r - f[INNER_RADIUS]) + r * (x * table[SIN, i] - y * table[COS, i])
            # Below the floor its continuation moves less.
            rates[k, i] = rate if land[k, i] >= f[FLOOR] else rate * (land[k, i] / f[FLOOR]) ** 2


@inner_kernel()
def film_of_triangle(f, s, row, x, y):
    """Film thickness (m) in the middle of a triangle, at the tilt of its pitch."""
    r = row[MIDDLE]
    h = f[CLEARANCE] + s[DZ] + (f[CONING] + s[CONING_CHANGE]) * (r - f[INNER_RADIUS])
    return regularised_thickness(h + r * (x * row[MIDDLE_SIN] - y * row[MIDDLE_COS]), f[FLOOR]) + row[DEPTH]


@inner_kernel()
def pressures(f, s, x, land, p):
    """Pressures `p` (pitches, nodes) (Pa)."""
    table, free = node_table(f), int(f[FREE])
    for k in range(p.shape[0]):
        for i in range(p.shape[1]):
            at = int(table[PLACE, i])
            if at >= 0:
                p[k, i] = x[k * free + at] / (land[k, i] + table[DEEPER, i] if f[GAS] != 0.0 else 1.0)
            else:
                p[k, i] = s[INNER_PRESSURE] if at == -1 else s[OUTER_PRESSURE]


@inner_kernel()
def state(f, s, x):
    """Film thickness over the lands (m) and pressures (Pa) at the nodes, (pitches, nodes)."""
    land, p = np.empty((int(f[SECTORS]), int(f[NODES]))), np.empty((int(f[SECTORS]), int(f[NODES])))
    lands(f, s, land)
    pressures(f, s, x, land, p)
    return land, p
