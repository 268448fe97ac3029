"""CVODE and IDA: by the compiled loop (sundials_direct.py) where a segment has equations for C and the libraries are as
known, else through scikit-sundae (sundials_python.py)."""

import os

from . import sundials_python
from .sundials_libraries import libraries

# Set to "python": scikit-sundae for everything.
CHOICE = "SEALDYN_SUNDIALS"
SCIKIT_SUNDAE = "scikit-sundae"


def cvode(segment, tau, y, method, tolerance, counts, max_order: int | None = None):
    """Steps of CVODE, Adams if so called, else BDF, with the contract of contract.py.
    **Raises** SolverFailure."""
    yield from _back_end(segment, counts).cvode(segment, tau, y, method, tolerance, counts, max_order)


def ida(segment, tau, y, method, tolerance, counts):
    """Steps of IDA, on the residual form, with the contract of contract.py; `y` is made consistent first.
    **Raises** SolverFailure."""
    yield from _back_end(segment, counts).ida(segment, tau, y, method, tolerance, counts)


def why_slow() -> str:
    """Why no run can take the compiled loop, a sentence; empty where it can."""
    if os.environ.get(CHOICE) == "python":
        return f"through scikit-sundae, several times slower: {CHOICE} asks for it"
    found = libraries()
    return f"through scikit-sundae, several times slower: {found}" if isinstance(found, str) else ""


def looped(segment) -> bool:
    """Whether the compiled loop takes a segment."""
    return not why_slow() and getattr(segment, "native", None) is not None


def _back_end(segment, counts):
    if not looped(segment):
        counts.back_end = SCIKIT_SUNDAE
        return sundials_python
    # Its compiled code needs the libraries open.
    from . import sundials_direct

    counts.back_end = f"SUNDIALS {libraries().version}, compiled loop"
    return sundials_direct
