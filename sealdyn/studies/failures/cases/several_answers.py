"""Several answers: a diverging film with rough faces has a clearance that touches and one that does not hold."""

from dataclasses import replace

from scipy.optimize import newton

from ....analysis.sources.green_1989 import reference_scene
from ....dynamics.model import Model
from ....scene.contact import Contact
from ....scene.scene import Closing
from ._common import not_available, row

ITEM = 11


def diverging():
    """The reference seal coned the other way, with asperities, closed by its balance and a spring."""
    scene = reference_scene("FMR")
    film = replace(scene.film, model="radial", coning=-0.5e-3, clearance=None)
    rough = Contact(roughness=0.5e-6, compressive_strength=1e9)
    return replace(scene, film=film, contact=rough, closing=Closing(balance_ratio=0.4, spring_force=50.0))


def show() -> list[dict]:
    """Newton from the design clearance finds one answer, the search over all clearances every one."""
    model = Model(diverging())
    film, roots, closing = model.scene.film, model.interface.equilibria, model.closing_force()

    def excess(clearance):
        force = model.interface.opening_force(clearance, film.inner_pressure, film.outer_pressure)
        return force / closing - 1

    alone = newton(excess, 10e-6)
    held = [root.clearance for root in roots if root.stable]
    off, residual = min(abs(alone - c) for c in held), max(abs(excess(c)) for c in held)
    return [
        row(ITEM, "Several clearances",
            (f"Newton from 10 um: {alone * 1e6:.3g} um, which does not hold", off / held[0]),
            (f"every clearance searched: {len(roots)} found, {len(held)} holds", residual),
            "off the clearance that holds, relative",
            "starts at the widest clearance that holds and says how many there are (study equilibrium lists them)"),
        not_available(ITEM, "Three waviness states", "Lebeck's states come with waviness (not there yet)"),
        not_available(
            ITEM, "Two stable clearances", "two clearances that both hold come with a gas film (not there yet)"
        ),
    ]  # fmt: skip
