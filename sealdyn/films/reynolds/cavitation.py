"""Which cells are full and which cavitate: the complementarity of pressure and void.

    p >= p_cav,   void >= 0,   (p - p_cav) void = 0

**Source** active sets as a semismooth Newton iteration: Hintermueller, Ito & Kunisch (2002), SIAM J. Optim. 13, 865;
of the cavitation problem Giacopini et al. (2010), J. Tribol. 132, 041702.
With the full cells given the balances are linear.  Full cells that come out below the cavitation pressure cavitate,
cavitated ones that come out fuller than full are full, and the system is solved again until no cell changes: the
solution is then exact.  A set near the solution, as of a step before, needs one to four rounds.
"""

import numpy as np

from ...numerics.kernel import inner_kernel, outer_kernel, value_kernel
from .mesh import ANGLE_STEP, ANGLES, AREA, CAVITATES, CELLS, films, stored_rates, table
from .pressure import eliminate, lay_out, room, unfold

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
    found = balance(f, s, carried, ways, around, stored, nothing, u)
    return found


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


def unknowns(f) -> np.ndarray:
    """Ones (angles, cells): a start from nothing, with every cell taken for full."""
    return np.ones((int(f[ANGLES]), int(f[CELLS])))
