"""The flow balance of every cell, the linear system of its unknowns, which cells are full, and what they add up to.

    div( E(H^3)/(12 mu) grad p ) = d(fill E(H))/dt + wm d(fill E(H))/dtheta
    p >= p_cav,   void >= 0,   (p - p_cav) void = 0

**Source** Elrod & Adams (1974), after Jakobsson & Floberg and Olsson: where the film is full (fill 1) the pressure is
unknown, where it cavitates it is the cavitation pressure and the fill is; the balance of volume is the same everywhere,
so that nothing is lost at the fronts between them (Elrod (1981), J. Lubr. Tech. 103, 350).

One unknown a cell: u >= 0 is the pressure above cavitation over the scale of the block, u < 0 the void, fill - 1.
Poiseuille flow by central differences, Couette flow with the film halfway between the nodes and the fill upstream:
second order in the cells where the film is full, first in the fill.  Every flow leaves one cell and enters another.

With the full cells given the balances are linear.  Full cells that come out below the cavitation pressure cavitate,
cavitated ones that come out fuller than full are full, and the system is solved again until no cell changes: the
solution is then exact.  A set near the solution, as of a step before, needs one to four rounds.
**Source** active sets as a semismooth Newton iteration: Hintermueller, Ito & Kunisch (2002), SIAM J. Optim. 13, 865;
of the cavitation problem Giacopini et al. (2010), J. Tribol. 132, 041702.
"""

import math

import numpy as np

from ...faces.geometry import (
    CAVITATED,
    FLOW_INNER,
    FLOW_OUTER,
    FORCE,
    INNER_PRESSURE,
    MEAN_SPIN,
    MOMENT_X,
    MOMENT_Y,
    OUTER_PRESSURE,
    SPIN_DIFFERENCE,
    TORQUE,
    VISCOSITY,
)
from ...numerics.kernel import inner_kernel, outer_kernel, value_kernel
from .._cells_around import eliminate, neighbours, place, room, unfold
from .mesh import (
    ANGLE_STEP,
    ANGLES,
    AREA,
    CAVITATES,
    CAVITATION,
    CELLS,
    DRAG,
    SCALE,
    SECTORS,
    TURNED,
    films,
    half_height,
    heights,
    mean_reciprocal,
    plateau,
    stored_rates,
    table,
)


@inner_kernel()
def split(f, u, p, fill):
    """Pressures `p` above cavitation (Pa) and `fill` of the unknowns `u`, all (angles, cells); a film that does not
    cavitate is full everywhere."""
    lowest = 0.0 if f[CAVITATES] != 0.0 else -np.inf
    for k in range(u.shape[0]):
        for j in range(u.shape[1]):
            p[k, j] = f[SCALE] * max(u[k, j], lowest)
            fill[k, j] = 1.0 + min(u[k, j] - max(u[k, j], lowest), 0.0)


@inner_kernel()
def lay_out(f, s, carried, ways, around, full, storing, stored, band, y):
    """Band matrix `band` (n, 2 width + 1) and right side `y` (n,) of the unknowns, in the order of `place`, with the
    cells that are `full` given: storing fill + stored = what flows in, both (angles, cells) in m^3/s."""
    angles, cells = full.shape
    width, scale, area = band.shape[1] // 2, f[SCALE], table(f, AREA)
    p_i, p_o = s[INNER_PRESSURE] - f[CAVITATION], s[OUTER_PRESSURE] - f[CAVITATION]
    band[:] = 0.0
    for k in range(angles):
        before, after = neighbours(k, angles)
        here = place(k, angles) * cells
        to_before, to_after = place(before, angles) * cells - here, place(after, angles) * cells - here
        for j in range(cells):
            at, wet = here + j, s[MEAN_SPIN] * area[j]
            row = band[at]
            # What all cells full at the cavitation pressure would lack.
            y[at] = wet * (carried[before, j] - carried[k, j]) - storing[k, j] - stored[k, j]
            if j == 0:
                y[at] += ways[k, 0] * p_i
            if j == cells - 1:
                y[at] += ways[k, cells] * p_o
            if full[k, j]:
                row[width] += scale * (ways[k, j] + ways[k, j + 1] + around[before, j] + around[k, j])
            else:
                row[width] += storing[k, j] + (wet * carried[k, j] if wet >= 0.0 else -wet * carried[before, j])
            if j > 0 and full[k, j - 1]:
                row[width - 1] -= scale * ways[k, j]
            if j < cells - 1 and full[k, j + 1]:
                row[width + 1] -= scale * ways[k, j + 1]
            if full[before, j]:
                row[width + to_before] -= scale * around[before, j]
            elif wet >= 0.0:
                row[width + to_before] -= wet * carried[before, j]
            if full[after, j]:
                row[width + to_after] -= scale * around[k, j]
            elif wet < 0.0:
                row[width + to_after] += wet * carried[k, j]


