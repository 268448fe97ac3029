"""The `[application]` table: what a seal is asked to do.  No number of a run hangs on it; design rules read it.

**Source** the application data sheet of Hayden & Keller, NASA CR-120997 (1974), table 2.1.
"""

import math
import re
from dataclasses import dataclass, field
from typing import Annotated, Any, Literal

from ..units import Frequency, Pressure, Quantity, QuantityError, Temperature, Usual, VolumeFlow, entries, quoted
from . import Strict

Size = Annotated[float, Quantity("length", "m", '"40 mm"', (), 0, True, Usual(1e-3, 10.0, "mm"))]
OFF = Usual(1e-9, 1e-2, "mm")
Offset = Annotated[float, Quantity("length", "m", '"0.1 mm"', (), 0, usual=OFF)]
SpeedSize = Annotated[
    float,
    Quantity("speed of rotation", "rad/s", '"9550 rpm", "150 Hz"', (), 0, usual=Usual(math.inf, math.inf, "rpm")),
]
Life = Annotated[float, Quantity("time", "s", '"1500 h"', (), 0, True, Usual(1e5, 1e10, "h"))]
FREQUENCY = Frequency.__metadata__[0]
# Ranges of the data sheet: "lowest_" and "highest_" of these, and their SI units.
RANGES = {"speed": "rad/s", "temperature": "K", "pressure": "Pa"}


class Reading(Quantity):
    """A total indicator reading (m): a length, with or without the word TIR behind it."""

    def read(self, value: Any) -> float:
        """Metres from dial low to dial high.  Raises `QuantityError`."""
        return super().read(re.sub(r"\s*\bTIR\s*$", "", value) if isinstance(value, str) else value)


class Frequencies(Quantity):
    """One frequency or a list of them (Hz)."""

    def expected(self) -> str:
        """What the key expects, in words, for a message."""
        return 'a frequency, or a list of them, "5.4 kHz" or ["2.1 kHz", "5.4 kHz"]'

    def read(self, value: Any) -> tuple[float, ...]:
        """Floats in Hz.  Raises `QuantityError`."""
        try:
            return entries(FREQUENCY, value if isinstance(value, list | tuple) else [value])
        except QuantityError as error:
            raise QuantityError(error.found, self.expected()) from None

    def __get_pydantic_json_schema__(self, schema, handler) -> dict:
        entry = FREQUENCY.__get_pydantic_json_schema__(None, None)
        about = {"description": self.expected(), "quantity": self.name, "unit": self.unit}
        return about | {"anyOf": [*entry["anyOf"], {"type": "array", "items": entry}]}


class Reasons(Quantity):
    """Why rules that a seal breaks are broken on purpose: {rule: reason}."""

    def expected(self) -> str:
        """What the key expects, in words, for a message."""
        return 'a table of rules, each with a reason in words: film_thickness = "test rig"'

    def read(self, value: Any) -> dict[str, str]:
        """Reasons by rule.  Raises `QuantityError`.  The rules are in analysis/design_rules.py."""
        if not isinstance(value, dict):
            raise QuantityError(quoted(value), self.expected())
        for rule, reason in value.items():
            if not isinstance(reason, str) or not reason.strip():
                raise QuantityError(f"{quoted(reason)} as the reason of {quoted(str(rule))}", self.expected())
        return dict(value)

    def __get_pydantic_json_schema__(self, schema, handler) -> dict:
        about = {"description": self.expected(), "quantity": self.name, "unit": self.unit}
        return about | {"type": "object", "additionalProperties": {"type": "string", "minLength": 1}}


@dataclass(frozen=True)
class Application(Strict):
    """The `[application]` table, SI."""

    shaft_diameter: Size | None = None
    """Diameter of the shaft."""
    bore: Size | None = None
    """Bore of the seal: the face's width is judged by it."""
    shaft_runout: Annotated[float, Reading("length", "m", '"0.1 mm TIR"', (), 0, usual=OFF)] | None = None
    """Radial runout of the shaft, total indicator reading."""
    face_runout: Annotated[float, Reading("length", "m", '"20 um TIR"', (), 0, usual=OFF)] | None = None
    """Axial runout of the turning face, total indicator reading at the outer radius of the face."""
    eccentricity: Offset | None = None
    """Static offset of the housing from the shaft's axis."""
    axial_displacement: Offset | None = None
    """Axial travel of the shaft, end to end, that the spring must take up."""
    spring: Literal["wave_washer", "coil", "bellows"] | None = None
    """What closes the faces."""
    lowest_speed: SpeedSize | None = None
    """Lowest speed in service, either way."""
    highest_speed: SpeedSize | None = None
    """Highest speed in service, either way."""
    rotation: Literal["clockwise", "counterclockwise", "both"] | None = None
    """Direction of rotation, looking at the seal from the driving end."""
    fluid: str | None = None
    """Name of the sealed fluid."""
    lowest_temperature: Temperature | None = None
    """Lowest temperature in service of the sealed fluid."""
    highest_temperature: Temperature | None = None
    """Highest temperature in service of the sealed fluid."""
    lowest_pressure: Pressure | None = None
    """Lowest sealed pressure in service, absolute."""
    highest_pressure: Pressure | None = None
    """Highest sealed pressure in service, absolute."""
    secondary_seal_material: Literal["nitrile", "silicone", "fluoroelastomer", "other"] | None = None
    """Of the O-ring or the like on which the ring slides."""
    gear_mesh_frequency: (
        Annotated[tuple[float, ...], Frequencies("frequency", "Hz", "", usual=FREQUENCY.usual)] | None
    ) = None
    """Of gears on the shaft or near it: one, or a list."""
    leakage_limit: VolumeFlow | None = None
    """Largest leakage allowed."""
    life: Life | None = None
    """Running time between overhauls."""
    acknowledge: Annotated[dict[str, str], Reasons("table of reasons", "words", "")] = field(default_factory=dict)
    """Design rules that the seal breaks on purpose: the rule's name and the reason."""


@dataclass(frozen=True)
class RadialApplication:
    """The same table of a radial seal."""

    hydrodynamic_lip: bool = False
    """A lip with ribs or helices that pump back what leaks: other tables of the guide are for it."""
    acknowledge: Annotated[dict[str, str], Reasons("table of reasons", "words", "")] = field(default_factory=dict)
    """Rules that the seal breaks on purpose: the rule's name and the reason."""


def application_errors(application) -> list[tuple[str, str, str]]:
    """What is wrong with an `Application`: (key, found, expected)."""
    bad = []
    for name, unit in RANGES.items():
        low, high = (getattr(application, f"{end}_{name}") for end in ("lowest", "highest"))
        if low is not None and high is not None and low > high:
            expected = f"at most highest_{name} = {high:g} {unit}"
            bad.append((f"lowest_{name}", f"{low:g} {unit}", expected))
    return bad
