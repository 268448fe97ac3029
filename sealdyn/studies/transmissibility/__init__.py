"""Transmissibility: how much misalignment reaches the film of the FMR, the FMS and the FMSR seal, over shaft speed.

Static: per unit misalignment fixed in space; dynamic: per unit misalignment turning with the shaft; total: both 1.
One ring floats on the scenario's support, or both do, each on its own (of a scenario with one floating ring: the same
support under both).
Phase (deg): how far the tilt of the ring that carries the forcing, relative to its partner, stands behind that
forcing in the forcing's own frame, against the sense of the shaft's rotation; 0 where it follows at once.
Three independent methods: formula, harmonic balance, and the equations of motion in time.
At the scenario's speed also Green's groups, the coning of the stiffest film, and the inertia ratio of a floating rotor.
**Source** Green (1989), Fig. 8 and Table 1; the phases are the arguments of the same quotients; FMSR, of which he only
expects that it is better than both, closed_form/tilting_ring.py.
"""

from dataclasses import dataclass
from functools import cache
from itertools import combinations, pairwise
from typing import Literal

import numpy as np
from scipy.optimize import brentq

from ... import closed_form as cf
from ...answers import Answer, Axis, Level, Panel, Series, Table
from ...dynamics.linearisation import moves_with_speed
from ...quantities import in_words, reading_in
from ...scene.film import aligned_gaps, coning_change
from ...scene.forces import touch_height
from ...scene.patterns import grooves_of
from ...scene.rings import SMALL_TILT
from ...scene.scene import arrangement, frozen_at_start
from ...simulation.stability import held_speeds
from ...units import Speed
from .. import Info
from .arrangements import (
    PHASES,
    QUANTITIES,
    SEALS,
    Arrangement,
    curves,
    phases_apart,
    points_in_time,
    seals_of,
    seals_over_grooves,
)
from .choices import UNITS, choice_tables, choices

INFO = Info(
    timed=("fmr_reference", 3),
    asks="How much misalignment reaches the film?",
    grooved=True,
    refuses=("secondary-seal",),
    units={
        "speed": "rad/s", "turns": "1", "from": "rad/s", "to": "rad/s", "pairs": "1", **UNITS,
        **dict.fromkeys(PHASES, "deg"), **dict.fromkeys((*QUANTITIES, "absolute"), "1"),
        **{f"stability_ends/{seal}": "rad/s" for seal in SEALS},
        **{f"table{road}/{seal}": "the row's unit"
           for seal in SEALS for road in ("", "/formula", "/linear_algebra", "/time_domain")},
    },
    along={seal + road: ("speed",) for seal in SEALS for road in ("", "/linear_algebra")}
    | {"time_domain": ("speed",), "crossings": ("speed",)}
    | {f"over_inertia_ratio{part}": ("ratio",) for part in ("", "/fmr", "/fmsr")},
)  # fmt: skip
# Relative difference below which two arrangements transmit the same; how well the end of stability is located.
SAME, LOCATED = 1e-9, 1e-9
# Numbers of speeds without any asked.
POINTS, POINTS_OVER_GROOVES = 301, 25
# Share of the fastest speed below which stability ends by rounding: rings at rest may have a neutral mode.
AT_REST = 1e-6
NAMES = {
    "static": "static_transmissibility",
    "dynamic": "dynamic_transmissibility",
    "total": "maximum_relative_misalignment",
}
ROADS = {"formula": "formula", "linear_algebra": "linear algebra", "time_domain": "in time"}
# Keys of the misalignments that one arrangement has: what is static, what is dynamic; and of which a critical size is
# told, that of the rigid partner, of two floating rings both.
KEYS = {
    "fmr": ("stator.misalignment", "rotor.misalignment"),
    "fms": ("stator.misalignment", "rotor.runout"),
    "fmsr": ("stator.misalignment", "rotor.misalignment"),
}
PARTNERS = {"fmr": ("stator.misalignment",), "fms": ("rotor.runout",), "fmsr": KEYS["fmsr"]}
STYLE = {"fmr": ("rotor", "circle"), "fms": ("stator", "square"), "fmsr": ("good", "diamond"), None: ("grey", "")}


