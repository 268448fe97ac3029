"""Stiffness and damping of a film with unknowns, these eliminated at one frequency (dynamic condensation)."""

import numpy as np
from scipy.sparse.linalg import splu

from ..faces.geometry import FORCE
from .modes import gap_slopes


def condensed(derivatives, s, x, steps, omega: float = 0.0):
    """Stiffness and damping matrices (3, 3) of a film with unknowns about a gap state `s` and its unknowns `x`, on
    (dz, g_x, g_y), for a motion of angular frequency `omega` (rad/s).

    With gap g exp(i w t), unknowns x exp(i w t) and the residual's derivatives R, force's F:

        (R_x + i w R_x') x = -(R_g + i w R_g') g,     K + i w D = -[F_x x / g + F_g + i w F_g']

    At w = 0 D is the limit.  `derivatives` FilmDerivatives; `steps` as in modes.gap_slopes.
    **Source** derived here from the two lines above; against the exact solution of a flat annulus that stores in
    tests/ladder/test_film_with_unknowns.py.
    **Valid** small motion about an equilibrium: neither x nor the gap changes in the state.
    """
    film, f, rest, res = derivatives.film, derivatives.f, np.zeros_like(x), np.empty_like(x)

    def residual_at(moved):
        film.residual(f, moved, x, rest, res)
        return res

    def force_at(moved):
        film.wrench(f, moved, x)
        return moved[FORCE : FORCE + 3]

    by_gap, force_by_gap = gap_slopes(residual_at, s, steps, len(x)), gap_slopes(force_at, s, steps, 3)
    by_x, force_by_x = derivatives.matrix(s, x, rest, 0.0), derivatives.wrench(s, x)
    by_rate = derivatives.matrix(s, x, rest, 1.0) - by_x
    if omega == 0.0:
        solved = splu(by_x.tocsc())
        moved = -solved.solve(by_gap[:, :3])
        stiffness = -(force_by_x @ moved + force_by_gap[:, :3])
        return stiffness, force_by_x @ solved.solve(by_gap[:, 3:] + by_rate @ moved) - force_by_gap[:, 3:]
    pushed = by_gap[:, :3] + 1j * omega * by_gap[:, 3:]
    moved = -splu((by_x + 1j * omega * by_rate).tocsc()).solve(pushed)
    total = -(force_by_x @ moved + force_by_gap[:, :3] + 1j * omega * force_by_gap[:, 3:])
    return total.real, total.imag / omega
