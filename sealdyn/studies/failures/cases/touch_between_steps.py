"""Touch: a gap that closes for four degrees of each turn, between the steps of a solver that has no reason to look."""

import math
from dataclasses import replace

import numpy as np
from sksundae.cvode import CVODE

from ....analysis.sources.green_1989 import reference_scene
from ....scene.contact import Contact, contact_thresholds
from ....scene.rings import AxialRunout, Rotor
from ._common import ZERO_FILM, integrated, row, run_from

ITEM = 3
TURNS, TOLERANCE, HALF = 300, 1e-4, math.radians(2)
SOFT = Contact(roughness=1e-7, compressive_strength=1e-6)


def bare_root_search(scene) -> int:
    """Dips, of 300, in which CVODE's own root search (Adams, 1e-4) sees a change of sign, its unknowns the tilt of the
    scene's stator under a rotor that runs out."""
    speed, support, inertia = scene.shaft.speed, scene.stator.support, scene.stator.transverse_inertia
    stiffness, damping = support.tilt()
    scale = scene.film.clearance / scene.film.outer_radius

    def stator(t, y, yp):
        g, v, runout = complex(y[0], y[1]), complex(y[2], y[3]), 0.1 * scale * np.exp(1j * speed * t)
        a = -(damping * v + stiffness * (g - runout)) / inertia
        yp[0], yp[1], yp[2], yp[3] = v.real, v.imag, a.real, a.imag

    def gap(t, y, events):
        events[0] = math.cos(HALF) + math.cos(speed * t)

    gap.terminal, gap.direction = [False], [0]
    absolute = TOLERANCE * np.array([scale, scale, scale * speed, scale * speed])
    solver = CVODE(stator, method="Adams", rtol=TOLERANCE, atol=absolute, max_num_steps=10**7, eventsfn=gap,
                   num_events=1)  # fmt: skip
    turn = 2 * math.pi / speed
    found = solver.solve(np.array([0.0, TURNS * turn]), np.zeros(4))
    return len(set(np.floor(np.atleast_1d(found.t_events) / turn).astype(int))) if found.t_events is not None else 0


def by_the_watch(scene) -> int:
    """Contacts that the package locates in the same 300 turns at the same accuracy."""
    depth = (scene.film.clearance - contact_thresholds(SOFT)[1]) / math.cos(HALF)
    dipping = replace(
        scene,
        film=replace(scene.film, model="linear", coefficients=ZERO_FILM),
        rotor=Rotor(axial_runout=[AxialRunout(order=1, amplitude=depth, phase=math.pi / 3)]),
        contact=SOFT,
    )
    run, events = run_from(dipping, TURNS * 2 * math.pi / scene.shaft.speed, TOLERANCE), []
    outcome, _ = integrated(run, "adams", TOLERANCE)
    run.contacts.tell(events.extend, end=(outcome.tau, outcome.y))
    return len(events)


def meets(scene, run) -> str:
    """A scene with asperities."""
    return "[contact]: its faces may touch between two steps" if run.model.contact is not None else ""


def show() -> list[dict]:
    """Dips missed by CVODE's root search and by the search on every step's own polynomial."""
    scene = reference_scene("FMS")
    return [
        row(
            ITEM, "Touch between steps", ("CVODE Adams' root search, 1e-4", TURNS - bare_root_search(scene)),
            ("gap searched on each step's polynomial", TURNS - by_the_watch(scene)), f"dips missed of {TURNS}",
            "bounds the gap over every step from its two ends and searches wherever it may close",
        )
    ]  # fmt: skip
