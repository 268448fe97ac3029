"""Neutral stability: what each method adds to or takes from a motion that must neither grow nor decay, and its price.

At the exact stability threshold of this seal (eigenvalues, linear film) the growth a method shows is its own: numerical
damping.  Its ring, precessing freely without damping, keeps energy and angular momentum: drift.
"""

import math
from dataclasses import dataclass, replace
from functools import partial

import numpy as np

from ..analysis.rotating_wave import free_model
from ..analysis.whirl_in_time import growth_rate
from ..answers import Answer, Axis, Level, Panel, Series, Table, table_of
from ..dynamics.model import Model
from ..dynamics.run_state import RunState
from ..dynamics.warm_state import at_work
from ..numerics.piecewise_linear import points
from ..quantities import in_words, number
from ..scene.film import Coefficients
from ..scene.rings import ROTOR, STATOR
from ..scene.scene import Closing, SceneError, refuse_uneven, unforced, with_values
from ..solvers.contract import Counts, SolverFailure, attainable, tolerance_for
from ..solvers.fixed_step import REFERENCE_METHODS
from . import Info
from .failures.cases import integration as exhibit

METHODS = ("adams", "bdf", "ida", "dop853", "rk45", "radau", "expm")
DEFAULT = "adams"
# Of a point what its row begins with.
OF_POINT = ("method", "accuracy", "turns")
# What the critical-speed study does at the edges of its bracket, and how far below it the method must stay.
EDGE, STUDY_TURNS, STUDY_ACCURACY, MARGIN = 2e-5, 200, 1e-7, 100.0
MOST_CALLS = 600_000
# Accuracy of the numbers that are told.
TOLD = 1e-6
NOTHING = Coefficients(tilt_stiffness=0.0, tilt_damping=0.0, axial_stiffness=0.0, axial_damping=0.0)
LINEAR = {"film.model": "linear"}
INFO = Info(
    timed=("fms_reference", 22),
    asks="What do the methods themselves add where nothing damps?",
    # The linear film at its threshold is the measure: nothing else may damp or bound the motion.
    refuses=("contact", "secondary-seal"),
    # Growth, cost and drift are for each turn, or shares.
    units=dict.fromkeys(("accuracy", "turns", "growth", "cost", "tolerance", "energy", "momentum", "attainable"), "1"),
    along={"damping": ("accuracy",), "drift": ("accuracy",)},
)
# How each method is drawn, and below which size a change per turn is rounding.
STYLES = {"adams": "first circle", "bdf": "second square", "ida": "third diamond", "dop853": "fourth triangle",
          "rk45": "fifth down", "radau": "sixth circle", "expm": "seventh star"}  # fmt: skip
ROUNDING = 1e-17


@dataclass(frozen=True)
class Settings:
    """How long and how exactly each method runs."""

    turns: int = 60
    """Turns of the neutral whirl and of the precession for every method."""
    accuracies: tuple[float, ...] = (1e-2, 1e-3, 1e-4, 1e-5, 1e-6, 1e-7, 1e-8, 1e-9)
    """Accuracies asked of each."""
    long: int = 10_000
    """Turns that the default method precesses (0: not at all)."""


