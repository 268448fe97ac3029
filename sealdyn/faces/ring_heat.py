"""What heat does to a ring from its drawing: its temperatures and the coning of its face; its cooling by its speed.

**Heat**  Finite volumes over radius and depth: heat enters evenly over the band, liquid takes it on the wetted side
from the face to the O-ring and on the wetted face beside the band, all else is insulated.  Temperatures count from the
liquid's.
**Source** conservation of heat; conduction between cells as of annuli.  Held against finite elements in
tests/ladder/test_heated_ring.py.
**Valid** conductivity and convection (more than 0) that do not depend on temperature.  Of 40 drawn rings (w/a 0.08 to
0.4, L/w 0.6 to 3.5, h w/k up to 22) the resistance is within 2.3 % of finite elements (1 % up to h w/k = 6), the time
constant within 1 %, the hottest place within 1.2 %.

**Coning**  A short cylinder that gives along its length: the section a <= r <= b of length L, w = b - a,
r_m = (a + b)/2; x runs from the face into the ring.  With the mean temperature T(x) over the section, its gradient
g(x) = (12/w^3) int T (r - r_m) dr and D = E w^3/(12 (1 - nu^2)), the radial displacement u(x) of the middle surface
makes least

    int { D [u'' + (1 + nu) alpha g]^2 + (E w/r_m^2) [u - r_m alpha T]^2 } dx / 2 - work of the loads

with free ends; the coning is -u'(0), positive where the face is farther from the film outside.  A face heated on a part
of its width also bows: the slope omega(r) = int^r (1 + nu) alpha (-dT/dx) dr of the face has another mean over the band
that runs on the film than over the whole section.
**Source** cylindrical shell of Timoshenko & Woinowsky-Krieger, with thermal strains; derived and held against finite
elements here (tests/ladder/test_heated_ring.py).
**Valid** rectangular sections.  Of 40 drawn rings wetted outside the coning by heat is within 4 % of finite elements up
to w/a = 0.3 and within 7 % up to 0.4.  In the bore of long thick rings its two parts nearly cancel, and the rest is off
by up to 0.1 alpha R r_m/L, the whole of it there.
"""

from dataclasses import dataclass, replace
from functools import lru_cache
from typing import Literal, NamedTuple

import numpy as np
from scipy.linalg import cho_solve_banded, cholesky_banded, eigh

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
    points, weights, by_load, bent = _influence(body)
    shares = np.array([np.interp(points, depths, row) for row in np.eye(len(depths))]) * weights
    bending = -_rigidity(body) * (1 + body.poisson) * body.expansion
    hoop = body.modulus * body.width / body.mean_radius * body.expansion
    return hoop * shares @ by_load, bending * shares @ bent


def coning_by_bow(body: RingBody, edges: np.ndarray) -> np.ndarray:
    """Coning (rad) of the band by its local bow, over the heat (W/m^2) that flows into the face between the radii
    `edges` (m), shape (rings of cells,)."""
    widths, middles = np.diff(edges), (edges[1:] + edges[:-1]) / 2
    band = (middles > body.face_inner_radius) & (middles < body.face_outer_radius)
    # Mean of int^r q dr over radii s: a cell adds to all radii beyond it, and half of its own.
    beyond = np.tril(np.ones((len(widths),) * 2), -1) + 0.5 * np.eye(len(widths))
    over_band, over_all = (where * widths / np.sum(where * widths) for where in (band, np.ones_like(widths)))
    return (1 + body.poisson) * body.expansion / body.conductivity * ((over_band - over_all) @ beyond) * widths


def _rigidity(body: RingBody) -> float:
    """D (N m): bending stiffness of the section over its circumference."""
    return body.modulus * body.width**3 / (12 * (1 - body.poisson**2))


def _influence(body: RingBody) -> tuple[np.ndarray, np.ndarray, np.ndarray, np.ndarray]:
    """Points (m) along the length and weights (m) of integrals over them; there the coning (rad) by a radial load of
    1 N/m per metre of circumference, and its second derivative.

    By reciprocity it is the shape of the beam under the load that works by -u'(0), from cubic Hermite elements."""
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
    return points.ravel(), np.tile(weights * size, ELEMENTS), values, bent


RADIAL, AXIAL, GRADING = 24, 32, 1.5
# Cells of the band at least, and of each stretch beside it.
FEWEST_IN_BAND, FEWEST_BESIDE = 8, 2
# Shifts over 1/(time constant) whose answers the reduced states span beside the even temperature, which stands for the
# coning's answer at the last.  Of 40 rings drawn at random the face is within 2.1 %, the coning within 2.8 % of the
# whole grid at all times, as with that answer in its place.
SHIFTS = (0.0, 4.0, 80.0)


