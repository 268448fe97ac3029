"""A ring heated at its face and cooled by liquid: the fin, its coning, and what liquid takes from a ring that turns.

The section of the ring reaches from `inner_radius` a to `outer_radius` b (m) and `length` L (m) from the face into the
ring; w = b - a, r_m = (a + b)/2.  Heat enters evenly through the whole face and leaves to liquid on the circumference,
or on the bore if `wet_bore`.  Coning is positive where the face is farther from the film outside.  Scalars.
"""

import math
from typing import NamedTuple

# Reynolds numbers w D^2/(2 nu) over which Becker measured.
BECKER_RANGE = (800.0, 1e5)
# A correlation for a free cylinder in a chamber with flush and dead corners: within this factor either way.
CONVECTION_FACTOR = 2.0


class Fin(NamedTuple):
    """Numbers of a ring as a fin: `resistance` (K/W, mean rise of the face over heat), `coning_per_watt` (rad/W) and
    `time_constant` (s, first moment of the step response of the face)."""

    resistance: float
    coning_per_watt: float
    time_constant: float


def ring_fin(
    inner_radius: float,
    outer_radius: float,
    length: float,
    conductivity: float,
    expansion: float,
    poisson: float,
    density: float,
    specific_heat: float,
    convection: float,
    wet_bore: bool = False,
) -> Fin:
    """Fin with the resistance inside its section, and the two ways in which its heat cones a rigid section.

    With R_w the wetted and R_d the dry radius, D_2 = R_w^2 - R_d^2, the convection h is in series with delta, what the
    section itself resists on average:

        1/h_e = 1/h + delta,  delta = (2 R_w/(k |D_2|)) |D_2/8 - R_d^2/4 + (R_d^4/(2 D_2)) ln(R_w/R_d)|
        m^2 = h_e 2 pi R_w/(k A),  z = m L,  R = 1/(k A m tanh z),  tau = (1 + 2 z/sinh 2z)/(2 kappa m^2)
        X = alpha R { (r_m/L) f(z) +- (1 + nu) h_e d/(k w) L j(z) }  (+ wetted outside, - in the bore)
        d = (2 R_w/|D_2|) |D_2/4 - (R_d^2/2) ln(R_w/R_d)|

    First the moment of the hot face, second the ring that is longer where it is hotter.
    **Source** derived here: one-dimensional fin, radial profile of an even heat source, elementary ring theory.
    **Valid** face and section alike, L up to 1.1 sqrt(r_m w), h w/k below 5: R within 5 % and X within 6 % wetted
    outside.  In the bore of a long ring of carbon the two terms nearly cancel: use faces/ring_heat.py.
    `conductivity` W/(m K), `expansion` 1/K, `density` kg/m^3, `specific_heat` J/(kg K), `convection` W/(m^2 K).
    """
    a, b, k, nu = inner_radius, outer_radius, conductivity, poisson
    wet, dry = (a, b) if wet_bore else (b, a)
    area, width, mean = math.pi * (b**2 - a**2), b - a, (a + b) / 2
    inside, depth = _section(wet, dry)
    effective = 1.0 / (1.0 / convection + inside / k)
    m = math.sqrt(effective * 2 * math.pi * wet / (k * area))
    z = m * length
    resistance = 1.0 / (k * area * m * math.tanh(z))
    moment, longer = _moment(z), math.tanh(z) / z - _moment(z) / z**2
    side = -1.0 if wet_bore else 1.0
    axial = side * (1 + nu) * effective * depth / (k * width) * length * longer
    coning = expansion * resistance * (mean / length * moment + axial)
    spread = 2 * z / math.sinh(2 * z) if z < 300.0 else 0.0
    return Fin(resistance, coning, (1 + spread) * density * specific_heat / (2 * k * m**2))


def _section(wet: float, dry: float) -> tuple[float, float]:
    """delta k and d (m) of the fin: w/3 and w/2 of a thin ring, where the terms of the formulas cancel to less than the
    limit is off."""
    both = wet**2 - dry**2
    if abs(wet - dry) < 2e-4 * wet:
        return abs(wet - dry) / 3, abs(wet - dry) / 2
    log = math.log(wet / dry)
    scale = 2 * wet / abs(both)
    inside = scale * abs(both / 8 - dry**2 / 4 + dry**4 / (2 * both) * log)
    return inside, scale * abs(both / 4 - dry**2 / 2 * log)


def _moment(z: float) -> float:
    """f(z) = 12 [tanh z/(2 z) - (1 - sech z)/z^2], by its series where the terms cancel."""
    if z < 0.02:
        return z**2 / 2 - 13 * z**4 / 60
    sech = 1 / math.cosh(z) if z < 700.0 else 0.0
    return 12 * (math.tanh(z) / (2 * z) - (1 - sech) / z**2)


def rigid_coning(inner_radius: float, outer_radius: float, length: float, modulus: float, moment: float) -> float:
    """Coning (rad) of a rigid section under a moment (N m per radian, positive if it opens the film outside):
    moment/(E (L^3/12) ln(b/a)).

    **Source** ring theory: hoop stress E x phi/r integrated over the section.
    **Valid** lengths below about twice the width; beyond 20 to 90 % off.
    """
    return moment / (modulus * length**3 / 12 * math.log(outer_radius / inner_radius))


