"""Coning of a ring by its temperatures and by pressure: a short cylinder that gives along its length.

The section a <= r <= b of length L, w = b - a, r_m = (a + b)/2; x runs from the face into the ring.  With the mean
temperature T(x) over the section, its gradient g(x) = (12/w^3) int T (r - r_m) dr and D = E w^3/(12 (1 - nu^2)), the
radial displacement u(x) of the middle surface makes least

    int { D [u'' + (1 + nu) alpha g]^2 + (E w/r_m^2) [u - r_m alpha T]^2 } dx / 2 - work of the loads

with free ends; the coning is -u'(0), positive where the face is farther from the film outside.  A face heated on a part
of its width also bows: the slope omega(r) = int^r (1 + nu) alpha (-dT/dx) dr of the face has another mean over the band
that runs on the film than over the whole section.
**Source** cylindrical shell of Timoshenko & Woinowsky-Krieger, with thermal strains; derived and held against finite
elements here (tests/ladder/test_heated_ring.py).
**Valid** rectangular sections.  Of 40 drawn rings wetted outside the coning by heat is within 4 % of finite elements up
to w/a = 0.3 and within 7 % up to 0.4.  In the bore of long thick rings its two parts nearly cancel, and the rest is off
by up to 0.1 alpha R r_m/L, the whole of it there.  By a single pressure within 3 to 8 % up to L = 2 w.
"""

from dataclasses import dataclass
from typing import Literal, NamedTuple

import numpy as np

from ..closed_form.ring_fin import face_moment

ELEMENTS = 60


@dataclass(frozen=True)
class RingBody:
    """A seal ring of one material, the band of it that runs on the film, and where liquid cools it.  SI units."""

    inner_radius: float
    """Of the bore, m; more than 0."""
    outer_radius: float
    """Of the circumference, m."""
    length: float
    """From the face to the back, m."""
    face_inner_radius: float
    """Of the band that carries the film, m; from `inner_radius` on."""
    face_outer_radius: float
    """Of the band, m; up to `outer_radius`."""
    density: float
    """kg/m^3."""
    modulus: float
    """Young's modulus, Pa."""
    poisson: float
    """Poisson's ratio."""
    expansion: float
    """Coefficient of linear thermal expansion, 1/K."""
    conductivity: float
    """W/(m K)."""
    specific_heat: float
    """J/(kg K)."""
    convection: float
    """Of the liquid on the wetted side and on the wetted face beside the band, W/(m^2 K); the rest is insulated."""
    wetted_length: float
    """From the face to the O-ring, m; the whole `length` at most."""
    wet: Literal["outer", "bore", "both"] = "outer"
    """Where the liquid is: on the circumference, in the bore, or both."""

    @property
    def width(self) -> float:
        """Of the section, m."""
        return self.outer_radius - self.inner_radius

    @property
    def mean_radius(self) -> float:
        """Of the section, m."""
        return (self.inner_radius + self.outer_radius) / 2


