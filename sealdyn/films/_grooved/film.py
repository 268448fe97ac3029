"""Film over a pattern in motion: the balances of balance.py over the whole circle, in the frame of the patterned face,
integrated with the rings.

Of a gas the unknowns are x = p H of the free nodes (Pa m), p the pressure and H the mean film of the node's median
cell, so that all that is stored is linear in them; of a liquid, which stores nothing, they are the pressures (Pa).
The tilt of the gap state enters as g' = g e^{-i psi}, psi the angle of the patterned face, and the moment leaves as
M = M' e^{i psi}: steps of an integrator see no groove pass.
**Source** balance.py; gas_reynolds/cells.py of the unknowns; cells.py has the cells.
**Valid** as balance.py, with tilts, of 3 pitches and more.  A liquid's film is full: where it would tear the run ends.
"""

import math
from dataclasses import replace

import numpy as np
from scipy.sparse import csc_array
from scipy.sparse.linalg import splu

from ...faces.geometry import (
    CAVITATED,
    CLEARANCE,
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
    TEMPERATURE,
    TORQUE,
    VISCOSITY,
)
from ...numerics.kernel import inner_kernel, outer_kernel, value_kernel
from ...numerics.piecewise_linear import initially
from ...scene.fluid import NORMAL_PRESSURE, NORMAL_TEMPERATURE, viscosity_of
from .._contract import PRESSURE, Film
from .aligned import MET, OpeningForce
from .balance import ARRIVED, LEAST, MOST_STEPS, PERMUTATION
from .cells import (
    AREA,
    BY_PHI,
    BY_U,
    CELL,
    CORNERS,
    COUNT,
    DEEPER,
    DEPTH,
    ENTRIES,
    FACE,
    FREE,
    GAS,
    LINKS,
    MIDDLE,
    NODES,
    PHI,
    PLACE,
    PRESSED,
    RADIUS,
    SCALE,
    SECTORS,
    SHIFTS,
    SLIP,
    TURNED,
    TURNED_TOO,
    cell_order,
    film_of_triangle,
    finer,
    halved,
    land_rates,
    lands,
    node_table,
    of_one_pitch,
    parameters,
    pattern_of_rows,
    prepared,
    state,
    tilt_of_sector,
    triangle_table,
    turned,
    unknowns,
    whole,
)

UNSOLVED, TORN = 1, 2
STATUS = {
    UNSOLVED: "no steady pressures of the film over grooves are found",
    TORN: "the liquid over the grooves would tear: its pressure falls below zero, and films there are full",
}
# Pressure below zero, as a share of the highest at the edges, at which a liquid's film ends: above it is what a solver
# tries.
PULLED = 1e-3
# Radii and angles to the pitch at which pressures are shown.
SHOWN_RADII, SHOWN_ANGLES = 25, 12
# Least share of a corner at which a point is in this triangle and no other.
INSIDE = 1e-9
# Share of the clearance within which the opening force is that of the clearance itself, not read between others.
NEAR = 0.01


def accepts(table, waves=()) -> str:
    """What faces it takes, "" if it can take these."""
    if waves or (table is not None and (table.geometry != "cylindrical" or table.profile is not None or table.pads)):
        return "cylindrical faces without waves, profile and pads"
    return ""


