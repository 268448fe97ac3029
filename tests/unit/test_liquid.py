"""Liquids over their temperature: water beside published numbers, oil beside Walther's law, what a scenario may say."""

import math
from dataclasses import replace

import numpy as np
import pytest
from warm_seals import VG32, warm_seal

from sealdyn import Scenario, ScenarioError
from sealdyn.numerics.piecewise_linear import PiecewiseLinear
from sealdyn.scenario.reader import parse_scenario
from sealdyn.scene.film import Film
from sealdyn.scene.fluid import Liquid, Water, in_numbers, liquid_of

ZERO = 273.15
# Saturated (below 100 degC at 1 bar all but the same) water: degC, viscosity (uPa s), density (kg/m^3), specific heat
# (J/(kg K)), conductivity (W/(m K)), vapour pressure (kPa).  Steam tables that follow IAPWS (viscosity 2008, IAPWS-95,
# conductivity 2011), e.g. Wagner & Pruss (2002), Huber et al. (2009, 2012), to the digits printed there.
STEAM_TABLE = np.array([
    (0.01, 1791.0, 999.79, 4219.9, 0.5557, 0.61165),
    (20.0, 1001.6, 998.16, 4184.4, 0.5980, 2.3393),
    (40.0, 653.0, 992.18, 4179.6, 0.6286, 7.3849),
    (60.0, 466.0, 983.16, 4185.1, 0.6510, 19.947),
    (80.0, 354.0, 971.77, 4196.9, 0.6670, 47.414),
    (100.0, 281.7, 958.35, 4215.7, 0.6773, 101.42),
    (120.0, 232.0, 943.11, 4244.2, 0.6820, 198.67),
    (150.0, 182.5, 917.01, 4310.0, 0.6820, 476.16),
])  # fmt: skip
# What the docstring of Water promises; a few units of the table's last digit more.
WITHIN = {"viscosity": 0.014, "density": 5e-4, "specific_heat": 2e-3, "conductivity": 4e-3, "vapour_pressure": 6e-3}


@pytest.mark.core
@pytest.mark.parametrize(("column", "name"), list(enumerate(WITHIN, 1)))
def test_water_is_that_of_the_steam_tables(column, name):
    scale = {"viscosity": 1e-6, "vapour_pressure": 1e3}.get(name, 1.0)
    found = getattr(Water(), f"{name}_at")(STEAM_TABLE[:, 0] + ZERO)
    assert found == pytest.approx(scale * STEAM_TABLE[:, column], rel=WITHIN[name])


def test_water_thins_at_every_temperature():
    everywhere = np.linspace(Water.lowest, Water.highest, 400)
    assert np.all(np.diff(Water().viscosity_at(everywhere)) < 0.0)
    assert np.all(np.diff(Water().vapour_pressure_at(everywhere)) > 0.0)


# --- oil ------------------------------------------------------------------------------------------------


def walther(points, temperature):
    """Kinematic viscosity (mm^2/s) at a temperature (K) of the law through two points (K, mm^2/s)."""
    (t1, nu1), (t2, nu2) = points
    w1, w2 = (math.log10(math.log10(nu + 0.7)) for nu in (nu1, nu2))
    slope = (w1 - w2) / (math.log10(t2) - math.log10(t1))
    return 10.0**10.0 ** (w1 - slope * (math.log10(temperature) - math.log10(t1))) - 0.7


def oil(*points, unit="m^2/s", **changes):
    return Liquid(**(dict(density=870.0, specific_heat=2000.0, viscosity=tuple((*p, unit) for p in points)) | changes))


@pytest.mark.core
def test_an_oil_follows_walther_between_its_points():
    points = (313.15, 32.0), (373.15, 5.4)
    of_two = oil(*((t, nu * 1e-6) for t, nu in points))
    for t in (313.15, 320.0, 333.15, 350.0, 373.15):
        assert of_two.viscosity_at(t) == pytest.approx(870.0 * 1e-6 * walther(points, t), rel=1e-12), t
    # An exponential through the same two errs by a fifth.
    between = math.sqrt(of_two.viscosity_at(313.15) * of_two.viscosity_at(373.15))
    assert between / of_two.viscosity_at(343.15) == pytest.approx(1.18, abs=0.04)


