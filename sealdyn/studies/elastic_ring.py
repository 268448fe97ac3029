"""Elastic ring: which waviness a wavy ring has left under load, of the one it was made with; every operating point, and
whether it holds, by the slope of the one over the other and by letting it go."""

from dataclasses import asdict, dataclass
from functools import partial

import numpy as np

from ..analysis.elastic_ring import release
from ..dynamics.elastic_ring import OperatingPoint, operating_point, operating_points, order_of, with_cells_of
from ..scene.scene import SceneError
from ..scene.variants import frozen_at_start
from ..units import Length, Time

WITH_WAVES = True
# Net wavinesses that are looked at, in initial ones.
LEAST, LARGEST = 1e-3, 1.3
# Steps of letting a ring go, and how near (as a share) it has come back.
STEPS, NEAR = 80, 0.1
ALONG = {"curve": ("net",), "points/let_go": ("instant",)}
units = dict.fromkeys(("net", "initial", "clearance", "from", "to"), "m") | {"turned": "rad", "leakage": "m^3/s"}
units |= {"time": "s"} | dict.fromkeys(("load_support", "friction_coefficient", "let_go/points"), "1")
COLUMNS = ("net", "initial", "turned", "load_support", "clearance", "leakage", "friction_coefficient")


# A scenario (and flags) with which the default settings take so much processor time (s) on one core.
TIMED = ("lebeck_elastic", 14)


@dataclass(frozen=True)
class Settings:
    """The curve of initial over net waviness, and how a ring is let go."""

    net_from: Length | None = None
    """Least net waviness; without it a thousandth of the initial one."""
    net_to: Length | None = None
    """Largest net waviness; without it a little beyond the initial one."""
    points: int = 33
    """Points of the curve."""
    disturbance: float = 0.05
    """Share by which a ring is let go from less and from more than an operating point."""
    duration: Time = 1.0
    """How long it is followed."""


def run(scenario, settings, tools) -> dict:
    """The curve of initial over net waviness, operating points by two roads."""
    scene = frozen_at_start(scenario.scene)
    ring = scene.stator.elastic
    if ring is None:
        expected = "the ring that bends: bending_stiffness, radius, torsion_ratio"
        raise SceneError("stator.elastic", "nothing", expected)
    initial, order = scene.stator.waviness[0].amplitude, order_of(scene)
    low = settings.net_from if settings.net_from is not None else LEAST * initial
    high = settings.net_to if settings.net_to is not None else LARGEST * initial
    if not 0.0 < low < high:
        raise SceneError("study.elastic_ring.net_to", f"{high:g} m", f"more than net_from = {low:g} m > 0")
    # The same cells for all: those of a wave as high as the film is thick.
    scene = with_cells_of(scene, _middle(scene, low, high))
    nets = [float(net) for net in np.geomspace(low, high, max(3, settings.points))]
    rows = tools.map(partial(_point, scene), nets, "wavinesses")
    along = [OperatingPoint(**row) for row in rows if "failed" not in row]
    if not along:
        raise SceneError("stator.elastic", rows[0]["failed"], "a seal with a balance")
    found = operating_points(scene, along)
    points = [_let_go(scene, settings, point, holds) for point, holds in found]
    answer = {
        "order": order,
        "initial": initial,
        "compliance": ring.compliance(order),
        "curve": {name: [getattr(point, name) for point in along] for name in COLUMNS},
        "points": points,
    }
    return answer | {"verdict": _verdict(answer)}


def _middle(scene, low, high) -> float:
    """A waviness (m) of the size of the asperities, or within the range."""
    rough = scene.contact.roughness if scene.contact else (low * high) ** 0.5
    return min(max(rough, low), high)


def _point(scene, net) -> dict:
    try:
        return asdict(operating_point(scene, net))
    except SceneError as error:
        return {"failed": str(error)}


def _let_go(scene, settings, point, holds) -> dict:
    """An operating point, whether it `holds` by the slope, and what becomes of it from less and from more waviness."""
    ways = []
    for share in (1.0 - settings.disturbance, 1.0 + settings.disturbance):
        try:
            time, wave, clearance = release(scene, point.net, share * point.net, settings.duration, STEPS)
        except ValueError as reason:
            ways.append({"from": share * point.net, "failed": str(reason)})
            continue
        ways.append({"from": share * point.net, "to": float(abs(wave[-1])), "time": time.tolist(),
                     "net": np.abs(wave).tolist(), "clearance": clearance.tolist()})  # fmt: skip
    ends = [way.get("to") for way in ways]
    back = None if None in ends else all(abs(end / point.net - 1.0) < NEAR * settings.disturbance for end in ends)
    return {**asdict(point), "stable": bool(holds), "comes_back": back, "let_go": ways}


def tables(answer) -> list:
    """Every operating point."""
    columns = (("waviness left, um", "net", 1e6), ("stable by the slope", "stable"), ("comes back", "comes_back"),
               ("turned, rad", "turned"), ("clearance, um", "clearance", 1e6), ("load support, %", "load_support", 100),
               ("friction", "friction_coefficient"), ("leakage, ml/h", "leakage", 3.6e9))  # fmt: skip
    return [(answer["points"], columns)]


def _verdict(answer) -> list[str]:
    points, made = answer["points"], f"{1e6 * answer['initial']:.4g} um of {answer['order']} waves"
    if not points:
        least, most = min(answer["curve"]["initial"]), max(answer["curve"]["initial"])
        less = f"; if any is left, it is less than the {1e6 * answer['curve']['net'][0]:.4g} um looked at"
        return [f"No operating point of a ring made with {made} among these: they need {1e6 * least:.4g} to "
                f"{1e6 * most:.4g} um{less if answer['initial'] < least else ''}."]  # fmt: skip
    left = ", ".join(f"{1e6 * point['net']:.4g} um ({'holds' if point['stable'] else 'does not'})" for point in points)
    said = [f"Of {made} the load leaves {left}."]
    apart = [point for point in points if point["comes_back"] is not None and point["comes_back"] != point["stable"]]
    unknown = [point for point in points if point["comes_back"] is None]
    if apart:
        where = ", ".join(f"{1e6 * point['net']:.4g} um" for point in apart)
        said.append(f"Slope and motion disagree at {where}: its waves turn as they change, or the duration is short.")
    elif not unknown:
        said.append("Let go from a waviness a little less and more, the film's cavities in motion, they do the same.")
    for point in unknown:
        why = next(way["failed"] for way in point["let_go"] if "failed" in way)
        said.append(f"At {1e6 * point['net']:.4g} um the motion was not followed: {why}.")
    if sum(point["stable"] for point in points) > 1:
        said.append("Several hold: how the seal was loaded decides which; from lifted faces it is the largest.")
    return said