@inner_kernel()
def leaving(f, s, p, out):
    """What leaves each node's cell through the triangles, `out` (pitches, nodes)."""
    table, sectors, gas = triangle_table(f), p.shape[0], f[GAS] != 0.0
    angle, _, carried = turned(f, s)
    slip, per = f[SLIP] * s[TEMPERATURE] ** 0.5 if gas else 0.0, 1.0 / (12.0 * s[VISCOSITY])
    out[:] = 0.0
    for k in range(sectors):
        x, y = tilt_of_sector(f, s[GX], s[GY], angle, k)
        for t in range(table.shape[0]):
            row = table[t]
            h = film_of_triangle(f, s, row, x, y)
            viscous, slippery = per * h * h * h, slip * h * h
            by_u = by_phi = mean = 0.0
            for b in range(3):
                # No array of the three corners: that would be one for every triangle.
                here = p[(k + int(row[SHIFTS + b])) % sectors, int(row[CORNERS + b])]
                passed = (0.5 * viscous * abs(here) + slippery) * here if gas else viscous * here
                by_u += row[BY_U + b] * passed
                by_phi += row[BY_PHI + b] * passed
                mean += here
            by_phi -= carried * row[MIDDLE] ** 2 * h * (mean / 3.0 if gas else 1.0)
            for a in range(3):
                at = (k + int(row[SHIFTS + a])) % sectors
                out[at, int(row[CORNERS + a])] += row[AREA] * (row[BY_U + a] * by_u + row[BY_PHI + a] * by_phi)


@value_kernel()
def residual(f, s, x, x_rate, res):
    """What every cell stores and what leaves it, per area: of a gas Pa m/s, of a liquid m/s."""
    land, p = state(f, s, x)
    table, free, out = node_table(f), int(f[FREE]), np.empty(p.shape)
    leaving(f, s, p, out)
    if f[GAS] == 0.0:
        rates = np.empty(p.shape)
        land_rates(f, s, land, rates)
    else:
        rates = land
    for k in range(p.shape[0]):
        for i in range(p.shape[1]):
            at = k * free + int(table[PLACE, i])
            if table[PLACE, i] >= 0.0:
                res[at] = out[k, i] / table[CELL, i] + (x_rate[at] if f[GAS] != 0.0 else rates[k, i])
                if f[GAS] == 0.0 and p[k, i] < -PULLED * f[SCALE]:
                    return TORN
    return 0


@value_kernel()
def jacobian(f, s, x, x_rate, alpha, data):
    """d residual / d x + alpha d residual / d x_rate, in the order of the pattern."""
    land, p = state(f, s, x)
    nodes, table, sectors, gas = node_table(f), triangle_table(f), p.shape[0], f[GAS] != 0.0
    angle, _, carried = turned(f, s)
    slip, per = f[SLIP] * s[TEMPERATURE] ** 0.5 if gas else 0.0, 1.0 / (12.0 * s[VISCOSITY])
    entries, done = int(f[ENTRIES]), np.zeros((sectors, int(f[NODES])))
    data[:] = 0.0
    for k in range(sectors):
        tilt_x, tilt_y = tilt_of_sector(f, s[GX], s[GY], angle, k)
        for t in range(table.shape[0]):
            row = table[t]
            h = film_of_triangle(f, s, row, tilt_x, tilt_y)
            viscous, slippery = per * h * h * h, slip * h * h
            drag = carried * row[MIDDLE] ** 2 * h / 3.0 if gas else 0.0
            for b in range(3):
                j, kb = int(row[CORNERS + b]), (k + int(row[SHIFTS + b])) % sectors
                if nodes[PLACE, j] < 0.0:
                    continue
                way, by_unknown = viscous, 1.0
                if gas:
                    way = viscous * abs(p[kb, j]) + slippery
                    by_unknown = 1.0 / (land[kb, j] + nodes[DEEPER, j])
                kind = 0 if kb == 0 else 2 if kb == sectors - 1 else 1
                first = LINKS + 9 * (kind if sectors > 1 else 1) + b
                for a in range(3):
                    i = int(row[CORNERS + a])
                    if nodes[PLACE, i] < 0.0:
                        continue
                    flow_by = row[BY_U + a] * row[BY_U + b] * way + row[BY_PHI + a] * (row[BY_PHI + b] * way - drag)
                    at = kb * entries + int(row[first + 3 * a])
                    data[at] += row[AREA] * flow_by * by_unknown / nodes[CELL, i]
                    if gas and a == b and done[kb, j] == 0.0:
                        done[kb, j] = 1.0
                        data[at] += alpha


