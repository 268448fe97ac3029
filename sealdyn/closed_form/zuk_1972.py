"""Gas flow across a sealing dam without inertia of the gas, and the published numbers of a main-shaft seal at cruise.

**Source** Zuk, J., "Analysis of face deformation effects on gas film seal performance", NASA TM X-68022 (1972); his
viscous forms (eqs. 13-22) derived again, forces and centres of tilted faces here.  Isothermal ideal gas, friction
factor 24/Re laminar or 0.079/Re^(1/4) turbulent, Re = 2 (flow per width)/viscosity:

    d(P^2)/dx = -2 f R T G^2/h^3,   G = mass flow per width

so that with constant width P^2 follows int dx/h^3, laminar or turbulent.
**Valid** exit Mach number well below 1 (0.3: within 1 % of the compressible flow).  x runs along the flow from the edge
with the high pressure: films `entrance` and `exit` (m) there and at the other edge, linear in between, `length` of the
dam (m), pressures (Pa).  Scalars or arrays that broadcast, unless a function says scalar.
"""

import math
from typing import NamedTuple

import numpy as np

Real = float | np.ndarray

# 0.079 is Blasius' factor for a Fanning friction factor.
LAMINAR, TURBULENT = 24.0, 0.079


class Cruise(NamedTuple):
    """The seal of the tables: air, high pressure at the inner radius.  SI units."""

    inner_radius: float = 3.265 * 0.0254
    outer_radius: float = 3.315 * 0.0254
    high_pressure: float = 215 * 6894.757
    low_pressure: float = 15 * 6894.757
    temperature: float = (800 + 459.67) / 1.8
    gas_constant: float = 287.04
    heat_ratio: float = 1.4
    # Sutherland's factor (kg/(m s K^0.5)) and temperature (K).
    sutherland: tuple[float, float] = (1.458e-6, 110.4)


class Published(NamedTuple):
    """One row: tilt (rad, positive: the film grows outwards), mean film (m), printed leakage (kg/s), force (N) and its
    centre (share of the dam's width from the high pressure); force and centre without the error of the tilted rows,
    and exit Mach number, computed: laminar, no entrance loss, width constant (no tilt) or radial, the friction factor
    of the mean radius; the printed exit Mach number.  None of what is not printed, or not held from the print."""

    tilt: float
    mean_film: float
    leakage: float | None
    force: float | None
    centre: float | None
    corrected_force: float
    corrected_centre: float
    exit_mach: float
    printed_exit_mach: float | None


CRUISE = Cruise()
MIL, POUND, POUND_FORCE = 25.4e-6, 0.45359237, 4.4482216152605


def _row(tilt, mils, pounds_per_minute, pounds, centre, corrected_pounds, corrected_centre, exit_mach, printed=None):
    return Published(
        tilt,
        mils * MIL,
        None if pounds_per_minute is None else pounds_per_minute * POUND / 60,
        None if pounds is None else pounds * POUND_FORCE,
        None if centre is None else centre / 100,
        corrected_pounds * POUND_FORCE,
        corrected_centre / 100,
        exit_mach,
        printed,
    )


# The printed forces and centres of the tilted rows are wrong: 220 lb are more than full pressure on the whole dam.
ZUK_1972 = (
    _row(0.0, 0.1, 0.0122, 133, 39.1, 133.4, 39.07, 0.251),
    _row(0.0, 0.2, 0.0939, 135, 39.7, 134.8, 39.51, 0.907),
    _row(0.0, 0.3, 0.2890, 138, 40.5, 137.8, 40.55, 1.0),
    _row(0.002, 0.1, 0.0068, 58, 26.0, 82.4, 31.57, 0.093, 0.09),
    _row(0.002, 0.2, 0.0837, 91, 33.0, 110.3, 36.12, 0.661, 0.66),
    _row(-0.002, 0.2, 0.0827, 220, 49.8, 155.3, 42.16, 1.0),
)
# Rows of which one printed number is held, or none.
ZUK_1972_IN_PART = (
    _row(0.0, 0.5, None, None, 41.7, 141.4, 42.65, 1.0),
    _row(0.002, 0.3, None, None, None, 121.0, 38.44, 1.0, 1.0),
    _row(0.002, 0.5, None, None, None, 130.1, 41.65, 1.0, 1.0),
    _row(-0.002, 0.3, None, None, None, 151.8, 42.19, 1.0),
    _row(-0.002, 0.5, None, None, None, 150.5, 43.41, 1.0),
)


