"""What the compiled loops of CVODE and IDA share: objects of SUNDIALS, the words it carries through, and counts.

SUNDIALS comes from the wheel of scikit-sundae (sundials_libraries.py): without it this file cannot be imported.
"""

import ctypes
from contextlib import ExitStack

import numpy as np
from numba import types

from ..numerics.addresses import ADDRESS
from .contract import MOST_ORDERS
from .sundials_libraries import libraries

# The functions of the loops are linked to these libraries as they are compiled.
if isinstance(libraries(), str):
    raise ImportError(libraries())

# Steps handed over at once.
BLOCK = 1024
# What SUNDIALS carries through to the functions that it calls, int64: the equations and their block, number of
# unknowns, how many of them have columns in a Jacobian, address of their scales; counts of evaluations and Jacobians;
# room for what only sparse Jacobians need (sundials_sparse.py).
FUNCTION, DATA, SIZE, COLUMNS, SCALES, CALLS, JACOBIANS, SPARSE = range(8)
CARRIED = SPARSE + 6
# One step at a time; what SUNDIALS says of steps that come to nothing.
ONE_STEP, TOO_MUCH_WORK = 2, -1

values_of = types.ExternalFunction("N_VGetArrayPointer_Serial", ADDRESS(ADDRESS))


class Objects:
    """What SUNDIALS makes for one integration, given back at the end (a context manager)."""

    def __init__(self, size: int):
        self.lib, self.size, self.stack, self.kept = libraries(), size, ExitStack(), []

    def __enter__(self):
        self.context = ctypes.c_void_p()
        self.lib.SUNContext_Create(0, ctypes.byref(self.context))
        self.stack.callback(lambda: self.lib.SUNContext_Free(ctypes.byref(self.context)))
        # Its own words go to the terminal; ours say the same to the user.
        self.lib.SUNContext_ClearErrHandlers(self.context)
        return self

    def __exit__(self, *error):
        self.stack.close()

    def vector(self, values: np.ndarray):
        """An N_Vector over the values (size,) of an array."""
        self.kept.append(values)
        found = self.lib.N_VMake_Serial(self.lib.index(self.size), ctypes.c_void_p(values.ctypes.data), self.context)
        return self._owned(found, self.lib.N_VDestroy)

    def dense(self, vector):
        """A dense matrix and the linear solver for it."""
        size = self.lib.index(self.size)
        matrix = self._owned(self.lib.SUNDenseMatrix(size, size, self.context), self.lib.SUNMatDestroy)
        return matrix, self._owned(self.lib.SUNLinSol_Dense(vector, matrix, self.context), self.lib.SUNLinSolFree)

    def sparse(self, vector, count: int, factored):
        """A sparse matrix of so many values, by columns, and SuperLU_MT on one thread for it; `factored()` says whether
        it ever got a matrix."""
        self.lib.one_thread()
        size, kind, threads = self.lib.index(self.size), 0, 1
        matrix = self.lib.SUNSparseMatrix(size, size, self.lib.index(count), kind, self.context)
        matrix = self._owned(matrix, self.lib.SUNMatDestroy)
        solver = ctypes.c_void_p(self.lib.SUNLinSol_SuperLUMT(vector, matrix, threads, self.context))

        def free():
            if not factored():
                # The process would end if it were given back without: it gets the identity.
                self.lib.SUNMatZero(matrix)
                self.lib.SUNMatScaleAddI(ctypes.c_double(0.0), matrix)
                self.lib.SUNLinSolInitialize(solver)
                self.lib.SUNLinSolSetup(solver, matrix)
            self.lib.SUNLinSolFree(solver)

        self.stack.callback(free)
        return matrix, solver

    def memory(self, address, free):
        """The memory of an integrator."""
        found = ctypes.c_void_p(address)
        self.stack.callback(lambda: free(ctypes.byref(found)))
        return found

    def _owned(self, address, free):
        found = ctypes.c_void_p(address)
        self.stack.callback(lambda: free(found))
        return found


def words_for(segment, function: int) -> np.ndarray:
    """The words (CARRIED,) for the equations of a segment, by the address of their `function`; they point into its
    native block and its scales, which have to stay."""
    block, scales = segment.native.block.ctypes.data, segment.differences.ctypes.data
    words = [function, block, segment.size, segment.n_mechanical, scales, *[0] * (CARRIED - CALLS)]
    return np.array(words, dtype=np.int64)


class Carried:
    """The words that SUNDIALS carries through to the functions that it calls, kept alive, and what they count."""

    def __init__(self, segment, function: int):
        self.native, self.scales = segment.native, segment.differences
        self.words, self.orders = words_for(segment, function), np.zeros(MOST_ORDERS, dtype=np.int64)
        self.failures = [0, 0]

    def tell(self, counts, memory, asked):
        """Add what has been done since the last time; `asked`: SUNDIALS' functions for the steps that the error test
        and the nonlinear solver refused."""
        counts.rhs += int(self.words[CALLS])
        counts.jacobians += int(self.words[JACOBIANS])
        counts.orders = [a + int(b) for a, b in zip(counts.orders, self.orders, strict=True)]
        found, number = [], ctypes.c_long()
        for ask in asked:
            ask(memory, ctypes.byref(number))
            found.append(number.value)
        counts.rejected += found[0] - self.failures[0]
        counts.unsolved += found[1] - self.failures[1]
        self.words[[CALLS, JACOBIANS]], self.orders[:], self.failures = 0, 0, found


def flag_name(ask, flag) -> str:
    """What SUNDIALS calls a flag."""
    return ctypes.string_at(ask(ctypes.c_long(flag))).decode()
