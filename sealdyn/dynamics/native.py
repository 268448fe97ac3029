"""The equations of a segment as functions for C: an address, the address of one block of parameters, and nothing of
Python inside.  What a compiled loop calls, and SUNDIALS itself (solvers/sundials_direct.py).

The kernels of film and contact come as addresses in the block: one function on disk serves all scenes.
"""

import math
from dataclasses import dataclass

import numpy as np
from numba import carray, float64, int32

from ..faces.geometry import FORCE
from ..numerics.addresses import ADDRESS, call_film, call_load, floats, integers
from ..numerics.kernel import c_function, inner_kernel
from .equations import kinematics, rates
from .function_values import Value, load_value

# The block, int64: number of unknowns, kernels of film and contact, then address and length of each array.
SIZE, KERNEL, LOAD, ARRAYS = 0, 1, 2, 3
PARAMETERS, SCRATCH, GAP, FILM, CONTACT, WORK = range(6)
BLOCK = ARRAYS + 2 * 6
# C: int(double tau, double *y, double *yp, [double *res,] int64 *block), the status 0, or 1 where the film has no
# solution, -1 where one with unknowns of its own (coupled_native.py) has none.
RATES = int32(float64, ADDRESS, ADDRESS, ADDRESS)
RESIDUAL = int32(float64, ADDRESS, ADDRESS, ADDRESS, ADDRESS)


@dataclass(frozen=True)
class Native:
    """A segment's equations for C: address of its `rates`, the `block` and the `arrays` that it points to, which it
    keeps alive; of a film with unknowns no rates (0), and addresses of its own `residual` and its `derivatives`."""

    rates: int
    block: np.ndarray
    arrays: tuple
    own_residual: int = 0
    derivatives: int = 0

    @property
    def residual(self) -> int:
        """Address of the residual; that of rings alone is compiled by its import, which few integrations need."""
        if self.own_residual:
            return self.own_residual
        from .native_residual import residual_at

        return residual_at.address


def native(segment) -> Native:
    """The equations of a segment whose film has no unknowns of its own (else coupled_native.py); they work on the
    segment's own arrays."""
    model, work = segment.model, np.zeros(segment.size)
    load, contact = load_value(model.contact)
    arrays = (segment.p, segment.w, segment.s, model.f, contact, work)
    block = [segment.size, Value(model.interface.film.wrench).address, load.address]
    for array in arrays:
        block += [array.ctypes.data, len(array)]
    return Native(rates_at.address, np.array(block, dtype=np.int64), arrays)


@inner_kernel()
def array(block, which):
    """One of the block's arrays."""
    at = ARRAYS + 2 * which
    return carray(floats(block[at]), block[at + 1])


@inner_kernel()
def loads(tau, y, yp, block):
    """Kinematics, film and contact at segment time tau (s) and unknowns `y` (size,), in the block's gap state."""
    f, s = array(block, FILM), array(block, GAP)
    kinematics(tau, y, yp, array(block, PARAMETERS), array(block, SCRATCH), s)
    call_film(block[KERNEL], f, s)
    call_load(block[LOAD], array(block, CONTACT), f, s)


@c_function(RATES)
def rates_at(tau, y_at, yp_at, data):
    """The right-hand side."""
    block = carray(integers(data), BLOCK)
    y, yp = carray(floats(y_at), block[SIZE]), carray(floats(yp_at), block[SIZE])
    loads(tau, y, yp, block)
    s = array(block, GAP)
    rates(tau, y, array(block, PARAMETERS), array(block, SCRATCH), s, yp)
    # A shorter step may stay where the film has a solution.
    return 1 if math.isnan(s[FORCE]) else 0
