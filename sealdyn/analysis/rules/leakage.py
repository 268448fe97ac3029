"""Leakage of the aligned faces."""

from ...numerics.piecewise_linear import initially
from ._finding import Verdict, missing, other_seals, within

SOURCE = "limit 5 cc/h, goal 1 cc/h"
COMMAND = "sealdyn run FILE"

CC_PER_H = 1e-6 / 3600
LIMIT, GOAL = 5 * CC_PER_H, 1 * CC_PER_H


def finding(seal):
    """Pass up to the goal, a note up to the limit of the data sheet (5 cc/h without one)."""
    if seal.scene.film.gas is not None:
        return other_seals("the film is a gas")
    film, own = seal.scene.film, seal.application.leakage_limit
    if initially(film.outer_pressure) == initially(film.inner_pressure):
        return missing("film.outer_pressure", "film.inner_pressure")
    leakage, most = seal.leakage, LIMIT if own is None else own
    goal = min(GOAL, most)
    whose = "the guide's" if own is None else "this seal's"
    said = (
        f"aligned faces leak {leakage / CC_PER_H:.4g} cc/h at the start, {whose} limit is {most / CC_PER_H:.4g} cc/h, "
        f"the goal {goal / CC_PER_H:.4g} cc/h"
    )
    beyond = Verdict.FAIL if leakage > most else Verdict.NOTE
    if beyond == Verdict.FAIL:
        return within(said, leakage, "m^3/s", most=most)
    return within(said, leakage, "m^3/s", most=goal, beyond=beyond)
