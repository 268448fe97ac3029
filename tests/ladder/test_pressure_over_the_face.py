"""The pressure that the study shows sums up to the film's own force and moments, film by film, and converges to it with
the grid; aligned coned faces have the closed form."""

import numpy as np
import pytest
from command import SCENARIOS
from oracles import opening_force
from radial_cells import film_of
from scipy.integrate import quad

from sealdyn import read_scenario
from sealdyn.dynamics import interface
from sealdyn.scenario.reader import with_values
from sealdyn.studies import pressure
from sealdyn.studies.pressure import Settings, sums

R_I, R_O, CLEARANCE, CONING, DROP = 0.032, 0.040, 1e-5, 3.125e-3, 5e5
AREA = np.pi * (R_O**2 - R_I**2)
TILTED = "tilt = 0.15 mrad"
# Faces, and how far the sums over the grid of 17 x 48 may be from the film's own: of the gauge force, of the moment.
# Measured 3e-4 and 1.2e-3; 2.4e-3 and 1.9e-3 with a floor, where the pressure has a bend.
CLOSE = 1e-3, 4e-3
FACES = {
    "cone": ([], CLOSE),
    "planar": (["film.geometry=planar"], CLOSE),
    "tilted at the mean radius": (["film.tilt_radius=mean"], CLOSE),
    "inside pressurised": (["film.inner_pressure=5 bar", "film.outer_pressure=1 bar"], CLOSE),
    "floor": (["film.inner_pressure=1 bar", "film.outer_pressure=1 bar", "film.cavitation_pressure=1 bar"],
              (7e-3, 6e-3)),
    "profile": (['film.profile={radius=["32 mm","33.5 mm","36 mm","40 mm"], depth=["0.5 um","0 um","2 um","9 um"]}',
                 "film.model=profiled", "film.coning=0"], CLOSE),
}  # fmt: skip


def answer(at="", overrides=(), scenario=None):
    changes = dict(word.split("=", 1) for word in overrides)
    scenario = scenario or read_scenario(SCENARIOS / "fms_reference.toml", ["film.model=radial"])
    return pressure.run(with_values(scenario, changes), Settings(at), None).numbers


def field(found):
    return (np.array(found["pressure"][name]) for name in ("r", "theta", "p"))


@pytest.mark.parametrize("faces", FACES)
def test_the_field_sums_up_to_the_films_force_and_moments(faces):
    overrides, within = FACES[faces]
    found = answer(TILTED, overrides)
    gauge, size = abs(found["gauge_force"]), np.hypot(*found["moment"])
    assert found["integrated"]["force"] == pytest.approx(found["force"], abs=within[0] * gauge)
    assert size > 1e-3 * gauge * R_O, "this state must turn the ring"
    assert found["integrated"]["moment"] == pytest.approx(found["moment"], abs=within[1] * size)


def test_the_sums_converge_with_the_grid():
    found = answer(TILTED)
    r, theta, p = field(found)
    errors = []
    for stride in (4, 2, 1):
        force, moment, _ = sums(r[::stride], theta[::stride], p[::stride, ::stride], found["edges"], True)
        errors.append([abs(force / found["force"] - 1), *np.abs(np.subtract(moment, found["moment"]))])
    errors = np.array(errors)
    # Simpson's order is four; near the steep edge these grids are not quite there (7 to 12 per halving).
    assert np.all(errors[:-1] > 4 * errors[1:])


def test_a_film_with_unknowns_shows_its_cells(monkeypatch):
    exact, errors = answer(TILTED), []
    for cells in (16, 32, 64):
        monkeypatch.setattr(interface, "film_of", lambda scene, film=None, cells=cells: film_of(cells, 48))
        found = answer(TILTED)
        assert found["film"] == "radial_cells" and np.shape(found["pressure"]["p"]) == (cells, 48)
        whole, turned = found["integrated"]["force"] / found["force"] - 1, found["integrated"]["moment"]
        turned = np.subtract(turned, found["moment"]) / np.hypot(*found["moment"])
        errors.append(np.abs([whole, *turned, found["centre_of_pressure"] - exact["centre_of_pressure"]]))
    # Second order, as the cells' own.
    errors = np.array(errors)
    assert np.all(errors[:-1] > 2.5 * errors[1:]) and np.max(errors[-1]) < 1.5e-3


# --- aligned coned faces ----------------------------------------------------------------------------------


