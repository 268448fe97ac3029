"""Green's narrow film against its own Reynolds equation, solved here in high precision."""

import mpmath as mp
import numpy as np
import pytest

from sealdyn.closed_form import (
    film_coefficients,
    narrow_seal_opening_force,
    radial_film_coefficients,
)
from sealdyn.closed_form.green_1989 import GREEN_1989_SEAL

FACE = ("inner_radius", "outer_radius", "clearance", "coning")
REFERENCE = {name: GREEN_1989_SEAL[name] for name in (*FACE, "viscosity", "pressure_drop")}


@pytest.fixture(autouse=True)
def digits():
    """Forty in these cases, and no others."""
    with mp.workdps(40):
        yield


def exact(names=REFERENCE, **changes):
    return {name: mp.mpf(value) for name, value in (dict(names) | changes).items()}


def squeeze_factor_of_green(x):
    """(ln(1+x) - 2x/(2+x)) / x^3, as printed, in enough digits to survive the cancellation."""
    with mp.workdps(120):
        x = mp.mpf(x)
        return (mp.log(1 + x) - 2 * x / (2 + x)) / x**3


def scales(speed, seal):
    """Green's S, and the factors from his dimensionless stiffness and damping to SI."""
    ratio = seal["inner_radius"] / seal["outer_radius"]
    pressure = 6 * seal["viscosity"] * speed * (seal["outer_radius"] / seal["clearance"]) ** 2
    pressure *= (1 - ratio) ** 2
    stiffness = pressure * seal["outer_radius"] ** 4 / seal["clearance"]
    return pressure, stiffness, stiffness / speed


@pytest.mark.parametrize("speed", [10.0, 1000.0])
@pytest.mark.parametrize("coning", [3.125e-3, 1e-3, 1e-9, -8e-4])
def test_tilt_pair_is_greens_dimensionless_formula(speed, coning):
    seal = exact(coning=coning)
    pressure, to_stiffness, to_damping = scales(mp.mpf(speed), seal)
    ratio = seal["inner_radius"] / seal["outer_radius"]
    b = seal["coning"] * seal["outer_radius"] / seal["clearance"]
    bracket = (1 - ratio**2) / (4 + 2 * b * (1 - ratio))
    stiffness = mp.pi * seal["pressure_drop"] / pressure * (b * ratio - 1) * bracket**2 * to_stiffness
    g = squeeze_factor_of_green(b * (1 - ratio)) * (1 - ratio)
    damping = 2 * mp.pi * ((1 + ratio) / 2) ** 3 * g * to_damping
    film = film_coefficients(**REFERENCE | {"coning": coning})
    assert film.tilt_stiffness == pytest.approx(float(stiffness), rel=1e-14)
    assert film.tilt_damping == pytest.approx(float(damping), rel=1e-14)


@pytest.mark.core
def test_published_dimensionless_coefficients():
    # Green (1989) prints K_f 0.0118, D_f 8.3e-3; his I 1.63e-3, K_s 8.14e-4, D_s 4.88e-4 check the scales.
    _, to_stiffness, to_damping = (float(x) for x in scales(mp.mpf(1000), exact()))
    film = film_coefficients(**REFERENCE)
    assert film.tilt_stiffness / to_stiffness == pytest.approx(0.0118, abs=0.5e-4)
    assert film.tilt_damping / to_damping == pytest.approx(8.3e-3, abs=0.5e-4)
    seal = GREEN_1989_SEAL
    half = seal["support_radius"] ** 2 / 2
    assert seal["axial_support_stiffness"] * half / to_stiffness == pytest.approx(8.14e-4, abs=0.5e-6)
    assert seal["axial_support_damping"] * half / to_damping == pytest.approx(4.88e-4, abs=0.5e-6)
    assert seal["transverse_inertia"] * 1000**2 / to_stiffness == pytest.approx(1.63e-3, abs=0.5e-5)
    assert seal["coning"] * seal["outer_radius"] / seal["clearance"] == pytest.approx(12.5)


