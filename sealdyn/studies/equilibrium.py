"""Equilibria: every clearance at which film and asperities carry the closing force, with stiffness and stability."""

import math
from collections.abc import Callable
from dataclasses import dataclass, replace

import numpy as np

from ..dynamics.equilibrium import (
    ClosingForce,
    crossing,
    equilibria,
    extent,
    film_stiffness,
    settle,
    support_stiffness,
)
from ..dynamics.interface import Interface, flow_at_rest, opening_parts, rest_state
from ..faces.geometry import CAVITATED, CONTACT_PRESSURE, CONTACT_TORQUE, FLOW_INNER, SPIN_DIFFERENCE, TORQUE, WEAR
from ..numerics.piecewise_linear import initially
from ..scene.coning import coned
from ..scene.gas import density_of
from ..scene.rings import RING_NAMES
from ..scene.scene import Closing, SceneError
from ..scene.variants import frozen_at_start
from ..scene.waviness import waves_of
from ..units import Length
from ._words import shown_in, wear, wearing

WITH_WAVES = True
# Relative error of the film's integrals.
FINE = 1e-10
# Of which force load support is a share.
ABOVE = "of the closing force above the lower pressure"
# From clearance to clearance in looking for where friction gives way.
STRIDE = 1.05
ALONG = {"curve": ("clearance",)}
units = dict.fromkeys(("opening_force", "film_force", "contact_force"), "N") | {"stiffness": "N/m", "range": "m"}
units |= {"clearance": "m", "held": "m", "mass_flow": "kg/s", "leakage": "m^3/s"}
units |= dict.fromkeys(("wear_rate", "standing", "travelling"), "m/s")
units |= dict.fromkeys(("load_support", "friction_coefficient", "cavitated_fraction"), "1")


# A scenario (and flags) with which the default settings take so much processor time (s) on one core.
TIMED = ("run_in", 2)


@dataclass(frozen=True)
class Settings:
    """The curve of the opening force."""

    clearance_from: Length | None = None
    """Least clearance; without it a range that shows every equilibrium."""
    clearance_to: Length | None = None
    """Largest clearance; without it as above."""
    points: int = 241
    """Points of the curve."""


@dataclass(frozen=True)
class Found:
    """What holds a scene: its closing-force `law` and the sentence on it, the `opening` forces of its film and
    asperities (interface.opening_parts), pressures (Pa) at the inner and the outer radius, every root (equilibria)."""

    law: ClosingForce
    said: str
    opening: Callable
    pressures: tuple[float, float]
    roots: list

    @property
    def closing(self) -> float:
        """The closing force (N)."""
        return float(self.law.at(*self.pressures, initially(self.law.spring)))


def find(scene) -> Found:
    """Every clearance at which film and asperities of a scene carry the closing force."""
    film, parts = coned(scene), opening_parts(scene)
    pressures = film.inner_pressure, film.outer_pressure

    def opening(clearance, inner, outer):
        return sum(parts(clearance, inner, outer))

    law, said = closing_force(scene, opening)
    found = Found(law, said, parts, pressures, [])
    return replace(found, roots=equilibria(film, opening, found.closing, *pressures, waves_of(scene), scene.contact))


def run(scenario, settings, tools) -> dict:
    """All equilibria in the range, the opening force over clearance and the closing force."""
    scene = kept_waves(frozen_at_start(scenario.scene))
    found, film, surfaces = find(scene), coned(scene), (waves_of(scene), scene.contact)
    low, high = _range(film, surfaces, found.roots, settings)
    roots = [root for root in found.roots if low <= root.clearance <= high]
    clearance = np.geomspace(low, high, max(3, settings.points))
    carried = np.array([found.opening(c, *found.pressures) for c in clearance])
    force, friction = carried.sum(axis=1), breakaway(scene)
    # Steps smaller than the distance to closed faces.
    steps = 1e-4 * (clearance - extent(film, *surfaces)[1])
    stiffness = np.array([
        film_stiffness(lambda *at: sum(found.opening(*at)), c, *found.pressures, step)
        for c, step in zip(clearance, steps, strict=True)
    ])  # fmt: skip
    support = support_stiffness(scene)
    answer = {
        "roots": [root_row(scene, root, found, friction) for root in roots],
        "closing_force": found.closing,
        "balance_ratio": float(found.law.balance_ratio),
        "spring_force": float(initially(found.law.spring)),
        "closing_said": found.said,
        "support_stiffness": support,
        "friction": friction,
        "range": [float(low), float(high)],
        "curve": {
            "clearance": clearance.tolist(),
            "opening_force": force.tolist(),
            "contact_force": carried[:, 1].tolist(),
            "stiffness": stiffness.tolist(),
        },
    }
    return answer | {"verdict": _verdict(answer, wearing(_wears(scene)))}


