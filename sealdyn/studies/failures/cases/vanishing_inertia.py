"""Vanishing inertia: a lighter ring decays ever faster towards the same motion, and without inertia has no rates."""

from dataclasses import replace

import numpy as np

from ....analysis.sources.green_1989 import reference_scene
from ....scene.rings import Rotor, Stator
from ....solvers.contract import Counts, SolverFailure
from ....solvers.methods import METHODS
from ._common import integrated, row, run_from

ITEM = 6
TURNS, ACCURACY, LIGHT, BUDGET = 2, 1e-6, 1e-7, 60_000


def lightened(share: float):
    """The reference FMS seal under a runout, its stator's mass and inertia a share of what they are."""
    scene = reference_scene("FMS", 0.5, 25e-6, 25e-6)
    ring = vars(scene.stator)
    parts = {name: share * ring[name] for name in ("mass", "transverse_inertia", "polar_inertia")}
    return replace(scene, stator=Stator(**(ring | parts)), rotor=Rotor(runout=25e-6))


def begun(share: float):
    """A run of that scene over some turns."""
    scene = lightened(share)
    return run_from(scene, TURNS * 2 * np.pi / scene.shaft.speed, ACCURACY)


def calls(share: float, method: str, limit: float = np.inf) -> float:
    """Right-hand sides per turn; a run that spends more than `limit` is judged by the turns it made."""
    run, counts, reached = begun(share), Counts(), 0.0
    for t, _, _ in METHODS[method](run.segment(0), 0.0, run.y0, method, ACCURACY, counts):
        reached = t[-1] / run.duration
        if counts.rhs > limit:
            break
    return counts.rhs / (reached * TURNS)


def without_mass() -> tuple[float | None, float]:
    """How far the tilt by CVODE at no inertia, whose rates nobody writes, and by IDA is from that of a ring with next
    to none (BDF); over clearance / outer radius.  None for CVODE if it gives up."""
    end = integrated(begun(LIGHT), "bdf", ACCURACY)[0].y
    massless = begun(0.0)
    x = massless.model.unknowns.names.index("stator_tilt_x")

    def off(y):
        return float(np.hypot(*(y[x : x + 2] - end[x : x + 2]))) * massless.model.face[1] / massless.model.clearance

    by_ida = off(integrated(begun(0.0), "ida", ACCURACY)[0].y)
    try:
        *_, (_, y, _) = METHODS["bdf"](massless.segment(0), 0.0, massless.y0, "bdf", ACCURACY, Counts())
    except SolverFailure:
        return None, by_ida
    return off(y[-1]) if np.isfinite(y[-1]).all() else None, by_ida


def meets(scene, run) -> str:
    """A ring without mass."""
    return "a floating ring without mass or inertia" if run.model.unknowns.massless else ""


def show() -> list[dict]:
    """Adams at a ten-millionth of the inertia, and CVODE at none, beside IDA at none."""
    by_cvode, by_ida = without_mass()
    default = "drops the rates of a ring without inertia and takes IDA on the residual form"
    return [
        row(ITEM, "Vanishing inertia", (f"CVODE Adams, {LIGHT:.0e} of the mass", calls(LIGHT, "adams", BUDGET)),
            ("IDA, no mass at all", calls(0.0, "ida")), "right-hand sides per turn", default),
        row(ITEM, "No inertia", ("CVODE at m = 0 writes no rates: stands still, says done", by_cvode),
            (f"IDA at m = 0 against {LIGHT:.0e} of the mass", by_ida), "tilt, of clearance / radius", default),
    ]  # fmt: skip
