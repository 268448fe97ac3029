"""Growth rates in the time domain, by integration and fit: a method of its own beside the eigenvalues."""

import math
from dataclasses import replace

import numpy as np

from ..dynamics.model import Model
from ..dynamics.run_state import RunState
from ..scene.scene import Initial, RingStart
from ..solvers.integrate import solve
from ..solvers.recorder import Recorder

ACCURACY = 1e-8


def run_over(scene, turns: float) -> RunState:
    """A run over so many turns of the shaft, extremes kept over its last two periods."""
    duration = 2 * math.pi * turns / scene.shaft.speed
    run = RunState(Model(scene, ACCURACY), duration)
    period = run.period()
    if period:
        run.extrema.windows[1:] = [[duration - period, duration], [duration - 2 * period, duration - period]]
    return run


def growth_rate(scene, turns: float = 200.0, method: str = "adams", accuracy: float = ACCURACY) -> float:
    """Growth rate (1/s) of a small tilt of one floating ring in the time domain: fitted over the last three quarters
    of a run, when all but the least damped mode has died out."""
    small = 1e-2 * scene.film.clearance / scene.film.outer_radius
    start = Initial(rotor=RingStart(tilt_x=small), stator=RingStart(tilt_x=small))
    run = run_over(replace(scene, initial=start), turns)
    at = next(i for i, name in enumerate(run.model.unknowns.names) if name.endswith("tilt_x"))
    run.y0[at] = small
    recorder = Recorder(interval=run.duration / (16 * turns))
    solve(run, method, accuracy, recorder)
    t, q, _ = recorder.arrays()
    late = t > 0.25 * run.duration
    return float(np.polyfit(t[late], np.log(np.hypot(q[late, at], q[late, at + 1])), 1)[0])
