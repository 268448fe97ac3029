"""Gas film with storage: the unsteady isothermal Reynolds equation over radius and angle, integrated with the rings.

**Source** cells.py.
**Valid** isothermal ideal gas at the film's temperature, laminar, without inertia (no choking: "gas_dam"), with slip
down to films of some mean free paths; faces with coning, a profile, tilt, pads, and waves that stand still
(passing ones leave no steady film to start from and to linearise about), in cylindrical geometry.
Leakage is the volume at normal conditions.
"""

import math
from dataclasses import replace

import numpy as np
from scipy.sparse import csc_array

from ...faces.film_thickness import lay_waves
from ...faces.geometry import (
    CAVITATED,
    FLOW_INNER,
    FLOW_OUTER,
    FORCE,
    GAP_STATE_SIZE,
    GX,
    GY,
    MEAN_SPIN,
    MOMENT_X,
    MOMENT_Y,
    SPIN_DIFFERENCE,
    TEMPERATURE,
    TORQUE,
    VISCOSITY,
)
from ...numerics.kernel import inner_kernel, outer_kernel, value_kernel
from ...numerics.piecewise_linear import initially
from ...scene.fluid import NORMAL_PRESSURE, NORMAL_TEMPERATURE, GasReynolds, viscosity_of
from .._cells_around import balances
from .._contract import PRESSURE, Film, FilmUnknowns, force_over_clearance
from . import OFFER
from .cells import (
    ANGLES,
    AREA,
    CELLS,
    CORE,
    DRAG,
    PADDED,
    PRESSED,
    RADIUS,
    SCALE,
    SLOPE_STEP,
    TURNED,
    UNSOLVED,
    between,
    jacobian,
    pads,
    parameters,
    pressures,
    radial_ways,
    residual,
    sines,
    start,
    table,
    thicknesses,
)

STATUS = {UNSOLVED: "no steady pressures of the gas film are found"}


def accepts(film, waves=()) -> str:
    """What faces it takes, "" if it can take these."""
    return "" if film is None or film.geometry == "cylindrical" else "cylindrical faces only"


def unknowns(f) -> FilmUnknowns:
    """Products p h of the cells (Pa m), angle by angle, all with rates."""
    cells, angles = int(f[CELLS]), int(f[ANGLES])
    n, (rows, columns) = cells * angles, balances(cells, angles)
    pattern = csc_array((np.ones(len(rows)), (rows, columns)), shape=(n, n))
    pattern.sort_indices()
    names = tuple(f"gas_{angle}_{cell}" for angle in range(angles) for cell in range(cells))
    return FilmUnknowns(names, np.full(n, f[SCALE]), np.full(n, True), pattern, (angles, cells))


