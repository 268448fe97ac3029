"""Wave design: how many waves, on how stiff a ring, carry most of the load below a leakage, of those that a pressure
between two O-rings can bend the ring to and that hold; the fold, and the stiffest ring that still comes there.

One curve of balances for each order of waves answers for all rings (dynamics/elastic_ring.py).
"""

from dataclasses import dataclass, replace
from functools import partial
from itertools import cycle
from typing import Annotated

import numpy as np
from pydantic import Field

from ..answers import CYCLE, Answer, Axis, Level, Panel, Series, Table, table_of
from ..dynamics.elastic_ring import PLACES, READ, design, joined, order_of, stiffest, with_cells_of
from ..quantities import in_words
from ..scene.film import MOST_AROUND
from ..scene.forces import HALF_HEIGHT
from ..scene.scene import Scene, SceneError
from ..units import BendingStiffness, Length, VolumeFlow
from . import Info
from .elastic_ring import asked_range, bending, point_of

INFO = Info(
    timed=("lebeck_driven", 13),
    asks="Which waves on which ring carry most?",
    wavy=True,
    units={
        **dict.fromkeys(("net", "initial", "drivable", "fold", "holds_again", "largest_stable", "clearance"), "m"),
        **dict.fromkeys(("stiffness", "stiffest"), "N*m^2"), "leakage": "m^3/s", "leakage_limit": "m^3/s",
        **dict.fromkeys(("load_support", "friction_coefficient", "order"), "1"),
    },
    along={"curves": ("curve", "place")},
)  # fmt: skip
# Net wavinesses that are looked at, in half heights of the asperities; points of a curve that is shown.
LEAST, LARGEST, SHOWN = 0.1, 3.0, 200


@dataclass(frozen=True)
class Settings:
    """Orders of waves and rings that are compared."""

    orders: Annotated[tuple[int, ...], Field(min_length=1)] = (3, 6, 9)
    """Waves around the ring."""
    stiffness_from: BendingStiffness | None = None
    """Bending stiffness of the softest ring; a tenth of the scenario's."""
    stiffness_to: BendingStiffness | None = None
    """Of the stiffest; ten times the scenario's."""
    rings: Annotated[int, Field(ge=2, le=10_000)] = 21
    """Rings between them, in even ratios."""
    leakage_limit: VolumeFlow | None = None
    """Most that may leak; that of `[application]`, or any."""
    net_from: Length | None = None
    """Least waviness left under load; a tenth of the half height of the asperities."""
    net_to: Length | None = None
    """Largest; three times that height."""
    points: Annotated[int, Field(ge=5, le=1000)] = 25
    """Wavinesses of an order that are computed."""


