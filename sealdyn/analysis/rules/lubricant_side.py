"""Which side of the face the lubricant is on."""

from ...numerics.piecewise_linear import initially
from ._finding import Finding, Verdict, missing, other_seals

SOURCE = "lubricant on the outer diameter"
COMMAND = "sealdyn run FILE --set film.inertia=true"


def finding(seal):
    """Pass at the outer diameter, where it is thrown back into the seal; at the inner one the faces may starve: a
    note."""
    film = seal.scene.film
    if film.gas is not None:
        return other_seals("the film is a gas")
    rise = initially(film.outer_pressure) - initially(film.inner_pressure)
    if rise == 0.0:
        return missing("film.outer_pressure", "film.inner_pressure")
    if rise > 0.0:
        said = "sealed at the outer diameter: the centrifugal force keeps the lubricant there"
        return Finding(Verdict.PASS, said, rise, "Pa", least=0.0)
    said = "sealed at the inner diameter: the centrifugal force throws the lubricant through the film, it may starve"
    return Finding(Verdict.NOTE, said, rise, "Pa", least=0.0)