def run(scenario, settings, tools) -> Answer:
    """Numerical damping and drift of every method, and whether the default one is fine enough."""
    linear = with_values(scenario.scene, LINEAR)
    speed, why = None, ""
    try:
        speed = exhibit.threshold(linear)
        why = "" if speed else "without a critical speed no motion is neutral"
    except (SceneError, ValueError, np.linalg.LinAlgError) as error:
        gas = "a film of gas is not linear, so that its threshold is not known exactly"
        why = gas if scenario.scene.film.gas else str(error)
    if speed and free_model(linear, speed).unknowns.has_residual_form:
        speed, why = None, "a ring without inertia: most methods have no rates to integrate"
    every = [{"turns": settings.turns, "method": m, "accuracy": a} for m in METHODS for a in settings.accuracies]
    damping, resolved = [], None
    if speed:
        points = [{**point, "speed": speed} for point in every]
        damping = tools.map(partial(damped, scenario.scene), points, "damping", OF_POINT)
        (resolved,) = tools.map(partial(resolution, scenario.scene), [{"speed": speed}], "resolution")
    drift, drift_why = [], ""
    try:
        free_ring(scenario.scene)
        every += [{"turns": settings.long, "method": DEFAULT, "accuracy": TOLD}] if settings.long else []
        drift = tools.map(partial(drifted, scenario.scene), every, "drift", OF_POINT)
        if all("failed" in row for row in drift):
            drift, drift_why = [], drift[0]["failed"]
    except SceneError as error:
        drift_why = str(error)
    answer = {"critical_speed": speed, "reason": why, "damping": damping, "resolved": resolved, "drift": drift,
              "drift_reason": drift_why, "turns": settings.turns}  # fmt: skip
    return Answer(answer, _found(answer), _tables(answer), _panels(answer), _notes(answer))


def tolerance(method, accuracy, memory) -> float:
    """Solver tolerance a method is held at; RK45, never chosen, at that of DOP853."""
    return tolerance_for("dop853" if method == "rk45" else method, accuracy, memory)


# --- at the threshold ------------------------------------------------------------------------------------


def damped(scene, point: dict) -> dict:
    """Growth per turn that a method gives the neutral whirl, and right-hand sides per turn."""
    speed, turns, method = point["speed"], point["turns"], point["method"]
    run, whirling = exhibit.neutral_run(with_values(scene, LINEAR), speed, turns)
    held = tolerance(method, point["accuracy"], run.memory)
    try:
        rate, calls = exhibit.growth(run, whirling, method, held, MOST_CALLS)
    except (SolverFailure, TimeoutError) as failure:
        return {"growth": None, "cost": None, "reason": str(failure), "tolerance": held}
    return {"growth": rate * 2 * math.pi / speed, "cost": calls / turns, "reason": None, "tolerance": held}


def resolution(scene, point: dict) -> dict:
    """What the critical-speed study resolves at the edge of its bracket, and the default method's own growth at the
    threshold under the same accuracy and turns (1/s)."""
    speed, linear = point["speed"], with_values(scene, LINEAR)
    found = growth_rate(linear, speed * (1 + EDGE), STUDY_TURNS, DEFAULT, STUDY_ACCURACY)
    run, whirling = exhibit.neutral_run(linear, speed, STUDY_TURNS, found["accuracy"])
    own, _ = exhibit.growth(run, whirling, DEFAULT, tolerance(DEFAULT, found["accuracy"], run.memory))
    return {"rate": abs(found["rate"]), "uncertainty": found["uncertainty"], "numerical_damping": abs(own),
            "accuracy": found["accuracy"], "method": DEFAULT, "turns": STUDY_TURNS, "decided": found["decided"],
            "ratio": abs(found["rate"]) / max(abs(own), 1e-300)}  # fmt: skip


# --- free precession -------------------------------------------------------------------------------------


def free_ring(scene):
    """The scene's first floating ring with inertia on undamped springs, the film off; and which ring that is.
    Raises SceneError if there is none."""
    name = next((n for n, ring in (("rotor", scene.rotor), ("stator", scene.stator))
                 if ring.support and ring.transverse_inertia > 0), None)  # fmt: skip
    if name is None:
        raise SceneError("rotor.transverse_inertia", "no floating ring with inertia", "one that can precess")
    refuse_uneven(scene)
    speed = max(points(scene.shaft.speed), key=abs)
    still = unforced(at_work(scene)[0], float(speed))
    ring, held = (still.rotor, still.stator) if name == "rotor" else (still.stator, still.rotor)
    support = replace(ring.support, axial_damping=0.0, tilt_damping=None if ring.support.radius is not None else 0.0)
    if support.tilt()[0] <= 0.0 or speed == 0.0:
        raise SceneError(f"{name}.support", "no tilt stiffness, or a shaft at rest", "a ring that can precess")
    other = "stator" if name == "rotor" else "rotor"
    # The film does nothing, so any clearance will do; a linear motion does not know its size.
    film = replace(still.film, model="linear", coefficients=NOTHING, cavitation_pressure=None,
                   clearance=still.film.clearance or 1e-5)  # fmt: skip
    parts = {name: replace(ring, support=support, secondary_seal=None),
             other: replace(held, support=None, secondary_seal=None)}  # fmt: skip
    return replace(still, film=film, closing=Closing(), contact=None, **parts), name


