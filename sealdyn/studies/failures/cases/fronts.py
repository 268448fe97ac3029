"""Fronts: where a film begins to cavitate its force has a kink that an even grid around the circle never resolves."""

import math
from dataclasses import replace

import numpy as np

from ....analysis.sources.green_1989 import reference_scene
from ....faces.geometry import FORCE, GAP_STATE_SIZE, GY, MEAN_SPIN, VISCOSITY
from ....films._radial_quadrature import RADIAL_POINTS, RULE_SIZE, RULES
from ....films.radial import floored as radial
from ....films.radial.cavitated_line import cavitated_line
from ._common import not_available, row

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


def show() -> list[dict]:
    """Error of the film force; the reference is the trapezoid of 200 000 angles, extrapolated."""
    coarse, fine = by_trapezoid(2**16), by_trapezoid(2**17)
    exact = fine + (fine - coarse) / 3
    return [
        row(
            ITEM, "Cavitation front", (f"trapezoid of {ANGLES} angles", abs(by_trapezoid(ANGLES) / exact - 1)),
            ("circle split at the fronts", abs(by_splitting(1e-10) / exact - 1)), "relative error of the film force",
            "finds the angles where a line begins to be dry and integrates between them",
        ),
        not_available(ITEM, "Choking", "a choked sector comes with a gas film (not there yet)"),
    ]  # fmt: skip
