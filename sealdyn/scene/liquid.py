"""The liquid of a film over its temperature: water, or a table of an oil's numbers."""

import math
from dataclasses import dataclass, replace
from itertools import pairwise
from typing import Annotated, Any, Literal

import numpy as np

from ..numerics.piecewise_linear import initially, points
from ..units import Density, Pressure, Quantity, QuantityError, SpecificHeat, Temperature, Usual, Viscosity
from .gas import over_temperature

ThermalConductivity = Annotated[float, Quantity("thermal conductivity", "W/(m*K)", '"10 W/(m*K)"', (), 0, True,
    usual=Usual(0.01, 3000.0, "W/(cm*K)"))]  # fmt: skip
KINEMATIC = Quantity("kinematic viscosity", "m^2/s", '"32 mm^2/s"', (), 0, True)
# Fewest and most points of a table of viscosities.
FEWEST, MOST = 2, 100


class ViscosityPoints:
    """Viscosities at temperatures, [[T, viscosity], ...]: dynamic or kinematic ones, as their unit says."""

    def read(self, value: Any) -> tuple[tuple[float, float, str], ...]:
        """Points (temperature in K, viscosity in SI, its unit "Pa*s" or "m^2/s").  Raises `QuantityError`."""
        if not isinstance(value, list | tuple) or not all(isinstance(point, list | tuple) for point in value):
            raise QuantityError("no list of pairs", self.expected())
        if not FEWEST <= len(value) <= MOST:
            raise QuantityError(f"{len(value)} points", f"{FEWEST} to {MOST} points, {self.expected()}")
        found = tuple(map(self._point, value))
        for before, after in pairwise(found):
            if not before[0] < after[0]:
                raise QuantityError(f"{after[0]:g} K after {before[0]:g} K", "temperatures that increase")
        if len({unit for *_, unit in found}) > 1:
            raise QuantityError("dynamic and kinematic viscosities", "all of one kind")
        return found

    def _point(self, point) -> tuple[float, float, str]:
        if len(point) not in (2, 3):
            raise QuantityError(f"a point of {len(point)} entries", self.expected())
        temperature = Temperature.__metadata__[0].read(point[0])
        dynamic, kinematic = Viscosity.__metadata__[0], KINEMATIC
        if len(point) == 3:
            kinds = {dynamic.unit: dynamic, kinematic.unit: kinematic}
            if point[2] not in kinds:
                raise QuantityError("a unit of no viscosity", self.expected())
            return temperature, kinds[point[2]].read(point[1]), point[2]
        try:
            return temperature, dynamic.read(point[1]), dynamic.unit
        except QuantityError:
            if not isinstance(point[1], str):
                raise
        try:
            return temperature, kinematic.read(point[1]), kinematic.unit
        except QuantityError as error:
            raise QuantityError(error.found, self.expected()) from None

    def expected(self) -> str:
        """What the key expects, in words, for a message."""
        return 'pairs of temperature and viscosity, e.g. [["40 degC", "32 mm^2/s"], ["100 degC", "5.4 mm^2/s"]]'

    def __get_pydantic_core_schema__(self, source, handler):
        from pydantic_core import core_schema

        return core_schema.no_info_plain_validator_function(self.read)

    def __get_pydantic_json_schema__(self, schema, handler) -> dict:
        return {"description": self.expected(), "type": "array", "minItems": FEWEST, "maxItems": MOST}


@dataclass(frozen=True)
class Liquid:
    """The `[film.liquid]` table: a liquid whose viscosity follows its temperature, between the first and the last of
    the temperatures of its viscosities.

    **Source** Walther (1931) for the viscosity: log10 log10(nu + 0.7) falls linearly with log10 T, nu in mm^2/s,
    between neighbouring points (ASTM D341 for two).
    **Valid** mineral oils and liquids alike; density, specific heat and conductivity are the same at all temperatures.
    """

    __pydantic_config__ = {"extra": "forbid"}  # noqa: RUF012

    density: Density
    """At the temperature of the seal."""
    specific_heat: SpecificHeat
    """At the temperature of the seal."""
    viscosity: Annotated[tuple[tuple[float, float, str], ...], ViscosityPoints()]
    """Pairs of temperature and viscosity, dynamic or kinematic: two of a data sheet are enough."""
    conductivity: ThermalConductivity = 0.13
    """Thermal conductivity; of mineral oils 0.13 W/(m K)."""
    vapour_pressure: Pressure | None = None
    """Absolute, at the temperature of the seal; without it nothing is said of boiling."""

    @property
    def lowest(self) -> float:
        """The lowest temperature (K) of its table."""
        return self.viscosity[0][0]

    @property
    def highest(self) -> float:
        """The highest temperature (K) of its table."""
        return self.viscosity[-1][0]

    def viscosity_at(self, temperature):
        """Viscosity (Pa s) at a temperature (K), scalars or arrays, not beyond the table."""
        temperatures, values, units = zip(*self.viscosity, strict=True)
        kinematic = np.array(values) * (1.0 if units[0] == "m^2/s" else 1.0 / self.density)
        # Thinner than 0.31 mm^2/s the law has no logarithm: the 0.7 is that of oils.
        if np.min(kinematic) < 3.1e-7:
            return np.exp(np.interp(temperature, temperatures, np.log(kinematic * self.density)))
        law = np.interp(np.log(temperature), np.log(temperatures), np.log(np.log(kinematic * 1e6 + 0.7)))
        return self.density * 1e-6 * (np.exp(np.exp(law)) - 0.7)

    def density_at(self, temperature):
        """Density (kg/m^3) at a temperature (K)."""
        return self.density

    def specific_heat_at(self, temperature):
        """Specific heat (J/(kg K)) at a temperature (K)."""
        return self.specific_heat

    def conductivity_at(self, temperature):
        """Thermal conductivity (W/(m K)) at a temperature (K)."""
        return self.conductivity

    def vapour_pressure_at(self, temperature):
        """Vapour pressure (Pa) at a temperature (K), None where it is not known."""
        return self.vapour_pressure


