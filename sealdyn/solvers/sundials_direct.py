"""CVODE and IDA stepped by compiled loops, without Python between steps.

Steps are handed over in blocks; between blocks the integrator waits with its whole history, it never starts again.
Right-hand side and residual come as addresses (dynamics/native.py).  Without the libraries this file cannot be
imported.
"""

import ctypes
from contextlib import contextmanager

import numpy as np
from numba import carray, float64, int32, int64, types

from ..numerics.kernel import (
    ADDRESS,
    c_function,
    call_derivatives,
    call_rates,
    call_residual,
    floats,
    inner_kernel,
    integers,
    lazy_kernel,
    outer_kernel,
    short_integers,
)
from .contract import FEW, MOST_STEPS, SolverFailure, absolute_tolerances, failure_message, longest_step
from .sundials_libraries import (
    BLOCK,
    CALLS,
    CARRIED,
    COLUMNS,
    DATA,
    FUNCTION,
    JACOBIANS,
    ONE_STEP,
    SCALES,
    SIZE,
    SPARSE,
    TOO_MUCH_WORK,
    Carried,
    Objects,
    flag_name,
    libraries,
    values_of,
)

# The loops are linked to the libraries as they are compiled.
if isinstance(libraries(), str):
    raise ImportError(libraries())

ADAMS, BDF = 1, 2

_columns = types.ExternalFunction("SUNDenseMatrix_Data", ADDRESS(ADDRESS))
_cvode = types.ExternalFunction("CVode", int32(ADDRESS, float64, ADDRESS, ADDRESS, int32))
_reinit = types.ExternalFunction("CVodeReInit", int32(ADDRESS, float64, ADDRESS))
_tolerances = types.ExternalFunction("CVodeSVtolerances", int32(ADDRESS, float64, ADDRESS))
_max_step = types.ExternalFunction("CVodeSetMaxStep", int32(ADDRESS, float64))
_stop_time = types.ExternalFunction("CVodeSetStopTime", int32(ADDRESS, float64))
_error_fails = types.ExternalFunction("CVodeGetNumErrTestFails", int32(ADDRESS, ADDRESS))
_newton_fails = types.ExternalFunction("CVodeGetNumNonlinSolvConvFails", int32(ADDRESS, ADDRESS))
_cvode_order = types.ExternalFunction("CVodeGetLastOrder", int32(ADDRESS, ADDRESS))


@c_function(int32(float64, ADDRESS, ADDRESS, ADDRESS))
def _rates(tau, y, yp, carried):
    carried = carray(integers(carried), CARRIED)
    carried[CALLS] += 1
    return call_rates(carried[FUNCTION], tau, values_of(y), values_of(yp), carried[DATA])


@c_function(int32(float64, ADDRESS, ADDRESS, ADDRESS, ADDRESS, ADDRESS, ADDRESS, ADDRESS))
def _jacobian(tau, y, yp, matrix, carried, moved, spare, another):
    """d y'/d y by forward differences, column by column; works feed nothing back."""
    carried = carray(integers(carried), CARRIED)
    size, data, there = carried[SIZE], _columns(matrix), values_of(moved)
    y, base, scale = (
        carray(floats(values_of(y)), size),
        carray(floats(values_of(yp)), size),
        carray(floats(carried[SCALES]), size),
    )
    at, columns = carray(floats(there), size), carray(floats(data), (size, size))
    # One by one, here and below: an array into an array compiles numba's message of shapes that differ.
    for i in range(size):
        at[i] = y[i]
    columns[:] = 0.0
    carried[JACOBIANS] += 1
    carried[CALLS] += carried[COLUMNS]
    for j in range(carried[COLUMNS]):
        # A negative scale is a step of its own: where friction turns within less than the usual one.
        step = -scale[j] if scale[j] < 0.0 else 1e-7 * max(abs(y[j]), scale[j])
        at[j] = y[j] + step
        status = call_rates(carried[FUNCTION], tau, there, data + 8 * size * j, carried[DATA])
        if status != 0:
            return status
        for i in range(size):
            columns[j, i] = (columns[j, i] - base[i]) / step
        at[j] = y[j]
    return 0


