"""Kernels handed to kernels as function values: what a scene chooses is called through its address, not compiled in."""

from functools import lru_cache

import numpy as np
from numba import float64, int64, types

from ..faces.contact import contact_load, contact_load_and_friction, no_load
from ..faces.film_thickness import h_min_of

VECTOR, MATRIX = float64[::1], float64[:, ::1]
# A film's kernel on its block and a gap state; the load of contact on its block, a film's and a gap state; the thinnest
# place of a face block at a gap state.
FILM, LOAD = types.FunctionType(types.void(VECTOR, VECTOR)), types.FunctionType(types.void(VECTOR, VECTOR, VECTOR))
# Friction of the secondary seal of a ring (int64) whose carrier spins, on the parameters and the scratch.
SEAL = types.FunctionType(float64(int64, float64, float64, VECTOR, VECTOR))
THINNEST = types.FunctionType(types.UniTuple(float64, 3)(VECTOR, VECTOR))


@lru_cache
class Value(types.WrapperAddressProtocol):
    """A kernel as a function value, its address looked up once: each look-up costs as much as thirty films."""

    def __init__(self, kernel, kind=FILM):
        found = kernel.get_compile_result(kind.signature)
        self.address = found.library.get_pointer_to_function(found.fndesc.llvm_cfunc_wrapper_name)
        if not self.address:
            raise TypeError(f"{kernel.__name__} is no value_kernel (numerics/kernel.py): it has no address")
        # What numba looks for first: without it the type is made anew at every call.
        self._numba_type_ = kind

    def __wrapper_address__(self):
        return self.address

    def signature(self):
        """The kernel's signature, which numba asks for."""
        return self._numba_type_.signature


def load_value(block, complete=False) -> tuple[Value, np.ndarray]:
    """Load of contact as a function value, `complete` with friction and wear, and its block; without one (None) a load
    that does nothing, and an empty block."""
    if block is None:
        return Value(no_load, LOAD), np.empty(0)
    return Value(contact_load_and_friction if complete else contact_load, LOAD), block


def thinnest_value(face) -> Value:
    """What finds the thinnest place of a face block, as a function value."""
    return Value(h_min_of(face), THINNEST)
