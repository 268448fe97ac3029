"""Cells over radius and angle, angle by angle, the last angle beside the first: who are neighbours, and band matrices
of their balances, the circle folded so that elimination stays in a band.
"""

import numpy as np

from ..numerics.kernel import inner_kernel

# What a balance has of its own unknown and of its neighbours', at the same angle and at the same radius.
OWN, INNER, OUTER, BEFORE, AFTER = range(5)


def balances(cells: int, angles: int) -> tuple[np.ndarray, np.ndarray]:
    """Rows and columns (entries,) of the balances of `cells` at each of so many `angles`: each has its own unknown and
    those of its four neighbours; on a short circle an entry may come twice."""
    n = cells * angles
    own = np.arange(n)
    inner, outer = own[own % cells > 0], own[own % cells < cells - 1]
    rows = np.concatenate([own, inner - 1, outer + 1, (own - cells) % n, (own + cells) % n])
    return rows, np.concatenate([own, inner, outer, own, own])


@inner_kernel()
def neighbours(k, angles):
    """The angles before and after angle k, around the circle."""
    return k - 1 if k > 0 else angles - 1, k + 1 if k < angles - 1 else 0


@inner_kernel()
def place(k, angles):
    """Place in the band of angle k: the circle folded, so that neighbours are two places apart at most."""
    return 2 * k - 1 if 0 < k <= angles // 2 else 2 * (angles - k) % (2 * angles)


@inner_kernel()
def room(angles, cells):
    """Room for the band matrix (n, 2 width + 1) of so many cells, and for its right side (n,)."""
    n, width = angles * cells, 2 * cells if angles > 2 else cells if angles == 2 else 1
    return np.empty((n, 2 * width + 1)), np.empty(n)


@inner_kernel()
def eliminate(band, y):
    """Solve with a band matrix (n, 2 width + 1), its diagonal in the middle, and `y` (n,), both of which it spoils; the
    solution is left in `y`.  Returns whether all pivots are numbers other than 0.

    Without exchanges of rows: every column is dominated by its diagonal, for what a cell loses its neighbours get.
    """
    n, width = band.shape[0], band.shape[1] // 2
    for i in range(n):
        pivot = band[i, width]
        if not abs(pivot) > 0.0:
            return False
        last = min(width, n - 1 - i)
        # The row ends where the folded circle does.
        while last > 0 and band[i, width + last] == 0.0 and band[i + last, width - last] == 0.0:
            last -= 1
        head = band[i, width + 1 : width + 1 + last]
        for down in range(1, last + 1):
            share = band[i + down, width - down] / pivot
            if share != 0.0:
                tail = band[i + down, width - down + 1 : width - down + 1 + last]
                for across in range(last):
                    tail[across] -= share * head[across]
                y[i + down] -= share * y[i]
    for i in range(n - 1, -1, -1):
        for across in range(1, min(width, n - 1 - i) + 1):
            y[i] -= band[i, width + across] * y[i + across]
        y[i] /= band[i, width]
    return True


@inner_kernel()
def unfold(y, u):
    """Unknowns `u` (angles, cells) from their order in the band, `y` (n,)."""
    angles, cells = u.shape
    for k in range(angles):
        here = place(k, angles) * cells
        for j in range(cells):
            u[k, j] = y[here + j]
