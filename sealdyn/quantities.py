"""Quantities: what each number of an answer is called, its SI unit, and the unit in which a person reads it.

One table serves the terminal, figures, pages, comparisons and archives; a number itself is SI wherever it is kept.
A quantity that is not in the table is named by its SI unit ("m", "rad/s"); "1" or "" has none.
"""

import math
import re
from collections.abc import Iterable, Mapping
from contextlib import contextmanager
from contextvars import ContextVar
from types import MappingProxyType
from typing import NamedTuple

RPM, HERTZ, DEGREES = 30 / math.pi, 0.5 / math.pi, 180 / math.pi

# Units that go before the table, {quantity or SI unit: unit}.
_READ_IN: ContextVar[Mapping[str, str]] = ContextVar("read_in", default=MappingProxyType({}))


class Quantity(NamedTuple):
    """`unit` (SI), long `name`, the unit `shown` to a person with its `factor` ("": by size, SIZES), and the `scale` on
    which a run's accuracy bounds its error: "clearance", "tilt" (clearance over outer radius), "" for none."""

    unit: str
    name: str = ""
    shown: str = ""
    factor: float = 1.0
    scale: str = ""


# SI unit -> units from the size (SI) on at which they begin, the smallest first, with the factor.
SIZES = {
    "m": ((0.0, "nm", 1e9), (5e-8, "um", 1e6), (1e-3, "mm", 1e3)),
    "rad": ((0.0, "nrad", 1e9), (5e-8, "urad", 1e6), (1e-3, "mrad", 1e3)),
    "rad/s": ((0.0, "rpm", RPM),),
    "Pa": ((0.0, "Pa", 1.0), (1e3, "bar", 1e-5)),
    "Pa*s": ((0.0, "uPa s", 1e6), (1e-4, "mPa s", 1e3)),
    "m^3/s": ((0.0, "ml/h", 3.6e9), (1e-5, "l/min", 6e4)),
    "kg/s": ((0.0, "g/h", 3.6e6), (1e-3, "kg/h", 3600.0)),
    "m^3": ((0.0, "mm^3", 1e9),),
    "m^2": ((0.0, "mm^2", 1e6),),
    "s": ((0.0, "us", 1e6), (1e-4, "ms", 1e3), (1.0, "s", 1.0), (600.0, "min", 1 / 60), (7200.0, "h", 1 / 3600)),
    "N/m": ((0.0, "N/um", 1e-6), (1e11, "kN/um", 1e-9)),
    "N m/rad": ((0.0, "N m/rad", 1.0), (1e4, "kN m/rad", 1e-3), (1e7, "MN m/rad", 1e-6)),
    "N m s/rad": ((0.0, "N m s/rad", 1.0), (1e4, "kN m s/rad", 1e-3), (1e6, "MN m s/rad", 1e-6)),
    "m/s": ((0.0, "um/s", 1e6), (1e-3, "mm/s", 1e3), (1.0, "m/s", 1.0)),
    "Pa*m/s": ((0.0, "kPa m/s", 1e-3), (1e4, "MPa m/s", 1e-6)),
    "B": ((0.0, "MB", 1e-6), (1e9, "GB", 1e-9)),
}

# SI unit -> unit of a series of any size: what archives say.
EVERYDAY = {"m": "um", "rad": "urad", "m/s": "mm/s", "m^3/s": "ml/h", "kg/s": "g/h", "Pa": "MPa"}
# Units that people write, beside those of SIZES: how many make one of SI.
WRITTEN = {
    "m": {"mil": 1e3 / 0.0254, "in": 1 / 0.0254, "uin": 1e6 / 0.0254, "inch": 1 / 0.0254},
    "rad": {"deg": DEGREES, "arcmin": 60 * DEGREES, "arcsec": 3600 * DEGREES},
    "Pa": {"kPa": 1e-3, "MPa": 1e-6, "psi": 0.0254**2 / (0.45359237 * 9.80665), "atm": 1 / 101325},
}
# As print has it, in place of what a terminal shows.
PRINT = ((re.compile(r"\bu(m|rad|s)\b"), r"µ\1"), (re.compile(r" deg\b"), "°"), (re.compile(r"\^2\b"), "²"),
         (re.compile(r"\^3\b"), "³"))  # fmt: skip