@inner_kernel()
def of_cells(f, x):
    """Pressure or void (angles, cells) among the unknowns `x` of the film."""
    angles, cells = int(f[ANGLES]), int(f[CELLS])
    return x[: angles * cells].reshape(angles, cells)


def line_load(f, x) -> np.ndarray:
    """What the pressure, counted from that of cavities, presses on the faces at each angle of a sector, (angles,) in N
    per rad; `x` the unknowns."""
    u = of_cells(f, x)
    p, fill = np.empty_like(u), np.empty_like(u)
    split(f, u, p, fill)
    return p @ table(f, AREA)[: u.shape[1]]


@value_kernel()
def wrench(f, s, x):
    """Force (N) and moments (N m) of the film's absolute pressure on the stator, and the share of the area that is
    cavitated, into the gap state; `x` the unknowns."""
    sum_up(f, s, of_cells(f, x))


@outer_kernel()
def sum_up(f, s, u):
    """As `wrench`, of pressure or void `u` (angles, cells) alone."""
    angles, cells = u.shape
    area, turned = table(f, AREA), table(f, TURNED)
    p, fill = np.empty_like(u), np.empty_like(u)
    split(f, u, p, fill)
    force = moment_x = moment_y = dry = whole = 0.0
    for k in range(angles):
        pressed = arm = 0.0
        for j in range(cells):
            pressed += (p[k, j] + f[CAVITATION]) * area[j]
            arm += (p[k, j] + f[CAVITATION]) * turned[j]
            whole += area[j]
            if fill[k, j] < 1.0:
                dry += area[j]
        force += pressed
        moment_x += math.sin(f[ANGLE_STEP] * k) * arm
        moment_y -= math.cos(f[ANGLE_STEP] * k) * arm
    # The moments of alike sectors cancel.
    step, single = f[ANGLE_STEP], 1.0 if f[SECTORS] == 1.0 else 0.0
    s[FORCE], s[CAVITATED] = step * f[SECTORS] * force, dry / whole
    s[MOMENT_X], s[MOMENT_Y] = single * step * moment_x, single * step * moment_y


@value_kernel()
def flow(f, s, x):
    """As `wrench`; also flow in +r (m^3/s) at both radii, and the viscous friction torque on the rotor (N m):
    int mu (W_r - W_s) r^3 E(1/H) dr dtheta over full and cavitated film alike, and what the pressure has on the slope
    of the faces, int p/2 dh/dtheta r dr dtheta with its sign."""
    u = of_cells(f, x)
    sum_up(f, s, u)
    angles, cells = u.shape
    _, _, ways, _ = films(f, s)
    p_i, p_o = s[INNER_PRESSURE] - f[CAVITATION], s[OUTER_PRESSURE] - f[CAVITATION]
    drag, c, b, area = table(f, DRAG), half_height(f), plateau(f), table(f, AREA)
    p, fill, nodes, between = np.empty_like(u), np.empty_like(u), np.empty_like(u), np.empty_like(u)
    split(f, u, p, fill)
    heights(f, s, nodes, between, np.empty((angles, cells + 1)))
    inner = outer = sheared = lifted = 0.0
    for k in range(angles):
        inner += ways[k, 0] * (p_i - p[k, 0])
        outer += ways[k, cells] * (p[k, cells - 1] - p_o)
        for j in range(cells):
            sheared += drag[j] * mean_reciprocal(nodes[k, j], c, b)
            lifted -= 0.5 * p[k, j] * area[j] * (between[k, j] - between[k - 1, j])
    s[FLOW_INNER], s[FLOW_OUTER] = f[SECTORS] * inner, f[SECTORS] * outer
    s[TORQUE] = f[SECTORS] * (f[ANGLE_STEP] * s[VISCOSITY] * s[SPIN_DIFFERENCE] * sheared + lifted)


# Rounds until the active set is given up, unknowns nearer to zero than this are rounding, and the code of that.
MOST_ROUNDS, ROUNDING = 200, 1e-13
# A time too short for anything but a pressure: share of the fastest change of the film, which takes at most 1/SLOW s.
SHORT, SLOW = 1e-6, 1.0
# Void below which a cell counts as full that is so at one step, and not at its neighbour.
ALMOST = 1e-3
UNSOLVED, ALIKE = 1, 2
STATUS = {
    UNSOLVED: "no pressures of the cavitating film are found (edges that are all at the cavitation pressure starve it)",
    ALIKE: "a tilt of a film of which one sector stands for all",
}


