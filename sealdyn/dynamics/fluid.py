"""The state of the fluid: what of the `[film]` table goes into which slots of a gap state."""

from ..faces.geometry import INNER_PRESSURE, OUTER_PRESSURE, TEMPERATURE, VISCOSITY
from ..scene.gas import viscosity_of


def fluid_conditions(film) -> dict:
    """Slots of the gap state and what they hold of a `Film` table, each a number or a function of time, SI; temperature
    0 of a liquid."""
    return {
        VISCOSITY: viscosity_of(film),
        INNER_PRESSURE: film.inner_pressure,
        OUTER_PRESSURE: film.outer_pressure,
        TEMPERATURE: 0.0 if film.temperature is None else film.temperature,
    }


def set_fluid(s, film, value) -> None:
    """Writes them into a gap state `s`; `value` takes the number of a function of time."""
    for slot, quantity in fluid_conditions(film).items():
        s[slot] = value(quantity)