class Water:
    """Liquid water.

    **Source** fitted to the formulations of IAPWS (viscosity 2008, IAPWS-95, conductivity 2011, saturation line 1992).
    **Valid** 0 to 150 degC, to 100 bar: viscosity within 1.3 % (0.3 % rms), density 0.02 %, specific heat 0.1 %,
    conductivity 0.3 %, vapour pressure 0.5 %.
    """

    lowest, highest = 273.15, 423.15

    def viscosity_at(self, temperature):
        """Viscosity (Pa s) at a temperature (K), scalars or arrays."""
        return np.exp(-10.57455285 + 552.34120971 / (temperature - 142.78519617))

    def density_at(self, temperature):
        """Density (kg/m^3) at a temperature (K)."""
        c = (temperature - 273.15) / 100.0
        return 1000.0 + c * (2.74266 + c * (-65.0028 + c * (26.7366 - 6.14552 * c)))

    def specific_heat_at(self, temperature):
        """Specific heat (J/(kg K)) at a temperature (K)."""
        c = (temperature - 273.15) / 100.0
        return 4214.72 + c * (-220.039 + c * (427.949 + c * (-299.399 + 93.198 * c)))

    def conductivity_at(self, temperature):
        """Thermal conductivity (W/(m K)) at a temperature (K)."""
        c = (temperature - 273.15) / 100.0
        return 0.557333 + c * (0.224489 + c * (-0.125378 + 0.0206845 * c))

    def vapour_pressure_at(self, temperature):
        """Vapour pressure (Pa) at a temperature (K)."""
        return np.exp(23.35319 - 3917.932 / (temperature - 41.9037))


LIQUIDS = {"water": Water()}
LiquidName = Literal["water"]


def liquid_of(film) -> Liquid | Water | None:
    """The liquid of a `Film` table; None of a gas, or where the film is given by its own numbers."""
    return LIQUIDS[film.liquid] if isinstance(film.liquid, str) else film.liquid


def in_numbers(film, rise: float = 0.0):
    """The `Film` table with the numbers of its liquid at `film.temperature` and a `rise` (K) above it, in place of the
    liquid; itself, if it has none."""
    liquid = liquid_of(film)
    if liquid is None:
        return film
    at = initially(film.temperature) + rise
    return replace(
        film,
        liquid=None,
        viscosity=over_temperature(film.temperature, lambda t: float(liquid.viscosity_at(t + rise))),
        density=float(liquid.density_at(at)),
        specific_heat=float(liquid.specific_heat_at(at)),
        vapour_pressure=liquid.vapour_pressure_at(at),
    )


def liquid_errors(film) -> list[tuple[str, str, str]]:
    """What a `Film` table with a liquid cannot have: (key below film, found, expected)."""
    liquid = liquid_of(film)
    if film.gas is not None:
        return [("liquid", "a liquid beside film.gas", "one of them")]
    bad = []
    for key, unsaid in (("viscosity", None), ("density", 1000.0), ("specific_heat", 4180.0), ("vapour_pressure", None)):
        if getattr(film, key) != unsaid:
            bad.append((key, f"{key.replace('_', ' ')} beside film.liquid", "one of them: the liquid has its own"))
    if film.temperature is None:
        return [*bad, ("temperature", "nothing, with film.liquid", Temperature.__metadata__[0].expected())]
    outside = [t for t in points(film.temperature) if not liquid.lowest <= t <= liquid.highest or not math.isfinite(t)]
    if outside:
        limits = f"{liquid.lowest:g} to {liquid.highest:g} K, where the liquid's numbers hold"
        bad.append(("temperature", f"{outside[0]:g} K", limits))
    return bad
