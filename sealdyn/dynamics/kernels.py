"""The compiled kernels at many instants in one call.

What differs from scene to scene, film, contact and thinnest place, comes as a function value (function_values.py): one
kernel on disk serves all, and none compiles what its scene has not.
"""

import numpy as np
from numba import boolean, types

from ..numerics.addresses import ADDRESS, call_rates
from ..numerics.kernel import outer_kernel
from .equations import kinematics, rates
from .function_values import FILM, LOAD, MATRIX, THINNEST, VECTOR


@outer_kernel(types.void(ADDRESS, ADDRESS, VECTOR, MATRIX, MATRIX))
def rates_along(function, block, taus, ys, yps):
    """Derivatives `yps` (m, unknowns) at segment times `taus` (m,) (s) and unknowns `ys` (m, unknowns), by addresses of
    the `function` for C and of its `block` (dynamics/native.py)."""
    for i in range(len(taus)):
        call_rates(function, taus[i], ys[i].ctypes.data, yps[i].ctypes.data, block)


STATES = types.void(
    FILM, VECTOR, LOAD, VECTOR, boolean, VECTOR, VECTOR, VECTOR, VECTOR, MATRIX, MATRIX,
    THINNEST, VECTOR, MATRIX, MATRIX, MATRIX,
)  # fmt: skip


@outer_kernel(STATES)
def states_along(flow, f, contact, block, seals, p, w, s, taus, ys, yps, thinnest, face, gaps, scratch, low):
    """Gap states `gaps` (m, GAP_STATE_SIZE), scratch states `scratch` (m, SCRATCH) and `low` (m, 3), the thinnest film
    of the `face` (m) as `thinnest` finds it, its angle (rad) and radius (m), at segment times `taus` (m,) (s) and
    unknowns `ys`; `yps` (m, unknowns) gives the rates of a massless ring.  `flow` may be any kernel of a film; with
    `seals` the friction of secondary seals too."""
    out = np.empty(yps.shape[1])
    for i in range(len(taus)):
        kinematics(taus[i], ys[i], yps[i], p, w, s)
        flow(f, s)
        contact(block, f, s)
        if seals:
            rates(taus[i], ys[i], p, w, s, out)
        # One by one: assigning whole arrays would take seconds to compile.
        for j in range(len(s)):
            gaps[i, j] = s[j]
        for j in range(len(w)):
            scratch[i, j] = w[j]
        low[i, 0], low[i, 1], low[i, 2] = thinnest(face, s)


@outer_kernel(types.void(FILM, VECTOR, MATRIX))
def at_each(kernel, f, gaps):
    """A film's kernel on every gap state of `gaps` (m, GAP_STATE_SIZE)."""
    for i in range(len(gaps)):
        kernel(f, gaps[i])
