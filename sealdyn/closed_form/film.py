"""Aligned and linearised liquid film of a coned face: the narrow seal, and exact over the radius.

Arguments, scalars or arrays that broadcast: radii and clearance (m), coning (rad), viscosity (Pa s), pressures (Pa).
"""

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


def aligned_opening_force(
    inner_radius: Real,
    outer_radius: Real,
    clearance: Real,
    coning: Real,
    inner_pressure: Real,
    outer_pressure: Real,
    geometry: Geometry = "cylindrical",
) -> Real:
    """Opening force (N) of the aligned radial film, area elements exact: `int p 2 pi r dr`.  Arguments as the module.

    **Source** `r h^3 p' = const` (planar: `h^3 p' = const`), integrated by parts.
    **Valid** aligned faces, full film, incompressible; any face width if cylindrical.
    **Raises** ValueError when the faces cross.
    """
    r, _, weight = _radial_weight(inner_radius, outer_radius, clearance, coning, geometry)
    mean_square = (weight * r**2).sum(-1) / weight.sum(-1)
    drop = np.subtract(outer_pressure, inner_pressure)
    at_edges = outer_pressure * np.square(outer_radius) - inner_pressure * np.square(inner_radius)
    return math.pi * (at_edges - drop * mean_square)


def aligned_leakage(
    inner_radius: Real,
    outer_radius: Real,
    clearance: Real,
    coning: Real,
    viscosity: Real,
    pressure_drop: Real,
    geometry: Geometry = "cylindrical",
) -> Real:
    """Volume flow (m^3/s) through the aligned film, positive inwards for a positive pressure drop.  Arguments as the
    module.

    **Source** Poiseuille flow `r h^3 p' / (12 mu)` per radian; planar: the strip is `2 pi r_m` long.
    **Valid** aligned faces, laminar, incompressible.  **Raises** ValueError when the faces cross.
    """
    _, _, weight = _radial_weight(inner_radius, outer_radius, clearance, coning, geometry)
    length = 1.0 if geometry == "cylindrical" else np.add(inner_radius, outer_radius) / 2
    return math.pi * length * pressure_drop / (6 * viscosity * weight.sum(-1))


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
