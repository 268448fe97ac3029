"""The opening force of aligned faces over the clearance, of any film's kernel."""

from ..faces.geometry import CLEARANCE, FLOOR, FORCE, INNER_PRESSURE, OUTER_PRESSURE


def opening_force(film, f, s, solve):
    """The function `force(clearance, inner_pressure, outer_pressure, floor)` (N) of a film's `opening_law`.

    `film` a Film table; one block `f` for all clearances, of which only the slots of the clearance and the floor (m)
    differ; gap state `s` of the aligned faces; `solve(f, s)` writes the force.
    """

    def force(clearance: float, inner_pressure: float, outer_pressure: float, floor: float | None = None) -> float:
        f[CLEARANCE], f[FLOOR] = clearance, film.floor * clearance if floor is None else floor
        s[INNER_PRESSURE], s[OUTER_PRESSURE] = inner_pressure, outer_pressure
        solve(f, s)
        return float(s[FORCE])

    return force