@dataclass(frozen=True)
class Conduction:
    """The ring in cells, radius fastest: C dT/dt = flux q - K T, face T = flux T + immediate q, coning likewise.

    `edges` (m, radial + 1), `depths` (m, axial + 1); `matrix` K (W/K, lower bands (radial + 1, cells)); `capacity` C
    (J/K, cells), `flux` (cells, sums to 1), `convected` (W/K, cells) what each cell gives to the liquid, `coning`
    (rad/K, cells), `immediate_resistance` (K/W) and `immediate_coning` (rad/W) of the outermost half cells.
    """

    edges: np.ndarray
    depths: np.ndarray
    matrix: np.ndarray
    capacity: np.ndarray
    flux: np.ndarray
    convected: np.ndarray
    coning: np.ndarray
    immediate_resistance: float
    immediate_coning: float

    def answer(self, load: np.ndarray, shift: float = 0.0) -> np.ndarray:
        """(K + shift C)^-1 load, shift in 1/s; loads (cells,) or (cells, n)."""
        matrix = self.matrix.copy()
        matrix[0] += shift * self.capacity
        return cho_solve_banded((cholesky_banded(matrix, lower=True), True), load)


@dataclass(frozen=True)
class RingHeat:
    """What heat through its face does to a ring."""

    resistance: float
    """Mean rise of the band over the heat, K/W."""
    coning_per_watt: float
    """rad/W, positive if the film grows thicker outside."""
    time_constant: float
    """First moment of the face's response to a step of heat, s."""
    hottest: float
    """Hottest place of the band over its mean rise, under even heat."""
    at_o_ring: float
    """Rise of the wetted side where the O-ring sits, over the mean rise of the band."""
    biot: float
    """Convection times width over conductivity."""


class RingStates(NamedTuple):
    """Slow answers of a ring to the heat through its face."""

    time_constants: np.ndarray
    """Of the reduced states, s, (6,), slowest first."""
    resistances: np.ndarray
    """What each state adds to the face's rise, K/W, (6,)."""
    conings: np.ndarray
    """What each state adds to the coning, rad/W, (6,)."""
    contents: np.ndarray
    """What each state adds to the heat that the ring holds, J/W, (6,)."""
    leaving: np.ndarray
    """What each state adds to the heat that the liquid takes, over the heat, (6,); their sum is 1."""
    immediate_resistance: float
    """Rest of the resistance, which follows the heat at once, K/W."""
    immediate_coning: float
    """Rest of the coning per watt, rad/W."""


@lru_cache(maxsize=64)
def ring_heat(body: RingBody) -> RingHeat:
    """The steady numbers of a ring, solved on the grid (a millisecond)."""
    ring = conduction(body)
    steady = ring.answer(ring.flux)
    resistance = float(ring.flux @ steady) + ring.immediate_resistance
    flux = 1 / _annulus(body.face_inner_radius, body.face_outer_radius)
    band = ring.flux[:RADIAL] > 0
    half = ring.depths[1] / 2
    hottest = float(np.max(steady[:RADIAL][band])) + flux * half / body.conductivity
    return RingHeat(
        resistance,
        float(ring.coning @ steady) + ring.immediate_coning,
        float(steady @ (ring.capacity * steady)) / resistance,
        hottest / resistance,
        _at_o_ring(body, ring, steady) / resistance,
        body.convection * body.width / body.conductivity,
    )


@lru_cache(maxsize=64)
def ring_states(body: RingBody) -> RingStates:
    """What the ring does in time, by six states (two milliseconds)."""
    found = ring_heat(body)
    times, resistances, conings, contents, leaving = _reduced(conduction(body), found.time_constant)
    return RingStates(
        times,
        resistances,
        conings,
        contents,
        leaving,
        found.resistance - float(np.sum(resistances)),
        found.coning_per_watt - float(np.sum(conings)),
    )