@pytest.mark.parametrize("sign", [1, -1])
@pytest.mark.parametrize("size", [*np.logspace(-12, 1, 27), 0.4, 0.5, 0.8, 1.99, 2.01, 4.0])
def test_damping_keeps_its_digits_as_the_faces_become_flat(size, sign):
    x = sign * min(size, 0.9) if sign < 0 else size
    width = REFERENCE["outer_radius"] - REFERENCE["inner_radius"]
    coning = x * REFERENCE["clearance"] / width
    # The comparison sees the coning that the function was given, not the one asked for.
    seal = exact(coning=coning)
    length = seal["outer_radius"] - seal["inner_radius"]
    mean_radius = (seal["inner_radius"] + seal["outer_radius"]) / 2
    g = squeeze_factor_of_green(seal["coning"] * length / seal["clearance"])
    damping = 12 * mp.pi * seal["viscosity"] * (mean_radius * length / seal["clearance"]) ** 3 * g
    assert film_coefficients(**REFERENCE | {"coning": coning}).tilt_damping == pytest.approx(
        float(damping), rel=3e-15 / (1 + min(x, 0))
    )


def strip(seal, films, rate=0):
    """int p ds over the face, inner pressure 0, of the strip `(h^3 p')' = 12 mu rate` on two edge films."""
    length, slope = seal["outer_radius"] - seal["inner_radius"], films[1] - films[0]

    def moment(power):
        return mp.quad(lambda s: s**power / (films[0] + slope * s / length) ** 3, [0, length / 2, length])

    # p' = (12 mu rate s + a) / h^3, a from the pressure drop;  int p ds = p_o L - int s p' ds
    squeeze = 12 * seal["viscosity"] * rate
    a = (seal["pressure_drop"] - squeeze * moment(1)) / moment(0)
    return seal["pressure_drop"] * length - squeeze * moment(2) - a * moment(1)


@pytest.mark.parametrize("coning", [3.125e-3, 0.0, -1e-3])
def test_all_four_coefficients_from_a_perturbed_strip(coning):
    seal = exact(coning=coning)
    length = seal["outer_radius"] - seal["inner_radius"]
    mean_radius = (seal["inner_radius"] + seal["outer_radius"]) / 2
    films = (seal["clearance"], seal["clearance"] + seal["coning"] * length)
    lift = mp.diff(lambda z: strip(seal, (films[0] + z, films[1] + z)), 0)
    radii = (seal["inner_radius"], seal["outer_radius"])
    tilt = mp.diff(lambda g: strip(seal, tuple(h + r * g for h, r in zip(films, radii, strict=True))), 0)
    squeeze = mp.diff(lambda v: strip(seal, films, v), 0)
    # Around the circle: force 2 pi r_m, moment pi r_m^2; a tilt rate moves the mean radius by r_m.
    film = film_coefficients(**REFERENCE | {"coning": coning})
    expected = (-mp.pi * mean_radius**2 * tilt, -mp.pi * mean_radius**3 * squeeze)
    expected += (-2 * mp.pi * mean_radius * lift, -2 * mp.pi * mean_radius * squeeze)
    assert film == pytest.approx([float(x) for x in expected], rel=1e-13, abs=1e-30)
    force = narrow_seal_opening_force(**{n: float(seal[n]) for n in FACE}, inner_pressure=2e5, outer_pressure=7e5)
    area = 2 * mp.pi * mean_radius * length
    assert force == pytest.approx(float(2e5 * area + 2 * mp.pi * mean_radius * strip(seal, films)), rel=1e-13)


def test_narrow_seal_is_the_limit_of_the_film_over_the_radius():
    # Errors fall with the face width, at the same film ratio.
    errors = []
    for width in (4e-4, 2e-4):
        seal = REFERENCE | {"outer_radius": 0.032 + width, "coning": 25e-6 / width}
        pairs = zip(film_coefficients(**seal), radial_film_coefficients(**seal), strict=True)
        errors.append([abs(a / b - 1) for a, b in pairs])
    assert np.max(errors[0]) < 0.01
    assert np.divide(*errors) == pytest.approx(2.0, rel=0.05)


def test_broadcasts_over_clearance_and_coning():
    clearance, coning = np.array([[5e-6], [10e-6]]), np.array([-5e-4, 0.0, 3.125e-3])
    changes = {"clearance": clearance, "coning": coning}
    one = {"clearance": 10e-6, "coning": 0.0}
    for law in (film_coefficients, radial_film_coefficients):
        for whole, single in zip(law(**REFERENCE | changes), law(**REFERENCE | one), strict=True):
            assert whole.shape == (2, 3)
            assert whole[1, 1] == single


@pytest.mark.parametrize(
    "wrong", [{"clearance": 0.0}, {"coning": -1.3e-3}, {"outer_radius": 0.03}, {"inner_radius": -0.01}]
)
def test_faces_that_cross_are_refused(wrong):
    for law in (film_coefficients, radial_film_coefficients):
        with pytest.raises(ValueError, match=r"radii|film"):
            law(**REFERENCE | wrong)
