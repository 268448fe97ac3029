"""Who reaches an error in the least time, from the runs of many methods."""

import math
from itertools import pairwise

from ...status import Status


def mark_slow_runs(methods: dict, where: str, slowest: float):
    """A run that took more than `slowest` times the fastest of at most its error becomes a cross."""
    everyone = {name: curve(row, where) for name, row in methods.items()}
    for row in methods.values():
        for k, error in enumerate(row["error"][where]):
            if row["status"][k] != Status.OK or error is None:
                continue
            least = min((w for c in everyone.values() for e, w in c if e <= error), default=math.inf)
            if row["wall"][k] > slowest * least:
                row["status"][k] = "slow"
                row["reason"][k] = f"{row['wall'][k] / least:.0f} times the fastest of this error"


def curve(row: dict, where: str, cost: str = "wall") -> list[tuple[float, float]]:
    """(error, cost) of the runs that ended, errors above zero."""
    return [
        (max(error, 1e-16), spent)
        for error, spent, status in zip(row["error"][where], row[cost], row["status"], strict=True)
        if status == Status.OK and error is not None
    ]


def time_at(points, error: float) -> float | None:
    """Cost at an error: between runs on a line of logarithms, along the lower edge; None below the smallest error."""
    edge, least = [], math.inf
    for e, wall in sorted(points):
        # From the most exact on: only what is cheaper yet is worth its error.
        if wall < least:
            least = wall
            edge.append((math.log(e), math.log(wall)))
    if not edge or edge[0][0] > math.log(error):
        return None
    for (e0, w0), (e1, w1) in pairwise(edge):
        if e1 >= math.log(error):
            return math.exp(w0 + (w1 - w0) * (math.log(error) - e0) / (e1 - e0))
    return math.exp(edge[-1][1])


def rank_methods(answer: dict, error: float) -> dict:
    """Who reaches an error in the least time, by what factor over the next and over DOP853."""
    where = answer["where"]
    band = (answer["judge_error"] or {}).get(where)
    if band is not None and band > error / 3:
        return {"error": error, "method": None, "why": f"the judges differ by {band:.1e}"}
    found = {name: time_at(curve(row, where), error) for name, row in answer["methods"].items()}
    order = sorted((wall, name) for name, wall in found.items() if wall is not None)
    if not order:
        collapsed = answer["judges"].get("status") == Status.COLLAPSED
        why = "the film collapses in the judge's run too" if collapsed else "no method got there"
        return {"error": error, "method": None, "why": why}
    wall, name = order[0]
    # Who ended well at the tightest tolerance and is still above this error was not asked tightly enough.
    above = [m for m, row in answer["methods"].items() if found[m] is None and row["status"][-1] == Status.OK]
    out = {"error": error, "method": name, "wall": wall, "next": None, "factor_next": None, "factor_dop853": None,
           "not_asked": above}  # fmt: skip
    if len(order) > 1:
        out |= {"next": order[1][1], "factor_next": order[1][0] / wall}
    if found.get("dop853"):
        out["factor_dop853"] = found["dop853"] / wall
    return out
