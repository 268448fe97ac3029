"""Gas films and gap states that tests of the gas Reynolds film share."""

import numpy as np

from sealdyn.dynamics.condensation import FilmDerivatives, LinearFilm
from sealdyn.faces import geometry
from sealdyn.films.gas_reynolds import film as gas
from sealdyn.scene.film import Film
from sealdyn.scene.fluid import GasReynolds

MU, TEMPERATURE = 1.8e-5, 300.0
PARTS = [geometry.FORCE, geometry.MOMENT_X, geometry.MOMENT_Y, geometry.FLOW_INNER, geometry.FLOW_OUTER,
         geometry.TORQUE]  # fmt: skip


def gas_film(cells=(12, 48), slip=False, **changes):
    """A face 8 mm wide in air, 6 bar inside."""
    given = dict(
        inner_radius=0.032, outer_radius=0.040, clearance=5e-6, viscosity=MU, gas="air", temperature=TEMPERATURE,
        inner_pressure=6e5, outer_pressure=1e5, model="gas_reynolds",
    )  # fmt: skip
    return Film(gas_reynolds=GasReynolds(slip=slip, cells=cells), **(given | changes))


def gap_state(film, spin=0.0, **slots):
    """Gap state of a film's pressures and gas; `spin` (rad/s) of the rotor, `slots` by their names in lower case."""
    s = np.zeros(geometry.GAP_STATE_SIZE)
    s[geometry.VISCOSITY], s[geometry.TEMPERATURE] = film.viscosity, film.temperature
    s[geometry.INNER_PRESSURE], s[geometry.OUTER_PRESSURE] = film.inner_pressure, film.outer_pressure
    s[geometry.MEAN_SPIN], s[geometry.SPIN_DIFFERENCE] = 0.5 * spin, spin
    for name, value in slots.items():
        s[getattr(geometry, name.upper())] = value
    return s


def steady(f, s):
    """Unknowns of the steady film, its force, moments, flows and torque in `s`."""
    x = np.empty(int(f[gas.CELLS] * f[gas.ANGLES]))
    assert gas.start(f, s, x) == 0
    gas.flow(f, s, x)
    return x


def linear_film(film, s, grading=None):
    """The film about a gap state."""
    f = gas.parameters(film, film.clearance, **({} if grading is None else {"grading": grading}))
    step, pace = 1e-2 * film.clearance, 1e3
    steps = (step, step / film.outer_radius, step * pace, step * pace / film.outer_radius)
    return LinearFilm.about(FilmDerivatives(gas.FILM, gas.unknowns(f), f), s, steady(f, s), steps)