def coned_pressure(r, geometry):
    """Pressure (Pa) of `r h^3 p' = const` (planar: `h^3 p' = const`), by the primitive of the slope.

    With h = a + b r:  int dr/h^3 = -1/(2 b h^2),  int dr/(r h^3) = [ln(r/h) + a/h + a^2/(2 h^2)] / a^3.
    """
    a, b = CLEARANCE - CONING * R_I, CONING

    def primitive(r):
        h = a + b * r
        if geometry == "planar":
            return -1 / (2 * b * h**2)
        return (np.log(r / np.abs(h)) + a / h + a**2 / (2 * h**2)) / a**3

    return DROP * (primitive(r) - primitive(R_I)) / (primitive(R_O) - primitive(R_I))


@pytest.mark.core
@pytest.mark.parametrize("geometry", ["planar", "cylindrical"])
def test_aligned_coned_faces_have_the_closed_form(geometry):
    found = answer("", [f"film.geometry={geometry}"])
    r, _, p = field(found)
    expected = coned_pressure(r, geometry)
    assert p == pytest.approx(np.broadcast_to(expected[:, None], p.shape), abs=1e-7 * DROP)
    for name in ("thinnest", "thickest", "circle_mean"):
        assert found["profiles"][name] == pytest.approx(expected, abs=1e-7 * DROP)
    carried = quad(lambda r: coned_pressure(r, geometry) * r, R_I, R_O)[0]
    centre = quad(lambda r: coned_pressure(r, geometry) * r * (R_O - r), R_I, R_O)[0] / carried / (R_O - R_I)
    assert found["centre_of_pressure"] == pytest.approx(centre, abs=3e-4)
    assert found["profiles"]["width_mean"] == pytest.approx(np.full(48, 2 * np.pi * carried / AREA), rel=1e-3)
    assert found["force"] == pytest.approx(2 * np.pi * carried, rel=1e-8)


def test_numbers_beside_the_field():
    found = answer("clearance = 5 um", ["film.inner_pressure=1 bar", "film.outer_pressure=6 bar", "film.density=850"])
    assert found["clearance"] == pytest.approx(5e-6) and found["tilt"] == 0.0 and found["h_min"]["value"] == 5e-6
    assert found["force"] == pytest.approx(opening_force(5e-6, CONING, 1e5, 6e5), rel=1e-8)
    assert found["gauge_force"] == pytest.approx(found["force"] - 1e5 * AREA, rel=1e-12)
    through = quad(lambda r: 1 / (r * (5e-6 + CONING * (r - R_I)) ** 3), R_I, R_O)[0]
    leakage = np.pi * 5e5 / (6 * 0.5e-3 * through)
    assert found["leakage"] == pytest.approx(leakage, rel=1e-6)
    assert found["mass_flow"] == pytest.approx(850 * leakage, rel=1e-6) and found["exit_mach"] is None


def test_the_centre_is_counted_from_the_high_pressure():
    outside = answer("", ["film.geometry=planar", "film.coning=0"])
    inside = answer("", ["film.geometry=planar", "film.coning=0", "film.inner_pressure=5 bar", "film.outer_pressure=0"])
    # Triangles: r dr weighs them, from the edge of their height.
    width = R_O - R_I
    for found, ring in ((outside, lambda x: R_O - x), (inside, lambda x: R_I + x)):
        carried, turned = (quad(lambda x: (width - x) * ring(x) * x**n, 0.0, width)[0] for n in (0, 1))  # noqa: B023
        assert found["centre_of_pressure"] == pytest.approx(turned / carried / width, abs=1e-6)
    assert inside["leakage"] == pytest.approx(outside["leakage"], rel=1e-9) and inside["leakage"] > 0


def test_profiles_are_lines_of_the_field():
    found = answer(TILTED)
    r, theta, p = field(found)
    profiles, at = found["profiles"], found["profiles"]["at"]
    # A stator tilted about x closes the gap at 270 degrees; there the pressure is the fuller one.
    assert (at["thinnest"], at["thickest"]) == pytest.approx((1.5 * np.pi, 0.5 * np.pi))
    for name in ("thinnest", "thickest"):
        assert profiles[name] == p[:, np.argmin(np.abs(theta - at[name]))].tolist()
    assert np.all(np.subtract(profiles["thinnest"], profiles["thickest"])[1:-1] > 0)
    assert at["mid_radius"] == pytest.approx(0.036) and profiles["mid_radius"] == p[len(r) // 2].tolist()


def test_a_film_without_a_field_says_so():
    found = answer("tilt = 0.05 mrad", ["film.model=linear"])
    assert found["pressure"] is None and found["centre_of_pressure"] is None
    assert found["force"] > 0 and found["moment"][0] < 0 and found["leakage"] > 0
