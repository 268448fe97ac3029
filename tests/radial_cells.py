"""The radial film once more as a film with unknowns: finite volumes over the radius at every angle, for tests only.

**Source** Reynolds' equation without circumferential pressure flow, as in sealdyn/films/radial/film.py, with a liquid
that gives way a little (density 1 + beta p):

    (1/r) d/dr (r h^3/(12 mu) dp/dr) = dh/dt + wm dh/dtheta + beta h dp/dt

The unknowns are the pressures of the cells, those of one angle side by side.  A row is the volume balance of its cell
over the conductance of its edges (Pa): conductances at the edges, half cells at the two radii, the wedge and squeeze
integrated exactly over the cell.  Error of second order in the cells; the trapezoid around the circle is exact.
**Valid** cones in cylindrical geometry, every radius with its own tilt arm, above the floor of the film.
"""

import math

import numpy as np
from numba import njit
from scipy.sparse import csc_array

from sealdyn.faces.geometry import (
    CLEARANCE,
    CONING,
    DZ,
    DZ_RATE,
    FACE_SIZE,
    FLOOR,
    FLOW_INNER,
    FLOW_OUTER,
    FORCE,
    GAP_STATE_SIZE,
    GX,
    GX_RATE,
    GY,
    GY_RATE,
    INNER_PRESSURE,
    INNER_RADIUS,
    MEAN_SPIN,
    MOMENT_X,
    MOMENT_Y,
    OUTER_PRESSURE,
    OUTER_RADIUS,
    SPIN_DIFFERENCE,
    TORQUE,
    VISCOSITY,
    face_parameters,
    regularised_thickness,
)
from sealdyn.films._contract import PRESSURE as PRESSURE_FIELD
from sealdyn.films._contract import Film, FilmUnknowns

# Block after the faces: cells over the radius, angles, compressibility (1/Pa), scale of the pressure (Pa), and the
# thickness (m) at the inner radius below which it says that it has no solution.
CELLS, ANGLES, COMPRESSIBILITY, PRESSURE, THINNEST = range(FACE_SIZE, FACE_SIZE + 5)

STATUS = {1: "no pressures: a line of cells is singular", 2: "thinner than this film may be"}


def accepts(film, waves=()) -> str:
    """What faces it takes, "" if it can take these."""
    plain = film is None or (film.profile is None and film.geometry == "cylindrical" and film.tilt_radius == "local")
    return "" if plain and not waves else "cylindrical cones only"


def unknowns(f) -> FilmUnknowns:
    """Pressures of the cells (Pa), angle by angle: algebraic, unless the liquid is compressible."""
    cells, angles = int(f[CELLS]), int(f[ANGLES])
    n = cells * angles
    row = np.arange(n)
    inside = row % cells
    rows = np.concatenate([row, row[inside > 0] - 1, row[inside < cells - 1] + 1])
    columns = np.concatenate([row, row[inside > 0], row[inside < cells - 1]])
    pattern = csc_array((np.ones(len(rows)), (rows, columns)), shape=(n, n))
    pattern.sort_indices()
    names = tuple(f"pressure_{angle}_{cell}" for angle in range(angles) for cell in range(cells))
    return FilmUnknowns(names, np.full(n, f[PRESSURE]), np.full(n, f[COMPRESSIBILITY] > 0), pattern)


@njit(cache=True)
def _thickness(f, s, r, cos, sin):
    h = f[CLEARANCE] + s[DZ] + f[CONING] * (r - f[INNER_RADIUS]) + r * (s[GX] * sin - s[GY] * cos)
    return regularised_thickness(h, f[FLOOR])


@njit(cache=True)
def _conductances(f, s, cos, sin, out):
    """Volume flow per pressure and angle over the edges of one line, (cells + 1,)."""
    cells, r_i = int(f[CELLS]), f[INNER_RADIUS]
    width = (f[OUTER_RADIUS] - r_i) / cells
    for j in range(cells + 1):
        r = r_i + j * width
        run = 0.5 * width if j == 0 or j == cells else width
        out[j] = r * _thickness(f, s, r, cos, sin) ** 3 / (12.0 * s[VISCOSITY] * run)


