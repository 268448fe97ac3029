"""Arrays and functions by their addresses, inside compiled code: what C hands over."""

from llvmlite import ir
from numba import float64, int32, int64, types
from numba.extending import intrinsic

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
