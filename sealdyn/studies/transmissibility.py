"""Transmissibility: how much misalignment reaches the film of the FMR and of the FMS seal, over shaft speed.

Static: per unit misalignment fixed in space; dynamic: per unit misalignment turning with the shaft; total: both 1.
Phase (deg): how far the tilt of the ring that carries the forcing, relative to its partner, stands behind that
forcing in the forcing's own frame, against the sense of the shaft's rotation; 0 where it follows at once.
Three independent methods: formula, harmonic balance, and the equations of motion in time.
**Source** Green (1989), Fig. 8 and Table 1; the phases are the arguments of the same quotients.
"""

import math
from dataclasses import dataclass, replace
from functools import partial
from itertools import pairwise
from typing import Literal

import numpy as np
from scipy.optimize import brentq

from .. import closed_form as cf
from ..analysis.arrangements import SEALS, Arrangement, seals_of
from ..dynamics.extrema import MOST
from ..dynamics.model import Model
from ..dynamics.run_state import RunState
from ..dynamics.signals import signals
from ..scene.coning import coning_change
from ..scene.contact import touch_height
from ..scene.film import Coefficients, aligned_gaps
from ..scene.scene import Scene
from ..scene.variants import arrangement, frozen_at_start
from ..simulation.method_selection import choose_method
from ..simulation.stability import critical_speed
from ..solvers.contract import Status
from ..solvers.integrate import solve
from ..solvers.recorder import Recorder
from ..units import Speed
from ._words import speed as speed_words

QUANTITIES = ("static", "dynamic", "total")
PHASES = ("static_phase", "dynamic_phase")
PHASE = (
    "Phase: how far the tilt of the ring that carries the forcing, relative to its partner, stands behind that forcing "
    "in the forcing's own frame, against the shaft's rotation (negative: ahead)."
)
NAMES = {
    "static": "static_transmissibility",
    "dynamic": "dynamic_transmissibility",
    "total": "maximum_relative_misalignment",
}
# Forcing of a time-domain point, as part of the thinnest edge film, and what may be left of its transient.
AMPLITUDE, LEFT, PER_TURN = 0.2, 1e-9, 64
COARSER = 100.0
REFUSES = ("secondary-seal",)
# Relative difference below which both arrangements transmit the same.
SAME = 1e-9

ALONG = {seal + road: ("speed",) for seal in SEALS for road in ("", "/linear_algebra")}
ALONG |= {"time_domain": ("speed",), "crossings": ("speed",)}
units = {"speed": "rad/s", "turns": "1"} | dict.fromkeys(PHASES, "deg") | dict.fromkeys(QUANTITIES, "1")
units |= dict.fromkeys(
    (f"table{road}/{seal}" for seal in SEALS for road in ("", "/formula", "/linear_algebra", "/time_domain")),
    "the row's unit",
)


# A scenario (and flags) with which the default settings take so much processor time (s) on one core.
TIMED = ("fmr_reference", 8)


@dataclass(frozen=True)
class Settings:
    """Speeds, and the time domain beside them."""

    __pydantic_config__ = {"extra": "forbid"}  # noqa: RUF012

    speed_from: Speed = 0.0
    """Lowest speed."""
    speed_to: Speed | None = None
    """Highest speed; without it three times the scenario's."""
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
    """Transmissibilities of both arrangements by three independent methods, the speeds at which they cross, and the
    table."""
    seals = seals_of(scenario.scene)
    own_speed = abs(frozen_at_start(scenario.scene).shaft.speed)
    top = settings.speed_to if settings.speed_to is not None else 3 * own_speed or 3000.0
    speeds = np.linspace(settings.speed_from, top, max(2, settings.points))
    by_formula = all(seal.formula_holds(w) for seal in seals.values() for w in (speeds[-1], 0.5 * speeds[-1]))
    answer = {"speed": speeds.tolist(), "unit": settings.unit, "arrangement": arrangement(scenario.scene)}
    answer["phase"] = PHASE
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
        q: next((c["speed"] for c in reversed(answer["crossings"]) if c["quantity"] == q), None) for q in QUANTITIES
    }
    answer["better"] = {q: _better(answer, q) for q in QUANTITIES}
    answer["time_domain"] = _in_time(scenario, settings, speeds, own_speed, tools)
    answer["table"] = table(seals, own_speed, by_formula, answer["time_domain"]) if own_speed else []
    return answer | {"verdict": _verdict(answer, own_speed)}