def characteristic_film(entrance: Real, exit_film: Real) -> Real:
    """Film (m) of the parallel dam with the same int dx/h^3: (h1^2 h2^2/h_m)^(1/3)."""
    return np.cbrt(2 * entrance**2 * exit_film**2 / (entrance + exit_film))


def laminar_mass_flow(entrance, exit_film, length, high_pressure, low_pressure, viscosity, gas_constant, temperature):
    """Mass flow per width (kg/(m s)) of the laminar dam, h^3 (P1^2 - P2^2)/(24 mu R T L) with the characteristic film.
    **Source** as the module."""
    squares = (high_pressure - low_pressure) * (high_pressure + low_pressure)
    cubed = characteristic_film(entrance, exit_film) ** 3
    return cubed * squares / (LAMINAR * viscosity * gas_constant * temperature * length)


def turbulent_mass_flow(entrance, exit_film, length, high_pressure, low_pressure, viscosity, gas_constant, temperature):
    """Mass flow per width (kg/(m s)) of the turbulent dam, (h^3 (P1^2 - P2^2)/(2 0.079 (mu/2)^(1/4) R T L))^(4/7).
    **Source** as the module.  **Valid** Re above some 3000."""
    squares = (high_pressure - low_pressure) * (high_pressure + low_pressure)
    cubed = characteristic_film(entrance, exit_film) ** 3
    drag = 2 * TURBULENT * (viscosity / 2) ** 0.25 * gas_constant * temperature * length
    return (cubed * squares / drag) ** (4 / 7)


def radial_laminar_mass_flow(film, high_radius, low_radius, squares, viscosity, gas_constant, temperature):
    """Mass flow (kg/s) of a parallel laminar dam between the radius with the high pressure and that with the low one,
    pi h^3 (P1^2 - P2^2)/(12 mu R T |ln(r2/r1)|); `squares` P1^2 - P2^2 (Pa^2).  **Source** as the module."""
    resistance = 12 * viscosity * gas_constant * temperature * np.abs(np.log(low_radius / high_radius))
    return np.pi * film**3 * squares / resistance


def radial_turbulent_mass_flow(film, high_radius, low_radius, squares, viscosity, gas_constant, temperature):
    """Mass flow (kg/s) of a parallel turbulent dam between the radius with the high pressure and that with the low one,

        2 pi 2.689 (h^3 (P1^2 - P2^2)/(mu^(1/4) R T |r1^(-3/4) - r2^(-3/4)|))^(4/7)

    `squares` P1^2 - P2^2 (Pa^2).  **Source** as the module, eq. 17, which has 3.995 in print; 2.689 is
    (2 0.079 2^(-1/4) 4/3)^(-4/7).  **Valid** Re above some 3000."""
    radii = np.abs(high_radius**-0.75 - low_radius**-0.75)
    drag = 2 * TURBULENT * (viscosity / 2) ** 0.25 * (4 / 3) * gas_constant * temperature * radii
    return 2 * np.pi * (film**3 * squares / drag) ** (4 / 7)


def pressure(x: Real, entrance: Real, exit_film: Real, length: Real, high_pressure: Real, low_pressure: Real) -> Real:
    """Pressure (Pa) at `x` (m) from the entrance: P^2 = P1^2 + (P2^2 - P1^2) (x/L) T, T = h2^2 (h1 + h)/(2 h_m h^2),
    laminar and turbulent.  **Source** as the module."""
    film = entrance + (exit_film - entrance) * x / length
    part = x / length * exit_film**2 * (entrance + film) / ((entrance + exit_film) * film**2)
    return np.sqrt(high_pressure**2 + (low_pressure**2 - high_pressure**2) * part)