def kept_waves(scene):
    """The scene with the waves that are left at rest of an elastic ring's."""
    if scene.stator.elastic is None:
        return scene
    from ..dynamics.elastic_ring import at_rest

    return at_rest(scene)


def breakaway(scene) -> float:
    """Axial force (N) that the secondary seals hold of film against closing force: both floating rings carry the same
    one, so that of the ring that slides first; 0 if one of them slides freely."""
    floating = [getattr(scene, name) for name in RING_NAMES if getattr(scene, name).support]
    return min((ring.secondary_seal.breakaway()[0] if ring.secondary_seal else 0.0 for ring in floating), default=0.0)


def root_row(scene, root, found: Found, friction=0.0) -> dict:
    """A root with what carries the closing force there, and the clearances (m) at which `friction` (N) holds a ring."""
    film, rough = (float(force) for force in found.opening(root.clearance, *found.pressures))
    ambient = min(found.pressures) * found.law.area
    carried = film + rough - ambient
    row = {**vars(root), "stable": bool(root.stable), "film_force": film, "contact_force": rough,
           "load_support": (film - ambient) / carried if carried else None}  # fmt: skip
    row |= _flows(scene, root.clearance, carried)
    if friction:
        row["held"] = _held(root, lambda c: sum(found.opening(c, *found.pressures)) - film - rough, friction)
    return row


def _flows(scene, clearance, carried) -> dict:
    """What flows and rubs at a clearance (m) at which the faces carry `carried` (N) beyond the lower pressure: leakage
    (m^3/s) and mass flow (kg/s) from high to low, friction coefficient at the mean radius, share of the face that
    cavitates."""
    film = replace(scene.film, clearance=clearance)
    interface = Interface(replace(scene, film=film, closing=Closing()), FINE)
    s, _ = rest_state(interface.scene, clearance)
    flow_at_rest(interface, s)
    leakage = math.copysign(1.0, film.inner_pressure - film.outer_pressure) * s[FLOW_INNER]
    torque, arm = s[TORQUE] + s[CONTACT_TORQUE], 0.5 * (film.inner_radius + film.outer_radius)
    return {"friction_coefficient": abs(torque) / (carried * arm) if carried > 0.0 else None,
            "mass_flow": leakage * density_of(film), "leakage": leakage,
            "cavitated_fraction": float(s[CAVITATED]), **_wear(scene, s, arm)}  # fmt: skip


def _wear(scene, s, radius) -> dict:
    """Depth rates of wear (m/s) in a gap state, if the faces wear: of both together, mean over the face; and with waves
    of the stator's alone, where it is highest while its waves stand, and anywhere once they travel around the ring.

    **Source** Archard's law; the machine of Lebeck et al. (1979), ch. 4, lets its waves travel around the ring twice a
    day.
    **Valid** travelling waves that pass every place as a whole number of them, slowly against the shaft, and while what
    is worn is small against the roughness; the highest at the mean `radius` (m)."""
    wears = _wears(scene)
    if not any(wears.values()):
        return {}
    found, own = {"wear_rate": float(s[WEAR])}, wears["stator"]
    if scene.stator.waviness and not scene.rotor.waviness and own:
        found["stator_wear"] = {
            "standing": float(own * s[CONTACT_PRESSURE] * abs(s[SPIN_DIFFERENCE]) * radius),
            "travelling": float(own / sum(wears.values()) * s[WEAR]),
        }
    return found


def _wears(scene) -> dict[str, float]:
    """Wear coefficient (1/Pa) of each face by its name; none without contact."""
    return {face: getattr(scene.contact, f"{face}_wear_coefficient") for face in RING_NAMES} if scene.contact else {}


def _held(root, excess, friction) -> list:
    """Clearances (m) around a root between which the `excess` (N) of opening force does not exceed the `friction` (N);
    None for an end that is not within a thousandth and a thousand times the root."""
    ends = []
    for ratio in (1 / STRIDE, STRIDE):
        near = root.clearance
        while 1e-3 < near / root.clearance < 1e3 and abs(excess(near * ratio)) < friction:
            near *= ratio
        within = 1e-3 < near / root.clearance < 1e3
        beyond = sorted((near, near * ratio))
        ends.append(crossing(lambda c: abs(excess(c)) - friction, *beyond) if within else None)
    return ends


