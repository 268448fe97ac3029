"""The fluid of a film: a gas, its constants, viscosity and options of the films that are for gases; a liquid over its
temperature, water or a table of an oil's numbers; and the `[film.heat]` table, what each ring takes of the heat that
film and asperities make, and how that cones its face.

**Source** of the heat: linear conduction and elasticity, a ring's mean face temperature and its coning are proportional
to the heat that enters it.
**Valid** numbers of one ring at a time, its other surfaces at the temperature of the sealed liquid.
"""

import math
from dataclasses import dataclass, replace
from itertools import pairwise
from typing import Annotated, Any, Literal

import numpy as np

from ..numerics.piecewise_linear import PiecewiseLinear, initially, points
from ..units import (
    DEGREES,
    Density,
    Length,
    Pressure,
    Quantity,
    QuantityError,
    ReadFromFile,
    SpecificHeat,
    Temperature,
    TemperatureScale,
    Time,
    Usual,
    Viscosity,
)
from . import Strict

# Of the properties of a gas, whatever the seal is.
GasTemperature = Annotated[float, TemperatureScale("temperature", "K", DEGREES, (), 0, True, Usual(1.0, 1e4, "degC"))]
# Volumes of gas are stated at normal conditions (DIN 1343): K, Pa.
NORMAL_TEMPERATURE, NORMAL_PRESSURE = 273.15, 101325.0


@dataclass(frozen=True)
class Gas(Strict):
    """The `[film.gas]` table: an ideal gas.  Unless `film.viscosity` is given its viscosity follows Sutherland's law
    through `reference_viscosity` (Pa s) at `reference_temperature` (K) with `sutherland_temperature` (K), valid between
    `lowest` and `highest` (K)."""

    gas_constant: SpecificHeat
    """Specific gas constant R, of p = density R T."""
    heat_ratio: float = 1.4
    """Ratio of the specific heats: 1.4 of two atoms, 5/3 of one."""
    reference_viscosity: Viscosity | None = None
    """Viscosity at `reference_temperature`, of Sutherland's law; or [film] viscosity."""
    reference_temperature: GasTemperature = 273.15
    """Where `reference_viscosity` holds."""
    sutherland_temperature: GasTemperature = 110.4
    """Sutherland's temperature S: viscosity grows as T^1.5/(T + S)."""
    lowest: GasTemperature = 100.0
    """From where on Sutherland's law holds."""
    highest: GasTemperature = 2000.0
    """Up to where it holds."""

    def sutherland(self) -> tuple[float, float]:
        """Factor (kg/(m s K^0.5)) and temperature (K) of the law, viscosity = factor T^1.5/(T + temperature)."""
        reference, s = self.reference_temperature, self.sutherland_temperature
        return self.reference_viscosity * (reference + s) / reference**1.5, s

    def viscosity(self, temperature):
        """Viscosity (Pa s) at a temperature (K), scalars or arrays.  **Source** Sutherland (1893), *Phil. Mag.* 36."""
        factor, s = self.sutherland()
        return factor * temperature**1.5 / (temperature + s)


# Gas constants: 8.314463 J/(mol K) over the molar mass.  Viscosities: air, U.S. Standard Atmosphere (1976), eq. 51;
# nitrogen and argon, White, Viscous Fluid Flow (1991), table 1-2; helium within 2.5 % of Petersen, Riso report 224
# (1970), between the limits.
GASES = {
    "air": Gas(287.053, 1.4, 1.458e-6 * 273.15**1.5 / (273.15 + 110.4), 273.15, 110.4, 100.0, 1900.0),
    "nitrogen": Gas(296.80, 1.4, 1.663e-5, 273.0, 107.0, 100.0, 1500.0),
    "helium": Gas(2077.1, 5 / 3, 1.87e-5, 273.15, 79.4, 200.0, 600.0),
    "argon": Gas(208.13, 5 / 3, 2.125e-5, 273.0, 144.0, 120.0, 1500.0),
}
GasName = Literal["air", "nitrogen", "helium", "argon"]


@dataclass(frozen=True)
class GasDam(Strict):
    """The `[film.gas_dam]` table: options of the film "gas_dam"."""

    entrance_loss: float = 1.0
    """C_L: share of the isentropic entrance velocity that is reached, 1 without loss."""
    friction: Literal["blend", "laminar", "turbulent"] = "blend"
    """Fanning friction factor: 24/Re, 0.079/Re^0.25, or (f_l^8 + f_t^8)^(1/8), which cross at Re = 2045."""
    width: Literal["radial", "constant", "zuk"] = "radial"
    """"radial": at every radius the flow, its friction and the area it presses on are those of the radius; "constant":
    those of the mean radius (parallel rows of Zuk 1972); "zuk": only the flow's area is that of the radius (his tilted
    rows)."""


