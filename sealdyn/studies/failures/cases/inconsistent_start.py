"""Inconsistent start: closed faces, loads no film can carry, rates and pressures that contradict the film's
equation."""

from dataclasses import replace

import numpy as np
from scipy.integrate import solve_ivp

from ....analysis.sources.green_1989 import reference_scene
from ....dynamics.model import Model
from ....films import film_named
from ....scene.excitation import Shaft
from ....scene.film import Film
from ....scene.gas import GasReynolds
from ....scene.rings import Stator, Support
from ....scene.scene import Closing, Initial, RingStart, Scene, SceneError
from ....solvers.contract import Recorder, Status
from ....solvers.integrate import solve
from ._common import row, run_from
from .vanishing_inertia import lightened

ITEM = 7
BELOW = -2e-6


def closed_start() -> dict:
    """A start 2 um beyond the other face: a film taken at its mean thickness has no pole there."""
    scene = reference_scene("FMR")
    film, support = replace(scene.film, model="radial"), scene.rotor.support
    wide, width = film.clearance, film.outer_radius - film.inner_radius
    cone, middle = film.coning * width, 0.5 * (film.inner_radius + film.outer_radius)

    def rates(t, y):
        damping = 2 * np.pi * middle * film.viscosity * width**3 / (y[0] + cone / 2) ** 3
        return [y[1], support.axial_stiffness * (wide - y[0]) - damping * y[1]]

    through = solve_ivp(rates, (0.0, 0.01), [BELOW, 0.0], "LSODA", rtol=1e-6, atol=1e-12)
    closed = max(0.0, -float(np.min(through.y[0]))) if through.success else np.nan
    run = run_from(replace(scene, film=film), 0.01, 1e-6, rotor_z=wide - BELOW)
    try:
        run.check_start()
        said, refused = "starts all the same", -BELOW
    except SceneError:
        said, refused = "refused with a sentence, no step taken", 0.0
    return row(
        ITEM, "Start inside the other face", ("film of mean thickness: a success, says LSODA", closed * 1e6),
        (said, refused * 1e6), "overlap of the faces accepted, um",
        "refuses a start below the film's floor and names the key, what was found and what to try",
    )  # fmt: skip


def no_equilibrium() -> dict:
    """Closing force above what the converging film can ever carry: Newton on the clearance goes below zero."""
    scene = reference_scene("FMR")
    film = replace(scene.film, model="radial", clearance=None)
    overloaded = replace(scene, film=film, closing=Closing(balance_ratio=1.3, spring_force=0.0))
    opening = film_named("radial", film).opening_law(film)
    area = np.pi * (film.outer_radius**2 - film.inner_radius**2)
    closing = 1.3 * area * film.outer_pressure

    def excess(c):
        return opening(c, 0.0, film.outer_pressure) - closing

    c = 1e-5
    for _ in range(50):
        step = 1e-3 * c
        moved = c - excess(c) * 2 * step / (excess(c + step) - excess(c - step))
        if not moved > 0:
            break
        c = moved
    try:
        Model(overloaded)
        said, left = "assembled all the same", abs(excess(c)) / closing
    except SceneError:
        said, left = "refused with a sentence", 0.0
    return row(
        ITEM, "Loads without an equilibrium", (f"Newton leaves the film at {c * 1e6:.2g} um", abs(excess(c)) / closing),
        (said, left), "force left unbalanced, of the closing force",
        "searches every clearance from a thousandth to a thousand times the coning and says what could be carried",
    )  # fmt: skip


def contradicting_rates() -> dict:
    """A massless ring begun with rates of zero, and with the rates that its film's equation asks for."""
    run = run_from(lightened(0.0), 0.01, 1e-6)
    segment, sizes = run.segment(0), []
    left = np.empty(segment.size)
    for yp in (np.zeros(segment.size), segment.start(0.0, run.y0)[1]):
        segment.residual(0.0, run.y0, yp, left)
        sizes.append(float(np.max(np.abs(left[: segment.n]))))
    return row(
        ITEM, "Rates at the start of a DAE", ("started with rates of zero", sizes[0]),
        ("rates from the balance itself", sizes[1]), "unbalanced, N and N m",
        "solves the residual for the rates before IDA takes its first step",
    )  # fmt: skip


def unsettled_pressures() -> dict:
    """A gas film that stores, begun with the low pressure everywhere, and with the pressures of its steady flow."""
    film = Film(
        inner_radius=0.032, outer_radius=0.040, inner_pressure=1e5, outer_pressure=6e5, clearance=5e-6, coning=2e-4,
        gas="air", temperature=300.0, model="gas_reynolds", gas_reynolds=GasReynolds(cells=(8, 8)),
    )  # fmt: skip
    ring = dict(mass=0.3, transverse_inertia=3e-4, polar_inertia=5e-4)
    support = Support(axial_stiffness=5e4, axial_damping=100.0, radius=0.04)
    scene = Scene(
        shaft=Shaft(speed=1000.0), film=film, stator=Stator(**ring, support=support), initial=Initial(RingStart(z=0.0))
    )
    moved = []
    for settled in (False, True):
        run = run_from(scene, 2e-3, 1e-6)
        if not settled:
            # Products of pressure and film.
            run.y0[run.model.unknowns.film] = film.inner_pressure * film.clearance
        # A run that goes on settles nothing.
        recorder, resume = Recorder(1e-5), None if settled else (0, 0.0, run.y0)
        outcome = solve(run, "ida", 1e-6, recorder, resume=resume)
        at = run.model.unknowns.names.index("stator_z")
        far = float(np.max(np.abs(recorder.arrays()[1][:, at]))) / film.clearance
        moved.append(1.0 if outcome.status == Status.COLLAPSED else far)
    return row(
        ITEM, "Pressures that contradict", ("begun with the low pressure everywhere: the faces close", moved[0]),
        ("pressures of the steady flow, by Newton", moved[1]), "motion of a ring at rest, of the clearance",
        "solves for the steady film at the gap of the start before the first step",
    )  # fmt: skip


def meets(scene, run) -> str:
    """A start that film and loads need not agree with."""
    if not run.model.loads_are_balanced(run.model.start):
        return "no clearance at which the film holds its loads"
    if run.model.unknowns.film_unknowns is not None:
        return "its film has pressures of its own to begin with"
    if run.model.unknowns.massless:
        return "a ring without mass has rates that follow from its position"
    return "[initial] gives a start of its own" if scene.initial.given else ""


def show() -> list[dict]:
    """All four."""
    return [closed_start(), no_equilibrium(), contradicting_rates(), unsettled_pressures()]
