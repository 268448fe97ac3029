"""Heat of friction: with a full film, and dry."""

from ...numerics.piecewise_linear import initially
from ...scene.gas import viscosity_of
from ._finding import Finding, Verdict, noted, other_seals

SOURCE = "full film mu A (w D/2)^2/h, dry pi f F D N, carbon-graphite f 0.1 to 0.25"
COMMAND = "sealdyn run FILE"

FRICTION = (0.1, 0.25)


def finding(seal):
    """Watts at the highest sliding speed, of the film at the start, and of faces that carry the closing force above the
    lower pressure: a note; fail if the film makes more than the faces do dry, and so spares them nothing.  What the
    asperities make besides is told."""
    speed, film = seal.sliding_speed, seal.film_thickness
    if film <= 0.0:
        # Rough faces may carry a cone that closes their mean planes.
        return other_seals(f"the mean film is {1e6 * film:.4g} um: the asperities carry the faces")
    full = initially(viscosity_of(seal.scene.film)) * seal.face_area * speed**2 / film
    dry = [f * seal.face_load * speed for f in FRICTION]
    rough = seal.asperity_heat
    said = f"heat {full:.4g} W of a full film of {1e6 * film:.4g} um"
    said += f" and {rough:.4g} W of the asperities that touch," if rough > 0.0 else ""
    said += f" at {60 * speed:.4g} m/min; faces that run dry would make {dry[0]:.4g} to {dry[1]:.4g} W"
    if full > dry[1] > 0.0:
        said += f": more than without it, {1e-4 * full / seal.face_area:.4g} W/cm^2 of face"
        return Finding(Verdict.FAIL, said, full, "W", most=dry[1], numbers={"dry": dry, "asperities": rough})
    return noted(said, full, "W", dry=dry, asperities=rough)
