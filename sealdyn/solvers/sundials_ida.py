"""IDA stepped by a compiled loop, as sundials_direct.py does it with CVODE: a file of its own, so that a run with CVODE
compiles none of it."""

import ctypes

import numpy as np
from numba import carray, float64, int32, int64, types

from ..numerics.addresses import ADDRESS, call_residual, integers
from ..numerics.kernel import c_function, outer_kernel
from .contract import FEW, SolverFailure, absolute_tolerances, failure_message
from .sundials_objects import (
    BLOCK,
    CALLS,
    CARRIED,
    DATA,
    FUNCTION,
    ONE_STEP,
    TOO_MUCH_WORK,
    Carried,
    Objects,
    flag_name,
    values_of,
)
from .sundials_python import MOST_STEPS, longest_step

_ida_order = types.ExternalFunction("IDAGetLastOrder", int32(ADDRESS, ADDRESS))
_ida = types.ExternalFunction("IDASolve", int32(ADDRESS, float64, ADDRESS, ADDRESS, ADDRESS, int32))


@c_function(int32(float64, ADDRESS, ADDRESS, ADDRESS, ADDRESS))
def _residual(tau, y, yp, res, carried):
    carried = carray(integers(carried), CARRIED)
    carried[CALLS] += 1
    return call_residual(carried[FUNCTION], tau, values_of(y), values_of(yp), values_of(res), carried[DATA])


STEPS = types.Tuple((int64, int32))(
    ADDRESS, ADDRESS, ADDRESS, float64[::1], float64[::1], float64[::1], float64,
    int64[::1], float64[::1], float64[:, ::1], float64[:, ::1],
)  # fmt: skip


@outer_kernel(STEPS, nogil=True)
def _step_ida(memory, vector, slopes, y, yp, reached, end, orders, ts, ys, yps):
    """As `step_cvode` (sundials_direct.py), with the derivatives `yp` (size,) in `yps` (m, size)."""
    order = np.zeros(1, dtype=np.int32)
    for k in range(len(ts)):
        before = reached[0]
        flag = _ida(memory, end, reached.ctypes.data, vector, slopes, ONE_STEP)
        if reached[0] <= before and flag >= 0:
            flag = int32(TOO_MUCH_WORK)
        if flag < 0:
            return k, flag
        _ida_order(memory, order.ctypes.data)
        orders[order[0] - 1] += 1
        ts[k] = reached[0]
        for i in range(len(y)):
            ys[k, i], yps[k, i] = y[i], yp[i]
        if reached[0] >= end:
            return k + 1, flag
    return len(ts), int32(0)


def ida(segment, tau, y, method, tolerance, counts):
    """Steps of IDA, on the residual form, with the contract of contract.py; `y` is made consistent first.
    **Raises** SolverFailure."""
    carried, reached = Carried(segment, segment.native.residual), np.array([tau])
    y, yp = (np.ascontiguousarray(part, dtype=float) for part in segment.start(tau, y.copy()))
    with Objects(segment.size) as made:
        lib, vector, slopes = made.lib, made.vector(y), made.vector(yp)
        memory = made.memory(lib.IDACreate(made.context), lib.IDAFree)
        lib.IDAInit(memory, ctypes.c_void_p(_residual.address), ctypes.c_double(tau), vector, slopes)
        absolute = made.vector(absolute_tolerances(segment, tolerance))
        lib.IDASVtolerances(memory, ctypes.c_double(tolerance), absolute)
        lib.IDASetUserData(memory, ctypes.c_void_p(carried.words.ctypes.data))
        if segment.native.derivatives:
            # Few integrations need it.
            from .sundials_sparse import set_sparse_solver

            set_sparse_solver(made, memory, vector, segment, carried)
        else:
            matrix, solver = made.dense(vector)
            lib.IDASetLinearSolver(memory, solver, matrix)
        if len(segment.algebraic):
            differential = np.ones(segment.size)
            differential[segment.algebraic] = 0.0
            lib.IDASetId(memory, made.vector(differential))
        lib.IDASetMaxNumSteps(memory, ctypes.c_long(MOST_STEPS))
        lib.IDASetMaxStep(memory, ctypes.c_double(longest_step(segment)))
        lib.IDASetStopTime(memory, ctypes.c_double(segment.length))
        rows = FEW if segment.may_change else BLOCK
        while reached[0] < segment.length:
            ts, (ys, yps) = np.empty(rows), np.empty((2, rows, segment.size))
            count, flag = _step_ida(
                memory.value, vector.value, slopes.value, y, yp, reached, segment.length, carried.orders, ts, ys, yps
            )
            carried.tell(counts, memory, (lib.IDAGetNumErrTestFails, lib.IDAGetNumNonlinSolvConvFails))
            if count:
                yield ts[:count], ys[:count], yps[:count]
            if flag < 0:
                message = failure_message(method, flag_name(lib.IDAGetReturnFlagName, flag), reached[0])
                raise SolverFailure(segment.failure() or message)
