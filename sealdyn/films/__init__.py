"""Films: one file (or folder) per fidelity level, found by file name.

What every film module offers (the contract):

`RUNG`            int, its fidelity level (1 linear, 2 radial, ...); "auto" climbs it.
`REMARK`          (if any) a sentence that every run with it says.
`GENERALISES`     (if any) name of a film that this one is once more, between faces which that one takes too.
`floored()`       (if any) the module that offers the same for tables with a floor of the pressure.
`rough()`         (if any) the module that offers the same between rough faces, which may meet.
`FLUIDS`          (if any) tuple of "liquid" and "gas"; a film without it is one of liquids.  Of a folder also in its
                  `__init__`, so that other films' scenes need not load it.
`BY_NAME`         (if any) True of a film that scenes have to ask for by name; in its `__init__`.
`accepts(film, waves)`
                  "" if it can take the faces of a `Film` table with these waves (Waviness of both rings), else what it
                  can take, as words that go after the film's name.
`parameters(film, clearance, error)`
                  float64 array: the film's block of the parameter array, for a `Film` table and the design clearance
                  (m); `error` is the relative error allowed to its quadrature.  The kernels below get this block.
`opening_law(film, mean_spin, spin_difference)`
                  function `force(clearance, inner_pressure, outer_pressure, floor)`: opening force (N) of the aligned
                  film, for the equilibrium; `floor` (m) of the film thickness, without it the film's own; the spins
                  (rad/s, 0 without them) matter to a fluid with inertia.
`wrench(f, s)`    compiled kernel: film block `f`, gap state `s` (slots named in faces/geometry.py) -> writes
                  force and moments on the stator into `s`.
`flow(f, s)`      compiled kernel: as `wrench`, and also leakage, friction torque into `s`.

A film that has no solution at some gaps writes NaN as its force, and into REFUSED (faces/geometry.py) a code of
`STATUS`, its {code: sentence}.

`matrices(f, s)`  (optional) stiffness and damping, each (3, 3), on (dz, g_x, g_y) at a gap state; without it they
                  are differences of the force.

What it may show over the faces, kept by archives at a few instants (a film that says nothing shows nothing):

`FIELDS`          tuple of Field (films/_fields.py): names, units, long names.
`MEAN_CIRCUMFERENCE`
                  (if any) True where pressure acts on the mean circumference, at whatever radius.
`exit_mach(f, s)` (if any) least and largest Mach number of the gas at its exit around the circle at a gap state.
`grid(f)`         radii (m) and angles (rad, from the x axis) at which it gives them; they do not change during a run.
`fields(f, s, out)`
                  compiled kernel: their values at a gap state into `out` (fields, radii, angles).

A film may have unknowns `x` (n,) of its own, such as pressures; its force is then no function of the gap state alone.
Its kernels are `wrench(f, s, x)`, `flow(f, s, x)` and `fields(f, s, x, out)`, and it offers besides:

`unknowns(f)`     FilmUnknowns (films/_unknowns.py): names, scales, which are differential, the residual's pattern.
`start(f, s, x)`  compiled: x of the steady film at a gap state, its rates among it; returns 0, or a code of STATUS.
`residual(f, s, x, x_rate, res)`
                  compiled: what is left of the film's equations, in any units; returns 0, or a code of STATUS, which
                  ends the run, as does what is not a number.  Finite and smooth at any gap state that a solver may try.
`STATUS`          {code: sentence}.
`PADS`            (if any) True where it takes the pads of a `Film` table.
`STANDING_WAVES`  (if any) True where it takes waves of faces that stand still only; its `opening_law` takes them too.
`WAVES_TOUCH`     (if any) True where wavy faces may be rough and meet; its `opening_law` takes the contact too.
`line_load(f, x)` (if any) what the film presses on the faces at each angle of a sector of them, (angles,) in N per rad:
                  what bends a ring.
`for_modes(f)`    (if any) changes a block for linearising: rates that the film has for a solver's sake are infinite in
                  it, and no modes.
`whole(film)`     (if any) the `Film` table of the whole circle where a part of it stands for all.
`prepared(scene)` (if any) the `Film` table with what the rest of the scene decides of it; beside it
                  `cells_are_given(film)`, and `doubled(film, times)`, the table with twice the cells so many times, for
                  the search of how many are needed (dynamics/cells.py).
`grid_accuracy(film)`
                  (if any) the relative error that its cells may have, beside the accuracy of a run.
`halved(film)`    (if any) the `Film` table with half the cells, which err four times as much.
`jacobian(f, s, x, x_rate, alpha, data)`
                  (optional) compiled: d res / d x + alpha d res / d x_rate in the order of the pattern's values.
`settle(f, s, alpha, base, x)`
                (optional) compiled: x at the end of a step of an implicit method, where the rates of the differential
                ones are alpha (x - base); at entry x near by.  Returns 0, or a code of STATUS.  For films whose
                residual has kinks that no Newton iteration of a library passes.
`between(f, s, x)`
                (beside `settle`) compiled: x between two steps, whose differential ones are interpolated, at a gap
                state.
`wrench_jacobian(f, s, x, rows)`
                  (optional) compiled: d (force, moments) / d x, (3, n).

Its stiffness and damping follow by condensation (dynamics/condensation.py); where some unknowns are differential they
hang on the frequency, and modes and responses have them at their own (dynamics/film_modes.py).

A film never asks which ring floats, and imports no other film.
"""

