"""The cells in motion: what each cell stores, and which cells are full, as unknowns beside those of the rings.

    dm/dt = inflow(u)                          liquid m (m^3 over the cell's area: a height, m) of every cell
    full (u > 0):        inflow(u) = dE/dt + (E - m) pace
    cavitated (u <= 0):  m = E (1 + u)

with E the mean film at the cell's node and u the pressure above cavitation over the block's scale, or the void with its
sign.  The liquid is an unknown of its own and moves by flows alone, each of which leaves one cell and enters another:
nothing is lost, whatever a solver's tolerance.  A full cell keeps its liquid because the pressure sees to it; the last
term of its row, nothing in the exact solution, brings back what a solver errs.
**Source** the pair of unknowns and its rows: derived here from the balance of pressure.py.
"""

import numpy as np
from scipy.sparse import csc_array

from ...faces.geometry import INNER_PRESSURE, MEAN_SPIN, OUTER_PRESSURE, SPIN_DIFFERENCE
from ...numerics.kernel import inner_kernel, value_kernel
from .._cells_around import AFTER, BEFORE, INNER, OUTER, OWN, balances, neighbours
from .mesh import ANGLE_STEP, ANGLES, AREA, CAVITATES, CAVITATION, CELLS, PACE, SCALE, films, stored_rates, table
from .pressure import split

# The least pace (1/s) of faces that counts in bringing full cells back to their volume.
SLOWEST = 1.0 / 3.0
# Pressures less than this share of the scale are rounding of a cell that is just full.
DRIEST = 1e-10


def pattern(cells: int, angles: int) -> csc_array:
    """Where the rows of `residual` may hang on the unknowns, (2 n, 2 n)."""
    n = cells * angles
    own, (near, of) = np.arange(n), balances(cells, angles)
    rows, columns = np.concatenate([near, n + near, own, n + own]), np.concatenate([of, of, n + own, n + own])
    found = csc_array((np.ones(len(rows)), (rows, columns)), shape=(2 * n, 2 * n))
    found.sum_duplicates()
    found.sort_indices()
    return found


@inner_kernel()
def driest(f):
    """The largest unknown of a cell that counts as cavitated."""
    return DRIEST if f[CAVITATES] != 0.0 else -np.inf


@inner_kernel()
def inflow(f, s, u, carried, ways, around, out):
    """What flows into every cell over its area, `out` (angles, cells) (m/s), at unknowns `u` (angles, cells)."""
    angles, cells = u.shape
    area, turning = table(f, AREA), s[MEAN_SPIN]
    p, fill = np.empty_like(u), np.empty_like(u)
    split(f, u, p, fill)
    p_i, p_o = s[INNER_PRESSURE] - f[CAVITATION], s[OUTER_PRESSURE] - f[CAVITATION]
    for k in range(angles):
        before, after = neighbours(k, angles)
        arriving = ways[k, 0] * (p_i - p[k, 0])
        for j in range(cells):
            leaving = ways[k, j + 1] * (p[k, j] - (p[k, j + 1] if j < cells - 1 else p_o))
            along = around[before, j] * (p[before, j] - p[k, j]) - around[k, j] * (p[k, j] - p[after, j])
            came, went = (fill[before, j], fill[k, j]) if turning >= 0.0 else (fill[k, j], fill[after, j])
            dragged = turning * (carried[before, j] * came - carried[k, j] * went)
            out[k, j] = (arriving - leaving + along) / (area[j] * f[ANGLE_STEP]) + dragged / f[ANGLE_STEP]
            arriving = leaving


