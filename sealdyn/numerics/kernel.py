"""The decorators of compiled kernels.

All are kept on disk and divide as IEEE 754 says, not by Python's rules: an exception cannot pass through C, and a
kernel that left this open would take the rule of whoever calls it first.  None leaves its rounding to the compiler:
no fast-math, no threads.
"""

from functools import partial

from numba import cfunc, njit
from numba.extending import register_jitable

from .kept_kernels import check_kept_kernels

check_kept_kernels()
OPTIONS = {"cache": True, "error_model": "numpy"}

# Each is compiled with no more ways in than it needs: those from Python and from C take a quarter of a kernel's time.
# Called from Python and by kernels.
outer_kernel = partial(njit, **OPTIONS, no_cfunc_wrapper=True)
# Called from Python and by kernels, and handed to kernels as a function value.
value_kernel = partial(njit, **OPTIONS)
# Called by kernels only; called from Python it runs as Python.
inner_kernel = partial(register_jitable, **OPTIONS, no_cfunc_wrapper=True)
# Called by C only.
c_function = partial(cfunc, **OPTIONS)
