"""The integrators by name: CVODE and IDA, SciPy's DOP853 and Radau as references, the matrix exponential, TR-BDF2."""

import os

import numpy as np

from .contract import SolverFailure, absolute_tolerances, failure_message
from .sundials_libraries import libraries

# SciPy's solvers, and whether they are implicit.
SCIPY = {"dop853": ("DOP853", False), "radau": ("Radau", True), "rk45": ("RK45", False), "lsoda": ("LSODA", True),
         "scipy_bdf": ("BDF", True), "quasi_static": ("BDF", True)}  # fmt: skip


def scipy_steps(segment, tau, y, method, tolerance, counts):
    """Steps of one of SciPy's solvers (`method` a key of SCIPY), with the contract of contract.py; an implicit one is
    given the segment's Jacobian.  **Raises** SolverFailure.

    **Source** Hairer, Norsett & Wanner (1993), Solving ODEs I (DOP853); Hairer & Wanner (1996), Solving ODEs II, IV.8
    (Radau IIA); Dormand & Prince, 1980 (RK45); Petzold, 1983 (LSODA); Shampine & Reichelt, 1997 (BDF).
    """
    from scipy import integrate

    kind, implicit = SCIPY[method]
    inner, stores = segment.rhs, segment.film.stop > segment.film.start

    def counted(t, y):
        counts.rhs += 1
        yp = np.empty_like(y)
        inner(t, y, yp)
        return yp

    def differences(t, y):
        # SciPy's own steps of the tolerance times 1e-8 drown beside a clearance.
        counts.jacobians += 1
        counts.rhs += segment.n_mechanical
        if stores:
            return segment.rates_matrix(t, np.array(y))
        matrix = np.empty((segment.size, segment.size))
        segment.jacobian(t, np.array(y), None, matrix)
        return matrix

    options = {"jac": differences} if implicit else {}
    # SciPy's own floor on rtol is 100 eps; the absolute part carries the accuracy below it.  Its norm is an average:
    # the unweighted last unknown would only loosen it, by sqrt(n/(n-1)).
    relative, absolute = max(tolerance, 2.3e-14), absolute_tolerances(segment, tolerance)
    solver = getattr(integrate, kind)(
        counted, tau, y, segment.length, rtol=relative, atol=absolute, max_step=segment.longest_step(), **options
    )
    while solver.status == "running":
        # A trial stage may fly off and overflow; the error norm then refuses the step.
        try:
            with np.errstate(all="ignore"):
                message = solver.step()
        except (ValueError, np.linalg.LinAlgError) as error:
            # A matrix that is no number: the film has no solution there.
            raise SolverFailure(failure_message(method, str(error), solver.t)) from None
        if solver.status == "failed":
            raise SolverFailure(failure_message(method, message, solver.t))
        # Between steps a film is interpolated with its rates.
        yield np.array([solver.t]), solver.y[None, :].copy(), counted(solver.t, solver.y)[None, :] if stores else None


# Set to "python": scikit-sundae for everything.
CHOICE = "SEALDYN_SUNDIALS"
SCIKIT_SUNDAE = "scikit-sundae"


def cvode(segment, tau, y, method, tolerance, counts, max_order: int | None = None):
    """Steps of CVODE, Adams if so called, else BDF, with the contract of contract.py.
    **Raises** SolverFailure."""
    yield from _back_end(segment, counts, "rates").cvode(segment, tau, y, method, tolerance, counts, max_order)


def ida(segment, tau, y, method, tolerance, counts, max_order: int | None = None):
    """Steps of IDA, on the residual form, with the contract of contract.py; `y` is made consistent first.
    **Raises** SolverFailure."""
    yield from _back_end(segment, counts, "residual").ida(segment, tau, y, method, tolerance, counts, max_order)


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
        from . import sundials_python

        counts.back_end = SCIKIT_SUNDAE
        return sundials_python
    loaded = libraries()
    assert not isinstance(loaded, str), "why_slow tells of libraries that are not there"
    counts.back_end = f"SUNDIALS {loaded.version}, compiled loop"
    # Its compiled code needs the libraries open.
    from . import sundials_direct

    return sundials_direct


def _trbdf2(*given):
    """TR-BDF2, loaded where it is used: for cells that tear and fill."""
    from .own_methods import trbdf2

    return trbdf2(*given)


def _expm(*given):
    """The matrix exponential, loaded where it is used: for linear scenes."""
    from .own_methods import expm

    return expm(*given)


METHODS = {
    "adams": cvode,
    "bdf": cvode,
    "ida": ida,
    "dop853": scipy_steps,
    "radau": scipy_steps,
    "expm": _expm,
    "trbdf2": _trbdf2,
}
