"""The equations of a segment as functions for C: an address, the address of one block of parameters, and nothing of
Python inside.  What a compiled loop calls, and SUNDIALS itself (solvers/sundials_direct.py).

The kernels of film and contact come as addresses in the block: one function on disk serves all scenes.
"""

import math
from dataclasses import dataclass
from functools import cached_property, lru_cache

import numpy as np
from numba import boolean, carray, float64, int32, int64, types

from ..faces.contact import contact_load, contact_load_and_friction, no_load
from ..faces.film_thickness import h_min_of
from ..faces.geometry import FORCE, pumped
from ..numerics.kernel import (
    ADDRESS,
    MATRIX,
    VECTOR,
    c_function,
    call_film,
    call_load,
    call_rates,
    call_residual,
    floats,
    inner_kernel,
    integers,
    lazy_kernel,
    outer_kernel,
)
from .equations import CENTRE, OFFSET, kinematics, rates, residual

# --- Function values -----------------------------------------------------------------------------------

# What a scene chooses is called by a kernel through its address, not compiled in.
# A film's kernel on its block and a gap state; the load of contact on its block, a film's and a gap state; the thinnest
# place of a face block at a gap state.
FILM_TYPE, LOAD_TYPE = (
    types.FunctionType(types.void(VECTOR, VECTOR)),
    types.FunctionType(types.void(VECTOR, VECTOR, VECTOR)),
)
# Friction of the secondary seal of a ring (int64) whose carrier spins, on the parameters and the scratch.
SEAL_TYPE = types.FunctionType(float64(int64, float64, float64, VECTOR, VECTOR))
THINNEST_TYPE = types.FunctionType(types.UniTuple(float64, 3)(VECTOR, VECTOR))


@lru_cache
class Value(types.WrapperAddressProtocol):
    """A kernel as a function value, its address looked up once: each look-up costs as much as thirty films."""

    def __init__(self, kernel, kind=FILM_TYPE):
        # By its arguments alone, as a call compiles it: by its whole signature it would be made and kept once more.
        kernel.compile(kind.signature.args)
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
        return Value(no_load, LOAD_TYPE), np.empty(0)
    return Value(contact_load_and_friction if complete else contact_load, LOAD_TYPE), block


def thinnest_value(face) -> Value:
    """What finds the thinnest place of a face block, as a function value."""
    return Value(h_min_of(face), THINNEST_TYPE)


# The block, int64: number of unknowns, kernels of film and contact, then address and length of each array.
SIZE, KERNEL, LOAD, ARRAYS = 0, 1, 2, 3
PARAMETERS, SCRATCH, GAP, FILM, CONTACT, WORK = range(6)
BLOCK = ARRAYS + 2 * 6
# C: int(double tau, double *y, double *yp, [double *res,] int64 *block), the status 0, or 1 where the film has no
# solution, -1 where one with unknowns of its own (coupled_native.py) has none.
RATES = int32(float64, ADDRESS, ADDRESS, ADDRESS)
RESIDUAL = int32(float64, ADDRESS, ADDRESS, ADDRESS, ADDRESS)


@dataclass(frozen=True)
class Native:
    """A segment's equations for C: address of its `rates`, the `block` and the `arrays` that it points to, which it
    keeps alive; of a film with unknowns no rates (0), and addresses of its own `residual`, its `derivatives`, and the
    rates of the rings."""

    rates: int
    block: np.ndarray
    arrays: tuple
    own_residual: int = 0
    derivatives: int = 0
    rates_of_rings: int = 0

    @property
    def ring_rates(self) -> int:
        """Address of the rates of rings and works at given unknowns of the film, if it has any."""
        return self.rates_of_rings or self.rates

    @cached_property
    def data(self) -> int:
        """Address of the block."""
        return self.block.ctypes.data

    @property
    def residual(self) -> int:
        """Address of the residual; that of rings alone is compiled when it is asked for: few integrations need it."""
        return self.own_residual or residual_at.address


def native(segment) -> Native:
    """The equations of a segment whose film has no unknowns of its own (else coupled_native.py); they work on the
    segment's own arrays."""
    model, work = segment.model, np.zeros(segment.size)
    load, contact = load_value(model.contact)
    arrays = (segment.p, segment.w, segment.s, model.f, contact, work)
    block = [segment.size, Value(model.interface.film.wrench).address, load.address]
    for array in arrays:
        block += [array.ctypes.data, len(array)]
    return Native(rates_at.address, np.array(block, dtype=np.int64), arrays)


@inner_kernel()
def array(block, which):
    """One of the block's arrays."""
    at = ARRAYS + 2 * which
    return carray(floats(block[at]), block[at + 1])


@inner_kernel()
def loads(tau, y, yp, block):
    """Kinematics, film and contact at segment time tau (s) and unknowns `y` (size,), in the block's gap state."""
    f, s = array(block, FILM), array(block, GAP)
    kinematics(tau, y, yp, array(block, PARAMETERS), array(block, SCRATCH), s)
    call_film(block[KERNEL], f, s)
    call_load(block[LOAD], array(block, CONTACT), f, s)