@dataclass(frozen=True)
class GasReynolds(Strict):
    """The `[film.gas_reynolds]` table: options of the film "gas_reynolds"."""

    slip: bool = False
    """First-order slip at the faces: flow grows by 1 + 6 Kn."""
    cells: tuple[int, int] = (12, 48)
    """Cells over the radius and around the circle."""
    columns: int = 8
    """Over grooves, in place of `cells`: columns of triangles to a pitch."""


def gas_of(film) -> Gas | None:
    """The gas of a `Film` table, None of a liquid."""
    return GASES[film.gas] if isinstance(film.gas, str) else film.gas


def viscosity_of(film):
    """Viscosity (Pa s, number or function of time) of a `Film` table: its own, or its gas's at the temperature."""
    if film.viscosity is not None or film.gas is None:
        return film.viscosity
    return over_temperature(film.temperature, gas_of(film).viscosity)


def over_temperature(temperature, law):
    """A property by its `law(temperature)`, number or function of time as the `temperature` (K) is: between the points
    of a table at 16 more."""
    if not isinstance(temperature, PiecewiseLinear):
        return law(temperature)
    times, values = list(temperature.time[:1]), list(temperature.value[:1])
    for (t0, v0), (t1, v1) in pairwise(zip(temperature.time, temperature.value, strict=True)):
        pieces = 16 if t1 > t0 and v1 != v0 else 1
        times += [t0 + (t1 - t0) * k / pieces for k in range(1, pieces)] + [t1]
        values += [v0 + (v1 - v0) * k / pieces for k in range(1, pieces)] + [v1]
    return PiecewiseLinear(tuple(times), tuple(map(law, values)))


def density_of(film) -> float:
    """Density (kg/m^3) at which the volumes of a film's leakage are stated: a liquid's own, a gas's at normal
    conditions (273.15 K, 101325 Pa)."""
    gas = gas_of(film)
    return film.density if gas is None else NORMAL_PRESSURE / (gas.gas_constant * NORMAL_TEMPERATURE)


def highest_density(film) -> float:
    """Density (kg/m^3) of a liquid, or of a gas at its highest pressure and lowest temperature."""
    gas = gas_of(film)
    if gas is None:
        return film.density
    return max(*points(film.inner_pressure), *points(film.outer_pressure)) / (
        gas.gas_constant * min(points(film.temperature))
    )


ThermalConductivity = Annotated[float, Quantity("thermal conductivity", "W/(m*K)", '"10 W/(m*K)"', (), 0, True,
    usual=Usual(0.01, 3000.0, "W/(cm*K)"))]  # fmt: skip
ThermalResistance = Annotated[float, Quantity("thermal resistance", "K/W", '"0.4 K/W"', (), 0, True,
    usual=Usual(1e-5, 1e4, "K/kW"))]  # fmt: skip
ConingPerWatt = Annotated[float, Quantity("coning per heat", "rad/W", '"2.5 urad/W"',
    usual=Usual(0.0, 1e-3, "urad/W"))]  # fmt: skip
HeatTransfer = Annotated[float, Quantity("heat transfer coefficient", "W/(m^2*K)", '"12 kW/(m^2*K)"', (), 0, True,
    usual=Usual(50.0, 1e6, "kW/(m^2*K)"))]  # fmt: skip
KINEMATIC = Quantity("kinematic viscosity", "m^2/s", '"32 mm^2/s"', (), 0, True)
# Fewest and most points of a table of viscosities.
FEWEST, MOST = 2, 100


class ViscosityPoints(ReadFromFile):
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

    def __get_pydantic_json_schema__(self, schema, handler) -> dict:
        return {"description": self.expected(), "type": "array", "minItems": FEWEST, "maxItems": MOST}


@dataclass(frozen=True)
class Liquid(Strict):
    """The `[film.liquid]` table: a liquid whose viscosity follows its temperature, between the first and the last of
    the temperatures of its viscosities.

    **Source** Walther (1931) for the viscosity: log10 log10(nu + 0.7) falls linearly with log10 T, nu in mm^2/s,
    between neighbouring points (ASTM D341 for two).
    **Valid** mineral oils and liquids alike; density, specific heat and conductivity are the same at all temperatures.
    """

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


def in_numbers(film, rise: float = 0.0, **changes):
    """The `Film` table with the numbers of its liquid at `film.temperature` and a `rise` (K) above it, in place of the
    liquid, and other `changes`; itself, if it has neither."""
    liquid = liquid_of(film)
    if liquid is None:
        return replace(film, **changes) if changes else film
    at = initially(film.temperature) + rise
    return replace(
        film,
        liquid=None,
        viscosity=over_temperature(film.temperature, lambda t: float(liquid.viscosity_at(t + rise))),
        density=float(liquid.density_at(at)),
        specific_heat=float(liquid.specific_heat_at(at)),
        vapour_pressure=liquid.vapour_pressure_at(at),
        **changes,
    )


