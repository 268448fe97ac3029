"""The residual form of a segment's equations as a function for C, beside its rates (native.py): a file of its own, so
that a run with CVODE compiles none of it."""

from numba import carray

from ..numerics.addresses import floats, integers
from ..numerics.kernel import c_function
from .equations import residual
from .native import BLOCK, GAP, PARAMETERS, RESIDUAL, SCRATCH, SIZE, WORK, array, loads


@c_function(RESIDUAL)
def residual_at(tau, y_at, yp_at, res_at, data):
    """The residual."""
    block = carray(integers(data), BLOCK)
    y, yp = carray(floats(y_at), block[SIZE]), carray(floats(yp_at), block[SIZE])
    loads(tau, y, yp, block)
    p, w, s = array(block, PARAMETERS), array(block, SCRATCH), array(block, GAP)
    residual(tau, y, yp, p, w, s, array(block, WORK), carray(floats(res_at), block[SIZE]))
    return 0