@outer_kernel(int32(ADDRESS, ADDRESS, ADDRESS, float64, float64, float64, float64), nogil=True)
def restart_cvode(memory, vector, absolute, tau, tolerance, end, longest):
    """Make CVODE ready to step from the values of its N_Vector at `tau` (s) to `end` (s), no step longer than `longest`
    (s, 0: any), at a relative `tolerance` and the N_Vector `absolute`; negative where a setting is refused."""
    return min(
        _reinit(memory, tau, vector),
        _tolerances(memory, tolerance, absolute),
        _max_step(memory, longest),
        _stop_time(memory, end),
    )


@inner_kernel()
def add_refused(memory, refused):
    """Add the steps that the error test and the nonlinear solver refused since the restart to `refused` (2,)."""
    number = np.zeros(1, dtype=np.int64)
    _error_fails(memory, number.ctypes.data)
    refused[0] += number[0]
    _newton_fails(memory, number.ctypes.data)
    refused[1] += number[0]


STEPS = types.Tuple((int64, int32))(
    ADDRESS, ADDRESS, float64[::1], float64[::1], float64, int64[::1], float64[::1], float64[:, ::1]
)


@outer_kernel(STEPS, nogil=True)
def step_cvode(memory, vector, y, reached, end, orders, ts, ys):
    """Steps of CVODE until `end` (s) or `ts` (m,), `ys` (m, size) are full: how many, and the flag of the last; `y`
    (size,) are the values of the N_Vector, `reached` (1,) is the time (s); `orders` (MOST_ORDERS,) counts."""
    order = np.zeros(1, dtype=np.int32)
    for k in range(len(ts)):
        before = reached[0]
        flag = _cvode(memory, end, vector, reached.ctypes.data, ONE_STEP)
        # It would make steps without an end.
        if reached[0] <= before and flag >= 0:
            flag = int32(TOO_MUCH_WORK)
        if flag < 0:
            return k, flag
        _cvode_order(memory, order.ctypes.data)
        orders[order[0] - 1] += 1
        ts[k] = reached[0]
        for i in range(len(y)):
            ys[k, i] = y[i]
        if reached[0] >= end:
            return k + 1, flag
    return len(ts), int32(0)


@contextmanager
def cvode_for(y, absolute, words, method):
    """CVODE on the unknowns `y` (size,) with absolute tolerances `absolute` (size,) and the words that SUNDIALS carries
    (see above), Adams if so called, else BDF: its memory, and the N_Vectors of both, for `restart_cvode`."""
    with Objects(len(y)) as made:
        lib, vector, tolerances = made.lib, made.vector(y), made.vector(absolute)
        memory = made.memory(lib.CVodeCreate(ADAMS if method == "adams" else BDF, made.context), lib.CVodeFree)
        lib.CVodeInit(memory, ctypes.c_void_p(_rates.address), ctypes.c_double(0.0), vector)
        lib.CVodeSVtolerances(memory, ctypes.c_double(1e-6), tolerances)
        lib.CVodeSetUserData(memory, ctypes.c_void_p(words.ctypes.data))
        matrix, solver = made.dense(vector)
        lib.CVodeSetLinearSolver(memory, solver, matrix)
        lib.CVodeSetJacFn(memory, ctypes.c_void_p(_jacobian.address))
        lib.CVodeSetMaxNumSteps(memory, ctypes.c_long(MOST_STEPS))
        # Steps that vanish are told by `step_cvode`, not on the terminal.
        lib.CVodeSetMaxHnilWarns(memory, ctypes.c_int(-1))
        yield memory, vector, tolerances


def cvode(segment, tau, y, method, tolerance, counts, max_order: int | None = None):
    """Steps of CVODE, Adams if so called, else BDF, with the contract of contract.py.
    **Raises** SolverFailure."""
    carried, y, reached = Carried(segment, segment.native.rates), y.copy(), np.array([tau])
    lib, absolute = libraries(), absolute_tolerances(segment, tolerance)
    with cvode_for(y, absolute, carried.words, method) as (memory, vector, absolute):
        settings = tau, tolerance, segment.length, longest_step(segment)
        if restart_cvode(memory.value, vector.value, absolute.value, *settings) < 0:
            raise OSError("SUNDIALS refused a setting")
        if max_order:
            lib.CVodeSetMaxOrd(memory, max_order)
        if segment.may_change:
            # Dry friction turns within a step: an older Jacobian holds the motion where it is.
            lib.CVodeSetJacEvalFrequency(memory, ctypes.c_long(1))
            lib.CVodeSetLSetupFrequency(memory, ctypes.c_long(1))
        rows = FEW if segment.may_change else BLOCK
        while reached[0] < segment.length:
            ts, ys = np.empty(rows), np.empty((rows, segment.size))
            count, flag = step_cvode(memory.value, vector.value, y, reached, segment.length, carried.orders, ts, ys)
            carried.tell(counts, memory, (lib.CVodeGetNumErrTestFails, lib.CVodeGetNumNonlinSolvConvFails))
            if count:
                yield ts[:count], ys[:count], None
            if flag < 0:
                raise SolverFailure(failure_message(method, flag_name(lib.CVodeGetReturnFlagName, flag), reached[0]))


