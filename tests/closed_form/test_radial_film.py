"""The film exact over the radius, against a tilted film solved here without linearising by hand."""

import mpmath as mp
import numpy as np
import pytest
from scipy.integrate import solve_bvp

from sealdyn.closed_form import GREEN_1989_SEAL, aligned_leakage, aligned_opening_force, radial_film_coefficients

FACE = ("inner_radius", "outer_radius", "clearance", "coning")
REFERENCE = {name: GREEN_1989_SEAL[name] for name in (*FACE, "viscosity", "pressure_drop")}
R_I, R_O, CLEARANCE = (REFERENCE[n] for n in ("inner_radius", "outer_radius", "clearance"))
MU, DROP = REFERENCE["viscosity"], REFERENCE["pressure_drop"]


POINTS, WEIGHTS = np.polynomial.legendre.leggauss(60)


def integral(function, start, stop):
    """Integral of an array function along its last axis, from start to (an array of) stop."""
    half = (np.asarray(stop) - start)[..., None] / 2
    return (function(start + half * (1 + POINTS)) * WEIGHTS * half).sum(-1)


def radial_moment(geometry, coning, lever, lift=0.0, tilt=0.0, lift_rate=0.0, tilt_rate=0.0):
    """int p r^lever dr along one radius, p = 0 inside and DROP outside, films and rates linear in r.

    The pressure is built as a function of r and integrated by a second quadrature, so that nothing of the
    moment-integral form is shared.
    """
    bend = 1 if geometry == "cylindrical" else 0

    def gradient(source, r):
        film = CLEARANCE + lift + coning * (r - R_I) + tilt * r
        return source(r) / (r**bend * film**3)

    def squeezed(r):  # 12 mu int (lift_rate + tilt_rate r) r^bend dr from the inner edge
        lifted = lift_rate * (r ** (1 + bend) - R_I ** (1 + bend)) / (1 + bend)
        tilted = tilt_rate * (r ** (2 + bend) - R_I ** (2 + bend)) / (2 + bend)
        return 12 * MU * (lifted + tilted)

    def pressure_from(source, r):
        return integral(lambda s: gradient(source, s), R_I, r)

    through = (DROP - pressure_from(squeezed, R_O)) / pressure_from(np.ones_like, R_O)
    return integral(
        lambda r: (pressure_from(squeezed, r) + through * pressure_from(np.ones_like, r)) * r**lever, R_I, R_O
    )


def slope(geometry, coning, lever, motion):
    """Derivative of the moment with respect to one small motion, by a complex step: no differences."""
    return radial_moment(geometry, coning, lever, **{motion: 1e-30j}).imag / 1e-30


@pytest.mark.parametrize("geometry", ["planar", "cylindrical"])
@pytest.mark.parametrize("coning", [3.125e-3, 0.0, -6e-4])
def test_coefficients_from_a_displaced_film(geometry, coning):
    film = radial_film_coefficients(**REFERENCE | {"coning": coning}, geometry=geometry)
    # Around the circle a tilt g gives the film r g sin(theta): the moment averages sin^2, hence pi.
    assert film.tilt_stiffness == pytest.approx(-np.pi * slope(geometry, coning, 2, "tilt"), rel=1e-12)
    assert film.tilt_damping == pytest.approx(-np.pi * slope(geometry, coning, 2, "tilt_rate"), rel=1e-12)
    axial = -2 * np.pi * slope(geometry, coning, 1, "lift")
    # Flat faces have no axial stiffness: zero on the scale of the load per clearance.
    assert film.axial_stiffness == pytest.approx(axial, rel=1e-12, abs=1e-13 * DROP * R_O**2 / CLEARANCE)
    assert film.axial_damping == pytest.approx(-2 * np.pi * slope(geometry, coning, 1, "lift_rate"), rel=1e-12)


