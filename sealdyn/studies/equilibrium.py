"""Equilibria: every clearance at which film and asperities carry the closing force, with stiffness and stability."""

import math
from collections.abc import Callable
from dataclasses import dataclass, replace

import numpy as np

from ..answers import Answer, Axis, Level, Panel, Series, Table, table_of
from ..dynamics.equilibrium import (
    ROUNDING,
    ClosingForce,
    closing_law,
    crossing,
    equilibria,
    extent,
    film_stiffness,
    settle,
    support_stiffness,
)
from ..dynamics.imposed_motion import rest_state
from ..dynamics.interface import Interface, flow_at_rest, opening_law, opening_parts
from ..dynamics.warm_state import at_work, unheated, warming
from ..faces.geometry import CAVITATED, CONTACT_PRESSURE, CONTACT_TORQUE, FLOW_INNER, SPIN_DIFFERENCE, TORQUE, WEAR
from ..numerics.piecewise_linear import initially
from ..quantities import in_words, resolved
from ..scene.film import coned
from ..scene.fluid import density_of
from ..scene.patterns import grooves_of, waves_of
from ..scene.scene import Closing, SceneError, frozen_at_start
from ..simulation.heat import heat_of, limits_of, limits_said
from ..units import Length
from . import Info

INFO = Info(
    timed=("run_in", 2),
    asks="At which clearance does the seal ride?",
    wavy=True,
    grooved=True,
    aligned=True,
    units={
        **dict.fromkeys(("opening_force", "film_force", "contact_force"), "N"), "stiffness": "N/m", "range": "m",
        "clearance": "m", "held": "m", "mass_flow": "kg/s", "leakage": "m^3/s", "torque": "N*m",
        **dict.fromkeys(("wear_rate", "standing", "travelling"), "m/s"),
        **dict.fromkeys(("load_support", "friction_coefficient", "cavitated_fraction", "loop_gain", "shares"), "1"),
        **dict.fromkeys(("rise", "face_temperature"), "K"), "coning": "rad", "viscosity": "Pa*s",
        **dict.fromkeys(("power", "contact_power", "carried"), "W"),
        **dict.fromkeys(("speed", "fold"), "rad/s"), **dict.fromkeys(("period", "hunting_period"), "s"),
    },
    along={"curve": ("clearance",), "balance": ("rise",)},
)  # fmt: skip
# What is drawn of the force of asperities, in closing forces, and of the stiffness, in that of the stiffest root.
SHOWN = 3.0
# Relative error of the film's integrals.
FINE = 1e-10
# From clearance to clearance in looking for where friction gives way.
STRIDE = 1.05
# Up to which multiple of its speed a warm seal is looked at.
FASTEST = 3.0


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
    asperities (interface.opening_parts), pressures (Pa) at the inner and the outer radius, the `closing` force (N),
    every root (equilibria)."""

    law: ClosingForce
    said: str
    opening: Callable
    pressures: tuple[float, float]
    closing: float
    roots: list


def find(scene) -> Found:
    """Every clearance at which film and asperities of a scene carry the closing force."""
    film, parts = coned(scene), opening_parts(scene)
    pressures = film.inner_pressure, film.outer_pressure

    def opening(clearance, inner, outer):
        return sum(parts(clearance, inner, outer))

    law, said = closing_law(scene, opening)
    closing = float(law.at(*pressures, initially(law.spring)))
    roots = equilibria(film, opening, closing, *pressures, waves_of(scene), scene.contact)
    return Found(law, said, parts, pressures, closing, roots)


def run(scenario, settings, tools) -> Answer:
    """All equilibria in the range, the opening force over clearance and the closing force."""
    given = frozen_at_start(scenario.scene)
    warm = warming(given) if given.film.heat is not None else None
    scene = resting(given) if warm is None else _as_warm(warm)
    found, film, surfaces, friction = find(scene), coned(scene), (waves_of(scene), scene.contact), breakaway(scene)
    low, high = _range(film, surfaces, found.roots, settings)
    rows = _warm_rows(given, warm) if warm is not None else [
        root_row(scene, root, found, friction) for root in found.roots if low <= root.clearance <= high
    ]  # fmt: skip
    clearance = np.geomspace(low, high, max(3, settings.points))
    carried = np.array([found.opening(c, *found.pressures) for c in clearance])
    force = carried.sum(axis=1)
    # Steps smaller than the distance to closed faces.
    steps = 1e-4 * (clearance - extent(film, *surfaces)[1])
    stiffness = np.array([
        film_stiffness(lambda *at: sum(found.opening(*at)), c, *found.pressures, step)
        for c, step in zip(clearance, steps, strict=True)
    ])  # fmt: skip
    numbers = {
        "roots": rows,
        "closing_force": found.closing,
        "balance_ratio": float(found.law.balance_ratio),
        "spring_force": float(initially(found.law.spring)),
        "closing_said": found.said if warm is None else warm.said,
        "support_stiffness": support_stiffness(scene),
        "friction": friction,
        "range": [float(low), float(high)],
        "curve": {
            "clearance": clearance.tolist(),
            "opening_force": force.tolist(),
            "contact_force": carried[:, 1].tolist(),
            "stiffness": stiffness.tolist(),
        },
    }
    if warm is not None:
        numbers["why_none"] = "" if rows else warm.why_none()
        numbers |= limits_of(warm, FASTEST * initially(given.shaft.speed))
        numbers["balance"] = {
            "rise": [state.rise for state in warm.scanned],
            "power": [state.power for state in warm.scanned],
            "carried": [(warm.conductance + state.carried) * state.rise for state in warm.scanned],
        }
    return Answer(numbers, _found(numbers), _tables(numbers), _panels(numbers), _notes(numbers, scene))


def _as_warm(warm):
    """The scene in the first of its warm states, or unheated if it has none."""
    states = sorted(warm.states, key=lambda state: not state.stable)
    return warm.at(states[0].rise, states[0].clearance) if states else unheated(warm.scene)


def _warm_rows(scene, warm) -> list[dict]:
    """Every warm state as a row: what `root_row` says of it with the faces and the liquid so warm, and its heat."""
    rows = []
    for state in warm.states:
        plain = warm.at(state.rise, state.clearance)
        found = find(plain)
        (root,) = settle(plain, opening_law(plain))[2]
        row = root_row(plain, replace(root, stable=state.stable), found, breakaway(plain))
        rows.append({**row, "heat": heat_of(scene, state)})
    return rows


def resting(scene):
    """The scene as it works (dynamics/warm_state.py), with the waves that are left at rest of an elastic ring's."""
    scene = at_work(scene)[0]
    if scene.stator.elastic is None:
        return scene
    from ..dynamics.elastic_ring import at_rest

    return at_rest(scene)


