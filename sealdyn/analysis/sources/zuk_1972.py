"""Zuk (1972), the sealing dam at cruise: leakage, force, its centre and exit Mach number against the gas dam's film.

The film's numbers must be those of an independent computation (closed_form/zuk_1972.py), by which the print is judged.
The printed forces and centres of the tilted rows have an error of the source: the tilt counted twice in the pressure.
That is computed too, and must give the print back.  Of five rows (parallel 0.5 mil, tilted 0.3 and 0.5 mil) the print
is held in part: what is left out is their leakage, forces, and centres but one.
"""

import math

import numpy as np

from ...closed_form.zuk_1972 import CRUISE, MIL, POUND, POUND_FORCE, ZUK_1972, ZUK_1972_IN_PART
from ...faces.geometry import (
    FLOW_OUTER,
    FORCE,
    GAP_STATE_SIZE,
    INNER_PRESSURE,
    OUTER_PRESSURE,
    TEMPERATURE,
    VISCOSITY,
)
from ...films import _gas_dam as sector
from ...films.gas_dam import film as gas_dam
from ...scene.film import Film
from ...scene.fluid import Gas, GasDam, viscosity_of

TITLE = "Zuk (1972), NASA TM X-68022, sealing dam at cruise; gas_dam, laminar, width constant (parallel) or zuk"
FILM = "gas_dam"
COVERS = "leakage, force, its centre and exit Mach number of a sealing dam"
COLUMNS = {"tilt, mrad": "tilt", "film, mil": "mean_film", "quantity": "quantity", "published": "published",
           "gas_dam": "computed", "independent": "independent", "tilt twice": "tilt_counted_twice",
           "deviation": "deviation", "verdict": "verdict"}  # fmt: skip
DIGITS = 4

SOURCE = "Zuk (1972), sealing dam at cruise"
# Relative: the film against the print, and against the independent computation in its four digits.
TOLERANCE = 5e-3
ROADS_TOLERANCE = {"force": 1e-3, "centre_of_pressure": 1e-3, "exit_mach": 5e-3}
# Half a unit of the last printed digit of Mach numbers.
MACH_ROUNDING = 5e-3
# Quantities in words and with their units of the source, in which the table is.
UNITS = {"leakage": ("leakage, lb/min", POUND / 60), "force": ("force, lb", POUND_FORCE),
         "centre_of_pressure": ("centre of pressure, %", 0.01), "exit_mach": ("exit Mach number", 1.0)}  # fmt: skip

WIDTH, MEAN_RADIUS = CRUISE.outer_radius - CRUISE.inner_radius, 0.5 * (CRUISE.inner_radius + CRUISE.outer_radius)
LARGEST_FORCE = 2 * math.pi * MEAN_RADIUS * WIDTH * (CRUISE.high_pressure - CRUISE.low_pressure)
# How often the source counts the tilt in the pressure.
TIMES = 2
TILT_COUNTED_TWICE = (
    "the print has the tilt counted twice in the pressure, P h/(h1 + 2 tilt x) for P, which gives it back within "
    f"{100 * TOLERANCE:g} %; full pressure on the whole dam would be {LARGEST_FORCE / POUND_FORCE:.1f} lb"
)
NOT_PRINTED = "no printed number held: gas_dam against an independent computation"
UNEXPLAINED = "the number of two independent computations is not the printed one, and no error of the source is known"


def checks() -> list[dict]:
    """Up to four quantities of each row: besides what every source has tilt, mean_film (m), computed (by the film
    gas_dam), independent (another computation, rounded; None of the leakage) and tilt_counted_twice (what is computed
    with the source's error; None where that changes nothing); leakage in kg/s, force in N over ambient pressure, centre
    as a share of the width from the edge with the high pressure."""
    return [
        _row(entry, quantity, *values)
        for entry in (*ZUK_1972, *ZUK_1972_IN_PART)
        for quantity, values in _quantities(entry).items()
        if any(value is not None for value in (values[0], values[2]))
    ]


def film_table(entry) -> Film:
    """The dam of a row as a film of the program: the tilt is a coning."""
    factor, s = CRUISE.sutherland
    reference = 273.15
    air = Gas(CRUISE.gas_constant, CRUISE.heat_ratio, factor * reference**1.5 / (reference + s), reference, s)
    return Film(
        model="gas_dam",
        gas=air,
        temperature=CRUISE.temperature,
        inner_radius=CRUISE.inner_radius,
        outer_radius=CRUISE.outer_radius,
        clearance=entry.mean_film - entry.tilt * WIDTH / 2,
        coning=entry.tilt,
        inner_pressure=CRUISE.high_pressure,
        outer_pressure=CRUISE.low_pressure,
        gas_dam=GasDam(friction="laminar", width="zuk" if entry.tilt else "constant"),
    )