def test_three_points_are_two_laws():
    points = (293.15, 90.0), (313.15, 32.0), (373.15, 5.4)
    of_three = oil(*((t, nu * 1e-6) for t, nu in points))
    assert of_three.lowest == 293.15 and of_three.highest == 373.15
    for t, pair in ((293.15, points[:2]), (300.0, points[:2]), (313.15, points[1:]), (360.0, points[1:])):
        assert of_three.viscosity_at(t) == pytest.approx(870.0 * 1e-6 * walther(pair, t), rel=1e-12), t


def test_dynamic_viscosity_is_kinematic_times_density():
    points = (313.15, 32e-6), (373.15, 5.4e-6)
    dynamic = oil(*((t, nu * 870.0) for t, nu in points), unit="Pa*s")
    for t in np.linspace(313.15, 373.15, 7):
        assert dynamic.viscosity_at(t) == pytest.approx(oil(*points).viscosity_at(t), rel=1e-13)


def test_a_liquid_too_thin_for_walther_is_geometric():
    """Below 0.3 mm^2/s the law has no logarithm; then viscosity is geometric between the points."""
    thin = oil((300.0, 0.4e-6), (400.0, 0.1e-6), density=700.0)
    assert thin.viscosity_at(300.0) == pytest.approx(700.0 * 0.4e-6, rel=1e-12)
    assert thin.viscosity_at(350.0) == pytest.approx(700.0 * 0.2e-6, rel=1e-12)
    assert thin.viscosity_at(400.0) == pytest.approx(700.0 * 0.1e-6, rel=1e-12)


# --- a scenario's liquid ---------------------------------------------------------------------------------

DRAWN = {
    "density": "0.87 g/cm^3",
    "specific_heat": "2 kJ/(kg*K)",
    "vapour_pressure": "10 mbar",
    "conductivity": "0.0013 W/(cm*K)",
    "viscosity": [["104 degF", "32 cSt"], ["212 degF", "5.4 mm^2/s"]],
}


def test_units_are_read():
    found, plain = liquid_of(seal(DRAWN).scene.film), liquid_of(seal(VG32).scene.film)
    assert found.density == pytest.approx(870.0) and found.specific_heat == pytest.approx(2000.0)
    assert found.conductivity == pytest.approx(0.13) and found.vapour_pressure == pytest.approx(1000.0)
    for (t, nu, unit), (t_plain, nu_plain, unit_plain) in zip(found.viscosity, plain.viscosity, strict=True):
        assert (t, nu) == pytest.approx((t_plain, nu_plain), rel=1e-12) and unit == unit_plain == "m^2/s"
    kelvin = seal(VG32 | {"viscosity": [[313.15, "27.84 mPa*s"], [373.15, 4.698e-3]]}).scene.film
    assert liquid_of(kelvin).viscosity_at(340.0) == pytest.approx(plain.viscosity_at(340.0), rel=1e-12)


def seal(liquid, **values):
    return warm_seal({"film.temperature": "60 degC", "film.liquid": liquid}, **values)


@pytest.mark.parametrize("liquid", ["water", VG32, DRAWN], ids=["water", "oil", "oil in other units"])
def test_a_warm_scenario_comes_back_as_it_went(liquid):
    scenario = seal(liquid)
    assert Scenario.from_dict(scenario.to_dict(), scenario.name).scene == scenario.scene
    assert parse_scenario(scenario.to_toml(), scenario.name).scene == scenario.scene
    assert eval(repr(scenario.scene), {**_names()}) == scenario.scene


def _names():
    from sealdyn.scene import excitation, film, fluid, rings, scene

    return {k: v for m in (excitation, film, fluid, rings, scene) for k, v in vars(m).items()}


