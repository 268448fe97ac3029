"""The decorators of compiled kernels, and what they need of C: arrays and functions by their addresses.

All are kept on disk and divide as IEEE 754 says, not by Python's rules: an exception cannot pass through C, and a
kernel that left this open would take the rule of whoever calls it first.  None leaves its rounding to the compiler:
no fast-math, no threads.  Kernels on disk carry a checksum: one that was damaged is compiled anew, which is said once.
"""

import io
import warnings
import zlib
from collections.abc import Callable
from contextlib import contextmanager
from dataclasses import dataclass
from functools import cached_property, partial
from pathlib import Path

from llvmlite import ir
from numba import cfunc, float64, int32, int64, njit, types
from numba.core import event
from numba.core.caching import CompileResultCacheImpl, IndexDataCacheFile
from numba.extending import intrinsic, register_jitable

from ..kernel_cache import KernelLocator, compiling

# numba asks its locators in turn.
CompileResultCacheImpl._locator_classes.insert(0, KernelLocator)


class _Compiling(event.Listener):
    def on_start(self, _):
        for tell in compiling:
            tell(1)

    def on_end(self, _):
        for tell in compiling:
            tell(-1)


event.register("numba:compile", _Compiling())

# --- checksums ----------------------------------------------------------------------------------------

# numba reads whatever stands there: of a file cut short it raises, and a changed byte of machine code it runs.

# Behind what numba writes, and which it does not read: this and the sum.
MARK = b"\0sum "
_warned: list[Path] = []


def check_kernel_sums() -> None:
    """From now on this process writes and reads kept kernels with their sums; those without are read as numba does."""
    names = "_open_for_write", "_load_index", "_load_data"
    opened, index, data = (getattr(IndexDataCacheFile, name) for name in names)

    @contextmanager
    def open_for_write(self, path):
        # Another process may have left only newer kernels.
        Path(path).parent.mkdir(parents=True, exist_ok=True)
        with opened(self, path) as file:
            yield (whole := io.BytesIO())
            file.write(whole.getvalue() + MARK + _sum(whole.getvalue()))

    def load_index(self):
        return _read(Path(self._index_path), lambda: index(self), {})

    def load_data(self, name):
        # None: not there.
        return _read(Path(self._data_path(name)), lambda: data(self, name), None)

    IndexDataCacheFile._open_for_write = open_for_write
    IndexDataCacheFile._load_index, IndexDataCacheFile._load_data = load_index, load_data


def _read(path: Path, load, otherwise):
    """What `load` reads of a kept file; `otherwise` of one that is damaged."""
    try:
        if not _is_whole(path.read_bytes()):
            raise ValueError("another sum")
        return load()
    except FileNotFoundError:
        return otherwise
    except PermissionError:
        raise
    except Exception:
        if not _warned:
            warnings.warn(f"kept kernels were damaged and are compiled anew ({path.parent})", stacklevel=2)
        _warned.append(path)
        return otherwise


def _is_whole(found: bytes) -> bool:
    content, mark, kept = found[: -len(MARK) - 4], found[-len(MARK) - 4 : -4], found[-4:]
    return mark != MARK or kept == _sum(content)


def _sum(content: bytes) -> bytes:
    return zlib.crc32(content).to_bytes(4, "big")


check_kernel_sums()
OPTIONS = {"cache": True, "error_model": "numpy"}

# Each is compiled with no more ways in than it needs: those from Python and from C take a quarter of a kernel's time.
# Called from Python and by kernels.
outer_kernel = partial(njit, **OPTIONS, no_cfunc_wrapper=True)
# Called from Python and by kernels, and handed to kernels as a function value.
value_kernel = partial(njit, **OPTIONS)
# Called by kernels only; called from Python it runs as Python.
inner_kernel = partial(register_jitable, **OPTIONS, no_cfunc_wrapper=True)


@dataclass(frozen=True)
class AtFirstUse:
    """A function of fixed signature, which a decorator would compile as its file is imported: here when its `address`
    is asked for (`c_function`), or when it is first called (`lazy_kernel`)."""

    decorator: Callable
    function: Callable

    @cached_property
    def compiled(self):
        """What numba makes of it."""
        return self.decorator(self.function)

    @property
    def address(self) -> int:
        """Where C finds it."""
        return self.compiled.address

    def __call__(self, *arguments):
        return self.compiled(*arguments)


