"""The two-dimensional film of a liquid, as scenes ask for it.

    div( E(H^3)/(12 mu) grad p ) = d(fill E(H))/dt + wm d(fill E(H))/dtheta,   p >= p_cav,   fill <= 1

**Source** Reynolds (1886); cavitation that conserves mass: Jakobsson & Floberg, Olsson, Elrod & Adams (1974); rough
faces: Lebeck, Teale & Pierce (1979).
**Valid** laminar flow of an incompressible liquid without inertia; cavities at one pressure.
"""

import math
from dataclasses import replace

import numpy as np

from ...faces.contact import lay_asperities
from ...faces.film_thickness import lay_waves
from ...faces.geometry import (
    CLEARANCE,
    FORCE,
    GAP_STATE_SIZE,
    GX,
    GX_RATE,
    GY,
    GY_RATE,
    MEAN_SPIN,
    SPIN_DIFFERENCE,
    VISCOSITY,
)
from ...numerics.kernel import outer_kernel, value_kernel
from ...numerics.piecewise_linear import initially
from ...scene.film import AROUND, PER_WAVE, Reynolds, cells_of
from ...scene.patterns import alike_sectors, waves_of
from ...scene.scene import SceneError
from .._contract import FILL, PRESSURE, Film, FilmUnknowns, force_over_clearance
from . import OFFER
from .balance import driest, jacobian, pattern, residual
from .mesh import (
    ANGLE_STEP,
    ANGLES,
    AREA,
    AT_ONCE,
    CAVITATES,
    CAVITATION,
    CELLS,
    PACE,
    RADIUS,
    SCALE,
    SECTORS,
    TURNED,
    films,
    moves,
    parameters,
    table,
)
from .pressure import (
    ALIKE,
    STATUS,
    UNSOLVED,
    between,
    flow,
    keep_void,
    line_load,
    settle,
    solve,
    solve_moving,
    sum_up,
    wrench,
)


def accepts(film, waves=()) -> str:
    """What faces it takes, "" if it can take these."""
    if film is None:
        return ""
    if film.geometry != "cylindrical":
        return "cylindrical faces only"
    return "no inertia of the film" if film.inertia else ""


def prepared(scene):
    """The `Film` table with what the rest of the scene decides: the cells, and which part of the circle stands for
    all of it.  Raises SceneError for sectors that are not alike."""
    film, orders = scene.film, [wave.order for wave in waves_of(scene) if wave.amplitude]
    options = film.reynolds or Reynolds()
    around, alike = options.cells_theta or max(AROUND, PER_WAVE * max(orders, default=0)), alike_sectors(scene)
    if options.sectors is None:
        options = replace(options, sectors=alike or around)
    elif alike % options.sectors:
        found = f"{options.sectors} alike sectors of a scene that has {alike}"
        raise SceneError("film.reynolds.sectors", found, "a divisor of that, or nothing")
    cells_r, cells_theta, sectors = cells_of(replace(film, reynolds=options), orders)
    options = replace(options, cells_r=cells_r, cells_theta=cells_theta * sectors, sectors=sectors)
    return replace(film, reynolds=options)


def cells_are_given(film) -> bool:
    """Whether a `Film` table says itself how many cells there are."""
    options = film.reynolds or Reynolds()
    return options.cells_r is not None and options.cells_theta is not None


def doubled(film, times):
    """The `Film` table of `prepared` with twice its cells so many times; one angle stays one."""
    cells_r, angles, sectors = cells_of(film)
    angles = angles * 2**times if angles > 1 else 1
    options = replace(film.reynolds, cells_r=cells_r * 2**times, cells_theta=angles * sectors)
    return replace(film, reynolds=options)


def whole(film):
    """The `Film` table of the whole circle, cells as of the sector."""
    cells_r, angles, sectors = cells_of(film)
    around = max(angles * sectors, AROUND)
    return replace(film, reynolds=replace(film.reynolds, cells_r=cells_r, cells_theta=around, sectors=1))


def for_modes(f):
    """Leave the block `f` of a film that is linearised its real modes only: full cells go back to their volume at
    once."""
    f[PACE] = AT_ONCE


def grid_accuracy(film) -> float:
    """Relative error that the cells may have."""
    return film.reynolds.grid_accuracy


