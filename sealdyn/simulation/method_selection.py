"""The method a run wants, and why."""

import math

import numpy as np

from ..dynamics.intervals import constant_and_slope
from ..faces.geometry import DZ, FLOOR
from ..scene.gas import viscosity_of
from ..scene.scene import SceneError

# Above this ratio of the fastest decay to the fastest motion of interest, an explicit-like method crawls.
STIFF = 60.0


def choose_method(run) -> tuple[str, str]:
    """The method for a run (RunState), by its name in METHODS, and a sentence why."""
    model = run.model
    if hasattr(model.interface.film, "settle"):
        return "trbdf2", "cells that tear and fill: TR-BDF2, the film settled at each stage"
    if model.unknowns.massless:
        return "ida", "a massless ring has no rates: IDA, on the residual form"
    if model.unknowns.has_residual_form:
        return "ida", "the film has unknowns of its own: IDA, on the residual form"
    if model.unknowns.linear and model.unknowns.constant:
        return "expm", "linear film, constant conditions: the exact motion, by matrix exponential"
    ratio = _fastest_decay(run) * model.shortest_period / (2 * math.pi)
    if ratio > STIFF:
        return "bdf", f"fastest decay {float(f'{ratio:.3g}'):g} times the fastest forcing: stiff, CVODE BDF"
    return "adams", f"fastest decay {max(ratio, 0):.2g} times the fastest motion: not stiff, CVODE Adams"


def check_method(model, method: str) -> None:
    """Raises SceneError where a method cannot integrate a scene."""
    unknowns = model.unknowns
    settles = hasattr(model.interface.film, "settle")
    if method == "trbdf2" and not settles:
        raise SceneError("run.solver", '"trbdf2"', "another solver: it is for films whose cells tear and fill")
    if unknowns.has_residual_form and method != "ida" and not (settles and method == "trbdf2"):
        what = "a massless ring" if unknowns.massless else "a film with unknowns of its own"
        raise SceneError("run.solver", f'"{method}" for {what}', '"ida" (or "auto")')
    if method == "expm" and not (unknowns.linear and unknowns.constant):
        what = "a nonlinear film, contact or friction" if not unknowns.linear else "parameters that change with time"
        raise SceneError("run.solver", f'"expm" with {what}', 'film.model = "linear" and constant parameters')


def _fastest_decay(run) -> float:
    """Fastest decay (1/s) of the scene linearised where the run starts (a squeezed film is stiffer by the cube) and at
    the equilibrium of each interval's loads."""
    model, s = run.model, run.segment(0).gap_state(0.0, run.y0)
    varying = (model.scene.shaft.speed, viscosity_of(model.scene.film))
    places = {(max(s[DZ], model.f[FLOOR] - model.clearance),): run.intervals[0]}
    for interval in run.intervals.few:
        places[model.axial_shift(interval), *(constant_and_slope(q, interval)[0] for q in varying)] = interval
    scenes = (model.linear_scene(interval, shift=at[0]) for at, interval in places.items())
    return max(float(np.max(-linear.eigen()[0].real)) for linear in scenes)
