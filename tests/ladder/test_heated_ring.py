"""A ring from its drawing: temperatures, coning and their course in time, against finite elements and formulas."""

from dataclasses import replace

import numpy as np
import pytest
from oracles import ring_fin
from own_ring import Ring
from scipy.linalg import eigh

from sealdyn.faces.ring_heat import (
    RADIAL,
    RingBody,
    conduction,
    coning_by_bow,
    coning_by_temperature,
    ring_cooling,
    ring_heat,
    ring_states,
    section_weights,
)
from sealdyn.scene.rings import MATERIALS

CARBON = dict(
    density=1800.0, modulus=20e9, poisson=0.2, expansion=4.5e-6, conductivity=10.0, specific_heat=750.0
)  # fmt: skip
SILICON_CARBIDE = dict(
    density=3100.0, modulus=410e9, poisson=0.16, expansion=4e-6, conductivity=125.0, specific_heat=670.0
)  # fmt: skip
STEEL = dict(
    density=7950.0, modulus=193e9, poisson=0.3, expansion=16e-6, conductivity=15.0, specific_heat=500.0
)  # fmt: skip


def body(inner, outer, length, material, convection, band=None, wetted=None, wet="outer") -> RingBody:
    """A ring by its radii and length in mm."""
    band = (inner, outer) if band is None else band
    sizes = [1e-3 * x for x in (inner, outer, length, *band)]
    return RingBody(*sizes, **material, convection=convection, wetted_length=1e-3 * (wetted or length), wet=wet)


# Rows of an independent program: R (K/W), X (rad/W) and crown (m/W) by finite elements, R, X and time constant (s) by
# finite volumes of the same size, and by how much X may differ from finite elements.
ROWS = {
    "carbon, face is section": (
        body(30.5, 34, 10, CARBON, 5000.0),
        (0.45519, 6.2619e-6, 7.29e-10), (0.45546, 6.2522e-6, 0.7497), 0.03,
    ),
    "silicon carbide, wet face": (
        body(29, 38, 8, SILICON_CARBIDE, 8000.0, (30.5, 34)),
        (0.079492, 2.4778e-7, 5.06e-11), (0.07965, 2.5144e-7, 1.301), 0.04,
    ),
    "steel, wet bore": (
        body(30.5, 34, 10, STEEL, 5000.0, wet="bore"),
        (0.372, 1.2438e-5, 1.9e-9), (0.37217, 1.2471e-5, 2.211), 0.04,
    ),
    "carbon, O-ring": (
        body(29, 36, 20, CARBON, 5000.0, (30.5, 34), 12),
        (0.42178, 2.6839e-6, 7.39e-10), (0.42405, 2.7428e-6, 1.708), 0.05,
    ),
}  # fmt: skip


@pytest.mark.core
@pytest.mark.parametrize("name", ROWS)
def test_rows_of_an_independent_program(name):
    ring, (resistance, coning, _), volumes, within = ROWS[name]
    found = ring_heat(ring)
    assert found.resistance == pytest.approx(resistance, rel=0.02)
    assert found.coning_per_watt == pytest.approx(coning, rel=within)
    # Another division of radii into cells; its time constant is over the resistance of the cells alone.
    assert (found.resistance, found.coning_per_watt) == pytest.approx(volumes[:2], rel=5e-3)
    assert found.time_constant == pytest.approx(volumes[2], rel=0.02)


# --- against finite elements -----------------------------------------------------------------------------


@pytest.mark.parametrize("name", ROWS)
def test_the_finite_elements_are_those_of_the_rows(name):
    """Two programs that share nothing agree to the digits that the other one prints."""
    ring, expected, *_ = ROWS[name]
    found = Ring(ring).heated()
    assert (found.resistance, found.coning) == pytest.approx(expected[:2], rel=1e-3)
    assert found.crown == pytest.approx(expected[2], rel=0.02)


OTHERS = {
    "tungsten carbide": body(20, 26, 9, MATERIALS["tungsten carbide"]._asdict(), 9000.0, (22, 25), 7, "bore"),
    "lead bronze": body(33, 43, 15, MATERIALS["lead bronze"]._asdict(), 1400.0, (35, 40), 10, "both"),
    "alumina": body(45, 57, 12, MATERIALS["alumina"]._asdict(), 6000.0, (46, 51), 9),
}


