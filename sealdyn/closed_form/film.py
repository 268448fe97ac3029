"""Aligned and linearised film of a face in closed form: coned, as the narrow seal and exact over the radius; and spiral
grooves so many that the pressure across a pitch is a saw tooth without height (narrow-groove theory).

Arguments of coned faces, scalars or arrays that broadcast: radii and clearance (m), coning (rad), viscosity (Pa s),
pressures (Pa).  Of grooves

    K1 = [ sin^2 a b (1-b) (h_g^3 - h_l^3)^2 + h_g^3 h_l^3 ] / D,    D = (1-b) h_g^3 + b h_l^3
    K2 = sin a cos a b (1-b) (h_g^3 - h_l^3)(h_g - h_l) / D
    liquid   p' = 12 mu [ w r K2/K1 - Q/(2 pi r K1) ]          gas   K1 p p' = 12 mu [ w r K2 p - Q/(2 pi r) ]

h_g, h_l films of groove and land (m), b the groove's share of the pitch, a its angle to the circle (positive where its
radius grows with the angle), w the entrainment in the frame of the grooves (rad/s), Q the
flow outwards (liquid m^3/s, gas Pa m^3/s).
**Source** of grooves: Muijderman (1964); Malanoski & Pan (1965), J. Basic Eng. 87, 547; derived here.  In coordinates n
across and s along the edges the flow q_n and the gradient p_s are the same in groove and land.  With q = -h^3 grad
p/(12 mu) + h w r t (t along the circle; gas: times p) the mean of p_n over the pitch follows from q_n, the mean of q_s
from p_s; turned back to the radius, with no mean gradient around the circle, they give the mean radial flow above.
**Valid** of grooves: the limit of infinitely many; with 12 the film has 5 to 13 % less force and up to a quarter less
flow (the ends cost 2.6/count).  A check and a first guess, no film."""

import math
from typing import Literal, NamedTuple

import numpy as np

Real = float | np.ndarray
Geometry = Literal["cylindrical", "planar"]


class FilmCoefficients(NamedTuple):
    """Linear film: moment on the stator `-K g - D (g' - i w/2 g)`, force `F_0 - K_z z - D_z z'`.

    K (N m/rad), D (N m s/rad), K_z (N/m), D_z (N s/m), of the shape of the arguments.
    """

    tilt_stiffness: Real
    tilt_damping: Real
    axial_stiffness: Real
    axial_damping: Real


# --- Narrow coned seal -------------------------------------------------------------------------------


def _edge_films(inner_radius: Real, outer_radius: Real, clearance: Real, coning: Real) -> tuple[Real, Real]:
    """Film thickness (m) at the inner and the outer edge; ValueError if faces cross or radii do."""
    inner, outer = np.add(clearance, 0.0), np.add(clearance, coning * np.subtract(outer_radius, inner_radius))
    if not (np.all(np.greater(outer_radius, inner_radius)) and np.all(np.greater(inner_radius, 0))):
        raise ValueError("radii: expected 0 < inner_radius < outer_radius")
    if not (np.all(inner > 0) and np.all(outer > 0)):
        raise ValueError("film: clearance and clearance + coning * face width must both be positive")
    return inner, outer


def _squeeze_factor(inner: Real, outer: Real) -> Real:
    """(artanh y - y) / y^3 with y = (h_o - h_i) / (h_o + h_i), to full precision for any coning; 1/3 flat."""
    y = (outer - inner) / (outer + inner)
    # Near flat faces the difference cancels: its series there, the logarithm elsewhere.
    series = np.zeros_like(y)
    for n in range(27, -1, -1):
        series = series * y**2 + 1 / (2 * n + 3)
    coned = np.where(np.abs(y) < 0.5, 1.0, y)
    return np.where(np.abs(y) < 0.5, series, (0.5 * np.log(outer / inner) - coned) / coned**3)[()]


