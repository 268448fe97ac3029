"""One thread for linear algebra: matrices here have a dozen rows, and threads of every worker's BLAS only get in each
other's way."""

import os
from functools import cache

VARIABLES = ("OPENBLAS_NUM_THREADS", "MKL_NUM_THREADS", "OMP_NUM_THREADS")


@cache
def one_thread():
    """Keep this process to one thread of BLAS and OpenMP: libraries that are loaded, and those that are still to be."""
    from threadpoolctl import threadpool_limits

    for name in VARIABLES:
        os.environ.setdefault(name, "1")
    threadpool_limits(1)
