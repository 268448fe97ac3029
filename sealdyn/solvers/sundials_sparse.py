"""Sparse Jacobians of IDA, for a segment that knows its residual's derivatives: they come as an address
(dynamics/coupled_native.py), and SuperLU_MT solves.

The values are written where the SUNDIALS matrix keeps them; SUNDIALS empties the whole matrix before, so that the
pattern is written each time too.
"""

import ctypes

import numpy as np
from numba import carray, float64, int32, types

from ..numerics.addresses import ADDRESS, call_derivatives, integers, short_integers
from ..numerics.kernel import c_function
from .sundials_objects import CALLS, CARRIED, COLUMNS, DATA, JACOBIANS, SPARSE, values_of

# Words that SUNDIALS carries: address of the derivatives, then addresses of the pattern's row numbers and of its
# columns' starts, and how many halves of a word (int32) each has; whether there has been a Jacobian.
DERIVATIVES, ROWS, ROW_HALVES, STARTS, START_HALVES, FACTORED = range(SPARSE, SPARSE + 6)

_values = types.ExternalFunction("SUNSparseMatrix_Data", ADDRESS(ADDRESS))
_rows = types.ExternalFunction("SUNSparseMatrix_IndexValues", ADDRESS(ADDRESS))
_starts = types.ExternalFunction("SUNSparseMatrix_IndexPointers", ADDRESS(ADDRESS))


@c_function(int32(float64, float64, ADDRESS, ADDRESS, ADDRESS, ADDRESS, ADDRESS, ADDRESS, ADDRESS, ADDRESS))
def _jacobian(tau, alpha, y, yp, res, matrix, carried, spare, another, third):
    """d res / d y + alpha d res / d y'."""
    carried = carray(integers(carried), CARRIED)
    for to, at, count in ((_rows(matrix), ROWS, ROW_HALVES), (_starts(matrix), STARTS, START_HALVES)):
        carray(short_integers(to), carried[count])[:] = carray(short_integers(carried[at]), carried[count])
    carried[JACOBIANS] += 1
    carried[CALLS] += carried[COLUMNS] + 1
    values = _values(matrix)
    status = call_derivatives(carried[DERIVATIVES], tau, alpha, values_of(y), values_of(yp), values, carried[DATA])
    carried[FACTORED] |= status == 0
    return status


def set_sparse_solver(made, memory, vector, segment, carried):
    """Give IDA of this `memory` the sparse Jacobian of a segment and a solver for it; `carried` gets the words."""
    pattern, lib = segment.pattern, made.lib
    # Their width is that of the library's indices.
    rows, starts = (part.astype(np.dtype(lib.index)) for part in (pattern.indices, pattern.indptr))
    made.kept += [rows, starts]
    words = [segment.native.derivatives]
    for part in (rows, starts):
        words += [part.ctypes.data, part.nbytes // 4]
    carried.words[SPARSE:] = [*words, False]
    matrix, solver = made.sparse(vector, pattern.nnz, lambda: carried.words[FACTORED])
    lib.IDASetLinearSolver(memory, solver, matrix)
    lib.IDASetJacFn(memory, ctypes.c_void_p(_jacobian.address))