def film_coefficients(
    inner_radius: Real,
    outer_radius: Real,
    clearance: Real,
    coning: Real,
    viscosity: Real,
    pressure_drop: Real,
) -> FilmCoefficients:
    """Stiffness and damping of the narrow coned film: Green's tilt pair, and its axial pair.  Arguments as the module.

    With h_i, h_o the films at the edges, L the face width, r_m the mean radius:
    `K_f = pi dp (coning r_i - h_i) [r_m L / (h_i + h_o)]^2` and
    `D_f = 24 pi mu r_m^3 [L / (h_i + h_o)]^3 (artanh y - y) / y^3`, y = (h_o - h_i) / (h_o + h_i); independent of
    speed.
    The axial pair is the same film moved without tilt: `K_z = 2 pi r_m L dp (h_o - h_i) / (h_i + h_o)^2`,
    `D_z = 2 D_f / r_m^2`.

    **Source** Green (1989), appendix, after Green (1987), made dimensional; rewritten so that no digits are lost for
    flat or diverging faces.  Axial pair derived here.
    **Valid** narrow face, full film, small motion.  At R = 0.8 the film integrated over the radius is 7 % (planar) to
    12 % (cylindrical) softer: `radial_film_coefficients`.
    **Raises** ValueError when the faces cross.
    """
    inner, outer = _edge_films(inner_radius, outer_radius, clearance, coning)
    width, mean_radius = np.subtract(outer_radius, inner_radius), np.add(inner_radius, outer_radius) / 2
    both = inner + outer
    tilt_stiffness = math.pi * pressure_drop * (coning * inner_radius - inner) * (mean_radius * width / both) ** 2
    squeeze = _squeeze_factor(inner, outer)
    tilt_damping = 24 * math.pi * viscosity * mean_radius**3 * (width / both) ** 3 * squeeze
    axial_stiffness = 2 * math.pi * mean_radius * width * pressure_drop * coning * width / both**2
    return FilmCoefficients(tilt_stiffness, tilt_damping, axial_stiffness, 2 * tilt_damping / mean_radius**2)


def optimum_coning(low_radius: Real, high_radius: Real, thinnest: Real) -> Real:
    """Coning (rad, of a film that widens towards the higher pressure) at which the narrow film is stiffest against
    tilt: `2 C r_h / (r_l L)`, C the `thinnest` film (m), that at the edge `low_radius` (m) of the lower pressure, and
    `high_radius` (m) the other.

    Inwards it is `b = 2 / (R (1 - R))` in units of C/r_o and the stiffness there `pi dp r_i^2 (r_o^2 - r_i^2)/(16 C)`.
    **Source** dK_f/d(coning) = 0 of `film_coefficients`, derived here; Green's (1989) seal, b = 12.5, stands there.
    **Valid** as `film_coefficients`, the thinnest film kept.
    """
    return 2 * thinnest * high_radius / (low_radius * np.abs(np.subtract(high_radius, low_radius)))


def narrow_seal_opening_force(
    inner_radius: Real,
    outer_radius: Real,
    clearance: Real,
    coning: Real,
    inner_pressure: Real,
    outer_pressure: Real,
) -> Real:
    """Opening force (N) of the aligned narrow film, `2 pi r_m L [p_i + dp h_o / (h_i + h_o)]`.  Arguments as the
    module.

    **Source** planar Reynolds equation with the area at the mean radius, as Green (1987).
    **Valid** narrow face, full film.  **Raises** ValueError when the faces cross.
    """
    inner, outer = _edge_films(inner_radius, outer_radius, clearance, coning)
    area = math.pi * (np.square(outer_radius) - np.square(inner_radius))
    return area * (inner_pressure + np.subtract(outer_pressure, inner_pressure) * outer / (inner + outer))


# --- The same film, exact over the radius -------------------------------------------------------------

_NODES, _WEIGHTS = np.polynomial.legendre.leggauss(48)


