"""The two-dimensional film of a liquid: steady pressures and cavities, its derivatives, what it sums up to."""

import math
from dataclasses import replace

import numpy as np
import own_cavities
import pytest
from gas_faces import gap_state
from scipy.integrate import dblquad, quad

from sealdyn.faces import contact, roughness
from sealdyn.faces import geometry as G
from sealdyn.faces.film_thickness import lay_waves
from sealdyn.films import film_named
from sealdyn.films.reynolds import film as reynolds
from sealdyn.films.reynolds import mesh as means
from sealdyn.scene.film import Film, Reynolds
from sealdyn.scene.forces import Contact
from sealdyn.scene.patterns import Waviness

SPIN, VISCOUS = 300.0, 1e-3


def wide(**more):
    """A Film table that cavitates."""
    given = dict(
        inner_radius=0.045, outer_radius=0.05, inner_pressure=1e5, outer_pressure=3e5, viscosity=VISCOUS,
        cavitation_pressure=2e4, clearance=3e-6, model="reynolds", reynolds=Reynolds(cells_r=8, cells_theta=36),
    )  # fmt: skip
    return Film(**(given | more))


def gap(film, **slots):
    """Gap state at its pressures, the rotor turning."""
    return gap_state(film, SPIN, **slots)


def block(film, waves=()):
    f = reynolds.parameters(film, film.clearance)
    lay_waves(f, list(waves), [])
    return f


def settled(film, waves=(), **slots):
    """Block, gap state with loads and flows, unknowns of the film at rest."""
    f, s = block(film, waves), gap(film, **slots)
    x = np.empty(len(reynolds.unknowns(f).names))
    assert reynolds.start(f, s, x) == 0
    reynolds.flow(f, s, x)
    return f, s, x


def cells(film):
    return film.reynolds.cells_r * film.reynolds.cells_theta


THREE = [Waviness(order=3, amplitude=1.5e-6)]


# --- pressures and cavities -------------------------------------------------------------------------


def test_pressures_and_voids_are_those_of_a_liquid_that_is_a_little_soft():
    film = wide()
    _, s, x = settled(film, THREE)
    waves = lambda a: 3e-6 + 1.5e-6 * np.cos(3 * a)  # noqa: E731
    p, fill, force = own_cavities.steady(0.045, 0.05, 8e4, 2.8e5, VISCOUS, 0.5 * SPIN, waves, (8, 36))
    u = x[: cells(film)].reshape(36, 8).T
    scale = 2.8e5
    assert 0.05 < s[G.CAVITATED] < 0.6
    assert scale * np.maximum(u, 0.0) == pytest.approx(p, abs=3e-3 * p.max())
    assert 1.0 + np.minimum(u, 0.0) == pytest.approx(fill, abs=3e-3)
    area = math.pi * (0.05**2 - 0.045**2)
    assert s[G.FORCE] - 2e4 * area == pytest.approx(force, rel=3e-3)


@pytest.mark.core
@pytest.mark.parametrize("tilt", [0.0, 2e-5])
def test_what_flows_in_flows_out(tilt):
    _, s, _ = settled(wide(), THREE, GX=tilt)
    assert s[G.FLOW_INNER] == pytest.approx(s[G.FLOW_OUTER], rel=1e-10)


def test_a_film_that_never_cavitates_may_fall_below_zero():
    film = wide(reynolds=Reynolds(cells_r=8, cells_theta=36, cavitation="none"))
    _, s, x = settled(film, THREE)
    assert s[G.CAVITATED] == 0.0
    assert x[: cells(film)].min() < -1.0


def test_cells_converge():
    loads = []
    for size in (1, 2, 4):
        film = wide(reynolds=Reynolds(cells_r=6 * size, cells_theta=36 * size))
        _, s, _ = settled(film, THREE)
        loads.append([s[G.FORCE], s[G.TORQUE]])
    loads = np.array(loads)
    change = np.abs(np.diff(loads, axis=0)) / np.abs(loads[-1])
    assert np.all(change[0] < 0.05)
    assert np.all(change[1] < 0.5 * change[0])


