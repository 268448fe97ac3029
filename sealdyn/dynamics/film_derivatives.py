"""Derivatives of the residual and of the force of a film with unknowns of its own: by its own kernels where it has
them, else by central differences."""

import numpy as np
from numba import float64, int64, types
from scipy.sparse import csc_array

from ..faces.geometry import FORCE
from ..films._contract import Film, FilmUnknowns
from ..numerics.addresses import (
    MATRIX,
    VECTOR,
    call_film_jacobian,
    call_film_residual,
    call_load,
    call_wrench_jacobian,
)
from ..numerics.kernel import outer_kernel
from .function_values import LOAD, Value

# Addresses of a film's kernels, int64; 0 where it has none.
WRENCH, RESIDUAL, JACOBIAN, WRENCH_JACOBIAN, SETTLE = range(5)
KINDS = (
    LOAD,
    types.FunctionType(int64(VECTOR, VECTOR, VECTOR, VECTOR, VECTOR)),
    types.FunctionType(types.void(VECTOR, VECTOR, VECTOR, VECTOR, float64, VECTOR)),
    types.FunctionType(types.void(VECTOR, VECTOR, VECTOR, MATRIX)),
    types.FunctionType(int64(VECTOR, VECTOR, float64, VECTOR, VECTOR)),
)
# Steps of differences, as a share of the unknowns' scales.
STEP = 1e-4


def kernels_of(film: Film) -> np.ndarray:
    """Addresses (5,) of a film's kernels."""
    kernels = film.wrench, film.residual, film.jacobian, film.wrench_jacobian, film.settle
    return np.array([Value(k, kind).address if k else 0 for k, kind in zip(kernels, KINDS, strict=True)])


@outer_kernel()
def residual_by_unknowns(kernels, f, s, x, x_rate, alpha, scales, indptr, indices, colours, data):
    """d residual / d x + alpha d residual / d x_rate into `data` (nnz,), the values of the pattern `indptr` (n + 1,),
    `indices` (nnz,); `scales` and `colours` (n,) as in FilmUnknowns.  Returns a code of the film."""
    n = len(x)
    if kernels[JACOBIAN] != 0:
        call_film_jacobian(kernels[JACOBIAN], f, s, x, x_rate, alpha, data)
        return 0
    near, rate, above, below = np.empty(n), np.empty(n), np.empty(n), np.empty(n)
    for colour in range(colours.max() + 1):
        for sign, res in ((1.0, above), (-1.0, below)):
            for j in range(n):
                step = sign * STEP * max(abs(x[j]), scales[j]) if colours[j] == colour else 0.0
                near[j], rate[j] = x[j] + step, x_rate[j] + alpha * step
            code = call_film_residual(kernels[RESIDUAL], f, s, near, rate, res)
            if code != 0:
                return code
        for j in range(n):
            if colours[j] == colour:
                step = STEP * max(abs(x[j]), scales[j])
                for place in range(indptr[j], indptr[j + 1]):
                    i = indices[place]
                    data[place] = (above[i] - below[i]) / (2 * step)
    return 0


@outer_kernel()
def wrench_by_unknowns(kernels, f, s, x, scales, rows):
    """d (force, moments) / d x into `rows` (3, n); force and moments in `s` stay as they are."""
    if kernels[WRENCH_JACOBIAN] != 0:
        call_wrench_jacobian(kernels[WRENCH_JACOBIAN], f, s, x, rows)
        return
    held, near = s[FORCE : FORCE + 3].copy(), x.copy()
    for j in range(len(x)):
        step = STEP * max(abs(x[j]), scales[j])
        rows[:, j] = 0.0
        for sign in (1.0, -1.0):
            near[j] = x[j] + sign * step
            call_load(kernels[WRENCH], f, s, near)
            for k in range(3):
                rows[k, j] += sign * s[FORCE + k] / (2 * step)
        near[j] = x[j]
    s[FORCE : FORCE + 3] = held


class FilmDerivatives:
    """These derivatives for one film: `unknowns` its FilmUnknowns, `f` its block."""

    def __init__(self, film: Film, unknowns: FilmUnknowns, f: np.ndarray):
        self.film, self.unknowns, self.f = film, unknowns, f
        self.kernels, self.scales = kernels_of(film), np.ascontiguousarray(unknowns.scales, dtype=float)
        pattern = unknowns.pattern
        self.pattern = tuple(part.astype(np.int64) for part in (pattern.indptr, pattern.indices, unknowns.colours))

    def matrix(self, s, x, x_rate, alpha) -> csc_array:
        """d residual / d x + alpha d residual / d x_rate, a CSC array (n, n), at a gap state `s` and unknowns `x`
        (n,)."""
        pattern, data = self.unknowns.pattern, np.empty(self.unknowns.pattern.nnz)
        residual_by_unknowns(self.kernels, self.f, s, x, x_rate, alpha, self.scales, *self.pattern, data)
        return csc_array((data, pattern.indices, pattern.indptr), pattern.shape)

    def wrench(self, s, x) -> np.ndarray:
        """d (force, moments) / d x, shape (3, n), in N and N m per unit of each unknown; every unknown may feel in all
        three."""
        rows = np.empty((3, len(x)))
        wrench_by_unknowns(self.kernels, self.f, s, x, self.scales, rows)
        return rows
