"""Unit parsing: "10 um", "9550 rpm", "5 bar" become SI floats; the field types of the scenario's tables.

A bare number is SI.  A string needs a unit.  Angles are counted: a revolution is 2 pi rad and Hz and rpm are
revolutions per time, so a speed in Hz and a frequency in rad/s both come out right.
"""

import math
import re
from collections.abc import Callable
from dataclasses import dataclass, is_dataclass
from decimal import Decimal, DecimalException
from functools import cache
from typing import Annotated, Any, NamedTuple, get_args

from .numerics.piecewise_linear import PiecewiseLinear
from .unit_names import dimension_and_factor, spelled_like, unknown_unit

NUMBER = re.compile(r"([+-]?(?:[0-9]+\.?[0-9]*|\.[0-9]+)(?:[eE][+-]?[0-9]{1,4})?)\s*(.*)", re.DOTALL)
# Points of a table and entries of a list, at most.
MOST_POINTS, MOST_LISTED = 20_000, 200_000
# A unit of pressure that counts from the air's, "barg", "bar(g)", "psi gauge", and that pressure (Pa).
GAUGE = re.compile(r"(.+?) ?(?:\([gG]\)|\(?\bgau?ge\b\)?)|(\w*(?:bar|psi|Pa|atm)) ?[gG]")
AIR = 101325


class QuantityError(ValueError):
    """A value that is not what its key asks for: what was found, what is expected."""

    def __init__(self, found: str, expected: str):
        super().__init__(found, expected)
        self.found, self.expected = found, expected

    def __str__(self):
        return f"found {self.found}; expected {self.expected}"


class Usual(NamedTuple):
    """Sizes of a number of seals from `least` to `most` (SI), beside 0: one without a unit that is of no such size may
    have been meant in the unit `meant`."""

    least: float
    most: float
    meant: str

    def takes(self, value: float) -> bool:
        """Whether a value is usual."""
        return value == 0.0 or self.least <= abs(value) <= self.most


class ReadFromFile:
    """What pydantic reads by its `read`; nothing of pydantic is imported before it asks."""

    read: Callable

    def __get_pydantic_core_schema__(self, source, handler):
        from pydantic_core import core_schema

        return core_schema.no_info_plain_validator_function(self.read)