def liquid_errors(film) -> list[tuple[str, str, str]]:
    """What a `Film` table with a liquid cannot have: (key below film, found, expected), empty without one."""
    liquid = liquid_of(film)
    if liquid is None:
        return []
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


# Keys of a ring given by two numbers, and of one given by its body.
BY_NUMBERS, BY_BODY = ("resistance", "coning_per_watt", "time_constant"), ("convection", "wetted_length", "wet")


@dataclass(frozen=True)
class HeatedRing(Strict):
    """One ring of `[film.heat]`: by numbers of its maker, finite elements or a test; or by its `body` and the
    convection on it."""

    resistance: ThermalResistance | None = None
    """Rise of the face over the heat that enters it."""
    coning_per_watt: ConingPerWatt = 0.0
    """Coning over that heat, positive where the film gets thicker outwards."""
    time_constant: Time | None = None
    """Time in which the rise settles."""
    convection: Literal["becker"] | HeatTransfer | None = None
    """In place of the numbers, with the ring's `body`: heat transfer coefficient of the wetted surface; "becker" by a
    cylinder that turns in the liquid."""
    wetted_length: Length | None = None
    """From the face to the O-ring; the whole length."""
    wet: Literal["outer", "bore", "both"] | None = None
    """Which surface the liquid wets; that of the higher pressure."""


@dataclass(frozen=True)
class Heat(Strict):
    """The `[film.heat]` table; a ring that is not named takes no heat."""

    stator: HeatedRing | None = None
    """The ring that stands."""
    rotor: HeatedRing | None = None
    """The ring that turns."""
    friction: float = 1.0
    """Friction that heats over that of the aligned film: of rings that rub or run tilted, as a run tells it."""

    @property
    def rings(self) -> dict[str, HeatedRing]:
        """The rings that take heat, by their names."""
        both = {"stator": self.stator, "rotor": self.rotor}
        return {name: ring for name, ring in both.items() if ring is not None}


def _body_errors(scene, name: str, ring) -> list[tuple[str, str, str]]:
    """What a ring of a Scene lacks to be reckoned from its body."""
    body, film = scene.rings[name].body, scene.film
    if body is None:
        found = f"nothing, with film.heat.{name}.convection"
        return [(f"{name}.body", found, "the ring: inner_radius, outer_radius, length, material")]
    bad = [(f"{name}.body.{key}", "nothing, with film.heat", "a number, or a material that has it")
           for key, value in body.solid().items() if value is None]  # fmt: skip
    if not body.inner_radius <= film.inner_radius < film.outer_radius <= body.outer_radius:
        found = f"{body.inner_radius:g} to {body.outer_radius:g} m"
        bad.append((f"{name}.body.inner_radius", found, "a ring that the face of the film lies on"))
    if body.inner_radius == 0.0:
        bad.append((f"{name}.body.inner_radius", "0 m, a disk", "a ring with a bore, or film.heat by numbers"))
    if ring.wetted_length is not None and not 0.0 < ring.wetted_length <= body.length:
        found = f"{ring.wetted_length:g} m"
        bad.append((f"film.heat.{name}.wetted_length", found, f"a length above 0, at most {body.length:g} m"))
    return bad


def heat_errors(scene) -> list[tuple[str, str, str]]:
    """What cannot be in `[film.heat]` of a Scene: (key, found, expected), empty without it."""
    film, heat, bad = scene.film, scene.film.heat, []
    if heat is None:
        return bad
    if film.gas is not None:
        return [("film.heat", "heat of a film of gas", "a liquid: across a film of gas the faces differ")]
    if film.model == "linear" and not isinstance(film.coefficients, str):
        return [("film.heat", "heat beside coefficients of one's own", "a film whose friction is known")]
    if scene.stator.elastic is not None:
        return [("film.heat", "heat beside an elastic ring", "one of them: its waves are those of one viscosity")]
    if not 0.0 < heat.friction < math.inf:
        bad.append(("film.heat.friction", f"{heat.friction:g}", "a number above 0"))
    if not heat.rings:
        bad.append(("film.heat", "an empty table", "stator or rotor, each { resistance, coning_per_watt }"))
    if film.liquid is None:
        found = "nothing, with film.heat"
        bad.append(("film.liquid", found, '"water", or a table: viscosity over temperature'))
    for name, ring in heat.rings.items():
        key = f"film.heat.{name}"
        numbers = [k for k in BY_NUMBERS if getattr(ring, k) not in (None, 0.0)]
        drawn = [k for k in BY_BODY if getattr(ring, k) is not None]
        if numbers and drawn:
            bad.append((f"{key}.{drawn[0]}", f"{drawn[0]} beside {numbers[0]}", "a ring by numbers, or by its body"))
        elif ring.resistance is None and ring.convection is None:
            bad.append((f"{key}.resistance", "nothing", "a resistance, or convection and the ring's body"))
        elif ring.convection is not None:
            bad += _body_errors(scene, name, ring)
    return bad
