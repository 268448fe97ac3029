"""What a film with unknowns says of them."""

from dataclasses import dataclass
from functools import cached_property

import numpy as np
from scipy.sparse import csc_array


@dataclass(frozen=True, eq=False)
class FilmUnknowns:
    """Unknowns `x` (n,) of a film.

    `names`; `scales` (n,) in their units; `differential` (n,) bool, true where the residual's row of that unknown has
    its rate in it, false where unknown and row are algebraic; `pattern` (n, n) of the residual's derivative by x and
    by x's rate together, a CSC array whose values do not matter; `around`: how many angles of the whole circle, and how
    many cells of each, the unknowns of one kind are (angle by angle, one kind after the other), None without any.
    """

    names: tuple
    scales: np.ndarray
    differential: np.ndarray
    pattern: csc_array
    around: tuple[int, int] | None = None

    @cached_property
    def colours(self) -> np.ndarray:
        """Colour (n,), from 0 on, of each column: those of one colour share no row, and one difference serves them.
        **Source** Curtis, Powell & Reid (1974), IMA J. Appl. Math. 13, 117-119."""
        indptr, indices = self.pattern.indptr, self.pattern.indices
        colours, taken = np.empty(len(self.names), dtype=np.int64), []
        for column in range(len(self.names)):
            rows = indices[indptr[column] : indptr[column + 1]]
            colour = next((i for i, used in enumerate(taken) if not used[rows].any()), len(taken))
            if colour == len(taken):
                taken.append(np.zeros(len(self.names), dtype=bool))
            taken[colour][rows], colours[column] = True, colour
        return colours