def test_cells_of_a_full_film_converge_at_second_order():
    forces = []
    for size in (1, 2, 4):
        options = Reynolds(cells_r=6 * size, cells_theta=36 * size, cavitation="none")
        _, s, _ = settled(wide(reynolds=options, coning=2e-4), THREE, GX=1e-5)
        forces.append(s[G.MOMENT_Y])
    first, second = np.diff(forces)
    assert first / second == pytest.approx(4.0, rel=0.15)


def test_one_sector_stands_for_all():
    film = wide(reynolds=Reynolds(cells_r=8, cells_theta=36, sectors=3))
    _, part, x = settled(film, THREE)
    _, whole, _ = settled(wide(), THREE)
    assert len(x) == 2 * 8 * 12
    for slot in (G.FORCE, G.FLOW_INNER, G.FLOW_OUTER, G.TORQUE, G.CAVITATED):
        assert part[slot] == pytest.approx(whole[slot], rel=1e-9)


# --- its neighbour on the ladder --------------------------------------------------------------------


def narrow(width, around=64):
    """A narrow face and its radial film's table."""
    film = wide(
        inner_radius=1.0 - width, outer_radius=1.0, cavitation_pressure=None, clearance=1e-5,
        reynolds=Reynolds(cells_r=120, cells_theta=around, cavitation="none"),
    )  # fmt: skip
    return film, replace(film, model="radial", reynolds=None)


def test_squeezed_parallel_faces_are_those_of_the_radial_film():
    film, radial = narrow(0.05)
    _, s, _ = settled(film, DZ_RATE=-1e-4)
    other = gap(radial, DZ_RATE=-1e-4)
    law = film_named("radial", radial)
    law.flow(law.parameters(radial, 1e-5, 1e-10), other)
    for slot in (G.FORCE, G.FLOW_INNER, G.FLOW_OUTER, G.TORQUE):
        assert s[slot] == pytest.approx(other[slot], rel=5e-4)


def test_tilted_narrow_faces_tend_to_those_of_the_radial_film():
    apart = []
    for width in (0.1, 0.05):
        film, radial = narrow(width)
        tilt = dict(GX=4e-6, GY=1e-6, GX_RATE=1e-4, MEAN_SPIN=50.0)
        _, s, _ = settled(film, **tilt)
        other = gap(radial, **tilt)
        law = film_named("radial", radial)
        law.flow(law.parameters(radial, 1e-5, 1e-10), other)
        moments = [np.hypot(s[G.MOMENT_X] - other[G.MOMENT_X], s[G.MOMENT_Y] - other[G.MOMENT_Y])]
        apart.append(moments[0] / np.hypot(other[G.MOMENT_X], other[G.MOMENT_Y]))
    # What flows around the circle is of second order in the width.
    assert apart[1] < 0.02
    assert apart[1] < 0.4 * apart[0]


@pytest.mark.parametrize("inner", [2e4, 1e5])
def test_waves_that_are_the_same_at_every_radius_leak_as_if_nothing_moved(inner):
    """Weighted with ln r the balance of all cells leaves the flow of parallel faces of mean h^3, with cavities or
    without: what is dragged around the circle comes back."""
    film = wide(inner_pressure=inner, reynolds=Reynolds(cells_r=8, cells_theta=60))
    _, s, _ = settled(film, THREE)
    assert s[G.CAVITATED] > 0.05
    cube = 3e-6**3 + 1.5 * 3e-6 * 1.5e-6**2
    leakage = 2.0 * math.pi * cube * (3e5 - inner) / (12.0 * VISCOUS * math.log(0.05 / 0.045))
    assert -s[G.FLOW_INNER] == pytest.approx(leakage, rel=1e-11)


def low_pressure(edges):
    """Ludwig & Allen's narrow seal, tilted, both edges at a pressure over that of cavities; with the film's floor."""
    film = wide(
        inner_radius=0.05949, outer_radius=0.06051, inner_pressure=edges, outer_pressure=edges, viscosity=2e-3,
        cavitation_pressure=0.0, clearance=5e-6, reynolds=Reynolds(cells_r=16, cells_theta=128),
    )  # fmt: skip
    return film, replace(film, model="radial", reynolds=None)