def run(scenario, settings, tools) -> Answer:
    """The best waviness of each order on each ring, and what limits it."""
    scene = bending(scenario, "drive_pressure, drive_length")
    nets, stiffnesses = _nets(scene, settings), _stiffnesses(scene, settings)
    limit = settings.leakage_limit
    if limit is None and scenario.application is not None:
        limit = scenario.application.leakage_limit
    orders, curves, designs = [], [], []
    for order in settings.orders:
        curve = _curve(of_order(scene, order), nets, tools)
        ring = scene.stator.elastic
        found = [{"order": order, **design(replace(ring, bending_stiffness=float(stiff)), order, curve, limit)}
                 for stiff in stiffnesses]  # fmt: skip
        designs += found
        orders.append({"order": order, **stiffest(ring, order, curve, limit)})
        curves.append({"order": order, **{name: curve[name][:: PLACES // SHOWN].tolist() for name in ("net", *READ)}})
    numbers = {"leakage_limit": limit, "driven": scene.stator.elastic.driven(2) > 0.0, "designs": designs,
               "orders": orders, "curves": curves, "best": _best(designs)}  # fmt: skip
    return Answer(numbers, _found(numbers), _tables(numbers), _panels(numbers), _notes(numbers))


def _nets(scene, settings) -> np.ndarray:
    """Net wavinesses (m) that are computed."""
    if scene.contact is None and None in (settings.net_from, settings.net_to):
        raise SceneError("study.wave_design.net_from", "no range of waviness", "net_from and net_to: faces are smooth")
    half = HALF_HEIGHT * scene.contact.roughness if scene.contact else 0.0
    ends = asked_range(settings, "study.wave_design.net", "m", LEAST * half, LARGEST * half)
    return np.geomspace(*ends, settings.points)


def _stiffnesses(scene, settings) -> np.ndarray:
    """Bending stiffnesses (N m^2) of the rings."""
    own = scene.stator.elastic.bending_stiffness
    ends = asked_range(settings, "study.wave_design.stiffness", "N*m^2", 0.1 * own, 10.0 * own)
    return np.geomspace(*ends, settings.rings)


def of_order(scene: Scene, order: int) -> Scene:
    """The scene with waves of another order, as many cells to a wave as it has."""
    options, own = scene.film.reynolds, order_of(scene)
    if options is not None and options.cells_theta is not None:
        around = min(-(-options.cells_theta * order // own), MOST_AROUND)
        scene = replace(scene, film=replace(scene.film, reynolds=replace(options, cells_theta=around)))
    waves = [replace(scene.stator.waviness[0], order=order)]
    return replace(scene, stator=replace(scene.stator, waviness=waves))


def _curve(scene, nets, tools) -> dict[str, np.ndarray]:
    """As `joined`, computed."""
    scene = with_cells_of(scene, float(np.sqrt(nets[0] * nets[-1])))
    rows = tools.map(partial(point_of, scene), [float(net) for net in nets], f"{order_of(scene)} waves")
    rows = [row for row in rows if "failed" not in row]
    if len(rows) < 2:
        raise SceneError("stator.elastic", f"no balance with {order_of(scene)} waves", "a seal with a balance")
    return joined(scene.stator.elastic.compliance(order_of(scene)), rows)


def _best(designs) -> dict | None:
    """The design of most load support; of those alike within rounding the stiffest ring."""
    known = [one for one in designs if one["load_support"] is not None]
    most = max((one["load_support"] for one in known), default=None)
    alike = [one for one in known if one["load_support"] > most - 1e-6]
    return max(alike, key=lambda one: one["stiffness"], default=None)


# --- what is shown ----------------------------------------------------------------------------------------


def _found(numbers) -> str:
    """The best design, or that there is none."""
    best = numbers["best"]
    if best is None:
        return "No waviness of these orders can be made, holds and leaks little enough."
    return (
        f"Most, {in_words('share', best['load_support'])} of the load, is carried by {best['order']} waves of "
        f"{in_words('m', best['net'])} left of {in_words('m', best['initial'])} on a ring of "
        f"{best['stiffness']:.4g} N m^2, limited by {best['limited_by']}."
    )


def _notes(numbers) -> list[str]:
    notes = []
    if not numbers["driven"]:
        notes.append("Without stator.elastic.drive_pressure and drive_length any waviness counts as made.")
    if numbers["leakage_limit"] is None:
        notes.append("No limit of the leakage is given: --leakage-limit.")
    return notes


def _tables(numbers) -> list[Table]:
    """Every order on every ring, and the stiffest ring of each order."""
    names = (
        ("1", "waves", "order"), ("N*m^2", "bending stiffness", "stiffness"), ("m", "drive can make", "drivable"),
        ("m", "fold", "fold"), ("m", "holds again", "holds_again"), ("m", "largest stable", "largest_stable"),
        ("m", "best left", "net"), ("m", "best made", "initial"), ("share", "load support", "load_support"),
        ("1", "friction", "friction_coefficient"), ("leakage", "leakage", "leakage"), ("1", "limited by", "limited_by"),
    )  # fmt: skip
    own = (("1", "waves", "order"), ("m", "waves left", "net"), ("share", "load support", "load_support"),
           ("N*m^2", "stiffest ring", "stiffest"))  # fmt: skip
    return [table_of("designs", names, numbers["designs"]), table_of("orders", own, numbers["orders"])]


def _panels(numbers) -> list[Panel]:
    """Load support and net waviness over the bending stiffness, and what waves left carry and leak."""
    stiff, limit = Axis("N*m^2", "bending stiffness", scale="log"), numbers["leakage_limit"]
    support, left, carried, leaked = [], [], [], []
    for curve, style in zip(numbers["curves"], cycle(CYCLE), strict=False):
        own = [one for one in numbers["designs"] if one["order"] == curve["order"]]
        at, label = [one["stiffness"] for one in own], f"{curve['order']} waves"
        support.append(Series("line", at, [one["load_support"] for one in own], label=label, style=style))
        left.append(Series("line", at, [one["net"] for one in own], label=f"{label}, best", style=style))
        folds = [one["fold"] for one in own]
        if any(folds):
            left.append(Series("line", at, folds, label=f"{label}, fold", style=f"{style} dotted"))
        carried.append(Series("line", curve["net"], curve["load_support"], label=label, style=style))
        leaked.append(Series("line", curve["net"], curve["leakage"], style=style))
    net = Axis("m", "net waviness", scale="log")
    levels = [] if limit is None else [Level(limit, "limit", style="contact dashed")]
    return [
        Panel("Best load support", stiff, Axis("share", "load support"), support),
        Panel("", stiff, Axis("m", "net waviness", scale="log"), left, below=True),
        Panel("Waves left", net, Axis("share", "load support"), carried),
        Panel("", net, Axis("leakage", "leakage", scale="log"), leaked, levels, below=True),
    ]
