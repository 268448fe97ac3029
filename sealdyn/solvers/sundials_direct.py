"""CVODE and IDA stepped by a compiled loop, without Python between steps.

Steps are handed over in blocks; between blocks the integrator waits with its whole history, it never starts again.
The right-hand side comes as an address (dynamics/native.py), SUNDIALS from the wheel of scikit-sundae
(sundials_libraries.py): without it this file cannot be imported.
"""

import ctypes
from contextlib import ExitStack, contextmanager

import numpy as np
from numba import carray, cfunc, float64, int32, int64, njit, types

from ..numerics.addresses import ADDRESS, call_rates, call_residual, floats, integers
from .contract import FEW, MOST_ORDERS, SolverFailure, absolute_tolerances, failure_message
from .sundials_libraries import libraries
from .sundials_python import MOST_STEPS, longest_step

# The functions below are linked to these libraries as they are compiled.
if isinstance(libraries(), str):
    raise ImportError(libraries())

# Steps handed over at once.
BLOCK = 1024
# What SUNDIALS carries through to the functions below, int64: the function and its block, number of unknowns, how many
# of them have columns in a Jacobian, address of their scales; counts of evaluations and Jacobians; room for what only
# sparse Jacobians need (sundials_sparse.py).
FUNCTION, DATA, SIZE, COLUMNS, SCALES, CALLS, JACOBIANS, SPARSE = range(8)
CARRIED = SPARSE + 6
ADAMS, BDF, ONE_STEP = 1, 2, 2
# What SUNDIALS says of steps that come to nothing.
TOO_MUCH_WORK = -1

_pointer = types.ExternalFunction("N_VGetArrayPointer_Serial", ADDRESS(ADDRESS))
_columns = types.ExternalFunction("SUNDenseMatrix_Data", ADDRESS(ADDRESS))
_cvode = types.ExternalFunction("CVode", int32(ADDRESS, float64, ADDRESS, ADDRESS, int32))
_reinit = types.ExternalFunction("CVodeReInit", int32(ADDRESS, float64, ADDRESS))
_tolerances = types.ExternalFunction("CVodeSVtolerances", int32(ADDRESS, float64, ADDRESS))
_max_step = types.ExternalFunction("CVodeSetMaxStep", int32(ADDRESS, float64))
_stop_time = types.ExternalFunction("CVodeSetStopTime", int32(ADDRESS, float64))
_error_fails = types.ExternalFunction("CVodeGetNumErrTestFails", int32(ADDRESS, ADDRESS))
_newton_fails = types.ExternalFunction("CVodeGetNumNonlinSolvConvFails", int32(ADDRESS, ADDRESS))
_cvode_order = types.ExternalFunction("CVodeGetLastOrder", int32(ADDRESS, ADDRESS))
_ida_order = types.ExternalFunction("IDAGetLastOrder", int32(ADDRESS, ADDRESS))
_ida = types.ExternalFunction("IDASolve", int32(ADDRESS, float64, ADDRESS, ADDRESS, ADDRESS, int32))


@cfunc(int32(float64, ADDRESS, ADDRESS, ADDRESS), cache=True)
def _rates(tau, y, yp, carried):
    carried = carray(integers(carried), CARRIED)
    carried[CALLS] += 1
    return call_rates(carried[FUNCTION], tau, _pointer(y), _pointer(yp), carried[DATA])


