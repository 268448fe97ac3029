"""Numbers without a unit that no seal has: what each is read as, in the unit that may have been meant."""

import math
from typing import NamedTuple

from ..numerics.piecewise_linear import initially, points


class Usual(NamedTuple):
    """What a number without a unit is of seals, from `least` to `most` in its SI `unit`; else it may be one in the unit
    `shown`, of which SI values less `zero` are `factor` times as many."""

    least: float
    most: float
    unit: str
    shown: str
    factor: float
    zero: float = 0.0


WEARS = Usual(0.0, 1e-11, "1/Pa", "mm^3/(N m)", 1e9)
SMALL_ANGLE = Usual(-0.02, 0.02, "rad", "mrad", 1e3)
ABSOLUTE = Usual(1e3, 1e9, "Pa", "bar", 1e-5)
OF_A_FACE = Usual(0.0, 1.0, "m", "mm", 1e3)
OF_A_RING = Usual(0.0, 100.0, "kg", "g", 1e3)
STIFF = Usual(100.0, 1e12, "N/m", "N/mm", 1e-3)
USUAL = {
    "film.viscosity": Usual(1e-6, 0.1, "Pa s", "cP", 1e3),
    "film.temperature": Usual(273.0, 330.0, "K", "degC", 1.0, 273.15),
    "film.outer_pressure": ABSOLUTE, "film.inner_pressure": ABSOLUTE,
    "film.outer_radius": OF_A_FACE, "film.inner_radius": OF_A_FACE,
    "film.coning": SMALL_ANGLE, "rotor.runout": SMALL_ANGLE,
    "rotor.misalignment": SMALL_ANGLE, "stator.misalignment": SMALL_ANGLE,
    "closing.balance_ratio": Usual(0.0, 3.0, "", "%", 100.0),
    "rotor.support.radius": OF_A_FACE, "stator.support.radius": OF_A_FACE,
    "rotor.support.axial_stiffness": STIFF, "stator.support.axial_stiffness": STIFF,
    "rotor.body.length": OF_A_FACE, "stator.body.length": OF_A_FACE,
    "rotor.body.inner_radius": OF_A_FACE, "stator.body.inner_radius": OF_A_FACE,
    "rotor.body.outer_radius": OF_A_FACE, "stator.body.outer_radius": OF_A_FACE,
    "film.density": Usual(100.0, 1e5, "kg/m^3", "g/cm^3", 1e-3),
    "film.specific_heat": Usual(100.0, 1e5, "J/(kg K)", "kJ/(kg K)", 1e-3),
    "rotor.mass": OF_A_RING, "stator.mass": OF_A_RING,
    "contact.roughness": Usual(0.0, 1e-5, "m", "um", 1e6),
    "contact.compressive_strength": Usual(1e6, 1e12, "Pa", "MPa", 1e-6),
    "contact.stator_wear_coefficient": WEARS, "contact.rotor_wear_coefficient": WEARS,
}  # fmt: skip


def slips(scenario) -> list[str]:
    """Sentences on the bare numbers of a Scenario where a unit is usual, or of another size than seals have."""
    said, scene = [], scenario.scene
    for ring, speed in (("shaft", scene.shaft.speed), ("stator", scene.stator.speed)):
        if f"{ring}.speed" in scenario.bare:
            fastest = max(points(speed), key=abs)
            read = f"{fastest:g} rad/s, which is {fastest * 30.0 / math.pi:.6g} rpm"
            said.append(f"{ring}.speed without a unit is read as {read}")
    for key, usual in USUAL.items():
        written = next((name for name in (key, key.replace("_radius", "_diameter")) if name in scenario.bare), None)
        value = _held(scene, key) if written else None
        if value is not None and not usual.least <= value <= usual.most:
            value *= 1.0 if written == key else 2.0
            shown = (value - usual.zero) * usual.factor
            read = f"{f'{value:.6g} {usual.unit}'.strip()}, which is {shown:.6g} {usual.shown}"
            said.append(f"{written} without a unit is read as {read}")
    return said


def _held(scene, key: str) -> float | None:
    """The value at a dotted key, of a table its first one; None where there is none."""
    for name in key.split("."):
        scene = getattr(scene, name, None)
    return None if scene is None else initially(scene)
