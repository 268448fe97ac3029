"""The gas of a film: its constants and viscosity, and options of the films that are for gases."""

from dataclasses import dataclass
from itertools import pairwise
from typing import Annotated, Literal

from ..numerics.piecewise_linear import PiecewiseLinear, points
from ..units import DEGREES, SpecificHeat, TemperatureScale, Usual, Viscosity
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