@c_function(RATES)
def rates_at(tau, y_at, yp_at, data):
    """The right-hand side."""
    block = carray(integers(data), BLOCK)
    y, yp = carray(floats(y_at), block[SIZE]), carray(floats(yp_at), block[SIZE])
    loads(tau, y, yp, block)
    s = array(block, GAP)
    rates(tau, y, array(block, PARAMETERS), array(block, SCRATCH), s, yp)
    # A shorter step may stay where the film has a solution.
    return 1 if math.isnan(s[FORCE]) else 0


@c_function(RESIDUAL)
def residual_at(tau, y_at, yp_at, res_at, data):
    """The residual."""
    block = carray(integers(data), BLOCK)
    y, yp = carray(floats(y_at), block[SIZE]), carray(floats(yp_at), block[SIZE])
    loads(tau, y, yp, block)
    p, w, s = array(block, PARAMETERS), array(block, SCRATCH), array(block, GAP)
    residual(tau, y, yp, p, w, s, array(block, WORK), carray(floats(res_at), block[SIZE]))
    return 0


# --- At many instants in one call ----------------------------------------------------------------------

# What differs from scene to scene, film, contact and thinnest place, comes as a function value: one kernel on disk
# serves all, and none compiles what its scene has not.


@lazy_kernel(types.void(ADDRESS, ADDRESS, VECTOR, MATRIX, MATRIX))
def rates_along(function, block, taus, ys, yps):
    """Derivatives `yps` (m, unknowns) at segment times `taus` (m,) (s) and unknowns `ys` (m, unknowns), by addresses of
    the `function` for C and of its `block` (dynamics/native.py)."""
    for i in range(len(taus)):
        call_rates(function, taus[i], ys[i].ctypes.data, yps[i].ctypes.data, block)


@lazy_kernel(types.void(ADDRESS, ADDRESS, float64, VECTOR, VECTOR))
def rates_of(function, block, tau, y, yp):
    """The same at one time tau (s), into `yp` (unknowns,)."""
    call_rates(function, tau, y.ctypes.data, yp.ctypes.data, block)


@lazy_kernel(types.void(ADDRESS, ADDRESS, float64, VECTOR, VECTOR, VECTOR))
def residual_of(function, block, tau, y, yp, res):
    """Residual `res` (unknowns,) at a segment time tau (s), unknowns `y` and derivatives `yp` (unknowns,), by addresses
    of the `function` for C and of its `block`."""
    call_residual(function, tau, y.ctypes.data, yp.ctypes.data, res.ctypes.data, block)


STATES = types.void(
    FILM_TYPE, VECTOR, LOAD_TYPE, VECTOR, boolean, VECTOR, VECTOR, VECTOR, VECTOR, MATRIX, MATRIX,
    THINNEST_TYPE, VECTOR, MATRIX, MATRIX, MATRIX,
)  # fmt: skip


@lazy_kernel(STATES)
def states_along(flow, f, contact, block, seals, p, w, s, taus, ys, yps, thinnest, face, gaps, scratch, low):
    """Gap states `gaps` (m, GAP_STATE_SIZE), scratch states `scratch` (m, SCRATCH) and `low` (m, 3), the thinnest film
    of the `face` (m) as `thinnest` finds it, its angle (rad) and radius (m), at segment times `taus` (m,) (s) and
    unknowns `ys`; `yps` (m, unknowns) gives the rates of a massless ring.  `flow` may be any kernel of a film; with
    `seals` the friction of secondary seals too."""
    out = np.empty(yps.shape[1])
    for i in range(len(taus)):
        kinematics(taus[i], ys[i], yps[i], p, w, s)
        flow(f, s)
        if p[OFFSET] != 0.0:
            pumped(p[OFFSET:], w[CENTRE:], f, s)
        contact(block, f, s)
        if seals:
            rates(taus[i], ys[i], p, w, s, out)
        # One by one: assigning whole arrays would take seconds to compile.
        for j in range(len(s)):
            gaps[i, j] = s[j]
        for j in range(len(w)):
            scratch[i, j] = w[j]
        low[i, 0], low[i, 1], low[i, 2] = thinnest(face, s)


@lazy_kernel(types.void(FILM_TYPE, VECTOR, MATRIX))
def at_each(kernel, f, gaps):
    """A film's kernel on every gap state of `gaps` (m, GAP_STATE_SIZE)."""
    for i in range(len(gaps)):
        kernel(f, gaps[i])


@outer_kernel()
def propagate(matrix, start, pushes):
    """States (m + 1, n) of x' = matrix x + push from `start` on, one push (m, n) a step."""
    count, n = pushes.shape
    states = np.empty((count + 1, n))
    states[0] = start
    for k in range(count):
        for i in range(n):
            total = pushes[k, i]
            for j in range(n):
                total += matrix[i, j] * states[k, j]
            states[k + 1, i] = total
    return states