@cfunc(int32(float64, ADDRESS, ADDRESS, ADDRESS, ADDRESS, ADDRESS, ADDRESS, ADDRESS), cache=True)
def _jacobian(tau, y, yp, matrix, carried, moved, spare, another):
    """d y'/d y by forward differences, column by column; works feed nothing back."""
    carried = carray(integers(carried), CARRIED)
    size, data, there = carried[SIZE], _columns(matrix), _pointer(moved)
    y, base, scale = (
        carray(floats(_pointer(y)), size),
        carray(floats(_pointer(yp)), size),
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
        step = 1e-7 * max(abs(y[j]), scale[j])
        at[j] = y[j] + step
        status = call_rates(carried[FUNCTION], tau, there, data + 8 * size * j, carried[DATA])
        if status != 0:
            return status
        for i in range(size):
            columns[j, i] = (columns[j, i] - base[i]) / step
        at[j] = y[j]
    return 0


@cfunc(int32(float64, ADDRESS, ADDRESS, ADDRESS, ADDRESS), cache=True)
def _residual(tau, y, yp, res, carried):
    carried = carray(integers(carried), CARRIED)
    carried[CALLS] += 1
    return call_residual(carried[FUNCTION], tau, _pointer(y), _pointer(yp), _pointer(res), carried[DATA])


@njit(int32(ADDRESS, ADDRESS, ADDRESS, float64, float64, float64, float64), cache=True, nogil=True)
def restart_cvode(memory, vector, absolute, tau, tolerance, end, longest):
    """Make CVODE ready to step from the values of its N_Vector at `tau` (s) to `end` (s), no step longer than `longest`
    (s, 0: any), at a relative `tolerance` and the N_Vector `absolute`; negative where a setting is refused."""
    return min(
        _reinit(memory, tau, vector),
        _tolerances(memory, tolerance, absolute),
        _max_step(memory, longest),
        _stop_time(memory, end),
    )


@njit(types.void(ADDRESS, int64[::1]), cache=True, nogil=True)
def add_refused(memory, refused):
    """Add the steps that the error test and the nonlinear solver refused since the restart to `refused` (2,)."""
    number = np.zeros(1, dtype=np.int64)
    _error_fails(memory, number.ctypes.data)
    refused[0] += number[0]
    _newton_fails(memory, number.ctypes.data)
    refused[1] += number[0]


@njit(types.Tuple((int64, int32))(ADDRESS, ADDRESS, float64[::1], float64[::1], float64, int64[::1], float64[::1],
                                  float64[:, ::1]), cache=True, nogil=True)  # fmt: skip
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


@njit(types.Tuple((int64, int32))(ADDRESS, ADDRESS, ADDRESS, float64[::1], float64[::1], float64[::1], float64,
                                  int64[::1], float64[::1], float64[:, ::1], float64[:, ::1]),
      cache=True, nogil=True)  # fmt: skip
def _step_ida(memory, vector, slopes, y, yp, reached, end, orders, ts, ys, yps):
    """The same of IDA, with the derivatives `yp` (size,) in `yps` (m, size)."""
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


class _Objects:
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
    block, scales = segment.native.block.ctypes.data, segment.scales.ctypes.data
    words = [function, block, segment.size, segment.n_mechanical, scales, *[0] * (CARRIED - CALLS)]
    return np.array(words, dtype=np.int64)


class _Carried:
    """The words that SUNDIALS carries through to the functions above, kept alive, and what they count."""

    def __init__(self, segment, function: int):
        self.native, self.scales = segment.native, segment.scales
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


@contextmanager
def cvode_for(y, absolute, words, method):
    """CVODE on the unknowns `y` (size,) with absolute tolerances `absolute` (size,) and the words that SUNDIALS carries
    (see above), Adams if so called, else BDF: its memory, and the N_Vectors of both, for `restart_cvode`."""
    with _Objects(len(y)) as made:
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
    carried, y, reached = _Carried(segment, segment.native.rates), y.copy(), np.array([tau])
    lib, absolute = libraries(), absolute_tolerances(segment, tolerance)
    with cvode_for(y, absolute, carried.words, method) as (memory, vector, absolute):
        settings = tau, tolerance, segment.length, longest_step(segment)
        if restart_cvode(memory.value, vector.value, absolute.value, *settings) < 0:
            raise OSError("SUNDIALS refused a setting")
        if max_order:
            lib.CVodeSetMaxOrd(memory, max_order)
        rows = FEW if segment.may_change else BLOCK
        while reached[0] < segment.length:
            ts, ys = np.empty(rows), np.empty((rows, segment.size))
            count, flag = step_cvode(memory.value, vector.value, y, reached, segment.length, carried.orders, ts, ys)
            carried.tell(counts, memory, (lib.CVodeGetNumErrTestFails, lib.CVodeGetNumNonlinSolvConvFails))
            if count:
                yield ts[:count], ys[:count], None
            if flag < 0:
                raise SolverFailure(failure_message(method, _name(lib.CVodeGetReturnFlagName, flag), reached[0]))


def ida(segment, tau, y, method, tolerance, counts):
    """Steps of IDA, on the residual form, with the contract of contract.py; `y` is made consistent first.
    **Raises** SolverFailure."""
    carried, reached = _Carried(segment, segment.native.residual), np.array([tau])
    y, yp = (np.ascontiguousarray(part, dtype=float) for part in segment.start(tau, y.copy()))
    with _Objects(segment.size) as made:
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
                message = failure_message(method, _name(lib.IDAGetReturnFlagName, flag), reached[0])
                raise SolverFailure(segment.failure() or message)


def _name(ask, flag) -> str:
    """What SUNDIALS calls a flag."""
    return ctypes.string_at(ask(ctypes.c_long(flag))).decode()
