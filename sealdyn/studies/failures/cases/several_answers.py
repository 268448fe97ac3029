"""Several answers: a diverging film with rough faces has a clearance that touches and one that does not hold, a gas dam
that hardly narrows two that hold, a wavy ring that bends three wavinesses."""

from dataclasses import replace

import numpy as np
from scipy.optimize import brentq, newton

from ....analysis.sources import lebeck_1979
from ....analysis.sources.green_1989 import reference_scene
from ....dynamics.elastic_ring import operating_point, operating_points
from ....dynamics.model import Model
from ....scene.contact import Contact
from ....scene.rings import ElasticRing
from ....scene.scene import Closing
from ._common import cruise_dam, row

ITEM = 11
# Spring (N) beside a balance of 0.6.
SPRING = 65.0


def diverging():
    """The reference seal coned the other way, with asperities, closed by its balance and a spring."""
    scene = reference_scene("FMR")
    film = replace(scene.film, model="radial", coning=-0.5e-3, clearance=None)
    rough = Contact(roughness=0.5e-6, compressive_strength=1e9)
    return replace(scene, film=film, contact=rough, closing=Closing(balance_ratio=0.4, spring_force=50.0))


def two_that_hold():
    """The reference seal's ring on Zuk's dam at cruise, 0.2 mrad narrower outwards: thin, the taper holds it, thick,
    choking does, and in between neither."""
    scene = reference_scene("FMS")
    film = cruise_dam(coning=-0.2e-3)
    return replace(scene, film=film, closing=Closing(balance_ratio=0.6, spring_force=SPRING))


def _from(model, start) -> float:
    """The clearance (m) that Newton's method finds from one."""
    return newton(lambda clearance: _excess(model, clearance), start)


def _excess(model, clearance) -> float:
    """Opening over closing force, less 1."""
    film = model.scene.film
    return (
        model.interface.opening_force(clearance, film.inner_pressure, film.outer_pressure) / model.closing_force() - 1
    )


def one_that_holds() -> dict:
    """Newton from the design clearance finds one answer, the search over all clearances every one."""
    model = Model(diverging())
    roots = model.interface.equilibria
    alone = _from(model, 10e-6)
    held = [root.clearance for root in roots if root.stable]
    off, residual = min(abs(alone - c) for c in held), max(abs(_excess(model, c)) for c in held)
    return row(
        ITEM, "Several clearances",
        (f"Newton from 10 um: {alone * 1e6:.3g} um, which does not hold", off / held[0]),
        (f"every clearance searched: {len(roots)} found, {len(held)} holds", residual),
        "off the clearance that holds, relative",
        "starts at the widest clearance that holds and says how many there are (study equilibrium lists them)",
    )  # fmt: skip


def another_that_holds() -> dict:
    """Newton finds the wide clearance and knows nothing of the narrow one, where a landing ring may come to stay."""
    model = Model(two_that_hold())
    roots = model.interface.equilibria
    held = sorted(root.clearance for root in roots if root.stable)
    alone, residual = _from(model, 10e-6), max(abs(_excess(model, c)) for c in held)
    return row(
        ITEM, "Two stable clearances",
        (f"Newton from 10 um: {alone * 1e6:.3g} um, which holds", max(abs(alone / c - 1) for c in held)),
        (f"every clearance searched: {', '.join(f'{c * 1e6:.3g}' for c in held)} um hold", residual),
        "off the other clearance that holds, relative",
        "starts at the widest clearance that holds and says how many there are (study equilibrium lists them)",
    )  # fmt: skip


def three_wavinesses() -> dict:
    """Lebeck's elastic ring of 35 half heights: a search finds the waviness that is left under load where it looks,
    and knows of no other; the middle one of three does not hold."""
    ring = ElasticRing(bending_stiffness=77.0, torsion_ratio=6.0, radius=47.54e-3)
    scene, half = lebeck_1979.scene_of(lebeck_1979.ROWS[1], (6, 36)), lebeck_1979.HALF
    initial = 35.0 * half
    waves = [replace(scene.stator.waviness[0], amplitude=initial)]
    scene = replace(scene, stator=replace(scene.stator, elastic=ring, waviness=waves))
    along = [operating_point(scene, net) for net in np.geomspace(0.1, 20.0, 12) * half]
    found = operating_points(scene, along)
    nets = [point.net for point, _ in found]
    near = (0.2 * half, 0.5 * half)
    alone = brentq(lambda h: operating_point(scene, h).initial - initial, *near, rtol=1e-6)
    return row(
        ITEM, "Three waviness states",
        (f"a search from 0.2 to 0.5 c: {alone / half:.3g} c", max(abs(alone / net - 1.0) for net in nets)),
        (f"every waviness searched: {', '.join(f'{net / half:.3g}' for net in nets)} c",
         max(abs(point.initial / initial - 1.0) for point, _ in found)),
        "off another waviness of the same ring, relative",
        "lists every operating point of an elastic ring and whether it holds (study elastic-ring)",
    )  # fmt: skip


def meets(scene, run) -> str:
    """More than one clearance or waviness."""
    if scene.stator.elastic is not None:
        return "[stator.elastic]: a ring that its load bends may have several wavinesses"
    found = len(run.model.interface.equilibria)
    return f"{found} clearances at which film and closing force balance" if found > 1 else ""


def show() -> list[dict]:
    """Clearances, and wavinesses."""
    return [one_that_holds(), another_that_holds(), three_wavinesses()]
