"""CVODE and IDA: by compiled loops (sundials_direct.py) where a segment has equations for C and the
libraries are as known, else through scikit-sundae (sundials_python.py)."""

import os

from . import sundials_python
from .sundials_libraries import libraries

# Set to "python": scikit-sundae for everything.
CHOICE = "SEALDYN_SUNDIALS"
SCIKIT_SUNDAE = "scikit-sundae"


def cvode(segment, tau, y, method, tolerance, counts, max_order: int | None = None):
    """Steps of CVODE, Adams if so called, else BDF, with the contract of contract.py.
    **Raises** SolverFailure."""
    yield from _back_end(segment, counts, "rates").cvode(segment, tau, y, method, tolerance, counts, max_order)


def ida(segment, tau, y, method, tolerance, counts):
    """Steps of IDA, on the residual form, with the contract of contract.py; `y` is made consistent first.
    **Raises** SolverFailure."""
    yield from _back_end(segment, counts, "residual").ida(segment, tau, y, method, tolerance, counts)


def why_slow(sparse: bool = False) -> str:
    """Why no run can take the compiled loop, or none that needs `sparse` matrices, a sentence; empty where it can."""
    if os.environ.get(CHOICE) == "python":
        why = f"{CHOICE} asks for it"
    else:
        found = libraries()
        why = found if isinstance(found, str) else found.why_not_sparse if sparse else ""
    return f"through scikit-sundae, several times slower: {why}" if why else ""


def looped(segment) -> bool:
    """Whether the compiled loop takes a segment's rates."""
    return not why_slow() and bool(getattr(segment.native, "rates", 0))


def _back_end(segment, counts, form):
    """Who makes the steps, from a segment's `form` (rates or residual)."""
    native = getattr(segment, "native", None)
    sparse = native is not None and bool(native.derivatives)
    counts.slow = why_slow(sparse)
    if counts.slow or not getattr(native, form, 0):
        counts.back_end = SCIKIT_SUNDAE
        return sundials_python
    counts.back_end = f"SUNDIALS {libraries().version}, compiled loop"
    # Its compiled code needs the libraries open.
    from . import sundials_direct

    return sundials_direct
