"""What a film with unknowns says of them, and the derivatives of its residual and of its force."""

from dataclasses import dataclass
from functools import cached_property

import numpy as np
from scipy.sparse import csc_array

from ..faces.geometry import FORCE

# Steps of differences, as a share of the unknowns' scales.
STEP = 1e-4


@dataclass(frozen=True, eq=False)
class FilmUnknowns:
    """Unknowns `x` (n,) of a film.

    `names`; `scales` (n,) in their units; `differential` (n,) bool, true where the residual's row of that unknown has
    its rate in it, false where unknown and row are algebraic; `pattern` (n, n) of the residual's derivative by x and
    by x's rate together, a CSC array whose values do not matter.
    """

    names: tuple
    scales: np.ndarray
    differential: np.ndarray
    pattern: csc_array

    @cached_property
    def colours(self) -> list[np.ndarray]:
        """Groups of columns that share no row: one difference serves a group.
        **Source** Curtis, Powell & Reid (1974), IMA J. Appl. Math. 13, 117-119."""
        indptr, indices, groups = self.pattern.indptr, self.pattern.indices, []
        for column in range(len(self.names)):
            rows = indices[indptr[column] : indptr[column + 1]]
            for group in groups:
                if not group[1][rows].any():
                    break
            else:
                group = [], np.zeros(len(self.names), dtype=bool)
                groups.append(group)
            group[0].append(column)
            group[1][rows] = True
        return [np.array(columns) for columns, _ in groups]


class FilmDerivatives:
    """Derivatives of a film with unknowns: its own kernels where it has them, else central differences.  `film` the
    module, `unknowns` its FilmUnknowns, `f` its block."""

    def __init__(self, film, unknowns: FilmUnknowns, f: np.ndarray):
        self.film, self.unknowns, self.f = film, unknowns, f
        n = len(unknowns.names)
        self._data, self._above, self._below = np.empty(unknowns.pattern.nnz), np.empty(n), np.empty(n)

    def residual(self, s, x, x_rate, alpha) -> np.ndarray:
        """d residual / d x + alpha d residual / d x_rate, the values (nnz,) of the pattern; reused by the next call."""
        data, pattern = self._data, self.unknowns.pattern
        if hasattr(self.film, "jacobian"):
            self.film.jacobian(self.f, s, x, x_rate, alpha, data)
            return data
        for columns in self.unknowns.colours:
            step = np.zeros(len(x))
            step[columns] = STEP * np.maximum(np.abs(x[columns]), self.unknowns.scales[columns])
            self.film.residual(self.f, s, x + step, x_rate + alpha * step, self._above)
            self.film.residual(self.f, s, x - step, x_rate - alpha * step, self._below)
            difference = self._above - self._below
            for column in columns:
                at = slice(pattern.indptr[column], pattern.indptr[column + 1])
                data[at] = difference[pattern.indices[at]] / (2 * step[column])
        return data

    def matrix(self, s, x, x_rate, alpha) -> csc_array:
        """The same as a CSC array (n, n) of its own."""
        pattern = self.unknowns.pattern
        return csc_array((self.residual(s, x, x_rate, alpha).copy(), pattern.indices, pattern.indptr), pattern.shape)

    def wrench(self, s, x) -> np.ndarray:
        """d (force, moments) / d x, shape (3, n), in N and N m per unit of each unknown, at a gap state `s` and
        unknowns `x` (n,); every unknown may feel in all three."""
        rows = np.empty((3, len(x)))
        if hasattr(self.film, "wrench_jacobian"):
            self.film.wrench_jacobian(self.f, s, x, rows)
            return rows
        moved, s = x.copy(), s.copy()
        for column in range(len(x)):
            step = STEP * max(abs(x[column]), self.unknowns.scales[column])
            for sign in (1.0, -1.0):
                moved[column] = x[column] + sign * step
                self.film.wrench(self.f, s, moved)
                part = s[FORCE : FORCE + 3] / (2 * step)
                rows[:, column] = part if sign > 0 else rows[:, column] - part
            moved[column] = x[column]
        return rows
