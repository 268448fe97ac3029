"""What gas films cost.

    python tests/benchmark/gas_cost.py

One sector of a gas dam (microseconds a solve; constant width in one piece, others in 4), over random films at cruise
(closed_form/zuk_1972.py), from within one compiled loop; a whole dam of 64 sectors; both against an empty loop of the
same calls.
"""

import time

import numpy as np
from numba import njit

from sealdyn.closed_form.zuk_1972 import CRUISE, MIL
from sealdyn.faces import geometry
from sealdyn.films import _gas_dam as sector
from sealdyn.films.gas_dam import film as gas_dam
from sealdyn.scene.film import Film
from sealdyn.scene.fluid import GasDam

COUNT, TIMES = 20_000, 5


@njit
def solves(f, films, high, low, out):
    """Solve them all; how many had a flow."""
    found = 0
    for k in range(len(films)):
        found += sector.dam(f, films[k, 0], films[k, 1], high, low, out) == sector.SOLVED
    return found


def best(function):
    """Least time (s) of some tries."""
    spent = []
    for _ in range(TIMES + 1):
        begun = time.perf_counter()
        function()
        spent.append(time.perf_counter() - begun)
    return min(spent[1:])


def sectors():
    random = np.random.default_rng(1)
    mean, ratio = MIL * np.exp(random.uniform(np.log(0.06), 0.0, COUNT)), random.uniform(-0.9, 0.9, COUNT)
    films, out = np.column_stack([mean * (1 - ratio), mean * (1 + ratio)]), np.empty(sector.DAM_SIZE)
    for width in ("constant", "zuk", "radial"):
        for friction in ("laminar", "blend"):
            f = sector.parameters(
                CRUISE.inner_radius, CRUISE.outer_radius, CRUISE.temperature, gas_constant=CRUISE.gas_constant,
                heat_ratio=CRUISE.heat_ratio, sutherland=CRUISE.sutherland, friction=friction, width=width,
            )  # fmt: skip
            spent = best(lambda f=f: solves(f, films, CRUISE.high_pressure, CRUISE.low_pressure, out))
            print(f"a sector, width {width}, friction {friction}: {1e6 * spent / COUNT:.2f} us")


def whole():
    """Tilted so that the rule takes 64 sectors or so: half as many, and one more, are solved, since it is even."""
    for width in ("constant", "zuk", "radial"):
        film = Film(
            model="gas_dam", gas="air", temperature=CRUISE.temperature, inner_radius=CRUISE.inner_radius,
            outer_radius=CRUISE.outer_radius, inner_pressure=CRUISE.high_pressure, coning=-2e-3,
            outer_pressure=CRUISE.low_pressure, clearance=0.25 * MIL, gas_dam=GasDam(width=width),
        )  # fmt: skip
        f, s = gas_dam.parameters(film, film.clearance, 1e-8), np.zeros(geometry.GAP_STATE_SIZE)
        s[geometry.INNER_PRESSURE], s[geometry.OUTER_PRESSURE] = CRUISE.high_pressure, CRUISE.low_pressure
        s[geometry.TEMPERATURE], s[geometry.GX] = CRUISE.temperature, 4.33e-5
        count = gas_dam.sectors_for(f, s)
        spent = best(lambda f=f, s=s: [gas_dam.wrench(f, s) for _ in range(200)]) / 200
        print(f"a dam of {count} sectors, width {width}: {1e3 * spent:.3f} ms")


if __name__ == "__main__":
    sectors()
    whole()
