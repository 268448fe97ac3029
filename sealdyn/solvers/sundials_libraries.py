"""The SUNDIALS libraries that the scikit-sundae wheel carries, opened without its Python; its objects for one
integration, the words that it carries through to the functions it calls, and what these count."""

import ctypes
from contextlib import ExitStack
from functools import cache, cached_property
from importlib.util import find_spec
from pathlib import Path

import llvmlite.binding
import numpy as np
from numba import types

from ..numerics.kernel import ADDRESS
from .contract import MOST_ORDERS

# In the order in which they need each other.
NAMES = ("core", "nvecserial", "sunmatrixdense", "sunmatrixsparse", "sunlinsoldense", "cvode", "ida")
# For sparse matrices only: it brings a whole BLAS with it.
SPARSE_SOLVER = "sunlinsolsuperlumt"
MAJOR = 7
# What returns a pointer; all else returns an int.
POINTERS = (
    "N_VMake_Serial", "CVodeCreate", "IDACreate", "SUNDenseMatrix", "SUNSparseMatrix", "SUNLinSol_Dense",
    "SUNLinSol_SuperLUMT", "CVodeGetReturnFlagName", "IDAGetReturnFlagName",
)  # fmt: skip
# What compiled code calls by itself: without one of them its loading would end the process.
COMPILED = (
    "N_VGetArrayPointer_Serial", "SUNDenseMatrix_Data", "SUNSparseMatrix_Data", "SUNSparseMatrix_IndexValues",
    "SUNSparseMatrix_IndexPointers", "CVode", "CVodeGetLastOrder", "IDASolve", "IDAGetLastOrder", "CVodeReInit",
    "CVodeSVtolerances", "CVodeSetMaxStep", "CVodeSetStopTime", "CVodeGetNumErrTestFails",
    "CVodeGetNumNonlinSolvConvFails",
)  # fmt: skip
# What may not be refused, by the beginnings of names.
ASKED = ("CVodeInit", "CVodeSV", "CVodeSet", "IDAInit", "IDASV", "IDASet")


class Libraries:
    """Functions of SUNDIALS by name, for ctypes (`libraries.CVodeCreate`), opened so that compiled code
    finds them too; its `version`, and `index`, the type of its indices.

    **Raises** OSError: no such wheel, another version or layout.
    """

    def __init__(self):
        spec = find_spec("sksundae")
        if spec is None or not spec.origin:
            raise OSError("scikit-sundae is not installed")
        self.folder, self.opened = Path(spec.origin).parents[1] / "scikit_sundae.libs", []
        for name in NAMES:
            self._open(name)
        self._check_version()
        self._check_layout()
        for name in COMPILED:
            getattr(self, name)

    def _open(self, name):
        found = sorted(self.folder.glob(f"libsundials_{name}-*.so*"))
        if not found:
            raise OSError(f"the wheel of scikit-sundae carries no library {name}")
        self.opened.append(ctypes.CDLL(str(found[0])))
        llvmlite.binding.load_library_permanently(str(found[0]))

    @cached_property
    def why_not_sparse(self) -> str:
        """Why there is no linear solver for sparse matrices, a sentence; "" if there is.  Opened when first asked."""
        try:
            self._open(SPARSE_SOLVER)
            self.SUNLinSol_SuperLUMT  # noqa: B018
        except OSError as error:
            return str(error)
        return ""

    def one_thread(self):
        """Keep the OpenMP of the sparse solver, the wheel's own, to one thread where this thread calls it: the solver,
        asked for one, still gathers all of them and waits several times as long as it works."""
        if limit := getattr(self.opened[-1], "omp_set_num_threads", None):
            limit(1)

    def __getattr__(self, name):
        for library in self.opened:
            try:
                found = getattr(library, name)
            except AttributeError:
                continue
            found.restype = ctypes.c_void_p if name in POINTERS else ctypes.c_int
            if name.startswith(ASKED):
                found.errcheck = _accepted
            setattr(self, name, found)
            return found
        raise OSError(f"SUNDIALS offers no {name}")

    def _check_version(self):
        numbers, label = [ctypes.c_int() for _ in range(3)], ctypes.create_string_buffer(64)
        self.SUNDIALSGetVersionNumber(*(ctypes.byref(n) for n in numbers), label, 64)
        self.version = ".".join(str(n.value) for n in numbers)
        if numbers[0].value != MAJOR:
            raise OSError(f"SUNDIALS {self.version}, where {MAJOR} is known")

    def _check_layout(self):
        """The width of an index, from the first words of a sparse matrix: 3, 3, 7."""
        context = ctypes.c_void_p()
        self.SUNContext_Create(0, ctypes.byref(context))
        matrix = ctypes.c_void_p(self.SUNSparseMatrix(3, 3, 7, 0, context))
        content = ctypes.cast(matrix, ctypes.POINTER(ctypes.c_void_p))[0]
        narrow = list(ctypes.cast(content, ctypes.POINTER(ctypes.c_int32))[:3])
        wide = list(ctypes.cast(content, ctypes.POINTER(ctypes.c_int64))[:3])
        self.SUNMatDestroy(matrix)
        self.SUNContext_Free(ctypes.byref(context))
        if [3, 3, 7] not in (narrow, wide):
            raise OSError("SUNDIALS lays its matrices out otherwise than known")
        self.index = ctypes.c_int32 if narrow == [3, 3, 7] else ctypes.c_int64


def _accepted(flag, function, given):
    """What SUNDIALS answers to a setting, if it takes it."""
    if flag < 0:
        raise OSError(f"SUNDIALS refused {function.__name__} ({flag})")
    return flag


@cache
def libraries() -> Libraries | str:
    """The libraries, or a sentence why they cannot be used."""
    try:
        return Libraries()
    except OSError as error:
        return str(error)


# --- What the compiled loops share -------------------------------------------------------------------

# Steps handed over at once.
BLOCK = 1024
# What SUNDIALS carries through to the functions that it calls, int64: the equations and their block, number of
# unknowns, how many of them have columns in a Jacobian, address of their scales; counts of evaluations and Jacobians;
# room for what only sparse Jacobians need (sundials_direct.py).
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
    block, scales = segment.native.data, segment.differences.ctypes.data
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
