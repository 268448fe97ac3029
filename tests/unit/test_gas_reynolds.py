"""Kernels of the gas Reynolds film against closed forms and collocation; conservation, derivatives, starts."""

from dataclasses import replace

import numpy as np
import pytest
from collocated_gas import collocated
from gas_faces import MU, PARTS, TEMPERATURE, gap_state, gas_film, linear_film, steady
from scenes import fms
from scipy.integrate import quad
from scipy.special import iv, kv

from sealdyn.dynamics.condensation import FilmDerivatives
from sealdyn.faces import film_thickness, geometry
from sealdyn.films import film_of
from sealdyn.films.gas_reynolds import film as gas
from sealdyn.scene.film import Profile
from sealdyn.scene.patterns import Waviness
from sealdyn.scene.rings import Rotor
from sealdyn.scene.scene import SceneError

R_I, R_O, CLEARANCE = 0.032, 0.040, 5e-6
NORMAL = 273.15 / (TEMPERATURE * 101325.0)


def orders(errors, factor=2.0):
    errors = np.abs(np.array(errors))
    return np.log(errors[:-1] / errors[1:]) / np.log(factor)


# --- steady -------------------------------------------------------------------------------------------


@pytest.mark.core
@pytest.mark.parametrize("slip", [False, True])
def test_parallel_faces_have_the_exact_steady_film(slip):
    """p^2 is linear in ln r; with slip p^2 + 2 a p, a = 6 mean free path times pressure over h."""
    p_i, p_o = 6e5, 1e5
    a = 6 * MU * np.sqrt(np.pi * 287.053 * TEMPERATURE / 2) / CLEARANCE if slip else 0.0

    def pressure(r):
        share = np.log(r / R_I) / np.log(R_O / R_I)
        return np.sqrt((p_i + a) ** 2 + ((p_o + a) ** 2 - (p_i + a) ** 2) * share) - a

    force = 2 * np.pi * quad(lambda r: pressure(r) * r, R_I, R_O, epsabs=0.0, epsrel=1e-12)[0]
    drop = (p_i + a) ** 2 - (p_o + a) ** 2
    flow = 2 * np.pi * NORMAL * CLEARANCE**3 * drop / (24 * MU * np.log(R_O / R_I))
    errors = []
    for cells in (12, 24, 48):
        film = gas_film((cells, 8), slip)
        f, s = gas.parameters(film, CLEARANCE), gap_state(film, 1000.0)
        x = steady(f, s)
        field = np.empty((1, cells + 2, 8))
        gas.fields(f, s, x, field)
        assert field[0] == pytest.approx(np.tile(pressure(gas.grid(f)[0]), (8, 1)).T, rel=1e-10)
        for slot in (geometry.FLOW_INNER, geometry.FLOW_OUTER):
            assert s[slot] == pytest.approx(flow, rel=1e-10)
        errors.append(s[geometry.FORCE] / force - 1)
    # What is left is the sum over the cells: measured 9e-5, and orders of 3.8 and 3.9.
    assert abs(errors[0]) < 3e-4 and np.all(orders(errors) > 3.0), errors


@pytest.mark.parametrize("coning", [5e-4, -3e-4])
def test_cones_have_the_steady_film_of_a_quadrature(coning):
    """dp^2 ~ dr/(r h^3); the opening law is the run's own sum over the cells."""
    p_i, p_o = 1e5, 6e5
    resistance = lambda r: 1 / (r * (CLEARANCE + coning * (r - R_I)) ** 3)  # noqa: E731
    whole = quad(resistance, R_I, R_O, epsabs=0.0, epsrel=1e-12)[0]

    def pressure(r):
        return np.sqrt(p_i**2 + (p_o**2 - p_i**2) * quad(resistance, R_I, r, epsabs=0.0, epsrel=1e-12)[0] / whole)

    force = 2 * np.pi * quad(lambda r: pressure(r) * r, R_I, R_O, epsabs=0.0, epsrel=1e-10)[0]
    film = gas_film(inner_pressure=p_i, outer_pressure=p_o, coning=coning)
    f, s = gas.parameters(film, CLEARANCE), gap_state(film, 1000.0)
    steady(f, s)
    flow = -2 * np.pi * NORMAL * (p_o**2 - p_i**2) / (24 * MU * whole)
    assert s[geometry.FLOW_INNER] == pytest.approx(flow, rel=3e-3)
    assert s[geometry.FLOW_OUTER] == pytest.approx(s[geometry.FLOW_INNER], rel=1e-10)
    assert s[geometry.FORCE] == pytest.approx(force, rel=5e-4)
    assert gas.opening_law(film)(CLEARANCE, p_i, p_o) == pytest.approx(s[geometry.FORCE], rel=1e-12)