@inner_kernel()
def slopes(f, s, u, carried, ways, around, out):
    """Derivatives `out` (n, 5) of `inflow` by each cell's own unknown and its neighbours' (OWN, INNER, ...), m/s."""
    angles, cells = u.shape
    area, turning, dry = table(f, AREA), s[MEAN_SPIN] / f[ANGLE_STEP], driest(f)
    out[:] = 0.0
    for k in range(angles):
        before, after = neighbours(k, angles)
        for j in range(cells):
            row, per = out[k * cells + j], f[SCALE] / (area[j] * f[ANGLE_STEP])
            if u[k, j] > dry:
                row[OWN] = -per * (ways[k, j] + ways[k, j + 1] + around[before, j] + around[k, j])
            else:
                row[OWN] = -turning * carried[k, j] if turning >= 0.0 else turning * carried[before, j]
            if j > 0 and u[k, j - 1] > dry:
                row[INNER] = per * ways[k, j]
            if j < cells - 1 and u[k, j + 1] > dry:
                row[OUTER] = per * ways[k, j + 1]
            if u[before, j] > dry:
                row[BEFORE] = per * around[before, j]
            elif turning >= 0.0:
                row[BEFORE] = turning * carried[before, j]
            if u[after, j] > dry:
                row[AFTER] = per * around[k, j]
            elif turning < 0.0:
                row[AFTER] = -turning * carried[k, j]


@inner_kernel()
def pace(f, s):
    """How fast (1/s) a full cell is brought back to its volume."""
    return f[PACE] * max(abs(s[MEAN_SPIN]) + abs(s[SPIN_DIFFERENCE]), SLOWEST)


@value_kernel()
def residual(f, s, x, x_rate, res):
    """What is left of the rows above, those of u first, all in m/s."""
    angles, cells = int(f[ANGLES]), int(f[CELLS])
    n, dry = angles * cells, driest(f)
    u = x[:n].reshape(angles, cells)
    stored, carried, ways, around = films(f, s)
    rates, arriving, back = np.empty_like(stored), np.empty_like(stored), pace(f, s)
    stored_rates(f, s, rates)
    inflow(f, s, u, carried, ways, around, arriving)
    for k in range(angles):
        for j in range(cells):
            i = k * cells + j
            res[n + i] = x_rate[n + i] - arriving[k, j]
            if u[k, j] > dry:
                res[i] = arriving[k, j] - rates[k, j] - back * (stored[k, j] - x[n + i])
            else:
                res[i] = back * (x[n + i] - stored[k, j] * (1.0 + u[k, j]))
    return 0


@value_kernel()
def jacobian(f, s, x, x_rate, alpha, data):
    """d residual / d x + alpha d residual / d x_rate, in the order of the pattern (columns, rows rising)."""
    angles, cells = int(f[ANGLES]), int(f[CELLS])
    n, dry = angles * cells, driest(f)
    u = x[:n].reshape(angles, cells)
    stored, carried, ways, around = films(f, s)
    by, back = np.empty((n, 5)), pace(f, s)
    slopes(f, s, u, carried, ways, around, by)
    rows, values, at = np.empty(5, dtype=np.int64), np.empty(5), 0
    for k in range(angles):
        before, after = neighbours(k, angles)
        for j in range(cells):
            # The balances that know this cell, each once: on a short circle neighbours are the same.
            count = _meet(rows, values, 0, k * cells + j, by[k * cells + j, OWN])
            if j > 0:
                count = _meet(rows, values, count, k * cells + j - 1, by[k * cells + j - 1, OUTER])
            if j < cells - 1:
                count = _meet(rows, values, count, k * cells + j + 1, by[k * cells + j + 1, INNER])
            count = _meet(rows, values, count, before * cells + j, by[before * cells + j, AFTER])
            count = _meet(rows, values, count, after * cells + j, by[after * cells + j, BEFORE])
            for m in range(count):
                row = rows[m]
                full = u[row // cells, row % cells] > dry
                data[at + m] = values[m] if full else 0.0
                if row == k * cells + j and not full:
                    data[at + m] = -back * stored[k, j]
                data[at + count + m] = -values[m]
            at += 2 * count
    for _ in range(n):
        data[at], data[at + 1], at = back, alpha, at + 2


@inner_kernel()
def _meet(rows, values, count, row, value):
    """Put a `value` of a `row` among the first `count` of `rows` (rising) and `values`; returns how many they are."""
    m = count
    while m > 0 and rows[m - 1] > row:
        m -= 1
    if m > 0 and rows[m - 1] == row:
        values[m - 1] += value
        return count
    for later in range(count, m, -1):
        rows[later], values[later] = rows[later - 1], values[later - 1]
    rows[m], values[m] = row, value
    return count + 1
