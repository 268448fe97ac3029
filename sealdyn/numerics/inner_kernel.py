"""The decorator of compiled kernels that only other kernels call."""

from functools import partial

from numba.extending import register_jitable

# Without the ways in from Python and from C, on which the compiler spends a quarter of a kernel's time; called from
# Python it runs as Python.
inner_kernel = partial(register_jitable, cache=True, no_cfunc_wrapper=True)
