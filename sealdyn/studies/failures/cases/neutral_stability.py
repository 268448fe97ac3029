"""Neutral stability: at the critical speed a whirl neither grows nor decays; what a method makes of it is its own."""

import math

import numpy as np

from ....analysis.sources.green_1989 import reference_scene
from ....analysis.whirl import RotatingWave, contact_tilt_aligned, free_model, least_damped
from ....dynamics.run_state import RunState
from ....simulation.stability import critical_speed
from ....solvers.contract import Counts
from ....solvers.fixed_step import REFERENCE_METHODS
from ._common import row

ITEM = 1
# Growth in a turn of the whirl that a method may hide.
SLOW = 0.05
# Whirl followed, over the tilt that closes the gap; turns of it; a solver tolerance as a user might set it.
AMPLITUDE, TURNS, BARE = 0.1, 60, 1e-5


def threshold(scene) -> float | None:
    """Speed (rad/s) where the eigenvalues of the unforced scene cross the axis; None if nowhere."""
    return critical_speed(free_model(scene, 1.0))


def neutral_run(scene, speed: float, turns: float, accuracy: float = 1e-8):
    """The unforced run at its threshold, starting on its neutral circle, and what reads the whirl."""
    model = free_model(scene, speed, accuracy)
    run, whirling = RunState(model, turns * 2 * math.pi / speed), RotatingWave(model)
    frequency, shape = least_damped(model, speed)
    run.y0 = whirling.state(AMPLITUDE * contact_tilt_aligned(model) * shape, frequency)
    return run, whirling


def growth(run, whirling, method: str, tolerance: float, most: float = math.inf) -> tuple[float, int]:
    """Growth rate (1/s) that a method at a bare solver tolerance gives the neutral whirl, over the last three
    quarters of the run, less the eigenvalue's; and right-hand sides spent.  Raises SolverFailure, or TimeoutError
    beyond `most` right-hand sides."""
    counts, steps = Counts(), []
    for t, y, _ in REFERENCE_METHODS[method](run.segment(0), 0.0, run.y0, method, tolerance, counts):
        steps.append((t, np.abs(whirling.relative(y[:, : run.model.unknowns.n].T))))
        if counts.rhs > most:
            raise TimeoutError(f"more than {most:.3g} right-hand sides")
    t, size = (np.concatenate([step[k] for step in steps]) for k in range(2))
    late = t > 0.25 * t[-1]
    exact = max(mode.value.real for mode in run.model.linear_scene().modes() if mode.kind == "tilt")
    return float(np.polyfit(t[late] - t[-1], np.log(size[late]), 1)[0]) - exact, counts.rhs


def meets(scene, run) -> str:
    """A whirl that hardly grows or decays."""
    whirls = [mode.value for mode in run.model.linear_scene().modes() if mode.value.imag]
    slowest = min(whirls, key=lambda value: abs(value.real / value.imag), default=1.0 + 1.0j)
    share = math.expm1(2 * math.pi * slowest.real / abs(slowest.imag))
    return f"a whirl that grows or decays by {100 * abs(share):.1g} % a turn of its own" if abs(share) < SLOW else ""


def show() -> list[dict]:
    """BDF at a bare tolerance of 1e-5 damps, Adams errs too; the matrix exponential keeps the circle."""
    scene = reference_scene("FMR", 3.0)
    speed = threshold(scene)
    run, whirling = neutral_run(scene, speed, TURNS)
    turn = 2 * math.pi / speed
    rates = {m: growth(run, whirling, m, BARE)[0] * turn for m in ("bdf", "adams", "expm")}

    def named(method, words):
        return f"{words} {'pumps' if rates[method] > 0 else 'damps'}", abs(rates[method])

    kept = "matrix exponential keeps the circle", abs(rates["expm"])
    default = "tightens the accuracy until the method's own damping cannot decide, and asks the eigenvalues as well"
    words = "growth per turn"
    return [
        row(ITEM, "Neutral stability: BDF", named("bdf", "BDF, tolerance 1e-5,"), kept, words, default),
        row(ITEM, "Neutral stability: Adams", named("adams", "Adams, tolerance 1e-5,"), kept, words, default),
    ]