def _quantities(entry) -> dict[str, tuple]:
    """Published, computed, independent and tilt counted twice of each quantity."""
    film = film_table(entry)
    f, s = gas_dam.parameters(film, film.clearance), np.zeros(GAP_STATE_SIZE)
    s[INNER_PRESSURE], s[OUTER_PRESSURE] = CRUISE.high_pressure, CRUISE.low_pressure
    s[TEMPERATURE], s[VISCOSITY] = CRUISE.temperature, viscosity_of(film)
    gas_dam.flow(f, s)
    face = math.pi * (CRUISE.outer_radius**2 - CRUISE.inner_radius**2)
    leakage, force = s[FLOW_OUTER] * f[gas_dam.DENSITY], s[FORCE] - CRUISE.low_pressure * face
    centre, twice = _across(entry, f)
    forces = entry.force, force, entry.corrected_force, twice[0]
    centres = entry.centre, centre, entry.corrected_centre, twice[1]
    mach = gas_dam.exit_mach(f, s)[1]
    return {
        "leakage": (entry.leakage, leakage, None, None),
        "force": forces,
        "centre_of_pressure": centres,
        "exit_mach": (entry.printed_exit_mach, mach, entry.exit_mach, None),
    }


def _across(entry, f):
    """Centre of pressure, and force (N) and centre with the tilt counted twice (None without tilt), by Gauss points
    across the dam."""
    h_1, h_2 = (entry.mean_film + side * entry.tilt * WIDTH / 2 for side in (-1, 1))
    g, out = f[gas_dam.DAM : gas_dam.DAM + sector.BLOCK_SIZE].copy(), np.empty(sector.DAM_SIZE)
    g[sector.TEMPERATURE] = CRUISE.temperature
    sector.dam(g, h_1, h_2, CRUISE.high_pressure, CRUISE.low_pressure, out)
    centre = 0.5 + out[sector.MOMENT] / (out[sector.FORCE] * WIDTH)
    if entry.tilt == 0.0:
        return centre, (None, None)
    points, weights = np.polynomial.legendre.leggauss(64)
    x, weights = WIDTH * (1 + points) / 2, WIDTH * weights / 2
    r_1, r_2 = CRUISE.inner_radius, CRUISE.outer_radius
    pressure = np.array([sector.pressure_inside(g, out, h_2, h_1, r_2, r_1, r_1 + at) for at in x])
    gauge = pressure * (h_1 + entry.tilt * x) / (h_1 + TIMES * entry.tilt * x) - CRUISE.low_pressure
    force = weights @ gauge
    return centre, (2 * math.pi * MEAN_RADIUS * force, weights @ (gauge * x) / (force * WIDTH))


def _row(entry, quantity, published, computed, independent, twice) -> dict:
    row = {
        "source": SOURCE,
        "tilt": entry.tilt,
        "mean_film": entry.mean_film,
        "quantity": quantity,
        "published": published,
        "computed": float(computed),
        "independent": independent,
        "tilt_counted_twice": None if twice is None else float(twice),
        "deviation": None if published is None else float(computed / published - 1),
        "roads_apart": None if independent is None else abs(float(computed / independent - 1)),
    }
    return row | dict(zip(("verdict", "remark"), _verdict(row), strict=True))


def _verdict(row) -> tuple[str, str]:
    """Verdict and remark of a row."""
    published, twice, apart = row["published"], row["tilt_counted_twice"], row["roads_apart"]
    if apart is not None and not apart <= ROADS_TOLERANCE[row["quantity"]]:
        return "FAILED", "gas_dam and the independent computation disagree"
    if published is None:
        return "agrees", NOT_PRINTED
    if abs(row["deviation"]) <= TOLERANCE:
        return "agrees", ""
    if row["quantity"] == "exit_mach" and abs(row["computed"] - published) <= MACH_ROUNDING:
        return "rounding", "printed with two decimals"
    if twice is not None and abs(twice / published - 1) <= TOLERANCE:
        return "print differs", TILT_COUNTED_TWICE
    if apart is not None and row["tilt"] == 0.0:
        return "unexplained", UNEXPLAINED
    return "FAILED", "not the printed number, and no known error of the source"


def shown(row: dict) -> dict:
    """A row in the units of the source."""
    words, size = UNITS[row["quantity"]]
    numbers = ("published", "computed", "independent", "tilt_counted_twice")
    seen = {
        "quantity": words,
        "tilt": f"{1e3 * row['tilt']:+g}" if row["tilt"] else "0",
        "mean_film": row["mean_film"] / MIL,
    }
    return row | seen | {name: row[name] / size for name in numbers if row[name] is not None}


def place(row: dict) -> str:
    """Which line a remark speaks of."""
    seen = shown(row)
    return f"{seen['tilt']} mrad {seen['mean_film']:.1f} mil {seen['quantity'].split(',')[0]}"
