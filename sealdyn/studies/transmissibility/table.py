"""FMR against FMS against FMSR at one speed, in the form of Green's Table 1, and his dimensionless groups."""

import numpy as np

from ... import closed_form as cf
from ...analysis.arrangements import SEALS, Arrangement, tilting
from ...dynamics.linearisation import moves_with_speed
from ...scene.coning import coned, coning_change
from ...scene.contact import touch_height
from ...scene.film import aligned_gaps
from ...scene.gas import viscosity_of
from ...simulation.stability import critical_speed
from .._words import plain
from .._words import speed as speed_words
from ..contact_onset import SMALL_TILT
from .curves import QUANTITIES

NAMES = {
    "static": "static_transmissibility",
    "dynamic": "dynamic_transmissibility",
    "total": "maximum_relative_misalignment",
}


def table(seals: dict[str, Arrangement], speed: float, by_formula: bool, rows: list[dict]) -> list[dict]:
    """The arrangements in the form of Green's Table 1, at one speed (rad/s), by every method there is."""
    roads = {"formula": {}, "linear_algebra": {}, "time_domain": {}}
    for name, seal in seals.items():
        roads["linear_algebra"][name] = [*seal.algebra(speed)]
        roads["formula"][name] = [float(v) for v in seal.formula(speed)] if by_formula else [None] * 3
        row = next((r for r in rows if r["seal"] == name and r["speed"] == speed and "failed" not in r), {})
        roads["time_domain"][name] = [row.get(q) for q in QUANTITIES]
    for road, both in roads.items():
        for name, values in both.items():
            values.append(min(critical_misalignments(seals[name], speed, values).values(), default=None))
            values.append(_critical_speed(seals[name], road, by_formula))
    kinds = [*((n, "1") for n in NAMES.values()), ("critical_misalignment", "C/r_o"), ("critical_speed", "rad/s")]

    def best(quantity, name):
        # A formula of the critical speed knows one gap only.
        moves = quantity == "critical_speed" and moves_with_speed(seals[name].scene.film)
        return "formula" if by_formula and not moves else "linear_algebra"

    return [
        {"quantity": quantity, "unit": unit, **{name: roads[best(quantity, name)][name][i] for name in SEALS}}
        | {road: {name: both[name][i] for name in SEALS} for road, both in roads.items()}
        for i, (quantity, unit) in enumerate(kinds)
    ]


# Keys of the misalignments that one arrangement has: what is static, what is dynamic; and of which a critical size is
# told, that of the rigid partner, of two floating rings both.
KEYS = {
    "fmr": ("stator.misalignment", "rotor.misalignment"),
    "fms": ("stator.misalignment", "rotor.runout"),
    "fmsr": ("stator.misalignment", "rotor.misalignment"),
}
PARTNERS = {"fmr": ("stator.misalignment",), "fms": ("rotor.runout",), "fmsr": KEYS["fmsr"]}


def critical_misalignments(seal: Arrangement, speed: float, values) -> dict[str, float]:
    """By its key, the misalignment of each of PARTNERS at first touch, of the asperities of rough faces, in units of
    C/r_o, the other key of KEYS being one such unit; from static and dynamic transmissibility, the first two of
    `values`; of none that closes the film, nor of faces that touch when aligned."""
    film, rough = seal.scene.film, touch_height(seal.scene)
    change = coning_change(seal.scene, float, speed)
    touch = min((h - rough) / r for r, h in aligned_gaps(film, film.clearance, change))
    if values[0] is None or touch <= 0.0:
        return {}
    found = {}
    for key in PARTNERS[seal.name]:
        forcing, own = (values[0], values[1]) if key == KEYS[seal.name][0] else (values[1], values[0])
        size = float(cf.critical_forcing(touch * film.outer_radius / film.clearance, own, forcing))
        if np.isfinite(size):
            found[key] = size
    return found


def critical_words(seals: dict[str, Arrangement], speed: float, rows: list[dict]) -> str:
    """Of which keys the critical misalignments of the `table` are, in a sentence."""
    row, said = {row["quantity"]: row for row in rows}, []
    for name, seal in seals.items():
        values = [row[NAMES[q]][name] for q in QUANTITIES]
        known = critical_misalignments(seal, speed, values)
        if not known:
            said.append(f"{name.upper()} none")
            continue
        key, film = min(known, key=known.get), seal.scene.film
        (other,) = (k for k in KEYS[name] if k != key)
        tilt = known[key] * film.clearance / film.outer_radius
        beyond = f" ({tilt:.2g} rad: beyond any small tilt, no limit)" if tilt > SMALL_TILT else ""
        smaller = ", the smaller of its two" if len(known) > 1 else ""
        said.append(f"{name.upper()} {key} {plain(known[key])} beside {other} 1{beyond}{smaller}")
    return f"Critical misalignment, at first touch, in C/r_o: {'; '.join(said)}."


def _critical_speed(seal: Arrangement, road: str, by_formula: bool) -> float | None:
    if road == "time_domain" or (road == "formula" and not by_formula):
        return None
    if road == "linear_algebra":
        return critical_speed(seal.model)
    if seal.name == "fmsr" or moves_with_speed(seal.scene.film):
        return None
    numbers = seal.tilt_numbers(1.0)
    numbers.pop("speed")
    try:
        return (cf.fmr_critical_speed if seal.name == "fmr" else cf.fms_critical_speed)(**numbers)
    except ValueError:
        return None


# --- what the film is, and the groups -----------------------------------------------------------------


def film_words(seals: dict[str, Arrangement], speed: float) -> str:
    """Film and its coefficients in tilt at a speed (rad/s), in a sentence; and what Green's figure needs."""
    seal = seals["fmr"]
    film, model = seal.scene.film, seal.model.interface.name
    k, d = (float(v) for v in seal.film_numbers(speed))
    words = f"Film {model}: {k:.5g} N m/rad, {d:.4g} N m s/rad in tilt at {speed_words(speed)}"
    if model == "linear" and film.coefficients == "green":
        return f"{words}, coefficients of the narrow seal as in Green's Fig. 8."
    return f'{words}; Green\'s Fig. 8 has those of the narrow seal (film.model = "linear").'


def groups(seals: dict[str, Arrangement], speed: float) -> dict:
    """Green's dimensionless groups at a speed (rad/s), {} at rest: those of faces and film, and of the rings on their
    supports, `rotor` and `stator`, as they float in the FMSR seal; what each is: closed_form/green_groups.py."""
    if speed == 0.0:
        return {}
    seal = seals["fmsr"]
    film = coned(seal.scene, float, speed)
    face = dict(
        speed=speed,
        viscosity=viscosity_of(film),
        inner_radius=film.inner_radius,
        outer_radius=film.outer_radius,
        clearance=film.clearance,
    )
    stiffness, damping = (float(v) for v in seal.film_numbers(speed))
    drop = film.outer_pressure - film.inner_pressure
    coefficients = {"film_stiffness": stiffness, "film_damping": damping}
    found = cf.film_groups(**face, coning=film.coning, pressure_drop=drop, **coefficients)
    for name in ("rotor", "stator"):
        found[name] = cf.ring_groups(**face, **tilting(getattr(seal.scene, name))._asdict())
        if not np.isfinite(found[name]["inertia_ratio"]):
            found[name]["inertia_ratio"] = None
    return found