@pytest.mark.parametrize("name", OTHERS)
def test_other_rings_against_finite_elements(name):
    ring = OTHERS[name]
    found, expected = ring_heat(ring), Ring(ring).heated()
    assert found.resistance == pytest.approx(expected.resistance, rel=0.015)
    # Of the turn of a ring whose face alone is warm; in the bore, where parts of it cancel, 9 % of what is left.
    whole = ring.expansion * expected.resistance * ring.mean_radius / ring.length
    assert found.coning_per_watt == pytest.approx(expected.coning, abs=0.025 * whole)
    assert found.time_constant == pytest.approx(expected.time_constant, rel=0.01)
    assert found.hottest * found.resistance == pytest.approx(expected.hottest, rel=0.02)
    assert found.at_o_ring * found.resistance == pytest.approx(expected.at_o_ring, rel=0.05)


# --- against the fin ---------------------------------------------------------------------------------------


@pytest.mark.parametrize("name, coning", [("carbon, face is section", 6.3251e-6), ("steel, wet bore", 1.2557e-5)])
def test_the_fin_on_a_section_that_gives(name, coning):
    """The fin's temperatures in the beam: its closed form as the independent program has it."""
    ring = ROWS[name][0]
    wet, dry = ring.outer_radius, ring.inner_radius
    wet, dry, sign = (dry, wet, -1) if ring.wet == "bore" else (wet, dry, 1)
    k, width, both = ring.conductivity, ring.width, wet**2 - dry**2
    log, scale = np.log(wet / dry), 2 * wet / abs(both)
    effective = 1 / (1 / ring.convection + scale / k * abs(both / 8 - dry**2 / 4 + dry**4 / (2 * both) * log))
    m = np.sqrt(effective * 2 * wet / (k * abs(both)))
    x = np.linspace(0.0, ring.length, 800)
    rise = np.cosh(m * (ring.length - x)) / np.sinh(m * ring.length) / (k * np.pi * abs(both) * m)
    gradient = -sign * effective * rise * scale * abs(both / 4 - dry**2 / 2 * log) / (k * width)
    by_mean, by_gradient = coning_by_temperature(ring, x)
    assert by_mean @ rise + by_gradient @ gradient == pytest.approx(coning, rel=1e-4)
    assert rise[0] == pytest.approx(ROWS[name][1][0], rel=0.01)


@pytest.mark.parametrize("wet", ["outer", "bore"])
@pytest.mark.parametrize("slender", [0.5, 1.0, 1.6])
@pytest.mark.parametrize("biot", [0.06, 0.5, 4.0])
def test_fin_and_finite_volumes(biot, slender, wet):
    """A face that is the whole section: the two agree where the fin holds."""
    ring = body(30, 36, 6 * slender, STEEL, biot * STEEL["conductivity"] / 6e-3, wet=wet)
    numbers = {key: value for key, value in STEEL.items() if key != "modulus"}
    sizes = ring.inner_radius, ring.outer_radius, ring.length
    resistance, coning, time = ring_fin(*sizes, convection=ring.convection, wet_bore=wet == "bore", **numbers)
    found = ring_heat(ring)
    assert found.resistance == pytest.approx(resistance, rel=0.05)
    assert found.time_constant == pytest.approx(time, rel=0.08)
    # Of the larger of the two parts, which oppose each other in the bore.
    part = ring.expansion * resistance * ring.mean_radius / ring.length
    assert abs(found.coning_per_watt - coning) < 0.06 * max(abs(coning), 0.4 * part)


# --- in time, and what must hold of any ring ---------------------------------------------------------------


@pytest.mark.parametrize("name", ROWS)
def test_six_states_for_the_whole_grid_in_time(name):
    """Face temperature and coning after a step of heat, against all states of the grid, within 3 % of their end."""
    ring = ROWS[name][0]
    grid, whole, found = conduction(ring), ring_heat(ring), ring_states(ring)
    root = np.sqrt(grid.capacity)
    rates, modes = eigh(dense(grid.matrix) / np.outer(root, root))
    modes /= root[:, None]
    time = whole.time_constant * np.geomspace(1e-4, 50.0, 200)
    step = (1 - np.exp(-np.outer(time, rates))) / rates * (grid.flux @ modes)
    rise = step @ (grid.flux @ modes) + grid.immediate_resistance
    coning = step @ (grid.coning @ modes) + grid.immediate_coning
    share = 1 - np.exp(-time[:, None] / found.time_constants)
    assert np.all(found.time_constants > 0) and len(found.time_constants) == 6
    assert np.abs(share @ found.resistances + found.immediate_resistance - rise).max() < 0.03 * whole.resistance
    assert np.abs(share @ found.conings + found.immediate_coning - coning).max() < 0.03 * np.abs(coning).max()
    # What the six and the immediate part add up to is the steady state, and their first moment the time constant.
    moment = np.sum(found.resistances * found.time_constants) / whole.resistance
    assert moment == pytest.approx(whole.time_constant, rel=1e-6)


