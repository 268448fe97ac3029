"""Transmissibility: how much misalignment reaches the film of the FMR, the FMS and the FMSR seal, over shaft speed.

Static: per unit misalignment fixed in space; dynamic: per unit misalignment turning with the shaft; total: both 1.
One ring floats on the scenario's support, or both do, each on its own (of a scenario with one floating ring: the same
support under both).
Phase (deg): how far the tilt of the ring that carries the forcing, relative to its partner, stands behind that
forcing in the forcing's own frame, against the sense of the shaft's rotation; 0 where it follows at once.
Three independent methods: formula, harmonic balance, and the equations of motion in time.
**Source** Green (1989), Fig. 8 and Table 1; the phases are the arguments of the same quotients; FMSR, of which he only
expects that it is better than both, closed_form/both_rings.py.
"""

from dataclasses import dataclass
from functools import partial
from itertools import combinations, pairwise
from typing import Literal

import numpy as np
from scipy.optimize import brentq

from ...analysis.arrangements import SEALS, Arrangement, seals_of
from ...dynamics.linearisation import moves_with_speed
from ...scene.variants import arrangement, frozen_at_start
from ...simulation.stability import held_speeds
from ...units import Speed
from .._words import no_film_beyond
from .._words import speed as speed_words
from .curves import PHASES, QUANTITIES, curves, phases_apart
from .in_time import measured
from .table import critical_words, film_words, groups, table

PHASE = (
    "Phase: how far the tilt of the ring that carries the forcing, relative to its partner, stands behind that forcing "
    "in the forcing's own frame, against the shaft's rotation (negative: ahead)."
)
REFUSES = ("secondary-seal",)
# Relative difference below which two arrangements transmit the same; how well the end of stability is located.
SAME, LOCATED = 1e-9, 1e-9
# Share of the fastest speed below which stability ends by rounding: rings at rest may have a neutral mode.
AT_REST = 1e-6

ALONG = {seal + road: ("speed",) for seal in SEALS for road in ("", "/linear_algebra")}
ALONG |= {"time_domain": ("speed",), "crossings": ("speed",)}
units = {"speed": "rad/s", "turns": "1", "groups/seal_parameter": "Pa", "from": "rad/s", "to": "rad/s", "pairs": "1"}
units |= dict.fromkeys(PHASES, "deg") | dict.fromkeys(QUANTITIES, "1")
units |= {f"stability_ends/{seal}": "rad/s" for seal in SEALS}
units |= dict.fromkeys(
    (f"table{road}/{seal}" for seal in SEALS for road in ("", "/formula", "/linear_algebra", "/time_domain")),
    "the row's unit",
)


# A scenario (and flags) with which the default settings take so much processor time (s) on one core.
TIMED = ("fmr_reference", 3)


@dataclass(frozen=True)
class Settings:
    """Speeds, and the time domain beside them."""

    __pydantic_config__ = {"extra": "forbid"}  # noqa: RUF012

    speed_from: Speed = 0.0
    """Lowest speed."""
    speed_to: Speed | None = None
    """Highest speed; without it three times the scenario's, no more than a film holds."""
    points: int = 301
    """Number of speeds."""
    unit: Literal["rad/s", "rpm"] = "rad/s"
    """Of the figure's axis."""
    time_points: int = 12
    """Speeds in the time domain."""
    accuracy: float = 1e-7
    """Accuracy of these runs."""
    longest: float = 4000.0
    """Turns that they may take."""


