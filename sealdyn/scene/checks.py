"""What cannot be: valid keys that no scene can have together; and keys that this scene leaves unused."""

import cmath
import math
from dataclasses import fields

from ..numerics.piecewise_linear import PiecewiseLinear, initially, points, value_at
from ..units import Temperature, Viscosity
from .excitation import ACCELERATIONS, MOTION_COLUMNS, acceleration_errors, random_errors, sample_errors
from .film import Film, aligned_gaps, coned, follows_speed, pads_errors, profile_errors, reynolds_errors
from .fluid import GASES, gas_of, heat_errors, liquid_errors
from .forces import (
    LOAD_COLUMNS,
    Load,
    contact_errors,
    contact_thresholds,
    film_in_words,
    limit_in_words,
    secondary_seal_errors,
)
from .patterns import grooves_errors, grooves_of, waves_of, waviness_errors
from .rings import OF_MASS, body_errors, elastic_errors
from .scene import SceneError
from .sweep import sweep_errors
from .tabulated import tabulated_errors

# Of keys that may not step, if not rad.
UNITS = {"temperature": "K", "speed": "rad/s", "outer_pressure": "Pa", "inner_pressure": "Pa"}


def check_scene(scene, run) -> None:
    """Raises `SceneError` with the first rule that a Scene, or its `run` (the `[run]` table), breaks."""
    for error in scene_errors(scene, run):
        raise error


def scene_errors(scene, run) -> list[SceneError]:
    """Rules that a Scene, or its `run` (the `[run]` table), breaks: of each part the first, and what follows from
    several parts only where each is possible."""
    bad = _broken(_film, scene) or _broken(_profile, scene)
    bad += _broken(_cavitation, scene.film) + _broken(_liquid if scene.film.gas is None else _gas, scene.film)
    for errors in (waviness_errors, elastic_errors, grooves_errors, heat_errors, tabulated_errors):
        bad += [SceneError(*error) for error in errors(scene)]
    bad += _broken(_closing, scene)
    for name, ring in (("stator", scene.stator), ("rotor", scene.rotor)):
        bad += _broken(_ring, name, ring) + _broken(check_no_step, name, ring)
    bad += _broken(_seals_alike, scene)
    if scene.contact:
        bad += _below("contact", contact_errors(scene.contact))
        options = scene.film.reynolds
        if scene.contact.law == "plateaus" and options and options.roughness == "patir-cheng":
            found = f'"{options.roughness}", with contact.law = "{scene.contact.law}"'
            bad.append(SceneError("film.reynolds.roughness", found, '"christensen": the film between the plateaus'))
    if not (scene.stator.support or scene.rotor.support):
        expected = "[rotor.support] or [stator.support]: the ring that floats"
        bad.append(SceneError("rotor.support", "no support on either ring", expected))
    for name, table in (("housing", scene.housing), ("shaft", scene.shaft)):
        if table.motion:
            given = (*MOTION_COLUMNS, *ACCELERATIONS)
            bad += _below(f"{name}.motion", sample_errors(table.motion, given) or acceleration_errors(table.motion))
    for name, ring in (("stator", scene.stator), ("rotor", scene.rotor)):
        if ring.load and ring.load.samples:
            bad += _below(f"{name}.load.samples", sample_errors(ring.load.samples, LOAD_COLUMNS))
    bad += _broken(_vibrations, scene.housing) + _broken(_run, scene.shaft, run)
    if not bad and (run.start == "rest" or (run.start == "auto" and scene.initial.given)):
        bad += _broken(_open_at_start, scene)
    return bad


def _broken(rule, *parts) -> list[SceneError]:
    """The SceneError that a rule raises for its parts, if it does."""
    try:
        rule(*parts)
    except SceneError as error:
        return [error]
    return []


def _below(table: str, errors) -> list[SceneError]:
    """The `errors` (key, found, expected) of a table, its dotted name before their keys."""
    return [SceneError(f"{table}.{key}", *words) for key, *words in errors]


def _refuse(table: str, errors) -> None:
    """Raises the first of them."""
    for error in _below(table, errors):
        raise error