@dataclass(frozen=True)
class Settings:
    """Speeds, and the time domain beside them."""

    speed_from: Speed = 0.0
    """Lowest speed."""
    speed_to: Speed | None = None
    """Highest speed; without it three times the scenario's, no more than a film holds."""
    points: int | None = None
    """Number of speeds (301; over grooves 25)."""
    unit: Literal["rad/s", "rpm"] = "rad/s"
    """Of the figure's axis."""
    time_points: int = 12
    """Speeds in the time domain."""
    accuracy: float = 1e-7
    """Accuracy of these runs."""
    longest: float = 4000.0
    """Turns that they may take."""


def run(scenario, settings, tools) -> Answer:
    """Transmissibilities of the three arrangements by three independent methods, the speeds at which they cross, which
    is best where, the table and Green's groups."""
    own_speed, grooved = abs(frozen_at_start(scenario.scene).shaft.speed), bool(grooves_of(scenario.scene)[1])
    seals = (seals_over_grooves if grooved else seals_of)(scenario.scene)
    top, held = settings.speed_to, None
    if top is None:
        asked = 3 * own_speed or 3000.0
        ends = [held_speeds(seal.model, seal.model.start, 1e-3 * asked, asked)[1] for seal in seals.values()
                if not grooved]  # fmt: skip
        top = min([asked, *ends])
        held = [settings.speed_from, top] if top < asked else None
    points = max(2, settings.points or (POINTS_OVER_GROOVES if grooved else POINTS))
    # At rest grooves do not pump.
    speeds = np.linspace(settings.speed_from or (top / points if grooved else 0.0), top, points)
    by_formula = all(seal.formula_holds(w) for seal in seals.values() for w in (speeds[-1], 0.5 * speeds[-1]))
    numbers = {"speed": speeds.tolist(), "unit": settings.unit, "arrangement": arrangement(scenario.scene)}
    numbers["stator_speed"] = frozen_at_start(scenario.scene).stator.speed
    numbers["own_speed"], numbers["speeds_held"] = own_speed, held
    numbers["gap_moves"] = moves_with_speed(scenario.scene)
    for name, seal in seals.items():
        algebra = curves(speeds, np.array([seal.relative_tilts(w) for w in speeds]).T)
        numbers[name] = dict(algebra)
        if by_formula:
            numbers[name] = curves(speeds, seal.formula_tilts(speeds))
            numbers[name] |= dict(zip(QUANTITIES, np.array(seal.formula(speeds)).tolist(), strict=True))
        numbers[name]["linear_algebra"] = algebra
        if name != "fmsr":
            numbers[name]["absolute"] = [seal.absolute(w) for w in speeds]
        numbers[name]["stable"] = [seal.growth(w) < 0 for w in speeds]
    numbers["formula_holds"] = by_formula
    numbers["roads_apart"], numbers["phases_apart"] = _apart(numbers)
    tools.say(0.05)
    numbers["crossings"] = crossings(seals, speeds)
    # The last one of each.
    between = {c["quantity"]: c["speed"] for c in numbers["crossings"] if c["seals"] == list(SEALS[:2])}
    numbers["crossovers"] = dict.fromkeys(QUANTITIES) | between
    numbers["stability_ends"] = {name: stability_ends(seals[name], speeds, numbers[name]["stable"]) for name in SEALS}
    numbers["best"] = {q: best(seals, q, speeds, numbers["crossings"], numbers["stability_ends"]) for q in QUANTITIES}
    numbers["pairs"] = [
        {"seals": pair, "best": best({name: seals[name] for name in pair}, "total", speeds, numbers["crossings"],
                                     numbers["stability_ends"])}
        for pair in map(list, combinations(SEALS, 2))
    ]  # fmt: skip
    # A turn over grooves takes its time, and Green's groups are of faces without.
    numbers["time_domain"] = [] if grooved else points_in_time(scenario, settings, speeds, own_speed, tools)
    numbers |= choices(seals, 0.0 if grooved else own_speed)
    numbers["table"] = table(seals, own_speed, by_formula, numbers["time_domain"]) if own_speed else []
    with reading_in({"rad/s": "rpm"} if settings.unit == "rpm" else {}):
        tables, far = _tables(seals, numbers)
        notes = _notes(seals, numbers) + far
        return Answer(numbers, _found(numbers), tables, _panels(numbers), notes)


