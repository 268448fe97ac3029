"""The film exact over the radius, against a tilted film solved here without linearising by hand."""

import numpy as np
import pytest

from sealdyn.closed_form import radial_film_coefficients
from sealdyn.closed_form.green_1989 import GREEN_1989_SEAL

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


def test_unknown_geometry_is_refused():
    with pytest.raises(ValueError, match="cylindrical"):
        radial_film_coefficients(**REFERENCE, geometry="conical")