@pytest.mark.parametrize("name", ROWS)
def test_heat_of_six_states_is_that_of_the_whole_grid(name):
    """Heat held and heat lost while the film heats, holds and stops, beside all cells by the midpoint rule.  In the
    states all that enters is held or lost, to rounding."""
    ring = ROWS[name][0]
    grid, whole, found = conduction(ring), ring_heat(ring), ring_states(ring)
    assert np.sum(found.leaving) == pytest.approx(1.0, rel=1e-9)
    assert found.contents == pytest.approx(found.leaving * found.time_constants, rel=1e-7, abs=1e-9)
    step, cells, states = 0.02 * whole.time_constant, np.zeros(len(grid.flux)), np.zeros(6)
    lost, left, entered, differ = 0.0, 0.0, 0.0, []
    for k in range(400):
        heat = np.interp(k + 0.5, [0, 50, 200, 220], [0.0, 100.0, 100.0, 0.0])
        middle = grid.answer(heat * grid.flux + 2 / step * grid.capacity * cells, 2 / step)
        cells, lost = 2 * middle - cells, lost + step * (grid.convected @ middle)
        between = (heat + 2 * found.time_constants / step * states) / (1 + 2 * found.time_constants / step)
        states, left = 2 * between - states, left + step * (found.leaving @ between)
        entered += step * heat
        differ.append((found.contents @ states - grid.capacity @ cells, left - lost))
    assert np.abs(differ).max() < 3e-2 * entered
    assert left + found.contents @ states == pytest.approx(entered, rel=1e-9)
    assert lost + grid.capacity @ cells == pytest.approx(entered, rel=1e-9)


def dense(bands):
    """The symmetric matrix of lower bands."""
    size = bands.shape[1]
    matrix = np.diag(bands[0])
    for off in (1, RADIAL):
        at = np.arange(size - off)
        matrix[at + off, at] = matrix[at, at + off] = bands[off, : size - off]
    return matrix


@pytest.mark.parametrize("name", [*ROWS, *OTHERS])
def test_what_goes_in_goes_out(name):
    """All heat of the band is convected; in a ring of one temperature none flows but to the liquid."""
    grid = conduction(OTHERS[name] if name in OTHERS else ROWS[name][0])
    assert grid.convected @ grid.answer(grid.flux) == pytest.approx(1.0, rel=1e-10)
    assert dense(grid.matrix).sum(axis=0) == pytest.approx(grid.convected, abs=1e-9 * grid.matrix[0].max())


def test_free_strains_cone_as_they_must():
    """An even temperature cones nothing; one that grows evenly with depth cones -alpha r_m per K/m, without stress."""
    ring = ROWS["carbon, O-ring"][0]
    depths = ring.length * np.linspace(0.0, 1.0, 41) ** 1.5
    by_mean, _ = coning_by_temperature(ring, depths)
    free = ring.expansion * ring.mean_radius
    assert abs(np.sum(by_mean)) < 1e-7 * free / ring.length
    assert by_mean @ depths == pytest.approx(-free, rel=1e-7)


def test_a_mirrored_section_bows_the_other_way():
    """Inside for outside: bow and gradient change their sign, the mean does not."""
    ring = body(29, 36, 20, CARBON, 5000.0, (30.5, 34))
    mirrored = replace(ring, face_inner_radius=0.031, face_outer_radius=0.0345)
    edges = 1e-3 * np.array([29, 29.7, 30.5, 31.3, 32, 34, 35.1, 36])
    flux = np.array([0.0, 0.0, 1.0, 3.0, 2.0, -1.0, -2.0])
    one, other = coning_by_bow(ring, edges), coning_by_bow(mirrored, 0.065 - edges[::-1])
    assert one @ flux == pytest.approx(-(other @ flux[::-1]), rel=1e-9)
    there, back = section_weights(ring, edges), section_weights(mirrored, 0.065 - edges[::-1])
    assert there[0] == pytest.approx(back[0][::-1]) and there[1] == pytest.approx(-back[1][::-1])