def _radial_weight(inner_radius, outer_radius, clearance, coning, geometry):
    """Gauss points over the face, the film there, and dr/(r h^3) (cylindrical) or dr/h^3 (planar).

    Arrays of shape (..., 48).  The points lie evenly in ln h, where the integrands are all but entire.
    """
    if geometry not in ("cylindrical", "planar"):
        raise ValueError(f"geometry: found {geometry!r}; expected 'cylindrical' or 'planar'")
    inner, outer = _edge_films(inner_radius, outer_radius, clearance, coning)
    log_ratio, x = np.log(outer / inner)[..., None], (1 + _NODES) / 2
    # Flat faces: the limit of the map, taken by a ratio that is not quite zero.
    log_ratio = np.where(log_ratio == 0, 1e-300, log_ratio)
    width = np.asarray(np.subtract(outer_radius, inner_radius))[..., None] / np.expm1(log_ratio)
    from_inner = width * np.expm1(log_ratio * x)
    r = np.asarray(inner_radius)[..., None] + from_inner
    h = np.asarray(clearance)[..., None] + np.asarray(coning)[..., None] * from_inner
    dr = _WEIGHTS / 2 * width * log_ratio * np.exp(log_ratio * x)
    return r, h, dr / h**3 / (r if geometry == "cylindrical" else 1.0)


def radial_film_coefficients(
    inner_radius: Real,
    outer_radius: Real,
    clearance: Real,
    coning: Real,
    viscosity: Real,
    pressure_drop: Real,
    geometry: Geometry = "cylindrical",
) -> FilmCoefficients:
    """Stiffness and damping of the radial film at zero tilt, tilt and area taken at their own radius.  Arguments as the
    module.

    **Source** linearised `r h^3 p' = 12 mu (Phi + c)`, films without circumferential pressure flow.  A motion `r^j` of
    the film (j = 0 axial, 1 tilt) leaves covariances over the face, which do not cancel.
    **Valid** full film, small motion.  **Raises** ValueError when the faces cross.
    """
    r, h, weight = _radial_weight(inner_radius, outer_radius, clearance, coning, geometry)
    total = weight.sum(-1, keepdims=True)

    def mean(values):
        return (weight * values).sum(-1) / total[..., 0]

    def covariance(a, b):
        return mean((a - mean(a)[..., None]) * (b - mean(b)[..., None]))

    curvature = 1 if geometry == "cylindrical" else 0
    pairs = []
    for j, angle_mean in ((1, math.pi), (0, 2 * math.pi)):
        lever = r ** (2 + j)
        stiffness = -angle_mean * 3 * pressure_drop / (2 + j) * covariance(lever, r**j / h)
        swept = r ** (j + 1 + curvature) / (j + 1 + curvature)
        damping = angle_mean * 12 * viscosity / (2 + j) * covariance(lever, swept) * total[..., 0]
        pairs += [stiffness, damping]
    return FilmCoefficients(*pairs)


class GroovedFace(NamedTuple):
    """Face and grooves: radii (m) of the face and of the grooved annulus, `angle` (rad), `share` of the pitch, `depth`
    and `clearance` over the lands (m)."""

    inner_radius: float
    outer_radius: float
    groove_inner_radius: float
    groove_outer_radius: float
    angle: float
    share: float
    depth: float
    clearance: float


def groove_coefficients(face: GroovedFace) -> tuple[float, float]:
    """K1 (m^3) and K2 (m) of the grooved annulus."""
    cube, land, b = (face.clearance + face.depth) ** 3, face.clearance**3, face.share
    sin, cos = math.sin(face.angle), math.cos(face.angle)
    mixed, step = b * (1.0 - b), cube - land
    whole = (1.0 - b) * cube + b * land
    return (sin * sin * mixed * step * step + cube * land) / whole, sin * cos * mixed * step * face.depth / whole


class NarrowGrooves(NamedTuple):
    """Absolute opening force (N), and flow outwards (m^3/s of a liquid, Pa m^3/s of a gas)."""

    force: float
    flow: float


# Points of Gauss' rule on each annulus of a liquid; steps of Runge and Kutta's on each of a gas.
POINTS, STEPS = np.polynomial.legendre.leggauss(40), 200