def halved(film):
    """The `Film` table with half the cells over the radius and around the circle."""
    cells_r, angles, sectors = cells_of(film)
    angles = max(angles // 2, 4) if angles > 2 else angles
    return replace(film, reynolds=replace(film.reynolds, cells_r=max(cells_r // 2, 2), cells_theta=angles * sectors))


def unknowns(f) -> FilmUnknowns:
    """Pressure or void of the cells, angle by angle, then the liquid of each (m), which has a rate."""
    cells, angles = int(f[CELLS]), int(f[ANGLES])
    n = cells * angles
    names = tuple(f"{name}_{angle}_{cell}" for name in ("film", "liquid") for angle in range(angles)
                  for cell in range(cells))  # fmt: skip
    scales = np.concatenate([np.ones(n), np.full(n, f[CLEARANCE])])
    return FilmUnknowns(names, scales, np.arange(2 * n) >= n, pattern(cells, angles), (angles, cells))


def opening_law(film, mean_spin=0.0, spin_difference=0.0, waves=None, contact=None):
    """Opening force (N) of the film between aligned faces, `force(clearance, inner_pressure, outer_pressure, floor)`:
    pressures absolute (Pa), clearance and floor of the film thickness in m; spins in rad/s; `waves` those of the stator
    and of the rotor (lists of Waviness), `contact` the Contact of rough faces.  It is the sum over the cells of a
    run."""
    f = parameters(film, film.clearance or 1.0)
    lay_waves(f, *(waves or ((), ())))
    if contact is not None:
        lay_asperities(contact, f)
    # From nothing, with every cell taken for full.
    s, u = np.zeros(GAP_STATE_SIZE), np.ones((int(f[ANGLES]), int(f[CELLS])))
    s[MEAN_SPIN], s[SPIN_DIFFERENCE], s[VISCOSITY] = mean_spin, spin_difference, initially(film.viscosity)

    def force(f, s):
        if solve(f, s, u):
            sum_up(f, s, u)
        else:
            s[FORCE], u[:] = math.nan, 1.0

    return force_over_clearance(film, f, s, force)


@outer_kernel()
def start(f, s, x):
    """Unknowns `x` of the film that was at rest until now at a gap state: its cavities, and the pressures of its
    motion.  Returns 0, or a code where none are found."""
    angles, cells = int(f[ANGLES]), int(f[CELLS])
    n = angles * cells
    if f[SECTORS] != 1.0 and (s[GX] != 0.0 or s[GY] != 0.0 or s[GX_RATE] != 0.0 or s[GY_RATE] != 0.0):
        return ALIKE
    u, m = x[:n].reshape(angles, cells), x[n:].reshape(angles, cells)
    u[:] = 1.0
    if solve(f, s, u) == 0:
        return UNSOLVED
    stored, _, _, _ = films(f, s)
    for k in range(angles):
        for j in range(cells):
            m[k, j] = stored[k, j] * (1.0 + (min(u[k, j], 0.0) if f[CAVITATES] != 0.0 else 0.0))
    if moves(f, s) and solve_moving(f, s, m, u) == 0:
        return UNSOLVED
    keep_void(f, stored, m, u)
    return 0


@value_kernel()
def wrench_jacobian(f, s, x, rows):
    """What force and moments have of every unknown, (3, 2 n)."""
    angles, cells = int(f[ANGLES]), int(f[CELLS])
    area, turned, dry = table(f, AREA), table(f, TURNED), driest(f)
    rows[:] = 0.0
    for k in range(angles):
        sin, cos = math.sin(f[ANGLE_STEP] * k), math.cos(f[ANGLE_STEP] * k)
        for j in range(cells):
            i = k * cells + j
            if x[i] > dry:
                per = f[SCALE] * f[ANGLE_STEP]
                rows[0, i] = per * f[SECTORS] * area[j]
                if f[SECTORS] == 1.0:
                    rows[1, i], rows[2, i] = per * turned[j] * sin, -per * turned[j] * cos


def grid(f) -> tuple[np.ndarray, np.ndarray]:
    """Radii (m) and angles (rad) of the cells' nodes, of the whole circle."""
    angles = int(f[ANGLES] * f[SECTORS])
    return table(f, RADIUS)[: int(f[CELLS])].copy(), 2.0 * math.pi / angles * np.arange(angles)


@outer_kernel()
def fields(f, s, x, out):
    """Pressure (Pa, absolute) and fill at the grid's radii and angles, `out` (2, radii, angles)."""
    angles, cells = int(f[ANGLES]), int(f[CELLS])
    for k in range(out.shape[2]):
        for j in range(cells):
            u = x[k % angles * cells + j]
            out[0, j, k] = f[CAVITATION] + f[SCALE] * (max(u, 0.0) if f[CAVITATES] != 0.0 else u)
            out[1, j, k] = 1.0 + (min(u, 0.0) if f[CAVITATES] != 0.0 else 0.0)


FILM = Film(
    **OFFER._asdict(),
    status=STATUS,
    accepts=accepts,
    parameters=parameters,
    opening_law=opening_law,
    standing_waves=True,
    waves_touch=True,
    patterned=f"{__package__.rpartition('.')[0]}._grooved.film",
    wrench=wrench,
    flow=flow,
    line_load=line_load,
    quantities=(PRESSURE, FILL),
    grid=grid,
    fields=fields,
    unknowns=unknowns,
    start=start,
    residual=residual,
    jacobian=jacobian,
    wrench_jacobian=wrench_jacobian,
    settle=settle,
    between=between,
    for_modes=for_modes,
    whole=whole,
    prepared=prepared,
    cells_are_given=cells_are_given,
    doubled=doubled,
    grid_accuracy=grid_accuracy,
    halved=halved,
)