def _film(scene) -> None:
    film = scene.film
    _coning(scene)
    for key in ("inner_radius", "outer_radius", "clearance"):
        value = getattr(film, key)
        if value is not None and value <= 0:
            raise SceneError(f"film.{key}", f"{value:g} m", "a length > 0")
    if film.inner_radius >= film.outer_radius:
        raise SceneError(
            "film.inner_radius",
            f"{film.inner_radius:g} m",
            f"less than outer_radius = {film.outer_radius:g} m",
        )
    _refuse("film", pads_errors(film))
    if not 0 < film.floor < 0.5:
        raise SceneError("film.floor", f"{film.floor:g}", "a fraction of the clearance between 0 and 0.5")
    if film.clearance is not None and film.profile is None:
        slope = coned(scene).coning
        outer = film.clearance + slope * (film.outer_radius - film.inner_radius)
        if outer <= film.floor * film.clearance:
            raise SceneError(
                "film.coning",
                f"{slope:g} rad, a film of {outer:g} m at the outer radius",
                "an open film",
            )
    width = film.outer_radius - film.inner_radius
    if not 0.0 <= film.offset < width:
        raise SceneError("film.offset", f"{film.offset:g} m", f"at least 0 and less than the face is wide, {width:g} m")
    if film.model == "reynolds":
        _refuse("film", reynolds_errors(film))


def _coning(scene) -> None:
    film = scene.film
    if film.coning_per_kelvin:
        for key in ("temperature", "coning_reference_temperature"):
            if getattr(film, key) is None:
                found = "nothing, with film.coning_per_kelvin"
                raise SceneError(f"film.{key}", found, Temperature.__metadata__[0].expected())
    elif film.coning_reference_temperature is not None:
        found = "a temperature without film.coning_per_kelvin"
        raise SceneError("film.coning_reference_temperature", found, "both of them, or none")
    if (film.coning_per_pressure != 0.0) != (film.coning_reference_pressure is not None):
        found = "a pressure without film.coning_per_pressure"
        if film.coning_per_pressure:
            found = "nothing, with film.coning_per_pressure"
        raise SceneError("film.coning_reference_pressure", found, "both of them, or none")
    follows = ["temperature"] if film.coning_per_kelvin else []
    if film.coning_per_pressure:
        follows += ["outer_pressure", "inner_pressure"]
        times = {t for p in (film.outer_pressure, film.inner_pressure) for t in getattr(p, "time", (0.0,))}
        sealed = [value_at(film.outer_pressure, t) - value_at(film.inner_pressure, t) for t in times]
        if min(sealed) < 0.0 < max(sealed):
            found = "a sealed pressure that changes sides"
            raise SceneError("film.coning_per_pressure", found, "the higher pressure always on one side")
    check_no_step("film", film, ("coning", *follows))
    if follows_speed(film):
        check_no_step("shaft", scene.shaft, ["speed"])


def _liquid(film) -> None:
    _refuse("film", liquid_errors(film))
    if film.viscosity is None and film.liquid is None:
        raise SceneError("film.viscosity", "nothing", Viscosity.__metadata__[0].expected())
    for key in ("temperature", "gas_dam", "gas_reynolds"):
        if getattr(film, key) is None or (key == "temperature" and (film.coning_per_kelvin or film.liquid)):
            continue
        found, expected = "a key of gases, with a liquid", f"nothing, or film.gas = {_names(GASES)}"
        if key == "temperature":
            found = "a temperature of a liquid, on which nothing hangs without film.liquid or film.coning_per_kelvin"
            expected += ", film.liquid, or film.coning_per_kelvin"
        raise SceneError(f"film.{key}", found, expected)