def halved(film):
    """The `Film` table with half the cells over the radius and around the circle."""
    options = film.gas_reynolds or GasReynolds()
    cells = tuple(max(count // 2, 3) for count in options.cells)
    return replace(film, gas_reynolds=replace(options, cells=cells))


def opening_law(film, mean_spin=0.0, spin_difference=0.0, waves=None):
    """Opening force (N) of the aligned film, `force(clearance, inner_pressure, outer_pressure, floor)`: pressures
    absolute (Pa), clearance and floor of the film thickness (without it the film's own) in m.  It is the sum over the
    cells of a run, so that rings rest where it balances the closing force; the spins (rad/s) matter to `waves` only,
    those of the stator and of the rotor (lists of Waviness)."""
    if waves is None and not film.pads:
        options = film.gas_reynolds or GasReynolds()
        # All angles are alike.
        f = parameters(replace(film, gas_reynolds=replace(options, cells=(options.cells[0], 3))), 1.0)
    else:
        f = parameters(film, 1.0)
        lay_waves(f, *(waves or ((), ())))
    s, x = np.zeros(GAP_STATE_SIZE), np.empty(int(f[CELLS] * f[ANGLES]))
    s[MEAN_SPIN], s[SPIN_DIFFERENCE] = mean_spin, spin_difference
    s[TEMPERATURE], s[VISCOSITY] = initially(film.temperature), initially(viscosity_of(film))

    def solve(f, s):
        if start(f, s, x):
            s[FORCE] = math.nan
        else:
            wrench(f, s, x)

    return force_over_clearance(film, f, s, solve)


@inner_kernel()
def _nodes(f, s, x):
    """Thicknesses (m), pressures (Pa) at the nodes, (angles, cells + 2), and the height of the waves (m)."""
    angles, cells = int(f[ANGLES]), int(f[CELLS])
    h, p, bumps = np.empty((angles, cells + 2)), np.empty((angles, cells + 2)), np.empty(angles)
    thicknesses(f, s, h, bumps)
    pressures(f, s, x, h, p)
    return h, p, bumps


@inner_kernel()
def _sum_up(f, s, p):
    """Force and moments of the pressures, into the gap state."""
    pressing, turning = table(f, PRESSED), table(f, TURNED)
    sin, cos = sines(f)
    force = moment_x = moment_y = 0.0
    for k in range(p.shape[0]):
        pressed = turned = 0.0
        for n in range(p.shape[1]):
            pressed += p[k, n] * pressing[n]
            turned += p[k, n] * turning[n]
        force += pressed
        moment_x += sin[k] * turned
        moment_y -= cos[k] * turned
    step = 2.0 * math.pi / p.shape[0]
    s[FORCE], s[MOMENT_X], s[MOMENT_Y], s[CAVITATED] = step * force, step * moment_x, step * moment_y, 0.0


@value_kernel()
def wrench(f, s, x):
    """Force (N) and moments (N m) of the pressures on the stator, into the gap state."""
    _, p, _ = _nodes(f, s, x)
    _sum_up(f, s, p)


@value_kernel()
def wrench_jacobian(f, s, x, rows):
    """What force and moments have of every unknown, (3, n)."""
    h, _, _ = _nodes(f, s, x)
    pressing, turning = table(f, PRESSED), table(f, TURNED)
    sin, cos = sines(f)
    angles, cells = h.shape[0], h.shape[1] - 2
    step = 2.0 * math.pi / angles
    for k in range(angles):
        for j in range(cells):
            i, per = k * cells + j, step / h[k, j + 1]
            rows[0, i] = per * pressing[j + 1]
            rows[1, i], rows[2, i] = per * turning[j + 1] * sin[k], -per * turning[j + 1] * cos[k]


@value_kernel()
def flow(f, s, x):
    """As `wrench`; also flow in +r (m^3/s at normal conditions) at both radii, and the friction torque on the rotor
    (N m): `int [mu (W_r - W_s) r^3/h + (h/2) r dp/dtheta] dr dtheta`, what the shaft supplies."""
    h, p, bumps = _nodes(f, s, x)
    _sum_up(f, s, p)
    angles, cells = h.shape[0], h.shape[1] - 2
    ways, slips = np.empty((angles, cells + 1)), np.empty((angles, cells + 1))
    radial_ways(f, s, h, ways, slips)
    area, core, pressing, drag = table(f, AREA), table(f, CORE), table(f, PRESSED), table(f, DRAG)
    last = cells - 1
    reach_i, reach_o = area[0] / core[0] - 1.0, area[last] / core[last] - 1.0
    inner = outer = couette = lift = 0.0
    for k in range(angles):
        first = between(p[k, 0], p[k, 1], ways[k, 0], slips[k, 0])
        second = between(p[k, 1], p[k, 2], ways[k, 1], slips[k, 1])
        inner += first + reach_i * (first - second)
        first = between(p[k, cells], p[k, cells + 1], ways[k, cells], slips[k, cells])
        second = between(p[k, last], p[k, cells], ways[k, last], slips[k, last])
        outer += first + reach_o * (first - second)
        pressed = 0.0
        for n in range(cells + 2):
            pressed += p[k, n] * pressing[n]
        for j in range(cells):
            couette += drag[j] / h[k, j + 1]
        after = k + 1 if k < angles - 1 else 0
        lift -= 0.5 * pressed * (bumps[after] - bumps[k - 1]) / f[SLOPE_STEP]
        if f[PADDED] != 0.0:
            deeper = pads(f)
            for n in range(cells + 2):
                lift -= 0.5 * p[k, n] * pressing[n] * (deeper[after, n] - deeper[k - 1, n]) / f[SLOPE_STEP]
    step = 2.0 * math.pi / angles
    # Of the volume at the film's temperature and 1 Pa.
    normal = step * NORMAL_TEMPERATURE / (s[TEMPERATURE] * NORMAL_PRESSURE)
    s[FLOW_INNER], s[FLOW_OUTER] = normal * inner, normal * outer
    # The pressure on the slope of the film, by parts: of the tilt, half the moment across it, times it.
    lift = step * lift + 0.5 * (s[GX] * s[MOMENT_Y] - s[GY] * s[MOMENT_X])
    s[TORQUE] = s[VISCOSITY] * s[SPIN_DIFFERENCE] * step * couette + lift


def grid(f) -> tuple[np.ndarray, np.ndarray]:
    """Radii (m) and angles (rad) of the cells' nodes, those of the face's edges too."""
    return table(f, RADIUS).copy(), 2.0 * math.pi / int(f[ANGLES]) * np.arange(int(f[ANGLES]))


@outer_kernel()
def fields(f, s, x, out):
    """Pressure (Pa, absolute) at the grid's radii and angles, `out` (1, radii, angles)."""
    _, p, _ = _nodes(f, s, x)
    out[0] = p.T


FILM = Film(
    **OFFER._asdict(),
    status=STATUS,
    accepts=accepts,
    parameters=parameters,
    opening_law=opening_law,
    pads=True,
    standing_waves=True,
    patterned=f"{__package__.rpartition('.')[0]}._grooved.film",
    wrench=wrench,
    flow=flow,
    quantities=(PRESSURE,),
    grid=grid,
    fields=fields,
    unknowns=unknowns,
    start=start,
    residual=residual,
    jacobian=jacobian,
    wrench_jacobian=wrench_jacobian,
    halved=halved,
)
