"""Trapped gas: squeezed faster than it can flow out, a gas film is a spring, whatever it is to slow motion.

Between narrow parallel faces at equal pressures p, squeezed at the frequency w, of p A/h

    K + i w D = 1 - tanh z/z,   z = (L/2) sqrt(12 i w mu/(p h^2))

at slow motion no stiffness and a damping of z^2/3, at fast motion p A/h and hardly any damping: what flows does so in a
layer at both edges, of a width L/|z|.
**Source** Langlois (1962), Quart. Appl. Math. 20, 131, for a long strip; derived here.
"""

import math

import numpy as np

from ....dynamics.condensation import FilmDerivatives, LinearFilm
from ....faces.geometry import GAP_STATE_SIZE, INNER_PRESSURE, OUTER_PRESSURE, TEMPERATURE, VISCOSITY
from ....films.gas_reynolds import film as gas
from ....films.gas_reynolds.cells import GRADING
from ....scene.film import Film
from ....scene.gas import GasReynolds, gas_of
from ._common import row

ITEM = 13
PRESSURE, CLEARANCE, MU, INNER, OUTER = 2e5, 5e-6, 1.8e-5, 0.0396, 0.040
# Squeeze numbers 12 w mu L^2/(p h^2) of a whirl in a stiff gas film, and of an edge layer of a twentieth of the width.
FAST, FASTEST, CELLS = 1e3, 2e3, 24


def exact(squeeze_number: float) -> complex:
    """K + i w D over p A/h."""
    z = 0.5 * np.sqrt(1j * squeeze_number)
    return complex(1.0 - np.tanh(z) / z)


def of_the_film(squeeze_number: float, grading: float = GRADING) -> tuple[complex, complex]:
    """The same of the film's cells, at this frequency and with the stiffness and damping of slow motion."""
    film = Film(
        inner_radius=INNER, outer_radius=OUTER, inner_pressure=PRESSURE, outer_pressure=PRESSURE, viscosity=MU,
        gas="air", temperature=300.0, model="gas_reynolds", clearance=CLEARANCE,
        gas_reynolds=GasReynolds(cells=(CELLS, 8)),
    )  # fmt: skip
    f, s = gas.parameters(film, CLEARANCE, grading=grading), np.zeros(GAP_STATE_SIZE)
    s[VISCOSITY], s[TEMPERATURE], s[INNER_PRESSURE], s[OUTER_PRESSURE] = MU, 300.0, PRESSURE, PRESSURE
    unknowns = gas.unknowns(f)
    x = np.empty(len(unknowns.names))
    if gas.start(f, s, x):
        raise RuntimeError("the gas film was not solved")
    step, pace = 1e-2 * CLEARANCE, 1e3
    steps = (step, step / OUTER, step * pace, step * pace / OUTER)
    linear = LinearFilm.about(FilmDerivatives(gas.FILM, unknowns, f), s, x, steps)
    omega = squeeze_number * PRESSURE * CLEARANCE**2 / (12.0 * MU * (OUTER - INNER) ** 2)
    stiff = PRESSURE * math.pi * (OUTER**2 - INNER**2) / CLEARANCE
    both = []
    for frequency in (omega, 0.0):
        k, d = linear.matrices(frequency)
        both.append(complex(k[0, 0], omega * d[0, 0]) / stiff)
    return both[0], both[1]


def meets(scene, run) -> str:
    """A gas film that stores."""
    stores = run.model.unknowns.film_unknowns is not None and gas_of(scene.film) is not None
    return "its film stores gas" if stores else ""


def show() -> list[dict]:
    """Dynamic stiffness by constant coefficients and at its own frequency; with even cells and with narrow ones."""
    right, right_fast = exact(FAST), exact(FASTEST)
    own, slow = of_the_film(FAST)
    graded, even = (of_the_film(FASTEST, grading)[0] for grading in (GRADING, 0.0))

    def off(found, true):
        return abs(found - true) / abs(true)

    return [
        row(
            ITEM, "Trapped gas", (f"K and D of slow motion, at a squeeze number of {FAST:g}", off(slow, right)),
            ("the film at its own frequency", off(own, right)), "dynamic stiffness, relative",
            "keeps the gas of every cell as an unknown; modes and responses meet the film at their own frequency",
        ),
        row(
            ITEM, "Layer at the edge",
            (f"{CELLS} even cells, at a squeeze number of {FASTEST:g}", off(even, right_fast)),
            (f"{CELLS} cells, narrow at the edges", off(graded, right_fast)), "dynamic stiffness, relative",
            "lays narrow cells where fast squeezed gas escapes, and says what half as many cells differ",
        ),
    ]  # fmt: skip