def radial_pressure(r, high_radius, low_radius, high_pressure, low_pressure, *, turbulent: bool = False) -> Real:
    """Pressure (Pa) at radius `r` (m) of the parallel dam: P^2 is linear in ln r laminar, in r^(-3/4) turbulent.
    **Source** as the module.  Its force is no elementary function."""
    if turbulent:
        part = (high_radius**-0.75 - r**-0.75) / (high_radius**-0.75 - low_radius**-0.75)
    else:
        part = np.log(r / high_radius) / np.log(low_radius / high_radius)
    return np.sqrt(high_pressure**2 + (low_pressure**2 - high_pressure**2) * part)


def parallel_load(length: Real, high_pressure: Real, low_pressure: Real) -> tuple[Real, Real]:
    """Gauge force per width int (P - P2) dx (N/m) of the parallel dam and its centre (share of `length` from the
    entrance), laminar and turbulent.  **Source** as the module; P2 < P1."""
    p_1, p_2 = high_pressure, low_pressure
    squares = (p_1 - p_2) * (p_1 + p_2)
    # int P dx and int P x dx by P: x/L = (P1^2 - P^2)/(P1^2 - P2^2).
    force = 2 / 3 * (p_1**2 + p_1 * p_2 + p_2**2) / (p_1 + p_2)
    moment = 2 * (p_1**2 * (p_1**3 - p_2**3) / 3 - (p_1**5 - p_2**5) / 5) / squares**2
    return (force - p_2) * length, (moment - p_2 / 2) / (force - p_2)


def tilted_load(entrance, exit_film, length, high_pressure, low_pressure) -> tuple[float, float]:
    """Gauge force per width int (P - P2) dx (N/m) of the tilted dam and its centre (share of `length` from the
    entrance), laminar and turbulent; scalar arguments.

    P^2 = b + c/h^2, of which int P dh and int P h dh are elementary.
    **Source** as the module.  **Valid** films that differ by a thousandth or more (rounding: 1e-9 there): ValueError
    below that, where `parallel_load` is within the same thousandth."""
    h_1, h_2, p_1, p_2 = entrance, exit_film, high_pressure, low_pressure
    if abs(h_2 - h_1) < 1e-3 * h_1:
        raise ValueError(f"films {h_1:g} m and {h_2:g} m do not differ enough for the form of tilted faces")
    slope = (h_2 - h_1) / length
    c = (p_1 - p_2) * (p_1 + p_2) / (1 / h_1**2 - 1 / h_2**2)
    b = p_1**2 - c / h_1**2
    # With a = P h: int dh/(h a) and int dh/a.
    a_1, a_2 = p_1 * h_1, p_2 * h_2
    if c > 0:
        ratio = (h_2**2 - h_1**2) * (a_1 * a_2 + c) / ((a_1 + a_2) * (h_2**2 * a_1**2 + c * h_1**2))
    else:
        ratio = (a_2 - a_1) / (a_1 * a_2 - c)
    over_h = _arc(c, ratio)
    plain = _arc(b, (p_1 - p_2) / (p_1 * p_2 - b))
    by_h = a_2 - a_1 + c * over_h
    by_h2 = (h_2 * a_2 - h_1 * a_1 + c * plain) / 2
    force = by_h / slope - p_2 * length
    moment = (by_h2 - h_1 * by_h) / slope**2 - p_2 * length**2 / 2
    return force, moment / (force * length)


def _arc(k: float, ratio: float) -> float:
    """artanh(sqrt(k) ratio)/sqrt(k), arctan(sqrt(-k) ratio)/sqrt(-k) for k < 0."""
    if k == 0:
        return ratio
    root = math.sqrt(abs(k))
    return (math.atanh(root * ratio) if k > 0 else math.atan(root * ratio)) / root