def closing_force(scene, opening) -> tuple[ClosingForce, str]:
    """The closing force and a sentence; unlike `settle`, also of a scene without a stable equilibrium."""
    if scene.film.clearance is not None:
        _, law, _, said = settle(scene, opening)
        return law, said
    film, closing = scene.film, scene.closing
    if closing.balance_ratio is None or closing.spring_force is None:
        raise SceneError("film.clearance", "nothing", "a length, or both balance_ratio and spring_force")
    area = math.pi * (film.outer_radius**2 - film.inner_radius**2)
    law = ClosingForce(area, closing.balance_ratio, closing.spring_force, film.outer_pressure >= film.inner_pressure)
    return law, "closing force from balance ratio and spring"


def _range(film, surfaces, roots, settings) -> tuple[float, float]:
    """Clearances to look at, (m): a decade around what was found, open faces only."""
    rise, least = extent(film, *surfaces)
    found = [root.clearance for root in roots] or [film.clearance or max(rise, 1e-6)]
    least *= 1 + 1e-6
    low = settings.clearance_from if settings.clearance_from is not None else min(found) / 10
    high = settings.clearance_to if settings.clearance_to is not None else max(found) * 10
    low = max(low, least + 0.01 * max(found))
    if not low < high:
        wanted = f"clearances above {least:.4g} m, where the faces are open"
        raise SceneError("study.equilibrium.clearance_to", f"{high:.4g} m", wanted)
    return float(low), float(high)


def tables(answer) -> list:
    """Every clearance of balance."""
    flow, factor = shown_in("m^3/s", [root["leakage"] for root in answer["roots"]])
    columns = (("clearance, um", "clearance", 1e6), ("stiffness, N/um", "stiffness", 1e-6), ("stable", "stable"),
               ("by the film, N", "film_force"), ("by contact, N", "contact_force"),
               ("load support, % above low pressure", "load_support", 100),
               ("friction coefficient", "friction_coefficient"),
               (f"leakage, {flow}", "leakage", factor), ("cavity, %", "cavitated_fraction", 100))  # fmt: skip
    return [(answer["roots"], columns)]


def _verdict(answer, faces) -> list[str]:
    """In words; `faces` that wear."""
    (low, high), roots, support = answer["range"], answer["roots"], answer["support_stiffness"]
    stable = [f"{1e6 * root['clearance']:.6g} um" for root in roots if root["stable"]]
    opening = "Film with asperities" if any(answer["curve"]["contact_force"]) else "Film"
    said = [
        f"{opening} and closing force balance at {len(roots)} clearance(s) from {1e6 * low:.4g} to {1e6 * high:.4g} "
        f"um; stable: {', '.join(stable) or 'none'}.",
        f"Closing force {answer['closing_force']:.6g} N (balance ratio {answer['balance_ratio']:.5g}, spring "
        f"{answer['spring_force']:.4g} N; {answer['closing_said']}).",
    ]
    loose = [f"{1e6 * root['clearance']:.6g} um" for root in roots if not root["stable"]]
    if loose:
        less = "A smaller gap would carry less there, and a larger one more: the faces close, or open to a stable gap."
        said.append(f"Statically unstable: {', '.join(loose)}.  {less}")
    for root in roots:
        where, rough = 1e6 * root["clearance"], root["contact_force"]
        if rough:
            words = f"At {where:.4g} um asperities carry {rough:.5g} N of {rough + root['film_force']:.5g} N absolute"
            share = root["load_support"]
            words += "" if share is None else f", {100 * (1 - share):.4g} % {ABOVE}; the film carries the rest"
            said.append(f"{words}.")
        if "wear_rate" in root:
            said.append(f"There {wear(root['wear_rate'])} wear off {faces} on average.")
        if "stator_wear" in root:
            standing, even = (wear(root["stator_wear"][key]) for key in ("standing", "travelling"))
            said.append(f"The stator's crests wear {standing} while its waves stand; if these travel slowly around the "
                        f"ring, by whole waves, it wears {even} everywhere: evenly.")  # fmt: skip
        if "held" in root:
            low, high = map(_um, root["held"])
            said.append(f"The secondary seal's friction, {answer['friction']:.4g} N, holds from {low} to {high} too.")
    if not roots:
        curve = answer["curve"]["opening_force"]
        said.append(f"The film carries {min(curve):.5g} to {max(curve):.5g} N there: never the closing force.")
    elif len(stable) > 1:
        said.append("Several stable clearances: the start of a run decides which one the seal takes.")
    elif any(not root["stable"] and root["stiffness"] + support > 0 for root in roots):
        said.append(f"The support's {support:.3g} N/m would hold an unstable one.")
    return said


def _um(clearance) -> str:
    """A clearance (m) in words; None: as far as was looked."""
    return f"{1e6 * clearance:.4g} um" if clearance is not None else "beyond what was looked at"