def crossings(seals: dict[str, Arrangement], speeds) -> list[dict]:
    """Every speed (rad/s) inside the range where one arrangement overtakes the other, located to rounding; at rest
    both transmit the same."""
    found = []
    moving = [w for w in speeds if w != 0]
    for i, quantity in enumerate(QUANTITIES):

        def excess(w, i=i):
            fmr, fms = (seals[name].algebra(w)[i] for name in SEALS)
            return fmr - fms if abs(fmr - fms) > SAME * fmr else 0.0

        values = [excess(w) for w in moving]
        for (a, b), (low, high) in zip(pairwise(moving), pairwise(values), strict=True):
            if low * high < 0:
                speed = float(brentq(excess, a, b, rtol=1e-12))
                better = "fms" if high > 0 else "fmr"
                found.append({"quantity": quantity, "speed": speed, "better_above": better})
    return found


def _better(answer, quantity: str) -> str | None:
    """The arrangement that transmits less at the highest speed; None if both transmit the same."""
    fmr, fms = (answer[s][quantity][-1] for s in SEALS)
    return None if abs(fmr - fms) <= SAME * fmr else ("fmr" if fmr < fms else "fms")


def _apart(answer) -> tuple[float, float]:
    """Largest distance of formula and linear algebra: of amplitudes relative to the largest of a curve, of phases
    in deg."""
    far = {}
    for seal in SEALS:
        for name in (*QUANTITIES, *PHASES):
            line, dashes = np.array(answer[seal][name]), np.array(answer[seal]["linear_algebra"][name])
            scale = 1.0 if name in PHASES else np.max(np.abs(line)) or 1.0
            far[seal, name] = float(np.max(np.abs(line - dashes)) / scale)
    return tuple(max(far[seal, name] for seal in SEALS for name in names) for names in (QUANTITIES, PHASES))


# --- amplitude and phase -----------------------------------------------------------------------------


def phases(speeds, static, dynamic) -> tuple:
    """Phases (deg) of the relative tilts (stator minus rotor, in the frame of the forcing) behind their forcings."""
    sense = np.where(np.asarray(speeds) < 0, -1.0, 1.0)
    # The rotor carries the dynamic forcing: counted from it, the relative tilt has the other sign.  (+ 0 for no -0.)
    return tuple(0.0 - sense * np.degrees(np.angle(tilt)) + 0.0 for tilt in (static, -np.asarray(dynamic)))


def curves(speeds, tilts) -> dict:
    """Amplitudes and phases over speed, phases without jumps."""
    static, dynamic = np.abs(tilts)
    lags = [np.unwrap(lag, period=360.0).tolist() for lag in phases(speeds, *tilts)]
    amplitudes = [a.tolist() for a in (static, dynamic, static + dynamic)]
    return dict(zip((*QUANTITIES, *PHASES), (*amplitudes, *lags), strict=True))


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


