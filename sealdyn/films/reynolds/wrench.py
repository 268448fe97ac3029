"""What the cells add up to: force, moments, leakage, friction, how much of the face cavitates."""

import math

import numpy as np

from ...faces.geometry import (
    CAVITATED,
    FLOW_INNER,
    FLOW_OUTER,
    FORCE,
    INNER_PRESSURE,
    MOMENT_X,
    MOMENT_Y,
    OUTER_PRESSURE,
    SPIN_DIFFERENCE,
    TORQUE,
    VISCOSITY,
)
from ...numerics.kernel import inner_kernel, outer_kernel, value_kernel
from .mesh import (
    ANGLE_STEP,
    ANGLES,
    AREA,
    CAVITATION,
    CELLS,
    DRAG,
    SECTORS,
    TURNED,
    films,
    half_height,
    heights,
    table,
)
from .pressure import split
from .roughness import mean_reciprocal


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
    drag, c, area = table(f, DRAG), half_height(f), table(f, AREA)
    p, fill, nodes, between = np.empty_like(u), np.empty_like(u), np.empty_like(u), np.empty_like(u)
    split(f, u, p, fill)
    heights(f, s, nodes, between, np.empty((angles, cells + 1)))
    inner = outer = sheared = lifted = 0.0
    for k in range(angles):
        inner += ways[k, 0] * (p_i - p[k, 0])
        outer += ways[k, cells] * (p[k, cells - 1] - p_o)
        for j in range(cells):
            sheared += drag[j] * mean_reciprocal(nodes[k, j], c)
            lifted -= 0.5 * p[k, j] * area[j] * (between[k, j] - between[k - 1, j])
    s[FLOW_INNER], s[FLOW_OUTER] = f[SECTORS] * inner, f[SECTORS] * outer
    s[TORQUE] = f[SECTORS] * (f[ANGLE_STEP] * s[VISCOSITY] * s[SPIN_DIFFERENCE] * sheared + lifted)
