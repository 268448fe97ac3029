"""What a designer chooses of a seal: the coning of its faces and the inertia ratio of a floating rotor, and what each
transmits then, at one speed; with Green's groups, as tables.

**Source** Green (1989): coning b = 12.5 of his seal is that of the stiffest film; his ratios c = I/J of 1/2 and 3.
"""

from dataclasses import replace

import numpy as np
from scipy.optimize import minimize_scalar

from ... import closed_form as cf
from ...answers import Table
from ...dynamics import modes
from ...dynamics.interface import prepared
from ...dynamics.linearisation import moves_with_speed
from ...scene.film import Coefficients, coned
from ...scene.rings import ROTOR
from ...scene.scene import frozen_at_start
from .arrangements import SEALS, Arrangement, groups

# Conings looked at, of the stiffest narrow film's; how well the best is found.  Ratios I/J, from the disk's on.
MOST, STEPS, LOCATED = 4.0, 5, 1e-4
RATIOS = (0.5, 0.6, 0.75, 1.0, 1.25, 1.5, 2.0, 2.5, 3.0, 4.0, 6.0, 10.0)


# Units of the numbers.
UNITS = {
    "groups/seal_parameter": "Pa", "over_coning/coning": "rad", "over_coning/of_thinnest": "1",
    "over_coning/tilt_stiffness": "N m/rad",
    "over_inertia_ratio/fmr/critical_speed": "rad/s",
    "over_inertia_ratio/ratio": "1", "over_inertia_ratio/stable_to": "1",
    **{f"over_{what}/{seal}": "1" for what in ("coning", "inertia_ratio") for seal in SEALS},
}  # fmt: skip


def choices(seals: dict[str, Arrangement], speed: float) -> dict:
    """Answers for one speed (rad/s): `groups`, `over_coning`, `over_inertia_ratio`; empty at rest."""
    kinds = {"groups": groups, "over_coning": over_coning, "over_inertia_ratio": over_inertia_ratio}
    return {name: kind(seals, speed) for name, kind in kinds.items()}


def over_coning(seals: dict[str, Arrangement], speed: float) -> list[dict]:
    """The scenario's `coning` (rad, of a film that widens towards the higher pressure), that of the stiffest narrow
    film by its closed form, and that of the stiffest film as it is, each with its thinnest place kept: `of`,
    `tilt_stiffness` (N m/rad), and totals `fmr`, `fms`, `fmsr` at a speed (rad/s), None without a steady state.
    None of them where no coning may be chosen: at rest, without a pressure, with a profile, heat, or coefficients that
    are given."""
    scene = seals["fmr"].scene
    film = scene.film
    drop = float(film.outer_pressure) - float(film.inner_pressure)
    given = film.profile or film.heat or isinstance(film.coefficients, Coefficients)
    if given or speed == 0.0 or drop == 0.0:
        return []
    scene = seals["fmr"].model.at_speed(speed).scene
    # Cells are those of the scenario's own faces.
    film = coned(replace(scene, film=prepared(scene, seals["fmr"].model.interface.film)), float, speed)
    width, sign = film.outer_radius - film.inner_radius, 1.0 if drop > 0 else -1.0
    low, high = (film.inner_radius, film.outer_radius)[:: int(sign)]
    thinnest = film.clearance + (0.0 if drop > 0 else film.coning * width)
    narrow = float(cf.optimum_coning(low, high, thinnest))

    def with_cone(coning, name="fmr"):
        clearance = thinnest + (0.0 if drop > 0 else coning * width)
        cone = replace(film, coning=sign * float(coning))
        return Arrangement(frozen_at_start(replace(seals[name].scene, film=cone), speed, clearance), name)

    def softness(coning):
        return -float(with_cone(coning).film_numbers(speed)[0])

    conings = {"the scenario": sign * float(film.coning), "stiffest narrow film": narrow}
    grid = np.linspace(0.0, MOST * narrow, STEPS)
    k = int(np.argmin([softness(coning) for coning in grid]))
    if 0 < k < STEPS - 1:
        ends, options = (grid[k - 1], grid[k + 1]), {"xatol": LOCATED * narrow}
        conings["stiffest film"] = float(minimize_scalar(softness, bounds=ends, method="bounded", options=options).x)
    found = []
    for of, coning in conings.items():
        held = {name: with_cone(coning, name) for name in SEALS}
        totals = {name: one.algebra(speed)[2] if one.growth(speed) < 0.0 else None for name, one in held.items()}
        row = {"of": of, "coning": coning, "of_thinnest": coning * film.outer_radius / thinnest}
        found.append({**row, "tilt_stiffness": -softness(coning), **totals})
    return found