@lru_cache(maxsize=8)
def conduction(body: RingBody) -> Conduction:
    """The grid and matrices of a ring."""
    edges, depths = _radii(body), _depths(body)
    k, sizes = body.conductivity, np.diff(depths)
    areas, middles = _annulus(edges[:-1], edges[1:]), (edges[1:] + edges[:-1]) / 2
    half = sizes[0] / 2
    # Between neighbours in depth and in radius, W/K.
    deeper = k * areas / ((sizes[1:] + sizes[:-1]) / 2)[:, None]
    outward = 2 * np.pi * k * sizes[:, None] / np.log(middles[1:] / middles[:-1])
    convected = np.zeros((AXIAL, RADIAL))
    wetted = np.clip(body.wetted_length - depths[:-1], 0.0, sizes)
    sides = {"outer": (1,), "bore": (0,), "both": (0, 1)}[body.wet]
    for side in sides:
        wall, cell = ((edges[0], 0), (edges[-1], -1))[side]
        inside = wall * abs(np.log(wall / middles[cell])) / k
        convected[:, cell] += 2 * np.pi * wall * wetted / (1 / body.convection + inside)
    band = (middles > body.face_inner_radius) & (middles < body.face_outer_radius)
    beside = np.zeros(RADIAL, bool)
    for side in sides:
        beside |= middles > body.face_outer_radius if side else middles < body.face_inner_radius
    convected[0] += np.where(beside, areas / (1 / body.convection + half / k), 0.0)
    matrix = np.zeros((RADIAL + 1, AXIAL, RADIAL))
    matrix[0] = convected
    matrix[0, :-1] += deeper
    matrix[0, 1:] += deeper
    matrix[0, :, :-1] += outward
    matrix[0, :, 1:] += outward
    matrix[1, :, :-1] = -outward
    matrix[RADIAL, :-1] = -deeper
    capacity = body.density * body.specific_heat * areas * sizes[:, None]
    flux = np.zeros((AXIAL, RADIAL))
    flux[0] = band * areas / np.sum(band * areas)
    row, rest = _coning_row(body, depths, band, beside)
    return Conduction(
        edges,
        depths,
        matrix.reshape(RADIAL + 1, -1),
        capacity.ravel(),
        flux.ravel(),
        convected.ravel(),
        row.ravel(),
        half / (k * float(np.sum(band * areas))),
        rest,
    )


def _coning_row(body: RingBody, depths, band, beside) -> tuple[np.ndarray, float]:
    """Coning (rad) over the temperatures of the cells (AXIAL, RADIAL), and over the heat (W) at once."""
    half, k = np.diff(depths)[0] / 2, body.conductivity
    # The beam knows nothing of the liquid.
    all_depths, bow, flux = _coning_of_cells(replace(body, convection=1.0))
    row = all_depths[1:-1].copy()
    row[-1] += all_depths[-1]
    # The face is as warm as its cells, cooler where liquid wets it, warmer under the film.
    loss = np.where(beside, 1 / (1 / body.convection + half / k), 0.0)
    row[0] += all_depths[0] * (1 - loss * half / k) - bow * loss
    return row, float(np.sum(band * flux * (all_depths[0] * half / k + bow)))


@lru_cache(maxsize=8)
def _coning_of_cells(body: RingBody) -> tuple[np.ndarray, np.ndarray, float]:
    """Coning over the temperatures (AXIAL + 2, RADIAL) of face, cells and back (rad/K) and by the local bow over the
    heat (W/m^2) into the face (RADIAL,); heat flux (W/m^2) of a watt through the band."""
    edges, depths = _radii(body), _depths(body)
    middles = np.concatenate([[0.0], (depths[1:] + depths[:-1]) / 2, [body.length]])
    by_mean, by_gradient = coning_by_temperature(body, middles)
    mean, gradient = section_weights(body, edges)
    over = (edges[1:] + edges[:-1]) / 2
    band = (over > body.face_inner_radius) & (over < body.face_outer_radius)
    all_depths = by_mean[:, None] * mean + by_gradient[:, None] * gradient
    return all_depths, coning_by_bow(body, edges), 1 / np.sum(band * _annulus(edges[:-1], edges[1:]))


def _reduced(ring: Conduction, time: float):
    """States of slow answers (rational Krylov projection): time constants (s) and, of each over the heat, what it adds
    to the face's rise, to the coning, to the heat held and to the heat that leaves.

    The space of (K + s C)^-1 [flux, coning] at a few shifts s, and the even temperature: with it heat is kept as in the
    whole grid, 1^T K being what is convected.  As K and C are symmetric all states decay.
    """
    loads = np.stack([ring.flux, ring.coning / np.linalg.norm(ring.coning)], axis=1)
    even = np.ones((len(ring.flux), 1))
    space = np.concatenate([even, *(ring.answer(loads, shift / time) for shift in SHIFTS)], axis=1)[:, :-1]
    # Orthonormal in C; two answers that coincide would leave a direction of rounding, which carries nothing.
    root = np.sqrt(ring.capacity)[:, None]
    basis, _ = np.linalg.qr(root * space / np.linalg.norm(root * space, axis=0))
    basis /= root
    rates, modes = eigh(basis.T @ _times(ring.matrix, basis))
    states = basis @ modes
    by_heat = ring.flux @ states / rates
    rows = ring.flux, ring.coning, ring.capacity, ring.convected
    return 1 / rates, *(by_heat * (row @ states) for row in rows)