def _annuli(face: GroovedFace):
    """(inner radius, outer radius, K1, K2) of the plain and grooved annuli, from the inside out."""
    k1, k2 = groove_coefficients(face)
    plain = face.clearance**3
    limits = face.inner_radius, face.groove_inner_radius, face.groove_outer_radius, face.outer_radius
    three = zip(limits[:-1], limits[1:], (plain, k1, plain), (0.0, k2, 0.0), strict=True)
    return [annulus for annulus in three if annulus[1] > annulus[0]]


def narrow_groove_liquid(
    face: GroovedFace, viscosity: float, entrainment: float, inner_pressure: float, outer_pressure: float
) -> NarrowGrooves:
    """Full film of a liquid (Pa s, rad/s, Pa absolute): p' integrated in closed form, the flow from the pressures at
    the edges, the force by parts."""
    pumped, resistance, annuli = 0.0, 0.0, _annuli(face)
    for a, b, k1, k2 in annuli:
        pumped += 6.0 * viscosity * entrainment * k2 / k1 * (b * b - a * a)
        resistance += 6.0 * viscosity / (math.pi * k1) * math.log(b / a)
    flow = (pumped - (outer_pressure - inner_pressure)) / resistance
    force = math.pi * (outer_pressure * face.outer_radius**2 - inner_pressure * face.inner_radius**2)
    nodes, weights = POINTS
    for a, b, k1, k2 in annuli:
        r = 0.5 * (a + b) + 0.5 * (b - a) * nodes
        slope = 12.0 * viscosity * (entrainment * r * k2 / k1 - flow / (2.0 * math.pi * r * k1))
        force -= math.pi * 0.5 * (b - a) * float(weights @ (slope * r * r))
    return NarrowGrooves(force, flow)


def narrow_groove_gas(
    face: GroovedFace, viscosity: float, entrainment: float, inner_pressure: float, outer_pressure: float
) -> NarrowGrooves:
    """Film of an isothermal gas without slip (Pa s, rad/s, Pa absolute): p^2/2 marched outwards, the flow that meets
    the pressure at the outer edge by Brent's method, since p there falls as the flow grows.  Raises ValueError where
    none meets it."""
    # Takes longer to load than all of the module, which every run needs.
    from scipy.optimize import brentq

    least, annuli = 1e-6 * inner_pressure, _annuli(face)

    def march(flow: float) -> tuple[float, float]:
        """p^2/2 at the outer edge (Pa^2), and the force (N)."""
        half_square, force = 0.5 * inner_pressure**2, 0.0
        for a, b, k1, k2 in annuli:
            carried, lost = 12.0 * viscosity * entrainment * k2 / k1, 6.0 * viscosity * flow / (math.pi * k1)

            def slopes(r, y, carried=carried, lost=lost):
                p = math.sqrt(max(2.0 * y, least * least))
                return carried * r * p - lost / r, 2.0 * math.pi * r * p

            step = (b - a) / STEPS
            for n in range(STEPS):
                r = a + n * step
                s1, f1 = slopes(r, half_square)
                s2, f2 = slopes(r + 0.5 * step, half_square + 0.5 * step * s1)
                s3, f3 = slopes(r + 0.5 * step, half_square + 0.5 * step * s2)
                s4, f4 = slopes(r + step, half_square + step * s3)
                half_square += step / 6.0 * (s1 + 2.0 * (s2 + s3) + s4)
                force += step / 6.0 * (f1 + 2.0 * (f2 + f3) + f4)
        return half_square, force

    def missed(flow: float) -> float:
        return march(flow)[0] - 0.5 * outer_pressure**2

    # From a film that drags nothing.
    high = max(inner_pressure, outer_pressure) ** 2 * face.clearance**3 / viscosity
    low = -high
    while missed(low) < 0.0 and low > -1e6 * high:
        low *= 2.0
    flow = brentq(missed, low, high, xtol=1e-13 * high, rtol=1e-13)
    return NarrowGrooves(march(flow)[1], flow)