@dataclass(frozen=True)
class Quantity(ReadFromFile):
    """What a key holds: its name, SI unit, an example for messages, other units it takes at the same factor (`also`),
    its `least` value (SI), itself excluded if `open`, and what is `usual`."""

    name: str
    unit: str
    example: str
    also: tuple[str, ...] = ()
    least: float = -math.inf
    open: bool = False
    usual: Usual | None = None

    def as_meant(self, value: float) -> str:
        """A value (SI) with the unit in which a number without one may have been meant."""
        zero, one = (self._from_string(f"{n} {self.usual.meant}") for n in (0, 1))
        return f"{(value - zero) / (one - zero):.6g} {self.usual.meant}"

    def read(self, value: Any) -> float:
        """SI value (float) of a number in SI or of a string with a unit.  Raises `QuantityError`: no number, another
        dimension, not finite, below the least value."""
        if isinstance(value, str):
            return self._limited(self._from_string(value), value)
        if isinstance(value, bool) or not isinstance(value, (int, float)):
            raise QuantityError(quoted(value), self.expected())
        try:
            return self._limited(float(value), value)
        except OverflowError:
            raise QuantityError("a number beyond 1e308", self.expected()) from None

    def expected(self) -> str:
        """What the key expects, in words, for a message."""
        article = "an" if self.name[0] in "aeiou" else "a"
        limit = "" if self.least == -math.inf else f" {'>' if self.open else '>='} {self.least:g}"
        return f"{article} {self.name}{limit} in {self.unit} or with its unit, e.g. {self.example}"

    def _limited(self, value: float, found: Any) -> float:
        """The value, if it can be; `found` as it was written."""
        if not math.isfinite(value):
            raise QuantityError(quoted(found), f"a finite {self.name}")
        if value < self.least or (self.open and value == self.least):
            raise QuantityError(quoted(found), self.expected())
        return value

    def _from_string(self, text: str) -> float:
        number, unit = self._split(text)
        try:
            dimension, factor = dimension_and_factor(unit)
        except ValueError:
            raise QuantityError(f"{quoted(text)} ({unknown_unit(unit)})", self.expected()) from None
        if dimension not in [dimension_and_factor(u)[0] for u in (self.unit, *self.also)]:
            raise QuantityError(f"{quoted(text)} ({_named(dimension)})", self.expected())
        try:
            return float(Decimal(number) * factor / dimension_and_factor(self.unit)[1])
        except (DecimalException, OverflowError):
            raise QuantityError(quoted(text), f"a finite {self.name}") from None

    def _split(self, text: str) -> tuple[str, str]:
        """Number and unit of a string, with this quantity's own reading of `g`."""
        match = _number_and_unit(text) if len(text) < 200 else None
        if not match:
            raise QuantityError(quoted(text), self.expected())
        number, unit = match[1], match[2]
        if not unit:
            raise QuantityError(f"{quoted(text)} (no unit)", self.expected())
        unit = RAISED.sub(lambda found: "^" + found[0].translate(POWERS), unit.translate(UNICODE_UNITS))
        if self.name.startswith("acceleration"):
            # The field's g is standard gravity; elsewhere g is the gram.
            unit = re.sub(r"\b([mu]?)g\b", r"\1standard_gravity", unit)
        if re.search(r"\bTIR\b", unit):
            raise QuantityError(
                f"{quoted(text)} (total indicator reading)", f"{self.expected()}; TIR: rotor.runout only"
            )
        return number, unit

    def __get_pydantic_json_schema__(self, schema, handler) -> dict:
        number = {"type": "number"}
        if self.least > -math.inf:
            number["exclusiveMinimum" if self.open else "minimum"] = self.least
        text = {"type": "string", "pattern": r"^\s*[+-]?(\d+\.?\d*|\.\d+)([eE][+-]?\d+)?\s*\S"}
        return {"description": self.expected(), "quantity": self.name, "unit": self.unit, "anyOf": [number, text]}


class TemperatureScale(Quantity):
    """A temperature: in kelvin, or on a scale with another zero."""

    def _from_string(self, text: str) -> float:
        number, unit = self._split(text)
        # Degrees per kelvin, and where absolute zero lies.
        celsius, fahrenheit = ("1", "273.15"), ("1.8", "459.67")
        scale = {"degc": celsius, "c": celsius, "deg c": celsius, "celsius": celsius, "degf": fahrenheit,
                 "f": fahrenheit, "deg f": fahrenheit, "fahrenheit": fahrenheit}.get(unit.lower())  # fmt: skip
        if scale is None:
            if re.search("deg[CF]", unit):
                raise QuantityError(f"{quoted(text)} (a scale with another zero)", self.expected())
            return super()._from_string(text)
        degrees, zero = map(Decimal, scale)
        return float((Decimal(number) + zero) / degrees)


class AbsolutePressure(Quantity):
    """A pressure: absolute, or above the air's standard 1.01325 bar where its unit says gauge ("5 barg", "70 psig")."""

    def _from_string(self, text: str) -> float:
        number, unit = self._split(text)
        if not (gauge := GAUGE.fullmatch(unit)):
            return super()._from_string(text)
        above = Quantity("pressure", self.unit, self.example)
        return float(Decimal(above.read(f"{number} {gauge[1] or gauge[2]}")) + AIR)


def is_gauge(value: Any) -> bool:
    """Whether a value as written, or any of a table's, is a gauge pressure."""
    if isinstance(value, dict):
        value = value.get("value")
    written = [match[2] for entry in (value if isinstance(value, list) else [value])
               if isinstance(entry, str) and (match := _number_and_unit(entry))]  # fmt: skip
    return any(map(GAUGE.fullmatch, written))


def _number_and_unit(text: str) -> re.Match | None:
    """NUMBER of a string, a typeset minus included."""
    return NUMBER.fullmatch(text.strip().replace(MINUS, "-"))


class RadiusQuantity(Quantity):
    """A radius: its key, "outer_radius", has a twin, "outer_diameter", as drawings have it."""


