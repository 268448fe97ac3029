"""The SUNDIALS libraries that the scikit-sundae wheel carries, opened without its Python."""

import ctypes
from functools import cache
from importlib.util import find_spec
from pathlib import Path

import llvmlite.binding

# In the order in which they need each other.
NAMES = ("core", "nvecserial", "sunmatrixdense", "sunmatrixsparse", "sunlinsoldense", "cvode", "ida")
MAJOR = 7
# What returns a pointer; all else returns an int.
POINTERS = (
    "N_VMake_Serial", "CVodeCreate", "IDACreate", "SUNDenseMatrix", "SUNSparseMatrix", "SUNLinSol_Dense",
    "CVodeGetReturnFlagName", "IDAGetReturnFlagName",
)  # fmt: skip
# What compiled code calls by itself: without one of them its loading would end the process.
COMPILED = (
    "N_VGetArrayPointer_Serial", "SUNDenseMatrix_Data", "CVode", "CVodeGetLastOrder", "IDASolve", "IDAGetLastOrder",
    "CVodeReInit", "CVodeSVtolerances", "CVodeSetMaxStep", "CVodeSetStopTime", "CVodeGetNumErrTestFails",
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
        folder = Path(spec.origin).parents[1] / "scikit_sundae.libs"
        self.opened = []
        for name in NAMES:
            found = sorted(folder.glob(f"libsundials_{name}-*.so*"))
            if not found:
                raise OSError(f"the wheel of scikit-sundae carries no library {name}")
            self.opened.append(ctypes.CDLL(str(found[0])))
            llvmlite.binding.load_library_permanently(str(found[0]))
        self._check_version()
        self._check_layout()
        for name in COMPILED:
            getattr(self, name)

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