def drifted(scene, point: dict) -> dict:
    """Drift per turn of energy and angular momentum, relative, over the point's turns, and right-hand sides per turn.

    The ring carries a forward and a backward circle of 0.15 and 0.05 of the clearance at the outer radius.
    """
    scene, name = free_ring(scene)
    turn = 2 * math.pi / abs(scene.shaft.speed)
    run = RunState(Model(scene, point["accuracy"]), point["turns"] * turn)
    ring, side = (scene.rotor, ROTOR) if name == "rotor" else (scene.stator, STATOR)
    spin = scene.shaft.speed if side == ROTOR else (scene.stator.speed or 0.0)
    inertia, gyro, stiffness = ring.transverse_inertia, ring.polar_inertia * spin, ring.support.tilt()[0]
    roots = np.roots([-inertia, gyro, stiffness])
    x = run.model.unknowns.names.index(f"{name}_tilt_x")
    rate_x = run.model.unknowns.rate_places[x]
    forward, backward, size = max(roots.real), min(roots.real), 0.1 * run.model.clearance / run.model.face[1]
    run.y0[x], run.y0[rate_x + 1] = 2 * size, size * (1.5 * forward + 0.5 * backward)

    def invariants(y):
        g, v = y[:, x] + 1j * y[:, x + 1], y[:, rate_x] + 1j * y[:, rate_x + 1]
        energy = 0.5 * inertia * np.abs(v) ** 2 + 0.5 * stiffness * np.abs(g) ** 2
        return energy, inertia * (np.conj(g) * v).imag - 0.5 * gyro * np.abs(g) ** 2

    (start,), (turning,) = invariants(run.y0[None, :])
    scale = abs(turning)
    counts, method = Counts(), point["method"]
    held = tolerance(method, point["accuracy"], run.memory)
    best = attainable("dop853" if method == "rk45" else method, run.memory)
    nothing = {"energy": None, "momentum": None, "cost": None, "tolerance": held, "attainable": best}
    try:
        tau, y = 0.0, run.y0
        for k in range(len(run.intervals)):
            for _, ys, _ in REFERENCE_METHODS[method](run.segment(k), tau, y, method, held, counts):
                y = ys[-1]
                if counts.rhs > MOST_CALLS and point["turns"] < 1000:
                    return {**nothing, "reason": f"more than {MOST_CALLS} right-hand sides"}
    except SolverFailure as failure:
        return {**nothing, "reason": str(failure)}
    (end,), (last,) = invariants(y[None, :])
    turns = point["turns"]
    return {**nothing, "energy": float(end / start - 1) / turns, "momentum": float(last - turning) / scale / turns,
            "cost": counts.rhs / turns, "reason": None}  # fmt: skip


# --- what is told ---------------------------------------------------------------------------------------


def _told(numbers) -> list[dict]:
    return [row for row in numbers["damping"] if row.get("growth") is not None and row["accuracy"] == TOLD]


def _found(numbers) -> str:
    """The least and the largest growth per turn that is a method's own."""
    if not numbers["critical_speed"]:
        return f"No numerical damping measured: {numbers['reason']}."
    where = f"at the threshold, {in_words('speed', numbers['critical_speed'], 5)}, and accuracy {TOLD:.0e}"
    rows = sorted(_told(numbers), key=lambda row: abs(row["growth"]))
    if not rows:
        return f"No method kept to the bound on its cost {where}."
    least, most = (f"{number(row['growth'], digits=2)} ({row['method']})" for row in (rows[0], rows[-1]))
    return f"Growth per turn of the methods' own {where}: {least} to {most}."


