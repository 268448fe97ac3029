"""Stiff squeeze film: flat faces at 1 % of their clearance, where damping is a million times that of the design."""

import math
from dataclasses import replace

from ....analysis.sources.green_1989 import reference_scene
from ....scene.rings import Rotor, Stator
from ....simulation.selection import choose_method
from ....solvers.contract import Counts, Status
from ....solvers.methods import METHODS
from ._common import integrated, row, run_from

ITEM = 2
CLEARANCE, ACCURACY, BUDGET = 1e-5, 1e-6, 20_000


def squeezed():
    """A flat ring on springs of 5 N/um pushed to 1 % of its clearance; 8 s bring it back."""
    scene = reference_scene("FMR")
    flat = replace(scene.film, model="radial", coning=0.0, outer_radius=0.036)
    support = replace(scene.rotor.support, axial_stiffness=5e6, radius=0.036)
    ring = replace(scene.rotor, support=support)
    return run_from(replace(scene, film=flat, rotor=Rotor(**vars(ring)), stator=Stator()), 8.0, ACCURACY,
                   rotor_z=0.99 * CLEARANCE)  # fmt: skip


def meets(scene, run) -> str:
    """Whether the program calls the run stiff."""
    method, why = choose_method(run)
    return why.partition(":")[0] if method == "bdf" else ""


def show() -> list[dict]:
    """Right-hand sides that a second of motion costs: DOP853 given 20 000, BDF to the end."""
    run, counts, reached = squeezed(), Counts(), 0.0
    for t, _, _ in METHODS["dop853"](run.segment(0), 0.0, run.y0, "dop853", ACCURACY, counts):
        reached = t[-1]
        if counts.rhs > BUDGET:
            break
    run = squeezed()
    outcome, _ = integrated(run, "bdf", ACCURACY)
    if outcome.status != Status.OK:
        raise RuntimeError(outcome.message)
    left = math.floor(math.log10(run.duration / reached))
    return [
        row(
            ITEM, "Stiff squeeze film", (f"DOP853 crawls: 1e-{left} of the run done", counts.rhs / reached),
            ("BDF runs to the end", outcome.counts.rhs / run.duration), "right-hand sides per second of motion",
            f'looks at the fastest decay where the run starts and takes "{choose_method(run)[0]}" by itself',
        )
    ]  # fmt: skip