def c_function(signature):
    """Decorator of what is called by C only."""
    return partial(AtFirstUse, cfunc(signature, **OPTIONS))


def lazy_kernel(signature, **options):
    """Decorator of a kernel of fixed signature that is called from Python only."""
    return partial(AtFirstUse, outer_kernel(signature, **options))


ADDRESS, VECTOR, MATRIX = types.intp, float64[::1], float64[:, ::1]


def _pointer_to(kind):
    def pointer(context, address):
        def code(context, builder, signature, arguments):
            return builder.inttoptr(arguments[0], context.get_value_type(signature.return_type))

        return types.CPointer(kind)(ADDRESS), code

    return pointer


@intrinsic
def floats(context, address):
    """An address as a pointer to doubles, for numba's carray."""
    return _pointer_to(float64)(context, address)


@intrinsic
def integers(context, address):
    """An address as a pointer to int64, for numba's carray."""
    return _pointer_to(int64)(context, address)


@intrinsic
def short_integers(context, address):
    """An address as a pointer to int32, for numba's carray."""
    return _pointer_to(int32)(context, address)


def _call(signature):
    """Call the function at an address, the first argument; arrays go as numba's own C wrappers take them."""

    def code(context, builder, signature, arguments):
        silent = signature.return_type == types.void
        back = ir.VoidType() if silent else context.get_value_type(signature.return_type)
        kind = ir.FunctionType(back, [context.get_value_type(part) for part in signature.args[1:]])
        found = builder.call(builder.inttoptr(arguments[0], kind.as_pointer()), arguments[1:])
        return context.get_dummy_value() if silent else found

    return signature, code


@intrinsic
def call_film(context, kernel, f, s):
    """Call the kernel void(f, s) at an address."""
    return _call(types.void(ADDRESS, VECTOR, VECTOR))


@intrinsic
def call_load(context, kernel, k, f, s):
    """Call the kernel void(k, f, s) at an address, three arrays."""
    return _call(types.void(ADDRESS, VECTOR, VECTOR, VECTOR))


@intrinsic
def call_seal(context, kernel, k, spin, spin_rate, p, w):
    """Call the kernel float64(k, spin, spin_rate, p, w) at an address, an int64, two numbers and two arrays."""
    return _call(float64(ADDRESS, int64, float64, float64, VECTOR, VECTOR))


@intrinsic
def call_film_residual(context, kernel, f, s, x, x_rate, res):
    """Call the kernel int64(f, s, x, x_rate, res) at an address, five arrays; returns its code."""
    return _call(int64(ADDRESS, VECTOR, VECTOR, VECTOR, VECTOR, VECTOR))


@intrinsic
def call_film_jacobian(context, kernel, f, s, x, x_rate, alpha, data):
    """Call the kernel void(f, s, x, x_rate, alpha, data) at an address, arrays but for the number alpha."""
    return _call(types.void(ADDRESS, VECTOR, VECTOR, VECTOR, VECTOR, float64, VECTOR))


@intrinsic
def call_settle(context, kernel, f, s, alpha, base, x):
    """Call the kernel int64(f, s, alpha, base, x) at an address, arrays but for the number alpha; returns its code."""
    return _call(int64(ADDRESS, VECTOR, VECTOR, float64, VECTOR, VECTOR))


@intrinsic
def call_wrench_jacobian(context, kernel, f, s, x, rows):
    """Call the kernel void(f, s, x, rows) at an address, three arrays and a matrix."""
    return _call(types.void(ADDRESS, VECTOR, VECTOR, VECTOR, MATRIX))


@intrinsic
def call_rates(context, function, tau, y, yp, data):
    """Call the function int32(double, y, yp, data) at an address, three addresses passed on; returns its status."""
    return _call(int32(ADDRESS, float64, ADDRESS, ADDRESS, ADDRESS))


@intrinsic
def call_residual(context, function, tau, y, yp, res, data):
    """Call the function int32(double, y, yp, res, data) at an address, four addresses passed on; returns its status."""
    return _call(int32(ADDRESS, float64, ADDRESS, ADDRESS, ADDRESS, ADDRESS))


@intrinsic
def call_derivatives(context, function, tau, alpha, y, yp, values, data):
    """Call the function int32(double, double, y, yp, values, data) at an address, four addresses passed on; returns its
    status."""
    return _call(int32(ADDRESS, float64, float64, ADDRESS, ADDRESS, ADDRESS, ADDRESS))