# --- which is best ------------------------------------------------------------------------------------


def crossings(seals: dict[str, Arrangement], speeds) -> list[dict]:
    """Every speed (rad/s) inside the range where one arrangement overtakes another, located to rounding; at rest
    FMR and FMS transmit the same."""
    found = []
    moving = [w for w in speeds if w != 0]
    algebra = {name: cache(seal.algebra) for name, seal in seals.items()}
    for i, quantity in enumerate(QUANTITIES):
        for pair in combinations(SEALS, 2):

            def excess(w, i=i, pair=pair):
                one, other = (algebra[name](w)[i] for name in pair)
                return one - other if abs(one - other) > SAME * one else 0.0

            for (a, low), (b, high) in pairwise((w, excess(w)) for w in moving):
                if low * high < 0:
                    speed = float(brentq(excess, a, b, rtol=1e-12))
                    better = pair[1] if high > 0 else pair[0]
                    found.append({"quantity": quantity, "seals": list(pair), "speed": speed, "better_above": better})
    return found


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


# --- the table --------------------------------------------------------------------------------------


def table(seals: dict[str, Arrangement], speed: float, by_formula: bool, rows: list[dict]) -> list[dict]:
    """The arrangements in the form of Green's Table 1, at one speed (rad/s), by every method there is."""
    roads = {road: {} for road in ROADS}
    for name, seal in seals.items():
        roads["linear_algebra"][name] = [*seal.algebra(speed)]
        roads["formula"][name] = [float(v) for v in seal.formula(speed)] if by_formula else [None] * 3
        row = next((r for r in rows if r["seal"] == name and r["speed"] == speed and "failed" not in r), {})
        roads["time_domain"][name] = [row.get(q) for q in QUANTITIES]
        found = {"linear_algebra": seal.critical_speed(), "formula": by_formula and seal.critical_speed_by_formula()}
        for road, both in roads.items():
            closing = min(critical_misalignments(seal, speed, both[name]).values(), default=None)
            both[name] += [closing, found.get(road) or None]
    kinds = [*((n, "1") for n in NAMES.values()), ("critical_misalignment", "C/r_o"), ("critical_speed", "rad/s")]

    def best(quantity, name):
        # A formula of the critical speed knows one gap only.
        moves = quantity == "critical_speed" and moves_with_speed(seals[name].scene)
        return "formula" if by_formula and not moves else "linear_algebra"

    return [
        {"quantity": quantity, "unit": unit, **{name: roads[best(quantity, name)][name][i] for name in SEALS}}
        | {road: {name: both[name][i] for name in SEALS} for road, both in roads.items()}
        for i, (quantity, unit) in enumerate(kinds)
    ]


def critical_misalignments(seal: Arrangement, speed: float, values) -> dict[str, float]:
    """By its key, the misalignment of each of PARTNERS at first touch, of the asperities of rough faces, in units of
    C/r_o, the other key of KEYS being one such unit; from static and dynamic transmissibility, the first two of
    `values`; of none that closes the film, nor of faces that touch when aligned."""
    scene = seal.model.at_speed(speed).scene
    film, rough, change = scene.film, touch_height(scene), coning_change(scene, float, speed)
    touch = min((h - rough) / r for r, h in aligned_gaps(film, film.clearance, change))
    if values[0] is None or touch <= 0.0:
        return {}
    found = {}
    for key in PARTNERS[seal.name]:
        forcing, own = (values[0], values[1]) if key == KEYS[seal.name][0] else (values[1], values[0])
        size = float(cf.critical_forcing(touch * film.outer_radius / film.clearance, own, forcing))
        if np.isfinite(size):
            found[key] = size
    return found


# --- what is shown ------------------------------------------------------------------------------------


def _found(numbers) -> str:
    """Which arrangement transmits least where, and how much at the scenario's speed."""
    stretches = numbers["best"]["total"]
    names = [stretch["seal"].upper() if stretch["seal"] else "none" for stretch in stretches]
    ends = [*(f"to {in_words('speed', s['to'])}" for s in stretches[:-1]), "beyond"]
    where = [f"{name} {end}" for name, end in zip(names, ends, strict=True)][1:]
    first = ends[0] if where else "at every speed"
    found = ", ".join([f"In total {names[0]} lets the least misalignment through {first}", *where])
    if not numbers["table"]:
        return f"{found}."
    (row,) = (row for row in numbers["table"] if row["quantity"] == NAMES["total"])
    values = ", ".join(f"{name.upper()} {row[name]:.4g}" for name in SEALS)
    return f"{found}; at {in_words('speed', numbers['own_speed'])} {values} per unit tilts."