@inner_kernel()
def sum_up(f, s, p):
    """Force and moments of the pressures, into the gap state."""
    table, angle, sectors = node_table(f), turned(f, s)[0], p.shape[0]
    force = moment_x = moment_y = 0.0
    for k in range(sectors):
        pressed = real = imaginary = 0.0
        for i in range(p.shape[1]):
            pressed += p[k, i] * table[PRESSED, i]
            real += p[k, i] * table[TURNED, i]
            imaginary += p[k, i] * table[TURNED_TOO, i]
        force += pressed
        # -i times what is turned back to the inertial frame.
        x, y = tilt_of_sector(f, imaginary, -real, -angle, -k)
        moment_x, moment_y = moment_x + x, moment_y + y
    s[FORCE], s[CAVITATED] = force * f[COUNT] / sectors, 0.0
    # One pitch that stands for all presses with no moment.
    alone = sectors < f[COUNT]
    s[MOMENT_X], s[MOMENT_Y] = (0.0, 0.0) if alone else (moment_x, moment_y)


@value_kernel()
def wrench(f, s, x):
    """Force (N) and moments (N m) of the pressures on the stator, into the gap state."""
    sum_up(f, s, state(f, s, x)[1])


@value_kernel()
def wrench_jacobian(f, s, x, rows):
    """What force and moments have of every unknown, (3, n)."""
    land, _ = state(f, s, x)
    table, angle, free = node_table(f), turned(f, s)[0], int(f[FREE])
    for k in range(land.shape[0]):
        for i in range(land.shape[1]):
            if table[PLACE, i] >= 0.0:
                at, per = k * free + int(table[PLACE, i]), 1.0
                if f[GAS] != 0.0:
                    per = 1.0 / (land[k, i] + table[DEEPER, i])
                rows[0, at] = per * table[PRESSED, i]
                x_part, y_part = tilt_of_sector(f, table[TURNED_TOO, i], -table[TURNED, i], -angle, -k)
                rows[1, at], rows[2, at] = per * x_part, per * y_part


@value_kernel()
def flow(f, s, x):
    """As `wrench`; also flow in +r (m^3/s, of a gas at normal conditions) at both radii, and the friction torque on the
    rotor (N m): shear on the plain face, and the pressure on the slope of the film as of faces without a pattern."""
    land, p = state(f, s, x)
    sum_up(f, s, p)
    out, rates, nodes, table = np.empty(p.shape), np.empty(p.shape), node_table(f), triangle_table(f)
    leaving(f, s, p, out)
    land_rates(f, s, land, rates)
    sectors, gas = p.shape[0], f[GAS] != 0.0
    inner = outer = sheared = pushed = 0.0
    for k in range(sectors):
        for i in range(p.shape[1]):
            if nodes[PLACE, i] < 0.0:
                # What a cell at the edge takes up comes from outside, too.
                filled = out[k, i] + nodes[CELL, i] * rates[k, i] * (p[k, i] if gas else 1.0)
                if nodes[PLACE, i] == -1.0:
                    inner += filled
                else:
                    outer -= filled
        for t in range(table.shape[0]):
            row, slope = table[t], 0.0
            for b in range(3):
                i, kb = int(row[CORNERS + b]), (k + int(row[SHIFTS + b])) % sectors
                j, kj = int(row[CORNERS + (b + 1) % 3]), (k + int(row[SHIFTS + (b + 1) % 3])) % sectors
                slope += row[BY_PHI + b] * p[kb, i]
                # At the middles of the sides.
                squares = (nodes[RADIUS, i] * nodes[RADIUS, j]) ** 2
                sheared += row[AREA] / 3.0 * squares / (0.5 * (land[kb, i] + land[kj, j]) + row[DEPTH])
            pushed += 0.5 * row[AREA] * row[DEPTH] * row[MIDDLE] ** 2 * slope
    whole = f[COUNT] / sectors
    # Of the volume at the film's temperature and 1 Pa.
    normal = whole * (NORMAL_TEMPERATURE / (s[TEMPERATURE] * NORMAL_PRESSURE) if gas else 1.0)
    s[FLOW_INNER], s[FLOW_OUTER] = normal * inner, normal * outer
    lift = 0.5 * (s[GX] * s[MOMENT_Y] - s[GY] * s[MOMENT_X]) - f[FACE] * whole * pushed
    s[TORQUE] = s[VISCOSITY] * s[SPIN_DIFFERENCE] * whole * sheared + lift


