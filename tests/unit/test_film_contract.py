"""What every film of the package offers, and that only what is chosen is loaded."""

import re
import subprocess
import sys
from dataclasses import MISSING, fields, replace
from importlib import import_module
from pathlib import Path

import pytest
from scenes import R_I, R_O, fms
from scenes import film as table

import sealdyn.films
from sealdyn.films import all_film_names, film_named, film_of
from sealdyn.films._contract import Field, Film, Offer
from sealdyn.scene.film import Pads
from sealdyn.scene.patterns import Waviness
from sealdyn.scene.scene import SceneError

FOLDER = Path(sealdyn.films.__file__).parent
UNKNOWNS = ("start", "residual", "jacobian", "wrench_jacobian", "settle", "between", "line_load", "for_modes", "frame")
CELLS = ("cells_are_given", "doubled", "grid_accuracy")


def variants(film):
    """A film, and what it is between rough faces and with a floor of the pressure."""
    yield film
    if film.rough is not None:
        yield film.rough
    if film.patterned is not None:
        yield import_module(film.patterned).FILM
    if film.floored is not None:
        yield film_named(film.name, table(cavitation_pressure=0.0))


@pytest.mark.core
def test_every_film_has_a_contract_whose_absent_fields_are_none():
    optional = {f.name: f.default for f in fields(Film) if f.default is not MISSING}
    for name in all_film_names():
        for film in variants(film_named(name)):
            assert isinstance(film, Film) and film.name in (name, "grooved")
            for field in fields(Film):
                value = getattr(film, field.name)
                assert value is not None or optional[field.name] is None, f"{name}.{field.name}"
                if optional.get(field.name, MISSING) is None and field.name not in (
                    "generalises", "remark", "floored", "rough", "patterned", "opening_slots",
                ):  # fmt: skip
                    assert value is None or callable(value), f"{name}.{field.name}"


def test_what_belongs_together_is_there_together():
    for name in all_film_names():
        for film in variants(film_named(name)):
            assert (film.unknowns is None) == (film.start is None) == (film.residual is None)
            assert film.unknowns is not None or not any(getattr(film, part) for part in UNKNOWNS)
            assert (film.settle is None) == (film.between is None)
            assert len(given := {getattr(film, part) is None for part in CELLS}) == 1
            assert film.prepared is not None or given == {True}
            assert bool(film.quantities) == (film.grid is not None) == (film.fields is not None)
            assert all(isinstance(quantity, Field) for quantity in film.quantities)
            assert film.fluids and set(film.fluids) <= {"liquid", "gas"}


def test_a_folder_offers_what_its_film_is():
    for name in all_film_names():
        if (FOLDER / name).is_dir():
            offer = sealdyn.films._offer(name)
            assert isinstance(offer, Offer)
            assert all(getattr(film_named(name), field) == value for field, value in offer._asdict().items())


@pytest.mark.parametrize(
    "given, loaded",
    [("viscosity=0.01", {"linear", "radial"}), ("gas='air', temperature=300.0", {"gas_dam", "gas_reynolds", "linear"})],
)
def test_kernels_of_films_that_do_not_matter_are_not_loaded(given, loaded):
    code = f"""
import sys
from sealdyn.films import film_names
from sealdyn.scene.film import Film
film_names(Film(0.036, 0.04, 2e5, 1e5, clearance=6e-6, {given}))
print(*[m.split(".")[2] for m in sys.modules if m == "sealdyn.films.linear" or m.endswith(".film")
        and m.startswith("sealdyn.films.")])
"""
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert set(done.stdout.split()) == loaded


def test_a_film_of_ones_own_is_handed_in_as_an_object():
    own = replace(film_named("radial"), name="own", fluids=("gas",))
    with pytest.raises(SceneError):
        sealdyn.films.film_of(fms(), own)


WAVES, PADS, BAND = [Waviness(3, 1e-7)], [Pads(3, 1e-6, 1.0, R_I, R_O)], {"inertia": True, "density": 1000.0}


@pytest.mark.parametrize("model", ["auto", "radial", "profiled", "gas_dam"])
@pytest.mark.parametrize(
    ("given", "waves", "willing"),
    [({}, WAVES, True), ({"geometry": "planar"}, WAVES, False), ({"pads": PADS}, [], False), (BAND, WAVES, False)],
)
def test_a_refused_film_is_told_the_films_that_would_do(model, given, waves, willing):
    """Each that is named takes the scene, those chosen on request too; where none does, each says what it takes."""
    scene = fms(film=table(model, **given))
    scene = replace(scene, stator=replace(scene.stator, waviness=waves))
    with pytest.raises(SceneError) as refused:
        film_of(scene)
    assert refused.value.key == "film.model"
    named = re.findall(r'"(\w+)"', refused.value.expected) if " takes " not in refused.value.expected else []
    assert bool(named) == willing
    for name in named:
        assert film_of(replace(scene, film=replace(scene.film, model=name))).name == name or name == "auto"
    for words in refused.value.expected.split("; ") if not named else []:
        assert not words.endswith("takes ")