def test_beside_the_floored_radial_film_on_a_narrow_seal():
    film, radial = low_pressure(2e4)
    _, s, _ = settled(film, GX=6e-5)
    other, law = gap(radial, GX=6e-5), film_named("radial", radial)
    law.flow(law.parameters(radial, 5e-6, 1e-8), other)
    assert 0.03 < s[G.CAVITATED] < 0.3 and 0.03 < other[G.CAVITATED] < 0.3
    assert other[G.FORCE] == pytest.approx(s[G.FORCE], rel=0.01)
    assert other[G.MOMENT_Y] == pytest.approx(s[G.MOMENT_Y], rel=0.05)
    # Between equal pressures the floor leaks as much in as out at each edge; what tears and fills pumps inwards.
    assert abs(other[G.FLOW_INNER]) < 1e-3 * abs(s[G.FLOW_INNER])
    assert s[G.FLOW_INNER] < 0.0


def test_edges_at_the_cavitation_pressure_starve_the_film():
    film, _ = low_pressure(0.0)
    f, s = block(film), gap(film, GX=6e-5)
    code = reynolds.start(f, s, np.empty(len(reynolds.unknowns(f).names)))
    assert "starve" in reynolds.STATUS[code]


# --- derivatives and starts -------------------------------------------------------------------------


def moving():
    return settled(wide(), THREE, GX=1e-5, DZ_RATE=-2e-5, GX_RATE=1e-3)


def must_have_its_jacobian(f, s, x, alpha, every=1):
    """Beside differences, for every so many unknowns."""
    unknowns = reynolds.unknowns(f)
    pattern, rate, high, low = unknowns.pattern, np.zeros_like(x), np.empty_like(x), np.empty_like(x)
    data = np.empty(pattern.nnz)
    reynolds.jacobian(f, s, x, rate, alpha, data)
    found = type(pattern)((data, pattern.indices, pattern.indptr), pattern.shape).toarray()
    for j in range(0, len(x), every):
        step = 1e-6 * unknowns.scales[j]
        if abs(x[j]) < 2 * step:
            continue
        for sign, out in ((1.0, high), (-1.0, low)):
            near, near_rate = x.copy(), rate.copy()
            near[j], near_rate[j] = near[j] + sign * step, alpha * sign * step
            reynolds.residual(f, s, near, near_rate, out)
        numbers = (high - low) / (2.0 * step)
        assert found[:, j] == pytest.approx(numbers, abs=1e-6 * np.abs(numbers).max())


@pytest.mark.parametrize("alpha", [0.0, 700.0])
def test_the_jacobian_is_that_of_the_residual(alpha):
    must_have_its_jacobian(*moving(), alpha, every=7)