def test_another_temperature_is_another_viscosity():
    scenario = seal("water")
    for degrees, micropascal_seconds in ((20.0, 1001.6), (60.0, 466.0), (100.0, 281.7)):
        film = in_numbers(scenario.with_(film__temperature=f"{degrees} degC").scene.film)
        assert film.viscosity == pytest.approx(1e-6 * micropascal_seconds, rel=0.01) and film.liquid is None
    assert in_numbers(film) is film


def test_numbers_of_a_liquid_follow_a_table_of_temperatures():
    """Between the points of the table, too, where viscosity is no straight line of the time."""
    film = Film(
        inner_radius=0.03, outer_radius=0.034, outer_pressure=1e6, inner_pressure=1e5, liquid="water",
        temperature=PiecewiseLinear((0.0, 10.0), (293.15, 373.15)),
    )  # fmt: skip
    found = in_numbers(film)
    for t in (0.0, 1.0, 5.0, 7.7, 10.0):
        assert found.viscosity.at(t) == pytest.approx(Water().viscosity_at(293.15 + 8.0 * t), rel=5e-3)
    assert found.density == pytest.approx(998.2, rel=1e-3)
    warmer = in_numbers(replace(film, temperature=300.0), 20.0)
    assert warmer.viscosity == pytest.approx(Water().viscosity_at(320.0), rel=1e-14)
    assert warmer.vapour_pressure == pytest.approx(Water().vapour_pressure_at(320.0), rel=1e-14)


# --- what cannot be ---------------------------------------------------------------------------------------