def run(scenario, settings, tools) -> dict:
    """Transmissibilities of the three arrangements by three independent methods, the speeds at which they cross, which
    is best where, the table and Green's groups."""
    seals = seals_of(scenario.scene)
    own_speed = abs(frozen_at_start(scenario.scene).shaft.speed)
    top, held = settings.speed_to, None
    if top is None:
        asked = 3 * own_speed or 3000.0
        top = min(held_speeds(seal.model, seal.model.start, 1e-3 * asked, asked)[1] for seal in seals.values())
        held = [settings.speed_from, top] if top < asked else None
    speeds = np.linspace(settings.speed_from, top, max(2, settings.points))
    by_formula = all(seal.formula_holds(w) for seal in seals.values() for w in (speeds[-1], 0.5 * speeds[-1]))
    answer = {"speed": speeds.tolist(), "unit": settings.unit, "arrangement": arrangement(scenario.scene)}
    answer["stator_speed"] = frozen_at_start(scenario.scene).stator.speed
    answer["own_speed"], answer["phase"], answer["speeds_held"] = own_speed, PHASE, held
    answer["gap_moves"] = moves_with_speed(scenario.scene.film)
    for name, seal in seals.items():
        algebra = curves(speeds, np.array([seal.relative_tilts(w) for w in speeds]).T)
        answer[name] = dict(algebra)
        if by_formula:
            answer[name] = curves(speeds, seal.formula_tilts(speeds))
            answer[name] |= dict(zip(QUANTITIES, np.array(seal.formula(speeds)).tolist(), strict=True))
        answer[name]["linear_algebra"] = algebra
        answer[name]["stable"] = [seal.growth(w) < 0 for w in speeds]
    answer["formula_holds"] = by_formula
    answer["roads_apart"], answer["phases_apart"] = _apart(answer)
    tools.say(0.05)
    answer["crossings"] = crossings(seals, speeds)
    answer["crossovers"] = {
        q: next((c["speed"] for c in reversed(answer["crossings"]) if of(c, q, SEALS[:2])), None) for q in QUANTITIES
    }
    answer["stability_ends"] = {name: stability_ends(seals[name], speeds, answer[name]["stable"]) for name in SEALS}
    answer["best"] = {q: best(seals, q, speeds, answer["crossings"], answer["stability_ends"]) for q in QUANTITIES}
    answer["pairs"] = [
        {"seals": pair, "best": best({name: seals[name] for name in pair}, "total", speeds, answer["crossings"],
                                     answer["stability_ends"])}
        for pair in map(list, combinations(SEALS, 2))
    ]  # fmt: skip
    answer["time_domain"] = _in_time(scenario, settings, speeds, own_speed, tools)
    answer["film"] = film_words(seals, own_speed)
    answer["groups"] = groups(seals, own_speed)
    answer["table"] = table(seals, own_speed, by_formula, answer["time_domain"]) if own_speed else []
    answer["critical"] = critical_words(seals, own_speed, answer["table"]) if own_speed else ""
    return answer | {"verdict": _verdict(answer, own_speed)}


# --- which is best ------------------------------------------------------------------------------------


def crossings(seals: dict[str, Arrangement], speeds) -> list[dict]:
    """Every speed (rad/s) inside the range where one arrangement overtakes another, located to rounding; at rest
    FMR and FMS transmit the same."""
    found = []
    moving = [w for w in speeds if w != 0]
    algebra = {name: [seal.algebra(w) for w in moving] for name, seal in seals.items()}
    for i, quantity in enumerate(QUANTITIES):
        for pair in combinations(SEALS, 2):

            def excess(one, other, i=i):
                return one[i] - other[i] if abs(one[i] - other[i]) > SAME * one[i] else 0.0

            def excess_at(w, pair=pair, excess=excess):
                return excess(*(seals[name].algebra(w) for name in pair))

            values = [excess(*both) for both in zip(*(algebra[name] for name in pair), strict=True)]
            for (a, b), (low, high) in zip(pairwise(moving), pairwise(values), strict=True):
                if low * high < 0:
                    speed = float(brentq(excess_at, a, b, rtol=1e-12))
                    better = pair[1] if high > 0 else pair[0]
                    found.append({"quantity": quantity, "seals": list(pair), "speed": speed, "better_above": better})
    return found


def of(crossing: dict, quantity: str, pair) -> bool:
    """Whether a crossing is that of a quantity and a pair of arrangements."""
    return crossing["quantity"] == quantity and crossing["seals"] == list(pair)


def best(seals: dict[str, Arrangement], quantity: str, speeds, crossings: list[dict], ends: dict) -> list[dict]:
    """The stretches of speed (rad/s) and which of `seals` transmits least there, of those that have a steady state:
    [{"seal", "from", "to"}], in the order of `speeds`; `seal` None where two transmit the same or none has a steady
    state.  `crossings`, and `ends` of stability by arrangement."""
    changes = [c["speed"] for c in crossings if c["quantity"] == quantity and set(c["seals"]) <= set(seals)]
    changes += [w for name in seals for w in ends[name]]
    changes = sorted(changes, reverse=bool(speeds[-1] < speeds[0]))
    found = []
    for a, b in pairwise([float(speeds[0]), *changes, float(speeds[-1])]):
        seal = _least(seals, 0.5 * (a + b), QUANTITIES.index(quantity))
        if found and found[-1]["seal"] == seal:
            found[-1]["to"] = b
        elif a != b:
            found.append({"seal": seal, "from": a, "to": b})
    return found


def _least(seals, speed: float, i: int) -> str | None:
    """The arrangement with the least of one quantity; None if there is not one."""
    ranked = sorted((seal.algebra(speed)[i], name) for name, seal in seals.items() if seal.growth(speed) < 0)
    if not ranked or (len(ranked) > 1 and ranked[1][0] - ranked[0][0] <= SAME * ranked[1][0]):
        return None
    return ranked[0][1]