def _notes(seals, numbers) -> list[str]:
    """What is compared, where there is no steady state, and what failed."""
    said = ["FMSR is this scene with the same ring and support on the other side too."]
    if numbers["arrangement"] == "FMSR":
        said = ["Both rings float: FMR and FMS are this scene with the other ring held rigid."]
    if face := grooves_of(seals["fmr"].scene)[0]:
        said.append(f"The grooves stay in the face of the {face}, whichever ring floats.")
    if numbers["speeds_held"]:
        said.append(f"Beyond {in_words('speed', numbers['speeds_held'][1])} no film holds the closing force.")
    for name in SEALS:
        if not numbers["stability_ends"][name] and not all(numbers[name]["stable"]):
            said.append(f"{name.upper()} is not damped over the whole range: no steady state.")
    if numbers["over_inertia_ratio"].get("stable_to"):
        said.append(f"FMR never whirls up to I/J = {numbers['over_inertia_ratio']['stable_to']:.4g}.")
    if not numbers["formula_holds"]:
        said.append("No closed form for this film or a turning stator: lines are linear algebra.")
    film = seals["fmr"].scene.film
    if not face and (seals["fmr"].model.interface.name != "linear" or film.coefficients != "green"):
        said.append('Green\'s Fig. 8 has the coefficients of the narrow seal (film.model = "linear").')
    failed = [row for row in numbers["time_domain"] if "failed" in row]
    if failed:
        said.append(f"{len(failed)} time-domain points failed, e.g. {failed[0]['failed']}")
    return said


def _tables(seals, numbers) -> tuple[list[Table], list[str]]:
    """The arrangements at the scenario's speed, in the form of Green's Table 1; which is best where; film and methods;
    and a note of each critical misalignment that is no small tilt."""
    speed, far, rows = numbers["own_speed"], [], []
    for name, road in ((name, road) for name in SEALS if numbers["table"] for road in ROADS):
        values = [row[road][name] for row in numbers["table"]]
        known = critical_misalignments(seals[name], speed, values)
        key = min(known, key=known.get, default=None)
        if any(value is not None for value in values):
            rows.append([name.upper() if road == "formula" or not numbers["formula_holds"] else "", ROADS[road],
                         *values[:4], key, values[4]])  # fmt: skip
        film = seals[name].model.at_speed(speed).scene.film
        if road == "linear_algebra" and key and known[key] * film.clearance / film.outer_radius > SMALL_TILT:
            far.append(f"{name.upper()}: the critical {key} is beyond any small tilt, no limit.")
    columns = [
        ("1", "seal"),
        ("1", "by"),
        *(("1", name) for name in QUANTITIES),
        ("1", "critical misalignment, C/r_o"),
        ("1", "of, beside another of 1"),
        ("speed", "critical speed"),
    ]
    found = [Table(f"at {in_words('speed', speed)}", columns, rows)]
    compared = [("all", q, numbers["best"][q]) for q in QUANTITIES]
    compared += [(" and ".join(map(str.upper, pair["seals"])), "total", pair["best"]) for pair in numbers["pairs"]]
    rows = [[who if k == 0 else "", quantity if k == 0 else "", (s["seal"] or "none").upper(), s["from"], s["to"]]
            for who, quantity, stretches in compared for k, s in enumerate(stretches)]  # fmt: skip
    columns = [("1", "of"), ("1", "in"), ("1", "transmits least"), ("speed", "from"), ("speed", "to")]
    found.append(Table("best", columns, rows))
    rows = [[name.upper(), end] for name in SEALS for end in numbers["stability_ends"][name]]
    found.append(Table("stability", [("1", "seal"), ("speed", "steady state ends or begins")], rows))
    rows = [[name.upper(), key, seals[name].absolute(speed)] for name in SEALS[:2] for key in PARTNERS[name]]
    columns = [("1", "floating ring of"), ("1", "per unit"), ("transmissibility", "absolute tilt")]
    found.append(Table("absolute", columns, rows))
    stiffness, damping = (float(v) for v in seals["fmr"].film_numbers(speed))
    columns = [("1", "film"), ("tilt_stiffness", "tilt stiffness"), ("tilt_damping", "tilt damping"),
               ("1", "formula and algebra apart"), ("phase", "phases apart"), ("1", "points in time")]  # fmt: skip
    done = sum("failed" not in row for row in numbers["time_domain"])
    apart = (numbers["roads_apart"], numbers["phases_apart"]) if numbers["formula_holds"] else (None, None)
    found.append(Table("film", columns, [[seals["fmr"].model.interface.name, stiffness, damping, *apart, done]]))
    return found + choice_tables(numbers), far