WAVES = [Waviness(order=2, amplitude=0.6e-6, phase=0.4)]
TILTED = dict(gx=4e-5, gy=-5e-5)
MOVING = dict(dz_rate=2e-4, gx_rate=8e-3, gy_rate=5e-3)


def height(r, theta, waves=()):
    h = CLEARANCE + 2e-4 * (r - R_I) + r * (4e-5 * np.sin(theta) + 5e-5 * np.cos(theta))
    return h + sum(w.amplitude * np.cos(w.order * theta + w.phase) for w in waves)


def height_rate(r, theta):
    return 2e-4 + r * (8e-3 * np.sin(theta) - 5e-3 * np.cos(theta))


@pytest.mark.parametrize(
    "slip, waves, spin, pressures",
    [(False, [], 2000.0, (1e5, 3e5)), (True, [], -2000.0, (1e5, 3e5)), (False, WAVES, 2000.0, (3e5, 1e5)),
     (False, [], 3e4, (1e5, 1e5))],
    ids=["tilt", "slip", "waves", "fast"],
)  # fmt: skip
def test_tilted_faces_tend_to_collocation_at_second_order(slip, waves, spin, pressures):
    """Coning, tilt, rates, wedge; `fast` has a compressibility number 6 mu w r^2/(p h^2) of 2000 at the clearance."""
    changes = dict(inner_pressure=pressures[0], outer_pressure=pressures[1], coning=2e-4)
    film = gas_film(**changes)
    # A wave on the stator that stands still has no rate.
    exact = collocated(film, lambda r, t: height(r, t, waves), height_rate, spin, slip)
    errors = []
    for cells in ((6, 24), (12, 48), (24, 96)):
        f = gas.parameters(gas_film(cells, slip, **changes), CLEARANCE)
        film_thickness.lay_waves(f, waves, [])
        s = gap_state(film, spin, **TILTED, **MOVING)
        steady(f, s)
        apart = s[PARTS] - exact
        # Force, both moments, both flows, torque.
        errors.append([np.linalg.norm(apart[k]) / np.linalg.norm(exact[k]) for k in ([0], [1, 2], [3, 4], [5])])
    slopes = orders(errors)
    # Measured 1.65 to 3.8, then 1.9 to 3.8.
    assert np.all(slopes[1] > 1.7), (slopes, errors)
    # Measured up to 3.4e-3 with 12 x 48 cells, 8e-4 with 24 x 96.
    assert np.max(errors[1]) < 0.01 and np.max(errors[2]) < 2.5e-3, errors


# --- small motion -------------------------------------------------------------------------------------


def narrow(cells, **changes):
    """A face 0.4 mm wide with equal pressures."""
    return gas_film(cells, inner_radius=0.0396, inner_pressure=2e5, outer_pressure=2e5, **changes)


def squeezed(squeeze_number, cells=12, grading=None):
    """Axial K + i omega D of a narrow face, and its closed form z, both over p A/h."""
    film = narrow((cells, 8))
    p, h, width = film.inner_pressure, film.clearance, film.outer_radius - film.inner_radius
    omega = squeeze_number * p * h * h / (12 * MU * width**2)
    k, d = linear_film(film, gap_state(film), grading).matrices(omega)
    stiff = p * np.pi * (film.outer_radius**2 - film.inner_radius**2) / h
    z = 0.5 * width * np.sqrt(12j * omega * MU / (p * h * h))
    return (k[0, 0] + 1j * omega * d[0, 0]) / stiff, 1 - np.tanh(z) / z


