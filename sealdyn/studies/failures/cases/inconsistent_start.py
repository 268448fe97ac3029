"""Inconsistent start: closed faces, loads no film can carry, rates or pressures that contradict the film's equation."""

from dataclasses import replace

import numpy as np
from scipy.integrate import quad, solve_ivp

from ....analysis.sources.green_1989 import reference_scene
from ....dynamics.model import Model
from ....faces import geometry
from ....films import film_module
from ....films.gas_reynolds import film as gas
from ....scene.film import Film
from ....scene.scene import Closing, SceneError
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
    opening = film_module("radial", film).opening_law(film)
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


def contradicting_pressures() -> dict:
    """A gas film between parallel faces begun with pressures that fall evenly, and with those of its own equation: p^2
    falls with the logarithm of the radius."""
    p_i, p_o, r_i, r_o, clearance = 6e5, 1e5, 0.032, 0.040, 5e-6
    film = Film(model="gas_reynolds", gas="air", temperature=300.0, viscosity=1.8e-5, clearance=clearance,
                inner_radius=r_i, outer_radius=r_o, inner_pressure=p_i, outer_pressure=p_o)  # fmt: skip

    def pressure(r):
        return np.sqrt(p_i**2 + (p_o**2 - p_i**2) * np.log(r / r_i) / np.log(r_o / r_i))

    opening = 2 * np.pi * quad(lambda r: (pressure(r) - p_o) * r, r_i, r_o)[0]
    f, s, off = gas.parameters(film, clearance), np.zeros(geometry.GAP_STATE_SIZE), []
    s[geometry.VISCOSITY], s[geometry.TEMPERATURE] = film.viscosity, film.temperature
    s[geometry.INNER_PRESSURE], s[geometry.OUTER_PRESSURE] = p_i, p_o
    r, angles = gas.grid(f)
    evenly = np.tile(clearance * np.interp(r[1:-1], (r_i, r_o), (p_i, p_o)), len(angles))
    steady = np.empty(len(evenly))
    gas.start(f, s, steady)
    for x in (evenly, steady):
        gas.wrench(f, s, x)
        off.append(abs((s[geometry.FORCE] - p_o * np.pi * (r_o**2 - r_i**2)) / opening - 1))
    return row(
        ITEM, "Pressures that contradict", ("started with pressures that fall evenly", off[0]),
        ("steady pressures of the gap at the start", off[1]), "force of the film at the start, relative",
        "starts a film with unknowns at the steady pressures of the gap as it moves then",
    )  # fmt: skip


def show() -> list[dict]:
    """All four."""
    return [
        closed_start(),
        no_equilibrium(),
        contradicting_rates(),
        contradicting_pressures(),
    ]