def stability_ends(seal: Arrangement, speeds, stable: list[bool]) -> list[float]:
    """Speeds (rad/s) between `speeds` at which the steady state comes or goes, by bisection; `stable` at each."""
    found = []
    for (a, b), (before, after) in zip(pairwise(speeds), pairwise(stable), strict=True):
        while before != after and abs(b - a) > LOCATED * max(abs(a), abs(b)):
            middle = 0.5 * (a + b)
            a, b = (middle, b) if (seal.growth(middle) < 0) == before else (a, middle)
        if before != after and abs(a + b) > AT_REST * max(abs(speeds[0]), abs(speeds[-1])):
            found.append(float(0.5 * (a + b)))
    return found


def _apart(answer) -> tuple[float, float]:
    """Largest distance of formula and linear algebra: of amplitudes relative to the largest of a curve, of phases
    in deg."""
    far = {}
    for seal in SEALS:
        for name in (*QUANTITIES, *PHASES):
            line, dashes = np.array(answer[seal][name]), np.array(answer[seal]["linear_algebra"][name])
            amplitudes = float(np.max(np.abs(line - dashes)) / (np.max(np.abs(line)) or 1.0))
            far[seal, name] = phases_apart(line, dashes) if name in PHASES else amplitudes
    return tuple(max(far[seal, name] for seal in SEALS for name in names) for names in (QUANTITIES, PHASES))


# --- the third road ----------------------------------------------------------------------------------


def _in_time(scenario, settings, speeds, own_speed, tools) -> list[dict]:
    """Rows of a dozen speeds, the scenario's own among them."""
    if settings.time_points < 1:
        return []
    chosen = np.linspace(speeds[0], speeds[-1], settings.time_points + (speeds[0] == 0))
    chosen = sorted({float(w) for w in [*chosen, own_speed] if w != 0})
    points = [
        {"seal": seal, "speed": w, "accuracy": settings.accuracy, "longest": settings.longest}
        for w in chosen
        for seal in SEALS
    ]
    rows = tools.map(partial(measured, scenario.scene), points, "time domain")
    return [{"seal": p["seal"], "speed": p["speed"], **row} for p, row in zip(points, rows, strict=True)]


# --- in words -----------------------------------------------------------------------------------------


def _verdict(answer: dict, own_speed: float) -> list[str]:
    said = []
    if answer["arrangement"] == "FMSR":
        said.append("Both rings float: FMR and FMS are this scene with the other ring held rigid.")
    else:
        said.append("FMSR is this scene with the same ring and support on the other side too.")
    if answer["speeds_held"]:
        said.append(f"Speeds{no_film_beyond(answer['speeds_held'])}.")
    carried = "turns with it" if answer["stator_speed"] else "fixed in space"
    static = f"static of the stator's ({carried})"
    said.append(f"Relative tilt per unit tilt: {static}, dynamic of what turns with the shaft, total of both.")
    said += [f"{quantity}: {_stretches(answer['best'][quantity])}." for quantity in QUANTITIES]
    for pair in answer["pairs"]:
        one, other = (name.upper() for name in pair["seals"])
        said.append(f"{one} against {other} in total: {_stretches(pair['best'], 'better')}.")
    for row in answer["table"][:3]:
        # Green's name of the total does not tell that it is no angle.
        name = row["quantity"].replace("_", " ").replace("misalignment", "misalignment (total, per unit tilts)")
        numbers = ", ".join(f"{s.upper()} {row[s]:.4g}" for s in SEALS)
        said.append(f"At {speed_words(own_speed)} {name}: {numbers}.")
    said += filter(None, [answer["critical"]])
    for name in SEALS:
        ends = answer["stability_ends"][name]
        if ends:
            at = ", ".join(speed_words(w, 6) for w in ends)
            said.append(f"{name.upper()}: the steady state ends or begins at {at}; none where it is not damped.")
        elif not all(answer[name]["stable"]):
            said.append(f"{name.upper()} is not damped over the whole range: no steady state.")
    failed = [r for r in answer["time_domain"] if "failed" in r]
    good = len(answer["time_domain"]) - len(failed)
    said.append(f"Formula and linear algebra agree to {answer['roads_apart']:.1e}, phases to "
                f"{answer['phases_apart']:.1e} deg; {good} points in the time domain.")  # fmt: skip
    if not answer["formula_holds"]:
        said[-1] = "No closed form for this film or a turning stator: lines are linear algebra."
    if failed:
        said.append(f"{len(failed)} time-domain points failed, e.g. {failed[0]['failed']}")
    return said


def _stretches(stretches: list[dict], word: str = "best") -> str:
    """Which arrangement is best where."""
    words = [s["seal"].upper() if s["seal"] else "none" for s in stretches]
    if len(stretches) == 1:
        return f"{words[0]} is {word} over the whole range"
    upto = [f"{name} is {word} to {speed_words(s['to'], 6)}" for name, s in zip(words, stretches, strict=True)]
    return ", ".join([*upto[:-1], f"{words[-1]} beyond"])
