"""Derivatives along steps of equations that have no function for C (tests' own ones): apart, since a kernel of fixed
signature is compiled by its import."""

from numba import types

from ..numerics.kernel import outer_kernel
from .equations import kinematics, rates
from .function_values import FILM, LOAD, MATRIX, VECTOR

RATES = types.void(FILM, VECTOR, LOAD, VECTOR, VECTOR, VECTOR, VECTOR, VECTOR, MATRIX, MATRIX)


@outer_kernel(RATES)
def rates_by_parts(wrench, f, contact, block, p, w, s, taus, ys, yps):
    """Derivatives `yps` (m, unknowns) at segment times `taus` (m,) (s) and unknowns `ys` (m, unknowns): film block `f`,
    load of `contact` and its `block`, parameters `p`, scratch `w` and `s` as in dynamics/equations.py."""
    for i in range(len(taus)):
        kinematics(taus[i], ys[i], yps[i], p, w, s)
        wrench(f, s)
        contact(block, f, s)
        rates(taus[i], ys[i], p, w, s, yps[i])
