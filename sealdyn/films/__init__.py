"""Films: one file (or folder) per rung of the ladder, found by file name.

What every film module offers (the contract):

`RUNG`            int, its place on the ladder (1 linear, 2 radial, ...); "auto" climbs it.
`UNKNOWNS`        number of unknowns the film owns; 0 for an algebraic law.
`parameters(film, clearance)`
                  float64 array: the film's block of the parameter array, for a `Film` table and the
                  design clearance (m).  The kernels below get this block.
`opening_force(film, clearance, inner_pressure, outer_pressure)`
                  force (N) of the aligned film at rest, for the equilibrium.
`wrench(f, s)`    compiled kernel: film block `f`, gap state `s` (slots named in faces/geometry.py) -> writes
                  force and moments on the stator into `s`.
`flow(f, s)`      compiled kernel: as `wrench`, and also leakage, friction torque into `s`.

A film never asks which ring floats, and imports no other film.
"""

import importlib
import pkgutil


def film_module(name: str, profile=None):
    """The film called `name`, found by file (or folder) name; "auto" is the radial film until a choice is certified, of
    faces with a profile the profiled film."""
    if name == "auto":
        name = "radial" if profile is None else "profiled"
    found = importlib.import_module(f"{__name__}.{name}")
    return importlib.import_module(f"{__name__}.{name}.film") if hasattr(found, "__path__") else found


def film_name(module) -> str:
    """Name of a film, as `film.model` has it, from its module."""
    return module.__name__.removeprefix(f"{__name__}.").split(".")[0]


def all_film_names() -> list[str]:
    """Names of all films, sorted."""
    return sorted(m.name for m in pkgutil.iter_modules(__path__) if not m.name.startswith("_"))


def film_names(film=None) -> list[str]:
    """Names of the films that can take a film's faces: of a profile the profiled film alone, which between plain
    cones (`film` without a profile, or None) is the radial film once more and is left out."""
    if film is not None and film.profile is not None:
        return ["profiled"]
    return [name for name in all_film_names() if name != "profiled"]