@njit(cache=True)
def _sources(f, s, cell, cos, sin):
    """Squeeze and wedge of a cell, and what it stores per rate of its pressure; both per angle."""
    width = (f[OUTER_RADIUS] - f[INNER_RADIUS]) / f[CELLS]
    a = f[INNER_RADIUS] + cell * width
    b = a + width
    tilting = s[GX_RATE] * sin - s[GY_RATE] * cos + s[MEAN_SPIN] * (s[GX] * cos + s[GY] * sin)
    area = 0.5 * (b * b - a * a)
    driven = s[DZ_RATE] * area + tilting * (b**3 - a**3) / 3.0
    return driven, f[COMPRESSIBILITY] * _thickness(f, s, 0.5 * (a + b), cos, sin) * area


@njit(cache=True)
def residual(f, s, x, x_rate, res):
    """Volume balance of every cell (Pa)."""
    cells, angles = int(f[CELLS]), int(f[ANGLES])
    g = np.empty(cells + 1)
    for k in range(angles):
        theta = 2.0 * math.pi * k / angles
        cos, sin = math.cos(theta), math.sin(theta)
        if _thickness(f, s, f[INNER_RADIUS], cos, sin) < f[THINNEST]:
            return 2
        _conductances(f, s, cos, sin, g)
        for j in range(cells):
            i = k * cells + j
            inner = x[i - 1] if j > 0 else s[INNER_PRESSURE]
            outer = x[i + 1] if j < cells - 1 else s[OUTER_PRESSURE]
            driven, store = _sources(f, s, j, cos, sin)
            flow = g[j + 1] * (outer - x[i]) - g[j] * (x[i] - inner)
            res[i] = (flow - driven - store * x_rate[i]) / (g[j] + g[j + 1])
    return 0


@njit(cache=True)
def jacobian(f, s, x, x_rate, alpha, data):
    """d residual / d x + alpha d residual / d x_rate, in the order of the pattern (columns, rows rising)."""
    cells, angles = int(f[CELLS]), int(f[ANGLES])
    g, at = np.empty(cells + 1), 0
    for k in range(angles):
        theta = 2.0 * math.pi * k / angles
        cos, sin = math.cos(theta), math.sin(theta)
        _conductances(f, s, cos, sin, g)
        for j in range(cells):
            if j > 0:
                data[at], at = g[j] / (g[j - 1] + g[j]), at + 1
            data[at], at = -1.0 - alpha * _sources(f, s, j, cos, sin)[1] / (g[j] + g[j + 1]), at + 1
            if j < cells - 1:
                data[at], at = g[j + 1] / (g[j + 1] + g[j + 2]), at + 1


@njit(cache=True)
def start(f, s, x):
    """Pressures of the steady film, by elimination along every line (Thomas)."""
    cells, angles = int(f[CELLS]), int(f[ANGLES])
    g, above = np.empty(cells + 1), np.empty(cells)
    for k in range(angles):
        theta = 2.0 * math.pi * k / angles
        cos, sin = math.cos(theta), math.sin(theta)
        _conductances(f, s, cos, sin, g)
        first, pushed = k * cells, s[INNER_PRESSURE]
        for j in range(cells):
            kept = above[j - 1] if j > 0 else 0.0
            driven = _sources(f, s, j, cos, sin)[0]
            pivot = g[j] * (1.0 - kept) + g[j + 1]
            if not pivot > 0.0:
                return 1
            above[j] = g[j + 1] / pivot
            pushed = (g[j] * pushed - driven) / pivot
            x[first + j] = pushed
        after = s[OUTER_PRESSURE]
        for j in range(cells - 1, -1, -1):
            after = x[first + j] + above[j] * after
            x[first + j] = after
    return 0


@njit(cache=True)
def wrench_jacobian(f, s, x, rows):
    """What force and moments have of every pressure, (3, n)."""
    cells, angles = int(f[CELLS]), int(f[ANGLES])
    width = (f[OUTER_RADIUS] - f[INNER_RADIUS]) / cells
    for k in range(angles):
        theta = 2.0 * math.pi * k / angles
        for j in range(cells):
            a = f[INNER_RADIUS] + j * width
            b, i = a + width, k * cells + j
            arm = (b**3 - a**3) / 3.0 * (2.0 * math.pi / angles)
            rows[0, i] = 0.5 * (b * b - a * a) * (2.0 * math.pi / angles)
            rows[1, i], rows[2, i] = arm * math.sin(theta), -arm * math.cos(theta)


