"""The SUNDIALS libraries that the scikit-sundae wheel carries, opened without its Python."""

import ctypes
from functools import cache, cached_property
from importlib.util import find_spec
from pathlib import Path

import llvmlite.binding

# In the order in which they need each other.
NAMES = ("core", "nvecserial", "sunmatrixdense", "sunmatrixsparse", "sunlinsoldense", "cvode", "ida")
# For sparse matrices only: it brings a whole BLAS with it.
SPARSE = "sunlinsolsuperlumt"
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
            self._open(SPARSE)
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