class SampleTime(Quantity):
    """Times of samples: usual is what lies between them."""


# Of typeset text.
MINUS, RAISED = "\N{MINUS SIGN}", re.compile("⁻?[¹²³⁴]")
POWERS = str.maketrans("⁻¹²³⁴", "-1234")
SAME_UNITS = {"µ": "u", "μ": "u", "·": "*", "⋅": "*", "×": "*", "°": "deg", MINUS: "-"}
UNICODE_UNITS = str.maketrans(SAME_UNITS | dict.fromkeys("\t\u00a0\u202f", " "))


def printable(words: str, kept: str = "") -> str:
    """Words without what a terminal would obey or cannot show, but for the characters `kept`: codes that move its
    cursor or colour it, line breaks, directions of script, halves of characters; each is told as Python writes it."""
    return "".join(c if c.isprintable() or c in kept else repr(c)[1:-1] for c in words)


def cut(words: str, most: int = 160) -> str:
    """Words of a readable length: of longer ones the beginning and the end."""
    return words if len(words) <= most else f"{words[: most * 3 // 4]} ... {words[-most // 5 :]}"


def quoted(value: Any, most: int = 60) -> str:
    """What a file held, in a few printable words; at most `most` characters."""
    if isinstance(value, dict) or is_dataclass(value):
        return "a table"
    if isinstance(value, (list, tuple)):
        return "a list"
    if isinstance(value, bool):
        return "true" if value else "false"
    try:
        text = f'"{value}"' if isinstance(value, str) else f"{value}"
    except ValueError:  # Python does not print integers of thousands of digits
        return "a number of thousands of digits"
    text = printable(text[:most])
    return text if len(text) < most else text[: most - 3] + "..."


@dataclass(frozen=True)
class VaryingQuantity(ReadFromFile):
    """A `Quantity` that may also be a function of time, `PiecewiseLinear`."""

    quantity: Quantity

    def read(self, value: Any) -> "float | PiecewiseLinear":
        """Float in SI, or `PiecewiseLinear` of a `{ time = [...], value = [...] }`.  Raises `QuantityError`."""
        if isinstance(value, PiecewiseLinear):
            value = {"time": list(value.time), "value": list(value.value)}
        return self._table(value) if isinstance(value, dict) else self._constant(value)

    def _constant(self, value: Any) -> float:
        try:
            return self.quantity.read(value)
        except QuantityError as error:
            if isinstance(value, list):
                raise QuantityError(error.found, "a number, or a table { time = [...], value = [...] }") from None
            raise

    def _table(self, value: dict) -> PiecewiseLinear:
        form = "a table { time = [...], value = [...] }"
        for key in value:
            if key not in ("time", "value"):
                near = spelled_like(key, ["time", "value"])
                raise QuantityError(f"key {quoted(key)}", form + (f"; nearest key {near[0]!r}" if near else ""))
        for key in ("time", "value"):
            if not isinstance(value.get(key), list):
                found = quoted(value[key]) if key in value else "nothing"
                raise QuantityError(f"{key} = {found}", form)
            if len(value[key]) > MOST_POINTS:
                few = f"at most {MOST_POINTS} points, a run starts anew at each"
                raise QuantityError(f"a table of {len(value[key])} points", few)
        return self._checked(entries(SECONDS, value["time"], "time"), entries(self.quantity, value["value"], "value"))

    @staticmethod
    def _checked(time: tuple[float, ...], value: tuple[float, ...]) -> PiecewiseLinear:
        if len(time) != len(value):
            raise QuantityError(f"{len(time)} times and {len(value)} values", "as many times as values")
        if len(time) < 2:
            raise QuantityError(f"a table of {len(time)} point(s)", "at least 2 points")
        for k in range(1, len(time)):
            if time[k] < time[k - 1]:
                raise QuantityError(f"time {time[k]:g} s after {time[k - 1]:g} s", "times that do not decrease")
            if k > 1 and time[k] == time[k - 2]:
                raise QuantityError(f"time {time[k]:g} s three times", "a time at most twice (a step)")
        return PiecewiseLinear(time, value)

    def __get_pydantic_json_schema__(self, schema, handler) -> dict:
        constant = self.quantity.__get_pydantic_json_schema__(None, None)
        column = {"type": "array", "minItems": 2, "maxItems": MOST_POINTS, "items": {"anyOf": constant["anyOf"]}}
        seconds = column | {"items": SECONDS.__get_pydantic_json_schema__(None, None)}
        table = {
            "type": "object",
            "properties": {"time": seconds, "value": column},
            "required": ["time", "value"],
            "additionalProperties": False,
        }
        return constant | {
            "description": constant["description"] + "; or a table of times",
            "anyOf": [*constant["anyOf"], table],
        }