QUANTITIES = {
    # Film and faces
    "clearance": Quantity("m", "clearance", scale="clearance"),
    "h_min": Quantity("m", "thinnest film", "um", 1e6, "clearance"),
    "film_thickness": Quantity("m", "film thickness", "um", 1e6, "clearance"),
    "largest_gap": Quantity("m", "largest gap", "um", 1e6, "clearance"),
    "depth": Quantity("m", "depth"),
    "travel": Quantity("m", "travel", "um", 1e6),
    "radius": Quantity("m", "radius", "mm", 1e3),
    "misalignment": Quantity("rad", "relative misalignment", scale="tilt"),
    "tilt": Quantity("rad", "tilt", scale="tilt"),
    "angle": Quantity("rad", "angle", "deg", DEGREES),
    "phase": Quantity("deg", "phase", "deg", 1.0),
    "pressure": Quantity("Pa", "pressure", "bar", 1e-5),
    "contact_pressure": Quantity("Pa", "contact pressure", "MPa", 1e-6),
    "leakage": Quantity("m^3/s", "leakage"),
    "mass_flow": Quantity("kg/s", "mass flow", "kg/h", 3600.0),
    "cavitated_fraction": Quantity("1", "cavitated share of the face", "%", 100.0),
    "share": Quantity("1", "share", "%", 100.0),
    "viscosity": Quantity("Pa*s", "viscosity"),
    # Forces and power
    "force": Quantity("N", "force", "N", 1.0),
    "moment": Quantity("N m", "moment", "N m", 1.0),
    "torque": Quantity("N m", "torque", "N m", 1.0),
    "friction_torque": Quantity("N m", "friction torque", "mN m", 1e3),
    "power": Quantity("W", "power", "W", 1.0),
    "coning_per_watt": Quantity("rad/W", "coning over heat", "urad/W", 1e6),
    "heat_flux": Quantity("W/m^2", "heat flux", "W/cm^2", 1e-4),
    "force_per_length": Quantity("N/m", "force per length", "N/m", 1.0),
    "friction_power": Quantity("W", "friction", "W", 1.0),
    "axial_stiffness": Quantity("N/m", "axial stiffness"),
    "axial_damping": Quantity("N s/m", "axial damping", "N s/m", 1.0),
    "tilt_stiffness": Quantity("N m/rad", "tilt stiffness"),
    "tilt_damping": Quantity("N m s/rad", "tilt damping"),
    "wear_rate": Quantity("m/s", "wear rate", "um/h", 3.6e9),
    "volume": Quantity("m^3", "volume"),
    # Motion
    "time": Quantity("s", "time"),
    "count": Quantity("1", "runs"),
    "turns": Quantity("1", "turns of the shaft"),
    "speed": Quantity("rad/s", "shaft speed"),
    "speed_rpm": Quantity("rad/s", "shaft speed", "rpm", RPM),
    "speed_ramp": Quantity("rad/s^2", "ramp rate", "rpm/s", RPM),
    "pressure_ramp": Quantity("Pa/s", "ramp rate", "bar/s", 1e-5),
    "frequency": Quantity("rad/s", "frequency", "Hz", HERTZ),
    "frequency_hz": Quantity("Hz", "frequency", "Hz", 1.0),
    "growth_rate": Quantity("1/s", "growth rate", "1/s", 1.0),
    "acceleration": Quantity("m/s^2", "acceleration", "g", 1 / 9.80665),
    "whirl_ratio": Quantity("1", "whirl ratio"),
    "log_decrement": Quantity("1", "logarithmic decrement"),
    "transmissibility": Quantity("rad/rad", "transmissibility", "", 1.0),
    "temperature": Quantity("K", "temperature", "K", 1.0),
}


def resolved(value: float, uncertainty: float) -> float:
    """A number, or 0 where it is not above its own uncertainty: what is left of rounding tells nothing, nor its
    sign."""
    return 0.0 if abs(value) <= uncertainty else value


