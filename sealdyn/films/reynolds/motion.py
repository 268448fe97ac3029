"""Cavities in motion: the balances in time, with the volume of liquid in each cell as what is kept.

    d(fill E(H))/dt = what flows in

**Source** backward differences of second order with steps that may change (Gear (1971), ch. 11); the complementarity
of cavitation.py at the end of each step.
The differences are of the volumes themselves: whatever the step, none is lost, and pressures, which have no memory,
are free of ringing.  Second order in time, also of a front that passes from cell to cell.
"""

import numpy as np

from ...numerics.kernel import outer_kernel
from .cavitation import balance
from .mesh import ANGLE_STEP, AREA, films, table


@outer_kernel()
def volumes(f, s, u, out):
    """Liquid (m^3) in each cell, `out` (angles, cells), at unknowns `u`."""
    stored, _, _, _ = films(f, s)
    area = table(f, AREA)
    for k in range(u.shape[0]):
        for j in range(u.shape[1]):
            out[k, j] = area[j] * f[ANGLE_STEP] * stored[k, j] * (1.0 + min(u[k, j], 0.0))


@outer_kernel()
def step(f, s, u, now, before, ahead, behind):
    """Unknowns `u` (angles, cells) at the end of a step of `ahead` s, whose gap state is `s`; at entry those at its
    start.  `now` and `before` (angles, cells) are the volumes (m^3) there and `behind` s earlier; 0 s earlier for a
    first step, of first order.  Returns how many linear systems were solved, 0 where no solution was found."""
    stored, carried, ways, around = films(f, s)
    ratio = ahead / behind if behind > 0.0 else 0.0
    newest, older = (1.0 + 2.0 * ratio) / (1.0 + ratio), ratio * ratio / (1.0 + ratio)
    history, area = np.empty_like(stored), table(f, AREA)
    for k in range(u.shape[0]):
        for j in range(u.shape[1]):
            stored[k, j] *= newest * area[j] * f[ANGLE_STEP] / ahead
            history[k, j] = (older * before[k, j] - (1.0 + ratio) * now[k, j]) / ahead
    return balance(f, s, carried, ways, around, stored, history, u)
