"""The state of fluid and faces at rest: what of a scene goes into which slots of a gap state."""

from ..faces.geometry import CONING_CHANGE, INNER_PRESSURE, OUTER_PRESSURE, TEMPERATURE, VISCOSITY
from ..scene.film import coning_change
from ..scene.gas import viscosity_of
from .intervals import constant_and_slope


def fluid_conditions(film) -> dict:
    """Slots of the gap state and what they hold of a `Film` table, each a number or a function of time, SI; temperature
    0 of a liquid."""
    return {
        VISCOSITY: viscosity_of(film),
        INNER_PRESSURE: film.inner_pressure,
        OUTER_PRESSURE: film.outer_pressure,
        TEMPERATURE: 0.0 if film.temperature is None else film.temperature,
    }


def thermal_coning(scene, interval) -> tuple[float, float]:
    """Change (rad) of the coning at an interval's start and its slope (rad/s), without what follows the speed."""
    film = scene.film
    change = coning_change(scene, lambda quantity: constant_and_slope(quantity, interval)[0], speed=0.0)
    rate, warming = (constant_and_slope(quantity, interval)[1] for quantity in (film.coning, film.temperature or 0.0))
    return change, rate + film.coning_per_kelvin * warming


def set_conditions(s, scene, value, speed=None) -> None:
    """Writes them into a gap state `s`, and how much the coning has changed; `value` takes the number of a function of
    time, `speed` (rad/s) is the shaft's in place of the scene's."""
    for slot, quantity in fluid_conditions(scene.film).items():
        s[slot] = value(quantity)
    s[CONING_CHANGE] = coning_change(scene, value, speed)