def _notes(numbers) -> list[str]:
    found, notes = numbers["resolved"] or {}, []
    if "ratio" in found:
        stays = "stays" if found["ratio"] >= MARGIN else "does not stay"
        notes.append(f"The default method {stays} {MARGIN:.0f} times or more below what critical-speed resolves.")
    return notes + ([f"No free precession: {numbers['drift_reason']}."] if numbers["drift_reason"] else [])


def _tables(numbers) -> list[Table]:
    """What is each method's own at the accuracy told, the long precession, and what the default method leaves."""
    method, cost = ("1", "method", "method"), ("1", "right-hand sides per turn", "cost")
    drift = [row for row in numbers["drift"] if row["turns"] != numbers["turns"] or row["accuracy"] == TOLD]
    precession = [method, ("1", "turns", "turns"), ("1", "energy drift per turn", "energy"),
                  ("1", "of angular momentum", "momentum"), cost]  # fmt: skip
    tables = [table_of("growth", [method, ("1", "growth per turn", "growth"), cost], _told(numbers)),
              table_of("drift", precession, drift)]  # fmt: skip
    found = numbers["resolved"] or {}
    if "ratio" in found:
        columns = [("1", "default method", "method"), ("growth_rate", "its own growth", "numerical_damping"),
                   ("growth_rate", "resolved growth", "rate"), ("growth_rate", "uncertainty", "uncertainty"),
                   ("1", "ratio", "ratio")]  # fmt: skip
        tables.append(table_of("resolution", columns, [found]))
    return tables


def _panels(numbers) -> list[Panel]:
    """Over the cost of a turn: growth of the neutral whirl, and energy drift of free precession."""
    cost, found, levels = Axis("1", "right-hand sides per turn", scale="log"), numbers["resolved"] or {}, []
    title, drifts = "Growth of a neutral whirl, at the stability threshold", "Energy drift of free precession"
    if "rate" in found:
        turn = 2 * math.pi / numbers["critical_speed"]
        shares = (1.0, "resolved by study critical-speed"), (0.01, "a hundredth of it")
        levels = [Level(share * found["rate"] * turn, words) for share, words in shares]
    growth = Panel(title, note=numbers["reason"])
    if numbers["damping"]:
        series, note = _curves(numbers["damping"], "growth")
        growth = Panel(title, cost, Axis("1", "|growth per turn|", scale="log"), series, levels, note=note)
    if not numbers["drift"]:
        return [growth, Panel(drifts, note=numbers["drift_reason"])]
    short = [row for row in numbers["drift"] if row["turns"] == numbers["turns"]]
    series, note = _curves(short, "energy")
    for row in numbers["drift"]:
        if row["turns"] != numbers["turns"] and row.get("energy") is not None:
            size = max(abs(row["energy"]), ROUNDING)
            series.append(Series("marks", [row["cost"]], [size], style=f"{STYLES[row['method']]} large front",
                                 names=[f"{row['turns']} turns"]))  # fmt: skip
    return [growth, Panel(drifts, cost, Axis("1", "|energy drift per turn|, relative", scale="log"), series, note=note)]


def _curves(rows, key: str) -> tuple[list[Series], str]:
    """One line per method over its accuracies, open marks where it pumps; what has no answer."""
    series, missing = [], []
    for method, style in STYLES.items():
        own = [row for row in rows if row["method"] == method]
        good = [row for row in own if row.get(key) is not None]
        missing += [f"{method} at {row['accuracy']:.0e}" for row in own if row not in good]
        cost, size = [row["cost"] for row in good], [max(abs(row[key]), ROUNDING) for row in good]
        if good:
            series.append(Series("line", cost, size, label=method, style=style))
        pumps = [(x, y) for x, y, row in zip(cost, size, good, strict=True) if row[key] > 0.0]
        if pumps:
            series.append(Series("marks", *zip(*pumps, strict=True), style=f"{style} open front"))
    note = "filled: damps; open: pumps" + (f"; no answer: {', '.join(missing)}" if missing else "")
    return series, note