def breakaway(scene) -> float:
    """Axial force (N) that the secondary seals hold of film against closing force: both floating rings carry the same
    one, so that of the ring that slides first; 0 if one of them slides freely."""
    floating = [ring for ring in (scene.stator, scene.rotor) if ring.support]
    return min((ring.secondary_seal.breakaway()[0] if ring.secondary_seal else 0.0 for ring in floating), default=0.0)


def root_row(scene, root, found: Found, friction=0.0) -> dict:
    """A root with what carries the closing force there, and the clearances (m) at which `friction` (N) holds a ring."""
    film, rough = (float(force) for force in found.opening(root.clearance, *found.pressures))
    ambient = min(found.pressures) * found.law.area
    carried, by_film = film + rough - ambient, resolved(film - ambient, ROUNDING * (abs(film) + abs(ambient)))
    row = {**vars(root), "stable": bool(root.stable), "film_force": film, "contact_force": rough,
           "load_support": by_film / carried if carried else None}  # fmt: skip
    row |= _flows(scene, root.clearance, carried)
    if friction:
        row["held"] = _held(root, lambda c: sum(found.opening(c, *found.pressures)) - film - rough, friction)
    return row


def _flows(scene, clearance, carried) -> dict:
    """What flows and rubs at a clearance (m) at which the faces carry `carried` (N) beyond the lower pressure: leakage
    (m^3/s) and mass flow (kg/s) from high to low, friction coefficient at the mean radius, share of the face that
    cavitates."""
    film = replace(scene.film, clearance=clearance)
    if grooves_of(scene)[1]:
        # Sparse matrices are loaded for grooves only, here and elsewhere.
        from ._grooved import flows_over_grooves

        return flows_over_grooves(scene, clearance, carried)
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
    if not scene.contact:
        return {}
    return {"stator": scene.contact.stator_wear_coefficient, "rotor": scene.contact.rotor_wear_coefficient}


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


