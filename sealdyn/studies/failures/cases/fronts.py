"""Fronts: where a film begins to cavitate its force has a kink that an even grid around the circle never resolves;
where it begins to choke, a jump of its second derivative."""

import math
from dataclasses import replace

import numpy as np

from ....analysis.sources.green_1989 import reference_scene
from ....closed_form.zuk_1972 import MIL
from ....faces.geometry import (
    FORCE,
    GAP_STATE_SIZE,
    GY,
    INNER_PRESSURE,
    MEAN_SPIN,
    MOMENT_Y,
    OUTER_PRESSURE,
    TEMPERATURE,
    VISCOSITY,
)
from ....films import _gas_dam as sector
from ....films._radial_quadrature import RADIAL_POINTS, RULE_SIZE, RULES
from ....films.gas_dam import film as gas_dam
from ....films.radial import floored as radial
from ....films.radial.cavitated_line import cavitated_line
from ....scene.gas import viscosity_of
from ._common import cruise_dam, row

ITEM = 8
ANGLES = 256


def tilted_film(error: float):
    """Block and gap state of flat faces without a pressure drop, tilted and turning: one half runs dry."""
    film = replace(reference_scene("FMR").film, model="radial", coning=0.0, outer_pressure=0.0, cavitation_pressure=0.0)
    s = np.zeros(GAP_STATE_SIZE)
    s[VISCOSITY], s[MEAN_SPIN], s[GY] = film.viscosity, 500.0, 0.6 * film.clearance / film.outer_radius
    # The ring also sinks, so that the front lies at no angle that a grid would have.
    s[3] = -1e-4
    return film, radial.parameters(film, film.clearance, error), s


def by_trapezoid(angles: int) -> float:
    """Force (N) with the floored lines of so many evenly spaced angles."""
    film, f, s = tilted_film(1e-10)
    rule = RULES + RULE_SIZE * (len(RADIAL_POINTS) - 1)
    x, w = f[rule + 2 : rule + 2 + RADIAL_POINTS[-1]], f[rule + 2 + RADIAL_POINTS[-1] : rule + RULE_SIZE]
    total = 0.0
    for theta in (np.arange(angles) + 0.37) * 2 * math.pi / angles:
        h_i, h_o = (film.clearance - r * s[GY] * math.cos(theta) for r in (film.inner_radius, film.outer_radius))
        rate = s[MEAN_SPIN] * s[GY] * math.sin(theta)
        total += cavitated_line(x, w, film.inner_radius, film.outer_radius, h_i, h_o, s[3], rate, False, False,
                              s[VISCOSITY], 0.0, 0.0, 0.0, 0.0)[0]  # fmt: skip
    return total * 2 * math.pi / angles


def by_splitting(error: float) -> float:
    """Force (N) of the package's film at an accuracy."""
    _, f, s = tilted_film(error)
    radial.wrench(f, s)
    return s[FORCE]


def cavitation() -> dict:
    """Error of the film force; the reference is the trapezoid of 200 000 angles, extrapolated."""
    coarse, fine = by_trapezoid(2**16), by_trapezoid(2**17)
    exact = fine + (fine - coarse) / 3
    return row(
        ITEM, "Cavitation front", (f"trapezoid of {ANGLES} angles", abs(by_trapezoid(ANGLES) / exact - 1)),
        ("circle split at the fronts", abs(by_splitting(1e-10) / exact - 1)), "relative error of the film force",
        "finds the angles where a line begins to be dry and integrates between them",
    )  # fmt: skip


# --- choking ------------------------------------------------------------------------------------------


def tilted_dam():
    """Block and gap state of Zuk's parallel dam at cruise, 0.22 mil and tilted by a fifth of that: choked on the wide
    side only."""
    film = cruise_dam(clearance=0.22 * MIL)
    s = np.zeros(GAP_STATE_SIZE)
    s[INNER_PRESSURE], s[OUTER_PRESSURE] = film.inner_pressure, film.outer_pressure
    s[TEMPERATURE], s[VISCOSITY], s[GY] = film.temperature, viscosity_of(film), 0.2 * film.clearance / film.outer_radius
    return film, gas_dam.parameters(film, film.clearance, 1e-8), s


def moment_of_sectors(count: int) -> float:
    """Moment (N m) about the tilt axis of so many evenly spaced sectors."""
    film, f, s = tilted_dam()
    g, out = f[gas_dam.DAM : gas_dam.DAM + sector.BLOCK_SIZE].copy(), np.empty(sector.DAM_SIZE)
    g[sector.TEMPERATURE] = film.temperature
    middle, total = 0.5 * (film.inner_radius + film.outer_radius), 0.0
    for cos in np.cos(np.arange(count) * 2 * math.pi / count):
        films = (film.clearance - r * s[GY] * cos for r in (film.inner_radius, film.outer_radius))
        sector.dam(g, *films, film.inner_pressure, film.outer_pressure, out)
        total -= (middle * out[sector.FORCE] + out[sector.MOMENT]) * cos
    return total * 2 * math.pi * middle / count


def choking() -> dict:
    """Error of the film's moment; the reference has 8192 sectors, where the error falls with their cube."""
    _, f, s = tilted_dam()
    gas_dam.wrench(f, s)
    exact, few = moment_of_sectors(2**13), gas_dam.sectors_for(f, s)
    return row(
        ITEM, "Choking", (f"{few} sectors, enough for 1e-8 without choking", abs(moment_of_sectors(few) / exact - 1)),
        ("more of them where some are choked", abs(s[MOMENT_Y] / exact - 1)), "relative error of the film moment",
        "asks the thinnest and the thickest place first and takes more sectors if one of them is choked",
    )  # fmt: skip


def meets(scene, run) -> str:
    """A film with a floor of its pressure, or a dam that chokes on a part of the circle."""
    film = run.model.interface.film
    if film.exit_mach is not None:
        low, high = film.exit_mach(run.model.f, run.segment(0).gap_state(0.0, run.y0))
        return "its gas is as fast as sound on a part of the circle" if low < 1.0 <= high else ""
    floored = scene.film.cavitation_pressure is not None and run.model.unknowns.film_unknowns is None
    return "film.cavitation_pressure: where the film tears its force has a kink" if floored else ""


def show() -> list[dict]:
    """Both fronts."""
    return [cavitation(), choking()]
