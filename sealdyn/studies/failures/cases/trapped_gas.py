"""Trapped gas: squeezed fast, a film of gas has no time to escape; its stiffness tends to the integral of p dA/h and
its damping vanishes, which coefficients at rest say nothing of.

Parallel faces that are narrow, with equal pressures p at both edges, as a squeeze number s = 12 mu omega L^2/(p h^2):

    K + i omega D = (p A/h) (1 - tanh z/z),   z = (L/2) sqrt(12 i omega mu/(p h^2)) = sqrt(i s)/2

At rest K = 0 and D = (p A/h) s/(12 omega).  What escapes at large s does so through a layer of width L/sqrt(s) at each
edge.
**Source** Langlois (1962), Quart. Appl. Math. 20, 131, for a long strip.
"""

import cmath
import math

import numpy as np

from ....dynamics.condensation import LinearFilm
from ....dynamics.film_derivatives import FilmDerivatives
from ....faces import geometry
from ....films.gas_reynolds import film as gas
from ....scene.film import Film
from ....scene.gas import GasReynolds
from ._common import row

ITEM = 14
VISCOSITY, PRESSURE, CLEARANCE = 1.8e-5, 2e5, 5e-6
INNER, OUTER = 0.0396, 0.04
# Squeeze numbers: damping has gone, and the gas is trapped to a hundredth.
FAST, TRAPPED = 1e3, 2e4
CELLS, EVEN = 48, 0.0


def pace(number: float) -> float:
    """Angular frequency (rad/s) of a squeeze number."""
    return number * PRESSURE * CLEARANCE**2 / (12 * VISCOSITY * (OUTER - INNER) ** 2)


def exact(number: float) -> complex:
    """K + i omega D over p A/h."""
    z = 0.5 * cmath.sqrt(1j * number)
    return 1 - cmath.tanh(z) / z


def linear_film(grading: float | None = None) -> LinearFilm:
    """The program's film about these faces; `grading` as in films/gas_reynolds/cells.py."""
    film = Film(
        model="gas_reynolds", gas="air", temperature=300.0, viscosity=VISCOSITY, clearance=CLEARANCE,
        inner_radius=INNER, outer_radius=OUTER, inner_pressure=PRESSURE, outer_pressure=PRESSURE,
        gas_reynolds=GasReynolds(cells=(CELLS, 8)),
    )  # fmt: skip
    f = gas.parameters(film, CLEARANCE, **({} if grading is None else {"grading": grading}))
    s, x = np.zeros(geometry.GAP_STATE_SIZE), np.empty(int(f[gas.CELLS] * f[gas.ANGLES]))
    s[geometry.VISCOSITY], s[geometry.TEMPERATURE] = VISCOSITY, film.temperature
    s[geometry.INNER_PRESSURE] = s[geometry.OUTER_PRESSURE] = PRESSURE
    if gas.start(f, s, x):
        raise RuntimeError("the gas film was not solved")
    step = 1e-2 * CLEARANCE
    steps = (step, step / OUTER, 1e3 * step, 1e3 * step / OUTER)
    return LinearFilm(FilmDerivatives(gas, gas.unknowns(f), f), s, x, steps)


def off(film: LinearFilm, number: float, at: float | None = None) -> float:
    """Error of K + i omega D at a squeeze number, relative, of a film taken at the frequency `at` (rad/s; default that
    of the squeeze number)."""
    omega, stiff = pace(number), PRESSURE * math.pi * (OUTER**2 - INNER**2) / CLEARANCE
    k, d = film.matrices(omega if at is None else at)
    return abs((k[0, 0] + 1j * omega * d[0, 0]) / stiff / exact(number) - 1)


def show() -> list[dict]:
    """Coefficients at rest where the gas is squeezed fast, and even cells where it is trapped."""
    film = linear_film()
    return [
        row(
            ITEM, "Trapped gas", (f"stiffness and damping at rest, squeeze number {FAST:g}", off(film, FAST, 0.0)),
            ("both at the frequency itself", off(film, FAST)), "K + i omega D, relative",
            "meets every mode and response of a film that stores at its own frequency",
        ),
        row(
            ITEM, "Layer at the edges",
            (f"{CELLS} even cells, squeeze number {TRAPPED:g}", off(linear_film(EVEN), TRAPPED)),
            (f"{CELLS} cells, narrower at the edges", off(film, TRAPPED)), "K + i omega D, relative",
            "makes the cells of a gas film narrower at the edges of the face",
        ),
    ]  # fmt: skip