@inner_kernel()
def balance(f, s, carried, ways, around, storing, stored, u):
    """Unknowns `u` (angles, cells) for which `storing` fill + `stored` (m^3/s, of every cell) flow into every cell; at
    entry those near by, whose signs say which cells are taken for full.  Returns how many linear systems were solved,
    0 where none was found."""
    angles, cells = u.shape
    full, (band, y) = u > 0.0, room(angles, cells)
    if f[CAVITATES] == 0.0:
        full[:] = True
    for round_ in range(1, MOST_ROUNDS + 1):
        lay_out(f, s, carried, ways, around, full, storing, stored, band, y)
        if not eliminate(band, y):
            return 0
        unfold(y, u)
        if f[CAVITATES] == 0.0:
            return round_ if np.all(np.isfinite(u)) else 0
        changed = 0
        for k in range(angles):
            for j in range(cells):
                if not abs(u[k, j]) < np.inf:
                    return 0
                if full[k, j]:
                    if u[k, j] < -ROUNDING:
                        full[k, j], changed = False, changed + 1
                    else:
                        u[k, j] = max(u[k, j], 0.0)
                elif u[k, j] >= 0.0:
                    full[k, j], changed = True, changed + 1
        if changed == 0:
            return round_
    return 0


@outer_kernel()
def solve(f, s, u):
    """Unknowns `u` (angles, cells) of the film at rest at a gap state, whose rates do not matter; at entry those near
    by, or ones.  Returns how many linear systems were solved, 0 where none was found."""
    _, carried, ways, around = films(f, s)
    nothing = np.zeros_like(carried)
    return balance(f, s, carried, ways, around, nothing, nothing, u)


@outer_kernel()
def solve_moving(f, s, m, u):
    """Unknowns `u` (angles, cells) at a gap state that moves, of cells that hold the liquid `m` (angles, cells) (m);
    at entry those near by.  Returns as `solve`.

    A cell that is just full keeps its liquid or opens: what it does within a time so short that nothing else changes.
    """
    stored, carried, ways, around = films(f, s)
    rates, nothing, area = np.empty_like(stored), np.empty_like(stored), table(f, AREA)
    stored_rates(f, s, rates)
    per = np.inf
    for k in range(u.shape[0]):
        for j in range(u.shape[1]):
            per = min(per, SHORT * stored[k, j] / max(abs(rates[k, j]), stored[k, j] * SLOW))
    for k in range(u.shape[0]):
        for j in range(u.shape[1]):
            whole = area[j] * f[ANGLE_STEP] / per
            nothing[k, j], stored[k, j] = -whole * m[k, j], whole * (stored[k, j] + per * rates[k, j])
    return balance(f, s, carried, ways, around, stored, nothing, u)


@value_kernel()
def settle(f, s, alpha, base, x):
    """Unknowns `x` at the end of a step, at a gap state; at entry those near by.  The liquid's rate is there
    alpha (m - base), with the number `alpha` (1/s) and `base` (2 n,) of an implicit method.  Returns 0, or a code where
    none are found.

    The differences are of the liquid itself: whatever the step, none is lost, and pressures have no memory.
    """
    angles, cells = int(f[ANGLES]), int(f[CELLS])
    n, area = angles * cells, table(f, AREA)
    u = x[:n].reshape(angles, cells)
    stored, carried, ways, around = films(f, s)
    storing, held = np.empty_like(stored), np.empty_like(stored)
    for k in range(angles):
        for j in range(cells):
            whole = alpha * area[j] * f[ANGLE_STEP]
            storing[k, j], held[k, j] = whole * stored[k, j], -whole * base[n + k * cells + j]
    if balance(f, s, carried, ways, around, storing, held, u) == 0:
        return UNSOLVED
    for k in range(angles):
        for j in range(cells):
            void = min(u[k, j], 0.0) if f[CAVITATES] != 0.0 else 0.0
            x[n + k * cells + j] = stored[k, j] * (1.0 + void)
    return 0


@outer_kernel()
def between(f, s, x):
    """Unknowns `x` between two steps, at a gap state: the liquid there, of cells that are not quite full, gives all
    others; at entry `x` near by.  Returns 0, or a code where none are found."""
    angles, cells = int(f[ANGLES]), int(f[CELLS])
    n = angles * cells
    u, m = x[:n].reshape(angles, cells), x[n:].reshape(angles, cells)
    stored, _, _, _ = films(f, s)
    for k in range(angles):
        for j in range(cells):
            # A cell that is full at both steps has pressures between them.
            if f[CAVITATES] == 0.0 or (u[k, j] > 0.0 and m[k, j] > stored[k, j] * (1.0 - ALMOST)):
                m[k, j] = stored[k, j]
            elif u[k, j] > 0.0:
                u[k, j] = -ALMOST
    if solve_moving(f, s, m, u) == 0:
        return UNSOLVED
    keep_void(f, stored, m, u)
    return 0


@inner_kernel()
def keep_void(f, stored, m, u):
    """Give the cavitated cells among `u` the void that their liquid `m` (m) leaves of the mean film `stored` (m)."""
    if f[CAVITATES] != 0.0:
        for k in range(u.shape[0]):
            for j in range(u.shape[1]):
                if u[k, j] <= 0.0:
                    u[k, j] = min(m[k, j] / stored[k, j] - 1.0, 0.0)