@pytest.mark.parametrize("squeeze_number", [0.1, 1.0, 10.0, 100.0])
def test_squeezed_narrow_face_has_the_closed_form(squeeze_number):
    found, exact = squeezed(squeeze_number)
    # Measured 2e-6, 6e-6, 5e-4, 3e-3 with 12 cells.
    assert abs(found - exact) < 0.01 * abs(exact)


def test_squeezed_film_is_of_second_order_in_the_cells():
    errors = [abs(np.subtract(*squeezed(100.0, cells))) for cells in (24, 48, 96)]
    assert np.all(np.abs(orders(errors) - 2.0) < 0.3), errors


def test_trapped_gas_is_a_spring_where_the_mesh_sees_its_edge():
    """K = p A/h within 1 % from a squeeze number of 20000 on, with a layer at the edges of a hundredth of the width; of
    even cells as many miss it."""
    found, exact = squeezed(2e4, 24)
    assert abs(found - exact) < 0.01 * abs(exact) and abs(found.real - 1.0) < 0.0105
    even, _ = squeezed(2e4, 24, grading=0.0)
    fine, _ = squeezed(2e4, 48)
    assert abs(fine - exact) < 1e-3 * abs(exact) < 4e-3 * abs(exact) < abs(even - exact)


@pytest.mark.parametrize("spin", [0.0, 3000.0, -3000.0])
@pytest.mark.parametrize("omega", [500.0, 4e4])
def test_whirl_of_wide_parallel_faces_has_the_closed_form(spin, omega):
    """Small tilt g exp(i omega t) at equal pressures p0: the pressure is p0/h of A I1(l r) + B K1(l r) - r, with
    l^2 = 12 mu i (wm - omega)/(p0 h^2), zero at both radii; storage, wedge and flow around the circle together."""
    p0, r_i = 2e5, 0.025
    root = np.sqrt(12j * MU * (0.5 * spin - omega) / p0) / CLEARANCE
    ends = [[iv(1, root * r), kv(1, root * r)] for r in (r_i, R_O)]
    a, b = np.linalg.solve(ends, [r_i, R_O])

    def primitive(r):
        return r**4 / 4 - r * r / root * (a * iv(2, root * r) - b * kv(2, root * r))

    exact = np.pi * p0 / CLEARANCE * np.conj(primitive(R_O) - primitive(r_i))
    errors = []
    for cells in (12, 24, 48):
        film = gas_film((cells, 16), inner_radius=r_i, inner_pressure=p0, outer_pressure=p0)
        dynamic = linear_film(film, gap_state(film, spin)).stiffness(1j * omega)
        errors.append(abs((dynamic @ [0.0, 1.0, -1j])[1] - exact) / abs(exact))
    # Measured up to 4e-3, 6e-4, 1.3e-4.
    assert errors[0] < 0.012 and np.all(orders(errors) > 1.8), errors


# --- the equations ------------------------------------------------------------------------------------


def cases():
    """Blocks, gap states and unknowns of any film: tilted, wavy, slipping, at random pressures."""
    draw = np.random.default_rng(2)
    for slip, spin in ((False, 1000.0), (True, -3e4), (True, 0.0)):
        film = gas_film((7, 12), slip, coning=3e-4, outer_pressure=3e5)
        f, s = gas.parameters(film, CLEARANCE), gap_state(film, spin, **TILTED, **MOVING)
        film_thickness.lay_waves(f, WAVES, [Waviness(order=3, amplitude=0.3e-6)])
        yield f, s, steady(f, s) * draw.uniform(0.5, 1.5, 84)