def circumference_moment(radius: float, length: float, wetted_length: float, pressure: float) -> float:
    """Opening moment (N m per radian) about the section's middle of a pressure (Pa) on the circumference, `radius`,
    from the face to the O-ring at `wetted_length`: p b l (l - L)/2, mostly negative.  On the bore its negative."""
    return pressure * radius * wetted_length * (wetted_length - length) / 2


def face_moment(mean_radius: float, inner: float, outer: float, at_inner: float, at_outer: float) -> float:
    """Opening moment (N m per radian) about `mean_radius` (m) of a pressure on the face, linear from `at_inner` to
    `at_outer` (Pa) between the radii `inner` and `outer` (m): int p (r - r_m) r dr.  On the back its negative."""
    # Simpson's rule is exact: the integrand is a polynomial of degree three.
    middle = (inner + outer) / 2
    ends = at_inner * (inner - mean_radius) * inner + at_outer * (outer - mean_radius) * outer
    between = (at_inner + at_outer) / 2 * (middle - mean_radius) * middle
    return (outer - inner) * (ends + 4 * between) / 6


def coning_per_speed_squared(
    inner_radius: float, outer_radius: float, length: float, modulus: float, poisson: float, density: float
) -> float:
    """Coning (rad s^2) over the square of the speed of a ring that turns: -(L/2) nu (1 + nu) rho r_m/E.

    **Source** derived here: by Poisson's ratio the stresses of the spin shorten the ring along the shaft, most at its
    bore; held against finite elements.
    **Valid** rectangular sections, L up to twice the width: within 4 %.
    """
    mean = (inner_radius + outer_radius) / 2
    return -length / 2 * poisson * (1 + poisson) * density * mean / modulus


class Cooling(NamedTuple):
    """Convection of a ring by its speed: `value`, and the `low` and `high` it may be (W/(m^2 K)); the Reynolds number
    w D^2/(2 nu), and whether it is `extrapolated` beyond what was measured."""

    value: float
    low: float
    high: float
    reynolds: float
    extrapolated: bool


def ring_cooling(speed: float, diameter: float, liquid: tuple[float, float, float, float], turns: bool) -> Cooling:
    """Convection of a ring in liquid by Becker, twice or half of it.

    A ring that stands has the liquid turn past it at half the speed, an assumption.  `speed` (rad/s) of the other ring
    over it, `diameter` (m) of its wetted side, `liquid` (density kg/m^3, viscosity Pa s, specific heat J/(kg K),
    conductivity W/(m K)).
    """
    passing = abs(speed) if turns else abs(speed) / 2
    value, reynolds = becker(passing, diameter, *liquid), turning_reynolds(passing, diameter, *liquid[:2])
    outside = not BECKER_RANGE[0] <= reynolds <= BECKER_RANGE[1]
    return Cooling(value, value / CONVECTION_FACTOR, value * CONVECTION_FACTOR, reynolds, outside)


def turning_reynolds(speed: float, diameter: float, density: float, viscosity: float) -> float:
    """Reynolds number w D^2/(2 nu) of a cylinder that turns: its surface speed over its diameter."""
    return speed * diameter**2 * density / (2 * viscosity)


def becker(
    speed: float, diameter: float, density: float, viscosity: float, specific_heat: float, conductivity: float
) -> float:
    """Convection (W/(m^2 K)) of a cylinder that turns in liquid: Nu_D = 0.133 Re^(2/3) Pr^(1/3).

    **Source** Becker (1963), a horizontal cylinder in water, as it is widely quoted; the paper itself was not seen.
    **Valid** Re = w D^2/(2 nu) of 800 to 1e5.  From 1e4 to 3e6 within a third of `chilton_colburn`.
    `speed` (rad/s), `diameter` (m), `density` (kg/m^3), `viscosity` (Pa s), `specific_heat` (J/(kg K)), `conductivity`
    of the liquid (W/(m K)).
    """
    reynolds, prandtl = turning_reynolds(speed, diameter, density, viscosity), viscosity * specific_heat / conductivity
    return 0.133 * reynolds ** (2 / 3) * prandtl ** (1 / 3) * conductivity / diameter


def chilton_colburn(
    speed: float, diameter: float, density: float, viscosity: float, specific_heat: float, conductivity: float
) -> float:
    """Convection (W/(m^2 K)) of a cylinder that turns by the analogy of heat and friction:
    h = (c/2) rho cp (w D/2) Pr^(-2/3), with the drag 1/sqrt(c) = -0.6 + 4.07 log10(Re_R sqrt(c)), Re_R = w (D/2)^2/nu.

    **Source** Chilton & Colburn (1934); drag of turning cylinders: Theodorsen & Regier, NACA report 793 (1944).
    **Valid** turbulent: Re_R from about 500.  Arguments as in `becker`.
    """
    radius = diameter / 2
    reynolds, prandtl = speed * radius**2 * density / viscosity, viscosity * specific_heat / conductivity
    # y = 1/sqrt(c), by a contraction: its slope is 4.07/(y ln 10), below a third where the law holds.
    y = 10.0
    for _ in range(60):
        y = max(-0.6 + 4.07 * math.log10(max(reynolds / y, 1.0)), 1.0)
    return 0.5 / y**2 * density * specific_heat * speed * radius * prandtl ** (-2 / 3)