def entries(quantity: Quantity, column: list, name: str = "") -> tuple[float, ...]:
    """SI values of the entries of a list, called `name` in messages.  Raises `QuantityError` that tells which."""
    values = []
    for k, entry in enumerate(column):
        try:
            values.append(quantity.read(entry))
        except QuantityError as error:
            found = f"{name}[{k}] = {error.found}" if name else f"{error.found} as entry {k + 1}"
            raise QuantityError(found, error.expected) from None
    return tuple(values)


def quantity_of(holds: Any) -> "Quantity | None":
    """The quantity that a field of type `holds` is one or several of, constant or not; None for plain numbers."""
    for kind in (holds, *get_args(holds)):
        # Only `Annotated` types have metadata.
        for part in getattr(kind, "__metadata__", ()):
            found = part if isinstance(part, Quantity) else getattr(part, "quantity", None)
            if isinstance(found, Quantity):
                return found
    return None


class Varying:
    """`Varying[X]`: the field type of an X that may be a function of time."""

    def __class_getitem__(cls, kind):
        return Annotated[float | PiecewiseLinear, VaryingQuantity(kind.__metadata__[0])]


@dataclass(frozen=True)
class ListedQuantity(ReadFromFile):
    """Several of a `Quantity`: a list, or, where `alone`, also one that stands for all."""

    quantity: Quantity
    alone: bool = False

    def read(self, value: Any) -> "float | tuple[float, ...]":
        """Floats in SI.  Raises `QuantityError`."""
        if self.alone and not isinstance(value, list | tuple):
            return self.quantity.read(value)
        if not isinstance(value, list | tuple):
            raise QuantityError(quoted(value), self.expected())
        if len(value) > MOST_LISTED:
            raise QuantityError(f"a list of {len(value)}", f"at most {MOST_LISTED}")
        return entries(self.quantity, value)

    def expected(self) -> str:
        """What the key expects, in words, for a message."""
        one = self.quantity.expected()
        return f"{one}, or a list of them" if self.alone else f"a list, each {one}"

    def __get_pydantic_json_schema__(self, schema, handler) -> dict:
        entry = self.quantity.__get_pydantic_json_schema__(None, None)
        about = {"description": self.expected(), "quantity": self.quantity.name, "unit": self.quantity.unit}
        column = {"type": "array", "maxItems": MOST_LISTED, "items": entry}
        return about | ({"anyOf": [*entry["anyOf"], column]} if self.alone else column)


class Listed:
    """`Listed[X]`: the field type of a list of X."""

    def __class_getitem__(cls, kind):
        return Annotated[tuple[float, ...], ListedQuantity(kind.__metadata__[0])]


class OneOrListed:
    """`OneOrListed[X]`: the field type of an X or a list of them."""

    def __class_getitem__(cls, kind):
        return Annotated[float | tuple[float, ...], ListedQuantity(kind.__metadata__[0], alone=True)]