def _found(numbers) -> str:
    """Where the seal rides."""
    carried = "film and asperities carry" if any(numbers["curve"]["contact_force"]) else "the film carries"
    rows = numbers["roots"]
    stable = [in_words("clearance", root["clearance"], digits=6) for root in rows if root["stable"]]
    low, high = (in_words("clearance", end) for end in numbers["range"])
    if stable:
        return f"The seal rides at {' or '.join(stable)}: {carried} the closing force there, stably."
    if numbers.get("why_none"):
        return f"No warm state: {numbers['why_none']}."
    kind = "only unstably" if rows else "nowhere"
    return f"Between {low} and {high} {carried} the closing force {kind}."


def _tables(numbers) -> list[Table]:
    """Every clearance of balance, and what closes the faces."""
    columns = [
        ("clearance", "clearance", "clearance"), ("1", "stable", "stable"),
        ("axial_stiffness", "stiffness", "stiffness"), ("force", "by the film", "film_force"),
        ("force", "by contact", "contact_force"), ("share", "load support", "load_support"),
        ("1", "friction coefficient", "friction_coefficient"), ("leakage", "leakage", "leakage"),
        ("cavitated_fraction", "cavity", "cavitated_fraction"), ("wear_rate", "wear of both faces", "wear_rate"),
    ]  # fmt: skip
    roots, rows = numbers["roots"], []
    for root in roots:
        low, high = root.get("held", (None, None))
        rows.append(root.get("heat", {}) | root.get("stator_wear", {}) | root | {"held_from": low, "held_to": high})
    if any("stator_wear" in root for root in roots):
        columns += [("wear_rate", "of crests, standing", "standing"), ("wear_rate", "travelling", "travelling")]
    if any("heat" in root for root in roots):
        columns += [("temperature", "rise", "rise"), ("tilt", "coning", "coning"), ("power", "heat", "power"),
                    ("1", "loop gain", "loop_gain")]  # fmt: skip
    if any("held" in root for root in roots):
        columns += [("clearance", "held by friction from", "held_from"), ("clearance", "to", "held_to")]
    closing = [[numbers[key] for key in ("closing_force", "balance_ratio", "spring_force", "support_stiffness")]]
    named = [("force", "closing force"), ("1", "balance ratio"), ("force", "spring"), ("axial_stiffness", "support")]
    return [table_of("equilibria", columns, rows), Table("closing", named, closing)]


def _notes(numbers, scene) -> list[str]:
    """What the rows do not say."""
    roots, notes = numbers["roots"], [f"Closing force: {numbers['closing_said']}."]
    wears = [face for face, coefficient in _wears(scene).items() if coefficient]
    if grooves_of(scene)[1]:
        notes.append("Over grooves forces are extrapolated from two coarse meshes, within 0.3 % in all cases tried.")
    if "fold" in numbers and (beyond := limits_said(numbers)):
        notes.append(beyond)
    if not roots:
        least, most = (in_words("force", end(numbers["curve"]["opening_force"])) for end in (min, max))
        notes.append(f"The film carries {least} to {most} there.")
    unstable = [root for root in roots if not root["stable"]]
    if any(not root.get("heat", {}).get("hunting_period") for root in unstable):
        notes.append("From an unstable clearance the faces close, or open to a stable one.")
    if any("heat" not in root and root["stiffness"] + numbers["support_stiffness"] > 0 for root in unstable):
        notes.append("The support's stiffness would hold an unstable one.")
    if len(roots) - len(unstable) > 1:
        notes.append("Several stable clearances: the start of a run decides which one the seal takes.")
    if wears and any("wear_rate" in root for root in roots):
        notes.append(f"Wear of the {' and the '.join(wears)}; of waves that travel by whole waves it is even.")
    return notes