def _gas(film) -> None:
    gas = gas_of(film)
    _refuse("film", liquid_errors(film))
    if not 1.0 < gas.heat_ratio <= 5.0 / 3.0 + 1e-9:
        raise SceneError("film.gas.heat_ratio", f"{gas.heat_ratio:g}", "a ratio above 1, at most 5/3")
    if film.temperature is None:
        raise SceneError("film.temperature", "nothing", Temperature.__metadata__[0].expected())
    if film.viscosity is None and gas.reference_viscosity is None:
        expected = f"{Viscosity.__metadata__[0].expected()}, or film.gas.reference_viscosity"
        raise SceneError("film.viscosity", "nothing", expected)
    for value in points(film.temperature) if film.viscosity is None else ():
        if not gas.lowest <= value <= gas.highest:
            limits = f"{gas.lowest:g} to {gas.highest:g} K"
            expected = f"{limits}, where its viscosity follows Sutherland's law, or film.viscosity"
            raise SceneError("film.temperature", f"{value:g} K", expected)
    for key in ("outer_pressure", "inner_pressure"):
        for value in points(getattr(film, key)):
            if value <= 0.0:
                raise SceneError(f"film.{key}", f"{value:g} Pa of a gas", "an absolute pressure above 0")
    if film.cavitation_pressure is not None:
        raise SceneError("film.cavitation_pressure", "a value with a gas", "nothing: a gas does not cavitate")
    if film.inertia:
        raise SceneError("film.inertia", "true with a gas", "nothing: centrifugal inertia is for films of liquids")
    if film.gas_dam is not None and not 0.0 < film.gas_dam.entrance_loss <= 1.0:
        found = f"{film.gas_dam.entrance_loss:g}"
        raise SceneError("film.gas_dam.entrance_loss", found, "a share above 0, at most 1 (no loss)")
    if film.gas_reynolds is not None:
        radial, around = film.gas_reynolds.cells
        if not (2 <= radial <= 200 and 8 <= around <= 1000):
            found = f"{radial} x {around} cells"
            raise SceneError("film.gas_reynolds.cells", found, "2 to 200 over the radius, 8 to 1000 around")


def _names(words) -> str:
    return " or ".join(f'"{word}"' for word in words)


def _profile(scene) -> None:
    film = scene.film
    _refuse("film", profile_errors(film))
    if film.clearance is not None and film.profile is not None:
        least, radius = min((h, r) for r, h in aligned_gaps(coned(scene), film.clearance))
        if not least > _lowest(scene):
            raise SceneError("film.profile.depth", f"a film of {least:g} m at r = {radius:g} m", "an open film")


def _lowest(scene) -> float:
    """Film thickness (m) at which a run ends."""
    if scene.contact is None:
        return scene.film.floor * scene.film.clearance
    return contact_thresholds(scene.contact)[2]


def _cavitation(film) -> None:
    for key in ("outer_pressure", "inner_pressure"):
        least = min(points(getattr(film, key)))
        if film.cavitation_pressure is not None and film.cavitation_pressure > least:
            raise SceneError(
                "film.cavitation_pressure",
                f"{film.cavitation_pressure:g} Pa",
                f"at most {key} = {least:g} Pa",
            )


def _closing(scene) -> None:
    ratio, spring = scene.closing.balance_ratio, scene.closing.spring_force
    if scene.film.clearance is None and (ratio is None or spring is None):
        raise SceneError(
            "film.clearance",
            "nothing",
            "a length, or both [closing] balance_ratio and [closing] spring_force",
        )
    if scene.film.clearance is not None and ratio is not None and spring is not None:
        raise SceneError(
            "film.clearance",
            "clearance, balance_ratio and spring_force together",
            "two of the three: the third follows",
        )
    if ratio is not None and ratio < 0:
        raise SceneError("closing.balance_ratio", f"{ratio:g}", "a ratio >= 0")


def _ring(name: str, ring) -> None:
    _refuse(f"{name}.body", body_errors(ring.body) if ring.body else ())
    if ring.polar_inertia > 2 * ring.transverse_inertia and not ring.unphysical_inertia:
        raise SceneError(
            f"{name}.polar_inertia",
            f"{ring.polar_inertia:g} kg*m^2",
            f"at most 2 x transverse_inertia = {2 * ring.transverse_inertia:g} kg*m^2 (a thin disk), "
            "or unphysical_inertia = true",
        )
    if ring.polar_inertia > 0 and ring.transverse_inertia == 0:
        raise SceneError(f"{name}.transverse_inertia", "0 beside a polar_inertia", "an inertia > 0")
    support = ring.support
    if support and ring.mass_centre and not (ring.mass > 0 and ring.transverse_inertia > 0):
        raise SceneError(f"{name}.mass_centre", "a ring without mass or inertia", "mass and transverse_inertia > 0")
    if ring.secondary_seal:
        _secondary_seal(name, ring)
    if support is None:
        return
    key = f"{name}.support"
    by_tilt = support.tilt_stiffness is not None or support.tilt_damping is not None
    if support.radius is not None and by_tilt:
        raise SceneError(f"{key}.radius", "radius and tilt coefficients", "one or the other")
    if support.radius is None and support.tilt_stiffness is None:
        raise SceneError(f"{key}.radius", "nothing", "radius (of the ring of springs), or tilt_stiffness")
    stiffness = support.tilt_stiffness
    if isinstance(stiffness, tuple) and (len(stiffness) != 2 or min(stiffness) < 0.0):
        expected = "one stiffness, or two >= 0, about the axis at tilt_axis and about the one across it"
        raise SceneError(f"{key}.tilt_stiffness", f"{list(stiffness)}", expected)
    if support.radius is not None and support.radius <= 0:
        raise SceneError(f"{key}.radius", f"{support.radius:g} m", "a length > 0")