RING = {"resistance": 0.4}
TABLE = [["40 degC", "32 mm^2/s"], ["100 degC", "5.4 mm^2/s"]]
WRONG = {
    "viscosity beside a liquid": ({"film.viscosity": "1 mPa*s"}, "film.viscosity"),
    "density beside a liquid": ({"film.density": 990.0}, "film.density"),
    "specific heat beside a liquid": ({"film.specific_heat": 4000.0}, "film.specific_heat"),
    "vapour pressure beside a liquid": ({"film.vapour_pressure": "20 mbar"}, "film.vapour_pressure"),
    "unknown liquid": ({"film.liquid": "wine"}, "film.liquid"),
    "ice": ({"film.temperature": "-1 degC"}, "film.temperature"),
    "steam": ({"film.temperature": "151 degC"}, "film.temperature"),
    "steam on the way": (
        {"film.temperature": {"time": [0, 1], "value": ["20 degC", "151 degC"]}},
        "film.temperature",
    ),
    "oil below its table": ({"film.liquid": VG32, "film.temperature": "39 degC"}, "film.temperature"),
    "oil above its table": ({"film.liquid": VG32, "film.temperature": "101 degC"}, "film.temperature"),
    "gas and liquid": ({"film.gas": "air"}, "film.liquid"),
    "one point": ({"film.liquid.viscosity": TABLE[:1]}, "film.liquid.viscosity"),
    "temperatures that fall": ({"film.liquid.viscosity": TABLE[::-1]}, "film.liquid.viscosity"),
    "both kinds": ({"film.liquid.viscosity": [TABLE[0], ["100 degC", "5 mPa*s"]]}, "film.liquid.viscosity"),
    "no viscosity": ({"film.liquid.viscosity": [TABLE[0], ["100 degC", "5 kg"]]}, "film.liquid.viscosity"),
    "no temperature": ({"film.liquid.viscosity": [TABLE[0], ["5 kg", "5 mm^2/s"]]}, "film.liquid.viscosity"),
    "a negative one": ({"film.liquid.viscosity": [TABLE[0], ["100 degC", "-5 mm^2/s"]]}, "film.liquid.viscosity"),
    "not finite": ({"film.liquid.viscosity": [[313.0, math.inf], [373.0, 0.01]]}, "film.liquid.viscosity"),
    "four entries": ({"film.liquid.viscosity": [[313.0, 0.1, "Pa*s", 1], [373.0, 0.01]]}, "film.liquid.viscosity"),
    "a wrong third": ({"film.liquid.viscosity": [[313.0, 0.1, "kg"], [373.0, 0.01]]}, "film.liquid.viscosity"),
    "no pairs": ({"film.liquid.viscosity": [313.0, 0.1]}, "film.liquid.viscosity"),
    "a number": ({"film.liquid.viscosity": 0.1}, "film.liquid.viscosity"),
    "a hundred and one": (
        {"film.liquid.viscosity": [[300.0 + k, 0.1 / (1 + k)] for k in range(101)]},
        "film.liquid.viscosity",
    ),
    "no density": ({"film.liquid.density": 0.0}, "film.liquid.density"),
    "an unknown key of a liquid": ({"film.liquid.colour": "red"}, "film.liquid.colour"),
    "no ring": ({"film.heat": {}}, "film.heat"),
    "no resistance": ({"film.heat": {"stator": {"coning_per_watt": 1e-6}}}, "film.heat.stator.resistance"),
    "a resistance of 0": ({"film.heat": {"rotor": {"resistance": 0.0}}}, "film.heat.rotor.resistance"),
    "a resistance of less": ({"film.heat": {"rotor": {"resistance": -1.0}}}, "film.heat.rotor.resistance"),
    "numbers beside a body": ({"film.heat": {"rotor": RING | {"convection": 5e3}}}, "film.heat.rotor.convection"),
    "wet and numbers": ({"film.heat": {"stator": RING | {"wet": "bore"}}}, "film.heat.stator.wet"),
    "coefficients of one's own": (
        {"film.model": "linear", "film.coefficients": {"tilt_stiffness": 1.0, "tilt_damping": 1.0,
                                                       "axial_stiffness": 1.0, "axial_damping": 1.0}},
        "film.heat",
    ),
    "pressure coning without its reference": ({"film.coning_per_pressure": 1e-11}, "film.coning_reference_pressure"),
    "a reference of nothing": ({"film.coning_reference_pressure": 1e6}, "film.coning_reference_pressure"),
    "a pressure that changes sides": (
        {"film.coning_per_pressure": 1e-11, "film.coning_reference_pressure": 1e6,
         "film.outer_pressure": {"time": [0, 1], "value": ["11 bar", "0.5 bar"]}},
        "film.coning_per_pressure",
    ),
}  # fmt: skip


@pytest.mark.parametrize(("values", "key"), WRONG.values(), ids=WRONG)
def test_what_a_warm_scenario_cannot_have(values, key):
    start = warm_seal()
    if any(k.startswith("film.liquid.") for k in values):
        start = seal(VG32)
    with pytest.raises(ScenarioError) as caught:
        start.with_(values)
    assert key in [error.key for error in (caught.value, *caught.value.others)]
    assert str(caught.value).count("\n") == 0


def test_heat_needs_a_liquid_and_a_liquid_its_temperature():
    table = warm_seal().to_dict()
    without = {k: v for k, v in table["film"].items() if k != "temperature"}
    assert _key(table | {"film": without}) == "film.temperature"
    numbers = {k: v for k, v in without.items() if k != "liquid"} | {"viscosity": 1e-3}
    assert _key(table | {"film": numbers}) == "film.liquid"
    assert _key(table | {"film": numbers | {"temperature": 300.0}}) in ("film.liquid", "film.temperature")
    bare = {k: v for k, v in numbers.items() if k not in ("heat", "viscosity")}
    assert _key(table | {"film": bare}) == "film.viscosity"
    of_gas = numbers | {"gas": "air", "temperature": 300.0, "viscosity": 1.8e-5}
    assert _key(table | {"film": of_gas}) == "film.heat"


def _key(table):
    with pytest.raises(ScenarioError) as caught:
        Scenario.from_dict(table, "seal")
    return caught.value.key