# Sizes are those of seals from a millimetre to a metre, of any fluid, with room; of what people write in one of two
# units of a like size, none is usual.
ANGLES, DEGREES = '"25 urad", "0.5 mrad", "1 deg"', '"300 K", "20 degC", "800 degF"'
ROTATION = '"1000 rad/s", "9550 rpm", "150 Hz"'
# fmt: off
Time = Annotated[float, Quantity("time", "s", '"0.5 s"', usual=Usual(1e-6, 1e4, "ms"))]
SECONDS = Time.__metadata__[0]
# Of samples of a vibration there are more than a hundred a second.
Sample = Annotated[float, SampleTime("time", "s", '"0.5 s"', usual=Usual(1e-9, 1e-2, "ms"))]
# Of films and what is on a face it is a Height, of lapped faces Roughness, of vibration Displacement.
Length = Annotated[float, Quantity("length", "m", '"10 um"', usual=Usual(1e-9, 1.0, "mm"))]
Height = Annotated[float, Quantity("length", "m", '"10 um"', usual=Usual(1e-9, 1e-3, "um"))]
Roughness = Annotated[float, Quantity("length", "m", '"10 um"', usual=Usual(1e-10, 1e-5, "um"))]
Displacement = Annotated[float, Quantity("length", "m", '"10 um"', usual=Usual(1e-12, 0.05, "um"))]
Radius = Annotated[float, RadiusQuantity("length", "m", '"32 mm"', usual=Usual(1e-4, 1.0, "mm"))]
Angle = Annotated[float, Quantity("angle", "rad", ANGLES, ("m/m",), usual=Usual(0.0, 6.3, "deg"))]
# Up to which the equations hold, which are linear in it.
Tilt = Annotated[float, Quantity("angle", "rad", ANGLES, ("m/m",), usual=Usual(0.0, 0.02, "mrad"))]
ConingPerSpeedSquared = Annotated[float, Quantity(
    "coning per speed squared", "s^2/rad", '"2e-9 s^2/rad", "2e-5 urad/rpm^2"', ("s^2",),
    usual=Usual(0.0, 1e-6, "urad/rpm^2"))]
ConingPerKelvin = Annotated[float, Quantity("coning per temperature", "rad/K", '"5 urad/K"',
    usual=Usual(0.0, 1e-3, "urad/K"))]
Speed = Annotated[float, Quantity("speed of rotation", "rad/s", ROTATION, usual=Usual(math.inf, math.inf, "rpm"))]
TiltRate = Annotated[float, Quantity("speed of rotation", "rad/s", ROTATION, usual=Usual(0.0, 100.0, "deg/s"))]
Frequency = Annotated[float, Quantity("frequency", "Hz", '"50 Hz", "3000 rpm", "314 rad/s"', (), 0, True,
    usual=Usual(1e-3, 1e6, "kHz"))]
Velocity = Annotated[float, Quantity("velocity", "m/s", '"1 mm/s"', usual=Usual(0.0, 10.0, "mm/s"))]
Acceleration = Annotated[float, Quantity("acceleration", "m/s^2", '"20 m/s^2", "2 g"', usual=Usual(1e-6, 1e4, "g"))]
AngularAcceleration = Annotated[float, Quantity("angular acceleration", "rad/s^2", '"30 rad/s^2"',
    usual=Usual(1e-6, 1e6, "deg/s^2"))]
AccelerationDensity = Annotated[float, Quantity(
    "acceleration density", "(m/s^2)^2/Hz", '"0.1 g^2/Hz", "10 (m/s^2)^2/Hz"', (), 0, True,
    usual=Usual(1e-9, 1e5, "g^2/Hz"))]
AngularAccelerationDensity = Annotated[float, Quantity(
    "angular acceleration density", "(rad/s^2)^2/Hz", '"1e4 (rad/s^2)^2/Hz"', (), 0, True,
    usual=Usual(1e-9, 1e9, "(deg/s^2)^2/Hz"))]
Mass = Annotated[float, Quantity("mass", "kg", '"1 kg"', (), 0, usual=Usual(1e-9, 100.0, "g"))]
Inertia = Annotated[float, Quantity("inertia", "kg*m^2", '"8e-4 kg*m^2"', (), 0, usual=Usual(1e-12, 10.0, "kg*mm^2"))]
Stiffness = Annotated[float, Quantity("stiffness", "N/m", '"5e5 N/m"', (), 0, usual=Usual(100.0, 1e12, "N/mm"))]
LineForce = Annotated[float, Quantity("force per length", "N/m", '"200 N/m"', (), 0, usual=Usual(1e-2, 1e6, "N/mm"))]
Damping = Annotated[float, Quantity("damping", "N*s/m", '"300 N*s/m"', (), 0, usual=Usual(1e-3, 1e9, "N*s/mm"))]
BendingStiffness = Annotated[float, Quantity("bending stiffness", "N*m^2", '"77 N*m^2"', (), 0,
    usual=Usual(1e-4, 1e7, "N*mm^2"))]