def grid(f) -> tuple[np.ndarray, np.ndarray]:
    """Radii (m) and angles (rad, inertial) at which pressures are shown."""
    angles = SHOWN_ANGLES * int(f[COUNT])
    return np.linspace(f[INNER_RADIUS], f[OUTER_RADIUS], SHOWN_RADII), 2.0 * math.pi / angles * np.arange(angles)


@outer_kernel()
def fields(f, s, x, out):
    """Pressure (Pa, absolute) at the grid's radii and angles, `out` (1, radii, angles)."""
    _, p = state(f, s, x)
    nodes, table, sectors, angle = node_table(f), triangle_table(f), p.shape[0], turned(f, s)[0]
    pitch, radii, angles = 2.0 * math.pi / f[COUNT], out.shape[1], out.shape[2]
    for n in range(radii):
        u = math.log(f[INNER_RADIUS] + (f[OUTER_RADIUS] - f[INNER_RADIUS]) * n / (radii - 1))
        for m in range(angles):
            phi, best = 2.0 * math.pi * m / angles - angle, -np.inf
            for t in range(table.shape[0]):
                row = table[t]
                i = int(row[CORNERS])
                away_u = u - math.log(nodes[RADIUS, i])
                corner = nodes[PHI, i] + pitch * row[SHIFTS]
                # The pitch in which the first corner is nearest.
                k = round((phi - corner) / pitch)
                away_phi = phi - corner - pitch * k
                least, value = np.inf, 0.0
                for b in range(3):
                    share = row[BY_U + b] * away_u + row[BY_PHI + b] * away_phi + (1.0 if b == 0 else 0.0)
                    least = min(least, share)
                    value += share * p[int(k + row[SHIFTS + b]) % sectors, int(row[CORNERS + b])]
                if least > best:
                    best, out[0, n, m] = least, value
                if least > INSIDE:
                    break


# --- the steady film -----------------------------------------------------------------------------------


def start(f, s, x) -> int:
    """Unknowns `x` (n,) of the film that is steady in the pattern's frame at a gap state, but for what the gap's own
    rates squeeze.  Returns 0, or a code where none is found."""
    one, aligned, table = of_one_pitch(f), s.copy(), node_table(f)
    aligned[[GX, GY, GX_RATE, GY_RATE]] = 0.0
    share = np.log(table[RADIUS] / f[INNER_RADIUS]) / math.log(f[OUTER_RADIUS] / f[INNER_RADIUS])
    power = 2.0 if f[GAS] != 0.0 else 1.0
    inner, outer = s[INNER_PRESSURE] ** power, s[OUTER_PRESSURE] ** power
    held, _ = _held(one, aligned)
    first = (inner + share * (outer - inner))[table[PLACE] >= 0.0] ** (1.0 / power) * held
    if not _settled(one, aligned, first):
        return UNSOLVED
    if f[GAS] == 0.0 and first.min() < 0.0:
        return TORN
    if not np.any(s[[GX, GY, GX_RATE, GY_RATE]]):
        x[:] = np.tile(first, int(f[SECTORS]))
        return 0
    x[:] = np.tile(first / held, int(f[SECTORS])) * _held(f, s)[0]
    return 0 if _settled(f, s, x) else UNSOLVED