def quantity(name: str) -> Quantity:
    """The quantity of a name, or one that an SI unit names ("N/m")."""
    return QUANTITIES.get(name) or Quantity(name or "1")


def units_read() -> dict[str, str]:
    """Units that go before the table here, {quantity or SI unit: unit}."""
    return dict(_READ_IN.get())


@contextmanager
def reading_in(units: Mapping[str, str] | None):
    """Within it numbers are read in these `units` {quantity or SI unit: unit}, as a person wrote them, which go before
    those around it and before the table."""
    token = _READ_IN.set({**_READ_IN.get(), **(units or {})})
    try:
        yield
    finally:
        _READ_IN.reset(token)


def shown_in(name: str, values: Iterable = ()) -> tuple[str, float]:
    """Unit in which `values` (SI) of a quantity are read, and its factor.

    The unit of `reading_in`, or the table's, or for a quantity of many sizes the one that suits the largest value.  ""
    of a pure number.
    """
    held, written = quantity(name), _READ_IN.get()
    asked = written.get(name) or (None if held.shown else written.get(held.unit))
    if asked and (factor := factor_of(held.unit, asked)):
        return asked, factor
    if held.shown or name == "transmissibility":
        return held.shown, held.factor
    size = max((abs(v) for v in values if isinstance(v, int | float) and math.isfinite(v)), default=0.0)
    sizes = SIZES.get(held.unit)
    if sizes is None:
        return ("" if held.unit in ("", "1", "rad/rad") else held.unit.replace("*", " ")), 1.0
    # Zeros are read in the unit of everyday, not in the finest.
    fits = [row for row in sizes if size >= row[0]]
    if size == 0.0 and sizes[0][1][0] in "nu":
        fits = sizes[1:2]
    _, unit, factor = fits[-1]
    return unit, factor


def everyday(name: str) -> tuple[str, float]:
    """Unit, as printed, in which a series of a quantity is read whatever its size, and its factor."""
    held = quantity(name)
    unit = held.shown or EVERYDAY.get(held.unit, held.unit)
    return printed(unit), factor_of(held.unit, unit) or 1.0


def by_size(unit: str, shown: str, factor: float, size: float) -> tuple[str, float]:
    """Unit, as printed, that suits a `size` (SI `unit`) in place of the everyday one; another `shown`, which somebody
    chose, stays with its factor."""
    if shown != everyday(unit)[0] or shown not in {printed(name) for _, name, _ in SIZES.get(unit, ())}:
        return shown, factor
    fits, per = shown_in(unit, [size])
    return printed(fits), per


def printed(words: str) -> str:
    """Words of a terminal with the units of print."""
    for told, letters in PRINT:
        words = told.sub(letters, words)
    return words


def factor_of(unit: str, shown: str) -> float | None:
    """How many of the unit `shown` make one of the SI `unit`, None where the table has no such pair."""
    if shown == unit:
        return 1.0
    sized = {name: factor for _, name, factor in SIZES.get(unit, ())}
    named = {held.shown: held.factor for held in QUANTITIES.values() if held.unit == unit and held.shown}
    return (WRITTEN.get(unit, {}) | sized | named).get(shown)


def written_alone(unit: str, shown: str) -> bool:
    """Whether somebody who writes an SI `unit` as `shown` wants to read all of them so: a unit other than those by
    size."""
    return shown in WRITTEN.get(unit, {})


def number(value: float | None, factor: float = 1.0, digits: int = 4, sign: str = "") -> str:
    """A number of so many digits, large ones up to seven figures without an exponent, also a positive one with its
    sign where `sign` is "+"; "-" of None."""
    if value is None or (isinstance(value, float) and math.isnan(value)):
        return "-"
    words = f"{value * factor:{sign}.{digits}g}"
    return f"{float(words):{sign}.0f}" if words.endswith(("e+03", "e+04", "e+05", "e+06")) else words


def in_words(name: str, value: float | None, digits: int = 4, sign: str = "") -> str:
    """A value (SI) with its unit: "4.898 mrad", "9549 rpm"; `sign` as in `number`."""
    unit, factor = shown_in(name, [value])
    return f"{number(value, factor, digits, sign)} {unit}".strip()