def _times(bands: np.ndarray, vectors: np.ndarray) -> np.ndarray:
    """The symmetric matrix of lower `bands` times columns."""
    product = bands[0][:, None] * vectors
    for off in (1, RADIAL):
        band = bands[off, : len(vectors) - off][:, None]
        product[off:] += band * vectors[:-off]
        product[:-off] += band * vectors[off:]
    return product


def _at_o_ring(body: RingBody, ring: Conduction, steady: np.ndarray) -> float:
    """Rise (K/W) of the wetted side's outermost cells where the O-ring sits."""
    middles = (ring.depths[1:] + ring.depths[:-1]) / 2
    along = steady.reshape(AXIAL, RADIAL)[:, 0 if body.wet == "bore" else -1]
    return float(np.interp(body.wetted_length, middles, along))


def _depths(body: RingBody) -> np.ndarray:
    """Edges (m) of the cells from the face to the back."""
    return body.length * np.linspace(0.0, 1.0, AXIAL + 1) ** GRADING


def _radii(body: RingBody) -> np.ndarray:
    """Edges (m) of the cells, evenly in the band and beside it on either side."""
    marks = [body.inner_radius, body.face_inner_radius, body.face_outer_radius, body.outer_radius]
    widths = np.diff(marks)
    beside = [i for i in (0, 2) if widths[i] > 1e-6 * body.width]
    counts = [0, RADIAL, 0]
    for i in beside:
        counts[i] = max(FEWEST_BESIDE, round(RADIAL * widths[i] / body.width))
    while sum(counts[i] for i in beside) > RADIAL - FEWEST_IN_BAND:
        counts[max(beside, key=counts.__getitem__)] -= 1
    counts[1] = RADIAL - counts[0] - counts[2]
    # A sliver beside the band belongs to it.
    marks[1], marks[2] = (marks[1] if counts[0] else marks[0]), (marks[2] if counts[2] else marks[3])
    stretches = [np.linspace(marks[i], marks[i + 1], counts[i], endpoint=False) for i in range(3) if counts[i]]
    return np.concatenate([*stretches, [marks[3]]])


def _annulus(inner, outer):
    """Its area (m^2)."""
    return np.pi * (outer**2 - inner**2)


# Reynolds numbers w D^2/(2 nu) over which Becker measured.
BECKER_RANGE = (800.0, 1e5)
# A correlation for a free cylinder in a chamber with flush and dead corners: within this factor either way.
CONVECTION_FACTOR = 2.0


class Cooling(NamedTuple):
    """Convection of a ring by its speed: `value`, and the `low` and `high` it may be (W/(m^2 K)); the Reynolds number
    w D^2/(2 nu), and whether it is `extrapolated` beyond what was measured."""

    value: float
    low: float
    high: float
    reynolds: float
    extrapolated: bool


def ring_cooling(speed: float, diameter: float, liquid: tuple[float, float, float, float], turns: bool) -> Cooling:
    """Convection of a cylinder that turns in liquid, Nu_D = 0.133 Re^(2/3) Pr^(1/3), twice or half of it.

    A ring that stands has the liquid turn past it at half the speed, an assumption.  `speed` (rad/s) of the other ring
    over it, `diameter` (m) of its wetted side, `liquid` (density kg/m^3, viscosity Pa s, specific heat J/(kg K),
    conductivity W/(m K)).
    **Source** Becker (1963), a horizontal cylinder in water, as it is widely quoted; the paper itself was not seen.
    **Valid** Re = w D^2/(2 nu) of 800 to 1e5.  From 1e4 to 3e6 within a third of the analogy of heat and friction
    (Chilton & Colburn (1934), drag of Theodorsen & Regier, NACA report 793 (1944)).
    """
    density, viscosity, specific_heat, conductivity = liquid
    passing = abs(speed) if turns else abs(speed) / 2
    reynolds, prandtl = passing * diameter**2 * density / (2 * viscosity), viscosity * specific_heat / conductivity
    value = 0.133 * reynolds ** (2 / 3) * prandtl ** (1 / 3) * conductivity / diameter
    outside = not BECKER_RANGE[0] <= reynolds <= BECKER_RANGE[1]
    return Cooling(value, value / CONVECTION_FACTOR, value * CONVECTION_FACTOR, reynolds, outside)