def _held(f, s) -> tuple[np.ndarray, np.ndarray]:
    """What the unknowns (n,) have of a pressure, and the shares of it (1/s) that the gap's rates squeeze out."""
    table, land = node_table(f), np.empty((int(f[SECTORS]), int(f[NODES])))
    rates, free = np.empty(land.shape), table[PLACE] >= 0.0
    lands(f, s, land)
    if f[GAS] == 0.0:
        return np.ones(free.sum() * len(land)), np.zeros(free.sum() * len(land))
    land_rates(f, s, land, rates)
    held = (land + table[DEEPER])[:, free].ravel()
    return held, rates[:, free].ravel() / held


def _settled(f, s, x) -> bool:
    """Newton's steps from `x` (n,) on, in place."""
    gas, pattern, (held, squeezed) = f[GAS] != 0.0, pattern_of_rows(f), _held(f, s)
    data, res = np.empty(int(f[ENTRIES] * f[SECTORS])), np.empty(len(x))
    own = csc_array((squeezed, np.arange(len(x)), np.arange(len(x) + 1)), shape=pattern.shape)
    for _ in range(MOST_STEPS):
        residual(f, s, x, squeezed * x, res)
        jacobian(f, s, x, res, 0.0, data)
        matrix = csc_array((data, pattern.indices, pattern.indptr), shape=pattern.shape)
        try:
            change = splu(csc_array(matrix + own), permc_spec=PERMUTATION).solve(-res)
        except RuntimeError:
            return False
        moved = np.abs(change / held).max()
        if not moved < np.inf:
            return False
        x[:] = np.maximum(x + change, LEAST * x) if gas else x + change
        if not gas or moved <= ARRIVED * np.abs(x / held).max():
            return True
    return False


def opening_law(table, mean_spin=0.0, spin_difference=0.0):
    """Opening force (N) of the aligned film, `force(clearance, inner_pressure, outer_pressure, floor)`, on the mesh of
    a run, so that rings rest where it balances the closing force; far from the clearance of the table read between."""
    f = parameters(replace(table, alike=True), 1.0)
    x, s = np.empty(int(f[FREE])), np.zeros(GAP_STATE_SIZE)
    s[MEAN_SPIN], s[SPIN_DIFFERENCE] = mean_spin, spin_difference
    s[VISCOSITY] = initially(viscosity_of(table))
    s[TEMPERATURE] = initially(table.temperature) if table.gas is not None else 0.0

    def exact(clearance, inner_pressure, outer_pressure):
        f[CLEARANCE] = clearance
        s[INNER_PRESSURE], s[OUTER_PRESSURE] = inner_pressure, outer_pressure
        if start(f, s, x):
            return math.nan
        wrench(f, s, x)
        return float(s[FORCE])

    def with_slope(clearance, inner_pressure, outer_pressure):
        beside = [exact(clearance * (1.0 + k * 1e-4), inner_pressure, outer_pressure) for k in (-1, 0, 1)]
        return beside[1], (beside[2] - beside[0]) / 2e-4

    laws = {None: OpeningForce(with_slope)}

    def force(clearance, inner_pressure, outer_pressure, floor=None):
        f[FLOOR] = floor or 0.0
        near = table.clearance is not None and abs(clearance / table.clearance - 1.0) < NEAR
        between = laws.setdefault(floor, OpeningForce(with_slope, MET))
        return (exact if near else between)(clearance, inner_pressure, outer_pressure)

    return force


def frame(f, s) -> float:
    """Speed (rad/s) of the frame in which the unknowns of the film stand."""
    return float(turned(f, s)[1])


FILM = Film(
    name="grooved",
    fidelity=4,
    fluids=("liquid", "gas"),
    status=STATUS,
    accepts=accepts,
    parameters=parameters,
    opening_law=opening_law,
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
    whole=whole,
    frame=frame,
    prepared=prepared,
    halved=halved,
    cell_order=cell_order,
    finer=finer,
)