def section_weights(body: RingBody, edges: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Weights (rings of cells,) that make of temperatures in cells between the radii `edges` (m) their mean over the
    section and their gradient (1/m) across it."""
    widths, off = np.diff(edges), (edges[1:] + edges[:-1]) / 2 - body.mean_radius
    # Exact for a linear temperature, of which cells know only the middles.
    return widths / body.width, widths * off / np.sum(widths * off**2)


def coning_by_temperature(body: RingBody, depths: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Coning (rad) by mean (per K) and by gradient (per K/m) of the temperature at `depths` (m), from 0 to the length
    and linear in between; each of the shape of `depths`."""
    by = _influence(body)
    shares = np.array([np.interp(by.points, depths, row) for row in np.eye(len(depths))]) * by.weights
    bending = -_rigidity(body) * (1 + body.poisson) * body.expansion
    hoop = body.modulus * body.width / body.mean_radius * body.expansion
    return hoop * shares @ by.by_load, bending * shares @ by.bent


def coning_by_bow(body: RingBody, edges: np.ndarray) -> np.ndarray:
    """Coning (rad) of the band by its local bow, over the heat (W/m^2) that flows into the face between the radii
    `edges` (m), shape (rings of cells,)."""
    widths, middles = np.diff(edges), (edges[1:] + edges[:-1]) / 2
    band = (middles > body.face_inner_radius) & (middles < body.face_outer_radius)
    # Mean of int^r q dr over radii s: a cell adds to all radii beyond it, and half of its own.
    beyond = np.tril(np.ones((len(widths),) * 2), -1) + 0.5 * np.eye(len(widths))
    over_band, over_all = (where * widths / np.sum(where * widths) for where in (band, np.ones_like(widths)))
    return (1 + body.poisson) * body.expansion / body.conductivity * ((over_band - over_all) @ beyond) * widths


def crown(body: RingBody, flux: float) -> float:
    """Height (m) of the band's edges beyond the fitted cone, over the heat (W/m^2) that flows into the band: of a
    parabola kappa w^2/12."""
    curvature = (1 + body.poisson) * body.expansion * flux / body.conductivity
    return curvature * (body.face_outer_radius - body.face_inner_radius) ** 2 / 12


def load_coning(
    body: RingBody,
    circumference: float = 0.0,
    bore: float = 0.0,
    face_moment: float = 0.0,
    back_moment: float = 0.0,
) -> float:
    """Coning (rad) by pressures (Pa) on circumference and bore from the face to the O-ring and by moments (N m per
    radian, positive if they open the film outside) on face and back."""
    by, stretch = _influence(body), body.length / ELEMENTS
    # What of each element is wetted.
    wetted = np.clip(body.wetted_length / stretch - np.floor(by.points / stretch), 0.0, 1.0)
    radial = (bore * body.inner_radius - circumference * body.outer_radius) / body.mean_radius
    moments = (face_moment * by.at_face + back_moment * by.at_back) / body.mean_radius
    return float(radial * np.sum(by.weights * wetted * by.by_load) + moments)


def pressure_coning(body: RingBody, pressure: float, balance_radius: float) -> float:
    """Coning (rad) by the pressure of the sealed liquid above that on the other side (Pa), on the wetted side as far as
    the O-ring, on the face beside the band, over the band linearly to nothing, and on the back from `balance_radius`
    (m) to the wetted side.  What force is left over the band carries evenly.

    **Valid** as a number that shows how much hangs on the O-ring and the carrier: 4 mm of an O-ring's place turn the
    sign of it.  `wet` "outer" or "bore".
    """
    inside, bands = body.wet == "bore", (body.face_inner_radius, body.face_outer_radius)
    wet = body.inner_radius if inside else body.outer_radius
    # (from, to, pressures there): face beside the band, film, back.
    beside = (*sorted((bands[0] if inside else bands[1], wet)), pressure, pressure)
    film = (*bands, pressure, 0.0) if inside else (*bands, 0.0, pressure)
    back = (*sorted((balance_radius, wet)), pressure, pressure)
    left = (_force(*back) - _force(*beside) - _force(*film)) / _force(*bands, 1.0, 1.0)
    mean = body.mean_radius
    on_face = face_moment(mean, *beside) + face_moment(mean, *film) + face_moment(mean, *bands, left, left)
    side = {"bore": pressure} if inside else {"circumference": pressure}
    return load_coning(body, **side, face_moment=on_face, back_moment=-face_moment(mean, *back))


def _force(inner, outer, at_inner, at_outer) -> float:
    """Force (N per radian) of a pressure that is linear between two radii."""
    return (outer - inner) / 6 * (at_inner * (2 * inner + outer) + at_outer * (inner + 2 * outer))


def _rigidity(body: RingBody) -> float:
    """D (N m): bending stiffness of the section over its circumference."""
    return body.modulus * body.width**3 / (12 * (1 - body.poisson**2))


class _Influence(NamedTuple):
    """Coning (rad) by a radial load of 1 N/m per metre of circumference at `points` (m) along the length, the second
    derivative of it, `weights` (m) of integrals over the points, and coning by opening moments (1 N m per metre of
    circumference) at face and back."""

    points: np.ndarray
    weights: np.ndarray
    by_load: np.ndarray
    bent: np.ndarray
    at_face: float
    at_back: float


def _influence(body: RingBody) -> _Influence:
    """By reciprocity the shape of the beam under the load that works by -u'(0), from cubic Hermite elements."""
    size = body.length / ELEMENTS
    nodes, weights = np.polynomial.legendre.leggauss(4)
    s, weights = (nodes + 1) / 2, weights / 2
    # Displacement and slope (times the element's length) at both ends, and the shapes' second derivatives.
    shapes = np.array([1 - 3 * s**2 + 2 * s**3, s - 2 * s**2 + s**3, 3 * s**2 - 2 * s**3, s**3 - s**2])
    bends = np.array([12 * s - 6, 6 * s - 4, 6 - 12 * s, 6 * s - 2])
    bed = body.modulus * body.width / body.mean_radius**2
    element = _rigidity(body) / size**3 * (bends * weights) @ bends.T + bed * size * (shapes * weights) @ shapes.T
    stiffness, load = np.zeros((2 * ELEMENTS + 2,) * 2), np.zeros(2 * ELEMENTS + 2)
    for k in range(ELEMENTS):
        stiffness[2 * k : 2 * k + 4, 2 * k : 2 * k + 4] += element
    load[1] = -1.0 / size
    y = np.linalg.solve(stiffness, load)
    own = np.stack([y[2 * k : 2 * k + 4] for k in range(ELEMENTS)])
    points = (np.arange(ELEMENTS)[:, None] + s) * size
    values, bent = (own @ shapes).ravel(), (own @ bends).ravel() / size**2
    return _Influence(points.ravel(), np.tile(weights * size, ELEMENTS), values, bent, -y[1] / size, -y[-1] / size)