@njit(cache=True)
def wrench(f, s, x):
    """Force (N) and moments (N m) of the pressures on the stator, into the gap state."""
    cells, angles = int(f[CELLS]), int(f[ANGLES])
    width = (f[OUTER_RADIUS] - f[INNER_RADIUS]) / cells
    d_theta = 2.0 * math.pi / angles
    force = moment_x = moment_y = 0.0
    for k in range(angles):
        pressed = turned = 0.0
        for j in range(cells):
            a = f[INNER_RADIUS] + j * width
            b = a + width
            pressed += x[k * cells + j] * 0.5 * (b * b - a * a)
            turned += x[k * cells + j] * (b**3 - a**3) / 3.0
        force += pressed
        moment_x += math.sin(d_theta * k) * turned
        moment_y -= math.cos(d_theta * k) * turned
    s[FORCE], s[MOMENT_X], s[MOMENT_Y] = d_theta * force, d_theta * moment_x, d_theta * moment_y


@njit(cache=True)
def flow(f, s, x):
    """As `wrench`; also flow in +r (m^3/s) at both radii and the friction torque on the rotor (N m)."""
    wrench(f, s, x)
    cells, angles = int(f[CELLS]), int(f[ANGLES])
    width = (f[OUTER_RADIUS] - f[INNER_RADIUS]) / cells
    g, inner, outer, drag = np.empty(cells + 1), 0.0, 0.0, 0.0
    for k in range(angles):
        theta = 2.0 * math.pi * k / angles
        cos, sin = math.cos(theta), math.sin(theta)
        _conductances(f, s, cos, sin, g)
        inner -= g[0] * (x[k * cells] - s[INNER_PRESSURE])
        outer -= g[cells] * (s[OUTER_PRESSURE] - x[k * cells + cells - 1])
        for j in range(cells):
            r = f[INNER_RADIUS] + (j + 0.5) * width
            drag += width * r**3 / _thickness(f, s, r, cos, sin)
    d_theta = 2.0 * math.pi / angles
    s[FLOW_INNER], s[FLOW_OUTER] = inner * d_theta, outer * d_theta
    # The pressure on the slope of the film, by parts: half the moment across the tilt, times the tilt.
    across = s[GX] * s[MOMENT_Y] - s[GY] * s[MOMENT_X]
    s[TORQUE] = s[VISCOSITY] * s[SPIN_DIFFERENCE] * drag * d_theta + 0.5 * across


def grid(f):
    """Radii (m) of the cells' middles, and their angles (rad)."""
    cells, angles = int(f[CELLS]), int(f[ANGLES])
    width = (f[OUTER_RADIUS] - f[INNER_RADIUS]) / cells
    return f[INNER_RADIUS] + width * (np.arange(cells) + 0.5), 2 * math.pi / angles * np.arange(angles)


@njit(cache=True)
def fields(f, s, x, out):
    """The pressures (Pa) as they are, (1, cells, angles)."""
    cells, angles = int(f[CELLS]), int(f[ANGLES])
    for k in range(angles):
        for j in range(cells):
            out[0, j, k] = x[k * cells + j]


def film_of(
    cells: int, angles: int, compressibility: float = 0.0, own_derivatives: bool = True, thinnest: float = 0.0
) -> Film:
    """The film with so many cells over the radius and angles, `compressibility` in 1/Pa, without a solution where it is
    below `thinnest` (m); a Model takes it.  `own_derivatives`: with kernels for its derivatives,
    else by differences."""

    def parameters(film, clearance, error=None):
        f = np.zeros(THINNEST + 1)
        f[:FACE_SIZE] = face_parameters(film, clearance)
        f[CELLS], f[ANGLES], f[COMPRESSIBILITY] = cells, angles, compressibility
        f[PRESSURE], f[THINNEST] = 5e5, thinnest
        return f

    def opening_law(film, mean_spin=0.0, spin_difference=0.0):
        def force(clearance, inner_pressure, outer_pressure, floor=None):
            f, s, x = parameters(film, clearance), np.zeros(GAP_STATE_SIZE), np.empty(cells * angles)
            f[FLOOR] = f[FLOOR] if floor is None else floor
            s[VISCOSITY], s[INNER_PRESSURE], s[OUTER_PRESSURE] = 1.0, inner_pressure, outer_pressure
            start(f, s, x)
            wrench(f, s, x)
            return float(s[FORCE])

        return force

    return Film(
        name="radial_cells", fidelity=99, status=STATUS, accepts=accepts, parameters=parameters,
        opening_law=opening_law, unknowns=unknowns, start=start, residual=residual, wrench=wrench, flow=flow,
        quantities=(PRESSURE_FIELD,), grid=grid, fields=fields, jacobian=jacobian if own_derivatives else None,
        wrench_jacobian=wrench_jacobian if own_derivatives else None,
    )  # fmt: skip