import importlib
import pkgutil
from functools import cache

from ..numerics.piecewise_linear import points
from ..scene.film import profile_errors
from ..scene.scene import SceneError
from ..scene.waviness import turning_waves, waves_of, waviness_errors


def has_unknowns(film) -> bool:
    """Whether a film (module) has unknowns of its own."""
    return hasattr(film, "unknowns")


def film_module(name: str, film=None, rough: bool = False):
    """The film called `name`, found by file (or folder) name; its floored one if a `Film` table asks for that, or the
    one for `rough` faces."""
    found = _module(name)
    if film is not None and film.cavitation_pressure is not None and hasattr(found, "floored"):
        return found.floored()
    return found.rough() if rough and hasattr(found, "rough") else found


def _outside(name: str):
    """What a film's file or folder says of it before all of it is loaded."""
    return importlib.import_module(f"{__name__}.{name}")


@cache
def _module(name: str):
    found = _outside(name)
    return importlib.import_module(f"{__name__}.{name}.film") if hasattr(found, "__path__") else found


def film_name(module) -> str:
    """Name of a film, as `film.model` has it, from its module."""
    return module.__name__.removeprefix(f"{__name__}.").split(".")[0]


@cache
def all_film_names() -> list[str]:
    """Names of all films, sorted."""
    return sorted(m.name for m in pkgutil.iter_modules(__path__) if not m.name.startswith("_"))


def refused(module, film, waves=()) -> str:
    """What a film (module) takes, as words that go after its name, where it cannot take the faces and the fluid of a
    `Film` table with these waves (Waviness); "" where it can."""
    if film is not None and not _takes_fluid(module, film):
        return "gases only" if film.gas is None else "liquids only"
    if film is not None and film.pads and not getattr(module, "PADS", False):
        return "faces without pads"
    return module.accepts(film, waves)


def _by_name(name) -> bool:
    return getattr(_outside(name), "BY_NAME", False)


def _takes_fluid(module, film) -> bool:
    return ("liquid" if film.gas is None else "gas") in getattr(module, "FLUIDS", ("liquid",))


def film_names(film=None, waves=()) -> list[str]:
    """Names of the films that can take the faces and the fluid of a `Film` table (None: plain cones) with these waves
    (Waviness), sorted, without those that are another one of them once more."""
    named = [name for name in all_film_names() if film is None or _takes_fluid(_outside(name), film)]
    # What nobody asks for is not even loaded.
    named = [name for name in named if film is None or film.model == name or not _by_name(name)]
    able = [name for name in named if not refused(film_module(name), film, waves)]
    return [name for name in able if getattr(film_module(name), "GENERALISES", None) not in able]


def film_of(scene, module=None):
    """The film that a scene (or what has its tables) asks for, or the `module` given instead; "auto" is the highest
    that takes the scene's faces, until a choice is certified.  Raises SceneError where it cannot take them."""
    film, waves = scene.film, waves_of(scene)
    if module is None:
        able, name = film_names(film, waves), film.model
        if name == "auto":
            name = max(able, key=lambda n: film_module(n).RUNG, default=None)
        if name is None or refused(film_module(name), film, waves):
            raise _refusal(film, waves, able)
        module = film_module(name, film, scene.contact is not None)
    elif refused(module, film, waves):
        found = f"faces or a fluid that the film {film_name(module)} does not take"
        raise SceneError("film", found, refused(module, film, waves))
    for key, found, expected in profile_errors(film):
        raise SceneError(f"film.{key}", found, expected)
    for error in waviness_errors(scene):
        raise SceneError(*error)
    if film.pads and any(points(scene.stator.speed)):
        raise SceneError("stator.speed", "a face with pads that turns", "0: pads are in the face that stands still")
    turning = turning_waves(scene) if getattr(module, "STANDING_WAVES", False) else ""
    if turning:
        expected = f"waves on a face that stands still: {film_name(module)} takes no others"
        raise SceneError(turning, "waves of a face that turns", expected)
    return module


def _refusal(film, waves, able) -> SceneError:
    plain = "a gas" if film.gas is not None else "a profile" if film.profile is not None else "a liquid"
    faces = "pads" if film.pads else "wavy faces" if waves else "film.inertia" if film.inertia else plain
    expected = " or ".join(f'"{name}"' for name in [*able, "auto"])
    if not able:
        said = {name: refused(film_module(name), film, waves) for name in all_film_names()}
        expected = "a film that takes them: " + "; ".join(f"{name} takes {words}" for name, words in said.items())
    return SceneError("film.model", f'"{film.model}" with {faces}', expected)