@pytest.mark.core
def test_numbers_of_the_reference_seal():
    # Independently computed values, printed to these digits.
    planar = radial_film_coefficients(**REFERENCE, geometry="planar")
    cylindrical = radial_film_coefficients(**REFERENCE)
    assert planar[:2] == (pytest.approx(5389.7, abs=0.05), pytest.approx(3.776, abs=5e-4))
    assert cylindrical[:2] == (pytest.approx(5099.5, abs=0.05), pytest.approx(3.649, abs=5e-4))
    assert aligned_leakage(**REFERENCE) == pytest.approx(1.2005e-5, abs=5e-10)


@pytest.mark.parametrize("geometry", ["planar", "cylindrical"])
@pytest.mark.parametrize("coning", [3.125e-3, 10e-6 / 0.032, 0.0, 1e-12, -6e-4, -1.24e-3])
def test_opening_force_and_leakage_of_the_aligned_film(geometry, coning):
    face = {name: REFERENCE[name] for name in FACE} | {"coning": coning}
    pressures = {"inner_pressure": 1e5, "outer_pressure": 1e5 + REFERENCE["pressure_drop"]}
    # The film is 125 times thinner at the outer edge in the last case: adaptive quadrature, in many digits.
    bend, length = (1, 1) if geometry == "cylindrical" else (0, (R_I + R_O) / 2)
    edges = mp.linspace(R_I, R_O, 9)

    def gradient(r):
        return 1 / (r**bend * (CLEARANCE + coning * (r - R_I)) ** 3)

    resistance = mp.quad(gradient, edges)
    # A step of pressure at s acts on every area element outside it.
    outside = mp.quad(lambda s: gradient(s) * (mp.mpf(R_O) ** 2 - s**2), edges) / resistance
    force = float(mp.pi * (1e5 * (mp.mpf(R_O) ** 2 - mp.mpf(R_I) ** 2) + DROP * outside))
    assert aligned_opening_force(**face, **pressures, geometry=geometry) == pytest.approx(force, rel=1e-12)
    if coning > -1e-3:  # where 60 points in r still resolve the film
        nested = force - 1e5 * np.pi * (R_O**2 - R_I**2)
        assert 2 * np.pi * radial_moment(geometry, coning, 1) == pytest.approx(nested, rel=1e-12)
    flow = 2 * np.pi * length * DROP / (12 * MU * float(resistance))
    leakage = aligned_leakage(**REFERENCE | {"coning": coning}, geometry=geometry)
    assert leakage == pytest.approx(flow, rel=1e-12)


def test_leakage_of_flat_faces_is_the_textbook_logarithm():
    flow = np.pi * DROP * CLEARANCE**3 / (6 * MU * np.log(R_O / R_I))
    assert aligned_leakage(**REFERENCE | {"coning": 0.0}) == pytest.approx(flow, rel=1e-13)


def test_aligned_film_by_a_boundary_value_solver():
    def radial(r, y):  # pressure in units of the drop, its force, and r h^3 p' in units of clearance^3
        h = 1 + REFERENCE["coning"] * (r - R_I) / 1e-5
        return [y[1] / (r * h**3), 0 * r, 2 * np.pi * r * y[0]]

    grid = [R_I + (R_O - R_I) * k / 400 for k in range(401)]
    start = [[0.5] * 401, [0.1] * 401, [0.0] * 401]
    solution = solve_bvp(radial, lambda a, b: [a[0], b[0] - 1, a[2]], grid, start, tol=1e-10, max_nodes=50000)
    assert solution.success
    force, flow = solution.y[2, -1] * 5e5, solution.y[1, 0] * 5e5 * 1e-15 / (12 * 0.5e-3) * 2 * np.pi
    face = {name: REFERENCE[name] for name in FACE}
    assert aligned_opening_force(**face, inner_pressure=0.0, outer_pressure=5e5) == pytest.approx(force, rel=1e-8)
    assert aligned_leakage(**REFERENCE) == pytest.approx(flow, rel=1e-8)


def test_unknown_geometry_is_refused():
    with pytest.raises(ValueError, match="cylindrical"):
        aligned_leakage(**REFERENCE, geometry="conical")
