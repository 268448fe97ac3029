"""Equations of motion of followers on a shaft that runs out, in the solver's inner loop.

Follower j moves along its own radius by u_j (outward, zero on the concentric shaft).  It is free, held on its flange
by dry friction, or rides on the shaft: then it moves as the surface under it, and the load on the shaft

    N_j = m s'' + d s' + (K u)_j + P + F sign(s')

must not pull.  Free it moves by  m u'' = -(K u)_j - d u' - P - F sign(u').

Unknowns `y`: n displacements, n rates, the works (of the shaft on those that ride, of damping, of friction), and the
sum of their absolute values.  Parameters `p`: HEAD numbers, the angle and the mode of each follower and the sign of its
sliding, the first row of the stiffness matrix, then the waves of the shaft, WAVE numbers each: `order, amplitude, a0,
a1, a2` with the phase a0 + a1 tau + a2 tau^2.
"""

import math

import numpy as np
from numba import carray

from ..dynamics.native import BLOCK, PARAMETERS, RATES, array
from ..numerics.kernel import c_function, floats, inner_kernel, integers, outer_kernel

COUNT, MASS, DAMPING, PRELOAD, FRICTION, OFFSET, OFFSET_DIRECTION, WAVES, HEAD = range(9)
WAVE = 5
FREE, HELD, RIDING = 0.0, 1.0, 2.0
# The works; after them the sum of absolute works.
SHAFT_WORK, DAMPING_WORK, FRICTION_WORK, WORKS = range(4)


def unknowns(count: int) -> int:
    """Number of unknowns of so many followers."""
    return 2 * count + WORKS + 1


@inner_kernel()
def surface(tau, theta, p, out):
    """The shaft's surface at the angle `theta` (rad) of the housing and segment time `tau` (s): how far (m) it stands
    out, its rate (m/s) and acceleration (m/s^2), into `out` (3,)."""
    n = int(p[COUNT])
    out[0], out[1], out[2] = p[OFFSET] * math.cos(theta - p[OFFSET_DIRECTION]), 0.0, 0.0
    for k in range(int(p[WAVES])):
        at = HEAD + 4 * n + WAVE * k
        phase = p[at] * theta - (p[at + 2] + tau * (p[at + 3] + tau * p[at + 4]))
        w = p[at + 3] + 2.0 * tau * p[at + 4]
        cos, sin = p[at + 1] * math.cos(phase), p[at + 1] * math.sin(phase)
        out[0] += cos
        out[1] += sin * w
        out[2] += 2.0 * p[at + 4] * sin - w * w * cos


@inner_kernel()
def spring(y, p, j):
    """Force (N) of the springs on follower j, inward."""
    n = int(p[COUNT])
    force = 0.0
    for k in range(n):
        force += p[HEAD + 3 * n + (j - k) % n] * y[k]
    return force


@inner_kernel()
def rates(tau, y, p, yp):
    """The right-hand side `yp` at segment time `tau` (s) and unknowns `y`."""
    n, here = int(p[COUNT]), np.zeros(3)
    works = 2 * n
    for i in range(WORKS + 1):
        yp[works + i] = 0.0
    for j in range(n):
        mode, sign, v = p[HEAD + n + j], p[HEAD + 2 * n + j], y[n + j]
        if mode == RIDING:
            surface(tau, p[HEAD + j], p, here)
            yp[j], yp[n + j], v = here[1], here[2], here[1]
            slides = np.sign(v)
            load = p[MASS] * here[2] + p[DAMPING] * v + spring(y, p, j) + p[PRELOAD] + p[FRICTION] * slides
            yp[works + SHAFT_WORK] += load * v
            yp[works + WORKS] += abs(load * v)
        elif mode == HELD:
            yp[j], yp[n + j], v, slides = 0.0, 0.0, 0.0, 0.0
        else:
            slides = sign
            force = spring(y, p, j) + p[DAMPING] * v + p[PRELOAD] + p[FRICTION] * slides
            yp[j], yp[n + j] = v, -force / p[MASS]
        damped, rubbed = p[DAMPING] * v * v, p[FRICTION] * slides * v
        yp[works + DAMPING_WORK] -= damped
        yp[works + FRICTION_WORK] -= rubbed
        yp[works + WORKS] += damped + abs(rubbed)


@c_function(RATES)
def rates_at(tau, y_at, yp_at, data):
    """The right-hand side for C (dynamics/native.py)."""
    block = carray(integers(data), BLOCK)
    size = block[0]
    rates(tau, carray(floats(y_at), size), array(block, PARAMETERS), carray(floats(yp_at), size))
    return 0


@outer_kernel()
def right_hand_side(tau, y, p, yp):
    """The same from Python."""
    rates(tau, y, p, yp)


@outer_kernel()
def rates_along(taus, ys, p, out):
    """Derivatives `out` (m, size) at times `taus` (m,) (s) and unknowns `ys` (m, size)."""
    for i in range(len(taus)):
        rates(taus[i], ys[i], p, out[i])


@outer_kernel()
def energies_along(ys, p, out):
    """Energy (J) `out` (m,) of motion, springs and preload at unknowns `ys` (m, size)."""
    n = int(p[COUNT])
    for i in range(len(ys)):
        y, found = ys[i], 0.0
        for j in range(n):
            found += 0.5 * p[MASS] * y[n + j] ** 2 + y[j] * (0.5 * spring(y, p, j) + p[PRELOAD])
        out[i] = found


@outer_kernel()
def state_along(taus, us, vs, p, gaps, gap_rates, loads):
    """At times `taus` (m,) (s), displacements `us` and rates `vs` (m, n): the gaps to the shaft (m), their rates (m/s),
    and the loads (N): of those that ride on the shaft, of the others what the flange must hold (signed, outward where
    the springs pull outward), all (m, n)."""
    n, here = int(p[COUNT]), np.zeros(3)
    for i in range(len(taus)):
        for j in range(n):
            surface(taus[i], p[HEAD + j], p, here)
            pressed = spring(us[i], p, j) + p[PRELOAD]
            gaps[i, j], gap_rates[i, j] = us[i, j] - here[0], vs[i, j] - here[1]
            if p[HEAD + n + j] == RIDING:
                gaps[i, j], gap_rates[i, j] = 0.0, 0.0
                slides = np.sign(here[1])
                loads[i, j] = p[MASS] * here[2] + p[DAMPING] * here[1] + pressed + p[FRICTION] * slides
            else:
                loads[i, j] = -pressed


@outer_kernel()
def surface_at(tau, p, out):
    """The shaft's surface under every follower at segment time `tau` (s), into `out` (n, 3) as `surface`."""
    for j in range(int(p[COUNT])):
        surface(tau, p[HEAD + j], p, out[j])