def measured(scene, point: dict) -> dict:
    """Static, dynamic and total of one arrangement at one speed, from a run on the linear film in the film's own
    coefficients; `error`: the difference to a run at a hundred times coarser accuracy."""
    seal = seals_of(scene)[point["seal"]]
    if seal.model.interface.stores:
        raise ValueError("a film that stores: no linear film with one stiffness and damping stands for it in time")
    decay = -seal.growth(point["speed"])
    if point["speed"] == seal.stator_speed:
        raise ValueError("the stator turns with the shaft: static and dynamic are one")
    turn = 2 * math.pi / abs(point["speed"] - seal.stator_speed)
    if decay <= 0:
        kind = "unstable" if decay < 0 else "undamped"
        raise ValueError(f"{kind} at {speed_words(point['speed'])}: no steady state")
    turns = math.ceil(-math.log(LEFT) / decay / turn) + 4
    if turns > point["longest"]:
        raise ValueError(f"the transient takes {turns} turns to die out, more than {point['longest']:g}")
    amplitude = _amplitude(seal, point["speed"])
    scene = _forced(seal, point["speed"], amplitude)
    fine = np.array(_steady(scene, turns, point["accuracy"], amplitude))
    coarse = np.array(_steady(scene, turns, COARSER * point["accuracy"], amplitude))
    away = np.abs(fine - coarse)
    # 359 deg apart is 1 deg apart.
    away[3:] = np.minimum(away[3:], 360.0 - away[3:])
    names = (*QUANTITIES, *PHASES)
    return dict(zip(names, fine.tolist(), strict=True)) | {
        "error": dict(zip(names, away.tolist(), strict=True)), "turns": turns
    }  # fmt: skip


def _amplitude(seal: Arrangement, speed: float) -> float:
    """Forcing (rad) that leaves the film open."""
    film, change = seal.scene.film, coning_change(seal.scene, float, speed)
    thinnest = min(h for _, h in aligned_gaps(film, film.clearance, change))
    return AMPLITUDE * thinnest / film.outer_radius / max(1.0, seal.algebra(speed)[2])


def _forced(seal: Arrangement, speed: float, amplitude: float) -> Scene:
    """The arrangement with both forcings, on the linear film, which has the stiffness of asperities that touch too."""
    linear = seal.linear(speed)
    own = Coefficients(
        tilt_stiffness=linear.film_k[1, 1],
        tilt_damping=linear.film_d[1, 1],
        axial_stiffness=linear.film_k[0, 0],
        axial_damping=linear.film_d[0, 0],
    )
    scene = frozen_at_start(seal.scene, speed)
    return replace(
        scene,
        film=replace(scene.film, model="linear", coefficients=own),
        contact=None,
        stator=replace(scene.stator, misalignment=amplitude, misalignment_direction=0.0),
        rotor=replace(scene.rotor, misalignment=amplitude, runout=amplitude, misalignment_phase=0.0, runout_phase=0.0),
    )


def _steady(scene: Scene, turns: int, accuracy: float, amplitude: float) -> tuple:
    """Relative tilt per unit forcing over the last turn of a run from rest: what turns with the stator, what with
    the shaft, the largest, and the phases (deg) of the first two."""
    speed = scene.shaft.speed
    # A turn of the shaft seen from the stator: over it the two frequencies are orthogonal and meet once.
    turn = 2 * math.pi / abs(speed - scene.stator.speed)
    run = RunState(Model(scene, accuracy), turns * turn)
    run.extrema.windows[1] = [run.duration - turn, run.duration]
    recorder = Recorder(turn / PER_TURN)
    outcome = solve(run, choose_method(run)[0], accuracy, recorder)
    if outcome.status != Status.OK:
        raise ValueError(outcome.message)
    t, q, rate = (a[-PER_TURN:] for a in recorder.arrays())
    seen = signals(run.segment(0), t, q, rate)
    tilt = seen["relative_tilt_x"] + 1j * seen["relative_tilt_y"]
    static, dynamic = (np.mean(tilt * np.exp(-1j * w * t)) / amplitude for w in (scene.stator.speed, speed))
    largest = run.extrema.records[1, MOST] / amplitude
    return tuple(float(v) for v in (abs(static), abs(dynamic), largest, *phases(speed, static, dynamic)))


# --- the table ---------------------------------------------------------------------------------------


