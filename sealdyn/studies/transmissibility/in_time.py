"""Amplitudes and phases of relative tilts over speed; and those of one arrangement, from runs in time."""

import math
from dataclasses import replace
from functools import partial

import numpy as np

from ...analysis.arrangements import SEALS, Arrangement, seals_of
from ...dynamics.extrema import MOST
from ...dynamics.model import Model
from ...dynamics.run_state import RunState
from ...dynamics.signals import signals
from ...quantities import in_words
from ...scene.film import Coefficients, aligned_gaps, coning_change
from ...scene.scene import Scene
from ...scene.variants import frozen_at_start
from ...simulation.selection import choose_method
from ...solvers.contract import Recorder, Status
from ...solvers.integrate import solve

QUANTITIES = ("static", "dynamic", "total")
PHASES = ("static_phase", "dynamic_phase")
# Forcing of a time-domain point, as part of the thinnest edge film, and what may be left of its transient.
AMPLITUDE, LEFT, PER_TURN = 0.2, 1e-9, 64
COARSER = 100.0


def points_in_time(scenario, settings, speeds, own_speed, tools) -> list[dict]:
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
        raise ValueError(f"{kind} at {in_words('speed', point['speed'])}: no steady state")
    turns = math.ceil(-math.log(LEFT) / decay / turn) + 4
    if turns > point["longest"]:
        raise ValueError(f"the transient takes {turns} turns to die out, more than {point['longest']:g}")
    clearance = seal.clearance(point["speed"])
    amplitude = _amplitude(seal, point["speed"], clearance)
    scene = _forced(seal, point["speed"], clearance, amplitude)
    fine = np.array(_steady(scene, turns, point["accuracy"], amplitude))
    coarse = np.array(_steady(scene, turns, COARSER * point["accuracy"], amplitude))
    away = np.abs(fine - coarse)
    # 359 deg apart is 1 deg apart.
    away[3:] = np.minimum(away[3:], 360.0 - away[3:])
    names = (*QUANTITIES, *PHASES)
    return dict(zip(names, fine.tolist(), strict=True)) | {
        "error": dict(zip(names, away.tolist(), strict=True)), "turns": turns
    }  # fmt: skip


def _amplitude(seal: Arrangement, speed: float, clearance: float) -> float:
    """Forcing (rad) that leaves the film of a `clearance` (m) open."""
    scene = seal.model.at_speed(speed).scene
    film, change = scene.film, coning_change(scene, float, speed)
    thinnest = min(h for _, h in aligned_gaps(film, clearance, change))
    return AMPLITUDE * thinnest / film.outer_radius / max(1.0, seal.algebra(speed)[2])


def _forced(seal: Arrangement, speed: float, clearance: float, amplitude: float) -> Scene:
    """The arrangement with both forcings (rad), on the linear film of a `clearance` (m), which has the
    stiffness of asperities that touch too."""
    linear = seal.linear(speed)
    own = Coefficients(
        tilt_stiffness=linear.film_k[1, 1],
        tilt_damping=linear.film_d[1, 1],
        axial_stiffness=linear.film_k[0, 0],
        axial_damping=linear.film_d[0, 0],
    )
    scene = frozen_at_start(seal.model.at_speed(speed).scene, speed)
    return replace(
        scene,
        # Inertia has moved the gap, and is in the coefficients.
        film=replace(scene.film, model="linear", coefficients=own, inertia=False, clearance=clearance),
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


def phases(speeds, static, dynamic) -> tuple:
    """Phases (deg) of the relative tilts (stator minus rotor, in the frame of the forcing) behind their forcings."""
    sense = np.where(np.asarray(speeds) < 0, -1.0, 1.0)
    # The rotor carries the dynamic forcing: counted from it, the relative tilt has the other sign.  (+ 0 for no -0.)
    return tuple(0.0 - sense * np.degrees(np.angle(tilt)) + 0.0 for tilt in (static, -np.asarray(dynamic)))


def curves(speeds, tilts) -> dict:
    """Amplitudes and phases over speed, phases without jumps."""
    static, dynamic = np.abs(tilts)
    lags = [_without_jumps(lag).tolist() for lag in phases(speeds, *tilts)]
    amplitudes = [a.tolist() for a in (static, dynamic, static + dynamic)]
    return dict(zip((*QUANTITIES, *PHASES), (*amplitudes, *lags), strict=True))


def _without_jumps(lag) -> np.ndarray:
    """Phases (deg) that run on; of those that begin behind and ahead at once, half a turn away, as near to zero as they
    can be told."""
    lag = np.unwrap(lag, period=360.0)
    return lag - 360.0 * np.round(lag.mean() / 360.0) if abs(lag[0]) > 90.0 else lag


def phases_apart(one, other) -> float:
    """Largest distance (deg) of two rows of phases: 359 deg apart is 1 deg apart."""
    away = np.abs(np.asarray(one) - other) % 360.0
    return float(np.max(np.minimum(away, 360.0 - away)))
