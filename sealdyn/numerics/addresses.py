"""Arrays and functions by their addresses, inside compiled code: what C hands over."""

from llvmlite import ir
from numba import float64, int64, types
from numba.extending import intrinsic

ADDRESS, VECTOR = types.intp, float64[::1]


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


def _call(context, builder, arguments):
    """Call a function of arrays at an address; the arrays go as numba's own C wrappers take them."""
    array = context.get_value_type(VECTOR)
    kind = ir.FunctionType(ir.VoidType(), [array] * (len(arguments) - 1))
    builder.call(builder.inttoptr(arguments[0], kind.as_pointer()), arguments[1:])
    return context.get_dummy_value()


@intrinsic
def call_film(context, kernel, f, s):
    """Call the kernel void(f, s) at an address."""

    def code(context, builder, signature, arguments):
        return _call(context, builder, arguments)

    return types.void(ADDRESS, VECTOR, VECTOR), code


@intrinsic
def call_load(context, kernel, k, f, s):
    """Call the kernel void(k, f, s) at an address."""

    def code(context, builder, signature, arguments):
        return _call(context, builder, arguments)

    return types.void(ADDRESS, VECTOR, VECTOR, VECTOR), code


@intrinsic
def call_rates(context, function, tau, y, yp, data):
    """Call the function int32(double, y, yp, data) at an address, three addresses passed on; returns its status."""

    def code(context, builder, signature, arguments):
        word = context.get_value_type(ADDRESS)
        kind = ir.FunctionType(ir.IntType(32), [ir.DoubleType(), word, word, word])
        return builder.call(builder.inttoptr(arguments[0], kind.as_pointer()), arguments[1:])

    return types.int32(ADDRESS, float64, ADDRESS, ADDRESS, ADDRESS), code


@intrinsic
def call_residual(context, function, tau, y, yp, res, data):
    """Call the function int32(double, y, yp, res, data) at an address, four addresses passed on; returns its status."""

    def code(context, builder, signature, arguments):
        word = context.get_value_type(ADDRESS)
        kind = ir.FunctionType(ir.IntType(32), [ir.DoubleType(), word, word, word, word])
        return builder.call(builder.inttoptr(arguments[0], kind.as_pointer()), arguments[1:])

    return types.int32(ADDRESS, float64, ADDRESS, ADDRESS, ADDRESS, ADDRESS), code