def test_hardly_and_well_cooled_rings():
    """Of a ring hardly cooled, which has one temperature, R = 1/(h A) and tau = C R; of one perfectly cooled R
    is what its section resists."""
    ring = ROWS["carbon, O-ring"][0]
    found = ring_heat(replace(ring, convection=1e-3))
    wetted = 2 * np.pi * 0.036 * 0.012 + np.pi * (0.036**2 - 0.034**2)
    capacity = 1800 * 750 * np.pi * (0.036**2 - 0.029**2) * 0.02
    assert found.resistance == pytest.approx(1 / (1e-3 * wetted), rel=1e-3)
    assert found.time_constant == pytest.approx(capacity / (1e-3 * wetted), rel=1e-3)
    assert found.hottest == pytest.approx(1.0, abs=1e-3) and found.at_o_ring == pytest.approx(1.0, abs=1e-3)
    numbers = {key: value for key, value in CARBON.items() if key != "modulus"}
    perfect = ring_heat(body(30, 36, 6, CARBON, 1e12))
    assert perfect.resistance == pytest.approx(ring_fin(0.03, 0.036, 0.006, convection=1e12, **numbers)[0], 0.06)


def test_a_thin_ring():
    """Of a ring a hundred times larger than wide the fin is right to what a grid of 24 by 32 cells errs."""
    numbers = {key: value for key, value in STEEL.items() if key != "modulus"}
    resistance, coning, time = ring_fin(0.6, 0.606, 0.012, convection=500.0, **numbers)
    found = ring_heat(body(600, 606, 12, STEEL, 500.0))
    assert found.resistance == pytest.approx(resistance, rel=5e-4)
    assert found.coning_per_watt == pytest.approx(coning, rel=2e-3)
    assert found.time_constant == pytest.approx(time, rel=3e-3)


def test_the_back_of_a_long_ring_does_not_matter():
    long, longer = (ring_heat(body(30, 36, length, CARBON, 8000.0, (31, 34))) for length in (40, 60))
    assert longer.resistance == pytest.approx(long.resistance, rel=0.02)
    assert longer.coning_per_watt == pytest.approx(long.coning_per_watt, rel=0.02)
    assert long.at_o_ring < 1e-3


def test_a_sliver_beside_the_band_is_part_of_it():
    whole, sliver = (ring_heat(body(30, 36, 8, STEEL, 8000.0, (30 + off, 36 - off))) for off in (0, 1e-9))
    assert sliver.resistance == pytest.approx(whole.resistance, rel=1e-6)
    assert sliver.coning_per_watt == pytest.approx(whole.coning_per_watt, rel=1e-6)


# --- its cooling by its speed --------------------------------------------------------------------------------

# Water of 40 degC: density, viscosity, specific heat, conductivity.
WATER = 992.16, 6.5378e-4, 4178.3, 0.62839


def by_friction(speed, diameter, density, viscosity, specific_heat, conductivity):
    """Convection of a turning cylinder by the analogy of heat and friction (Chilton & Colburn (1934)), its drag by
    Theodorsen & Regier, NACA report 793 (1944): 1/sqrt(c) = -0.6 + 4.07 log10(Re_R sqrt(c))."""
    reynolds, root = speed * diameter**2 / 4 * density / viscosity, 10.0
    for _ in range(60):
        root = -0.6 + 4.07 * np.log10(reynolds / root)
    prandtl = viscosity * specific_heat / conductivity
    return 0.5 / root**2 * density * specific_heat * speed * diameter / 2 * prandtl ** (-2 / 3)


def test_cooling_by_the_analogy_of_heat_and_friction():
    """Becker's convection within -31 and +32 % of it from Re 1e4 to 3e6, in water."""
    for reynolds, more in ((1e4, 0.32), (1e5, 0.10), (1e6, -0.18), (3e6, -0.31)):
        speed = 2 * reynolds * WATER[1] / WATER[0] / 0.072**2
        cooled = ring_cooling(speed, 0.072, WATER, True)
        assert cooled.reynolds == pytest.approx(reynolds)
        assert cooled.value / by_friction(speed, 0.072, *WATER) == pytest.approx(1 + more, abs=0.01)


def test_cooling_of_the_rings_of_a_pump():
    """2950 rpm, water of 40 degC: 13590 W/(m^2 K) at 72 mm of a ring that stands, 21572 if it turned."""
    stands, turns = (ring_cooling(-308.923278, 0.072, WATER, turns) for turns in (False, True))
    assert (stands.value, turns.value) == pytest.approx((13590, 21572), rel=1e-3)
    assert (stands.low, stands.high) == (stands.value / 2, stands.value * 2)
    assert stands.extrapolated and not ring_cooling(20.0, 0.072, WATER, True).extrapolated