def test_what_is_stored_is_what_flows_in_at_every_evaluation():
    for f, s, x in cases():
        res = np.empty_like(x)
        assert gas.residual(f, s, x, np.zeros_like(x), res) == 0
        gas.flow(f, s, x)
        r, _ = gas.grid(f)
        edges = np.concatenate([r[:1], 0.5 * (r[1:-2] + r[2:-1]), r[-1:]])
        stored = -np.sum(res.reshape(12, 7) @ (0.5 * np.diff(edges**2))) * 2 * np.pi / 12 * NORMAL
        through = max(abs(s[geometry.FLOW_INNER]), abs(s[geometry.FLOW_OUTER]))
        assert abs(stored - (s[geometry.FLOW_INNER] - s[geometry.FLOW_OUTER])) < 1e-10 * through


def test_derivatives_are_differences():
    plain = replace(gas.FILM, jacobian=None, wrench_jacobian=None)
    for f, s, x in cases():
        unknowns, found = gas.unknowns(f), []
        assert unknowns.differential.all()
        for film in (gas.FILM, plain):
            derivatives = FilmDerivatives(film, unknowns, f)
            found.append((derivatives.matrix(s, x, 0 * x, 2e3).data, derivatives.wrench(s, x)))
        for own, differenced in zip(*found, strict=True):
            assert np.max(np.abs(own - differenced)) < 1e-8 * np.max(np.abs(own))


def test_start_solves_the_balances_with_the_gaps_own_rates():
    film = gas_film(coning=2e-4)
    f, s = gas.parameters(film, CLEARANCE), gap_state(film, 1000.0, **TILTED, **MOVING)
    x = steady(f, s)
    theta, r = np.meshgrid(gas.grid(f)[1], gas.grid(f)[0][1:-1], indexing="ij")
    rate, res = x * (height_rate(r, theta) / height(r, theta)).ravel(), np.empty_like(x)
    gas.residual(f, s, x, rate, res)
    assert np.max(np.abs(res)) < 1e-8 * np.max(np.abs(rate))


def test_start_finds_pressures_of_any_motion():
    """Closing and opening fast, near to touching, with either spin."""
    draw = np.random.default_rng(1)
    for _ in range(200):
        clearance = 10 ** draw.uniform(-6, -4.7)
        inner, outer = 10 ** draw.uniform(4.7, 6.5, 2)
        film = gas_film((8, 24), bool(draw.integers(2)), inner_pressure=inner, outer_pressure=outer)
        f, s = gas.parameters(film, clearance), gap_state(film, draw.choice([-1, 1]) * 10 ** draw.uniform(1, 4.3))
        angle, tilt = draw.uniform(0, 2 * np.pi), draw.uniform(0, 0.95) * clearance / R_O
        s[geometry.GX], s[geometry.GY] = tilt * np.cos(angle), tilt * np.sin(angle)
        s[geometry.DZ_RATE] = draw.normal() * clearance * 10 ** draw.uniform(0, 3)
        assert np.min(steady(f, s)) > 0.0


def test_pressures_below_zero_even_out():
    """A solver may try what no gas does: the residual stays a number, and pulls back up."""
    f, s, x = next(cases())
    x[40] = -x[40]
    res = np.empty_like(x)
    assert gas.residual(f, s, x, np.zeros_like(x), res) == 0 and np.all(np.isfinite(res)) and res[40] < 0.0


# --- faces --------------------------------------------------------------------------------------------


def test_a_profile_is_the_cone_it_draws():
    plain, drawn = gas_film(coning=2e-4), gas_film(profile=Profile((R_I, 0.035, R_O), (0.0, 6e-7, 1.6e-6)))
    found = []
    for film in (plain, drawn):
        s = gap_state(film, 1000.0, **TILTED)
        steady(gas.parameters(film, CLEARANCE), s)
        found.append(s[PARTS])
    assert found[1] == pytest.approx(found[0], rel=1e-12)


def test_gases_between_cylindrical_faces_only():
    assert film_of(fms(film=gas_film())) is gas.FILM
    turning = fms(film=gas_film(), rotor=Rotor(waviness=WAVES))
    for scene in (fms(film=gas_film(geometry="planar")), fms(film=gas_film(gas=None, temperature=None)), turning):
        with pytest.raises(SceneError):
            film_of(scene)
