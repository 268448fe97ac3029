"""Coning that follows time, the speed of the shaft, which turns a ring inside out, and the temperature of the film.

    coning = film.coning(t) + coning_per_speed_squared w^2 + coning_per_kelvin (T - coning_reference_temperature)

**Source** Zuk, NASA TM X-68022 (1972), Figs. 2 and 3: sketches of centrifugal and thermal coning, without numbers;
in linear elasticity the first goes with the square of the speed, the second with the temperature.
**Valid** rings that deform far slower than they vibrate; both numbers are the user's.
"""

from dataclasses import replace

from ..numerics.piecewise_linear import PiecewiseLinear, initially


def follows_speed(film) -> bool:
    """Whether the coning of a `Film` follows the shaft speed."""
    return film.coning_per_speed_squared != 0.0


def changes(film) -> bool:
    """Whether the coning of a `Film` may be another than the number of its key."""
    return isinstance(film.coning, PiecewiseLinear) or follows_speed(film) or film.coning_per_kelvin != 0.0


def coning_change(scene, value=initially, speed=None) -> float:
    """By how much (rad) the coning of a scene differs from what `film.coning` is at time zero; `value` takes the number
    of a function of time, `speed` (rad/s) is the shaft's in place of the scene's."""
    film = scene.film
    if not changes(film):
        return 0.0
    speed = value(scene.shaft.speed) if speed is None else speed
    change = value(film.coning) - initially(film.coning) + film.coning_per_speed_squared * speed**2
    if film.coning_per_kelvin:
        change += film.coning_per_kelvin * (value(film.temperature) - film.coning_reference_temperature)
    return change


def coned(scene, value=initially, speed=None):
    """The `Film` table of a scene with its coning as a number: arguments as of `coning_change`."""
    film = scene.film
    if not changes(film):
        return film
    coning = initially(film.coning) + coning_change(scene, value, speed)
    none = dict(coning_per_speed_squared=0.0, coning_per_kelvin=0.0, coning_reference_temperature=None)
    return replace(film, coning=coning, **none)