def check_no_step(name: str, table, keys=("runout", "misalignment")) -> None:
    """Raises `SceneError` if one of the `keys` of the table called `name`, a ring's or one that its coning follows, has
    a step in time: a face cannot be somewhere else at once, the film, or the support's damper, would push without
    bound."""
    for key in keys:
        value = getattr(table, key, 0.0)
        if not isinstance(value, PiecewiseLinear):
            continue
        for t0, t1, v0, v1 in zip(value.time, value.time[1:], value.value, value.value[1:], strict=False):
            if t0 == t1 and v0 != v1:
                found = f"a step at {t0:g} s, from {v0:g} to {v1:g} {UNITS.get(key, 'rad')}"
                expected = "a ramp: a face that jumps squeezes the film without bound"
                raise SceneError(f"{name}.{key}", found, expected)


def _secondary_seal(name: str, ring) -> None:
    key = f"{name}.secondary_seal"
    _refuse(key, secondary_seal_errors(ring.secondary_seal))
    if ring.support and (ring.mass == 0 or ring.transverse_inertia == 0):
        raise SceneError(key, "a ring without mass or inertia", "mass and transverse_inertia > 0 to stick and slip")


def _seals_alike(scene) -> None:
    """Rings that stick rigidly change their equations in another way than those whose seal gives."""
    seals = {name: ring.secondary_seal for name, ring in scene.rings.items() if ring.support}
    gives = {name: seal.stiffness is not None for name, seal in seals.items() if seal and seal.law == "coulomb"}
    if len(set(gives.values())) == 2:
        key = next(f"{name}.secondary_seal.stiffness" for name, given in gives.items() if not given)
        raise SceneError(key, "none, while the seal of the other ring gives", "both seals to give, or none")


def _vibrations(housing) -> None:
    for kind, errors in (("", _tone_errors), ("_random", random_errors), ("_sweep", sweep_errors)):
        for name in (f"axial{kind}", f"angular{kind}"):
            for n, vibration in enumerate(getattr(housing, name)):
                _refuse(f"housing.{name}.{n}", errors(vibration))


def _tone_errors(tone) -> list[tuple[str, str, str]]:
    if (tone.displacement is None) != (tone.acceleration is None):
        return []
    found = "neither" if tone.displacement is None else "both"
    return [("displacement", found, "exactly one of displacement and acceleration")]


def _run(shaft, run) -> None:
    if run.duration is not None:
        if run.duration <= 0:
            raise SceneError("run.duration", f"{run.duration:g} s", "a time > 0")
    elif turns_of(shaft.speed) < run.turns:
        raise SceneError(
            "run.turns",
            f"{run.turns:g} turns of a shaft that makes {turns_of(shaft.speed):g}",
            "[run] duration, or a [shaft] speed that gets there",
        )


def _open_at_start(scene) -> None:
    """The flexible ring starts where [initial] says, else untilted at the clearance."""
    film = scene.film
    if film.clearance is None or waves_of(scene):
        # Among waves the model's own start looks for the thinnest place.
        return
    rotor, stator = _start(scene.initial.rotor), _start(scene.initial.stator)
    if scene.rotor.support is None:
        rotor = (0.0, cmath.rect(initially(scene.rotor.runout), scene.rotor.runout_phase))
    if scene.stator.support is None:
        angle, direction = initially(scene.stator.misalignment), scene.stator.misalignment_direction
        stator = (0.0, cmath.rect(angle, direction))
    tilt, gap = abs(stator[1] - rotor[1]), film.clearance + stator[0] - rotor[0]
    thinnest, radius = min((h - tilt * r, r) for r, h in aligned_gaps(coned(scene), gap))
    lowest = _lowest(scene)
    if not thinnest > lowest:
        blame = "stator.misalignment" if scene.stator.support is None else "rotor.runout"
        if (scene.rotor.support and scene.stator.support) or scene.initial.given:
            blame = "initial"
        where = {film.inner_radius: "the inner radius", film.outer_radius: "the outer radius"}
        raise SceneError(
            blame,
            f"a film closed at the start ({film_in_words(thinnest)} at {where.get(radius, f'r = {radius:g} m')}, "
            f"relative misalignment {tilt:g} rad)",
            f"a film above {limit_in_words(lowest)}",
        )