def table(seals: dict[str, Arrangement], speed: float, by_formula: bool, rows: list[dict]) -> list[dict]:
    """FMR against FMS in the form of Green's Table 1, at one speed (rad/s), by every method there is."""
    roads = {"formula": {}, "linear_algebra": {}, "time_domain": {}}
    for name, seal in seals.items():
        roads["linear_algebra"][name] = [*seal.algebra(speed)]
        roads["formula"][name] = [float(v) for v in seal.formula(speed)] if by_formula else [None] * 3
        row = next((r for r in rows if r["seal"] == name and r["speed"] == speed and "failed" not in r), {})
        roads["time_domain"][name] = [row.get(q) for q in QUANTITIES]
    for road, both in roads.items():
        for name, values in both.items():
            values.append(_critical_misalignment(seals[name], speed, values))
            values.append(_critical_speed(seals[name], road, by_formula))
    kinds = [*((n, "1") for n in NAMES.values()), ("critical_misalignment", "C/r_o"), ("critical_speed", "rad/s")]
    best = "formula" if by_formula else "linear_algebra"
    return [
        {"quantity": quantity, "unit": unit, "fmr": roads[best]["fmr"][i], "fms": roads[best]["fms"][i]}
        | {road: {name: both[name][i] for name in SEALS} for road, both in roads.items()}
        for i, (quantity, unit) in enumerate(kinds)
    ]


def _critical_misalignment(seal: Arrangement, speed: float, values) -> float | None:
    """Partner's misalignment at first touch, of the asperities of rough faces, in units of C/r_o, with a unit own
    misalignment; None for faces that touch when aligned."""
    if values[0] is None:
        return None
    film, rough = seal.scene.film, touch_height(seal.scene)
    change = coning_change(seal.scene, float, speed)
    touch = min((h - rough) / r for r, h in aligned_gaps(film, film.clearance, change))
    if touch <= 0.0:
        return None
    own, forcing = (values[1], values[0]) if seal.name == "fmr" else (values[0], values[1])
    found = cf.critical_forcing(touch * film.outer_radius / film.clearance, own, forcing)
    return float(found) if np.isfinite(found) else None


def _critical_speed(seal: Arrangement, road: str, by_formula: bool) -> float | None:
    if road == "time_domain" or (road == "formula" and not by_formula):
        return None
    if road == "linear_algebra":
        return critical_speed(seal.model)
    numbers = seal.tilt_numbers(1.0)
    numbers.pop("speed")
    try:
        return (cf.fmr_critical_speed if seal.name == "fmr" else cf.fms_critical_speed)(**numbers)
    except ValueError:
        return None


def _verdict(answer: dict, own_speed: float) -> list[str]:
    said = []
    if answer["arrangement"] == "FMSR":
        said.append("Both rings float: each arrangement is this scene with the other ring held rigid.")
    for quantity in QUANTITIES:
        found = [c for c in answer["crossings"] if c["quantity"] == quantity]
        if not found:
            better = answer["better"][quantity]
            said.append(f"{quantity}: {better.upper()} is better over the whole range." if better else
                        f"{quantity}: both arrangements transmit the same.")  # fmt: skip
        for c in found:
            said.append(f"{quantity}: {c['better_above'].upper()} is better above {speed_words(c['speed'], 6)}.")
    for row in answer["table"][:3]:
        name = row["quantity"].replace("_", " ")
        said.append(f"At {speed_words(own_speed)} {name}: FMR {row['fmr']:.4g}, FMS {row['fms']:.4g}.")
    for name in SEALS:
        stable = answer[name]["stable"]
        if not all(stable):
            first = answer["speed"][stable.index(False)]
            about = speed_words(first, 4)
            said.append(f"{name.upper()} is not damped at speeds from about {about}: no steady state there.")
    failed = [r for r in answer["time_domain"] if "failed" in r]
    good = len(answer["time_domain"]) - len(failed)
    said.append(f"Formula and linear algebra agree to {answer['roads_apart']:.1e}, phases to "
                f"{answer['phases_apart']:.1e} deg; {good} points in the time domain.")  # fmt: skip
    if not answer["formula_holds"]:
        said[-1] = "No closed form for this film or a turning stator: lines are linear algebra."
    if failed:
        said.append(f"{len(failed)} time-domain points failed, e.g. {failed[0]['failed']}")
    return said
