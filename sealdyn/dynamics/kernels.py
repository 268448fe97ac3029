"""The compiled kernels at many instants in one call.

A film's kernel comes as a function `Value`: its signature is fixed here, so that one kernel on disk serves all films.
"""

from functools import lru_cache

from numba import boolean, float64, njit, types

from ..faces.contact import contact_load, contact_load_and_friction
from ..faces.film_thickness import h_min
from .equations import kinematics, rates

VECTOR, MATRIX = float64[::1], float64[:, ::1]
SIGNATURE = types.void(VECTOR, VECTOR)
KERNEL = types.FunctionType(SIGNATURE)


@lru_cache
class Value(types.WrapperAddressProtocol):
    """A film's kernel as a function value, its address looked up once: each look-up costs as much as thirty films."""

    def __init__(self, kernel):
        self.kernel, found = kernel, kernel.get_compile_result(SIGNATURE)
        self.address = found.library.get_pointer_to_function(found.fndesc.llvm_cfunc_wrapper_name)

    def __wrapper_address__(self):
        return self.address

    def signature(self):
        """The kernel's signature, which numba asks for."""
        return SIGNATURE


@njit(types.void(KERNEL, VECTOR, VECTOR, VECTOR, VECTOR, VECTOR, VECTOR, MATRIX, MATRIX), cache=True)
def rates_along(wrench, f, block, p, w, s, taus, ys, yps):
    """Derivatives `yps` (m, unknowns) at segment times `taus` (m,) (s) and unknowns `ys` (m, unknowns): film block `f`,
    contact `block` (empty: none), parameters `p`, scratch `w` and `s` as in dynamics/equations.py."""
    for i in range(len(taus)):
        kinematics(taus[i], ys[i], yps[i], p, w, s)
        wrench(f, s)
        if len(block):
            contact_load(block, f, s)
        rates(taus[i], ys[i], p, w, s, yps[i])


@njit(
    types.void(
        KERNEL, VECTOR, VECTOR, boolean, VECTOR, VECTOR, VECTOR, VECTOR, MATRIX, MATRIX, VECTOR, MATRIX, MATRIX, MATRIX
    ),
    cache=True,
)
def states_along(flow, f, block, seals, p, w, s, taus, ys, yps, face, gaps, scratch, low):
    """Gap states `gaps` (m, GAP_STATE_SIZE), scratch states `scratch` (m, SCRATCH) and `low` (m, 3), the thinnest film
    of the `face` (m), its angle (rad) and radius (m), at segment times `taus` (m,) (s) and unknowns `ys`; `yps` (m,
    unknowns) gives the rates of a massless ring.  `flow` may be any kernel of a film; with `seals` the friction of
    secondary seals too."""
    out = yps[0].copy() if len(taus) else yps.ravel()
    for i in range(len(taus)):
        kinematics(taus[i], ys[i], yps[i], p, w, s)
        flow(f, s)
        if len(block):
            contact_load_and_friction(block, f, s)
        if seals:
            rates(taus[i], ys[i], p, w, s, out)
        gaps[i], scratch[i] = s, w
        low[i, 0], low[i, 1], low[i, 2] = h_min(face, s)


@njit(types.void(KERNEL, VECTOR, MATRIX), cache=True)
def at_each(kernel, f, gaps):
    """A film's kernel on every gap state of `gaps` (m, GAP_STATE_SIZE)."""
    for i in range(len(gaps)):
        kernel(f, gaps[i])