def test_short_circles_have_their_neighbours_once():
    for angles in (1, 2, 3):
        film = wide(reynolds=Reynolds(cells_r=4, cells_theta=12, sectors=12 // angles))
        must_have_its_jacobian(*settled(film, DZ_RATE=-1e-5), 3.0)


def test_force_and_moments_by_the_unknowns():
    f, s, x = moving()
    rows, loads = np.empty((3, len(x))), []
    reynolds.wrench_jacobian(f, s, x, rows)
    for j in (3, 100, 250):
        for sign in (1.0, -1.0):
            near = x.copy()
            near[j] += sign * 1e-6
            reynolds.wrench(f, s, near)
            loads.append(s[[G.FORCE, G.MOMENT_X, G.MOMENT_Y]].copy())
        assert rows[:, j] == pytest.approx((loads[-2] - loads[-1]) / 2e-6, rel=1e-6, abs=1e-9)


def test_a_start_in_motion_satisfies_the_equations():
    f, s, x = moving()
    rate, res = np.zeros_like(x), np.empty_like(x)
    reynolds.residual(f, s, x, rate, res)
    n = len(x) // 2
    fastest = 2e-5 + 0.05 * 1e-3 + 3e-6 * SPIN
    # Rows of pressure and void; those of the liquid say how fast it moves.
    assert np.abs(res[:n]).max() < 1e-5 * fastest
    assert np.abs(res[n:]).max() < 10.0 * fastest


# --- rough faces ------------------------------------------------------------------------------------


@pytest.mark.parametrize("x", [-0.7, -0.2, 0.0, 0.3, 0.99, 1.0, 1.7])
def test_means_over_the_asperities(x):
    assert means.mean_cube(x, 1.0, 0.0, False) == pytest.approx(float(roughness.mean_film_cubed(x)), rel=1e-11)
    assert means.contact_share(x, 1.0) == pytest.approx(float(roughness.contact_fraction(x)), abs=1e-14)

    def density(d):
        return 35.0 / 32.0 * (1.0 - d * d) ** 3

    low = max(-1.0, 0.1 - x)
    reciprocal = quad(lambda d: density(d) / (x + d), low, 1.0, epsrel=1e-12)[0]
    assert means.mean_reciprocal(x, 1.0, 0.0) == pytest.approx(reciprocal, rel=1e-9)
    # Over plateaus that are 4 apart: the smooth film that stays between them, and how it moves.
    smooth = 4.0 + quad(lambda d: density(d) * max(x + d, 0.0), -1.0, 1.0, points=[min(max(-x, -1.0), 1.0)])[0]
    moved = quad(density, max(-x, -1.0), 1.0)[0] if x > -1.0 else 0.0
    assert means.mean_film(x, 1.0, 0.0) == pytest.approx(smooth - 4.0, rel=1e-9)
    assert means.mean_film(4.0 + x, 1.0, 4.0) == pytest.approx(smooth, rel=1e-9)
    assert means.mean_cube(4.0 + x, 1.0, 4.0, False) == pytest.approx(smooth**3, rel=1e-9)
    assert means.mean_reciprocal(4.0 + x, 1.0, 4.0) == pytest.approx(1.0 / smooth, rel=1e-9)
    open_share = 1.0 - means.contact_share(means.open_height(4.0 + x, 1.0, 4.0, 9.0) - 4.0, 1.0)
    assert open_share == pytest.approx(moved, abs=1e-9)
    assert means.open_slope(4.0 + x, 1.0, 4.0, 9.0) == 1.0


@pytest.mark.parametrize("c", [0.0, 10.0])
@pytest.mark.parametrize("x", [-2.0, 0.3, 0.9, 1.1])
def test_the_continued_film_moves_as_its_slope_says(x, c):
    """Around the floor of smooth faces, and around where rough ones are continued: both 0.5."""
    h, step = 0.5 * x - c, 1e-6
    ahead, behind = (means.open_height(h + side * step, c, 0.0, 0.5) for side in (1, -1))
    assert means.open_slope(h, c, 0.0, 0.5) == pytest.approx((ahead - behind) / (2 * step), rel=1e-7)


@pytest.mark.parametrize("x", [3.0, 4.0])
def test_the_isotropic_factor_is_what_a_flow_around_low_asperities_asks_for(x):
    """Patir and Cheng's of h = x rms.  Of a plane field of conductances h^3, alike in every direction, second order in
    their spread: mean less variance over twice the mean, h^3 (1 + 3/x^2) - 9 h^3/(2 x^2) = h^3 (1 - 1.5/x^2)."""
    assert means.mean_cube(x, 3.0, 0.0, True) / x**3 == pytest.approx(1.0 - 1.5 / x**2, rel=5e-3)
    # Heights that are long along the flow let more through.
    assert means.mean_cube(x, 3.0, 0.0, True) < x**3 < means.mean_cube(x, 3.0, 0.0, False)


def test_the_isotropic_factor_in_the_leakage_and_beyond_its_range():
    film = wide(inner_pressure=0.0, cavitation_pressure=0.0, clearance=5e-7)
    leaks = {}
    for seen in ("none", "christensen", "patir-cheng"):
        f = reynolds.parameters(replace(film, reynolds=Reynolds(cells_r=40, cells_theta=8, roughness=seen)), 5e-7)
        contact.lay_asperities(Contact(roughness=2e-7, compressive_strength=1e8), f)
        s, x = gap(film), np.empty(2 * 40 * 8)
        assert reynolds.start(f, s, x) == 0
        reynolds.flow(f, s, x)
        leaks[seen] = s[G.FLOW_INNER]
    # Of parallel faces; 0.5 um are 2.5 rms.
    smooth = -math.pi * 5e-7**3 * 3e5 / (6.0 * VISCOUS * math.log(0.05 / 0.045))
    assert leaks["patir-cheng"] == pytest.approx(smooth * (1.0 - 0.90 * math.exp(-0.56 * 2.5)), rel=1e-6)
    assert leaks["christensen"] == pytest.approx(smooth * roughness.mean_film_cubed(5 / 6) / (5 / 6) ** 3, rel=1e-6)
    cubes = [means.mean_cube(x, 3.0, 0.0, True) for x in np.linspace(3.0, -2.0, 60)]
    assert min(cubes) > 0.0 and np.all(np.diff(cubes) < 0.0)


def touching(order=3, amplitude=0.3e-6, dz=0.0, tilt=0.0):
    """Contact block, face block and gap state of wavy faces that touch."""
    film = wide(clearance=0.66e-6, coning=1e-5)
    face = G.face_parameters(film, film.clearance)
    lay_waves(face, [Waviness(order=order, amplitude=amplitude, phase=0.4)], [])
    given = Contact(roughness=0.16667e-6, compressive_strength=286.7e6, shear_strength=28.67e6)
    k = contact.lay_asperities(given, face)
    s = gap(film, DZ=dz, GX=tilt)
    return k, face, s


def test_asperities_of_wavy_faces_are_a_double_integral():
    k, face, s = touching(dz=-0.1e-6, tilt=2e-6)
    contact.contact_load_and_friction(k, face, s)

    def pressed(r, theta):
        h = 0.56e-6 + 1e-5 * (r - 0.045) + 0.3e-6 * math.cos(3 * theta + 0.4) + r * 2e-6 * math.sin(theta)
        return float(roughness.contact_fraction(h / 0.50001e-6)) * r

    def whole(weight):
        return dblquad(lambda r, t: pressed(r, t) * weight(r, t), 0.0, 2 * math.pi, 0.045, 0.05, epsabs=1e-13)[0]

    area = math.pi * (0.05**2 - 0.045**2)
    assert s[G.CONTACT_FORCE] == pytest.approx(286.7e6 * whole(lambda r, t: 1.0), rel=1e-6)
    assert s[G.CONTACT_X] == pytest.approx(286.7e6 * whole(lambda r, t: r * math.sin(t)), rel=1e-6)
    assert s[G.CONTACT_AREA] == pytest.approx(whole(lambda r, t: 1.0) / area, rel=1e-6)


def test_asperities_of_wavy_faces_have_a_potential():
    step, stored = 1e-10, []
    for dz in (-step, step):
        k, face, s = touching(dz=dz, tilt=1e-6)
        contact.contact_load_and_friction(k, face, s)
        stored.append(s[G.CONTACT_ENERGY])
    k, face, s = touching(tilt=1e-6)
    contact.contact_load(k, face, s)
    assert s[G.CONTACT_FORCE] == pytest.approx(-(stored[1] - stored[0]) / (2 * step), rel=3e-6)


def test_waves_of_nothing_leave_the_contact_of_cones():
    k, face, s = touching(amplitude=1e-16, dz=-0.3e-6, tilt=2e-6)
    contact.contact_load(k, face, s)
    wavy = s[[G.CONTACT_FORCE, G.CONTACT_X]].copy()
    lay_waves(face, [], [])
    contact.contact_load(k, face, s)
    assert wavy == pytest.approx(s[[G.CONTACT_FORCE, G.CONTACT_X]], rel=1e-6)


def test_gap_states_of_any_kind_have_a_finite_residual():
    f, s, x = moving()
    for dz in (-2.99e-6, -5e-6, 1e-3):
        s[G.DZ], res = dz, np.empty_like(x)
        reynolds.residual(f, s, x, np.zeros_like(x), res)
        assert np.all(np.isfinite(res))
    s[G.GY] = 1.0
    reynolds.residual(f, s, x, np.zeros_like(x), res)
    assert np.all(np.isfinite(res))
