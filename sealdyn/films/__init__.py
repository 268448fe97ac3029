"""Films: one file (or folder) per fidelity level, found by its name; what a film is: `Film` in _contract.py.

A file `films/NAME.py`, or `films/NAME/film.py` of a folder, ends in `FILM = Film(...)`.  Before one is chosen only its
name, fidelity, fluids and whether it comes on request are read: of a folder from `OFFER` in its `__init__.py`, so that
kernels of films that are not chosen are neither loaded nor compiled.  Films from outside (extensions.py) are chosen by
their name alone.
"""

import importlib
import pkgutil
from dataclasses import replace
from functools import cache

from ..extensions import OutsideError, folders, in_folders, installed, outside_module
from ..numerics.piecewise_linear import points
from ..scene.film import profile_errors
from ..scene.patterns import grooves_of, turning_waves, waves_of, waviness_errors
from ..scene.scene import SceneError
from ._contract import Film, Offer


def film_named(name: str, table=None, rough: bool = False) -> Film:
    """The film called `name`: its floored one if a `Film` table asks for that, or the one for `rough` faces."""
    film = _film(name)
    if table is not None and table.cavitation_pressure is not None and film.floored:
        return importlib.import_module(film.floored).FILM
    return film.rough if rough and film.rough else film


# These four are all that knows where films come from.
_OWN = tuple(__path__)
__path__ = [*_OWN, *folders("films")]


@cache
def own_film_names() -> list[str]:
    """Names of the films of this package, sorted."""
    return sorted(m.name for m in pkgutil.iter_modules(_OWN) if not m.name.startswith("_"))


def all_film_names() -> list[str]:
    """Names of all films, those from outside too, sorted."""
    return sorted({*own_film_names(), *in_folders("films"), *installed("films")})


def _offer(name: str) -> Offer | Film:
    """What is asked of a film before it is chosen."""
    module = _module(name)
    return module.OFFER if _is_folder(module) else module.FILM


def _module(name: str):
    """The file of a film, or the `__init__` of its folder, which offers it before all of it is loaded.  Raises
    SceneError."""
    if name in own_film_names():
        return _own_module(name)
    try:
        module = outside_module("films", name, "FILM", "OFFER")
    except OutsideError as error:
        raise SceneError("film.model", error.found, error.expected) from None
    if (called := getattr(module, "FILM", None) or module.OFFER).name != name:
        raise SceneError("film.model", f'"{name}", whose FILM is called "{called.name}"', f'name="{name}" in its file')
    return module


@cache
def _own_module(name: str):
    return importlib.import_module(f"{__name__}.{name}")


def _film(name: str) -> Film:
    module = _module(name)
    return importlib.import_module(f"{module.__name__}.film").FILM if _is_folder(module) else module.FILM


def _is_folder(module) -> bool:
    return module.__spec__.submodule_search_locations is not None


def limits(film: Film, table, waves=()) -> str:
    """What a film takes, as words that go after its name, where it cannot take the faces and the fluid of a `Film`
    table with these waves (Waviness); "" where it can."""
    if table is not None and not _takes_fluid(film, table):
        return "gases only" if table.gas is None else "liquids only"
    if table is not None and table.pads and not film.pads:
        return "faces without pads"
    return film.accepts(table, waves)


def _takes_fluid(film: Film | Offer, table) -> bool:
    return ("liquid" if table.gas is None else "gas") in film.fluids


def film_names(table=None, waves=()) -> list[str]:
    """Names of the films that can take the faces and the fluid of a `Film` table (None: plain cones) with these waves
    (Waviness), sorted, without those that are another one of them once more."""
    asked = [table.model] if table is not None and table.model != "auto" else []
    offers = [_offer(name) for name in sorted({*own_film_names(), *asked})]
    # What nobody asks for is not even loaded, nor what generalises a film that will do.
    if table is not None:
        offers = [o for o in offers if _takes_fluid(o, table) and (table.model == o.name or not o.only_on_request)]
    able = []
    for offer in sorted(offers, key=lambda offer: offer.generalises is not None):
        if offer.generalises not in able and not limits(_film(offer.name), table, waves):
            able.append(offer.name)
    return sorted(able)


def _over_grooves(film: Film, scene) -> Film:
    """The film over the grooves of a scene that this one becomes there.  Raises SceneError where it does not."""
    if film.patterned is None:
        key, expected = f"{grooves_of(scene)[0]}.grooves", 'film.model = "gas_reynolds" or "reynolds" of a liquid'
        raise SceneError(key, f'grooves, with film.model = "{film.name}"', expected)
    found = importlib.import_module(film.patterned).FILM
    return replace(found, name=film.name, fidelity=film.fidelity, fluids=film.fluids, patterned=film.patterned)


def film_of(scene, film: Film | None = None) -> Film:
    """The film that a scene (or what has its tables) asks for, or the `film` given instead; "auto" is the highest
    that takes the scene's faces, until a choice is certified.  Raises SceneError where it cannot take them."""
    table, waves = scene.film, waves_of(scene)
    if film is None:
        able, name = film_names(table, waves), table.model
        if name == "auto" and grooves_of(scene)[1]:
            name = "reynolds" if table.gas is None else "gas_reynolds"
        elif name == "auto":
            name = max(able, key=lambda n: _offer(n).fidelity, default=None)
        if name is None or limits(_film(name), table, waves):
            raise _no_film(table, waves, able)
        film = film_named(name, table, scene.contact is not None)
        film = _over_grooves(film, scene) if grooves_of(scene)[1] else film
    elif limits(film, table, waves):
        raise SceneError(
            "film", f"faces or a fluid that the film {film.name} does not take", limits(film, table, waves)
        )
    for key, found, expected in profile_errors(table):
        raise SceneError(f"film.{key}", found, expected)
    for error in waviness_errors(scene):
        raise SceneError(*error)
    if table.offset and (film.unknowns or table.gas is not None or table.profile or waves or grooves_of(scene)[1]):
        expected = "0, or a liquid between plain cones by a film without cells: linear, radial"
        raise SceneError("film.offset", f'{table.offset:g} m with film.model = "{film.name}" or such faces', expected)
    if table.pads and any(points(scene.stator.speed)):
        raise SceneError("stator.speed", "a face with pads that turns", "0: pads are in the face that stands still")
    turning = turning_waves(scene) if film.standing_waves else ""
    if turning:
        expected = f"waves on a face that stands still: {film.name} takes no others"
        raise SceneError(turning, "waves of a face that turns", expected)
    return film


def _no_film(table, waves, able) -> SceneError:
    plain = "a gas" if table.gas is not None else "a profile" if table.profile is not None else "a liquid"
    faces = "pads" if table.pads else "wavy faces" if waves else "film.inertia" if table.inertia else plain
    willing, taken = [*able, "auto"], {}
    if not able:
        # One that is chosen on request only may do.
        taken = {name: limits(_film(name), table, waves) for name in all_film_names()}
        willing = [name for name, words in taken.items() if not words]
    expected = " or ".join(f'"{name}"' for name in willing)
    if not willing:
        expected = "a film that takes them: " + "; ".join(f"{name} takes {words}" for name, words in taken.items())
    return SceneError("film.model", f'"{table.model}" with {faces}', expected)