TiltStiffness = Annotated[float, Quantity("tilt stiffness", "N*m/rad", '"400 N*m/rad"', ("N*m",), 0,
    usual=Usual(1e-4, 1e9, "N*mm/rad"))]
TiltDamping = Annotated[float, Quantity("tilt damping", "N*m*s/rad", '"0.24 N*m*s/rad"', ("N*m*s",), 0,
    usual=Usual(1e-9, 1e6, "N*mm*s/rad"))]
AxialFilmStiffness = Annotated[float, Quantity("film stiffness", "N/m", '"5e7 N/m"', usual=Usual(1e3, 1e13, "N/um"))]
AxialFilmDamping = Annotated[float, Quantity("film damping", "N*s/m", '"3e4 N*s/m"', usual=Usual(1e-3, 1e10, "N*s/mm"))]
SignedTiltStiffness = Annotated[float, Quantity("tilt stiffness", "N*m/rad", '"400 N*m/rad"', ("N*m",),
    usual=Usual(1e-3, 1e9, "N*mm/rad"))]
SignedTiltDamping = Annotated[float, Quantity("tilt damping", "N*m*s/rad", '"0.24 N*m*s/rad"', ("N*m*s",),
    usual=Usual(1e-9, 1e6, "N*mm*s/rad"))]
Pressure = Annotated[float, AbsolutePressure("absolute pressure", "Pa", '"5 bar"', (), 0, usual=Usual(1e3, 1e9, "bar"))]
Stress = Annotated[float, Quantity("stress", "Pa", '"300 MPa"', (), 0, True, usual=Usual(1e4, 1e13, "MPa"))]
WearCoefficient = Annotated[float, Quantity("wear coefficient", "1/Pa", '"1e-15 1/Pa"', (), 0,
    usual=Usual(0.0, 1e-11, "mm^3/(N*m)"))]
AsperityDensity = Annotated[float, Quantity("number per area", "1/m^2", '"1e10 1/m^2"', (), 0, True,
    usual=Usual(1e6, 1e15, "1/mm^2"))]
Viscosity = Annotated[float, Quantity("viscosity", "Pa*s", '"0.5 mPa*s"', (), 0, True, usual=Usual(1e-6, 0.1, "mPa*s"))]
Temperature = Annotated[float, TemperatureScale("temperature", "K", DEGREES, (), 0, True,
    usual=Usual(273.0, 330.0, "degC"))]
Density = Annotated[float, Quantity("density", "kg/m^3", '"1000 kg/m^3"', (), 0, True,
    usual=Usual(100.0, 1e5, "g/cm^3"))]
SpecificHeat = Annotated[float, Quantity("specific heat", "J/(kg*K)", '"4180 J/(kg*K)"', (), 0, True,
    usual=Usual(100.0, 1e5, "kJ/(kg*K)"))]
Force = Annotated[float, Quantity("force", "N", '"50 N"', usual=Usual(1e-4, 1e6, "kN"))]
Moment = Annotated[float, Quantity("moment", "N*m", '"0.1 N*m"', usual=Usual(1e-6, 1e4, "N*mm"))]
VolumeFlow = Annotated[float, Quantity("volume flow", "m^3/s", '"5 cc/h", "1 l/min"', (), 0, True,
    usual=Usual(1e-18, 1e-2, "cc/h"))]
# fmt: on
# Pure numbers that some write in percent.
Share = Annotated[float, Usual(0.0, 3.0, "%")]


@cache
def _named(dimension: frozenset) -> str:
    """What a dimension is called, for a message."""
    if dimension == dimension_and_factor("1/s")[0]:
        return "says neither radians nor revolutions"
    for kind in [v for v in globals().values() if hasattr(v, "__metadata__")]:
        quantity = kind.__metadata__[0]
        if isinstance(quantity, Quantity) and dimension_and_factor(quantity.unit)[0] == dimension:
            return f"a unit of {quantity.name}"
    return "another dimension" if dimension else "a pure number"