def _panels(numbers) -> list[Panel]:
    """Forces above, stiffness below, over clearance."""
    curve, closing, roots = numbers["curve"], numbers["closing_force"], numbers["roots"]
    clearance, opening, rough = (np.array(curve[name]) for name in ("clearance", "opening_force", "contact_force"))
    # Asperities pressed flat carry so much that nothing else would be seen.
    most = min(opening.max(), SHOWN * closing) if rough.any() and closing > 0 else opening.max()
    lowest = min(opening.min(), closing, 0.0 if rough.any() else np.inf)
    span = max(max(most, closing) - lowest, 1e-9)
    seen = clearance >= clearance[np.argmax(opening <= most + 0.18 * span)] / 10**0.25
    over = Axis("clearance", "clearance at the inner radius", "log", clearance[seen][0], clearance[-1])
    forces = [Series("line", clearance, opening, label="opening force", style="film thick")]
    if rough.any():
        forces.append(Series("line", clearance, rough, label="of it asperities", style="contact dotted"))
    stiff = [Series("line", clearance, np.array(curve["stiffness"]), style="film")]
    for label, style, own in _by_stability(roots):
        at = [root["clearance"] for root in own]
        names = [in_words("clearance", c) for c in at]
        forces.append(Series("marks", at, [closing] * len(at), label=label, style=style, names=names))
        stiff.append(Series("marks", at, [root["stiffness"] for root in own], style=style))
    held, ends = max((root["stiffness"] for root in roots), default=0.0), {}
    if rough.any() and held > 0:
        ends = {"low": min(min(curve["stiffness"]), 0.0) - 0.1 * held, "high": SHOWN * held}
    level = Level(closing, "closing force", style="theory dashed", number=True)
    force = Axis("force", "axial force", low=lowest - 0.08 * span, high=max(most, closing) + 0.18 * span)
    balance = [_heat_panel(numbers)] if numbers.get("balance", {}).get("rise") else []
    return [
        Panel("Opening and closing force", over, force, forces, [level], tall=1.4),
        Panel("Axial stiffness (negative: the gap runs away)", over, Axis("axial_stiffness", **ends), stiff,
              [Level(0.0, style="black")], below=True),
        *balance,
    ]  # fmt: skip


def _by_stability(roots) -> list[tuple[str, str, list]]:
    """Label, style and members of the stable roots and of the unstable ones, as far as there are any."""
    kinds = ((True, "stable", "good circle large front"), (False, "unstable", "bad cross large front"))
    found = [(label, style, [root for root in roots if root["stable"] == stable]) for stable, label, style in kinds]
    return [kind for kind in found if kind[2]]


def _heat_panel(numbers) -> Panel:
    """Heat that is made and that leaves over the rise of the faces; they cross at the warm states."""
    balance = numbers["balance"]
    shown = max([3.0 * root["heat"]["rise"] for root in numbers["roots"]] or [balance["rise"][-1]])
    upto = sum(rise <= shown for rise in balance["rise"]) + 1
    rise, made, left = (balance[key][:upto] for key in ("rise", "power", "carried"))
    lines = [Series("line", rise, made, label="made", style="film thick"), Series("line", rise, left, label="leaves")]
    for label, style, own in _by_stability(numbers["roots"]):
        rises, powers = ([root["heat"][key] for root in own] for key in ("rise", "power"))
        names = [in_words("temperature", rise) for rise in rises]
        lines.append(Series("marks", rises, powers, label=label, style=style, names=names))
    top = 3.0 * max(root["heat"]["power"] for root in numbers["roots"]) if numbers["roots"] else None
    return Panel("Heat made and heat that leaves", Axis("temperature", "rise of the faces"),
                 Axis("power", "heat", low=0.0, high=top), lines)  # fmt: skip