def over_inertia_ratio(seals: dict[str, Arrangement], speed: float) -> dict:
    """Ratios I/J of a floating rotor (`ratio`), I kept, and what they give at a speed (rad/s): for `fmr` and `fmsr`
    lists of `dynamic` and `total` (None without a steady state), for `fmr` of `critical_speed` (rad/s, None where it
    never whirls and where no formula holds); `stable_to` the ratio up to which it is stable at every speed, by formula.
    {} at rest and for a rotor without inertia."""
    rotor = seals["fmr"].scene.rotor
    if speed == 0.0 or rotor.transverse_inertia == 0.0:
        return {}
    own = [rotor.transverse_inertia / rotor.polar_inertia] if rotor.polar_inertia else []
    found = {"ratio": sorted({*RATIOS, *own}), "stable_to": None}
    for name in ("fmr", "fmsr"):
        linear, columns = seals[name].linear(speed), {"dynamic": [], "total": []}
        for ratio in found["ratio"]:
            rings = [*linear.rings]
            rings[ROTOR] = replace(rings[ROTOR], polar=rings[ROTOR].inertia / ratio)
            other = modes.LinearScene(rings, linear.film_k, linear.film_d, linear.film, linear.doubt, linear.rest)
            steady = modes.growth([mode for mode in other.modes() if mode.kind == "tilt"]) < 0.0
            static, dynamic = map(abs, seals[name].relative_tilts(speed, other)) if steady else (None, None)
            columns["dynamic"].append(dynamic)
            columns["total"].append(static + dynamic if steady else None)
        found[name] = columns
    found["fmr"]["critical_speed"] = [None] * len(found["ratio"])
    numbers = seals["fmr"].tilt_numbers(speed)
    stiffness, damping = (numbers[f"support_{name}"] + numbers[f"film_{name}"] for name in ("stiffness", "damping"))
    if stiffness > 0.0 and damping > 0.0 and seals["fmr"].formula_holds(speed):
        both = {name: float(numbers[name]) for name in ("support_damping", "film_damping")}
        found["stable_to"] = cf.unconditional_inertia_ratio(**both)
        if not moves_with_speed(seals["fmr"].scene):
            del numbers["speed"], numbers["polar_inertia"]
            found["fmr"]["critical_speed"] = [
                cf.fmr_critical_speed(**numbers, polar_inertia=numbers["transverse_inertia"] / ratio)
                for ratio in found["ratio"]
            ]
    return found


# --- what is shown --------------------------------------------------------------------------------------


def choice_tables(numbers) -> list[Table]:
    """Green's groups, the best conings, and the inertia ratios: those that there are."""
    found, groups, coning, ratios = [], numbers["groups"], numbers["over_coning"], numbers["over_inertia_ratio"]
    if groups:
        names = ("seal_parameter", "radius_ratio", "coning", "pressure_drop")
        columns = [("pressure", "seal parameter S"), ("1", "radius ratio R"), ("1", "coning b"), ("1", "pressure drop")]
        found.append(Table("groups of the faces", columns, [[groups[name] for name in names]]))
        rows = [["film", "tilt", groups["film_stiffness"], groups["film_damping"], None, None]]
        for ring in ("rotor", "stator"):
            names = ("support_stiffness", "support_damping", "transverse_inertia", "inertia_ratio")
            rows.append([ring, "tilt", *(groups[ring][name] for name in names)])
        for of, axial in groups["axial"].items():
            rows.append([of, "axial", axial["stiffness"], axial["damping"], axial.get("mass"), None])
        columns = [("1", "of"), ("1", "motion"), ("1", "stiffness"), ("1", "damping"), ("1", "inertia"), ("1", "I/J")]
        found.append(Table("groups", columns, rows))
    if coning:
        columns = [("1", "of"), ("tilt", "coning"), ("1", "coning, C/r_o"), ("tilt_stiffness", "tilt stiffness"),
                   *(("transmissibility", f"{name.upper()} total") for name in SEALS)]  # fmt: skip
        rows = [list(row.values()) for row in coning]
        found.append(Table("coning", columns, rows))
    if ratios:
        kinds = {"dynamic": "transmissibility", "total": "transmissibility", "critical_speed": "speed"}
        columns, values = [("1", "I/J")], [ratios["ratio"]]
        for seal in ("fmr", "fmsr"):
            columns += [(kinds[name], f"{seal.upper()} {name.replace('_', ' ')}") for name in ratios[seal]]
            values += ratios[seal].values()
        found.append(Table("inertia ratio", columns, [list(row) for row in zip(*values, strict=True)]))
    return found