# --- Sparse Jacobians ---------------------------------------------------------------------------------

# For a segment that knows its residual's derivatives: they come as an address (dynamics/coupled_native.py), and
# SuperLU_MT solves.  The values are written where the SUNDIALS matrix keeps them; SUNDIALS empties the whole matrix
# before, so that the pattern is written each time too.
# Words that SUNDIALS carries: address of the derivatives, then addresses of the pattern's row numbers and of its
# columns' starts, and how many halves of a word (int32) each has; whether there has been a Jacobian.
DERIVATIVES, ROWS, ROW_HALVES, STARTS, START_HALVES, FACTORED = range(SPARSE, SPARSE + 6)

_values = types.ExternalFunction("SUNSparseMatrix_Data", ADDRESS(ADDRESS))
_rows = types.ExternalFunction("SUNSparseMatrix_IndexValues", ADDRESS(ADDRESS))
_starts = types.ExternalFunction("SUNSparseMatrix_IndexPointers", ADDRESS(ADDRESS))


@c_function(int32(float64, float64, ADDRESS, ADDRESS, ADDRESS, ADDRESS, ADDRESS, ADDRESS, ADDRESS, ADDRESS))
def _sparse_jacobian(tau, alpha, y, yp, res, matrix, carried, spare, another, third):
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


# At order one the rate that a step finds of a ring of little mass hangs on the step's length, and the many unknowns of
# a film hide its error until it is large: a step twice as long fails, the next begins at order one again, and so for
# ever.  Steps grow by less, and seldom fail.
GROWTH = 1.3


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
    lib.IDASetJacFn(memory, ctypes.c_void_p(_sparse_jacobian.address))
    lib.IDASetEtaMax(memory, ctypes.c_double(GROWTH))


# --- IDA ----------------------------------------------------------------------------------------------

_ida_order = types.ExternalFunction("IDAGetLastOrder", int32(ADDRESS, ADDRESS))
_ida = types.ExternalFunction("IDASolve", int32(ADDRESS, float64, ADDRESS, ADDRESS, ADDRESS, int32))


@c_function(int32(float64, ADDRESS, ADDRESS, ADDRESS, ADDRESS))
def _residual(tau, y, yp, res, carried):
    carried = carray(integers(carried), CARRIED)
    carried[CALLS] += 1
    return call_residual(carried[FUNCTION], tau, values_of(y), values_of(yp), values_of(res), carried[DATA])


IDA_STEPS = types.Tuple((int64, int32))(
    ADDRESS, ADDRESS, ADDRESS, float64[::1], float64[::1], float64[::1], float64,
    int64[::1], float64[::1], float64[:, ::1], float64[:, ::1],
)  # fmt: skip


@lazy_kernel(IDA_STEPS, nogil=True)
def _step_ida(memory, vector, slopes, y, yp, reached, end, orders, ts, ys, yps):
    """As `step_cvode`, with the derivatives `yp` (size,) in `yps` (m, size)."""
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


def ida(segment, tau, y, method, tolerance, counts, max_order: int | None = None):
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
            set_sparse_solver(made, memory, vector, segment, carried)
        else:
            matrix, solver = made.dense(vector)
            lib.IDASetLinearSolver(memory, solver, matrix)
        if len(segment.algebraic):
            differential = np.ones(segment.size)
            differential[segment.algebraic] = 0.0
            lib.IDASetId(memory, made.vector(differential))
        if max_order:
            lib.IDASetMaxOrd(memory, max_order)
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