def _start(ring) -> tuple[float, complex]:
    return ring.z or 0.0, complex(ring.tilt_x or 0.0, ring.tilt_y or 0.0)


def turns_of(speed) -> float:
    """Turns the shaft makes in all (either way) at a `speed` (rad/s, number or function of time): endless unless it
    ends at zero."""
    if points(speed)[-1] != 0:
        return math.inf
    if not isinstance(speed, PiecewiseLinear):
        return 0.0
    angle = max(0.0, speed.time[0]) * abs(speed.value[0])
    for t0, t1 in zip(speed.time, speed.time[1:], strict=False):
        if t1 > 0:
            t0 = max(t0, 0.0)
            middle = 0.5 * (t0 + t1)
            angle += (t1 - t0) * abs(speed.at(middle))
    return angle / (2 * math.pi)


RIGID_LEAVES = (*OF_MASS, "load")


def _others_options(table, kind: type) -> list[str]:
    """Options from outside in a table of a `kind` that are not of its model."""
    added = {f.name for f in fields(table)} - {f.name for f in fields(kind)}
    return [name for name in added if name != table.model]


def unused(scene, given: set[str]) -> list[str]:
    """Known keys, dotted and sorted, that were `given` (dotted) and that this scene does not use."""
    leaves = []
    for name, ring in (("rotor", scene.rotor), ("stator", scene.stator)):
        if ring.support is None:
            kept = ("body",) if scene.film.heat is not None and name in scene.film.heat.rings else ()
            leaves += [f"{name}.{key}" for key in RIGID_LEAVES if key not in kept]
            leaves += [f"initial.{name}.", f"{name}.secondary_seal."]
        elif not ring.support.tilt_difference():
            leaves.append(f"{name}.support.tilt_axis")
    if scene.rotor.support is None:
        leaves += ["rotor.misalignment", "rotor.misalignment_phase"]
    else:
        leaves += ["rotor.runout", "rotor.runout_phase"]
    if not any(ring.support and ring.mass_centre for ring in (scene.rotor, scene.stator)):
        leaves += ["housing.gravity", "housing.gravity_direction"]
    elif not scene.housing.gravity:
        leaves.append("housing.gravity_direction")
    grooved = bool(grooves_of(scene)[1])
    if scene.film.model != "reynolds" and not grooved:
        leaves.append("film.reynolds.")
    cells = ("gas_reynolds.cells", "reynolds.cells_r", "reynolds.cells_theta", "reynolds.grid_accuracy")
    leaves += [f"film.{key}" for key in (cells if grooved else ("gas_reynolds.columns", "reynolds.columns"))]
    if scene.film.gas is not None:
        leaves += [f"film.{key}" for key in ("density", "specific_heat", "vapour_pressure", "coefficients")]
        leaves += [f"film.{name}." for name in ("gas_dam", "gas_reynolds") if scene.film.model not in (name, "auto")]
    if scene.film.model != "tabulated":
        leaves.append("film.tabulated.")
    leaves += [f"film.{name}." for name in _others_options(scene.film, Film)]
    for name, load in (("rotor", scene.rotor.load), ("stator", scene.stator.load)):
        leaves += [f"{name}.load.{other}." for other in (_others_options(load, Load) if load is not None else ())]
    if scene.film.model != "linear":
        leaves.append("film.coefficients")
    elif scene.film.coefficients != "radial":
        leaves += ["film.geometry", "film.cavitation_pressure"]
    beginnings = tuple(leaf.rstrip(".") + "." for leaf in leaves)
    return sorted(key for key in given if (key + ".").startswith(beginnings))