def _panels(numbers) -> list[Panel]:
    """Transmissibilities above phases; beside the total, which arrangement transmits least."""
    speed = numbers["speed"]
    axis = Axis("speed", low=min(speed[0], speed[-1]), high=max(speed[0], speed[-1]))
    turns = "turns with the stator" if numbers["stator_speed"] else "fixed in space"
    titles = {
        "static": f"Static: {turns}",
        "dynamic": "Dynamic: turns with the shaft",
        "total": "Total: both forcings 1",
    }
    panels = []
    for quantity, title in titles.items():
        values = np.concatenate([numbers[seal][quantity] for seal in SEALS])
        low, high = max(values.min(), 1e-9), np.percentile(values, 99)
        # Far apart: the crossing is seen on a logarithmic axis only.
        scale = {"scale": "log", "low": 0.7 * low, "high": 1.4 * high} if high > 8 * low else {"low": 0.0}
        panels.append(Panel(title, axis, Axis("transmissibility", "relative tilt per unit forcing", **scale),
                            _curves(numbers, quantity, axis, first=quantity == "static")))  # fmt: skip
        if quantity != "total":
            lags = Axis("phase", "phase behind the forcing")
            behind = _curves(numbers, f"{quantity}_phase", axis)
            panels.append(Panel("", axis, lags, behind, [Level(0.0, style="black")], below=True))
    series = []
    for k, stretches in enumerate(numbers["best"].values()):
        for stretch in stretches:
            ends, seal = [stretch["from"], stretch["to"]], stretch["seal"]
            series.append(Series("line", ends, [k, k], style=f"{STYLE[seal][0]} thick"))
        ends = [stretch["from"] for stretch in stretches[1:]]
        series.append(Series("marks", ends, [k] * len(ends), style="black plus front",
                             names=[in_words("speed", end) for end in ends]))  # fmt: skip
    least = Axis(words=QUANTITIES, low=-0.5, high=2.5)
    return [*panels, Panel("The one that transmits least", axis, least, series, below=True, down=True)]


def _curves(numbers, name: str, axis: Axis, first: bool = False) -> list[Series]:
    """One column of the arrangements by three independent methods over speed."""
    speed, series = numbers["speed"], []
    road = "formula" if numbers["formula_holds"] else "linear algebra"
    for seal in SEALS:
        held, (colour, mark) = numbers[seal], STYLE[seal]
        for stable, style, words in ((True, "thick", road), (False, "dotted thin", "not damped")):
            line = [v if there is stable else None for v, there in zip(held[name], held["stable"], strict=True)]
            if any(value is not None for value in line):
                label = f"{seal.upper()}, {words}" * first
                series.append(Series("line", speed, line, label=label, style=f"{colour} {style}"))
        if numbers["formula_holds"]:
            algebra = zip(held["linear_algebra"][name], held["stable"], strict=True)
            series.append(Series("line", speed, [v if there else None for v, there in algebra],
                                 label="linear algebra" * first, style="black dashed thin"))  # fmt: skip
        # The scenario's own speed may lie elsewhere.
        rows = [row for row in numbers["time_domain"]
                if row["seal"] == seal and "failed" not in row and axis.low <= row["speed"] <= axis.high]  # fmt: skip
        if rows:
            series.append(Series("marks", [row["speed"] for row in rows], [row[name] for row in rows],
                                 error=[row["error"][name] for row in rows], label="in time" * first,
                                 style=f"{colour} {mark} open front"))  # fmt: skip
    return series
